"""Figures and tables of the circle tracking experiment, from what is on disk."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter8.sensitivity import Variant, sensitivity_table
from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Recordings
from dexrepro.report import style
from dexrepro.report.tables import by_case

FIGURES = {
    "8.4": Figure(
        "Where the broad network for gravity has put its nodes after one revolution, for the three printed thresholds, "
        "with the circle and the fixed grid of the fuzzy network. The book's figure is a schematic of the network.",
        "Nodes line the circle more densely as the threshold falls; the fixed grid covers the whole square.",
    ),
    "8.6": Figure(
        "Circle tracking of Case 1: path, error inside its hard bounds (shaded), and the steady error with the "
        "adaptation rate 1 of the printed law and with tuned rates. The book shows path and error of both networks.",
        "The path, the errors of both networks inside the shaded bounds, and their steady errors with rate 1 and with "
        "tuned rates, one above the other.",
    ),
    "8.7": Figure(
        "Number of nodes of the networks for D, C and G against time for the three printed thresholds.",
        "Node counts grow as the thresholds fall; the nodes of C are born in the first transient.",
    ),
    "8.8": Figure(
        "Circle tracking of Case 2, under the joint friction of Eq. (8.47): the two networks and H-infinity with an "
        "exact model, with masses 20 % too light, and with integral action.",
        "The path and the errors of the two networks and of the H-infinity laws against time.",
    ),
    "8.A": Figure(
        "Error of every network of this section from 5 to 10 s against its adaptation gain over the same time, the "
        "rate times the mean squared length of the features; one constant node a network is integral action. Not in "
        "the book.",
        "Markers of grown, fixed and constant networks in the plane of adaptation gain and error, both logarithmic.",
    ),
}
UNITS = {"reference": "m", "error": "m", "nodes": "1", "network_force": "N", "feature_power": "1"}
TABLES = {
    "T8.1": "Parameters of the two-link arm and its controller",
    "T8.A": "Circle tracking: every network and H-infinity design",
    "T8.Sa": "Sensitivity: the variants of circle tracking and what they do to the claims",
}


THRESHOLDS = ("broad", "broad_2", "broad_3")


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figures = {
        "8.4": (_draw_centres, THRESHOLDS),
        "8.6": (_draw_tracking, ("broad", "fuzzy", "broad_unit", "fuzzy_unit")),
        "8.7": (_draw_nodes, THRESHOLDS),
        "8.8": (
            _draw_friction,
            ("friction_broad", "friction_fuzzy", "friction_hinf", "friction_hinf_light", "friction_hinf_integral"),
        ),
        "8.A": (_draw_gains, ("broad", "fuzzy", "fuzzy_matched", "node")),
    }
    return style.drawn(figures, recordings, metrics, config)


def _draw_tracking(recordings: Any, metrics: Any, config: Config) -> Drawing:
    figure, grid = style.subplots(4, 2, height=7.2, sharex="row")
    lines = {"broad": ("BFNN", "book"), "fuzzy": ("FNN", "rival")}
    for axis, (column, letter) in enumerate(zip(grid.T, "xy")):
        for case, (label, line) in lines.items():
            run, unit = recordings[case], recordings[f"{case}_unit"]
            column[0].plot(
                run.time, run["reference"][:, axis] + run["error"][:, axis], label=label, **style.LINES[line]
            )
            first, steady = run.time <= 0.5, run.time >= config.settled
            column[1].plot(run.time[first], 1e3 * run["error"][first, axis], **style.LINES[line])
            column[2].plot(unit.time[steady], 1e3 * unit["error"][steady, axis], **style.LINES[line])
            column[3].plot(run.time[steady], 1e3 * run["error"][steady, axis], **style.LINES[line])
        column[0].plot(run.time, run["reference"][:, axis], label="desired", **style.LINES["reference"])
        bound = 1e3 * config.bound[axis]
        style.band(column[1], [0, 0.5], -bound, bound)
        column[1].text(0.5, bound, f" $\\pm\\iota_{letter}$ = {bound:g} mm", fontsize=7, ha="right", va="top")
        column[1].set(xlim=(0, 0.5), ylim=(-1.1 * bound, 1.1 * bound))
        for row, label in enumerate((f"${letter}$ [m]", *[f"$e_{letter}$ [mm]"] * 3)):
            column[row].set_ylabel(label)
        for axes in column:
            axes.set_xlabel("Time [s]")
    names = ("Path", "Transient, tuned rates", "Steady error, rate 1 as printed", "Steady error, tuned rates")
    style.panels(grid[:, 0], *names)
    figure.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    ratio = metrics["summary"]["ratio_tuned_x"] if "summary" in metrics else float("nan")
    unit = metrics["summary"]["ratio_unit_x"] if "summary" in metrics else float("nan")
    return style.title(
        figure,
        f"Error of FNN over that of BFNN in x, {config.settled:g} to {config.early:g} s: {unit:.3f} as printed, "
        f"{ratio:.2f} with tuned rates",
    )


def _draw_nodes(recordings: Recordings, metrics: Any, config: Config) -> Drawing:
    figure, row = style.subplots(1, 3, height=2.4, sharey=True)
    for index, (axes, case) in enumerate(zip(row, THRESHOLDS)):
        run = recordings[case]
        for column, name, line in ((0, "D", "book"), (2, "G", "extra2"), (1, "C", "rival")):
            counts = run["nodes"][:, column]
            (curve,) = axes.plot(run.time, counts, drawstyle="steps-post", **style.LINES[line])
            same = column == 2 and counts[-1] == run["nodes"][-1, 0]
            above = 5 if column != 1 and counts[-1] >= run["nodes"][-1, 1] else -5 if index == 0 else 0
            if not same:
                style.label_end(
                    axes, curve, f"$c_{name}$" + (", $c_G$" if column == 0 else "") + f": {counts[-1]:.0f}", dy=above
                )
        values = config.cases[case].networks.thresholds
        axes.set_title(rf"$\Theta_{index + 1}$ = ({', '.join(f'{value:g}' for value in values)})")
        axes.set(xlabel="Time [s]", xlim=(0, 43))
    row[0].set(ylabel="Number of nodes [-]", ylim=(0, None))
    totals = [int(metrics[case]["nodes"]) for case in THRESHOLDS]
    grid = f" against {metrics['fuzzy']['nodes']:.0f} on the grid" if "fuzzy" in metrics else ""
    return style.title(figure, f"Smaller thresholds, more nodes: {totals[0]}, {totals[1]} and {totals[2]}{grid}")


def _draw_friction(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawing:
    lines = {
        "friction_broad": ("BFNN", "book"),
        "friction_fuzzy": ("FNN", "rival"),
        "friction_hinf": (r"$H_\infty$, exact model", "plain"),
        "friction_hinf_light": (r"$H_\infty$, 20 % light model", "extra2"),
        "friction_hinf_integral": (r"$H_\infty$ with integral", "extra1"),
    }
    near = ("friction_broad", "friction_fuzzy", "friction_hinf_integral")
    figure, grid = style.subplots(3, 2, height=5.2, sharex=True)
    for axis, (column, letter) in enumerate(zip(grid.T, "xy")):
        for case, (label, line) in lines.items():
            run = recordings[case]
            column[0].plot(
                run.time, run["reference"][:, axis] + run["error"][:, axis], label=label, **style.LINES[line]
            )
            column[1].plot(run.time, 1e3 * run["error"][:, axis], label=label, **style.LINES[line])
            if case in near:
                column[2].plot(run.time, 1e3 * run["error"][:, axis], **style.LINES[line])
        column[0].plot(run.time, run["reference"][:, axis], label="desired", **style.LINES["reference"])
        bound = 1e3 * config.bound[axis]
        style.band(column[1], [0, config.duration], -bound, bound)
        column[1].set_ylim(-12, 12)
        column[2].set_ylim(-4, 4)
        for row, label in enumerate((f"${letter}$ [m]", f"$e_{letter}$ [mm]", f"$e_{letter}$ [mm]")):
            column[row].set_ylabel(label)
        column[2].set(xlabel="Time [s]", xlim=(0, config.duration))
    style.panels(grid[:, 0], "Path", "Error; shaded: bound of the networks", "Closer")
    figure.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=6)
    errors = "; ".join(f"{label} {metrics[case]['early_x']:.2g}" for case, (label, _) in lines.items())
    finding = f"RMS error in x under friction, {config.settled:g} to {config.early:g} s [mm]: {errors}"
    return style.title(figure, finding)


def _draw_centres(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawing:
    figure, row = style.subplots(1, 3, height=2.9, sharex=True, sharey=True)
    levels = config.networks.position_levels
    for axes, case in zip(row, THRESHOLDS):
        run, nodes = recordings[case], recordings[case].frames["nodes"]
        threshold = config.cases[case].networks.thresholds[2]
        axes.plot(*run["reference"].T, **style.LINES["reference"])
        axes.plot(*np.meshgrid(levels, levels), linestyle="", marker="+", color=style.RIVAL, markersize=6)
        axes.plot(nodes.x, nodes.y, linestyle="", marker="o", color=style.BOOK, markersize=4)
        axes.set_title(rf"$\Theta_G$ = {threshold:g} m: {len(nodes)} nodes")
        axes.set(xlabel="$x$ [m]", aspect="equal")
    row[0].set_ylabel("$y$ [m]")
    row[0].annotate("grid of FNN", (0.2, 0.2), (0.2, 0.215), fontsize=7, color=style.RIVAL, ha="center")
    return style.title(figure, "The broad network puts its nodes where the arm goes")


def _draw_gains(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawing:
    marks = {
        "broad": ("broad", style.BOOK, "o"),
        "broad_plain": ("grown, no cos and sin", style.EXTRA[2], "D"),
        "fuzzy_enhanced": ("grid with cos and sin", style.EXTRA[0], "^"),
        "fuzzy": ("fuzzy", style.RIVAL, "s"),
        "node": ("one constant node", style.EXTRA[1], "*"),
    }
    cases = {
        "broad": ["broad", "broad_2", "broad_3", "broad_unit"],
        "broad_plain": ["broad_plain"],
        "fuzzy_enhanced": ["fuzzy_enhanced"],
        "fuzzy": ["fuzzy", "fuzzy_matched", "fuzzy_unit"],
        "node": ["node", "node_3"],
    }
    names = {"broad": "BFNN, $\\Theta_1$", "broad_2": "$\\Theta_2$", "broad_3": "$\\Theta_3$", "fuzzy": "FNN",
             "fuzzy_matched": "FNN, gain\nmatched", "broad_unit": "rate 1"}  # fmt: skip
    figure, row = style.subplots(1, 2, height=2.9, sharex=True, sharey=True)
    for axes, letter in zip(row, "xy"):
        for kind, (label, colour, marker) in marks.items():
            found = [metrics[case] for case in cases[kind] if case in metrics]
            axes.loglog(
                [m["early_gain"] for m in found], [m[f"early_{letter}"] for m in found], linestyle="", marker=marker,
                color=colour, label={"broad": "BFNN", "fuzzy": "FNN"}.get(kind, label), markersize=5,
            )  # fmt: skip
        for case, name in names.items():
            if case in metrics:
                below = config.cases[case].networks.kind == "fuzzy"
                place = (metrics[case]["early_gain"], metrics[case][f"early_{letter}"])
                side: Any = {"xytext": (-5, -5), "ha": "right", "va": "top"} if below else {"xytext": (4, 4)}
                axes.annotate(name, place, textcoords="offset points", fontsize=6.5, **side)
        axes.set(xlabel=r"Adaptation gain $\Gamma_G\,\overline{|\vartheta_G|^2}$ [-]", ylabel=f"rms $e_{letter}$ [mm]")
        axes.set(xlim=(0.7, 1e5), ylim=(0.01, 5))
    row[0].legend(loc="lower left")
    errors = ", ".join(
        f"{name} {metrics[case]['early_x']:.3f}/{metrics[case]['early_y']:.3f}"
        for case, name in (("broad", "BFNN"), ("fuzzy_matched", "FNN"), ("node", "one node"))
    )
    return style.title(figure, f"Error x/y [mm] at equal gain: {errors}")


_TUNED, _FRICTION = ("broad", "fuzzy"), ("friction_broad", "friction_fuzzy")
_MATCHED, _NARROW = ("broad", "fuzzy_matched"), ("narrow_broad", "narrow_fuzzy_matched")
_STATIC, _INTEGRAL = ("friction_broad", "friction_hinf"), ("friction_broad", "friction_hinf_integral")
VARIANTS = (
    Variant("C8.02", "Gaussians of {0.networks.widths[0]:g} m", "early_x", ("narrow_broad", "narrow_fuzzy"), _TUNED),
    Variant("C8.02", "Gaussians of {0.networks.widths[0]:g} m, x", "early_x", ("wide_broad", "wide_fuzzy"), _TUNED),
    Variant("C8.02", "Gaussians of {0.networks.widths[0]:g} m, y", "early_y", ("wide_broad", "wide_fuzzy"), _TUNED),
    Variant("C8.02", "equal adaptation gain", "early_x", _MATCHED, _TUNED),
    Variant("C8.02", "without cos and sin", "early_x", ("broad_plain", "fuzzy"), _TUNED),
    Variant("C8.02", "the grid with cos and sin", "early_x", ("broad", "fuzzy_enhanced"), _TUNED),
    Variant("C8.02", "elbow-down, x", "early_x", ("down_broad", "down_fuzzy"), _TUNED),
    Variant("C8.02", "elbow-down, y", "early_y", ("down_broad", "down_fuzzy"), _TUNED),
    Variant("C8.02", "tanh for the sign, x", "early_x", ("smooth_broad", "smooth_fuzzy"), _TUNED),
    Variant("C8.02", "tanh for the sign, y", "early_y", ("smooth_broad", "smooth_fuzzy"), _TUNED),
    Variant("C8.02", "no gravity, rate 1", "early_x", ("horizontal_broad", "horizontal_fuzzy"), _TUNED),
    Variant(
        "C8.02",
        "m = {0.networks.neighbours}, beta_1 = {0.networks.placement:g}",
        "early_y",
        ("neighbours_3", "fuzzy"),
        _TUNED,
    ),
    Variant("C8.03", "Gaussians of {0.networks.widths[0]:g} m, x", "early_x", _NARROW, _MATCHED),
    Variant("C8.03", "Gaussians of {0.networks.widths[0]:g} m, y", "early_y", _NARROW, _MATCHED),
    Variant("C8.01", "elbow-down, rate 1, step {0.step:g} s", "bound_used", ("down_unit", 1.0), ("broad_unit", 1.0)),
    Variant(
        "C8.01", "elbow-down, rate 1, step {0.step:g} s", "bound_used", ("down_unit_fine", 1.0), ("broad_unit", 1.0)
    ),
    Variant("C8.07", "rate 1, x", "early_x", ("friction_broad_unit", "friction_fuzzy_unit"), _FRICTION),
    Variant("C8.07", "equal adaptation gain, x", "early_x", ("friction_broad", "friction_fuzzy_matched"), _FRICTION),
    Variant("C8.08", "H-infinity with integral action", "early_x", _INTEGRAL, _STATIC),
    Variant("C8.08", "rate 1", "early_y", ("friction_broad_unit", "friction_hinf"), _STATIC),
    Variant("C8.08", "every method the best of its search", "early_x", ("tuned_broad", "tuned_hinf"), _STATIC),
)


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    columns = {"max_x": "largest e_x [mm]", "max_y": "largest e_y [mm]", "bound_used": "share of the bound used",
               "rms_x": "rms e_x [mm]", "rms_y": "rms e_y [mm]", "early_x": "rms e_x, early [mm]",
               "early_y": "rms e_y, early [mm]", "nodes": "nodes", "features": "features",
               "network_force": "rms network force [N]", "feature_power": "feature power [-]",
               "early_gain": "adaptation gain, early [-]"}  # fmt: skip
    return {
        "T8.1": _parameters(config),
        "T8.A": by_case(metrics, columns, recordings),
        "T8.Sa": sensitivity_table(VARIANTS, metrics, columns, config),
    }


def _parameters(config: Config) -> pd.DataFrame:
    arm = config.arm
    rows: list[tuple[str, str, Any, str]] = []
    for index in (0, 1):
        rows += [
            (f"m_{index + 1}", f"Mass of link {index + 1}", arm.masses[index], "kg"),
            (f"l_{index + 1}", f"Length of link {index + 1}", arm.lengths[index], "m"),
            (f"I_{index + 1}", f"Inertia of link {index + 1}", arm.inertias[index], "kg m^2"),
        ]
    rows.append(("g", "Gravity acceleration", config.gravity, "m/s^2"))
    for symbol, what, value, unit in (
        ("iota", "Bound of the error", config.bound, "m"),
        ("K_1", "Position gain", config.barrier.position_gain, "1/s"),
        ("K_p", "Velocity gain", config.barrier.velocity_gain, "N s/m"),
        ("K_r", "Robust gain", config.barrier.robust_gain, "N"),
        ("beta", "Leakage", config.networks.leakage, "1/s"),
        ("Gamma", "Adaptation rates of D, C, G (not printed)", config.networks.rates, "-"),
        ("eta_w", "Widths of D, C, G (not printed)", config.networks.widths, "m"),
    ):
        rows.append((symbol, what, value, unit))
    return pd.DataFrame(rows, columns=["parameter", "description", "value", "unit"])
