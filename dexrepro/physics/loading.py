"""Loading an arm into a physics client without the engine's silent defaults."""

from __future__ import annotations

import ctypes
import math
import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress

import numpy as np
import pybullet as bullet

from dexrepro.robots.arm import Arm


class LoadingError(RuntimeError):
    """The physics engine complained about, or changed, the description it was given."""


def can_open_window() -> bool:
    """Whether there is a display; the engine ends the whole process where it finds none."""
    if not sys.platform.startswith("linux"):
        return True
    try:
        x11 = ctypes.CDLL("libX11.so.6")
    except OSError:
        return False
    x11.XOpenDisplay.restype = ctypes.c_void_p
    display = x11.XOpenDisplay(None)
    if display:
        x11.XCloseDisplay(ctypes.c_void_p(display))
    return bool(display)


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
        with _captured() as output, suppress(bullet.error):
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


@contextmanager
def _captured() -> Iterator[list[str]]:
    """Catch what native code prints on both output streams; the text is the list's only item afterwards."""
    sys.stdout.flush()
    sys.stderr.flush()
    output = [""]
    saved = os.dup(1), os.dup(2)
    with tempfile.TemporaryFile() as file:
        try:
            os.dup2(file.fileno(), 1)
            os.dup2(file.fileno(), 2)
            yield output
        finally:
            for target, copy in zip((1, 2), saved, strict=True):
                os.dup2(copy, target)
                os.close(copy)
            file.seek(0)
            output[0] = file.read().decode(errors="replace")
