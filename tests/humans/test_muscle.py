import numpy as np
import pytest

from dexrepro.humans.muscle import Muscle, low_pass

PHASE = np.linspace(0, 1, 1001)


def test_ordinary_stiffness_starts_and_ends_at_rest():
    level = Muscle().stiffness(PHASE)
    assert level[[0, -1]] == pytest.approx(0.030)
    assert level.max() == pytest.approx(0.036)


@pytest.mark.parametrize(("height", "final"), [(2.0, 0.060), (4.0, 0.0767), (8.0, 0.110)])
def test_taller_obstacles_end_stiffer(height, final):
    assert Muscle().stiffness(PHASE, height, 0.55)[-1] == pytest.approx(final, abs=3e-4)


def test_closer_obstacles_stiffen_earlier_by_the_time_they_are_closer():
    early, late = (Muscle().stiffness(PHASE, 8.0, moment) for moment in (0.38, 0.55))
    half = [PHASE[np.argmax(trace > 0.070)] for trace in (early, late)]
    assert half[1] - half[0] == pytest.approx(0.17, abs=0.02)


def test_estimate_from_emg_is_unbiased_with_the_ripple_of_its_window():
    muscle, rng = Muscle(), np.random.default_rng(5)
    truth = np.full(2001, 0.05)
    estimates = np.array([muscle.estimate(*muscle.record(truth, rng)) for _ in range(40)])[:, 200:-200]
    assert estimates.mean() == pytest.approx(0.05, rel=0.01)
    ripple = np.sqrt(np.pi / 2 - 1) / np.sqrt(muscle.channels * muscle.window * muscle.rate)
    assert 0.5 * ripple < estimates.std() / 0.05 < 1.2 * ripple


def test_low_pass_keeps_slow_and_removes_fast_without_delay():
    t = np.arange(0, 5, 0.01)
    slow, fast = np.sin(2 * np.pi * 0.3 * t), np.sin(2 * np.pi * 20 * t)
    assert low_pass(slow + fast, 4.0, 100.0)[50:-50] == pytest.approx(slow[50:-50], abs=0.01)


def test_an_obstacle_adds_nothing_at_the_start_and_all_of_its_rise_in_the_end():
    muscle = Muscle(spread=0.2)
    added = muscle.stiffness([0.0, 9.0], 8.0, 0.5) - muscle.stiffness([0.0, 9.0])
    assert added == pytest.approx([0.0, 0.080], abs=1e-9)


def test_the_rise_is_half_done_before_the_passage_by_the_lead():
    muscle = Muscle(lead=0.2, spread=0.01)
    assert muscle.stiffness(0.4, 2.0, 0.6) - muscle.stiffness(0.4) == pytest.approx(0.015)


def test_a_measured_trace_follows_the_true_one():
    muscle = Muscle(channels=2000)
    trace = muscle.measure(4.0, 41, np.random.default_rng(2), 8.0, 0.6)
    assert trace == pytest.approx(muscle.stiffness(np.linspace(0, 1, 41), 8.0, 0.6), rel=0.06)


def test_the_gains_of_the_channels_lie_half_around_one():
    emg, gain = Muscle(channels=4000).record(np.ones(50), np.random.default_rng(3))
    assert gain == pytest.approx(1.0, abs=0.02)
    assert emg.std() == pytest.approx(np.sqrt(1 + 1 / 12), rel=0.02)


def test_low_pass_takes_a_signal_shorter_than_its_padding():
    assert low_pass(np.full(10, 3.0), 0.5, 100.0) == pytest.approx(3.0)
