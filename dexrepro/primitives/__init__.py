"""Movement primitives: learned from a demonstration, rolled out whole, in batches or step by step.

>>> demonstration = Demonstration.of(time, position)                         # (N,), (N, d)
>>> kernels = GaussianKernels.spaced(20, decay=4.0)
>>> primitive = DMP.fit(demonstration, kernels, SpringDamper.critical(400.0), decay=4.0)
>>> primitive.rollout(step=0.001, goal=goals).position                       # goals (1000, d): 1000 movements at once
>>> online = primitive.online(step=0.001); online.step(coupling=force)       # the same, one step at a time
"""

from .demonstration import Demonstration
from .dmp import DMP, OnlineDMP, Propagator, Scaling, Trajectory, forcing_target
from .incremental import Blocks, ExtendedKernels, extend, extend_styles, interpolate, original
from .kernels import FeatureMap, GaussianKernels, TruncatedKernels, phase
from .pseudo_inverse import GrowingRegression, extended_pseudo_inverse
from .regression import least_squares, locally_weighted
from .transformation import SpringDamper, Step, exact, runge_kutta, semi_implicit

__all__ = [
    "DMP",
    "Blocks",
    "Demonstration",
    "ExtendedKernels",
    "FeatureMap",
    "GaussianKernels",
    "GrowingRegression",
    "OnlineDMP",
    "Propagator",
    "Scaling",
    "SpringDamper",
    "Step",
    "Trajectory",
    "TruncatedKernels",
    "exact",
    "extend",
    "extend_styles",
    "extended_pseudo_inverse",
    "forcing_target",
    "interpolate",
    "least_squares",
    "locally_weighted",
    "original",
    "phase",
    "runge_kutta",
    "semi_implicit",
]
