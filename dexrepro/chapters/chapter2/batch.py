"""The planar comparison for hundreds of runs at once: what the sensitivity table and the gain search are made of."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from dexrepro.control.force_control import ForceControl, IntegralForceControl
from dexrepro.control.holding_line import HoldingLineRegulation
from dexrepro.control.holding_reference import ImpedanceReference
from dexrepro.control.movement_estimation import MovementEstimation
from dexrepro.control.passive_impedance import PassiveImpedance
from dexrepro.physics.planar_batch import PlanarPairs
from dexrepro.robots.planar_chain import PlanarChain

Array = NDArray[np.float64]

# Runs whose law differs in structure (not in a number) are stepped in separate groups.
STRUCTURE = ("law", "window", "velocity", "order", "implicit")


def simulate_runs(
    runs: pd.DataFrame, config: Any, *, edges: Sequence[float], noise: np.random.Generator | None = None
) -> pd.DataFrame:
    """Simulate one planar pair for every row of ``runs`` and reduce its force error.

    runs: one row a run, one column a setting (see ``default_run``). edges: instants [s] that part the run.
    noise: draws the force noise of the runs whose ``noise`` is not 0.
    Returns, row by row, the mean square ``square_k`` and the mean ``mean_k`` of ||F|| - f_d [N] in the k-th part, and
    ``lost``, the share of time without contact. A run that diverged has NaN.
    """
    order = runs.sort_values(list(STRUCTURE), kind="stable", na_position="last")
    with np.errstate(all="ignore"):
        result = _loop(order, config, np.asarray(edges), noise)
    result.index = order.index
    return result.loc[runs.index]


def _loop(runs: pd.DataFrame, config: Any, edges: Array, noise: np.random.Generator | None) -> pd.DataFrame:
    dt, arm = config.dt, config.arm
    p = {name: column.to_numpy() for name, column in runs.items()}
    chain = PlanarChain(arm.lengths, arm.masses, (np.array(config.bases)[:, :1], 0.0), np)
    start = np.stack([np.repeat(np.array(config.poses[name])[:, None], len(runs), 1) for name in ("leader", "b")], 1)
    plant = PlanarPairs(
        chain,
        start,
        stiffness=p["object_stiffness"],
        rest_length=p["rest_length"],
        dt=dt,
        unilateral=p["unilateral"].astype(bool),
    )
    kp = np.array(arm.stiffness)[:, None, None] * p["kp_scale"]
    kd = np.array(arm.damping)[:, None, None] * p["kd_scale"]
    gravity = np.where(p["gravity"], 9.81, 0.0)
    laws = _laws(runs, dt)
    regulation = HoldingLineRegulation(gain=p["regulation"])
    (x, y), force, _ = plant.contact()
    home_x, home_y = x.copy(), y.copy()
    for part, law in laws:
        law.reset(x[1, part].copy())
    joints, before = tuple(start.copy()), start
    squares, sums = np.zeros((len(edges) - 1, len(runs))), np.zeros((len(edges) - 1, len(runs)))
    lost, reference = np.zeros(len(runs)), np.zeros(len(runs))
    steps, parts = (
        round(edges[-1] / dt),
        np.searchsorted(np.round(edges[1:] / dt), np.arange(round(edges[-1] / dt)), "right"),
    )
    for i in range(steps):
        time = i * dt
        (x, y), force, magnitude = plant.contact()
        error = magnitude - p["desired_force"]
        squares[parts[i]] += error * error
        sums[parts[i]] += error
        lost += magnitude <= 0
        measured = force if noise is None else force + p["noise"] * noise.standard_normal(force.shape)
        for part, law in laws:
            reference[part] = law(x[1, part], measured[0, part])
        np.clip(reference, *config.workspace, out=reference)
        swing = config.amplitude * math.sin(2 * math.pi / config.period * time)
        first = p["trajectory"] == 1
        leader_x = home_x[0] + np.where(first, swing, config.drift * time)
        leader_y = home_y[0] + np.where(first, 0.0, swing)
        follower_y = home_y[1] + regulation(measured[1])
        joints = chain.approach(
            joints, (np.stack((leader_x, reference)), np.stack((leader_y, follower_y))), config.ik_damping
        )
        wanted = np.array(joints)
        torque = kp * (wanted - plant.position) - kd * plant.velocity
        if p["velocity_reference"].any():
            torque += kd * p["velocity_reference"] * (wanted - before) / dt
            before = wanted
        if gravity.any():
            torque -= np.array(chain.gravity(plant.position, gravity))
        cancel = np.stack((-measured, measured), axis=1) * p["compensation"]
        torque -= np.array(chain.tip_torque(plant.position, cancel))
        plant.step(torque, force)
    counts = np.bincount(parts, minlength=len(edges) - 1)[:, None]
    columns = {f"square_{k}": row for k, row in enumerate(squares / counts)}
    columns |= {f"mean_{k}": row for k, row in enumerate(sums / counts)}
    return pd.DataFrame(columns | {"lost": lost / steps})


def _laws(runs: pd.DataFrame, dt: float) -> list[tuple[slice, Any]]:
    """The law of every group of structurally equal, adjacent runs."""
    laws, start = [], 0
    for _, rows in runs.groupby(list(STRUCTURE), sort=False, dropna=False):
        part = slice(start, start + len(rows))
        laws.append((part, BUILDERS[rows["law"].iloc[0]](rows, dt)))
        start = part.stop
    return laws


def _force(rows: pd.DataFrame, dt: float) -> ForceControl:
    return ForceControl(gain=rows["force_gain"].to_numpy(), desired_force=rows["desired_force"].to_numpy())


def _integral(rows: pd.DataFrame, dt: float) -> IntegralForceControl:
    return IntegralForceControl(
        rate=rows["force_rate"].to_numpy(), desired_force=rows["desired_force"].to_numpy(), dt=dt
    )


def _passive(rows: pd.DataFrame, dt: float) -> PassiveImpedance:
    p = {name: rows[name].to_numpy() for name in ("passive_mass", "passive_damping", "desired_force")}
    return PassiveImpedance(
        mass=p["passive_mass"], damping=p["passive_damping"], desired_force=p["desired_force"], dt=dt
    )


def _estimated(rows: pd.DataFrame, dt: float) -> ImpedanceReference:
    p = {name: column.to_numpy() for name, column in rows.items()}
    first = rows.iloc[0]
    order = int(first["order"])
    zero = np.zeros(len(rows))
    estimation = MovementEstimation(
        stiffness=p["initial_stiffness"],
        coefficients=[p["initial_rest"], *[zero] * (order - 1)],
        rates=[p[f"rate_{j}"] for j in range(1, order + 2)],
        dt=dt,
        window=None if math.isnan(first["window"]) else float(first["window"]),
        implicit=bool(first["implicit"]),
        velocity=str(first["velocity"]),
    )
    return ImpedanceReference(
        estimation=estimation,
        mass=p["mass"],
        damping=p["damping"],
        stiffness=p["stiffness"],
        desired_force=p["desired_force"],
        smoothing_rate=float(first["smoothing_rate"]),
        smoothing_power=float(first["smoothing_power"]),
        dt=dt,
    )


BUILDERS: Mapping[str, Callable[[pd.DataFrame, float], Any]] = {
    "force": _force,
    "force_integral": _integral,
    "passive_impedance": _passive,
    "estimated": _estimated,
}
