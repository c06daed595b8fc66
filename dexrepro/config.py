"""The configuration of a chapter: its files, what Hydra composes of them and of overrides, and its settings."""

from __future__ import annotations

import logging
import math
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

from dexrepro import chapters
from dexrepro.cases import LONGEST
from dexrepro.checks import is_number, is_whole
from dexrepro.disk_cache import cached
from dexrepro.errors import InputError, nearest, one_line, refused
from dexrepro.interpolation import inherited
from dexrepro.overrides import check_overrides, forced, in_quotes, keys_in, parsed, refuse_sweeps
from dexrepro.physics.engine import ENGINES, is_installed
from dexrepro.storage import read_yaml

SETTINGS = ("only", "case", "figure", "seed", "engine", "results", "workers", "case_timeout", "force", "quiet", "gui")
log = logging.getLogger(__name__)


def config_dir() -> Path:
    """The folder of Hydra configurations: inside an installed wheel, or at the top of a checkout."""
    inside = Path(__file__).parent / "conf"
    return inside if inside.is_dir() else Path(__file__).parent.parent / "conf"


def baseline_dir() -> Path:
    """Where baselines are stored: in an installed wheel, or in results/baselines of a checkout."""
    inside = Path(__file__).parent / "baselines"
    return inside if inside.is_dir() else Path(__file__).parent.parent / "results" / "baselines"


def config_files(chapter: str) -> dict[str, Path]:
    """Where the parameters of a chapter stand: the file of each of its experiments, and of ``shared`` values.

    Those of the book stand in conf/chapter/N; an experiment outside the package has ``config.yaml`` in its own folder,
    its chapter ``shared.yaml``.
    """
    if chapter != chapters.OWN and chapters.is_added(chapter):
        folder = chapters.load(chapter).folder
        files = {path.parent.name: path for path in sorted(folder.glob("*/config.yaml"))}
        return {"shared": shared, **files} if (shared := folder / "shared.yaml").exists() else files
    return {path.stem: path for path in sorted((config_dir() / "chapter" / chapter).glob("*.yaml"))}


def compose_chapter(chapter: str, overrides: Sequence[str] = (), extra_dir: str | None = None) -> dict[str, Any]:
    """The configuration of one chapter under Hydra overrides, interpolations unresolved, as plain dictionaries.

    Raises InputError with one sentence where an override names no key, cannot be parsed or is out of range.
    """
    if not extra_dir and (own := [text for text in overrides if re.match(r"\+(scene|own)=\w", text)]):
        raise InputError(
            f"'{own[0]}' needs --config-dir FOLDER, the folder that holds {own[0][1:].replace('=', '/')}.yaml"
        )
    raw = as_written(chapter)
    shipped = inherited(raw)
    if not extra_dir and (settings := _plain_settings(overrides)) is not None:
        check_settings(shipped | settings)
        return shipped | settings
    import yaml
    from hydra.errors import HydraException
    from omegaconf.errors import OmegaConfBaseException

    search = [f"hydra.searchpath=[{in_quotes(f'file://{Path(extra_dir).resolve()}')}]"] if extra_dir else []
    added = [text for text in overrides if text.startswith("+")]
    refuse_sweeps(overrides, shipped)
    if extra_dir:
        own_keys(overrides, extra_dir)  # each file is looked at
    try:
        if added:
            raw = _compose(chapter, [*added, *search])
        check_overrides(overrides, inherited(raw))
        composed = inherited(_compose(chapter, [*forced(overrides, raw), *search]))
    except RecursionError:
        raise InputError("an override is nested too deeply") from None
    except (HydraException, OmegaConfBaseException) as error:
        cause = error.__cause__ or error
        if (key := getattr(cause, "full_key", None)) and "not in struct" in str(cause):
            known = keys_in(inherited(raw))
            raise InputError(f"unknown key '{key}': {nearest(key, known)} (a new one: '+{key}=VALUE')") from error
        if extra_dir and "Cannot merge" in str(cause):
            for path in _own_files(overrides, extra_dir):
                full = inherited(raw)
                if clash := next(_clashes(read_config(path), {**full, **full.get("scene", {})}), ""):
                    raise InputError(f"{path}: {clash}") from error
        if gone := re.match(r"Could not delete from config\. '([\w.]+)' does not exist", str(cause)):
            of_another = gone[1] in keys_in(inherited(raw))
            why = "is inherited from another block and stays; set it to null" if of_another else "is not there"
            raise InputError(f"'{gone[1]}' {why}") from error
        raise InputError(one_line(cause)) from error
    except (yaml.YAMLError, ValueError, TypeError) as error:
        raise InputError(one_line(error.__cause__ or error)) from error
    if unknown := [key for key in composed if key not in shipped]:
        if not extra_dir:
            raise InputError(f"unknown key '{unknown[0]}': {nearest(unknown[0], shipped)}")
        if chapter == chapters.OWN:
            raise InputError(
                f"a file in {extra_dir} sets '{unknown[0]}' beside the scene: leave out its line '# @package _global_'"
            )
        raise InputError(
            f"a file in {extra_dir} sets '{unknown[0]}', which chapter {chapter} does not have: begin it with "
            "'# @package _global_' and name an experiment of the chapter"
        )
    check_settings(composed)
    return composed


