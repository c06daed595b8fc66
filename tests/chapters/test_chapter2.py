"""The two arms of chapter 2: what the follower may know, and what the printed equations do."""

from __future__ import annotations

from functools import partial
from types import SimpleNamespace
from typing import Any

import cases
import numpy as np
import pandas as pd
import pytest

from dexrepro import baselines, chapters
from dexrepro.chapters.chapter2 import balloon_pair, batch, planar_pair
from dexrepro.chapters.chapter2.balloon_movement import experiment as balloon_movement
from dexrepro.chapters.chapter2.balloon_static.figures import _off
from dexrepro.chapters.chapter2.holding_line import experiment as holding_line
from dexrepro.chapters.chapter2.holding_sensitivity.experiment import margins_of
from dexrepro.chapters.chapter2.movement_estimation import experiment as movement_estimation
from dexrepro.chapters.chapter2.movement_estimation.figures import _of_one_period
from dexrepro.experiment import Config
from dexrepro.plan import plan_chapter

case = partial(cases.case, "2")


def logged(controller: Any) -> tuple[Any, list[Any]]:
    log: list[Any] = []

    def listening(sense: Any) -> Any:
        command = controller(sense)
        log.append((sense.time, sense.angles, sense.rates, sense.felt, list(command)))
        return command

    return listening, log


@pytest.mark.parametrize("name", ["s2", "s4", "s6", "s8", "impedance_8"])
def test_follower_commands_depend_on_its_own_measurements_alone(name: str) -> None:
    """One log of measurements gives the same torques whatever partner and object stand behind it."""
    config = case("holding_comparison", name, duration=0.4)
    follower, log = logged(planar_pair.Follower(config, config.laws[config.controller]))
    with planar_pair.scene(config) as world:
        world.run(config.duration, {"leader": planar_pair.Leader(config), "follower": follower})
    other = case("holding_comparison", name, stiffness=80, rest_length=0.7, leader__trajectory=2, leader__amplitude=0.3)
    replayed = planar_pair.Follower(other, other.laws[other.controller])
    for time, angles, rates, felt, command in log:
        sense = SimpleNamespace(time=time, angles=angles, rates=rates, felt=felt)
        assert list(replayed(sense)) == command


def test_lateral_offset_closes_with_the_predicted_time_constant() -> None:
    config = case("holding_line", "case1_with", duration=2.5)
    run = holding_line.simulate(config, None)
    offset = np.abs(run["follower.tip"][:, 1] - run["leader.tip"][:, 1])
    late = run.between(1.0, 2.0)
    rate = -np.polyfit(run.time[late], np.log(offset[late]), 1)[0]
    assert 1 / rate == pytest.approx(0.52, rel=0.05)


def test_a_spring_of_constant_direction_makes_the_printed_sign_diverge() -> None:
    printed = case("holding_line", "constant_vector", duration=2.0)
    reversed_sign = case("holding_line", "constant_vector_reversed", duration=2.0)
    assert holding_line.simulate(printed, None).status.startswith("diverged")
    assert holding_line.simulate(reversed_sign, None).status == "finished"


def test_fast_stiffness_rates_end_by_the_explicit_step_whatever_the_floor() -> None:
    ends = {}
    for implicit, floor in ((False, 1.0), (False, 20.0), (True, 1.0)):
        config = case("movement_estimation", "fast_stiffness", duration=4.0)
        config.law.estimation.implicit, config.law.estimation.floor = implicit, floor
        run = movement_estimation.simulate(config, None)
        ends[implicit, floor] = run.status.partition(" ")[0], run["estimate"][:, 1].min()
    assert ends[False, 1.0][0] == ends[False, 20.0][0] == "diverged"
    assert ends[True, 1.0][0] == "finished"
    assert ends[True, 1.0][1] > 20.0
    # So no run shows what E2.07 warns of, and no override selects it.
    (erratum,) = (item for item in chapters.load("2").errata if item.id == "E2.07")
    assert not erratum.switch
    assert "E2.02" in erratum.summary


def test_batched_plant_and_world_agree() -> None:
    config = case("holding_comparison", "s8", duration=1.0)
    world = planar_pair.simulate(Config({**config, "law": config.laws["impedance"]}))
    study = case("holding_sensitivity", "all")
    (row,) = (row for row in batch.table_rows(study.run) if row["run"] == "s8")
    errors = batch.simulate_runs(pd.DataFrame([row]), study, edges=[0.0, 0.5, 1.0])
    expected = np.mean((world["object.force"][world.between(0.5)] - 1.0) ** 2)
    assert errors["square_1"].iloc[0] == pytest.approx(expected, rel=1e-3)


def test_a_diverged_batched_run_is_no_number() -> None:
    study = case("holding_sensitivity", "all")
    (row,) = (row for row in batch.table_rows({**study.run, "kp_scale": 6.0}) if row["run"] == "s4")
    errors = batch.simulate_runs(pd.DataFrame([row]), study, edges=[0.0, 0.5])
    assert np.isnan(errors["square_0"].iloc[0])


