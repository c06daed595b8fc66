"""What ``growth_cost`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings
from dexrepro.report import style

FIGURES = {
    "4.A": Figure(
        "Cost of one control step (output and weight update, 14 inputs, 7 outputs) and reserved memory against the "
        "number of nodes, for a growing network with enhancement, a lattice evaluated as a product and the same "
        "lattice by the plain formula. Times are of the machine that made the figure. The book reports that a broad "
        "network of 72 nodes replaces one of 16384.",
        "Step time and memory grow in proportion to the nodes; a broad network of 72 nodes is far cheaper than 16384.",
    )
}
TABLES = {"T4.D": "Cost of one control step by network and number of nodes"}

LABELS = {
    "growing": ("Growing, with enhancement", "book"),
    "lattice": ("Lattice as a product", "rival"),
    "plain": ("Lattice, plain formula", "plain"),
}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if set(recordings) < set(LABELS):
        return {}
    figure, (left, right) = style.subplots(1, 2, height=2.7)
    for case, (label, line) in LABELS.items():
        cost = recordings[case].frames["cost"]
        left.loglog(cost.nodes, cost.step_us, marker="o", markersize=3, label=label, **style.LINES[line])
        right.loglog(cost.nodes, cost.memory_kb, marker="o", markersize=3, **style.LINES[line])
    left.axhline(1e3 * config.period_ms, **style.LINES["reference"])
    left.annotate(
        f"control period {config.period_ms:g} ms", (90, 1e3 * config.period_ms), xytext=(0, -9), size=7,
        textcoords="offset points",
    )  # fmt: skip
    broad, fixed = 72, 2**config.inputs  # nodes printed in 4.6
    for axes, label in ((left, "Shortest step time [µs]"), (right, "Memory [kB]")):
        axes.set(xlabel="Nodes [-]", ylabel=label)
        for nodes in (broad, fixed):
            axes.axvline(nodes, color="#999999", linewidth=0.6, zorder=-5)
    places = ((broad, " the book's broad network", "left", 0.05), (fixed, "its fixed network ", "right", 0.14))
    for nodes, word, side, height in places:
        right.annotate(word, (nodes, height), xycoords=("data", "axes fraction"), size=6.5, ha=side)
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    small, large = (recordings[case].frames["cost"] for case in ("growing", "lattice"))
    ratio = float(large.step_us.iloc[-1] / small.step_us[small.nodes <= broad].iloc[-1])
    finding = f"A broad network of {broad} nodes takes its step {ratio:.0f} times faster than {fixed} fixed nodes"
    return {"4.A": style.title(figure, finding)}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, Any]:
    tables = [
        recordings[case].frames["cost"].assign(network=label)
        for case, (label, _) in LABELS.items()
        if case in recordings
    ]
    table = pd.concat(tables).rename(columns={"memory_kb": "memory [kB]", "step_us": "shortest step [µs]"})
    return {"T4.D": table[["network", *(name for name in table.columns if name != "network")]]}