_SETTING = re.compile(r"(\w+)=(?:'([\w./-]+)'|(0|[1-9]\d{0,17})|([A-Za-z_]\w*))")
_WORDS = {"true": True, "false": False, "null": None}


def _plain_settings(overrides: Sequence[str]) -> dict[str, Any] | None:
    """What overrides say that are settings with plain words and whole numbers; None where Hydra has to read them."""
    found: dict[str, Any] = {}
    for text in overrides:
        match = _SETTING.fullmatch(text)
        if not match or match[1] not in SETTINGS or str(match[4]).lower() in ("nan", "inf"):
            return None
        word = match[4] and _WORDS.get(match[4].lower(), match[4])
        found[match[1]] = match[2] or (int(match[3]) if match[3] else word)
    return found


def as_written(chapter: str) -> dict[str, Any]:
    """The shipped configuration of a chapter as its files have it, inheritance not filled in."""
    return _shipped(str(config_dir()), chapter, _changed(chapter))


def own_keys(overrides: Sequence[str], folder: str) -> list[str]:
    """Keys set by the files of a folder that overrides such as ``+own=compare`` choose."""
    return [key for path in _own_files(overrides, folder) for key in read_config(path)]


def _own_files(overrides: Sequence[str], folder: str) -> Iterator[Path]:
    for text in overrides:
        override = parsed(text)
        chosen = override.value() if override else None
        for option in chosen if isinstance(chosen, list) else [chosen]:
            path = Path(folder, override.key_or_group if override else "", f"{str(option).removesuffix('.yaml')}.yaml")
            if path.is_file():
                yield path


def _clashes(given: Mapping[str, Any], shipped: Mapping[str, Any], where: str = "") -> Iterator[str]:
    """Keys of a file whose value is a list where keys with values are wanted, or the other way round, as sentences."""
    for key, value in given.items():
        book = shipped.get(key)
        if isinstance(value, Mapping) and isinstance(book, Mapping):
            yield from _clashes(value, book, f"{where}{key}.")
        elif isinstance(value, Mapping | list) and isinstance(book, Mapping | list) and type(value) is not type(book):
            must = "be a list" if isinstance(book, list) else "hold keys with values"
            yield str(refused(f"{where}{key}", value, must))


def read_config(path: Path) -> dict[str, Any]:
    """The content of a configuration file. Raises InputError that names the file, and the line that is wrong."""
    import yaml
    from omegaconf import OmegaConf
    from omegaconf.errors import OmegaConfBaseException

    try:
        read_yaml(path)  # refuses aliases that explode before OmegaConf writes them out
        _refuse_odd_numbers(path, text := path.read_text("utf-8"))
        content: Any = OmegaConf.to_container(OmegaConf.create(text), resolve=False)
    except AssertionError:
        content = None
    except UnicodeDecodeError as error:
        line = error.object.count(b"\n", 0, error.start) + 1
        raise InputError(f"{path}: line {line} is not UTF-8; save the file as UTF-8") from error
    except (yaml.YAMLError, OmegaConfBaseException, ValueError) as error:
        raise InputError(f"{path} is no YAML file: {_yaml_fault(error, path)}") from error
    if not isinstance(content, dict) or not content or not all(isinstance(key, str) for key in content):
        raise InputError(f"{path} holds no keys: it must consist of lines such as 'key: value'")
    return content


def _yaml_fault(error: Exception, path: Path) -> str:
    """What is wrong in a YAML file, with its line."""
    mark = getattr(error, "problem_mark", None)
    if mark is None:
        return one_line(error)
    line = path.read_text("utf-8").splitlines()[mark.line : mark.line + 1]
    tab = "; a tab cannot indent, write spaces" if re.match(r"\s*\t", "".join(line)) else ""
    said = ": ".join(filter(None, [getattr(error, "context", ""), getattr(error, "problem", "")]))
    return one_line(f"line {mark.line + 1}: {said}{tab}")


