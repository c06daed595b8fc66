"""How names and values read on a page."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Any

from markupsafe import Markup, escape

from dexrepro.report import symbols

if TYPE_CHECKING:  # its import takes longer than a run that has nothing to do
    import pandas as pd


def breakable(name: str) -> Markup:
    """A dotted name that may be broken between its parts, and only there."""
    return Markup("<wbr>").join(re.split(r"(?<=[._=,/-])(?=\w)", name))


_BASE = rf"(?<![\w.\\/'-])(?:{'|'.join(symbols.GREEK)}|[A-Za-z]{{1,2}}|[A-Za-z](?:hat|bar))"
_BELOW, _ABOVE = r"_(?:\{[^}]*\}|\w{1,3}(?:,\w+)?)", r"\^(?:\w{1,3}|\([^)]*\))"
_SYMBOL = re.compile(rf"(?:{_BASE}(?:{_BELOW}(?:{_ABOVE})?|{_ABOVE})|(?<=[|)\]]){_ABOVE})(?!\w|=|\.\w)")


def prose(text: str) -> Markup:
    """A sentence in which symbols as ``K_1`` or ``x^T`` are set as the book has them."""
    parts, end = [], 0
    for match in _SYMBOL.finditer(text):
        symbol = re.sub(r"_(\w+,\w+)", r"_{\1}", match[0])
        parts += [escape(text[end : match.start()]), symbols.html(symbol)]
        end = match.end()
    return Markup("").join([*parts, escape(text[end:])])


def section(where: str) -> str:
    """A place in the book: "Sect. 2.4" of "2.4"; another text as it is."""
    return re.sub(r"^(?=\d)", "Sect. ", where)


def unit(text: str) -> Markup:
    """A unit with its exponents raised: "kg m^2"."""
    return Markup(re.sub(r"\^(-?[\d.]+|\w)", r"<sup>\1</sup>", str(escape(text))))


def column_kind(column: pd.Series[Any]) -> str:
    """How a table's column is set: "number", "words" (some cell is a phrase, so that it needs width) or ""."""
    if column.dtype.kind in "if":
        return "number"
    return "words" if column.astype(str).str.len().max() > 24 else ""


def cell(value: Any) -> str:
    """A table's entry: a minus sign at which no line is broken, words in place of ``True`` and of a key."""
    if value is None or value != value:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, str) and re.fullmatch(r"[a-z][a-z0-9]+(_[a-z0-9]+)+", value):
        return value.replace("_", " ")
    if isinstance(value, str):
        return symbols.greek(value.replace("+-", "\u00b1"))
    if isinstance(value, float):
        return (f"{value:.0f}" if 1e4 <= abs(value) < 1e6 else f"{value:.4g}").replace("-", "\u2212")
    return str(value)


def number(value: float | None, digits: int = 4) -> str:
    """Four digits, with a minus sign; a dash where there is none."""
    return "–" if value is None else f"{value:.{digits}g}".replace("-", "\u2212")


def short_number(value: float | None) -> str:
    """Two digits: of a margin no more matter."""
    return number(value, 2)


def percent(value: float) -> str:
    """A share as a whole percentage; 100 % is kept for all."""
    return f"{100 * value:.0f} %" if value == 1 else f"{min(100 * value, 99.4):.0f} %"


def script(name: str, data: Any) -> str:
    """Data as a script that a page opened from disk may load."""
    return f"{name} = {json.dumps(data, separators=(',', ':')).replace('<', chr(92) + 'u003c')};\n"
