"""Recorded series and scenes for the pages: scripts that a page opened from disk may load when a reader asks.

A page opened from ``file://`` may load scripts but fetch no data, so a case becomes ``SERIES["..."] = "<base64>"``: its
columns as 32-bit floats, differences of their bit patterns, bytes of one weight together, deflated. It is exact.
"""

from __future__ import annotations

import base64
import json
import re
import zlib
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from dexrepro.arrays import Array
from dexrepro.damage import check_series
from dexrepro.errors import InputError
from dexrepro.experiment import Experiment, Film
from dexrepro.physics.rendering import Camera, Solid
from dexrepro.recordings import read_frame
from dexrepro.report import words
from dexrepro.report.animation import instants, recorded_scene

LONGEST = 4000  # samples of a case; of a longer one every k-th is shown
SHORTEST = 10
FRAMES = 240  # instants of a scene
HIDDEN = 2.5  # m: what lies farther from the middle is not to be seen
UNITS = {  # of the channels that arms, bodies and objects of the world record as "<name>.<quantity>"
    "position": "rad", "velocity": "rad/s", "torque": "N m", "tip": "m", "force": "N", "sensed_force": "N",
    "length": "m", "slip": "m", "pose": "m, m, m, 1, 1, 1, 1",
}  # fmt: skip
TELLING = ("error", "force", "contact", "distance", "rcm_distance", "estimate", "lyapunov", "stiffness", "reference")
ARMS = ("arm", "leader", "follower", "left", "right", "object")


def write(
    place: Path, target: Path, cases: Iterable[str], film: Film | None, units: Mapping[str, str] | None = None
) -> dict[str, Any] | None:
    """Write ``target/series-<case>.js`` for every recorded case; returns what the page must know, None without any."""
    found: dict[str, Any] = {}
    for case in cases:
        path = place / "series" / f"{case}.csv.gz"
        if path.exists() and (columns := _columns(path)):
            text, samples, stride = _packed(columns)
            script, key = target / f"series-{case}.js", f"{target.name}/{case}"
            script.write_text(words.script(f"SERIES[{json.dumps(key)}]", text), encoding="utf-8")
            found[case] = {
                "key": key, "script": f"files/{target.name}/{script.name}", "csv": f"files/{target.name}/{path.name}",
                "channels": list(columns), "samples": samples, "stride": stride,
            }  # fmt: skip
    if not found:
        return None
    names = list(dict.fromkeys(_name(column) for case in found.values() for column in case["channels"]))[1:]
    channels = [{"name": name, "unit": unit(name, units or {})} for name in names]
    return {"name": target.name, "cases": found, "channels": channels, "first": _first(names, list(found), film)}


def beside(series: dict[str, Any], book: Mapping[str, Any]) -> None:
    """Add the cases of the book's run to those of another one, and show those of the same name together."""
    ours = list(series["cases"])
    series["cases"] |= {f"book: {case}": entry for case, entry in book["cases"].items()}
    shown = [case for case in ours if case in book["cases"]][:2] or ours[:2]
    series["first"]["cases"] = [name for case in shown for name in (case, f"book: {case}") if name in series["cases"]]


def scene(place: Path, target: Path, experiment: Experiment) -> dict[str, Any] | None:
    """Write ``target/scene.js``, the recorded motion of a scene's solids; returns its case and script, or None."""
    if not experiment.function("scene"):
        return None
    try:
        case, times, seen, poses = _motion(place, experiment)
    except InputError:  # nothing moves, or the configuration names code that is not ours
        return None
    except (AttributeError, LookupError, TypeError, ValueError):  # recorded under a configuration of other code
        return None
    columns = {"time": times.astype(np.float32)}
    columns |= {str(i): column for i, column in enumerate(poses.reshape(len(times), -1).T.astype(np.float32))}
    text, samples, _ = _packed(columns)
    camera = experiment.film.camera if experiment.film else _fitted(poses[..., :3].reshape(-1, 3))
    entry = {
        "case": case, "samples": samples, "poses": text, "camera": asdict(camera),
        "solids": [{"kind": item.kind, "size": item.size, "colour": item.colour} for item in seen],
    }  # fmt: skip
    script = target / "scene.js"
    script.write_text(words.script(f"SCENES[{json.dumps(target.name)}]", entry), encoding="utf-8")
    return {"case": case, "script": f"files/{target.name}/{script.name}"}


