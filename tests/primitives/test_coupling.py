import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dexrepro.primitives.constrained import Skill
from dexrepro.primitives.coupling import Agents, SurfaceFollower, coupled_rollout, dynamic_potential, steering

coordinate = st.floats(-5, 5)


@settings(deadline=None, max_examples=50)
@given(coordinate, coordinate, coordinate, coordinate)
def test_steering_turns_without_braking(x, y, vx, vy):
    velocity = np.array([vx, vy])
    term = steering(np.array([x, y]), velocity, np.array([[1.0, 2.0]]), 1000.0, 20 / np.pi)
    assert abs(term @ velocity) <= 1e-9 * (1 + np.linalg.norm(term) * np.linalg.norm(velocity))


def test_steering_is_dead_for_a_heading_exactly_at_a_point_and_strongest_near_nine_degrees():
    beta = 20 / np.pi
    heading = np.radians(np.linspace(0, 90, 901))
    velocity = np.stack([np.cos(heading), np.sin(heading)], axis=1)
    size = np.linalg.norm(steering(np.zeros((901, 2)), velocity, np.array([[5.0, 0.0]]), 1000.0, beta), axis=1)
    assert size[0] == 0
    assert heading[size.argmax()] == pytest.approx(1 / beta, abs=np.radians(0.1))
    assert size.max() == pytest.approx(1000 / (beta * np.e), rel=1e-3)


def test_steering_points_away_from_the_obstacle():
    term = steering(np.zeros(2), np.array([1.0, 0.1]), np.array([[5.0, 0.0]]), 1000.0, 20 / np.pi)
    assert term[1] > 0


def test_dynamic_potential_acts_only_on_approach():
    wall = np.array([2.0, 0.0])
    for heading, active in ((1.0, True), (-1.0, False)):
        term = dynamic_potential(
            np.zeros(2), np.array([heading, 0.0]), lambda x: np.broadcast_to(wall, x.shape), 10.0, 2.0
        )
        assert (term[0] < -0.1) == active
    # On the line to the obstacle the potential is lambda |v| / distance.
    term = dynamic_potential(np.zeros(2), np.array([1.0, 0.0]), lambda x: np.broadcast_to(wall, x.shape), 10.0, 2.0)
    assert term[0] == pytest.approx(-10 / 4, rel=1e-4)


def test_without_coupling_the_primitive_moves_alone_as_its_closed_form():
    """From rest without forcing, x = g (1 - (1 + l t) exp(-l t)) with l = alpha_z / (2 tau)."""
    time = np.arange(0, 1.0005, 1e-3)
    skill = Skill(np.zeros((len(time), 1)), np.array([1.0]), 1.0)
    path = coupled_rollout(skill, lambda k, x, v: np.zeros(1), 1e-3, np.zeros(1), np.zeros(1))
    np.testing.assert_allclose(path[:, 0], 1 - (1 + 12.5 * time) * np.exp(-12.5 * time), atol=5e-3)


def push(t: float) -> np.ndarray:
    return np.array([[0.0, 0.0], [0.0, 300.0 if 0.3 < t < 0.5 else 0.0]])


def disturbed(agents: Agents) -> np.ndarray:
    starts, goals = np.array([[0.0, 0.0], [0.0, 2.0]]), np.array([[10.0, 0.0], [10.0, 2.0]])
    paths = agents.rollout(lambda s: np.zeros((2, 2)), starts, goals, push, 1e-3, 1.0)
    return np.linalg.norm(paths[:, 0] - paths[:, 1], axis=1) - 2


def test_coupled_agents_hold_their_distance_better_the_stronger_the_coupling():
    worst = [np.abs(disturbed(Agents(k, 2.0))).max() for k in (0, 10, 50)]
    assert worst[0] == pytest.approx(1.40, abs=0.01)
    assert worst[0] > 2 * worst[1] > 4 * worst[2]


def test_predictive_coupling_lowers_the_worst_error_further():
    worst = [np.abs(disturbed(Agents(10, 2.0, prediction=c))).max() for c in (0, 10, 20)]
    assert worst[0] > worst[1] > worst[2]


def test_surface_follower_reaches_its_force_on_a_plane():
    time = np.arange(0, 3.0005, 1e-3)
    skill = Skill(np.zeros((len(time), 2)), np.array([10.0, 0.1]), 3.0)
    _, force = SurfaceFollower(20, 100, 5.0).rollout(skill, np.array([0.0, 0.1]), 1e-3, lambda x: 0.0, 20.0)
    assert force[-1] == pytest.approx(5, abs=0.05)
