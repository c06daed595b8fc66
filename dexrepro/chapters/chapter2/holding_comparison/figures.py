"""What ``holding_comparison`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter2.holding_comparison.experiment import SETTLED
from dexrepro.chapters.chapter2.measures import gains, shown
from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Recordings
from dexrepro.report import style
from dexrepro.report.tables import by_case

FIGURES = {
    "2.8": Figure(
        "Holding force of s1 to s18 of Table 2.1, solid with the regulation (2.8), dashed without, and the root mean "
        "square of the force error over the second period (from {.period:g} s). Curves that leave a "
        "panel are cut; the number at its top is the largest force. The book shows the time histories; its panel (a) "
        "is the first two here.",
        "Holding forces of eighteen simulations over time in four groups, with bars of their errors.",
    ),
    "2.A": Figure(
        "The two estimating laws against each other, on both trajectories: the reference tracked by the joint PD, with "
        "and without (2.8), by an arm that realises the target impedance (2.25), and by the joint PD with velocity "
        "estimates as printed (2.12) or from the total derivative (Traj. 1 alone); and all laws with gains tuned under "
        "one search budget. Not in the book.",
        "Bars of the force error of two laws in several settings on two trajectories, and errors with tuned gains.",
    ),
}
UNITS = {"reference": "m", "estimate": "m, N/m, m/s"}
TABLES = {"T2.1": "The eighteen simulations of Table 2.1 with their force errors, and our further rows"}

NAMES = {
    "force": "F",
    "force_integral": "F (integral)",
    "passive_impedance": "PIm",
    "passive_told": "PIm, told as much as NoIm",
    "no_impedance": "NoIm",
    "impedance": "Im",
}
LINES = {"force": "plain", "passive_impedance": "rival", "no_impedance": "extra1", "impedance": "book"}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    def told(case: str) -> dict[str, Any]:
        its = config.cases[case]
        return {"controller": _name(case, its), "trajectory": its.leader.trajectory,
                "regulation (2.8)": "yes" if its.follower.regulation else "no", "f_d [N]": its.desired_force,
                "gains": gains(its, config), "realisation": its.realisation}  # fmt: skip

    late = f"[{SETTLED:g}, {config.duration:g}] s [N]"
    columns = {f"rmse_{start}": f"RMSE [{start}, {config.duration:g}] s [N]" for start in (0, 5, 10)}
    columns |= {"rmse": f"RMSE {late}", "mean_error": f"mean error {late}", "largest_error": f"largest error {late}",
                "lost": "share of time without contact",
                "bounded": "share of time at the workspace bounds"}  # fmt: skip
    return {"T2.1": by_case(metrics, columns, recordings, "no", told)}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figures = {}
    if {f"s{n}" for n in range(1, 19)} <= set(recordings):
        figures["2.8"] = _draw_histories(recordings, metrics, config)
    if {f"s{n}" for n in (5, 6, 7, 8)} <= set(recordings):
        figures["2.A"] = _draw_settings(metrics, config)
    return figures


def _name(case: str, parameters: Config) -> str:
    """The controller of a case; one with a law of its own goes by the name of the case."""
    return case if parameters.law else NAMES[parameters.controller]


def _alike(one: Config, other: Config) -> bool:
    """Whether two cases share the leader's trajectory and the desired force."""
    return (one.leader.trajectory, one.desired_force) == (other.leader.trajectory, other.desired_force)


