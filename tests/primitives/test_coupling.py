import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dexrepro.primitives.constrained import Skill
from dexrepro.primitives.coupling import Agents, SurfaceFollower, coupled_rollout, dynamic_potential, steering
from dexrepro.primitives.transformation import semi_implicit

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


@pytest.mark.parametrize("velocity", [(1.5, 0.4), (0.3, -0.8), (2.0, 2.0)])
def test_the_potential_is_minus_the_gradient_of_its_formula(velocity):
    """lambda (-cos theta)^beta |v| / p about a point at the origin, with cos theta = x . v / (|x| |v|)."""
    x, v, power = np.array([-2.0, 0.3]), np.array(velocity), 3.0
    p, speed = np.linalg.norm(x), np.linalg.norm(v)
    cosine = -(x @ v) / (p * speed)
    slope = -v / (p * speed) + (x @ v) * x / (p**3 * speed)
    gradient = 10.0 * speed * (power * cosine ** (power - 1) * slope / p - cosine**power * x / p**3)
    if cosine < 0:
        gradient = np.zeros(2)
    assert dynamic_potential(x, v, np.zeros_like, 10.0, power) == pytest.approx(-gradient, rel=1e-5, abs=1e-12)


@pytest.mark.parametrize("power", [20 / np.pi, 2.0])
def test_steering_adds_up_over_points_and_grows_with_the_speed(power):
    """gamma R v phi exp(-beta phi): two points, at 0.3 to the left and 0.5 to the right of the heading."""
    points = 4.0 * np.array([[np.cos(0.3), np.sin(0.3)], [np.cos(0.5), -np.sin(0.5)]])
    size = np.array([-0.3 * np.exp(-power * 0.3), 0.5 * np.exp(-power * 0.5)]) * [900.0, 700.0]
    term = steering(np.zeros(2), np.array([2.0, 0.0]), points, np.array([900.0, 700.0]), power)
    assert term == pytest.approx([0.0, 2.0 * size.sum()])


def test_a_term_is_asked_at_every_step_and_the_path_has_every_sample():
    skill = Skill(np.arange(5.0)[:, None], np.array([1.0]), 1.0)
    asked = []

    def term(k, x, v):
        asked.append(k)
        return np.full(1, 3.0)

    path = coupled_rollout(skill, term, 0.01, np.zeros(1), np.zeros(1), semi_implicit)
    assert asked == [0, 1, 2, 3]
    x, v = 0.0, 0.0
    for k in range(5):
        assert path[k, 0] == pytest.approx(x)
        v = v + 0.01 * (156.25 * (1.0 - x) - 25.0 * v + k + 3.0)
        x = x + 0.01 * v


@pytest.mark.parametrize("slowing", [0.0, 6.0])
def test_the_phase_of_an_agent_waits_for_the_distance(slowing):
    """s' = -decay s / (1 + eta (|x_1 - x_2| - d)^2), in the units of C / k."""
    seen, agents = [], Agents(4.0, 2.0, slowing=slowing, decay=0.9)
    starts = np.array([[0.0, 0.0], [0.0, 3.0]])

    def forcing(s):
        seen.append(s)
        return np.zeros((2, 2))

    agents.rollout(forcing, starts, starts, lambda t: np.zeros((2, 2)), 0.01, 0.02)
    assert seen[:2] == [1.0, 1.0]
    assert seen[2:] == pytest.approx([1.0 - 0.01 * 0.9 / (1.0 + slowing)] * 2)
    alone = Agents(4.0, 3.0, slowing=slowing, decay=0.9)
    seen.clear()
    alone.rollout(forcing, starts, starts, lambda t: np.zeros((2, 2)), 0.01, 0.5)
    assert seen[-1] == pytest.approx((1.0 - 0.01 * 0.9) ** 49), "it does not wait at its distance"


def test_the_first_step_of_two_agents_is_that_of_their_equations():
    """tau dv/dt = K (g - x) + c_2 dC/dt, tau dx/dt = v + C with C = -k n (|x_1 - x_2| - d), opposite on the two."""
    starts, goals, dt = np.array([[0.0, 0.0], [0.0, 3.0]]), np.array([[1.0, 0.0], [1.0, 3.0]]), 0.01
    path = Agents(4.0, 2.0, prediction=0.5).rollout(
        lambda s: np.zeros((2, 2)), starts, goals, lambda t: np.zeros((2, 2)), dt, 0.02
    )
    pull = np.array([[0.0, 4.0], [0.0, -4.0]])  # they are 1 too far apart
    velocity = dt * 156.25 * (goals - starts)
    first = starts + dt * (velocity + pull)
    assert path[1] == pytest.approx(first)
    gap = first[1, 1] - first[0, 1]
    later = np.array([[0.0, 4.0 * (gap - 2.0)], [0.0, -4.0 * (gap - 2.0)]])
    velocity = velocity + dt * (156.25 * (goals - first) - 25.0 * velocity + 0.5 * (later - pull) / dt)
    assert path[2] == pytest.approx(first + dt * (velocity + later))


def test_a_surface_pushes_back_in_proportion_and_over_time():
    """error = k max(h - y, 0) - f_d enters tau dv/dt as P error + I (sum of error dt), across the surface alone."""
    skill, dt = Skill(np.zeros((3, 2)), np.array([0.0, -0.1]), 1.0), 0.01
    path, force = SurfaceFollower(20.0, 100.0, 5.0).rollout(skill, np.array([0.0, -0.1]), dt, lambda x: 0.0, 30.0)
    assert force[0] == pytest.approx(3.0)
    vertical = dt * (20.0 * -2.0 + 100.0 * -2.0 * dt)
    assert path[1] == pytest.approx([0.0, -0.1 + dt * vertical])
    assert force[1] == pytest.approx(30.0 * (0.1 - dt * vertical))
    _, force = SurfaceFollower(0.0, 0.0, 5.0).rollout(skill, np.array([0.0, 0.4]), dt, lambda x: 0.0, 30.0)
    assert force[0] == 0.0, "it does not touch"
