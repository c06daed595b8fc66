"""Figures and tables of the circle tracking experiment."""


def draw(recordings, metrics, config):
    return {}


def tabulate(recordings, metrics, config):
    return {}
