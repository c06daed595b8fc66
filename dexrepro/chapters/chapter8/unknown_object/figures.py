"""Figures and tables of the contact with an unknown object, from what is on disk."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter8 import drawings, learning_study
from dexrepro.chapters.chapter8.sensitivity import Variant, sensitivity_table
from dexrepro.control.impedance_learning import EXPLORING, soft_transfer
from dexrepro.control.interaction_optimum import InteractionCost, InteractionModel, closed_form_gain
from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Recordings
from dexrepro.report import style
from dexrepro.report.tables import by_case

from .experiment import objects

FIGURES = {
    "8.2": Figure(
        "The soft change of gain, Eq. (8.11), of both components from K_0 to K* in shares of the learned gain, and "
        "its rate. The book shows the same curve.",
        "The gain moves monotonically along half a sine, fastest in the middle.",
    ),
    "8.9": Figure(
        "The arm, the circle and the object's surface at the start, at first contact and during the interaction. The "
        "book's figure is a drawing of the scene.",
        "Two-link arm, elbow-up, whose end point stays near the object's surface where the circle goes through it.",
    ),
    "8.10": Figure(
        "Contact with the unknown object: position along x, error to the virtual reference with its bound, contact "
        "force, and position with the reference taken from the interaction law itself. The book shows position and "
        "error.",
        "Position, error and contact force under soft and abrupt changes of gain and under the regulator, over time.",
    ),
    "8.11": Figure(
        "Gain of the learned law and of the regulator over time with the phases of Algorithm 8.1, and the iterates of "
        "the policy iteration with the optimum (dashed). The book shows the gains over time.",
        "Gain over the iterations, from its initial value to the optimum, and over time, along half a sine.",
    ),
    "8.B": Figure(
        "Learned gain against the optimum of the Riccati equation for objects of 5 to 1000 N/m, the relative error, "
        "and the spread of the gain under sensor noise. Not in the book.",
        "Learned gain and optimum over the stiffness of the object, their difference, and the effect of noise.",
    ),
}
UNITS = {
    "object": "N", "reference": "m", "reference_speed": "m/s", "path": "m", "error": "m", "gain": "N/m, N",
    "phase": "1", "desired_force": "N",
}  # fmt: skip
TABLES = {
    "T8.2": "Algorithm 8.1: iterates of the policy iteration on the unknown object",
    "T8.B": "Contact with the unknown object: every method",
    "T8.C": "Noise study: the gain learned from the recorded exploration with added sensor noise",
    "T8.D": "The gain learned from the same exploration under other assumptions",
    "T8.Sb": "Sensitivity: the variants of the contact and what they do to the claims",
}


METHODS = {
    "soft": ("proposed, soft", "book"),
    "abrupt": ("abrupt", "extra3"),
    "lqr": ("LQR, wrong model", "rival"),
    "lqr_true": ("LQR, true model", "extra1"),
    "hold": ("$K_0$ kept", "extra2"),
}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figures = {
        "8.2": (_draw_transfer, ("soft",)),
        "8.9": (_draw_scene, ("soft",)),
        "8.10": (_draw_contact, (*METHODS, "static_soft", "static_abrupt")),
        "8.11": (_draw_gain, ("soft", "lqr")),
        "8.B": (_draw_objects, ("soft", "object_5", "object_1000")),
    }
    return style.drawn(figures, recordings, metrics, config)


def _cost(config: Config) -> InteractionCost:
    cost = config.cost
    return InteractionCost(tracking=cost.tracking, effort=cost.effort, output=cost.output)


def _draw_transfer(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawing:
    initial = np.array(config.interaction.gain.initial, float)
    optimal = np.array([metrics["soft"]["gain_x"], metrics["soft"]["gain_s"]])
    progress = np.linspace(0.0, 1.0, 201)
    gain = soft_transfer(initial, optimal, progress)
    figure, row = style.subplots(1, 2, height=2.2)
    for index, (name, line) in enumerate((("$K_x$", "book"), ("$K_s$", "rival"))):
        share = gain[:, index] / optimal[index]
        row[0].semilogy(progress, share, label=name, **style.LINES[line])
        rate = np.gradient(gain[:, index], progress) / (optimal - initial)[index]
        row[1].plot(progress, rate, **style.LINES[line])
    row[0].axhline(1.0, **style.LINES["reference"])
    for axes, edge in ((axes, edge) for axes in row for edge in ((0.0, "$T_a$"), (1.0, "$T_b$"))):
        axes.axvline(edge[0], color="#444444", linewidth=0.6)
        axes.annotate(edge[1], (edge[0], 1), xycoords=("data", "axes fraction"), fontsize=7, ha="center", va="bottom")
    row[0].set(xlabel="$t/T_s$ [-]", ylabel="$K'/K^*$ [-]")
    row[1].set(xlabel="$t/T_s$ [-]", ylabel="$T_s\\,\\dot K' / (K^* - K_0)$ [-]")
    row[0].legend(loc="lower left", bbox_to_anchor=(0.08, 0.06))
    return style.title(figure, f"The gain moves along half a sine, at most at {rate.max():.1f} times the mean rate")


def _draw_scene(recordings: Recordings, metrics: Any, config: Config) -> Drawing:
    run = recordings["soft"]
    times = (0.0, metrics["soft"]["touched_at"], 15.0)
    figure, axes = style.subplots(1, 1, width=style.ONE_COLUMN, height=3.0)
    surface = config.object.surface
    axes.axvspan(surface, 0.33, color="#F3E3C3", zorder=-5)
    axes.text(0.275, 0.04, "object", fontsize=7, ha="center", color="#7A5C1E")
    angle = np.linspace(0, 2 * np.pi, 200)
    (cx, cy), radius = config.path.centre, config.path.radius
    axes.plot(cx - radius * np.cos(angle), cy + radius * np.sin(angle), **style.LINES["reference"])
    first, second = config.arm.lengths
    for time, line, name in zip(
        times, ("plain", "rival", "book"), ("start", f"{times[1]:.1f} s, contact", f"{times[2]:g} s")
    ):
        q = run["arm.position"][int(np.searchsorted(run.time, time))]
        elbow = first * np.array([np.cos(q[0]), np.sin(q[0])])
        tip = elbow + second * np.array([np.cos(q.sum()), np.sin(q.sum())])
        axes.plot(*np.array([(0, 0), elbow, tip]).T, marker="o", markersize=4, label=name, **style.LINES[line])
    axes.set(xlabel="$x$ [m]", ylabel="$y$ [m]", aspect="equal", xlim=(-0.13, 0.33), ylim=(-0.02, 0.42))
    axes.legend(loc="upper left", fontsize=6.5)
    return style.title(figure, f"The arm meets the object at {surface:g} m")


def _draw_contact(recordings: Recordings, metrics: Any, config: Config) -> Drawing:
    figure, grid = style.subplots(2, 2, height=4.8)
    (place, error), (force, static) = grid
    start, end = metrics["soft"]["touched_at"] - 0.6, metrics["soft"]["left_at"] + 0.6
    soft = recordings["soft"]
    for case, (label, line) in METHODS.items():
        run = recordings[case]
        place.plot(run.time, run["arm.tip"][:, 0], label=label, **style.LINES[line])
        force.plot(run.time, run["object.x"], **style.LINES[line])
        if case in ("soft", "abrupt", "lqr"):
            error.plot(run.time, 1e3 * run["error"][:, 0], **style.LINES[line])
    place.plot(soft.time, soft["path"][:, 0], label="desired $x_d$", **style.LINES["reference"])
    place.set(ylabel="$x$ [m]", ylim=(0.21, 0.32))
    place.axhline(config.object.surface, color="#7A5C1E", linewidth=0.6)
    place.annotate("surface", (19.5, config.object.surface - 0.001), fontsize=6.5, color="#7A5C1E", va="top")
    error.set(ylabel="$z_{1x} = x - x_0$ [mm]", ylim=(-1.5, 1.5))
    bound = 1e3 * config.bound[0]
    error.text(0.98, 0.03, f"bound $\\pm${bound:g} mm, far outside", transform=error.transAxes, fontsize=7, ha="right")
    force.set(ylabel="Contact force $\\tau_{e,x}$ [N]", xlabel="Time [s]")
    for case in ("soft", "abrupt", "lqr"):
        run, (label, line) = recordings[f"static_{case}"], METHODS[case]
        path = config.cases[f"static_{case}"].path
        static.plot(run.time + path.phase / path.rate, run["arm.tip"][:, 0], label=label, **style.LINES[line])
    static.plot(soft.time, soft["path"][:, 0], **style.LINES["reference"])
    static.set(ylabel="$x$ [m]", xlabel="Time [s]", ylim=(0.19, 0.32))
    names = ("Position", "Error to the virtual reference", "Contact force", "Position, reference from the law itself")
    for letter, axes, name in zip("abcd", grid.flat, names):
        style.panel(axes, letter, name)
        drawings.phases(axes, soft)
        axes.set_xlim(start, end)
    figure.legend(*place.get_legend_handles_labels(), loc="outside lower center", ncols=6)
    soft_rate, abrupt_rate = (metrics[case]["force_rate"] for case in ("soft", "abrupt"))
    return style.title(
        figure,
        f"The measured force changes at {style.at_most(soft_rate, 2)} N/s at most with the soft change, at up to "
        f"{abrupt_rate:.1f} N/s with the abrupt one",
    )


def _draw_gain(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawing:
    soft, lqr, steps = recordings["soft"], recordings["lqr"], recordings["soft"].frames["iterates"]
    figure, grid = style.subplots(2, 2, height=4.0, sharex="col")
    start, end = metrics["soft"]["touched_at"], metrics["soft"]["left_at"]
    for index, (row, key, unit) in enumerate(zip(grid, "xs", ("N/m", "N"))):
        best = steps[f"optimal_{key}"].iloc[0]
        for run, (name, line) in ((soft, ("$K_m$, proposed", "book")), (lqr, ("$K_l$, LQR, wrong model", "rival"))):
            row[0].plot(run.time, run["gain"][:, index], label=name, **style.LINES[line])
        row[0].axhline(best, label="optimum of the true object", **style.LINES["reference"])
        row[0].set(ylabel=f"$K_{key}$ [{unit}]", xlim=(start, end))
        row[0].set_ylim(*((-32, 5), (-0.05, 1.6))[index])
        drawings.phases(row[0], soft, names=index == 0)
        count = np.arange(len(steps) + 1)
        values = np.append(steps[f"gain_{key}"], steps[f"next_{key}"].iloc[-1])
        row[1].semilogy(count, np.abs(values), marker="o", markersize=4, **style.LINES["book"])
        row[1].axhline(abs(best), **style.LINES["reference"])
        row[1].set_ylabel(f"$|K_{key}|$ [{unit}]")
    grid[1, 0].set_xlabel("Time [s]")
    grid[1, 1].set_xlabel("Iteration $m$ [-]")
    grid[0, 0].legend(loc="center left", fontsize=6.5)
    style.panels(grid[0], "Gain in use", "Iterates of the policy iteration")
    digits, seconds = metrics["soft"]["digits"], np.ptp(soft.time[soft["phase"] == EXPLORING])
    finding = f"{len(steps)} iterations on {seconds:.0f} s of contact find the optimum to {digits:.1f} digits"
    return style.title(figure, finding)


def _draw_objects(recordings: Recordings, metrics: Any, config: Config) -> Drawing:
    found = sorted(
        (config.cases[name].object.stiffness, metrics[name]) for name in objects(config) if name in recordings
    )
    stiffness = np.array([item[0] for item in found], float)
    curve = np.geomspace(4, 1250, 60)
    damping = config.object.damping
    best = np.array([closed_form_gain(InteractionModel(k, damping, config.exosystem), _cost(config)) for k in curve])
    figure, row = style.subplots(1, 3, height=2.5)
    for index, (key, unit, line, marker) in enumerate((("x", "N/m", "book", "o"), ("s", "N", "rival", "s"))):
        colour = style.LINES[line]["color"]
        row[0].loglog(curve, np.abs(best[:, index]), color=colour, linestyle="--", linewidth=0.8)
        row[0].loglog(
            stiffness, [abs(m[f"gain_{key}"]) for _, m in found], color=colour, linestyle="", marker=marker,
            markersize=4, label=f"$|K_{key}|$ [{unit}]",
        )  # fmt: skip
        row[1].loglog(
            stiffness, [100 * m[f"gain_error_{key}"] for _, m in found], color=colour, marker=marker, markersize=4
        )
    row[0].legend()
    row[0].set(xlabel="Stiffness of the object [N/m]", ylabel="Gain [N/m] or [N]")
    row[1].set(xlabel="Stiffness of the object [N/m]", ylabel="Relative error [%]")
    noise = recordings["soft"].frames["noise"].query("quantity == 'force'")
    for key, line, marker in (("x", "book", "o"), ("s", "rival", "s")):
        scale = abs(metrics["soft"][f"gain_{key}"])
        spread = 100 * noise[f"std_{key}"] / scale
        row[2].loglog(noise.noise, spread, marker=marker, markersize=4, label=f"$K_{key}$", **style.LINES[line])
    row[2].set(xlabel="Force noise, rms [N]", ylabel="Spread of the gain [%]")
    row[2].legend()
    style.panels(row, "Learned; dashed: optimum", "Distance from it", "Under sensor noise")
    worst = 100.0 * (metrics.get("summary", {}).get("worst_gain_error") or float("nan"))
    return style.title(
        figure,
        f"The learned gain is optimal within {style.at_most(worst, 1)} % for {stiffness[0]:g} to {stiffness[-1]:g} N/m",
    )


_STATIC = ("static_soft", "static_abrupt")
VARIANTS = (
    Variant("C8.10", "reference integrates the force error", "oscillation", ("soft", "abrupt"), _STATIC),
    Variant("C8.11", "reference from the law itself", "oscillation", ("static_soft", "static_lqr"), ("soft", "lqr")),
    Variant("C8.12", "abrupt, reference from the law", "bound_used", ("static_abrupt_fast", 1.0), ("abrupt", 1.0)),
    Variant("C8.12", "x and x_d in absolute coordinates", "bound_used", ("absolute", 1.0), ("soft", 1.0)),
    Variant("C8.12", "+ tau_e as printed in (8.31)", "bound_used", ("force_sign_printed", 1.0), ("soft", 1.0)),
    Variant("C8.12", "tau_e not fed back", "bound_used", ("force_sign_none", 1.0), ("soft", 1.0)),
    Variant("C8.12", "sign itself in place of tanh", "bound_used", ("sign", 1.0), ("soft", 1.0)),
    Variant("C8.09", "T_s = 1 s", "force_rate", ("quick", "abrupt"), ("soft", "abrupt")),
)


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    columns = {"bound_used": "share of the bound used in contact", "max_error_x": "largest z_1x [mm]",
               "max_error_y": "largest z_1y [mm]", "force_jump": "force jump [N]", "force_rate": "force rate [N/s]",
               "reference_speed": "reference speed [m/s]", "oscillation": "oscillation [mm]",
               "fraction": "x/x_d late in the contact [-]", "fraction_theory": "x/x_d, closed form [-]",
               "final_cost": "cost rate at rest, closed form [1/m^2]", "contact_cost": "cost of the contact",
               "gain_x": "K_x [N/m]", "gain_s": "K_s [N]", "gain_error_x": "error of K_x [-]",
               "gain_error_s": "error of K_s [-]", "iterations": "iterations",
               "violated_at": "violated at [s]", "diverged_at": "diverged at [s]"}  # fmt: skip
    tables = {
        "T8.B": by_case(metrics, columns, recordings),
        "T8.Sb": sensitivity_table(VARIANTS, metrics, columns, config),
    }
    if "soft" in recordings:
        frames = recordings["soft"].frames
        tables["T8.2"] = learning_study.headed(frames["iterates"], "N")
        tables["T8.C"] = learning_study.headed(frames["noise"], "N")
        tables["T8.D"] = learning_study.headed(frames["assumptions"][["assumption", "gain_x", "gain_s"]], "N")
    return tables
