"""PyBullet: one physics client a scene and a model, its silent defaults taken away."""

from __future__ import annotations

import contextlib
import math
import tempfile
import weakref
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from scipy.spatial.transform import Rotation

from dexrepro.arrays import Array, Image
from dexrepro.physics.loading import LoadingError, captured
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.plant import RigidBody, SimulatedArm, Touch, Vector
from dexrepro.physics.rendering import Camera, Overhead, Solid
from dexrepro.physics.sensor import Sensor
from dexrepro.robots.arm import Arm, Shape
from dexrepro.robots.rotations import rotated

with captured():  # it prints its build time when imported; nobody who pipes our output wants it
    import pybullet as bullet

SHAPES = {"box": bullet.GEOM_BOX, "sphere": bullet.GEOM_SPHERE, "cylinder": bullet.GEOM_CYLINDER,
          "capsule": bullet.GEOM_CAPSULE}  # fmt: skip
KINDS = {number: kind for kind, number in SHAPES.items()}


class BulletBody(RigidBody):
    """A rigid body of a client."""

    def __init__(self, client: int, body: int, mass: float) -> None:
        self.client = client
        super().__init__(body, mass)

    def read(self) -> None:
        (self.x, self.y, self.z), self.orientation = bullet.getBasePositionAndOrientation(self.body, self.client)
        (self.vx, self.vy, self.vz), self.spin = bullet.getBaseVelocity(self.body, self.client)

    def place(self, position: Sequence[float], orientation: Sequence[float] | None = None) -> None:
        self.x, self.y, self.z = position
        turn = self.orientation if orientation is None else orientation
        bullet.resetBasePositionAndOrientation(self.body, position, turn, physicsClientId=self.client)

    def push_at(self, force: Vector, place: Vector) -> None:
        bullet.applyExternalForce(self.body, -1, force, place, bullet.WORLD_FRAME, self.client)