def _refuse_odd_numbers(path: Path, text: str) -> None:
    """Refuse what YAML 1.1 takes for octal or for minutes and seconds, and a reader for another number or a text."""
    import yaml

    for event in yaml.parse(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader)):
        if not (isinstance(event, yaml.ScalarEvent) and event.implicit[0]):
            continue
        octal = re.fullmatch(r"[-+]?0[0-7]+", word := event.value)
        if octal or re.fullmatch(r"[-+]?\d+(:[0-5]?\d)+(\.\d*)?", word):
            value = yaml.safe_load(word)
            if octal and value == int(word):
                continue
            ways = f"{int(word)} or {value}" if octal else value
            line = event.start_mark.line + 1  # type: ignore[union-attr]
            raise InputError(
                f"{path}: line {line}: YAML takes {word} for {value}; write {ways}, or '{word}' "
                "in quotes where it is a text"
            )


def offer(chapter: str) -> None:
    """Let Hydra find the configuration of a chapter outside the package."""
    if chapter == chapters.OWN or not chapters.is_added(chapter):
        return
    from hydra.core.config_store import ConfigStore
    from omegaconf import OmegaConf

    for name, path in config_files(chapter).items():
        node = OmegaConf.create({name: read_config(path)})
        ConfigStore.instance().store(f"{name}.yaml", node, group=f"chapter/{chapter}", package="_global_")
    defaults = {"defaults": [f"{chapter}/{name}" for name in config_files(chapter)]}
    ConfigStore.instance().store(f"{chapter}.yaml", defaults, group="chapter", package="_global_")


def _changed(chapter: str) -> tuple[tuple[Path, float], ...]:
    files = (config_dir() / "config.yaml", *config_files(chapter).values())
    return tuple((path, path.stat().st_mtime) for path in files)


@lru_cache(maxsize=16)
def _shipped(folder: str, chapter: str, changed: tuple[tuple[Path, float], ...]) -> dict[str, Any]:
    """The configuration without overrides; composing takes a while, so it is kept until the files change."""

    def composed() -> tuple[dict[str, Any], list[Path]]:
        files = config_files(chapter).values()
        folders = {path.parent for path in files} | {config_dir(), config_dir() / "chapter"}
        if home := chapters.folders().get(chapter):  # where a file may appear
            folders |= {home, *(home / name for name in chapters.names(chapter))}
        log.info("composed chapter %s from %d files of %s", chapter, len(files), next(iter(folders)))
        return _compose(chapter), [Path(__file__), *files, *folders, *config_dir().rglob("*.yaml")]

    return dict(cached(f"chapter {chapter} of {folder}, {os.environ.get(chapters.ADDED)}", composed))


def _compose(chapter: str, overrides: Sequence[str] = ()) -> dict[str, Any]:
    from hydra import compose, initialize_config_dir
    from hydra.core.global_hydra import GlobalHydra
    from omegaconf import OmegaConf

    offer(chapter)
    GlobalHydra.instance().clear()
    with initialize_config_dir(str(config_dir().resolve()), version_base="1.3"):
        config = compose("config", overrides=[f"chapter='{chapter}'", *overrides])
    return OmegaConf.to_container(config, resolve=False)  # type: ignore[return-value]


def check_settings(composed: Mapping[str, Any]) -> None:
    """Refuse settings that are no experiment's and of which nothing can be made."""
    if removed := [key for key in SETTINGS if key not in composed]:
        raise InputError(f"'{removed[0]}' cannot be left out; give it a value instead")
    seed, results, figure = composed["seed"], composed["results"], composed["figure"]
    if not is_whole(seed) or not 0 <= seed < 1 << 64:
        raise refused("seed", str(seed)[:40], "be a whole number of 0 or greater, below 2^64")
    if not isinstance(results, str) or not results:
        raise refused("results", repr(results), "be the name of a folder")
    if isinstance(figure, list):
        raise refused("figure", figure, "be one figure or table, such as 2.7 or T2.1")
    scene = composed.get("scene")
    if isinstance(scene, Mapping) and not re.fullmatch(r"\w[\w.-]{,59}", name := str(scene.get("name") or "")):
        must = f"name a folder: use up to {LONGEST} letters, digits, '_', '-'"
        raise refused("scene.name", name[:80] or "null", must)
    check_engine(composed["engine"])
    timeout = composed["case_timeout"]
    if timeout is not None and not (is_number(timeout) and 0 < timeout < math.inf):
        raise refused("case_timeout", timeout, "be a number of seconds greater than 0")
    for key in ("force", "quiet", "gui"):
        if not isinstance(composed[key], bool):
            raise refused(key, composed[key], "be true or false")


def check_engine(engine: Any) -> None:
    """Refuse an engine that there is not, or not here."""
    words = [engine] if engine is not None else list(ENGINES)
    if not all(isinstance(word, str) and word in ENGINES for word in words):
        raise refused("engine", engine, f"be one of {', '.join(ENGINES)}")
    if not any(map(is_installed, words)):
        raise InputError(
            f"engine = {words[0]} needs {ENGINES[words[0]]}, which is not installed here: pip install {words[-1]}"
        )
