"""What ``barrier_anatomy`` shows: its figures and tables."""

from __future__ import annotations

import numpy as np

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings
from dexrepro.report import style

FIGURES = {
    "6.B": Figure(
        "(a) Share of the barrier in the gain k_n over the distance to the reference, weighted by 1 as in (6.9) and by "
        "the square of the bound H. (b) Largest distance on the map over k_2, tracking gains alone. (c) Largest "
        "distance over the margin. (d) The same over the time step at the printed margin. In (c), (d) a cross in the "
        "law's row above 1 stands for a run that stepped over the barrier, in place of its point. Laws by the "
        "acceleration that (6.13) subtracts: the primitive's own, as printed, recorded. Ours.",
        "The barrier's share of the gain, and largest distances over k_2, the margin and the time step.",
    )
}


WORDS = {
    "consistent": "own acceleration",
    "printed": "as printed (6.15)",
    "feedforward": "recorded acceleration",
    "tau1_printed": r"as printed, $\tau$ = 1 s",
    "tau1_feedforward": r"recorded, $\tau$ = 1 s",
}
TAU1 = (0, (5, 1.5))


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if not {"printed", "feedforward", "tau1_feedforward"} <= set(recordings):
        return {}
    figure, ((a, b), (c, d)) = style.subplots(2, 2, height=4.4)
    for case, line, end in (("feedforward", "-", "duration"), ("tau1_feedforward", TAU1, "1 s")):
        share = recordings[case].frames["share"]
        for weight, colour in (("one", style.REFERENCE), ("h2", style.PLAIN)):
            a.plot(share.gap, share[weight], color=colour, linestyle=line, label=rf"$\tau$ = {end}")
    for weight, text, colour in (("one", "weight 1", style.REFERENCE), ("h2", "weight $H^2$", style.PLAIN)):
        place = metrics["feedforward"][f"half_gap_{weight}"]
        a.annotate(text, (place, 0.5), xytext=(5, -4), textcoords="offset points", color=colour)
    a.set(xscale="log", xlabel="$1-(\\|e\\|/h)^2$ [-]", ylabel="Barrier's share of $k_n$ [-]", ylim=(0, 1.05))
    a.invert_xaxis()
    a.legend(*(part[::2] for part in a.get_legend_handles_labels()), loc="lower right", fontsize=8)
    cases = [case for case in WORDS if case in recordings]
    for row, case in enumerate(reversed(cases)):
        frames, law = recordings[case].frames, config.cases[case].cdmp.law
        role = {"consistent": "extra1", "printed": "printed"}.get(law, "book")
        look = {"color": style.LINES[role]["color"], "linestyle": TAU1 if config.cases[case].dmp.tau else "-"}
        if law != "consistent":
            b.plot(frames["k2"]["k2"], frames["k2"].e_max, marker=".", **look)
        for axes, name, scale in ((c, "margin", 1), (d, "step", 1e3)):
            frame = frames[name]
            kept = frame.defined.astype(bool)
            used = (frame.e_max / (frame.margin if name == "margin" else config.cases[case].cdmp.margin)).where(kept)
            axes.plot(scale * frame[name], used, marker=".", label=WORDS[case], **look)
            height = np.full(int((~kept).sum()), 1.1 + 0.08 * row)
            axes.plot(scale * frame[name][~kept], height, "x", color=look["color"], markersize=4)
            axes.plot(scale * frame[name], np.full(len(frame), 1.1 + 0.08 * row), linewidth=0.5, **look)
    for axes in (c, d):
        axes.axhline(1, **style.LINES["reference"])
        axes.set(ylabel="Largest distance / h [-]", ylim=(0, 1.5), yticks=(0, 0.5, 1))
    b.set(xscale="log", yscale="log", xlabel="$k_2$ [1/s]", ylabel="Largest distance [cm]", ylim=(0.05, 2))
    c.set(xlabel="Margin h [cm]")
    d.set(xlabel="Time step [ms]", xscale="log")
    for axes, ticks in ((b, config.sweep.k2), (d, [1e3 * step for step in config.sweep.step])):
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.minorticks_off()
    b.set_yticks((0.1, 0.5, 1), ("0.1", "0.5", "1"))
    d.plot([], [], "x", color=style.REFERENCE, markersize=4, label="stepped over the barrier")
    handles = dict(zip(*reversed(d.get_legend_handles_labels())))
    figure.legend(handles.values(), handles, loc="outside lower center", ncols=3, fontsize=8, columnspacing=1.5)
    style.panels((a, b, c, d), "who brakes", "gain $k_2$, no barrier", "margin", "time step")
    gap = float(metrics["feedforward"]["half_gap_one"] or np.nan)
    power = int(np.floor(np.log10(gap)))
    near = rf"$1 - (e/h)^2 < {style.at_most(gap / 10.0**power, 1)} \cdot 10^{{{power}}}$"
    return {"6.B": style.title(figure, f"The printed barrier outweighs $k_2$ only where {near}")}
