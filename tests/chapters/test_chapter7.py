"""The parts that the experiments of chapter 7 share, on answers known beforehand."""

from __future__ import annotations

import shlex
from functools import partial
from typing import Any

import cases
import numpy as np
import pytest

from dexrepro import baselines, chapters
from dexrepro.chapters.chapter7 import desk, skills
from dexrepro.chapters.chapter7.fuzzy_generalisation import experiment as fuzzy_generalisation
from dexrepro.chapters.chapter7.impedance_stability import experiment as impedance_stability
from dexrepro.chapters.chapter7.obstacle_contact import experiment as obstacle_contact
from dexrepro.chapters.chapter7.reactive_learning import experiment as reactive_learning
from dexrepro.chapters.chapter7.style_separation import experiment as style_separation
from dexrepro.chapters.chapter7.unseen_conditions import experiment as unseen_conditions
from dexrepro.control.contract import Measured
from dexrepro.control.motion import Motion
from dexrepro.control.time_delay_impedance import ConstantImpedance, TimeDelayImpedance
from dexrepro.experiment import Config
from dexrepro.measures import rms_distance
from dexrepro.physics.model import RigidBodyModel
from dexrepro.robots.pen_arm import pen_arm, pen_arm_tip

case = partial(cases.case, "7")


@pytest.fixture(scope="module")
def learned() -> skills.Skills:
    config = case("fuzzy_generalisation", "main")
    return skills.Skills(config, *skills.demonstrate(config))


def test_printed_kinematics_end_where_the_damper_balances_the_spring() -> None:
    """T X' = V' drives X to (K G + D T X0) / (K + D T) instead of G when nothing forces it."""
    config = case("fuzzy_generalisation", "main")
    primitive = skills.Primitive(config, 8)
    start, goal = np.array([1.0, 0.0, 0.0]), np.array([9.0, 4.0, 0.0])
    still = np.zeros((len(primitive.time), 3))
    end = primitive.rollout(still, start, goal, printed=True)[-1]
    spring, damper = primitive.system.stiffness, primitive.system.damping * primitive.duration
    assert end == pytest.approx((spring * goal + damper * start) / (spring + damper), abs=1e-6)
    assert primitive.rollout(still, start, goal)[-1] == pytest.approx(goal, abs=1e-2)


def test_target_and_rollout_return_a_smooth_path() -> None:
    config = case("fuzzy_generalisation", "main")
    primitive, task = skills.Primitive(config, 8), skills.reach(config)
    path = skills.person(config).ordinary(task)
    again = primitive.rollout(primitive.target(path, task.ends[1], 8.0), *task.ends)
    assert rms_distance(again, path) < 0.02


def test_a_task_that_is_turned_is_performed_turned(learned: skills.Skills) -> None:
    config = case("fuzzy_generalisation", "main")
    angle = 0.6
    turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1.0]])
    tasks = []
    for rotation in (np.eye(3), turn):
        place = {name: (rotation @ [*config.task[name], 0.0])[:2].tolist() for name in ("start", "goal", "obstacle")}
        tasks.append(skills.NewTask(Config({**config, "task": Config({**config.task, **place})}), learned))
    straight, turned = (task.perform(task.reaction(0.4)) for task in tasks)
    assert turned == pytest.approx(straight @ turn.T, abs=1e-9)
    assert tasks[0].clearance(straight) == pytest.approx(skills.NewTask(config, learned).clearance(straight))


def test_the_old_task_is_its_own_generalisation(learned: skills.Skills) -> None:
    config = case("fuzzy_generalisation", "main")
    old = Config({**config.task, "start": config.scene.start, "goal": config.scene.goal, "scope": "same"})
    task = skills.NewTask(Config({**config, "task": old}), learned)
    assert task.perform() == pytest.approx(learned.perform(), abs=1e-9)
    assert task.ratio == pytest.approx(1.0)


def test_board_and_robot_are_inverse() -> None:
    points = np.random.default_rng(0).uniform((2, 0, 0), (20, 9, 10), (50, 3))
    assert desk.to_board(desk.to_robot(points)) == pytest.approx(points)


def test_the_reference_rests_before_and_after_and_its_derivatives_fit() -> None:
    config = case("impedance_tracking", "muscle")
    _, reference = desk.planned(config)
    assert abs(reference.velocity[:500]).max() < 1e-9
    assert abs(reference.velocity[-500:]).max() < 1e-9
    middle = reference.position[3002] - reference.position[2998]
    assert middle / (4 * config.control_period) == pytest.approx(reference.velocity[3000], rel=1e-3, abs=1e-5)
    assert reference.tip == pytest.approx(pen_arm_tip(reference.position))


def test_nearest_and_plane_return_what_they_know(learned: skills.Skills) -> None:
    config = case("unseen_conditions", "main")
    known = skills.conditions(config)
    for index in (0, 7):
        x = known[index].inputs
        for predict in (unseen_conditions.nearest, unseen_conditions.PREDICTORS["nearest_same"]):
            assert predict(x, learned.reactions, known, config) == pytest.approx(learned.reactions[index])
    plane = np.einsum("k,ij->kij", [c.distance + 2 * c.obstacle.height for c in known], np.ones((4, 3)))
    found = unseen_conditions.plane({"distance": 9.0, "height": 3.0, "direction": 0.4}, plane, known, config)
    assert found == pytest.approx(15.0)


