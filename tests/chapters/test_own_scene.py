"""A scene of the user's own runs under every family of laws; what cannot be used gets one sentence."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cases import case, rng

from dexrepro.chapters.own.paths import leader_path
from dexrepro.chapters.own.scene import experiment as scene
from dexrepro.checks import check_files
from dexrepro.cli import main
from dexrepro.commands.run import run_overrides
from dexrepro.control.contract import Command
from dexrepro.errors import InputError
from dexrepro.experiment import Config, Recording

URDF = """
<robot name="tiny">
  <link name="base"/>
  <joint name="shoulder" type="revolute"> <parent link="base"/> <child link="upper"/> <axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="20" velocity="10"/> </joint>
  <link name="upper"> <inertial> <origin xyz="0.2 0 0"/> <mass value="1"/>
    <inertia ixx="0.002" iyy="0.015" izz="0.015"/> </inertial> </link>
  <joint name="elbow" type="revolute"> <origin xyz="0.4 0 0"/> <parent link="upper"/> <child link="fore"/>
    <axis xyz="0 0 1"/> <limit lower="-3" upper="3" effort="10" velocity="10"/> </joint>
  <link name="fore"> <inertial> <origin xyz="0.15 0 0"/> <mass value="0.8"/>
    <inertia ixx="0.001" iyy="0.006" izz="0.006"/> </inertial> </link>
  <joint name="mount" type="fixed"> <origin xyz="0.3 0 0"/> <parent link="fore"/> <child link="tip"/> </joint>
  <link name="tip"/>
</robot>
"""
TINY = "{_target_: dexrepro.robots.urdf.from_urdf, path: tiny.urdf, end: tip}"
BAXTER = "{_target_: dexrepro.robots.baxter.baxter, side: right}"
LINE = "{line: {start: [0.5, 0.1, 0], end: [0.55, 0.15, 0], period: 4}}"
CONTROL = "dexrepro.control"
SQUEEZED = ("scene.offset=[-0.25,0,0]", "scene.elastic={stiffness: 100, rest_length: 0.27}", "scene.desired_force=2.0",
            "scene.leader={line: {start: [0.75, 0.1, 0], end: [0.8, 0.1, 0], period: 4}}")  # fmt: skip


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "tiny.urdf").write_text(URDF)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def configured(*overrides: str, arm: str = TINY, leader: str = LINE) -> Any:
    given = (f"scene.arm={arm}", f"scene.leader={leader}", "scene.start=[-0.5,1.0]", "scene.duration=0.5", *overrides)
    return case("own", "scene", "default", *given)


def run(law: str, *overrides: str, **parts: str) -> tuple[Recording, Any]:
    config = configured(f"scene.law={{_target_: {CONTROL}.{law}}}", *overrides, **parts)
    recording = scene.simulate(config, None)
    assert recording.status == "finished"
    return recording, scene.measure(recording, config)


@pytest.mark.parametrize(
    ("law", "largest"),
    [
        ("joint_pd.JointPD, stiffness: 300, damping: 20", 0.01),
        ('computed_torque.ComputedTorque, model: "${scene.model}", frequency: 30', 1e-4),
        ('gravity_pd.GravityPD, model: "${scene.model}", stiffness: 300, damping: 20', 0.01),
        ('time_delay_impedance.TimeDelayImpedance, model: "${scene.model}", dt: 0.001, error_slope: 10,'
         " impedance: {_target_: dexrepro.control.time_delay_impedance.ConstantImpedance, gain: 20}", 0.01),
        ("own", 0.01),
    ],
)  # fmt: skip
def test_a_tracking_law_follows_the_leader(law: str, largest: float) -> None:
    if law == "own":
        config = configured("scene.law={_target_: test_own_scene.Spring}")
        metrics = scene.measure(scene.simulate(config, None), config)
    else:
        _, metrics = run(law)
    assert metrics["rmse"] < largest
    assert metrics["saturated"] == 0
    assert metrics["force_rmse"] is None


class Spring:
    """An end-point law of the user's: F = k (x_d - x) + d (x_d' - x')."""

    kind = "end_point"

    def reset(self, measured: Any) -> None: ...

    def __call__(self, measured: Any, desired: Any) -> Command:
        error, rate = desired.position - measured.position, desired.velocity - measured.velocity
        return Command(force=2000 * error + 80 * rate)


