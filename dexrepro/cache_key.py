"""What a result depends on: values, code, the files of the user; where none of it has changed, nothing runs again."""

from __future__ import annotations

import glob
import os
import uuid
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from dexrepro import closure
from dexrepro.case import targets
from dexrepro.checks import FILES, leaves
from dexrepro.experiment import Experiment
from dexrepro.own_code import file_digest, own_modules
from dexrepro.physics.engine import REFERENCE
from dexrepro.storage import digest_of

ENGINE = "dexrepro.physics.engine", "engine"  # what every scene and model is made by
READERS = (("dexrepro.chapters.demonstrations", "recorded"), ("dexrepro.chapters.demonstrations", "corners"),
           ("dexrepro.primitives.recorded", "read_path"))  # fmt: skip


def content_of(experiment: Experiment, values: Mapping[str, Any], own: str | None = None) -> str:
    """What the numbers of a case depend on but for the versions of packages: values, code, and files of the user."""
    return digest_of([experiment.name, values, own or own_digest(values), code_digest(experiment, values)])


def code_digest(experiment: Experiment, values: Mapping[str, Any]) -> str:
    """Hash of the code of this package that a case uses: its simulation and the laws that its values name; of what
    reads files of the user only where the values name one."""
    named = frozenset(text for text in targets(values) if text.startswith("dexrepro."))
    reads = any(isinstance(text, str) and {*FILES} & {*key.split(".")} for key, text in leaves(values))
    return package_digest(experiment.package, named, values.get("engine", REFERENCE), reads)


@lru_cache(maxsize=256)  # emptied before each planning: a session may edit files
def package_digest(package: str, named: frozenset[str], engine: str, reads: bool) -> str:
    """The same by the package of the experiment and the classes of ours that the values name."""
    roots = [(f"{package}.experiment", name) for name in ("simulate", "measure", "RATE")]
    roots += [("dexrepro.case", "run"), ("dexrepro.case", "live"), ("dexrepro.recordings", "save_recording")]
    roots += map(closure.target, named)
    engines = [(f"dexrepro.physics.engines.{engine}", "")] if closure.reaches(roots, ENGINE) else []
    return closure.digest([*roots, *engines], () if reads else READERS)


@lru_cache(maxsize=256)
def uses_engine(experiment: Experiment) -> bool:
    """Whether an experiment simulates arms."""
    return closure.reaches([(f"{experiment.package}.experiment", name) for name in ("simulate", "measure")], ENGINE)


def own_digest(values: Mapping[str, Any]) -> str:
    """Hash of the user's files that a configuration names: data, and modules of classes with what is beside them.

    What a class of a notebook or script (``__main__``) does, no file tells: it is never the same again.
    """
    paths = own_modules(values)
    for key, text in leaves(values):
        if not isinstance(text, str) or key.rpartition(".")[2] == "_target_":
            continue
        if "." in text or {*FILES} & {*key.split(".")}:
            name = os.path.expanduser(text)
            paths.update(path for found in (name, *glob.glob(name)) if (path := Path(found)).is_file())
    if any(text.startswith("__main__.") for text in targets(values)):
        return uuid.uuid4().hex
    return digest_of([[str(path), file_digest(path)] for path in sorted(paths)])


def presentation(experiment: Experiment) -> str:
    """Hash of the code that makes claims, tables and figures of the numbers of an experiment."""
    roots = [(f"{experiment.package}.{part}", "") for part in ("figures", "claims")]
    roots += [(f"{experiment.package}.experiment", "summarise"), ("dexrepro.report.style", "")]
    return closure.digest([*roots, *(("dexrepro.result", name) for name in ("present", "summarise", "flat"))])
