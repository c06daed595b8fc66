"""What ``arm_obstacles`` shows: its figures and tables."""

from __future__ import annotations

import numpy as np
import pandas as pd

from dexrepro.arrays import Array
from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Film, Metrics, Recording, Recordings
from dexrepro.physics.rendering import Camera
from dexrepro.report import style

from .experiment import BOXES, TOP

FIGURES = {
    "6.3": Figure(
        "The simulated scene from above: two old boxes (orange), the new one (blue), the learned path (grey) and the "
        "constrained one. The book shows a photograph of the same arrangement.",
        "Boxes from above with the learned and the constrained path.",
    ),
    "6.4": Figure(
        "Simulated arm on the learned path at five instants (contacts off) and the smallest distance of the whole arm "
        "to each box. The book shows photographs.",
        "Five pictures of the arm among the boxes, and its distance to each over time, on the learned path.",
    ),
    "6.5": Figure(
        "Simulated arm on the constrained path at five instants and the smallest distance of the whole arm to each "
        "box.",
        "Five pictures of the arm among the boxes, and its distance to each over time, on the constrained path.",
    ),
}
UNITS = {
    "distance_first": "m", "distance_second": "m", "distance_new": "m", "desired": "m", "reference": "m",
    "projected": "1", "contact_first": "N", "contact_second": "N", "contact_new": "N",
}  # fmt: skip
TABLES = {"T6.Sc": "Variants of the detour, the law and the contacts on the arm"}
FILM = Film(
    "constrained", "The constrained path takes the whole arm round the new, blue box.",
    Camera(target=(0.5, -0.25, 0.13), distance=1.5, yaw=40.0, pitch=-35.0, field_of_view=45.0), "distance_new",
    "Distance to the new box [mm]", scale=1e3,
)  # fmt: skip


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    rows = []
    for case, numbers in metrics.items():
        distances = {f"arm to {name} box [cm]": 100 * float(numbers[f"distance_{name}"] or 0) for name in BOXES}
        rest = {
            "tip path to new box [cm]": None if numbers["path_to_new"] is None else 100 * numbers["path_to_new"],
            "largest distance to reference [cm]": numbers["e_max"],
            "projected steps": numbers["projections"],
            "contact peak [N]": numbers.get("contact_peak"),
        }
        rows.append({"case": case, **distances, **rest})
    return {"T6.Sc": pd.DataFrame(rows)}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figures = {}
    for identifier, case in (("6.4", "original"), ("6.5", "constrained")):
        if case in recordings:
            figures[identifier] = _draw_run(recordings[case], metrics[case])
    if {"original", "constrained"} <= set(recordings):
        figures["6.3"] = _draw_scene(recordings["original"], recordings["constrained"], metrics, config)
    return figures


def _draw_scene(original: Recording, constrained: Recording, metrics: AllMetrics, config: Config) -> Drawing:
    figure, axes = style.subplots(width=style.ONE_COLUMN, height=3.0)
    image = constrained.images["top"]
    axes.imshow(image)
    for run, line in (
        (original, {**style.LINES["plain"], "label": "learned path"}),
        (constrained, {**style.LINES["book"], "label": "constrained path"}),
    ):
        axes.plot(*_pixels(run["desired"], image.shape).T, **line)
    figure.legend(loc="outside lower center", ncols=2)
    for name, text, shift in (("first", "old", -30), ("second", "old", 16), ("new", "new", -32)):
        spot = _pixels(np.array(config.boxes[name]), image.shape)
        axes.annotate(text, spot, xytext=(shift, -2), textcoords="offset points", fontsize=7)
    axes.set(xlim=(0, image.shape[1]), ylim=(image.shape[0], 0))
    axes.axis("off")
    before, after = (f"{100 * (metrics[case]['distance_new'] or 0.0):.1f}" for case in ("original", "constrained"))
    finding = f"From arm to new box: {before} cm on the learned path, {after} cm on the constrained one"
    return style.title(figure, finding)


def _pixels(points: Array, shape: tuple[int, ...]) -> Array:
    """Where points (n, 2) [m] at the height of the camera's target appear in the picture from above."""
    scale = shape[0] / 2 / np.tan(np.radians(TOP.field_of_view) / 2) / TOP.distance
    offset = (points - np.array(TOP.target[:2])) * scale
    return np.array([shape[1], shape[0]]) / 2 + offset * [1, -1]


def _draw_run(run: Recording, numbers: Metrics) -> Drawing:
    shots = style.trimmed({name: run.images[name] for name in sorted(run.images) if name != "top"})
    figure = style.plt.figure(figsize=(style.TWO_COLUMNS, 3.5))
    grid = figure.add_gridspec(2, len(shots), height_ratios=[1.1, 1.3])
    for i, (name, image) in enumerate(shots.items()):
        axes = figure.add_subplot(grid[0, i])
        style.photo(axes, image)
        style.panel(axes, "abcdef"[i], f"{name.partition('_')[2]} s")
    axes = figure.add_subplot(grid[1, :])
    for name, line in zip(BOXES, ("extra1", "extra2", "book")):
        axes.plot(run.time, 100 * run[f"distance_{name}"], label=f"{name} box", **style.LINES[line])
    axes.axhline(0, **style.LINES["reference"])
    axes.set(xlabel="Time [s]", ylabel="Distance of arm [cm]")
    axes.set_ylim(top=15)
    axes.legend(loc="upper center", ncols=3, bbox_to_anchor=(0.5, 1.2))
    closest = {name: 100 * float(numbers[f"distance_{name}"] or 0) for name in BOXES}
    if closest["new"] < 0:
        text = f"On the learned path the arm runs {-closest['new']:.1f} cm into the new box"
    else:
        least = style.at_least(min(closest.values()), 1)
        text = f"On the constrained path the whole arm clears the boxes by {least} cm or more"
    return style.title(figure, text)