@pytest.mark.parametrize(
    "law",
    [
        "force_control.IntegralForceControl, rate: 0.1, desired_force: 2, dt: 0.001",
        "passive_impedance.PassiveImpedance, mass: 1, damping: 10, desired_force: 2, dt: 0.001",
        "holding.AutoregressiveHolding, dt: 0.001, desired_force: 2, gain: 0.1, estimator_gain: 10, adaptation: 0.1,"
        " lags: 2",
    ],
)
def test_a_force_law_holds_the_elastic_object(law: str) -> None:
    recording, metrics = run(law, *SQUEEZED, "scene.duration=2")
    assert recording["force_along"][-500:] == pytest.approx(2.0, abs=0.5)
    assert np.abs(recording["arm.force"][:, 1]).max() < 0.2
    assert metrics["force_peak"] < 2.5


LEADER = "{_target_: dexrepro.robots.urdf.from_urdf, path: tiny.urdf, end: tip, base: [1.25, 0, 0]}"


def test_the_leader_may_be_an_arm_that_yields_to_what_it_holds() -> None:
    squeeze = ("scene.offset=[-0.25,0,0]", "scene.elastic={stiffness: 100, rest_length: 0.27}", "scene.duration=1",
               "scene.leader={line: {start: [0.75, 0.1, 0], end: [0.8, 0.1, 0], period: 4}}")  # fmt: skip
    force = "force_control.IntegralForceControl, rate: 0.1, desired_force: 2, dt: 0.001"
    gaps = {}
    for stiffness in (100, 3000):
        law = f"{{_target_: {CONTROL}.joint_pd.JointPD, stiffness: {stiffness}, damping: 20}}"
        recording, _ = run(force, *squeeze, f"scene.leader_arm={LEADER}", f"scene.leader_law={law}")
        assert recording["force_along"][-200:] == pytest.approx(2.0, abs=0.5)
        plan = leader_path(configured(*squeeze))(1.0).position
        gaps[stiffness] = np.linalg.norm(recording["leader.pose"][-1] - plan)
    assert 5 * gaps[3000] < gaps[100]
    assert gaps[100] > 1e-4


def test_the_leaders_law_may_need_its_own_model() -> None:
    law = f"{{_target_: {CONTROL}.computed_torque.ComputedTorque, _partial_: true, frequency: 30}}"
    follow = 'computed_torque.ComputedTorque, model: "${scene.model}", frequency: 30'
    pair = ("scene.leader_arm=" + LEADER.replace("1.25", "1.0"), f"scene.leader_law={law}")
    recording, metrics = run(follow, *pair, "scene.offset=[-0.1,0,0]")
    assert metrics["rmse"] < 1e-3
    assert np.ptp(recording["leader.torque"]) > 0


@pytest.mark.parametrize(
    ("arm", "law", "sentence"),
    [
        (LEADER, "null", "scene.leader_law must name a law of kind joint or end_point"),
        (LEADER.replace("1.25", "9"), "joint_pd.JointPD, stiffness: 9, damping: 1", "comes no closer"),
        ("{path: tiny.urdf}", "joint_pd.JointPD, stiffness: 9, damping: 1", "scene.leader_arm is no arm"),
    ],
)
def test_a_leader_that_cannot_be_used_gets_one_sentence(arm: str, law: str, sentence: str) -> None:
    law = law if law == "null" else f"{{_target_: {CONTROL}.{law}}}"
    config = configured("scene.law={_target_: test_own_scene.Spring}", f"scene.leader_arm={arm}",
                        f"scene.leader_law={law}")  # fmt: skip
    with pytest.raises(InputError, match=sentence):
        scene.simulate(config, None)


