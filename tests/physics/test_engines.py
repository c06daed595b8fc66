"""What every physics engine has to do, whichever of them is installed: the same statements about each."""

import numpy as np
import pinocchio as pin
import pytest

from dexrepro.physics import engine
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.world import World
from dexrepro.robots.baxter import baxter, palm, posture
from dexrepro.robots.planar import planar

RANDOM = np.random.default_rng(0)
STATES = [(RANDOM.uniform(-1.5, 1.5, 7), RANDOM.normal(size=7), RANDOM.normal(size=7)) for _ in range(20)]


@pytest.fixture(params=[word for word in engine.ENGINES if engine.is_installed(word)], autouse=True)
def word(request):
    engine.use(request.param)
    yield request.param
    engine.use(engine.default())


def test_dynamics_are_those_of_pinocchio():
    arm = baxter("right", tool=palm())
    peer = pin.buildModelFromXML(arm.urdf())
    data, model = peer.createData(), RigidBodyModel(arm)
    frame = peer.getFrameId("palm")
    for q, dq, ddq in STATES:
        mass = pin.crba(peer, data, q)
        np.testing.assert_allclose(model.mass_matrix(q), np.triu(mass) + np.triu(mass, 1).T, atol=1e-8)
        np.testing.assert_allclose(model.inverse_dynamics(q, dq, ddq), pin.rnea(peer, data, q, dq, ddq), atol=1e-8)
        np.testing.assert_allclose(model.bias(q, dq), pin.nonLinearEffects(peer, data, q, dq), atol=1e-8)
        np.testing.assert_allclose(model.gravity(q), pin.computeGeneralizedGravity(peer, data, q), atol=1e-8)
        pin.framesForwardKinematics(peer, data, q)
        place = data.oMf[frame] * pin.SE3(arm.tool.tip.matrix)
        position, rotation = model.forward(q)
        np.testing.assert_allclose(position, place.translation, atol=1e-8)
        np.testing.assert_allclose(rotation, place.rotation, atol=1e-8)


def test_jacobian_is_the_derivative_of_the_pose_and_gives_the_torque_of_a_force():
    model, nudge = RigidBodyModel(baxter("left", tool=palm())), 1e-6
    for q, force, _ in STATES[:5]:
        jacobian = model.jacobian(q)
        for joint, step in enumerate(nudge * np.eye(7)):
            (ahead, turned), (behind, other) = model.forward(q + step), model.forward(q - step)
            np.testing.assert_allclose(jacobian[:3, joint], (ahead - behind) / (2 * nudge), atol=1e-8)
            spin = (turned @ other.T - np.eye(3)) / (2 * nudge)
            np.testing.assert_allclose(jacobian[3:, joint], (spin[2, 1], spin[0, 2], spin[1, 0]), atol=1e-5)
        np.testing.assert_allclose(model.tip_torque(q, force[:3]), jacobian[:3].T @ force[:3], atol=1e-12)


def energy(model: RigidBodyModel, q: np.ndarray, dq: np.ndarray) -> float:
    """Kinetic and potential [J], the latter by the work of gravity along a straight way from zero."""
    ways = (np.arange(200) + 0.5) / 200
    return 0.5 * dq @ model.mass_matrix(q) @ dq + sum(model.gravity(share * q) @ q for share in ways) / 200


def test_a_free_arm_keeps_its_energy():
    arm = planar([0.4, 0.3, 0.2], [1.0, 0.8, 0.5])
    model = RigidBodyModel(arm, gravity=(0.0, -9.81, 0.0))
    drifts = []
    for step in (1e-3, 5e-4):
        with World(step=step, gravity=(0.0, -9.81, 0.0)) as world:
            world.add_arm("arm", arm, [0.3, 0.4, 0.2])
            run = world.run(0.3)
        held = [energy(model, run["arm.position"][k], run["arm.velocity"][k]) for k in (0, -1)]
        drifts.append(abs(held[1] - held[0]))
    assert drifts[0] < 0.01
    assert drifts[1] < 0.6 * drifts[0], "the error of a first-order integrator halves with the step"


