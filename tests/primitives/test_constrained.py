import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dexrepro.primitives.constrained import (
    LAWS,
    Constraint,
    Gains,
    Reference,
    Skill,
    case_two_value,
    closed_loop_rates,
    decay_in_error_coordinates,
    gain,
    lyapunov_rate,
    printed_case_two_pull,
    rollout,
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


def test_without_the_barrier_the_error_decays_with_poles_six_and_ten():
    """e(t) = e(0) (k_2 exp(-a t) - a exp(-k_2 t)) / (k_2 - a), a = k_z / d_z, when v starts at the reference's."""
    time = np.arange(0, 0.5005, 1e-3)
    circle = np.stack([np.cos(time), np.sin(time)], 1)
    reference = Reference(circle, np.stack([-np.sin(time), np.cos(time)], 1), -circle)
    path = rollout(
        Skill(np.zeros_like(circle), np.zeros(2), 1.0),
        reference,
        Constraint(True, 1e9),
        GAINS,
        LAWS["consistent"],
        1e-3,
        circle[0] - [0.3, 0.0],
        reference.velocity[0],
    )
    expected = 0.3 * (10 * np.exp(-6 * time) - 6 * np.exp(-10 * time)) / 4
    np.testing.assert_allclose(path.distance, expected, atol=1e-3)
    assert expected[-1] == pytest.approx(0.0343, abs=1e-4)


def bumpy(dt: float, amplitude: float, duration: float = 2.0) -> tuple[np.ndarray, Reference]:
    time = np.arange(0, duration + dt / 2, dt)
    w = 2 * np.pi / duration
    wave = amplitude * (1 - np.cos(w * time))
    zero, one = np.zeros_like(time), np.ones_like(time)
    return time, Reference(
        np.stack([time, wave], 1),
        np.stack([one, amplitude * w * np.sin(w * time)], 1),
        np.stack([zero, amplitude * w * w * np.cos(w * time)], 1),
    )


def roll(
    law: str, reference: Reference, dt: float, margin: float = 0.3, projection: float | None = None, tau: float = 1.0
):
    skill = Skill(
        np.zeros_like(reference.position), reference.position[-1], tau, nominal=np.zeros_like(reference.position)
    )
    constraint = Constraint(True, GAINS.position * margin)
    return rollout(
        skill,
        reference,
        constraint,
        GAINS,
        LAWS[law],
        dt,
        reference.position[0],
        tau * reference.velocity[0],
        projection,
    )


def test_consistent_law_follows_the_reference_whatever_was_learned():
    """Its path does not depend on goal, forcing or time constant of the primitive."""
    _, reference = bumpy(1e-3, 1.0)
    for tau in (0.5, 2.0):
        skill = Skill(np.random.default_rng(0).normal(size=reference.position.shape), np.ones(2), tau)
        path = rollout(
            skill,
            reference,
            Constraint(True, 75.0),
            GAINS,
            LAWS["consistent"],
            1e-3,
            reference.position[0],
            tau * reference.velocity[0],
        )
        assert path.distance.max() < 2e-3
        assert path.lyapunov.max() < 1.0


def test_lagged_acceleration_alternates_and_leaves_the_tube():
    _, reference = bumpy(1e-3, 0.2, 5.0)
    path = roll("lagged", reference, 1e-3)
    assert not path.defined[-1]
    last = np.flatnonzero(path.defined)[-1]
    change = np.diff(path.velocity[last - 20 : last, 1], n=2)
    assert (np.sign(change[1:]) == -np.sign(change[:-1])).all()


@settings(deadline=None, max_examples=20)
@given(
    law=st.sampled_from([name for name in LAWS]),
    dt=st.sampled_from([1e-3, 5e-3, 1e-2]),
    amplitude=st.floats(0, 5),
    margin=st.floats(0.05, 1),
)
def test_projection_keeps_the_constraint_for_every_law_step_and_reference(law, dt, amplitude, margin):
    _, reference = bumpy(dt, amplitude)
    path = roll(law, reference, dt, margin, projection=0.2)
    assert (path.distance < margin * (1 + 1e-9)).all()


def test_projection_is_idle_where_the_law_keeps_the_constraint_itself():
    _, reference = bumpy(1e-3, 0.05)
    free, guarded = (roll("consistent", reference, 1e-3, projection=rate) for rate in (None, 0.2))
    assert not guarded.projected.any()
    np.testing.assert_array_equal(free.position, guarded.position)


def test_filter_leaves_the_primitive_alone_inside_and_keeps_the_constraint():
    time, reference = bumpy(1e-3, 0.0)
    skill = Skill(np.zeros_like(reference.position), reference.position[-1], 1.0)
    start = (reference.position[0], reference.velocity[0])
    wide = rollout(skill, reference, Constraint(True, 1e6), GAINS, LAWS["filter"], 1e-3, *start)
    alone = rollout(skill, reference, Constraint(True, 1e6), GAINS, LAWS["none"], 1e-3, *start)
    assert not wide.filtered.any()
    np.testing.assert_array_equal(wide.position, alone.position)
    tight = rollout(skill, reference, Constraint(True, 15.0), GAINS, LAWS["filter"], 1e-3, *start)
    assert tight.filtered.any()
    assert alone.distance.max() > 0.1
    assert tight.distance.max() < 0.1 * 1.001


def test_runs_of_a_batch_do_not_influence_each_other():
    _, reference = bumpy(1e-3, 0.3)
    batch = Reference(
        *(
            np.repeat(part[:, None], 2, axis=1)
            for part in (reference.position, reference.velocity, reference.acceleration)
        )
    )
    margins = np.array([[0.3], [1e-3]])
    skill = Skill(np.zeros_like(batch.position), batch.position[-1], 1.0)
    both = rollout(
        skill,
        batch,
        Constraint(True, 150 * margins),
        GAINS,
        LAWS["printed"],
        1e-3,
        batch.position[0],
        batch.velocity[0],
    )
    single = roll("printed", reference, 1e-3)
    np.testing.assert_allclose(both.position[:, 0], single.position, atol=1e-12)
    assert not both.defined[-1, 1]


def test_gain_carries_the_barrier_only_near_the_bound():
    """With weight 1 the barrier's share of k_n at e = 0 is 4e-7 of the total for tau = 5 s: it is not scaled to z2."""
    constraint = Constraint(True, 75.0)
    k = gain(np.zeros((1, 2)), constraint, GAINS, 1 / 5).item()
    assert (k - 0.4) / k == pytest.approx(1.07e-6, rel=0.01)
