"""Wall time of one step: the constrained primitive against the coupling terms of [16] and [39] (Sect. 6.5, point 3)."""

import time

import numpy as np
import pytest

from dexrepro.primitives.barrier import Constraint, Gains
from dexrepro.primitives.constrained import LAWS, Reference, Skill, rollout
from dexrepro.primitives.coupling import coupled_rollout, dynamic_potential, steering
from dexrepro.primitives.obstacles import Polygon

STEPS = 2000
BLOCK = Polygon(np.array([[9, 10.5], [13, 10.5], [11, 13.0]]))
LINE = np.linspace([17.0, 12.4], [5.0, 14.0], STEPS + 1)
STILL = np.zeros_like(LINE)
SKILL = Skill(STILL, LINE[-1], 5.0, nominal=STILL)
TERMS = {
    "steering, one point": lambda k, x, v: steering(x, v, BLOCK.centroid[None], 1000.0, 6.37),
    "steering, 30 points": lambda k, x, v: steering(x, v, BLOCK.boundary(30), 33.0, 6.37),
    "potential, closest point": lambda k, x, v: dynamic_potential(x, v, BLOCK.closest, 100.0, 2.0),
}
CASES = {
    "primitive alone": ("none", None),
    "constrained": ("feedforward", None),
    "constrained, projected": ("feedforward", 0.2),
    "safety filter": ("filter", None),
}


@pytest.mark.parametrize("name", [*CASES, *TERMS])
def test_time_of_a_step(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    start = time.perf_counter()
    if name in TERMS:
        path = coupled_rollout(SKILL, TERMS[name], 5.0 / STEPS, LINE[0], STILL[0])
        evaluations = 4 * STEPS
    else:
        law, projection = CASES[name]
        reference = Reference(LINE, np.broadcast_to(np.diff(LINE, axis=0)[0] * STEPS / 5.0, LINE.shape), STILL)
        tube = Constraint(True, 750.0)
        path = rollout(SKILL, reference, tube, Gains(), LAWS[law], 5.0 / STEPS, LINE[0], STILL[0], projection).position
        evaluations = STEPS
    spent = (time.perf_counter() - start) / evaluations
    with capsys.disabled():
        print(f"{name:26s} {1e6 * spent:7.1f} us an evaluation")
    assert np.isfinite(path).all()
