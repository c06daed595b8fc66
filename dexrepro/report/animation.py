"""Moving pictures of a recorded run: the scene, and a measured quantity drawn alongside. Nothing is simulated."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from dexrepro import chapters
from dexrepro.config import InputError, nearest
from dexrepro.experiment import Config, Experiment, Recording
from dexrepro.report import style
from dexrepro.runner import live
from dexrepro.storage import load_recording, read_json

SIZE = (420, 340)
FRAMES = 90  # at the most
RATE = 12  # frames a second


def render(folder: Path, case: str | None = None, kind: str = "gif") -> Path:
    """Write ``animation/<case>.<kind>`` into a result folder and return its path.

    The experiment's module may name ``CAMERA`` (how to look) and ``WATCHED`` (channel, label) (what is drawn
    alongside). Raises InputError where there is no result, no scene, no such case, or no encoder for MP4.
    """
    if not (folder / "run.json").exists():
        raise InputError(f"{folder} holds no result (no run.json)")
    run = read_json(folder / "run.json")
    experiment = chapters.load(run["chapter"]).experiment(run["experiment"])
    if not experiment.has("scene"):
        raise InputError(f"experiment '{experiment.name}' has no scene to render")
    if kind == "mp4" and not shutil.which("ffmpeg"):
        raise InputError("format = mp4 is not allowed: it needs the program ffmpeg; use format=gif")
    cases = run["cases"]
    if case is not None and case not in cases:
        raise InputError(f"unknown case '{case}' of {experiment.name}: {nearest(case, cases)}")
    recording, chosen = _recording(folder, cases, case)
    raw = yaml.safe_load((folder / "config.yaml").read_text())["cases"][chosen]
    target = folder / "animation" / f"{chosen}.{kind}"
    target.parent.mkdir(exist_ok=True)
    raw |= {"law": None} if "law" in raw else {}  # a scene needs none, and the user's may be in another folder
    frames = _frames(experiment, live(raw), recording)
    _write_gif(frames, target) if kind == "gif" else _write_mp4(frames, target)
    return target


def _recording(folder: Path, cases: dict[str, Any], case: str | None) -> tuple[Recording, str]:
    for name in [case] if case else cases:
        recording = load_recording(folder / "series", name)
        if any(channel.endswith(".position") for channel in recording.series):
            return recording, name
    raise InputError(f"no case in {folder} has recorded an arm")


def _frames(experiment: Experiment, config: Config, recording: Recording) -> Iterator[Image.Image]:
    from dexrepro.physics.rendering import Camera

    camera = getattr(experiment.module, "CAMERA", Camera())
    channel, label = getattr(experiment.module, "WATCHED", (None, "")) or (None, "")
    instants = np.linspace(recording.time[0], recording.time[-1], min(FRAMES, len(recording.time)))
    plot, left, right = _plot(recording, channel, label)
    with experiment.module.scene(config) as world:
        for instant in instants:
            picture = Image.fromarray(world.snapshot(recording, instant, camera, SIZE))
            ImageDraw.Draw(picture).text((8, 6), f"t = {instant:.1f} s", fill=(20, 20, 20))
            if plot is None:
                yield picture
                continue
            frame = Image.new("RGB", (SIZE[0] + plot.width, SIZE[1]), "white")
            frame.paste(picture, (0, 0))
            frame.paste(plot, (SIZE[0], 0))
            share = (instant - instants[0]) / (instants[-1] - instants[0] or 1)
            x = SIZE[0] + left + share * (right - left)
            ImageDraw.Draw(frame).line([(x, 30), (x, SIZE[1] - 45)], fill=(213, 94, 0), width=2)
            yield frame


def _plot(recording: Recording, channel: str | None, label: str) -> tuple[Image.Image | None, float, float]:
    """The watched quantity over time as a picture, and the columns of its first and last instant."""
    if channel is None or channel not in recording:
        return None, 0, 0
    values = recording[channel]
    with style.style():
        figure, axes = style.subplots(width=SIZE[0] / 100, height=SIZE[1] / 100, dpi=100)
        axes.plot(recording.time, values, color=style.BOOK)
        axes.set(xlabel="Time [s]", ylabel=label, xlim=(recording.time[0], recording.time[-1]))
        figure.canvas.draw()
        pixels: NDArray[np.uint8] = np.asarray(figure.canvas.buffer_rgba())[:, :, :3].copy()
        left, right = (axes.transData.transform((t, 0))[0] for t in axes.get_xlim())
        style.plt.close(figure)
    return Image.fromarray(pixels), float(left), float(right)


def _write_gif(frames: Iterator[Image.Image], target: Path) -> None:
    first, *rest = [frame.quantize(96) for frame in frames]
    first.save(target, save_all=True, append_images=rest, duration=1000 // RATE, loop=0, optimize=True)


def _write_mp4(frames: Iterator[Image.Image], target: Path) -> None:
    first = next(frames)
    size = f"{first.width}x{first.height}"
    command = ["ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size,
               "-r", str(RATE), "-i", "-", "-pix_fmt", "yuv420p", str(target)]  # fmt: skip
    with subprocess.Popen(command, stdin=subprocess.PIPE) as encoder:
        assert encoder.stdin
        for frame in (first, *frames):
            encoder.stdin.write(frame.tobytes())
        encoder.stdin.close()
        if encoder.wait():
            raise InputError("ffmpeg could not write the animation")
