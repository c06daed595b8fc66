"""Synthetic people: an operator of a leader, handwriting, reaching over a board, carrying a box, muscle stiffness."""
