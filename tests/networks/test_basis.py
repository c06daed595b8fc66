import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dexrepro.networks import Gaussians, Lattice


def test_gaussians_follow_the_printed_formula():
    centres = np.array([[0.0, 0.0], [3.0, 4.0]])
    assert Gaussians(centres, width=5.0)([0.0, 0.0]) == pytest.approx([1.0, np.exp(-1.0)], rel=1e-15)


@settings(deadline=None, max_examples=20)
@given(st.lists(st.floats(-2, 2), min_size=5, max_size=5), st.floats(0.3, 5.0), st.booleans())
def test_lattice_product_equals_the_plain_formula_at_every_combination_of_levels(z, width, normalised):
    levels = [[-1, 1], [0.1, 0.2, 0.5], [0.0], [-1, 0, 1, 2], [3, 4]]
    lattice = Lattice(levels, width, normalised)
    plain = Gaussians(list(itertools.product(*levels)), width, normalised)
    assert np.array_equal(lattice.centres, plain.centres)
    assert lattice(z) == pytest.approx(plain(z), rel=1e-10, abs=1e-300)


def test_lattice_of_fourteen_pairs_has_16384_gaussians_and_equals_the_plain_formula():
    rng = np.random.default_rng(1)
    levels = np.sort(rng.uniform(-1, 1, (14, 2)), axis=1)
    lattice = Lattice(levels, width=0.9)
    z = rng.uniform(-1, 1, 14)
    assert lattice.capacity == 16384
    assert np.allclose(lattice(z), Gaussians(lattice.centres, 0.9)(z), rtol=1e-12, atol=0)


def test_normalised_features_sum_to_one_and_vanish_quietly_far_outside():
    rules = Lattice([[-1, 1]] * 8, width=1.0, normalised=True)
    assert rules(np.linspace(-2, 2, 8)).sum() == pytest.approx(1.0, rel=1e-12)
    assert not rules(np.full(8, 1e4)).any()


@given(st.lists(st.floats(-3, 3), min_size=3, max_size=3))
def test_gaussian_features_lie_between_zero_and_one(z):
    features = Gaussians(np.eye(3), width=2.0)(z)
    assert np.all((features > 0) & (features <= 1))
