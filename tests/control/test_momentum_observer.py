import numpy as np
import pytest

from dexrepro.control.momentum_observer import MomentumObserver
from dexrepro.physics.elements import Push
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.world import World
from dexrepro.robots.baxter import baxter, posture


@pytest.mark.parametrize("gain", [5.0, 50.0, 500.0])
def test_constant_torque_is_seen_with_the_lag_of_the_gain(gain):
    h, external, velocity = 1e-3, 2.0, 0.0
    observer, seen = MomentumObserver(gain=gain, dt=h), []
    for _ in range(300):
        seen.append(float(observer(np.eye(1), np.array([velocity]), np.zeros(1), np.zeros(1))[0]))
        velocity += h * external
    steps = np.arange(300)
    assert np.array(seen) == pytest.approx(external * (1 - (1 - gain * h) ** steps), abs=1e-9)


def swing(external):
    """Baxter's arm driven by growing torques; largest torque observed and the last one."""
    arm = baxter("right")
    model, observer = RigidBodyModel(arm), MomentumObserver(gain=50, dt=1e-3)
    seen = []
    with World() as world:
        plant = world.add_arm("right", arm, posture("right"))
        world.add(Push("right", lambda time: external))

        def controller(sense):
            q, dq = sense.position, sense.velocity
            seen.append(observer(model.mass_matrix(q), dq, model.bias(q, dq), np.array(plant.torque)))
            return model.gravity(q) + np.array([3, -3, 2, 2, 0.1, 0.1, 0.002]) * np.sin(6 * sense.time)

        recording = world.run(0.4, {"right": controller})
    jacobian = model.jacobian(recording["right.position"][-1])[:3]
    model.close()
    return np.array(seen), jacobian.T @ np.array(external)


def test_nothing_is_observed_where_nothing_pushes():
    seen, _ = swing((0.0, 0.0, 0.0))
    assert np.abs(seen).max() < 1e-6


def test_a_push_on_the_moving_arm_is_observed():
    seen, expected = swing((0.0, 10.0, 0.0))
    # The arm swings on during the observer's lag of 20 ms.
    assert seen[-1] == pytest.approx(expected, abs=0.1 * np.abs(expected).max())


def test_gains_beyond_two_over_the_period_are_unstable():
    for gain, stable in ((1900.0, True), (2100.0, False)):
        observer, velocity = MomentumObserver(gain=gain, dt=1e-3), 0.0
        for _ in range(400):
            observer(np.eye(1), np.array([velocity]), np.zeros(1), np.zeros(1))
            velocity += 1e-3
        assert (abs(observer.torque[0]) < 10) == stable
