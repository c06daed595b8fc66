"""The convolutional classifier of grasps: safe, unsafe or bad (Sect. 3.4.2)."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from dexrepro.arrays import Array
from dexrepro.vision.patches import CHANNELS, SAMPLES

Single = NDArray[np.float32]
"""Single precision."""

INPUT = 28  # side that the 24 x 24 patches are resampled to
KERNEL = 5
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
        self,
        patches: Single,
        labels: NDArray[np.int64],
        epochs: int,
        watch: Callable[[int, float], None] | None = None,
    ) -> None:
        """Train on patches (n, 7, 24, 24) and labels (n,).

        After every epoch ``watch`` gets its number and the share found right while it was trained on.
        """
        self.mean = patches.mean(axis=(0, 2, 3), keepdims=True)
        self.deviation = patches.std(axis=(0, 2, 3), keepdims=True) + np.float32(1e-6)
        inputs, adam = self._prepared(patches), Adam(self.weights, self.rate)
        for epoch in range(epochs):
            right = 0
            for part in _batches(self._order, len(inputs), self.batch):
                scores, gradient = self.gradient(inputs[part], labels[part])
                adam.step(self.weights, gradient)
                right += int((scores.argmax(1) == labels[part]).sum())
            if watch is not None:
                watch(epoch + 1, right / len(inputs))

    def probabilities(self, patches: Single) -> Array:
        """Probability of each class, shape (n, 3)."""
        inputs = self._prepared(patches)
        parts = [_softmax(self._scores(inputs[k : k + 128])[0]) for k in range(0, len(inputs), 128)]
        return np.concatenate([np.zeros((0, CLASSES)), *parts])

    def gradient(self, inputs: Single, labels: NDArray[np.int64]) -> tuple[Single, list[Single]]:
        """Scores (n, 3) of prepared inputs, and the gradient of their mean cross-entropy by each of the weights."""
        first, _, second, _, third, _, fourth, _ = self.weights
        scores, (columns1, conv1, columns2, conv2, flat, hidden) = self._scores(inputs)
        by_scores = _softmax(scores)
        by_scores[np.arange(len(labels)), labels] -= 1
        by_scores /= np.float32(len(labels))
        by_hidden: Single = (by_scores @ fourth) * (hidden > 0)
        by_flat: Single = (by_hidden @ third).reshape(-1, 32, 4, 4).transpose(0, 2, 3, 1)
        by_conv2 = _unpooled(by_flat, conv2)
        by_pooled = _spread(by_conv2, second)
        by_conv1 = _unpooled(by_pooled, conv1)
        rows1, rows2 = by_conv1.reshape(-1, 16), by_conv2.reshape(-1, 32)
        return scores, [
            _by_channel(rows1.T @ columns1, first.shape), rows1.sum(0),
            _by_channel(rows2.T @ columns2, second.shape), rows2.sum(0),
            by_hidden.T @ flat, by_hidden.sum(0),
            by_scores.T @ hidden, by_scores.sum(0),
        ]  # fmt: skip

    def _scores(self, inputs: Single) -> tuple[Single, tuple[Single, ...]]:
        """Scores (n, 3) before the softmax, and what the gradient needs of the layers below."""
        first, offset1, second, offset2, third, offset3, fourth, offset4 = self.weights
        conv1, columns1 = _convolved(inputs, first, offset1)
        conv2, columns2 = _convolved(_pooled(conv1), second, offset2)
        flat = _pooled(conv2).transpose(0, 3, 1, 2).reshape(len(inputs), -1)
        hidden = np.maximum(flat @ third.T + offset3, 0)
        return hidden @ fourth.T + offset4, (columns1, conv1, columns2, conv2, flat, hidden)

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


def _convolved(inputs: Single, weight: Single, offset: Single) -> tuple[Single, Single]:
    """Rectified convolution (n, h - 4, w - 4, out) of inputs (n, h, w, in), and the windows it took, one a row.

    In a row the channels of one pixel are neighbours, as in the inputs: whole lines of a window are copied at once.
    """
    windows = np.lib.stride_tricks.sliding_window_view(inputs, (KERNEL, KERNEL), axis=(1, 2))
    columns = windows.transpose(0, 1, 2, 4, 5, 3).reshape(-1, weight[0].size)
    result = columns @ _by_pixel(weight).T
    result += offset
    return np.maximum(result, 0, out=result).reshape(*windows.shape[:3], -1), columns


def _by_pixel(weight: Single) -> Single:
    """Weights (out, in, 5, 5) as (out, 5 x 5 x in), in the order of the windows."""
    return weight.transpose(0, 2, 3, 1).reshape(len(weight), -1)


def _by_channel(gradient: Single, shape: tuple[int, ...]) -> Single:
    """The inverse: (out, 5 x 5 x in) as weights of a shape (out, in, 5, 5)."""
    return gradient.reshape(shape[0], KERNEL, KERNEL, shape[1]).transpose(0, 3, 1, 2)


def _spread(by_result: Single, weight: Single) -> Single:
    """Gradient by the inputs of a convolution from that by its result."""
    count, height, width, _ = by_result.shape
    rows = by_result.reshape(-1, len(weight)) @ _by_pixel(weight)
    windows = rows.reshape(count, height, width, KERNEL, KERNEL, -1)
    result = np.zeros((count, height + KERNEL - 1, width + KERNEL - 1, windows.shape[-1]), np.float32)
    for i in range(KERNEL):
        for j in range(KERNEL):
            result[:, i : i + height, j : j + width] += windows[:, :, :, i, j]
    return result


def _pooled(inputs: Single) -> Single:
    """Largest of each 2 x 2: (n, h, w, c) becomes (n, h / 2, w / 2, c)."""
    return np.maximum(
        np.maximum(inputs[:, ::2, ::2], inputs[:, 1::2, ::2]), np.maximum(inputs[:, ::2, 1::2], inputs[:, 1::2, 1::2])
    )


def _unpooled(by_pooled: Single, inputs: Single) -> Single:
    """Gradient by what was rectified to ``inputs`` and pooled: only the largest, where positive, has one."""
    largest = np.repeat(np.repeat(_pooled(inputs), 2, axis=1), 2, axis=2)
    spread = np.repeat(np.repeat(by_pooled, 2, axis=1), 2, axis=2)
    return spread * ((inputs == largest) & (inputs > 0))


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


def confusion(labels: NDArray[np.int64], found: NDArray[np.int64]) -> NDArray[np.int64]:
    """Counts (3, 3): rows the true class, columns the found one."""
    result = np.zeros((CLASSES, CLASSES), dtype=np.int64)
    np.add.at(result, (labels, found), 1)
    return result
