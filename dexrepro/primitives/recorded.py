"""Recorded paths from text files of many makes: read, checked, and resampled at equal steps."""

from __future__ import annotations

import contextlib
import csv
import glob
import os
import re
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import PchipInterpolator

from dexrepro.arrays import Array
from dexrepro.text import decoded

LENGTHS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254}
TIMES = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0}
SPELT = {"in": "inch", "inches": "inch", "meters": "m", "metres": "m", "centimeters": "cm", "centimetres": "cm",
         "millimeters": "mm", "millimetres": "mm", "sec": "s", "secs": "s", "seconds": "s", "minutes": "min",
         "msec": "ms", "milliseconds": "ms", "µs": "us", "μs": "us", "usec": "us", "microseconds": "us", "nsec": "ns",
         "nsecs": "ns", "nanoseconds": "ns", "millis": "ms", "micros": "us", "nanos": "ns"}  # fmt: skip
UNITS = {"", "-", *LENGTHS, *TIMES, *SPELT}
ANGLES = {"deg", "degree", "degrees", "rad", "radian", "radians"}
NO_LENGTHS = {*ANGLES, *TIMES, "mps", "hz", "n", "v", "volts"}
RELATIVE = {"norm", "normalised", "normalized"}
OTHER_TIMES = {"hour", "hours", "hrs", "day", "days"}
OTHER_LENGTHS = {"um", "µm", "μm", "micrometers", "micrometres", "microns", "dm", "km", "ft", "feet"}
CONVERTED = {*OTHER_LENGTHS, *OTHER_TIMES, "h", "hr", "d", "nm", "frame", "frames"}  # by hand
OTHERS = {*ANGLES, *RELATIVE, *OTHER_LENGTHS, "px", "pixel", "pixels", "mps"}
TIME = {"time", "t", "timestamp", "timestamps", "stamp", "sec", "secs", "seconds", "zeit"}
OFTEN = {"time": {"datetime", "elapsed"}, "x": {"px", "posx", "xpos"}, "y": {"py", "posy", "ypos"},
         "z": {"pz", "posz", "zpos"}}  # fmt: skip  # where no column has the plain name
NANO = {"nanosec", "nanosecs", "nsec", "nsecs", "nanoseconds"}  # of a stamp whose whole seconds stand beside
NO_PLACE = {"orientation", "rotation", "rot", "angular", "angle", "euler", "quaternion", "quat", "q", "r", "twist",
            "linear", "velocity", "vel", "v", "u", "w", "omega", "speed", "dot", "ddot", "d", "dd", "delta", "diff",
            "acceleration", "accel", "acc", "a", "jerk", "gyro", "gyroscope", "mag", "magnetometer", "force", "f",
            "torque", "wrench", "moment", "error", "err", "e", "std", "var", "cov", "covariance", "seq"}  # fmt: skip
PLACE = {"position", "pos"}
WHOLE = {"sec", "secs", "seconds"}
NAME = re.compile(  # neither a number nor prose
    r"(?!(in|of|for|at|per|the|over|from|versus|and|und)\b|.*\b(is|are|by|to)\b)[^\W\d]", re.IGNORECASE
)
LEAD = re.compile(r"^([^:=]*[:=]|rem\b|[^\w\s\[(\"']+)\s+", re.IGNORECASE)  # "columns: t x y", "REM t x y", "! t x y"
SAID = re.compile(r"(?:\bin|\bunits?)\W+(?:are|is)?\W*([a-zµμ]+)\b|[\[(]([a-zµμ]+)[\])]")  # units in words about a file
HASH = r"#(?!N/A|[NН]/[DД]|NV(?=[\"';,\t]|$)|[¡¿]?[A-ZÀ-ÞА-Я/0]+[!?])"  # "#N/A", "#DIV/0!", ... are entries of a sheet
REMARK = re.compile(rf"(\S*)(^|\s+)({HASH}|//)")  # behind the numbers of a row
COMMENT = re.compile(rf"^\s*({HASH}|%|//)[\s#%/]*")
OPENED = re.compile(r'(^|[,;\t])"[^"]*$')  # an entry in quotes that goes on in the next line
STAMP = (
    r"(\d+ days? )?(\d{4}-\d\d-\d\d[t ])?\d?\d:\d\d:\d\d([.,]\d+)?(z|[-+]\d\d:?\d\d)?"  # ISO 8601's, a span of pandas
)
FEWEST = 8
LONG = 60.0  # s; a file that lasts longer with steps of a second or more has other stamps than seconds
SHORT = 0.01  # s; no movement of a hand
WIDE = 2.0  # m; neither
FAR = 1e7  # m; as far as from the equator to a pole
csv.field_size_limit(2**31 - 1)  # by default 128 kB, which a note or a picture in base64 beside the path exceeds
SHOWN, LONGEST = 60, 300  # letters of a line and of a header in a sentence
PAUSE = 10.0  # times the usual step; where such pauses take a third of the time, clocks have jumped


