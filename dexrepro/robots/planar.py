"""Planar arms: revolute joints about z, links along x, in the plane z = 0."""

from __future__ import annotations

from collections.abc import Sequence

from dexrepro.robots.arm import Arm, Colour, Joint, Link, Pose, Shape, Tool

BLUE: Colour = (0.25, 0.45, 0.75, 1.0)


def planar(
    lengths: Sequence[float],
    masses: Sequence[float],
    inertias: str | Sequence[float] = "rods",
    centres: Sequence[float] | None = None,
    base: Pose | Sequence[float] = Pose(),
    effort: float = float("inf"),
    tool: Tool | None = None,
    radius: float = 0.02,
    colour: Colour = BLUE,
) -> Arm:
    """A planar arm of n links whose joint angles are measured from the link before, counterclockwise.

    lengths [m], masses [kg]: n numbers each.
    inertias: n moments about the centres of mass [kg m^2]; or "rods", m l^2 / 12 with the centre half-way (what we
        take where the book is silent); or "points", all mass at the far end of each link.
    centres: distance of the centre of mass from the link's joint [m]; by default half-way (at the end for "points").
    base: pose in the world, or (x, y) [m], or (x, y, heading) [m, rad].
    effort: largest torque of every joint [N m]. radius [m] of the capsule that stands for a link.
    Gravity belongs to the world: it acts along -y where the plane is meant to be vertical.
    """
    if isinstance(inertias, str) and inertias not in ("rods", "points"):
        raise ValueError(f"inertias: '{inertias}' is neither 'rods', 'points' nor a list of moments")
    points = inertias == "points"
    if centres is None:
        centres = [length if points else length / 2 for length in lengths]
    if isinstance(inertias, str):
        inertias = [0.0 if points else mass * length**2 / 12 for mass, length in zip(masses, lengths, strict=True)]
    if not isinstance(base, Pose):
        x, y, *heading = (float(value) for value in base)
        base = Pose((x, y, 0.0), (0.0, 0.0, heading[0] if heading else 0.0))
    links, joints, reach = [], [], 0.0
    for i, (length, mass, moment, centre) in enumerate(zip(lengths, masses, inertias, centres, strict=True), 1):
        shape = Shape.between((0, 0, 0), (length, 0, 0), radius, colour)
        # In the plane only izz matters; the others are those of a slender body along x.
        inertia = (1e-3 * moment, 0.0, 0.0, moment, 0.0, moment)
        links.append(Link(f"link{i}", float(mass), (float(centre), 0.0, 0.0), inertia, (shape,)))
        joints.append(Joint(f"joint{i}", Pose((reach, 0.0, 0.0)), effort=effort))
        reach = float(length)
    return Arm("planar", tuple(joints), tuple(links), end=Pose((reach, 0.0, 0.0)), tool=tool, base=base)
