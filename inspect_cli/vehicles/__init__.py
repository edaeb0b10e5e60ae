"""One module per kind of platform: nominal MuJoCo model, Capabilities, flight stack."""
