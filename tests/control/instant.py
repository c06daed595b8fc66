"""What a control law is told at one instant, in short."""

import numpy as np

from dexrepro.control.contract import Measured


def at(position, force=0.0, velocity=0.0, time=0.0, joints=None):
    """``joints``: angles and rates of an end-point law's arm, by default its position and velocity."""
    angles, rates = (position, velocity) if joints is None else joints
    return Measured(time, position, velocity, force, np.asarray(angles), np.asarray(rates))
