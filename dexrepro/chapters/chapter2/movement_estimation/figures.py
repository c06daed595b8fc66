"""What ``movement_estimation`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import numpy as np

from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Recordings, changed
from dexrepro.report import style

FIGURES = {
    "2.6": Figure(
        "Contact force f_x on the assistive follower for three stiffnesses, initial estimate 30 N/m (Case 1; the "
        "book shows the same). Simulated: two planar arms, partner moving with a period of 20 s along the line.",
        "Contact force over time for three stiffnesses, with the desired force.",
    ),
    "2.7": Figure(
        "Estimated and true rest position, their difference and the force error for three periods of the partner's "
        "movement (Case 2). The estimate keeps the offset f_d (1/khat - 1/k_o), dashed, which vanishes only with f_d. "
        "The small sawtooth at sigma = 10 s has the period of the estimator's window, which is ours; dotted: time "
        "counted from the start, as printed, with rates that this allows.",
        "Estimated and true rest position, their difference and the force error over time for three periods.",
    ),
}
UNITS = {"reference": "m", "rest_position": "m", "estimate": "m, N/m, m/s"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figures = {}
    plain = [case for case in recordings if changed(config.cases[case], config) <= {"stiffness", "period"}]
    periods = [case for case in plain if config.cases[case].period in np.atleast_1d(config.period)]
    if stiffnesses := [case for case in plain if case not in periods]:
        figures["2.6"] = _draw_forces(stiffnesses, recordings, metrics, config)
    if periods:
        figures["2.7"] = _draw_estimates(periods, recordings, metrics, config)
    return figures


def _draw_forces(cases: list[str], recordings: Recordings, metrics: Any, config: Config) -> Drawing:
    figure, axes = style.subplots(width=style.TWO_COLUMNS, height=2.2)
    inset = axes.inset_axes((0.3, 0.3, 0.45, 0.55))
    lines = [style.LINES[name] for name in ("book", "extra1", "rival", "extra2", "plain")]
    for line, case in zip(lines, cases):
        time, force = recordings[case].time, recordings[case]["follower.force"][:, 0]
        axes.plot(time, force, label=f"$k_o$ = {config.cases[case].stiffness:g} N/m", **line)
        inset.plot(time[time <= 3], force[time <= 3], **line)
    for panel in (axes, inset):
        panel.axhline(config.desired_force, label="$f_{x,d}$", **style.LINES["reference"])
    inset.set(title="first 3 s")
    axes.set(xlabel="Time [s]", ylabel="Contact force $f_x$ [N]")
    axes.legend(loc="center right")
    slowest = max(metrics[case]["settling_time"] for case in cases)
    finding = f"The force is within 5 % of the desired one after {slowest:.2f} s, whatever the stiffness"
    return style.title(figure, finding)


def _draw_estimates(cases: list[str], recordings: Recordings, metrics: Any, config: Config) -> Drawing:
    figure, grid = style.subplots(3, len(cases), height=4.6, sharex=True, sharey="row", squeeze=False)
    for column, case in zip(grid.T, cases):
        recording, parameters = recordings[case], config.cases[case]
        offset = parameters.desired_force * (1 / recording["estimate"][:, 1] - 1 / parameters.stiffness)
        column[0].plot(recording.time, recording["estimate"][:, 0], label="estimate", **style.LINES["book"])
        column[0].plot(recording.time, recording["rest_position"], label="true", **style.LINES["reference"])
        variants = {
            "window": (recording, "book"),
            "printed time": (recordings.get(f"printed{parameters.period:g}"), "printed"),
        }
        for label, (run, line) in variants.items():
            if run is not None:
                difference = 1e3 * (run["estimate"][:, 0] - run["rest_position"])
                column[1].plot(run.time, difference, label=label, **style.LINES[line])
                column[2].plot(run.time, run["object.force"] - parameters.desired_force, **style.LINES[line])
        column[1].plot(recording.time, 1e3 * offset, label="predicted offset", **style.LINES["reference"])
        column[0].set_title(rf"$\sigma$ = {parameters.period:g} s")
        column[1].set_ylim(0, 16)
        column[2].set_ylim(-0.15, 0.15)
    style.edges(grid, "Time [s]", ("$\\hat x_c$, $x_c$ [m]", "$\\hat x_c - x_c$ [mm]", "$\\|F\\| - f_d$ [N]"))
    grid[0, -1].legend(loc="lower left")
    grid[1, -1].legend(loc="upper right")
    offsets = [
        1e3 * metrics[case]["estimation_error"] for case in cases if metrics[case]["estimation_error"] is not None
    ]
    found = f" but for the {np.mean(offsets):.1f} mm that the wrong stiffness explains" if offsets else ""
    return style.title(figure, f"The estimate follows the partner{found}")