def test_a_controlled_second_is_the_same_under_every_engine(word):
    """Free of contact and limits, the engines integrate the same equations by the same rule."""
    arm, start = baxter("right"), posture("right")

    def second(name: str) -> np.ndarray:
        engine.use(name)
        model = RigidBodyModel(arm)
        with World() as world:
            world.add_arm("arm", arm, start)
            law = lambda sense: (model.gravity(sense.position) + np.sin(6.0 * sense.time), np.full(7, 0.5))  # noqa: E731
            return world.run(1.0, {"arm": law})["arm.position"]

    np.testing.assert_allclose(second(word), second(engine.default()), atol=1e-7)


def test_a_force_on_the_end_point_moves_the_arm_as_its_torque_does():
    arm, start, force = baxter("right"), posture("right"), np.array((3.0, -2.0, 4.0))
    model, ends = RigidBodyModel(arm), []
    for pushed in (True, False):
        with World() as world:
            plant = world.add_arm("arm", arm, start)

            def law(sense, plant=plant, pushed=pushed):
                plant.locate()
                if pushed:
                    plant.push(*force)
                    return model.gravity(sense.position)
                return model.gravity(sense.position) + model.tip_torque(sense.position, force)

            ends.append(world.run(0.2, {"arm": law})["arm.position"][-1])
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-6)
    assert np.linalg.norm(ends[0] - start) > 0.01


def test_damping_is_implicit_also_where_it_is_large():
    with World() as world:
        world.add_arm("arm", baxter("right"), posture("right"))
        run = world.run(0.5, {"arm": lambda sense: (np.zeros(7), np.full(7, 500.0))})
    assert np.abs(run["arm.velocity"]).max() < 0.2


def test_a_hanging_payload_swings_with_its_period():
    """A sphere on a ball joint: 2 pi sqrt((I + m l^2) / (m g l)) for small angles."""
    arm, start, mass, drop, inertia = baxter("right"), posture("right"), 0.5, 0.2, 2e-3
    model, hold = RigidBodyModel(arm), 4000.0
    with World(step=5e-4) as world:
        world.add_arm("arm", arm, start)
        body = world.hang("payload", "arm", mass, drop, inertia=inertia)

        def law(sense):
            load = model.tip_torque(sense.position, (0.0, 0.0, mass * 9.81))
            return model.gravity(sense.position) + load + hold * (start - sense.position), np.full(7, 400.0)

        kick = [(0.05, lambda: body.push(4.0, 0.0, 0.0)), (0.0505, lambda: body.push(4.0, 0.0, 0.0))]
        run = world.run(4.0, {"arm": law}, events=kick)
    x = run["payload.pose"][:, 0] - run["arm.tip"][:, 0]
    after = run.time > 0.3
    x, time = x[after] - x[after].mean(), run.time[after]
    up = np.flatnonzero((x[:-1] < 0) & (x[1:] >= 0))
    crossings = time[up] - x[up] * (time[up + 1] - time[up]) / (x[up + 1] - x[up])
    expected = 2 * np.pi * np.sqrt((inertia + mass * drop**2) / (mass * 9.81 * drop))
    assert np.diff(crossings).mean() == pytest.approx(expected, rel=0.02)
    gap = np.linalg.norm(run["payload.pose"][:, :3] - run["arm.tip"], axis=1)
    np.testing.assert_allclose(gap, drop, atol=2e-3)


@pytest.mark.parametrize("angle", [0.3, 0.44, 0.49, 0.6])
def test_friction_holds_a_box_up_to_its_angle(angle):
    """Coulomb: coefficient 0.5 holds below atan(0.5) = 0.4636 rad; above, the box slides as it says."""
    with World() as world:
        world.add_box("slope", (3, 3, 0.1), (0, 0, 0), rpy=(0, angle, 0), friction=1.0)
        place = (0.1 * np.sin(angle), 0, 0.1 * np.cos(angle))
        world.add_box("box", (0.1, 0.1, 0.1), place, mass=0.3, rpy=(0, angle, 0), friction=0.5)
        run = world.run(0.7)
    moved = np.linalg.norm(run["box.pose"][-1, :3] - run["box.pose"][0, :3])
    slides = 0.5 * 0.699**2 * 9.81 * (np.sin(angle) - 0.5 * np.cos(angle))
    assert moved == pytest.approx(max(slides, 0.0), rel=0.06, abs=2e-3)


