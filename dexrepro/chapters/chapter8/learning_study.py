"""What the data of one exploration say about the gain: its iterates, and how noise and wrong assumptions change it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from dexrepro.arrays import Array
from dexrepro.control.impedance_learning import LearnedGain, exploration_windows
from dexrepro.control.interaction_optimum import InteractionModel, optimal_gain
from dexrepro.control.policy_iteration import NotExcited, Windows, policy_iteration


def iterates(gain: LearnedGain, model: InteractionModel) -> pd.DataFrame:
    """One row an iteration of Algorithm 8.1: the gain evaluated, its value matrix, the change, the regression."""
    learned = gain.learned
    assert learned is not None
    best = optimal_gain(model, gain.cost)
    rows = len(learned.values)
    return pd.DataFrame(
        {
            "iteration": np.arange(rows),
            "gain_x": learned.gains[:rows, 0, 0],
            "gain_s": learned.gains[:rows, 0, 1],
            "next_x": learned.gains[1:, 0, 0],
            "next_s": learned.gains[1:, 0, 1],
            "p11": learned.values[:, 0, 0],
            "p12": learned.values[:, 0, 1],
            "p22": learned.values[:, 1, 1],
            "change": learned.changes,
            "condition": learned.conditions,
            "rank": gain.windows.rank,
            "optimal_x": best[0],
            "optimal_s": best[1],
        }
    )


ITERATES = {
    "gain_x": "K_x [N/m]",
    "gain_s": "K_s [{unit}]",
    "next_x": "next K_x [N/m]",
    "next_s": "next K_s [{unit}]",
    "p11": "P_11",
    "p12": "P_12",
    "p22": "P_22",
    "change": "change of P",
    "condition": "condition number",
    "optimal_x": "optimal K_x [N/m]",
    "optimal_s": "optimal K_s [{unit}]",
}
NOISE = {
    "quantity": "noise on",
    "noise": "standard deviation [N or m]",
    "mean_x": "mean K_x [N/m]",
    "mean_s": "mean K_s [{unit}]",
    "std_x": "deviation of K_x [N/m]",
    "std_s": "deviation of K_s [{unit}]",
}


def headed(frame: pd.DataFrame, unit: str) -> pd.DataFrame:
    """Iterates or noise study as a table; ``unit`` is that of K_s."""
    return frame.rename(columns={key: text.format(unit=unit) for key, text in (ITERATES | NOISE).items()})


def learn(gain: LearnedGain, windows: Windows) -> Array:
    """Gain [N/m, N] that Algorithm 8.1 finds from other data with the settings of ``gain``; nan where it fails."""
    try:
        learned = policy_iteration(
            windows, gain.cost.state_weight, gain.cost.effort_weight, gain.initial, gain.tolerance
        )
    except NotExcited:
        return np.full(2, np.nan)
    return learned.gain[0]


def noise_study(
    gain: LearnedGain,
    draws: int,
    force_noise: Sequence[float],
    position_noise: Sequence[float],
    rng: np.random.Generator,
) -> pd.DataFrame:
    """Mean and standard deviation of the learned gain when white noise [N, m] is added to the recorded exploration."""
    rows = []
    levels = [("force", level) for level in force_noise] + [("position", level) for level in position_noise]
    for quantity, level in levels:
        column = 2 if quantity == "force" else 0
        gains = []
        for _ in range(draws):
            samples = gain.samples
            samples[:, column] += level * rng.standard_normal(len(samples))
            gains.append(learn(gain, exploration_windows(samples, gain.dt, gain.window, gain.exosystem, gain.start)))
        mean, deviation = np.mean(gains, axis=0), np.std(gains, axis=0)
        rows.append((quantity, level, mean[0], mean[1], deviation[0], deviation[1]))
    return pd.DataFrame(rows, columns=["quantity", "noise", "mean_x", "mean_s", "std_x", "std_s"])


def assumptions(gain: LearnedGain, surface: float, offsets: Sequence[float]) -> pd.DataFrame:
    """Gain learned from the same exploration under other assumptions than the right ones."""

    def found(samples: Array, exosystem: float | None = gain.exosystem) -> Array:
        return learn(gain, exploration_windows(samples, gain.dt, gain.window, exosystem, gain.start))

    def shifted(offset: float) -> Array:
        return gain.samples + [offset, offset / gain.cost.output, 0.0]

    rows = {"as run": found(gain.samples)}
    rows["regressed on the desired path"] = found(gain.samples, exosystem=None)
    rows["absolute coordinates"] = found(shifted(surface))
    rows |= {f"surface {-1e3 * offset:+.0f} mm off": found(shifted(offset)) for offset in offsets}
    quarter = gain.samples[: len(gain.samples) // 4 + 1]
    windows = exploration_windows(quarter, gain.dt, gain.window // 4, gain.exosystem, gain.start)
    rows["a quarter of the data"] = learn(gain, windows)
    return pd.DataFrame(rows.values(), columns=["gain_x", "gain_s"]).assign(assumption=list(rows))
