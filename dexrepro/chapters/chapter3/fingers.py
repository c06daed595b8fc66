"""Two fingers close on what lies between them and rise; contact and friction alone decide what they hold."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from dexrepro.arrays import Array
from dexrepro.chapters.chapter3.scene import add_box
from dexrepro.experiment import Config
from dexrepro.physics.elements import TipForce
from dexrepro.physics.world import World
from dexrepro.vision.patches import Grasp
from dexrepro.vision.tabletop import FINGER, Box, Item, place_items

MASS, HEIGHT = 0.1, 0.05  # kg, m, of a finger
DROP, RISE = 0.06, 0.05  # m, by which the open fingers come down, and closed rise
DOWN, CLOSED, UP = 0.5, 1.0, 1.5  # s, until when they come down, close and rise
STIFF, DAMP, LIMIT = 2000.0, 30.0, 40.0  # N/m, N s/m, N, of what guides them across and up
SIDES = (-1, 1)


def held(config: Config, floor: Box, items: Sequence[Item], grasp: Grasp, bottom: float) -> int | None:
    """Index of the item that rises with the fingers, the highest one if there are several; None where none does.

    grasp: where the hand is and its opening [m, rad]; bottom: height of the fingers' ends when they close [m].
    """
    with World(step=config.step) as world:
        add_box(world, config.box, config.centre)
        names = place_items(world, floor, list(items), mass=config.item_mass)
        along = np.array((*grasp.direction, 0.0))
        middle = np.array((grasp.x, grasp.y, bottom + HEIGHT / 2))
        for side in SIDES:
            place = middle + side * grasp.width / 2 * along + (0.0, 0.0, DROP)
            world.add_box(
                f"finger{side}", (2 * FINGER, grasp.width / 4, HEIGHT), tuple(place.tolist()), MASS,
                rpy=(0.0, 0.0, grasp.angle), inertia=(1.0, 1.0, 1.0), friction=config.fingers.friction,
            )  # fmt: skip
            world.add(TipForce(f"drive{side}", f"finger{side}", _drive(world, config, side, along, middle, grasp)))
        world.run(DOWN)
        before = _heights(world, names)
        world.run(UP - DOWN)
        rise = _heights(world, names) - before
    return int(rise.argmax()) if len(rise) and rise.max() > RISE / 2 else None


def _heights(world: World, names: Sequence[str]) -> Array:
    return np.array([world.bodies[name].z for name in names])


def _drive(
    world: World, config: Config, side: int, along: Array, middle: Array, grasp: Grasp
) -> Callable[[float, Array, Array], Array]:
    """Force on a finger [N]: guided to a height and across, driven along with the other's mirror image to close."""

    def law(time: float, position: Array, velocity: Array) -> Array:
        height = np.interp(time, (0.0, 0.8 * DOWN, CLOSED, UP), (DROP, 0.0, 0.0, RISE))
        offset, other = position - middle, world.bodies[f"finger{-side}"]
        own = float(offset @ along)
        if time < DOWN:
            push = STIFF * (side * grasp.width / 2 - own)
        else:  # both close alike: their middle stays where the hand is
            push = -side * config.fingers.force - STIFF * (
                own + float((other.x, other.y, 0.0) @ along - middle @ along)
            )
        guide = STIFF * (np.array((0.0, 0.0, height)) - (offset - own * along)) - DAMP * velocity
        return np.clip(guide, -LIMIT, LIMIT) + push * along + np.array((0.0, 0.0, 9.81 * MASS))

    return law
