import numpy as np
import pytest
from scipy.signal import correlate

from dexrepro.vision.classifier import Adam, GraspClassifier, _batches, _convolved, _resampling, _softmax, confusion


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
    flat = classifier.mean + 2 * classifier.deviation * np.ones_like(patches[:1])
    assert classifier._prepared(flat) == pytest.approx(2 * np.ones((1, 28, 28, 7)), rel=1e-5)
    classifier.fit(np.ones_like(patches), np.zeros(len(patches), int), epochs=1)
    assert np.isfinite(classifier.probabilities(patches)).all(), "a channel that never changes"


def test_every_epoch_says_how_many_were_told_right():
    classifier, (patches, labels), test = GraspClassifier(seed=0, rate=0.0), toy(70, 4), toy(30, 5)
    (train, new), (again, _) = classifier.fit(patches, labels, 2, test)
    right = (classifier.probabilities(patches).argmax(1) == labels).mean()
    assert train == again == pytest.approx(right), "where nothing is learnt"
    learnt = GraspClassifier(seed=0).fit(patches, labels, 5, test)
    assert learnt[-1][0] > 0.9 > learnt[0][0]
    assert np.isnan(classifier.fit(patches, labels, 1)[0][1])
    assert new == pytest.approx((classifier.probabilities(test[0]).argmax(1) == test[1]).mean())


def test_steps_under_a_constant_gradient_are_the_rate():
    weights = [np.zeros((2, 3), np.float32)]
    adam = Adam(weights, 0.01)
    for k in range(1, 40):
        adam.step(weights, [np.full((2, 3), 0.5, np.float32)])
        assert weights[0] == pytest.approx(-0.01 * k, rel=1e-3)
    adam.step(weights, [np.full((2, 3), -0.5, np.float32)])
    mean, square = (1 - 0.9**39) * 0.9 * 0.5 - 0.1 * 0.5, 0.25 * (1 - 0.999**40)
    step = mean / (1 - 0.9**40) / (square / (1 - 0.999**40)) ** 0.5
    assert weights[0] == pytest.approx(-0.39 - 0.01 * step, rel=1e-4)


def test_largest_of_four_places_of_a_convolution_is_kept():
    rng = np.random.default_rng(6)
    inputs, weight = rng.standard_normal((2, 12, 12, 3)), rng.standard_normal((4, 3, 5, 5))
    offset = rng.standard_normal(4)
    every = np.array([[correlate(x.transpose(2, 0, 1), w, "valid")[0] for w in weight] for x in inputs])
    largest = (every + offset[:, None, None]).reshape(2, 4, 4, 2, 4, 2).max(axis=(3, 5))
    kept = _convolved(inputs.astype(np.float32), weight.astype(np.float32), offset.astype(np.float32))[2]
    assert kept.transpose(0, 3, 1, 2) == pytest.approx(np.maximum(largest, 0), abs=1e-4)


def test_scores_of_any_size_are_probabilities():
    assert _softmax(np.array([[1000.0, 999.0, -1000.0]])) == pytest.approx(
        np.array([[0.731059, 0.268941, 0.0]]), abs=1e-5
    )


def test_between_pixels_a_patch_is_straight():
    places = np.clip((np.arange(28) + 0.5) * 24 / 28 - 0.5, 0, 23)
    assert _resampling(24, 28) @ np.arange(24) == pytest.approx(places, abs=1e-6)
    assert _resampling(24, 28).sum(axis=1) == pytest.approx(1.0)


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
    assert {tuple(next(_batches(np.random.RandomState(k), 2, 2)).tolist()) for k in range(9)} == {(0, 1), (1, 0)}
