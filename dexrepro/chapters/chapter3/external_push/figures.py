"""What ``external_push`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter3.measures import headed
from dexrepro.chapters.chapter3.scene import FILMED
from dexrepro.control.momentum_observer import MomentumObserver
from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Film, Recordings
from dexrepro.report import style

FIGURES = {
    "3.1": Figure(
        "Response of one observer channel to a step of external torque for four gains, with 1 - exp(-K t) dashed "
        "(computed). The book shows the block diagram.",
        "Response of the observer and of a first-order lag over time.",
    ),
    "3.11": Figure(
        "Force on the forearm, the external torque of the three joints it loads most (pale and wide: true; thin: "
        "observed; two of the true ones coincide), with the nominal model and with an exact one, and Dis_R, during a "
        "push of {.push.force:g} N along y in reach 1. Simulated; the arm may touch box and lid, and "
        "does not. The book plots force, torque and distance.",
        "Force, observed and true torques and the distance to the opening over time during a push, for two models.",
    ),
    "3.12": Figure(
        "Distance to the target and Dis_R during the same push with and without observer compensation and null-space "
        "torque (simulated).",
        "Distances to target and opening over time during a push, with and without compensation and null-space torque.",
    ),
    "3.B": Figure(
        "Observer gain: relative error of the observed torque over the push, without and with noise on the momentum "
        "(replayed from the recorded push with an exact model; ours, after the remark below Eq. (3.20)).",
        "Error of the observer over its gain, with and without noise.",
    ),
}
UNITS = {
    "push": "N", "tracking": "m", "observed": "N m", "external": "N m", "nodes": "1", "contact": "1, N, m",
    "error": "m", "rcm_distance": "m",
}  # fmt: skip
TABLES = {"T3.B": "Push: laws, models and directions", "T3.C": "Observer gain: lag and relative error"}
FILM = Film(
    "plus", "A push on the forearm moves the arm by millimetres; it returns when let go.", FILMED,
    "rcm_distance", "Dis_R [mm]", scale=1e3, span=(4.0, 9.5),
)  # fmt: skip
JOINTS = ("s0", "s1", "e0", "e1", "w0", "w1", "w2")


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figures: dict[str, Any] = {"3.1": _draw_steps()}
    if "plus" in recordings:
        figures["3.11"] = _draw_torques(recordings, metrics, config)
        figures["3.12"] = _draw_effect(recordings, metrics, config)
    if "exact_plus" in recordings:
        figures["3.B"] = _draw_sweep(recordings["exact_plus"].frames["sweep"])
    return figures


def _draw_steps() -> Drawing:
    figure, axes = style.subplots(width=style.ONE_COLUMN, height=2.3)
    step, unit = 1e-3, np.eye(1)
    for gain, line in zip((5, 20, 50, 200), ("extra1", "rival", "book", "extra2")):
        observer, velocity, seen = MomentumObserver(gain=gain, dt=step), 0.0, []
        for _ in range(400):
            seen.append(float(observer(unit, np.array([velocity]), np.zeros(1), np.zeros(1))[0]))
            velocity += step  # unit mass under a unit external torque
        time = step * np.arange(400)
        axes.plot(time, seen, label=f"$K_{{Ex}}$ = {gain}/s", **style.LINES[line])
        label = r"$1 - \exp(-K_{Ex} t)$" if gain == 200 else None
        axes.plot(time, 1 - np.exp(-gain * time), label=label, **style.LINES["reference"])
    axes.set(xlabel="Time [s]", ylabel=r"Observed $\sigma_i$ [N m]")
    axes.legend(loc="lower right")
    return style.title(figure, r"The observer lags by 1/$K_{Ex}$")


def _draw_torques(recordings: Recordings, metrics: Any, config: Config) -> Drawing:
    recording, push = recordings["plus"], config.cases["plus"].push
    figure, (force, top, middle, bottom) = style.subplots(4, 1, height=6.0, sharex=True, height_ratios=(1, 2, 2, 1.4))
    force.plot(recording.time, recording["push.y"], **style.LINES["reference"])
    force.set_ylabel("$F_y$ [N]")
    busiest = np.abs(recording["external"]).max(axis=0).argsort()[::-1][:3]
    error = config.cases["plus"].model.mass_error
    for axes, case in ((top, "plus"), (middle, "exact_plus")):
        run = recordings.get(case, recording)
        for joint, line in zip(sorted(busiest), ("book", "rival", "extra1")):
            wide = {"color": style.LINES[line]["color"], "linewidth": 4.0, "alpha": 0.3}
            axes.plot(run.time, run["external"][:, joint], **wide)
            axes.plot(run.time, run["observed"][:, joint], label=JOINTS[joint], **style.LINES[line])
        axes.set_ylabel(r"$\tau_{Ex}$ [N m]")
    bottom.plot(recording.time, 1e3 * recording["rcm_distance"], **style.LINES["book"])
    top.legend(loc="upper right", title="joint")
    shown = (push.start - 1, push.start + push.duration + 2.1)
    bottom.set(xlabel="Time [s]", ylabel="$Dis_R$ [mm]", xlim=shown)
    bottom.set_ylim(0, 1.2e3 * recording["rcm_distance"][recording.between(shown[0])].max())
    force.margins(y=0.35)
    for axes in (force, top, middle, bottom):
        style.phase(axes, push.start, push.start + push.duration, "push" if axes is force else "")
    style.panels(
        (force, top, middle, bottom), "force on the forearm",
        f"external torque, model with {abs(error):.0%} error in masses (pale: true)",
        "external torque, model with exact masses", "distance of the arm to the remote centre",
    )  # fmt: skip
    errors = [100 * metrics[case]["observer_error"] for case in ("plus", "exact_plus") if case in metrics]
    found = f", with an exact model by {errors[1]:.0f} %" if len(errors) > 1 else ""
    return style.title(figure, f"The observed torque errs by {errors[0]:.0f} %, mostly unknown weight{found}")


CURVES = {
    "plus": ("whole method", "book"),
    "plain_plus": ("without observer torque", "extra1"),
    "free_plus": ("without null-space torque", "extra2"),
    "pos_plus": ("position-only task", "rival"),
    "posplain_plus": ("position-only, without observer", "plain"),
}


def _draw_effect(recordings: Recordings, metrics: Any, config: Config) -> Drawing:
    figure, (left, right) = style.subplots(1, 2, height=2.9)
    push = config.cases["plus"].push
    style.curves(left, recordings, CURVES, "error", 1e3)
    style.curves(right, recordings, CURVES, "rcm_distance", 1e3)
    for axes in (left, right):
        style.phase(axes, push.start, push.start + push.duration, "push")
        axes.set(xlabel="Time [s]", xlim=(push.start - 1, push.start + push.duration + 2.1))
    left.set(ylabel=r"$\|\tilde X\|$ [mm]", ylim=(0, 18))
    right.set(ylabel="$Dis_R$ [mm]", ylim=(0, 80))
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncol=3)
    found = metrics["plus"]
    peak, tip = 1e3 * found["rcm_peak"], 1e3 * found["error_peak"]
    return style.title(
        figure,
        f"{push.force:g} N move the arm {peak:.1f} mm off the centre and the end point by {tip:.1f} mm",
    )


def _draw_sweep(table: pd.DataFrame) -> Drawing:
    figure, axes = style.subplots(width=style.ONE_COLUMN, height=2.4)
    for kind, word, marker, line in (("clean", "exact", "o", "book"), ("noisy", "noisy", "s", "rival")):
        axes.plot(table.gain, 100 * table[f"{kind}_error"], marker=marker, markersize=3, label=f"{word} momentum",
                  **style.LINES[line])  # fmt: skip
    axes.set(xscale="log", yscale="log", xlabel="$K_{Ex}$ [1/s]", ylabel="Error of $\\sigma$ [%]")
    axes.legend()
    best = table.gain.iloc[int(table.noisy_error.argmin())]
    return style.title(figure, f"With noise the best gain is near {best:g}/s")


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    names = ("observer_error", "observer_change_error", "observer_lag", "rcm_rest", "rcm_peak", "rcm_final",
             "rcm_recovery_time", "error_peak", "limit_margin", "finished")  # fmt: skip
    along = {case: values.push.force * values.push.direction[1] for case, values in config.cases.items()}
    rows = [
        {"case": case, "push y [N]": along[case], **{name: values.get(name) for name in names}}
        for case, values in metrics.items()
        if case in along
    ]
    tables = {"T3.B": headed(rows)}
    if "exact_plus" in recordings:
        headers = {
            "gain": "K_Ex [1/s]",
            "clean_error": "error [-]",
            "lag": "lag [s]",
            "noisy_error": "error, noise [-]",
        }
        tables["T3.C"] = recordings["exact_plus"].frames["sweep"].rename(columns=headers)
    return tables