def test_a_redundant_arm_of_the_library_goes_round_a_circle_without_falling() -> None:
    around = "{circle: {centre: [0.8, -0.3, 0.2], radius: 0.05, period: 2}}"
    law = ("scene.law={_target_: test_own_scene.Spring}", "scene.gravity_compensation=true", "scene.start=null")
    config = configured(*law, arm=BAXTER, leader=around)
    recording = scene.simulate(config, None)
    assert scene.measure(recording, config)["rmse"] < 0.01
    assert np.ptp(recording["leader.pose"][:, 1]) > 0.01


def test_a_fixed_box_stops_the_arm_and_is_felt() -> None:
    pen = "{_target_: dexrepro.robots.pen_arm.pen_arm}"
    down = "{points: [[0, 0.2, 0, 0.05], [0.4, 0.2, 0, -0.02]]}"
    law = 'computed_torque.ComputedTorque, model: "${scene.model}", frequency: 30'
    box = "scene.box={size: [0.1, 0.1, 0.02], position: [0.2, 0, 0]}"
    recording, metrics = run(law, "scene.start=[0,1,-1]", box, arm=pen, leader=down)
    assert recording["arm.tip"][:, 2].min() > 0.0
    assert metrics["force_peak"] > 0.05


def test_a_recorded_path_is_followed(folder: Path) -> None:
    rows = [f"{0.1 * k},{50 + k},{10 - k},0" for k in range(10)]
    (folder / "path.csv").write_text("time,x,y,z\n" + "\n".join(rows))
    leader = "{csv: {file: path.csv, unit: cm}}"
    recording, _ = run('computed_torque.ComputedTorque, model: "${scene.model}", frequency: 30', leader=leader)
    assert recording["leader.pose"][-1] == pytest.approx([0.5499, 0.0501, 0], abs=1e-3)
    with pytest.raises(
        InputError, match=r"the point .50, 10, 0. m of .*; scene.leader=.csv: .file: ..., unit: mm}} rea"
    ):
        run('computed_torque.ComputedTorque, model: "${scene.model}", frequency: 30', leader="{csv: path.csv}")


OWN_LINE = "{line: {start: [0.72, 0.1, 0], end: [0.5, 0.1, 0], period: 4}}"
FIXED = "{_target_: dexrepro.control.holding.FixedDistance, dt: 1, displacement: 1, speed: 1}"


@pytest.mark.parametrize(
    ("key", "value", "sentence"),
    [
        ("arm", "{_target_: dexrepro.robots.urdf.from_urdf, path: no.urdf, end: tip}", "no URDF file 'no.urdf'"),
        ("arm", TINY.replace("end: tip", "end: hand"), "has no link 'hand'; there are: base, upper, fore, tip"),
        ("arm", "{path: tiny.urdf, end: tip}", "scene.arm is no arm"),
        (
            "leader",
            OWN_LINE,
            r"the point \(0.72, 0.1, 0\) m of scene.leader \+ offset at 0 s: arm .* no closer than .* .m.; move scene",
        ),
        ("leader", LINE.replace("0.1, 0]", "0.1, 0.2]"), r"at 0 s: the arm stays at z = 0 m"),
        ("leader", "{circle: {radius: 1}, line: {period: 1}}", "names line, circle: give exactly one of points, line"),
        ("leader", "{points: [[0, 0, 0]]}", "scene.leader.points: give two rows or more of time"),
        ("leader", "{circle: {radius: 1}}", "scene.leader.circle.centre = null is not allowed: it must be three"),
        ("leader", "{csv: no.csv}", "scene.leader.csv: cannot read 'no.csv'"),
        (
            "law",
            "{_target_: fractions.Fraction}",
            "scene law Fraction must declare its kind, one of joint, end_p",
        ),
        ("law", "null", "scene.law = null is not allowed: name a law, or cases that each name one"),
        ("name", "n" * 61, "scene.name = n.* is not allowed: it must name a folder: use up to 60 letters"),
        ("start", "[0.1]", r"scene.start = \[0.1\] is not allowed: it must be 2 joint angles"),
        ("start", "5", "scene.start = 5 is not allowed: it must be 2 joint angles"),
        ("offset", "[0,0]", r"scene.offset = \[0, 0\] is not allowed: it must be three numbers"),
        ("gravity", "5", "scene.gravity = 5 is not allowed: it must be three numbers"),
        ("law", FIXED, "a holding law needs the direction it acts along"),
    ],
)
def test_what_cannot_be_used_gets_one_sentence(key: str, value: str, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence) as caught:
        scene.simulate(
            configured(**{key: value}) if key in ("arm", "leader") else configured(f"scene.{key}={value}"), None
        )
    assert "\n" not in str(caught.value)


