"""Reactions learned as an addition to the ordinary skill, one group of enhancement nodes after the other."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Rng
from dexrepro.chapters.chapter7 import skills
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.measures import rms_distance
from dexrepro.primitives.reactive import fit_reaction, ridge_weights

RATE = 50.0


def simulate(config: Config, rng: Rng) -> Recording:
    learned, reactions = taught(config)
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


def taught(config: Config) -> tuple[skills.Skills, np.ndarray]:
    """The skills learned, and the reactions (conditions, repetitions, N, 3) [cm] that taught them."""
    ordinary, reactions = skills.demonstrate(config)
    reactions = skills.with_recorded_reactions(config, reactions)
    return skills.Skills(config, ordinary, reactions), reactions


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
    """Errors [cm] without reaction, of plain primitives fitted again (its own kernels, or as many as there are weights
    after the groups that are shown last and after all), and with the printed sign in (7.23) alone."""
    primitive, mean = learned.primitive, learned.demonstrated[shown(config)]
    targets = learned.target(demonstrations).mean(axis=1)

    def again(nodes: int) -> np.ndarray:
        psi = skills.Primitive(config, config.dmp.kernels + nodes).kernels.features(primitive.phases)
        forcing = np.array([psi @ ridge_weights(psi, target, primitive.ridge) for target in targets])
        return primitive.rollout(forcing, learned.start, learned.goal)

    smooth = skills.low_pass(mean - learned.perform(), config.dmp.cutoff, primitive.rate, axis=-2)
    velocity = primitive.duration * np.gradient(smooth, 1 / primitive.rate, axis=-2)
    printed = learned.reaction_targets[shown(config)] - 2 * primitive.system.damping * velocity
    forcing = fit(config, learned, learned.features, printed)
    paths = {
        "no reaction": np.broadcast_to(learned.perform(), mean.shape),
        "plain primitive fitted again": again(0),
        **{
            f"plain primitive with the weights of {g} groups": again(g * config.enhancement.nodes)
            for g in larger(config)
        },
        "printed sign of D(v^N - v)": learned.perform(forcing @ learned.reach.axes.T),
    }
    spread = np.sqrt(((demonstrations - mean[:, None]) ** 2).sum(axis=-1).mean(axis=(1, 2)))
    rows = [{"what": name, "rmse": rms_distance(path, mean).mean()} for name, path in paths.items()]
    return pd.DataFrame([*rows, {"what": "spread of repetitions", "rmse": spread.min()}])


def larger(config: Config) -> tuple[int, int]:
    """Groups of nodes after which a plain primitive of as many weights is a rival: those shown last, and all."""
    return config.shown_groups[-1], config.enhancement.groups


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
        **{
            f"plain_equal{g}": float(baseline[f"plain primitive with the weights of {g} groups"])
            for g in larger(config)
        },
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
    learned, _ = taught(config)
    return float(np.abs(learned.perform(np.zeros((1, len(recording.time), 3)))[0] - recording["ordinary"]).max())
