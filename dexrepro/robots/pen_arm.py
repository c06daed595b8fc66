"""A desktop arm that writes and carries small cubes: a turret and two pitching links; description and closed forms."""

from __future__ import annotations

import numpy as np

from dexrepro.arrays import Array
from dexrepro.robots.arm import Arm, Colour, Joint, Link, Pose, Shape, Tool

WHITE: Colour = (0.85, 0.85, 0.88, 1.0)
DARK: Colour = (0.2, 0.2, 0.25, 1.0)
LENGTH = 0.1335  # m, both links, device data


def pen_arm(
    tool: Tool | None = None,
    base: Pose = Pose(),
    masses: tuple[float, float, float] = (0.10, 0.060, 0.040),
    effort: float = 0.5,
) -> Arm:
    """The three-joint arm: yaw about z, then shoulder and elbow about -y (positive lifts), links of 0.1335 m.

    base: pose of the point where yaw and shoulder axis meet; at q = 0 the arm points along x. masses [kg] of turret
    and links: inertias scale with them. Lengths are the device's; masses and inertias, which include those of the
    drives, are chosen, as is the torque limit ``effort`` [N m]. The end point is the end of the second link, or the
    tip of a tool such as :func:`pen` or :func:`gripper`.
    """
    up = (0.0, -1.0, 0.0)
    # About the centre of mass, of 0.10, 0.060 and 0.040 kg; every set satisfies the triangle inequality.
    moments = ((5e-4, 5e-4, 1e-3), (5e-5, 8e-4, 7.6e-4), (3e-5, 4e-4, 3.8e-4))
    scales = [mass / nominal for mass, nominal in zip(masses, (0.10, 0.060, 0.040), strict=True)]
    inertias = [
        (scale * a, 0.0, 0.0, scale * b, 0.0, scale * c) for scale, (a, b, c) in zip(scales, moments, strict=True)
    ]
    rod = Shape.between((0, 0, 0), (LENGTH, 0, 0), 0.01, WHITE)
    turret = Shape("cylinder", (0.025, 0.05), Pose((0.0, 0.0, -0.035)), DARK)
    links = (
        Link("turret", masses[0], (0.0, 0.0, 0.0), inertias[0], (turret,)),
        Link("upper_arm", masses[1], (0.05, 0.0, 0.0), inertias[1], (rod,)),
        Link("forearm", masses[2], (0.06, 0.0, 0.0), inertias[2], (rod,)),
    )
    joints = (
        Joint("yaw", Pose(), effort=effort),
        Joint("shoulder", Pose(), up, effort=effort),
        Joint("elbow", Pose((LENGTH, 0.0, 0.0)), up, effort=effort),
    )
    stand = (Shape("cylinder", (0.035, 0.04), Pose((0.0, 0.0, -0.08)), DARK),)
    return Arm("pen_arm", joints, links, end=Pose((LENGTH, 0.0, 0.0)), tool=tool, base=base, base_shapes=stand)


def pen(mass: float = 0.015) -> Tool:
    """A pen, a small body at the end of the arm; its point is the end point. mass [kg]."""
    shape = Shape.between((0, 0, 0.004), (0, 0, 0.06), 0.004, DARK)
    moment = mass * 0.01**2
    return Tool("pen", mass=mass, inertia=(moment, 0.0, 0.0, moment, 0.0, moment), shapes=(shape,))


def gripper(mass: float = 0.060, moment: float = 2e-5) -> Tool:
    """A small gripper whose centre of mass is the end point. mass [kg], moment of inertia about any axis [kg m^2]."""
    jaws = tuple(Shape("box", (0.02, 0.004, 0.02), Pose((0.01, side, 0.0)), DARK) for side in (-0.012, 0.012))
    return Tool("gripper", mass=mass, inertia=(moment, 0.0, 0.0, moment, 0.0, moment), shapes=jaws)


def pen_arm_tip(angles: Array) -> Array:
    """Tip positions (..., 3) [m] in the frame of the arm's base for yaw, shoulder and elbow (..., 3) [rad]."""
    yaw, shoulder, elbow = np.moveaxis(angles, -1, 0)
    reach = LENGTH * (np.cos(shoulder) + np.cos(shoulder + elbow))
    height = LENGTH * (np.sin(shoulder) + np.sin(shoulder + elbow))
    return np.stack([reach * np.cos(yaw), reach * np.sin(yaw), height], axis=-1)


def pen_arm_angles(tip: Array) -> Array:
    """Yaw, shoulder and elbow (..., 3) [rad], elbow up, for tip positions (..., 3) [m] in the frame of the arm's base.

    Raises ValueError where a position is out of reach.
    """
    x, y, z = np.moveaxis(tip, -1, 0)
    reach = np.hypot(x, y)
    cosine = (reach**2 + z**2 - 2 * LENGTH**2) / (2 * LENGTH**2)
    if np.any(np.abs(cosine) > 1):
        raise ValueError(f"a tip position is out of the arm's reach of {2 * LENGTH:g} m")
    elbow = -np.arccos(cosine)
    shoulder = np.arctan2(z, reach) - np.arctan2(np.sin(elbow), 1 + np.cos(elbow))
    return np.stack([np.arctan2(y, x), shoulder, elbow], axis=-1)
