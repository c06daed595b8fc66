"""What ``bounded_tracking`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import numpy as np

from dexrepro.chapters.chapter5 import pen
from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Film, Recordings, changed
from dexrepro.report import style
from dexrepro.report.tables import by_case
from dexrepro.robots.pen_arm import pen_arm_tip

from .experiment import VIEW

FIGURES = {
    "5.4": Figure(
        "The simulated three-joint arm with its pen over the sheet, after it has written the learned letter a "
        "(rendered from the run; the book shows a photograph of a haptic device).",
        "A small three-joint arm holds a pen over a written letter a.",
    ),
    "5.5b": Figure(
        "Pen path of the simulated arm (blue) as it writes the learned letters under the adaptive neural controller, "
        "and what it was told to write (dashed); it starts 1 cm off. In the letters' own centimetres: on the paper "
        "they are 0.8 times as high. The book shows what a haptic device drew.",
        "Pen paths of the arm and what it was told to write, for six letters.",
    ),
    "5.D": Figure(
        "Joint errors e = q_d - q while the arm writes the letter w, with the prescribed bound (shaded), under the "
        "corrected law, the law without network, tuned PD control with gravity compensation, and the law with the "
        "printed sign of the network; below: the largest share of the bound that they use, and the joint torques. The "
        "share at the start is the initial error that we chose. Ours; the book shows no control result.",
        "Joint errors, share of the bound and joint torques over time under four laws.",
    ),
}
UNITS = {"drag": "N", "velocity_error": "rad/s", "desired": "rad", "error": "rad"}
TABLES = {
    "T5.G": "Tracking of the letter w under compared laws: share of the bound, errors, torque",
    "T5.H": "Sensitivity of the bound to model, contact, sensors and start",
}
FILM = Film(
    "letter_a", "The arm writes the learned letter a; its joint errors vanish within the first second.", VIEW,
    "error", "Joint error [mrad]", scale=1e3,
)  # fmt: skip


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figures = {}
    written = [case for case in recordings if changed(config.cases[case], config) <= {"hand.letter"}]
    if written:
        figures["5.5b"] = _draw_letters(written, recordings, metrics, config)
    if "letter_a" in recordings:
        figures["5.4"] = style.picture(
            recordings["letter_a"].images["picture"], "The simulated arm has written the letter a", 2.4
        )
    if set(SHOWN) <= set(recordings):
        figures["5.D"] = _draw_errors(recordings, metrics, config)
    return figures


SHOWN = {
    "letter_w": ("corrected", "book"),
    "no_network": ("no network", "rival"),
    "pd_tuned": ("PD, tuned", "plain"),
    "printed_sign": ("printed sign", "printed"),
}


def _draw_letters(cases: list[str], recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawing:
    figure, axes = style.subplots(1, len(cases), height=2.0, sharex=True, sharey=True, squeeze=False)
    for panel, case in zip(axes[0], cases):
        drawn = pen.from_paper(recordings[case]["arm.tip"])
        told = pen.from_paper(pen_arm_tip(recordings[case]["desired"]))
        panel.plot(*drawn.T, **style.LINES["book"])
        panel.plot(*told.T, **style.LINES["reference"])
        panel.set(aspect="equal", xlabel="x [cm]")
        panel.set_title(f"{config.cases[case].hand.letter}: {1e3 * metrics[case]['tip_rms']:.0f} µm")  # type: ignore[operator]
    axes[0, 0].set_ylabel("y [cm]")
    worst = max(metrics[case]["tip_rms"] for case in cases)  # type: ignore[type-var]
    return style.title(
        figure,
        f"After 1 s the arm writes every letter within {style.at_most(worst or 0.0, 2)} mm (RMS of the pen's point)",
    )


def _draw_errors(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawing:
    figure, grid = style.subplots(3, 4, height=4.8, sharex=True)
    bound = config.bound
    for column, (case, (name, line)) in zip(grid.T, SHOWN.items()):
        recording = recordings[case]
        time = recording.time
        limit = 1e3 * ((bound.initial - bound.final) * np.exp(-bound.decay * time) + bound.final)
        style.band(column[0], time, -bound.lower * limit, bound.upper * limit)
        for joint, dashes in zip(range(3), ("-", "--", ":")):
            column[0].plot(time, 1e3 * recording["error"][:, joint], color=style.LINES[line]["color"], linestyle=dashes)
            column[2].plot(time, recording["arm.torque"][:, joint], color=style.LINES[line]["color"], linestyle=dashes,
                           linewidth=0.7)  # fmt: skip
        column[1].plot(time, pen.bound_use(recording, config), color=style.LINES[line]["color"])
        column[1].axhline(1, **style.LINES["reference"])
        column[0].set(ylim=(-160, 160), title=name)
        column[1].set(yscale="log", ylim=(3e-4, 5))
        column[2].set_ylim(-0.55, 0.55)
    style.edges(grid, "Time [s]", ("Joint error e\n[mrad]", "Largest share\nof the bound [-]", "Joint torque\n[N m]"))
    for axes in grid[:, 1:].flat:
        axes.tick_params(labelleft=False)
    joints = {"joint 1": "-", "joint 2": "--", "joint 3": ":"}
    style.legend_below(figure, {name: {"color": style.REFERENCE, "linestyle": line} for name, line in joints.items()})
    law, rival, printed = (metrics[case]["bound_use"] or 0.0 for case in ("letter_w", "pd_tuned", "printed_sign"))
    return style.title(
        figure,
        f"The corrected law uses {100 * law:.0f} % of the bound, its initial error, tuned PD {100 * rival:.0f} %; "
        f"with the printed sign of the network it is {100 * printed:.0f} %",
    )


LAWS = (
    *("letter_w", "tuned", "integrator", "no_network", "no_barrier", "no_network_no_barrier", "pd", "pd_stiff"),
    *("pd_tuned", "printed", "printed_forgetting", "printed_no_robust", "printed_sign"),
    *("printed_gain", "printed_robust", "sign_only", "sign_robust"),
)
SENSITIVITY = (
    *("letter_w", "light_model", "heavy_model", "rough_paper", "near_edge", "outside", "encoders", "encoders_slow"),
    *("tuned_encoders", "pd_tuned_encoders", "exponential", "exponential_slow", "small_robust"),
    "printed_gain_no_network",
)


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, Any]:
    names = {
        "bound_use": "largest share of the bound",
        "outside": "share of the time outside",
        "error_rms": "joint error RMS [mrad]",
        "tip_rms": "tip error RMS [mm]",
        "torque_max": "largest torque [N m]",
        "torque_step": "torque change a step RMS [N m]",
    }
    return {"T5.G": by_case(metrics, names, LAWS), "T5.H": by_case(metrics, names, SENSITIVITY)}
