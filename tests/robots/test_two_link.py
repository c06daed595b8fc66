import numpy as np
import pytest

from dexrepro.robots.kinematics import forward, jacobian
from dexrepro.robots.planar import planar
from dexrepro.robots.two_link import TwoLink

ARM, CLOSED = planar([1.0, 0.7], [10.0, 10.0], [0.83, 0.83]), TwoLink([1.0, 0.7])


@pytest.mark.parametrize("q", [(0.3, 1.2), (-1.0, -2.0)])
def test_closed_forms_are_those_of_the_arm(q):
    angles = np.array(q)
    assert CLOSED.position(angles) == pytest.approx(forward(ARM, angles)[0][:2])
    assert CLOSED.jacobian(angles) == pytest.approx(jacobian(ARM, angles)[:2])


@pytest.mark.parametrize("elbow", [-1, 1])
def test_both_elbows_reach_the_same_point(elbow):
    q = CLOSED.inverse([0.6, 0.8], elbow)
    assert CLOSED.position(q) == pytest.approx([0.6, 0.8])
    assert np.sign(q[1]) == elbow


def test_a_place_out_of_reach_is_refused():
    with pytest.raises(ValueError, match=r"\(2, 0\) m is out of reach"):
        CLOSED.inverse([2.0, 0.0])
