"""What the book says about ``relative_pose``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, less, within

CLAIMS = (
    Claim(
        "C1.09",
        "1.6",
        "Eq. (1.14) makes AFR face DFR for every orientation.",
        every(less(".default.facing", 1e-12), less(".default.euler", 1e-12)),
        no_control="An identity of unit quaternions; one orientation for which it failed would refute it.",
        where="Lemma 1.1",
    ),
    Claim(
        "C1.27",
        "1.6",
        "The quaternion rule is computationally efficient: it neither multiplies nor adds.",
        every(less(".default.multiplications", 0.5), less(".default.additions", 0.5)),
        by_construction="Eq. (1.14) is a permutation with two changes of sign.",
        where="1.3.3",
        note="The product with the quaternion of a half-turn, which it stands for, takes 16 multiplications and 12 "
        "additions in general.",
    ),
    Claim(
        "C1.11",
        "1.5",
        "Re-fixing makes no jump, and afterwards the tool turns as the leader does.",
        every(less(".default.fixing_jump", 1e-12), less(".default.fixing_rotation", 1e-12)),
        no_control="An identity: (1.11) at the instant of the fixing.",
        where="1.3.1",
    ),
    Claim(
        "C1.15",
        "1.15",
        "The scale grows with the hand's speed from 1 to 8.",
        every(
            within(".default.scale_least", 0.99, 1.01),
            within(".default.scale_most", 7.9, 8.1),
            less(".default.scale_steps_down", 0.5),
        ),
        where="Eq. (1.45)",
        by_construction="It is Eq. (1.45), evaluated.",
    ),
)
