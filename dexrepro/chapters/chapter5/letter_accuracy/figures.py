"""What ``letter_accuracy`` shows: its figures and tables."""

from __future__ import annotations

from typing import Any

import pandas as pd

from dexrepro.experiment import AllMetrics, Config, Drawing, Drawings, Figure, Metrics, Recording, Recordings
from dexrepro.report import style

from .experiment import METHODS

FIGURES = {
    "5.3": Figure(
        "An A by a synthetic hand (dashed) and what DMP, DMP+ and IDMP make of it with the same random kernels, 5 "
        "above, 20 below, for the draw with the median error of the DMP; as in the book. Right: mean squared error "
        "over draws of the kernels (box: quartiles, whiskers: all draws).",
        "A letter and what three methods make of it with two numbers of kernels, with boxes of their errors.",
    ),
    "5.A": Figure(
        "Mean squared error of the IDMP against the number of added features (median and 10 to 90 % of the draws), "
        "with DMP and DMP+ on the same kernels and on as many free parameters as the largest IDMP. Ours; the book does "
        "not print how many features it adds.",
        "Error of the IDMP over the number of added features, with lines for the DMP and the DMP+ of two sizes.",
    ),
}
TABLES = {
    "T5.A": "Mean squared error [cm^2] over random kernels: median, 90 % quantile, deviation from the goal afterwards",
    "T5.B": "Share of the draws in which one method is better than another [%]",
    "T5.S": "Sensitivity of the order of methods to what the book does not print: share of the draws in which it holds",
}


def draw(recordings: Recordings, metrics: AllMetrics, config: Config) -> Drawings:
    if "default" not in recordings:
        return {}
    recording, found = recordings["default"], metrics["default"]
    return {"5.3": _draw_paths(recording, found, config), "5.A": _draw_features(recording, found, config)}


def _draw_paths(recording: Recording, metrics: Metrics, config: Config) -> Drawing:
    lines = {"dmp": "plain", "dmp_plus": "rival", "idmp": "book"}
    most, counts = max(config.features.counts), config.kernels.counts
    figure, grid = style.subplots(2, 4, height=4.1, squeeze=False)
    paths, draws = recording.frames["paths"], recording.frames["draws"]
    letter = iter("abcdef")
    for row, count in zip(grid, counts):
        for axes, (method, name) in zip(row, METHODS.items()):
            path = paths[(paths.kernels == count) & (paths.method == method)]
            axes.plot(path.x, path.y, **style.LINES[lines[method]])
            axes.plot(path.x_d, path.y_d, **style.LINES["reference"])
            style.panel(axes, next(letter), f"{name}: {_power(path.mse.iloc[0])} cm²")
            axes.set(aspect="equal", xlabel="x [cm]")
            if not config.demonstrations:
                axes.set(xlim=(-0.5, 4.5), ylim=(-0.6, 4.6))
        row[0].set_ylabel(f"{count} kernels\ny [cm]")
        names = ["dmp", "dmp_plus", f"idmp{most}"]
        values = [draws[(draws.kernels == count) & (draws.method == name)].mse for name in names]
        boxes = row[3].boxplot(values, whis=(0, 100), widths=0.6, patch_artist=True, medianprops={"color": "black"})
        for box, method in zip(boxes["boxes"], METHODS):
            box.set(facecolor=style.LINES[lines[method]]["color"], alpha=0.6, linewidth=0.6)
        row[3].set(yscale="log", ylabel="MSE [cm²]", ylim=None if config.demonstrations else (1e-6, 5))
        row[3].set_xticks([1, 2, 3], METHODS.values())
        row[3].set_title(f"{config.kernels.draws} draws")
    shares = " and ".join(f"{100 * metrics[f'n{count}.ordered']:.0f} %" for count in counts)  # type: ignore[operator]
    return style.title(figure, f"IDMP ({most} added features) beats DMP+, DMP+ beats DMP: in {shares} of the draws")


def _power(value: float) -> str:
    digits, power = f"{value:.1e}".split("e")
    return rf"{digits}·10$^{{{int(power)}}}$"


