"""Chapter 1: one leader and two followers hold and move an object."""

from dexrepro.chapters.chapter1 import (
    claims,
    dartboard,
    errata,
    force_tracking,
    hand_over,
    hold_and_move,
    lyapunov,
    ready_to_hold,
    relative_pose,
    rigid_boxes,
    sensitivity,
    two_nuts,
)
from dexrepro.experiment import Experiment

TITLE = "Single-leader dual-follower holding and moving of objects"
EXPERIMENTS = tuple(
    Experiment.of(module)
    for module in (
        force_tracking,
        lyapunov,
        relative_pose,
        two_nuts,
        dartboard,
        ready_to_hold,
        hand_over,
        rigid_boxes,
        hold_and_move,
        sensitivity,
    )
)
CLAIMS, REFERENCES = claims.CLAIMS, claims.REFERENCES
ERRATA = errata.ERRATA
