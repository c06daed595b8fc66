"""MuJoCo: one model a scene, compiled anew whenever something is added.

Integrator: semi-implicit Euler without implicit damping, as PyBullet's. Solver: Newton, elliptic cones, impratio 10 and
a pass against slip. Contacts are as soft as MuJoCo makes them by itself (time constant 0.02 s, impedance 0.9 to 0.95):
much stiffer ones part and meet again within a step when squeezed. Joint limits, ball joints and grips give way with a
time constant of five steps, in which PyBullet, too, takes back most of an error, and an impedance of 0.99 to 0.999.
Coefficients of friction of two bodies are multiplied. A contact with ``contactStiffness`` k [N/m] and
``contactDamping`` c [N s/m] gives k times the overlap at rest, in each of its points. Restitution is not modelled.
Pictures are traced by rays.
"""

from __future__ import annotations

import contextlib
import itertools
import time
import warnings
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, cast

import mujoco
import numpy as np
from numpy.random import Generator

from dexrepro.arrays import Array, Image
from dexrepro.physics.loading import LoadingError
from dexrepro.physics.model import RigidBodyModel
from dexrepro.physics.plant import RigidBody, SimulatedArm, Touch, Vector
from dexrepro.physics.rendering import Camera, Overhead, Solid
from dexrepro.physics.sensor import Sensor
from dexrepro.robots.arm import Arm, Pose, Shape
from dexrepro.robots.rotations import rotated

# It would print, and write a file into the working directory.
mujoco.set_mju_user_warning(lambda text: warnings.warn(f"MuJoCo: {text}", stacklevel=2))

