"""What the book says about ``ready_to_hold``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Predicate, every, greater, less, within


def _in_time(case: str) -> Predicate:
    return within(f".{case}.own_before_partner", -1.5, 1.5)


def _waits_and_assists(case: str) -> Predicate:
    return every(greater(f".{case}.clearance", 0.0), _in_time(case))


def _points(case: str) -> Predicate:
    return every(less(f".{case}.facing", 2.0), less(f".{case}.pointing", 10.0))


CLAIMS = (
    Claim(
        "C1.18",
        "1.16",
        "AFR follows the moving object and does not touch it before DFR approaches.",
        every(less(".adjustable.lag_most", 0.05), greater(".adjustable.clearance", 0.03)),
        control=every(less(".constant.lag_most", 0.05), greater(".constant.clearance", 0.03)),
        where="1.5.2.1",
        note="The control has constant weights. Both bounds are ours, and with other gains of the field, none of "
        "which is printed, it may exceed one of them (study).",
    ),
    Claim(
        "C1.19",
        "1.16",
        "The adjustable weights are what lets AFR wait and then assist.",
        _waits_and_assists("adjustable"),
        control=_waits_and_assists("constant"),
        credits="the adjustable weights (1.21)",
        where="1.3.4",
        note="It keeps clear until DFR approaches and reaches the surface within 1.5 s of it. With constant weights it "
        "presses in by {.constant.clearance:.3f} m before DFR comes, with the partner's field alone by "
        "{.partner_only.clearance:.3f} m; the other two fields alone keep clear and never touch.",
    ),
    Claim(
        "C1.20",
        "1.16e",
        "When DFR touches the object AFR assists in holding at the right time.",
        less(".adjustable.own_before_partner", 0.0),
        control=less(".constant.own_before_partner", 0.0),
        readings={"at the same time, within 1.5 s, as in C1.19": _in_time("adjustable")},
        searched="the tolerance in time, varpi and the compliance of the field",
        where="1.5.2.1",
        note="Right: when DFR touches, so not before. AFR comes {.adjustable.own_before_partner:.1f} s "
        "before it. For any varpi below 2 the field lets AFR touch first: at a distance of r / (varpi - 1) > r. With "
        "varpi = 2, or with a third of the compliance, it touches after DFR (T1.E).",
    ),
    Claim(
        "C1.21",
        "1.16f",
        "AFR keeps facing and pointing to DFR while DFR rotates.",
        _points("adjustable"),
        control=_points("unturned"),
        credits="the quaternion rule (1.14)",
        where="1.5.2.1",
        note="The tools' axes are opposite to within {.adjustable.facing:.2f} deg; the line between the "
        "hands lags by up to {.adjustable.pointing:.1f} deg because the field follows DFR's rotation "
        "slowly. The control keeps the orientation it starts with. With a smaller compliance of the field, which is "
        "not printed, it may lag by more than the bound (study).",
    ),
)
