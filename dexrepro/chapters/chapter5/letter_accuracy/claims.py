"""What the book says about ``letter_accuracy``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.claims import Claim, Predicate, every, greater, less

ACCURACY = "letter_accuracy.default"
PRINTED_SIGN = "letter_accuracy.printed_damping"
FEW_FEATURES = (
    "With 20 kernels the DMP+ stays ahead while fewer than about 25 features are added; the book does not print how "
    "many it adds. Narrow kernels, steep features or a regularised fit reverse the order as well (T5.S)."
)


def _both(
    statement: str, less_than: float | None = None, more_than: float | None = None
) -> tuple[Predicate, Predicate]:
    """A predicate on the learned letter and the same where the target has the printed sign of D v."""

    def predicate(case: str) -> Predicate:
        name = f"{case}.{statement}"
        return less(name, less_than) if less_than is not None else greater(name, more_than or 0.0)

    return predicate(ACCURACY), predicate(PRINTED_SIGN)


def _accuracy(identifier: str, statement: str, metric: str, note: str = "", **limit: float) -> Claim:
    corrected, printed = _both(metric, **limit)
    return Claim(identifier, "5.3", statement, corrected, printed=printed, where="5.5.1", note=note)


def improves(case: str) -> Predicate:
    return every(*(greater(f"{case}.{method}.improves", 0.8) for method in ("dmp", "dmp_plus", "idmp60")))


def limited_by_kernels(case: str) -> Predicate:
    return greater(f"{case}.n5.idmp60.mse", f"{case}.n20.idmp60.mse", factor=2.0)


def beyond_dmp_plus(case: str) -> Predicate:
    return less(f"{case}.n5.idmp60.mse", f"{case}.n5.dmp_plus.mse", factor=0.1)


def to_the_goal(case: str) -> Predicate:
    return every(*(less(f"{case}.n{n}.{m}.limit", 1e-3) for n in (5, 20) for m in ("dmp", "idmp60")))


CLAIMS = (
    _accuracy(
        "C5.01",
        "With 5 kernels a DMP tracks the letter badly: more than 5 % of its size.",
        "n5.dmp.mse",
        more_than=0.04,
    ),
    _accuracy(
        "C5.02",
        "The DMP+ reduces the error on the same 5 kernels markedly.",
        "n5.dmp_plus.ratio",
        less_than=0.2,
        note="Fitted by least squares like all others; fitted locally, the DMP+ loses (T5.S).",
    ),
    _accuracy("C5.03", "The IDMP improves on the DMP+ with 5 kernels.", "n5.idmp60.beats_dmp_plus", more_than=0.9),
    Claim(
        "C5.04",
        "5.3",
        "All methods are better with 20 kernels than with 5.",
        improves(ACCURACY),
        where="5.5.1",
        printed=improves(PRINTED_SIGN),
    ),
    _accuracy(
        "C5.05",
        "The IDMP is the best of the three with 20 kernels (60 added features).",
        "n20.idmp60.beats_dmp_plus",
        more_than=0.9,
        note=FEW_FEATURES,
    ),
    _accuracy(
        "C5.06",
        "With 20 kernels the IDMP's error is much lower: less than half of the DMP+'s.",
        "n20.idmp60.ratio",
        less_than=0.5,
        note="The tremor that the smoothing leaves in the letters is a floor for every method.",
    ),
    _accuracy("C5.07", "IDMP before DMP+ before DMP, with 5 kernels.", "n5.ordered", more_than=0.9),
    Claim(
        "C5.08",
        "5.3",
        "The IDMP is still limited by the number of initial kernels.",
        limited_by_kernels(ACCURACY),
        where="5.5.1, 5.5.4",
        printed=limited_by_kernels(PRINTED_SIGN),
    ),
    Claim(
        "C5.09",
        "5.A",
        "Adding features goes on lowering the error, where the DMP+ is stuck with its kernels.",
        every(
            less("letter_accuracy.largest_step_n5", 1.0),
            less("letter_accuracy.largest_step_n20", 1.0),
            beyond_dmp_plus(ACCURACY),
        ),
        where="Remark 5.2",
        printed=beyond_dmp_plus(PRINTED_SIGN),
        note="Not to any accuracy: double precision and remaining tremor end it near 1e-4 cm^2 with 5 kernels.",
    ),
    Claim(
        "C5.10",
        "5.A",
        "With 20 kernels the IDMP is better than a plain DMP with as many weights.",
        greater(f"{ACCURACY}.n20.idmp60.beats_dmp_equal", 0.5),
        source="ours",
        note="The book fixes the initial kernels, so this is no claim of its own.",
    ),
    Claim(
        "C5.29",
        "5.3",
        "The state converges to the goal.",
        to_the_goal(ACCURACY),
        where="5.3.1, (5.8)",
        printed=to_the_goal(PRINTED_SIGN),
        by_construction="every feature carries the factor s",
        note="As a limit, measured at ten times the duration. Soon after the end an IDMP without rest in its training "
        "data is tens of centimetres away (T5.S, no_rest); with rest it is within tenths of a millimetre.",
    ),
    _accuracy(
        "C5.30", "IDMP before DMP+ before DMP, with 20 kernels.", "n20.ordered", more_than=0.9, note=FEW_FEATURES
    ),
    Claim(
        "C5.31",
        "5.A",
        "With 5 kernels the IDMP is better than a plain DMP with as many weights.",
        greater(f"{ACCURACY}.n5.idmp60.beats_dmp_equal", 0.5),
        source="ours",
        note="There the advantage over the DMP is one of the number of weights.",
    ),
    Claim(
        "C5.32",
        "5.A",
        "The IDMP is better than a DMP+ with as many weights, with 5 and with 20 kernels.",
        every(*(greater(f"{ACCURACY}.n{n}.idmp60.beats_dmp_plus_equal", 0.5) for n in (5, 20))),
        source="ours",
    ),
)