@dataclass(frozen=True)
class Format:
    """How a file of recorded positions is written.

    unit: of its lengths, m, cm, mm or inch; time_unit: s, ms, us, ns or min; None: as its header says. duplicates:
    "drop" keeps the first of several samples of one instant, "refuse" refuses them. encoding: of a file that is neither
    UTF-8 nor UTF-16, such as cp1252; 1252 is the same.
    """

    unit: str | None = None
    time_unit: str | None = None
    duplicates: str = "refuse"
    encoding: str | int | None = None

    def __post_init__(self) -> None:
        allowed = {"unit": [*LENGTHS], "time_unit": [*TIMES], "duplicates": ["refuse", "drop"]}
        for key, values in allowed.items():
            value = getattr(self, key)
            if value not in values and (value is not None or key == "duplicates"):
                raise ValueError(f"{key} = {value} is not allowed: it must be one of {', '.join(values)}")
        if not isinstance(self.encoding, str | int | None):
            raise ValueError(f"encoding = {self.encoding} is not allowed: it must be a name such as utf-8 or cp1252")


def read_path(path: str, style: Format = Format(), axes: int = 3, otherwise: str = "m") -> tuple[Array, Array]:
    """Time (N,) [s] from 0 and position (N, axes) [m] of a file with the columns time, x, y and, for three axes, z.

    Columns are parted by commas, semicolons, tabs or blanks; the decimal mark may be a comma where that is clear. Times
    are numbers, or dates with a clock's time as ISO 8601 writes them, or this alone. A
    line before the numbers may name the columns, in any order and among others, with their units in brackets. Lines
    that begin with #, % or // are comments, one of which may name the columns, as is what stands behind # or // in a
    row. otherwise: the unit of length where neither header nor ``style`` tells it.
    Raises ValueError with one sentence where the file cannot be used.
    """
    try:
        lines = _lines(path, style)
    except OSError as error:
        raise ValueError(f"cannot read '{path}': {error.strerror}") from None
    except ValueError as error:
        raise ValueError(f"cannot read '{path}': {error}") from None
    try:
        table = _Table(lines, ("time", "x", "y", "z")[: axes + 1])
        length = table.unit(style, "unit", LENGTHS, 1, otherwise)
        if table.dated and style.time_unit not in (None, "s"):
            raise ValueError(f"its times are a clock's; leave out time_unit={style.time_unit}")
        tick = "s" if table.dated else table.unit(style, "time_unit", TIMES, 0, "s")
        data, numbers = table.data()
        time, position = TIMES[tick or "s"] * (data[:, 0] - data[0, 0]), LENGTHS[length or otherwise] * data[:, 1:]
        if style.duplicates == "drop":
            new = np.concatenate([[True], np.diff(time) != 0])
            time, position, numbers = time[new], position[new], numbers[new]
        _check(time, position, numbers, tick)
    except ValueError as error:
        raise ValueError(f"'{path}': {error}") from None
    return time, position


