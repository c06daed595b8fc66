import numpy as np
import pytest

from dexrepro.vision.classifier import GraspClassifier, confusion

pytest.importorskip("torch")


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
