"""Jobs of a sweep, handed to a Hydra launcher: here, on Ray or on Slurm."""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Callable, Sequence
from typing import Any

import hydra
from hydra.core.hydra_config import HydraConfig
from hydra.errors import HydraException
from omegaconf.errors import OmegaConfBaseException

from dexrepro.config import config_dir
from dexrepro.errors import COMPLETES, InputError, folder_named, one_line
from dexrepro.overrides import in_quotes

PLUGINS = {  # by launcher: the package that has it, and the extra that brings it
    "ray": ("hydra_plugins.hydra_ray_launcher", "ray"),
    "submitit_local": ("hydra_plugins.hydra_submitit_launcher", "slurm"),
    "submitit_slurm": ("hydra_plugins.hydra_submitit_launcher", "slurm"),
}


class JobFailed(Exception):
    """A job of a sweep did not do its work; the message is one sentence that says why."""


def launch(arguments: Sequence[str], job: Callable[[Any], None]) -> None:
    """Give Hydra its arguments and wait for its jobs. Raises JobFailed for the first job that failed or died."""
    overrides = [text for text in arguments if text.startswith("~") or ("=" in text and not text.startswith("-"))]
    flags = [text for text in arguments if text not in overrides]  # Hydra wants them first
    values = dict(text.partition("=")[::2] for text in overrides)
    plugin, extra = PLUGINS.get(values.get("hydra/launcher", ""), ("", ""))
    if extra and importlib.util.find_spec(plugin) is None:
        raise InputError(f"hydra/launcher={values['hydra/launcher']} needs: pip install 'dexrepro[{extra}]'")
    results = folder_named(values.get("results", "results").strip("'\""))
    sweep = in_quotes(str((results / ".sweep").absolute()))
    sys.argv = ["dexrepro run", *flags, f"hydra.sweep.dir={sweep}", *overrides]
    os.environ["HYDRA_FULL_ERROR"] = "1"  # Hydra raises instead of printing a traceback
    try:
        hydra.main(str(config_dir().resolve()), "config", version_base="1.3")(job)()
    except (InputError, JobFailed):
        raise
    except (HydraException, OmegaConfBaseException, ValueError, FileNotFoundError, PermissionError) as error:
        raise InputError(one_line(error)) from error
    except Exception as error:  # each launcher has its own for a process that is gone
        reason = f"{type(error).__name__}: {str(error).strip().partition(chr(10))[0]}"
        raise JobFailed(f"its process died; {COMPLETES} ({reason})") from error


def enter_launch_folder() -> None:
    """Work where the sweep was started, the user's own classes in reach, wherever the launcher put this process."""
    os.chdir(HydraConfig.get().runtime.cwd)
    if "" not in sys.path:
        sys.path.append("")


def job_overrides() -> tuple[list[str], str | None]:
    """Overrides of the job that this process is, with one worker as default, and its extra configuration folder."""
    settings = HydraConfig.get()
    chapter = settings.runtime.choices.get("chapter")
    overrides = [text for text in settings.overrides.task if not text.startswith("chapter=")]
    selected = [f"chapter='{chapter}'"] if chapter else []
    extra_dir = next((s.path for s in settings.runtime.config_sources if s.provider == "command-line"), None)
    return [*selected, "workers=1", *overrides], extra_dir
