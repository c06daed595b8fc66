"""Needs a package nobody has."""
