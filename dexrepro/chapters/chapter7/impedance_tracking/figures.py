"""What ``impedance_tracking`` shows: its figures and tables."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter7 import desk, skills
from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Film, Recording, Recordings
from dexrepro.report import style

from .experiment import PICTURES

FIGURES = {
    "7.10": Figure(
        "The simulated arm grasps the cube, carries it past the 4 cm stack and puts it down; rendered from the "
        "recorded joint angles. The book shows photographs of a joystick with a gripper.",
        "Six pictures of the arm carrying a cube around the green stack.",
    ),
    "7.11": Figure(
        "(a-c) Joint torques under the corrected law with the printed k_s = 10 and, dashed, the gravity torque that "
        "the nominal model knows (it knows neither gripper, cube nor friction); the cube is picked up at {.pick:g} s "
        "and put down at {.release:g} s. (d, e) Planned and real path of the tip from above and its height; (f) error "
        "of the tip with and without time-delay estimation, same gains. Simulated; PyBullet, torque control.",
        "Torques of three joints, planned and real path, and the error of the tip with and without estimation.",
    ),
}
UNITS = {
    "reference": "rad", "planned": "m", "filtered_error": "rad/s", "impedance": "N m s/rad", "stiffness": "1",
    "modelled": "N m", "push": "N",
}  # fmt: skip
TABLES = {"T7.C": "Tracking under the compared laws"}
FILM = Film(
    "muscle", "The arm carries the cube past the stack; its tip stays within micrometres of the plan.", desk.CAMERA,
    "tracking", "Error of the tip [µm]", scale=1e6,
)  # fmt: skip


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figures = {}
    if "muscle" in recordings:
        if recordings["muscle"].images:
            figures["7.10"] = draw_pictures(recordings["muscle"])
        figures["7.11"] = draw_tracking(recordings, metrics, config)
    return figures


def draw_pictures(recording: Recording) -> Drawing:
    words = {"a": "grasp", "f": "release"}
    figure, axes = style.subplots(2, 3, height=4.6)
    titles = {k: f"({k}) {words.get(k, 'transport')}, {instant:g} s" for k, instant in PICTURES.items()}
    style.photos(axes.flat, recording.images, titles)
    return style.title(figure, "The arm carries the cube past the stack (simulated)")


def draw_tracking(recordings: Recordings, metrics: Mapping[str, Any], config: Config) -> Drawing:
    from dexrepro.chapters.chapter7 import pictures as views

    recording, case = recordings["muscle"], config.cases.muscle
    figure = style.plt.figure(figsize=(style.TWO_COLUMNS, 4.4))
    grid = figure.add_gridspec(2, 6)
    for k, (letter, name) in enumerate(zip("abc", ("yaw", "shoulder", "elbow"))):
        panel = figure.add_subplot(grid[0, 2 * k : 2 * k + 2])
        panel.plot(recording.time, recording["modelled"][:, k], **style.LINES["reference"])
        panel.plot(recording.time, recording["arm.torque"][:, k], **style.LINES["book"])
        for instant, word in ((case.pick, "pick"), (case.release, "release")):
            style.event(panel, instant, word)
        panel.set(xlabel="Time [s]", ylabel="Torque [N m]" if k == 0 else "", xlim=(0, recording.time[-1]))
        panel.margins(y=0.15)
        style.panel(panel, letter, f"joint {k + 1}, {name}")
    plan, side, error = (figure.add_subplot(grid[1, 2 * k : 2 * k + 2]) for k in range(3))
    task = skills.Reach(case.task.start, case.task.goal)
    obstacle = skills.Obstacle(case.task.obstacle, case.task.height, case.scene.cube)
    for channel, line in (("arm.tip", "book"), ("planned", "reference")):
        views.plan(plan, desk.to_board(recording[channel]), **style.LINES[line])
        views.side(side, desk.to_board(recording[channel]), task, **style.LINES[line])
    views.footprint(plan, obstacle)
    views.profile(side, obstacle, task)
    views.ends(plan, task)
    plan.set_aspect("equal")
    plan.set(xlabel="x [cm]", ylabel="y [cm]", ylim=(-1, 9))
    side.set(xlabel="Along the straight line [cm]", ylabel="z [cm]", ylim=(0, 5))
    style.panel(plan, "d", "planned (dashed) and real")
    for name, line, label in (("muscle", "book", "with estimation"), ("no_estimation", "plain", "without")):
        if name in recordings:
            distance = desk.tip_error(recordings[name])
            error.semilogy(recordings[name].time, np.maximum(distance, 1e-6), label=label, **style.LINES[line])
    error.set(xlabel="Time [s]", ylabel="Tip error [mm]", ylim=(1e-5, 10))
    error.legend(loc="center right", bbox_to_anchor=(1.0, 0.68))
    style.panel(side, "e", "height")
    style.panel(error, "f", "error of the tip")
    found = 1e3 * metrics["muscle"]["rms_error"]
    return style.title(figure, f"The tip follows the plan to {found:.1f} µm although gripper and cube are unmodelled")


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    rows = []
    for case, values in metrics.items():
        law = config.cases[case].law
        impedance = law.impedance
        gain = next((impedance[key] for key in ("stiffness_gain", "gain") if key in impedance), None)
        rows.append(
            {
                "case": case,
                "K_imp": impedance["_target_"].rpartition(".")[2].removesuffix("Impedance").lower(),
                "k_s or K": gain,
                "k [1/s]": law.error_slope,
                "finished": bool(values["finished"]),
                "diverged at [s]": values["diverged_at"],
                "RMS tip error [mm]": values["rms_error"],
                "largest tip error [mm]": values["largest_error"],
                "torque travel a joint [N m]": values["torque_travel"],
            }
        )
    return {"T7.C": pd.DataFrame(rows)}
