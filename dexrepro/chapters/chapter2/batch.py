"""The planar comparison for hundreds of runs at once: what the sensitivity table and the gain search are made of."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Array
from dexrepro.control.contract import Measured
from dexrepro.control.force_control import ForceControl, IntegralForceControl
from dexrepro.control.holding_line import HoldingLineRegulation
from dexrepro.control.holding_reference import ImpedanceReference
from dexrepro.control.movement_estimation import MovementEstimation
from dexrepro.control.passive_impedance import PassiveImpedance
from dexrepro.physics.planar_batch import PlanarPairs
from dexrepro.robots.planar import PlanarChain

SPIN = 200.0  # rad/s, a joint faster than this has lost control whatever the force
Rows = list[dict[str, Any]]

# Runs whose law differs in structure (not in a number) are stepped in separate groups.
STRUCTURE = ("law", "window", "velocity", "implicit")


def table_rows(setting: Mapping[str, Any], laws: Sequence[str] | None = None) -> Rows:
    """The runs s1 ... s18 of Table 2.1 under a setting (columns as in the configuration's ``run``).

    laws: only the runs of these controllers ("force", "passive_impedance", "no_impedance", "impedance").
    """
    rows, number = [], 0
    groups = (
        (("force", "passive_impedance", "no_impedance", "impedance"), 1, 1.0),
        (("passive_impedance", "no_impedance", "impedance"), 2, 1.0),
        (("no_impedance", "impedance"), 2, 7.0),
    )
    for controllers, trajectory, force in groups:
        for controller, regulated in itertools.product(controllers, (False, True)):
            number += 1
            if laws is None or controller in laws:
                row = {**setting, "trajectory": trajectory, "desired_force": force, "run": f"s{number}"}
                rows.append(controlled_by(controller, row if regulated else row | {"regulation": 0.0}))
    return rows


def controlled_by(controller: str, row: Mapping[str, Any]) -> dict[str, Any]:
    """A run's settings with one of the compared controllers; NoIm is Im without mass and damping."""
    if controller == "impedance":
        return {**row, "law": "estimated"}
    if controller == "no_impedance":
        return {**row, "law": "estimated", "mass": 0.0, "damping": 0.0}
    law = row.get("law_of_force", controller) if controller == "force" else controller
    return {**row, "law": law, "window": None, "velocity": "", "order": 0, "implicit": False}


def simulate_runs(
    runs: pd.DataFrame, config: Any, *, edges: Sequence[float], noise: np.random.Generator | None = None
) -> pd.DataFrame:
    """Simulate one planar pair for every row of ``runs`` and reduce its force error.

    runs: one row a run, one column a setting (those of ``run`` in the chapter's configuration).
    edges: instants [s] that part the run.
    noise: draws the force noise of the runs whose ``noise`` is not 0.
    Returns, row by row, the mean square ``square_k`` and the mean ``mean_k`` of ||F|| - f_d [N] in the k-th part, and
    ``lost``, the share of time without contact. A run that diverged has NaN.
    """
    order = runs.astype({"window": float}).sort_values(list(STRUCTURE), kind="stable", na_position="last")
    with np.errstate(all="ignore"):
        result = _loop(order, config, np.asarray(edges), noise)
    result.index = order.index
    return result.loc[runs.index]


def _loop(runs: pd.DataFrame, config: Any, edges: Array, noise: np.random.Generator | None) -> pd.DataFrame:
    dt = config.step
    p = {str(name): column.to_numpy() for name, column in runs.items()}
    plant = _plant(p, config)
    chain = plant.chain
    kp = np.array(config.arm.stiffness)[:, None, None] * p["kp_scale"]
    kd = np.array(config.arm.damping)[:, None, None] * p["kd_scale"]
    heavy, leads = np.flatnonzero(p["gravity"]), bool(p["velocity_reference"].any())
    lead = kd * p["velocity_reference"] / dt
    laws, regulation = grouped_laws(runs, dt), HoldingLineRegulation(gain=p["regulation"])
    home_x, home_y = plant.contact()[0]
    low, high = config.follower.workspace
    for part, law in laws:
        law.reset(at(home_x[1, part], 0.0))
    joints: Any = tuple(plant.position)
    wanted = plant.position.copy()
    first, swing_rate = p["trajectory"] == 1, 2 * math.pi / config.period
    parts = np.searchsorted(np.round(edges[1:] / dt), np.arange(round(edges[-1] / dt)), "right")
    squares, sums = np.zeros((len(edges) - 1, len(runs))), np.zeros((len(edges) - 1, len(runs)))
    lost, reference, spun = np.zeros(len(runs)), np.zeros(len(runs)), np.zeros(len(runs), dtype=bool)
    for i, part_index in enumerate(parts):
        (x, _), force, magnitude = plant.contact()
        error = magnitude - p["desired_force"]
        squares[part_index] += error * error
        sums[part_index] += error
        lost += magnitude <= 0
        measured = force if noise is None else force + p["noise"] * noise.standard_normal((2, 1))
        for part, law in laws:
            reference[part] = law(at(x[1, part], measured[0, part]))
        np.minimum(np.maximum(reference, low, out=reference), high, out=reference)
        swing = config.leader.amplitude * math.sin(swing_rate * i * dt)
        leader_x = home_x[0] + np.where(first, swing, config.leader.drift * i * dt)
        leader_y = home_y[0] + np.where(first, 0.0, swing)
        follower_y = home_y[1] + regulation(measured[1])
        target = np.array((leader_x, reference)), np.array((leader_y, follower_y))
        joints, before = chain.approach(joints, target, config.arm.ik_damping), wanted
        wanted = np.array(joints)
        torque = kp * (wanted - plant.position) - kd * plant.velocity
        if leads:
            torque += lead * (wanted - before)
        if heavy.size:
            torque[..., heavy] -= np.array(chain.gravity(plant.position[..., heavy]))
        plant.step(torque, force, measured * p["compensation"])
        if i % 20 == 0:
            spun |= ~(np.abs(plant.velocity).max(axis=(0, 1)) < SPIN)
    squares[:, spun] = np.nan
    counts = np.bincount(parts, minlength=len(edges) - 1)[:, None]
    columns = {f"square_{k}": row for k, row in enumerate(squares / counts)}
    columns |= {f"mean_{k}": row for k, row in enumerate(sums / counts)}
    return pd.DataFrame(columns | {"lost": lost / len(parts)})


def _plant(p: Mapping[str, Any], config: Any) -> PlanarPairs:
    """The arms of all runs in the printed poses; arm 0 leads, arm 1 follows."""
    bases = np.array([[config.leader.base[0]], [config.follower.base[0]]])
    chain = PlanarChain(config.arm.lengths, config.arm.masses, (bases, 0.0), np)
    start = np.array([config.leader.pose, config.follower.pose]).T + config.perturbation
    return PlanarPairs(
        chain,
        np.repeat(start[:, :, None], len(p["law"]), axis=2),
        stiffness=p["object_stiffness"],
        rest_length=p["rest_length"],
        dt=config.step,
        unilateral=p["unilateral"].astype(bool),
    )


def at(position: Any, force: Any) -> Measured[Any]:
    """What a holding law that needs neither time nor velocity is told: position [m] and force [N]."""
    return Measured(math.nan, position, math.nan, force)


def grouped_laws(runs: pd.DataFrame, dt: float) -> list[tuple[slice, Any]]:
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
    order = int(p["order"].max())
    zero = np.zeros(len(rows))
    estimation = MovementEstimation(
        stiffness=p["initial_stiffness"],
        coefficients=[p["initial_rest"], *[zero] * (order - 1)],
        # A run of lower order is one whose further coefficients start at zero and stay there.
        rates=[np.where(j <= p["order"] + 1, p[f"rate_{j}"], 0.0) for j in range(1, order + 2)],
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
