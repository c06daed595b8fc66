"""What the book says about ``obstacle_contact``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import about, every, greater, less, within

ours_7_d = about("7.D", source="ours")
CLAIMS = (
    ours_7_d(
        "C7.31",
        "Variable impedance gives in softly to a constant force (by more than 0.1 mm at 0.5 N).",
        greater(".muscle.static_deviation", 0.1),
        note="A quotation that motivates the design. The estimation cancels a constant force.",
    ),
    ours_7_d(
        "C7.31b",
        "Without estimation it gives in by J (K k)^-1 J' F.",
        within(".muscle_plain.compliance_ratio", 0.9, 1.1),
    ),
    ours_7_d(
        "C7.32b",
        "Without estimation muscle-like impedance is softer before and stiffer behind the obstacle.",
        every(
            greater(".muscle_plain.before_push", ".mean_plain.before_push"),
            less(".muscle_plain.behind_push", ".mean_plain.behind_push"),
        ),
    ),
    ours_7_d(
        "C7.32c",
        "Muscle-like impedance lowers the force of an unexpected contact against a constant one.",
        less(".muscle_plain.contact_peak", ".mean_plain.contact_peak"),
        note="Without estimation. It stiffens where the obstacle is, so that it pushes harder there.",
    ),
    ours_7_d(
        "C7.32d",
        "With estimation the force of an unexpected contact depends on the impedance (by 5 %).",
        greater(".estimated_spread", 0.05),
        note="The arm follows its plan into the soft obstacle, whatever K is.",
    ),
)
