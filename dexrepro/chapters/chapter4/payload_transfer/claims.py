"""What the book says about ``payload_transfer``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Reference, every, less

P = "payload_transfer"

CLAIMS = (
    Claim(
        "C4.20",
        "4.12",
        "The prescribed performance is achieved on all nine trajectories.",
        less(f"{P}.reuse.max_usage", 1.0),
        where="4.6",
        note="The bound, 0.21 m shrinking to 0.10 m, is so wide that every method keeps it, even without a network.",
    ),
    Claim(
        "C4.21",
        "4.12",
        "The fixed network oscillates visibly during the whole process, the broad one does not.",
        every(
            *(
                less(f"{P}.reuse.{metric}", f"{P}.{case}.{metric}")
                for metric in ("oscillation_mm_s", "rmse_mm")
                for case in ("rbf_medium", "rbf_wide")
            )
        ),
        where="4.6",
        note="Three widths were tried: 0.3 gives no response (as without a network), 1.5 twice the error and "
        "oscillation (the rms rate of the error), 3 about a quarter more of both, no more than without a network.",
    ),
    Claim(
        "C4.22",
        "4.12",
        "Phase II lies far from the region of the fixed network, so that its training has little effect.",
        less(f"{P}.rbf_narrow.activation_phase2", 0.01),
        where="4.6",
        note="The printed box reaches none of the points A to F, so phase I too is outside; a frame or the reversed "
        "fourth interval may be read wrongly.",
    ),
    Claim(
        "C4.23",
        "4.12",
        "The broad network needs some tens of nodes (58 after phase I, 72 after II) instead of 16384.",
        every(
            less(f"{P}.reuse.nodes_phase1", f"{P}.reuse.nodes_phase2"),
            less(f"{P}.reuse.nodes_phase2", 163.84),
        ),
        where="4.6",
        note="The exact numbers depend on n, beta and the speed of the motion, which are not printed.",
    ),
    Claim(
        "C4.25",
        "4.12",
        "What was trained in phases I and II transfers to new trajectories.",
        every(
            less(f"{P}.reuse.rmse_mm", f"{P}.zero.rmse_mm"),
            less(f"{P}.frozen.rmse_mm", f"{P}.none.rmse_mm"),
        ),
        where="4.6",
        note="Mainly the payload's weight: with an empty hand the network changes nothing.",
    ),
    Claim(
        "C4.26",
        "4.12",
        "One set of controller parameters serves all tasks.",
        every(less(f"{P}.reuse.worst_rmse_mm", f"{P}.reuse.rmse_mm", 1.5), less(f"{P}.reuse.max_usage", 1.0)),
        where="Remark 4.3",
        note="The worst trajectory errs by less than 1.5 times the mean.",
    ),
)
REFERENCES = (
    Reference(f"{P}.reuse.nodes_phase1", 58, "4.6"),
    Reference(f"{P}.reuse.nodes_phase2", 72, "4.6"),
    Reference(f"{P}.rbf_medium.most_nodes", 16384, "4.6"),
)
