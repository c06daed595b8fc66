"""What ``unseen_conditions`` shows: its figures and tables."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings
from dexrepro.report import style

from .experiment import METHODS

FIGURES = {
    "7.C": Figure(
        "Fuzzy rules against simpler ways to react (simulated; not in the book). (a) Leave one out: RMS error of each "
        "of the twelve reactions predicted from the other eleven (dots) and mean (bars). (b) {.main.unseen_count:.0f} "
        "unseen conditions of places, heights and directions: mean error, and the share of reactions that touch the "
        "obstacle; the person's own reactions to these conditions touch it in the share drawn as a line.",
        "Errors of five ways to react where a condition was left out, and in unseen ones with the share that touch.",
    )
}
TABLES = {"T7.3": "Reactions to conditions that were never shown"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if "main" not in recordings:
        return {}
    left_out = recordings["main"].frames["left_out"]
    values: Mapping[str, Any] = metrics["main"]
    figure, (one, many) = style.subplots(1, 2, height=2.9)
    colours = (style.BOOK, style.RIVAL, style.EXTRA[0], style.EXTRA[2], style.PLAIN)
    labels = [
        text.replace(", ", ",\n").replace("plane a ", "plane a\n").replace("same ", "same\n")
        for text in METHODS.values()
    ]
    places = np.arange(len(METHODS))
    one.bar(places, [values[f"left_out_{m}"] for m in METHODS], 0.6, color=colours)
    for place, method in zip(places, METHODS):
        one.plot(place + np.linspace(-0.2, 0.2, len(left_out)), left_out[method], ".", color="k", markersize=2.5)
    many.bar(places - 0.2, [values[f"unseen_{m}"] for m in METHODS], 0.38, color=colours)
    touch = style.twin(many, "Touch the obstacle [%] (hatched)")
    touch.bar(places + 0.2, [100 * values[f"touches_{m}"] for m in METHODS], 0.38, color=colours, hatch="///",
              edgecolor="w", linewidth=0)  # fmt: skip
    touch.axhline(100 * values["touches_person"], label="the person (touches)", **style.LINES["reference"])
    touch.legend(loc="upper left")
    touch.set_ylim(0, 100)
    for letter, panel, text in zip(
        "ab", (one, many), ("leave one out", f"{values['unseen_count']:.0f} unseen conditions")
    ):
        panel.set_xticks(places, labels, fontsize=6.5)
        panel.set_ylabel("RMS error [cm]")
        style.panel(panel, letter, text)
    fuzzy, nearest = (
        f"{10 * values[f'unseen_{name}']:.1f} mm, {100 * values[f'touches_{name}']:.0f} % touch"
        for name in ("fuzzy", "nearest")
    )
    finding = f"Unseen conditions: fuzzy rules err by {fuzzy}; the nearest demonstration by {nearest}"
    return {"7.C": style.title(figure, finding)}


def tabulate(recordings: Recordings, metrics: Mapping[str, Any], config: Config) -> dict[str, pd.DataFrame]:
    rows = []
    for case, values in metrics.items():
        for method, text in METHODS.items():
            if config.cases[case].fuzzy != config.fuzzy and method != "fuzzy":
                continue  # the rivals do not depend on the fuzzy sets
            rows.append(
                {
                    "sets": case,
                    "method": text,
                    "leave one out [cm]": values[f"left_out_{method}"],
                    "unseen [cm]": values[f"unseen_{method}"],
                    "touch the obstacle [%]": 100 * values[f"touches_{method}"],
                    "at the rules, mean [cm]": values["rule_error"] if method == "fuzzy" else None,
                    "at the rules, worst [cm]": values["rule_worst"] if method == "fuzzy" else None,
                }
            )
    return {"T7.3": pd.DataFrame(rows)}
