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
