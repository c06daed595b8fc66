import numpy as np
import pytest

from dexrepro.control.pose_transformation import ConstantScaling, SpeedScaling
from dexrepro.humans.operator import Hand, Operator, Tremor, strides

STEADY = Operator(
    along=0.0, across=0.0, scatter=0.0, tremor=0.0, vision=0.0, tolerance=1e-3, patience=5.0, reaction=0.2
)


def hand(operator=STEADY, scaling=None, seed=0):
    scaling = scaling or ConstantScaling(factor=4.5)
    return Hand(operator, scaling, np.random.default_rng(seed), tool=np.zeros(3))


def test_minimum_jerk_ends_at_rest():
    path = strides(1000)
    assert path[-1] == pytest.approx(1.0)
    assert path[499] == pytest.approx(0.5)
    assert max(path[0], 1 - path[-2]) < 1e-8


def test_tremor_has_the_set_strength_and_band():
    path = Tremor(2.5e-4, np.random.default_rng(1), 0.01, 3)(20_000)
    np.testing.assert_allclose(path.std(axis=0), 2.5e-4, rtol=0.1)
    power = np.abs(np.fft.rfft(path[:, 0])) ** 2
    frequency = np.fft.rfftfreq(len(path), 0.01)
    assert power[(frequency > 6) & (frequency < 14)].sum() > 0.8 * power.sum()


@pytest.mark.parametrize("scaling", [ConstantScaling(factor=4.5), SpeedScaling()])
def test_a_person_without_noise_reaches_in_one_movement(scaling):
    h = hand(scaling=scaling)
    target = np.array([0.0, 0.25, -0.15])
    h.reach(target)
    assert h.submovements == 1
    assert np.linalg.norm(h.tool - target) < 3e-3


def test_scatter_grows_with_the_amplitude():
    person = Operator(
        along=0.1, across=0.05, scatter=0.0, tremor=0.0, vision=0.0, tolerance=1e-3, patience=5.0, reaction=0.2
    )
    spread = {}
    for distance in (0.05, 0.2):
        ends = []
        for seed in range(300):
            h = hand(person, seed=seed)
            h.submove(np.array([distance, 0.0, 0.0]))
            ends.append(h.tool)
        spread[distance] = np.std(ends, axis=0) / distance
    np.testing.assert_allclose(spread[0.05], [0.1, 0.05, 0.05], rtol=0.15)
    np.testing.assert_allclose(spread[0.2], spread[0.05], rtol=0.2)


def test_held_tool_shakes_with_the_scaled_tremor():
    person = Operator.draw(np.random.default_rng(5))
    h = hand(person, ConstantScaling(factor=6.0))
    h.wait(30.0)
    np.testing.assert_allclose(h.record()["tool"].std(axis=0), 6.0 * person.tremor, rtol=0.15)


def test_a_clutch_moves_the_hand_but_not_the_tool():
    h = hand(Operator.draw(np.random.default_rng(2)))
    h.submove(np.array([0.2, 0.1, 0.0]))
    h.turn(0.5)
    tool, tool_roll = h.tool, h.tool_roll
    h.clutch(np.zeros(3), roll=-0.3)
    np.testing.assert_array_equal(h.tool, tool)
    assert h.tool_roll == tool_roll
    assert h.roll == pytest.approx(-0.3)
    assert np.abs(h.centre).max() < 1e-12


def test_the_record_is_whole():
    h = hand(Operator.draw(np.random.default_rng(3)), SpeedScaling())
    h.reach(np.array([0.0, 0.1, 0.1]))
    record = h.record()
    assert all(len(value) == h.samples for value in record.values())
    np.testing.assert_array_equal(record["tool"][-1], h.tool)
    assert 1.0 <= record["scale"].min() <= record["scale"].max() <= 8.0
