"""What the figures of this chapter share: plan and side views of the board, obstacles, the three directions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from dexrepro.arrays import Array
from dexrepro.humans.reaching import Obstacle, Reach
from dexrepro.report import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DIRECTIONS: dict[str, dict[str, Any]] = {
    "left": {"color": style.EXTRA[0], "linestyle": "-"},
    "forward": {"color": style.EXTRA[1], "linestyle": (0, (5, 1))},
    "right": {"color": style.EXTRA[2], "linestyle": (0, (3, 1, 1, 1))},
}


def plan(axes: Axes, paths: Array, **line: Any) -> Any:
    """Paths (N, 3) or (k, N, 3) [cm] seen from above; returns the last line."""
    for path in np.reshape(paths, (-1, *np.shape(paths)[-2:])):
        (drawn,) = axes.plot(path[:, 0], path[:, 1], **line)
    return drawn


def side(axes: Axes, paths: Array, reach: Reach, **line: Any) -> None:
    """Height over the progress along the straight line from start to goal [cm]."""
    for path in np.reshape(paths, (-1, *np.shape(paths)[-2:])):
        axes.plot((path - reach.ends[0]) @ reach.axes[0], path[:, 2], **line)


def footprint(axes: Axes, obstacle: Obstacle, **patch: Any) -> None:
    x, y = np.subtract(obstacle.position, obstacle.side / 2)
    options: dict[str, Any] = {"facecolor": "#D9D9D9", "edgecolor": "#555555", "linewidth": 0.6, "zorder": 0} | patch
    axes.add_patch(style.plt.Rectangle((x, y), obstacle.side, obstacle.side, **options))


def profile(axes: Axes, obstacle: Obstacle, reach: Reach, **patch: Any) -> None:
    """The obstacle in the side view: its shadow along the path."""
    dx, dy = reach.axes[0, :2]
    half = obstacle.side / 2 * (abs(dx) + abs(dy))
    middle = reach.locate(obstacle.position)[0] * reach.length
    options: dict[str, Any] = {"facecolor": "#D9D9D9", "edgecolor": "#555555", "linewidth": 0.6, "zorder": 0} | patch
    axes.add_patch(style.plt.Rectangle((middle - half, 0), 2 * half, obstacle.height, **options))


def ends(axes: Axes, reach: Reach) -> None:
    """Start (open) and goal (full)."""
    start, goal = reach.ends
    axes.plot(*start[:2], "o", color="k", markerfacecolor="w", markersize=3.5, zorder=5)
    axes.plot(*goal[:2], "o", color="k", markersize=3.5, zorder=5)


def name_directions(axes: Axes, **options: Any) -> None:
    for name, line in DIRECTIONS.items():
        axes.plot([], [], label=name, **line)
    axes.legend(**({"loc": "upper left", "handlelength": 2.2, "borderpad": 0.1} | options))


def plans_over_sides(columns: int, height: float) -> tuple[Figure, Any, Any]:
    """A figure of plan views (2, columns), each with the height over the path below it."""
    figure = style.plt.figure(figsize=(style.TWO_COLUMNS, height))
    grid = figure.add_gridspec(4, columns, height_ratios=[2.1, 1.0] * 2)
    plans, sides = (
        np.array([[figure.add_subplot(grid[2 * r + k, c]) for c in range(columns)] for r in range(2)]) for k in (0, 1)
    )
    for panel in plans.flat:
        board(panel, labels=False)
        panel.set_xlabel("x [cm]", labelpad=1)
    for panel in sides.flat:
        panel.set(xlabel="Along the straight line [cm]")
    for rows, text in ((plans, "y [cm]"), (sides, "z [cm]")):
        for axes in rows[:, 0]:
            axes.set_ylabel(text)
    return figure, plans, sides


def joined(figure: Figure, plans: Any, sides: Any, row: int, column: int) -> Axes:
    """One panel in the place of a plan and a side view."""
    upper, lower = plans[row, column], sides[row, column]
    whole = upper.get_subplotspec().get_gridspec()[2 * row : 2 * row + 2, column]
    upper.remove()
    lower.remove()
    plans[row, column] = sides[row, column] = axes = figure.add_subplot(whole)
    return axes


def board(axes: Axes, labels: bool = True) -> None:
    """Axes of the plan view: equal scales and the range that reactions need."""
    axes.set_aspect("equal")
    axes.set(xlim=(0, 22), ylim=(-3.5, 12.5), xticks=range(0, 21, 5))
    if labels:
        axes.set(xlabel="x [cm]", ylabel="y [cm]")
