"""Safe, unsafe and bad grasps told apart by the convolutional network (Sect. 3.4)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Rng
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.vision.classifier import GraspClassifier, confusion

NAMES = ("safe", "unsafe", "bad")


def simulate(config: Config, rng: Rng) -> Recording:
    patches, labels, new_patches, new_labels = _data(config, rng)
    classifier = GraspClassifier(config.network_seed, config.learning_rate, config.batch)
    # The perturbation is a share of the inputs' range, which is about 1 in every channel.
    moved = patches + np.float32(config.perturbation)
    shares = classifier.fit(moved, labels, config.epochs, (new_patches, new_labels))
    recording = Recording(steps=len(patches) * config.epochs)
    recording.frames["epochs"] = pd.DataFrame(shares, columns=["train", "test"])
    recording.frames["epochs"].insert(0, "epoch", range(1, config.epochs + 1))
    counts = confusion(new_labels, classifier.probabilities(new_patches).argmax(1))
    recording.frames["confusion"] = pd.DataFrame(counts, columns=list(NAMES))
    if config.dataset == "synthetic":
        _example(recording, classifier, config, rng("example"))
    return recording


def _data(config: Config, rng: Rng) -> tuple[Any, Any, Any, Any]:
    """Training and test patches with labels: new scenes for the test, never patches of a scene trained on."""
    if config.dataset == "synthetic":
        from dexrepro.vision.tabletop import training_set

        train = training_set(config, config.box, config.scenes, rng("train"), config.patch_size)
        return (*train, *training_set(config, config.box, config.test_scenes, rng("test"), config.patch_size))
    from dexrepro.vision.cornell import labelled

    patches, labels = labelled(Path(config.dataset))
    cut = int(0.8 * len(patches))
    return patches[:cut], labels[:cut], patches[cut:], labels[cut:]


def _example(recording: Recording, classifier: GraspClassifier, config: Config, rng: np.random.Generator) -> None:
    """Keep one new scene with its candidates, found classes and scores."""
    from dexrepro.physics.rendering import Overhead
    from dexrepro.vision.patches import cut
    from dexrepro.vision.tabletop import Box, candidates, label, photograph, scatter

    box = Box(tuple(config.box))
    camera = Overhead((0.0, 0.0, config.camera_height), (180, 140), config.field_of_view)
    items = scatter(rng, box, 4)
    picture = photograph(box, items, camera, rng)
    grasps = candidates(rng, items, box)
    scores = classifier.probabilities(cut(picture, grasps, config.patch_size))
    recording.images["scene"] = (255 * picture.colours).astype(np.uint8)
    rows = []
    for grasp, score in zip(grasps, scores):
        corners = camera.project(np.column_stack((grasp.corners, np.full(4, grasp.z))))
        rows.append({f"{axis}{k}": corners[k, i] for k in range(4) for i, axis in enumerate("uv")})
        rows[-1].update(found=int(score.argmax()), true=label(grasp, items, box, config.safety_margin), score=score[0])
    recording.frames["grasps"] = pd.DataFrame(rows)
    width, depth = (side / 2 - config.safety_margin for side in config.box)
    ring = [(-width, -depth), (width, -depth), (width, depth), (-width, depth), (-width, -depth)]
    outline = camera.project(np.array([(x, y, 0.0) for x, y in ring]))
    recording.frames["boundary"] = pd.DataFrame(outline, columns=["u", "v"])


def measure(recording: Recording, config: Config) -> Metrics:
    epochs, counts = recording.frames["epochs"], recording.frames["confusion"].to_numpy()
    recalls = counts.diagonal() / np.maximum(counts.sum(axis=1), 1)
    return {
        "train_accuracy": float(epochs.train.iloc[-1]),
        "test_accuracy": float(epochs.test.iloc[-1]),
        "balanced_accuracy": float(recalls.mean()),
        "majority": float(counts.sum(axis=1).max() / counts.sum()),
        "unsafe_recall": float(recalls[1]),
        "unsafe_called_safe": float(counts[1, 0] / max(counts[1].sum(), 1)),
        "unsafe_samples": int(counts[1].sum()),
        "test_samples": int(counts.sum()),
    }
