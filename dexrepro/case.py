"""One case: from its configuration to a recording and its metrics. What stands here belongs to every case's key."""

from __future__ import annotations

import importlib
import inspect
import json
import re
import time
import zlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import chdir
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np

from dexrepro.checks import leaves, returned, returned_numbers
from dexrepro.errors import InputError
from dexrepro.experiment import Config, Experiment, Metrics, Recording
from dexrepro.storage import finite

LIBRARY = ("control", "networks", "primitives", "robots", "physics", "humans", "vision", r"chapters\.\w+")


def generator(seed: int, experiment: str, purpose: str) -> np.random.Generator:
    """The random numbers of one purpose: the same in all cases of an experiment."""
    entropy = [seed, zlib.crc32(experiment.encode()), zlib.crc32(purpose.encode())]
    return np.random.default_rng(np.random.SeedSequence(entropy))


def run(experiment: Experiment, config: Config, seed: int) -> tuple[Recording, Metrics, float]:
    """Recording at the full rate, metrics, and the wall time of the simulation [s]."""
    start = time.perf_counter()
    recording = experiment.simulation.simulate(config, lambda purpose: generator(seed, experiment.name, purpose))
    wall = time.perf_counter() - start
    return recording, experiment.simulation.measure(recording, config), wall


def watched(experiment: Experiment, ends: list[str]) -> Experiment:
    """The same, but what its functions give is checked, and how its simulations end is added to ``ends``."""
    module, result = experiment.simulation, replace(experiment)

    def simulate(*given: Any) -> Recording:
        from dexrepro.physics.loop import law_failure

        must = "a Recording, such as world.run gives"
        try:
            recording: Recording = returned(module.simulate(*given), "experiment.py: simulate", must, Recording)
        except Exception as error:
            if failure := law_failure(error):
                raise failure from error
            raise
        ends.append(recording.status)
        return recording

    def measure(*given: Any) -> Metrics:
        return dict(returned_numbers(module.measure(*given), "experiment.py: measure"))

    vars(result)["simulation"] = SimpleNamespace(simulate=simulate, measure=measure)
    return result


def measured(experiment: Experiment, config: Mapping[str, Any]) -> Metrics:
    """Metrics of a case whose configuration says all, its seed and engine too; no picture is made."""
    from dexrepro.physics import engine

    engine.use(config.get("engine", engine.REFERENCE))
    with chdir("."), engine.unseen():  # a law may go elsewhere
        return finite(run(watched(experiment, []), live(config), config["seed"])[1])


def live(config: Mapping[str, Any]) -> Config:
    """A configuration whose ``_target_`` nodes are objects; InputError says why one cannot be made."""
    from hydra.utils import instantiate

    if "_target_" in json.dumps(finite(config), default=str):
        try:
            config = instantiate(dict(config), _convert_="all")
        except Exception as error:
            cause: BaseException = error
            while cause.__cause__ is not None:
                cause = cause.__cause__
            text = " ".join(str(cause).split())
            if isinstance(cause, LookupError | AttributeError | TypeError):  # these say little by themselves
                text = f"{type(cause).__name__}: {text}"
            where = re.search(r"full_key: (\S+)", str(error))
            key = f" ({where[1]})" if where else ""
            raise InputError(f"cannot build the objects of the configuration{key}: {text}") from error
    return Config.of(config)


def targets(config: Any) -> Iterator[str]:
    """What a configuration names as ``_target_``, or hands to Hydra's own look-ups as ``path``."""
    for key, text in leaves(config):
        if key.rpartition(".")[2] in ("_target_", "path") and re.fullmatch(r"\w+(\.\w+)+", str(text)):
            yield text


def refuse_foreign(config: Any, where: str, allowed: Callable[[str], bool]) -> None:
    """Refuse to build what the library does not define: a result of somebody else is data, never code.

    Raises InputError that names the first ``_target_`` that is neither a class or function of the library nor allowed.
    """
    for key, value in leaves(config):
        if key.rpartition(".")[2] != "_target_":
            continue
        if not isinstance(value, str) or not (of_library(value) or allowed(value)):
            raise InputError(
                f"{where} names {value} under {key}, which is not part of this package and was not run; if you trust "
                f"it, say so: allow={str(value).partition('.')[0]}"
            )


def of_library(text: str) -> bool:
    """Whether a target is a class or function that a module of the library defines (not one that it imports)."""
    module, _, name = text.rpartition(".")
    if not re.match(rf"dexrepro\.({'|'.join(LIBRARY)})\.", text) or name.startswith("_"):
        return False
    try:
        found = getattr(importlib.import_module(module), name)
    except (ImportError, AttributeError):
        return False
    home = str(getattr(found, "__module__", ""))
    return (inspect.isclass(found) or inspect.isfunction(found)) and home.startswith("dexrepro.")
