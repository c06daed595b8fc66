"""What ``scene`` shows: its figures and tables."""

from __future__ import annotations

import numpy as np
import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings
from dexrepro.report import style
from dexrepro.report.tables import by_case

from .experiment import distance

FIGURES = {
    "own.A": Figure("Path of the end point, its distance from where it should be, and the force along the line.")
}
UNITS = {"reference": "m", "leader.pose": "m", "force_along": "N", "wall": "N", "push": "N"}
TABLES = {"own.T": "Tracking, force and torque of every case"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figure, (plan, error, force) = style.subplots(1, 3, height=2.5)
    ranges = np.ptp(np.vstack([run["arm.tip"] for run in recordings.values()]), axis=0)
    across, up = sorted(np.argsort(-ranges, kind="stable")[:2])
    kinds = [kind for kind in style.LINES if kind not in ("reference", "printed")]
    for index, (case, run) in enumerate(recordings.items()):
        line = style.LINES[kinds[index % len(kinds)]]
        plan.plot(run["arm.tip"][:, across], run["arm.tip"][:, up], label=case, **line)
        error.plot(run.time, 1e3 * distance(run, config.cases[case]), **line)
        force.plot(run.time, run["force_along"], **line)
    first, case = next(iter(recordings.values())), next(iter(config.cases.values()))
    goal = first["leader.pose"] + np.array(case.offset)
    plan.plot(goal[:, across], goal[:, up], label="leader + offset", **style.LINES["reference"])
    if case.desired_force is not None:
        force.axhline(case.desired_force, **style.LINES["reference"])
    plan.set(xlabel=f"{'xyz'[across]} [m]", ylabel=f"{'xyz'[up]} [m]", aspect="equal")
    plan.set_adjustable("datalim")
    error.set(xlabel="Time [s]", ylabel="Distance [mm]")
    force.set(xlabel="Time [s]", ylabel="Force along the line [N]")
    style.panels((plan, error, force), "path", "off leader + offset", "force")
    figure.legend(loc="outside lower center", ncols=5)
    best = {
        f"{text}, {scale * min(values.values()):.3g} {unit} RMS": min(values, key=lambda name: values[name])
        for key, text, scale, unit in (
            ("rmse", "stays closest", 1e3, "mm"),
            ("force_rmse", "holds the force best", 1, "N"),
        )
        if (values := {case: float(m[key]) for case, m in metrics.items() if m[key] is not None})  # type: ignore[arg-type]
    }
    style.title(figure, f"{config.name}: " + "; ".join(f"{case} {text}" for text, case in best.items()))
    return {"own.A": figure}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    names = {
        "rmse": "RMSE [m]",
        "peak_distance": "largest distance [m]",
        "force_rmse": "force RMSE [N]",
        "force_peak": "largest force [N]",
        "saturated": "share of time at a torque limit",
    }
    table = by_case(metrics, names, recordings, told=lambda case: {"law": config.cases[case].law["_target_"]})
    return {"own.T": table.assign(status=[run.status for run in recordings.values()])}