def read_corners(path: str, style: Format = Format(), otherwise: str = "m") -> Array:
    """Corners (n, 2) [m] of a polygon, in order, from a file with the columns x, y; see :func:`read_path`."""
    try:
        table = _Table(_lines(path, style), ("x", "y"))
        corners, numbers = table._row_by_row()
        corners = LENGTHS[table.unit(style, "unit", LENGTHS, 1, otherwise) or otherwise] * corners
        _check_near(corners, numbers)
    except OSError as error:
        raise ValueError(f"cannot read '{path}': {error.strerror}") from None
    except ValueError as error:
        raise ValueError(f"'{path}': {error}") from None
    corners = corners[:-1] if len(corners) > 1 and (corners[0] == corners[-1]).all() else corners
    (x, y), (later_x, later_y) = corners.T, np.roll(corners, -1, axis=0).T
    if len(corners) < 3 or abs((x * later_y - y * later_x).sum()) < 1e-12:
        raise ValueError(
            f"'{path}': it has no area; it must hold the corners x, y of a polygon, three or more, in order"
        )
    return corners


def _lines(path: str, style: Format) -> list[str]:
    """The lines of a file. Raises ValueError with half a sentence where it is another kind of text than a table."""
    encoding = f"cp{style.encoding}" if isinstance(style.encoding, int) else style.encoding  # of Windows, such as 1252
    text = decoded(Path(os.path.expanduser(path)).read_bytes(), encoding).replace("\u2212", "-")
    begin = text.lstrip()[:SHOWN]
    if not begin:
        raise ValueError("it is empty")
    if begin[0] in "{<" or re.match(r"\[\s*[\[{\d-]", begin):
        kind = "XML" if begin[0] == "<" else "JSON or a printed list"
        raise ValueError(f"it is {kind}, not columns of numbers; export them as CSV")
    lines = text.splitlines()
    for k, line in enumerate(lines):
        if '"' in line and OPENED.search(line) and line.count('"') % 2:
            end = next((j for j in range(k + 1, min(k + 20, len(lines))) if lines[j].count('"') % 2), k)
            lines[k : end + 1] = [" ".join(lines[k : end + 1]), *[""] * (end - k)]
    return lines