def test_a_negative_mass_gets_one_sentence(folder: Path) -> None:
    (folder / "tiny.urdf").write_text(URDF.replace('<mass value="1"/>', '<mass value="-1"/>'))
    with pytest.raises(InputError, match=r"'tiny\.urdf': link 'upper' has the mass -1 kg"):
        scene.simulate(configured(), None)


def test_a_doubtful_file_is_said_once_and_kept_with_the_result(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "tiny.urdf").write_text(URDF.replace('izz="0.015"', 'izz="0.0172"'))
    law = 'law: {_target_: dexrepro.control.computed_torque.ComputedTorque, model: "${scene.model}", frequency: 30}'
    cases = f"+scene.cases={{a: {{{law}}}, b: {{duration: 0.1, {law}}}}}"
    words = [f"scene.arm={TINY}", f"scene.leader={LINE}", "scene.start=[-0.5,1.0]", "scene.duration=0.2", cases]
    for _ in ("run", "found again"):
        assert run_overrides(["chapter=own", *words, "workers=1", "quiet=true"]) == 0
        text = " ".join(capsys.readouterr().err.split())
        assert text.startswith("warning: URDF file 'tiny.urdf': link upper by 1.2 %: no rigid body has this inertia")
        assert text.count("warning") == 1
    words[1] = "scene.leader={line: {start: [7,0,0], end: [7.1,0,0], period: 4}}"
    assert run_overrides(["chapter=own", *words, "workers=1", "quiet=true"]) == 1
    text = " ".join(capsys.readouterr().err.split())
    assert "; it was warned that URDF file 'tiny.urdf': link upper by 1.2 %" in text


def test_folders_and_files_have_the_names_that_people_give_them(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    own = folder / "Öl & Büro (neu), O'Neill" / "scene"
    own.mkdir(parents=True)
    monkeypatch.setenv("HOME", str(folder))
    (folder / "trial[1] größe=2.csv").write_text("".join(f"{0.1 * k},{0.5 + 0.01 * k},0.1,0\n" for k in range(10)))
    law = "{_target_: dexrepro.control.joint_pd.JointPD, stiffness: 300, damping: 20}"
    text = f"name: own\narm: {TINY}\nstart: [-0.5, 1.0]\nduration: 0.05\nlaw: {law}\n"
    (own / "letter (1).v2.yaml").write_text(text, "utf-8")
    words = ["--config-dir", str(own.parent), "+scene=letter (1).v2", "scene.leader.csv=trial[1] größe=2.csv"]
    assert main(["run", *words, "results=~/run (2)/größe", "workers=1"]) == 0, capsys.readouterr().err
    assert len([*folder.glob("run (2)/größe/runs/own-*/metrics.json")]) == 1
    assert main(["run", "-m", *words, "results=~/run (3), größe", "seed=0,1", "workers=1"]) == 0
    assert len([*folder.glob("run (3), größe/runs/own-*/metrics.json")]) == 2


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "squeeze.yaml holds no keys: it must consist of lines such as 'key: value'"),
        ("cases: [a, b]", "squeeze.yaml: cases = ['a', 'b'] is not allowed: it must hold keys with values"),
        ("servo: [3]", "squeeze.yaml: servo = [3] is not allowed: it must hold keys with values"),
        ("gravity: {z: 3}", "squeeze.yaml: gravity = {'z': 3} is not allowed: it must be a list"),
        ("leader: 3", "scene.leader = 3 is not allowed: it must hold keys with values"),
        ("# @package _global_\nduration: 3", "sets 'duration' beside the scene: leave out its line '# @pack"),
        ("scene: {duration: 3}", "unknown key 'scene.scene': what is below 'scene:' in the file stands there without"),
        ("name: null", "scene.name = null is not allowed: it must name a folder"),
        ("leader: {line: {period: 010}}", "squeeze.yaml: line 1: YAML takes 010 for 8; write 10 or 8, or '010' in"),
        ("duration: 1\nstep: 1:30", "squeeze.yaml: line 2: YAML takes 1:30 for 90; write 90, or '1:30' in quotes"),
        ("duration: 0,5", "scene.duration = '0,5' is not allowed: it must be a number"),
        ("duration: [1, 2]", "scene.duration = [1, 2] is not allowed: it must be a number"),
        ("duration: 1e30", "scene.duration = 1e+30 is not allowed: it must be 10000 s at most, 10000000 steps of "
                            "scene.step = 0.001 s"),
        ("step: 1e-30", "scene.duration = 5 is not allowed: it must be 1e-23 s at most, 10000000 steps of scene"),
    ],
)  # fmt: skip
def test_what_is_wrong_in_a_scenes_file_gets_one_sentence(
    folder: Path, capsys: pytest.CaptureFixture[str], text: str, sentence: str
) -> None:
    (folder / "mine/scene").mkdir(parents=True)
    (folder / "mine/scene/squeeze.yaml").write_text(text)
    assert main(["run", "--config-dir", "mine", "+scene=squeeze", "workers=1"]) == 2
    assert sentence in " ".join(capsys.readouterr().err.split())


