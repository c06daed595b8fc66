"""Figures 4.1 and 4.4 to 4.10: what the two-link arm did, from recordings alone."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from scipy.ndimage import maximum_filter1d

from dexrepro.arrays import Array, Mask
from dexrepro.chapters.chapter4.two_link import ELLIPSE
from dexrepro.experiment import Config, Drawing, Drawings, Figure, Metrics, Recording
from dexrepro.report import style
from dexrepro.report.tables import by_case

ARM = "Two-link arm in PyBullet under the law's torque, gravity and {.task.force.1:g} N at the tip. "
WEIGHTS = (
    ARM + "Weights of the Gaussians, one line a node, while the four strokes are learned one after another; above each "
    "panel how many exceed a tenth of the largest (joint 1). The book shows many small and few large weights."
)
FIGURES = {
    "4.1": Figure(
        "(a) The four strokes that are learned, (b) the ellipse drawn with what was learned, (c, d) inputs of the "
        "network in the plane of the virtual acceleration, with nodes (dots) and the threshold distance around them "
        "(circles); dashed orange: nodes added on the ellipse. The book sketches the principle.",
        "Strokes, ellipse, and inputs and nodes of the network in the plane of the virtual acceleration.",
    ),
    "4.4": Figure(
        "The arm at the start of every run, rendered in its vertical plane, with strokes, ellipse (dashed), reach, "
        "gravity and the force field. The book draws the same arrangement.",
        "A two-link arm whose tip stands at the centre of an ellipse crossed by four strokes.",
    ),
    "4.5": Figure(
        ARM
        + "Above: 20 s of the ellipse from the centre, by fixed radial basis networks of two widths, a fuzzy network "
        "and the broad network, all after the same training and at equal effective gain. Below: the training of "
        "the broad network. The book compares one radial basis, one fuzzy and the broad network.",
        "Paths of four methods on the ellipse, and of the broad network on four strokes.",
    ),
    "4.6": Figure(
        ARM + "Tracking error on the ellipse after training, at equal effective gain: the component in y during the "
        "first 3 s (grey: prescribed bound; the start is cut) and the envelope of the error over the whole run, above "
        "for three thresholds, below against fixed and fuzzy networks. The book shows thresholds 20, 30 and 50 and one "
        "fixed network.",
        "Errors of six networks at the start with the bound, and their envelopes over the run, on a logarithmic scale.",
    ),
    "4.7": Figure(
        ARM
        + "Number of nodes for three thresholds while four strokes are learned and the ellipse is drawn; below, the "
        "first half second of each run. The book shows counts that grow faster for smaller thresholds.",
        "Number of nodes over time for three thresholds, with the first half second of each run.",
    ),
    "4.8": Figure(
        WEIGHTS,
        "Weights of the nodes over time while four strokes are learned, threshold "
        "{.cases.broad20.law.network.basis.threshold:g}.",
    ),
    "4.9": Figure(
        WEIGHTS,
        "Weights of the nodes over time while four strokes are learned, threshold "
        "{.cases.broad30.law.network.basis.threshold:g}.",
    ),
    "4.10": Figure(
        WEIGHTS,
        "Weights of the nodes over time while four strokes are learned, threshold "
        "{.cases.broad50.law.network.basis.threshold:g}.",
    ),
}
UNITS = {
    "error": "m", "tip": "m", "position": "rad", "torque": "N m", "virtual_acceleration": "rad/s²", "usage": "1",
    "share": "1", "nodes": "1", "feature_energy": "1", "input_norm": "mixed", "input_peak": "mixed", "segment": "1",
}  # fmt: skip
TABLES = {"T4.A": "Ellipse after training: errors, oscillation, nodes and gain of every method"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    drawn: dict[str, Any] = {}
    finished = {case: recording for case, recording in recordings.items() if recording.status == "finished"}
    for identifier, case, threshold in (("4.8", "broad20", 20), ("4.9", "broad30", 30), ("4.10", "broad50", 50)):
        if case in finished and config.cases[case].training:
            drawn[identifier] = weights(finished[case], metrics[case], threshold)
    if "broad20" not in finished or not config.cases["broad20"].training:
        return drawn
    drawn["4.1"] = motions_and_nodes(finished["broad20"], config)
    if "arm" in finished["broad20"].images:
        drawn["4.4"] = arm(finished["broad20"], config)
    drawn["4.5"] = paths(finished, metrics, config)
    drawn["4.6"] = errors(finished, metrics, config)
    drawn["4.7"] = node_counts(finished, metrics, config)
    return drawn


COLUMNS = {
    "rmse_mm": "RMSE [mm]",
    "transient_rmse_mm": "RMSE 1-5 s [mm]",
    "steady_rmse_mm": "RMSE last half [mm]",
    "torque_increment_nm": "torque increment [N m per 10 ms]",
    "error_ripple_mm": "early error ripple [mm]",
    "nodes": "nodes",
    "max_usage": "largest share of the bound",
    "violations": "samples outside",
    "effective_gain": "effective gain",
}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, Any]:
    def told(case: str) -> dict[str, str]:
        network = config.cases[case].law.network
        common = network and network.gain == config.law.network.gain
        return {"gain": "none" if not network else "common" if common else "equal effective"}

    return {"T4.A": by_case(metrics, COLUMNS, config.cases, told=told)}


METHODS = {
    "broad20": (r"broad, $\Theta$ = 20", "book"),
    "broad30": (r"broad, $\Theta$ = 30", "extra1"),
    "broad50": (r"broad, $\Theta$ = 50", "extra2"),
    "rbf2": (r"RBF, $\eta$ = 2", "plain"),
    "rbf_settled": ("RBF, tuned", "rival"),
    "fuzzy": ("fuzzy", "extra3"),
}
ROMAN = ("I", "II", "III", "IV")
NODE_COLOURS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#8C8C8C", "#F0E442")

Recordings = Mapping[str, Recording]
AllMetrics = Mapping[str, Metrics]


def run_of(recording: Recording, number: int = ELLIPSE) -> tuple[Array, Mask]:
    """Time [s] from the start of one segment, and the mask of its samples."""
    now = recording["segment"] == number
    time = recording.time[now]
    return (time - time[0] if len(time) else time), now


def ellipse_path(config: Config) -> Array:
    """The desired ellipse as a closed curve (n, 2) [m]."""
    angle = np.linspace(0, 2 * math.pi, 200)[:, None]
    return np.array(config.task.centre) + np.array(config.task.semi_axes) * np.hstack([np.cos(angle), np.sin(angle)])


def stroke_ends(config: Config) -> Array:
    """Both ends of the four strokes, shape (4, 2, 2) [m]."""
    angles = np.radians(config.task.stroke_angles)
    end = np.array(config.task.semi_axes) * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return np.array(config.task.centre) + np.stack([-end, end], axis=1)


def motions_and_nodes(recording: Recording, config: Config) -> Drawing:
    """Fig. 4.1: what is trained, what is drawn afterwards, and where the nodes go."""
    figure, axes = style.subplots(1, 4, height=2.2)
    for start, end in stroke_ends(config):
        axes[0].plot(*np.transpose([start, end]), color=style.BOOK)
    axes[1].plot(*ellipse_path(config).T, color=style.BOOK)
    for panel, text, letter in zip(axes[:2], ("strokes to learn", "ellipse to draw"), "ab"):
        style.panel(panel, letter, text)
        panel.set(xlabel="x [m]", ylabel="y [m]", aspect="equal", xlim=(0.65, 1.35), ylim=(-0.35, 0.35))
    centres = recording.frames["centres"][["dalpha1", "dalpha2"]].to_numpy()
    trained = int(recording["nodes"][recording["segment"] < ELLIPSE][-1])
    for panel, letter, text, nodes, numbers in (
        (axes[2], "c", "inputs, strokes", centres[:trained], range(ELLIPSE)),
        (axes[3], "d", "inputs, ellipse", centres, (ELLIPSE,)),
    ):
        for number in numbers:
            panel.plot(*recording["virtual_acceleration"][recording["segment"] == number].T, color="#555555", lw=0.6)
        for k, centre in enumerate(nodes):
            line = {"edgecolor": style.BOOK if k < trained else style.RIVAL, "linestyle": "-" if k < trained else "--"}
            panel.add_patch(_circle(centre, recording_threshold(config), **line))
            panel.plot(*centre, ".", color=line["edgecolor"], markersize=3)
        style.panel(panel, letter, text)
        panel.set(xlabel=r"$\dot\alpha_1$ [rad/s$^2$]", ylabel=r"$\dot\alpha_2$ [rad/s$^2$]", aspect="equal")
        panel.set(xlim=(-85, 45), ylim=(-65, 65), xticks=(-50, 0), yticks=(-50, 0, 50))
    finding = f"{trained} nodes serve the strokes; the ellipse adds {len(centres) - trained}, for its start"
    return style.title(figure, finding)


def number(value: float | None) -> float:
    """A metric, or infinity where it is absent."""
    return math.inf if value is None else float(value)


def recording_threshold(config: Config) -> float:
    """Theta of the case that is drawn."""
    return float(config.cases["broad20"].law.network.basis.threshold)


def _circle(centre: Array, radius: float, **options: Any) -> Any:
    from matplotlib.patches import Circle

    return Circle(tuple(centre), radius, facecolor="none", linewidth=0.8, **options)


def arm(recording: Recording, config: Config) -> Drawing:
    """Fig. 4.4: the rendered arm with strokes and ellipse at their places."""
    figure, axes = style.subplots(width=style.ONE_COLUMN, height=3.2)
    axes.imshow(recording.images["arm"], extent=(0, 2, -1, 1))
    for start, end in stroke_ends(config):
        axes.plot(*np.transpose([start, end]), color=style.RIVAL, linewidth=1.0)
    axes.plot(*ellipse_path(config).T, **style.LINES["reference"])
    reach = np.radians(np.linspace(-90, 90, 100))
    axes.plot(2 * np.cos(reach), 2 * np.sin(reach), color=style.PLAIN, linewidth=0.8)
    axes.annotate("reach", (1.9, -0.62), size=7, color=style.PLAIN, ha="right")
    axes.annotate("$g$", xy=(1.4, -0.85), xytext=(1.4, -0.55), ha="center", arrowprops={"arrowstyle": "->", "lw": 0.8})
    axes.annotate(
        f"{config.task.force[1]:g} N",
        xy=(1.0, 0.55),
        xytext=(1.0, 0.25),
        ha="center",
        arrowprops={"arrowstyle": "->", "lw": 0.8},
    )
    axes.set(xlabel="x [m]", ylabel="y [m]", xlim=(0, 2), ylim=(-1, 1))
    return style.title(figure, "Every run starts at rest at the centre")


def paths(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawing:
    """Fig. 4.5: the ellipse by three methods, and the four training strokes of the book's."""
    figure, axes = style.subplots(2, 4, height=3.4)
    shown = [case for case in ("rbf2", "rbf_settled", "fuzzy", "broad20") if case in recordings]
    for panel, case in zip(axes[0], shown):
        label, line = METHODS[case]
        _, now = run_of(recordings[case])
        panel.plot(*recordings[case]["tip"][now].T, **{**style.LINES[line], "linestyle": "-", "linewidth": 0.8})
        panel.plot(*ellipse_path(config).T, **style.LINES["reference"])
        panel.set_title(f"{label}: {metrics[case]['steady_rmse_mm']:.1f} mm", fontsize=7)
    ends = stroke_ends(config)
    for k, panel in enumerate(axes[1]):
        _, now = run_of(recordings["broad20"], k)
        panel.plot(*recordings["broad20"]["tip"][now].T, color=style.BOOK, linewidth=0.8)
        panel.plot(*ends[k].T, **style.LINES["reference"])
        panel.set_title(f"stroke {ROMAN[k]}: {metrics['broad20'][f'stroke{k + 1}_rmse_mm']:.1f} mm", fontsize=7)
    for panel in axes.flat:
        panel.set(aspect="equal", xlim=(0.63, 1.37), ylim=(-0.3, 0.3))
    style.edges(axes, "x [m]", "y [m]")
    _, best = min((number(metrics[case]["steady_rmse_mm"]), METHODS[case][0]) for case in shown)
    text = f"Ellipse after training (error: rms of the last 10 s), strokes below; {best} ends nearest"
    return style.title(figure, text)


