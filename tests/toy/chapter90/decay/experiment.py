"""Something decays."""

import ctypes
import os
import shutil
import signal
import sys
import threading
import time

import numpy as np

from dexrepro.experiment import Recording


class Unpicklable(Exception):
    def __init__(self, one, two):
        super().__init__("cannot travel")
        self.what = lambda: (one, two)


def unpicklable():
    raise Unpicklable(1, 2)


def surrogate():
    raise ValueError("a letter \udcff that is none")


def crash_once():
    if not os.path.exists("crashed"):
        open("crashed", "w").close()
        os.abort()


def interrupt():
    raise KeyboardInterrupt


def fork():
    if os.fork() == 0:
        time.sleep(3600)


def forever():
    while True:
        time.sleep(0.1)


FAULTS = {
    "kill": lambda: os.kill(os.getpid(), signal.SIGKILL),
    "term": lambda: os.kill(os.getpid(), signal.SIGTERM),
    "abort": os.abort,
    "segv": lambda: ctypes.string_at(0),
    "exit": lambda: os._exit(3),
    "leave": lambda: sys.exit(4),
    "interrupt": interrupt,
    "unpicklable": unpicklable,
    "surrogate": surrogate,
    "crash_once": crash_once,
    "recursion": lambda: FAULTS["recursion"](),
    "thread": lambda: threading.Thread(target=forever).start(),
    "fork": fork,
    "fork_on": os.fork,  # and the child simulates on
    "close": lambda: os.closerange(3, 64),
    "elsewhere": lambda: os.chdir("/"),
    "delete": lambda: shutil.rmtree("results"),
    "say": lambda: print("a letter \udcff that is none", file=sys.stderr),
    "mute": lambda: (sys.stdout.close(), os.close(2)),
    "mask": lambda: os.umask(0o777),
    "forever": forever,
    "deaf": lambda: (signal.signal(signal.SIGTERM, signal.SIG_IGN), forever()),
}


def simulate(config, rng):
    if config.pause:
        time.sleep(config.pause)
    if config.fail == "at once":
        return Recording(status="undefined from 0 s")
    if config.fail in FAULTS:
        FAULTS[config.fail]()
    elif config.fail:
        raise ValueError("told to fail")
    instants = np.arange(round(config.duration / config.step)) * config.step
    values = (config.start + config.perturbation) * np.exp(-config.rate * instants) * float(config.law) * config.gain
    noisy = values + config.noise * rng("noise").standard_normal(len(instants))
    pair = np.column_stack([noisy, -noisy])
    return Recording({"time": instants, "x": noisy, "pair": pair}, steps=len(instants), simulated=config.duration)


def measure(recording, config):
    if not recording.series:
        return {"final": np.nan}
    return {
        "final": recording["x"][-1],
        "largest": recording["x"].max(),
        "samples": len(recording.time),
        "none": np.nan,
    }


def summarise(metrics, config):
    return {"ratio": metrics["plain"]["final"] / metrics["fast"]["final"]}
