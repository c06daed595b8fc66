import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dexrepro.control.motion import minimum_jerk
from dexrepro.humans.reaching import Obstacle, Reach, Reacher, bump

REACH = Reach((2.3, 0.0), (20.0, 9.0))
FAR = Obstacle((13.0, 5.0), 8.0)


@given(st.floats(0.1, 0.9), st.floats(2.0, 20.0))
@settings(deadline=None, max_examples=30)
def test_bump_peaks_at_one_where_told(peak, sharpness):
    u = np.linspace(0, 1, 2001)
    values = bump(u, peak, sharpness)
    assert values.max() <= 1 + 1e-9
    assert u[values.argmax()] == pytest.approx(peak, abs=1e-3)
    assert values[[0, -1]] == pytest.approx(0.0)


def test_far_obstacle_stands_on_the_straight_line_of_the_old_task():
    progress, left = REACH.locate(FAR.position)
    assert progress == pytest.approx(0.594, abs=1e-3)
    assert abs(left) == pytest.approx(0.39, abs=5e-3)
    assert minimum_jerk(REACH.moment(FAR.position)) == pytest.approx(progress)


def test_path_frame_is_a_rotation_whose_first_axis_points_to_the_goal():
    assert REACH.axes @ REACH.axes.T == pytest.approx(np.eye(3))
    assert np.linalg.det(REACH.axes) == pytest.approx(1.0)
    start, goal = REACH.ends
    assert REACH.axes @ (goal - start) == pytest.approx([REACH.length, 0, 0])


@pytest.mark.parametrize(
    ("point", "distance"),
    [((13, 5, 9), 1.0), ((15, 5, 4), 1.0), ((17, 9, 4), np.hypot(3, 3)), ((13, 5, 7), -1.0), ((13.5, 5, 4), -0.5)],
)
def test_clearance_is_the_signed_distance_to_the_stack(point, distance):
    assert FAR.clearance(np.array([point], float)) == pytest.approx(distance)
    assert FAR.clearance(np.array([point], float), tool_radius=0.5) == pytest.approx(distance - 0.5)


def test_reactions_keep_start_and_goal_and_peak_at_the_obstacle():
    reacher = Reacher()
    for direction in (0.0, 0.4, 0.8, 1.0):
        reaction = reacher.reaction(REACH, FAR, direction)
        assert reaction[[0, -1]] == pytest.approx(0.0)
    lift = reacher.reaction(REACH, FAR, 0.8)[:, 2]
    assert reacher.phase[lift.argmax()] == pytest.approx(REACH.moment(FAR.position), abs=2e-3)
    assert lift.max() == pytest.approx(10.6, rel=1e-3)


def test_every_demonstration_clears_the_obstacle():
    reacher = Reacher()
    for direction in reacher.directions:
        paths = reacher.demonstrate(REACH, FAR, direction, 8, np.random.default_rng(3))
        assert paths.shape == (8, 501, 3)
        assert FAR.clearance(paths, reacher.tool_radius).min() > 0


def test_a_person_who_cannot_pass_says_so():
    with pytest.raises(RuntimeError, match="cannot be passed"):
        Reacher(lift=((1.5, 3.0),) * 3, lateral=((0.0, 0.0),) * 3).demonstrate(
            REACH, FAR, 0.8, 3, np.random.default_rng(0)
        )
