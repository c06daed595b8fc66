"""Figures and tables of the contact with an unknown object."""


def draw(recordings, metrics, config):
    return {}


def tabulate(recordings, metrics, config):
    return {}
