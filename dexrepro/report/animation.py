"""Moving pictures of a recorded run: the scene, and a measured quantity drawn alongside. Nothing is simulated."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from dexrepro.arrays import Array
from dexrepro.case import live, refuse_foreign, targets
from dexrepro.checks import value_at
from dexrepro.config import compose_chapter
from dexrepro.damage import check_result
from dexrepro.errors import InputError, nearest
from dexrepro.experiment import Config, Experiment, Film, Recording
from dexrepro.physics import rendering
from dexrepro.physics.world import World
from dexrepro.recordings import load_recording
from dexrepro.report import style
from dexrepro.storage import read_json, read_yaml

SIZE = (400, 330)
FRAMES = 60  # at the most
RATE = 12  # frames a second
COLOURS = 96
MARGIN = 24  # pixels above and below the line that marks the instant


def render(folder: Path, case: str | None = None, kind: str = "gif", allow: Sequence[str] = ()) -> Path:
    """Write ``animation/<case>.<kind>`` and a still ``<case>.png`` into a result folder; returns the animation's path.

    The module's ``FILM`` says which case is shown, how it is looked at and what is drawn alongside; another case is
    shown in the same way. A result is data: of what its config.yaml names, only what this package's library or its
    configuration has is built, and what the modules ``allow`` hold. Raises InputError where there is no result, a
    damaged one or one that names other code, no scene, no such case, or no encoder for MP4.
    """
    if not (folder / "run.json").exists():
        raise InputError(f"{folder} holds no result (no run.json)")
    experiment = check_result(folder, "config.yaml", series=True)
    run = read_json(folder / "run.json")
    if not experiment.function("scene"):
        raise InputError(f"experiment '{experiment.name}' has no scene to render")
    if kind == "mp4" and not shutil.which("ffmpeg"):
        raise InputError("format = mp4 is not allowed: it needs the program ffmpeg; use format=gif")
    cases = run["cases"]
    if case is not None and case not in cases:
        raise InputError(f"unknown case '{case}' of {experiment.name}: {nearest(case, cases)}")
    config, recording, chosen = recorded_scene(folder, experiment, case, allow)
    target = folder / "animation" / f"{chosen}.{kind}"
    target.parent.mkdir(exist_ok=True)
    frames = list(_frames(experiment, config, recording))
    frames[len(frames) // 2].save(target.with_suffix(".png"), optimize=True)
    _write_gif(frames, target) if kind == "gif" else _write_mp4(frames, target)
    return target


def recorded_scene(
    folder: Path, experiment: Experiment, case: str | None = None, allow: Sequence[str] = ()
) -> tuple[Config, Recording, str]:
    """What a scene is built from, its recording, and the case: the one asked for, the film's, or the first with an arm.

    Raises InputError where no case has recorded an arm, or config.yaml is damaged or names other code (see ``render``).
    """
    run = read_json(folder / "run.json")
    cases = run["cases"]
    chosen = case or (experiment.film.case if experiment.film and experiment.film.case in cases else None)
    recording, chosen = _recording(folder, experiment, {chosen: cases[chosen]} if chosen else cases)
    raw = read_yaml(folder / "config.yaml").get("cases", {}).get(chosen)
    if not isinstance(raw, dict):
        raise InputError(f"{folder / 'config.yaml'} has no configuration of the case '{chosen}'")
    raw |= {"law": None} if "law" in raw else {}  # a scene needs none, and the user's may be in another folder
    ours = set(targets(compose_chapter(run["chapter"])))
    refuse_foreign(
        {"cases": {chosen: raw}},
        str(folder / "config.yaml"),
        lambda target: target in ours or any(target.startswith(f"{module}.") for module in allow),
    )
    return live(raw), recording, chosen


def film_of(folder: Path, experiment: Experiment) -> Path | None:
    """Where the film that an experiment declares lies in its result folder, made or not; None without such a case."""
    film = experiment.film
    if film is None or not (folder / "series" / f"{film.case}.csv.gz").exists():
        return None
    return folder / "animation" / f"{film.case}.gif"


def up_to_date(film: Path, experiment: Experiment) -> bool:
    """Whether a film is younger than its recording and than the code that shows it, the chapter's included."""
    code = [Path(__file__), Path(rendering.__file__), *experiment.folder.parent.rglob("*.py")]
    sources = [film.parent.parent / "series" / f"{film.stem}.csv.gz", *code]
    return film.exists() and film.stat().st_mtime >= max(path.stat().st_mtime for path in sources)


