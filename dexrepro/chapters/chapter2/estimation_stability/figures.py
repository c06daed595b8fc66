"""What ``estimation_stability`` shows: its figures and tables."""

from __future__ import annotations

import numpy as np

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings
from dexrepro.report import style

FIGURES = {
    "2.B": Figure(
        "(a) Prediction error of the adaptation law with time counted from the start and all rates equal to c, fed "
        "with the exact signals of Traj. 1; vertical lines: where the explicit step reaches its limit, dt c t^4 = 2. "
        "(b) Fall of the Lyapunov function (2.19) for constant parameters, and the sum of its exact discrete "
        "decrements. Not in the book.",
        "Prediction error over time for several rates, and a Lyapunov function beside the sum of its decrements.",
    )
}
UNITS = {"lyapunov": "N² s", "change": "N² s", "exact_change": "N² s", "predicted_fall": "N² s", "error": "N"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    growing = [case for case in recordings if config.cases[case].study == config.study]
    if not growing or "lyapunov" not in recordings:
        return {}
    figure, (left, right) = style.subplots(1, 2, height=2.6)
    for case, line in zip(growing, ("book", "rival", "extra1")):
        run, look = recordings[case], style.LINES[line]
        left.plot(run.time, np.abs(run["error"]), label=f"c = {config.cases[case].rate:g}", **look)
        left.axvline(metrics[case]["predicted_time"], color=look["color"], linewidth=0.6)
    left.set(yscale="log", ylim=(1e-4, 200), xlabel="Time [s]", ylabel="Prediction error [N]")
    left.axvline(np.nan, color=style.REFERENCE, linewidth=0.6, label="predicted instant")
    figure.legend(*left.get_legend_handles_labels(), loc="outside lower left", ncols=4)

    run = recordings["lyapunov"]
    fall = 1e3 * (run["lyapunov"][0] - run["lyapunov"])
    right.plot(run.time, fall, label="measured", **style.LINES["book"])
    right.plot(run.time, 1e3 * run["predicted_fall"], label="exact decrements, summed", **style.LINES["reference"])
    right.set(xlabel="Time [s]", ylabel="$V(0) - V$ [$10^{-3}$]")
    right.legend()
    style.panels((left, right), "time from the start, equal rates", "constant parameters")
    worst = style.at_most(100 * max(metrics[case]["relative_difference"] or 0.0 for case in growing), 0)
    finding = f"Time from the start makes the law diverge within {worst} % of the predicted instant"
    return {"2.B": style.title(figure, finding)}
