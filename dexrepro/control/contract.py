"""What every control law is given, what it returns, and what it may ask for: one contract for the library's and yours.

A law declares its ``kind``, which says in which coordinates it thinks:

- ``joint``: position and velocity are those of the joints (n,) [rad, rad/s], the force is the external torque of the
  joints (n,) [N m] as estimated; it returns a :class:`Command` with a torque.
- ``end_point``: they are those of the end point (d,) [m, m/s], the force is the one felt there (d,) [N]; it returns a
  :class:`Command` with a force at the end point or with joint torques.
- ``holding``: they are the displacement along the line of contact [m], its rate, and the force along it [N], positive
  in compression; it returns where the arm should be along that line [m], and is told nothing of a partner.

Where a holding law is wanted, a class without ``kind`` may have the plain shape ``reset(position)`` and
``__call__(position, force)``, see :class:`Plain`. The other kinds have none: a joint or end-point law is told more than
two numbers, in an order that nothing but a name would tell.

Adapters that drive an arm of a World with a law stand in :mod:`dexrepro.physics.drive`.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Collection, Mapping
from functools import partial
from typing import Any, ClassVar, Generic, Literal, NamedTuple, Protocol, TypeVar, cast

import numpy as np

from dexrepro.arrays import Array, Real
from dexrepro.control.motion import Motion, Value
from dexrepro.networks import AdaptiveNetwork

Law_ = TypeVar("Law_")
Kind = Literal["joint", "end_point", "holding"]
EMPTY: Array = np.empty(0)
NUMBERS = (int, float, np.number, np.ndarray)
KINDS: tuple[Kind, ...] = ("joint", "end_point", "holding")


class Measured(NamedTuple, Generic[Value]):
    """What a law may know at one instant: nothing of a partner, an object or the true model.

    time [s]; position, velocity, force: in the coordinates of the law's kind (nan: not measured there).
    angles, rates: joint angles and rates (n,) [rad, rad/s] of an end-point law's arm.
    """

    time: float
    position: Value
    velocity: Value
    force: Value
    angles: Array = EMPTY
    rates: Array = EMPTY


class Command(NamedTuple):
    """What a law asks of an arm: joint torque, or a force at the end point.

    torque: (n,) [N m]. damping: (n,) or (n, n) [N m s/rad], subtracted from it times the joint rates, implicitly, at
    every physics step (large velocity gains on light links are unstable at 1 kHz otherwise). force: (d,) [N].
    """

    torque: Array = EMPTY
    damping: Array | None = None
    force: Array | None = None


class Unusable(ValueError):
    """What a law gave is no command; the sentence shows it."""


class Undefined(Unusable):
    """A law gave numbers that are not finite."""


class Law(Protocol):
    """A law of kind ``joint`` or ``end_point``.

    A law may also have ``needs``, names among those a comparison offers (``model``, ``network``, ``stiffness``), which
    its constructor takes as keyword arguments (``_partial_: true`` in the configuration leaves them open);
    ``diagnostics()``, what deserves a channel of the recording by name (a node count, an estimate); and, if it learns,
    ``network``, its memory, and ``learning``, which freezes it when False. All of these may be absent.
    """

    kind: ClassVar[Kind]

    def reset(self, measured: Measured[Array]) -> None:
        """Start anew from what is measured; called before the first call of a run."""

    def __call__(self, measured: Measured[Array], desired: Motion[Array]) -> Command:
        """Once a control period."""


class HoldingLaw(Protocol):
    """A law of kind ``holding``; ``needs`` and ``diagnostics`` as for :class:`Law`."""

    kind: ClassVar[Kind]

    def reset(self, measured: Measured[Real]) -> None:
        """Start anew where the arm is when contact begins."""

    def __call__(self, measured: Measured[Real]) -> Real:
        """Where the arm should be along the line of contact [m], once a control period."""


class PlainLaw(Protocol):
    """A holding law of the plain shape, see :func:`is_plain`."""

    def reset(self, position: Real) -> None:
        """Start anew at a displacement [m]."""

    def __call__(self, position: Real, force: Real) -> Real:
        """Where the arm should be [m] at a displacement [m] and a force [N]."""


class Plain:
    """A holding law of the plain shape as one of the contract."""

    def __init__(self, law: PlainLaw) -> None:
        self.law = law

    def reset(self, measured: Measured[Real]) -> None:
        """Start anew at a displacement [m]."""
        self.law.reset(measured.position)

    def __call__(self, measured: Measured[Real]) -> Real:
        """Where the arm should be [m]."""
        return self.law(measured.position, measured.force)

    def diagnostics(self) -> Mapping[str, Real]:
        """Those of the law."""
        return report(self.law)


class NominalModel(Protocol):
    """What a law may know of its arm: dynamics and end point at joint angles and rates (n,) [rad, rad/s]."""

    def mass_matrix(self, q: Array) -> Array:
        """M(q), (n, n) [kg m^2]."""

    def gravity(self, q: Array) -> Array:
        """G(q), (n,) [N m]."""

    def bias(self, q: Array, dq: Array) -> Array:
        """C(q, dq) dq + G(q), (n,) [N m]."""

    def inverse_dynamics(self, q: Array, dq: Array, ddq: Array) -> Array:
        """M(q) ddq + C(q, dq) dq + G(q), (n,) [N m]."""

    def jacobian(self, q: Array) -> Array:
        """Velocity of the end point per joint rate, (3 or more, n) [m/rad]: x, y, z first."""


class Network(Protocol):
    """A learning approximator, such as :class:`dexrepro.networks.AdaptiveNetwork`."""

    @property
    def weights(self) -> Array:
        """W, (features, outputs); a view."""

    @property
    def nodes(self) -> int:
        """How many nodes it has."""

    def diagnostics(self) -> Mapping[str, float]:
        """What deserves a channel."""

    def output(self, z: Array, grow: bool = False) -> Array:
        """Value at an input; ``grow`` lets it add a node there first."""

    def adapt(self, error: Array) -> None:
        """One step of the weight law, at the input of the last ``output``."""

    def forget(self) -> None:
        """Start anew: no weights, and the nodes it had at first."""


def coriolis(model: NominalModel, q: Array, dq: Array, vector: Array) -> Array:
    """C(q, dq) v from inverse dynamics alone: [h(dq + v) - h(dq - v)] / 4 with h(u) = C(q, u) u + G(q), (n,) [N m]."""
    result: Array = (model.bias(q, dq + vector) - model.bias(q, dq - vector)) / 4
    return result


def build(law: Law_ | partial[Law_], **offers: object) -> Law_:
    """The law itself, or what a ``_partial_`` configuration of it makes of the offers its class ``needs``.

    Raises ValueError where the class cannot do without what the comparison does not offer.
    """
    if not isinstance(law, partial):
        return law
    taken = set(getattr(law.func, "needs", ())) & offers.keys() - law.keywords.keys()
    try:
        return law(**{name: offers[name] for name in taken})
    except TypeError as error:
        raise ValueError(f"law {_name(law.func)}: {error}; this comparison offers {', '.join(offers)}") from error


def printed_forms(printed: Collection[str], known: Collection[str]) -> frozenset[str]:
    """Which of a law's equations are taken as the book prints them. Raises ValueError for a word that is not known."""
    if isinstance(printed, str) or not set(printed) <= set(known):
        raise ValueError(f"printed = {printed} is not allowed: it must be a list of {', '.join(known)}")
    return frozenset(printed)


