"""Files of points and triangles, as scanners and modelling software write them."""
