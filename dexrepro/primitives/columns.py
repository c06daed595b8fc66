"""Names and units of the columns of a table, as the lines before its rows spell them."""

from __future__ import annotations

import re
from collections.abc import Sequence

from dexrepro.primitives.tables import CLOCKS, COMMENT, SHOWN, Table, entries, is_entry, mark_in, numbers_in

LENGTHS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254}
TIMES = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0}
SPELLINGS = {"inch": "in inches", "m": "meter meters metre metres metern", "min": "minute minutes minuten",
             "cm": "centimeter centimeters centimetre centimetres zentimeter zentimetern",
             "mm": "millimeter millimeters millimetre millimetres millimetern",
             "s": "sec secs second seconds sekunde sekunden",
             "ms": "msec msecs millisec millisecs millisecond milliseconds millis millisekunden",
             "us": "µs μs usec usecs microsec microsecs microsecond microseconds micros mikrosekunden",
             "ns": "nsec nsecs nanosec nanosecs nanosecond nanoseconds nanos nanosekunden"}  # fmt: skip
SPELT = {word: unit for unit, words in SPELLINGS.items() for word in words.split()}
ANGLES = {"deg", "degree", "degrees", "rad", "radian", "radians"}
RELATIVE = {"norm", "normalised", "normalized"}
OTHER_TIMES = {"hour", "hours", "hrs", "day", "days"}
OTHER_LENGTHS = {"um", "µm", "μm", "micrometers", "micrometres", "microns", "dm", "km", "ft", "feet"}
OTHERS = {*ANGLES, *RELATIVE, *OTHER_LENGTHS, "px", "pixel", "pixels", "mps"}
NO_LENGTHS = {*ANGLES, *TIMES, "mps", "hz", "n", "v", "mv", "volts", "a", "ma", "amps", "w", "kg", "pa"}
CONVERTED = {*OTHER_LENGTHS, *OTHER_TIMES, "h", "hr", "d", "nm", "frame", "frames"}  # by hand
UNITS = {"", "-", *LENGTHS, *TIMES, *SPELT, *OTHERS}  # at the end of a name, or in a row of units
SAID = re.compile(r"(?:\bin|\bunits?)\W+(?:are|is)?\W*([a-zµμ]+)\b|[\[(]([a-zµμ]+)[\])]")  # units in words about a file
QUANTITIES = {  # by the key that sets the unit: which wanted column tells it, its plural, units, and words of others
    "time_unit": (0, "times", TIMES, OTHER_TIMES),
    "unit": (1, "lengths", LENGTHS, OTHERS),
}
OTHER_LETTERS = {"b", "g", "m", "t"}  # before a coordinate: of a magnetic field, gravity, a moment, a torque
NAMES = {  # of a wanted column: its plain ones, those that count where no column has one, and what begins no name of it
    "time": (
        {"time", "t", "timestamp", "timestamps", "stamp", "sec", "secs", "seconds", "zeit"}, {"elapsed"},
        set[str]()),
    **{axis: ({axis}, {f"p{axis}", f"pos{axis}", f"{axis}pos"}, OTHER_LETTERS) for axis in "xyz"},
}  # fmt: skip
TIMELY = re.compile(r"(time|zeit)\w+|\w+(time|zeit|stamp)")  # a word of several: Zeitstempel, datetime
TICKS = {word for unit in ("ms", "us", "ns") for word in (unit, *SPELLINGS[unit].split())}  # name a column of times
WHOLE = {"sec", "secs", "seconds"}  # of a stamp in two columns
PLACE = {"position", "pos", "posi"}
NO_PLACE = {"rot", "quat", "q", "r", "linear", "vel", "velo", "v", "u", "w", "omega", "dot", "ddot", "d", "dd", "delta",
            "diff", "acce", "acc", "a", "mag", "force", "forces", "f", "error", "errors", "err", "e", "std", "var",
            "cov", "seq", "ori", "tau", "sd", "normal", "scale", "rate"}  # fmt: skip
