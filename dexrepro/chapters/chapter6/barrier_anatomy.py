"""What the barrier contributes: its share of the gain, and sweeps of k_2, margin and time step (ours)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from dexrepro.chapters.chapter6 import learning, plane
from dexrepro.experiment import Config, Figure, Metrics, Recording
from dexrepro.primitives.barrier import Constraint, gain
from dexrepro.primitives.constrained import Path, rollout

FIGURES = {
    "6.B": Figure(
        "(a) Share of the barrier in the gain k_n over the distance to the reference. (b) Largest distance on the map "
        "over k_2, tracking gains alone. (c) Largest distance over the margin; a cross marks a run that stepped over "
        "the barrier. (d) The same over the time step at the printed margin. Ours.",
        "With the printed weight of 1 the barrier acts only within a millionth of its bound.",
    ),
}
RATE = 0.0


def simulate(config: Config, rng: Any) -> Recording:
    lesson = plane.teach(config, rng("demonstrations"))[0]
    primitive, duration = lesson.second, float(lesson.durations[1])

    def largest(step: float, decay: Any, margin: Any, weight: str) -> tuple[NDArray[Any], NDArray[Any]]:
        """Largest distance, and whether the run stayed defined, for arrays of gains or margins (runs, 1)."""
        path = _run(config, primitive, duration, step, np.asarray(decay, float), np.asarray(margin, float), weight)
        return np.nanmax(path.distance, axis=0), np.asarray(path.defined.all(axis=0))

    column = lambda values: np.array(values, float)[:, None]  # noqa: E731
    s, c = config.sweep, config.cdmp
    frames = {}
    tracked, _ = largest(config.step, column(s.k2), np.full((len(s.k2), 1), c.margin), "off")
    frames["k2"] = pd.DataFrame({"k2": s.k2, "e_max": tracked})
    far, defined = largest(config.step, np.full((len(s.margin), 1), c.k2), column(s.margin), c.weight)
    frames["margin"] = pd.DataFrame({"margin": s.margin, "e_max": far, "defined": defined})
    steps = [largest(step, [[c.k2]], [[c.margin]], c.weight) for step in s.step]
    frames["step"] = pd.DataFrame(
        {"step": s.step, "e_max": [e[0] for e, _ in steps], "defined": [d[0] for _, d in steps]}
    )
    frames["share"] = _shares(config, duration)
    return Recording(frames=frames, steps=2 * round(duration / config.step))


def _run(
    config: Config, primitive: Any, duration: float, step: float, decay: NDArray[Any], margin: NDArray[Any], weight: str
) -> Path:
    (movement,) = learning.nominal([primitive], np.array([duration]), round(duration / step))
    skill = learning.skill([primitive], [movement])
    reference = learning.stack([plane.spline_reference(config, movement)[0]])
    constraint = learning.tube(Config({**config.cdmp, "weight": weight}), margin)
    gains = replace(learning.gains(config.cdmp), decay=decay)
    runs = len(margin)
    start = np.repeat(reference.position[0], runs, axis=0)
    velocity = np.broadcast_to(primitive.time_constant * primitive.velocity, start.shape)
    return rollout(
        skill,
        reference,
        constraint,
        gains,
        learning.law(config.cdmp),
        duration / len(movement.time[1:]),
        start,
        velocity,
    )


def _shares(config: Config, duration: float) -> pd.DataFrame:
    """Share of the barrier in k_n over 1 - (e/h)^2, for both weights."""
    tau = duration if config.dmp.tau is None else config.dmp.tau
    gap = np.logspace(-9, 0, 181)
    bound = config.cdmp.kz * config.cdmp.margin
    z1 = bound * np.sqrt(1 - gap)[:, None]
    frame = {"gap": gap}
    for name, weight in (("one", 1.0), ("h2", bound**2)):
        gains = learning.gains(config.cdmp)
        total = gain(z1, Constraint(True, bound, weight=weight), gains, 1 / tau)[:, 0]
        frame[name] = 1 - config.cdmp.k2 / gains.velocity / total
    return pd.DataFrame(frame)


def measure(recording: Recording, config: Config) -> Metrics:
    k2, margin, step, share = (recording.frames[name] for name in ("k2", "margin", "step", "share"))
    slope = np.polyfit(np.log(k2["k2"]), np.log(k2.e_max), 1)[0]
    crossed = margin.margin[~margin.defined.astype(bool)]
    metrics: Metrics = {
        "k2_slope": float(slope),
        "e_max_k2_low": float(k2.e_max.iloc[0]),
        "e_max_k2_high": float(k2.e_max.iloc[-1]),
        "widest_crossed_margin": float(crossed.max()) if len(crossed) else 0.0,
        "step_spread": float(np.ptp(step.e_max) / step.e_max.mean()),
    }
    for name in ("one", "h2"):
        metrics[f"share_centre_{name}"] = float(share[name].iloc[-1])
        # Where barrier and k_2 contribute alike: share 1/2.
        metrics[f"half_gap_{name}"] = float(np.exp(np.interp(-0.5, -share[name], np.log(share.gap))))
    return metrics


def draw(recordings: Mapping[str, Recording], metrics: Mapping[str, Metrics], config: Config) -> dict[str, Any]:
    if not {"printed", "feedforward", "tau1_feedforward"} <= set(recordings):
        return {}
    from dexrepro.report import style

    figure, ((a, b), (c, d)) = style.subplots(2, 2, height=4.2)
    for case, tau, line in (("feedforward", "duration", "book"), ("tau1_feedforward", "1 s", "extra1")):
        share = recordings[case].frames["share"]
        a.plot(share.gap, share.one, label=rf"weight 1, $\tau$ = {tau}", **style.LINES[line])
        a.plot(
            share.gap, share.h2, color=style.LINES[line]["color"], linestyle=":", label=rf"weight $H^2$, $\tau$ = {tau}"
        )
    a.set(xscale="log", xlabel="$1-(\\|e\\|/h)^2$ [-]", ylabel="Barrier's share of $k_n$ [-]")
    a.invert_xaxis()
    a.set(ylim=(0, 1.75), yticks=(0, 0.5, 1))
    a.legend(fontsize=6.5, ncols=2, loc="upper center", columnspacing=1)
    lines = {
        "consistent": "extra1",
        "printed": "printed",
        "feedforward": "book",
        "tau1_printed": "extra2",
        "tau1_feedforward": "extra3",
    }
    for case, line in lines.items():
        if case not in recordings:
            continue
        frames = recordings[case].frames
        label = case.replace("tau1_", r"$\tau$ = 1 s, ")
        if case != "consistent":
            b.plot(frames["k2"]["k2"], frames["k2"].e_max, label=label, **style.LINES[line])
        for axes, name, x in ((c, "margin", "margin"), (d, "step", "step")):
            frame = frames[name]
            limit = frame.margin if name == "margin" else config.cases[case].cdmp.margin
            scale = 1e3 if name == "step" else 1
            axes.plot(scale * frame[x], frame.e_max / limit, label=label, **style.LINES[line])
            lost = frame[~frame.defined.astype(bool)]
            far = lost.e_max / (lost.margin if name == "margin" else limit)
            axes.plot(scale * lost[x], far, "x", color="black", markersize=4)
    b.set(xscale="log", yscale="log", xlabel="$k_2$ [1/s]", ylabel="Largest distance [cm]")
    c.set(xlabel="Margin h [cm]", ylabel="Largest distance / h [-]", ylim=(0, 1.2))
    d.set(xlabel="Time step [ms]", ylabel="Largest distance / h [-]", ylim=(0, 1.2), xscale="log")
    d.plot([], [], "x", color="black", markersize=4, label="stepped over")
    figure.legend(*d.get_legend_handles_labels(), loc="outside lower center", ncols=6, columnspacing=1.2)
    for letter, axes, text in zip(
        "abcd", (a, b, c, d), ("who brakes", "gain $k_2$, no barrier", "margin", "time step")
    ):
        style.panel(axes, letter, text)
    gap = metrics["feedforward"]["half_gap_one"]
    style.title(
        figure,
        rf"The printed barrier outweighs $k_2$ only where $1 - (e/h)^2 < 10^{{{np.log10(float(gap or np.nan)):.0f}}}$",
    )
    return {"6.B": figure}