KINDS = {"box": mujoco.mjtGeom.mjGEOM_BOX, "sphere": mujoco.mjtGeom.mjGEOM_SPHERE,
         "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER, "capsule": mujoco.mjtGeom.mjGEOM_CAPSULE}  # fmt: skip
IMPEDANCE = (0.99, 0.999, 0.001, 0.5, 2.0)
SOFT = 0.5  # impedance of a contact with a stiffness: its share of the inertia that the contact itself adds
FRICTION = 0.5  # of an arm's links, as PyBullet's default
KNOWN = {"spinningFriction", "rollingFriction", "contactStiffness", "contactDamping", "angularDamping"}


@dataclass
class Geometry:
    """A shape as the scene knows it: the item it belongs to, the link (-1: the base), what it may touch and how."""

    item: int
    link: int
    shape: Shape
    name: str
    moves: bool
    solid: bool
    touchable: bool
    friction: float = FRICTION
    contact: Mapping[str, float] = field(default_factory=dict)


class MujocoBody(RigidBody):
    """A rigid body: free if it has a mass, else moved by hand alone."""

    def __init__(self, scene: MujocoScene, name: str, mass: float, pose: list[float], drag: Array) -> None:
        self.scene, self.name, self.state = scene, name, np.r_[pose, np.zeros(6)]
        self.drag, self._free = drag, mass > 0
        scene.items.append(self)
        scene.compile()
        super().__init__(len(scene.items) - 1, mass)

    def bind(self) -> None:
        """Find the body in a new model and put it where it was."""
        model, data = self.scene.model, self.scene.data
        self.index = model.body(self.name).id
        self._com = data.xipos[self.index]
        self._forces = data.xfrc_applied[self.index]
        if self._free:
            at, dof = model.jnt_qposadr[model.body_jntadr[self.index]], model.body_dofadr[self.index]
            self._pose, self._rates = data.qpos[at : at + 7], data.qvel[dof : dof + 6]
            self._rates[:] = self.state[7:]
            self._pose[:] = self.state[:7]
        else:
            self._mocap = model.body_mocapid[self.index]
            data.mocap_pos[self._mocap], data.mocap_quat[self._mocap] = self.state[:3], self.state[3:7]

    def keep(self) -> None:
        """Remember the state, for a new model."""
        data = self.scene.data
        if self._free:
            self.state = np.r_[self._pose, self._rates]
        else:
            self.state[:7] = np.r_[data.mocap_pos[self._mocap], data.mocap_quat[self._mocap]]

    def read(self) -> None:
        if not self._free:
            self.x, self.y, self.z = self.scene.data.mocap_pos[self._mocap].tolist()
            w, i, j, k = self.scene.data.mocap_quat[self._mocap].tolist()
            self.orientation = i, j, k, w
            return
        self.x, self.y, self.z, w, i, j, k = self._pose.tolist()
        self.orientation = i, j, k, w
        self.vx, self.vy, self.vz, *spin = self._rates.tolist()
        self.spin = rotated(self.orientation, spin)
        if self.drag.any():
            self._resist()

    def _resist(self) -> None:
        """Damping as PyBullet has it: m c (1 + |v|) v, I c (1 + |w|) w."""
        linear, angular = self.drag
        model, spin = self.scene.model, self._rates[3:]
        force = -linear * self.mass * self._rates[:3] * (1.0 + np.linalg.norm(self._rates[:3]))
        inertia = model.body_inertia[self.index]
        torque = -angular * inertia * spin * (1.0 + np.linalg.norm(spin))
        self.scene.drags[self.index] = np.r_[force, rotated(self.orientation, torque.tolist())]

    def place(self, position: Sequence[float], orientation: Sequence[float] | None = None) -> None:
        self.x, self.y, self.z = position
        i, j, k, w = self.orientation if orientation is None else orientation
        if self._free:
            self._pose[:], self._rates[:] = (*position, w, i, j, k), 0.0
        else:
            self.scene.data.mocap_pos[self._mocap] = position
            self.scene.data.mocap_quat[self._mocap] = w, i, j, k
        mujoco.mj_step1(self.scene.model, self.scene.data)

    def push_at(self, force: Vector, place: Vector) -> None:
        if self._free:
            self.scene.push(self._forces, self._com, force, place)


class MujocoArm(SimulatedArm):
    """An arm of a scene."""

    def __init__(
        self, scene: MujocoScene, prefix: str, name: str, arm: Arm, start: Array, sensor: Sensor, rng: Generator | None
    ) -> None:
        self.scene, self.prefix = scene, prefix
        self.state = np.zeros((2, arm.dof))
        self._names = [f"{prefix}{k}" for k in range(len(arm.links) + len(arm.bodies))]
        scene.items.append(self)
        scene.compile()
        super().__init__(len(scene.items) - 1, name, arm, start, sensor, rng)

    def bind(self) -> None:
        """Find the arm in a new model and put it where it was."""
        model, data = self.scene.model, self.scene.data
        self.bodies = [model.body(name).id for name in self._names]
        first, count = int(model.body_dofadr[self.bodies[0]]), self.state.shape[1]
        start = int(model.jnt_qposadr[model.body_jntadr[self.bodies[0]]])
        self._dofs = slice(first, first + count)
        self._angles, self._rates = data.qpos[start : start + count], data.qvel[self._dofs]
        self._torque, self._bias = data.qfrc_applied[self._dofs], data.qfrc_bias[self._dofs]
        self._site = model.site(f"{self.prefix}tip").id
        self._place = data.site_xpos[self._site]
        self._velocity, self._mass = np.zeros(6), np.zeros((model.nv, model.nv))
        self._linear = np.zeros((3, model.nv))
        self._angles[:], self._rates[:] = self.state

    def keep(self) -> None:
        """Remember the state, for a new model."""
        self.state = np.array((self._angles, self._rates))

    def _state(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        return tuple(self._angles.tolist()), tuple(self._rates.tolist())

    def _put(self, angles: list[float], rates: list[float]) -> None:
        self._angles[:], self._rates[:] = angles, rates
        mujoco.mj_step1(self.scene.model, self.scene.data)

    def _give(self, torque: Sequence[float]) -> None:
        self._torque[:] = torque

    def _end(self) -> tuple[float, float, float, float, float, float]:
        mujoco.mj_objectVelocity(
            self.scene.model, self.scene.data, mujoco.mjtObj.mjOBJ_SITE, self._site, self._velocity, 0
        )
        _, _, _, vx, vy, vz = self._velocity.tolist()
        x, y, z = self._place.tolist()
        return x, y, z, vx, vy, vz

    def _push(self, force: Vector) -> None:
        last, data = self.bodies[-1], self.scene.data
        self.scene.push(data.xfrc_applied[last], data.xipos[last], force, (self.x, self.y, self.z))

    def _dynamics(self) -> tuple[Array, Array]:
        mujoco.mj_fullM(self.scene.model, self.scene.data, self._mass)
        return self._mass[self._dofs, self._dofs].copy(), self._bias.copy()

    def _felt_torque(self) -> Array:
        mujoco.mj_jacSite(self.scene.model, self.scene.data, self._linear, None, self._site)
        torque: Array = np.array((self.fx, self.fy, self.fz)) @ self._linear[:, self._dofs]
        return torque

    def touches(self) -> list[Touch]:
        return self.scene.touches(self.body)

    def push_link(self, link: str, point: Vector, force: Vector) -> None:
        data, body = self.scene.data, self.bodies[self.links.index(link)]
        x, y, z = (data.xpos[body] + data.xmat[body].reshape(3, 3) @ point).tolist()
        self.scene.push(data.xfrc_applied[body], data.xipos[body], force, (x, y, z))

    def set_mass(self, link: str, mass: float) -> None:
        name = self._names[self.links.index(link)]
        self.scene.spec.body(name).mass = mass
        self.scene.compile()


class MujocoScene:
    """One model and its data; with ``gui`` in a window."""

    def __init__(self, step: float, gravity: Sequence[float], iterations: int, gui: bool) -> None:
        self.spec = spec = _empty(gravity)
        spec.option.timestep = step
        self._stiff = (5.0 * step, 1.0)
        self.items: list[MujocoArm | MujocoBody] = []
        self.geometries: list[Geometry] = []
        self.drags: dict[int, Array] = {}
        self._pushed, self._touches = False, list[tuple[tuple[Geometry, Geometry], Vector, Array]]()
        self._gui, self._viewer, self._shown = gui, cast(Any, None), 0.0
        if gui:
            self.spec.add_texture(
                name="sky", type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT,
                rgb1=(0.9, 0.93, 0.97), rgb2=(0.6, 0.65, 0.7), width=64, height=384,
            )  # fmt: skip
        self._names = (f"n{k}" for k in itertools.count())
        self._bound = 0
        self.compile()

    def compile(self) -> None:
        """Make the model of everything that is there, in the state it had."""
        for item in self.items[: self._bound]:
            item.keep()
        self.model = _compiled(self.spec)
        self.drags.clear()
        self.data = mujoco.MjData(self.model)
        for item in self.items:
            item.bind()
        self._bound = len(self.items)
        self._known = {self.model.geom(geometry.name).id: geometry for geometry in self.geometries}
        self._solid = [
            np.array([index for index, known in self._known.items() if known.item == item and known.solid], dtype=int)
            for item in range(self._bound)
        ]
        self._soften()
        mujoco.mj_step1(self.model, self.data)
        self.close()

    def close(self) -> None:
        if self._viewer is not None:
            self._viewer.close()
            self._viewer = None

    def advance(self) -> None:
        model, data = self.model, self.data
        for body, force in self.drags.items():
            data.xfrc_applied[body] += force
            self._pushed = True
        mujoco.mj_step2(model, data)
        self._touches = self._contacts() if data.ncon else []
        if self._pushed:
            data.xfrc_applied.fill(0.0)
            self._pushed = False
        mujoco.mj_step1(model, data)
        if self._gui:
            self._show()

    def _show(self) -> None:
        """Show the state, as often as a screen can."""
        if (now := time.perf_counter()) - self._shown < 1 / 60:
            return
        self._shown = now
        if self._viewer is None:
            from mujoco import viewer

            self._viewer = viewer.launch_passive(self.model, self.data, show_left_ui=False, show_right_ui=False)
        self._viewer.sync()

    def push(self, row: Array, com: Array, force: Vector, place: Vector) -> None:
        """Add a force [N] at a place [m] to the wrench (6,) on a body whose centre of mass is at ``com``."""
        (fx, fy, fz), (x, y, z) = force, com.tolist()
        rx, ry, rz = place[0] - x, place[1] - y, place[2] - z
        a, b, c, d, e, f = row.tolist()
        row[:] = (a + fx, b + fy, c + fz, d + ry * fz - rz * fy, e + rz * fx - rx * fz, f + rx * fy - ry * fx)
        self._pushed = True

    # ------------------------------------------------------------------------------------------------------ loading

    def arm(
        self, name: str, arm: Arm, position: Array, contacts: bool, sensor: Sensor, rng: Generator | None, meshes: bool
    ) -> MujocoArm:
        prefix, item = f"{next(self._names)}/", len(self.items)
        bodies, new = _add_arm(self.spec, arm, prefix), list[Geometry]()
        for link, (parent, shown) in enumerate(zip((self.spec.worldbody, *bodies), arm.shown), start=-1):
            for shape in shown.shapes:
                if shape.kind in KINDS:
                    solid = shape.collides
                    known = Geometry(item, link, shape, next(self._names), link >= 0, solid, solid and contacts)
                    new.append(self._put(parent, known))
        self._pair(new)
        return MujocoArm(self, prefix, name, arm, position, sensor, rng)

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
    ) -> MujocoBody:
        if unknown := [key for key, value in contact.items() if key not in {*KNOWN, "linearDamping"} and value]:
            raise LoadingError(f"MuJoCo has no {unknown[0]}; it has {', '.join(sorted({*KNOWN, 'linearDamping'}))}")
        name = next(self._names)
        x, y, z = position
        i, j, k, w = Pose(rpy=(rpy[0], rpy[1], rpy[2])).quaternion
        body = self.spec.worldbody.add_body(name=name, pos=(x, y, z), quat=(w, i, j, k), mocap=mass == 0)
        if mass > 0:
            moments, turn = _principal(_inertia(shapes, mass)) if inertia is None else (inertia, (1.0, 0.0, 0.0, 0.0))
            body.mass, body.ipos, body.inertia, body.iquat, body.explicitinertial = mass, (0, 0, 0), moments, turn, True
            body.add_freejoint()
        item, names = len(self.items), self._names
        self._pair([
            self._put(body, Geometry(item, -1, shape, next(names), mass > 0, collides, collides, friction, contact))
            for shape in shapes
        ])  # fmt: skip
        drag = np.array((contact.get("linearDamping", 0.0), contact.get("angularDamping", 0.0)))
        return MujocoBody(self, name, mass, [x, y, z, w, i, j, k], drag)

    def _put(self, body: mujoco.MjsBody, new: Geometry) -> Geometry:
        shape, (i, j, k, w) = new.shape, new.shape.pose.quaternion
        body.add_geom(
            name=new.name, type=KINDS[shape.kind], size=_size(shape), pos=shape.pose.xyz, quat=(w, i, j, k),
            rgba=shape.colour, contype=0, conaffinity=0,
        )  # fmt: skip
        self.geometries.append(new)
        return new

    def _pair(self, new: list[Geometry]) -> None:
        """Let new shapes touch those of other items, unless neither can move."""
        others = [other for other in self.geometries if other.item != len(self.items) and other.touchable]
        for one, other in itertools.product([geometry for geometry in new if geometry.touchable], others):
            if not (one.moves or other.moves):
                continue
            slide = one.friction * other.friction
            spin, roll = (
                one.contact.get(key, 0.0) * other.friction + other.contact.get(key, 0.0) * one.friction
                for key in ("spinningFriction", "rollingFriction")
            )
            self.spec.add_pair(  # its softness is the default
                name=f"{other.name}:{one.name}", geomname1=other.name, geomname2=one.name,
                condim=6 if roll else 4 if spin else 3, friction=(slide, slide, spin, roll, roll),
            )  # fmt: skip

    def _soften(self) -> None:
        """Give contacts with a stiffness their own solref; MuJoCo scales it by the inverse inertia it assumes there."""
        model, by_name = self.model, {geometry.name: geometry for geometry in self.geometries}
        for index in range(model.npair):
            one, other = (by_name[name] for name in model.pair(index).name.split(":"))
            soft = [side.contact for side in (one, other) if "contactStiffness" in side.contact]
            if not soft:
                continue
            stiffness = 1.0 / sum(1.0 / side["contactStiffness"] for side in soft)
            damping = max(side.get("contactDamping", 0.0) for side in soft)
            bodies = [model.geom(side.name).bodyid[0] for side in (one, other)]
            scale = (1.0 - SOFT) * sum(model.body_invweight0[body][0] for body in bodies)
            model.pair_solimp[index] = (SOFT, SOFT, *IMPEDANCE[2:])
            model.pair_solref[index] = -stiffness * scale, -damping * scale

    def hinge(self, arm: SimulatedArm, body: RigidBody, lever: Vector) -> None:
        assert isinstance(arm, MujocoArm)
        assert isinstance(body, MujocoBody)
        name = next(self._names)
        self.spec.body(body.name).add_site(name=name, pos=lever)
        self._join(mujoco.mjtEq.mjEQ_CONNECT, f"{arm.prefix}tip", name)

    def hold(self, arm: SimulatedArm, body: RigidBody) -> None:
        assert isinstance(arm, MujocoArm)
        assert isinstance(body, MujocoBody)
        last, data, names = arm.bodies[-1], self.data, (next(self._names), next(self._names))
        rotation = data.xmat[last].reshape(3, 3).T
        turn, back = np.zeros(4), np.zeros(4)
        mujoco.mju_negQuat(back, data.xquat[last])
        mujoco.mju_mulQuat(turn, back, data.xquat[body.index])
        place = rotation @ (data.xpos[body.index] - data.xpos[last])
        self.spec.body(arm._names[-1]).add_site(name=names[0], pos=place, quat=turn)
        self.spec.body(body.name).add_site(name=names[1])
        self._join(mujoco.mjtEq.mjEQ_WELD, *names)

    def _join(self, kind: mujoco.mjtEq, first: str, second: str) -> None:
        join = self.spec.add_equality(
            name=next(self._names), type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, name1=first, name2=second,
            solref=self._stiff, solimp=IMPEDANCE,
        )  # fmt: skip
        join.active = True
        self.compile()

    # -------------------------------------------------------------------------------------------- contact, distance

    def _contacts(self) -> list[tuple[tuple[Geometry, Geometry], Vector, Array]]:
        """Pairs of shapes, places and, in the world frame, forces on the second that the step just taken had."""
        model, data, found, wrench = self.model, self.data, [], np.zeros(6)
        contacts = data.contact
        for index, (pair, place, frame) in enumerate(zip(contacts.geom.tolist(), contacts.pos, contacts.frame)):
            mujoco.mj_contactForce(model, data, index, wrench)
            x, y, z = place.tolist()
            force = np.r_[wrench[0], wrench[:3] @ frame.reshape(3, 3)]
            found.append(((self._known[pair[0]], self._known[pair[1]]), (x, y, z), force))
        return found

    def touches(self, body: int) -> list[Touch]:
        result = []
        for pair, place, (normal, *force) in self._touches:
            for side in (0, 1):
                if pair[side].item == body:
                    x, y, z = (component if side else -component for component in force)
                    result.append(Touch(pair[side].link, pair[1 - side].item, place, float(normal), (x, y, z)))
        return result

    def distance(self, first: int, second: int, limit: float) -> float:
        model, data, ends = self.model, self.data, np.zeros(6)
        one, other = self._solid[first], self._solid[second]
        if not (len(one) and len(other)):
            return limit
        apart = np.linalg.norm(data.geom_xpos[one, None] - data.geom_xpos[None, other], axis=2)
        least = apart - model.geom_rbound[one, None] - model.geom_rbound[None, other]
        closest = limit
        for index in np.argsort(least, axis=None):
            a, b = np.unravel_index(index, least.shape)
            if least[a, b] >= closest:
                break
            closest = min(closest, mujoco.mj_geomDistance(model, data, int(one[a]), int(other[b]), limit, ends))
        return float(closest)

    @contextlib.contextmanager
    def kept(self) -> Iterator[None]:
        kind = int(mujoco.mjtState.mjSTATE_INTEGRATION)
        state = np.zeros(mujoco.mj_stateSize(self.model, kind))
        mujoco.mj_getState(self.model, self.data, state, kind)
        yield
        mujoco.mj_setState(self.model, self.data, state, kind)
        mujoco.mj_step1(self.model, self.data)

    # ----------------------------------------------------------------------------------------------------- pictures

    def photograph(self, camera: Camera, size: tuple[int, int]) -> Image:
        yaw, pitch = np.radians((camera.yaw, camera.pitch))
        ahead = np.array((-np.sin(yaw) * np.cos(pitch), np.cos(yaw) * np.cos(pitch), np.sin(pitch)))
        right = np.array((np.cos(yaw), np.sin(yaw), 0.0))
        eye = camera.target - camera.distance * ahead
        return self._trace(eye, (right, np.cross(right, ahead), ahead), camera.field_of_view, size, (1.0, -1.0, 2.0))[0]

    def look_down(self, camera: Overhead) -> tuple[Image, Array]:
        frame = np.array((1.0, 0.0, 0.0)), np.array((0.0, 1.0, 0.0)), np.array((0.0, 0.0, -1.0))
        colours, depth = self._trace(
            np.array(camera.position), frame, camera.field_of_view, camera.size, (0.3, -0.3, 1.0)
        )
        return colours, camera.position[2] - np.clip(depth, camera.near, camera.far)

    def _trace(
        self, eye: Array, frame: tuple[Array, Array, Array], angle: float, size: tuple[int, int], light: Vector
    ) -> tuple[Image, Array]:
        """Colours (height, width, 3) and depth along the axis (height, width) [m], infinite where nothing is."""
        (width, height), (right, up, ahead) = size, frame
        tall = np.tan(np.radians(angle) / 2)
        across = (2 * np.arange(width) + 1 - width) / height * tall
        along = (height - 1 - 2 * np.arange(height)) / height * tall
        rays = (ahead + across[:, None] * right)[None] + along[:, None, None] * up
        lengths = np.linalg.norm(rays, axis=2, keepdims=True)
        count, vectors = width * height, (rays / lengths).ravel()
        hit, far, normal = np.zeros(count, dtype=np.int32), np.zeros(count), np.zeros(3 * count)
        mujoco.mj_multiRay(self.model, self.data, eye, vectors, None, 1, -1, hit, far, normal, count, mujoco.mjMAXVAL)
        lit = np.clip(normal.reshape(-1, 3) @ (np.array(light) / np.linalg.norm(light)), 0.0, 1.0)
        paint = self.model.geom_rgba[hit, :3] * (0.6 + 0.4 * lit[:, None])
        colours = np.where((hit >= 0)[:, None], paint, 1.0).reshape(height, width, 3)
        depth = np.where(hit >= 0, far, np.inf).reshape(height, width) / lengths[..., 0]
        return (255 * np.clip(colours, 0.0, 1.0)).astype(np.uint8), depth

    def solids(self) -> list[Solid]:
        found = []
        for geometry in self.geometries:
            shape, body = geometry.shape, int(self.model.geom(geometry.name).bodyid[0])
            if shape.colour[3] > 0:
                colour, place = tuple(shape.colour), tuple(shape.pose.xyz)
                found.append(
                    Solid(geometry.item, body, shape.kind, tuple(shape.size), colour, place, shape.pose.quaternion)
                )
        return found

    def whereabouts(self, seen: Sequence[Solid]) -> Array:
        poses, turn = [], np.zeros(4)
        for solid in seen:
            place = self.data.xpos[solid.link] + self.data.xmat[solid.link].reshape(3, 3) @ solid.place
            i, j, k, w = solid.turn
            mujoco.mju_mulQuat(turn, self.data.xquat[solid.link], np.array((w, i, j, k)))
            poses.append((*place, *turn[1:], turn[0]))
        return np.array(poses)


class MujocoModel(RigidBodyModel):
    """The model of an arm in a scene of its own that is never stepped."""

    def _load(self, gravity: Sequence[float]) -> None:
        spec = _empty(gravity)
        _add_arm(spec, self.arm, "")
        self._model = _compiled(spec)
        self._data = mujoco.MjData(self._model)
        self._torque, self._mass = np.zeros(self.dof), np.zeros((self.dof, self.dof))
        self._rows = np.zeros((6, self.dof))

    def close(self) -> None:
        """Nothing is held."""

    def _pose(self, q: Array) -> None:
        self._data.qpos[:] = q
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_comPos(self._model, self._data)

    def mass_matrix(self, q: Array) -> Array:
        self._pose(q)
        mujoco.mj_makeM(self._model, self._data)
        mujoco.mj_fullM(self._model, self._data, self._mass)
        return self._mass.copy()

    def inverse_dynamics(self, q: Array, dq: Array, ddq: Array) -> Array:
        self._data.qacc[:] = ddq
        return self._newton_euler(q, dq, 1)

    def bias(self, q: Array, dq: Array) -> Array:
        return self._newton_euler(q, dq, 0)

    def _newton_euler(self, q: Array, dq: Array, accelerates: int) -> Array:
        self._pose(q)
        self._data.qvel[:] = dq
        mujoco.mj_comVel(self._model, self._data)
        mujoco.mj_rne(self._model, self._data, accelerates, self._torque)
        return self._torque.copy()

    def gravity(self, q: Array) -> Array:
        return self.bias(q, np.zeros(self.dof))

    def jacobian(self, q: Array) -> Array:
        self._pose(q)
        mujoco.mj_jacSite(self._model, self._data, self._rows[:3], self._rows[3:], 0)
        return self._rows.copy()

    def tip_torque(self, q: Array, force: Sequence[float]) -> Array:
        torque: Array = np.asarray(force, dtype=float) @ self.jacobian(q)[:3]
        return torque

    def forward(self, q: Array) -> tuple[Array, Array]:
        self._pose(q)
        return self._data.site_xpos[0].copy(), self._data.site_xmat[0].reshape(3, 3).copy()


def _empty(gravity: Sequence[float]) -> mujoco.MjSpec:
    spec = mujoco.MjSpec()
    spec.compiler.degree, spec.compiler.autolimits = False, False
    option = spec.option
    option.gravity, option.integrator = gravity, mujoco.mjtIntegrator.mjINT_EULER
    option.cone, option.impratio = mujoco.mjtCone.mjCONE_ELLIPTIC, 10.0
    option.noslip_iterations = 10
    option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_EULERDAMP)
    option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)  # what diverges is to be seen to diverge
    return spec