STEMS = ("orient", "rotat", "rotvec", "angul", "angle", "euler", "quatern", "twist", "veloc", "speed", "geschw",
         "accel", "beschl", "jerk", "gyro", "magnetic", "magnetom", "gravi", "kraft", "torque", "wrench", "moment",
         "impuls", "stiff", "covar", "varian", "sigma", "tilt")  # of more such words  # fmt: skip
DOUBTFUL = ("axis", "axes", "joy", "stick", "thumbst", "button", "motor", "servo", "encod", "current", "volt", "power",
            "press", "temperat", "strain", "sensor", "pwm", "emg", "imu", "adc")  # of what may be none  # fmt: skip
CENTRE = {"center", "centre"}  # of gravity: this is a place
NAME = re.compile(  # neither a number nor prose
    r"(?!(in|of|for|at|per|the|over|from|versus|and|und)\b|.*\b(is|are|by|to)\b)[^\W\d]", re.IGNORECASE
)
BESIDE = (  # what stands in a header beside the names, and what these are parted by without it
    (re.compile(r"^([^:=]*[:=]|rem\b|[^\w\s\[(\"']+)\s+", re.IGNORECASE), ""),  # "columns: t x y", "REM t x y", "! t x"
    (re.compile(r"\s(#|//).*"), ""),
    (re.compile(r",?\s+(and|und)\s+"), ", "),
)
LATEST = 30  # lines from the first with numbers on in which the names may stand
ABOVE = 5  # lines above the names in which the row of kinds may stand
LONGEST = 300  # letters of a header in a sentence


def words_in(name: str) -> list[str]:
    """The words of a column's name in small letters, without its unit; posX are two."""
    name = re.sub("(?<=[a-z])(?=[A-Z])", " ", re.sub(r"[\[(].*", "", name))
    return [word for word in re.split(r"[\W_]+", name.lower()) if word]


def unit_in(name: str) -> str:
    """The unit in a column's name: in brackets, or the last word behind the first that is one; empty where none is.

    x_in is in inches, x_in_world in what the name does not tell."""
    if bracket := re.search(r"[\[(]([^\])]*)", name):
        return re.sub(r"^in\s+", "", bracket[1].strip())
    first, *rest = words_in(name) or [""]
    rest = [word for word in rest[:-1] if word != "in"] + rest[-1:]
    found = next((word for word in reversed(rest) if word in UNITS - NAMES["time"][0]), "")
    return found or (first if first in (OTHERS if rest else TICKS) else "")


def are_units(names: Sequence[str]) -> bool:
    """Whether these are the units of columns rather than their names."""
    return {name.strip("[]() ").lower() for name in names} <= UNITS


def no_place(word: str) -> bool:
    """Whether a word is of another quantity than a place."""
    return word in NO_PLACE or word.startswith(STEMS)


def _more_words(wanted: str, names: Sequence[Sequence[str]]) -> set[str]:
    """Words of these names that mean the wanted column, too: compounds of time, a unit of it that stands alone; tx
    where a rotation stands beside it and no force, as whose torque it would count."""
    words = {word for name in names for word in name}
    if wanted == "time":
        return {name[0] for name in names if len(name) == 1} & TICKS | {*filter(TIMELY.fullmatch, words)}
    return {f"t{wanted}"} if words & {"qx", "rx"} and not words & {"fx", "force"} else set()


def ranked(wanted: str, names: Sequence[str]) -> list[tuple[bool, bool, bool, bool, int]]:
    """The columns that have the wanted word, first those that have no other than a unit, a place's before others."""
    result, (plain, often, never) = [], NAMES[wanted]
    often = often | _more_words(wanted, [*map(words_in, names)])
    for column, name in enumerate(names):
        first, words = {*words_in(name)[:1]}, {*words_in(name)}
        other = {word for word in words if no_place(word)} - ({"gravity"} if words & CENTRE else set())
        if first == {"p"}:  # the position, of which frames stand behind it: p_RS_R_x
            other = {word for word in other if len(word) > 2}
        if words & (plain | often) and not (other or first & never):
            more = words - plain - often - PLACE - UNITS | words & {"min"}
            result.append((not words & plain, bool(more), not PLACE & words, len(words) > 1, column))
    return sorted(result)


