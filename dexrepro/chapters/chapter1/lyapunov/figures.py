"""What ``lyapunov`` shows: its figures and tables."""

from __future__ import annotations

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Recordings
from dexrepro.report import style

FIGURES = {
    "1.D": Figure(
        "Left: V of Eq. (1.34) on the ramp of case 1, steps of {.step:g} s, for the law that knows z_d, the "
        "law that can be built and the printed definition of e_f. Right: how the force error develops over "
        "{.long:g} s for estimator gains L around the bound of Routh's condition. Neither is in the book.",
        "V over time for three forms of the law, and force errors over time for several gains L.",
    )
}
UNITS = {"lyapunov": "1", "error": "N"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if not {"ideal", "built", "printed", "growth"} <= set(recordings):
        return {}
    figure, (left, right) = style.subplots(1, 2, height=2.4)
    for case, role in (("ideal", "book"), ("built", "rival"), ("printed", "printed")):
        recording = recordings[case]
        left.semilogy(recording.time, recording["lyapunov"], label=case, **style.LINES[role])
    left.set(xlabel="Time [s]", ylabel="$V$ [-]", ylim=(1e-2, 1e4), xlim=(0, 6))
    left.legend(loc="upper right")
    frame = recordings["growth"].frames["growth"]
    for column, role in zip(frame.columns[1:], ("printed", "extra1", "rival", "extra3", "plain", "book")):
        right.semilogy(frame["time"], frame[column], label=f"L = {column}/s", **style.LINES[role])
    right.set(xlabel="Time [s]", ylabel="Force error, largest\nof 10 s [N]", ylim=(1e-3, 1e3))
    right.legend(loc="lower left", ncols=2)
    share = 100 * (metrics["built"]["rising"] or 0)
    style.title(
        figure,
        f"$V$ falls at every step only if $z_d$ is known; the law as built lets it rise {share:.0f} % of the time",
    )
    return {"1.D": figure}
