import numpy as np
import pytest

from dexrepro.networks import AdaptiveNetwork, Gaussians, GrowingGaussians, Lattice


def test_weights_settle_where_the_error_balances_the_leakage():
    network = AdaptiveNetwork(Gaussians([[0.0]], 1.0), outputs=2, gain=[3.0, 5.0], leakage=2.0, step=1e-3)
    for _ in range(8000):
        network.output([0.0])
        network.adapt(np.array([1.0, -2.0]))
    assert network.weights == pytest.approx(np.array([[1.5, -5.0]]), rel=1e-6)  # gain e / leakage


def test_it_learns_a_function_from_the_error_of_its_own_output():
    network = AdaptiveNetwork(
        Lattice([np.linspace(-1.25, 1.25, 11)], 0.25), outputs=1, gain=50.0, leakage=0.0, step=1e-2
    )
    for z in np.random.default_rng(0).uniform(-1, 1, 6000):
        network.adapt(np.sin(3 * z) - network.output([z]))
    assert max(abs(np.sin(3 * z) - network.output([z])[0]) for z in np.linspace(-1, 1, 17)) < 0.03


def test_one_step_is_the_printed_law():
    network = AdaptiveNetwork(Gaussians([[0.0], [1.0]], 1.0), outputs=2, gain=4.0, leakage=0.5, step=0.01)
    weights, error = np.array([[1.0, 2.0], [3.0, 4.0]]), np.array([0.2, -0.1])
    network.reset(weights)
    features = network.basis([0.3]).copy()
    assert network.output([0.3]) == pytest.approx(weights.T @ features)
    network.adapt(error)
    assert network.weights == pytest.approx(weights + 0.01 * (4.0 * np.outer(features, error) - 0.5 * weights))


def test_a_new_node_leaves_the_output_unchanged():
    basis = GrowingGaussians(1, width=1.0, threshold=0.5)
    network = AdaptiveNetwork(basis, outputs=2, gain=1.0, leakage=0.0, step=0.1)
    network.output([0.0], grow=True)
    network.adapt(np.array([2.0, -1.0]))
    before = network.output([0.8])
    after = network.output([0.8], grow=True)
    assert basis.nodes == 2
    assert len(network.weights) == 6
    assert after == pytest.approx(before, abs=1e-12)
    assert np.abs(before).min() > 0.1


def test_learned_weights_start_a_larger_network():
    small = AdaptiveNetwork(Gaussians([[0.0], [1.0]], 1.0), outputs=1, gain=1.0, leakage=0.0, step=0.1)
    small.reset([[2.0], [-1.0]])
    large = AdaptiveNetwork(Gaussians([[0.0], [1.0], [2.0]], 1.0), outputs=1, gain=1.0, leakage=0.0, step=0.1)
    large.reset([[2.0], [-1.0]])
    assert large.output([0.4]) == pytest.approx(small.output([0.4]))


def test_a_reset_network_knows_only_what_it_is_given():
    network = AdaptiveNetwork(Gaussians([[0.0], [1.0]], 1.0), outputs=1, gain=1.0, leakage=0.0, step=0.1)
    assert network.weights.shape == (0, 1)
    network.reset([[2.0], [-1.0]])
    network.reset([[3.0]])
    network.output([0.4])
    assert network.weights.tolist() == [[3.0], [0.0]]
    network.reset()
    assert network.output([0.4]) == pytest.approx([0.0])


def test_it_reports_nodes_and_the_features_at_its_last_input():
    network = AdaptiveNetwork(Gaussians([[0.0], [1.0]], 1.0), outputs=1, gain=1.0, leakage=0.0, step=1e-3)
    assert network.diagnostics() == {"nodes": 2, "feature_energy": 0.0, "activation": 0.0}
    network.output([0.5])
    assert Gaussians.features_per_node == 1
    share = np.exp(-0.25)
    assert network.diagnostics() == pytest.approx({"nodes": 2, "feature_energy": 2 * share**2, "activation": share})
    network.output([2.0])
    assert network.diagnostics()["activation"] == pytest.approx(np.exp(-1.0)), "the largest"


def test_a_network_that_forgets_has_no_weights_and_the_nodes_of_its_start():
    network = AdaptiveNetwork(
        GrowingGaussians(1, width=2.0, threshold=0.5, enhanced=False), outputs=1, gain=1.0, leakage=0.0, step=0.1
    )
    for z in ([0.0], [1.0], [3.0]):
        network.output(z, grow=True)
        network.adapt(np.array([1.0]))
    assert network.nodes == 3
    network.forget()
    assert network.nodes == 0
    assert network.output([5.0]).tolist() == [0.0]
    assert network.features == pytest.approx([1.0])
    assert network.output([6.0]).tolist() == [0.0]
    assert network.features == pytest.approx([np.exp(-0.25)]), "exp(-|z - c|^2 / width^2)"


def test_a_gain_set_later_counts_from_the_next_step():
    network = AdaptiveNetwork(Gaussians([[0.0]], 1.0), outputs=1, gain=1.0, leakage=0.0, step=0.1)
    network.output([0.0])
    network.adapt(np.array([1.0]))
    network.gain = 3.0 * network.gain
    network.adapt(np.array([1.0]))
    assert network.weights == pytest.approx(np.array([[0.1 + 0.3]]))