def column_of(wanted: str, names: Sequence[str]) -> int:
    """Which of the names is the wanted column, the first of those ranked. Refuses several of the same rank."""
    best = ranked(wanted, names)
    first, *others = (column for *rank, column in best if rank == [*best[0][:-1]])
    small = [{"us", "ns"} & {*map(SPELT.get, words_in(name))} for name in names if wanted == "time"]
    parts = [column for column, units in enumerate(small) if units]
    whole = [column for column in (first, *others) if WHOLE & {*words_in(names[column])}]
    one, other = (whole[0], parts[0]) if parts and whole else (first, *others, first)[:2]
    both = f"{names[one]} and {names[other]} (columns {one + 1} and {other + 1})"
    if parts and whole:
        raise ValueError(f"its time is split into {both}; give it in one column, in s with its fractions")
    if others:
        raise ValueError(f"its columns {both} could both be {wanted}; rename one")
    return first


def _fields(line: str) -> list[str]:
    """Entries of a header, whatever parts them; a unit in brackets stays with its name."""
    line = re.sub(r"(?<=[^\s\])])\s+([\[(])", r"\1", line.strip())
    words = re.findall(r"""(?:"[^"]*"|[\[(][^\])]*[\])]|\S)+""", line)
    row = entries(line, mark) if (mark := mark_in(line)) else words
    return [entry.strip(" \"'") for entry in row]


