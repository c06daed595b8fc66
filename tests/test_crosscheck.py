"""One word chooses the engine, results know which it was, and the cross-check says what depends on it."""

import json
import re
from pathlib import Path

import pytest
from conftest import ROOT

from dexrepro import baselines, cli, crosscheck
from dexrepro.baselines import Baseline
from dexrepro.cache_key import uses_engine
from dexrepro.crosscheck import Comparison, Difference
from dexrepro.errors import InputError
from dexrepro.physics import engine
from dexrepro.plan import plan_chapter
from dexrepro.study import samples, sampling

ARMS, NONE = "arm_obstacles", "planar_skill"  # experiments of chapter 6 with simulated arms, and without


@pytest.fixture(autouse=True)
def chosen():
    yield
    engine.use(engine.default())


def plan(*words: str):
    found = {item.experiment: item for item in plan_chapter("6", [f"only=[{ARMS},{NONE}]", *words], write=False)[0]}
    return found[ARMS], found[NONE]


@pytest.mark.skipif(not engine.is_installed("pybullet"), reason="there is one engine")
def test_another_engine_is_another_result_where_arms_are_simulated():
    (arms, none), (other_arms, other_none) = plan(), plan("engine=mujoco")
    assert other_arms.differs == ["engine=mujoco"]
    assert other_arms.folder.parent.name == "runs"
    assert {job.folder for job in arms.jobs}.isdisjoint(job.folder for job in other_arms.jobs)
    assert not set(arms.contents.values()) & set(other_arms.contents.values())
    assert (none.folder, none.contents) == (other_none.folder, other_none.contents)
    assert plan("engine=pybullet")[0].contents == arms.contents
    assert not plan("engine=pybullet")[0].differs


def test_an_engine_that_there_is_not_is_refused(monkeypatch):
    with pytest.raises(InputError, match="engine = bullet is not allowed: it must be one of pybullet, mujoco"):
        plan("engine=bullet")
    monkeypatch.setattr("dexrepro.config.is_installed", lambda word: word == "pybullet")
    with pytest.raises(InputError, match="engine = mujoco needs MuJoCo, which is not installed here: pip install muj"):
        plan("engine=mujoco")


