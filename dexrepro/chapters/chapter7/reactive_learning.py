"""Reactions learned as an addition to the ordinary skill, one group of enhancement nodes after the other."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.chapters.chapter7 import skills
from dexrepro.experiment import Config, Figure, Metrics, Recording
from dexrepro.measures import rms_distance
from dexrepro.primitives.reactive import fit_reaction, ridge_weights

FIGURES = {
    "7.8": Figure(
        "Reactions to the low, close obstacle learned with 1, 2 and 5 groups of three enhancement nodes, seen from "
        "above; black dashed: ordinary skill; thin: demonstrations (simulated). Below: error against the mean "
        "demonstration while groups are added, median and range of ten draws of the random nodes; the old nodes keep "
        "their weights (blue, as in (7.17)) or are fitted again (orange, the other reading of (7.19)).",
        "With one, two and five groups the learned reactions approach the demonstrated ones.",
    ),
}
TABLES = {"T7.2": "Learning the reactions to the low, close obstacle"}
RATE = 50.0


def simulate(config: Config, rng: Any) -> Recording:
    ordinary, reactions = skills.demonstrate(config)
    learned = skills.Skills(config, ordinary, reactions)
    chosen = shown(config)
    targets = learned.reaction_targets[chosen]
    stages = {}
    rows = []
    for draw in range(config.draws):
        features = skills.enhancement(config, learned.primitive.kernels, draw)
        for groups in range(1, config.enhancement.groups + 1):
            part = features.first(groups * config.enhancement.nodes)
            forcing = fit(config, learned, part, targets)
            paths = learned.perform(forcing @ learned.reach.axes.T)
            rows.append(errors(learned, paths, forcing, targets, chosen) | {"draw": draw, "groups": groups})
            if draw == 0 and groups in config.shown_groups:
                stages[f"groups{groups}"] = np.moveaxis(paths, 1, 0).reshape(len(learned.primitive.time), -1)
    series = {"time": learned.primitive.time, "ordinary": learned.perform(), **stages}
    series["demonstrations"] = np.moveaxis(reactions[chosen], 2, 0).reshape(len(learned.primitive.time), -1)
    recording = Recording(series=series, frames={"learning": pd.DataFrame(rows)}, steps=len(rows))
    recording.frames["baselines"] = baselines(config, learned, reactions[chosen])
    return recording


def shown(config: Config) -> list[int]:
    """Indices of the conditions of Fig. 7.8: the low, close obstacle in three directions."""
    return [i for i, c in enumerate(skills.conditions(config)) if c.labels[:2] == ("close", "low")]


def fit(config: Config, learned: skills.Skills, features: Any, targets: np.ndarray) -> np.ndarray:
    """Reactive forcing terms (3, N, 3) for targets, every direction on its own."""
    phases, ridge = learned.primitive.phases, config.enhancement.ridge
    frozen = learned.weights if config.old_weights == "frozen" else None
    change = features.blocks(phases).change
    return np.array([change @ fit_reaction(features, phases, target, ridge, frozen) for target in targets])


def errors(
    learned: skills.Skills, paths: np.ndarray, forcing: np.ndarray, targets: np.ndarray, chosen: list[int]
) -> dict:
    return {
        "rmse": rms_distance(paths, learned.demonstrated[chosen]).mean(),
        "worst_rmse": rms_distance(paths, learned.demonstrated[chosen]).max(),
        "forcing_error": np.mean([np.linalg.norm(f - t) / np.linalg.norm(t) for f, t in zip(forcing, targets)]),
        "end_error": np.linalg.norm(paths[:, -1] - learned.goal, axis=-1).max(),
    }


def baselines(config: Config, learned: skills.Skills, demonstrations: np.ndarray) -> pd.DataFrame:
    """Errors [cm] without reaction, of a plain primitive fitted again, and with the printed sign in (7.23) alone."""
    primitive, mean = learned.primitive, learned.demonstrated[shown(config)]
    psi = primitive.kernels.features(primitive.phases)
    again = [
        psi @ ridge_weights(psi, target, primitive.ridge) for target in learned.target(demonstrations).mean(axis=1)
    ]
    smooth = skills.low_pass(mean - learned.perform(), config.dmp.cutoff, primitive.rate, axis=-2)
    velocity = primitive.duration * np.gradient(smooth, 1 / primitive.rate, axis=-2)
    printed = learned.reaction_targets[shown(config)] - 2 * primitive.system.damping * velocity
    forcing = fit(config, learned, learned.features, printed)
    paths = {
        "no reaction": np.broadcast_to(learned.perform(), mean.shape),
        "plain primitive fitted again": primitive.rollout(np.array(again), learned.start, learned.goal),
        "printed sign of D(v^N - v)": learned.perform(forcing @ learned.reach.axes.T),
    }
    spread = np.sqrt(((demonstrations - mean[:, None]) ** 2).sum(axis=-1).mean(axis=(1, 2)))
    rows = [{"what": name, "rmse": rms_distance(path, mean).mean()} for name, path in paths.items()]
    return pd.DataFrame([*rows, {"what": "spread of repetitions", "rmse": spread.min()}])


def measure(recording: Recording, config: Config) -> Metrics:
    learning, baseline = recording.frames["learning"], recording.frames["baselines"].set_index("what")["rmse"]
    median = learning.groupby("groups")[["rmse", "forcing_error", "end_error"]].median()
    curves = learning.pivot(index="draw", columns="groups", values="forcing_error").to_numpy()
    own = learning[learning.draw == 0].set_index("groups")
    return {
        **{f"rmse{g}": float(median.rmse[g]) for g in median.index},
        **{f"end_error{g}": float(median.end_error[g]) for g in median.index},
        **{f"forcing_error{g}": float(median.forcing_error[g]) for g in median.index},
        "shown_rmse": float(own.rmse[config.shown_groups[-1]]),
        "falling_draws": float((np.diff(curves, axis=1) < 0).all(axis=1).mean()),
        "spread": float(baseline["spread of repetitions"]),
        "no_reaction": float(baseline["no reaction"]),
        "plain_refit": float(baseline["plain primitive fitted again"]),
        "printed_difference": float(baseline["printed sign of D(v^N - v)"]),
        "ordinary_change": ordinary_change(recording, config),
        **normalisation(config),
    }


def normalisation(config: Config) -> Metrics:
    """Range of Gamma over the movement and the draws, and the share of draws in which tanh makes it change its sign."""
    primitive = skills.Primitive(config, config.dmp.kernels)
    gammas, crossings = [], []
    for draw in range(config.draws):
        features = skills.enhancement(config, primitive.kernels, draw).first(5 * config.enhancement.nodes)
        gammas.append(1 / features.blocks(primitive.phases).share)
        activations = primitive.kernels.activations(primitive.phases)
        odd = np.tanh(activations @ features.input_weights + features.biases).sum(axis=1)
        crossings.append((activations.sum(axis=1) + odd).min() < 0)
    return {
        "gamma_lowest": float(np.min(gammas)),
        "gamma_highest": float(np.max(gammas)),
        "tanh_crossings": float(np.mean(crossings)),
    }


def ordinary_change(recording: Recording, config: Config) -> float:
    """Largest difference [cm] of the ordinary movement before and after the reactions are learned, Delta f = 0."""
    ordinary, reactions = skills.demonstrate(config)
    learned = skills.Skills(config, ordinary, reactions)
    return float(np.abs(learned.perform(np.zeros((1, len(recording.time), 3)))[0] - recording["ordinary"]).max())


def draw(recordings: Mapping[str, Recording], metrics: Mapping[str, Any], config: Config) -> dict[str, Any]:
    if "frozen" not in recordings:
        return {}
    from dexrepro.chapters.chapter7 import pictures
    from dexrepro.report import style

    recording, case = recordings["frozen"], config.cases.frozen
    task, condition = skills.reach(case), skills.conditions(case)[shown(case)[0]]
    figure = style.plt.figure(figsize=(style.TWO_COLUMNS, 4.6))
    grid = figure.add_gridspec(2, 6, height_ratios=[1, 1.15])
    names = list(pictures.DIRECTIONS)
    groups = [g for g in case.shown_groups if f"groups{g}" in recording]
    panels = [figure.add_subplot(grid[0, 2 * k : 2 * k + 2]) for k in range(len(groups))]
    panels.append(figure.add_subplot(grid[1, :3]))
    for letter, number, panel in zip("abcd", [*groups, groups[-1]], panels):
        demonstrations = skills.by_path(recording["demonstrations"])
        for k, path in enumerate(demonstrations):
            line = pictures.DIRECTIONS[names[k * 3 // len(demonstrations)]]
            pictures.plan(panel, path, color=line["color"], linewidth=0.4, alpha=0.5)
        for name, path in zip(names, skills.by_path(recording[f"groups{number}"])):
            pictures.plan(panel, path, **pictures.DIRECTIONS[name])
        pictures.plan(panel, recording["ordinary"], **style.LINES["reference"])
        pictures.footprint(panel, condition.obstacle)
        pictures.ends(panel, task)
        pictures.board(panel)
        error = 10 * metrics["frozen"][f"rmse{number}"]
        plural = "s" if number > 1 else ""
        style.panel(
            panel,
            letter,
            f"{number} group{plural}, {error:.2g} mm off" if letter != "d" else "final, and demonstrations",
        )
    pictures.name_directions(panels[3])
    curve = figure.add_subplot(grid[1, 3:])
    for name, kind in (("frozen", "book"), ("refit", "rival")):
        if name in recordings:
            learning = recordings[name].frames["learning"].groupby("groups").rmse
            label = {"frozen": "old weights kept (7.17)", "refit": "all weights free"}[name]
            curve.plot(learning.median().index, 10 * learning.median(), label=label, marker=".", **style.LINES[kind])
            style.band(curve, learning.median().index, 10 * learning.min(), 10 * learning.max())
    curve.axhline(10 * metrics["frozen"]["spread"], **style.LINES["reference"])
    curve.annotate("spread of repetitions", (4.5, 10 * metrics["frozen"]["spread"]), fontsize=6.5, va="bottom")
    curve.axhline(10 * metrics["frozen"]["plain_refit"], label="plain primitive fitted again", **style.LINES["plain"])
    curve.set(yscale="log", xlabel="Groups of enhancement nodes [-]", ylabel="RMS error [mm]")
    curve.legend()
    style.panel(curve, "e", "error of ten draws of the nodes")
    style.title(figure, "Reactions approach the demonstrations group by group, if the old weights are kept")
    return {"7.8": figure}


def tabulate(
    recordings: Mapping[str, Recording], metrics: Mapping[str, Any], config: Config
) -> dict[str, pd.DataFrame]:
    rows = []
    for case, values in metrics.items():
        groups = [g for g in (1, 2, 5, 8) if f"rmse{g}" in values]
        rows.append(
            {"case": case}
            | {f"RMS error, {g} group(s) [mm]": 10 * values[f"rmse{g}"] for g in groups}
            | {f"end error, {g} group(s) [mm]": 10 * values[f"end_error{g}"] for g in groups}
            | {"draws whose forcing error always falls [%]": 100 * values["falling_draws"]}
        )
    return {"T7.2": pd.DataFrame(rows)}