def _draw_histories(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawing:
    figure, grid = style.subplots(4, 2, height=6.9, width_ratios=(3, 1))
    groups = {"a": range(1, 3), "b": range(3, 9), "c": range(9, 15), "d": range(15, 19)}
    limits = {"a": (-0.2, 6), "b": (0.6, 1.6), "c": (0.6, 1.6), "d": (2, 10)}
    texts = {"a": "s1, s2: force control, Traj. 1", "b": "s3 to s8, Traj. 1", "c": "s9 to s14, Traj. 2"}
    texts["d"] = f"s15 to s18, {config.cases['s15'].desired_force:g} N"
    for (histories, bars), (letter, numbers) in zip(grid, groups.items()):
        cases = [f"s{n}" for n in numbers]
        like = config.cases[cases[0]]
        own = [case for case, its in config.cases.items() if its.law and letter != "a" and _alike(its, like)]
        for case in cases + own:
            parameters, run = config.cases[case], recordings[case]
            look = dict(style.LINES["extra2" if parameters.law else LINES[parameters.controller]])
            look["linestyle"] = "-" if parameters.follower.regulation else (0, (4, 2))
            name = _name(case, parameters) if parameters.follower.regulation or parameters.law else None
            histories.plot(run.time, run["object.force"], label=name, **look)
            bars.barh(case, shown(metrics[case]["rmse"]), color=look["color"], alpha=1 if name else 0.45)
        most = max(float(recordings[case]["object.force"].max()) for case in cases + own)
        if most > limits[letter][1]:
            histories.annotate(f"↑ {most:.1f} N", (0.16, 0.97), xycoords="axes fraction", va="top", fontsize=7)
        histories.axhline(config.cases[cases[0]].desired_force, **style.LINES["reference"])
        histories.set(ylabel="$\\|F\\|$ [N]", ylim=limits[letter])
        style.panel(histories, letter.strip(), texts[letter])
        histories.legend(loc="upper right", ncols=4)
        bars.set(xscale="log", xlim=(1e-3, 5))
        bars.invert_yaxis()
        bars.set_title(f"RMSE from {SETTLED:g} s")
    looks = {"with (2.8), bars full": "-", "without (2.8), bars pale": (0, (4, 2))}
    style.legend_below(figure, {name: {"color": style.REFERENCE, "linestyle": line} for name, line in looks.items()})
    grid[-1, 0].set_xlabel("Time [s]")
    grid[-1, 1].set_xlabel("RMSE [N]")
    mean, largest = (
        style.at_most(100 * max(shown(metrics[case][key]) / config.cases[case].desired_force for case in ESTIMATING), 1)
        for key in ("rmse", "largest_error")
    )
    return style.title(
        figure,
        f"With (2.8) and estimation the force errs by up to {mean} % rms, {largest} % at most (from {SETTLED:g} s)",
    )


CONTROLS = ("integral_1", "integral_2")  # tuned more finely than the search that the tuned laws share
ESTIMATING = ("s6", "s8", "s12", "s14", "s16", "s18")  # with the regulation (2.8)
SETTINGS = {  # NoIm and Im on either trajectory
    1: {
        "joint PD": ("s6", "s8"),
        "joint PD,\nno (2.8)": ("s5", "s7"),
        "arm of\n(2.25)": ("impedance_6", "impedance_8"),
        "(2.12) as\nprinted": ("printed_6", "printed_8"),
        "total\nderivative": ("printed_6", "total_8"),
    },
    2: {
        "joint PD": ("s12", "s14"),
        "joint PD,\nno (2.8)": ("s11", "s13"),
        "arm of\n(2.25)": ("impedance_12", "impedance_14"),
    },
}


def _draw_settings(metrics: AllMetrics, config: Config) -> Drawing:
    ours = {case: its for case, its in config.cases.items() if case not in CONTROLS}
    tuned = [case for case, its in ours.items() if its.law or gains(its, config) == "tuned"]
    figure, (*panels, right) = style.subplots(1, 3, height=2.9, width_ratios=(5, 3, 3.4))
    counts = []
    for axes, letter, (trajectory, settings) in zip(panels, "ab", SETTINGS.items()):
        pairs = {name: pair for name, pair in settings.items() if set(pair) <= set(metrics)}
        place = np.arange(len(pairs))
        errors = [[1e3 * shown(metrics[case]["rmse"]) for case in pair] for pair in pairs.values()]
        for shift, index, key in ((-0.2, 0, "no_impedance"), (0.2, 1, "impedance")):
            values = [pair[index] for pair in errors]
            axes.bar(place + shift, values, 0.38, color=style.LINES[LINES[key]]["color"], label=NAMES[key])
        axes.set_xticks(place, list(pairs), fontsize=6.5)
        axes.set(yscale="log", ylim=(0.3, 150))
        style.panel(axes, letter, f"Traj. {trajectory}, {config.cases['s5'].desired_force:g} N")
        counts.append(
            f"{sum(led < 0.99 * plain for plain, led in errors)} of {len(errors)} settings on Traj. {trajectory}"
        )
    panels[0].set_ylabel("Force RMSE [mN]")
    panels[0].legend(ncols=2, loc="upper right")
    for trajectory, marker, colour in ((1, "o", style.REFERENCE), (2, "s", style.PLAIN)):
        cases = [case for case in tuned if config.cases[case].leader.trajectory == trajectory]
        names = [_name(case, config.cases[case]) for case in cases]
        values = [1e3 * shown(metrics[case]["rmse"]) for case in cases]
        right.plot(values, names, marker, color=colour, label=f"Traj. {trajectory}", ms=4)
    right.set(xscale="log", xlabel="Force RMSE [mN]")
    right.invert_yaxis()
    right.legend(loc="center right")
    style.panel(right, "c", "tuned gains, with (2.8)")
    return style.title(figure, f"The impedance lead lowers the error by 1 % or more in {' and '.join(counts)}")