HOLDS = "joint_pd.JointPD, stiffness: 300, damping: 20"
STILL = "{line: {start: [0.5, 0.1, 0], end: [0.5, 0.1, 0], period: 4}}"


def test_a_push_moves_the_arm_where_and_when_it_acts() -> None:
    push = "{force: [0, 3, 0], start: 0.2, duration: 0.1, link: fore}, {force: [1, 0, 0], start: 0.4, duration: 9}"
    recording, _ = run(HOLDS, f"scene.pushes=[{push}]", leader=STILL)
    moved = np.linalg.norm(recording["arm.tip"] - recording["arm.tip"][0], axis=1)
    assert moved[recording.time < 0.2].max() < 1e-6
    assert moved[recording.between(0.2, 0.3)].max() > 1e-3
    assert not np.any(recording["arm.force"]), "no sensor feels a push"
    assert recording["push.y"][recording.between(0.21, 0.29)] == pytest.approx(3.0)
    assert recording["push1.x"][-1] == 1.0


def test_a_wall_of_given_stiffness_pushes_back() -> None:
    wall = "scene.wall={point: [0.48, 0, 0], normal: [-2, 0, 0], stiffness: 500, damping: 5}"
    leader = "{line: {start: [0.45, 0.1, 0], end: [0.5, 0.1, 0], period: 2}}"
    recording, _ = run(HOLDS, wall, "scene.duration=1", leader=leader)
    depth = np.maximum(recording["arm.tip"][:, 0] - 0.48, 0.0)
    force = recording["arm.force"]
    assert depth.max() > 1e-3
    assert force[-1, 0] == pytest.approx(-500 * depth[-1], rel=0.1)
    assert not force[depth == 0].any()


def test_two_elastic_objects_act_at_once() -> None:
    springs = "scene.elastic=[{stiffness: 100, rest_length: 0.3}, {stiffness: 50, rest_length: 0.5, to: [0.5, 0.5, 0]}]"
    recording, _ = run(HOLDS, springs, "scene.offset=[-0.25,0,0]",
                       leader="{line: {start: [0.75, 0.1, 0], end: [0.75, 0.1, 0], period: 4}}")  # fmt: skip
    tip, leader = recording["arm.tip"][0], recording["leader.pose"][0]
    for name, stiffness, rest, place in (("object", 100, 0.3, leader), ("object1", 50, 0.5, (0.5, 0.5, 0))):
        force = stiffness * (rest - np.linalg.norm(tip - np.array(place)))
        assert recording[f"{name}.force"][0] == pytest.approx(force, rel=0.02)


