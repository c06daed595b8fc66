import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dexrepro.control.prescribed_performance import PerformanceBound

BOUND = PerformanceBound(initial=1.25, final=0.1, decay=1.0, lower=0.2, upper=0.3)


def test_bound_shrinks_from_its_initial_to_its_final_value():
    assert BOUND.nu([0.0, 40.0]) == pytest.approx([1.25, 0.1])
    assert np.all(np.diff(BOUND.nu(np.linspace(0, 5, 50))) < 0)


def test_relative_rate_and_its_derivative_match_finite_differences():
    h, t = 1e-5, 0.7
    _, ratio, ratio_rate = BOUND.rate(t)
    assert ratio == pytest.approx((np.log(BOUND.nu(t + h)) - np.log(BOUND.nu(t - h))) / (2 * h), rel=1e-8)
    assert ratio_rate == pytest.approx((BOUND.rate(t + h)[1] - BOUND.rate(t - h)[1]) / (2 * h), rel=1e-8)


def test_usage_is_one_at_either_bound():
    assert BOUND.usage(np.array([0.3, -0.2]), 1.0) == pytest.approx([1.0, -1.0])


@settings(deadline=None, max_examples=30)
@given(st.floats(-0.19, 0.29), st.floats(0, 5))
def test_barrier_gradient_is_the_derivative_of_the_barrier_function(share, t):
    nu = BOUND.nu(t)
    error = share * nu

    def barrier(e):
        return 0.5 * np.log(1 / (1 - BOUND.usage(e, nu) ** 2))

    h = 1e-7 * nu
    expected = (barrier(error + h) - barrier(error - h)) / (2 * h)
    gradient = BOUND.barrier_gradient(np.array([error]), nu)
    assert gradient == pytest.approx([expected], rel=1e-4, abs=1e-4 / nu)
    assert gradient * error >= 0


def test_barrier_gradient_is_odd_for_equal_bounds_and_finite_outside():
    equal = PerformanceBound(1.0, 0.5, 1.0, lower=0.2, upper=0.2)
    errors = np.array([0.0, 0.1, 0.19, 5.0])
    pushed = equal.barrier_gradient(errors, 1.0)
    assert pushed[0] == 0.0
    assert equal.barrier_gradient(-errors, 1.0) == pytest.approx(-pushed)
    assert np.all(np.isfinite(pushed))