class _Table:
    """Rows of numbers in lines of text, from the columns ``wanted``; what stands before them names columns and units.

    columns: where the wanted ones are, None where nothing names them; units: by column, as the header spells them;
    dated: whether the times are a clock's.
    """

    def __init__(self, lines: list[str], wanted: tuple[str, ...]) -> None:
        self.lines, self.wanted = lines, wanted
        self.columns: list[int] | None = None
        self.units: list[str] = [""] * len(wanted)
        self.header: list[str] = []  # the names of all columns
        self.blanks = False  # whether these are parted by blanks
        first = _first_row(lines, min(len(wanted), 3))
        stripped = [line.strip(" \t,;") for line in lines]
        rows = [k for k in range(first, len(lines)) if stripped[k]]
        self.body = [k for k in rows if not (stripped[k][0] in "#%/" and COMMENT.match(lines[k]))]
        self.separator = self._separator(lines[first - 1] if first else "")
        self.widths = {len(self._split(lines[k], self.separator)) for k in self.body[:20]}
        head = [k for k in range(first) if stripped[k] and not stripped[k].startswith("sep=")]
        plain = [k for k in head if not COMMENT.match(lines[k])]
        for k in sorted(head[::-1], key=self._is_prose):
            unnamed = self.columns is None
            self._name(lines[k])
            if unnamed and self.columns is not None:  # rows that hold no numbers enough are to be refused, not left out
                self.body = [other for other in plain if other > k and _numbers(lines[other])] + self.body
                self.body = [other for other in self.body if stripped[other] != stripped[k]]  # the header again
                head.remove(k)
        self.about = {k: lines[k].lower() for k in head}
        if plain and not self.body:
            shown = f"line {plain[-1] + 1} holds '{stripped[plain[-1]][:SHOWN]}'"
            parted = "it has no row of numbers parted by commas, semicolons, tabs or blanks"
            raise ValueError(f"{parted} for each of {', '.join(wanted)}; {shown}")
        if plain and self.columns is None and _numbers(lines[plain[-1]]):
            shown = f"line {plain[-1] + 1} holds '{lines[plain[-1]].strip()[:SHOWN]}'"
            raise ValueError(f"{shown}: it must have {', '.join(wanted)}, or name the columns")
        naming = plain[::-1] or [k for k in head[::-1] if self._is_header(lines[k])]
        if naming and self.columns is None:
            names = max((self._names(lines[k]) for k in naming), key=self._found)
            shown = ", ".join(name or "(no name)" for name in names)[:LONGEST]
            raise ValueError(f"its columns are {shown}; they must be {', '.join(wanted)}")
        if self.columns is None and len(self.units) != len(wanted):
            self.units = [""] * len(wanted)
        if len(set(self.units[1:])) > 1:
            shown = ", ".join(unit or "no unit" for unit in self.units[1:])
            raise ValueError(f"its header gives {', '.join(wanted[1:])} in {shown}; give all in one unit")
        self.dated = wanted[0] == "time" and bool(self.body) and _seconds(self._chosen(self.body[0])[0]) is not None
        self._check(first)

    def _check(self, first: int) -> None:
        """Refuse rows in which columns have been shifted, and numbers that count the columns."""
        rows, named = [self._split(self.lines[k], self.separator) for k in self.body[:20]], len(self.header)
        short = self.blanks and max(map(len, rows), default=named) < named
        for k, row in zip(self.body, rows, strict=False):
            note = not self.separator and not all(map(_is_entry, row[named - 1 : named + 1]))  # of several words
            if named and (short or (len(row) > named and not note)):
                shown = f"line {k + 1} has {len(row)} entries, but the header names {named} columns"
                comma = ", or part them by ; if , is the decimal mark" if self.separator == "," else ""
                how = " in one word" if self.blanks else comma
                raise ValueError(f"{shown}, {', '.join(self.header)[:LONGEST]}; name each column{how}")
        counted = rows and len(rows[0]) > 2 and rows[0] == [str(column) for column in range(len(rows[0]))]
        if counted and not named and any("." in entry for row in rows[1:2] for entry in row):
            raise ValueError(
                f"line {first + 1} numbers the columns; delete it, or name them {', '.join(self.wanted)} there"
            )

    def _separator(self, above: str) -> str | None:
        """What parts the columns, None for blanks: that by which most of the first rows are numbers, or else that of
        the line ``above``."""

        def rows(separator: str | None) -> tuple[int, int, int]:
            parts = [self._split(self.lines[k], separator) for k in self.body[:20]]
            good = sum(len(row) >= len(self.wanted) and all(map(_is_entry, row)) for row in parts)
            return good, above.count(separator or " "), len(parts[0]) if parts else 0

        return max((";", "\t", ",", None), key=rows)

    def _split(self, line: str, separator: str | None) -> list[str]:
        """The entries of a row, without quotes, a remark behind them and empty ones at its end."""
        row = _entries(line, separator) if separator else line.split()
        row = [entry.strip().strip("\"'") for entry in row]
        if "#" in line or "//" in line:
            enough = max(self.columns or [len(self.wanted) - 1])
            for k, entry in enumerate(row):
                if (match := REMARK.match(entry)) and (_is_entry(match[1]) if match[1] else k > enough):
                    row = [*row[:k], match[1]]
                    break
        while row and not row[-1]:
            row.pop()
        return row

    def _found(self, names: list[str]) -> int:
        """How many columns are the wanted ones."""
        return len({ranked[0][-1] for wanted in self.wanted if (ranked := _ranked(wanted, names))})

    def _is_prose(self, k: int) -> bool:
        """Whether a line is a comment of another number of words than rows have entries."""
        line = self.lines[k]
        return bool(COMMENT.match(line) and not _mark(line) and len(self._names(line)) not in self.widths)

    def _is_header(self, line: str) -> bool:
        """Whether a comment names columns, if perhaps not the wanted ones."""
        names = self._names(line)
        if len(names) not in self.widths or not all(map(NAME.match, names)):
            return False
        bare = [len(_parts(name)) == self._found([name]) == 1 for name in names]
        return self._found(names) > 1 or any(bare if _mark(line) else bare[:1])

    def _names(self, line: str) -> list[str]:
        """The names in a line; where only so each entry has one, without a word or mark before them or a remark behind
        them, or parted by "and"."""
        line = re.sub(r"^[\[({]([^\[\](){}]*)[\])}]$", r"\1", COMMENT.sub("", line).strip())
        names = _fields(line)
        for pattern, new in ((LEAD, ""), (r"\s(#|//).*", ""), (r",?\s+(and|und)\s+", ", ")):
            if len(names) not in self.widths and len(fewer := _fields(re.sub(pattern, new, line))) in self.widths:
                names = fewer
        return names

    def _chosen(self, k: int) -> list[str]:
        """The entries of a line in the wanted columns, or all where nothing names these."""
        row = self._split(self.lines[k], self.separator)
        return [row[column] if column < len(row) else "" for column in self.columns or range(len(row))]

    def _name(self, line: str) -> None:
        """Take the columns, or their units, from a line before the numbers, if it names them."""
        names = self._names(line)
        units = [entry.strip("[]() ") for entry in names]
        known = {entry.lower() for entry in units} <= UNITS | OTHERS
        if self.columns is not None:
            if known and len(units) == len(self.header):  # a row of units above the names
                self.units = [unit or units[column] for unit, column in zip(self.units, self.columns, strict=True)]
        elif known or self._found(names) < len(self.wanted):
            if known or not (COMMENT.match(line) or _numbers(line)):
                self.units = units  # perhaps a row of units under the names
        else:
            self.columns, self.header = [_column(name, names) for name in self.wanted], names
            self.blanks = not _mark(COMMENT.sub("", line))
            under = self.units if len(self.units) == len(names) else [""] * len(names)
            self.units = [_unit(names[column]) or under[column] for column in self.columns]

    def unit(self, style: Format, key: str, allowed: dict[str, float], column: int, otherwise: str) -> str | None:
        """The unit of a column by style and header, None where neither tells it. Refuses to go by ``otherwise`` where
        a line about the file speaks of another one."""
        given, said = getattr(style, key), self.units[column].strip("-").lower()
        said, units = SPELT.get(said, said), ", ".join(allowed)
        if not (given or said):
            for k, line in self.about.items():
                for match in SAID.finditer(line):
                    word = SPELT.get(match[1] or match[2], match[1] or match[2])
                    if word != otherwise and (word in allowed or word in (OTHERS if column else OTHER_TIMES)):
                        right = f"set {key}={word}" if word in allowed else f"convert to one of {units} and set {key}="
                        right = "give positions" if column and word in NO_LENGTHS else right
                        raise ValueError(
                            f"line {k + 1} says '{match[0]}', and no column has a unit; {right} if that is "
                            f"the one of its {'lengths' if column else 'times'}, else {key}={otherwise}"
                        )
        shown = f"its header gives {self.wanted[column]} in {said}"
        if column and (said in NO_LENGTHS or re.search(r"[^\W\d]\s*/", said)):
            raise ValueError(f"{shown}, which is no length; give positions")
        if said in CONVERTED or said[:1].isdigit() or (said in RELATIVE and not given):
            raise ValueError(f"{shown}; convert it to one of {units}")
        if said and said not in allowed and not given:
            raise ValueError(f"{shown}; set {key}= to {units}")
        if given and said in allowed and said != given:
            raise ValueError(f"{shown}, not in {given}; set {key}={said}")
        return given or said or None

    def data(self) -> tuple[Array, Array]:
        """The wanted columns (N, d) and the number of each row's line."""
        rows = [self.lines[k] for k in self.body]
        if len(rows) < FEWEST:
            raise ValueError(f"it has {len(rows)} samples; there must be at least {FEWEST}")
        data, text = np.empty((0, 0)), "\n".join(rows) if self.separator != "," else ""
        if not (re.search(r"\d,\d", text) and re.search(r"\d\.\d", text)):
            rows = text.replace(",", ".").split("\n") if "," in text else rows
            with contextlib.suppress(ValueError):  # what cannot be read so is read row by row
                data = np.loadtxt(
                    rows, delimiter=self.separator, usecols=self.columns, comments=None, quotechar='"', ndmin=2
                )
        numbers = np.array(self.body) + 1
        if data.shape[1] != len(self.wanted) or not np.isfinite(data).all():
            data, numbers = self._row_by_row()
        return data, numbers

    def _row_by_row(self) -> tuple[Array, Array]:
        """The same slowly, with a sentence for the first line that cannot be used; empty rows are left out."""
        wanted, data, numbers, marks = ", ".join(self.wanted), [], [], set[str]()
        for k in self.body:
            row = self._split(self.lines[k], self.separator)
            if not row:
                continue
            if len(row) != len(self.wanted) and self.columns is None:
                raise ValueError(
                    f"line {k + 1} has {len(row)} numbers; it must have {wanted}, or a first line must name the columns"
                )
            chosen = self._chosen(k)
            if self.dated and (instant := _seconds(chosen[0])) is not None:
                chosen[0] = instant
            marks |= {mark for entry in chosen[self.dated :] for mark in ".," if mark in entry}
            if not all(map(_is_number, map(_point, chosen))) or len(marks) > 1:
                must = "every entry must be a finite number; delete the row or fill it in"
                if ":" in chosen[0]:
                    must = "its time must be a number, or all be as 2026-11-28T10:00:00.25 or 10:00:00.25"
                elif len(marks) > 1:
                    must = "numbers must have either . or , and no mark between thousands"
                raise ValueError(f"line {k + 1} holds '{self.lines[k].strip()[:SHOWN]}': {must}")
            data.append([float(_point(entry)) for entry in chosen])
            numbers.append(k + 1)
        return np.array(data).reshape(-1, len(self.wanted)), np.array(numbers)


