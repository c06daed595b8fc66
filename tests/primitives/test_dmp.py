"""Movement primitives: exact solutions, features, fitting, batch and online rollouts."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.interpolate import make_interp_spline

from dexrepro.primitives import (
    DMP,
    Demonstration,
    GaussianKernels,
    Scaling,
    SpringDamper,
    TruncatedKernels,
    forcing_target,
    least_squares,
    phase,
)

SYSTEM = SpringDamper.critical(400.0)


def wave(samples=501, duration=2.0):
    """A smooth path at rest at both ends that turns round on its way."""
    time = np.linspace(0, duration, samples)
    u = time / duration
    blend = u**3 * (10 - 15 * u + 6 * u**2)
    path = np.stack([4 * blend + np.sin(2 * np.pi * blend), blend + 2 * np.sin(np.pi * blend) ** 2], axis=1)
    return Demonstration.of(time, path)


def primitive(**options):
    demonstration = wave()
    options = {"scaling": Scaling.guarded(demonstration), "rest": 0.5, **options}
    return DMP.fit(demonstration, GaussianKernels.spaced(15, 4.0), SYSTEM, 4.0, **options)


@pytest.mark.parametrize("damping", [10.0, 40.0, 90.0])  # under-, critically and overdamped
def test_solution_agrees_with_an_ode_solver(damping):
    system = SpringDamper(400.0, damping)
    time = np.linspace(0, 1, 41)
    force = 300 * np.sin(9 * time)
    position, velocity = system.solve(force[:, None], time[1], start=[1.0], goal=[-2.0], velocity=[3.0])
    reference = solve_ivp(
        lambda t, y: [y[1], 400 * (-2 - y[0]) - damping * y[1] + np.interp(t, time, force)],
        (0, 1), [1.0, 3.0], t_eval=time, rtol=1e-10, atol=1e-12, max_step=time[1] / 4,
    )  # fmt: skip
    np.testing.assert_allclose(position[:, 0], reference.y[0], atol=1e-8)
    np.testing.assert_allclose(velocity[:, 0], reference.y[1], atol=1e-6)


@given(st.floats(0.2, 3.0), st.floats(-2.0, 2.0))
@settings(deadline=None, max_examples=20)
def test_solution_does_not_depend_on_the_step_when_the_forcing_is_linear(slope, offset):
    coarse, fine = (
        SYSTEM.solve((offset + slope * np.linspace(0, 1, n))[:, None], 1 / (n - 1), start=[1.0])[0][-1]
        for n in (6, 20001)
    )
    np.testing.assert_allclose(coarse, fine, atol=1e-11)


def test_exact_forcing_reproduces_the_demonstration():
    demonstration = wave(samples=2001)
    forcing = forcing_target(demonstration, SYSTEM, demonstration.duration, demonstration.goal)
    position, _ = SYSTEM.solve(forcing, 1 / 2000, demonstration.start, demonstration.goal)
    assert np.mean(np.sum((position - demonstration.position) ** 2, axis=1)) < 1e-9


def test_printed_sign_of_the_damping_term_misses_the_demonstration():
    demonstration = wave()
    forcing = forcing_target(demonstration, SpringDamper(400.0, 40.0), 2.0, demonstration.goal)
    printed = forcing - 2 * 40.0 * 2.0 * demonstration.velocity
    position, _ = SYSTEM.solve(printed, 1 / 500, demonstration.start, demonstration.goal)
    assert np.mean(np.sum((position - demonstration.position) ** 2, axis=1)) > 1.0


@pytest.mark.parametrize(
    "kernels", [GaussianKernels.spaced(7, 4.0), GaussianKernels.with_widths([0.0, 0.02, 1.0], 4.0, 0.005)]
)
def test_features_sum_to_the_phase_even_where_every_kernel_underflows(kernels):
    s = phase(np.linspace(0, 3, 200), 2.0, 4.0)
    np.testing.assert_allclose(kernels.features(s).sum(axis=1), s, rtol=1e-14)


def test_truncated_kernels_are_silent_after_their_reach_and_zero_when_all_are():
    kernels = TruncatedKernels(GaussianKernels.with_widths([0.1, 0.3], 4.0, 0.02))
    late = kernels.features(phase(np.array([0.9]), 1.0, 4.0))
    early = kernels.features(phase(np.array([0.1]), 1.0, 4.0))
    assert np.all(late == 0)
    assert early.sum() == pytest.approx(1 + np.exp(-0.4))


def test_fit_reproduces_and_reaches_the_goal():
    dmp = primitive()
    rollout = dmp.rollout(step=0.004)
    assert np.sqrt(np.mean((rollout.position - wave().position) ** 2)) < 0.01
    assert np.linalg.norm(dmp.rollout(step=0.004, horizon=4.0).position[-1] - dmp.goal) < 0.01


def test_locally_weighted_regression_is_the_coarser_estimator():
    errors = [
        np.mean((primitive(estimator=name).rollout(step=0.004).position - wave().position) ** 2)
        for name in ("least_squares", "lwr")
    ]
    assert errors[0] < 0.1 * errors[1]


def test_time_constant_stretches_time_and_keeps_the_path():
    dmp = primitive()
    slow = dmp.rollout(step=0.008, horizon=4.0, time_constant=4.0)
    np.testing.assert_allclose(slow.position, dmp.rollout(step=0.004).position, atol=1e-11)


def test_demonstrated_movement_does_not_depend_on_the_scaling():
    choices = Scaling.none(2), Scaling.goal(2), Scaling.guarded(wave()), Scaling.extent(wave())
    paths = [primitive(scaling=scaling).rollout(step=0.004).position for scaling in choices]
    for path in paths[1:]:
        np.testing.assert_allclose(path, paths[0], atol=1e-8)


def test_goal_scaling_is_refused_where_start_and_goal_agree():
    demonstration = wave()
    flat = Demonstration.of(demonstration.time, demonstration.position * [1.0, 0.0])
    with pytest.raises(ValueError, match=r"Scaling\.guarded"):
        DMP.fit(flat, GaussianKernels.spaced(5, 4.0), SYSTEM, 4.0, Scaling.goal(2))


def test_goal_shift_follows_the_closed_form_of_the_critically_damped_system():
    dmp = primitive(scaling=Scaling.none(2))
    moved = dmp.rollout(step=0.004, goal=dmp.goal + [1.0, -2.0]).position - dmp.rollout(step=0.004).position
    normalised = np.linspace(0, 1, 501)
    expected = 1 - (1 + 20 * normalised) * np.exp(-20 * normalised)
    np.testing.assert_allclose(moved, expected[:, None] * [1.0, -2.0], atol=1e-10)


def test_a_batch_of_goals_equals_single_rollouts_and_the_propagator():
    dmp = primitive()
    goals = dmp.goal + np.random.default_rng(0).normal(size=(4, 3, 2))
    batch = dmp.rollout(step=0.004, goal=goals)
    kept = dmp.propagator(step=0.004)
    weights = dmp.weights * dmp.scaling.amplitude(dmp.start, goals)[..., None, :]
    np.testing.assert_allclose(batch.position[2, 1], dmp.rollout(step=0.004, goal=goals[2, 1]).position, atol=1e-12)
    np.testing.assert_allclose(kept.position(weights, dmp.start, goals), batch.position, atol=1e-9)
    np.testing.assert_allclose(kept.velocity(weights, dmp.start, goals), batch.velocity, atol=1e-8)


def test_weights_of_many_kernel_draws_are_rolled_out_together():
    rng = np.random.default_rng(1)
    draws = GaussianKernels.with_widths(rng.uniform(size=(6, 10)), 4.0, rng.uniform(0.04, 0.12, size=(6, 10)))
    demonstration = wave()
    s = phase(demonstration.time, 2.0, 4.0)
    target = forcing_target(demonstration, SYSTEM, 2.0, demonstration.goal)
    weights = least_squares(draws.features(s), target)
    positions, _ = SYSTEM.solve(draws.features(s) @ weights, 1 / 500, demonstration.start, demonstration.goal)
    alone = GaussianKernels(draws.centres[3], draws.sharpness[3])
    single = DMP.fit(demonstration, alone, SYSTEM, 4.0).rollout(step=0.004)
    np.testing.assert_allclose(positions[3], single.position, atol=1e-9)


@pytest.mark.parametrize("damping", [20.0, 40.0])
def test_online_stepping_agrees_with_the_batch_with_and_without_coupling(damping):
    demonstration = wave()
    dmp = DMP.fit(demonstration, GaussianKernels.spaced(15, 4.0), SpringDamper(400.0, damping), 4.0)
    goal = dmp.goal + [0.5, -0.3]
    batch = dmp.rollout(step=0.004, goal=goal, extra_forcing=np.array([50.0, -20.0]))
    online = dmp.online(step=0.004, goal=goal)
    stepped = [online.step(coupling=[50.0, -20.0]) for _ in range(500)]
    np.testing.assert_allclose([p for p, _ in stepped], batch.position[1:], atol=1e-9)
    np.testing.assert_allclose([v for _, v in stepped], batch.velocity[1:], atol=1e-9)
    np.testing.assert_allclose(online.acceleration * 4.0 + [50.0, -20.0], batch.acceleration[-1] * 4.0, atol=1e-8)


def test_a_movement_that_starts_moving_keeps_its_initial_velocity():
    time = np.linspace(0, 2, 501)
    moving = Demonstration.of(time, np.stack([np.sin(2 * time), np.cos(3 * time)], axis=1), at_rest=False)
    dmp = DMP.fit(moving, GaussianKernels.spaced(25, 0.7), SpringDamper(156.25, 25.0), 0.7, ridge=1e-8)
    rollout = dmp.rollout(step=0.004)
    np.testing.assert_allclose(rollout.velocity[0], [2.0, 0.0], atol=1e-6)
    assert np.max(np.abs(rollout.position - moving.position)) < 0.01
    np.testing.assert_allclose(rollout.acceleration[1:-1], np.diff(rollout.velocity, axis=0)[1:] / 0.004, atol=0.1)


def test_a_perturbed_online_movement_still_converges():
    online = primitive().online(step=0.004)
    for k in range(1500):
        if k == 200:
            online.position = online.position + [1.0, 1.0]
        online.step()
    assert np.linalg.norm(online.position - online.goal) < 0.05


@pytest.mark.parametrize("at_rest", [True, False])
def test_derivatives_are_those_of_the_quintic_spline(at_rest):
    time = np.linspace(1.0, 3.0, 81)
    path = np.random.default_rng(2).normal(size=(81, 2))
    demonstration = Demonstration.of(time, path, at_rest)
    rest = [(1, np.zeros(2)), (2, np.zeros(2))]
    spline = make_interp_spline(time, path, k=5, bc_type=(rest, rest) if at_rest else None)
    np.testing.assert_allclose(demonstration.velocity, spline(time, 1), atol=1e-9)
    np.testing.assert_allclose(demonstration.acceleration, spline(time, 2), atol=1e-7)


def test_unequal_steps_are_refused():
    with pytest.raises(ValueError, match="equally spaced"):
        Demonstration.of(np.linspace(0, 1, 20) ** 2, np.zeros((20, 2)))


def test_each_scaling_is_the_amplitude_it_says():
    """The goal is a tenth of the largest range away on the first axis and two fifths on the second."""
    time = np.linspace(0, 1, 50)
    rise = time**3 * (10 - 15 * time + 6 * time**2)
    bow = np.sin(np.pi * rise) * 9.5
    shown = Demonstration.of(time, np.stack([rise + bow, 3.0 - 4.0 * rise], axis=1))
    largest = shown.extent.max()
    assert largest > 2 * shown.extent.min()
    start, goal = np.array([0.5, 1.0]), np.array([[1.0, -1.0], [3.0, 2.0]])
    for scaling, expected in (
        (Scaling.none(2), [[1, 1], [1, 1]]),
        (Scaling.goal(2), [[0.5, -2], [2.5, 1]]),
        (Scaling.guarded(shown), [[largest, -2], [largest, 1]]),
        (Scaling.guarded(shown, 0.05), [[0.5, -2], [2.5, 1]]),
        (Scaling.guarded(shown, 0.5), [[largest, largest]] * 2),
        (Scaling.extent(shown), [[largest, largest]] * 2),
    ):
        assert scaling.amplitude(start, goal) == pytest.approx(np.array(expected))


def test_the_acceleration_on_the_way_is_that_of_the_path():
    dmp = replace(primitive(), time_constant=3.0)
    online, times, velocities, accelerations = dmp.online(1e-3), [], [], []
    for _ in range(400):
        times.append(online.time)
        velocities.append(online.velocity)
        accelerations.append(online.acceleration)
        online.step()
    slope = np.gradient(np.array(velocities), 1e-3, axis=0)
    assert times[-1] == pytest.approx(0.399)
    np.testing.assert_allclose(slope[1:-1], np.array(accelerations)[1:-1], atol=2e-3 * np.abs(slope).max())
