"""What is so: true geometry, specimens, disturbances, proximity effects, faults."""