def test_a_payload_bends_a_law_that_does_not_know_it() -> None:
    pen = "{_target_: dexrepro.robots.pen_arm.pen_arm}"
    law = 'computed_torque.ComputedTorque, model: "${scene.model}", frequency: 30'
    still = "{points: [[0, 0.2, 0, 0.05], [1, 0.2, 0, 0.05]]}"
    errors = [
        run(law, "scene.start=[0,1,-1]", "scene.duration=1", *more, arm=pen, leader=still)[1]["rmse"]
        for more in ((), ("scene.payload={mass: 0.02}",), ("scene.payload={mass: 0.04}",))
    ]
    assert errors[0] < 1e-4
    assert 1e-4 < errors[1] < errors[2]


def test_a_noisy_sensor_is_noisy_and_the_same_in_every_run() -> None:
    spring = ("scene.elastic={stiffness: 100, rest_length: 0.27}", "scene.offset=[-0.25,0,0]", "scene.duration=0.2")
    leader = "{line: {start: [0.75, 0.1, 0], end: [0.75, 0.1, 0], period: 4}}"
    law = "scene.law={_target_: dexrepro.control.joint_pd.JointPD, stiffness: 300, damping: 20}"
    config = configured(law, *spring, "scene.sensor={velocity_noise: 0.05, force_delay: 0.01}", leader=leader)
    first, again = (scene.simulate(config, rng("scene")) for _ in range(2))
    assert np.array_equal(first["arm.torque"], again["arm.torque"])
    exact, _ = run(HOLDS, *spring, leader=leader)
    assert np.std(np.diff(first["arm.torque"][50:], axis=0)) > 5 * np.std(np.diff(exact["arm.torque"][50:], axis=0))


@pytest.mark.parametrize(
    ("word", "sentence"),
    [
        ("pushes=[{force: [0, 1, 0], start: 1, duration: 1, link: hand}]",
         "scene.pushes.0.link = hand is not allowed: there are upper, fore"),
        ("pushes={force: [0, 1], start: 1, duration: 1}",
         r"scene.pushes.force = \[0, 1\] is not allowed: it must be three numbers"),
        ("pushes=[{force: [0, 1, 0], start: 1}]", "scene.pushes.0.duration = null is not allowed: it must be a number"),
        ("pushes={force: [0, 1, 0], start: -1, duration: 1}", "scene.pushes.0.start = -1 is not allowed: it must be 0"),
        ("pushes=[5]", "scene.pushes.0 = 5 is not allowed: it must have force, start, duration, link, point"),
        ("wall={point: [0,0,0], normal: [0,0,0], stiffness: 5}", r"scene.wall.normal = \[0, 0, 0\] is not allowed"),
        ("wall={point: [0,0,0], normal: [1,0,0], stifness: 5}", "unknown key 'scene.wall.stifness': did you"),
        ("elastic={stiffness: 5, rest_length: 1, damp: 2}", "unknown key 'scene.elastic.damp': did you mean 'damping'"),
        ("elastic={stiffness: 5, rest_length: 1, to: box}", "scene.elastic.to = 'box' .* three numbers, or lead"),
        ("box={size: [1, 1], position: [0, 0, 0]}", r"scene.box.size = \[1, 1\] is not allowed: it must be three num"),
        ("box={size: [1, 1, -1], position: [0, 0, 0]}", r"scene.box.size = \[1, 1, -1\] is not allowed: .* greater t"),
        ("box={position: [0, 0, 0]}", "scene.box.size = null is not allowed: it must be three numbers"),
        ("box={size: [1, 1, 1], position: [0, 0, 0], mas: 1}", "unknown key 'scene.box.mas': did you mean 'mass'"),
        ("box=5", "scene.box = 5 is not allowed: it must have size, position, mass, friction"),
        ("leader=null", "scene.leader names nothing: give exactly one of points, line, circle, csv"),
        ("desired_force=much", "scene.desired_force = 'much' is not allowed: it must be a number, or null"),
        ("gravity_compensation=maybe", "scene.gravity_compensation = maybe is not allowed: it must be true or false"),
        ("payload={mass: true}", "scene.payload.mass = True is not allowed: it must be a number"),
        ("payload={mass: heavy}", "scene.payload.mass = 'heavy' is not allowed: it must be a number"),
        ('elastic={stiffness: "100", rest_length: 1}', "scene.elastic.stiffness = '100' is not allowed: it must"),
        ("servo=null", "scene.servo = None is not allowed: it must have frequency, ik_gain, rest_gain"),
        ("servo.frequency=[1]", r"scene.servo.frequency = \[1\] is not allowed: it must be a number"),
        ("regulation=[1]", r"scene.regulation = \[1\] is not allowed: it must be a number"),
        ("sensor={force_nois: 1}", "unknown key 'scene.sensor.force_nois': did you mean 'force_noise'"),
    ],
)  # fmt: skip
def test_what_is_wrong_in_a_block_names_key_value_and_what_is_allowed(word: str, sentence: str) -> None:
    law = "scene.law={_target_: dexrepro.control.joint_pd.JointPD, stiffness: 300, damping: 20}"
    with pytest.raises(InputError, match=sentence):
        scene.simulate(configured(law, f"scene.{word}"), rng("scene"))


