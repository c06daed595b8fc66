"""The world integrates what its laws and elements say, and nothing else."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dexrepro.physics.elements import Elastic, JointLoad, Push, TipForce, joint_friction
from dexrepro.physics.loop import Diverged, LawFailed, Progress
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.sensor import Sensor
from dexrepro.physics.world import World
from dexrepro.robots.arm import Pose
from dexrepro.robots.baxter import baxter, extension, palm, posture
from dexrepro.robots.kinematics import forward, jacobian
from dexrepro.robots.planar import planar

BOOK = ([0.5, 0.3, 0.1], [1.5, 0.9, 0.2])
KP, KD = np.array([700.0, 600.0, 500.0]), np.array([10.0, 1.0, 0.1])
FOLLOWER, LEADER = np.pi / 3 * np.array([1.0, 1, 1]), np.pi / 3 * np.array([2.0, -1, -1])
FLAT = (0.0, 0.0, 0.0)


def hold(target, kp=KP, kd=KD):
    return lambda sense: kp * (target - sense.position) - kd * sense.velocity


def idle(arm):
    return lambda sense: np.zeros(arm.dof)


def pair(world, **options):
    world.add_arm("follower", planar(*BOOK, base=(0.5, 0.0)), FOLLOWER, **options)
    world.add_arm("leader", planar(*BOOK), LEADER)
    world.add(Elastic("object", ("follower", "leader"), stiffness=45.0, rest_length=0.55))
    return {"follower": hold(FOLLOWER), "leader": hold(LEADER)}


ARMS = {"planar": planar(*BOOK, base=(0.2, 0.1, 0.4)), "baxter": baxter("left", tool=extension()),
        "palm": baxter("right", base=Pose((0.3, 0, 0), (0, 0, 1.0)), tool=palm())}  # fmt: skip


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("damping", [None, 5.0, "matrix"])
def test_a_step_is_semi_implicit_and_damping_acts_at_its_end(name, damping):
    arm = ARMS[name]
    n, step = arm.dof, 1e-3
    rng = np.random.default_rng(3)
    torque, load = 0.05 * rng.normal(size=n), 0.05 * rng.normal(size=n)
    force = np.array([3.0, -2.0, 0.0 if name == "planar" else 4.0])
    matrix = {None: np.zeros((n, n)), 5.0: 5.0 * np.eye(n)}.get(damping)
    if matrix is None:
        root = rng.normal(size=(n, n))
        matrix = root @ root.T
    command = torque if damping is None else (torque, np.diag(matrix) if damping == 5.0 else matrix)
    with World(step=step) as world:
        world.add_arm("arm", arm, posture("left")[:n])
        world.add(TipForce("field", "arm", lambda t, x, v: force), JointLoad("arm", lambda t, q, dq: load))
        run = world.run(0.05, {"arm": lambda sense: command})
    model = RigidBodyModel(arm)
    for k in (0, 10, 40):
        q, dq = run["arm.position"][k], run["arm.velocity"][k]
        mass = model.mass_matrix(q)
        drive = torque + load + jacobian(arm, q)[:3].T @ force - model.bias(q, dq)
        after = np.linalg.solve(mass + step * matrix, mass @ dq + step * drive)
        np.testing.assert_allclose(run["arm.velocity"][k + 1], after, atol=1e-9)
        np.testing.assert_allclose(run["arm.position"][k + 1], q + step * after, atol=1e-9)
        np.testing.assert_allclose(run["arm.tip"][k], forward(arm, q)[0], atol=1e-9)


@pytest.mark.parametrize("burden", ["push", "link", "hung", "gripped"])
def test_damping_does_not_matter_at_rest_under_a_load_that_no_sensor_tells(burden):
    arm, start, weight = baxter("right"), posture("right"), 15.0
    torque = RigidBodyModel(arm).gravity(start) + weight * jacobian(arm, start)[2]
    with World() as world:
        world.add_arm("arm", arm, start)
        if burden == "hung":
            world.hang("ball", "arm", weight / 9.81, 0.05)
        elif burden == "gripped":
            world.add_sphere("ball", 0.01, forward(arm, start)[0], weight / 9.81, collides=False)
            world.grip("arm", "ball")
        else:
            last = {"link": arm.links[-1].name, "point": tuple(arm.tip[:3, 3])} if burden == "link" else {}
            world.add(Push("arm", lambda t: (0, 0, -weight), **last))
        run = world.run(0.3, {"arm": lambda sense: (torque, np.array([5.5, 5, 6, 4, 8.5, 9, 5]))})
    assert np.abs(run["arm.tip"] - run["arm.tip"][0]).max() < 1e-4


def test_stiff_damping_on_a_light_wrist_is_stable_only_when_implicit():
    arm, start = baxter("right"), posture("right")
    model = RigidBodyModel(arm)
    gain = 10.0  # the last joint carries 6e-4 kg m^2: gain * 1 ms / inertia = 17 > 2

    def explicit(sense):
        return model.gravity(sense.position) - gain * sense.velocity

    def implicit(sense):
        return model.gravity(sense.position), np.full(7, gain)

    speeds = []
    for law in (explicit, implicit):
        with World() as world:
            world.add_arm("arm", arm, start)
            world.add(Push("arm", lambda t: (5.0, 0, 0) if t < 0.1 else (0, 0, 0)))
            speeds.append(np.abs(world.run(0.5, {"arm": law})["arm.velocity"][-100:]).max())
    assert speeds[0] > 1.0
    assert speeds[1] < 1e-2


def test_elastic_object_pushes_both_arms_apart_along_their_line():
    with World(gravity=FLAT) as world:
        run = world.run(1.0, pair(world))
    line = run["follower.tip"] - run["leader.tip"]
    length = np.linalg.norm(line, axis=1)
    np.testing.assert_allclose(run["object.force"], 45.0 * (0.55 - length), atol=1e-12)
    np.testing.assert_allclose(run["follower.force"], run["object.force"][:, None] * line / length[:, None], atol=1e-12)
    np.testing.assert_allclose(run["leader.force"], -run["follower.force"], atol=1e-12)
    assert run["object.force"][0] == pytest.approx(2.25)


@pytest.mark.parametrize(("stretched", "unilateral"), [(True, False), (True, True), (False, True)])
def test_a_stretched_object_pulls_where_it_may(stretched, unilateral):
    with World(gravity=FLAT) as world:
        world.add_arm("arm", planar(*BOOK), FOLLOWER)
        tip = forward(planar(*BOOK), FOLLOWER)[0]
        rest = 0.1 if stretched else 0.5
        world.add(Elastic("rod", ("arm", tip + (0.3, 0.0, 0.0)), 45.0, rest, unilateral=unilateral))
        run = world.run(2e-3)
    force = 0.0 if stretched and unilateral else 45.0 * (rest - 0.3)
    assert run["rod.force"][0] == pytest.approx(force)
    np.testing.assert_allclose(run["arm.force"][0], (-force, 0, 0), atol=1e-9)


def test_an_elastic_object_acts_along_its_line_in_space():
    place, anchor, step = np.array((0.1, 0.2, 0.3)), np.array((0.4, -0.1, 0.75)), 1e-3
    with World(step=step, gravity=FLAT) as world:
        world.add_sphere("ball", 0.02, tuple(place), mass=0.5, collides=False)
        world.add(Elastic("rod", ("ball", tuple(anchor)), 50.0, 1.0))
        run = world.run(2 * step)
    line = place - anchor
    length = np.linalg.norm(line)
    force = 50.0 * (1.0 - length) * line / length
    assert run["rod.length"][0] == pytest.approx(length)
    np.testing.assert_allclose((run["ball.pose"][1, :3] - place) / step**2 * 0.5, force, rtol=1e-4)


def test_a_law_without_a_sensor_of_its_own_feels_the_exact_force():
    felt = []
    with World(gravity=FLAT) as world:
        world.add_arm("arm", planar(*BOOK), FOLLOWER)
        world.add(TipForce("field", "arm", lambda t, x, v: (2.0 + t, -1.0, 0.0)))
        world.run(3e-3, {"arm": lambda sense: felt.append(sense.force) or np.zeros(3)})
    np.testing.assert_allclose(felt, [(2.0, -1, 0), (2.001, -1, 0), (2.002, -1, 0)], atol=1e-12)


def test_unilateral_object_never_pulls_and_stiffness_may_vary_in_time():
    with World(gravity=FLAT) as world:
        world.add_arm("arm", planar(*BOOK), LEADER)
        world.add(
            Elastic("loose", ("arm", (0.4, 0.6928, 0)), 50.0, rest_length=0.3, unilateral=True),
            Elastic("soft", ("arm", (0.4, 0.6928, 0)), stiffness=lambda t: 50 + 10 * np.sin(t), rest_length=0.5),
        )
        run = world.run(0.5, {"arm": hold(LEADER)})
    assert (run["loose.force"] == 0).all()
    expected = (50 + 10 * np.sin(run.time)) * (0.5 - run["soft.length"])
    np.testing.assert_allclose(run["soft.force"], expected, atol=1e-12)


def test_body_between_two_elastic_sides_settles_where_they_balance():
    with World(gravity=FLAT) as world:
        world.add_sphere("object", 0.05, (0.2, 0.0, 0.0), mass=0.3, collides=False)
        for name, place, stiffness in (("left", (0.0, 0.0, 0.0), 100.0), ("right", (0.5, 0.0, 0.0), 50.0)):
            world.add(Elastic(name, ("object", place), stiffness, rest_length=0.3, damping=5.0))
        run = world.run(2.0)
    # 100 (0.3 - x) = 50 (0.3 - (0.5 - x))
    np.testing.assert_allclose(run["object.pose"][-1, :3], (40 / 150, 0, 0), atol=1e-5)
    assert run["left.force"][-1] == pytest.approx(run["right.force"][-1], abs=1e-3)


def test_push_on_a_link_acts_like_the_jacobian_of_its_point():
    arm, start = baxter("right"), posture("right")
    forces = {}
    for link, point in (("hand", (0.0, 0.0, 0.025)), (None, (0.0, 0.0, 0.0))):
        with World() as world:
            world.add_arm("arm", arm, start)
            world.add(Push("arm", lambda t: (0.0, 30.0, 0.0), link=link, point=point))
            run = world.run(0.05, {"arm": idle(arm)})
            forces[link] = run["arm.velocity"][-1]
            assert (run["arm.force"] == 0).all()
    np.testing.assert_allclose(forces["hand"], forces[None], atol=1e-5)


def energy(arm, run):
    model = RigidBodyModel(arm, gravity=FLAT)
    rates = run["arm.velocity"]
    return np.array([dq @ model.mass_matrix(q) @ dq / 2 for q, dq in zip(run["arm.position"], rates)])


@pytest.mark.parametrize("arm", [planar([0.5, 0.3], [1.5, 0.9]), planar(*BOOK)], ids=["2 joints", "3 joints"])
def test_energy_of_the_free_arm_drifts_below_one_percent_and_less_with_smaller_steps(arm):
    drift = {}
    for step in (1e-3, 5e-4):
        with World(step=step, gravity=FLAT) as world:
            world.add_arm("arm", arm, np.array([0.3, 0.5, -0.4])[: arm.dof]).reset(
                [0.3, 0.5, -0.4][: arm.dof], [1.0, -0.5, 0.5][: arm.dof]
            )
            values = energy(arm, world.run(5.0, record_every=round(5e-3 / step)))
        drift[step] = np.abs(values / values[0] - 1).max()
    assert drift[1e-3] < 0.01
    assert drift[5e-4] / drift[1e-3] == pytest.approx(0.5, abs=0.1)


def test_runs_with_the_same_seed_are_identical_to_the_last_bit():
    def once():
        with World(gravity=FLAT) as world:
            laws = pair(world, sensor=Sensor(0.05, force_cutoff=30.0), rng=np.random.default_rng(1))
            feedback = laws["follower"]
            laws["follower"] = lambda s: feedback(s) + 0.1 * s.force
            return world.run(0.5, laws)

    first, other = once(), once()
    for name, values in first.series.items():
        np.testing.assert_array_equal(values, other[name], strict=True)


def test_worlds_side_by_side_do_not_interfere():
    with World(gravity=FLAT) as alone:
        expected = alone.run(0.2, pair(alone))
    with World(gravity=FLAT) as first, World(step=2e-3) as second:
        laws = pair(first)
        second.add_arm("arm", baxter("left"), posture("left"))
        parts = []
        for _ in range(4):
            parts.append(first.run(0.05, laws)["follower.position"])
            second.run(0.05)
    np.testing.assert_array_equal(np.concatenate(parts), expected["follower.position"])


def test_torque_is_clipped_at_the_limits_of_the_arm_and_recorded_so():
    arm = baxter("right")
    with World() as world:
        world.add_arm("arm", arm, posture("right"))
        run = world.run(0.01, {"arm": lambda s: np.full(7, 500.0)})
    np.testing.assert_array_equal(run["arm.torque"], np.tile([50.0, 100, 50, 50, 15, 15, 15], (10, 1)))


def test_divergence_is_told_with_time_arm_and_joint():
    def unstable(sense):
        return 400.0 * sense.velocity + 1.0

    with World(gravity=FLAT) as world:
        world.add_arm("follower", planar(*BOOK), FOLLOWER)
        with pytest.raises(Diverged, match=r"diverged at 0\.\d+ s: velocity of joint 'joint\d' of arm 'follower'"):
            world.run(5.0, {"follower": unstable})
    with World(gravity=FLAT) as world:
        world.add_arm("follower", planar(*BOOK), FOLLOWER)
        run = world.run(5.0, {"follower": unstable}, on_divergence="stop")
    assert run.status.startswith("diverged at")
    assert 0 < len(run.time) == run.steps < 5000
    assert np.isfinite(run["follower.velocity"]).all()


def test_divergence_names_the_quantity_that_makes_up_most_of_the_sum():
    rates, turned = np.array([300.0, 320.0, -310.0]), np.array([340.0, 0.0, 0.0])
    with World(gravity=FLAT) as world:
        arm = world.add_arm("arm", planar(*BOOK), FOLLOWER)
        for angles, speeds, found in (
            (turned, rates, "velocity of joint 'joint2' of arm 'arm' is 320 rad/s"),
            (3 * turned, rates / 100, "angle of joint 'joint1' of arm 'arm' is 1020 rad"),
        ):
            arm.reset(angles, speeds)
            run = world.run(0.01, on_divergence="stop")
            assert run.status.endswith(found)


@pytest.mark.parametrize(
    "answer", [np.full(3, np.nan), np.zeros(2), np.zeros((3, 3)), "much", None, [1.0, np.inf, 0.0]]
)
def test_what_is_no_torque_names_law_time_and_value(answer):
    def pushing(sense):
        return np.zeros(3) if sense.time < 0.5 else answer

    with World(gravity=FLAT) as world:
        world.add_arm("arm", planar(*BOOK), FOLLOWER)
        with pytest.raises(LawFailed, match=r"law .*pushing of arm 'arm' failed at 0.5 s: it gave .* 3 finite numbers"):
            world.run(1.0, {"arm": pushing})
        if np.shape(answer) == (3,):
            stopped = world.run(1.0, {"arm": pushing}, on_divergence="stop")
            assert "it gave" in stopped.status
            assert stopped.time[-1] == pytest.approx(0.5)


def test_an_error_in_a_law_names_law_and_time():
    with World(gravity=FLAT) as world:
        world.add_arm("arm", planar(*BOOK), FOLLOWER)
        with pytest.raises(LawFailed, match=r"failed at 0 s: ZeroDivisionError"):
            world.run(1.0, {"arm": lambda sense: 1 / 0})


def test_inner_loop_runs_at_every_physics_step_while_the_controller_keeps_its_period():
    instants, inner_instants = [], []

    def controller(sense):
        instants.append(sense.time)
        target = FOLLOWER.copy()

        def inner(now):
            inner_instants.append(now.time)
            return KP * (target - now.position) - KD * now.velocity

        return inner

    with World(step=2.5e-4, gravity=FLAT) as world:
        world.add_arm("arm", planar(*BOOK), FOLLOWER)
        world.run(0.01, {"arm": controller}, control_period=1e-3)
    np.testing.assert_allclose(instants, np.arange(10) * 1e-3, atol=1e-12)
    np.testing.assert_allclose(inner_instants, np.arange(40) * 2.5e-4, atol=1e-12)


def test_held_torque_changes_at_control_instants_alone():
    with World(step=2.5e-4, gravity=FLAT) as world:
        world.add_arm("arm", planar(*BOOK), FOLLOWER)
        run = world.run(0.01, {"arm": lambda s: np.full(3, s.time)}, control_period=1e-3)
    np.testing.assert_allclose(run["arm.torque"][:, 0], np.repeat(np.arange(10) * 1e-3, 4), atol=1e-12)


@pytest.mark.parametrize(("element", "times"), [(JointLoad("arm", joint_friction(0.1, 0.02)), 5), (None, 5),
                                               (TipForce("field", "arm", lambda t, x, v: FLAT), 20)])  # fmt: skip
def test_an_end_point_is_located_only_where_it_is_recorded_or_a_force_looks_at_it(element, times, monkeypatch):
    with World() as world:
        plant, found = world.add_arm("arm", planar(*BOOK), FOLLOWER), []
        levers = plant._planar.levers
        monkeypatch.setattr(plant._planar, "levers", lambda q: found.append(q) or levers(q))
        world.add(*[element] if element else [])
        world.run(0.02, {"arm": idle(plant)}, record_every=4)
    assert len(found) == times


@pytest.mark.parametrize("period", [None, 5e-3])
def test_damping_acts_at_every_step_whatever_the_control_period(period):
    arm, damping, step = planar([0.5], [1.0]), 30.0, 1e-3
    with World(step=step, gravity=FLAT) as world:
        world.add_arm("arm", arm, [0.0]).reset([0.0], [2.0])
        run = world.run(0.02, {"arm": lambda s: (np.zeros(1), np.array([damping]))}, control_period=period)
    inertia = 0.5**2 / 12 + 0.25**2
    decay = (1 + step * damping / inertia) ** -np.arange(20.0)
    np.testing.assert_allclose(run["arm.velocity"][:, 0], 2.0 * decay, rtol=1e-6, atol=1e-12)


def test_control_period_that_is_no_multiple_of_the_step_is_refused():
    with World() as world, pytest.raises(ValueError, match="no multiple of the physics step"):
        world.run(1.0, control_period=1.5e-3)


def test_stop_condition_ends_the_run_with_its_reason_and_events_happen_once():
    happened = []
    with World(gravity=FLAT) as world:
        world.add_arm("arm", planar(*BOOK), FOLLOWER)
        run = world.run(
            1.0, {"arm": hold(FOLLOWER)},
            probes={"events": lambda: float(len(happened)), "pair": lambda: np.array([1.0, 2.0])},
            stop=lambda t: "seen enough" if t >= 0.1 else None,
            events=[(0.05, lambda: happened.append(1))],
        )  # fmt: skip
    assert run.status == "seen enough"
    assert run.steps == 100
    assert run["events"].sum() == 51
    assert run["pair"].shape == (101, 2)


def test_every_tenth_step_is_recorded_on_request():
    with World(gravity=FLAT) as world:
        laws = pair(world)
        run = world.run(0.1, laws, record_every=10)
    np.testing.assert_allclose(run.time, np.arange(10) * 0.01, atol=1e-12)


def test_perturbation_moves_every_initial_joint_angle():
    with World(gravity=FLAT, perturbation=1e-3) as world:
        world.add_arm("arm", planar(*BOOK), FOLLOWER)
        run = world.run(0.001)
    np.testing.assert_allclose(run["arm.position"][0], FOLLOWER + 1e-3, atol=1e-15)


@pytest.mark.parametrize("speed", [2.0, 0.04])
def test_viscous_and_dry_friction_slow_a_joint_as_their_law_says(speed):
    arm = planar([0.5], [1.0])
    with World(gravity=FLAT) as world:
        world.add_arm("arm", arm, [0.0]).reset([0.0], [speed])
        world.add(JointLoad("arm", joint_friction(0.1, 0.02)))
        run = world.run(0.5)
    inertia = 0.5**2 / 12 + 0.25**2
    np.testing.assert_allclose(
        np.gradient(run["arm.velocity"][:, 0], run.time)[10:-10] * inertia,
        -(0.1 * run["arm.velocity"] + 0.02 * np.tanh(run["arm.velocity"] / 0.05))[10:-10, 0],
        rtol=4e-3,
    )


def test_mass_of_the_tool_can_change_during_a_run():
    arm, start = baxter("right", tool=palm()), posture("right")
    holding = RigidBodyModel(arm).gravity(start)
    with World() as world:
        world.add_arm("arm", arm, start)
        run = world.run(
            0.02, {"arm": lambda s: holding}, events=[(0.01, lambda: world.set_mass("arm", "palm", 2.1))]
        )  # fmt: skip
    assert np.abs(run["arm.velocity"][10]).max() < 1e-9
    assert np.abs(run["arm.velocity"][-1]).max() > 1e-2


def test_hanging_payload_pulls_with_its_weight_once_at_rest():
    arm, start = baxter("right"), posture("right")
    model = RigidBodyModel(arm)
    down = 1.5 * 9.81 * -jacobian(arm, start)[2]
    with World() as world:
        world.add_arm("arm", arm, start)
        world.hang("payload", "arm", mass=1.5, drop=0.05)
        gains = np.array([200.0, 200, 100, 100, 50, 50, 20])

        def law(sense):
            torque = model.gravity(sense.position) - down + gains * (start - sense.position)
            return torque, gains / 10

        run = world.run(1.0, {"arm": law})
    np.testing.assert_allclose(run["arm.position"][-1], start, atol=2e-3)
    np.testing.assert_allclose(run["payload.pose"][-1][2], run["arm.tip"][-1][2] - 0.05, atol=2e-3)


def test_progress_is_told_while_a_run_lasts(monkeypatch):
    told = []
    ticks = iter(np.arange(0.0, 1000.0, 0.6))
    monkeypatch.setattr("dexrepro.physics.loop.wall.perf_counter", lambda: next(ticks))
    monkeypatch.setattr(Progress, "report", staticmethod(lambda now, total: told.append((now, total))))
    with World(gravity=FLAT) as world:
        world.run(1.0)
    assert len(told) == 4, "each look at the clock is 0.6 s after the last one told"
    assert all(0 <= now < total == 1.0 for now, total in told)
    told.clear()
    ticks = iter(np.arange(0.0, 1000.0, 0.2))
    with World(gravity=FLAT) as world:
        world.run(1.0)
    assert len(told) == 1, "twice a second at most"


@settings(deadline=None, max_examples=10)
@given(st.floats(-1.5, 1.5), st.floats(-1.5, 1.5), st.floats(-3, 3))
def test_tip_velocity_is_the_jacobian_times_the_joint_rates(first, second, rate):
    arm = planar([0.4, 0.3], [1.0, 1.0], base=(0.1, 0.2, 0.3))
    with World(gravity=FLAT) as world:
        plant = world.add_arm("arm", arm, [first, second])
        plant.reset([first, second], [rate, -rate])
        expected = jacobian(arm, [first, second])[:3] @ [rate, -rate]
        np.testing.assert_allclose(plant.sense.tip_velocity, expected, atol=1e-12)


def test_torque_of_one_run_is_not_carried_into_the_next():
    with World(gravity=FLAT) as world:
        world.add_arm("arm", planar(*BOOK), FOLLOWER)
        world.run(0.01, {"arm": lambda s: np.ones(3)})
        assert (world.run(0.01)["arm.torque"] == 0).all()


def test_probes_with_memory_are_asked_once_a_sample():
    asked = []
    with World() as world:
        run = world.run(0.01, probes={"count": lambda: asked.append(1) or len(asked)})
    np.testing.assert_array_equal(run["count"], np.arange(1, 11))
