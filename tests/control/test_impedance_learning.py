import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from instant import at

from dexrepro.control.impedance_learning import (
    DONE,
    EXPLORING,
    SOLVING,
    TRANSFERRING,
    WAITING,
    ConstantGain,
    IntegratingReference,
    InteractionLaw,
    LearnedGain,
    StaticReference,
    exploration_windows,
    soft_transfer,
)
from dexrepro.control.interaction_optimum import InteractionCost, InteractionModel, optimal_gain, steady_fraction
from dexrepro.control.motion import Motion

COST = InteractionCost(tracking=70.0, effort=5.0, output=0.05)
INITIAL, DT = [-30.01, 1.47], 1e-3


def learned_gain(**changes):
    options = dict(
        initial=INITIAL, cost=COST, tolerance=1e-3, exosystem=-1.0, start=1.5, amplitude=0.05, wait=0.5,
        explore=4.0, solve=0.5, transfer=2.0, window=0.25, dt=DT,
    )  # fmt: skip
    return LearnedGain(**{**options, **changes})


def press(gain, duration, stiffness=10.0, damping=0.01, depth=0.08, reference=None, side=1, **options):
    """Indent an object at 0 along a path x_d towards side * depth, with a perfect inner loop; histories of x, f, K."""
    reference = reference or IntegratingReference(mobility=0.5, bandwidth=50.0, dt=DT)
    law = InteractionLaw(gain, reference, COST.output, side, contact_force=1e-6, recovery=5.0, **options)
    position, velocity, history = -side * 0.01, 0.0, []
    for step in range(round(duration / DT)):
        path = depth * (1.0 - 1.2 * np.exp(-2.0 * step * DT))
        rate = depth * 2.4 * np.exp(-2.0 * step * DT)
        force = -(stiffness * position + damping * velocity) if side * position > 0 else 0.0
        state = law(at(position, force), Motion(side * path, side * rate, -2.0 * side * rate))
        history.append((position, force, *gain.gain, law.desired_force))
        position, velocity = state.position, state.velocity
    return law, np.array(history)


@given(st.floats(0.0, 1.0))
def test_the_soft_transfer_is_monotone_between_its_ends(progress):
    start, end = np.array([-30.0, 1.5]), np.array([-0.7, 0.07])
    here, later = soft_transfer(start, end, progress), soft_transfer(start, end, progress + 1e-3)
    assert here[0] <= later[0] <= end[0] + 1e-12
    assert here[1] >= later[1] >= end[1] - 1e-12
    assert soft_transfer(start, end, 0.0) == pytest.approx(start)
    assert soft_transfer(start, end, 0.5) == pytest.approx((start + end) / 2)
    assert soft_transfer(start, end, 1.0) == pytest.approx(end)


def test_the_gain_learned_in_contact_is_the_optimal_one():
    gain = learned_gain()
    press(gain, duration=9.0)
    assert gain.phase == DONE
    optimal = optimal_gain(InteractionModel(10.0, 0.01, -1.0), COST)
    assert gain.gain == pytest.approx(optimal, rel=5e-3)  # the velocity of the press lags half a step


def test_the_transfer_is_continuous_when_soft_and_one_step_when_abrupt():
    _, soft = press(learned_gain(), duration=9.0)
    _, abrupt = press(learned_gain(transfer=0.0), duration=9.0)
    assert np.abs(np.diff(soft[:, 2])).max() < 0.05
    assert np.abs(np.diff(abrupt[:, 2])).max() == pytest.approx(30.01 - 0.677, abs=0.01)


@pytest.mark.parametrize("reference", [None, StaticReference(rate=20.0, dt=DT)])
def test_the_force_settles_where_the_law_and_the_object_meet(reference):
    law, history = press(ConstantGain([-5.0, 0.3]), duration=8.0, reference=reference)
    assert history[-1, 1] == pytest.approx(law.desired_force, abs=2e-3)
    fraction = steady_fraction(np.array([-5.0, 0.3]), 10.0, COST.output)
    assert history[-1, 0] / 0.08 == pytest.approx(fraction, rel=5e-3)


