"""The arm writes the learned letters while its joint errors stay inside a shrinking bound (Sects. 5.4, 5.5.2)."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter5 import letters, pen
from dexrepro.experiment import Config, Figure, Film, Metrics, Recording
from dexrepro.physics.rendering import Camera
from dexrepro.primitives import DMP, extend
from dexrepro.robots.arm import Pose, Shape
from dexrepro.robots.pen_arm import pen_arm_tip

FIGURES = {
    "5.4": Figure(
        "The simulated three-joint arm with its pen over the sheet, after it has written the learned letter a "
        "(rendered from the run; the book shows a photograph of a haptic device).",
        "A small three-joint arm holds a pen over a written letter a.",
    ),
    "5.5b": Figure(
        "Pen path of the simulated arm (blue) as it writes the learned letters under the adaptive neural controller, "
        "and what it was told to write (dashed); it starts 1 cm off. The book shows what a haptic device drew.",
        "The arm writes a, w, z, k, l and A within a few hundredths of a millimetre.",
    ),
    "5.D": Figure(
        "Joint errors e = q_d - q while the arm writes the letter w, with the prescribed bound (shaded), under the "
        "corrected law, the law without network, PD control with gravity compensation, and the law with the printed "
        "sign of the network; below: joint torques under the corrected law and the largest share of the bound used. "
        "Ours; the book shows no control result.",
        "Only with the corrected sign of the network do the errors vanish inside the shrinking bound.",
    ),
}
TABLES = {
    "T5.G": "Tracking of the letter w under compared laws: share of the bound, errors, torque",
    "T5.H": "Sensitivity of the bound to model, contact, sensors and start",
}
RATE = 100.0
INK = (0.05, 0.1, 0.4, 1.0)
VIEW = Camera(target=(0.10, 0.0, -0.06), distance=0.36, yaw=125.0, pitch=-35.0, field_of_view=42.0)
FILM = Film(
    "letter_a", "The arm writes the learned letter a; its joint errors vanish within the first second.", VIEW,
    "error", "Joint error [mrad]", scale=1e3,
)  # fmt: skip


def simulate(config: Config, rng: Any) -> Recording:
    path = learned_path(config.hand.letter, config, rng)
    target = pen.reference(pen.on_paper(path), config.arm.step)
    nominal = pen.model(config)
    centres = pen.node_centres(config, target, config.network.nodes, rng("nodes"))
    learner = pen.network(config, centres) if config.network.enabled else None
    recording = pen.track(config, target, pen.law(config, nominal, learner), nominal)
    if config.picture == config.hand.letter:
        recording.images["picture"] = _picture(recording, config)
    return recording


def learned_path(letter: str, config: Config, rng: Any) -> Any:
    """What the primitives make of a letter [cm], at the arm's pace: an IDMP grown from the letter a, or a DMP."""
    hand, training = rng("demonstration"), config.training
    shown = {name: letters.demonstration(name, config, hand) for name in config.hand.letters}
    kernels = letters.kernels(config.kernels.count, config, None)

    def fit(name: str) -> DMP:
        scaling, decay = letters.letter_scaling(config), config.dmp.decay
        options = {"rest": training.rest, "rcond": training.rcond}
        return DMP.fit(shown[name], kernels, letters.system(config), decay, scaling, **options)

    primitive = fit(config.hand.base if letter in config.hand.targets else letter)
    if letter in config.hand.targets:
        features = letters.features(kernels, config.features.count, config, rng("features"))
        options = {"rest": training.rest, "rcond": training.rcond, "relearn_old": training.relearn_old}
        primitive = extend(primitive, features, shown[letter], **options)
    duration = config.arm.duration
    return primitive.rollout(config.arm.step, horizon=duration, time_constant=duration).position


def scene(config: Config) -> Any:
    """The arm over its sheet of paper, without a law."""
    world = pen.world(config, np.zeros(3))
    world.add_box("paper", (0.07, 0.07, 0.001), (0.165, 0.0, pen.HEIGHT - 0.001), colour=(1, 1, 1, 1), collides=False)
    world.add_box(
        "table", (0.3, 0.3, 0.01), (0.12, 0.0, pen.HEIGHT - 0.008), colour=(0.8, 0.82, 0.85, 1), collides=False
    )
    return world


def stage(world: Any, recording: Recording, config: Config) -> Recording:
    """Shows the ink: short strokes that wait below the table until the pen has made them."""
    tip = recording["arm.tip"]
    marks = np.linspace(0, len(tip) - 1, 33).astype(int)
    for k, (first, last) in enumerate(itertools.pairwise(marks)):
        beads = [Shape("box", (0.0013, 0.0013, 0.0006), Pose(tuple(tip[i])), INK) for i in range(first, last, 3)]
        world.add_body(f"ink{k}", beads, (0, 0, 0), collides=False)
        recording.series[f"ink{k}.pose"] = np.where(np.arange(len(tip)) < last, -1.0, 0.0)[:, None] * [0.0, 0.0, 1.0]
    return recording


