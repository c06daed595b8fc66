"""``dexrepro new controller NAME --kind KIND``: a working control law in the user's folder, with its test."""

from __future__ import annotations

import importlib.util
import keyword
from pathlib import Path
from typing import NamedTuple

from dexrepro.errors import InputError


class Template(NamedTuple):
    """A law of one kind, what it is built with, its test, and the comparison that it joins."""

    law: str
    settings: str
    test: str
    comparison: str


TEMPLATES = {
    "joint": Template(
        '''"""A joint law of your own: from joint angles and rates, and what they should be, to torque."""

import numpy as np

from dexrepro.control.contract import Command


class {name}:
    """Torque that pulls every joint to where it should be, within a limit.

    stiffness [N m/rad], damping [N m s/rad]: one number for all joints. limit [N m].
    """

    kind = "joint"
    ranges = {{"stiffness": (10.0, 100.0), "damping": (0.02, 1.0), "limit": (0.1, 2.0)}}  # for compare

    def __init__(self, stiffness: float, damping: float, limit: float) -> None:
        self.stiffness, self.damping, self.limit = stiffness, damping, limit

    def reset(self, measured) -> None:
        """Nothing is remembered."""

    def __call__(self, measured, desired) -> Command:
        """Torque (n,) [N m] after one control period."""
        error, rate = desired.position - measured.position, desired.velocity - measured.velocity
        return Command(np.clip(self.stiffness * error + self.damping * rate, -self.limit, self.limit))
''',
        "stiffness: 30.0, damping: 0.1, limit: 0.5",
        '''"""A joint with a known inertia must come to rest where it should be."""

import numpy as np
import pytest
from {module} import {name}

from dexrepro.control.contract import Measured
from dexrepro.control.motion import Motion


def test_a_joint_comes_to_rest_where_it_should_be():
    law, inertia, q, dq = {name}(stiffness=30.0, damping=0.5, limit=0.5), 2e-3, np.zeros(1), np.zeros(1)
    desired = Motion(np.array([0.2]), np.zeros(1), np.zeros(1))
    for k in range(1000):
        measured = Measured(1e-3 * k, q, dq, np.zeros(1))
        if k == 0:
            law.reset(measured)
        dq = dq + 1e-3 * law(measured, desired).torque / inertia
        q = q + 1e-3 * dq
    assert q[0] == pytest.approx(0.2, abs=1e-3)
''',
        "bounded_tracking.cases.mine={{hand.letter: w, law: {law}}}",
    ),
    "end_point": Template(
        '''"""An end-point law of your own: from place and velocity of the end point, and the desired ones, to force."""

from dexrepro.control.contract import Command


class {name}:
    """Force of a spring and a damper between the end point and where it should be, and of what integrates the error.

    stiffness [N/m], damping [N s/m], integral [N/(m s)]: one number for all axes. dt: control period [s].
    """

    kind = "end_point"
    ranges = {{"stiffness": (500.0, 8000.0), "damping": (20.0, 400.0), "integral": (500.0, 20000.0)}}  # for compare

    def __init__(self, stiffness: float, damping: float, integral: float, dt: float) -> None:
        self.stiffness, self.damping, self.integral, self.dt = stiffness, damping, integral, dt

    def reset(self, measured) -> None:
        """Forget the past."""
        self.sum = 0.0 * measured.position

    def __call__(self, measured, desired) -> Command:
        """Force (d,) [N] after one control period."""
        error, rate = desired.position - measured.position, desired.velocity - measured.velocity
        self.sum = self.sum + self.dt * error
        return Command(force=self.stiffness * error + self.damping * rate + self.integral * self.sum)
''',
        "stiffness: 2000.0, damping: 80.0, integral: 8000.0, dt: 0.001",
        '''"""A mass under an unknown constant load must come to rest where it should be."""

import numpy as np
import pytest
from {module} import {name}

from dexrepro.control.contract import Measured
from dexrepro.control.motion import Motion


def test_a_mass_comes_to_rest_where_it_should_be_in_spite_of_a_load():
    law, mass, x, v = {name}(stiffness=2000.0, damping=80.0, integral=8000.0, dt=1e-3), 2.0, np.zeros(2), np.zeros(2)
    desired = Motion(np.array([0.05, 0.0]), np.zeros(2), np.zeros(2))
    for k in range(4000):
        measured = Measured(1e-3 * k, x, v, np.zeros(2))
        if k == 0:
            law.reset(measured)
        v = v + 1e-3 * (law(measured, desired).force + np.array([0.0, -20.0])) / mass
        x = x + 1e-3 * v
    assert x == pytest.approx(desired.position, abs=1e-4)
''',
        "circle_tracking.cases.mine={{duration: 10, law: {law}}}",
    ),
    "holding": Template(
        '''"""A holding law of your own: from position and contact force along the holding line to a reference."""


class {name}:
    """Moves the arm along the holding line until the contact force is the desired one.

    gain: speed per force error [m/(N s)]. desired_force [N]. dt: control period [s].
    """

    kind = "holding"
    ranges = {{"gain": (0.005, 0.1)}}  # for compare

    def __init__(self, gain: float, desired_force: float, dt: float) -> None:
        self.gain, self.desired_force, self.dt = gain, desired_force, dt

    def reset(self, measured) -> None:
        """Start where the arm is when contact begins."""
        self.reference = measured.position

    def __call__(self, measured) -> float:
        """Reference [m] after one control period."""
        self.reference += self.gain * (measured.force - self.desired_force) * self.dt
        return self.reference
''',
        "gain: 0.02, desired_force: 1.0, dt: 0.001",
        '''"""On a spring with a known stiffness the force must settle at the desired one."""

import pytest
from {module} import {name}

from dexrepro.control.contract import Measured


def test_the_force_settles_on_a_spring():
    law, stiffness, position = {name}(gain=0.02, desired_force=1.0, dt=0.001), 35.0, 0.0
    law.reset(Measured(0.0, position, 0.0, 0.0))
    for k in range(20_000):
        position = law(Measured(0.001 * k, position, 0.0, stiffness * (0.1 - position)))
    assert stiffness * (0.1 - position) == pytest.approx(1.0, rel=1e-3)
''',
        "holding_comparison.cases.mine={{law: {law}}}",
    ),
}


def new_controller(name: str, kind: str, folder: Path) -> tuple[Path, Path, str]:
    """Write ``<module>.py`` and ``test_<module>.py``; returns both paths and the command that joins a comparison.

    kind: one of TEMPLATES. Raises InputError for a name that is no class name, or whose file exists already or would
    hide another module.
    """
    if not name.isidentifier() or not name.isascii() or not name[0].isupper() or keyword.iskeyword(name):
        raise InputError(f"'{name}' is not allowed: it must be a class name such as MyLaw")
    module = "".join(f"_{c.lower()}" if c.isupper() else c for c in name).lstrip("_")
    law, test = folder / f"{module}.py", folder / f"test_{module}.py"
    for path in (law, test):
        if path.exists():
            raise InputError(f"{path} exists already; choose another name")
    if importlib.util.find_spec(module) is not None:
        raise InputError(f"'{name}' is not allowed: {law.name} would hide the module '{module}' of Python or a package")
    template = TEMPLATES[kind]
    law.write_text(template.law.format(name=name), encoding="utf-8")
    test.write_text(template.test.format(name=name, module=module), encoding="utf-8")
    case = template.comparison.format(law=f"{{_target_: {module}.{name}, {template.settings}}}")
    return law, test, f"dexrepro run only={case.partition('.')[0]} '+{case}'"
