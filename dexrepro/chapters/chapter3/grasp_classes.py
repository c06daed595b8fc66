"""Safe, unsafe and bad grasps told apart by the convolutional network (Sect. 3.4)."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.experiment import Config, Figure, Metrics, Recording
from dexrepro.vision.classifier import GraspClassifier, confusion

FIGURES = {
    "3.C": Figure(
        "Accuracy on training and on new scenes over 25 epochs, and confusion on the new scenes, for a patch of 0.16 m "
        "that shows the walls. Synthetic RGB-D scenes rendered in place of Cornell's data (the book states 98 "
        "% training "
        "accuracy and no test accuracy).",
        "Training accuracy approaches 100 %; new scenes are classified almost as well.",
    ),
    "3.E": Figure(
        "A new synthetic scene: the rectangle the network scores highest as safe, all candidates coloured by their "
        "found class, and the boundary of the safety region.",
        "The chosen grasp lies on an object inside the safety region.",
    ),
}
TABLES = {"T3.F": "Confusion on new scenes (rows: true class)"}
NAMES = ("safe", "unsafe", "bad")


def simulate(config: Config, rng: Any) -> Recording:
    patches, labels, new_patches, new_labels = _data(config, rng)
    classifier = GraspClassifier(config.network_seed, config.learning_rate, config.batch)
    rows = []

    def watch(epoch: int, train: float) -> None:
        test = (classifier.probabilities(new_patches).argmax(1) == new_labels).mean()
        rows.append({"epoch": epoch, "train": train, "test": test})

    # The perturbation is a share of the inputs' range, which is about 1 in every channel.
    classifier.fit(patches + np.float32(config.perturbation), labels, config.epochs, watch)
    recording = Recording(steps=len(patches) * config.epochs)
    recording.frames["epochs"] = pd.DataFrame(rows)
    counts = confusion(new_labels, classifier.probabilities(new_patches).argmax(1))
    recording.frames["confusion"] = pd.DataFrame(counts, columns=list(NAMES))
    if config.dataset == "synthetic":
        _example(recording, classifier, config, rng("example"))
    return recording


def _data(config: Config, rng: Any) -> tuple[Any, Any, Any, Any]:
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


def draw(recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics], config: Config) -> dict[str, Any]:
    figures: dict[str, Any] = {}
    wide = recordings.get("wide")
    if wide is None:
        return figures
    figures["3.C"] = _draw_training(wide, metrics["wide"])
    if "grasps" in wide.frames:
        figures["3.E"] = _draw_example(wide)
    return figures


def _draw_training(recording: Recording, found: Metrics) -> Any:
    from dexrepro.report import style

    figure, (left, right) = style.subplots(1, 2, height=2.5, width_ratios=(1.4, 1))
    epochs = recording.frames["epochs"]
    left.plot(epochs.epoch, 100 * epochs.train, label="training scenes", **style.LINES["book"])
    left.plot(epochs.epoch, 100 * epochs.test, label="new scenes", **style.LINES["rival"])
    left.axhline(98, label="book, training", **style.LINES["reference"])
    left.set(xlabel="Epoch", ylabel="Accuracy [%]")
    left.legend(loc="lower right")
    counts = recording.frames["confusion"].to_numpy()
    shares = counts / np.maximum(counts.sum(axis=1, keepdims=True), 1)
    right.imshow(shares, cmap="Blues", vmin=0, vmax=1)
    for i in range(3):
        for j in range(3):
            dark = shares[i, j] > 0.5
            right.text(j, i, str(counts[i, j]), ha="center", va="center", color="white" if dark else "black")
    right.set(xticks=range(3), yticks=range(3), xticklabels=NAMES, yticklabels=NAMES, xlabel="Found", ylabel="True")
    accuracy, missed = 100 * found["test_accuracy"], 100 * found["unsafe_called_safe"]  # type: ignore[operator]
    style.title(figure, f"New scenes: {accuracy:.0f} % right, {missed:.0f} % of unsafe grasps pass for safe")
    return figure


def _draw_example(recording: Recording) -> Any:
    from dexrepro.report import style

    figure, axes = style.subplots(width=style.ONE_COLUMN, height=2.7)
    axes.imshow(recording.images["scene"])
    grasps = recording.frames["grasps"]
    colours = (style.BOOK, style.RIVAL, style.PLAIN)
    best = int(grasps.score.argmax())
    for index, row in enumerate(grasps.to_dict("records")):
        u, v = ([row[f"{axis}{k % 4}"] for k in range(5)] for axis in "uv")
        found = int(row["found"])
        axes.plot(u, v, color=colours[found], linewidth=2.2 if index == best else 0.7)
    boundary = recording.frames["boundary"]
    axes.plot(boundary.u, boundary.v, label="safety region", **style.LINES["reference"])
    for colour, name in zip(colours, NAMES):
        axes.plot([], [], color=colour, label=f"found {name}")
    figure.legend(loc="outside lower center", ncols=2)
    axes.set_axis_off()
    right = float((grasps.found == grasps.true).mean())
    style.title(figure, f"{100 * right:.0f} % of this scene's grasps are told right")
    return figure


def tabulate(
    recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics], config: Config
) -> dict[str, pd.DataFrame]:
    tables = []
    for case, recording in recordings.items():
        table = recording.frames["confusion"].copy()
        table.insert(0, "true", list(NAMES)[: len(table)])
        table.insert(0, "patch", case)
        tables.append(table)
    return {"T3.F": pd.concat(tables)} if tables else {}