def _compiled(spec: mujoco.MjSpec) -> mujoco.MjModel:
    try:
        return spec.compile()
    except ValueError as error:
        raise LoadingError(f"MuJoCo cannot load it: {' '.join(str(error).split())}") from error


def _add_arm(spec: mujoco.MjSpec, arm: Arm, prefix: str) -> list[mujoco.MjsBody]:
    """Add the bodies, joints and the end point (a site ``tip``) of an arm; its shapes are not added."""
    parent, bodies, step = spec.worldbody, [], 5.0 * spec.option.timestep
    places = [*arm.origins, *(pose.matrix for pose, _ in arm.bodies)]
    for index, (place, link) in enumerate(zip(places, [*arm.links, *(link for _, link in arm.bodies)], strict=True)):
        moments, turn = _principal(link.inertia_matrix)
        parent = parent.add_body(
            name=f"{prefix}{index}", pos=place[:3, 3], quat=_quaternion(place[:3, :3]), mass=link.mass, ipos=link.com,
            inertia=moments, iquat=turn, explicitinertial=True,
        )  # fmt: skip
        bodies.append(parent)
        if index < arm.dof:
            joint = arm.joints[index]
            limited = np.isfinite((joint.lower, joint.upper)).all()
            parent.add_joint(
                name=f"{prefix}{index}", type=mujoco.mjtJoint.mjJNT_HINGE, axis=joint.axis, limited=int(limited),
                range=(joint.lower, joint.upper) if limited else (0.0, 0.0), solref_limit=(step, 1.0),
                solimp_limit=IMPEDANCE,
            )  # fmt: skip
    local = arm.tip
    for pose, _ in arm.bodies:
        local = np.linalg.inv(pose.matrix) @ local
    parent.add_site(name=f"{prefix}tip", pos=local[:3, 3], quat=_quaternion(local[:3, :3]))
    return bodies


