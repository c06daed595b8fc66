"""Tables of numbers in texts of many makes: which lines are rows, what parts their entries, what numbers these are."""

from __future__ import annotations

import contextlib
import csv
import math
import re
from collections.abc import Sequence
from datetime import UTC, datetime
from itertools import chain, pairwise

import numpy as np

from dexrepro.arrays import Array

OTHER_TEXTS = {r"{|\[\s*[\[{\d-]": "JSON or a printed list", "<": "XML",
               r"---\n|- *[\[{]|\w+: *\n *(- |\w+:)": "YAML"}  # by their beginning  # fmt: skip
SEPARATORS = (";", "\t", ",", None)  # None: blanks; of several that do equally well, the first
LOOKED_AT = 20  # rows that tell how all are written
SHOWN = 60  # letters of a line in a sentence
HASH = r"#(?!N/A|[NН]/[DД]|NV(?=[\"';,\t]|$)|[¡¿]?[A-ZÀ-ÞА-Я/0]+[!?])"  # "#N/A", "#DIV/0!", ... are entries of a sheet
REMARK = re.compile(rf"(\S*)(^|\s+)({HASH}|//)")  # behind the numbers of a row
COMMENT = re.compile(rf"^\s*({HASH}|%|//)[\s#%/]*")
OPENED = re.compile(r'(^|[,;\t])"[^"]*$')  # an entry in quotes that goes on in the next line
STAMP = (  # ISO 8601's, a span of pandas, minutes and seconds, a duration of MATLAB
    r"(\d+ days? )?(\d{4}[-/]\d\d[-/]\d\d[t ])?\d?\d:\d\d:\d\d([.,]\d+|:\d{3})?(z|[-+]\d\d:?\d\d)?"
    r"|\d{1,3}:[0-5]\d[.,]\d+|\d+(\.\d+)? sec"
)
CLOCKS = "2026-11-28T10:00:00.25, 10:00:00.25 or 00:00.25"
NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?|nan|[-+]?inf|" + STAMP)


def lines_of(text: str) -> list[str]:
    """The lines of a text; several that an entry in quotes goes over are joined, and empty ones follow. Refuses other
    kinds of text."""
    text = text.replace("\u2212", "-").replace("\u2013", "-")
    text = text.replace("\ufeff", "")  # begins a file that was joined to another
    begin = text.lstrip()[:SHOWN]
    if not begin:
        raise ValueError("it is empty")
    if kind := next((kind for start, kind in OTHER_TEXTS.items() if re.match(start, begin)), None):
        raise ValueError(f"it is {kind}, not columns of numbers; export them as CSV")
    lines = text.splitlines()
    for k, line in enumerate(lines):
        if '"' in line and OPENED.search(line) and line.count('"') % 2:
            end = next((j for j in range(k + 1, min(k + 20, len(lines))) if lines[j].count('"') % 2), k)
            lines[k : end + 1] = [" ".join(lines[k : end + 1]), *[""] * (end - k)]
    return lines