def test_the_table_has_its_eighteen_runs() -> None:
    rows = pd.DataFrame(batch.table_rows(case("holding_sensitivity", "all").run)).set_index("run")
    assert list(rows.index) == [f"s{n}" for n in range(1, 19)]
    assert (rows["regulation"] > 0).tolist() == [False, True] * 9
    assert rows.loc["s1", "law"] == "force"
    assert rows.loc["s15", ["trajectory", "desired_force", "mass"]].tolist() == [2, 7.0, 0.0]
    assert rows.loc["s18", "mass"] == 0.01


def test_a_variant_that_swaps_two_laws_flips_their_verdict() -> None:
    numbers = {f"s{n}": 1.0 / n for n in range(1, 19)}
    rows = [
        {"variant": variant, "run": run, **dict.fromkeys(("rmse_0", "rmse_5", "rmse_10", "rmse_20"), value)}
        for variant, values in (("default", numbers), ("worse", {"s8": 9.0}))
        for run, value in values.items()
    ]
    margins = margins_of(pd.DataFrame(rows))
    assert margins["default"]["C2.19"] > 0 > margins["worse"]["C2.19"]


def test_the_path_on_baxter_is_a_line_then_closed_laps() -> None:
    shape = case("balloon_movement", "proposed").path
    assert balloon_movement.path(shape, 0.0) == pytest.approx(np.zeros(3))
    assert balloon_movement.path(shape, 18.0) == pytest.approx(shape.line)
    assert balloon_movement.path(shape, 44.0) == pytest.approx(shape.line)
    places = np.array([balloon_movement.path(shape, t) for t in np.arange(0, 44, 0.01)])
    assert np.abs(np.diff(places, axis=0)).max() < 5e-4
    assert np.ptp(places[2000:, 2]) == pytest.approx(2 * shape.radius, rel=1e-3)


def test_tremor_has_the_size_asked_for() -> None:
    tremor = balloon_movement.Tremor(5e-4, np.random.default_rng(1))
    places = np.array([tremor(t) for t in np.arange(0, 200, 0.05)])
    assert places.std(axis=0) == pytest.approx(5e-4, rel=0.15)


def test_the_follower_on_baxter_waits_for_contact_and_then_holds() -> None:
    config = case("balloon_static", "off_80", duration=0.3)
    run = balloon_pair.run(config, lambda purpose: np.random.default_rng(0), lambda t: np.zeros(3))
    before = run.time < -0.05
    assert run.status == "finished"
    assert run["object.force"][before].max() < 1.2
    assert np.diff(run["follower.tip"][before, 1]).max() < 1e-4
    assert run["object.force"][-1] > 1.0


def test_an_estimate_that_is_off_on_either_side_has_not_converged() -> None:
    claim = next(claim for claim in chapters.load("2").claims if claim.id == "C2.08")
    stored = baselines.Baseline.of("2", "movement_estimation").values
    assert claim.predicate is not None
    assert (claim.predicate.margin(stored) or 0) > 0
    for off in (0.05, -0.05):
        assert (claim.predicate.margin(stored | {"movement_estimation.light10.estimation_error": off}) or 1) < 0


def test_a_start_may_be_off_by_another_distance_in_each_axis() -> None:
    config = Config.of({"cases": {"off_80": {"discrepancy": [0.08, 0.05]}, "off_100": {"discrepancy": 0.1}}})
    assert _off(config, "off_80") == "0.08 and 0.05 m off"
    assert _off(config, "off_100") == "0.1 m off"


def test_a_key_that_every_case_sets_itself_is_said_to_have_no_effect() -> None:
    plans, _ = plan_chapter("2", ["balloon_static.discrepancy=0.05"], write=False)
    assert [text for plan in plans for text in plan.differs] == [
        "discrepancy=0.05 (book: 0.08), without effect: every case sets its own"
    ]


def test_a_shared_value_is_named_beside_other_overrides() -> None:
    given = ["shared.fixed.displacement=-0.2", "hold_and_move.object.mass=0.4", "only=hold_and_move"]
    plans, _ = plan_chapter("1", given, write=False)
    assert plans[0].differs == ["object.mass=0.4 (book: 0.3)", "t1_fixed.law.displacement=-0.2 (book: -0.15)"]


def test_fig_2_6_shows_one_case_for_each_stiffness_at_one_period_and_fig_2_7_the_others() -> None:
    def split(period: list[int], **cases: tuple[float, float]) -> list[str]:
        config = Config.of(
            {"period": period, "cases": {k: {"stiffness": c, "period": p} for k, (c, p) in cases.items()}}
        )
        return _of_one_period(list(cases), config)

    forces, estimates = {"k25": (25, 20), "k35": (35, 20)}, {"sigma10": (35, 10), "sigma30": (35, 30)}
    assert split([10, 30], **forces, **estimates, mine=(35, 5)) == ["k25", "k35"]
    assert split([20, 30], **forces, sigma20=(35, 20), sigma30=(35, 30)) == ["k25", "k35"]
    assert split([10, 30], k35=(35, 20), **estimates) == ["k35"]
    assert split([10, 30], **estimates) == split([10, 30]) == []
