"""The assistive follower from approach to holding: potential field, hand-over at contact, holding law."""

from __future__ import annotations

from dexrepro.arrays import Array
from dexrepro.control.contract import HoldingLaw
from dexrepro.control.hand_over import ContactLatch
from dexrepro.control.potential_field import PotentialField
from dexrepro.physics.drive import HoldingDrive
from dexrepro.physics.plant import Sense
from dexrepro.physics.servo import JointServo, PoseServo


class AssistiveFollower:
    """Where AFR goes: into the field until the latch closes, then at the holding law's distance from DFR, Eq. (1.33).

    speed_limit: of the distance command [m/s]. ``phase`` is 0 in the field and 1 while holding; ``switches`` counts
    changes of it; ``opening`` [m] is added to the distance (to let go).
    """

    def __init__(
        self, follower: PoseServo, field: PotentialField, latch: ContactLatch, law: HoldingLaw, *, speed_limit: float
    ) -> None:
        self.follower, self.field, self.latch = follower, field, latch
        self.law = HoldingDrive(law, speed_limit * follower.dt)
        self.phase, self.switches, self.force, self.opening = 0, 0, 0.0, 0.0

    def reset(self, position: Array, tip: Array) -> None:
        """Start from joint angles [rad] and the end point [m] that belongs to them, in the field."""
        self.follower.reset(position)
        self.field.reset(tip)
        self.latch.reset()

    def go(self, sense: Sense, partner: Array, axis: Array, measured: Array, rotation: Array) -> JointServo:
        """One control period: commanded pose of DFR (``partner`` [m], ``axis``), object as seen, own orientation."""
        tip = sense.tip
        self.force = max(0.0, float(sense.force @ axis))
        holding = self.latch(self.force)
        if holding and not self.phase:
            self.contact = float((tip - partner) @ axis)
            self.law.reset(sense.time, 0.0)
        elif self.phase and not holding:
            self.field.reset(tip)
        self.switches += int(holding != bool(self.phase))
        self.phase = int(holding)
        if not holding:
            return self.follower.go(sense, self.field(partner, axis, measured) + self.opening * axis, rotation)
        reference = float(self.law(sense.time, float((tip - partner) @ axis) - self.contact, self.force))
        target = partner + (self.contact + reference + self.opening) * axis
        return self.follower.go(sense, target, rotation)
