"""What ``force_tracking`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Recording, Recordings
from dexrepro.report import style
from dexrepro.robots.planar import PlanarChain

from .experiment import CASES, LATE

FIGURES = {
    "1.9": Figure(
        "The two planar arms and the object at four instants of the first case, proposed law. The book shows a sketch "
        "of the platform.",
        "Two three-link arms hold a spring between them and move right together.",
    ),
    "1.10": Figure(
        "Simulated torque-controlled arms. Columns: the book's three cases. Rows: force error; the same after "
        "5 s; the contact position x_d that gives the desired force, the reference x_r and the stiffness; the Lyapunov "
        "function of Eq. (1.34) along the run, which the book does not draw (W*: exact and small in case 1, elsewhere "
        "the best constant weights of moderate size).",
        "The proposed law has the smallest force error of three controllers in all three cases.",
    ),
}
UNITS = {
    "error": "N", "displacement": "m", "partner": "m", "reference": "m", "contact": "m", "stiffness": "N/m",
    "joints": "rad", "tracking": "m", "lyapunov": "J", "weights": "m/s, 1/s, 1/s, 1/s",
}  # fmt: skip
TABLES = {"T1.A": "Force error of every law in the three cases of Fig. 1.10"}
ROLES = {"proposed": "book", "force": "rival", "passive": "plain"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    figures = {}
    if "c1_proposed" in recordings:
        figures["1.9"] = _draw_arms(recordings["c1_proposed"], config)
    if all(f"{case}_{law}" in recordings for case in CASES for law in ROLES):
        figures["1.10"] = _draw_errors(recordings, metrics)
    return figures


def _draw_arms(recording: Recording, config: Config) -> Drawing:
    figure, axes = style.subplots(1, 4, height=1.95, sharex=True, sharey=True)
    chains = [PlanarChain(config.arm.lengths, config.arm.masses, tuple(base)) for base in config.bases.values()]
    for axis, instant in zip(axes, np.linspace(0, recording.time[-1], 4)):
        joints = recording["joints"][np.argmin(np.abs(recording.time - instant))]
        ends = []
        for chain, q, colour in zip(chains, (joints[:3], joints[3:]), (style.EXTRA[0], style.BOOK)):
            turns = np.cumsum(q)
            x = chain.base[0] + np.cumsum(np.r_[0.0, chain.lengths * np.cos(turns)])
            y = chain.base[1] + np.cumsum(np.r_[0.0, chain.lengths * np.sin(turns)])
            axis.plot(x, y, "-o", color=colour, markersize=3)
            ends.append((x[-1], y[-1]))
        axis.plot(*zip(*ends), color=style.RIVAL, linestyle=(0, (1, 0.6)), linewidth=3)
        axis.set_title(f"{instant:.0f} s, {1e3 * abs(ends[1][0] - ends[0][0]):.0f} mm apart")
        axis.set_aspect("equal")
        axis.set(xlim=(-0.35, 0.95), ylim=(-0.1, 0.85), xticks=(0.0, 0.5))
        axis.set_xlabel("x [m]")
    axes[0].set_ylabel("y [m]")
    axes[0].annotate("DFR", (-0.05, -0.03), fontsize=7, color=style.EXTRA[0], ha="right")
    axes[0].annotate("AFR", (0.56, -0.03), fontsize=7, color=style.BOOK)
    return style.title(figure, "The follower (blue) keeps squeezing the object while its partner (green) moves right")


def _draw_errors(recordings: Recordings, metrics: Any) -> Drawing:
    figure, axes = style.subplots(4, 3, height=6.6, sharex=True, sharey="row")
    for column, case in enumerate(CASES):
        for law, role in ROLES.items():
            recording = recordings[f"{case}_{law}"]
            for row in (0, 1):
                late = recording.time >= (LATE if row else 0)
                axes[row, column].plot(recording.time[late], recording["error"][late], **style.LINES[role], label=law)
        recording = recordings[f"{case}_proposed"]
        time = recording.time
        axes[2, column].plot(time, 1e3 * recording["contact"], **style.LINES["reference"], label="$x_d$")
        axes[2, column].plot(time, 1e3 * recording["reference"], **style.LINES["book"], label="$x_r$")
        twin = style.twin(axes[2, column], "Stiffness $k_o$ [N/m]" if column == 2 else "")
        twin.plot(time, recording["stiffness"], **style.LINES["extra1"], label="$k_o$")
        twin.set_ylim(30, 65)
        if column < 2:
            twin.set_yticklabels([])
        axes[3, column].semilogy(time, recording["lyapunov"], **style.LINES["book"])
        axes[1, column].axhline(0, color="black", linewidth=0.4)
        axes[0, column].set_title(("Ramp, constant $k_o$", "Ramp, varying $k_o$", "Sine, varying $k_o$")[column])
    style.edges(axes, "Time [s]", ("Force error [N]", "after 5 s [N]", "Position [mm]", "Lyapunov $V$ [-]"))
    axes[0, 0].legend(loc="lower right")
    handles = [*axes[2, 0].get_lines(), *twin.get_lines()]
    axes[2, 0].legend(handles, [line.get_label() for line in handles], loc="lower right", ncols=3)
    best = sum(
        metrics[f"{case}_proposed"]["rmse"]
        < min(metrics[f"{case}_{law}"]["rmse"] for law in ROLES if law != "proposed")
        for case in CASES
    )
    return style.title(figure, f"The proposed law keeps the smallest force error in {best} of {len(CASES)} cases")


LAWS = ("proposed", "integral", "force", "passive", "proposed_tuned", "force_tuned", "passive_tuned", "printed",
        "printed_inverse")  # fmt: skip
COLUMNS = {
    "rmse": "RMSE [N]",
    "rmse_late": f"RMSE after {LATE:g} s [N]",
    "iae": "integral of the error [N s]",
    "settling": "settling [s]",
}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    rows = []
    for law in (law for law in LAWS if any(f"{case}_{law}" in metrics for case in CASES)):
        row: dict[str, Any] = {"law": law.replace("_", " ")}
        for case in CASES:
            values = metrics.get(f"{case}_{law}", {})
            row |= {f"{case} {text}": values.get(key) for key, text in COLUMNS.items()}
        rows.append(row)
    return {"T1.A": pd.DataFrame(rows)}