def _mark(line: str) -> str | None:
    """What parts the entries of a header, None for blanks."""
    return next((mark for mark in ";\t," if mark in line), None)


def _fields(line: str) -> list[str]:
    """Entries of a header, whatever parts them; a unit in brackets stays with its name."""
    line = re.sub(r"(?<=[^\s\])])\s+([\[(])", r"\1", line.strip())
    words = re.findall(r"""(?:"[^"]*"|[\[(][^\])]*[\])]|\S)+""", line)
    row = _entries(line, mark) if (mark := _mark(line)) else words
    return [entry.strip(" \"'") for entry in row]


def _entries(line: str, separator: str) -> list[str]:
    """The entries of a line; of one that is quoted as a whole, too."""
    row = next(csv.reader([line], delimiter=separator))
    return next(csv.reader(row, delimiter=separator)) if len(row) == 1 and separator in row[0] else row


def _parts(name: str) -> list[str]:
    """The words of a column's name in small letters, without its unit; posX are two."""
    name = re.sub("(?<=[a-z])(?=[A-Z])", " ", re.sub(r"[\[(].*", "", name))
    return [word for word in re.split(r"[\W_]+", name.lower()) if word]


def _unit(name: str) -> str:
    """The unit in a column's name: in brackets, or the last word behind the first that is one; empty where none is."""
    if bracket := re.search(r"[\[(]([^\])]*)", name):
        return re.sub(r"^in\s+", "", bracket[1].strip())
    first, *rest = _parts(name) or [""]
    found = next((word for word in reversed(rest) if word in (UNITS | OTHERS) - TIME), "")
    return found or (first if rest and first in OTHERS else "")


