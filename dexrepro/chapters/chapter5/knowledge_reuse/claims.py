"""What the book says about ``knowledge_reuse``, as predicates over its metrics."""

from __future__ import annotations

from dexrepro.chapters.chapter5.statements import TARGETS
from dexrepro.claims import Claim, Predicate, every, less


def begins_better(case: str, than: str = "anew") -> Predicate:
    return every(*(less(f".{case}.{letter}.early", f".{than}.{letter}.early") for letter in TARGETS))


CLAIMS = (
    Claim(
        "C5.20",
        "5.E",
        "Learned weights can be accumulated and reused: later letters begin with smaller errors.",
        begins_better("kept"),
        control=begins_better("integrator_kept", "integrator_anew"),
        printed=begins_better("printed_sign"),
        credits="the network's nodes, which grow in number",
        where="5.4.2, 5.5.4",
        note="The control is an integrator, one constant node at the same effective gain, that goes on from letter to "
        "letter: w begins with {.integrator_kept.w.early:.2f} mrad against {.integrator_anew.w.early:.2f} from zero, l "
        "with {.integrator_kept.l.early:.2f} against {.integrator_anew.l.early:.2f}; the network with "
        "{.kept.w.early:.2f} against {.anew.w.early:.2f} and {.kept.l.early:.2f} against {.anew.l.early:.2f}. One "
        "order of letters, and an adaptation gain chosen slow enough for the start of a letter to show it: a fifth of "
        "the gain used elsewhere.",
    ),
)