def _draw_features(recording: Recording, metrics: Metrics, config: Config) -> Drawing:
    draws, added = recording.frames["draws"], config.features.counts
    figure, axes = style.subplots(1, len(config.kernels.counts), height=2.8, sharey=True, squeeze=False)
    for panel, count in zip(axes[0], config.kernels.counts):
        part = draws[draws.kernels == count].pivot(index="draw", columns="method", values="mse")
        errors = part[[f"idmp{m}" for m in added]]
        style.band(panel, added, errors.quantile(0.1), errors.quantile(0.9))
        panel.plot(added, errors.median(), marker="o", markersize=3, label="IDMP", **style.LINES["book"])
        for method, name, line in (
            ("dmp", "DMP, same kernels", "plain"),
            ("dmp_plus", "DMP+, same kernels", "rival"),
            ("dmp_equal", "DMP, as many weights", "extra2"),
            ("dmp_plus_equal", "DMP+, as many weights", "extra1"),
        ):
            panel.axhline(part[method].median(), label=name, **style.LINES[line])
        panel.set(yscale="log", xlabel="Added features m [-]")
        panel.set_title(f"{count} kernels")
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    axes[0, 0].set(ylabel="MSE [cm²]", ylim=None if config.demonstrations else (5e-6, 3))
    last = config.kernels.counts[-1]
    better = [m for m in added if (metrics[f"n{last}.idmp{m}.beats_dmp_plus"] or 0) > 0.5]
    text = f"With {last} kernels, {min(better)} added features beat the DMP+" if better else "The DMP+ stays ahead"
    best = f"idmp{max(added)}.beats_dmp_plus_equal"
    shares = " and ".join(f"{100 * (metrics[f'n{count}.{best}'] or 0):.0f} %" for count in config.kernels.counts)
    return style.title(figure, f"{text}; a DMP+ with as many weights is beaten in {shares} of the draws")


def tabulate(recordings: Recordings, metrics: AllMetrics, config: Config) -> dict[str, Any]:
    tables = {}
    if "default" in recordings:
        tables["T5.A"] = _errors_table(recordings["default"].frames["draws"])
        tables["T5.B"] = _shares_table(metrics["default"], config)
    columns = {
        "dmp_plus.beats_dmp": "DMP+ better than DMP [%]",
        "idmp30.beats_dmp_plus": "IDMP, m = 30, better than DMP+ [%]",
        "idmp60.beats_dmp_plus": "IDMP, m = 60, better than DMP+ [%]",
        "ordered": "IDMP better than DMP+ better than DMP [%]",
        "idmp60.after": "IDMP, m = 60: distance from goal after T [cm]",
    }
    scales = {"idmp60.after": 1.0}
    rows = [
        {"variant": case, "kernels": count}
        | {text: _scaled(values.get(f"n{count}.{key}"), scales.get(key, 100.0)) for key, text in columns.items()}
        for case, values in metrics.items()
        if case in recordings
        for count in config.kernels.counts
    ]
    tables["T5.S"] = pd.DataFrame(rows)
    return tables


def _scaled(value: float | int | None, factor: float) -> float | None:
    return None if value is None else factor * value


def _errors_table(draws: pd.DataFrame) -> pd.DataFrame:
    groups = draws.groupby(["kernels", "method"], sort=False)
    quantile = groups.mse.quantile(0.9).rename("90 % quantile [cm^2]")
    return pd.concat(
        [
            groups.mse.median().rename("median MSE [cm^2]"),
            quantile,
            groups.after.median().rename("median distance from goal after T [cm]"),
            groups.weight.median().map("{:.0e}".format).rename("largest weight (median)"),
        ],
        axis=1,
    ).reset_index()


def _shares_table(metrics: Metrics, config: Config) -> pd.DataFrame:
    best = f"idmp{max(config.features.counts)}"
    names = {
        "dmp_plus.beats_dmp": "DMP+ better than DMP",
        **{f"idmp{m}.beats_dmp_plus": f"IDMP, m = {m}, better than DMP+" for m in config.features.counts},
        "ordered": "IDMP better than DMP+ better than DMP",
        f"{best}.beats_dmp_equal": "IDMP better than a DMP of equal size",
        f"{best}.beats_dmp_plus_equal": "IDMP better than a DMP+ of equal size",
    }
    return pd.DataFrame(
        {"comparison": text}
        | {f"{n} kernels": _scaled(metrics.get(f"n{n}.{key}"), 100.0) for n in config.kernels.counts}
        for key, text in names.items()
    )