def test_an_object_below_its_surface_is_pressed_the_same_way():
    _, above = press(ConstantGain([-5.0, 0.3]), duration=4.0)
    _, below = press(ConstantGain([-5.0, 0.3]), duration=4.0, side=-1)
    assert below[:, :2] == pytest.approx(-above[:, :2], abs=1e-12)


def test_the_surface_is_found_by_touch():
    law, _ = press(ConstantGain([-5.0, 0.3]), duration=1.0)
    assert law.surface == pytest.approx(0.0, abs=1e-3)


def test_the_reference_returns_to_the_path_after_contact():
    law = InteractionLaw(ConstantGain([-5.0, 0.3]), IntegratingReference(0.5, 50.0, DT), 0.05, 1, 1e-6, 5.0)
    state = law(at(0.005, -0.05), Motion(0.01, 0.0, 0.0))
    for _ in range(3000):
        state = law(at(-0.01), Motion(-0.05, 0.0, 0.0))
    assert state.position == pytest.approx(-0.05, abs=1e-4)
    assert law.gain.exploration == 0.0


def test_the_printed_sign_pushes_into_the_object_without_end():
    law, history = press(ConstantGain(INITIAL), duration=1.0, printed=True)
    assert abs(history[-1, 0]) > 1.0
    assert law.desired_force * history[-1, 0] < 0


def test_at_the_balance_the_wanted_force_is_the_one_felt_exploration_included():
    """tau_e = -K [x - x_ob, s] + noise, solved for x: what the static reference goes to is where the force is right."""

    class Target(StaticReference):
        def acceleration(self, state, force, desired, target):
            self.target = target
            return super().acceleration(state, force, desired, target)

    class Exploring(ConstantGain):
        def reset(self):
            super().reset()
            self.exploration = 0.07

    gain, reference, surface, force = Exploring([-5.0, 0.3]), Target(rate=20.0, dt=DT), 0.02, -0.4
    law = InteractionLaw(gain, reference, COST.output, 1, contact_force=1e-6, recovery=5.0, origin=surface)
    law(at(0.05, force), Motion(0.06, 0.0, 0.0))
    share = (0.06 - surface) / COST.output
    assert law.desired_force == pytest.approx(5.0 * (0.05 - surface) - 0.3 * share + 0.07)
    assert 5.0 * (reference.target - surface) - 0.3 * share + 0.07 == pytest.approx(force)


def test_a_gain_given_in_advance_waits_as_long_as_it_is_told():
    gain = ConstantGain([-5.0, 0.3], initial=[-9.0, 0.1], wait=0.01, dt=DT)
    seen = []
    for _ in range(12):
        gain.update(0.0, 0.0, 0.0)
        seen.append(gain.gain)
    assert seen == [[-9.0, 0.1]] * 10 + [[-5.0, 0.3]] * 2
    gain.reset()
    assert gain.gain == [-9.0, 0.1]
    assert ConstantGain([-5.0, 0.3]).gain == [-5.0, 0.3]