def _recording(folder: Path, experiment: Experiment, cases: dict[str, Any]) -> tuple[Recording, str]:
    staged = experiment.function("stage") is not None
    for name in cases:
        recording = load_recording(folder / "series", name)
        if recording.series and (staged or any(channel.endswith(".position") for channel in recording.series)):
            return recording, name
    said = ", ".join(f"'{name}' ({entry['status']})" for name, entry in cases.items())
    raise InputError(f"no arm is recorded in {folder} by {said}")


def _frames(experiment: Experiment, config: Config, recording: Recording) -> Iterator[Image.Image]:
    film = experiment.film
    camera = film.camera if film else rendering.Camera()
    font = ImageFont.load_default(15)
    World.meshes = True
    with experiment.simulation.scene(config) as world:
        if experiment.function("stage"):
            recording = experiment.simulation.stage(world, recording, config)
        times = instants(recording, film.span if film else None, FRAMES)
        plots = _plots(film, config, recording, times) if film and film.channel in recording else None
        for instant in times:
            picture = Image.fromarray(world.snapshot(recording, instant, camera, SIZE))
            ImageDraw.Draw(picture).text((10, 8), f"t = {instant:.1f} s", fill=(20, 20, 20), font=font)
            yield _beside(picture, *plots, instant) if plots else picture


def instants(recording: Recording, span: tuple[float, float] | None, count: int) -> Array:
    """At most ``count`` recorded instants [s] of a span, evenly; of the whole run where it ended before the span."""
    within = recording.time[recording.between(*span)] if span else recording.time
    shown = within if within.size else recording.time
    return shown[np.unique(np.linspace(0, len(shown) - 1, count).round().astype(int))]


def _beside(picture: Image.Image, past: Image.Image, future: Image.Image, column: Any, instant: float) -> Image.Image:
    """The scene, and the plot whose part up to the instant is coloured."""
    x = round(column(instant))
    frame = Image.new("RGB", (picture.width + past.width, picture.height), "white")
    frame.paste(picture, (0, 0))
    frame.paste(future, (picture.width, 0))
    frame.paste(past.crop((0, 0, x, past.height)), (picture.width, 0))
    line = [(picture.width + x, MARGIN), (picture.width + x, picture.height - 2 * MARGIN)]
    ImageDraw.Draw(frame).line(line, fill=(120, 120, 120), width=1)
    return frame


def _plots(film: Film, config: Config, recording: Recording, shown: Array) -> tuple[Image.Image, Image.Image, Any]:
    """The watched quantity over time, coloured and pale, and the function from an instant to its column."""
    values = recording[film.channel]
    values = film.scale * (np.linalg.norm(values, axis=1) if values.ndim > 1 else values)
    inside = recording.between(shown[0], shown[-1])
    pictures = []
    with style.style():
        figure, axes = style.subplots(width=SIZE[0] / 125, height=SIZE[1] / 125, dpi=125)
        (curve,) = axes.plot(recording.time[inside], values[inside], linewidth=1.6)
        if film.reference and (wanted := value_at(config, film.reference)) is not None:
            axes.axhline(wanted, **style.LINES["reference"])
        axes.set(xlabel="Time [s]", ylabel=film.label, xlim=(shown[0], shown[-1]))
        axes.margins(y=0.12)
        for colour in (style.BOOK, "#D5DCE2"):
            curve.set_color(colour)
            figure.canvas.draw()
            pixels: NDArray[np.uint8] = np.asarray(figure.canvas.buffer_rgba())[:, :, :3].copy()
            pictures.append(Image.fromarray(pixels))
        left, right = (axes.transData.transform((time, 0))[0] for time in (shown[0], shown[-1]))
        style.plt.close(figure)
    return *pictures, lambda time: left + (right - left) * (time - shown[0]) / (shown[-1] - shown[0] or 1)  # type: ignore[return-value]


def _write_gif(frames: list[Image.Image], target: Path) -> None:
    palette = frames[len(frames) // 2].quantize(COLOURS, method=Image.Quantize.FASTOCTREE)
    first, *rest = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    first.save(target, save_all=True, append_images=rest, duration=1000 // RATE, loop=0, optimize=False)


def _write_mp4(frames: list[Image.Image], target: Path) -> None:
    size = f"{frames[0].width}x{frames[0].height}"
    command = ["ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size,
               "-r", str(RATE), "-i", "-", "-pix_fmt", "yuv420p", str(target)]  # fmt: skip
    with subprocess.Popen(command, stdin=subprocess.PIPE) as encoder:
        assert encoder.stdin
        for frame in frames:
            encoder.stdin.write(frame.tobytes())
        encoder.stdin.close()
        if encoder.wait():
            raise InputError("ffmpeg could not write the animation")
