import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dexrepro.control.movement_estimation import MovementEstimation

DT = 1e-3


def estimation(**changes):
    gains = dict(stiffness=30.0, coefficients=(0.55, 0.0, 0.0), rates=(10.0, 100.0, 500.0, 500.0), dt=DT, window=1.0)
    return MovementEstimation(**{**gains, **changes})


def test_prediction_error_vanishes_on_an_object_that_moves_like_the_model():
    law = estimation()
    for i in range(4000):
        rest = 0.55 + 0.02 * i * DT
        law(0.5, 35.0 * (rest - 0.5))
    assert law.stiffness * (law.position - 0.5) == pytest.approx(35.0 * (rest - 0.5), abs=1e-4)


def test_estimated_rest_position_is_off_by_what_the_wrong_stiffness_explains():
    """f_d (1/khat - 1/k_o): without excitation the stiffness cannot be found, Erratum E2.05."""
    law, force = estimation(rates=(0.0, 100.0, 500.0, 500.0)), 1.0
    for _ in range(4000):
        law(0.55 - force / 35.0, force)
    assert law.position - 0.55 == pytest.approx(force * (1 / 30.0 - 1 / 35.0), abs=1e-6)


@settings(deadline=None, max_examples=20)
@given(st.lists(st.floats(-1, 1), min_size=3, max_size=3), st.floats(0.2, 2.0).map(lambda w: round(w, 2)))
def test_moving_the_origin_of_time_keeps_the_estimate_continuous(coefficients, window):
    a0, a1, a2 = coefficients
    law = estimation(coefficients=coefficients, window=window)
    law._move_origin()
    moved = law.coefficients
    assert moved[0] == pytest.approx(a0 + a1 * window + a2 * window**2, abs=1e-12)
    assert moved[1] == pytest.approx(a1 + 2 * a2 * window, abs=1e-12)
    assert moved[2] == a2


def test_a_frozen_estimate_does_not_notice_the_window():
    short, printed = (estimation(rates=(0, 0, 0, 0), coefficients=(0.5, 0.1, -0.2), window=w) for w in (0.1, None))
    for _ in range(350):
        short(0.5, 0.0), printed(0.5, 0.0)
    for name in ("position", "velocity", "acceleration"):
        assert getattr(short, name) == pytest.approx(getattr(printed, name), abs=1e-12)


@settings(deadline=None, max_examples=10)
@given(st.floats(0.1, 50.0), st.floats(10.0, 60.0))
def test_lyapunov_function_falls_by_the_exact_discrete_amount(rate, stiffness):
    """dV = -dt e^2 (1 - dt L / 2) with L = sum g_j Y_j^2, to the second order in dt, for constant parameters."""
    rates = (rate, 2 * rate, rate, rate)
    truth, rest = (stiffness, stiffness * 0.6, stiffness * 0.05, 0.0), lambda t: 0.6 + 0.05 * t
    law = estimation(rates=rates, window=None)

    def lyapunov():
        k, a = law.stiffness, law.coefficients
        phi = (truth[0] - k, *(k * c - p for c, p in zip(a, truth[1:])))
        return 0.5 * sum(p * p / g for p, g in zip(phi, rates))

    for i in range(200):
        before, t, x = lyapunov(), i * DT, 0.5 + 0.03 * math.sin(i * DT)
        k, a = law.stiffness, law.coefficients
        phi = [k * c - p for c, p in zip(a, truth[1:])]
        error = k * (a[0] + a[1] * t + a[2] * t * t - x) - stiffness * (rest(t) - x)
        load = rates[0] * x * x + rates[1] + rates[2] * t**2 + rates[3] * t**4
        dk = rates[0] * x * error  # the product k a_j has a remainder of second order in the step, Eq. (2.18)
        remainders = [DT**2 * dk * (g * t**j * error + dk * c) / k for j, (g, c) in enumerate(zip(rates[1:], a))]
        second_order = sum(abs(p * r) + r * r for p, r in zip(phi, remainders)) / min(rates)
        law(x, stiffness * (rest(t) - x))
        exact = -DT * error**2 * (1 - 0.5 * DT * load)
        assert lyapunov() - before == pytest.approx(exact, rel=1e-3, abs=2 * second_order + 1e-12)