GROUPS = {"thresholds of the broad network": ("broad20", "broad30", "broad50"),
          "broad network and its rivals": ("broad20", "rbf_settled", "fuzzy", "rbf2")}  # fmt: skip


def envelope(time: Array, size: Array) -> Array:
    """Largest size within 0.25 s before and after each instant."""
    return maximum_filter1d(size, max(round(0.5 / (time[1] - time[0])), 1))


def errors(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawing:
    """Fig. 4.6: the start within the prescribed bound, and the envelope of the error over the whole run."""
    figure, axes = style.subplots(2, 2, height=4.6, sharex="col", sharey="col")
    bound = config.cases["broad20"].law.bound
    shown = [case for case in METHODS if case in recordings]
    for (early, whole), (text, cases), letters in zip(axes, GROUPS.items(), ("ab", "cd")):
        for case in (case for case in cases if case in recordings):
            label, line = METHODS[case]
            time, now = run_of(recordings[case])
            error = 1e3 * recordings[case]["error"][now]
            first = time <= 3.0
            early.plot(time[first], error[first, 1], label=label, **style.LINES[line])
            size = np.maximum(np.linalg.norm(error, axis=1), 1e-3)
            whole.plot(time, envelope(time, size), label=label, **style.LINES[line])
        instants = np.linspace(0, 3.0, 200)
        limit = 1e3 * bound.upper * ((bound.initial - bound.final) * np.exp(-bound.decay * instants) + bound.final)
        style.band(early, instants, -limit, limit, zorder=-5)
        early.set(ylabel="$z_{1,y}$ [mm]", ylim=(-105, 60))
        whole.set(ylabel=r"largest $\|z_1\|$ within 0.5 s [mm]", yscale="log", ylim=(0.2, 400))
        whole.legend(loc="upper right", ncols=2)
        style.panel(early, letters[0], text)
        style.panel(whole, letters[1], "envelope over the run")
    for panel in axes[-1]:
        panel.set_xlabel("Time [s]")
    worst = style.at_most(100 * max(number(metrics[case]["max_usage"]) for case in shown), 0)
    finding = f"Every method stays inside the bound (at most {worst} % of it); they differ in oscillation"
    return style.title(figure, finding)


def node_counts(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawing:
    """Fig. 4.7: nodes over the strokes and the ellipse, with the start of each run enlarged."""
    shown = [case for case in ("broad20", "broad30", "broad50") if case in recordings]
    figure, (top, *bottom) = _count_axes()
    for case in shown:
        recording = recordings[case]
        label, line = METHODS[case]
        runs = recording["segment"] <= ELLIPSE
        top.step(recording.time[runs], recording["nodes"][runs], where="post", label=label, **style.LINES[line])
        for k, panel in enumerate(bottom):
            time, now = run_of(recording, k)
            early = time <= 0.5
            panel.step(time[early], recording["nodes"][now][early], where="post", **style.LINES[line])
    for k in range(ELLIPSE + 1):
        time = recordings[shown[0]].time[recordings[shown[0]]["segment"] == k]
        style.phase(top, time[0], time[-1], f"stroke {ROMAN[k]}" if k < ELLIPSE else "ellipse", _shade(k))
        bottom[k].set(title=ROMAN[k] if k < ELLIPSE else "ellipse", xlabel="Time [s]")
    top.set(ylabel="Nodes [-]", xlabel="Time of strokes and ellipse [s]", ylim=(0, 16), xlim=(0, time[-1]))
    top.legend(loc="upper left", bbox_to_anchor=(0.0, 0.9))
    bottom[0].set(ylabel="Nodes at first [-]", ylim=(0, 16), yticks=(0, 5, 10, 15))
    last = style.at_most(max(number(metrics[case]["last_node_s"]) for case in shown), 2)
    counts = ", ".join(str(metrics[case]["nodes"]) for case in shown)
    finding = f"A smaller threshold gives more nodes ({counts}), the last at most {last} s into the ellipse"
    return style.title(figure, finding)


def _count_axes() -> Any:
    figure = style.plt.figure(figsize=(style.TWO_COLUMNS, 3.8))
    grid = figure.add_gridspec(2, 5)
    top = figure.add_subplot(grid[0, :])
    first = figure.add_subplot(grid[1, 0])
    return figure, (top, first, *(figure.add_subplot(grid[1, k], sharey=first) for k in range(1, 5)))


def _shade(number: int) -> str:
    return "#EAF2F8" if number % 2 == 0 else "#FFFFFF"


def weights(recording: Recording, metrics: Metrics, threshold: int) -> Drawing:
    """Figs. 4.8 to 4.10: weights of the Gaussians, one line a node, over the four strokes."""
    figure, axes = style.subplots(2, 4, height=3.4, sharex=True, sharey="row")
    frame = recording.frames["weights"]
    for row, joint in zip(axes, (1, 2)):
        columns = [name for name in frame.columns if name.startswith(f"joint{joint}_")]
        for number, panel in enumerate(row):
            now = frame["segment"] == number
            for k, name in enumerate(columns):
                values = frame.loc[now, name].to_numpy()
                if np.isfinite(values).any():
                    dashes = ("-", "--", "-.", ":")[k % 4]
                    panel.plot(frame.loc[now, "time"], values, dashes, color=NODE_COLOURS[k % 8], label=f"node {k + 1}")
        row[0].set_ylabel(f"$W$, joint {joint} [N m]")
    for number, panel in enumerate(axes[0]):
        large, nodes = metrics.get(f"stroke{number + 1}_large_weights"), metrics.get(f"stroke{number + 1}_nodes")
        panel.set_title(f"stroke {ROMAN[number]}: {large} of {nodes} large")
        axes[1, number].set_xlabel("Time [s]")
    figure.legend(*axes[0, 3].get_legend_handles_labels(), loc="outside lower center", ncols=8)
    several = (metrics.get("stroke4_nodes") or 0) > 1
    who = "most of the few nodes carry" if several else "the single node carries all"
    return style.title(figure, rf"$\Theta$ = {threshold}: {who} weight, and the weights keep rippling")
