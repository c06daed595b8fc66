"""The convolutional classifier of grasps: safe, unsafe or bad (Sect. 3.4.2)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from dexrepro.arrays import Array
from dexrepro.vision.patches import CHANNELS, SAMPLES

Single = NDArray[np.float32]
"""Single precision."""
Labels = NDArray[np.int64]
"""The number of a class, one a patch."""

INPUT = 28  # side that the 24 x 24 patches are resampled to
KERNEL = 5
WINDOW = KERNEL + 1  # what the four results see of which the largest is kept
PARTS = tuple((slice(row, row + KERNEL), slice(column, column + KERNEL)) for row in (0, 1) for column in (0, 1))
CLASSES = 3
SHAPES = ((16, len(CHANNELS), KERNEL, KERNEL), (32, 16, KERNEL, KERNEL), (128, 32 * 4 * 4), (CLASSES, 128))


class GraspClassifier:
    """conv 5x5-16, pool, conv 5x5-32, pool, full 128, full 3 on 28 x 28 x 7, cross-entropy, Adam, single precision.

    Layers are ours (the book prints input, optimiser, rate and epochs). Every channel is standardised with the mean
    and deviation of the training set. First weights, order of the samples and steps are those of PyTorch for the same
    seed, so that a training there is the same up to rounding; the network is too small to ask everyone for PyTorch.
    """

    def __init__(self, seed: int, rate: float = 1e-3, batch: int = 64) -> None:
        self.rate, self.batch = rate, batch
        start, self._order = (np.random.RandomState(seed) for _ in range(2))
        self.weights: list[Single] = []  # of a layer and its offset, in turn
        for shape in SHAPES:
            bound = np.float32(1 / np.sqrt(np.prod(shape[1:])))
            self.weights += [_uniform(start, shape, bound), _uniform(start, shape[:1], bound)]
        self.mean: Single = np.zeros((1, len(CHANNELS), 1, 1), np.float32)
        self.deviation: Single = np.ones_like(self.mean)

    def fit(
        self, patches: Single, labels: Labels, epochs: int, test: tuple[Single, Labels] | None = None
    ) -> list[tuple[float, float]]:
        """Train on patches (n, 7, 24, 24) and labels (n,).

        Of every epoch the share found right while it was trained on, and of ``test``, others with their labels, after
        it (nan without).
        """
        self.mean = patches.mean(axis=(0, 2, 3), keepdims=True)
        self.deviation = patches.std(axis=(0, 2, 3), keepdims=True) + np.float32(1e-6)
        inputs, adam, shares = self._prepared(patches), Adam(self.weights, self.rate), []
        new, new_labels = (self._prepared(test[0]), test[1]) if test else (None, labels)
        for _ in range(epochs):
            right = 0
            for part in _batches(self._order, len(inputs), self.batch):
                scores, gradient = self.gradient(inputs[part], labels[part])
                adam.step(self.weights, gradient)
                right += int((scores.argmax(1) == labels[part]).sum())
            found = np.nan if new is None else float((self._probable(new).argmax(1) == new_labels).mean())
            shares.append((right / len(inputs), found))
        return shares

    def probabilities(self, patches: Single) -> Array:
        """Probability of each class, shape (n, 3)."""
        return self._probable(self._prepared(patches))

    def _probable(self, inputs: Single) -> Array:
        parts = [_softmax(self._scores(inputs[k : k + 128])[0]) for k in range(0, len(inputs), 128)]
        return np.concatenate([np.zeros((0, CLASSES)), *parts])

    def gradient(self, inputs: Single, labels: Labels) -> tuple[Single, list[Single]]:
        """Scores (n, 3) of prepared inputs, and the gradient of their mean cross-entropy by each of the weights."""
        first, _, second, _, third, _, fourth, _ = self.weights
        scores, (windows1, fours1, pooled1, windows2, fours2, pooled2, flat, hidden) = self._scores(inputs)
        by_scores = _softmax(scores)
        by_scores[np.arange(len(labels)), labels] -= 1
        by_scores /= np.float32(len(labels))
        by_hidden: Single = (by_scores @ fourth) * (hidden > 0)
        by_flat: Single = (by_hidden @ third).reshape(-1, 32, 4, 4).transpose(0, 2, 3, 1)
        by_fours2 = _unpooled(by_flat, pooled2, fours2)
        by_fours1 = _unpooled(_spread(by_fours2, second, pooled1.shape), pooled1, fours1)
        return scores, [
            _by_weight(windows1.T @ by_fours1, first.shape), by_fours1.sum(0).reshape(4, -1).sum(0),
            _by_weight(windows2.T @ by_fours2, second.shape), by_fours2.sum(0).reshape(4, -1).sum(0),
            by_hidden.T @ flat, by_hidden.sum(0),
            by_scores.T @ hidden, by_scores.sum(0),
        ]  # fmt: skip

    def _scores(self, inputs: Single) -> tuple[Single, tuple[Single, ...]]:
        """Scores (n, 3) before the softmax, and what the gradient needs of the layers below."""
        first, offset1, second, offset2, third, offset3, fourth, offset4 = self.weights
        windows1, fours1, pooled1 = _convolved(inputs, first, offset1)
        windows2, fours2, pooled2 = _convolved(pooled1, second, offset2)
        flat = pooled2.transpose(0, 3, 1, 2).reshape(len(inputs), -1)
        hidden = np.maximum(flat @ third.T + offset3, 0)
        return hidden @ fourth.T + offset4, (windows1, fours1, pooled1, windows2, fours2, pooled2, flat, hidden)

    def _prepared(self, patches: Single) -> Single:
        """Standardised and resampled inputs (n, 28, 28, 7)."""
        standard = ((patches - self.mean) / self.deviation).astype(np.float32)
        matrix = _resampling(SAMPLES, INPUT)
        return np.ascontiguousarray((matrix @ standard @ matrix.T).transpose(0, 2, 3, 1))


class Adam:
    """Steps of Kingma and Ba's Adam with its usual constants, in place."""

    def __init__(self, weights: list[Single], rate: float) -> None:
        self.rate, self.count = rate, 0
        self.first = [np.zeros_like(weight) for weight in weights]
        self.second = [np.zeros_like(weight) for weight in weights]

    def step(self, weights: list[Single], gradient: list[Single]) -> None:
        """Move the weights along their gradient, of the same shapes."""
        self.count += 1
        rate, scale = self.rate / (1 - 0.9**self.count), (1 - 0.999**self.count) ** 0.5
        for weight, slope, first, second in zip(weights, gradient, self.first, self.second, strict=True):
            first += 0.1 * (slope - first)
            second += 0.001 * (slope * slope - second)
            weight -= rate * first / (np.sqrt(second) / scale + 1e-8)


