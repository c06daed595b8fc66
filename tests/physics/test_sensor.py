"""Sensors delay, filter and quantise as stated."""

import numpy as np
import pytest

from dexrepro.physics.elements import TipForce
from dexrepro.physics.sensor import ForceChannel, JointChannel, Sensor
from dexrepro.physics.world import World
from dexrepro.robots.planar import planar


def test_low_pass_answers_a_step_with_its_time_constant():
    channel = ForceChannel(Sensor(force_cutoff=5.0), 1e-3, None)
    channel((0, 0, 0))
    values = np.array([channel((1, 1, 1))[0] for _ in range(200)])
    np.testing.assert_allclose(values, 1 - np.exp(-2 * np.pi * 5.0 * 1e-3 * np.arange(1, 201)), atol=1e-12)


def test_force_is_late_by_whole_control_periods():
    channel = ForceChannel(Sensor(force_delay=3e-3), 1e-3, None)
    values = [channel((k, k, k))[0] for k in range(1, 8)]
    assert values == [0, 0, 0, 1, 2, 3, 4]


def test_noise_has_the_stated_deviation_and_needs_a_generator():
    channel = ForceChannel(Sensor(force_noise=0.05), 1e-3, np.random.default_rng(0))
    values = np.array([channel((0, 0, 0)) for _ in range(4000)])
    assert values.std() == pytest.approx(0.05, rel=0.03)
    with pytest.raises(ValueError, match="needs a random generator"):
        ForceChannel(Sensor(force_noise=0.05), 1e-3, None)
    with pytest.raises(ValueError, match="need a random generator"):
        JointChannel(Sensor(velocity_noise=0.05), 1e-3, None)


def test_encoder_rounds_angles_and_velocity_comes_from_their_differences():
    channel = JointChannel(Sensor(encoder_resolution=1e-3, velocity_cutoff=20.0), 1e-3, None)
    rates = []
    for k in range(1000):
        position, velocity = channel(np.array([0.5e-3 * k]), np.array([0.5]))
        assert position[0] / 1e-3 == pytest.approx(round(position[0] / 1e-3), abs=1e-9)
        rates.append(velocity[0])
    assert np.mean(rates[-200:]) == pytest.approx(0.5, rel=0.01)
    assert np.ptp(rates[-200:]) > 0.01


def test_controller_sees_the_filtered_force_and_the_recording_has_both():
    seen = []
    sensor = Sensor(force_noise=0.1, force_cutoff=10.0)
    with World(gravity=(0, 0, 0)) as world:
        world.add_arm("arm", planar([0.5, 0.3], [1, 1]), [0.3, 0.4], sensor=sensor, rng=np.random.default_rng(1))
        world.add(TipForce("field", "arm", lambda t, x, v: (1.0, 2.0, 0.0)))

        def law(sense):
            seen.append(sense.force)
            return np.zeros(2)

        run = world.run(0.05, {"arm": law})
    np.testing.assert_array_equal(run["arm.sensed_force"], seen)
    np.testing.assert_array_equal(run["arm.force"], np.tile((1.0, 2.0, 0.0), (50, 1)))
    assert np.ptp(run["arm.sensed_force"][:, 2]) > 0


def test_measured_tip_follows_the_measured_angles():
    tips = []
    with World(gravity=(0, 0, 0)) as world:
        world.add_arm("arm", planar([1.0], [1.0]), [0.0123], sensor=Sensor(encoder_resolution=0.01))
        world.run(0.001, {"arm": lambda s: tips.append(s.tip) or np.zeros(1)})
    np.testing.assert_allclose(tips[0], (np.cos(0.01), np.sin(0.01), 0), atol=1e-12)


def test_measured_tip_velocity_rests_on_measured_rates():
    rng, speeds = np.random.default_rng(0), []
    with World(gravity=(0, 0, 0)) as world:
        arm = planar([1.0], [1.0])
        world.add_arm("arm", arm, [0.0], sensor=Sensor(velocity_noise=0.1), rng=rng)
        world.run(0.01, {"arm": lambda s: speeds.append((s.tip_velocity[1], s.velocity[0])) or np.zeros(1)})
    measured, rates = np.array(speeds).T
    np.testing.assert_allclose(measured, rates, atol=1e-12)
    assert np.ptp(rates) > 0.05


def test_a_sensor_is_exact_only_where_nothing_is_said_of_it_and_draws_no_noise_that_it_has_not():
    assert Sensor().exact_force
    assert Sensor().exact_joints
    for rough in (Sensor(encoder_resolution=1e-3), Sensor(velocity_noise=0.1), Sensor(velocity_cutoff=20.0)):
        assert not rough.exact_joints
        assert rough.exact_force
    for rough in (Sensor(force_noise=0.1), Sensor(force_delay=0.01), Sensor(force_cutoff=20.0)):
        assert not rough.exact_force
        assert rough.exact_joints
    rng = np.random.default_rng(0)
    ForceChannel(Sensor(force_cutoff=20.0), 1e-3, rng)((1.0, 2.0, 3.0))
    assert rng.standard_normal() == np.random.default_rng(0).standard_normal()