def test_contact_forces_balance_the_weight():
    with World() as world:
        world.add_box("table", (1, 1, 0.1), (0, 0, -0.05))
        world.add_box("lower", (0.2, 0.2, 0.2), (0, 0, 0.1), mass=0.6)
        world.add_box("upper", (0.1, 0.1, 0.1), (0, 0, 0.25), mass=0.4)
        world.run(1.0)
        assert world.contact_force("lower", "table") == pytest.approx(1.0 * 9.81, rel=0.02)
        assert world.contact_force("upper", "lower") == pytest.approx(0.4 * 9.81, rel=0.02)
        total = np.sum([touch.force for touch in world.contacts("lower")], axis=0)
        np.testing.assert_allclose(total, (0, 0, 0.6 * 9.81), atol=0.1)
        assert world.distance("lower", "table") == pytest.approx(0.0, abs=2e-3)
        assert world.distance("upper", "table") == pytest.approx(0.2, abs=2e-3)


@pytest.mark.parametrize(("squeeze", "holds"), [(30.0, True), (4.0, False)])
def test_two_palms_hold_a_box_if_they_press_enough(squeeze, holds):
    """Palms of friction 0.5 on a box of 1: two contacts carry 2 x 0.5 x squeeze; the box weighs 9.8 N."""
    with World() as world:
        arms = {side: baxter(side, tool=palm()) for side in ("left", "right")}
        models = {side: RigidBodyModel(arm) for side, arm in arms.items()}
        starts = {side: held_posture(models[side], side) for side in arms}
        for side, arm in arms.items():
            world.add_arm(side, arm, starts[side], contacts=True)
        world.add_box("box", (0.1, 0.2, 0.1), (0.6, 0.0, 0.2), mass=1.0, friction=1.0)

        def law(side):
            inward = np.array((0.0, -1.0 if side == "left" else 1.0, 0.0))
            stiff = np.diag((800.0, 0.0, 800.0, 20.0, 20.0, 20.0))

            def torque(sense):
                q, model = sense.position, models[side]
                jacobian = model.jacobian(q)
                goal, turn = model.forward(starts[side])
                place, now = model.forward(q)
                off = 0.5 * sum(np.cross(a, b) for a, b in zip(now.T, turn.T))
                wrench = stiff @ np.r_[goal - place, off] + np.r_[squeeze * inward, 0, 0, 0]
                return model.gravity(q) + jacobian.T @ wrench, np.full(7, 2.0)

            return torque

        run = world.run(1.0, {side: law(side) for side in arms})
        fell = 0.2 - run["box.pose"][-1, 2]
        if holds:
            assert fell < 0.02
            assert world.contact_force("left", "box") == pytest.approx(squeeze, rel=0.1)
        else:
            assert fell > 0.3


def held_posture(model: RigidBodyModel, side: str) -> np.ndarray:
    """Joint angles at which a palm stands upright at the side of a box of width 0.2 m."""
    from dexrepro.robots.inverse_kinematics import nearest

    sign = 1.0 if side == "left" else -1.0
    rotation = np.array(((0.0, 1.0, 0.0), (0.0, 0.0, -sign), (-sign, 0.0, 0.0)))
    return nearest(model.arm, posture(side), np.array((0.6, sign * 0.1005, 0.2)), rotation)


def test_a_gripped_body_moves_with_the_arm():
    arm, start = baxter("right"), posture("right")
    model = RigidBodyModel(arm)
    with World() as world:
        plant = world.add_arm("arm", arm, start)
        plant.locate()
        body = world.add_sphere("ball", 0.03, (plant.x + 0.02, plant.y, plant.z - 0.05), mass=0.05, collides=False)
        world.grip("arm", "ball")
        run = world.run(0.5, {"arm": lambda sense: model.gravity(sense.position) + 0.5})
    rotations = [model.forward(run["arm.position"][k])[1] for k in (0, -1)]
    offsets = [run["ball.pose"][k, :3] - run["arm.tip"][k] for k in (0, -1)]
    np.testing.assert_allclose(rotations[1].T @ offsets[1], rotations[0].T @ offsets[0], atol=2e-3)
    assert np.linalg.norm(run["arm.tip"][-1] - run["arm.tip"][0]) > 0.02
    assert body.mass == 0.05


