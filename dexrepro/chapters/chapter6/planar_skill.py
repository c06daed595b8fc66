"""Planar map: two sub-skills learned from demonstrations, and two ways to a reference path (Figs. 6.1, 6.2 a-c)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter6 import plane
from dexrepro.experiment import Config, Figure, Metrics, Recording
from dexrepro.primitives.obstacles import Polygon, clearance
from dexrepro.primitives.reference_path import lagrange

FIGURES = {
    "6.1": Figure(
        "Simulated map with demonstrations (thin lines), the old obstacles (orange), the additional block (light blue) "
        "and the operator's arc (dots). The book shows a board of 20 x 16 cm; its obstacles are not printed.",
        "Five demonstrated paths pass the old obstacles; the additional block lies across them.",
    ),
    "6.2a": Figure(
        "The two sub-skills learned from five demonstrations that were cut at a change point. The book shows the same.",
        "The learned path passes the old obstacles but cuts through the additional block.",
    ),
    "6.2b": Figure(
        "Reference path by cubic splines (thin) between the kept parts of the learned path and the arc.",
        "The spline reference clears all obstacles and keeps most of the learned path.",
    ),
    "6.2c": Figure(
        "Reference path by extended primitives: sub-skill 1 with its goal moved to the arc's start, sub-skill 2 with "
        "its start moved to the arc's end; crosses mark samples inside an obstacle. The book reports such collisions.",
        "Extending whole sub-skills leads the path through the old obstacles.",
    ),
}
TABLES = {"T6.Sa": "Variants of the map, of the segmentation and of the intervals, and what they change"}
RATE = 0.0


def simulate(config: Config, rng: Any) -> Recording:
    lessons = plane.teach(config, rng("demonstrations"))
    rows, frames = [], {}
    for group, lesson in enumerate(lessons):
        row, lines = _study(config, lesson)
        rows.append(row)
        if group == 0:
            frames = lines
    return Recording(frames={"groups": pd.DataFrame(rows), **frames}, steps=len(lessons))


def _study(config: Config, lesson: plane.Lesson) -> tuple[dict[str, float], dict[str, pd.DataFrame]]:
    """Numbers of one group of demonstrations, and the lines to draw."""
    old, block = plane.obstacles(config)
    steps = config.samples
    first, second = (
        skill.rollout(duration / steps, horizon=duration)
        for skill, duration in zip((lesson.first, lesson.second), lesson.durations)
    )
    reference, samples, (leave, resume) = plane.spline_reference(config, second)
    extended = plane.extended_paths(config, lesson, steps)
    inside = [_inside(path, [*old, block]) for path in extended]
    row = {
        "segmentation_error": np.abs(lesson.segmentation_errors).max(),
        "clearance_new": clearance(second.position, [block]),
        "clearance_old": min(clearance(first.position, old), clearance(second.position, old)),
        "clearance_first_new": clearance(first.position, [block]),
        "clearance_reference": clearance(reference.position, [*old, block]),
        "kept_share": 1 - (resume - leave) / len(second.position),
        "clearance_extended_1": clearance(extended[0], [*old, block]),
        "clearance_extended_2": clearance(extended[1], [*old, block]),
        "inside_share_extended": float(np.concatenate(inside).mean()),
        "goal_error": float(np.linalg.norm(second.position[-1] - lesson.second.goal)),
        "late_drift": _late_drift(lesson),
        "lagrange_deviation": _lagrange_deviation(samples),
    }
    lines = {
        "first": first.position,
        "second": second.position,
        "reference": samples,
        "reserved": np.vstack([second.position[: leave + 1], [[np.nan, np.nan]], second.position[resume:]]),
        "extended_1": extended[0],
        "extended_2": extended[1],
        **{f"demonstration_{i}": drawing.position for i, drawing in enumerate(lesson.drawings)},
    }
    return row, {
        name: pd.DataFrame(line[:: max(1, len(line) // 400)], columns=["x", "y"]) for name, line in lines.items()
    }


def _inside(path: Any, polygons: list[Polygon]) -> Any:
    return np.any([polygon.contains(path) for polygon in polygons], axis=0)


def _late_drift(lesson: plane.Lesson) -> float:
    """Largest distance from the goal between the end of sub-skill 2 and 1.5 times its duration [cm] (E6.15)."""
    skill, duration = lesson.second, lesson.durations[1]
    late = skill.rollout(duration / 400, horizon=1.5 * duration).position[400:]
    return float(np.linalg.norm(late - skill.goal, axis=1).max())


def _lagrange_deviation(samples: Any) -> float:
    """Distance of the reference from the polynomial through 15 of its points [cm] (E6.19)."""
    u = np.linspace(-1, 1, len(samples))
    nodes = np.linspace(0, len(samples) - 1, 15).round().astype(int)
    return float(np.linalg.norm(lagrange(u[nodes], samples[nodes], u) - samples, axis=1).max())


def measure(recording: Recording, config: Config) -> Metrics:
    groups = recording.frames["groups"]
    metrics: Metrics = {f"{name}_min": float(column.min()) for name, column in groups.items()}
    metrics |= {f"{name}_max": float(column.max()) for name, column in groups.items()}
    # (6.1) without forcing has the poles of tau^2 p^2 + alpha_z tau p + alpha_z beta_z.
    metrics["damping_ratio"] = config.dmp.alpha_z / (2 * np.sqrt(config.dmp.alpha_z * config.dmp.beta_z))
    return metrics


def tabulate(
    recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics], config: Config
) -> dict[str, pd.DataFrame]:
    shown = {
        "segmentation_error_max": "largest cut error [s]",
        "clearance_new_max": "learned path to new block, largest [cm]",
        "clearance_old_min": "learned path to old obstacles, smallest [cm]",
        "clearance_reference_min": "spline reference, smallest clearance [cm]",
        "clearance_extended_1_max": "extended primitive 1, largest clearance [cm]",
        "clearance_extended_2_max": "extended primitive 2, largest clearance [cm]",
        "late_drift_max": "largest drift from the goal after the end [cm]",
    }
    rows = [
        {"variant": case, **{text: numbers[key] for key, text in shown.items()}} for case, numbers in metrics.items()
    ]
    return {"T6.Sa": pd.DataFrame(rows)}


def draw(recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics], config: Config) -> dict[str, Any]:
    if "book" not in recordings:
        return {}
    from dexrepro.report import style

    lines = {name: frame.to_numpy() for name, frame in recordings["book"].frames.items() if name != "groups"}
    numbers, settings = metrics["book"], config.cases["book"]
    figures = {}
    for identifier in FIGURES:
        figures[identifier], axes = style.subplots(width=style.ONE_COLUMN, height=3.0)
        plane.draw_map(axes, settings)
        axes.set_ylabel("y [cm]")
        text = _PANELS[identifier](axes, lines, numbers, settings, style)
        style.title(figures[identifier], text)
        handles = axes.get_legend_handles_labels()
        if handles[0]:
            figures[identifier].legend(*handles, loc="outside lower center", ncols=3)
    return figures


def _demonstrations(axes: Any, lines: Any, numbers: Any, settings: Config, style: Any) -> str:
    for i in range(settings.demonstrations.count):
        axes.plot(*lines[f"demonstration_{i}"].T, color=style.PLAIN, linewidth=0.6)
    axes.annotate("start", (3, 16), xytext=(0.3, 15.2), fontsize=7)
    axes.annotate("goal", (5, 14), xytext=(4.6, 14.5), fontsize=7)
    return "The new block lies across the\ndemonstrated paths"


def _learned(axes: Any, lines: Any, numbers: Any, settings: Config, style: Any) -> str:
    axes.plot(*lines["first"].T, color=style.BOOK, label="sub-skill 1")
    axes.plot(*lines["second"].T, color=style.EXTRA[0], linestyle="-.", label="sub-skill 2")
    return f"The learned path cuts {-numbers['clearance_new_max']:.2f} cm or more\ninto the new block"


def _spline(axes: Any, lines: Any, numbers: Any, settings: Config, style: Any) -> str:
    axes.plot(*lines["first"].T, color=style.BOOK, label="sub-skill 1")
    axes.plot(*lines["reference"].T, color="black", linewidth=0.8, label="spline")
    axes.plot(*lines["reserved"].T, color=style.EXTRA[0], linestyle="-.", label="kept of sub-skill 2")
    return f"The spline reference clears everything\nby {numbers['clearance_reference_min']:.2f} cm"


def _extended(axes: Any, lines: Any, numbers: Any, settings: Config, style: Any) -> str:
    old, block = plane.obstacles(settings)
    axes.set(
        xlim=(min(0.0, lines["extended_1"][:, 0].min() - 0.5), 20), ylim=(0, lines["extended_1"][:, 1].max() + 0.5)
    )
    for name, colour, dash, text in (
        ("extended_1", style.BOOK, "-", "1, new goal"),
        ("extended_2", style.EXTRA[0], "-.", "2, new start"),
    ):
        path = lines[name]
        axes.plot(*path.T, color=colour, linestyle=dash, label=f"sub-skill {text}")
        axes.plot(*path[_inside(path, [*old, block])].T, "x", color="black", markersize=2.5, markeredgewidth=0.5)
    share = 100 * numbers["inside_share_extended_min"]
    return f"Extended sub-skills run through old\nobstacles (at least {share:.0f} % of the samples)"


_PANELS = {"6.1": _demonstrations, "6.2a": _learned, "6.2b": _spline, "6.2c": _extended}
