import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from dexrepro.primitives.barrier import (
    Constraint,
    Gains,
    case_two_value,
    closed_loop_rates,
    decay_in_error_coordinates,
    gain,
    lyapunov_rate,
    printed_case_two_pull,
)

GAINS = Gains()
CASES = {
    "asymmetric inside": Constraint(True, 75.0, -60.0),
    "inside": Constraint(True, 75.0),
    "outside": Constraint(False, 75.0),
    "asymmetric outside": Constraint(False, 75.0, -60.0),
}


def random_errors(constraint: Constraint, rng: np.random.Generator, count: int = 500) -> np.ndarray:
    dimensions = 1 if constraint.lower is not None else 2
    z1 = rng.uniform(-300, 300, (20 * count, dimensions))
    if constraint.inside:
        z1 /= 3
    return z1[constraint.satisfied(z1)][:count]


@pytest.mark.parametrize("coupling", [1.0, 1 / 3])
@pytest.mark.parametrize("name", CASES)
def test_lyapunov_function_never_rises_and_its_rate_is_minus_a_sum_of_squares(name, coupling):
    constraint, rng = CASES[name], np.random.default_rng(1)
    z1 = random_errors(constraint, rng)
    z2 = rng.normal(0, 100, z1.shape)
    rate = lyapunov_rate(z1, z2, *closed_loop_rates(z1, z2, constraint, GAINS, coupling), constraint)
    square = z1 / (1 if constraint.inside else (z1**2).sum(-1, keepdims=True))
    square = (square + (-1 if constraint.inside else 1) * coupling * z2 / 2) ** 2
    expected = -6 * (constraint.share(z1) * square).sum(-1) - 10 * (z2**2).sum(-1)
    np.testing.assert_allclose(rate, expected, rtol=1e-5, atol=1e-3)
    assert (rate <= 1e-6).all()


@pytest.mark.parametrize(("norm", "sided"), [("inside", True), ("outside", False)])
def test_asymmetric_cases_with_equal_bounds_are_the_symmetric_ones(norm, sided):
    symmetric, asymmetric = CASES[norm], Constraint(sided, 75.0, -75.0)
    z1 = random_errors(asymmetric, np.random.default_rng(2))
    for method in ("value", "pull", "share"):
        np.testing.assert_allclose(getattr(symmetric, method)(z1), getattr(asymmetric, method)(z1))


def test_printed_second_case_pushes_negative_errors_into_the_forbidden_band():
    """(6.17) gives W = 1 on both sides: from z1 = -62 the bound -60 is reached after 2 d_z / k_z = 1/3 s."""
    constraint = CASES["asymmetric outside"]
    assert printed_case_two_pull(np.array([-62.0, 90.0]), -60.0, 75.0) == pytest.approx([1.0, 1.0])
    z1, z2 = np.array([[-62.0]]), np.zeros((1, 1))
    printed = closed_loop_rates(z1, z2, constraint, GAINS, 1.0, printed_case_two_pull(z1, -60.0, 75.0))[0]
    assert (-60.0 + 62.0) / printed.item() == pytest.approx(1 / 3)
    assert lyapunov_rate(z1, z2, printed, z2, constraint).item() > 0
    assert closed_loop_rates(z1, z2, constraint, GAINS, 1.0)[0].item() < 0


def test_second_case_needs_bounds_of_different_sign():
    assert np.isnan(case_two_value(np.array([10.0, 29.0, 76.0, 200.0]), 30.0, 75.0)).all()
    assert np.isfinite(case_two_value(np.array([-62.0, 90.0]), -60.0, 75.0)).all()
    with pytest.raises(ValueError, match="lower < 0 < upper"):
        Constraint(False, 75.0, 30.0)


def test_outside_error_grows_as_the_square_root_of_time():
    """With z2 = 0, z1^2 = z1(0)^2 + 2 k_z t / d_z: the error never tends to zero (against Remark 6.2)."""
    first, _, _ = decay_in_error_coordinates([90.0, 0.0], [0.0, 0.0], CASES["outside"], GAINS, 1.0, 1e-3, 1000)
    np.testing.assert_allclose(first[-1] ** 2, [90.0**2 + 2 * 6.0, 0.0], rtol=1e-6)


