import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.linalg import solve_continuous_are, solve_continuous_lyapunov

from dexrepro.control.interaction_optimum import (
    InteractionCost,
    InteractionModel,
    NoStabilisingSolution,
    closed_form_gain,
    optimal_gain,
    steady_cost,
    steady_fraction,
)
from dexrepro.control.policy_iteration import NotExcited, Windows, policy_iteration

COST = InteractionCost(tracking=70.0, effort=5.0, output=0.05)
OBJECT = InteractionModel(stiffness=10.0, damping=0.01, exosystem=-1.0)
INITIAL = np.array([[-30.01, 1.47]])


def contact_data(model, dt=1e-3, duration=4.0, depth=0.03):
    """Indentation [m], the auxiliary s, and the force of the object for an arbitrary smooth motion against it."""
    time = np.arange(round(duration / dt) + 1) * dt
    frequencies = np.array([1.3, 2.9, 4.7, 7.1])[:, None]
    motion = depth * (1.0 + np.sum(np.sin(frequencies * time + frequencies) / 4.0, axis=0))
    speed = depth * np.sum(frequencies * np.cos(frequencies * time + frequencies) / 4.0, axis=0)
    states = np.column_stack([motion, 1.5 * np.exp(model.exosystem * time)])
    return states, -(model.damping * speed + model.stiffness * motion)[:, None]


def test_the_printed_object_gives_the_known_optimum():
    assert optimal_gain(OBJECT, COST) == pytest.approx([-0.67707825, 0.06549966], rel=1e-7)


@given(st.floats(1.0, 1000.0), st.floats(0.01, 20.0), st.floats(-3.0, -0.01))
@settings(max_examples=25, deadline=None)
def test_closed_form_and_riccati_equation_agree(stiffness, damping, exosystem):
    model = InteractionModel(stiffness, damping, exosystem)
    assert optimal_gain(model, COST) == pytest.approx(closed_form_gain(model, COST), rel=1e-6)


def test_a_growing_reference_has_a_gain_but_no_stabilising_solution():
    model = InteractionModel(stiffness=7.0, damping=0.4, exosystem=0.001)
    cost = InteractionCost(tracking=370.0, effort=0.003, output=1.0)
    with pytest.raises(NoStabilisingSolution):
        optimal_gain(model, cost)
    decaying = InteractionModel(stiffness=7.0, damping=0.4, exosystem=-0.001)
    assert closed_form_gain(model, cost) == pytest.approx(optimal_gain(decaying, cost), rel=1e-4)


@given(st.floats(2.0, 500.0), st.floats(0.05, 10.0))
@settings(max_examples=15, deadline=None)
def test_the_steady_state_under_the_optimal_gain_minimises_the_cost_rate(stiffness, damping):
    slow = InteractionModel(stiffness, damping, exosystem=-1e-7)
    fraction = steady_fraction(optimal_gain(slow, COST), stiffness, COST.output)
    assert fraction == pytest.approx(1.0 / (1.0 + COST.effort / COST.tracking * stiffness**2), rel=1e-4)
    for other in (0.9 * fraction, 1.1 * fraction):
        assert steady_cost(fraction, stiffness, COST) < steady_cost(other, stiffness, COST)


@given(st.floats(5.0, 1000.0), st.floats(0.01, 10.0))
@settings(max_examples=15, deadline=None)
def test_the_gain_learned_from_contact_data_is_optimal(stiffness, damping):
    model = InteractionModel(stiffness, damping, exosystem=-1.0)
    states, forces = contact_data(model)
    windows = Windows.of(states, forces, dt=1e-3, length=250)
    initial = np.array([[-3.0 * stiffness, 1.0]])
    learned = policy_iteration(windows, COST.state_weight, COST.effort_weight, initial, tolerance=1e-9)
    assert learned.converged
    assert learned.gain[0] == pytest.approx(optimal_gain(model, COST), rel=1e-3)


def test_the_iterates_are_those_of_policy_iteration_with_the_model_known():
    windows = Windows.of(*contact_data(OBJECT), dt=1e-3, length=250)
    learned = policy_iteration(windows, COST.state_weight, COST.effort_weight, INITIAL, tolerance=1e-3)
    known = [-30.01, -11.430, -3.3747, -0.9491, -0.68046, -0.677079, -0.67707825]
    assert learned.gains[:, 0, 0] == pytest.approx(known, rel=2e-4)
    assert learned.gain[0] == pytest.approx(optimal_gain(OBJECT, COST), rel=1e-6)
    eigenvalues = np.linalg.eigvalsh(learned.values[:-1] - learned.values[1:])
    assert np.all(eigenvalues > -1e-6)


def test_a_plant_with_two_states_and_two_inputs_is_learned():
    system = np.array([[-1.0, 2.0, 0.0], [-0.5, -2.0, 0.3], [0.0, 0.0, -0.8]])
    control = np.array([[1.0, 0.0], [0.2, 1.0], [0.0, 0.0]])
    weight, effort = np.diag([3.0, 1.0, 0.5]), np.diag([1.0, 0.5])

    def inputs(time):
        return np.array([np.sin(3 * time) + np.cos(7 * time), np.sin(5 * time) - np.cos(1.7 * time)])

    time = np.arange(6001) * 1e-3
    solution = solve_ivp(
        lambda t, z: system @ z + control @ inputs(t), (0, 6), [1.0, -1.0, 1.0], t_eval=time, rtol=1e-10, atol=1e-12
    )
    windows = Windows.of(solution.y.T, inputs(time).T, dt=1e-3, length=200)
    learned = policy_iteration(windows, weight, effort, np.zeros((2, 3)), tolerance=1e-9)
    value = solve_continuous_are(system, control, weight, effort)
    assert learned.gain == pytest.approx(np.linalg.solve(effort, control.T @ value), abs=1e-4)
    assert learned.values[-1] == pytest.approx(value, abs=1e-4)
    closed = system - control @ learned.gains[1]
    second = solve_continuous_lyapunov(closed.T, -(weight + learned.gains[1].T @ effort @ learned.gains[1]))
    assert learned.values[1] == pytest.approx(second, abs=1e-4), "the value of the gain before it"
    steps = np.linalg.norm(np.diff(learned.values, axis=0), axis=(1, 2))
    assert learned.changes[1:] == pytest.approx(steps)
    assert len(windows.change) == 30, "whole windows of 0.2 s in 6 s"


def test_data_without_excitation_are_refused():
    states, forces = contact_data(OBJECT, depth=0.0)
    windows = Windows.of(states, forces, dt=1e-3, length=250)
    assert windows.rank < windows.required_rank == 5
    with pytest.raises(NotExcited):
        policy_iteration(windows, COST.state_weight, COST.effort_weight, INITIAL, tolerance=1e-3)


def test_a_reference_that_does_not_obey_its_generator_spoils_the_gain():
    states, forces = contact_data(OBJECT)
    states[:, 1] = 1.5 + np.sin(np.arange(len(states)) * 2e-4)
    windows = Windows.of(states, forces, dt=1e-3, length=250)
    learned = policy_iteration(windows, COST.state_weight, COST.effort_weight, INITIAL, tolerance=1e-3)
    assert abs(learned.gain[0, 1] / optimal_gain(OBJECT, COST)[1] - 1.0) > 0.1
