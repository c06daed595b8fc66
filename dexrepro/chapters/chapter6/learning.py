"""Skills of this chapter: averaged demonstrations learned by primitives, constrained about a reference."""

from __future__ import annotations

import numpy as np
from scipy.signal import savgol_filter

from dexrepro.arrays import Array
from dexrepro.experiment import Config
from dexrepro.primitives.barrier import Constraint, Gains
from dexrepro.primitives.constrained import LAWS, Law, Path, Reference, Skill, rollout, safety_filter
from dexrepro.primitives.demonstration import Demonstration
from dexrepro.primitives.dmp import DMP, Trajectory
from dexrepro.primitives.kernels import GaussianKernels
from dexrepro.primitives.transformation import SpringDamper


def learn(time: Array, path: Array, dmp: Config) -> DMP:
    """Primitive of (6.1)-(6.5) for a path (n, d): alpha_z, beta_z = alpha_z / 4, least squares with a ridge.

    ``dmp.tau`` is the time constant [s]; null means the duration of the path.
    """
    smooth = savgol_filter(path, dmp.smoothing, 3, axis=0)
    smooth[[0, -1]] = path[[0, -1]]
    duration = time[-1] - time[0]
    tau = duration if dmp.tau is None else dmp.tau
    kernels = GaussianKernels.spaced(dmp.kernels, dmp.gamma * duration / tau)
    demonstration = Demonstration.of(time - time[0], smooth, at_rest=False)
    return DMP.fit(demonstration, kernels, spring(dmp), dmp.gamma, time_constant=tau, ridge=dmp.ridge)


def spring(dmp: Config) -> SpringDamper:
    """alpha_z and beta_z as stiffness and damping."""
    return SpringDamper(dmp.alpha_z * dmp.beta_z, dmp.alpha_z)


def nominal(primitives: list[DMP], durations: Array, steps: int) -> list[Trajectory]:
    """Unconstrained movements of each primitive over its duration, in ``steps`` equal steps."""
    return [p.rollout(t / steps, horizon=t) for p, t in zip(primitives, durations)]


def skill(primitives: list[DMP], movements: list[Trajectory]) -> Skill:
    """What the constrained rollout needs of several primitives as one batch: runs along axis 1."""
    tau = np.array([[p.time_constant] for p in primitives])
    return Skill(
        forcing=np.stack([p.forcing(m.time) for p, m in zip(primitives, movements)], axis=1),
        goal=np.stack([p.goal for p in primitives]),
        time_constant=tau,
        system=primitives[0].system,
        nominal=np.stack([m.acceleration for m in movements], axis=1) * tau,
    )


def stack(references: list[Reference]) -> Reference:
    """References of several runs as one batch along axis 1."""
    return Reference(
        np.stack([r.position for r in references], axis=1),
        np.stack([r.velocity for r in references], axis=1),
        np.stack([r.acceleration for r in references], axis=1),
    )


def law(cdmp: Config) -> Law:
    """The law that a configuration names; the filter with its rates."""
    return safety_filter(tuple(cdmp.filter_rates)) if cdmp.law == "filter" else LAWS[cdmp.law]


def gains(cdmp: Config) -> Gains:
    return Gains(cdmp.kz, cdmp.dz, cdmp.k2)


def tube(cdmp: Config, margin: float | Array) -> Constraint:
    """(6.23): the path stays within the margin h of its reference.

    ``bound_scaling`` "scaled": H = k_z h, "printed": H = h (E6.01); ``weight`` of the barrier: "one" (printed), "h2"
    (H^2) or "off".
    """
    bound = np.asarray(margin) * (cdmp.kz if scaled(cdmp) else 1.0)
    return Constraint(True, bound, weight=weight(cdmp, bound))


def scaled(cdmp: Config) -> bool:
    """Whether the bounds are those of x^c - x, H = k_z h."""
    return bool(cdmp.bound_scaling == "scaled")


def weight(cdmp: Config, bound: float | Array) -> float | Array:
    """Factor of the barrier for a bound H."""
    return {"one": 1.0, "h2": bound**2, "off": 0.0}[cdmp.weight]


def constrained(
    s: Skill, reference: Reference, cdmp: Config, dt: float | Array, velocity: Array, offset: float | Array = 0.0
) -> Path:
    """The constrained movement from ``offset`` [cm] off the reference's start, at a scaled velocity tau dx/dt."""
    projection = cdmp.projection_rate if cdmp.projection else None
    start = reference.position[0] + offset
    return rollout(s, reference, tube(cdmp, cdmp.margin), gains(cdmp), law(cdmp), dt, start, velocity, projection)
