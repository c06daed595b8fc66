"""Figures and tables of the sponge experiment."""


def draw(recordings, metrics, config):
    return {}


def tabulate(recordings, metrics, config):
    return {}
