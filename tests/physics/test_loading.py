"""Arms reach the engine as they are described."""

from __future__ import annotations

from dataclasses import replace

import pytest

from dexrepro.robots.arm import Arm
from dexrepro.robots.baxter import baxter

bullet = pytest.importorskip("pybullet")

from dexrepro.physics.engines.pybullet import connect, load_arm  # noqa: E402


def joint_places(arm: Arm) -> list[tuple[object, ...]]:
    client = connect()
    try:
        body = load_arm(client, arm)
        return [bullet.getJointInfo(body, index, physicsClientId=client)[13:16] for index in range(arm.dof)]
    finally:
        bullet.disconnect(client)


@pytest.fixture(scope="module")
def places() -> list[tuple[object, ...]]:
    return joint_places(baxter("right"))


@pytest.mark.parametrize("letters", range(500, 1500, 11))
def test_a_long_description_is_read_whole_wherever_the_engine_cuts_it(letters: int, places: list[object]) -> None:
    arm = replace(baxter("right"), name=letters * "a")
    assert len(arm.urdf()) > 8192
    assert joint_places(arm) == places
