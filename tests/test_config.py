"""Each parameter says where it comes from, and every chapter's configuration composes."""

from __future__ import annotations

import copy
import re
from pathlib import Path

import pytest

from dexrepro import chapters
from dexrepro.cases import experiment_cases, resolved_block
from dexrepro.checks import check_sizes, is_number, leaves, set_value, value_at
from dexrepro.config import SETTINGS, compose_chapter
from dexrepro.errors import InputError
from dexrepro.interpolation import inherited, names_of
from dexrepro.overrides import selecting
from dexrepro.plan import plan_chapter
from dexrepro.provenance import (
    Provenance,
    commented_leaves,
    leaves_with_comments,
    parse_provenance,
    provenance,
    times_of,
)

CHAPTERS = (*chapters.numbers(), chapters.OWN)


def test_the_provenance_grammar() -> None:
    assert parse_provenance("N/m | printed 2.4.1.1") == Provenance("N/m", "printed", "2.4.1.1")
    assert parse_provenance("m | chosen: fits | 0.5..6e-1") == Provenance("m", "chosen", "fits", 0.5, 0.6)
    assert parse_provenance("- | derived: a/b | -1..+2").low == -1
    each = parse_provenance("1/s | chosen: open | -, 0.1..1, 2 .. 50")
    assert each.spans == (None, (0.1, 1.0), (2.0, 50.0))
    assert each.bounds == "-, 0.1 to 1, 2 to 50"
    assert (each.low, each.of("2").low, each.of("0").low, each.of("1").bounds) == (0.1, 2.0, None, "0.1 to 1")
    assert parse_provenance("khat_o(0) [N/m] | printed 2.4") == Provenance("N/m", "printed", "2.4", symbol="khat_o(0)")
    assert parse_provenance("- | chosen: open | one of a, b").words == ("a", "b")
    assert parse_provenance("- | chosen: open | drawn from a, b").drawn
    assert parse_provenance("- | printed Table 6.1 [16]").symbol is None
    assert parse_provenance("just a remark") is None
    assert parse_provenance("m | guessed") is None


def test_leaves_are_found_with_their_dotted_key() -> None:
    text = "a:\n  b: 1  # m | printed 1\n  c:\n    d: [1,\n      2]  # x\n  e: '#no' # y\nf: {g: 1}  # z\n"
    assert list(leaves_with_comments(text)) == [
        ("a.b", "1", "m | printed 1"),
        ("a.c.d", "[1,", ""),
        ("a.e", "'#no'", "y"),
        ("f", "{g: 1}", "z"),
    ]


@pytest.mark.parametrize("chapter", CHAPTERS)
def test_every_leaf_states_where_it_comes_from(chapter: str) -> None:
    silent = [
        key
        for key, value, comment in commented_leaves(chapter)
        if not key.rpartition(".")[2].startswith("_")
        and not key.endswith("inherits")
        and not value.startswith("${")
        and not parse_provenance(comment)
    ]
    assert not silent


@pytest.mark.parametrize("chapter", CHAPTERS)
def test_a_range_is_of_what_the_book_does_not_print_and_contains_the_value_or_all_of_a_list(chapter: str) -> None:
    composed = compose_chapter(chapter)
    for key, source in provenance(chapter).items():
        if source.low is not None and ".cases." not in key:
            assert source.kind != "printed", key
            for place, value in leaves(value_at(composed, key)):
                part = source.of(place)
                if part.low is not None and part.high is not None:
                    assert part.low < part.high, key
                    assert not is_number(value) or part.low <= value <= part.high, f"{key} {place}"


@pytest.mark.parametrize("chapter", CHAPTERS)
def test_every_case_of_a_chapter_composes(chapter: str) -> None:
    composed = compose_chapter(chapter)
    for experiment in chapters.load(chapter).experiments:
        assert experiment_cases(composed, experiment.name)


@pytest.mark.parametrize("chapter", CHAPTERS)
def test_the_parts_of_a_chapter_fit_together(chapter: str) -> None:
    loaded = chapters.load(chapter)
    composed = compose_chapter(chapter)
    names = {experiment.name for experiment in loaded.experiments}
    blocks = set(composed) - {"shared", "hydra", *SETTINGS}
    assert blocks == names
    for told in (loaded.claims, loaded.errata):
        assert len({item.id for item in told}) == len(told)
    figures = [figure for experiment in loaded.experiments for figure in experiment.figures]
    assert len(set(figures)) == len(figures)
    for claim in loaded.claims:
        assert {name.partition(".")[0] for name in claim.metrics} <= {claim.experiment}, claim.id
        assert claim.experiment in names | {""}, claim.id


def test_experiment_names_are_unique_in_the_book() -> None:
    names = [experiment.name for chapter in CHAPTERS for experiment in chapters.load(chapter).experiments]
    assert len(set(names)) == len(names)