def _ranked(wanted: str, names: Sequence[str]) -> list[tuple[bool, bool, bool, bool, int]]:
    """The columns that have the wanted word, first those that have no other than a unit, a place's before others."""
    ranked = []
    plain = TIME if wanted == "time" else {wanted}
    for column, name in enumerate(names):
        words = {*_parts(name)}
        if words & (plain | OFTEN[wanted]) and not words & NO_PLACE:
            more = words - plain - OFTEN[wanted] - PLACE - (UNITS | OTHERS) | words & {"min"}
            ranked.append((not words & plain, bool(more), not PLACE & words, len(words) > 1, column))
    return sorted(ranked)


def _column(wanted: str, names: Sequence[str]) -> int:
    """Which of the names is the wanted column, the first of those ranked. Refuses several of the same rank."""
    ranked = _ranked(wanted, names)
    first, *others = (column for *rank, column in ranked if rank == [*ranked[0][:-1]])
    nano = [column for column, name in enumerate(names) if wanted == "time" and NANO & {*_parts(name)}]
    whole = [column for column in (first, *others) if WHOLE & {*_parts(names[column])}]
    one, other = (whole[0], nano[0]) if nano and whole else (first, *others, first)[:2]
    both = f"{names[one]} and {names[other]} (columns {one + 1} and {other + 1})"
    if nano and whole:
        raise ValueError(f"its time is split into {both}; give it in one column, 1e-9 times the nanoseconds added")
    if others:
        raise ValueError(f"its columns {both} could both be {wanted}; rename one")
    return first


