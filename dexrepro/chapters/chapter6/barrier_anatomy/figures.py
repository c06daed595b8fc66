"""What ``barrier_anatomy`` shows: its figures and tables."""

from __future__ import annotations

import numpy as np

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings

FIGURES = {
    "6.B": Figure(
        "(a) Share of the barrier in the gain k_n over the distance to the reference. (b) Largest distance on the map "
        "over k_2, tracking gains alone. (c) Largest distance over the margin; a cross marks a run that stepped over "
        "the barrier. (d) The same over the time step at the printed margin. Ours.",
        "The barrier's share of the gain, and largest distances over k_2, the margin and the time step.",
    ),
}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if not {"printed", "feedforward", "tau1_feedforward"} <= set(recordings):
        return {}
    from dexrepro.report import style

    figure, ((a, b), (c, d)) = style.subplots(2, 2, height=4.2)
    for case, tau, line in (("feedforward", "duration", "book"), ("tau1_feedforward", "1 s", "extra1")):
        share = recordings[case].frames["share"]
        a.plot(share.gap, share.one, label=rf"weight 1, $\tau$ = {tau}", **style.LINES[line])
        a.plot(
            share.gap, share.h2, color=style.LINES[line]["color"], linestyle=":", label=rf"weight $H^2$, $\tau$ = {tau}"
        )
    a.set(xscale="log", xlabel="$1-(\\|e\\|/h)^2$ [-]", ylabel="Barrier's share of $k_n$ [-]")
    a.invert_xaxis()
    a.set(ylim=(0, 1.75), yticks=(0, 0.5, 1))
    a.legend(fontsize=6.5, ncols=2, loc="upper center", columnspacing=1)
    lines = {
        "consistent": ("consistent", "extra1"),
        "printed": ("printed", "printed"),
        "feedforward": ("feedforward", "book"),
        "tau1_printed": (r"$\tau$ = 1 s, printed", "extra2"),
        "tau1_feedforward": (r"$\tau$ = 1 s, feedforward", "extra3"),
    }
    for case, (label, line) in lines.items():
        if case not in recordings:
            continue
        frames = recordings[case].frames
        if config.cases[case].cdmp.law != "consistent":
            b.plot(frames["k2"]["k2"], frames["k2"].e_max, label=label, **style.LINES[line])
        for axes, name, x in ((c, "margin", "margin"), (d, "step", "step")):
            frame = frames[name]
            limit = frame.margin if name == "margin" else config.cases[case].cdmp.margin
            scale = 1e3 if name == "step" else 1
            axes.plot(scale * frame[x], frame.e_max / limit, label=label, **style.LINES[line])
            lost = frame[~frame.defined.astype(bool)]
            far = lost.e_max / (lost.margin if name == "margin" else limit)
            axes.plot(scale * lost[x], far, "x", color="black", markersize=4)
    b.set(xscale="log", yscale="log", xlabel="$k_2$ [1/s]", ylabel="Largest distance [cm]")
    c.set(xlabel="Margin h [cm]", ylabel="Largest distance / h [-]", ylim=(0, 1.2))
    d.set(xlabel="Time step [ms]", ylabel="Largest distance / h [-]", ylim=(0, 1.2), xscale="log")
    d.plot([], [], "x", color="black", markersize=4, label="stepped over")
    figure.legend(*d.get_legend_handles_labels(), loc="outside lower center", ncols=6, columnspacing=1.2)
    for letter, axes, text in zip(
        "abcd", (a, b, c, d), ("who brakes", "gain $k_2$, no barrier", "margin", "time step")
    ):
        style.panel(axes, letter, text)
    gap = metrics["feedforward"]["half_gap_one"]
    style.title(
        figure,
        rf"The printed barrier outweighs $k_2$ only where $1 - (e/h)^2 < 10^{{{np.log10(float(gap or np.nan)):.0f}}}$",
    )
    return {"6.B": figure}