class BulletArm(SimulatedArm):
    """An arm of a client."""

    def __init__(
        self,
        client: int,
        name: str,
        arm: Arm,
        position: Array,
        sensor: Sensor,
        rng: np.random.Generator | None,
        meshes: bool = False,
    ) -> None:
        self.client = client
        body = load_arm(client, arm, meshes)
        self._twin = client, body, lighter(arm)
        if self._twin[2] < 1:
            self._twin = _twin(client, arm)
            weakref.finalize(self, disconnect, self._twin[0])
        self.end = EndPoint(client, body, arm)
        super().__init__(body, name, arm, position, sensor, rng)

    def _state(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        angles, rates, _, _ = zip(*bullet.getJointStates(self.body, self._indices, self.client))
        return angles, rates

    def _put(self, angles: list[float], rates: list[float]) -> None:
        for index, angle, rate in zip(self._indices, angles, rates, strict=True):
            bullet.resetJointState(self.body, index, angle, rate, physicsClientId=self.client)

    def _give(self, torque: Sequence[float]) -> None:
        bullet.setJointMotorControlArray(
            self.body, self._indices, bullet.TORQUE_CONTROL, forces=torque, physicsClientId=self.client
        )

    def _end(self) -> tuple[float, float, float, float, float, float]:
        state = bullet.getLinkState(self.body, self.end.link, 1, 1, self.client)
        (cx, cy, cz), (rx, ry, rz) = state[0], rotated(state[1], self.end.from_com)
        (ux, uy, uz), (ox, oy, oz) = state[6], state[7]
        return cx + rx, cy + ry, cz + rz, ux + oy * rz - oz * ry, uy + oz * rx - ox * rz, uz + ox * ry - oy * rx

    def _push(self, force: Vector) -> None:
        place = self.x, self.y, self.z
        bullet.applyExternalForce(self.body, self.end.link, force, place, bullet.WORLD_FRAME, self.client)

    def _dynamics(self) -> tuple[Array, Array]:
        client, body, factor = self._twin
        mass = np.array(bullet.calculateMassMatrix(body, self.q, 0, client))
        bias = np.array(bullet.calculateInverseDynamics(body, self.q, self.dq, self._zeros, 0, client))
        if factor < 1:
            mass /= factor
            bias /= factor
        return mass, bias

    def _felt_torque(self) -> Array:
        client, body, _ = self._twin
        linear, _ = bullet.calculateJacobian(
            body, self.end.link, self.end.for_jacobian, self.q, self.dq, self._zeros, client
        )
        torque: Array = np.array((self.fx, self.fy, self.fz)) @ np.array(linear)
        return torque

    def touches(self) -> list[Touch]:
        return touches(self.client, self.body)

    def push_link(self, link: str, point: Vector, force: Vector) -> None:
        index = self.links.index(link)
        state = bullet.getLinkState(self.body, index, 0, 1, physicsClientId=self.client)
        place = [a + b for a, b in zip(state[4], rotated(state[5], point), strict=True)]
        bullet.applyExternalForce(self.body, index, force, place, bullet.WORLD_FRAME, physicsClientId=self.client)

    def set_mass(self, link: str, mass: float) -> None:
        bullet.changeDynamics(self.body, self.links.index(link), mass=mass, physicsClientId=self.client)


class BulletScene:
    """One physics client; with ``gui`` in a window."""

    def __init__(self, step: float, gravity: Sequence[float], iterations: int, gui: bool) -> None:
        self.client = connect(gui)
        bullet.setGravity(*gravity, physicsClientId=self.client)
        bullet.setPhysicsEngineParameter(
            fixedTimeStep=step, numSubSteps=0, numSolverIterations=iterations, deterministicOverlappingPairs=1,
            physicsClientId=self.client,
        )  # fmt: skip

    def close(self) -> None:
        if self.client >= 0:
            bullet.disconnect(physicsClientId=self.client)
            self.client = -1

    def advance(self) -> None:
        bullet.stepSimulation(self.client)

    def arm(
        self,
        name: str,
        arm: Arm,
        position: Array,
        *,
        contacts: bool,
        sensor: Sensor,
        rng: np.random.Generator | None,
        meshes: bool,
    ) -> BulletArm:
        plant = BulletArm(self.client, name, arm, position, sensor, rng, meshes)
        for link in range(-1, 0 if contacts else bullet.getNumJoints(plant.body, physicsClientId=self.client)):
            if not contacts:
                bullet.setCollisionFilterGroupMask(plant.body, link, 0, 0, physicsClientId=self.client)
        return plant

    def rigid_body(
        self,
        shapes: Sequence[Shape],
        position: Sequence[float],
        rpy: Sequence[float],
        *,
        mass: float,
        inertia: Sequence[float] | None,
        friction: float,
        collides: bool,
        contact: Mapping[str, float],
    ) -> BulletBody:
        visual = self._shape_arrays(shapes, visual=True)
        collision = self._shape_arrays(shapes, visual=False) if collides else -1
        body = bullet.createMultiBody(
            mass, collision, visual, list(position), bullet.getQuaternionFromEuler(list(rpy)),
            physicsClientId=self.client,
        )  # fmt: skip
        undamped(self.client, body)
        more = {} if inertia is None else {"localInertiaDiagonal": list(inertia)}
        bullet.changeDynamics(body, -1, lateralFriction=friction, physicsClientId=self.client, **contact, **more)
        return BulletBody(self.client, body, mass)

    def _shape_arrays(self, shapes: Sequence[Shape], visual: bool) -> int:
        sizes = [_engine_size(shape) for shape in shapes]
        common = {
            "shapeTypes": [SHAPES[shape.kind] for shape in shapes],
            "radii": [size[0] for size in sizes],
            "halfExtents": [size[1] for size in sizes],
            "lengths": [size[2] for size in sizes],
            "physicsClientId": self.client,
        }
        places = [list(shape.pose.xyz) for shape in shapes]
        turns = [list(shape.pose.quaternion) for shape in shapes]
        if not visual:
            return int(
                bullet.createCollisionShapeArray(
                    collisionFramePositions=places, collisionFrameOrientations=turns, **common
                )
            )
        return int(
            bullet.createVisualShapeArray(
                visualFramePositions=places,
                visualFrameOrientations=turns,
                rgbaColors=[list(shape.colour) for shape in shapes],
                **common,
            )
        )

    def hinge(self, arm: SimulatedArm, body: RigidBody, lever: Vector) -> None:
        assert isinstance(arm, BulletArm)
        bullet.createConstraint(
            arm.body, arm.end.link, body.body, -1, bullet.JOINT_POINT2POINT, (0, 0, 0), arm.end.from_com, lever,
            physicsClientId=self.client,
        )  # fmt: skip

    def hold(self, arm: SimulatedArm, body: RigidBody) -> None:
        assert isinstance(arm, BulletArm)
        state = bullet.getLinkState(arm.body, arm.end.link, 0, 1, physicsClientId=self.client)
        body.read()
        to_link = bullet.invertTransform(state[0], state[1])
        place, turn = bullet.multiplyTransforms(*to_link, (body.x, body.y, body.z), body.orientation)
        bullet.createConstraint(
            arm.body, arm.end.link, body.body, -1, bullet.JOINT_FIXED, (0, 0, 0), place, (0, 0, 0), turn,
            physicsClientId=self.client,
        )  # fmt: skip

    def touches(self, body: int) -> list[Touch]:
        return touches(self.client, body)

    def distance(self, first: int, second: int, limit: float) -> float:
        points = bullet.getClosestPoints(first, second, limit, physicsClientId=self.client)
        return min((point[8] for point in points), default=limit)

    @contextlib.contextmanager
    def kept(self) -> Iterator[None]:
        state = bullet.saveState(physicsClientId=self.client)
        yield
        bullet.restoreState(stateId=state, physicsClientId=self.client)
        bullet.removeState(state, physicsClientId=self.client)

    def photograph(self, camera: Camera, size: tuple[int, int]) -> Image:
        width, height = size
        view = bullet.computeViewMatrixFromYawPitchRoll(
            camera.target, camera.distance, camera.yaw, camera.pitch, 0.0, 2, physicsClientId=self.client
        )
        lens = bullet.computeProjectionMatrixFOV(
            camera.field_of_view, width / height, 0.02, 20.0, physicsClientId=self.client
        )
        pixels = bullet.getCameraImage(
            width, height, view, lens, shadow=1, lightDirection=(1.0, -1.0, 2.0), renderer=bullet.ER_TINY_RENDERER,
            physicsClientId=self.client,
        )[2]  # fmt: skip
        return np.asarray(pixels, dtype=np.uint8).reshape(height, width, -1)[:, :, :3].copy()

    def look_down(self, camera: Overhead) -> tuple[Image, Array]:
        (x, y, z), (width, height) = camera.position, camera.size
        view = bullet.computeViewMatrix((x, y, z), (x, y, z - 1.0), (0.0, 1.0, 0.0), physicsClientId=self.client)
        lens = bullet.computeProjectionMatrixFOV(
            camera.field_of_view, width / height, camera.near, camera.far, physicsClientId=self.client
        )
        answer = bullet.getCameraImage(
            width, height, view, lens, shadow=0, lightDirection=(0.3, -0.3, 1.0), renderer=bullet.ER_TINY_RENDERER,
            physicsClientId=self.client,
        )  # fmt: skip
        colours = np.asarray(answer[2], dtype=np.uint8).reshape(height, width, -1)[:, :, :3].copy()
        buffer = np.asarray(answer[3], dtype=float).reshape(height, width)
        depth = camera.far * camera.near / (camera.far - (camera.far - camera.near) * buffer)
        return colours, z - depth

    def solids(self) -> list[Solid]:
        bodies = [
            bullet.getBodyUniqueId(i, physicsClientId=self.client) for i in range(bullet.getNumBodies(self.client))
        ]
        found = []
        for body in bodies:
            for _, link, kind, size, _, place, turn, colour, *_ in bullet.getVisualShapeData(
                body, physicsClientId=self.client
            ):
                if kind in KINDS and colour[3] > 0:
                    sides = {"box": size, "sphere": size[:1]}.get(KINDS[kind], (size[1], size[0]))
                    found.append(Solid(body, link, KINDS[kind], tuple(sides), tuple(colour), place, turn))
        return found

    def whereabouts(self, seen: Sequence[Solid]) -> Array:
        poses = []
        for solid in seen:
            if solid.link < 0:
                inertial = bullet.getDynamicsInfo(solid.body, -1, physicsClientId=self.client)[3:5]
                centre = bullet.getBasePositionAndOrientation(solid.body, physicsClientId=self.client)
                frame = bullet.multiplyTransforms(*centre, *bullet.invertTransform(*inertial))
            else:
                frame = bullet.getLinkState(solid.body, solid.link, 0, 1, physicsClientId=self.client)[4:6]
            place, turn = bullet.multiplyTransforms(*frame, solid.place, solid.turn)
            poses.append((*place, *turn))
        return np.array(poses)


class BulletModel(RigidBodyModel):
    """The model of an arm in a physics client that is never stepped."""

    def _load(self, gravity: Sequence[float]) -> None:
        self._client = connect()
        self._close = weakref.finalize(self, disconnect, self._client)
        self._factor = lighter(self.arm)
        self._body = load_arm(self._client, self.arm.scaled(self._factor) if self._factor < 1 else self.arm)
        bullet.setGravity(*gravity, physicsClientId=self._client)
        self._zeros = [0.0] * self.dof
        self._indices = list(range(self.dof))
        self._end = EndPoint(self._client, self._body, self.arm)

    def close(self) -> None:
        self._close()

    def mass_matrix(self, q: Array) -> Array:
        return self._scaled(bullet.calculateMassMatrix(self._body, _list(q), 0, self._client))

    def inverse_dynamics(self, q: Array, dq: Array, ddq: Array) -> Array:
        torque = bullet.calculateInverseDynamics(self._body, _list(q), _list(dq), _list(ddq), 0, self._client)
        return self._scaled(torque)

    def bias(self, q: Array, dq: Array) -> Array:
        torque = bullet.calculateInverseDynamics(self._body, _list(q), _list(dq), self._zeros, 0, self._client)
        return self._scaled(torque)

    def gravity(self, q: Array) -> Array:
        torque = bullet.calculateInverseDynamics(self._body, _list(q), self._zeros, self._zeros, 0, self._client)
        return self._scaled(torque)

    def jacobian(self, q: Array) -> Array:
        linear, angular = bullet.calculateJacobian(
            self._body, self._end.link, self._end.for_jacobian, _list(q), self._zeros, self._zeros, self._client
        )
        return np.array(linear + angular)

    def tip_torque(self, q: Array, force: Sequence[float]) -> Array:
        linear, _ = bullet.calculateJacobian(
            self._body, self._end.link, self._end.for_jacobian, _list(q), self._zeros, self._zeros, self._client
        )
        fx, fy, fz = force
        return np.array([fx * x + fy * y + fz * z for x, y, z in zip(*linear)])

    def forward(self, q: Array) -> tuple[Array, Array]:
        angles = [[angle] for angle in _list(q)]
        bullet.resetJointStatesMultiDof(self._body, self._indices, angles, physicsClientId=self._client)
        state = bullet.getLinkState(self._body, self._end.link, 0, 1, physicsClientId=self._client)
        rotation = np.array(bullet.getMatrixFromQuaternion(state[1])).reshape(3, 3)
        (x, y, z), (a, b, c) = state[0], rotated(state[1], self._end.from_com)
        return np.array((x + a, y + b, z + c)), rotation @ self._end.rotation

    def _scaled(self, numbers: Sequence[float] | Sequence[Sequence[float]]) -> Array:
        """What the engine says of the arm that it holds, for the arm as heavy as it is."""
        return np.array(numbers) / self._factor if self._factor < 1 else np.array(numbers)


def _list(values: Array) -> list[float]:
    return values.tolist() if isinstance(values, np.ndarray) else list(values)


def touches(client: int, body: int) -> list[Touch]:
    """Contact points of a body as of the last step.

    The engine is asked for all of its points: when it is asked for one body's, it turns the normal but not the
    directions of friction where that body is the second of a pair.
    """
    result = []
    for point in bullet.getContactPoints(physicsClientId=client):
        if body not in point[1:3]:
            continue
        first = point[1] == body
        sign = 1.0 if first else -1.0
        parts = ((point[9], point[7]), (point[10], point[11]), (point[12], point[13]))
        x, y, z = (sign * sum(size * direction[i] for size, direction in parts) for i in range(3))
        link, other = (point[3], point[2]) if first else (point[4], point[1])
        result.append(Touch(link, other, point[6], point[9], (x, y, z)))
    return result


class EndPoint:
    """Where an arm's end point is on the body that carries it, in the frames the engine asks for.

    link: the engine's index of that body; from_com: place [m] from the centre of mass, along the principal axes;
    for_jacobian: place [m] from the link's origin, along the principal axes, as calculateJacobian takes it; rotation:
    of the end point's frame relative to the principal axes. (The engine's link frame itself is of single precision.)
    """

    def __init__(self, client: int, body: int, arm: Arm) -> None:
        poses = [pose.matrix for pose, _ in arm.bodies]
        self.link = arm.dof - 1 + len(poses)
        local = arm.tip
        for pose in poses:
            local = np.linalg.inv(pose) @ local
        info = bullet.getDynamicsInfo(body, self.link, physicsClientId=client)
        axes = Rotation.from_quat(info[4]).as_matrix()
        self.rotation = axes.T @ local[:3, :3]
        self.from_com: tuple[float, ...] = tuple((axes.T @ (local[:3, 3] - info[3])).tolist())
        self.for_jacobian: tuple[float, ...] = tuple((axes.T @ local[:3, 3]).tolist())


def _twin(client: int, arm: Arm) -> tuple[int, int, float]:
    """A client of its own, under the same gravity, with an arm light enough for inverse dynamics, and its factor."""
    parameters, factor = bullet.getPhysicsEngineParameters(physicsClientId=client), lighter(arm)
    twin = connect()
    bullet.setGravity(*(parameters[f"gravityAcceleration{axis}"] for axis in "XYZ"), physicsClientId=twin)
    return twin, load_arm(twin, arm.scaled(factor)), factor


def _engine_size(shape: Shape) -> tuple[float, list[float], float]:
    """Radius, half extents and length as PyBullet's shape arrays take them."""
    if shape.kind == "box":
        return 0.0, [side / 2 for side in shape.size], 0.0
    radius, *length = shape.size
    return radius, [0.0, 0.0, 0.0], length[0] if length else 0.0


def connect(gui: bool = False) -> int:
    """Open a physics client of its own and return its id."""
    client = bullet.connect(bullet.GUI if gui else bullet.DIRECT)
    if client < 0:
        raise LoadingError("no further physics client can be opened in this process")
    return int(client)


def load_arm(client: int, arm: Arm, meshes: bool = False) -> int:
    """Load an arm with its inertias as given, without damping and with its motors off; return the body's id.

    Joint i of the arm is joint i of the body. meshes: load those of its links, which takes a while and is for pictures
    alone; where the engine cannot, the other shapes stand for them. Raises LoadingError on any warning of the importer
    and if a mass or a moment of inertia in the engine differs from the description.
    """
    body, warnings = _imported(client, arm.urdf(meshes))
    if warnings and meshes:
        if body >= 0:
            bullet.removeBody(body, physicsClientId=client)
        body, warnings = _imported(client, arm.urdf())
    if warnings:
        raise LoadingError(f"arm '{arm.name}': {'; '.join(warnings)}")
    undamped(client, body)
    _verify(client, body, arm)
    joints = list(range(arm.dof))
    bullet.setJointMotorControlArray(
        body, joints, bullet.VELOCITY_CONTROL, forces=[0.0] * arm.dof, physicsClientId=client
    )
    return int(body)


def _imported(client: int, text: str) -> tuple[int, list[str]]:
    """Id of the body that a URDF text describes, -1 for none, and what the importer complains about."""
    with tempfile.NamedTemporaryFile("w", suffix=".urdf", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        body = -1
        with captured() as output, contextlib.suppress(bullet.error):
            body = bullet.loadURDF(
                file.name, useFixedBase=1, flags=bullet.URDF_USE_INERTIA_FROM_FILE, physicsClientId=client
            )
    warnings = [line for line in output[0].splitlines() if "arning" in line or "rror" in line]
    return body, warnings or ([] if body >= 0 else ["the engine cannot load it"])


def lighter(arm: Arm) -> float:
    """The power of two by which an arm is to be lighter for the engine's inverse dynamics to take it, 1 for most.

    It refuses inertias whose halves above and below the diagonal differ by 1e-15, which rounding does to heavy links.
    Powers of two change no digit of the results.
    """
    moments = [
        np.abs(link.inertia_matrix).max() + link.mass * np.dot(link.com, link.com)
        for link in (*arm.links, *(link for _, link in arm.bodies))
    ]
    return 2.0 ** -max(0, math.ceil(math.log2(max(moments))))


def disconnect(client: int) -> None:
    """Close a physics client that may be closed already."""
    if bullet.isConnected(client):
        bullet.disconnect(physicsClientId=client)


def undamped(client: int, body: int) -> None:
    """Take the engine's default damping and speed limit from every link of a body."""
    for link in range(-1, bullet.getNumJoints(body, physicsClientId=client)):
        bullet.changeDynamics(
            body, link, linearDamping=0, angularDamping=0, jointDamping=0, maxJointVelocity=1e6, physicsClientId=client
        )


def _verify(client: int, body: int, arm: Arm) -> None:
    links = [*arm.links, *(link for _, link in arm.bodies)]
    for index, link in enumerate(links):
        mass, _, moments, *_ = bullet.getDynamicsInfo(body, index, physicsClientId=client)
        expected = np.linalg.eigvalsh(link.inertia_matrix)
        if abs(mass - link.mass) > 1e-9 * link.mass or not np.allclose(np.sort(moments), expected, 1e-6, 1e-12):
            raise LoadingError(
                f"arm '{arm.name}', link '{link.name}': the engine holds {mass} kg and moments {moments} "
                f"instead of {link.mass} kg and {expected}"
            )


scene = BulletScene
Model = BulletModel