def test_interpolations_mean_what_omegaconf_says_they_mean() -> None:
    from omegaconf import OmegaConf

    composed = compose_chapter("7")
    block = {key: value for key, value in composed["impedance_tracking"].items() if key != "cases"}
    names = {**names_of(composed), "impedance_tracking": block}
    whole = OmegaConf.to_container(OmegaConf.create(names)["impedance_tracking"], resolve=True)
    assert resolved_block(composed, "impedance_tracking") == whole


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ("${a.b}", 2), ("${c.b}", 2), ("${chain}", 2), ("${l.1}", 4), ("${l.0.b}", 3), ("${a}", {"b": 2}),
        ("x${a.b}", "x2"), ("${oc.select:a.z,5}", 5),
    ],
)  # fmt: skip
def test_interpolations_of_every_kind(value: str, expected: object) -> None:
    composed = {"a": {"b": 2}, "c": "${a}", "chain": "${c.b}", "l": [{"b": 3}, 4], "e": {"value": value}}
    assert resolved_block(composed, "e") == {"value": expected}


@pytest.mark.parametrize("chapter", CHAPTERS)
def test_the_books_interpolations_are_all_looked_up_fast(chapter: str, monkeypatch: pytest.MonkeyPatch) -> None:
    composed = compose_chapter(chapter)
    monkeypatch.setattr("omegaconf.OmegaConf.create", None)
    for experiment in chapters.load(chapter).experiments:
        experiment_cases(composed, experiment.name)


@pytest.mark.parametrize(("value", "word"), [("${nowhere.x}", "nowhere"), ("${e.value}", "e"), ("${l.2}", r"l\.2")])
def test_an_interpolation_that_leads_nowhere_is_refused(value: str, word: str) -> None:
    with pytest.raises(InputError, match=word):
        resolved_block({"l": [1, 2], "e": {"value": value}}, "e")


def test_cases_that_differ_in_case_alone_are_refused() -> None:
    with pytest.raises(InputError, match=r"e\.cases: 'A' and 'a' differ in case alone"):
        experiment_cases({"e": {"x": 1, "cases": {"a": {}, "A": {}}}}, "e")


def test_a_block_inherits_what_it_does_not_say_itself() -> None:
    composed = inherited(
        {
            "shared": {"law": {"_target_": "a.Law", "gain": 1.0, "bound": {"low": 0, "high": 2}}, "step": {"dt": 0.1}},
            "e": {
                "inherits": "shared.step",
                "law": {"inherits": "shared.law", "bound": {"high": 3}},
                "cases": {"a": {}},
            },
        }
    )
    assert composed["e"]["law"]["gain"] == "${shared.law.gain}"
    assert resolved_block(composed, "e") == {
        "dt": 0.1,
        "law": {"_target_": "a.Law", "gain": 1.0, "bound": {"low": 0, "high": 3}},
    }
    with pytest.raises(InputError, match=r"shared\.nothing"):
        inherited({"e": {"inherits": "shared.nothing"}})


def test_a_block_inherits_named_keys_of_another() -> None:
    shared = {"inherits": "base", "gain": 1.0, "bound": {"low": 0}}
    blocks = {"base": {"rate": 3.0, "lag": 0.1}, "shared": shared}
    found = inherited({**blocks, "e": {"inherits": ["base", {"shared": ["gain", "rate"]}], "gain": 2.0}})["e"]
    assert found == {"rate": "${shared.rate}", "lag": "${base.lag}", "gain": 2.0}
    with pytest.raises(InputError, match="shared has no 'gian': did you mean 'gain'"):
        inherited({**blocks, "e": {"inherits": {"shared": ["gian"]}}})
    with pytest.raises(InputError, match="does not inherit from this one"):
        inherited({"a": {"inherits": {"b": ["x"]}}, "b": {"inherits": {"a": ["x"]}}})
    with pytest.raises(InputError, match="a = 3 is not allowed: it must hold keys with values, which others inherit"):
        inherited({"a": 3, "b": {"inherits": "a"}})