def test_printed_time_diverges_once_the_step_limit_is_passed():
    """All rates c and time from the start: unstable when dt c t^4 reaches about 2."""
    law, c = estimation(rates=(10.0,) * 4, coefficients=(0.55, 0.0, 0.0), window=None), 10.0
    predicted = (2 / (DT * c)) ** 0.25
    with np.errstate(all="ignore"):
        for i in range(10000):
            x = 0.52 + 0.01 * math.sin(0.3 * i * DT)
            law(x, 35.0 * (0.55 + 0.05 * math.sin(0.5 * i * DT) - x))
            if abs(law.stiffness * (law.position - x)) > 100:
                break
    assert i * DT == pytest.approx(predicted, rel=0.1)


def test_implicit_step_survives_where_the_explicit_one_diverges():
    law = estimation(rates=(10.0,) * 4, window=None, implicit=True)
    for i in range(10000):
        law(0.5, 35.0 * (0.05 + 0.02 * math.sin(0.5 * i * DT)))
    assert abs(law.stiffness * (law.position - 0.5)) < 10


def test_total_derivative_follows_a_moving_rest_position():
    law = estimation(window=None, rates=(0.0, 100.0, 20.0, 0.0), velocity="total")
    for i in range(3000):
        law(0.5, 30.0 * (0.05 + 0.02 * math.sin(i * DT)))
    assert law.velocity == pytest.approx(0.02 * math.cos(3.0), abs=2e-3)


def test_stiffness_estimate_stays_above_its_floor():
    law = estimation(rates=(3e4, 100.0, 500.0, 500.0), implicit=True)
    for _ in range(300):
        law(0.5, 50.0)
        assert law.stiffness >= 1.0


def test_a_batch_equals_single_runs():
    stiffness = np.array([20.0, 30.0])
    batch = estimation(stiffness=stiffness, coefficients=(np.full(2, 0.55), np.zeros(2), np.zeros(2)))
    single = [estimation(stiffness=float(k)) for k in stiffness]
    for i in range(1500):
        force = 1.0 + math.sin(i * DT)
        batch(0.5, np.full(2, force))
        for law in single:
            law(0.5, force)
    assert batch.position == pytest.approx([law.position for law in single], abs=1e-12)
    assert batch.stiffness == pytest.approx([law.stiffness for law in single], abs=1e-9)


def test_the_number_of_rates_must_fit():
    with pytest.raises(ValueError, match="need 4 rates"):
        estimation(rates=(1.0, 1.0))


def test_velocity_and_acceleration_are_the_derivatives_of_the_polynomial():
    law = estimation(rates=(0.0,) * 6, coefficients=(0.5, 0.1, -0.2, 0.3, -0.4), window=None)
    for _ in range(801):
        law(0.5, 0.0)
    rest = np.polynomial.Polynomial((0.5, 0.1, -0.2, 0.3, -0.4))
    assert law.position == pytest.approx(rest(0.8))
    assert law.velocity == pytest.approx(rest.deriv(1)(0.8))
    assert law.acceleration == pytest.approx(rest.deriv(2)(0.8))


def test_the_implicit_step_takes_the_error_that_is_left_after_it():
    """e / (1 + dt sum_j g_j Y_j^2) with Y = (x, 1, t, t^2): what an explicit step leaves, to the first order in dt."""
    rates, x, force, steps = (30.0, 3.0, 5.0, 7.0), 0.7, 2.0, 500
    explicit, implicit = (estimation(rates=rates, window=None, implicit=kind) for kind in (False, True))
    for _ in range(steps):
        explicit(x, force)
    implicit.stiffness, implicit.coefficients = explicit.stiffness, list(explicit.coefficients)
    implicit._sample, t = steps, steps * DT
    before = explicit.stiffness
    explicit(x, force), implicit(x, force)
    load = 30.0 * x**2 + 3.0 + 5.0 * t**2 + 7.0 * t**4
    assert implicit.stiffness - before == pytest.approx((explicit.stiffness - before) / (1 + DT * load), rel=1e-9)