def _picture(recording: Recording, config: Config) -> Any:
    """The arm at the end of its letter, the ink as a chain of beads."""
    tip = recording["arm.tip"][:: max(1, len(recording.time) // 400)]
    ink = tuple(Shape("sphere", (0.0007,), Pose(tuple(point)), INK) for point in tip.tolist())
    with scene(config) as world:
        for first in range(0, len(ink), 16):
            world.add_body(f"ink{first}", ink[first : first + 16], (0, 0, 0), collides=False)
        return world.render({"arm": recording["arm.position"][-1]}, camera=VIEW, size=(900, 640))


def measure(recording: Recording, config: Config) -> Metrics:
    return pen.quality(recording, config)


def draw(recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics], config: Config) -> dict[str, Any]:
    figures = {}
    written = [case for case in recordings if case.startswith("letter_")]
    if written:
        figures["5.5b"] = _draw_letters(written, recordings, metrics)
    if "letter_a" in recordings:
        figures["5.4"] = _draw_picture(recordings["letter_a"])
    if set(SHOWN) <= set(recordings):
        figures["5.D"] = _draw_errors(recordings, metrics, config)
    return figures


SHOWN = {
    "letter_w": ("corrected", "book"),
    "no_network": ("no network", "rival"),
    "pd": ("PD + gravity", "plain"),
    "printed_sign": ("printed sign", "printed"),
}


def _draw_letters(cases: list[str], recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics]) -> Any:
    from dexrepro.report import style

    figure, axes = style.subplots(1, len(cases), height=2.0, sharex=True, sharey=True, squeeze=False)
    for panel, case in zip(axes[0], cases):
        drawn = pen.from_paper(recordings[case]["arm.tip"])
        told = pen.from_paper(pen_arm_tip(recordings[case]["desired"]))
        panel.plot(*drawn.T, **style.LINES["book"])
        panel.plot(*told.T, **style.LINES["reference"])
        panel.set(aspect="equal", xlabel="x [cm]")
        panel.set_title(f"{case[-1]}: {1e3 * metrics[case]['tip_rms']:.0f} µm")  # type: ignore[operator]
    axes[0, 0].set_ylabel("y [cm]")
    worst = max(metrics[case]["tip_rms"] for case in cases)  # type: ignore[type-var]
    style.title(figure, f"After 1 s the arm writes every letter within {worst:.2f} mm (RMS of the pen's point)")
    return figure


def _draw_picture(recording: Recording) -> Any:
    from dexrepro.report import style

    figure, axes = style.plt.subplots(figsize=(style.ONE_COLUMN, 2.4))
    axes.imshow(style.trimmed({"a": recording.images["picture"]})["a"])
    axes.set_axis_off()
    style.title(figure, "The simulated arm has written the letter a")
    return figure


def _draw_errors(recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics], config: Config) -> Any:
    from dexrepro.report import style

    figure, grid = style.subplots(3, 4, height=4.8, sharex=True)
    bound = config.bound
    for column, (case, (name, line)) in zip(grid.T, SHOWN.items()):
        recording = recordings[case]
        time = recording.time
        limit = 1e3 * ((bound.initial - bound.final) * np.exp(-bound.decay * time) + bound.final)
        style.band(column[0], time, -bound.lower * limit, bound.upper * limit)
        for joint, dashes in zip(range(3), ("-", "--", ":")):
            column[0].plot(time, 1e3 * recording["error"][:, joint], color=style.LINES[line]["color"], linestyle=dashes)
            column[2].plot(
                time,
                recording["arm.torque"][:, joint],
                color=style.LINES[line]["color"],
                linestyle=dashes,
                linewidth=0.7,
            )
        column[1].plot(time, pen.bound_use(recording, config), color=style.LINES[line]["color"])
        column[1].axhline(1, **style.LINES["reference"])
        column[0].set(ylim=(-160, 160), title=name)
        column[1].set(yscale="log", ylim=(3e-4, 5))
        column[2].set(ylim=(-0.55, 0.55), xlabel="Time [s]")
    for axes, text in zip(
        grid[:, 0], ("Joint error e\n[mrad]", "Largest share\nof the bound [-]", "Joint torque\n[N m]")
    ):
        axes.set_ylabel(text)
    for axes in grid[:, 1:].flat:
        axes.tick_params(labelleft=False)
    joints = {"joint 1": "-", "joint 2": "--", "joint 3": ":"}
    style.legend_below(figure, {name: {"color": style.REFERENCE, "linestyle": line} for name, line in joints.items()})
    share = metrics["letter_w"]["bound_use"] or 0.0
    style.title(
        figure, f"With the sign of the network corrected the errors use at most {100 * share:.0f} % of the bound"
    )
    return figure


LAWS = (
    *(
        "letter_w",
        "tuned",
        "no_network",
        "no_barrier",
        "no_network_no_barrier",
        "pd",
        "pd_stiff",
        "pd_tuned",
        "pd_stiffest",
    ),
    *("printed", "printed_no_robust", "printed_sign", "printed_gain", "printed_robust", "sign_only", "sign_robust"),
)
SENSITIVITY = (
    *("letter_w", "light_model", "heavy_model", "rough_paper", "near_edge", "outside", "encoders", "encoders_slow"),
    *("tuned_encoders", "pd_tuned_encoders", "pd_stiffest_encoders", "exponential", "exponential_slow", "small_robust"),
    "printed_gain_no_network",
)


def tabulate(recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics], config: Config) -> dict[str, Any]:
    names = {
        "bound_use": "largest share of the bound",
        "outside": "share of the time outside",
        "error_rms": "joint error RMS [mrad]",
        "tip_rms": "tip error RMS [mm]",
        "torque_max": "largest torque [N m]",
        "torque_step": "torque change a step RMS [N m]",
    }
    return {
        table: pd.DataFrame(
            {"case": case, **{text: metrics[case][name] for name, text in names.items()}}
            for case in cases
            if case in metrics
        )
        for table, cases in (("T5.G", LAWS), ("T5.H", SENSITIVITY))
    }