def test_learning_experiments_measure_what_they_simulate() -> None:
    for module, name in ((style_separation, "one_obstacle"), (fuzzy_generalisation, "main")):
        config = case(module.__name__.split(".")[-2], name)
        metrics = module.measure(module.simulate(config, None), config)
        assert all(np.isfinite(value) for value in metrics.values())
    config = case("reactive_learning", "frozen", draws=2)
    metrics = reactive_learning.measure(reactive_learning.simulate(config, None), config)
    assert metrics["rmse5"] < metrics["rmse1"] < metrics["no_reaction"]


def shortened(config: Config, **changes: Any) -> Config:
    """A run of one second: hold, quick movement, hold."""
    demonstration = Config({**config.demonstration, "duration": 0.6, "rate": 500.0})
    return Config({**config, "demonstration": demonstration, "hold": 0.2, "pick": 0.1, "release": 0.9, **changes})


def test_the_arm_follows_the_plan_and_chatters_above_the_predicted_gain() -> None:
    metrics = {}
    for name in ("gain10", "gain45"):
        config = shortened(case("impedance_stability", name))
        metrics[name] = impedance_stability.measure(impedance_stability.simulate(config, None), config)
    assert metrics["gain10"]["rms_error"] < 0.2
    assert metrics["gain10"]["predicted_radius"] < 1 < metrics["gain45"]["predicted_radius"]
    assert metrics["gain45"]["torque_travel"] > 10 * metrics["gain10"]["torque_travel"]


def test_a_push_moves_the_arm_by_its_compliance_without_estimation() -> None:
    config = shortened(case("obstacle_contact", "high_plain"), rise=-3.0)
    config["hold"] = 0.5
    config["pushes"] = Config({"before": [0.1, 0.2], "behind": [0.2, 0.3], "rest": [1.15, 1.7]})
    recording = obstacle_contact.simulate(config, None)
    metrics = obstacle_contact.measure(recording, config)
    assert metrics["static_deviation"] == pytest.approx(metrics["predicted_deviation"], rel=0.15)
    assert metrics["contact_peak"] == 0.0
    del recording.series["impedance"]  # as of a law that reports none
    assert np.isnan(obstacle_contact.predicted_deviation(recording, config))


def test_a_task_is_taken_as_printed_by_words_that_there_are(learned: skills.Skills) -> None:
    config = case("fuzzy_generalisation", "main")
    config["task"] = Config({**config.task, "printed": ["kinematic"]})
    with pytest.raises(ValueError, match="must be a list of scaling, kinematics"):
        skills.NewTask(config, learned)


def test_integral_action_holds_the_last_load_and_waits_while_the_torque_is_at_its_limit() -> None:
    model = RigidBodyModel(pen_arm())
    law = TimeDelayImpedance(
        model, 0.001, 20.0, ConstantImpedance(1.0), estimation=False, torque_limit=5.0, integral_rate=100.0
    )
    still = Measured(0.0, np.full(3, 0.3), np.zeros(3), np.full(3, np.nan))

    def torque(error: float) -> np.ndarray:
        return law(still, Motion(still.position + error, np.zeros(3), np.zeros(3))).torque

    law.reset(still)
    rest = torque(0.0)
    for _ in range(10):
        torque(0.01)  # K r = 1.0 x 20 x 0.01
    assert torque(0.0) - rest == pytest.approx(np.full(3, 10 * 100.0 * 0.001 * 0.2), rel=1e-6)
    for _ in range(1000):
        torque(1.0)  # beyond the limit
    assert torque(0.0) - rest == pytest.approx(np.full(3, 0.2), rel=1e-6)
    law.reset(still)
    assert torque(0.0) == pytest.approx(rest)


def test_the_relay_of_7_40_is_run_with_the_corrected_signs() -> None:
    (erratum,) = (e for e in chapters.load("7").errata if e.id == "E7.20")
    values = cases.resolved("7", "impedance_tracking", "as_printed", *shlex.split(erratum.switch))
    assert values["law"]["printed"] == []
    assert values["law"]["impedance"]["switching_gain"] == 100.0


def test_what_the_printed_law_fails_at_the_corrected_one_does_from_the_same_start() -> None:
    """C7.28: a displaced start alone makes more torque travel than a smooth run, whatever the sign of the estimate."""
    (claim,) = (c for c in chapters.load("7").claims if c.id == "C7.28")
    assert claim.printed
    stored = baselines.stored_values("7")
    corrected = {name: stored[name.replace("displaced_printed", "displaced")] for name in claim.printed.metrics}
    assert (claim.printed.margin(stored) or 0) < 0 < (claim.printed.margin(corrected) or 0)


def test_the_bound_of_a_claim_on_the_estimation_stands_in_its_statement() -> None:
    bounds = {"C7.33": ("0.1", "a tenth"), "C7.33b": ("0.01", "a hundredth")}
    for claim in chapters.load("7").claims:
        factor, words = bounds.get(claim.id, ("", ""))
        assert factor in str(claim.predicate)
        assert words in claim.statement
