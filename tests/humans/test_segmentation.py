import numpy as np
import pytest

from dexrepro.humans.segmentation import change_point, pauses, slowest_point

TIME = np.arange(0, 12, 0.01)


def along_a_line(speed):
    """A path (n, 2) in the direction (3, 4) at a speed (n,)."""
    return np.cumsum(speed)[:, None] * 0.01 * np.array([0.6, 0.8])


def resting(*spans, slow=0.0):
    """Speed 1 with stretches at another speed."""
    speed = np.ones_like(TIME)
    for start, end in spans:
        speed[(start <= TIME) & (end > TIME)] = slow
    return along_a_line(speed)


def test_pauses_are_found_amid_their_stretches_without_start_and_end():
    path = resting((0, 0.6), (3, 3.5), (7, 8), (11.4, 12))
    assert pauses(TIME, path) == pytest.approx([3.25, 7.5], abs=0.02)


def test_stretches_less_than_a_second_apart_are_one_pause():
    assert pauses(TIME, resting((3, 3.4), (4.1, 4.5))) == pytest.approx([3.75], abs=0.02)
    assert pauses(TIME, resting((3, 3.4), (4.7, 5.1))) == pytest.approx([3.2, 4.9], abs=0.02)


@pytest.mark.parametrize(("slow", "found"), [(0.05, 1), (0.2, 0)])
def test_a_pause_is_slower_than_a_tenth_of_the_fast_part_whatever_its_unit(slow, found):
    for unit in (1.0, 100.0):
        assert len(pauses(TIME, unit * resting((5, 6), slow=slow))) == found


def test_only_the_first_and_the_last_tenth_are_start_and_end():
    assert pauses(TIME, resting((1.35, 1.75), (10.25, 10.65))) == pytest.approx([1.55, 10.45], abs=0.02)
    assert pauses(TIME, resting((1.0, 1.5), (10.5, 11.0))) == []


def test_steady_motion_has_no_pause():
    assert pauses(TIME, along_a_line(np.ones_like(TIME))) == []


@pytest.mark.parametrize("slowest", [2.7, 6.0, 9.3])
def test_the_slowest_point_lies_in_the_middle_of_the_path(slowest):
    speed = 0.2 + np.abs(TIME - slowest)
    speed[(TIME < 1.5) | (TIME > 10.5)] = 0.0
    assert slowest_point(TIME, along_a_line(speed)) == pytest.approx(slowest, abs=0.05)


@pytest.mark.parametrize("turn", [2.03, 4.23, 9.0])
def test_a_path_of_two_straight_pieces_changes_where_they_meet(turn):
    later = np.maximum(TIME - turn, 0)
    path = np.stack([TIME - later, 2 * later], axis=1)
    assert change_point(TIME, path) == pytest.approx(turn, abs=0.11)
    assert change_point(TIME, path) == pytest.approx(round(change_point(TIME, path), 1)), "ten instants a second"
