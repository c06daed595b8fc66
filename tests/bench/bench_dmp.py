"""Movement primitives against two public packages on one task: a 2-D path of 1000 steps, 20 kernels.

Run by ``make bench`` with the extra ``[bench]``: movement_primitives, with its compiled step, and pydmps. Every time is
the best of several, all packages in turn in the same run. Targets: fit 8 times as fast as the faster peer, rollout 50
times as fast as the fastest stepping with the features computed anew and 300 times with them kept, error no larger
than the smaller one. A second table has the incremental pseudo-inverse against solving anew.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
import pytest

from dexrepro.primitives import DMP, Demonstration, GaussianKernels, GrowingRegression, SpringDamper, least_squares

STEPS, KERNELS, GOALS = 1000, 20, 1000
TARGETS = {"fit": 8.0, "rollout": 50.0, "rollout, responses kept": 300.0}


def best(function: Callable[[], object], repeats: int) -> float:
    """Shortest wall time of ``repeats`` calls after a first one [s]."""
    function()
    shortest = np.inf
    for _ in range(repeats):
        begin = time.perf_counter()
        function()
        shortest = min(shortest, time.perf_counter() - begin)
    return shortest


def path() -> tuple[np.ndarray, np.ndarray]:
    """A loop drawn from rest to rest with a minimum-jerk speed profile: time [s] and position."""
    u = np.linspace(0, 1, STEPS + 1)
    blend = u**3 * (10 - 15 * u + 6 * u**2)
    return u, np.stack([4 * blend + np.sin(2 * np.pi * blend), blend + 2 * np.sin(np.pi * blend) ** 2], axis=1)


def ours(time: np.ndarray, position: np.ndarray) -> dict[str, float]:
    kernels, system = GaussianKernels.spaced(KERNELS, 4.0), SpringDamper.critical(400.0)

    def fit() -> DMP:
        return DMP.fit(Demonstration.of(time, position), kernels, system, 4.0)

    dmp = fit()
    kept = dmp.propagator(1 / STEPS)
    goals = dmp.goal + np.random.default_rng(0).normal(size=(GOALS, 2))
    return {
        "fit": best(fit, 100),
        "rollout": best(lambda: dmp.rollout(1 / STEPS), 300),
        "rollout, responses kept": best(lambda: kept.position(dmp.weights, dmp.start, dmp.goal), 1000),
        "1000 goals": best(lambda: kept.position(dmp.weights, dmp.start, goals), 5),
        "error": float(np.sqrt(np.mean((dmp.rollout(1 / STEPS).position - position) ** 2))),
    }


def movement_primitives(time: np.ndarray, position: np.ndarray) -> dict[str, float]:
    from movement_primitives.dmp import DMP as Peer

    def fit() -> Peer:
        dmp = Peer(n_dims=2, execution_time=1.0, dt=1 / STEPS, n_weights_per_dim=KERNELS, int_dt=1 / STEPS)
        dmp.imitate(time, position)
        return dmp

    dmp = fit()
    steppings = {name: best(lambda name=name: dmp.open_loop(step_function=name), 5)
                 for name in ("euler-cython", "rk4-cython", "euler", "rk4")}  # fmt: skip
    print("movement_primitives, rollout by step function:",
          ", ".join(f"{name} {1e3 * t:.2f} ms" for name, t in steppings.items()))  # fmt: skip
    return {
        "fit": best(fit, 10),
        "rollout": min(steppings.values()),
        "error": min(
            float(np.sqrt(np.mean((dmp.open_loop(step_function=name)[1][: STEPS + 1] - position) ** 2)))
            for name in ("euler-cython", "rk4-cython")
        ),
    }


def pydmps(_: np.ndarray, position: np.ndarray) -> dict[str, float]:
    from pydmps.dmp_discrete import DMPs_discrete as Peer

    def fit() -> Peer:
        dmp = Peer(n_dmps=2, n_bfs=KERNELS, dt=1 / STEPS)
        dmp.imitate_path(y_des=position.T)
        return dmp

    dmp = fit()
    rolled = dmp.rollout()[0]
    return {
        "fit": best(fit, 5),
        "rollout": best(dmp.rollout, 5),
        "error": float(np.sqrt(np.mean((rolled - position[1 : len(rolled) + 1]) ** 2))),
    }


def test_movement_primitives_are_faster_than_their_peers_and_no_less_exact():
    pytest.importorskip("movement_primitives", reason="pip install 'dexrepro[bench]'")
    pytest.importorskip("pydmps", reason="pip install 'dexrepro[bench]'")
    time, position = path()
    mine = ours(time, position)
    peers = {package.__name__: package(time, position) for package in (movement_primitives, pydmps)}
    print(f"\n{'':28}{'dexrepro':>14}" + "".join(f"{name:>24}" for name in peers))
    for row in ("fit", "rollout", "rollout, responses kept", "1000 goals"):
        cells = [f"{1e3 * mine[row]:11.3f} ms"]
        for peer in peers.values():
            seconds = peer["fit"] if row == "fit" else peer["rollout"] * (GOALS if row == "1000 goals" else 1)
            cells.append(f"{1e3 * seconds:11.2f} ms ({seconds / mine[row]:6.0f}x)")
        print(f"{row:28}" + "".join(f"{cell:>{24 if i else 14}}" for i, cell in enumerate(cells)))
    print(f"{'error (RMS)':28}{mine['error']:14.2e}" + "".join(f"{peer['error']:24.2e}" for peer in peers.values()))
    for row, target in TARGETS.items():
        assert min(peer["fit" if row == "fit" else "rollout"] for peer in peers.values()) > target * mine[row], row
    assert mine["error"] <= min(peer["error"] for peer in peers.values())


def test_incremental_update_is_faster_than_solving_anew():
    rng = np.random.default_rng(0)
    target = rng.normal(size=(1501, 2))
    print(f"\n{'features':>10}{'update':>14}{'anew':>14}")
    for count in (50, 100, 200, 400):
        matrix, block = rng.normal(size=(1501, count)), rng.normal(size=(1501, 5))
        regression = GrowingRegression(matrix)
        inverse = regression.inverse

        def update(regression=regression, matrix=matrix, inverse=inverse, block=block):
            regression.matrix, regression.inverse = matrix, inverse
            regression.append(block)
            return regression.weights(target)

        def anew(matrix=matrix, block=block):
            return least_squares(np.concatenate([matrix, block], axis=1), target)

        seconds = best(update, 10), best(anew, 10)
        print(f"{count:10}{1e3 * seconds[0]:11.2f} ms{1e3 * seconds[1]:11.2f} ms")
        assert seconds[0] < seconds[1]