def test_two_runs_are_the_same_to_the_last_bit():
    def run():
        with World() as world:
            world.add_arm("arm", planar([0.5, 0.4], [1.0, 0.8]), [0.3, 0.9], contacts=True)
            world.add_box("box", (0.1, 0.1, 0.1), (0.3, 0.75, 0.0), mass=0.3)
            return world.run(0.6, {"arm": lambda sense: [0.8, 0.2]})

    first, second = run(), run()
    for name, values in first.series.items():
        np.testing.assert_array_equal(values, second[name], err_msg=name)


def test_a_picture_leaves_the_state_as_it_was():
    moved = []
    for looks in (False, True):
        with World() as world:
            world.add_arm("arm", baxter("right"), posture("right"))
            world.add_box("box", (0.2, 0.2, 0.2), (0.6, 0.0, 0.4), mass=0.5)
            events = [(0.05, lambda world=world: world.render({"arm": np.zeros(7)}, size=(60, 40)))] if looks else []
            moved.append(world.run(0.1, events=events)["arm.position"])
    np.testing.assert_array_equal(*moved)


def test_an_overhead_camera_sees_heights():
    from dexrepro.physics.rendering import Overhead

    camera = Overhead((0.5, 0.0, 1.0), size=(60, 60))
    with World() as world:
        world.add_box("table", (1, 1, 0.1), (0.5, 0.0, -0.05), colour=(0.2, 0.2, 0.2, 1.0))
        world.add_box("box", (0.2, 0.1, 0.1), (0.5, 0.0, 0.05), colour=(0.9, 0.1, 0.1, 1.0))
        colours, heights = world.look_down(camera)
    column, row = np.round(camera.project(np.array((0.5, 0.0, 0.1)))).astype(int)
    assert heights[row, column] == pytest.approx(0.1, abs=2e-3)
    assert heights[2, 2] == pytest.approx(0.0, abs=2e-3)
    red, green, _ = colours[row, column].astype(int)
    assert red > 2 * green


def test_a_heavier_tool_weighs_more():
    arm, start = baxter("right", tool=palm()), posture("right")
    model = RigidBodyModel(arm)
    falls = []
    for mass in (0.1, 1.1):
        with World() as world:
            world.add_arm("arm", arm, start)
            world.set_mass("arm", "palm", mass)
            run = world.run(0.02, {"arm": lambda sense: model.gravity(start)})
        falls.append(run["arm.velocity"][-1])
    assert np.abs(falls[0]).max() < 1e-3
    assert np.abs(falls[1]).max() > 0.05


def test_a_soft_contact_sinks_by_its_stiffness(word):
    """Four points of 500 N/m carry 2 kg with 9.81 mm of overlap; PyBullet reports it to a tenth."""
    with World() as world:
        world.add_box("table", (1, 1, 0.1), (0, 0, -0.05))
        world.add_box("box", (0.2, 0.2, 0.2), (0, 0, 0.1), mass=2.0, contactStiffness=500.0, contactDamping=20.0)
        run = world.run(2.0)
    assert 0.1 - run["box.pose"][-1, 2] == pytest.approx(2.0 * 9.81 / 2000.0, rel=0.1)


@pytest.mark.filterwarnings("ignore:MuJoCo")
def test_what_diverges_is_seen_to_diverge(tmp_path, monkeypatch):
    """An engine that put everything back to the start, as MuJoCo does by itself, would hide it."""
    monkeypatch.chdir(tmp_path)
    with World() as world:
        world.add_arm("arm", baxter("right"), posture("right"))
        run = world.run(2.0, {"arm": lambda sense: 1e4 * sense.velocity + 1.0}, on_divergence="stop")
    assert run.status.startswith("diverged at")
    assert not list(tmp_path.iterdir())


def test_unseen_pictures_are_black_and_what_the_robot_sees_is_drawn():
    from dexrepro.physics.rendering import Overhead

    with World() as world:
        world.add_box("box", (0.4, 0.4, 0.2), (0.5, 0, 0.1), colour=(0.9, 0.2, 0.1, 1.0))
        with engine.unseen():
            assert world.render(size=(60, 40)).shape == (40, 60, 3)
            assert not world.render(size=(60, 40)).any()
            assert world.look_down(Overhead((0.5, 0.0, 1.5), size=(60, 40)))[0].any()
        assert world.render(size=(60, 40)).any()
