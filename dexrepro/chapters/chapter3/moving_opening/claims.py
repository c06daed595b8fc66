"""What the book says about ``moving_opening``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import about, every, greater, less

GRIPPER = "the gripper's length, by which only the straight tool lies at the opening, is ours"

fig_3_16 = about("3.16", "3.5.4")
ours_3_16 = about("3.16", source="ours")
CLAIMS = (
    fig_3_16(
        "C3.12",
        "The arm follows the moving opening (Dis_R below 10 mm) and touches neither lid nor box.",
        every(less(".track.moving_distance_max", 0.01), less(".track.contact_time", 1e-3)),
        by_construction=f"{GRIPPER}, and so is the hole's side (C3.02, C3.06); with shorter ones it may fail (study)",
    ),
    ours_3_16(
        "C3.12b",
        "With the tool axis left free it follows as well (Dis_R below 10 mm).",
        less(".pos.moving_distance_max", 0.01),
        note="A strong spring drives the arm into a joint limit (pos_strong).",
    ),
    fig_3_16(
        "C3.21",
        "The arm tracks the moving remote centre in real time (Dis_R below 10 mm).",
        less(".track.moving_distance_max", 0.01),
        control=less(".once.moving_distance_max", 0.01),
        readings={"told by a camera, a picture late": less(".late.moving_distance_max", 0.01)},
        by_construction=f"{GRIPPER} (C3.02, C3.12); with shorter ones it may fail (study)",
        where="3.6",
        note="In real time: from where the opening is now, without its path. The control is told once where it is "
        "({.once.moving_distance_max:.3f} m); a picture late the arm is up to {.late.moving_distance_max:.4f} m off. "
        "Whether a control step is computed within its period depends on the machine (`make bench`).",
    ),
    fig_3_16(
        "C3.13",
        "It is the null-space control that makes it follow (Dis_R below 10 mm).",
        less(".track.moving_distance_max", 0.01),
        control=less(".free.moving_distance_max", 0.01),
        credits="the null-space torque",
        note="Without it the mean Dis_R is {.default_ratio:.2f} times as large: as with the fixed "
        "opening, the orientation rule alone does it.",
    ),
    ours_3_16(
        "C3.13b",
        "Where the tool axis is left free, the null-space torque more than halves the mean Dis_R.",
        greater(".position_ratio", 2.0),
    ),
)
