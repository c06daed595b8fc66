"""A simulated world: what stands in it, and how to run it."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TypedDict, Unpack

import numpy as np
from numpy.typing import ArrayLike

from dexrepro.arrays import Array, Image
from dexrepro.experiment import Recording
from dexrepro.physics import loop
from dexrepro.physics.elements import Element, Place
from dexrepro.physics.engine import engine
from dexrepro.physics.plant import Controller, Point, RigidBody, SimulatedArm, Touch
from dexrepro.physics.rendering import Camera, Overhead, Solid
from dexrepro.physics.sensor import Sensor
from dexrepro.robots.arm import GREY, Arm, Colour, Shape

Vector = Sequence[float]


class BodyOptions(TypedDict, total=False):
    """What :meth:`World.add_body` takes beside name, shapes, position and mass; the last seven by PyBullet's names."""

    rpy: Vector
    inertia: Vector
    friction: float
    collides: bool
    spinningFriction: float
    rollingFriction: float
    restitution: float
    contactStiffness: float
    contactDamping: float
    linearDamping: float
    angularDamping: float


class World:
    """A scene of its own, closed at the end of a ``with`` block; several may live side by side.

    step: physics step [s]; gravity: (3,) [m/s^2]; perturbation: added to every initial joint angle [rad];
    iterations: of PyBullet's contact solver. The world frame has z up; positions in m, forces in N. Setting
    ``World.live`` makes every world open a window and run in real time; ``World.meshes`` shows arms as their makers
    drew them.
    """

    live = meshes = False

    def __init__(
        self,
        step: float = 1e-3,
        gravity: Vector = (0.0, 0.0, -9.81),
        perturbation: float = 0.0,
        iterations: int = 50,
    ) -> None:
        self.step, self.time, self.gui = step, 0.0, World.live
        self.perturbation = perturbation
        self.scene = engine().scene(step, gravity, iterations, self.gui)
        self.arms: dict[str, SimulatedArm] = {}
        self.bodies: dict[str, RigidBody] = {}
        self.elements: list[Element] = []

    def __enter__(self) -> World:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Free what the engine holds; the world cannot be used afterwards."""
        self.scene.close()

    def add_arm(
        self,
        name: str,
        arm: Arm,
        position: ArrayLike,
        contacts: bool = False,
        sensor: Sensor = Sensor(),
        rng: np.random.Generator | None = None,
    ) -> SimulatedArm:
        """Place an arm with initial joint angles (n,) [rad], at rest.

        contacts: whether its links touch other bodies (if so its force sensor feels contacts of the last link and
        the tool). sensor, rng: imperfections of its sensors and the generator of their noise.
        """
        self._check_new(name)
        start = np.asarray(position, dtype=float) + self.perturbation
        meshes = World.meshes or self.gui
        plant = self.scene.arm(name, arm, start, contacts=contacts, sensor=sensor, rng=rng, meshes=meshes)
        plant.feels_contact = contacts
        self.arms[name] = plant
        return plant

    def add_body(
        self,
        name: str,
        shapes: Sequence[Shape],
        position: Vector,
        rpy: Vector = (0.0, 0.0, 0.0),
        mass: float = 0.0,
        inertia: Vector | None = None,
        friction: float = 0.5,
        collides: bool = True,
        **contact: float,
    ) -> RigidBody:
        """Place a rigid body of one or more shapes; static if its mass [kg] is 0.

        friction: lateral coefficient (PyBullet multiplies those of two bodies). inertia: principal moments [kg m^2],
        by default those of the shapes. contact: further arguments of PyBullet's changeDynamics, such as
        spinningFriction, rollingFriction, contactStiffness with contactDamping, restitution.
        """
        self._check_new(name)
        self.bodies[name] = self.scene.rigid_body(
            shapes, position, rpy, mass=mass, inertia=inertia,
            friction=friction, collides=collides, contact=contact,
        )  # fmt: skip
        return self.bodies[name]

    def add_box(
        self,
        name: str,
        size: Vector,
        position: Vector,
        mass: float = 0.0,
        colour: Colour = GREY,
        **options: Unpack[BodyOptions],
    ) -> RigidBody:
        """A box with sides (x, y, z) [m], centred at a position [m]; options as for add_body."""
        return self.add_body(name, [Shape("box", tuple(size), colour=colour)], position, mass=mass, **options)

    def add_sphere(
        self,
        name: str,
        radius: float,
        position: Vector,
        mass: float = 0.0,
        colour: Colour = GREY,
        **options: Unpack[BodyOptions],
    ) -> RigidBody:
        """A sphere of a radius [m], centred at a position [m]; options as for add_body."""
        return self.add_body(name, [Shape("sphere", (radius,), colour=colour)], position, mass=mass, **options)

    def hang(
        self,
        name: str,
        arm: str,
        mass: float,
        drop: float,
        radius: float = 0.05,
        inertia: float = 2e-3,
        angular_damping: float = 0.0,
    ) -> RigidBody:
        """Hang a sphere (mass [kg], moment of inertia [kg m^2]) on a ball joint at an arm's end point.

        Its centre starts ``drop`` [m] below the end point and swings freely; it touches nothing.
        """
        plant = self.arm(arm)
        plant.read()
        plant.locate()
        body = self.add_sphere(
            name, radius, (plant.x, plant.y, plant.z - drop), mass, collides=False, inertia=[inertia] * 3,
            angularDamping=angular_damping,
        )  # fmt: skip
        self.scene.hinge(plant, body, (0.0, 0.0, drop))
        plant.burdened = True
        return body

    def add(self, *elements: Element) -> None:
        """Add force elements (Elastic, Push, TipForce, JointLoad or your own)."""
        self.elements.extend(elements)

    def set_mass(self, arm: str, link: str, mass: float) -> None:
        """Change the mass [kg] of one body of an arm, for instance of a tool that has taken up a payload."""
        self.arm(arm).set_mass(link, mass)

    def arm(self, name: str) -> SimulatedArm:
        """The arm of a name. Raises KeyError, naming those there are, where there is none."""
        try:
            return self.arms[name]
        except KeyError:
            raise KeyError(f"no arm '{name}' in the world; there are: {', '.join(self.arms)}") from None

    def end(self, place: Place) -> Point:
        """What a name or a fixed point (x, y, z) [m] stands for."""
        if not isinstance(place, str):
            x, y, z = place
            return Point((x, y, z))
        return self.bodies[place] if place in self.bodies else self.arm(place)

    @property
    def moving(self) -> dict[str, RigidBody]:
        """Rigid bodies that are not static."""
        return {name: body for name, body in self.bodies.items() if body.mass > 0}

    def contacts(self, name: str) -> list[Touch]:
        """Points [m] and forces [N] where a named body touches anything, as of the last step."""
        return self.scene.touches(self._body(name))

    def contact_force(self, first: str, second: str) -> float:
        """Sum of the normal forces between two named bodies [N], as of the last step."""
        other = self._body(second)
        return sum(touch.normal_force for touch in self.contacts(first) if touch.other == other)

    def distance(self, first: str, second: str, limit: float = 1.0) -> float:
        """Smallest distance between two named bodies [m], negative where they overlap, at most ``limit``."""
        return self.scene.distance(self._body(first), self._body(second), limit)

    def run(
        self,
        duration: float,
        controllers: Mapping[str, Controller] | None = None,
        control_period: float | None = None,
        probes: Mapping[str, loop.Probe] | None = None,
        stop: Callable[[float], str | None] | None = None,
        events: Sequence[tuple[float, Callable[[], object]]] = (),
        record_every: int = 1,
        on_divergence: str = "raise",
    ) -> Recording:
        """Simulate for a duration [s] and return the recording; a second call goes on from where the first ended.

        controllers: by arm name, ``controller(sense) -> command``, called every ``control_period`` [s] (a multiple of
            the step, by default the step) in the order given. A command is joint torques (n,) [N m], held; a Command
            or tuple (torque, damping) whose damping, (n,) or (n, n) [N m s/rad], the world applies implicitly at every
            physics step; or a callable ``inner(sense) -> torque or tuple`` evaluated at every physics step until the
            next command. A tuple is always (torque, damping): give torques as arrays or lists.
        probes: functions without arguments, evaluated at every recorded sample after the controllers.
        stop: ``stop(time)`` at every control instant; a text it returns ends the run and becomes the status.
        events: (time [s], action) pairs, each done once.
        record_every: physics steps between recorded samples.
        on_divergence: "raise" Diverged, or "stop" with the sentence as status and the samples up to then.

        Channels: ``time`` [s]; of each arm ``position``, ``velocity``, ``torque`` (as applied, after damping and
        saturation), ``tip`` (3,), ``force`` (3,) on the end point and, with an imperfect sensor, ``sensed_force``;
        ``<body>.pose`` (7,), position and quaternion x, y, z, w; the channels of the elements; the probes. A sample
        holds the state at its instant and the forces and torques computed from it; the last is one step before the end.
        """
        return loop.run(
            self, duration, controllers or {}, control_period, probes or {}, stop, events, record_every, on_divergence
        )

    def render(
        self,
        positions: Mapping[str, ArrayLike] | None = None,
        poses: Mapping[str, ArrayLike] | None = None,
        camera: Camera = Camera(),
        size: tuple[int, int] = (640, 480),
    ) -> Image:
        """Picture (height, width, 3) of the scene with arms at given joint angles and bodies at given poses (7,).

        The state of the simulation is left as it was. size: (width, height) in pixels.
        """
        with self._posed(positions or {}, poses or {}):
            return self.scene.photograph(camera, size)

    @contextlib.contextmanager
    def _posed(self, positions: Mapping[str, ArrayLike], poses: Mapping[str, ArrayLike]) -> Iterator[None]:
        with self.scene.kept():
            for name, position in positions.items():
                self.arm(name).reset(np.asarray(position, dtype=float))
            for name, pose in poses.items():
                values = np.asarray(pose, dtype=float).tolist()
                self.bodies[name].place(values[:3], values[3:] or (0.0, 0.0, 0.0, 1.0))
            yield

    def look_down(self, camera: Overhead) -> tuple[Image, Array]:
        """Colours (height, width, 3) and heights z (height, width) [m] that an overhead camera sees, free of noise."""
        return self.scene.look_down(camera)

    def grip(self, arm: str, body: str) -> None:
        """Fix a body to an arm's end point as it lies there now, as closed fingers would; it still touches the rest."""
        self.scene.hold(self.arm(arm), self.bodies[body])
        self.arm(arm).burdened = True

    def snapshot(
        self, recording: Recording, time: float, camera: Camera = Camera(), size: tuple[int, int] = (640, 480)
    ) -> Image:
        """Picture (height, width, 3) of the sample of a recording that is nearest to a time [s]."""
        return self.render(*self._recorded(recording, time), camera, size)

    def animate(self, recording: Recording, times: Sequence[float]) -> tuple[list[Solid], Array]:
        """What is seen of the scene, and the poses (times, solids, 7) of it at the samples nearest to times [s]."""
        seen, poses = self.scene.solids(), []
        for time in times:
            with self._posed(*self._recorded(recording, time)):
                poses.append(self.scene.whereabouts(seen))
        return seen, np.array(poses)

    def _recorded(self, recording: Recording, time: float) -> tuple[dict[str, Array], dict[str, Array]]:
        """Joint angles of the arms and poses of the bodies at the sample of a recording that is nearest to a time."""
        index = int(np.abs(recording.time - time).argmin())

        def of(names: Iterable[str], channel: str) -> dict[str, Array]:
            found = {name: f"{name}.{channel}" for name in names}
            return {name: recording[key][index] for name, key in found.items() if key in recording}

        return of(self.arms, "position"), of(self.bodies, "pose")

    def _body(self, name: str) -> int:
        return self.bodies[name].body if name in self.bodies else self.arm(name).body

    def _check_new(self, name: str) -> None:
        if name in self.arms or name in self.bodies:
            raise ValueError(f"there is already something named '{name}' in the world")