def _principal(inertia: Array) -> tuple[Array, Array]:
    """Principal moments [kg m^2] and the quaternion (w, x, y, z) of their axes."""
    moments, axes = np.linalg.eigh(inertia)
    if np.linalg.det(axes) < 0:
        axes[:, 0] = -axes[:, 0]
    moments[2] = min(moments[2], moments[0] + moments[1])  # rounding breaks the triangle inequality of a thin rod
    return moments, _quaternion(axes)


def _quaternion(rotation: Array) -> Array:
    quaternion = np.zeros(4)
    mujoco.mju_mat2Quat(quaternion, np.ascontiguousarray(rotation).ravel())
    return quaternion


def _size(shape: Shape) -> list[float]:
    """Half sides of a box, else radius and half length."""
    if shape.kind == "box":
        return [side / 2 for side in shape.size]
    radius, *length = shape.size
    return [radius, length[0] / 2 if length else 0.0, 0.0]


def _inertia(shapes: Sequence[Shape], mass: float) -> Array:
    """Inertia (3, 3) [kg m^2] about the body's origin of solid shapes of one density."""
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body()
    for shape in shapes:
        i, j, k, w = shape.pose.quaternion
        body.add_geom(type=KINDS[shape.kind], size=_size(shape), pos=shape.pose.xyz, quat=(w, i, j, k))
    model = spec.compile()
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, model.body_iquat[1])
    axes, com, share = turn.reshape(3, 3), model.body_ipos[1], mass / model.body_mass[1]
    central = share * axes @ np.diag(model.body_inertia[1]) @ axes.T
    inertia: Array = central + mass * (com @ com * np.eye(3) - np.outer(com, com))
    return inertia


scene = MujocoScene
Model = MujocoModel