def _check(time: Array, position: Array, numbers: Array, tick: str | None) -> None:
    """Refuse what is no movement over time; ``numbers``: lines of the samples; ``tick``: the unit of time, if told."""
    if len(time) < FEWEST:
        raise ValueError(f"it has samples of {len(time)} instants; there must be at least {FEWEST}")
    steps = np.diff(time)
    if (late := np.flatnonzero(steps <= 0)).size:
        same = " (duplicates=drop keeps the first of several samples of one instant)" if steps[late[0]] == 0 else ""
        raise ValueError(f"its time does not increase at line {numbers[late[0] + 1]}{same}")
    total, usual = time[-1], np.median(steps)
    long = steps > PAUSE * np.maximum(usual, (total - steps) / max(len(steps) - 1, 1))
    if steps[long].sum() > total / 3:
        worst = int(np.argmax(steps))
        raise ValueError(
            f"line {numbers[worst + 1]} comes {steps[worst]:.6g} s after the line before, where the usual step is "
            f"{usual:.3g} s; delete what does not belong to the movement (or set time_unit= if its stamps are not in s)"
        )
    if tick is None and usual >= 1 and total > LONG:
        likely = "ms" if usual < 1e3 else "us" if usual < 1e6 else "ns"
        raise ValueError(
            f"line {numbers[1]} comes {steps[0]:.6g} s after the line before, and all take {total:.6g} s; set "
            f"time_unit={likely} if that is the unit of its stamps, time_unit=s if it is as slow as that"
        )
    if total < SHORT:
        raise ValueError(
            f"it lasts {total:.3g} s from line {numbers[0]} to {numbers[-1]}; its unit of time must be another"
        )
    _check_near(position, numbers)
    if not np.ptp(position, axis=0).any():
        raise ValueError("it never moves: all its samples are at one place")


def _check_near(position: Array, numbers: Array) -> None:
    """Refuse a place that no hand can reach; ``numbers``: lines of the places."""
    away = np.abs(position).max(axis=1)
    if (far := np.flatnonzero(away > FAR)).size:
        raise ValueError(f"line {numbers[far[0]]} is {away[far[0]]:.3g} m away; mend it, or set unit=")