@pytest.mark.parametrize(
    ("leader", "sentence"),
    [
        ("circle", "scene.leader = circle is not allowed: it must hold one of points, line, circle, csv"),
        ({"line": [0, 1]}, "scene.leader.line = [0, 1] is not allowed: it must have start, end, period"),
        ({"line": {"speed": 2}}, "unknown key 'scene.leader.line.speed'"),
        ({"line": {"start": [0, 0], "end": [1, 0, 0], "period": 1}}, "scene.leader.line.start = [0, 0] is not allowed"),
        ({"line": {"start": [0, 0, 0], "end": [1, 0, 0], "period": "010"}}, "scene.leader.line.period = '010' is not"),
        ({"line": {"start": [0, 0, 0], "end": [1, 0, 0]}}, "scene.leader.line.period = null is not allowed"),
        (
            {"circle": {"centre": [0.7, 0.1], "radius": 1, "period": 1}},
            "scene.leader.circle.centre = [0.7, 0.1] is not",
        ),
        ({"circle": {"plane": "xz"}}, "unknown key 'scene.leader.circle.plane'"),
        (
            {"points": [[0, 0, 0, "a"], [1, 0, 0, 0]]},
            "scene.leader.points: give two rows or more of time, x, y, z, all",
        ),
        ({"points": 5}, "scene.leader.points: give two rows or more"),
        ({"csv": {"unit": "mm"}}, "scene.leader.csv.file = null is not allowed: it must be a name"),
        ({"csv": {"file": "a.csv", "encoding": 1252}}, "scene.leader.csv: cannot read 'a.csv'"),
        ({"csv": {"file": "a.csv", "encoding": [5]}}, "scene.leader.csv: encoding = [5] is not allowed: it must be a"),
        ({"csv": {"file": "a.csv", "units": "mm"}}, "unknown key 'scene.leader.csv.units': did you mean 'unit'"),
    ],
)
def test_what_is_wrong_in_the_leaders_path_names_key_value_and_what_is_allowed(leader: Any, sentence: str) -> None:
    with pytest.raises(InputError, match=re.escape(sentence)):
        leader_path(Config.of({"leader": leader}))


def test_what_is_said_of_a_file_is_no_name_of_one() -> None:
    given = {"leader": {"csv": {"file": 5, "encoding": 1252}}}
    with pytest.raises(InputError, match=r"scene\.leader\.csv\.file = 5 is not allowed"):
        check_files(given, {"leader": {"csv": None}}, "scene")
    given["leader"]["csv"]["file"] = "a.csv"
    check_files(given, {"leader": {"csv": None}}, "scene")


def test_a_push_after_the_end_is_said() -> None:
    law = "scene.law={_target_: dexrepro.control.joint_pd.JointPD, stiffness: 300, damping: 20}"
    push = "scene.pushes={force: [0, 1, 0], start: 9, duration: 1}"
    with pytest.warns(
        UserWarning, match=r"scene.pushes.0.start = 9 comes after the end at 0.1 s: there is no such push"
    ):
        scene.simulate(configured(law, push, "scene.duration=0.1"), rng("scene"))