def test_where_pybullet_is_missing_the_book_is_simulated_by_mujoco(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for place in ("dexrepro.config.is_installed", "dexrepro.physics.engine.is_installed"):
        monkeypatch.setattr(place, lambda word: word == "mujoco")
    arms, _ = plan()
    assert (arms.folder.parent.name, arms.differs, arms.engine) == ("chapter6", [], "mujoco")
    assert all(job.config["engine"] == "mujoco" for job in arms.jobs)
    monkeypatch.setattr("dexrepro.runner.run_plans", lambda *_, **__: pytest.fail("ran"))
    with pytest.raises(pytest.fail.Exception):
        cli.main(["run", "chapter=6", f"only={ARMS}", "results=nowhere"])
    assert "PyBullet is not installed here" in capsys.readouterr().err
    with pytest.raises(InputError, match=f"baselines of {ARMS} are PyBullet's, which is not installed here"):
        baselines.update_chapter("6", Path("nowhere"), [ARMS, NONE], accept=[], workers=1)


def comparison(verdicts: tuple[str, str]) -> Comparison:
    return Comparison("2", "holding_line", "3.14", 10, [Difference("holding_line.a.x", 1.0, 2.0, None)],
                      {"C2.01": verdicts})  # fmt: skip


def test_a_number_matters_where_it_leaves_its_tolerance_and_the_study():
    assert Difference("a", 1.0, 2.0, None).matters
    assert Difference("a", 1.0, 2.0, (0.5, 1.5)).matters
    assert not Difference("a", 1.0, 1.4, (0.5, 1.5)).matters
    assert Difference("a", 1.0, None, (0.5, 1.5)).matters


def test_only_what_differs_from_the_baseline_is_reported(tmp_path):
    arms, _ = plan("engine=mujoco")
    stored = Baseline.of("6", ARMS)
    metrics = stored.values
    changed = next(name for name, value in metrics.items() if isinstance(value, float) and value)
    metrics[changed] *= 1.5
    (tmp_path / "metrics.json").write_text(json.dumps(metrics))
    found = crosscheck.compare(arms, tmp_path)
    assert [item.name for item in found.metrics] == [changed]
    assert found.compared == len(metrics)
    assert set(found.claims) == set(stored.claims)


def test_the_table_keeps_the_last_comparison_of_each_experiment(tmp_path):
    path = crosscheck.table(tmp_path)
    crosscheck.keep([comparison(("reproduced", "not reproduced"))], path)
    assert crosscheck.stored(path)[0].turned == ["C2.01"]
    crosscheck.keep([comparison(("reproduced", "reproduced"))], path)
    assert crosscheck.stored(path) == [comparison(("reproduced", "reproduced"))]
    assert crosscheck.verdicts(tmp_path)["C2.01"] == ("reproduced", "reproduced")
    path.write_text("[{}]")
    with pytest.raises(InputError, match="is no table of comparisons"):
        crosscheck.stored(path)


def test_where_no_arm_is_simulated_there_is_nothing_to_compare(command):
    status, said = command("crosscheck")
    assert (status, Path("results/crosscheck").exists()) == (cli.WRONG, False)
    assert "none of these experiments simulates arms" in said


def test_samples_of_another_engine_count_while_the_engines_agree(tmp_path, monkeypatch):
    for module in (crosscheck, samples, baselines):
        monkeypatch.setattr(module, "baseline_dir", lambda: tmp_path / "shipped")
    with pytest.raises(InputError, match="ask: dexrepro crosscheck chapter=2 only=holding_line"):
        sampling.run("2", "holding_line", 1, tmp_path, workers=1, engine="mujoco")
    sample = {"index": 0, "engine": "mujoco"}
    contents = samples.contents("2", "holding_line", sample)
    assert contents != samples.contents("2", "holding_line", {"index": 0})
    entries = [sample, {"index": 1}]
    for entry in entries:
        contents = samples.contents("2", "holding_line", entry)
        entry["cases"] = {case: {"content": content, "metrics": {}} for case, content in contents.items()}
    monkeypatch.setattr(samples, "all_samples", lambda *_: entries)
    for verdicts, counts in ((("reproduced", "reproduced"), True), (("reproduced", "not reproduced"), False)):
        crosscheck.keep([comparison(verdicts)], crosscheck.table(tmp_path))
        assert sampling.kept_samples("2", "holding_line", tmp_path).keys() == ({0, 1} if counts else {1})


def test_the_shipped_table_is_of_all_experiments_with_simulated_arms_and_of_claims_that_there_are():
    from dexrepro import chapters

    shipped = {item.experiment: item for item in crosscheck.stored(crosscheck.table(Path(), shipped=True))}
    simulated = {
        (experiment.name, number)
        for number in chapters.numbers()
        for experiment in chapters.load(number).experiments
        if uses_engine(experiment)
    }
    assert {(name, item.chapter) for name, item in shipped.items()} == simulated
    known = {claim.id for number in chapters.numbers() for claim in chapters.load(number).claims}
    assert {key for item in shipped.values() for key in item.claims} <= known


def test_the_manual_names_the_experiments_and_cases_whose_numbers_differ():
    page = (ROOT / "docs/how-to/engines.md").read_text("utf-8")
    rows = re.findall(r"^\| (.*?) \| (.*?) \|", page.partition("| experiment | numbers")[2], re.MULTILINE)[1:]
    shipped = crosscheck.stored(crosscheck.table(Path(), shipped=True))
    differ = {item.experiment: item.metrics for item in shipped if item.metrics}
    named = {name for experiments, _ in rows for name in re.findall(r"`(\w+)`", experiments)}
    assert named == set(differ)
    for experiments, numbers in rows:
        names = [entry.name for name in re.findall(r"`(\w+)`", experiments) for entry in differ[name]]
        for case in re.findall(r"`(\w+)`", numbers):
            assert any(name.split(".")[1].startswith(case) for name in names), (experiments, case)


@pytest.mark.parametrize(
    "item", crosscheck.stored(crosscheck.table(Path(), shipped=True)), ids=lambda item: item.experiment
)
def test_the_shipped_spreads_are_those_of_the_shipped_study(item: Comparison) -> None:
    spreads = crosscheck._spreads(item.experiment, [one.name for one in item.metrics])
    assert {one.name: one.spread for one in item.metrics} == spreads
