import numpy as np
import pytest

from dexrepro.physics.planar_batch import PlanarPairs
from dexrepro.robots.planar import PlanarChain

BASE = (np.array([[0.0], [0.5]]), 0.0)
CHAIN = PlanarChain((0.5, 0.3, 0.1), (1.5, 0.9, 0.2), base=BASE, functions=np)
LEADER, FOLLOWER = np.pi / 3 * np.array([2.0, -1.0, -1.0]), np.array([0.9112, 1.4184, 0.8120])


def pairs(runs=1, **changes):
    position = np.repeat(np.stack((LEADER, FOLLOWER), axis=1)[:, :, None], runs, axis=2)
    return PlanarPairs(CHAIN, position, **{**dict(stiffness=45.0, rest_length=0.55, dt=1e-3), **changes})


def test_the_object_pushes_along_the_line_between_the_tips():
    (x, y), force, magnitude = pairs().contact()
    assert force[1] / force[0] == pytest.approx((y[1] - y[0]) / (x[1] - x[0]))
    assert np.hypot(*force) == pytest.approx(magnitude)
    assert magnitude == pytest.approx(45.0 * (0.55 - np.hypot(x[1] - x[0], y[1] - y[0])))


def test_a_stretched_object_pulls_only_where_it_is_bilateral():
    _, _, magnitude = pairs(rest_length=0.45, unilateral=np.array([True, False]), runs=2).contact()
    assert magnitude[0] == 0
    assert magnitude[1] < 0


def test_energy_is_kept_without_torque():
    plant = pairs(dt=1e-5)

    def energy():
        """Spring energy plus half of dq . M dq, with M dq recovered from the acceleration under unit torques."""
        kinetic = 0.0
        for arm in range(2):
            columns = [plant.chain.acceleration(plant.position[:, arm, 0], np.zeros(3), e) for e in np.eye(3)]
            dq = plant.velocity[:, arm, 0]
            kinetic += 0.5 * dq @ np.linalg.solve(np.array(columns).T, dq)
        return kinetic + 0.5 * plant.contact()[2][0] ** 2 / 45.0

    before = energy()
    for _ in range(2000):
        plant.step(np.zeros((3, 2, 1)), plant.contact()[1])
    assert energy() == pytest.approx(before, rel=1e-3)
