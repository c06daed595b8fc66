"""The convolutional classifier of grasps: safe, unsafe or bad (Sect. 3.4.2). Needs torch."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dexrepro.arrays import Array

INPUT = 28  # side that the 24 x 24 patches are resampled to
CLASSES = 3


class GraspClassifier:
    """conv 5x5-16, pool, conv 5x5-32, pool, full 128, full 3 on 28 x 28 x 7, cross-entropy, Adam.

    Layers are ours (the book prints input, optimiser, rate and epochs). Every channel is standardised with the mean
    and deviation of the training set. Single-threaded and seeded, so that a training can be repeated.
    """

    def __init__(self, seed: int, rate: float = 1e-3, batch: int = 64) -> None:
        import torch

        torch.set_num_threads(1)
        torch.manual_seed(seed)
        self._torch, self._batch = torch, batch
        layers = torch.nn
        self.network = layers.Sequential(
            layers.Conv2d(7, 16, 5), layers.ReLU(), layers.MaxPool2d(2),
            layers.Conv2d(16, 32, 5), layers.ReLU(), layers.MaxPool2d(2),
            layers.Flatten(), layers.Linear(32 * 4 * 4, 128), layers.ReLU(), layers.Linear(128, CLASSES),
        )  # fmt: skip
        self._optimiser = torch.optim.Adam(self.network.parameters(), lr=rate)
        self._order = torch.Generator().manual_seed(seed)
        self.mean: Any = 0.0
        self.deviation: Any = 1.0

    def fit(
        self,
        patches: NDArray[np.float32],
        labels: NDArray[np.int64],
        epochs: int,
        watch: Callable[[int, float], None] | None = None,
    ) -> None:
        """Train on patches (n, 7, 24, 24) and labels (n,).

        After every epoch ``watch`` gets its number and the share found right while it was trained on.
        """
        torch = self._torch
        self.mean = patches.mean(axis=(0, 2, 3), keepdims=True)
        self.deviation = patches.std(axis=(0, 2, 3), keepdims=True) + 1e-6
        inputs, targets = self._prepared(patches), torch.from_numpy(np.asarray(labels, dtype=np.int64))
        loss = torch.nn.CrossEntropyLoss()
        for epoch in range(epochs):
            self.network.train()
            right = 0
            for part in torch.randperm(len(inputs), generator=self._order).split(self._batch):
                self._optimiser.zero_grad()
                scores = self.network(inputs[part])
                loss(scores, targets[part]).backward()
                self._optimiser.step()
                right += int((scores.detach().argmax(1) == targets[part]).sum())
            if watch is not None:
                watch(epoch + 1, right / len(inputs))

    def probabilities(self, patches: NDArray[np.float32]) -> Array:
        """Probability of each class, shape (n, 3)."""
        torch = self._torch
        if not len(patches):
            return np.zeros((0, CLASSES))
        self.network.eval()
        with torch.no_grad():
            parts = [torch.softmax(self.network(part), 1) for part in self._prepared(patches).split(512)]
        return np.asarray(torch.cat(parts).numpy(), dtype=float)

    def _prepared(self, patches: NDArray[np.float32]) -> Any:
        torch = self._torch
        standard = torch.from_numpy(((patches - self.mean) / self.deviation).astype(np.float32))
        return torch.nn.functional.interpolate(standard, size=(INPUT, INPUT), mode="bilinear", align_corners=False)


def confusion(labels: NDArray[np.int64], found: NDArray[np.int64]) -> NDArray[np.int64]:
    """Counts (3, 3): rows the true class, columns the found one."""
    result = np.zeros((CLASSES, CLASSES), dtype=np.int64)
    np.add.at(result, (labels, found), 1)
    return result
