import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from dexrepro.primitives.barrier import Constraint, Gains, gain
from dexrepro.primitives.constrained import LAWS, Moment, Reference, SafetyFilter, Skill, rollout

GAINS = Gains()


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
    _, reference = bumpy(1e-3, 0.0)
    skill = Skill(np.zeros_like(reference.position), reference.position[-1], 1.0)
    start = (reference.position[0], reference.velocity[0])
    wide = rollout(skill, reference, Constraint(True, 1e6), GAINS, LAWS["filter"], 1e-3, *start)
    alone = rollout(skill, reference, Constraint(True, 1e6), GAINS, LAWS["none"], 1e-3, *start)
    assert not wide.altered.any()
    np.testing.assert_array_equal(wide.position, alone.position)
    tight = rollout(skill, reference, Constraint(True, 15.0), GAINS, LAWS["filter"], 1e-3, *start)
    assert tight.altered.any()
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


@pytest.mark.parametrize("law", ["consistent", "printed", "feedforward"])
def test_fixed_steps_agree_with_an_adaptive_solution(law):
    """A primitive that would go straight follows a wave; LSODA solves the same equations written out."""
    dt, tau, amplitude, margin, duration = 1e-3, 2.0, 0.1, 0.3, 2.0
    time, reference = bumpy(dt, amplitude, duration)
    goal, stiffness, damping = reference.position[-1], 156.25, 25.0

    def forcing(t):
        straight = np.stack([t, 0 * t], axis=-1)
        return stiffness * (straight - goal) + damping * tau * np.array([1.0, 0.0])

    def rate(t, state):
        x, v = state[:2], state[2:]
        w = 2 * np.pi / duration
        target = np.array([t, amplitude * (1 - np.cos(w * t))])
        velocity = np.array([1.0, amplitude * w * np.sin(w * t)])
        acceleration = np.array([0.0, amplitude * w * w * np.cos(w * t)])
        z1, z1_rate = 150 * (target - x), 150 * (velocity - v / tau)
        alpha, alpha_rate = tau * (velocity + z1 / 25), tau * (acceleration + z1_rate / 25)
        z2 = 25 * (alpha - v)
        gain = 10 / 25 + 150 / (4 * 625 * tau**2) / ((150 * margin) ** 2 - z1 @ z1)
        own = (stiffness * (goal - x) - damping * v + forcing(t)) / tau
        wanted = alpha_rate + gain * z2
        applied = {"consistent": wanted, "printed": (own + wanted) / 2, "feedforward": own + wanted}[law]
        return np.concatenate([v / tau, applied])

    start, velocity = reference.position[0] - [0.05, 0.0], tau * reference.velocity[0]
    exact = solve_ivp(
        rate, (0, duration), np.concatenate([start, velocity]), method="LSODA", rtol=1e-8, atol=1e-10, t_eval=time
    )
    nominal = np.zeros_like(reference.position)
    skill = Skill(forcing(time), goal, tau, nominal=nominal)
    path = rollout(skill, reference, Constraint(True, 150 * margin), GAINS, LAWS[law], dt, start, velocity)
    assert path.distance.max() < margin
    np.testing.assert_allclose(path.position, exact.y[:2].T, atol=5e-4)


@pytest.mark.parametrize("rate", [0.2, 0.7])
def test_a_projected_step_uses_up_the_share_lambda_of_the_free_margin(rate):
    """|e+| = h - (1 - lambda) (h - |e|): the constraint is approached geometrically and never reached."""
    _, reference = bumpy(1e-3, 5.0)
    path = roll("none", reference, 1e-3, 0.3, projection=rate)
    on = np.flatnonzero(path.projected)
    assert len(on) > 10
    free = 0.3 - path.distance
    np.testing.assert_allclose(free[on], (1 - rate) * free[on - 1], rtol=1e-6, atol=1e-8)


def moment(inside=True, **parts):
    rng = np.random.default_rng(4)
    named = {name: rng.normal(size=2) for name in Moment.__slots__}
    return Moment(**{**named, "margin": 0.5, "inside": inside, "time_constant": 1.7, **parts})


def test_each_reading_of_the_law_takes_the_acceleration_that_it_is_called_after():
    """(6.14), (6.15): dv/dt = own + d(alpha_2)/dt + k_n z2 - an acceleration; solved for dv/dt where it is that."""
    now = moment()
    wanted = now.stabiliser_rate + now.decay
    expected = {
        "consistent": wanted,
        "printed": (now.own + wanted) / 2,
        "lagged": now.own + wanted - now.previous,
        "feedforward": now.own + wanted - now.nominal,
        "none": now.own,
    }
    for name, acceleration in expected.items():
        np.testing.assert_allclose(LAWS[name].base(now) + LAWS[name].share * now.decay, acceleration)