def _convolved(inputs: Single, weight: Single, offset: Single) -> tuple[Single, Single, Single]:
    """Convolution of inputs (n, h, w, in) of which the largest of each 2 x 2 is kept, or zero where it is negative.

    First the windows of 6 x 6 that the four results share, one a row, then those four, (rows, 4 x out), then what is
    kept, (n, h / 2 - 2, w / 2 - 2, out). In a row the channels of one pixel are neighbours, as in the inputs: whole
    lines of a window are copied at once.
    """
    windows = np.lib.stride_tricks.sliding_window_view(inputs, (WINDOW, WINDOW), axis=(1, 2))[:, ::2, ::2]
    columns = windows.transpose(0, 1, 2, 4, 5, 3).reshape(-1, WINDOW**2 * inputs.shape[3])
    fours = columns @ _of_fours(weight)
    fours += np.tile(offset, 4)
    one, two, three, four = np.split(fours, 4, axis=1)
    pooled = np.maximum(np.maximum(one, two), np.maximum(three, four))
    return columns, fours, np.maximum(pooled, 0, out=pooled).reshape(*windows.shape[:3], -1)


def _unpooled(by_pooled: Single, pooled: Single, fours: Single) -> Single:
    """Gradient by the four results of each window: only the largest, where positive, has one."""
    positive = (by_pooled * (pooled > 0)).reshape(len(fours), 1, -1)
    largest = fours.reshape(len(fours), 4, -1) == pooled.reshape(positive.shape)
    return (positive * largest).reshape(fours.shape)