def _motion(place: Path, experiment: Experiment) -> tuple[str, Array, list[Solid], Array]:
    """The case shown, instants (n,) [s], what is seen, and its poses (n, solids, 7)."""
    config, recording, case = recorded_scene(place, experiment)
    film = experiment.film
    with experiment.simulation.scene(config) as world:
        if stage := experiment.function("stage"):
            recording = stage(world, recording, config)
        times = instants(recording, film.span if film and film.case == case else None, FRAMES)
        seen, poses = world.animate(recording, times)
    return case, times, seen, poses


def _fitted(points: Array) -> Camera:
    """A camera that sees all points (n, 3) [m]; those far from most are hidden things. A plane it sees from above."""
    middle = np.median(points, axis=0)
    seen = points[np.abs(points - middle).max(axis=1) < HIDDEN]
    low, high = seen.min(axis=0), seen.max(axis=0)
    x, y, z = (low + high) / 2
    flat = high[2] - low[2] < 0.05 * max(high[:2] - low[:2])
    return Camera((x, y, z), 0.25 + 1.1 * float(np.linalg.norm(high - low)), *((0.0, -89.0) if flat else (50.0, -30.0)))


def unit(channel: str, units: Mapping[str, str]) -> str:
    """A channel's unit, "1" of a number without, "m, N" of components: as declared, or the world's own; else "".

    units: declared, by a channel's name, by what stands before its dot ("push" for "push.x"), or by its name without
    a number at its end ("force" for "force_0", "force_1").
    """
    body, _, quantity = channel.rpartition(".")
    names = (channel, body, *(re.sub(r"_?\d+$", "", name) for name in (channel, body)))
    return next((units[name] for name in names if name in units), UNITS.get(quantity, "") if body else "")


def _first(names: list[str], cases: list[str], film: Film | None) -> dict[str, list[str]]:
    """What is shown before the reader chooses: the channel of the film, or errors and forces, of at most four cases."""
    wanted = [film.channel] if film and film.channel in names else []
    own = [name for name in names if name.rpartition(".")[0] not in ARMS[:-1]]
    wanted += [name for word in TELLING for name in own if name.rpartition(".")[2] == word]
    wanted = list(dict.fromkeys([*wanted, *own, *names]))
    shown = cases[:4]
    if film and film.case in cases and film.case not in shown:
        shown = [film.case, *shown[:3]]
    return {"channels": wanted[:2], "cases": shown}


def _columns(path: Path) -> dict[str, Any]:
    """Numeric columns by name, time first; {} for what is no series in time."""
    check_series(path)
    frame = read_frame(path).select_dtypes("number")
    if len(frame) < SHORTEST or frame.columns[0] != "time" or not frame["time"].is_monotonic_increasing:
        return {}
    return {str(name): frame[name].to_numpy(np.float32) for name in frame}


def _packed(columns: dict[str, Any]) -> tuple[str, int, int]:
    samples = len(columns["time"])
    stride = -(-samples // LONGEST)
    bits = np.array([values[::stride] for values in columns.values()]).view(np.int32)
    changes = np.diff(bits, axis=1, prepend=np.int32(0))
    planes = changes.astype("<i4").view(np.uint8).reshape(*bits.shape, 4).transpose(0, 2, 1)
    return base64.b64encode(zlib.compress(planes.tobytes(), 6)).decode(), bits.shape[1], stride


def _name(column: str) -> str:
    return column.partition("[")[0]
