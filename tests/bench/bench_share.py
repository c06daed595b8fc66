"""A step of a book's case beside the engine's own step, both in the same run: what the laws and the loop cost.

Run by ``make bench``. The engine's share is the CPU time inside ``advance``; what is printed is microseconds a step of
both, and their ratio. As in a study, no pictures are drawn; modules that a case imports do not count.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import pytest

from dexrepro import chapters
from dexrepro.case import live, run
from dexrepro.cases import experiment_cases
from dexrepro.config import compose_chapter
from dexrepro.physics.engine import unseen
from dexrepro.physics.world import World

CASES = (
    "8/circle_tracking.broad", "3/fixed_opening.reach1", "4/skill_reuse.broad20", "4/payload_transfer.reuse",
    "7/impedance_tracking.muscle", "1/hold_and_move.t1_proposed", "2/movement_estimation.sigma10",
    "2/balloon_static.off_80",
)  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_a_cases_step_beside_the_engines(
    name: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    chapter, _, place = name.partition("/")
    experiment, case = place.split(".")
    spent: list[float] = []
    begin = World.__init__

    def timed(self: World, *arguments, **options) -> None:
        begin(self, *arguments, **options)
        advance: Callable[[], None] = self.scene.advance

        def measured() -> None:
            start = time.process_time()
            advance()
            spent.append(time.process_time() - start)

        self.scene.advance = measured

    monkeypatch.setattr(World, "__init__", timed)
    config = live({**experiment_cases(compose_chapter(chapter), experiment)[case], "perturbation": 0.0, "seed": 0})
    found = chapters.load(chapter).experiment(experiment)
    assert found.simulation  # imported before the clock starts: the first case would pay for all
    start = time.process_time()
    with unseen():
        run(found, config, 0)
    whole = time.process_time() - start
    with capsys.disabled():
        one, engine = 1e6 * whole / len(spent), 1e6 * sum(spent) / len(spent)
        print(f"\n{place:30s} {one:7.1f} us a step, the engine {engine:6.1f} us: {one / engine:4.1f} : 1")
    assert spent