def resampled(time: ArrayLike, position: ArrayLike, samples: int) -> Array:
    """The path (samples, d) at equal steps from its first instant to its last, by monotone cubic interpolation."""
    time = np.asarray(time, dtype=float)
    path: Array = PchipInterpolator(time, np.asarray(position, dtype=float))(np.linspace(time[0], time[-1], samples))
    return path


def matching(pattern: str) -> list[str]:
    """The file of that name or, where there is none, the files that a pattern such as ``letters/*.csv`` matches."""
    name = os.path.expanduser(pattern)  # "~t.csv" is the home of nobody
    return [name] if os.path.exists(name) else sorted(glob.glob(name))


def demonstrations(
    files: str | Sequence[str], count: int, samples: int, style: Format, axes: int, otherwise: str = "m"
) -> list[Array]:
    """``count`` recorded paths (samples, axes) [m], the files one after another and over again.

    files: a name, a pattern such as ``letters/*.csv``, or a list of them. Raises ValueError as :func:`read_path` does,
    and where there are more files than ``count``.
    """
    patterns = [files] if isinstance(files, str) else list(files)
    if folder := next((name for name in patterns if os.path.isdir(os.path.expanduser(name))), None):
        raise ValueError(f"'{folder}' is a folder; give its files, such as {os.path.join(folder, '*.csv')}")
    found = [name for pattern in patterns for name in matching(pattern) or [pattern]]
    if len(found) > count:
        raise ValueError(f"{len(found)} files are more than the {count} demonstrations of the experiment")
    paths = [resampled(*read_path(name, style, axes, otherwise), samples) for name in found]
    for name, path in zip(found, paths, strict=True):
        if (span := float(np.ptp(path, axis=0).max())) > WIDE:
            warnings.warn(f"'{name}' spans {span:.3g} m; set unit= if no hand went as far as that", stacklevel=2)
    return [paths[k % len(paths)] for k in range(count)]


def _first_row(lines: Sequence[str], enough: int) -> int:
    """The first line with enough numbers; one with words, too, is about the recording if the next one has too few."""
    rows = (k for k, line in enumerate(lines) if line.strip(" \t,;") and not COMMENT.match(line))
    found = len(lines)
    for k in rows:
        if (full := _numbers(lines[k]) >= enough) and found < len(lines):
            break
        found = k if full else len(lines)
        if full and not re.search("[a-z]{2}", lines[k]):
            break
    return found


def _numbers(line: str) -> int:
    """How many entries of a line are numbers, whatever parts them."""
    return sum(re.fullmatch(r"[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?|nan|[-+]?inf|" + STAMP, entry) is not None
               for entry in re.split(r"""[;,\s"']+""", line.lower()))  # fmt: skip


def _point(entry: str) -> str:
    """A number with a decimal point in the place of a comma."""
    return entry.replace(",", ".")


def _seconds(entry: str) -> str | None:
    """A date with a clock's time, or this alone, as seconds; None for what is neither."""
    if not re.fullmatch(STAMP, entry.lower()):
        return None
    with contextlib.suppress(ValueError):  # such as the 31st of February
        days, _, entry = entry.rpartition(" days ") if " days " in entry else entry.rpartition(" day ")
        date = datetime.fromisoformat(entry if "-" in entry[:5] else f"1970-01-01T{'0' * (entry[1] == ':')}{entry}")
        return repr(86400 * int(days or 0) + (date if date.tzinfo else date.replace(tzinfo=UTC)).timestamp())
    return None


def _is_entry(text: str) -> bool:
    return _is_number(_point(text)) or _seconds(text) is not None


def _is_number(text: str) -> bool:
    try:
        return bool(np.isfinite(float(text)))
    except ValueError:
        return False
