"""Arms as data, their descriptions, kinematics and, of planar ones, dynamics in closed form; nothing is simulated."""
