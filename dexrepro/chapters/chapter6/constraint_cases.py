"""The four constraint cases: does the Lyapunov function fall, with printed and with corrected terms (Sect. 6.3.2)?"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from dexrepro.experiment import Config, Figure, Metrics, Recording
from dexrepro.primitives.barrier import (
    Constraint,
    Gains,
    case_two_value,
    closed_loop_rates,
    decay_in_error_coordinates,
    lyapunov_rate,
    printed_case_two_pull,
)

FIGURES = {
    "6.A": Figure(
        "V^c relative to its start, and the scaled error, of the error dynamics under the consistent law for the four "
        "cases of Conditions 6.1 and 6.2, and under (6.17) as printed. (b) has a linear axis: outside of a bound V "
        "falls slowly, because the pull away from it fades. Ours; the book has no such figure.",
        "The Lyapunov function falls in all four cases, outside by a few per cent; with the printed (6.17) it rises "
        "and the error hits its bound after 0.33 s.",
    ),
}
TABLES = {"T6.2": "alpha_2 and k_n of the four cases, and the worst dV^c/dt over random states"}
RATE = 200.0
SYMBOLS = {  # constraint, W in alpha_2 = (xdot^c - f1)/g1 - W/(d_z g1), B in k_n = k_2/d_z + k_z g1^2 B/(4 d_z^2)
    "asymmetric_inside": ("H_l < z1 < H_u", "-z1", "rho/(H_s^2 - z1^2)"),
    "symmetric_inside": ("|z1| < H", "-z1", "rho/(H^2 - z1^2)"),
    "symmetric_outside": ("|z1| > H", "z1/|z1|^2", "H^2/(|z1|^2 - H^2)"),
    "asymmetric_outside": ("z1 > H_u or z1 < H_l", "1/z1", "H_s^2/(z1^2 - H_s^2)"),
    "asymmetric_outside_printed": ("z1 > H_u or z1 < H_l", "(K_2 + K_1 z1^4)/(K_2 - K_1 z1^3)", "K_1 + K_2"),
}


def simulate(config: Config, rng: Any) -> Recording:
    constraint = _constraint(config)
    frames = {"states": _random_states(constraint, config, rng("states"))}
    z1, z2 = np.array(config.start, float) + config.perturbation, np.zeros(len(config.start))
    z2[0] = config.start_rate
    if config.printed:
        first, second = _printed_flow(z1, z2, constraint, config)
        with np.errstate(invalid="ignore", divide="ignore"):
            value = constraint.value(first) + 0.5 * (second**2).sum(axis=1)
    else:
        steps = round(config.duration / config.step)
        first, second, value = decay_in_error_coordinates(z1, z2, constraint, _gains(config), 1.0, config.step, steps)
    time = config.step * np.arange(len(first))
    series = {"time": time, "error": first, "rate": second, "lyapunov": value}
    return Recording(series=series, frames=frames, steps=len(time), simulated=float(time[-1]))


def _gains(config: Config) -> Gains:
    return Gains(config.kz, config.dz, config.k2)


def _constraint(config: Config) -> Constraint:
    return Constraint(config.inside, config.upper, config.lower)


def _random_states(constraint: Constraint, config: Config, rng: np.random.Generator) -> pd.DataFrame:
    """Allowed errors, velocity errors and dV^c/dt by differences, for both couplings g1."""
    dimensions = 1 if config.lower is not None else 2
    z1 = rng.uniform(-1, 1, (40 * config.states, dimensions)) * (80.0 if config.inside else 300.0)
    z1 = z1[constraint.satisfied(z1)][: config.states]
    z2 = rng.normal(0, 100, z1.shape)
    z2[::4] *= 1e-3  # velocity errors near zero, where the barrier's pull decides
    frame = {f"z1_{i}": column for i, column in enumerate(z1.T)}
    for coupling in config.couplings:
        pull = printed_case_two_pull(z1, config.lower, config.upper) if config.printed else None
        rates = closed_loop_rates(z1, z2, constraint, _gains(config), coupling, pull)
        frame[f"rate_{coupling:.2g}"] = lyapunov_rate(z1, z2, *rates, constraint)
        frame[f"squares_{coupling:.2g}"] = _squares(z1, z2, constraint, _gains(config), coupling)
    return pd.DataFrame(frame)


def _squares(z1: Any, z2: Any, constraint: Constraint, gains: Gains, coupling: float) -> NDArray[Any]:
    """dV^c/dt as (6.21) and its counterparts for the other cases have it."""
    square = -constraint.pull(z1) - coupling * z2 / 2
    barrier = gains.position / gains.velocity * constraint.share(z1) * square**2
    return -(barrier.sum(axis=1) + gains.decay * (z2**2).sum(axis=1))


def _printed_flow(z1: Any, z2: Any, constraint: Constraint, config: Config) -> tuple[Any, Any]:
    """Explicit steps under (6.17) as printed, up to the instant the bound is hit."""
    first, second = [z1], [z2]
    for _ in range(round(config.duration / config.step)):
        pull = printed_case_two_pull(first[-1], config.lower, config.upper)
        rate1, rate2 = closed_loop_rates(first[-1], second[-1], constraint, _gains(config), 1.0, pull)
        first.append(first[-1] + config.step * rate1)
        second.append(second[-1] + config.step * rate2)
        if not constraint.satisfied(first[-1]):
            break
    return np.array(first), np.array(second)


def measure(recording: Recording, config: Config) -> Metrics:
    states, held = recording.frames["states"], _constraint(config).satisfied(recording["error"])
    value = recording["lyapunov"]
    rates = states.filter(like="rate_").to_numpy()
    scale = 1 + np.abs(states.filter(like="squares_").to_numpy())
    metrics: Metrics = {
        "worst_rate": float((rates / scale).max()),
        "rising_states": int((rates > 1e-6 * scale).sum()),
        "v_rises": int((np.diff(value) > 1e-12 * value[:-1]).sum()) if held.all() else None,
        "end_error": float(np.linalg.norm(recording["error"][-1])),
        "hit_time": None if held.all() else float(recording.time[held.argmin()]),
    }
    if config.inside and config.lower is None:
        metrics |= {f"shrinking_{name}": _shrinking(config, name == "corrected") for name in ("printed", "corrected")}
    if not config.inside and config.lower is None:
        # z1^2 = z1(0)^2 + 2 (k_z / d_z) t for z2 = 0
        grown = np.sqrt(np.sum(np.square(config.start)) + 2 * config.kz / config.dz * recording.time[-1])
        metrics["growth_gap"] = float(metrics["end_error"] / grown - 1)
    if config.printed:
        metrics["same_sign_undefined"] = float(
            np.isnan(case_two_value(np.array(config.probes), *config.same_sign)).mean()
        )
    return metrics


def _shrinking(config: Config, with_rate: bool) -> float:
    """Largest |e| - h [length] while the margin shrinks linearly, with and without the term -(e hdot/h)/g1."""
    start, end, duration = config.shrink
    step, e, worst = 1e-5, 0.8 * start, -np.inf
    for k in range(round(duration / step)):
        h = start + (end - start) * k * step / duration
        worst = max(worst, e - h)
        e += step * (-config.kz / config.dz * e + (with_rate * e * (end - start) / duration / h))
    return float(max(worst, e - end))


def tabulate(
    recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics], config: Config
) -> dict[str, pd.DataFrame]:
    rows = []
    for case, (constraint, pull, share) in SYMBOLS.items():
        if case in metrics:
            states = recordings[case].frames["states"]
            worst = {f"worst dV/dt, g1 = {g:.2g} [1/s]": states[f"rate_{g:.2g}"].max() for g in config.couplings}
            rows.append({"case": case, "constraint": constraint, "W": pull, "B": share, **worst})
    return {"T6.2": pd.DataFrame(rows)}


def draw(recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics], config: Config) -> dict[str, Any]:
    from dexrepro.report import style

    figure, (inner, outer, right) = style.subplots(1, 3, height=2.7, width_ratios=(1, 1, 1.1))
    lines = ("extra1", "book", "rival", "extra2", "printed")
    fallen = []
    for (case, recording), name in zip(recordings.items(), lines):
        bound = _constraint(config.cases[case])
        time, error = recording.time, np.linalg.norm(recording["error"], axis=1)
        value = recording["lyapunov"] / recording["lyapunov"][0]
        axes = inner if bound.inside else outer
        axes.plot(time, value, label=case.replace("_", " "), **style.LINES[name])
        if not (bound.inside or config.cases[case].printed):
            fallen.append(100 * (1 - value[-1]))
        edges = [bound.upper if bound.lower is None or z > 0 else -bound.lower for z in recording["error"][:, 0]]
        right.plot(time, error / np.array(edges), **style.LINES[name])
    right.axhline(1, **style.LINES["reference"])
    right.annotate("bound", (0.99, 0.98), xycoords=("axes fraction", "data"), fontsize=7, ha="right", va="top")
    inner.set(ylabel="$V^c(t)/V^c(0)$ [-]", yscale="log", ylim=(1e-6, 3), xlim=(-0.05, 1))
    outer.set(ylabel="$V^c(t)/V^c(0)$ [-]", ylim=(0.94, 1.03))
    right.set(ylabel="$|z_1|/H$ [-]", ylim=(0, None))
    for axes in (inner, outer, right):
        axes.set_xlabel("Time [s]")
    parts = [axes.get_legend_handles_labels() for axes in (inner, outer)]
    figure.legend(*(first + second for first, second in zip(*parts)), loc="outside lower center", ncols=3)
    style.panel(inner, "a", "V, inside")
    style.panel(outer, "b", "V, outside")
    style.panel(right, "c", "scaled error and bound")
    hit = metrics.get("asymmetric_outside_printed", {}).get("hit_time")
    slow = f", outside by {min(fallen):.1f} to {max(fallen):.1f} % in {config.duration:g} s" if fallen else ""
    late = f"; with (6.17) as printed it rises and the bound is hit after {hit:.2f} s" if hit else ""
    style.title(figure, f"The corrected terms lower V in all four cases{slow}{late}")
    return {"6.A": figure}
