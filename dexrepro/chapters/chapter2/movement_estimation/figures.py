"""What ``movement_estimation`` shows: its figures and tables."""

from __future__ import annotations

from itertools import cycle
from typing import Any

import numpy as np

from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Recordings, changed
from dexrepro.report import style

FIGURES = {
    "2.6": Figure(
        "Contact force f_x on the assistive follower for objects of several stiffnesses, initial estimate "
        "{.law.estimation.stiffness:g} N/m (Case 1; the book shows the same). Simulated: two planar arms, partner "
        "moving with period sigma along the line.",
        "Contact force over time for each stiffness, with the desired force.",
    ),
    "2.7": Figure(
        "Estimated and true rest position, their difference and the force error, one column for each period of the "
        "partner's movement (Case 2). The estimate keeps the offset f_d (1/khat - 1/k_o), dashed, which vanishes only "
        "with f_d. The sawtooth, larger for a faster partner, has the period of the estimator's window, "
        "{.law.estimation.window:g} s, which is ours; dotted: time counted from the start, as printed, with rates that "
        "this allows.",
        "Estimated and true rest position, their difference and the force error over time, for each period.",
    ),
}
SHOWN_FROM = 2.0  # s, from here on nothing is cut off
UNITS = {"reference": "m", "rest_position": "m", "estimate": "m, N/m, m/s"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figures = {}
    plain = [case for case in recordings if changed(config.cases[case], config) <= {"stiffness", "period"}]
    stiffnesses = _of_one_period(plain, config)
    if stiffnesses:
        figures["2.6"] = _draw_forces(stiffnesses, recordings, metrics, config)
    if periods := [case for case in plain if case not in stiffnesses]:
        figures["2.7"] = _draw_estimates(periods, recordings, metrics, config)
    return figures


def _of_one_period(cases: list[str], config: Config) -> list[str]:
    """One case for each stiffness at the period that most cases share; none where each has a listed one of its own."""
    periods = [config.cases[case].period for case in cases]
    rank = {period: (periods.count(period), period not in np.atleast_1d(config.period)) for period in periods}
    shared = max(rank, key=lambda period: rank[period], default=None)
    if shared is None or rank[shared] == (1, False):
        return []
    return list({config.cases[case].stiffness: case for case in reversed(cases)
                 if config.cases[case].period == shared}.values())[::-1]  # fmt: skip


def _draw_forces(cases: list[str], recordings: Recordings, metrics: Any, config: Config) -> Drawing:
    figure, axes = style.subplots(width=style.TWO_COLUMNS, height=2.2)
    inset = axes.inset_axes((0.3, 0.3, 0.45, 0.55))
    lines = [style.LINES[name] for name in ("book", "extra1", "rival", "extra2", "plain")]
    for line, case in zip(cycle(lines), cases):
        time, force = recordings[case].time, recordings[case]["follower.force"][:, 0]
        axes.plot(time, force, label=f"$k_o$ = {config.cases[case].stiffness:g} N/m", **line)
        inset.plot(time[time <= 3], force[time <= 3], **line)
    for panel in (axes, inset):
        panel.axhline(config.desired_force, label="$f_{x,d}$", **style.LINES["reference"])
    inset.set(title="first 3 s")
    axes.set(xlabel="Time [s]", ylabel="Contact force $f_x$ [N]")
    axes.legend(loc="center right", title=rf"$\sigma$ = {config.cases[cases[0]].period:g} s", title_fontsize=7)
    slowest = max(metrics[case]["settling_time"] for case in cases)
    finding = f"The force is within 5 % of the desired one after {slowest:.2f} s, whatever the stiffness"
    return style.title(figure, finding)


def _draw_estimates(cases: list[str], recordings: Recordings, metrics: Any, config: Config) -> Drawing:
    figure, grid = style.subplots(3, len(cases), height=4.6, sharex=True, sharey="row", squeeze=False)
    several = len({config.cases[case].stiffness for case in cases}) > 1
    late: tuple[list[float], list[float]] = ([0.0], [0.0])  # differences [mm] and force errors [N]
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
                error = run["object.force"] - parameters.desired_force
                for ax, values, shown in zip(column[1:], (difference, error), late):
                    ax.plot(run.time, values, label=label, **style.LINES[line])
                    shown += values[run.between(SHOWN_FROM)].tolist()
        column[1].plot(recording.time, 1e3 * offset, label="predicted offset", **style.LINES["reference"])
        stiffness = f", $k_o$ = {parameters.stiffness:g} N/m" if several else ""
        column[0].set_title(rf"$\sigma$ = {parameters.period:g} s{stiffness}")
    widest = max(0.15, 1.1 * float(np.abs(late[1]).max()))
    grid[1, 0].set_ylim(1.1 * min(late[0]), max(16, 1.1 * max(late[0])))
    grid[2, 0].set_ylim(-widest, widest)
    style.edges(grid, "Time [s]", ("$\\hat x_c$, $x_c$ [m]", "$\\hat x_c - x_c$ [mm]", "$\\|F\\| - f_d$ [N]"))
    grid[0, -1].legend(loc="lower left")
    grid[1, -1].legend(loc="upper right")
    offsets, rest = (
        [1e3 * value for case in cases if (value := metrics[case][name]) is not None]
        for name in ("estimation_error", "residual")
    )
    found = f"The estimate follows the partner but for the {np.mean(offsets):.1f} mm the wrong stiffness explains, to "
    return style.title(
        figure, f"{found}{style.at_most(max(rest), 1)} mm" if offsets and rest else "The estimate and the partner"
    )
