import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dexrepro.networks import Gaussians, GrowingGaussians


def walk(basis, inputs):
    """Node count after each input."""
    return [len(basis(z, grow=True)) // basis.features_per_node for z in inputs]


def test_first_input_becomes_the_first_node():
    basis = GrowingGaussians(2, width=1.0, threshold=1.0)
    basis([3.0, 4.0])
    assert basis.centres.tolist() == [[3.0, 4.0]]


def test_a_node_is_added_only_beyond_the_threshold_and_placed_on_the_way_to_the_input():
    basis = GrowingGaussians(1, width=1.0, threshold=2.0, placement=0.5)
    assert walk(basis, [[0.0], [2.0], [2.1]]) == [1, 1, 2]
    assert basis.centres[1] == pytest.approx([1.05])


def test_distance_is_measured_from_the_mean_of_the_nearest_centres():
    basis = GrowingGaussians(1, width=1.0, threshold=1.5, neighbours=2)
    basis.reset([[0.0], [2.0], [10.0]])
    assert walk(basis, [[2.4], [2.6]]) == [3, 4]  # the mean of 0 and 2 is 1
    assert basis.centres[3] == pytest.approx([2.6])


def test_fewer_centres_than_neighbours_are_all_of_them():
    basis = GrowingGaussians(1, width=1.0, threshold=1.5, neighbours=3)
    basis.reset([[1.0], [3.0]])
    assert walk(basis, [[3.4], [3.6]]) == [2, 3]  # their mean is 2
    assert basis.centres[2] == pytest.approx([3.6])


def test_the_nearest_centres_are_found_among_many():
    rng = np.random.default_rng(0)
    for _ in range(10):
        centres, z = rng.normal(size=(200, 2)), rng.normal(size=2)
        basis = GrowingGaussians(2, width=1.0, threshold=0.0, neighbours=3, placement=0.0)
        basis.reset(centres)
        basis(z, grow=True)
        nearest = np.argsort(np.linalg.norm(centres - z, axis=1))[:3]
        assert basis.centres[-1] == pytest.approx(centres[nearest].mean(axis=0))


def test_growth_is_considered_at_every_interval_and_only_when_asked():
    basis = GrowingGaussians(1, width=1.0, threshold=0.5, interval=4)
    assert walk(basis, [[0.0], [1.0], [2.0], [3.0], [4.0], [5.0]]) == [1, 1, 1, 1, 2, 2]
    basis([50.0])
    assert basis.nodes == 2


@settings(deadline=None, max_examples=20)
@given(st.lists(st.tuples(st.floats(-50, 50), st.floats(-50, 50)), min_size=1, max_size=60), st.floats(0.5, 30))
def test_nodes_never_disappear_and_every_input_ends_within_the_threshold_of_one(inputs, threshold):
    basis = GrowingGaussians(2, width=1.0, threshold=threshold, placement=1.0)
    counts = walk(basis, inputs)
    assert all(0 <= b - a <= 1 for a, b in itertools.pairwise(counts))
    for z in inputs:
        assert np.min(np.linalg.norm(basis.centres - np.array(z), axis=1)) <= threshold * (1 + 1e-12)


def test_a_smaller_threshold_needs_more_nodes():
    inputs = np.random.default_rng(0).uniform(-10, 10, (400, 2))
    counts = [walk(GrowingGaussians(2, width=1.0, threshold=t), inputs)[-1] for t in (1.0, 3.0, 9.0)]
    assert counts[0] > counts[1] > counts[2] > 1


def test_features_are_the_gaussian_its_cosine_and_its_sine_node_by_node():
    centres = [[0.0], [1.0], [5.0]]
    basis = GrowingGaussians(1, width=2.0, threshold=1.0)
    basis.reset(centres)
    s = Gaussians(centres, 2.0)([0.7])
    assert basis([0.7]).reshape(3, 3) == pytest.approx(np.stack([s, np.cos(s), np.sin(s)], axis=1))
    plain = GrowingGaussians(1, width=2.0, threshold=1.0, enhanced=False)
    plain.reset(centres)
    assert plain([0.7]) == pytest.approx(s)
    assert (basis.capacity, plain.capacity) == (3 * 500, 500)


def test_growth_stops_at_the_reserved_size_and_reallocates_nothing():
    basis = GrowingGaussians(1, width=1.0, threshold=0.5, max_nodes=3)
    memory = basis._centres
    assert walk(basis, [[float(i)] for i in range(6)]) == [1, 2, 3, 3, 3, 3]
    assert basis._centres is memory
    with pytest.raises(ValueError, match="at most 3"):
        basis.reset(np.zeros((4, 1)))
