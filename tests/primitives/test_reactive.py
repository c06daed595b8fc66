import numpy as np
import pytest

from dexrepro.primitives import GaussianKernels, SpringDamper, phase
from dexrepro.primitives.incremental import ExtendedKernels
from dexrepro.primitives.reactive import Styles, fit_reaction, path_scaling, ridge_weights

PHASES = phase(np.linspace(0, 5, 301), 5.0, 4.0)
KERNELS = GaussianKernels.spaced(8, 4.0, overlap=0.65)


def enhanced(groups=5, seed=0):
    return ExtendedKernels.draw(KERNELS, 3 * groups, np.random.default_rng(seed))


def change(features):
    return features.blocks(PHASES).change


def smooth_targets(count, seed=0):
    """Curves that decay with the phase, (count, N, 3)."""
    rng = np.random.default_rng(seed)
    waves = np.sin(np.outer(np.arange(1, 5), np.linspace(0, np.pi, len(PHASES))))
    return 30 * np.einsum("kwd,wn->knd", rng.normal(size=(count, 4, 3)), waves) * PHASES[:, None]


def test_frozen_reaction_is_the_changed_forcing_term_minus_the_ordinary_one():
    """Eqs. (7.17), (7.18): Xi theta^N - f = Xi^A theta^N when the old nodes keep their weights."""
    rng = np.random.default_rng(1)
    basis, theta, free = enhanced(), rng.normal(size=(8, 3)), rng.normal(size=(15, 3))
    psi, share, upsilon = basis.blocks(PHASES)
    changed = share * (psi @ theta) + (1 - share) * (upsilon @ free)
    delta = change(basis) @ np.concatenate([theta, free])
    assert changed - psi @ theta == pytest.approx(delta, abs=1e-12)


def test_frozen_fit_keeps_the_ordinary_weights_and_free_fit_is_at_least_as_good():
    target = smooth_targets(1)[0]
    theta = ridge_weights(KERNELS.features(PHASES), 2 * target[::-1], 1e-9)
    basis = enhanced()
    frozen = fit_reaction(basis, PHASES, target, 1e-12, ordinary=theta)
    free = fit_reaction(basis, PHASES, target, 1e-12)
    assert (frozen[:8] == theta).all()
    residual = [np.linalg.norm(change(basis) @ weights - target) for weights in (free, frozen)]
    assert residual[0] <= residual[1] * (1 + 1e-6)


def test_frozen_fit_approaches_the_target_group_by_group():
    target = smooth_targets(1)[0]
    theta = ridge_weights(KERNELS.features(PHASES), target[::-1], 1e-9)
    residuals = []
    for groups in (1, 2, 5):
        basis = enhanced(groups)
        weights = fit_reaction(basis, PHASES, target, 1e-10, ordinary=theta)
        residuals.append(np.linalg.norm(change(basis) @ weights - target))
    assert residuals[0] > residuals[1] > residuals[2]


@pytest.mark.parametrize("shared", [False, True])
def test_all_components_return_the_targets_and_fewer_miss_the_tail_of_the_spectrum(shared):
    targets = smooth_targets(6)
    full = Styles.separate(targets, 6, shared)
    assert full.targets == pytest.approx(targets)
    for rank in (1, 3):
        styles = Styles.separate(targets, rank, shared)
        missed = np.linalg.norm(styles.targets - targets)
        assert missed == pytest.approx(np.linalg.norm(styles.spectrum[:, rank:]), rel=1e-9)


def test_rank_one_represents_multiples_of_one_curve():
    curve = smooth_targets(1)[0]
    targets = np.array([-2.0, 0.5, 3.0])[:, None, None] * curve
    styles = Styles.separate(targets, 1, shared=True)
    assert styles.targets == pytest.approx(targets)
    weights = styles.fit(enhanced(), PHASES, 1e-12)
    assert weights[2] == pytest.approx(-1.5 * weights[0])


def test_styles_fitted_together_equal_styles_fitted_one_by_one():
    targets = smooth_targets(4)
    basis = enhanced()
    together = Styles.separate(targets, 4).fit(basis, PHASES, 1e-8)
    for weights, target in zip(together, targets, strict=True):
        alone = fit_reaction(basis, PHASES, target, 1e-8)
        assert change(basis) @ weights == pytest.approx(change(basis) @ alone, abs=1e-4)


def test_scaling_is_the_identity_at_the_old_task_and_turns_with_the_new_one():
    angle = 0.7
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1.0]])
    assert path_scaling(np.eye(3), np.eye(3), [1, 1, 1]) == pytest.approx(np.eye(3))
    scaling = path_scaling(np.eye(3), (turn @ np.eye(3)).T, [1, 1, 1])
    system, start, goal = SpringDamper.critical(156.25), np.array([1.0, 2.0, 0.0]), np.array([8.0, 3.0, 1.0])
    forcing = smooth_targets(1)[0]
    path, _ = system.solve(forcing, 1 / 300, start, goal)
    turned, _ = system.solve(forcing @ scaling.T, 1 / 300, turn @ start, turn @ goal)
    assert turned == pytest.approx(path @ turn.T)


def test_the_ridge_is_relative_to_the_mean_power_of_the_features():
    """Features in another unit give weights in that unit; the ridge is what it says: ridge sum of squares / p."""
    features, target = KERNELS.features(PHASES), smooth_targets(1)[0]
    weights = ridge_weights(features, target, 0.01)
    assert ridge_weights(1000.0 * features, target, 0.01) == pytest.approx(weights / 1000.0)
    added = 0.01 * np.mean(features**2) * len(features)
    assert (features.T @ features + added * np.eye(8)) @ weights == pytest.approx(features.T @ target)
