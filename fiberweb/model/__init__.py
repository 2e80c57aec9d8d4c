"""What is simulated: network, scene, drive, mesh; no numerics of time."""
