"""The two planar arms of Sect. 2.4.1: the scene, both controllers and the run that all planar experiments share."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from dexrepro.control.holding_line import HoldingLineRegulation
from dexrepro.control.joint_pd import JointPD
from dexrepro.experiment import Config, Recording
from dexrepro.physics.elements import Elastic
from dexrepro.physics.world import World
from dexrepro.robots.planar import planar
from dexrepro.robots.planar_chain import PlanarChain


def scene(config: Config) -> World:
    """Leader-driven arm, assistive follower and the elastic object between their tips, in a horizontal plane."""
    world = World(step=config.step, gravity=(0, 0, 0), perturbation=config.perturbation)
    for name in ("leader", "follower"):
        arm = planar(config.arm.lengths, config.arm.masses, base=config[name].base)
        world.add_arm(name, arm, config[name].pose)
    between = ("follower", "leader")
    world.add(Elastic("object", between, config.stiffness, config.rest_length, unilateral=True))
    return world


def simulate(config: Config) -> Recording:
    """Run the pair; besides the World's channels, records the follower's ``reference`` and its ``estimate`` if any.

    ``reference``: x_1,r along the holding line before the workspace bounds, and the lateral position asked for [m].
    ``estimate``: rest position [m], stiffness [N/m] and velocity of that position [m/s] as believed.
    """
    leader, follower = Leader(config), Follower(config)
    probes: dict[str, Callable[[], Any]] = {"reference": lambda: follower.reference}
    estimation = getattr(config.law, "estimation", None)
    if estimation is not None:
        probes["estimate"] = lambda: (estimation.position, estimation.stiffness, estimation.velocity)
    with scene(config) as world:
        return world.run(config.duration, {"leader": leader, "follower": follower}, probes=probes, on_divergence="stop")


def path(config: Config) -> Callable[[float], tuple[float, float]]:
    """Displacement (x, y) [m] of the leader's path at time t [s]: Traj. 1 along the holding line, Traj. 2 across it."""
    amplitude, drift, rate = config.leader.amplitude, config.leader.drift, 2 * math.pi / config.period
    if config.leader.trajectory == 1:
        return lambda t: (amplitude * math.sin(rate * t), 0.0)
    return lambda t: (drift * t, amplitude * math.sin(rate * t))


class TipServo:
    """Joint PD behind closed-loop inverse kinematics: takes the tip where it is told, in spite of the contact force."""

    def __init__(self, config: Config, base: tuple[float, float]) -> None:
        self.chain = PlanarChain(config.arm.lengths, config.arm.masses, base)
        self._pd = JointPD(stiffness=np.array(config.arm.stiffness), damping=np.array(config.arm.damping))
        self._damping = config.arm.ik_damping
        self._joints: Any = None

    def __call__(self, sense: Any, target: tuple[float, float]) -> Any:
        """Torque [N m] towards a tip position (x, y) [m], the measured contact force compensated."""
        q = sense.position.tolist()
        self._joints = self.chain.approach(self._joints or q, target, self._damping)
        return self._pd(self._joints, sense.position, sense.velocity) - self.chain.tip_torque(q, sense.force.tolist())


class Leader:
    """The directly teleoperated follower: its tip repeats the operator's displacement."""

    def __init__(self, config: Config) -> None:
        self._servo, self._path = TipServo(config, config.leader.base), path(config)
        self._home = self._servo.chain.forward(config.leader.pose)

    def __call__(self, sense: Any) -> Any:
        dx, dy = self._path(sense.time)
        return self._servo(sense, (self._home[0] + dx, self._home[1] + dy))


class Follower:
    """The assistive follower: from its own state and the force it feels to the torque of its joints, nothing else.

    reference: the last x_1,r and y_1,d [m].
    """

    def __init__(self, config: Config) -> None:
        self._law, self._servo = config.law, TipServo(config, config.follower.base)
        self._regulation = HoldingLineRegulation(gain=config.follower.regulation)
        self._low, self._high = config.follower.workspace
        self._home: tuple[float, float] | None = None
        self.reference = (0.0, 0.0)

    def __call__(self, sense: Any) -> Any:
        x, y = self._servo.chain.forward(sense.position.tolist())
        if self._home is None:
            self._home = x, y
            self._law.reset(x)
        fx, fy, _ = sense.force.tolist()
        along, across = self._law(x, fx), self._home[1] + self._regulation(fy)
        self.reference = along, across
        return self._servo(sense, (min(max(along, self._low), self._high), across))
