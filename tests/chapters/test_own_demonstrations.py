"""Demonstrations of the user's own: what they change, what is not defined for them, what cannot be used."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cases import case, rng

from dexrepro.case import generator
from dexrepro.chapters.chapter5 import crossing, letters
from dexrepro.chapters.chapter5.bounded_tracking import experiment as bounded_tracking
from dexrepro.chapters.chapter5.knowledge_reuse import experiment as knowledge_reuse
from dexrepro.chapters.chapter5.letter_accuracy import experiment as letter_accuracy
from dexrepro.chapters.chapter5.obstacle_crossing import experiment as obstacle_crossing
from dexrepro.chapters.chapter5.style_transformation import experiment as style_transformation
from dexrepro.chapters.chapter6.planar_skill import experiment as planar_skill
from dexrepro.chapters.chapter7 import desk, skills
from dexrepro.chapters.chapter7.reaching_demonstrations import experiment as reaching_demonstrations
from dexrepro.chapters.chapter7.reactive_learning import experiment as reactive_learning
from dexrepro.errors import InputError
from dexrepro.humans.handwriting import LETTERS
from dexrepro.plan import plan_chapter
from dexrepro.provenance import provenance


def configured(chapter: str, experiment: str, name: str, *overrides: str) -> Any:
    return case(chapter, experiment, name, *(f"{experiment}.{text}" for text in overrides))


@pytest.fixture(autouse=True)
def recordings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    share = np.linspace(0, 1, 60)
    progress = share**3 * (10 - 15 * share + 6 * share**2)
    for name, columns in {
        "letter": (20 + 10 * np.sin(2 * np.pi * progress), 40 * progress),
        "over": (12 * progress - 6, 0 * share, 5 * np.sin(np.pi * share)),
        "back": (30 + 0 * share, 20 + 0 * share, 5 * np.sin(np.pi * share)),
    }.items():
        np.savetxt(f"{name}.csv", np.column_stack([0.7 * share, *columns]), delimiter=",")


def test_a_recorded_letter_keeps_its_ends_and_its_shape() -> None:
    config = configured("5", "letter_accuracy", "default", "demonstrations=letter.csv", "unit=mm")
    first, second = letters.demonstrations("A", config.demonstrations, 2, config, None)
    assert np.array_equal(first.position, second.position)
    assert first.duration == config.dmp.duration
    assert first.position.shape == (config.dmp.samples, 2)
    assert first.start == pytest.approx([2, 0], abs=1e-9)
    assert first.goal == pytest.approx([2, 4], abs=1e-9)
    assert np.ptp(first.position[:, 0]) == pytest.approx(2.0, abs=0.05)


def test_what_is_said_of_files_is_refused_where_none_is_named() -> None:
    said = "letter_accuracy.unit has no effect: no file is named by letter_accuracy.demonstrations"
    with pytest.raises(InputError, match=said):
        plan_chapter("5", ["only=letter_accuracy", "letter_accuracy.unit=mm"], write=False)
    plan_chapter("5", ["only=letter_accuracy", "shared.files.unit=mm"], write=False)  # for the others of the chapter
    named = "+letter_accuracy.cases.mine={demonstrations: letter.csv}"
    plan_chapter("5", ["only=letter_accuracy", "letter_accuracy.unit=mm", named], write=False)


def test_only_the_crossings_with_files_are_recorded() -> None:
    config = configured("5", "obstacle_crossing", "default", "demonstrations={1: over.csv}")
    rng = generator(0, "obstacle_crossing", "demonstration")
    one, two = (crossing.repetitions(blocks, config, rng) for blocks in (1, 2))
    assert np.ptp(one, axis=0).max() == 0
    assert np.ptp(two, axis=0).max() > 0


def test_the_printed_amplitude_is_not_evaluated_where_it_is_not_defined() -> None:
    config = configured("5", "obstacle_crossing", "printed_amplitude", "demonstrations={1: over.csv}")
    recording = obstacle_crossing.simulate(config, rng("obstacle_crossing"))
    assert "not defined" in recording.status
    assert obstacle_crossing.measure(recording, config) == {}


@pytest.mark.parametrize(
    ("files", "sentence"),
    [
        ("over.csv", r"demonstrations: they go from \(-6, 0\) to \(6, 0\) cm instead of from \(2.3, 0\) to \(20, 9\)"),
        ("letter.csv", "demonstrations: 'letter.csv': line 1 has 3 numbers; it must have time, x, y, z"),
        ("no*.csv", r"demonstrations: cannot read 'no\*.csv'"),
        ("back.csv", r"demonstrations: their start and their goal are the same place, \(30, 20\) cm"),
    ],
)
def test_a_reach_that_cannot_be_used_gets_one_sentence(files: str, sentence: str) -> None:
    config = configured("7", "reaching_demonstrations", "corrected", f"demonstrations={files}")
    with pytest.raises(InputError, match=sentence):
        skills.demonstrate(config)


@pytest.mark.parametrize("part", ["scene", "task"])
def test_a_reach_to_where_it_begins_is_refused(part: str) -> None:
    config = case("7", "fuzzy_generalisation", "main", f"shared.{part}.goal=${{shared.{part}.start}}")
    with pytest.raises(InputError, match=rf"{part}\.goal = .* is not allowed: it must be another place than {part}"):
        skills.reach(config, part)


@pytest.mark.parametrize("goal", [(-6.0, 3.0), (30.0, 15.0), (1.0, -9.0)])
@pytest.mark.parametrize("desk", [0.0, 75.0])
def test_a_reach_on_another_desk_is_learned_after_following_the_refusal(goal: tuple[float, float], desk: float) -> None:
    share = np.linspace(0, 1, 60)
    progress = (share**3 * (10 - 15 * share + 6 * share**2))[:, None]
    path = np.array([40.0, 10.0, desk]) + progress * (*goal, 0.0) + np.sin(np.pi * share)[:, None] * (0, 0, 1)
    np.savetxt("desk.csv", np.column_stack([share, path]), delimiter=",")
    overrides = ["reaching_demonstrations.demonstrations=desk.csv"]

    def attempt() -> Any:
        return skills.demonstrate(case("7", "reaching_demonstrations", "corrected", *overrides))

    for _ in range(2):
        with pytest.raises(InputError, match=r"set (shared\.scene\.start=.*)") as refused:
            attempt()
        words = str(refused.value).partition("; set ")[2].split()
        overrides += words[:2] if len(overrides) == 1 else words[2:]
    ordinary, reactions = attempt()
    assert ordinary[:, -1] == pytest.approx(np.array([[40 + goal[0], 10 + goal[1], 0.0]] * len(ordinary)), abs=0.2)
    assert np.isfinite(reactions).all()


def test_the_arm_stands_before_a_reach_elsewhere_and_is_not_shown_where_that_is_too_long() -> None:
    elsewhere = skills.moved_scene((30, 20), (50, 30)).split()
    config = case("7", "reaching_demonstrations", "corrected", *elsewhere)
    assert len(reaching_demonstrations.simulate(config, rng("reaching_demonstrations")).images) == 5
    assert np.array_equal(desk.before_arm(np.ones(3), case("7", "reaching_demonstrations", "corrected")), np.ones(3))
    config = case("7", "reaching_demonstrations", "corrected", "shared.scene.goal=[80,36]", "shared.scene.far=[40,18]")
    with pytest.warns(UserWarning, match=r"the arm is not shown: .* out of the arm's reach of 0\.267 m"):
        assert not reaching_demonstrations.simulate(config, rng("reaching_demonstrations")).images


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ("height", "they end 5 cm above their start"),
        ("spread", "their starts, or their goals, lie more than 1 cm from their mean"),
    ],
)
def test_reaches_that_do_not_begin_and_end_together_get_one_sentence(change: str, sentence: str) -> None:
    share = np.linspace(0, 1, 60)[:, None]
    for number in (1, 2):
        path = (2.3, 0, 0) + share * (17.7 + 4 * number * (change == "spread"), 9, 5 * (change == "height"))
        np.savetxt(f"reach{number}.csv", np.column_stack([share, path]), delimiter=",")
    config = configured("7", "reaching_demonstrations", "corrected", "demonstrations=reach*.csv")
    with pytest.raises(InputError, match=sentence):
        skills.demonstrate(config)


def write_reach(name: str, aside: float, goal: tuple[float, float] = (20.0, 9.0)) -> None:
    share = np.linspace(0, 1, 80)
    progress = (share**3 * (10 - 15 * share + 6 * share**2))[:, None]
    path = (2.3, 0, 0) + progress * (goal[0] - 2.3, goal[1], 0) + np.sin(np.pi * share)[:, None] ** 3 * (0, aside, 2)
    np.savetxt(name, np.column_stack([share, path]), delimiter=",")


def test_recorded_reactions_are_learned_in_the_place_of_the_synthetic_ones() -> None:
    write_reach("left.csv", 6.0)
    config = configured("7", "reactive_learning", "frozen", "reactions={close_low_left: left.csv}", "draws=1")
    recording = reactive_learning.simulate(config, rng("reactive_learning"))
    demonstrated = recording["demonstrations"].reshape(len(recording.time), 3, -1, 3)
    assert np.ptp(demonstrated[:, 0], axis=1).max() == pytest.approx(0, abs=1e-9)  # one file takes every turn
    assert np.ptp(demonstrated[:, 1], axis=1).max() > 0.01
    share = np.linspace(0, 1, len(recording.time))
    assert demonstrated[len(share) // 2, 0, 0, 1] == pytest.approx(4.5 + 6.0, abs=0.1)
    assert reactive_learning.measure(recording, config)["rmse5"] < 0.5


@pytest.mark.parametrize(
    ("name", "goal", "sentence"),
    [
        ("close_low_lift", (20.0, 9.0), "reactions: unknown condition 'close_low_lift': did you mean 'close_low_left'"),
        ("close_low_left", (30.0, 9.0), r"reactions.close_low_left: they go from \(2.3, 0\) to \(30, 9\) cm instead"),
    ],
)
def test_a_reaction_that_cannot_be_used_gets_one_sentence(name: str, goal: tuple[float, float], sentence: str) -> None:
    write_reach("left.csv", 6.0, goal)
    config = configured("7", "reactive_learning", "frozen", f"reactions={{{name}: left.csv}}")
    with pytest.raises(InputError, match=sentence):
        reactive_learning.taught(config)


@pytest.mark.parametrize(
    ("simulate", "experiment", "given", "sentence"),
    [
        (style_transformation.simulate, "style_transformation", "q", "'q': there are: a, w"),
        (obstacle_crossing.simulate, "obstacle_crossing", "4", "'4': there are: 1, 2, 3"),
        (obstacle_crossing.simulate, "obstacle_crossing", "one", "'one': there are: 1, 2, 3"),
    ],
)
def test_a_demonstration_that_nothing_learns_from_is_refused(
    simulate: Any, experiment: str, given: str, sentence: str
) -> None:
    config = configured("5", experiment, "default", f"demonstrations={{{given}: over.csv}}")
    with pytest.raises(InputError, match=f"demonstrations: there is none of {sentence}"):
        simulate(config, rng(experiment))


@pytest.mark.parametrize(
    ("simulate", "experiment", "given", "must"),
    [
        (style_transformation.simulate, "style_transformation", "demonstrations=over.csv", "{a: FILE, ...}"),
        (obstacle_crossing.simulate, "obstacle_crossing", "demonstrations=[over.csv]", "{1: FILE, ...}"),
        (reactive_learning.taught, "reactive_learning", "reactions=over.csv", "{far_tall_left: FILE, ...}"),
        (letter_accuracy.simulate, "letter_accuracy", "demonstrations={a: letter.csv}", "a file or a list of files"),
        (letter_accuracy.simulate, "letter_accuracy", "demonstrations=[[letter.csv]]", "a file or a list of files"),
        (letter_accuracy.simulate, "letter_accuracy", "demonstrations=[null]", "a file or a list of files"),
        (planar_skill.simulate, "planar_skill", "map.block_file={a: block.csv}", "a file or a list of files"),
        (letter_accuracy.simulate, "letter_accuracy", "hand.letter=B", "one of A, a, z, l, k, w"),
        (letter_accuracy.simulate, "letter_accuracy", "hand.letter=[A,B]", "one of A, a, z, l, k, w"),
        (style_transformation.simulate, "style_transformation", "hand.targets=[w,7]", "a list of letters"),
        (style_transformation.simulate, "style_transformation", "hand.base=B", "one of A, a, z, l, k, w"),
        (bounded_tracking.simulate, "bounded_tracking", "hand.base=B", "one of a, w, z, k, l, A"),
        (bounded_tracking.simulate, "bounded_tracking", "hand.letters=null", "a list of letters"),
        (knowledge_reuse.simulate, "knowledge_reuse", "hand.sequence=[a,B]", "one of a, w, z, k, l, A"),
    ],
)
def test_what_a_key_does_not_take_gets_one_sentence(simulate: Any, experiment: str, given: str, must: str) -> None:
    chapter = {"planar_skill": "6", "reactive_learning": "7"}.get(experiment, "5")
    name = {"planar_skill": "book", "reactive_learning": "frozen", "bounded_tracking": "pd", "knowledge_reuse": "kept"}
    config = configured(chapter, experiment, name.get(experiment, "default"), given)
    key = given.partition("=")[0]
    with pytest.raises(InputError, match=rf"^{key} = .* is not allowed: it must be {re.escape(must)}$"):
        simulate(config, *([rng(experiment)] if simulate.__name__ == "simulate" else []))


def write_drawing(turn: float = 0.0) -> None:
    """A drawing down, a pause, and across a block, and that block; about the origin, turned by an angle [rad]."""
    share = np.linspace(0, 1, 80)
    progress = (share**3 * (10 - 15 * share + 6 * share**2))[:, None]
    down, across = (30, 20) + progress * (0, -12), (30, 8) + progress * (-24, 0)
    path = np.concatenate([down, np.repeat(down[-1:], 8, axis=0), across + np.sin(np.pi * share)[:, None] * (0, 0.5)])
    about = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    np.savetxt("drawing.csv", np.column_stack([np.arange(len(path)) / 20, path @ about.T]), delimiter=",")
    block = np.array([(16, 6.5), (19, 6.5), (19, 9), (16, 9)]) @ about.T
    np.savetxt("block.csv", block, delimiter=",", header="x [cm], y [cm]")
    np.savetxt("wall.csv", np.array([(0, 2), (34, 2), (34, 3), (0, 3)]) @ about.T, delimiter=",")


def planar(*overrides: str) -> tuple[Any, Any]:
    own = ["demonstrations.files=drawing.csv", "map.block_file=block.csv", "map.obstacle_files=wall.csv", *overrides]
    config = configured("6", "planar_skill", "book", *own)
    return config, planar_skill.simulate(config, rng("planar_skill"))


@pytest.mark.parametrize("turn", [0.0, 1.2, 3.0])
def test_a_drawing_of_ones_own_is_led_round_ones_own_block_after_following_the_refusal(turn: float) -> None:
    write_drawing(turn)
    with pytest.raises(InputError, match=r"does not lead round the new block; set (planar_skill\.ref.*)") as refused:
        planar()
    words = str(refused.value).partition("; set ")[2].replace("planar_skill.", "").split()
    config, recording = planar(*words)
    metrics = planar_skill.measure(recording, config)
    assert metrics["clearance_new_max"] < 0 < metrics["clearance_reference_min"]
    assert "segmentation_error_max" not in metrics  # nobody says where the person paused
    assert metrics["pauses_fewest_min"] == 1


@pytest.mark.parametrize("size", [0.1, 1.0, 10.0])
@pytest.mark.parametrize(("key", "file"), [("map.block_file", "block.csv"), ("map.block", "null")])
def test_a_drawing_elsewhere_is_led_round_a_block_after_the_refusals(size: float, key: str, file: str) -> None:
    write_drawing()
    drawing = np.loadtxt("drawing.csv", delimiter=",")
    np.savetxt("drawing.csv", np.column_stack([drawing[:, 0], (500, 300) + size * drawing[:, 1:]]), delimiter=",")
    overrides = [f"map.block_file={file}"]
    for named in (key, "reference.arc"):
        with pytest.raises(InputError, match=rf"^{named}: .*; set planar_skill") as refused:
            planar(*overrides)
        overrides += str(refused.value).partition("; set ")[2].replace("planar_skill.", "").split()
    assert planar_skill.measure(planar(*overrides)[1], None)["clearance_reference_min"] > 0


@pytest.mark.parametrize(
    ("name", "text", "sentence"),
    [
        ("block.csv", "1,2\n3,4\n", "map.block_file: 'block.csv': it has no area; it must hold the corners"),
        ("block.csv", "1,2\n3,x\n4,5\n", "map.block_file: 'block.csv': line 2 holds '3,x'"),
        ("block.csv", "60,60\n62,60\n62,62\n", "must lie across the second of the two sub-skills"),
        ("drawing.csv", "1,2\n3,4\n", "demonstrations: 'drawing.csv': it has no row of numbers"),
    ],
)
def test_a_map_that_cannot_be_used_gets_one_sentence(name: str, text: str, sentence: str) -> None:
    write_drawing()
    Path(name).write_text(text)
    with pytest.raises(InputError, match=sentence):
        planar()


@pytest.mark.parametrize("key", ["letter_accuracy.hand.letter", "style_transformation.hand.base"])
def test_the_configuration_names_the_letters_that_the_synthetic_hand_writes(key: str) -> None:
    assert provenance("5")[key].text.endswith(f"the synthetic hand writes {', '.join(LETTERS)}")