def check(law: Law_, kind: Kind) -> Law_:
    """The law, if its declared kind is the one wanted; a plain holding law, if such is wanted, in a :class:`Plain`.

    Raises ValueError with one sentence otherwise.
    """
    declared = getattr(law, "kind", None)
    if declared == kind and callable(law):
        return law
    if declared in KINDS:
        raise ValueError(f"law {_name(type(law))} is of kind '{declared}'; here a law of kind '{kind}' is wanted")
    if kind == "holding" and declared is None and is_plain(type(law)):
        return cast(Law_, Plain(cast(PlainLaw, law)))
    plain = "; or, without a kind, have reset(self, position) and __call__(self, position, force)"
    raise ValueError(
        f"{_name(type(law))} is no law: its class must declare kind = '{kind}' (kinds are {', '.join(KINDS)})"
        f"{plain if kind == 'holding' else ''}"
    )


def takes(law: type, method: str, *given: str) -> bool:
    """Whether objects of a class can be called so: a method by its name with just these arguments, in this order."""
    function: Any = next((vars(base)[method] for base in law.__mro__ if method in vars(base)), None)
    try:
        inspect.signature(function).bind(law, *given)
    except (TypeError, ValueError):
        return False
    return True


def is_plain(law: type) -> bool:
    """Whether a class that declares no kind is a plain holding law: ``reset`` takes a position, a call position and
    force, and not one argument alone, as in the contract."""
    calls = takes(law, "__call__", "position", "force") and not takes(law, "__call__", "measured")
    return not hasattr(law, "kind") and calls and takes(law, "reset", "position")


def number(value: object) -> float:
    """A value that is one finite number. Raises Undefined or Unusable."""
    if not isinstance(value, NUMBERS) or (isinstance(value, np.ndarray) and value.size != 1):
        raise Unusable(f"it gave {str(value)[:80]}, and one number is wanted")
    single = float(value.item() if isinstance(value, np.ndarray) else value)
    if not math.isfinite(single):
        raise Undefined(f"it gave {single}, and a finite number is wanted")
    return single


def report(law: object) -> Mapping[str, Real]:
    """What the law says of itself by ``diagnostics()``: numbers or arrays by name, nothing where it has none."""
    diagnostics = getattr(law, "diagnostics", None)
    found: Mapping[str, Real] = {} if diagnostics is None else diagnostics()
    return found


def memory(law: object) -> AdaptiveNetwork | None:
    """The network of a law, built or still partial; None where it has none."""
    return law.keywords.get("network") if isinstance(law, partial) else getattr(law, "network", None)


def channels(law: object, *names: str) -> dict[str, Callable[[], Real]]:
    """Probes for :meth:`World.run`: those of the named diagnostics that the law reports, each one channel."""
    return {name: lambda name=name: report(law)[name] for name in names if name in report(law)}  # type: ignore[misc]


def _name(kind: object) -> str:
    return getattr(kind, "__name__", str(kind))
