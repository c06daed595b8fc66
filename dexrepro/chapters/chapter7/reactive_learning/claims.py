"""What the book says about ``reactive_learning``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Predicate, about, every, greater, less, ordered

LEFT = 0.1  # of the error without any node: what is there at once does not come gradually


def gradual(case: str) -> Predicate:
    """The error falls from stage to stage, and the first leaves a part of it to learn."""
    return every(
        ordered(*(f".{case}.rmse{groups}" for groups in (5, 2, 1))),
        greater(f".{case}.falling_draws", 0.99),
        greater(f".{case}.rmse1", f".{case}.no_reaction", LEFT),
    )


def to_the_floor(case: str) -> Predicate:
    return every(ordered(*(f".{case}.rmse{groups}" for groups in (8, 5, 2, 1))), less(f".{case}.rmse8", 0.015))


fig_7_8 = about("7.8", "7.4.1")
CLAIMS = (
    fig_7_8(
        "C7.10",
        "With 1, 2 and 5 groups of enhancement nodes the reactions are approached gradually.",
        gradual("frozen"),
        no_control="It is a matter of which weights are learned, and that is the reading.",
        printed=gradual("printed_sign"),
        readings={"the old nodes' weights fitted again (E7.06)": gradual("refit")},
        note="The old nodes keep their weights, as (7.17) and (7.18) say: of {.frozen.no_reaction:.2f} cm the first "
        "group leaves {.frozen.rmse1:.2f} cm. Fitted again, {.refit.rmse1:.3f} cm are left at once.",
    ),
    Claim(
        "C7.10b",
        "7.8",
        "One group leaves a visible error when the old nodes' weights are fitted again, too.",
        greater(".refit.rmse1", ".refit.spread"),
        source="ours",
        note="The old kernels alone already fit the reactions to {.refit.plain_refit:.1g} cm.",
    ),
    fig_7_8(
        "C7.11",
        "The final reactions represent the classes with minor errors.",
        less(".frozen.shown_rmse", ".frozen.spread"),
        control=less(".frozen.plain_equal5", ".frozen.spread"),
        credits="the enhancement nodes",
        printed=less(".printed_sign.shown_rmse", ".printed_sign.spread"),
        note="With five groups of enhancement nodes the error is {.frozen.shown_rmse:.2g} cm, with plain kernels of as "
        "many weights {.frozen.plain_equal5:.2g} cm, with the primitive's eight kernels alone "
        "{.frozen.plain_refit:.2g} cm; repetitions spread by {.frozen.spread:.2g} cm.",
    ),
    fig_7_8(
        "C7.12",
        "More enhancement nodes approach any trajectory.",
        to_the_floor("frozen"),
        control=less(".frozen.plain_equal8", 0.015),
        credits="the enhancement nodes",
        printed=to_the_floor("printed_sign"),
        where="Remark 7.2",
        note="Down to a floor of {.frozen.rmse8:.1g} cm, which the smoothing of the demonstrations sets; plain kernels "
        "with as many weights come to {.frozen.plain_equal8:.1g} cm. The bound is for the sensor noise chosen; with "
        "more of it the floor is higher.",
    ),
    fig_7_8(
        "C7.13",
        "Reactions keep start and end (to 1 mm).",
        less(".frozen.end_error5", 0.1),
        printed=less(".printed_sign.end_error5", 0.1),
        readings={
            "while they are being learned, too": every(less(".frozen.end_error1", 0.1), less(".frozen.end_error2", 0.1))
        },
        no_control="an attractor whose forcing fades ends at its goal: only half-learned or wrong forcing misses it",
        where="7.3.1",
        note="The final skill does; half-learned forcing terms do not fade in time: with one group of nodes the "
        "movement ends {.frozen.end_error1:.2g} cm off.",
    ),
    fig_7_8(
        "C7.14",
        "The ordinary skill is preserved beside the reactions.",
        less(".frozen.ordinary_change", 1e-9),
        by_construction="ordinary and reactive forcing terms are stored apart",
        where="7.4.3",
    ),
    fig_7_8(
        "C7.34",
        "The method realises life-long learning: what was learned stays.",
        less(".frozen.ordinary_change", 1e-9),
        by_construction="every condition has weights of its own, which nothing learned later touches",
        where="7.5",
        note="That it copes with more complex tasks no experiment of the chapter touches.",
    ),
)
