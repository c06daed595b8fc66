"""From the camera's picture to an object lifted through the opening, over random scenes (Sects. 3.4 and 3.5 joined)."""

from __future__ import annotations

import copy
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from scipy.ndimage import find_objects
from scipy.ndimage import label as regions_of

from dexrepro.arrays import Mask, Rng
from dexrepro.chapters.chapter3 import fingers, reach
from dexrepro.chapters.chapter3.scene import ARM, Touching, add_box, cutaway, gripper_arm, start_posture
from dexrepro.experiment import AllMetrics, Config, Metrics, Recording
from dexrepro.measures import binomial_interval
from dexrepro.physics.rendering import Camera, Overhead
from dexrepro.physics.world import World
from dexrepro.vision.classifier import GraspClassifier
from dexrepro.vision.patches import Grasp, Picture, cut, observe
from dexrepro.vision.tabletop import BAD, Box, Item, label, place_items, scatter, training_set

VIEW = Camera(target=(0.5, -0.25, 0.2), distance=1.3, yaw=40.0, pitch=-25.0)
FINGERS = 0.04  # m, how far the fingers, which are not bodies of the simulation, reach beyond the tool's tip


def scene(config: Config) -> World:
    world = World(step=config.step, perturbation=config.perturbation)
    add_box(world, config.box, config.centre)
    world.add_arm(ARM, gripper_arm(config.gripper), start_posture(config.gripper, config.lift), contacts=True)
    return world


def stage(world: World, recording: Recording, config: Config) -> Recording:
    """The objects of the attempt that is shown, and the box cut open."""
    items = [
        Item(
            r["x"],
            r["y"],
            r["yaw"],
            (r["width"], r["depth"], r["height"]),
            bool(r["round"]),
            (r["R"], r["G"], r["B"], 1.0),
        )
        for r in recording.frames["items"].to_dict("records")
    ]
    place_items(world, _floor(config), items)
    return cutaway(world, recording, config)


def simulate(config: Config, rng: Rng) -> Recording:
    classifier = _trained(config, rng) if config.choice == "network" else None
    scenes, draws, pick = rng("scenes"), rng("draws"), rng("pick")
    recording, rows = Recording(), []
    for number in range(config.trials):
        items = _scene(config, scenes)
        picture = _picture(config, items, scenes)
        opening = find_opening(picture, config)
        grasps = proposals(picture, opening, config, draws)
        if classifier is None:
            grasp = grasps[int(pick.integers(len(grasps)))] if grasps else None
        else:
            scores = classifier.probabilities(cut(picture, grasps, config.patch_size))
            grasp = grasps[int(scores[:, 0].argmax())] if grasps else None
        row = {"scene": number, "candidates": len(grasps), "lifted": 0, "outcome": "nothing seen"}
        row["opening_error"] = math.dist(opening, config.centre)
        if grasp is not None:
            row["truly"] = ("safe", "unsafe", "bad")[label(grasp, items, _floor(config), config.safety_margin)]
            row["possible"] = sum(label(g, items, _floor(config), config.safety_margin) != BAD for g in grasps)
            row.update(_attempt(config, items, grasp, opening, recording))
        rows.append(row)
    recording.frames["scenes"] = pd.DataFrame(rows)
    return recording


def _trained(config: Config, rng: Rng) -> GraspClassifier:
    classifier = GraspClassifier(config.network_seed, config.learning_rate, config.batch)
    patches, labels = training_set(config, config.box.size, config.scenes, rng("train"), config.patch_size)
    classifier.fit(patches + np.float32(config.perturbation), labels, config.epochs)
    return classifier


def _floor(config: Config) -> Box:
    box, floor = config.box, config.centre[2] - config.box.height
    return Box(tuple(box.size), tuple(box.middle), floor, box.height)


def _scene(config: Config, rng: np.random.Generator) -> list[Item]:
    """Items on the part of the floor that the camera sees through the opening."""
    (x, y, _), span = config.centre, config.spread
    return scatter(rng, _floor(config), int(rng.integers(1, 4)), (x - span, x + span, y - span, y + span))


def _camera(config: Config) -> Overhead:
    x, y, z = config.centre
    return Overhead(
        (x + 0.01, y - 0.01, z - config.box.height + config.camera_height), (180, 180), config.field_of_view
    )


def _picture(config: Config, items: list[Item], rng: np.random.Generator) -> Picture:
    """What the camera sees through the opening before the arm comes."""
    camera = _camera(config)
    with World() as world:
        add_box(world, config.box, config.centre)
        place_items(world, _floor(config), items)
        return observe(*world.look_down(camera), camera, rng)


def find_opening(picture: Picture, config: Config) -> tuple[float, float, float]:
    """Centre (3,) [m] of the hole: middle of the deep pixels framed by the lid, half a plate below its upper face."""
    camera, heights = picture.lens, picture.heights
    highest = heights > heights.max() - 0.02
    lid = float(np.median(heights[highest]))
    top, bottom, left, right = _enclosed(~highest)
    x0, y0 = camera.place(left - 0.5, bottom + 0.5, lid)  # type: ignore[attr-defined]
    x1, y1 = camera.place(right + 0.5, top - 0.5, lid)  # type: ignore[attr-defined]
    return (x0 + x1) / 2, (y0 + y1) / 2, lid - config.box.thickness / 2


