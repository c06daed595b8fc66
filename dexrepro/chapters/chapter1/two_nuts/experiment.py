"""Two nuts turned one after the other through the general and through the proposed mapping (Task 1, Section 1.5.2.1).

A synthetic operator moves the tool to a nut, turns it, moves to the next and turns that. The general mapping ties the
tool's orientation to the hand's and scales the whole workspace; the proposed one lets the operator fix anew and scale
down. The tool is where the mapping puts it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.arrays import Rng
from dexrepro.experiment import Config, Metrics, Recording
from dexrepro.humans.operator import COMFORTABLE_ROLL, FOREARM_ROLL, Hand, Operator
from dexrepro.measures import rms_distance

RATE = 50.0


def simulate(config: Config, rng: Rng) -> Recording:
    rows, shown = [], None
    people = rng("people")
    for person in range(config.operators):
        operator = Operator.draw(people)
        hand = _turn_both(config, Hand(operator, config.scaling, rng(f"hand {person}"), tool=np.zeros(3)))
        rows.append(_judge(hand, config))
        shown = shown or hand
    assert shown is not None
    record = shown.record()
    series = {key: record[key] for key in ("time", "roll", "tool_roll", "hand", "tool", "scale")}
    return Recording(series=series, frames={"operators": pd.DataFrame(rows)}, steps=shown.samples)


def nuts(config: Config) -> Any:
    """Places of the two nuts [m], shape (2, 3)."""
    return np.array([[0.0, config.approach, 0.0], [0.0, config.approach + config.spacing, 0.0]])


def _turn_both(config: Config, hand: Hand) -> Hand:
    """The whole task; ``hand.working`` lists the sample ranges in which a nut is being turned."""
    home = np.deg2rad(config.home_roll)
    hand.roll = 0.0 if config.refix else home
    hand.working = []  # type: ignore[attr-defined]
    for nut in nuts(config):
        hand.reach(nut)
        begin, start = hand.samples, hand.tool_roll
        if config.refix:
            hand.clutch(roll=-config.stroke_share * COMFORTABLE_ROLL)
        _turn_nut(config, hand, start + np.deg2rad(config.turn))
        hand.working.append((begin, hand.samples))  # type: ignore[attr-defined]
        hand.clutch(np.zeros(3), 0.0) if config.refix else _unwind(hand, home)
    return hand


def _turn_nut(config: Config, hand: Hand, goal: float) -> None:
    """Strokes until the nut has been turned; with re-fixing each stays in the comfortable range."""
    while (left := goal - hand.tool_roll) > np.deg2rad(config.angle_tolerance):
        if not config.refix:
            hand.turn(left)
        else:
            room = config.stroke_share * COMFORTABLE_ROLL - hand.roll
            hand.turn(min(left, room))
            if goal - hand.tool_roll > np.deg2rad(config.angle_tolerance):
                hand.clutch(roll=-config.stroke_share * COMFORTABLE_ROLL)
        hand.wait(hand.operator.reaction)


def _unwind(hand: Hand, home: float) -> None:
    """Without re-fixing the tool is lifted off and turned back with the hand."""
    hand.turn(home - hand.roll)


def _judge(hand: Hand, config: Config) -> dict[str, float]:
    record, places = hand.record(), nuts(config)
    roll, dt = np.abs(record["roll"]), hand.dt
    jitter, error = [], []
    for (begin, end), nut in zip(hand.working, places):  # type: ignore[attr-defined]
        tool = record["tool"][begin:end]
        jitter.append(rms_distance(tool, tool.mean(axis=0)))
        error.append(np.linalg.norm(tool.mean(axis=0) - nut))
    return {
        "largest roll [deg]": np.rad2deg(roll.max()),
        "time outside comfort [-]": float(np.mean(roll > COMFORTABLE_ROLL)),
        "time beyond the forearm's range [-]": float(np.mean(roll > FOREARM_ROLL)),
        "posture load [deg s]": np.rad2deg(np.sum(np.maximum(roll - COMFORTABLE_ROLL, 0.0)) * dt),
        "tool jitter [mm]": 1e3 * float(np.mean(jitter)),
        "distance from the nut [mm]": 1e3 * float(np.mean(error)),
        "submovements": float(hand.submovements),
        "clutches": float(hand.clutches),
        "time [s]": hand.time,
    }


NAMES = {
    "roll": "largest roll [deg]", "outside": "time outside comfort [-]", "load": "posture load [deg s]",
    "beyond": "time beyond the forearm's range [-]", "jitter": "tool jitter [mm]", "time": "time [s]",
    "clutches": "clutches", "distance": "distance from the nut [mm]",
}  # fmt: skip


def measure(recording: Recording, config: Config) -> Metrics:
    table = recording.frames["operators"]
    result: Metrics = {name: float(table[column].median()) for name, column in NAMES.items()}
    result["least_load"] = float(table["posture load [deg s]"].min())
    result["most_load"] = float(table["posture load [deg s]"].max())
    return result
