import math

import numpy as np
import pytest
from instant import at

from dexrepro.control.force_control import ForceControl, IntegralForceControl
from dexrepro.control.holding_line import HoldingLineRegulation
from dexrepro.control.holding_reference import FadeIn, ImpedanceReference, KnownMovement, NonImpedanceReference
from dexrepro.control.joint_pd import JointPD
from dexrepro.control.motion import Motion
from dexrepro.control.movement_estimation import MovementEstimation
from dexrepro.control.passive_impedance import PassiveImpedance

DT, STIFFNESS, REST, DESIRED = 1e-3, 35.0, 0.55, 1.0


def hold(law, duration, partner=lambda t: 0.0, start=0.5):
    """The arm stands exactly where the law asks for; returns time and force."""
    law.reset(at(start))
    position, forces = start, []
    for i in range(round(duration / DT)):
        force = STIFFNESS * (REST + partner(i * DT) - position)
        forces.append(force)
        position = law(at(position, force))
    return np.array(forces)


def reference(kind=NonImpedanceReference, lead=None, **changes):
    gains = dict(stiffness=30.0, coefficients=(0.55, 0.0, 0.0), rates=(10.0, 100.0, 500.0, 500.0), dt=DT, window=1.0)
    estimation = MovementEstimation(**{**gains, **changes})
    return kind(
        estimation=estimation, desired_force=DESIRED, smoothing_rate=5, smoothing_power=1, dt=DT, **(lead or {})
    )


def test_lateral_offset_decays_with_the_time_constant_of_the_spring():
    law, length, offset = HoldingLineRegulation(gain=1e-3), 0.52, 0.08
    tau = length * DT / (1e-3 * DESIRED)
    for _ in range(round(tau / DT)):
        law(DESIRED * (offset + law.displacement) / length)
    assert offset + law.displacement == pytest.approx(offset / math.e, rel=2e-3)


def test_the_opposite_sign_of_the_regulation_drives_the_arms_apart():
    law, offset = HoldingLineRegulation(gain=1e-3, printed=False), 0.08
    for _ in range(1000):
        law(offset + law.displacement)
    assert offset + law.displacement == pytest.approx(offset * 1.001**1000), "with the time constant of the other sign"


def test_proportional_force_control_keeps_the_error_of_its_closed_form():
    gain = 0.01
    forces = hold(ForceControl(gain=gain, desired_force=DESIRED), 1.0)
    assert forces[-1] - DESIRED == pytest.approx((STIFFNESS * 0.05 - DESIRED) / (1 + gain * STIFFNESS), rel=1e-6)


def test_integral_force_control_removes_the_static_error():
    assert hold(IntegralForceControl(rate=0.5, desired_force=DESIRED, dt=DT), 2.0)[-1] == pytest.approx(
        DESIRED, abs=1e-6
    )


def test_passive_impedance_lags_a_moving_partner_by_damping_times_velocity():
    forces = hold(PassiveImpedance(mass=3.0, damping=8.0, desired_force=DESIRED, dt=DT), 30.0, lambda t: -0.01 * t)
    assert forces[-1] - DESIRED == pytest.approx(-0.01 * 8.0, abs=1e-4)


def test_passive_impedance_is_second_order_accurate():
    """Constant error e: v = e/b (1 - exp(-b t/m)); halving the step divides the error by four."""

    def position(dt):
        law = PassiveImpedance(mass=1.0, damping=2.0, desired_force=0.0, dt=dt)
        law.reset(at(0.0))
        for _ in range(round(1 / dt)):
            x = law(at(0.0, 1.0))
        return x

    exact = 0.5 * (1 - 0.5 * (1 - math.exp(-2.0)))
    assert abs(position(0.01) - exact) / abs(position(0.005) - exact) == pytest.approx(4, rel=0.1)


def test_estimated_reference_reaches_the_desired_force_on_an_unknown_object():
    assert hold(reference(), 6.0, lambda t: 0.05 * math.sin(0.3 * t))[-1000:] == pytest.approx(DESIRED, abs=0.02)


def test_static_equilibrium_obeys_the_wrong_stiffness():
    """Held at a wrong place, the force error is khat (x_r - x_1)."""
    law = reference(rates=(0.0, 100.0, 500.0, 500.0))
    law.reset(at(0.5))
    for _ in range(6000):
        target = law(at(0.51, STIFFNESS * (REST - 0.51)))
    assert 30.0 * (target - 0.51) == pytest.approx(STIFFNESS * (REST - 0.51) - DESIRED, abs=1e-5)


