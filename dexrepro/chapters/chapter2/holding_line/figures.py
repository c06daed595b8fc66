"""What ``holding_line`` shows: its figures and tables."""

from __future__ import annotations

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings
from dexrepro.report import style

FIGURES = {
    "2.5": Figure(
        "Holding force and lateral offset of the two tips with and without the regulation (2.8): (a) the arms start "
        "apart across the line, (b) the partner swings across it. The partner's movement and the object are known to "
        "the follower here, as in the book, which shows the upper row.",
        "Holding force and lateral offset over time with and without the regulation, in two cases.",
    )
}
UNITS = {"reference": "m", "estimate": "m, N/m, m/s"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    cases = [case for case in ("case1", "case2") if {f"{case}_with", f"{case}_without"} <= set(recordings)]
    if not cases:
        return {}
    figure, grid = style.subplots(2, len(cases), height=3.4, sharex=True, sharey="row", squeeze=False)
    lines = {"with": ("with (2.8)", "book"), "without": ("without", "plain")}
    texts = ("start {:.0f} mm apart (Case 1)", "partner swings across (Case 2)")
    for column, case, letter, text in zip(grid.T, cases, "ab", texts):
        for switch, (label, line) in lines.items():
            run = recordings[f"{case}_{switch}"]
            offset = run["follower.tip"][:, 1] - run["leader.tip"][:, 1]
            column[0].plot(run.time, run["object.force"], label=label, **style.LINES[line])
            column[1].plot(run.time, 1e3 * offset, **style.LINES[line])
        column[0].axhline(config.desired_force, label="$f_d$", **style.LINES["reference"])
        style.panel(column[0], letter, text.format(1e3 * abs(offset[0])))
        column[1].set_xlabel("Time [s]")
    grid[0, 0].set(ylabel="Holding force $\\|F\\|$ [N]", ylim=(-0.1, 2.6))
    grid[1, 0].set_ylabel("Offset $y_1 - y_2$ [mm]")
    grid[0, 0].legend(loc="upper right", ncols=3)
    lost = metrics.get("case2_without", {}).get("lost")
    found = f"; without it the object is lost for {100 * lost:.0f} % of case 2" if lost else ""
    finding = f"The regulation keeps the arms on one line and the force at {config.desired_force:g} N{found}"
    return {"2.5": style.title(figure, finding)}
