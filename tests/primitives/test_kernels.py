"""Phases, kernels, features and the estimators of their weights, each against its own formula."""

import numpy as np
import pytest

from dexrepro.primitives.demonstration import Demonstration
from dexrepro.primitives.kernels import GaussianKernels, TruncatedKernels, phase
from dexrepro.primitives.regression import least_squares, locally_weighted, locally_weighted_affine

PHASES = np.linspace(1.0, 0.05, 40)
KERNELS = GaussianKernels(np.array([0.9, 0.6, 0.35]), np.array([30.0, 50.0, 80.0]))
PHI = np.exp(-KERNELS.sharpness * (PHASES[:, None] - KERNELS.centres) ** 2)


def test_the_phase_solves_its_canonical_system():
    """tau s' = -o s, s(0) = 1: Eq. (5.2)."""
    time, step = np.linspace(0, 3, 7), 1e-5
    s = phase(time, 1.5, 4.0)
    assert s[0] == 1.0
    slope = (phase(time + step, 1.5, 4.0) - phase(time - step, 1.5, 4.0)) / (2 * step)
    assert 1.5 * slope == pytest.approx(-4.0 * s, rel=1e-6)


def test_spaced_kernels_stand_equally_in_time_and_overlap_as_told():
    kernels = GaussianKernels.spaced(5, 3.0, overlap=0.7)
    assert np.log(kernels.centres) == pytest.approx([0, -0.75, -1.5, -2.25, -3.0])
    at_next = np.diag(kernels.activations(kernels.centres), -1)
    assert at_next == pytest.approx(np.exp(-0.7)), "phi_i at c_{i+1}"
    assert kernels.sharpness[-1] == kernels.sharpness[-2]
    own = GaussianKernels.spaced(3, 9.0, phases=[0.9, 0.5, 0.4])
    assert own.centres.tolist() == [0.9, 0.5, 0.4]
    assert own.sharpness == pytest.approx([0.5 / 0.16, 50.0, 50.0])


def test_a_kernel_of_a_width_in_time_is_as_wide_wherever_it_sits():
    times, decay, width = np.array([0.0, 0.4, 1.0]), 2.0, 1e-4
    kernels = GaussianKernels.with_widths(times, decay, width)
    assert np.log(kernels.centres) == pytest.approx(-decay * times)
    for shift in (-width, width):
        reached = np.exp(-decay * (times + shift))
        assert np.diag(kernels.activations(reached)) == pytest.approx(np.exp(-0.5), rel=1e-3)
    assert kernels.deviations == pytest.approx(kernels.centres * decay * width)


def test_activations_and_features_are_their_formulas():
    assert KERNELS.activations(PHASES) == pytest.approx(PHI)
    assert KERNELS.features(PHASES) == pytest.approx(PHASES[:, None] * PHI / PHI.sum(axis=1, keepdims=True))


@pytest.mark.parametrize("two_sided", [False, True])
def test_truncated_features_are_those_of_the_kernels_that_are_alive(two_sided):
    truncated = TruncatedKernels(KERNELS, reach=1.5, two_sided=two_sided)
    offset, reach = PHASES[:, None] - KERNELS.centres, 1.5 / np.sqrt(2 * KERNELS.sharpness)
    alive = (offset >= -reach) & (np.abs(offset) <= reach if two_sided else True)
    psi = np.where(alive, PHI, 0.0)
    total = psi.sum(axis=1, keepdims=True)
    share = np.divide(psi, total, out=np.zeros_like(psi), where=total > 0)
    assert (total == 0).any(), "there are phases at which none is alive"
    assert (alive.sum(axis=1) > 1).any()
    assert truncated.features(PHASES) == pytest.approx(np.hstack([share * PHASES[:, None], share]))
    assert truncated.count == 6


def test_each_estimator_minimises_its_own_squares():
    rng = np.random.default_rng(0)
    target = rng.normal(size=(40, 2))
    for k, weights in enumerate(locally_weighted(KERNELS, PHASES, target)):
        root = np.sqrt(PHI[:, k : k + 1])
        assert weights == pytest.approx(np.linalg.lstsq(root * PHASES[:, None], root * target)[0][0])
    truncated = TruncatedKernels(KERNELS, reach=2.0)
    affine = locally_weighted_affine(truncated, PHASES, target)
    for k in range(3):
        root = np.sqrt(truncated.features(PHASES)[:, 3 + k : 4 + k])
        slope, offset = np.linalg.lstsq(root * np.stack([PHASES, np.ones(40)], axis=1), root * target)[0]
        assert affine[[k, 3 + k]] == pytest.approx(np.array([slope, offset]))


def test_least_squares_of_a_batch_and_with_a_ridge():
    rng = np.random.default_rng(1)
    features, target = rng.normal(size=(4, 20, 3)), rng.normal(size=(20, 2))
    single = [np.linalg.lstsq(x, target)[0] for x in features]
    assert least_squares(features, target) == pytest.approx(np.array(single))
    assert least_squares(features[0], np.stack([target, 2 * target])) == pytest.approx(
        np.array([single[0], 2 * single[0]])
    )
    ridged = least_squares(features, target, ridge=0.3)
    for x, weights in zip(features, ridged):
        stacked = np.vstack([x, np.sqrt(0.3) * np.eye(3)])
        assert weights == pytest.approx(np.linalg.lstsq(stacked, np.vstack([target, np.zeros((3, 2))]))[0])
    double = np.hstack([features[0], features[0]])
    assert least_squares(double, target) == pytest.approx(np.vstack([single[0], single[0]]) / 2), "of smallest norm"


def test_a_demonstration_knows_its_ends_and_can_be_held_at_its_goal():
    time = 2.0 + np.linspace(0, 4, 41)
    path = np.stack([np.sin(time), np.cos(2 * time)], axis=1)
    shown = Demonstration.of(time, path, at_rest=False)
    assert shown.duration == pytest.approx(4.0)
    assert np.array_equal(shown.start, path[0])
    assert np.array_equal(shown.goal, path[-1])
    assert shown.extent == pytest.approx(path.max(axis=0) - path.min(axis=0))
    assert shown.velocity == pytest.approx(np.stack([np.cos(time), -2 * np.sin(2 * time)], axis=1), abs=1e-3)
    assert shown.acceleration == pytest.approx(np.stack([-np.sin(time), -4 * np.cos(2 * time)], axis=1), abs=0.05)
    held = shown.with_rest(0.5)
    assert held.time == pytest.approx(2.0 + np.linspace(0, 6, 61))
    assert np.array_equal(held.position[41:], np.tile(path[-1], (20, 1)))
    assert not held.velocity[41:].any()
    assert not held.acceleration[41:].any()
    for part in ("position", "velocity", "acceleration"):
        assert np.array_equal(getattr(held, part)[:41], getattr(shown, part))
    for wrong in (path[:, 0], path[1:]):
        with pytest.raises(ValueError, match="do not go with 41 instants"):
            Demonstration.of(time, wrong)


def test_truncated_features_share_out_the_phase_even_where_every_kernel_underflows():
    far = TruncatedKernels(GaussianKernels(np.array([0.5, 0.4]), np.array([5e4, 5e4])), reach=1e3)
    features = far.features(np.array([0.9, 0.45, 0.05]))
    assert features[:, 2:].sum(axis=1) == pytest.approx(1.0)
    assert features == pytest.approx(np.array([[0.9, 0, 1, 0], [0.225, 0.225, 0.5, 0.5], [0, 0.05, 0, 1]]))
