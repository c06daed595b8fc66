import math

import numpy as np
import pytest

from dexrepro.physics.rendering import Overhead
from dexrepro.vision.patches import Grasp, Picture, cut
from dexrepro.vision.tabletop import BAD, SAFE, UNSAFE, Box, Item, candidates, label, photograph, scatter

BOX = Box((0.5, 0.37))
GREEN = (0.1, 0.8, 0.1, 1.0)


def bar(x=0.0, y=0.0, yaw=0.0):
    return Item(x, y, yaw, (0.04, 0.10, 0.05), False, GREEN)


def test_grasp_across_the_short_side_is_safe_in_the_middle_and_unsafe_at_the_wall():
    assert label(Grasp(0.0, 0.0, 0.0, 0.05), [bar()], BOX, 0.06) == SAFE
    assert label(Grasp(0.0, 0.0, math.pi, 0.05), [bar()], BOX, 0.06) == SAFE  # fingers have no sides
    near = bar(y=0.13)
    assert label(Grasp(0.0, 0.13, 0.0, 0.05), [near], BOX, 0.06) == UNSAFE


@pytest.mark.parametrize(
    "grasp",
    [
        Grasp(0.0, 0.0, math.pi / 2, 0.05),  # along the long side, wider than the gripper
        Grasp(0.03, 0.0, 0.0, 0.05),  # beside the middle: a finger would land on it
        Grasp(0.0, 0.0, 0.4, 0.05),  # askew
        Grasp(0.15, 0.0, 0.0, 0.05),  # nothing there
    ],
)
def test_other_grasps_are_bad(grasp):
    assert label(grasp, [bar()], BOX, 0.06) == BAD


def test_a_neighbour_in_the_way_of_a_finger_makes_a_grasp_bad():
    assert label(Grasp(0.0, 0.0, 0.0, 0.05), [bar(), bar(x=0.05)], BOX, 0.06) == BAD


def test_scattered_items_lie_inside_and_apart():
    items = scatter(np.random.default_rng(2), BOX, 4)
    for i, item in enumerate(items):
        assert BOX.clearance(np.array((item.x, item.y))) >= item.reach
        for other in items[:i]:
            assert math.dist((item.x, item.y), (other.x, other.y)) > item.reach + other.reach


def test_camera_sees_an_item_where_it_stands_and_as_high_as_it_is():
    camera, item = Overhead((0.0, 0.0, 1.0), (180, 140), 36.0), bar(x=0.08, y=-0.05)
    picture = photograph(BOX, [item], camera, np.random.default_rng(0))
    column, row = camera.project(np.array((item.x, item.y, 0.05)))
    assert picture.heights[round(row), round(column)] == pytest.approx(0.05, abs=0.006)
    assert picture.colours[round(row), round(column)].argmax() == 1
    assert camera.place(column, row, 0.05) == pytest.approx((item.x, item.y))


def test_patches_turn_with_the_grasp():
    camera, item = Overhead((0.0, 0.0, 1.0), (180, 140), 36.0), bar()
    picture = photograph(BOX, [item], camera, np.random.default_rng(0))
    across, along = cut(picture, [Grasp(0.0, 0.0, 0.0, 0.05), Grasp(0.0, 0.0, math.pi / 2, 0.05)], 0.16)
    high = [(patch[3] < 0.97).sum(axis=axis).max() for patch, axis in ((across, 0), (along, 1))]
    assert across.shape == (7, 24, 24)
    assert high[0] == pytest.approx(high[1], abs=2)
    assert np.linalg.norm(across[4:7], axis=0) == pytest.approx(1.0, abs=1e-5)


def test_a_tilted_floor_has_its_normal_in_the_frame_of_the_grasp():
    camera = Overhead((0.0, 0.0, 1.0), (180, 140), 36.0)
    rows, columns = np.mgrid[0:140, 0:180]
    x, _ = camera.place(columns, rows, 0.0)
    picture = Picture(np.zeros((140, 180, 3)), 0.2 * x, camera)
    straight, turned = cut(picture, [Grasp(0, 0, 0.0, 0.0), Grasp(0, 0, math.pi / 2, 0.0)], 0.1)
    assert straight[4].mean() == pytest.approx(-0.196, abs=0.02)
    assert turned[5].mean() == pytest.approx(0.196, abs=0.02)


def test_half_of_the_candidates_are_meant_to_be_good():
    rng = np.random.default_rng(4)
    items = [bar()]
    grasps = candidates(rng, items, BOX, 40)
    assert sum(label(g, items, BOX, 0.06) != BAD for g in grasps[:20]) > 15
