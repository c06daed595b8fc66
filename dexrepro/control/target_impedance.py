"""A planar arm whose tip obeys a target impedance along the holding line, by inverse dynamics of its own model."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from dexrepro.arrays import Row
from dexrepro.control.contract import Command, Kind, Measured
from dexrepro.control.motion import Motion

if TYPE_CHECKING:
    from dexrepro.robots.planar import PlanarChain


class TargetImpedance:
    """Joint torque under which m a + b v + k (x - x_r) = f_x - f_x,d holds at the tip, Eqs. (2.25), (2.26).

    Across the line (y) the tip follows its reference as a critically damped system. The redundant joint motion is
    damped. Plain floats.

    model: the arm's own kinematics and dynamics (a ``PlanarChain``).
    mass, damping, stiffness: m [kg], b [N s/m], k [N/m]. desired_force: f_x,d [N].
    across: natural frequency across the line [rad/s]. null_damping: decay rate of the redundant motion [1/s].
    """

    kind: ClassVar[Kind] = "end_point"
    needs = ("model",)

    def __init__(
        self,
        *,
        model: PlanarChain[float],
        mass: float,
        damping: float,
        stiffness: float,
        desired_force: float,
        across: float = 100.0,
        null_damping: float = 20.0,
    ) -> None:
        self.model, self.desired_force = model, desired_force
        self.mass, self.damping, self.stiffness = mass, damping, stiffness
        self.across, self.null_damping = across, null_damping

    def reset(self, measured: Measured[Row[float]]) -> None:
        """Nothing is remembered."""

    def __call__(self, measured: Measured[Row[float]], desired: Motion[Row[float]]) -> Command:
        """Torque [N m] from angles, rates and the force at the tip, for a reference position (x_r, y_d) [m] at rest."""
        _, _, _, force, q, dq = measured
        model, target = self.model, desired.position
        x, y = model.forward(q)
        (x1, x2, x3), (y1, y2, y3) = model.jacobian(q)
        vx, vy = x1 * dq[0] + x2 * dq[1] + x3 * dq[2], y1 * dq[0] + y2 * dq[1] + y3 * dq[2]
        cx, cy = model.centripetal(q, dq)
        decay = self.null_damping
        # What the tip still lacks once the joints have their null-space damping -decay dq.
        error = force[0] - self.desired_force
        ax = (error - self.damping * vx - self.stiffness * (x - target[0])) / self.mass - cx + decay * vx
        ay = self.across * (self.across * (target[1] - y) - 2 * vy) - cy + decay * vy
        xx, yy, xy = x1 * x1 + x2 * x2 + x3 * x3, y1 * y1 + y2 * y2 + y3 * y3, x1 * y1 + x2 * y2 + x3 * y3
        determinant = xx * yy - xy * xy
        u, v = (yy * ax - xy * ay) / determinant, (xx * ay - xy * ax) / determinant
        rates = (x1 * u + y1 * v - decay * dq[0], x2 * u + y2 * v - decay * dq[1], x3 * u + y3 * v - decay * dq[2])
        torque: Any = [t - c for t, c in zip(model.torque(q, dq, rates), model.tip_torque(q, (force[0], force[1])))]
        return Command(torque)
