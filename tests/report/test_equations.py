"""The index from the book's equations to the lines of the code: every mention, ranges expanded, one look-up."""

from __future__ import annotations

from pathlib import Path

import pytest

from dexrepro.report import equations

LAW = """class Law:
    \"\"\"A law, Eqs. (2.16)-(2.18).

    Also Eq. (2.9), which
    holds from (3.1) to
    (3.3).
    \"\"\"

    def __call__(self, gain=(2.5), shape=(1.5, 2.5)):
        # the sign of
        # (2.21)
        return f"{gain}"


CLAIMS = [Claim("C2.07", "2.8", "It holds (2.30).", note="as (2.5) to " "(2.7)")]
ERRATA = [Erratum("E2.01", "(2.4), (2.8)", "slip", "A sign.")]
"""
CONF = """# @package holding
# Both follow (2.31).
gains:
  stiffness: 45  # N/m | printed (2.1)
cases:
  loud: {stiffness: "(2.2)"}  # - | chosen: (2.3) needs it
"""


@pytest.fixture(scope="module")
def mentions(tmp_path_factory) -> list[equations.Mention]:
    package = tmp_path_factory.mktemp("book") / "pack"
    package.mkdir()
    (package / "law.py").write_text(LAW)
    (package / "holding.yaml").write_text(CONF)
    return equations.index(package)


@pytest.fixture(scope="module")
def found(mentions) -> dict[str, tuple[str, str, int]]:
    return {m.equation: (m.kind, m.name, m.line) for m in mentions}


def test_each_mention_has_its_line_and_what_it_belongs_to(found) -> None:
    expected = {
        "2.1": ("parameter", "holding.gains.stiffness", 4),
        "2.3": ("parameter", "holding.cases.loud", 6),
        "2.4": ("erratum", "E2.01", 16),
        "2.9": ("code", "Law", 4),
        "2.21": ("code", "Law.__call__", 11),
        "2.30": ("claim", "C2.07", 15),
        "2.31": ("parameter", "holding.gains", 2),
    }
    assert {number: found[number] for number in expected} == expected


@pytest.mark.parametrize("inside", ["2.16", "2.17", "2.18", "3.1", "3.2", "3.3", "2.6"])
def test_ranges_are_expanded_over_line_ends_and_joined_texts(found, inside: str) -> None:
    assert inside in found


def test_numbers_of_the_program_are_no_equations(found, mentions) -> None:
    assert not {"1.5", "2.2"} & set(found)
    assert [m.kind for m in mentions if m.equation == "2.5"] == ["claim"], "a default in parentheses is none either"


def test_a_text_is_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "law.py").write_text('"""First. It follows Eq. (2.1); the rest does not.\n\nLast."""\n')
    (mention,) = equations.index(tmp_path)
    assert mention.text == "It follows Eq. (2.1)"


@pytest.mark.parametrize("number", ["6.13", "7.33", "3.14", "1.33", "5.47", "2.2"])
def test_an_equation_of_the_book_is_found_in_one_look_up(number: str) -> None:
    mentions = [mention for mention in equations.index() if mention.equation == number]
    assert mentions
    for mention in mentions:
        line = mention.path.read_text().splitlines()[mention.line - 1]
        assert f"({number.split('.')[0]}." in line, f"{mention.path}:{mention.line} names no equation of that chapter"


def test_the_index_covers_the_book() -> None:
    assert len({mention.equation for mention in equations.index()}) >= 275


def test_every_equation_of_the_book_is_typeset_and_most_are_cited() -> None:
    printed, cited = equations.printed(), {m.equation for m in equations.index() if m.equation[1] == "."}
    assert cited <= set(printed), "no line names an equation that the book has not"
    chapters = {
        name: [equations.place(other)[1] for other in printed if other.split(".")[0] == name] for name in "12345678"
    }
    assert all(sorted(numbers) == list(range(1, max(numbers) + 1)) for numbers in chapters.values()), "none is left out"
    assert len(set(printed) - cited) <= 20
    for name, (section, latex) in printed.items():
        typeset = equations.typeset(latex)
        assert section.startswith(name.split(".")[0])
        assert "\\" not in typeset, f"({name}) has a word that is not typeset"
        assert "<mi>&</mi>" not in typeset, f"({name}) has a column that is not aligned"