def test_lead_is_damping_times_velocity_plus_mass_times_acceleration():
    lead = dict(mass=0.01, damping=0.1, stiffness=10.0)
    frozen = dict(rates=(0, 0, 0, 0), coefficients=(0.55, 0.3, -0.2))
    plain, led = reference(**frozen), reference(ImpedanceReference, lead, **frozen)
    plain.reset(at(0.5)), led.reset(at(0.5))
    time = np.arange(900) * DT
    difference = [led(at(0.5, 1.0)) - plain(at(0.5, 1.0)) for _ in time]
    assert difference == pytest.approx(-np.expm1(-5 * time) * (0.1 * (0.3 - 0.4 * time) - 0.01 * 0.4) / 10.0, abs=1e-12)


def test_without_mass_and_damping_the_lead_vanishes():
    lead = dict(mass=0.0, damping=0.0, stiffness=10.0)
    assert np.array_equal(hold(reference(), 1.0), hold(reference(ImpedanceReference, lead), 1.0))


def test_reference_fades_in_from_where_the_arm_stands():
    law = reference()
    law.reset(at(0.5))
    assert law(at(0.5, 1.75)) == 0.5


def test_a_law_starts_afresh_after_reset():
    laws = reference(), PassiveImpedance(mass=3.0, damping=2.0, desired_force=DESIRED, dt=DT)
    for law in laws:
        assert np.array_equal(hold(law, 0.5), hold(law, 0.5))


def test_joint_pd_pulls_towards_the_reference_and_brakes():
    law = JointPD(stiffness=np.array([700.0, 600.0]), damping=np.array([10.0, 1.0]))
    still, rates = np.zeros(2), np.array([0.0, 2.0])
    told = at(still, 0.0, rates)
    assert law(told, Motion(np.array([0.1, 0.0]), still, still)).torque == pytest.approx([70.0, -2.0])
    assert law(told, Motion(still, rates, still)).torque == pytest.approx([0.0, 0.0])


def test_a_faded_law_starts_at_rest_and_ends_as_itself():
    law = faded(ForceControl(gain=0.01, desired_force=1.0))
    law.reset(at(0.5))
    targets = [law(at(0.5, 3.0)) for _ in range(4000)]
    assert targets[0] == 0.5
    assert targets[-1] == pytest.approx(0.52, abs=1e-9)


def faded(law):
    return FadeIn(law=law, desired_force=1.0, smoothing_rate=5, smoothing_power=1, dt=DT)


def test_an_integrator_does_not_wind_up_while_it_fades_in():
    forces = hold(faded(IntegralForceControl(rate=0.5, desired_force=DESIRED, dt=DT)), 3.0, start=0.55)
    assert forces.max() < 1.001 * DESIRED
    assert forces[-1] == pytest.approx(DESIRED, rel=1e-3)


def test_a_speed_limit_acts_where_the_impedance_integrates():
    law = PassiveImpedance(mass=1.0, damping=0.0, desired_force=0.0, dt=0.01, speed_limit=0.1)
    law.reset(at(0.0))
    outward = [law(at(0.0, 5.0)) for _ in range(100)]
    assert np.diff(outward).max() == pytest.approx(0.001)
    back = [law(at(0.0, -5.0)) for _ in range(5)]
    assert back[-1] < back[0]  # no speed beyond the limit that it would have to lose first


def test_known_movement_with_an_impedance_lead_holds_the_force_exactly():
    """On an arm of its own impedance the reference of Eq. (2.31) leaves no steady-state error, Eq. (2.30)."""
    mass, damping, stiffness = 0.5, 4.0, 10.0
    time = iter(np.arange(0, 100) * 10 * DT)
    movement = KnownMovement(
        movement=lambda: (lambda t: (REST + 0.02 * t, 0.02))(next(time)), stiffness=STIFFNESS, dt=DT
    )
    movement.reset()
    movement(0.5, 1.0)
    lead = (mass * movement.acceleration + damping * movement.velocity) / stiffness
    reference = movement.position + lead - DESIRED / STIFFNESS
    # Eq. (2.30) with the estimates true.
    error = (
        STIFFNESS
        / (stiffness + STIFFNESS)
        * (
            -stiffness / STIFFNESS * DESIRED
            + mass * movement.acceleration
            + damping * movement.velocity
            + stiffness * movement.position
            - stiffness * reference
        )
    )
    assert error == pytest.approx(0, abs=1e-12)


def test_known_movement_has_the_acceleration_of_the_movement_and_none_at_the_start():
    """Of 3 - 2 t + 0.5 t^2 the velocity differs by one step times its acceleration, 1."""
    instants = iter(np.arange(1, 10) * DT)
    movement = KnownMovement(
        movement=lambda: (lambda t: (3 - 2 * t + 0.5 * t**2, t - 2))(next(instants)), stiffness=STIFFNESS, dt=DT
    )
    movement.reset()
    assert (movement.position, movement.velocity) == (3 - 2 * DT + 0.5 * DT**2, DT - 2)
    assert movement.acceleration == 0.0
    for _ in range(3):
        movement(0.5, 1.0)
        assert movement.acceleration == pytest.approx(1.0)
