import numpy as np
import pytest

from dexrepro.vision.classifier import GraspClassifier, _batches, confusion


def toy(count, seed):
    """Patches whose class is where their bright half is: left, right or nowhere."""
    rng = np.random.default_rng(seed)
    labels = rng.integers(0, 3, count)
    patches = 0.3 * rng.standard_normal((count, 7, 24, 24)).astype(np.float32)
    patches[labels == 0, :, :, :12] += 1
    patches[labels == 1, :, :, 12:] += 1
    return patches, labels


def trained():
    classifier = GraspClassifier(seed=0)
    classifier.fit(*toy(192, 0), epochs=3)
    return classifier


def test_classes_that_differ_are_learnt_and_the_training_can_be_repeated():
    patches, labels = toy(60, 1)
    first, second = (trained().probabilities(patches) for _ in range(2))
    assert (first.argmax(1) == labels).mean() > 0.95
    assert first == pytest.approx(second)
    assert first.sum(axis=1) == pytest.approx(1.0, abs=1e-5)


def test_order_of_a_batch_does_not_matter():
    classifier, (patches, _) = trained(), toy(20, 2)
    order = np.random.default_rng(3).permutation(20)
    assert classifier.probabilities(patches[order]) == pytest.approx(classifier.probabilities(patches)[order], abs=1e-5)


def test_channels_are_standardised_on_the_training_set():
    classifier, (patches, _) = trained(), toy(192, 0)
    standard = (patches - classifier.mean) / classifier.deviation
    assert standard.mean(axis=(0, 2, 3)) == pytest.approx(0.0, abs=1e-4)
    assert standard.std(axis=(0, 2, 3)) == pytest.approx(1.0, abs=1e-3)


def test_confusion_counts_true_classes_in_rows():
    counts = confusion(np.array([0, 0, 1, 2]), np.array([0, 2, 1, 2]))
    assert counts.tolist() == [[1, 0, 1], [0, 1, 0], [0, 0, 1]]


def test_gradient_is_that_of_the_cross_entropy():
    classifier, (patches, labels) = GraspClassifier(seed=1), toy(8, 4)
    inputs = classifier._prepared(patches)
    classifier.weights = [weight.astype(np.float64) for weight in classifier.weights]
    rng = np.random.default_rng(5)

    def loss():
        scores = classifier._scores(inputs)[0]
        return float(np.mean(np.log(np.exp(scores).sum(1)) - scores[np.arange(len(labels)), labels]))

    for weight, slope in zip(classifier.weights, classifier.gradient(inputs, labels)[1], strict=True):
        along = rng.standard_normal(weight.shape)
        weight += 1e-6 * along
        ahead = loss()
        weight -= 2e-6 * along
        behind = loss()
        weight += 1e-6 * along
        assert np.sum(slope * along) == pytest.approx((ahead - behind) / 2e-6, rel=1e-3, abs=1e-6)


def test_first_weights_and_order_are_those_of_pytorch_for_the_seed():
    first = GraspClassifier(seed=3).weights[0]
    assert first[0, 0, 0] == pytest.approx([-0.0749483, -0.0596323, -0.0323776, -0.0715177, -0.0042915], abs=1e-7)
    order = next(_batches(np.random.RandomState(3), 1000, 10))
    assert order.tolist() == [986, 114, 871, 894, 140, 885, 232, 402, 837, 674]  # torch.randperm


def test_every_patch_is_taken_once_an_epoch():
    parts = list(_batches(np.random.RandomState(0), 150, 64))
    assert [len(part) for part in parts] == [64, 64, 22]
    assert sorted(np.concatenate(parts)) == list(range(150))
