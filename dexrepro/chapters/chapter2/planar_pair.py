"""The two planar arms of Sect. 2.4.1: the scene, both controllers and the run that all planar experiments share."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from dexrepro.control.contract import HoldingLaw, Measured, report
from dexrepro.control.holding_line import HoldingLineRegulation
from dexrepro.control.motion import Motion
from dexrepro.control.target_impedance import TargetImpedance
from dexrepro.experiment import Config, Recording
from dexrepro.physics.drive import HoldingDrive
from dexrepro.physics.elements import Elastic, Ends
from dexrepro.physics.plant import Controller
from dexrepro.physics.world import World
from dexrepro.robots.planar import Links, PlanarChain, planar

REST = (0.0, 0.0)
ESTIMATE = ("rest_position", "stiffness", "rest_velocity")


def scene(config: Config) -> World:
    """Leader-driven arm, assistive follower and the elastic object between their tips, in a horizontal plane."""
    world = World(step=config.step, gravity=(0, 0, 0), perturbation=config.perturbation)
    for name in ("leader", "follower"):
        arm = planar(config.arm.lengths, config.arm.masses, base=config[name].base)
        world.add_arm(name, arm, config[name].pose)
    if config.get("object_model", "central") == "central":
        between = ("follower", "leader")
        world.add(Elastic("object", between, config.stiffness, config.rest_length, unilateral=True))
    else:
        world.add(ConstantVector(config.stiffness, config.rest_length))
    return world


def simulate(config: Config) -> Recording:
    """Run the pair with the law of the configuration, every sample recorded; see ``run``."""
    with scene(config) as world:
        return run(world, config, config.law, record_every=1)


def run(world: World, config: Config, law: HoldingLaw, record_every: int = 5) -> Recording:
    """Run the pair; besides the World's channels, records the follower's ``reference`` and its ``estimate`` if any.

    ``reference``: x_1,r along the holding line before the workspace bounds, and the lateral position asked for [m].
    ``estimate``: rest position [m], stiffness [N/m] and velocity of that position [m/s] as the law believes.
    The run ends once the force is that of the fully squeezed object.
    """
    follower = Follower(config, law)
    probes: dict[str, Callable[[], Any]] = {"reference": lambda: follower.reference}
    if set(ESTIMATE) <= report(law).keys():
        probes["estimate"] = lambda: tuple(map(report(law).get, ESTIMATE))
    contact: Any = world.elements[0]
    limit = config.stiffness * config.rest_length

    def squeezed(time: float) -> str | None:
        force = contact.force
        return f"diverged at {time:.4g} s: the force is {force:.4g} N" if force >= limit else None

    controllers: dict[str, Controller] = {"leader": Leader(config), "follower": follower}
    return world.run(
        config.duration, controllers, probes=probes, stop=squeezed, record_every=record_every, on_divergence="stop"
    )


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
        self._stiffness, self._brake = config.arm.stiffness, config.arm.damping
        self._damping = config.arm.ik_damping
        self._joints: Any = None

    def __call__(self, sense: Any, target: tuple[float, float], links: Links | None = None) -> list[float]:
        """Torque [N m] towards a tip position (x, y) [m], the measured contact force compensated."""
        q, (fx, fy, _) = sense.angles, sense.felt
        self._joints = self.chain.approach(self._joints or q, target, self._damping)
        contact = self.chain.tip_torque(q, (fx, fy), links)
        # Plain floats are several times faster here than arrays of three.
        parts = zip(self._stiffness, self._joints, q, self._brake, sense.rates, contact)
        return [k * (r - a) - d * v - t for k, r, a, d, v, t in parts]


class ImpedanceServo:
    """The same interface for an arm that realises the target impedance of Eq. (2.25) itself."""

    def __init__(self, config: Config, base: tuple[float, float]) -> None:
        self.chain = PlanarChain(config.arm.lengths, config.arm.masses, base)
        self._law = TargetImpedance(model=self.chain, desired_force=config.desired_force, **config.impedance)

    def __call__(self, sense: Any, target: tuple[float, float], links: Links | None = None) -> Any:
        measured = Measured(sense.time, math.nan, math.nan, sense.felt[:2], sense.angles, sense.rates)
        return self._law(measured, Motion(target, REST, REST)).torque


class Leader:
    """The directly teleoperated follower: its tip repeats the operator's displacement."""

    def __init__(self, config: Config) -> None:
        self._servo, self._path = TipServo(config, config.leader.base), path(config)
        self._home = self._servo.chain.forward(config.leader.pose)

    def __call__(self, sense: Any) -> list[float]:
        dx, dy = self._path(sense.time)
        return self._servo(sense, (self._home[0] + dx, self._home[1] + dy))


class Follower:
    """The assistive follower: from its own state and the force it feels to the torque of its joints, nothing else.

    reference: the last x_1,r and y_1,d [m].
    """

    def __init__(self, config: Config, law: HoldingLaw) -> None:
        servo = ImpedanceServo if config.get("realisation") == "impedance" else TipServo
        self.law, self._servo = HoldingDrive(law), servo(config, config.follower.base)
        printed = config.follower.get("regulation_printed", True)
        self._regulation = HoldingLineRegulation(gain=config.follower.regulation, printed=printed)
        self._low, self._high = config.follower.workspace
        self._home: tuple[float, float] | None = None
        self.reference = (0.0, 0.0)

    def __call__(self, sense: Any) -> Any:
        links = self._servo.chain.links(sense.angles)
        x, y = self._servo.chain.forward(sense.angles, links)
        if self._home is None:
            self._home = x, y
            self.law.reset(sense.time, x)
        fx, fy, _ = sense.felt
        along, across = self.law(sense.time, x, fx), self._home[1] + float(self._regulation(fy))
        self.reference = along, across
        low, high = self._low, self._high
        return self._servo(sense, (low if along < low else high if along > high else along, across), links)


class ConstantVector:
    """The other reading of Eqs. (2.3)-(2.5): D keeps its direction, so the force has the lateral part k_o (y_2 - y_1).

    A force element in place of ``Elastic``, with the same channels; it never pulls along the holding line.
    """

    name = "object"

    def __init__(self, stiffness: float, rest_length: float) -> None:
        self._stiffness, self._rest_length = stiffness, rest_length
        self.force = self.length = 0.0

    def bind(self, world: Ends) -> Callable[[float], None]:
        follower, leader = world.end("follower"), world.end("leader")

        def apply(time: float) -> None:
            dx, dy = follower.x - leader.x, follower.y - leader.y
            along, across = self._stiffness * (self._rest_length - dx), -self._stiffness * dy
            self.length = math.hypot(dx, dy)
            self.force = math.hypot(along, across) if along > 0 else 0.0
            if self.force:
                follower.push(along, across, 0.0)
                leader.push(-along, -across, 0.0)

        return apply

    def channels(self) -> dict[str, float]:
        return {"force": self.force, "length": self.length}
