"""Control laws: selective impedance, allocation. Kernels with thin typed faces."""
