"""Chapter 4: the arms, references and measures that its experiments are made of, and short runs of each."""

import math
from functools import partial

import cases
import numpy as np
import pytest

from dexrepro import chapters
from dexrepro.baselines import stored_values
from dexrepro.cases import experiment_cases
from dexrepro.chapters.chapter4 import measures, payload_arm, two_link
from dexrepro.config import compose_chapter
from dexrepro.robots import kinematics
from dexrepro.robots.baxter import baxter
from dexrepro.robots.inverse_kinematics import nearest

case = partial(cases.case, "4")


def simulated(experiment, name, **changes):
    config = case(experiment, name, **changes)
    module = chapters.load("4").experiment(experiment).simulation
    recording = module.simulate(config, lambda purpose: np.random.default_rng(0))
    return recording, module.measure(recording, config)


def networks():
    """Name and network of each case that has one, of the experiments that compare networks; and the shared values."""
    composed = compose_chapter("4")
    for experiment in ("skill_reuse", "barrier_and_switch", "payload_transfer"):
        for name, values in experiment_cases(composed, experiment).items():
            if network := values.get("network") or values["law"].get("network"):
                yield name, network, composed["shared"]["network"]


def test_networks_forget_at_one_rate_as_the_rule_of_fairness_says():
    apart = {name for name, network, shared in networks() if network["leakage"] != shared["leakage"]}
    assert apart == {"common_gamma", "fuzzy_common_gamma"}


def test_one_network_has_one_gain_beside_the_one_for_all():
    found = {}
    for name, network, shared in networks():
        if name != "rbf10_high_gain" and network.get("gain", shared["gain"]) != shared["gain"]:
            found.setdefault(str(sorted(network["basis"].items())), set()).add(float(network["gain"]))
    assert found
    assert not {basis: gains for basis, gains in found.items() if len(gains) > 1}


def test_networks_that_are_compared_at_equal_effective_gain_have_it_and_none_searched_has_more():
    stored = stored_values("4")
    ratios = [
        stored[f"payload_transfer.{name}.gain_ratio"] for name in ("reuse", "rbf_medium", "rbf_tuned", "constant")
    ]
    gains = [stored[f"skill_reuse.{name}.effective_gain"] for name in ("broad20", "broad30", "broad50", "constant")]
    assert ratios == pytest.approx([1.0] * 4, rel=0.06)
    assert gains == pytest.approx([1000.0] * 4, rel=0.06)
    assert all(stored[f"skill_reuse.{name}.effective_gain"] <= 1000 for name in ("rbf_tuned", "rbf_settled"))


def test_gravity_torque_of_the_arm_in_the_world_is_the_known_one():
    config = case("skill_reuse", "broad20")
    with two_link.scene(config) as world:
        model_torque = world.run(config.step, {"arm": lambda sense: np.array([98.0, 24.5])}, control_period=config.step)
    assert np.abs(model_torque["arm.velocity"]).max() < 1e-12


@pytest.mark.parametrize("reference", [two_link.ellipse, lambda c, d: two_link.stroke(c, 45, d)])
def test_references_are_consistent_derivatives(reference):
    config = case("skill_reuse", "broad20")
    motion = reference(config, 2.0)
    velocity = np.gradient(motion.position, config.step, axis=0)[1:-1]
    acceleration = np.gradient(motion.velocity, config.step, axis=0)[1:-1]
    assert velocity == pytest.approx(motion.velocity[1:-1], abs=1e-5)
    assert acceleration == pytest.approx(motion.acceleration[1:-1], abs=1e-5)


def test_ellipse_follows_the_printed_equation_and_strokes_are_its_diameters():
    config = case("skill_reuse", "broad20")
    x, y = two_link.ellipse(config, 5.0).position.T
    assert (x - 1) ** 2 / 0.09 + y**2 / 0.04 == pytest.approx(1.0)
    for angle in config.task.stroke_angles:
        x, y = two_link.stroke(config, angle, 5.0).position.T
        assert np.max((x - 1) ** 2 / 0.09 + y**2 / 0.04) == pytest.approx(1.0, abs=1e-5)


def test_minimum_jerk_segments_rest_at_every_point():
    motion = payload_arm.via_points([[0, 0, 0], [1, 0, 0], [1, 2, 0]], [1.0, 2.0], 1e-3)
    assert motion.position[1000] == pytest.approx([1, 0, 0])
    assert motion.velocity[[0, 1000]] == pytest.approx(np.zeros((2, 3)))
    assert np.gradient(motion.velocity, 1e-3, axis=0)[5:995] == pytest.approx(motion.acceleration[5:995], abs=1e-3)