def test_the_phases_of_the_algorithm_last_as_long_as_they_are_told():
    """Algorithm 8.1 on a known object: K_0 until whole windows are solved, then half a sine of T_s to the optimum."""
    gain, phases = learned_gain(wait=0.3, explore=1.1, solve=0.2, transfer=0.4, window=0.25), []
    for k in range(2400):
        x, rate = 0.01 * np.sin(7.0 * k * DT), 0.07 * np.cos(7.0 * k * DT)
        gain.update(x, 0.0, -(10.0 * x + 0.01 * rate))
        phases.append(gain.phase)
        if gain.phase == EXPLORING:
            t = (k - 300) * DT
            assert gain.exploration == pytest.approx(sum(0.05 / n * np.sin(n * t) for n in range(1, 9)), abs=1e-12)
        else:
            assert gain.exploration == 0.0
        if gain.phase < TRANSFERRING:
            assert gain.gain == INITIAL
        if phases.count(TRANSFERRING) == 201 and gain.phase == TRANSFERRING:
            assert gain.gain == pytest.approx((np.array(INITIAL) + gain.learned.gain[0]) / 2)
    begins = [phases.index(phase) for phase in (WAITING, EXPLORING, SOLVING, TRANSFERRING, DONE)]
    assert begins == [0, 300, 1551, 1751, 2151], "five windows of 0.25 s and the sample that ends them"
    assert gain.gain == pytest.approx(gain.learned.gain[0])
    assert gain.samples.shape == (1251, 3)
    gain.reset()
    assert (gain.phase, gain.gain, gain.learned, len(gain.samples), gain.exploration) == (
        WAITING,
        INITIAL,
        None,
        0,
        0.0,
    )


def test_the_auxiliary_signal_obeys_its_exosystem():
    """s' = M s from its start; without M the recorded s is kept."""
    samples = np.random.default_rng(0).normal(size=(11, 3))
    kept = exploration_windows(samples, 0.1, 5, None)
    made = exploration_windows(samples, 0.1, 5, -2.0, start=3.0)
    replaced = samples.copy()
    replaced[:, 1] = 3.0 * np.exp(-2.0 * 0.1 * np.arange(11))
    again = exploration_windows(replaced, 0.1, 5, None)
    for name in vars(made):
        assert np.array_equal(getattr(made, name), getattr(again, name))
    assert any(not np.array_equal(getattr(made, name), getattr(kept, name)) for name in vars(made))


def test_a_surface_found_wrongly_moves_where_the_indentation_counts_from():
    law = InteractionLaw(ConstantGain([-5.0, 0.3]), StaticReference(20.0, DT), COST.output, 1, 1e-6, 5.0,
                         surface_error=0.004)  # fmt: skip
    law(at(0.01, -0.1), Motion(0.05, 0.0, 0.0))
    assert law.surface == pytest.approx(0.014)
    assert law.desired_force == pytest.approx(5.0 * (0.01 - 0.014) - 0.3 * (0.05 - 0.014) / COST.output)
    law.reset()
    assert law.surface is None
    state = law(at(0.01, 1e-7), Motion(0.05, 0.2, 0.0))
    assert (state.position, state.velocity, law.desired_force) == (0.05, 0.2, 0.0), "no contact yet"


def test_the_references_are_the_systems_they_are_called_after():
    """b (kappa (tau_e - f_d) - v) and r^2 (x_b - x) - 2 r v."""
    state = Motion(0.2, 0.3, 0.0)
    assert IntegratingReference(0.5, 40.0, DT).acceleration(state, 2.0, 0.7, 9.0) == pytest.approx(40 * (0.65 - 0.3))
    assert StaticReference(20.0, DT).acceleration(state, 2.0, 0.7, 0.9) == pytest.approx(400 * 0.7 - 40 * 0.3)


def test_the_printed_sign_is_that_of_the_whole_law():
    """tau_e = +K [x, s] in the place of -K [x, s]: at one state the two wanted forces are opposite."""
    wanted = []
    for printed in (False, True):
        reference = StaticReference(20.0, DT)
        law = InteractionLaw(ConstantGain([-5.0, 0.3]), reference, COST.output, 1, 1e-6, 5.0, printed=printed)
        law(at(0.0, -0.1), Motion(0.05, 0.0, 0.0))
        law(at(0.01, -0.1), Motion(0.05, 0.0, 0.0))
        wanted.append(law.desired_force)
    assert wanted == pytest.approx([5.0 * 0.01 - 0.3 * 1.0, -5.0 * 0.01 + 0.3 * 1.0])
