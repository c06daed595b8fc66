import math
from dataclasses import replace

import numpy as np
import pytest
from cases import case

from dexrepro.chapters.chapter3 import reach
from dexrepro.chapters.chapter3.grasp_through_opening import experiment as joined
from dexrepro.chapters.chapter3.grasp_through_opening.figures import FILM
from dexrepro.vision.tabletop import Item

RED = (0.9, 0.1, 0.1, 1.0)


@pytest.fixture(scope="module")
def settings():
    return case("3", "grasp_through_opening", "random")


def picture(settings, items):
    return joined._picture(settings, items, np.random.default_rng(0))


def item(settings, dx=0.0, dy=0.0, yaw=0.0):
    return Item(settings.centre[0] + dx, settings.centre[1] + dy, yaw, (0.04, 0.08, 0.05), False, RED)


def test_opening_is_found_in_the_picture(settings):
    seen = picture(settings, [item(settings)])
    assert joined.find_opening(seen, settings) == pytest.approx(settings.centre, abs=0.004)


def test_proposals_lie_on_what_stands_out(settings):
    block = item(settings, 0.03, -0.02)
    grasps = joined.proposals(picture(settings, [block]), settings.centre[:2], settings, np.random.default_rng(1))
    assert len(grasps) > 50
    assert all(block.covers(np.array((g.x, g.y)), 0.012) for g in grasps)
    assert np.median([g.z for g in grasps]) == pytest.approx(settings.centre[2] - 0.3 + 0.05, abs=0.005)


def test_an_empty_box_has_no_proposals(settings):
    assert joined.proposals(picture(settings, []), settings.centre[:2], settings, np.random.default_rng(1)) == []


def test_a_block_gripped_across_its_short_side_is_lifted_out_and_one_gripped_along_is_not(settings):
    block, floor = item(settings, 0.03, 0.02, yaw=0.6), settings.centre[2] - settings.box.height
    for angle, lifted in ((0.6, 1), (0.6 + math.pi / 2, 0)):
        grasp = joined.Grasp(block.x, block.y, angle, floor + 0.05)
        result = joined._attempt(settings, [block], grasp, tuple(settings.centre), joined.Recording())
        assert result["lifted"] == lifted


def test_the_film_shows_the_object_rise_with_the_hand(settings):
    block, recording = replace(item(settings, 0.03, 0.02, yaw=0.6), colour=(0.1, 0.1, 0.9, 1.0)), joined.Recording()
    grasp = joined.Grasp(block.x, block.y, 0.6, settings.centre[2] - settings.box.height + 0.05)
    joined._attempt(settings, [block], grasp, tuple(settings.centre), recording)
    assert recording["raised"][0] < 0.01
    assert recording["raised"][-1] > settings.lifted
    with joined.scene(settings) as world:
        shown = joined.stage(world, recording, settings)
        views = [world.snapshot(shown, time, FILM.camera, (160, 132)) for time in (0.0, recording.time[-1])]
    below, above = (np.argwhere(view[..., 2] > 1.4 * view[..., :2].max(axis=2)).mean(axis=0)[0] for view in views)
    assert below - above > 10  # rows of the picture


def test_roll_error_takes_the_nearer_side_of_the_fingers(settings):
    down = np.diag((1.0, -1.0, -1.0))
    law = reach.Reach.__new__(reach.Reach)
    for roll, expected in ((0.0, 0.0), (math.pi, 0.0), (0.05, 0.05), (math.pi - 0.05, -0.05), (1.0, 0.1)):
        law.config = type(settings)({**settings, "roll": roll})
        assert law._roll_error(down, down[:, 2]) == pytest.approx(expected, abs=1e-9)


def test_friction_decides_what_the_fingers_hold(settings):
    block, floor = item(settings, 0.03, 0.02, yaw=0.6), joined._floor(settings)
    grasp = joined.Grasp(block.x, block.y, 0.6, floor.floor + 0.05)
    slippery = type(settings)({**settings, "fingers": type(settings)({**settings.fingers, "friction": 0.01})})
    beside = replace(grasp, x=grasp.x + 0.12)
    assert joined.fingers.held(settings, floor, [block], grasp, floor.floor + 0.02) == 0
    assert joined.fingers.held(slippery, floor, [block], grasp, floor.floor + 0.02) is None
    assert joined.fingers.held(settings, floor, [block], beside, floor.floor + 0.02) is None