def test_all_printed_points_are_within_reach_from_the_preferred_posture():
    config = case("payload_transfer", "reuse")
    arm = baxter("right")
    for point in (config.task.home, *config.task.starts, *config.task.ends):
        q = nearest(arm, config.task.posture, point, task="position", settle=400)
        assert kinematics.forward(arm, q)[0] == pytest.approx(point, abs=1e-9)
        assert np.all((q > arm.lower) & (q < arm.upper))


def test_ripple_is_that_of_the_error_about_its_mean():
    time = np.arange(0, 5, 1e-3)
    error = np.stack([0.01 + 2e-3 * np.sin(2 * np.pi * time / 0.15), np.zeros_like(time)], axis=1)
    found = measures.tracking(time, error, error / 0.02, np.zeros((len(time), 2)))
    assert found["error_ripple_mm"] == pytest.approx(math.sqrt(2), rel=0.02)
    assert found["torque_increment_nm"] == 0.0
    assert found["max_usage"] == pytest.approx(0.6, rel=1e-3)
    assert found["violations"] == 0


def test_converged_weights_have_neither_drift_nor_ripple_and_large_ones_are_counted():
    steady = [np.array([[10.0, 1.0], [0.5, 1.0], [-2.0, 1.0]])] * 10
    found = two_link.settled(steady, per_node=1)
    assert found["drift"] == pytest.approx(0.0)
    assert found["ripple"] == pytest.approx(0.0)
    assert (found["large"], found["nodes"]) == (2, 3)


def test_a_stroke_is_learned_and_its_weights_start_the_ellipse():
    recording, metrics = simulated(
        "skill_reuse", "broad20", task__stroke_angles=[0], task__stroke_duration=5.0, task__duration=1.0, frozen=False
    )
    assert metrics["diverged"] == 0
    assert metrics["max_usage"] < 1
    assert metrics["nodes"] > metrics["nodes_trained"] > 1
    ellipse = recording.frames["weights"].query("segment == 4").iloc[0]
    assert abs(ellipse["joint1_node1"]) > 1.0


def test_reuse_and_an_empty_network_start_from_the_same_state():
    short = {"task__stroke_angles": [0], "task__stroke_duration": 5.0, "task__duration": 1.0}
    reuse, _ = simulated("skill_reuse", "broad20", frozen=False, **short)
    zero, _ = simulated("skill_reuse", "zero20", **short)
    first = np.flatnonzero(reuse["segment"] == two_link.ELLIPSE)[0]
    assert reuse["position"][first] == pytest.approx(zero["position"][0], abs=1e-12)
    assert reuse["error"][first] == pytest.approx(zero["error"][0], abs=1e-12)


def test_the_barrier_keeps_the_bound_without_any_network_and_gains_alone_do_not():
    _, with_barrier = simulated("barrier_and_switch", "no_network", task__duration=3.0)
    _, without = simulated("barrier_and_switch", "gains_only", task__duration=3.0)
    assert with_barrier["max_usage"] < 1 < without["max_usage"]


def test_without_the_switch_the_enhanced_network_diverges():
    recording, metrics = simulated("barrier_and_switch", "no_switch20")
    assert metrics["diverged"] == 1
    assert "diverged" in recording.status


def test_knowledge_of_the_payload_reduces_the_error_of_a_new_trajectory():
    short = {"task__starts": [[0.7, -0.2, -0.25]], "task__ends": [[0.5, -0.8, 0.25]], "picture": False}
    _, trained = simulated("payload_transfer", "reuse", **short)
    _, empty = simulated("payload_transfer", "zero", **short)
    assert trained["rmse_mm"] < 0.8 * empty["rmse_mm"]
    assert trained["max_usage"] < 1
    assert trained["nodes_phase2"] >= trained["nodes_phase1"] > 1


def test_the_printed_box_of_the_fixed_network_contains_none_of_the_points():
    short = {"task__trajectories": 1, "task__training_time": 0.1, "task__times": [0.05, 0.05, 0.05]}
    _, metrics = simulated("payload_transfer", "rbf_narrow", **short)
    assert metrics["points_in_box"] == 0


def test_cost_grows_in_proportion_to_the_nodes():
    recording, metrics = simulated("growth_cost", "growing", nodes=[8, 72, 512], repetitions=2)
    assert metrics["multiplication_exponent"] == pytest.approx(1.0, abs=0.01)
    assert metrics["memory_exponent"] == pytest.approx(1.0, abs=0.01)
    assert np.all(recording.frames["cost"].step_us > 0)