@settings(deadline=None, max_examples=15)
@given(share=st.floats(0.05, 0.95), angle=st.floats(0, 6.28), speed=st.floats(0, 80), weighted=st.booleans())
def test_in_error_coordinates_v_never_rises_and_the_bound_holds(share, angle, speed, weighted):
    """|e| <= h sqrt(1 - exp(-2 V(0) / rho)) follows from dV/dt <= 0."""
    weight = 75.0**2 if weighted else 1.0
    constraint = Constraint(True, 75.0, weight=weight)
    direction = np.array([np.cos(angle), np.sin(angle)])
    first, _, v = decay_in_error_coordinates(
        75 * share * direction, 25 * speed * direction[::-1], constraint, GAINS, 1.0, 5e-3, 100
    )
    assert (np.diff(v) <= 1e-12 * v[:-1]).all()
    assert constraint.satisfied(first).all()
    assert np.linalg.norm(first, axis=1).max() <= 75 * np.sqrt(-np.expm1(-2 * v[0] / weight)) * (1 + 1e-9)


@pytest.mark.parametrize("name", ["inside", "outside"])
def test_the_steps_follow_the_equations_of_the_error(name):
    constraint, errors = CASES[name], []
    start = np.array([40.0, -30.0] if name == "inside" else [70.0, -60.0]), np.array([25.0, 10.0])
    truth = solve_ivp(
        lambda t, z: np.concatenate(closed_loop_rates(z[:2], z[2:], constraint, GAINS, 0.8)),
        (0, 0.2), np.concatenate(start), rtol=1e-10, atol=1e-10,
    ).y[:, -1]  # fmt: skip
    for dt in (4e-3, 1e-3):
        first, second, _ = decay_in_error_coordinates(*start, constraint, GAINS, 0.8, dt, round(0.2 / dt))
        assert len(first) == round(0.2 / dt) + 1
        errors.append(np.abs(np.concatenate([first[-1], second[-1]]) - truth).max())
    assert errors[1] < 0.05
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1), "of first order"


def test_gain_carries_the_barrier_only_near_the_bound():
    """With weight 1 the barrier's share of k_n at e = 0 is 4e-7 of the total for tau = 5 s: it is not scaled to z2."""
    constraint = Constraint(True, 75.0)
    k = gain(np.zeros((1, 2)), constraint, GAINS, 1 / 5).item()
    assert (k - 0.4) / k == pytest.approx(1.07e-6, rel=0.01)


@pytest.mark.parametrize("name", CASES)
def test_the_rate_of_the_pull_is_its_derivative_along_the_error(name):
    constraint, rng = CASES[name], np.random.default_rng(3)
    z1 = random_errors(constraint, rng)
    rate, step = rng.normal(0, 100, z1.shape), 1e-6
    difference = (constraint.pull(z1 + step * rate) - constraint.pull(z1 - step * rate)) / (2 * step)
    np.testing.assert_allclose(constraint.pull_rate(z1, rate), difference, rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("z1", [50.0, -50.0, 0.5, -0.5])
def test_the_second_case_is_the_printed_one_also_where_its_bounds_have_one_sign(z1):
    """(6.17): K_1 of the lower bound on the right where it is positive, of the upper one on the left otherwise."""
    low, high = 0.6 * abs(z1), 1.5 * abs(z1)
    lower, upper = (low, high) if z1 > 0 else (-high, -low)
    inner = 1 / ((lower if z1 > 0 else upper) ** 2 - z1**2)
    outer = (upper**2 if z1 > 0 else lower**2) / (z1**2 - (upper if z1 > 0 else lower) ** 2)
    expected = (outer + inner * z1**4) / (outer - inner * z1**3)
    assert printed_case_two_pull(np.array([z1]), lower, upper) == pytest.approx([expected])


@pytest.mark.parametrize("scale", [1.0, 0.01])
def test_the_printed_barrier_of_the_second_case_is_the_keep_out_zone(scale):
    """(6.16) with its flags, for bounds on both sides of the reference."""
    z1 = scale * np.array([-200.0, -62.0, 76.0, 150.0])
    constraint = Constraint(False, 75.0 * scale, -60.0 * scale)
    assert case_two_value(z1, -60.0 * scale, 75.0 * scale) == pytest.approx(constraint.value(z1[:, None]))
