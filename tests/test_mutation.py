"""The tool behind ``make mutation`` makes the wrong laws that it says it makes."""

from __future__ import annotations

import sys
from pathlib import Path

from conftest import ROOT

sys.path.insert(0, str(ROOT / "tests/mutation"))
import mutate

LAW = '''
class Law:
    gain: float = 3.0

    def step(self, x, low=7.0):
        """Not 9."""
        self.past[1:] = self.past[:-1]
        self.past[0] = x
        if x < low:
            raise ValueError(f"below {low + 1}")
        return -x * self.gain + 2.0
'''


def test_every_kind_of_change_is_made_once_and_leaves_the_rest_alone(tmp_path: Path) -> None:
    (tmp_path / "law.py").write_text(LAW)
    once, again = (list(mutate.mutants(tmp_path / "law.py")) for _ in range(2))
    assert [text for _, text, _ in once] == [text for _, text, _ in again]
    found = {text.partition("  [")[2][:-1] for _, text, _ in once}
    assert {"-x * self.gain + 2.0 -> -x * self.gain - 2.0", "-x * self.gain -> -x / self.gain", "-x -> +x"} <= found
    assert {"2.0 -> 3.0", "x < low -> x >= low", "self.past[0] = x -> pass"} <= found
    swapped = "self.past[1:] = self.past[:-1]; self.past[0] = x -> self.past[0] = x; self.past[1:] = self.past[:-1]"
    assert swapped in found
    assert not [text for text in found if "7.0" in text or "9" in text or "low + 1" in text or text.startswith("3.0")]


def test_a_mutant_runs_in_the_place_of_its_module(tmp_path: Path) -> None:
    (tmp_path / "law.py").write_text("def double(x):\n    return 2 * x\n")
    (tmp_path / "test_law.py").write_text("from law import double\n\ndef test_it():\n    assert double(3) == 6\n")
    sys.path.insert(0, str(tmp_path))
    try:
        path, tests = tmp_path / "law.py", [tmp_path / "test_law.py"]
        assert mutate.passes("law", path, None, tests, 60.0)
        assert not any(mutate.passes("law", path, code, tests, 60.0) for _, _, code in mutate.mutants(path))
    finally:
        sys.path.remove(str(tmp_path))


SCALED = """
unit = 2.0

def scaled(x):
    return [unit * item for item in x]
"""


def test_a_function_changes_where_it_is_and_the_rest_only_by_an_import(tmp_path: Path) -> None:
    path = tmp_path / "scaled.py"
    path.write_text(SCALED)
    old = compile(SCALED, str(path), "exec")
    names = {}
    exec(old, names)
    found = [(text, mutate.changed(old, code)) for _, text, code in mutate.mutants(path)]
    assert [text for text, function in found if function is None] == ["unit = 2.0  [2.0 -> 3.0]"]
    assert [function.co_name for _, function in found if function] == ["scaled"]
    names["scaled"].__code__ = found[1][1]
    assert names["scaled"]([4.0]) == [0.5]


def test_what_takes_too_long_counts_as_noticed() -> None:
    def forever() -> None:
        while True:
            pass

    assert mutate.in_a_process(lambda: 5, 10.0) == 5
    assert mutate.in_a_process(forever, 0.2) is None