@pytest.mark.parametrize(
    ("word", "sentence"),
    [
        ("letter_accuracy.kernels=3", "kernels = 3 is not allowed: it must hold keys with values"),
        ("~letter_accuracy.unit", "'letter_accuracy.unit' is inherited from another block and stays; set it to null"),
        ("letter_accuracy.kernels.width=0,6", "one number is written letter_accuracy.kernels.width=0.6"),
        ("letter_accuracy.kernels.counts=5,6", r"one list is written letter_accuracy.kernels.counts=\[5,6\]"),
        ("letter_accuracy.unit=mm,cm", "is a sweep, which needs -m, a run for each value$"),
        ("force_tracking.step=0.1", "'force_tracking.step' is of chapter 1, which is not selected"),
    ],
)
def test_an_override_that_cannot_be_is_one_sentence(word: str, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        compose_chapter("5", [word])


@pytest.mark.parametrize("value", ["5", "[5,0]", "[5.5]", "[]"])
def test_counts_are_a_list_of_whole_numbers(value: str) -> None:
    with pytest.raises(InputError, match=r"counts = .* is not allowed: it must be a list of whole numbers, each 1"):
        plan_chapter("5", ["only=letter_accuracy", f"letter_accuracy.kernels.counts={value}"], write=False)
    with pytest.raises(InputError, match=r"width_range = .* is not allowed: it must be \[LOW, HIGH\], low before high"):
        plan_chapter("5", ["only=letter_accuracy", "letter_accuracy.kernels.width_range=[2,1]"], write=False)


def test_an_inherited_key_can_be_overridden_there_and_where_it_comes_from() -> None:
    key = "barrier_and_switch.law.position_gain"
    assert resolved_block(compose_chapter("4", [f"{key}=7"]), "barrier_and_switch")["law"]["position_gain"] == 7
    there = compose_chapter("4", ["shared.two_link.position_gain=8"])
    assert resolved_block(there, "barrier_and_switch")["law"]["position_gain"] == 8
    assert resolved_block(there, "skill_reuse")["law"]["position_gain"] == 8


@pytest.mark.parametrize("chapter", chapters.numbers())
def test_every_parameter_that_is_a_word_declares_the_words_there_are(chapter: str) -> None:
    for key, value, comment in commented_leaves(chapter):
        word = re.fullmatch(r"['\"]?([A-Za-z]\w*)['\"]?", value)
        if not word or word[1] in ("true", "false", "null") or ".cases." in key or "inherits" in key or "._" in key:
            continue
        origin = parse_provenance(comment)
        assert origin, key
        assert word[1] in origin.words or comment.endswith("| any"), key


@pytest.mark.parametrize(
    ("chapter", "override", "sentence"),
    [
        ("6", "keep_out.cdmp.law=feedfoward", "must be one of feedforward, printed, consistent, lagged, filter, none"),
        ("3", "fixed_opening.task=poses", "fixed_opening.task = poses is not allowed: it must be one of position"),
        ("1", "+force_tracking.cases.mine={motion: sines}", "force_tracking.motion = sines"),
        ("1", "shared.planar.lengths=[0.5,0.3]", "force_tracking.arm: lengths has 2, masses has 3 values"),
        ("3", "fixed_opening.centre=[1,2]", "is not allowed: it must have 3 values"),
        ("5", "letter_accuracy.demonstrations=", "demonstrations = '' is not allowed: it must name a file or files"),
        ("5", "letter_accuracy.demonstrations=[]", "letter_accuracy.demonstrations = [] is not allowed"),
        ("5", "letter_accuracy.demonstrations=[a.csv,5]", "letter_accuracy.demonstrations.1 = 5 is not allowed"),
        ("5", "style_transformation.demonstrations={w: 5}", "style_transformation.demonstrations.w = 5 is not allowed"),
        ("6", "planar_skill.demonstrations.files=true", "planar_skill.demonstrations.files = True is not allowed"),
        ("5", "letter_accuracy.demonstrations=/dev/full", "it must be a file that can be read again, no pipe or devi"),
        ("own", "scene.leader.csv=", "scene.leader.csv = '' is not allowed: it must name a file or files of yours"),
    ],
)
def test_an_unknown_word_or_a_wrong_length_is_refused(chapter: str, override: str, sentence: str) -> None:
    with pytest.raises(InputError, match=re.escape(sentence)):
        plan_chapter(chapter, [override])


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["scene.gravity.2=-1.6"], r"'scene.gravity.2' lies in a list, which is given whole: 'scene.gravity=.….'"),
        (["scene.gravity.2.x=-1.6"], r"'scene.gravity.2.x' lies in a list, which is given whole: 'scene.gravity="),
        (
            ["scene.leader={poins: 3}"],
            r"unknown key 'scene.leader.poins': did you mean 'scene.leader.points'. .a new o",
        ),
        (["scene.servo.frequency=0"], "scene.servo.frequency = 0 is not allowed: it must be greater than 0"),
    ],
)
def test_what_a_word_cannot_set_is_said_by_its_whole_key(words: list[str], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        experiment_cases(compose_chapter("own", words), "scene")


def test_results_may_be_in_a_folder_of_any_name() -> None:
    composed = compose_chapter("2", selecting(Path("it's [mine], too"), ["holding_line"]))
    assert (composed["results"], composed["only"]) == ("it's [mine], too", ["holding_line"])


def test_no_length_of_time_or_count_of_any_experiment_makes_a_run_without_end() -> None:
    for chapter in chapters.numbers():
        composed = compose_chapter(chapter)
        for experiment in chapters.load(chapter).experiments:
            times = times_of(chapter, experiment.name)
            for values in experiment_cases(composed, experiment.name).values():
                check_sizes(values, times, experiment.name)
                for key, value in leaves(values):
                    last = key.rstrip(".0123456789").rpartition(".")[2]
                    if is_number(value) and (last.endswith(("duration", "durations")) or last == "samples"):
                        changed = copy.deepcopy(values)
                        set_value(changed, key, 1e300)
                        with pytest.raises(InputError, match=f"{experiment.name}.{key} = 1e.300 is not allowed"):
                            check_sizes(changed, times, experiment.name)
