"""The command line: what holds for every command (``dexrepro --help`` names them; see ``commands``)."""

from __future__ import annotations

import argparse
import logging
import os
import re
import shutil
import signal
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from dexrepro import __version__
from dexrepro.commands import (  # noqa: F401  each declares its commands
    COMMANDS,
    FAILED,
    INTERRUPTED,
    OK,
    WRONG,
    checks,
    command,
    laws,
    option,
    results,
    run,
    warn,
)
from dexrepro.errors import COMPLETES, InputError, existing_folder
from dexrepro.keys import TAKEN, described

STATUSES = {
    OK: "done; check: the same as stored",
    FAILED: "a case failed or cannot be drawn; check: something differs; the output is no longer read",
    WRONG: "the input cannot be used, or results are missing; one sentence says what",
    INTERRUPTED: f"interrupted; {COMPLETES}",
}


def main(arguments: Sequence[str] | None = None) -> int:
    """Entry point; returns the exit status."""
    arguments = list(sys.argv[1:] if arguments is None else arguments)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    sys.path.append("")  # a user's own classes, named by _target_: behind all that is installed
    try:
        return _dispatch(_global_options(arguments))
    except KeyboardInterrupt:
        warn(STATUSES[INTERRUPTED])
        return INTERRUPTED
    except Exception as error:
        if isinstance(error, BrokenPipeError):  # who reads the output has seen enough
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            return FAILED
        if isinstance(error, shutil.Error):  # of many files; the reason of the first
            error = InputError(f"cannot copy files: {error.args[0][0][2]}")
        if isinstance(error, OSError):  # a full or write-protected disk, an unreadable file
            error = InputError(f"{error.filename or 'cannot read or write a file'}: {error.strerror or error}")
        if not isinstance(error, InputError):
            raise
        warn(f"dexrepro: {error}")
        return WRONG


def _dispatch(arguments: list[str]) -> int:
    if arguments[:1] == ["run"] and not {"-h", "--help"} & {*arguments}:
        return run.run_command(arguments[1:])
    parser = _parser()
    if "_ARGCOMPLETE" in os.environ:
        from dexrepro.completion import complete

        complete(parser)
    options, words = parser.parse_known_args(arguments)
    if words and not (hasattr(options, "selection") and all(re.match(r"[\w.]+=", word) for word in words)):
        parser.error(f"unrecognized arguments: {' '.join(words)}")
    if words:  # key=value behind an option
        options.selection += words
    return int(options.function(options))


class _ToTerminal(logging.Handler):
    """Says what is logged where errors are said."""

    def emit(self, record: logging.LogRecord) -> None:
        warn(record.getMessage())


def _global_options(arguments: list[str]) -> list[str]:
    """Heed ``--log`` and ``--experiments DIR``, before or behind any command; the other arguments."""
    from dexrepro import chapters

    parser = argparse.ArgumentParser(prog="dexrepro", add_help=False, allow_abbrev=False)
    parser.add_argument("--experiments", action="append", default=[], type=Path, metavar="DIR")
    parser.add_argument("-v", "--log", action="store_true")
    options, rest = parser.parse_known_args(arguments)
    logging.getLogger("dexrepro").handlers = [_ToTerminal()]
    logging.getLogger("dexrepro").setLevel(logging.INFO if options.log else logging.WARNING)
    for folder in options.experiments:
        existing_folder(folder, "--experiments")
        chapters.add(folder)
        if not any(folder.resolve() in (path, path.parent) for path in chapters.folders().values()):
            raise InputError(
                f"--experiments = {folder} adds nothing: an experiment is a folder in it with experiment.py, and a "
                "chapter whose name is taken needs another"
            )
    return rest


def _parser() -> argparse.ArgumentParser:
    told = "exit status:\n" + "\n".join(f"  {status:<5}{meaning}" for status, meaning in STATUSES.items())
    parser = argparse.ArgumentParser(
        prog="dexrepro", description="Reproduce the book's figures and check its claims.", epilog=told,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )  # fmt: skip
    parser.add_argument("--version", action="version", version=f"dexrepro {__version__}")
    parser.add_argument("--experiments", metavar="DIR", help="experiments of your own, beside the book's")
    parser.add_argument("-v", "--log", action="store_true", help="say what is read, and why something runs again")
    commands = parser.add_subparsers(required=True, metavar="command", dest="command")
    for name, declared in COMMANDS.items():
        added: argparse.ArgumentParser = commands.add_parser(
            name, help=declared.help, description=declared.help[0].upper() + declared.help[1:] + ".",
            epilog=described(name) + declared.more, formatter_class=argparse.RawDescriptionHelpFormatter,
        )  # fmt: skip
        if name in TAKEN:
            words = added.add_argument("selection", nargs="*", metavar=declared.metavar, help="as listed below")
            words.completer = _completions  # type: ignore[attr-defined]
        for names, settings in declared.options:
            added.add_argument(*names, **settings)
        added.set_defaults(function=declared.run)
    return parser


def _completions(**context: Any) -> list[str]:
    from dexrepro.completion import words

    return list(words(**context))


@command(
    'for Tab: eval "$(dexrepro completion bash)"', None,
    option("shell", choices=("bash", "zsh", "fish"), help="whose script to print"),
)  # fmt: skip
def completion_command(options: argparse.Namespace) -> int:
    """``dexrepro completion bash|zsh|fish``."""
    from dexrepro.completion import script

    print(script(options.shell))
    return OK
