"""What is believed of the structure: clouds, meshes, robust fits, planned surfaces."""
