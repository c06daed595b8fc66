"""How often does a claim hold? Vary what the book does not print, within the ranges declared in conf/, and count.

A sample draws every ranged parameter of an experiment, and the seed: scrambled Sobol points cover the ranges evenly. It
keeps the *metrics* of the cases, each with the key of its simulation, so that claims, controls and printed forms are
evaluated from samples made earlier: rewording a claim costs nothing, a new case costs that case alone, and only a
changed simulation runs again; ``confirm`` carries samples over a change of code that changed no number. A study looks
at its claims every few samples from 16 on, then draws for those alone that are open, and ends when none is, or at 100.

Samples are kept one a line beside the summary; the same study may be started any number of times, on any machine that
shares the results folder: its processes share the samples.
"""
