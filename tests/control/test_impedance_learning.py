import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from instant import at

from dexrepro.control.impedance_learning import (
    DONE,
    ConstantGain,
    IntegratingReference,
    InteractionLaw,
    LearnedGain,
    StaticReference,
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
