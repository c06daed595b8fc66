"""Something decays."""

import os
import signal
import time

import numpy as np
import pandas as pd

from dexrepro.experiment import Figure, Recording

FIGURES = {"90.10": Figure("simulated decay", "a falling curve")}
TABLES = {"T90.1": "final values"}


def simulate(config, rng):
    if config.pause:
        time.sleep(config.pause)
    if config.fail == "kill":
        os.kill(os.getpid(), signal.SIGKILL)
    if config.fail:
        raise ValueError("told to fail")
    instants = np.arange(round(config.duration / config.step)) * config.step
    values = (config.start + config.perturbation) * np.exp(-config.rate * instants) * float(config.law) * config.gain
    noisy = values + config.noise * rng("noise").standard_normal(len(instants))
    pair = np.column_stack([noisy, -noisy])
    return Recording({"time": instants, "x": noisy, "pair": pair}, steps=len(instants), simulated=config.duration)


def measure(recording, config):
    return {
        "final": recording["x"][-1],
        "largest": recording["x"].max(),
        "samples": len(recording.time),
        "none": np.nan,
    }


def summarise(metrics, config):
    return {"ratio": metrics["plain"]["final"] / metrics["fast"]["final"]}


def draw(recordings, metrics, config):
    from dexrepro.report import style

    figure, axes = style.subplots()
    for case, recording in recordings.items():
        axes.plot(recording.time, recording["x"], label=case)
    return {"90.10": figure}


def tabulate(recordings, metrics, config):
    return {"T90.1": pd.DataFrame({"case": list(recordings), "final": [metrics[c]["final"] for c in recordings]})}
