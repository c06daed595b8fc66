"""What ``sensitivity`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawings, Figure, Metrics, Recordings
from dexrepro.report import style

from .experiment import DELAYS

FIGURES = {
    "1.E": Figure(
        "RMS force error after the 8th second of the first trajectory of Fig. 1.18 on the holding line, over the "
        "object's stiffness, for 0 to 2 late force samples: the printed gains and the best of twelve gains of each law "
        "for the nominal object. Our own test.",
        "With the printed gain one late sample or a stiff object is enough for the proposed law to lose.",
    )
}
TABLES = {"T1.S": "Variants that change a verdict", "T1.H": "Gains tried for each law and the force error they give"}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if "carrying" not in recordings:
        return {}
    variants = recordings["carrying"].frames["variants"]
    variants = variants[variants["gain"].isna()]
    figure, axes = style.subplots(1, len(DELAYS), height=2.5, sharey=True)
    roles = {"proposed": "book", "proposed, own gain": "extra3", "passive, own gain": "rival", "fixed": "plain"}
    for axis, delay in zip(axes, DELAYS):
        for law, role in roles.items():
            rows = variants[(variants["law"] == law) & (variants["delay"] == delay)]
            axis.loglog(rows["stiffness"], rows["rmse"], marker=".", markersize=3, label=law, **style.LINES[role])
        axis.set(xlabel="Object stiffness [N/m]", title=f"{delay} late sample{'s' * (delay != 1)}", ylim=(0.1, 100))
        axis.set_xticks((50, 100, 200, 600), ("50", "100", "200", "600"))
        axis.minorticks_off()
    axes[0].set_ylabel("RMS force error [N]")
    axes[0].legend(loc="upper left", fontsize=6.5)
    printed, best = (variants[variants["law"] == law].set_index(["stiffness", "delay"])["rmse"]
                     for law in ("proposed", "passive, own gain"))  # fmt: skip
    won = [int((printed - best < 0).xs(delay, level="delay").sum()) for delay in DELAYS]
    times, objects = ", ".join(map(str, DELAYS)), f"{', '.join(map(str, won))} of {len(printed) // len(DELAYS)} objects"
    finding = f"With {times} late samples the printed gain beats the best impedance for {objects}"
    return {"1.E": style.title(figure, finding)}


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, pd.DataFrame]:
    if not {"tracking", "carrying"} <= set(recordings):
        return {}
    rows = _flips(metrics["tracking"], metrics["carrying"])
    tracking = recordings["tracking"].frames["variants"]
    tried = tracking[tracking["variant"].str.startswith("tuning")].assign(figure="1.10")
    tried["law"], tried["gain"] = (tried["variant"].str.split().str[k] for k in (1, 2))
    tried["rmse"] = tried[["c1", "c2", "c3"]].mean(axis=1)
    carrying = recordings["carrying"].frames["variants"].dropna(subset="gain").assign(figure="1.18")
    carrying["law"] = carrying["law"].str.split().str[1]
    columns = ["figure", "law", "gain", "rmse"]
    return {
        "T1.S": pd.DataFrame(rows),
        "T1.H": pd.concat([tried[columns], carrying[columns]]).rename(columns={"rmse": "RMS force error [N]"}),
    }


def _flips(t: Metrics, c: Metrics) -> list[dict[str, Any]]:
    """Rows of T1.S: what is varied, the claim, the two errors that decide it, and the verdict then."""

    def row(claim: str, variant: str, own: Any, other: Any, what: str) -> dict[str, Any]:
        return {"claim": claim, "variant": variant, "rival": what, "RMS force error, proposed [N]": own,
                "RMS force error, rival [N]": other, "claim holds": "yes" if own < other else "no"}  # fmt: skip

    compared = (
        ("as printed", "proposed_c", "force_c", "force"),
        ("equal gains of 0.05", "equal_c", "force_c", "force"),
        ("equal gains of 0.05, after 5 s", "equal_late", "force_late", "force"),
        ("force gain 0.5", "proposed_c", "fast_force_c", "force"),
        ("critically damped", "proposed_c", "critical_c", "passive"),
    )
    rows = [
        row("C1.01", f"case {i}, {variant}", t[f"{own}{i}"], t[f"{other}{i}"], rival)
        for variant, own, other, rival in compared
        for i in (1, 2, 3)
    ]
    rows += [row("C1.01", "case 1, follower lags 0.2 s", t["lagging_c1"], t["force_c1"], "force")]
    rows += [
        row("C1.26", f"case {i}, whole run", t[f"proposed_c{i}"], t[f"proportional_c{i}"], "proportional")
        for i in (1, 2, 3)
    ]
    rows += [
        row("C1.23", f"{k} N/m, {d} late", c[f"proposed_k{k}_d{d}"], c[f"passive_own_k{k}_d{d}"], "passive, own gain")
        for k in (50, 100, 200, 600)
        for d in (0, 1, 2)
    ]
    rows += [
        row("C1.23", "100 N/m, both tuned", c["proposed_own_k100_d0"], c["passive_own_k100_d0"], "passive"),
        row("C1.23", "100 N/m, proportional law, gain 0.05", c["proposed_k100_d0"], c["proportional_k100_d0"],
            "proportional"),
    ]  # fmt: skip
    return rows
