"""Figures and tables of the sponge experiment, from what is on disk."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter8 import drawings, learning_study
from dexrepro.chapters.chapter8.sensitivity import Variant, sensitivity_table
from dexrepro.control.interaction_optimum import InteractionCost, InteractionModel, closed_form_gain, steady_fraction
from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Film, Recordings
from dexrepro.report import style
from dexrepro.report.tables import by_case

from .experiment import VIEW

FIGURES = {
    "8.12": Figure(
        "The simulated Baxter arm above the sponge, and its gripper on it at three instants seen from near by, the box "
        "as low as it is pressed. The book shows a photograph of the real arm.",
        "A red arm with its gripper pointing down meets a yellow block.",
    ),
    "8.13": Figure(
        "Desired, virtual and actual path of the gripper in the simulated sponge experiment, with the learned law, "
        "the regulator with the wrong model and one that is told the sponge (run for 10 s); (a, b) what the gripper is "
        "off the path across it, and (d) its error to the virtual reference. The book shows the same, x and y apart.",
        "Height, deviation across the path and error of the gripper against time.",
    ),
    "8.14": Figure(
        "Gain of the learned law and of the regulator over time on the simulated sponge, with the optimum (dashed). "
        "The book shows the same curves.",
        "Both components of the gain over time, with the optimum and the regulator's.",
    ),
    "8.C": Figure(
        "Final compression of sponges of several stiffnesses under the optimal gain and under the regulator with the "
        "wrong model, in closed form (lines) and simulated (marks). Not in the book.",
        "Final compression over the stiffness of the sponge under the optimal gain and under the regulator.",
    ),
}
UNITS = {
    "sponge_force": "N", "reference": "m", "path": "m", "error": "m", "nodes": "1", "gain": "N/m", "phase": "1",
}  # fmt: skip
TABLES = {
    "T8.E": "Sponge: every method and variant",
    "T8.F": "Algorithm 8.1: iterates of the policy iteration on the sponge",
    "T8.G": "Noise study on the sponge",
    "T8.Sc": "Sensitivity: the variants of the sponge experiment and what they do to the claims",
}
FILM = Film(
    "learned", "The arm meets the sponge, explores it and moves to the optimal gain.", VIEW, "sponge_force.z",
    "Contact force [N]",
)  # fmt: skip


LINES = {
    "learned": ("proposed", "book"),
    "lqr": ("LQR, wrong model", "rival"),
    "lqr_true": ("LQR, true model", "extra1"),
}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figures = {
        "8.12": (_draw_pictures, ("learned",)),
        "8.13": (_draw_tracking, tuple(LINES)),
        "8.14": (_draw_gain, ("learned", "lqr")),
        "8.C": (_draw_stiffness, ("learned", "lqr")),
    }
    return style.drawn(figures, recordings, metrics, config)


def _draw_pictures(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawing:
    run, values = recordings["learned"], metrics["learned"]
    depth = 1e3 * np.maximum(config.cases.learned.sponge.surface - run["arm.tip"][:, 2], 0)
    instants = sorted((float(name.removeprefix("at_").removesuffix("s")), name) for name in run.images)
    figure, row = style.subplots(1, len(instants), height=1.8)
    for axes, (instant, name) in zip(np.atleast_1d(row), instants):
        image = run.images[name]
        top = 0.1 if instant == instants[0][0] else 0.0  # the others are near views of where it touches
        style.photo(axes, image[round(top * len(image)) : round((top + 0.78) * len(image))])
        pressed = depth[np.abs(run.time - instant).argmin()]
        axes.set_title(f"{instant:g} s" + (f": {pressed:.0f} mm deep" if pressed else ""))
    return style.title(
        figure,
        f"The simulated arm presses the sponge {values['peak_compression']:.0f} mm deep while it learns, "
        f"{values['final_compression']:.0f} mm in the end",
    )


def _draw_tracking(recordings: Recordings, metrics: Any, config: Config) -> Drawing:
    figure = style.plt.figure(figsize=(style.TWO_COLUMNS, 4.0))
    grid = figure.add_gridspec(2, 3)
    depth, aside, error = (figure.add_subplot(place) for place in (grid[:, :2], grid[0, 2], grid[1, 2]))
    learned = recordings["learned"]
    for case, (label, line) in LINES.items():
        run = recordings[case]
        depth.plot(run.time, run["arm.tip"][:, 2], label=label, **style.LINES[line])
        if run.time[-1] < learned.time[-1] - 1.0:
            depth.plot(run.time[-1], run["arm.tip"][-1, 2], "|", color=style.LINES[line]["color"], markersize=9)
            depth.annotate("run ends", (run.time[-1], run["arm.tip"][-1, 2]), (3, -10), textcoords="offset points",
                           fontsize=7, color=style.LINES[line]["color"])  # fmt: skip
    for channel, label, line in (
        ("reference", "virtual $x_0$, proposed", "extra2"),
        ("path", "desired $x_d$", "reference"),
    ):
        depth.plot(learned.time, learned[channel][:, 2], label=label, **style.LINES[line])
    style.panel(depth, "c", "Height")
    for axis, (letter, line) in enumerate((("x, forward", "book"), ("y, sideways", "extra2"))):
        deviation = 1e3 * (learned["arm.tip"][:, axis] - config.path.place[axis])
        aside.plot(learned.time, deviation, label=f"${letter[0]}${letter[1:]}", **style.LINES[line])
    aside.set(ylabel="Off the path [mm]", xlim=(0, config.duration), ylim=(-0.1, 0.1))
    aside.legend(loc="upper right")
    style.panel(aside, "a, b", "Across the path")
    surface = config.sponge.surface
    depth.set(xlim=(0, config.duration), ylim=(0.04, 0.15), xlabel="Time [s]", ylabel="$z$ [m]")
    depth.axhline(surface, color="#7A5C1E", linewidth=0.6)
    depth.annotate("sponge, relaxed", (17.8, surface + 0.001), fontsize=6.5, color="#7A5C1E", ha="right", va="bottom")
    drawings.phases(depth, learned)
    for case, position in (("learned", 0.0835), ("lqr", 0.071)):
        depth.annotate(
            f"{metrics[case]['final_compression']:.1f} mm", (17.8, position), fontsize=7, ha="right",
            color=style.LINES[LINES[case][1]]["color"],
        )  # fmt: skip
    for case in ("learned", "lqr"):
        run = recordings[case]
        error.plot(run.time, 1e3 * run["error"][:, 2], **style.LINES[LINES[case][1]])
    error.set(ylabel="$z_{1z}$ [mm]", xlabel="Time [s]", xlim=(0, config.duration), ylim=(-8, 8))
    error.text(0.98, 0.05, f"bound $\\pm${1e3 * config.bound[2]:g} mm, far outside", transform=error.transAxes,
               fontsize=7, ha="right")  # fmt: skip
    style.panel(error, "d", "Error to $x_0$")
    figure.legend(*depth.get_legend_handles_labels(), loc="outside lower center", ncols=5)
    less = metrics["lqr"]["final_compression"] - metrics["learned"]["final_compression"]
    more = metrics["learned"]["peak_compression"] - metrics["lqr"]["peak_compression"]
    end, before = (f"{abs(gap):.1f} mm {word[gap > 0]}" for gap, word in (
        (less, ("more", "less")), (more, ("less", "more"))))  # fmt: skip
    return style.title(figure, f"The learned law presses {end} than the regulator in the end, {before} before")


def _draw_gain(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawing:
    learned, lqr = recordings["learned"], recordings["lqr"]
    steps = learned.frames["iterates"]
    figure, row = style.subplots(1, 2, height=2.4)
    for index, (axes, key) in enumerate(zip(row, "xs")):
        for run, (name, line) in ((learned, ("$K_m$, proposed", "book")), (lqr, ("$K_l$, LQR, wrong model", "rival"))):
            axes.plot(run.time, run["gain"][:, index], label=name, **style.LINES[line])
        axes.axhline(steps[f"optimal_{key}"].iloc[0], label="optimum of the true sponge", **style.LINES["reference"])
        axes.set(xlabel="Time [s]", ylabel=f"$K_{key}$ [N/m]", xlim=(0, config.duration))
        axes.set_ylim(*((-1050, 150), (0, 1200))[index])
        drawings.phases(axes, learned)
    row[0].legend(loc="lower left", bbox_to_anchor=(0.0, 0.14), fontsize=6.5)
    found, best = steps.iloc[-1].next_x, steps.iloc[-1].optimal_x
    return style.title(figure, f"The gain settles at {found:.1f} N/m, the optimum is {best:.1f} N/m".replace("-", "−"))


def _draw_stiffness(recordings: Recordings, metrics: Any, config: Config) -> Drawing:
    cost = InteractionCost(config.cost.tracking, config.cost.effort, config.cost.output)
    commanded = 1e3 * (config.sponge.surface - config.path.end)
    stiffness = np.geomspace(100, 1000, 100)
    gains = np.array(
        [closed_form_gain(InteractionModel(k, config.sponge.damping, config.exosystem), cost) for k in stiffness]
    )
    wrong = np.array([metrics["lqr"]["gain_x"], metrics["lqr"]["gain_s"]])
    learned = commanded * np.array([steady_fraction(g, k, cost.output) for g, k in zip(gains, stiffness)])
    fixed = commanded * np.array([steady_fraction(wrong, k, cost.output) for k in stiffness])
    figure, axes = style.subplots(1, 1, width=style.ONE_COLUMN, height=2.6)
    axes.semilogx(stiffness, learned, label="learned law", **style.LINES["book"])
    axes.semilogx(stiffness, fixed, label="LQR, wrong model", **style.LINES["rival"])
    for prefix in ("", "soft_", "firm_"):
        for kind, line, marker in (("learned", "book", "o"), ("lqr", "rival", "s")):
            case = prefix + kind
            if case in metrics and metrics[case]["final_compression"] is not None:
                axes.plot(
                    config.cases[case].sponge.stiffness, metrics[case]["final_compression"], marker=marker,
                    color=style.LINES[line]["color"], markersize=5, linestyle="",
                )  # fmt: skip
    crossing = metrics["summary"]["crossing_stiffness"]
    style.event(axes, crossing, f" {crossing:.0f} N/m")
    axes.set(xlabel="Stiffness of the sponge [N/m]", ylabel="Final compression [mm]", ylim=(0, 50))
    axes.set_xticks(ticks := [100, 200, 500, 1000], map(str, ticks))
    axes.minorticks_off()
    axes.legend(loc="lower left")
    return style.title(figure, f"Below {crossing:.0f} N/m the learned law presses more")


_BASE = ("learned", "lqr")
VARIANTS = (
    Variant("C8.17", "sponge of {0.sponge.stiffness:g} N/m", "final_compression", ("soft_learned", "soft_lqr"), _BASE),
    Variant("C8.17", "sponge of {0.sponge.stiffness:g} N/m", "final_compression", ("firm_learned", "firm_lqr"), _BASE),
    Variant("C8.17", "peak in place of the end", "peak_compression", _BASE, ("learned_end", "lqr_end")),
    Variant("C8.17", "printed model, force on the environment", "final_compression",
            ("learned", "lqr_printed_environment"), _BASE),
    Variant("C8.16", "printed model, force on the robot", "bound_used", ("lqr_printed", 1.0), ("lqr", 1.0)),
    Variant("C8.16", "no gravity compensation", "bound_used", ("uncompensated", 1.0), ("learned", 1.0)),
    Variant("C8.16", "{0.control_period:g} s between samples", "bound_used", ("at_200_hz", 1.0), ("learned", 1.0)),
    Variant("C8.16", "{0.control_period:g} s between samples, as printed", "bound_used", ("at_50_hz", 1.0),
            ("learned", 1.0)),
)  # fmt: skip


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    columns = {"final_compression": "final compression [mm]", "final_force": "final force [N]",
               "peak_compression": "peak compression [mm]", "peak_force": "peak force [N]",
               "max_error_x": "largest z_1x [mm]", "max_error_y": "largest z_1y [mm]",
               "max_error_z": "largest z_1z [mm]", "bound_used": "share of the bound used", "gain_x": "K_x [N/m]",
               "gain_s": "K_s [N/m]", "gain_error": "error of the gain [-]", "iterations": "iterations",
               "nodes_d": "nodes for D", "nodes_c": "nodes for C", "nodes_g": "nodes for G",
               "peak_torque": "peak torque [N m]", "stopped_at": "stopped at [s]"}  # fmt: skip
    ends = {
        f"{case}_end": {"peak_compression": metrics[case].get("final_compression")} for case in _BASE if case in metrics
    }
    tables = {
        "T8.E": by_case(
            metrics, columns, recordings, told=lambda case: {"stiffness [N/m]": config.cases[case].sponge.stiffness}
        ),
        "T8.Sc": sensitivity_table(VARIANTS, {**metrics, **ends}, columns, config),
    }
    if "learned" in recordings:
        tables["T8.F"] = learning_study.headed(recordings["learned"].frames["iterates"], "N/m")
        tables["T8.G"] = learning_study.headed(recordings["learned"].frames["noise"], "N/m")
    return tables
