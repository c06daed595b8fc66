"""Loader of the Cornell Grasping Dataset, given its folder; the data itself is not shipped."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from dexrepro.arrays import Array
from dexrepro.vision.patches import Grasp, Picture, cut
from dexrepro.vision.tabletop import BAD, SAFE, UNSAFE

ROWS, COLUMNS = 480, 640


class NotCornell(RuntimeError):
    """The folder does not hold files of the data set."""


@dataclass(frozen=True)
class Pixels:
    """A lens for which x and y are columns and rows; the camera is at height 0, so heights are minus depths."""

    position: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def project(self, points: Array) -> Array:
        """Columns and rows (..., 2) of points (..., 3)."""
        return points[..., :2]


def rectangles(path: Path) -> list[Array]:
    """Rectangles (4, 2) of corners (column, row) in a cpos or cneg file; those with undefined corners are left out."""
    corners = np.array(
        [
            [float(word) for word in line.split()[:2]]
            for line in path.read_text(encoding="utf-8").splitlines()
            if line.strip()
        ]
    )
    groups = corners[: len(corners) // 4 * 4].reshape(-1, 4, 2)
    return [group for group in groups if np.isfinite(group).all()]


def grasp_of(corners: Array, heights: Array) -> Grasp:
    """Grasp in pixels: the edge from corner 1 to 2 lies along the finger plates, that from 2 to 3 over the opening."""
    (x, y), opening = corners.mean(axis=0), corners[2] - corners[1]
    row, column = min(max(round(float(y)), 0), ROWS - 1), min(max(round(float(x)), 0), COLUMNS - 1)
    angle = float(np.arctan2(opening[1], opening[0]))
    return Grasp(float(x), float(y), angle, float(heights[row, column]), float(np.hypot(*opening)))


def heights_of(path: Path) -> Array:
    """Minus the depth (480, 640) of a point cloud in PCD text; pixels without a point take the median."""
    lines = path.read_text(encoding="utf-8").splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith("DATA")) + 1
    points = np.array([[float(word) for word in line.split()] for line in lines[start:] if line.strip()])
    result = np.full(ROWS * COLUMNS, float(np.median(points[:, 2])))
    result[points[:, 4].astype(int)] = points[:, 2]
    return result.reshape(ROWS, COLUMNS)


def pictures(folder: Path) -> Iterator[tuple[Picture, list[Grasp], list[Grasp]]]:
    """Every picture below a folder with its good and its bad grasps. Raises NotCornell where there are none."""
    from PIL import Image

    files = sorted(folder.rglob("pcd[0-9][0-9][0-9][0-9]cpos.txt"))
    if not files:
        raise NotCornell(f"no files pcdNNNNcpos.txt in '{folder}': give the folder of the Cornell Grasping Dataset")
    for positive in files:
        stem = positive.name[: len("pcdNNNN")]
        colours = np.asarray(Image.open(positive.with_name(f"{stem}r.png")).convert("RGB"), dtype=float) / 255.0
        heights = heights_of(positive.with_name(f"{stem}.txt"))
        good, bad = (
            [grasp_of(corners, heights) for corners in rectangles(positive.with_name(f"{stem}{kind}.txt"))]
            for kind in ("cpos", "cneg")
        )
        yield Picture(colours, heights, Pixels()), good, bad


def labelled(
    folder: Path, size: float = 100.0, boundary: tuple[float, float, float, float] = (120.0, 520.0, 90.0, 390.0)
) -> tuple[NDArray[np.float32], NDArray[np.int64]]:
    """Patches (n, 7, 24, 24) of a side in pixels and labels (n,).

    The data set shows no walls: a good grasp outside the made-up ``boundary`` (columns from, to, rows from, to) counts
    as unsafe.
    """
    patches, labels = [], []
    x0, x1, y0, y1 = boundary
    for picture, good, bad in pictures(folder):
        patches.append(cut(picture, good + bad, size, bounded=False))
        labels += [SAFE if x0 <= g.x <= x1 and y0 <= g.y <= y1 else UNSAFE for g in good] + [BAD] * len(bad)
    return np.concatenate(patches), np.array(labels)