class Header:
    """What the lines before the rows of a table say of its columns; the table is told where the wanted ones are.

    names: of all columns; units: of the wanted ones, as spelt there. Raises ValueError with half a sentence where they
    leave a doubt.
    """

    def __init__(self, table: Table) -> None:
        self.table = table
        self.names: list[str] = []
        self.units = [""] * len(table.wanted)
        self.blanks = False  # whether the names are parted by blanks
        self._pass_numbers()
        for k in sorted(table.head[::-1], key=self._is_prose):
            self._take(k)
        self._check_named()
        if len(set(self.units[1:])) > 1:
            shown = ", ".join(unit or "no unit" for unit in self.units[1:])
            raise ValueError(f"its header gives {', '.join(table.wanted[1:])} in {shown}; give all in one unit")
        self._check_places()
        self._check_shifted()

    def _pass_numbers(self) -> None:
        """Let the rows begin behind a line that is the first to name the columns, if no row of nothing but numbers
        stands before it: files of OptiTrack and LabVIEW have numbers with names above their columns."""
        table, first = self.table, min(self.table.body, default=len(self.table.lines))
        rows = [_fields(COMMENT.sub("", line)) for line in table.lines[: first + LATEST]]
        named = [self._found(row) == len(table.wanted) for row in rows]
        for k in range(first, first if True in named[:first] else len(rows)):
            if named[k] and not numbers_in(table.lines[k]):
                return table.rows_behind(k + 1)
            if (row := _fields(table.lines[k])) and all(map(is_entry, row)):
                break

    def _found(self, names: list[str]) -> int:
        """How many columns are the wanted ones."""
        return len({best[0][-1] for wanted in self.table.wanted if (best := ranked(wanted, names))})

    def _names(self, line: str) -> list[str]:
        """The names in a line; where only so each entry has one, without what stands beside them."""
        line = re.sub(r"^[\[({]([^\[\](){}]*)[\])}]$", r"\1", COMMENT.sub("", line).strip())
        names, widths = _fields(line), self.table.widths
        for pattern, new in BESIDE:
            if len(names) not in widths and len(fewer := _fields(pattern.sub(new, line))) in widths:
                names = fewer
        return names

    def _grouped(self, k: int) -> list[str]:
        """The names in a line, each behind the kind of its columns where a row of kinds stands above: Rotation X."""
        lines, mark = self.table.lines, mark_in(self.table.lines[k])
        names = self._names(lines[k])
        for line in reversed(lines[max(k - ABOVE, 0) : k] if mark and not are_units(names) else []):
            kinds = [entry.strip(" \"'") for entry in entries(line, mark or "")]
            words = {word for kind in kinds[1:] for word in words_in(kind) if len(word) > 1}
            is_kind = any(word in PLACE or no_place(word) for word in words)
            if len(kinds) == len(names) > len({*kinds}) and is_kind and not numbers_in(line):
                for column, kind in enumerate(kinds[1:], 1):  # one that is written once goes for those behind it, too
                    kinds[column] = kind or kinds[column - 1]
                parts = [re.split(r"(?=[\[(])", kind, maxsplit=1) for kind in kinds]  # a unit stays behind
                return [f"{kind.strip()} {name}{''.join(unit)}".strip() for (kind, *unit), name in zip(parts, names)]
        return names

    def _is_prose(self, k: int) -> bool:
        """Whether a line is a comment of another number of words than rows have entries."""
        line = self.table.lines[k]
        return bool(COMMENT.match(line) and not mark_in(line) and len(self._names(line)) not in self.table.widths)

    def _is_header(self, line: str) -> bool:
        """Whether a comment names columns, if perhaps not the wanted ones."""
        names = self._names(line)
        bare = [len(words_in(name)) == self._found([name]) == 1 and not are_units([name]) for name in names]
        found = self._found(names) > 1 or any(bare if mark_in(line) else bare[:1])
        return found and len(names) in self.table.widths and all(map(NAME.match, names))

    def _resemblance(self, k: int) -> tuple[bool, bool, int, int]:
        """How much a line is like a header: no numbers, a name for each column, many of the wanted, many others."""
        line = self.table.lines[k]
        names = self._names(line)
        others = sum(not are_units([name]) for name in names)
        return not numbers_in(line), len(names) in self.table.widths, self._found(names), others

    def _take(self, k: int) -> None:
        """Take the columns, or their units, from a line, if it names them."""
        line, columns = self.table.lines[k], self.table.columns
        names = self._grouped(k)
        units, known = [name.strip("[]() ") for name in names], are_units(names)
        if columns is not None:  # perhaps a row of units above the names, of which others may be of no quantity here
            if len(units) == len(self.names) and are_units([units[column] for column in columns]):
                self.units = [unit or units[column] for unit, column in zip(self.units, columns, strict=True)]
        elif known or self._found(names) < len(self.table.wanted):
            if known or not (COMMENT.match(line) or numbers_in(line)):
                self.units = units  # perhaps a row of units under the names
        else:
            columns = [column_of(name, names) for name in self.table.wanted]
            under = self.units if len(self.units) == len(names) else [""] * len(names)
            self.units = [unit_in(names[column]) or under[column] for column in columns]
            self.names, self.blanks = names, not mark_in(COMMENT.sub("", line))
            self.table.named_by(k, columns)

    def _check_named(self) -> None:
        """Refuse a table without rows, or one whose columns have other names than the wanted."""
        table, wanted = self.table, ", ".join(self.table.wanted)
        last = table.plain[-1] if table.plain else -1
        if table.plain and not table.body:
            parted = f"it has no row of numbers parted by commas, semicolons, tabs or blanks for each of {wanted}"
            raise ValueError(f"{parted}; line {last + 1} holds '{table.stripped[last][:SHOWN]}'")
        if table.columns is not None:
            return
        if table.plain and numbers_in(table.lines[last]):
            shown = f"line {last + 1} holds '{table.lines[last].strip()[:SHOWN]}'"
            raise ValueError(f"{shown}: it must have {wanted}, or name the columns")
        lines = reversed(table.plain or table.head)
        if naming := [k for k in lines if table.plain or self._is_header(table.lines[k])]:
            names = self._grouped(max(naming, key=self._resemblance))
            shown = ", ".join(name or "(no name)" for name in names)[:LONGEST]
            lacking = [one for one in table.wanted if not ranked(one, names)]
            how = "; name the time so, or add it (frame / frame rate)" if lacking == ["time"] else ""
            raise ValueError(f"its columns are {shown}; they must be {wanted}{how}")
        if len(self.units) != len(table.wanted):
            self.units = [""] * len(table.wanted)

    def _check_places(self) -> None:
        """Refuse coordinates that may be of no place, or each of another one."""
        owners, names = dict[frozenset[str], str](), [self.names[column] for column in self.table.columns or ()]
        places = [place for place in zip(self.table.wanted, names, strict=False) if place[0] != "time"]
        for wanted, name in places:
            words = {*words_in(name)}
            if any(word.startswith(DOUBTFUL) for word in words) and not (PLACE & words or any(self.units[1:])):
                raise ValueError(f"its column {name} may be no place; name it {wanted} if it is one, or add its unit")
            if more := words - PLACE - UNITS - CENTRE - NAMES[wanted][0] - NAMES[wanted][1] - {f"t{wanted}"}:
                owners.setdefault(frozenset(more), name)
        if len(owners) > 1:
            shown, wanted = " and ".join(owners.values()), ", ".join(name for name, _ in places)
            raise ValueError(f"its columns {shown} seem to be of several places; name those of one {wanted}")

    def _check_shifted(self) -> None:
        """Refuse rows in which columns have been shifted, and numbers that count the columns."""
        table, named = self.table, len(self.names)
        rows = table.first_rows(table.separator)
        short = self.blanks and max(map(len, rows), default=named) < named
        many = [k for k in table.body if len(table.lines[k].split(table.separator)) > named]
        for k in [*table.body[:short], *many] if named else ():
            row = table.row(k)
            note = not table.separator and not all(map(is_entry, row[named - 1 : named + 1]))  # of several words
            if short or (len(row) > named and not note):
                shown = f"line {k + 1} has {len(row)} entries, but the header names {named} columns"
                comma = ", or part them by ; if , is the decimal mark" if table.separator == "," else ""
                how = " in one word" if self.blanks else comma
                raise ValueError(f"{shown}, {', '.join(self.names)[:LONGEST]}; name each column{how}")
        counted = not named and rows and len(rows[0]) > 2 and rows[0] == [*map(str, range(len(rows[0])))]
        if counted and any("." in entry for row in rows[1:2] for entry in row):
            wanted = ", ".join(table.wanted)
            raise ValueError(f"line {table.body[0] + 1} numbers the columns; delete it, or name them {wanted} there")

    def unit(self, key: str, given: str | None, otherwise: str) -> str | None:
        """The unit of ``unit`` or ``time_unit`` as ``given`` or in the header, None where neither tells it.

        Refuses to go by ``otherwise`` where a line about the file speaks of another one.
        """
        column, plural, allowed, others = QUANTITIES[key]
        said, units = self.units[column].strip("-").lower(), ", ".join(allowed)
        said = SPELT.get(said, said)
        for k in self.table.head if not (given or said) else ():
            for match in SAID.finditer(self.table.lines[k].lower()):
                word = SPELT.get(match[1] or match[2], match[1] or match[2])
                if word != otherwise and (word in allowed or word in others):
                    right = f"set {key}={word}" if word in allowed else f"convert to one of {units} and set {key}="
                    right = "give positions" if column and word in NO_LENGTHS else right
                    shown = f"line {k + 1} says '{match[0]}', and no column has a unit"
                    raise ValueError(f"{shown}; {right} if that is the one of its {plural}, else {key}={otherwise}")
        no_length = column and (said in NO_LENGTHS or re.search(r"[^\W\d]\s*/", said))
        by_hand = said in CONVERTED or said[:1].isdigit() or (said in RELATIVE and not given)
        for wrong, why in (
            (":" in said, f"; write its times as {CLOCKS}"),
            (no_length, ", which is no length; give positions"),
            (by_hand, f"; convert it to one of {units}"),
            (said and said not in allowed and not given, f"; set {key}= to {units}"),
            (given and said in allowed and said != given, f", not in {given}; set {key}={said}"),
        ):
            if wrong:
                raise ValueError(f"its header gives {self.table.wanted[column]} in {said}{why}")
        return given or said or None