class Table:
    """Lines of a text, some of them rows with a number for each of the ``wanted`` columns.

    head: the lines before the rows, without empty ones; plain: those of them that are no comments; body: the rows; all
    by their place in ``lines``. separator: what parts the entries of a row, None for blanks; widths: how many entries
    the first rows have; columns: where the wanted ones are, None where nothing names them; again:
    the line that repeats the names, None where none does.
    """

    def __init__(self, lines: list[str], wanted: tuple[str, ...]) -> None:
        self.lines, self.wanted = lines, wanted
        self.columns: list[int] | None = None
        self.again: int | None = None
        self.stripped = [line.strip(" \t,;") for line in lines]
        self.rows_behind(0)

    def rows_behind(self, start: int) -> None:
        """Let the rows begin with the first line from ``start`` on that is one; the head are all lines before them."""
        lines, first = self.lines, self._first_row(start, min(len(self.wanted), 3))
        self.head = [k for k in range(first) if self.stripped[k] and not self.stripped[k].startswith("sep=")]
        self.plain = [k for k in self.head if not COMMENT.match(lines[k])]
        rows = [k for k in range(first, len(lines)) if self.stripped[k]]
        self.body = [k for k in rows if not (self.stripped[k][0] in "#%/" and COMMENT.match(lines[k]))]
        above = lines[first - 1] if first else ""
        self.separator = max(SEPARATORS, key=lambda separator: self._fit(separator, above))
        self.widths = set(map(len, self.first_rows(self.separator)))

    def _first_row(self, start: int, enough: int) -> int:
        """The first line from ``start`` on with enough numbers; one with words, too, is about the recording if the next
        has too few."""
        later = enumerate(self.lines[start:], start)
        rows = ((k, line) for k, line in later if self.stripped[k] and not COMMENT.match(line))
        for (k, line), (_, after) in pairwise(chain(rows, [(0, "")])):
            full = numbers_in(line) >= enough
            if full and (not re.search("[a-z]{2}", line) or not after or numbers_in(after) >= enough):
                return k
        return len(self.lines)

    def _fit(self, separator: str | None, above: str) -> tuple[int, int, int]:
        """How well a separator fits: how many of the first rows are numbers by it, else how often it is ``above``."""
        rows = self.first_rows(separator)
        good = sum(len(row) >= len(self.wanted) and all(map(is_entry, row)) for row in rows)
        return good, above.count(separator or " "), len(rows[0]) if rows else 0

    def first_rows(self, separator: str | None) -> list[list[str]]:
        """The entries of those rows that tell how all are written."""
        return [self._split(self.lines[k], separator) for k in self.body[:LOOKED_AT]]

    def row(self, k: int) -> list[str]:
        """The entries of a row."""
        return self._split(self.lines[k], self.separator)

    def _split(self, line: str, separator: str | None) -> list[str]:
        """The entries of a row, without quotes, a remark behind them and empty ones at its end."""
        row = entries(line, separator) if separator else line.split()
        row = [entry.strip().strip("\"'") for entry in row]
        if "#" in line or "//" in line:
            enough = max(self.columns or [len(self.wanted) - 1])
            for k, entry in enumerate(row):
                if (match := REMARK.match(entry)) and (is_entry(match[1]) if match[1] else k > enough):
                    row = [*row[:k], match[1]]
                    break
        while row and not row[-1]:
            row.pop()
        return row

    def _chosen(self, row: Sequence[str]) -> list[str]:
        """The entries of a row in the wanted columns, or all where nothing names these."""
        return [row[column] if column < len(row) else "" for column in self.columns or range(len(row))]

    def named_by(self, k: int, columns: list[int]) -> None:
        """Take a line for the names of the columns: below it are rows, to be refused if they hold too few numbers."""
        rows = [other for other in self.plain if other > k and numbers_in(self.lines[other])] + self.body
        again = {other for other in range(k + 1, len(self.lines)) if self.stripped[other] == self.stripped[k]}
        self.again = min(again, default=None)
        self.body = [other for other in rows if other not in again]
        self.head.remove(k)
        self.columns = columns

    @property
    def dated(self) -> bool:
        """Whether the times are a clock's."""
        return self.wanted[0] == "time" and _seconds(self._first) is not None

    @property
    def _first(self) -> str:
        """The first entry that is wanted."""
        return self._chosen(self.row(self.body[0]))[0] if self.body else ""

    def _unwrapped(self, time: Array) -> Array:
        """A clock's times (N,) [s], one turn on behind midnight, or behind the full hour where they have none."""
        turn = 3600 if self._first.count(":") == 1 else 86400
        alone = time.size and time.max() < turn  # without dates
        return time + turn * np.cumsum(np.diff(time, prepend=time[0]) < -turn / 2) if alone else time

    def numbers(self) -> tuple[Array, Array]:
        """The wanted columns (N, d), and the number of each row's line (N,), from 1."""
        rows, data = [self.lines[k] for k in self.body], np.empty((0, 0))
        place: int | str = self.columns[0] if self.columns else 0
        clock = {place: _time} if self.dated else {}
        text = "\n".join(rows) if self.separator != "," else ""
        if not (re.search(r"\d,\d", text) and re.search(r"\d\.\d", text)):
            rows = text.replace(",", ".").split("\n") if "," in text else rows
            with contextlib.suppress(ValueError):  # what cannot be read so is read row by row
                data = np.loadtxt(
                    rows, delimiter=self.separator, usecols=self.columns, comments=None, quotechar='"', ndmin=2,
                    converters=clock, encoding=None,
                )  # fmt: skip
        if data.shape[1] != len(self.wanted) or not np.isfinite(data).all():
            return self.numbers_by_row()
        if clock:
            data[:, 0] = self._unwrapped(data[:, 0])
        return data, np.array(self.body) + 1

    def numbers_by_row(self) -> tuple[Array, Array]:
        """The same slowly, with a sentence for the first line that cannot be used; empty rows are left out."""
        data, lines, marks, dated = [], [], set[str](), self.dated
        for k in self.body:
            if not (row := self.row(k)):
                continue
            if len(row) != len(self.wanted) and self.columns is None:
                must = f"it must have {', '.join(self.wanted)}, or a first line must name the columns"
                raise ValueError(f"line {k + 1} has {len(row)} numbers; {must}")
            chosen = self._chosen(row)
            values = [_number(entry) for entry in chosen]
            values[0] = _seconds(chosen[0]) if dated and values[0] is None else values[0]
            marks |= {mark for entry in chosen[dated:] for mark in ".," if mark in entry}
            if None in values or len(marks) > 1:
                must = "every entry must be a finite number; delete the row or fill it in"
                if values[0] is None and ":" in chosen[0]:
                    must = f"its time must be a number, or all be as {CLOCKS}"
                elif len(row) >= len(self.wanted) and not numbers_in(self.lines[k]):
                    must = "give each of several recordings a file of its own, or delete the row"
                elif len(marks) > 1:
                    must = "numbers must have either . or , and no mark between thousands"
                raise ValueError(f"line {k + 1} holds '{self.lines[k].strip()[:SHOWN]}': {must}")
            data.append(values)
            lines.append(k + 1)
        table = np.array(data, dtype=float).reshape(-1, len(self.wanted))
        if dated:
            table[:, 0] = self._unwrapped(table[:, 0])
        return table, np.array(lines)


