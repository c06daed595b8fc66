"""Help says every key that a command takes, and the exit status says how a command ended."""

from __future__ import annotations

import argparse
import re
from pathlib import Path

import pytest
from conftest import Command

from dexrepro import cli
from dexrepro.config import SETTINGS
from dexrepro.errors import InputError
from dexrepro.keys import KEYS, TAKEN
from dexrepro.selection import selected

PARSER = cli._parser()
COMMANDS: dict[str, argparse.ArgumentParser] = next(a for a in PARSER._actions if a.dest == "command").choices  # type: ignore


@pytest.mark.parametrize("command", COMMANDS)
def test_help_says_every_key_and_every_option(command: str) -> None:
    said = COMMANDS[command].format_help()
    for key in TAKEN.get(command, ()):
        assert re.search(rf"^  {key}=\S+ +\w", said, re.MULTILINE), key
    for action in COMMANDS[command]._actions:
        assert action.help, action.dest
    assert cli.COMMANDS[command].run.__doc__


@pytest.mark.parametrize("command", [name for name in TAKEN if name not in ("run", "tune", "compare")])
def test_a_command_takes_what_its_help_says_and_nothing_else(command: str) -> None:
    example = {"chapter": "2", "only": "holding_line", "figure": "2.7", "workers": "1", "claim": "C2.12"}
    for key in {name for name in KEYS if "." not in name}:
        word = f"{key}={example.get(key, 'x')}"
        if key in TAKEN[command]:
            selected([word, *(["only=holding_line"] if key == "case" else [])], command)
        else:
            with pytest.raises(InputError, match=rf"'{word}' has no meaning here; there are: .*{TAKEN[command][0]}="):
                selected([word], command)


def test_run_takes_the_settings_of_the_configuration() -> None:
    assert {"chapter", "claim", *SETTINGS} == set(TAKEN["run"])


def test_every_key_of_the_code_is_in_the_table() -> None:
    """What a command looks up among its words is what it takes."""
    source = "".join(path.read_text("utf-8") for path in Path(cli.__file__).parent.glob("commands/*.py"))
    asked = set(re.findall(r"(?:values|known|extra)(?:\.get\(|\[)\"(\w+)\"", source)) - {"metric", "sign"}
    assert asked <= {key for keys in TAKEN.values() for key in keys}


@pytest.mark.parametrize(
    ("text", "status"),
    [
        ("list", cli.OK),
        ("run quiet=true", cli.OK),
        ("run decay.fail=true quiet=true", cli.FAILED),
        ("run chapter=99", cli.WRONG),
        ("show nosuch", cli.WRONG),
        ("check only=nosuch", cli.WRONG),
    ],
)
def test_the_exit_status_is_the_one_that_help_says(command: Command, text: str, status: int) -> None:
    assert command(text)[0] == status
    assert re.search(rf"^  {status} +\w", PARSER.format_help(), re.MULTILINE)


def test_a_narrow_terminal_cuts_no_folder_short(command: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("dexrepro.commands.out.width", 30)
    folder = f"results/{'deep/' * 40}here"
    code, text = command(f"run only=decay case=plain workers=1 results={folder}")
    assert (code, f"{folder}/runs/decay-" in text, "reproduced" in text, "…" in text) == (0, True, True, False), text


def test_help_fits_a_narrow_terminal_and_the_alphabet_of_any_console(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "40")
    for parser in (PARSER, *COMMANDS.values()):
        assert parser.format_help().encode("cp1252")
