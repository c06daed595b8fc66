"""Incremental primitives: features, the growing pseudo-inverse, styles and what is kept of the old skill."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dexrepro.primitives import (
    DMP,
    Demonstration,
    ExtendedKernels,
    GaussianKernels,
    GrowingRegression,
    Scaling,
    SpringDamper,
    extend,
    extend_styles,
    extended_pseudo_inverse,
    interpolate,
    least_squares,
    original,
    phase,
)
from dexrepro.primitives.incremental import lemma_weights

TIME = np.linspace(0, 3, 601)
KERNELS = GaussianKernels.with_widths(np.linspace(0, 1, 12), 4.0, 0.05)
PHASES = phase(TIME, 3.0, 4.0)


def bump(height, sway):
    u = TIME / 3
    blend = u**3 * (10 - 15 * u + 6 * u**2)
    path = np.stack([4 * blend + sway * np.sin(4 * np.pi * blend), height * np.sin(np.pi * blend) ** 2 + blend], axis=1)
    return Demonstration.of(TIME, path)


def base_skill():
    scaling = Scaling(np.zeros(2, dtype=bool), np.array([4.0, 4.0]))
    return DMP.fit(bump(1.0, 0.0), KERNELS, SpringDamper.critical(400.0), 4.0, scaling, rest=0.5)


def drawn(count=20, seed=0, base=None):
    return ExtendedKernels.draw(KERNELS, count, np.random.default_rng(seed), base=base)


def distance(primitive, demonstration):
    return np.sqrt(np.mean((primitive.rollout(0.005).position - demonstration.position) ** 2))


@given(st.integers(1, 40), st.integers(0, 5))
@settings(deadline=None, max_examples=20)
def test_extended_features_sum_to_the_phase(count, seed):
    features = drawn(count, seed)
    np.testing.assert_allclose(features.features(PHASES).sum(axis=1), PHASES, rtol=1e-12)
    share = features.blocks(PHASES).share
    assert np.all(share > 0)
    assert np.all(share < 1)


def test_no_added_feature_is_the_plain_primitive():
    dmp = base_skill()
    same = extend(dmp, drawn().first(0), bump(2.0, 0.5), relearn_old=False)
    np.testing.assert_allclose(same.rollout(0.005).position, dmp.rollout(0.005).position, atol=1e-12)


def test_more_features_begin_with_the_same_ones():
    np.testing.assert_array_equal(drawn(30).first(12).input_weights, drawn(12).input_weights)


@given(st.integers(0, 4), st.integers(0, 6), st.integers(1, 6), st.integers(0, 1000))
@settings(deadline=None, max_examples=40)
def test_block_update_is_the_pseudo_inverse_whatever_the_rank(dependent, deficient, added, seed):
    rng = np.random.default_rng(seed)
    matrix = rng.standard_normal((40, 8))
    matrix[:, 8 - deficient :] = matrix[:, : 8 - deficient] @ rng.standard_normal((8 - deficient, deficient))
    columns = rng.standard_normal((40, added))
    inside = min(dependent, added)
    columns[:, :inside] = matrix @ rng.standard_normal((8, inside))
    expected = np.linalg.pinv(np.concatenate([matrix, columns], axis=1), rcond=1e-10)
    found = extended_pseudo_inverse(matrix, np.linalg.pinv(matrix, rcond=1e-10), columns)
    assert np.linalg.norm(found - expected) < 1e-8 * np.linalg.norm(expected)


def test_growing_regression_equals_solving_anew():
    rng = np.random.default_rng(3)
    regression, target = GrowingRegression(rng.standard_normal((200, 10))), rng.standard_normal((200, 3))
    for _ in range(8):
        block = rng.standard_normal((200, 5))
        block[:, 4] = regression.matrix[:, 0]  # one column is already there
        regression.append(block)
    np.testing.assert_allclose(regression.weights(target), least_squares(regression.matrix, target), atol=1e-10)


def test_new_skill_is_learned_and_the_old_one_recovered():
    dmp, wanted = base_skill(), bump(2.0, 0.5)
    learned = extend(dmp, drawn(), wanted, rest=0.5)
    assert distance(learned, wanted) < 0.1 * distance(dmp, wanted)
    np.testing.assert_allclose(original(learned).rollout(0.005).position, dmp.rollout(0.005).position, atol=1e-12)


def test_added_features_alone_change_the_skill_gradually():
    dmp, wanted, features = base_skill(), bump(2.0, 0.5), drawn(20)
    errors = [distance(extend(dmp, features.first(m), wanted, relearn_old=False, rest=0.5), wanted) for m in (2, 6, 20)]
    assert distance(dmp, wanted) > errors[0] > errors[1] > errors[2]
    assert errors[0] > 0.3 * distance(dmp, wanted)


def test_styles_learned_together_equal_styles_learned_one_by_one():
    dmp, features = base_skill(), drawn()
    wanted = [bump(2.0, 0.5), bump(0.5, -0.4)]
    together = extend_styles(dmp, features, wanted, rest=0.5)
    for style, demonstration in zip(together, wanted, strict=True):
        alone = extend(dmp, features, demonstration, rest=0.5)
        np.testing.assert_allclose(style.rollout(0.005).position, alone.rollout(0.005).position, atol=1e-6)


def test_mixed_weights_give_the_pointwise_mixture():
    first, second = extend_styles(base_skill(), drawn(8), [bump(2.0, 0.5), bump(0.5, -0.4)], rest=0.5)
    mixed = interpolate(first, second, 0.3).rollout(0.005).position
    expected = 0.3 * first.rollout(0.005).position + 0.7 * second.rollout(0.005).position
    np.testing.assert_allclose(mixed, expected, atol=1e-6)


def test_styles_that_start_and_end_elsewhere_are_mixed_with_their_start_and_goal():
    there = bump(2.0, 0.5)
    moved = Demonstration(there.time, there.position + [0.3, -0.2], there.velocity, there.acceleration)
    stretched = Demonstration(moved.time, 1.2 * moved.position, 1.2 * moved.velocity, 1.2 * moved.acceleration)
    first, second = extend_styles(base_skill(), drawn(8), [there, stretched], rest=0.5)
    mixed = interpolate(first, second, 0.3).rollout(0.005).position
    np.testing.assert_allclose(mixed[0], 0.3 * there.start + 0.7 * stretched.start, atol=1e-12)
    expected = 0.3 * first.rollout(0.005).position + 0.7 * second.rollout(0.005).position
    np.testing.assert_allclose(mixed, expected, atol=1e-6)


def test_a_skill_can_grow_twice():
    dmp = base_skill()
    second = extend(dmp, drawn(), bump(2.0, 0.3), rest=0.5)
    wanted = bump(3.0, 0.3)
    third = extend(second, drawn(seed=1, base=second.features), wanted, relearn_old=False, rest=0.5)
    assert distance(third, wanted) < 0.1 * distance(second, wanted)
    np.testing.assert_allclose(original(third).rollout(0.005).position, second.rollout(0.005).position, atol=1e-9)


def test_lemma_with_the_corrected_start_fits_and_the_printed_start_leads_away():
    blocks, rng = drawn(10).blocks(PHASES), np.random.default_rng(5)
    target = blocks.kernels @ rng.standard_normal((12, 2))
    left = {
        reading: np.linalg.norm(target - blocks.change @ lemma_weights(blocks, target, reading))
        for reading in ("row_wise", "printed_start")
    }
    assert left["row_wise"] < 0.1 * np.linalg.norm(target)
    assert left["printed_start"] > np.linalg.norm(target)


def test_features_of_another_skill_are_refused():
    with pytest.raises(ValueError, match="extend those of the old skill"):
        extend(base_skill(), drawn(base=GaussianKernels.spaced(12, 4.0)), bump(2.0, 0.5))
