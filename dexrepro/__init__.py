"""Reproduce, as simulations, the figures and tables of a robotics book, and check its claims with numbers."""

from importlib.metadata import PackageNotFoundError, version

try:
    __version__ = version("dexrepro")
except PackageNotFoundError:  # running from a source tree that was never installed
    __version__ = "0+unknown"
