"""What ``skeleton_constraints`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Array
from dexrepro.chapters.chapter6 import bimanual
from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Metrics, Recording, Recordings
from dexrepro.report import style

from .experiment import SIDES

FIGURES = {
    "6.6": Figure(
        "Synthetic person carrying the box: joints at six instants, front view, link lengths in cm. The book shows "
        "photographs of a person.",
        "Stick figure of the synthetic person with the box at six instants.",
    ),
    "6.7": Figure(
        "Distance of the synthetic person's joints to the median of ten demonstrations (band from smallest to largest; "
        "left green, right blue) and the 95th percentiles. The book shows the bands; our noise levels set the ratio.",
        "Bands of distances to the median for wrists, elbows and shoulders, and their percentiles.",
    ),
    "6.8": Figure(
        "Stages of the calculation as the code runs them; same order as in the book.",
        "Block diagram: loop 1 restores lengths outwards, then the hands, then loop 2 restores lengths inwards.",
    ),
    "6.9": Figure(
        "Both arms of the synthetic person from the front at six instants, under the constrained primitives (solid) "
        "and the original ones (dotted); thin: the whole paths of the six joints. The book shows the same in three "
        "dimensions.",
        "Arms at six instants under constrained and original primitives, with the paths of their joints.",
    ),
    "6.10": Figure(
        "Synthetic person: link lengths of the original and of the constrained primitives; shaded: the printed 22 and "
        "28 cm with +-1 cm. The book prints ranges of [12, 52] and [25, 39] cm for the original left arm.",
        "Link lengths over time of both arms, constrained and original, with their margins.",
    ),
    "6.11": Figure(
        "Synthetic person: distance of the hands; shaded: 33 +- 1 cm. The book prints [34, 57] cm for the original "
        "and [24, 25] cm for the constrained primitives, which is outside of its own band.",
        "Hand distance over time, constrained and original, with its margin.",
    ),
}
UNITS = {"truth": "cm", "original": "cm", "joints": "cm"}
TABLES = {
    "T6.B": "Error of the joints to the truth, original and constrained, largest of the groups",
    "T6.Sb": "Variants of noise, law and stages of the two-hand calculation",
}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    rows = []
    for case, numbers in metrics.items():
        shown = ("length_error", "hands_error")
        row = {f"{name.replace('_', ' ')}, {kind} [cm]": numbers[f"{name}_{kind}"] for name in shown
               for kind in ("original", "constrained")}  # fmt: skip
        found = [numbers[f"rmse_shoulder_{side}_constrained"] for side in SIDES]
        shoulders = max((value for value in found if value is not None), default=None)
        rows.append({"case": case, **row, "shoulder rmse [cm]": shoulders, "projected steps": numbers["projections"]})
    tables = {"T6.Sb": pd.DataFrame(rows)}
    if "feedforward" in metrics:
        numbers = metrics["feedforward"]
        tables["T6.B"] = pd.DataFrame(
            {
                "joint": f"{side} {name}",
                "original [cm]": numbers[f"rmse_{name}_{side}_original"],
                "constrained [cm]": numbers[f"rmse_{name}_{side}_constrained"],
            }
            for name in ("shoulder", "elbow", "wrist")
            for side in SIDES
        )
    return tables


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if "feedforward" not in recordings:
        return {}
    run, numbers = recordings["feedforward"], metrics["feedforward"]
    settings = config.cases["feedforward"]
    return {
        "6.6": _draw_person(run, settings),
        "6.7": _draw_spread(run, numbers),
        "6.8": _draw_stages(run),
        "6.9": _draw_paths(run, settings),
        "6.10": _draw_lengths(run, numbers, settings),
        "6.11": _draw_hands(run, numbers, settings),
    }


def _joints(run: Recording, channel: str) -> Array:
    return run[channel].reshape(-1, 2, 3, 3)


def _stick(axes: Any, joints: Any, colour: str, **options: Any) -> None:
    """Both arms of one instant in front view."""
    for side in joints:
        axes.plot(side[:, 0], side[:, 2], "o-", color=colour, markersize=2, linewidth=1, **options)
    axes.plot(*joints[:, 0][:, [0, 2]].T, color=colour, linewidth=0.6, **options)


def _instants(run: Recording, settings: Config) -> Array:
    return np.searchsorted(run.time, np.array(settings.shown_instants) * run.time[-1] * 0.999)


def _draw_person(run: Recording, settings: Config) -> Drawing:
    figure, grid = style.subplots(1, 6, height=1.4, sharex=True, sharey=True)
    joints = _joints(run, "truth")
    for letter, axes, index in zip("abcdef", grid, _instants(run, settings)):
        left, right = joints[index, :, 2]
        axes.plot(
            [left[0], right[0]], [left[2], right[2]], color="#D9B38C", linewidth=9, solid_capstyle="butt", zorder=0
        )
        _stick(axes, joints[index], "#333333")
        axes.set(aspect="equal", xlabel="x [cm]", xlim=(-45, 45), ylim=(-45, 12))
        style.panel(axes, letter, f"{run.time[index]:.1f} s")
    s, (_, right) = settings.skeleton, joints[0]
    for a, b, value, place in ((0, 1, s.upper_arm, (4, -1)), (1, 2, s.forearm, (4, -6))):
        spot = (right[a] + right[b])[[0, 2]] / 2
        grid[0].annotate(f"{value:g}", spot, xytext=place, textcoords="offset points", fontsize=6.5)
    spot = joints[0][:, 2].mean(axis=0)[[0, 2]]
    grid[0].annotate(f"{s.box_length:g}", spot, xytext=(0, -2), textcoords="offset points", fontsize=6.5, ha="center")
    grid[0].set_ylabel("z [cm]")
    return style.title(figure, f"A synthetic person carries a box of {settings.skeleton.box_length:g} cm")


def _draw_spread(run: Recording, numbers: Metrics) -> Drawing:
    figure, grid = style.subplots(1, 4, height=2.4, gridspec_kw={"width_ratios": [1, 1, 1, 1]})
    frame, percentiles = run.frames["spread"], run.frames["percentiles"]
    for letter, name, axes in zip("abc", ("wrist", "elbow", "shoulder"), grid):
        for side, colour in zip(SIDES, (style.EXTRA[0], style.BOOK)):
            low, high = frame[f"{name}_{side}_low"], frame[f"{name}_{side}_high"]
            axes.fill_between(frame.u, low, high, color=colour, alpha=0.45, linewidth=0, label=side)
        axes.set(xlabel="Time / duration [-]", ylim=(0, 14))
        style.panel(axes, letter, name)
    grid[0].set_ylabel("Distance to the\nmedian [cm]")
    figure.legend(*grid[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    for i, name in enumerate(("wrist", "elbow", "shoulder")):
        for side, colour, shift in zip(SIDES, (style.EXTRA[0], style.BOOK), (-0.2, 0.2)):
            values = percentiles[f"{name}_{side}"]
            grid[3].bar(i + shift, values.mean(), 0.38, color=colour, alpha=0.6)
            grid[3].plot(np.full(len(values), i + shift), values, "k.", markersize=3)
    grid[3].set_xticks(range(3), ("wrist", "elbow", "shoulder"))
    grid[3].set_ylabel("95th percentile [cm]")
    style.panel(grid[3], "d", "three groups")
    ratio = f"{numbers['spread_ratio_low']:.1f} to {numbers['spread_ratio_high']:.1f}"
    return style.title(figure, f"With the noise that we chose the wrists spread {ratio} times as far as the shoulders")


def _draw_stages(run: Recording) -> Drawing:
    figure, axes = style.subplots(height=1.1)
    axes.set(xlim=(0, 10), ylim=(0, 1))
    axes.axis("off")
    boxes = [("original", ["six primitives"]), *bimanual.stages(), ("result", ["six paths"])]
    before = None
    for x, (name, tracks) in zip((0.6, 2.7, 5.2, 7.7, 9.5), boxes):
        frame = {"boxstyle": "round", "facecolor": "#EAF2F8", "edgecolor": "#0072B2", "linewidth": 0.6}
        box = axes.text(x, 0.5, "\n".join([name, *tracks]), ha="center", va="center", fontsize=7, bbox=frame)
        if before is not None:
            ends = {"patchA": before.get_bbox_patch(), "patchB": box.get_bbox_patch(), "shrinkA": 1, "shrinkB": 1}
            axes.annotate("", (x, 0.5), before.get_position(), arrowprops={"arrowstyle": "->", "lw": 0.8, **ends})
        before = box
    return style.title(figure, "Lengths are restored outwards, then the hands, then lengths inwards")


def _draw_paths(run: Recording, settings: Config) -> Drawing:
    figure, panels = style.subplots(2, 3, height=3.6, sharex=True, sharey=True)
    joints, original = _joints(run, "joints"), _joints(run, "original")
    front = (0, 2)
    for letter, axes, index in zip("abcdef", panels.flat, _instants(run, settings)):
        for side, colour in zip((0, 1), (style.BOOK, style.EXTRA[0])):
            for paths, dashes in ((joints, "-"), (original, ":")):
                axes.plot(
                    *paths[:, side][..., front].transpose(2, 0, 1), color=colour, alpha=0.35, linewidth=0.5, ls=dashes
                )
                arm = paths[index, side][:, front]
                axes.plot(*arm.T, "o", color=colour, markersize=2.5, mfc=colour if dashes == "-" else "white", mew=0.7)
                axes.plot(*arm.T, dashes, color=colour, linewidth=1.3)
        axes.set(aspect="equal")
        style.panel(axes, letter, f"{run.time[index]:.1f} s")
    style.edges(panels, "x [cm]", "z [cm]")
    dark = {"color": "black"}
    names = {"left": {"color": style.BOOK}, "right": {"color": style.EXTRA[0]}, "constrained": dark,
             "original": {**dark, "linestyle": ":"}}  # fmt: skip
    style.legend_below(figure, names)
    moved = np.linalg.norm(joints - original, axis=-1).max(axis=0)
    shoulder, elbow, wrist = (style.at_most(value, 0) for value in moved.max(axis=0))
    text = f"elbows by up to {elbow} cm, wrists by {wrist} cm, shoulders by {shoulder} cm"
    return style.title(figure, f"The constraints move {text}")


def _draw_lengths(run: Recording, numbers: Metrics, settings: Config) -> Drawing:
    figure, panels = style.subplots(1, 2, height=2.4, sharey=True)
    found = {kind: bimanual.lengths(_joints(run, kind)) for kind in ("joints", "original")}
    s, margin = settings.skeleton, settings.link_margin
    for side, (letter, axes) in enumerate(zip("ab", panels)):
        for link, nominal, colour in (("se", s.upper_arm, style.BOOK), ("ew", s.forearm, style.EXTRA[0])):
            style.band(axes, run.time[[0, -1]], nominal - margin, nominal + margin)
            text = {"se": "shoulder-elbow", "ew": "elbow-wrist"}[link]
            axes.plot(run.time, found["joints"][link][:, side], color=colour, label=f"{text}, constrained")
            axes.plot(run.time, found["original"][link][:, side], "--", color=colour, label=f"{text}, original")
        style.panel(axes, letter, f"{SIDES[side]} arm")
    style.edges(panels, "Time [s]", "Link length [cm]")
    panels[1].legend(loc="upper right")
    kept, lost = numbers["length_error_constrained"], numbers["length_error_original"]
    within = style.at_most(kept or 0.0, 2)
    finding = f"Constrained links keep their length within {within} cm, original ones miss it by up to {lost:.0f} cm"
    return style.title(figure, finding)


def _draw_hands(run: Recording, numbers: Metrics, settings: Config) -> Drawing:
    figure, axes = style.subplots(width=style.ONE_COLUMN, height=2.3)
    nominal = settings.skeleton.box_length
    style.band(axes, run.time[[0, -1]], nominal - 1, nominal + 1)
    axes.plot(run.time, bimanual.lengths(_joints(run, "original"))["hands"], label="original", **style.LINES["plain"])
    axes.plot(run.time, bimanual.lengths(_joints(run, "joints"))["hands"], label="constrained", **style.LINES["book"])
    axes.set(xlabel="Time [s]", ylabel="Distance of the hands [cm]")
    axes.legend(loc="upper right")
    before, after = (
        [numbers[f"hands_{kind}_{end}"] for end in ("low", "high")] for kind in ("original", "constrained")
    )
    finding = f"Hands: {before[0]:.0f} to {before[1]:.0f} cm becomes\n{after[0]:.1f} to {after[1]:.1f} cm"
    return style.title(figure, finding)