@pytest.mark.parametrize("inside", [True, False])
def test_the_filter_gives_the_least_acceleration_that_keeps_its_condition(inside):
    """b'' + (p1 + p2) b' + p1 p2 b = 0 where it acts, for b = +-(h^2 - |e|^2) along e(t), and only along e."""
    size, h, p1, p2 = (0.4 if inside else 0.6), 1e-4, 7.0, 11.0
    e = size * np.array([0.6, 0.8])
    rate = (3.0 if inside else -3.0) * e + np.array([0.2, -0.1])
    now, step = moment(inside, error=e, error_rate=rate), SafetyFilter((p1, p2))
    applied = step(now)

    def barrier(t):
        moved = e + t * rate + t**2 / 2 * (now.reference_acceleration - applied / now.time_constant)
        return (1 if inside else -1) * (0.25 - moved @ moved)

    first = (barrier(h) - barrier(-h)) / (2 * h)
    second = (barrier(h) - 2 * barrier(0) + barrier(-h)) / h**2
    assert second + (p1 + p2) * first + p1 * p2 * barrier(0) == pytest.approx(0.0, abs=1e-5)
    assert (applied - now.own) @ [-e[1], e[0]] == pytest.approx(0.0, abs=1e-9)
    assert np.abs(applied - now.own).max() > 0.1
    back = moment(inside, error=e, error_rate=-rate, own=np.zeros(2), reference_acceleration=np.zeros(2))
    assert np.array_equal(step(back), back.own), "it moves away from the bound by itself"


@pytest.mark.parametrize("explicit", [False, True])
@pytest.mark.parametrize("law", ["consistent", "printed"])
def test_one_step_is_that_of_its_equation(law, explicit):
    """dv/dt = base + share k_n d_z (alpha_2 - v): with the v and alpha_2 of the start, or of the end of the step."""
    dt, tau = 0.01, 1.6
    _, reference = bumpy(dt, 0.1)
    skill = Skill(np.ones_like(reference.position), reference.position[-1], tau)
    constraint, x, v = Constraint(True, 45.0), reference.position[0] - [0.1, 0.05], np.array([1.1, 0.4])
    path = rollout(skill, reference, constraint, GAINS, LAWS[law], dt, x, v, explicit=explicit)

    def alpha(time):
        error = reference.position[0] - x + time * (reference.velocity[0] - v / tau)
        return tau * (reference.velocity[0] + time * reference.acceleration[0] + 150 * error / 25)

    kn = gain(150 * (reference.position[0] - x), constraint, GAINS, 1 / tau)
    own = (156.25 * (skill.goal - x) - 25 * v + 1.0) / tau
    rate, share = (alpha(1e-6) - alpha(-1e-6)) / 2e-6, LAWS[law].share
    base = rate if law == "consistent" else (own + rate) / 2
    if explicit:
        after = v + dt * (base + share * kn * 25 * (alpha(0) - v))
    else:
        after = (v + dt * (base + share * kn * 25 * alpha(dt))) / (1 + dt * share * kn * 25)
    np.testing.assert_allclose(path.velocity[1], after, rtol=1e-6)
    np.testing.assert_allclose(path.position[1], x + dt * after / tau, rtol=1e-6)


def test_the_level_of_a_path_is_the_barrier_s_value_and_half_the_square_of_z2():
    """V^c with z1 = k_z e and z2 = d_z (tau (x^c' - W / d_z) - v), along any path; undefined outside."""
    _, reference = bumpy(1e-2, 0.1)
    constraint = Constraint(True, 45.0)
    path = roll("none", reference, 1e-2, 0.3, tau=1.3)
    z1 = 150 * (reference.position - path.position)
    z2 = 25 * (1.3 * (reference.velocity + z1 / 25) - path.velocity)
    inside = np.linalg.norm(z1, axis=1) < 45
    assert inside.sum() > 20
    expected = constraint.value(z1[inside]) + 0.5 * (z2[inside] ** 2).sum(axis=1)
    np.testing.assert_allclose(path.lyapunov[inside], expected)
    assert np.isnan(path.lyapunov[~inside]).all()
    np.testing.assert_allclose(path.distance, np.linalg.norm(z1, axis=1) / 150)
