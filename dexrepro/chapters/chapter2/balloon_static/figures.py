"""What ``balloon_static`` shows: its figures and tables."""

from __future__ import annotations

import numpy as np

from dexrepro.chapters.chapter2 import balloon_pair
from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Film, Recordings, changed
from dexrepro.report import style

FIGURES = {
    "2.9": Figure(
        "Simulated Baxter, synthetic operator. (a) The two arms and the balloon at the instant of contact; (b) front "
        "view of the two grippers' starts with both discrepancies. The book shows photographs of the robot.",
        "Two arms of a Baxter robot face each other with a balloon between their grippers.",
    ),
    "2.10": Figure(
        "Simulated Baxter, balloon as a spring of {.stiffness:g} N/m. (a), (b) Path of the follower's gripper from two "
        "starts; (c), (d) contact force on it. Contact comes at y = {.off_100.contact_y:.2f} and "
        "{.off_80.contact_y:.2f} m (book: about 0.25 m; it shifts with the balloon's size, which is not printed).",
        "Paths of the follower's gripper from two starts, and the contact forces over time.",
    ),
}
UNITS = {"reference": "m"}
FILM = Film(
    "off_100", "The follower touches the balloon {.cases.off_100.discrepancy:g} m off the line, finds the line and "
    "holds {.desired_force:g} N.", balloon_pair.VIEW, "object.force", "Holding force [N]", reference="desired_force",
)  # fmt: skip


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    recordings = {
        case: run for case, run in recordings.items() if changed(config.cases[case], config) <= {"discrepancy"}
    }
    if len(recordings) < 2:
        return {}
    return {"2.9": _draw_setup(recordings, config), "2.10": _draw_paths(recordings, metrics, config)}


def _off(config: Config, case: str) -> str:
    """How far off the line a case starts; in x and in z where the two differ."""
    sizes = np.atleast_1d(config.cases[case].discrepancy)
    return " and ".join(f"{size:g}" for size in dict.fromkeys(sizes.tolist())) + " m off"


def _draw_setup(recordings: Recordings, config: Config) -> Drawing:
    figure, (photo, front) = style.subplots(1, 2, height=2.7, width_ratios=(1.3, 1))
    style.photo(photo, next(iter(recordings.values())).images["contact"])
    style.panel(photo, "a", "simulated Baxter at the instant of contact")
    leader = next(iter(recordings.values()))["leader.tip"][0]
    front.plot(1e3 * leader[0], 1e3 * leader[2], "s", color=style.PLAIN, label="partner (right arm)")
    for (case, run), line in zip(recordings.items(), ("book", "rival")):
        x, z = 1e3 * run["follower.tip"][0, [0, 2]]
        front.plot(x, z, "o", color=style.LINES[line]["color"], label=f"follower, {_off(config, case)}")
        front.annotate("", 1e3 * leader[[0, 2]], (x, z), arrowprops={"arrowstyle": "<->", "lw": 0.6})
    front.set(xlabel="x [mm]", ylabel="z [mm]", aspect="equal", xlim=(600, 820), ylim=(210, 400))
    front.legend(loc="upper left")
    style.panel(front, "b", "grippers at the start, seen along y")
    finding = "Two arms, one balloon, and a follower that starts off the holding line (synthetic operator)"
    return style.title(figure, finding)


def _draw_paths(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawing:
    figure, grid = style.subplots(2, 2, height=4.4)
    for axes, (first, second), letter in ((grid[0, 0], (0, 2), "a"), (grid[0, 1], (1, 2), "b")):
        for (case, run), line in zip(recordings.items(), ("book", "rival")):
            tip, label = 1e3 * run["follower.tip"], _off(config, case)
            axes.plot(tip[:, first], tip[:, second], label=label, **style.LINES[line])
            axes.plot(tip[0, first], tip[0, second], "o", ms=3, color=style.LINES[line]["color"])
            axes.plot(tip[-1, first], tip[-1, second], "x", ms=5, color=style.REFERENCE)
        axes.set(xlabel=f"{'xyz'[first]} [mm]", ylabel="z [mm]")
        style.panel(axes, letter, f"path in the {'xyz'[first]}z plane")
    leader = 1e3 * next(iter(recordings.values()))["leader.tip"][0]
    grid[0, 0].plot(leader[0], leader[2], "s", ms=4, color=style.PLAIN, label="partner")
    grid[0, 0].legend()
    for axes, (case, run), letter in zip(grid[1], reversed(list(recordings.items())), "cd"):
        for index, line in enumerate(("extra1", "book", "extra2")):
            axes.plot(run.time, run["follower.force"][:, index], label=f"$f_{'xyz'[index]}$", **style.LINES[line])
        axes.axhline(config.cases[case].desired_force, **style.LINES["reference"])
        style.event(axes, 0.0, "contact")
        axes.set(xlabel="Time since contact [s]", ylabel="Force [N]", ylim=(-2, 11.5))
        style.panel(axes, letter, _off(config, case))
    grid[1, 1].legend(ncols=3, loc="center right")
    ends = np.ptp([run["follower.tip"][-1] for run in recordings.values()], axis=0)
    spread = style.at_most(1e3 * float(np.linalg.norm(ends)), 1)
    finding = f"From both starts the follower ends at one place, within {spread} mm (simulated Baxter)"
    return style.title(figure, finding)