def _of_fours(weight: Single) -> Single:
    """Weights (out, in, 5, 5) as (6 x 6 x in, 4 x out): each of the four results sees its own part of the window."""
    result = np.zeros((WINDOW, WINDOW, weight.shape[1], 4, len(weight)), weight.dtype)
    for k, (rows, columns) in enumerate(PARTS):
        result[rows, columns, :, k] = weight.transpose(2, 3, 1, 0)
    return result.reshape(-1, 4 * len(weight))


def _by_weight(gradient: Single, shape: tuple[int, ...]) -> Single:
    """Gradient by the weights, of a shape (out, in, 5, 5), from that by those of :func:`_of_fours`."""
    fours = gradient.reshape(WINDOW, WINDOW, shape[1], 4, shape[0])
    by_pixel: Single = sum(fours[rows, columns, :, k] for k, (rows, columns) in enumerate(PARTS))  # type: ignore[assignment]
    return by_pixel.transpose(3, 2, 0, 1)


def _spread(by_fours: Single, weight: Single, shape: tuple[int, ...]) -> Single:
    """Gradient by the inputs, of a shape (n, h, w, in), of a convolution from that by its fours."""
    count, height, width, channels = shape
    rows, columns, half = height // 2 - 2, width // 2 - 2, WINDOW // 2
    windows = (by_fours @ _of_fours(weight).T).reshape(count, rows, columns, half, 2, half, 2, channels)
    result = np.zeros((count, height // 2, 2, width // 2, 2, channels), windows.dtype)
    for i in range(half):
        for j in range(half):
            result[:, i : i + rows, :, j : j + columns] += windows[:, :, :, i, :, j].swapaxes(2, 3)
    return result.reshape(shape)


def _softmax(scores: Single) -> Single:
    powers = np.exp(scores - scores.max(axis=1, keepdims=True))
    return powers / powers.sum(axis=1, keepdims=True)


def _resampling(size: int, target: int) -> Single:
    """Matrix (target, size) that interpolates linearly between the centres of pixels."""
    at = np.clip((np.arange(target) + 0.5) * size / target - 0.5, 0, None)
    low = np.minimum(at.astype(int), size - 1)
    share = np.float32(at - low)
    matrix = np.zeros((target, size), np.float32)
    matrix[np.arange(target), low] = 1 - share
    matrix[np.arange(target), np.minimum(low + 1, size - 1)] += share
    return matrix


def _uniform(start: np.random.RandomState, shape: tuple[int, ...], bound: np.float32) -> Single:
    bits = start.randint(1 << 32, size=shape, dtype=np.uint32) & np.uint32((1 << 24) - 1)
    return bits.astype(np.float32) * np.float32(2.0**-24) * (2 * bound) - bound


def _batches(order: np.random.RandomState, count: int, size: int) -> Iterator[NDArray[np.int64]]:
    """All numbers below ``count`` in random order, some at a time."""
    shuffled = np.arange(count)
    for k, draw in enumerate(order.randint(1 << 32, size=count - 1, dtype=np.uint32).tolist()):
        other = k + draw % (count - k)
        shuffled[k], shuffled[other] = shuffled[other], shuffled[k]
    yield from np.split(shuffled, range(size, count, size))


def confusion(labels: Labels, found: Labels) -> NDArray[np.int64]:
    """Counts (3, 3): rows the true class, columns the found one."""
    result = np.zeros((CLASSES, CLASSES), dtype=np.int64)
    np.add.at(result, (labels, found), 1)
    return result