def _enclosed(deep: Mask) -> tuple[int, int, int, int]:
    """First and last row and column of the largest deep region that does not touch the picture's border."""
    regions, _ = regions_of(deep)
    border = set(np.concatenate((regions[0], regions[-1], regions[:, 0], regions[:, -1])).tolist())
    sizes = {k + 1: box for k, box in enumerate(find_objects(regions)) if k + 1 not in border}
    best = max(sizes.values(), key=lambda box: (box[0].stop - box[0].start) * (box[1].stop - box[1].start))
    return best[0].start, best[0].stop - 1, best[1].start, best[1].stop - 1


def proposals(picture: Picture, opening: Sequence[float], config: Config, rng: np.random.Generator) -> list[Grasp]:
    """Candidate rectangles around everything that stands out of the floor inside the hole: places and angles at random.

    Stands for the book's morphological candidate search; it knows the camera's picture and the height of the floor.
    """
    camera, floor = picture.lens, config.centre[2] - config.box.height
    raised = (picture.heights > floor + 0.02) & (picture.heights < floor + 0.12)
    rows, columns = np.nonzero(raised)
    result = []
    for index in rng.integers(len(rows), size=config.proposals) if len(rows) else ():
        height = float(picture.heights[rows[index], columns[index]])
        x, y = camera.place(float(columns[index]), float(rows[index]), height)  # type: ignore[attr-defined]
        if max(abs(x - opening[0]), abs(y - opening[1])) < config.spread + 0.02:
            result.append(Grasp(x, y, float(rng.uniform(-math.pi / 2, math.pi / 2)), height))
    return result


def _attempt(
    config: Config, items: list[Item], grasp: Grasp, opening: Sequence[float], recording: Recording
) -> dict[str, Any]:
    """Reach, close, lift; held is what rises with two fingers that close where the arm truly is (``fingers``)."""
    depth = grasp.z + FINGERS / 2
    values = Config.of({**config, "target": [grasp.x, grasp.y, depth], "roll": grasp.angle, "centre": list(opening)})
    values["law"], values["observer"] = copy.deepcopy(config.law), copy.deepcopy(config.observer)
    held: list[int] = []
    with scene(config) as world:
        names = place_items(world, _floor(config), items, mass=config.item_mass)

        def close() -> None:
            plant = world.arm(ARM)
            state = reach.State(plant.arm, np.array(plant.q))
            angle = math.atan2(state.rotation[1, 0], state.rotation[0, 0])
            now = [_moved(item, world.bodies[name]) for item, name in zip(items, names)]
            actual = Grasp(state.tip[0], state.tip[1], angle, state.tip[2])
            found = fingers.held(config, _floor(config), now, actual, state.tip[2] - FINGERS)
            if found is not None:
                held.append(found)
                world.grip(ARM, names[found])

        at = sum(config.phases[:3]) - 0.02
        centre = np.array(opening)
        run = reach.run(world, values, lambda _: centre, Touching(world), events=[(at, close)])
        raised = world.bodies[names[held[0]]].z - items[held[0]].size[2] / 2 - _floor(config).floor if held else 0.0
        lifted = int(raised > config.lifted)
        if lifted and not recording.images:
            recording.images["lifted"] = world.snapshot(run, sum(config.phases), VIEW)
            _keep(recording, run, items, names, held[0])
    recording.steps += run.steps
    recording.simulated += run.simulated
    if recording.status == "finished" and not run.status.startswith("finished"):
        recording.status = run.status
    outcome = "lifted" if lifted else "held, not lifted" if held else "closed on nothing"
    return {
        "x": grasp.x,
        "y": grasp.y,
        "angle": grasp.angle,
        "outcome": outcome if run.status == "finished" else run.status,
        "lifted": lifted,
        "contact_time": float((run["contact"][:, 0] > 0).sum() * config.step),
    }


def _keep(recording: Recording, run: Recording, items: list[Item], names: list[str], held: int) -> None:
    """What the film needs of one attempt: joint angles, places and looks of the items, how far one is lifted [m]."""
    channels = ("time", f"{ARM}.position", *(f"{name}.pose" for name in names))
    recording.series = {name: run[name] for name in channels}
    height = run[f"{names[held]}.pose"][:, 2]
    recording.series["raised"] = height - height.min()
    looks = [(item.x, item.y, item.yaw, *item.size, item.round, *item.colour[:3]) for item in items]
    columns = ["x", "y", "yaw", "width", "depth", "height", "round", "R", "G", "B"]
    recording.frames["items"] = pd.DataFrame(looks, columns=columns)


def _moved(item: Item, body: Any) -> Item:
    """The item where it lies now."""
    body.read()
    x, y, z, w = body.orientation
    return replace(item, x=body.x, y=body.y, yaw=math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))


def measure(recording: Recording, config: Config) -> Metrics:
    table = recording.frames["scenes"]
    count, trials = int(table.lifted.sum()), len(table)
    low, high = binomial_interval(count, trials, "exact")
    return {
        "lifted": count,
        "trials": trials,
        "success": count / trials,
        "success_low": low,
        "success_high": high,
        "opening_error_max": float(table.opening_error.max()),
        "good_grasps": int(table.truly.isin(("safe", "unsafe")).sum()),
        "scenes_with_good_grasp": int((table.possible > 0).sum()),
        "touched": int((table.contact_time.fillna(0) > 0).sum()),
    }


def summarise(metrics: AllMetrics, config: Config) -> Metrics:
    """By how much the chosen grasps' success exceeds that of the random ones."""
    values = [metrics.get(case, {}).get("success") for case in ("chosen", "random")]
    return {"success_gain": None if None in values else values[0] - values[1]}  # type: ignore[operator]
