"""What a World asks of a physics engine, and which engine it is: one for a whole process, PyBullet unless told."""

from __future__ import annotations

import importlib
import importlib.util
from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from typing import TYPE_CHECKING, Any, Protocol, cast

if TYPE_CHECKING:
    import numpy as np

    from dexrepro.arrays import Array, Image
    from dexrepro.physics.model import RigidBodyModel
    from dexrepro.physics.plant import RigidBody, SimulatedArm, Touch
    from dexrepro.physics.rendering import Camera, Overhead, Solid
    from dexrepro.physics.sensor import Sensor
    from dexrepro.robots.arm import Arm, Shape

ENGINES = {"pybullet": "PyBullet", "mujoco": "MuJoCo"}
"""Their names by the word for each, which is that of its package and of its module in :mod:`.engines`."""

REFERENCE = "pybullet"  # the engine of the stored baselines

_chosen: list[str] = []


class Scene(Protocol):
    """One simulated scene of an engine; bodies and arms are numbered together, as they are added."""

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
    ) -> SimulatedArm:
        """Load an arm; without contacts its links touch nothing."""

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
    ) -> RigidBody:
        """Load a rigid body; the arguments are those of :meth:`World.add_body`."""

    def advance(self) -> object:
        """Take one physics step."""

    def hinge(self, arm: SimulatedArm, body: RigidBody, lever: tuple[float, float, float]) -> None:
        """Join an arm's end point and a point [m] in the frame of a body by a ball joint."""

    def hold(self, arm: SimulatedArm, body: RigidBody) -> None:
        """Fix a body to an arm's end point as it lies there now."""

    def touches(self, body: int) -> list[Touch]:
        """Contact points of a body or arm as of the last step."""

    def distance(self, first: int, second: int, limit: float) -> float:
        """Smallest distance [m] between two, negative where they overlap, at most ``limit``."""

    def kept(self) -> AbstractContextManager[None]:
        """Afterwards the state is what it was."""

    def photograph(self, camera: Camera, size: tuple[int, int]) -> Image:
        """Picture of shape (height, width, 3) for a size (width, height)."""

    def look_down(self, camera: Overhead) -> tuple[Image, Array]:
        """Colours (height, width, 3) and heights z (height, width) [m] that an overhead camera sees, free of noise."""

    def solids(self) -> list[Solid]:
        """Everything that is seen, meshes apart."""

    def whereabouts(self, seen: Sequence[Solid]) -> Array:
        """Poses (n, 7) of solids in the world: position [m] and quaternion x, y, z, w."""

    def close(self) -> None:
        """Free what the engine holds."""


class Engine(Protocol):
    """The module of an engine."""

    def scene(self, step: float, gravity: Sequence[float], iterations: int, gui: bool) -> Scene:
        """An empty scene; see :class:`World`."""

    @property
    def Model(self) -> type[RigidBodyModel]:
        """Its rigid-body model."""


def is_installed(name: str) -> bool:
    """Whether an engine can be used here."""
    return importlib.util.find_spec(name) is not None


def default() -> str:
    """PyBullet where it is installed, else what is."""
    return next(filter(is_installed, ENGINES), REFERENCE)


def use(word: str) -> None:
    """Choose the engine of the scenes and models made from now on."""
    _chosen[:] = [word]


def engine() -> Engine:
    """The module of the engine last chosen, else of the default."""
    word = _chosen[0] if _chosen else default()
    return cast(Engine, importlib.import_module(f"dexrepro.physics.engines.{word}"))


@contextmanager
def unseen() -> Iterator[None]:
    """Meanwhile pictures for people are black, which spares a simulation that nobody looks at a tenth to a third of its
    time; what a camera of the robot's sees is drawn as ever."""
    import numpy as np

    try:
        scene: Any = engine().scene
    except ImportError:  # what simulates no arm needs none
        yield
        return
    drawn = scene.photograph
    scene.photograph = lambda scene, camera, size: np.zeros((size[1], size[0], 3), np.uint8)
    try:
        yield
    finally:
        scene.photograph = drawn
