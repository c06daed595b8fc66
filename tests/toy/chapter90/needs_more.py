"""Needs a package nobody has."""

REQUIRES = ("no_such_package",)
FIGURES = {}