def mark_in(line: str) -> str | None:
    """What parts the entries of a line that holds no numbers, None for blanks."""
    return next((mark for mark in SEPARATORS if mark and mark in line), None)


def entries(line: str, separator: str) -> list[str]:
    """The entries of a line; of one that is quoted as a whole, too."""
    row = next(csv.reader([line], delimiter=separator))
    return next(csv.reader(row, delimiter=separator)) if len(row) == 1 and separator in row[0] else row


def numbers_in(line: str) -> int:
    """How many entries of a line are numbers, whatever parts them."""
    return sum(NUMBER.fullmatch(entry) is not None for entry in re.split(r"""[;,\s"']+""", line.lower()))


def is_entry(text: str) -> bool:
    """Whether a text is a finite number, or a clock's time."""
    return _number(text) is not None or _seconds(text) is not None


def _number(entry: str) -> float | None:
    """A finite number, its decimal mark a point or a comma; None for what is none."""
    with contextlib.suppress(ValueError):
        if "_" not in entry and math.isfinite(number := float(entry.replace(",", "."))):  # 10_59_58 is a clock's
            return number
    return None


def _time(entry: str) -> float:
    """A clock's time, or seconds as they are. Raises ValueError."""
    number = _number(entry)
    found = _seconds(entry.strip()) if number is None else number
    if found is None:
        raise ValueError(entry)
    return found


def _seconds(entry: str) -> float | None:
    """A date with a clock's time, or this alone, as seconds; None for what is neither."""
    if not re.fullmatch(STAMP, entry.lower()):
        return None
    if " sec" in entry:
        return float(entry.removesuffix(" sec"))
    if entry.count(":") == 1:
        minutes, _, rest = entry.partition(":")
        return 60 * int(minutes) + float(rest.replace(",", "."))
    with contextlib.suppress(ValueError):  # such as the 31st of February
        entry = re.sub(r":(\d{3})$", r".\1", entry.replace("/", "-"))
        days, _, entry = entry.rpartition(" days ") if " days " in entry else entry.rpartition(" day ")
        date = datetime.fromisoformat(entry if "-" in entry[:5] else f"1970-01-01T{'0' * (entry[1] == ':')}{entry}")
        return 86400 * int(days or 0) + (date if date.tzinfo else date.replace(tzinfo=UTC)).timestamp()
    return None
