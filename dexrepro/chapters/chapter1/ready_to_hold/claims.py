"""What the book says about ``ready_to_hold``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, every, greater, less, within

READY = "ready_to_hold"

CLAIMS = (
    Claim(
        "C1.18",
        "1.16",
        "AFR follows the moving object and does not touch it before DFR approaches.",
        every(less(f"{READY}.adjustable.lag_most", 0.05), greater(f"{READY}.adjustable.clearance", 0.03)),
        where="1.5.2.1",
        note="Both bounds are ours, and with other gains of the field, none of which is printed, it mostly exceeds one "
        "of them (study).",
    ),
    Claim(
        "C1.19",
        "1.16",
        "The adjustable weights are what lets AFR wait and then assist.",
        every(
            less(f"{READY}.constant.clearance", 0.0),
            less(f"{READY}.partner_only.clearance", 0.0),
            greater(f"{READY}.ready_only.clearance", 0.0),
            greater(f"{READY}.adjustable.clearance", 0.0),
        ),
        where="1.3.4",
        note="Constant weights, or the partner's field alone, press into the object before DFR comes; the other two "
        "fields alone never touch it.",
    ),
    Claim(
        "C1.20a",
        "1.16e",
        "AFR comes to the object when DFR does, and not before DFR approaches.",
        within(f"{READY}.adjustable.own_before_partner", -1.5, 1.5),
        where="1.5.2.1",
        note="Difference of the instants at which the two end points reach the surface [s].",
    ),
    Claim(
        "C1.20b",
        "1.16e",
        "AFR assists at the right time: not before DFR touches the object.",
        less(f"{READY}.adjustable.own_before_partner", 0.0),
        where="1.5.2.1",
        note="For any varpi below 2 the field lets AFR touch first: at a distance of r / (varpi - 1) > r. With varpi "
        "= 2, or with a third of the compliance, it touches after DFR (T1.E).",
    ),
    Claim(
        "C1.21",
        "1.16f",
        "AFR keeps facing and pointing to DFR while DFR rotates.",
        every(less(f"{READY}.adjustable.facing", 2.0), less(f"{READY}.adjustable.pointing", 10.0)),
        where="1.5.2.1",
        note="The tools' axes are opposite to well below 1 deg; the line between the hands lags by several degrees "
        "because the field follows DFR's rotation slowly.",
    ),
)
