"""A two-link arm in closed form, integrated by Runge-Kutta steps: the known answer for control laws."""

import numpy as np


class PlanarPlant:
    """Uniform links in a vertical plane, angles from the horizontal; gravity acts along -y."""

    def __init__(self, mass=10.0, length=1.0, inertia=0.83, g=9.8):
        self.mass, self.length, self.inertia, self.g = mass, length, inertia, g

    def position(self, q):
        a, b = q[0], q[0] + q[1]
        return self.length * np.array([np.cos(a) + np.cos(b), np.sin(a) + np.sin(b)])

    def jacobian(self, q):
        a, b = q[0], q[0] + q[1]
        sine, cosine = self.length * np.sin(b), self.length * np.cos(b)
        return np.array([[-self.length * np.sin(a) - sine, -sine], [self.length * np.cos(a) + cosine, cosine]])

    def inverse(self, x):
        """Joint angles with a positive elbow."""
        elbow = np.arccos((x @ x - 2 * self.length**2) / (2 * self.length**2))
        return np.array([np.arctan2(x[1], x[0]) - elbow / 2, elbow])

    def dynamics(self, q, dq):
        """M, C, G."""
        m, length, half = self.mass, self.length, 0.5 * self.length
        coupling = m * length * half * np.cos(q[1])
        m22 = m * half**2 + self.inertia
        m11 = 2 * m22 + m * length**2 + 2 * coupling
        h = -m * length * half * np.sin(q[1])
        g2 = m * half * self.g * np.cos(q[0] + q[1])
        g1 = 1.5 * m * length * self.g * np.cos(q[0]) + g2
        coriolis = np.array([[h * dq[1], h * (dq[0] + dq[1])], [-h * dq[0], 0.0]])
        return np.array([[m11, m22 + coupling], [m22 + coupling, m22]]), coriolis, np.array([g1, g2])

    def step(self, q, dq, torque, damping, dt, force=(0.0, 0.0)):
        """One step of duration ``dt`` with held torque; joint damping and a force at the tip act continuously."""

        def slope(state):
            q, dq = state[:2], state[2:]
            mass, coriolis, gravity = self.dynamics(q, dq)
            rest = torque - damping * dq + self.jacobian(q).T @ np.asarray(force) - coriolis @ dq - gravity
            return np.concatenate([dq, np.linalg.solve(mass, rest)])

        state = np.concatenate([q, dq])
        a = slope(state)
        b = slope(state + 0.5 * dt * a)
        c = slope(state + 0.5 * dt * b)
        d = slope(state + dt * c)
        state = state + dt / 6 * (a + 2 * b + 2 * c + d)
        return state[:2], state[2:]
