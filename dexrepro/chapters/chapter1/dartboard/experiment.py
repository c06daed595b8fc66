"""Thirteen synthetic operators hit six dartboards through two mappings (Task 2, Section 1.5.2.1, Fig. 1.15).

Each operator does the task with the general mapping (constant scale, the hand's posture tied to the tool's) and with
the proposed one (speed-dependent scale, re-fixing), with the same traits and the same random numbers. The tool is where
the mapping puts it. A case is one pair of mappings, repeated over several panels of thirteen.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from scipy import stats

from dexrepro.arrays import Rng
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.humans.operator import COMFORTABLE_ROLL, Hand, Operator

RATE = 100.0
MAPPINGS = ("general", "proposed")
HAND_ROOM = 0.09  # m, offset of the hand from the middle of its range at which an operator re-fixes


def boards() -> Any:
    """Centres of the six boards [m] in the plane x = 0, shape (6, 3)."""
    return np.array([(0.0, y, z) for y in (-0.25, 0.0, 0.25) for z in (0.15, -0.15)])


def simulate(config: Config, rng: Rng) -> Recording:
    people, rows, shown = rng("people"), [], {}
    for panel in range(config.panels):
        for person in range(config.operators):
            operator = Operator.draw(people)
            seed = int(people.integers(2**63))
            for mapping in MAPPINGS:
                refix = mapping == "proposed"
                hand, hits = _play(config, operator, config.mappings[mapping], np.random.default_rng(seed), refix)
                rows += _rows(panel, person, mapping, hand, hits, 0.0 if refix else config.home_roll)
                if panel == person == 0:
                    shown[mapping] = hand.record()
    record = shown["proposed"]
    series = {"time": record["time"], "scale": record["scale"], "tool": record["tool"], "hand": record["hand"]}
    return Recording(series=series, frames={"hits": pd.DataFrame(rows)}, steps=len(rows))


def _play(
    config: Config, operator: Operator, scaling: Any, rng: np.random.Generator, refix: bool
) -> tuple[Hand, list[Any]]:
    """All six boards; hit points (y, z) [m] relative to the centres."""
    reach = config.press
    hand = Hand(operator, scaling, rng, tool=boards()[0] + [-reach, 0.1, -0.1], cutoff=config.speed_cutoff)
    hits = []
    for board in boards():
        hand.reach(board - [reach, 0.0, 0.0])
        hand.submove(np.array([-hand.tool[0], 0.0, 0.0]), config.press_time)
        hits.append((hand.tool - board)[1:])
        hand.submove(np.array([-reach - hand.tool[0], 0.0, 0.0]), config.press_time)
        if refix and np.abs(hand.centre).max() > HAND_ROOM:
            hand.clutch(np.zeros(3))
    return hand, hits


def _rows(panel: int, person: int, mapping: str, hand: Hand, hits: list[Any], roll: float) -> list[dict[str, Any]]:
    excursion = float(np.abs(hand.record()["hand"]).max())
    load = max(0.0, roll - np.rad2deg(COMFORTABLE_ROLL)) * hand.time
    shared = {
        "panel": panel, "person": person, "mapping": mapping, "time": hand.time / len(hits), "excursion": excursion,
        "load": load, "clutches": hand.clutches,
    }  # fmt: skip
    return [shared | {"board": k, "y": hit[0], "z": hit[1]} for k, hit in enumerate(hits)]


def scores(hits: pd.DataFrame, ring: float) -> pd.DataFrame:
    """Score of every operator, one row a (panel, person), one column a mapping: 10 a bull's-eye, 1 less a ring."""
    radius = np.hypot(hits["y"], hits["z"])
    points = np.maximum(0, 10 - np.floor(radius / ring))
    return points.groupby([hits["panel"], hits["person"], hits["mapping"]]).sum().unstack()


def measure(recording: Recording, config: Config) -> Metrics:
    hits = recording.frames["hits"]
    radius: Any = np.hypot(hits["y"], hits["z"])
    table = scores(hits, config.ring)
    gain = table["proposed"] - table["general"]
    by_panel = gain.groupby("panel")
    wins, losses = by_panel.agg(lambda g: (g > 0).sum()), by_panel.agg(lambda g: (g < 0).sum())
    first = gain.loc[0]
    test = stats.wilcoxon(first) if np.any(first != 0) else None
    result: Metrics = {
        "wins": int(wins.loc[0]),
        "losses": int(losses.loc[0]),
        "ties": int(config.operators - wins.loc[0] - losses.loc[0]),
        "wins_median": float(wins.median()),
        "wins_least": int(wins.min()),
        "losses_median": float(losses.median()),
        "losses_most": int(losses.max()),
        "p_value": float(test.pvalue) if test else 1.0,
        "p_value_all": float(stats.wilcoxon(gain).pvalue),
    }
    for ring in (0.005, 0.01):
        wider = scores(hits, ring)
        change = (wider["proposed"] - wider["general"]).groupby("panel")
        result |= {
            f"wins_median_{1e3 * ring:.0f}mm": float(change.agg(lambda g: (g > 0).sum()).median()),
            f"losses_median_{1e3 * ring:.0f}mm": float(change.agg(lambda g: (g < 0).sum()).median()),
        }
    for mapping in MAPPINGS:
        mine = hits["mapping"] == mapping
        result |= {
            f"{mapping}_radius": 1e3 * float(radius[mine].median()),
            f"{mapping}_radius_mean": 1e3 * float(radius[mine].mean()),
            f"{mapping}_score": float(table[mapping].mean()),
            f"{mapping}_time": float(hits["time"][mine].mean()),
            f"{mapping}_load": float(hits["load"][mine].mean()),
            f"{mapping}_excursion": float(hits["excursion"][mine].mean()),
        }
    speed = np.linalg.norm(np.diff(recording["hand"], axis=0), axis=1) / 0.01
    scale, tool = recording["scale"][1:], recording["tool"][1:]
    near = np.min(np.linalg.norm(tool[:, None, 1:] - boards()[None, :, 1:], axis=2), axis=1)
    result |= {
        "speed_near": float(speed[near < 0.01].mean()),
        "speed_far": float(speed[near > 0.05].mean()),
        "scale_near": float(scale[near < 0.01].mean()),
        "scale_far": float(scale[near > 0.05].mean()),
    }
    return result
