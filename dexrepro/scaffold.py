"""``dexrepro new controller NAME``: a working control law in the user's folder, with its test."""

from __future__ import annotations

import importlib.util
import keyword
from pathlib import Path

from dexrepro.config import InputError

_LAW = '''"""A holding law of your own: from position and contact force along the holding line to a reference."""


class {name}:
    """Moves the arm along the holding line until the contact force is the desired one.

    gain: speed per force error [m/(N s)]. desired_force [N]. dt: control period [s].
    """

    def __init__(self, gain: float, desired_force: float, dt: float) -> None:
        self.gain, self.desired_force, self.dt = gain, desired_force, dt

    def reset(self, position: float) -> None:
        """Start at a position [m]."""
        self.reference = position

    def __call__(self, position: float, force: float) -> float:
        """Reference [m] after one control period, from the measured position [m] and force [N]."""
        self.reference += self.gain * (force - self.desired_force) * self.dt
        return self.reference
'''

_TEST = '''"""On a spring with a known stiffness the force must settle at the desired one."""

import pytest
from {module} import {name}


def test_the_force_settles_on_a_spring():
    law, stiffness, position = {name}(gain=0.02, desired_force=1.0, dt=0.001), 35.0, 0.0
    law.reset(position)
    for _ in range(20_000):
        position = law(position, stiffness * (0.1 - position))
    assert stiffness * (0.1 - position) == pytest.approx(1.0, rel=1e-3)
'''


def new_controller(name: str, folder: Path) -> tuple[Path, Path, str]:
    """Write ``<module>.py`` and ``test_<module>.py``; returns both paths and the command that joins a comparison.

    Raises InputError for a name that is no class name, or whose file exists already or would hide another module.
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
    law.write_text(_LAW.format(name=name))
    test.write_text(_TEST.format(name=name, module=module))
    case = f"{{law: {{_target_: {module}.{name}, gain: 0.02, desired_force: 1.0, dt: 0.001}}}}"
    return law, test, f"dexrepro run only=holding_comparison '+holding_comparison.cases.mine={case}'"
