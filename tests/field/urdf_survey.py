"""Reads the arms of published URDF files and compares each with what Pinocchio makes of the same file.

    pip install 'dexrepro[dev]'
    pip install --no-deps --target robots example-robot-data airo-models icub-models jvrc-description dexmate-urdf
    python tests/field/urdf_survey.py robots "$(python -c 'import pybullet_data; print(pybullet_data.getDataPath())')"

An arm is a chain of two turning joints or more from a file's root to a link behind which none moves. It is sound if
its joints are free (none slides, floats or follows another) and every moving body has a mass and the inertia of a
rigid body. Compared at random postures: place of the end point, joint torques of the inverse dynamics.
"""

from __future__ import annotations

import re
import sys
import warnings
from collections import Counter, defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

from dexrepro.physics.model import RigidBodyModel
from dexrepro.robots.kinematics import forward
from dexrepro.robots.urdf import from_urdf

POSTURES = 3


def chains(model: Any) -> Iterator[list[int]]:
    """Joints from the root to each joint that carries no other."""
    for joint in range(1, model.njoints):
        if not model.children[joint]:
            yield list(model.supports[joint])[1:]


def last_link(model: Any, joint: int) -> str:
    """The link that the file hangs on a joint."""
    frame = next(f for f in model.frames if f.parentJoint == joint and f.type == pin.BODY)
    return str(frame.name)


def reduced(model: Any, chain: list[int]) -> Any:
    """The chain alone, with what it carries fixed to it at 0."""
    others = [joint for joint in range(1, model.njoints) if joint not in chain]
    return pin.buildReducedModel(model, others, pin.neutral(model))


def unsound(model: Any, chain: list[int], mimics: set[str]) -> str | None:
    """Why a chain is no arm that physics allows, None where it is one."""
    if not all(model.joints[j].shortname().startswith(("JointModelR", "JointModelM")) for j in chain):
        return "a joint slides or floats"
    if any(model.names[joint] in mimics for joint in chain):
        return "a joint follows another or is followed"
    for inertia in list(reduced(model, chain).inertias)[1:]:
        a, b, c = np.linalg.eigvalsh(inertia.inertia) if inertia.mass > 0 else (-1.0, 0.0, 0.0)
        if a < -1e-6 * abs(c):
            return "a body has no mass or a negative moment of inertia"
        if c > (a + b) * (1 + 1e-6):
            return "a moment of inertia exceeds the sum of the others"
    return None


def differences(file: Path, model: Any, chain: list[int], link: str, rng: Any) -> tuple[float, float]:
    """Largest distance of the end points [m], and of the torques as a share of the largest torque."""
    arm, small = from_urdf(str(file), link), reduced(model, chain)
    ours, data = RigidBodyModel(arm), small.createData()
    frame = next(k for k, f in enumerate(small.frames) if f.name == link and f.type == pin.BODY)
    place = torque = 0.0
    for _ in range(POSTURES):
        q, dq, ddq = rng.uniform(-1, 1, (3, arm.dof))
        angles = np.concatenate(
            [[np.cos(x), np.sin(x)] if joint.nq == 2 else [x] for x, joint in zip(q, list(small.joints)[1:])]
        )
        pin.framesForwardKinematics(small, data, angles)
        place = max(place, float(np.linalg.norm(forward(arm, q)[0] - data.oMf[frame].translation)))
        wanted = pin.rnea(small, data, angles, dq, ddq)
        torque = max(torque, float(np.abs(ours.inverse_dynamics(q, dq, ddq) - wanted).max() / np.abs(wanted).max()))
    ours.close()
    return place, torque


def survey(folder: Path) -> Iterator[tuple[str, ...]]:
    """One row an arm: file, link, what it is ("sound" or why not), and what became of it."""
    rng = np.random.default_rng(0)
    for file in sorted(folder.rglob("*.urdf")):
        name = str(file.relative_to(folder))
        text = re.sub(r"\s(?!xmlns)\w+:\w+=\"[^\"]*\"", "", file.read_text(errors="replace"))  # undeclared prefixes
        try:  # names of joints apart from those of links, which Pinocchio's reduction confuses
            model = pin.buildModelFromXML(re.sub(r"""(<joint\s[^>]*?\bname=["'])""", r"\1joint:", text))
        except (ValueError, RuntimeError) as error:
            yield name, "", "Pinocchio cannot read the file", " ".join(str(error).split())[:80]
            continue
        mimics = set()
        for part in re.split(r"<joint\b", text)[1:]:
            if follows := re.search(r"""<mimic\s[^>]*?joint\s*=\s*["']([^"']*)""", part.split("</joint")[0]):
                own = re.search(r"""\bname\s*=\s*["']([^"']*)""", part)
                mimics |= {f"joint:{name}" for name in (follows[1], own[1] if own else "")}
        for chain in chains(model):
            if len(chain) < 2:
                continue
            link, kind = last_link(model, chain[-1]), unsound(model, chain, mimics) or "sound"
            try:
                place, torque = differences(file, model, chain, link, rng)
                yield name, link, kind, "read", f"{place}", f"{torque}"
            except Exception as error:
                yield name, link, kind, f"{type(error).__name__}: {error}"


def main(folders: list[str]) -> int:
    mended: Counter[str] = Counter()
    warnings.showwarning = lambda message, *_: mended.update([str(message)])  # type: ignore[assignment]
    warnings.simplefilter("always", UserWarning)
    rows = [row for folder in folders for row in survey(Path(folder))]
    table: dict[str, list[tuple[str, ...]]] = defaultdict(list)
    for row in rows:
        table[row[2]].append(row)
    print(f"{len({row[0] for row in rows})} files, {sum(bool(row[1]) for row in rows)} arms, {len(mended)} mended")
    print(f"{'arms':60} {'all':>5} {'read':>5} {'place [m]':>10} {'torque [-]':>10}")
    for kind, found in sorted(table.items(), key=lambda item: -len(item[1])):
        read = [row for row in found if row[3] == "read"]
        worst = [max((float(row[k]) for row in read), default=0.0) for k in (4, 5)]
        print(f"{kind:60} {len(found):5} {len(read):5} {worst[0]:10.1e} {worst[1]:10.1e}")
    for row in rows:
        if row[2] == "sound" and (row[3] != "read" or float(row[4]) > 1e-6 or float(row[5]) > 1e-4):
            print("  ".join(row)[:400])
    sound = table["sound"]
    share = sum(row[3] == "read" for row in sound) / max(len(sound), 1)
    print(f"{100 * share:.1f} % of the sound arms are read")
    return 0 if share >= 0.98 else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
