"""What the book says about ``grasp_classes``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Reference, greater, less

CLAIMS = (
    Claim(
        "C3.19",
        "3.C",
        "The classifier reaches a training accuracy of 98 % after 25 epochs.",
        greater(".wide.train_accuracy", 0.98),
        by_construction="Cornell's data, relabelled, is not available: synthetic scenes whose difficulty is ours.",
        where="3.4.2.3",
        note="With one seed of the network; fewer of the new scenes are told right (Fig. 3.C).",
        turns="trained in single precision; by construction",
    ),
    Claim(
        "C3.20",
        "3.C",
        "Grasps outside the safety region can be told from those inside: at most a tenth of them passes for safe.",
        less(".wide.unsafe_called_safe", 0.1),
        control=less(".narrow.unsafe_called_safe", 0.1),
        where="3.4.2.2",
        note="The control is a patch that does not reach beyond the safety margin, so that no wall "
        "is seen in it. It needs enough scenes, too: {.scenes} were taken after fewer had let more than a tenth pass.",
    ),
)
REFERENCES = (Reference(".wide.train_accuracy", 0.98, "3.4.2.3", "-"),)
