import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dexrepro.control.potential_field import PotentialField

AXIS = np.array([0.0, 1.0, 0.0])


def field(**changes):
    values = dict(
        ready_distance=0.25, repulsion_range=0.22, lower=0.18, upper=0.30, reach=1.8,
        gains=(0.002, 1.3, 0.8), compliance=0.03, max_step=0.003,
    )  # fmt: skip
    return PotentialField(**(values | changes))


@given(st.integers(0, 2**32 - 1))
@settings(deadline=None, max_examples=30)
def test_force_is_the_negative_gradient(seed):
    rng = np.random.default_rng(seed)
    f = field()
    f.place(np.zeros(3), AXIS, AXIS * rng.uniform(0.15, 0.4) + rng.normal(scale=0.01, size=3))
    x = f.points[0] + rng.uniform(0.08, 0.3) * (u := rng.normal(size=3)) / np.linalg.norm(u)
    h = 1e-6 * np.eye(3)
    gradient = (f.potential(x + h) - f.potential(x - h)) / 2e-6
    np.testing.assert_allclose(f.force(x), -gradient, atol=1e-6 * (1 + np.abs(gradient).max()))


def test_the_potential_is_that_of_two_springs_and_of_a_repulsion_within_its_range():
    """U = w1 eta1 (1/rho1 - 1/rho0)^2 / 2 + w2 eta2 rho2^2 / 2 + w3 eta3 rho3^2 / 2, Eq. (1.18), one place or many."""
    f = field()
    f.place(np.zeros(3), AXIS, 0.24 * AXIS)  # w = 1/2 each
    near, far = np.array([0.1, 0.24, 0.0]), np.array([0.3, 0.24, 0.0])
    springs = [0.25 * (1.3 * (x**2 + 0.25**2) + 0.8 * (x**2 + (0.24 * 0.8) ** 2)) for x in (0.1, 0.3)]
    repulsion = 0.25 * 0.002 * (1 / 0.1 - 1 / 0.22) ** 2
    np.testing.assert_allclose(f.potential(np.stack([near, far])), [springs[0] + repulsion, springs[1]])
    assert f.potential(near) == pytest.approx(springs[0] + repulsion)


def test_weights_share_the_field_and_move_monotonically():
    weights = np.array([field().weights(d) for d in np.linspace(0.1, 0.4, 61)])
    np.testing.assert_allclose(weights[:, 0] + weights[:, 2], 1.0)
    assert np.all(np.diff(weights[:, 0]) >= 0)
    assert field().weights(0.24)[0] == pytest.approx(0.5)
    assert weights.min() == 0.0
    assert weights.max() == 1.0


def test_follower_settles_at_the_ready_position_and_never_steps_too_far():
    f = field()
    partner, measured = np.zeros(3), 0.38 * AXIS
    f.reset(np.array([0.3, 0.7, 0.1]))
    path = np.array([f(partner, AXIS, measured) for _ in range(600)])
    assert np.abs(np.diff(path, axis=0)).max() <= 0.003 + 1e-15
    np.testing.assert_allclose(path[-1], measured + 0.25 * AXIS, atol=1e-6)


def test_close_partner_draws_the_follower_through_the_surface():
    f = field()
    f.reset(0.4 * AXIS)
    for _ in range(600):
        end = f(np.zeros(3), AXIS, 0.15 * AXIS)
    np.testing.assert_allclose(end, 1.8 * 0.15 * AXIS, atol=1e-6)  # 0.12 m from the centre of a 0.15 m object


def test_a_follower_that_starts_on_the_partners_side_is_pulled_through_the_object():
    f = field()
    f.reset(np.array([0.0, 0.05, 0.0]))
    path = np.array([f(np.zeros(3), AXIS, 0.38 * AXIS) for _ in range(2000)])
    assert np.linalg.norm(path - 0.38 * AXIS, axis=1).min() < 0.15


@pytest.mark.parametrize(("distance", "third"), [(0.15, 1.8 * 0.15), (0.30, 1.8 * 0.30), (0.38, 0.30)])
def test_the_three_subfields_stand_at_the_object_behind_it_and_before_the_partner(distance, third):
    """X_o, X_o + d_2 z and X_D + d_3 z with d_3 = varpi rho of a near object, else rho_D,o: Eqs. (1.19), (1.20)."""
    f, partner = field(), np.array([0.1, -0.2, 0.3])
    f.place(partner, AXIS, partner + distance * AXIS)
    np.testing.assert_allclose(f.points, partner + np.outer([distance, distance + 0.25, third], AXIS))


def test_weights_that_are_given_stay():
    f = field(weights=(0.2, 0.3, 0.5))
    f.place(np.zeros(3), AXIS, 0.5 * AXIS)
    assert f.active == (0.2, 0.3, 0.5)
    np.testing.assert_allclose(
        f.force(0.9 * AXIS), (-0.3 * 1.3 * (0.9 - 0.75) - 0.5 * 0.8 * (0.9 - 0.3)) * AXIS, atol=1e-15
    )
