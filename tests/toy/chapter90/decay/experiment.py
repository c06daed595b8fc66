"""Something decays."""

import os
import signal
import time

import numpy as np

from dexrepro.experiment import Recording


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
