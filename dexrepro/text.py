"""Text from the bytes of a file, whatever program has saved it."""

from __future__ import annotations

import codecs

ARCHIVE = "a spreadsheet or an archive, not text; export or unpack it first"
BINARY = " file, not text; export its numbers as CSV"
PICTURE = "a picture, not text; export its numbers as CSV"
WEB = "a web page; download the file itself that it shows"
MARKS = {codecs.BOM_UTF32_LE: "utf-32", codecs.BOM_UTF32_BE: "utf-32", codecs.BOM_UTF8: "utf-8-sig",
         codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}  # fmt: skip
LFS = "a pointer of Git LFS to the file; run: git lfs pull"
OTHERS = {
    **dict.fromkeys((b"PK\x03\x04", b"\x1f\x8b", b"\xd0\xcf\x11\xe0", b"BZh", b"\xfd7zXZ", b"7z\xbc\xaf", b"Rar!",
                     b"\x28\xb5\x2f\xfd"), ARCHIVE),
    **dict.fromkeys((b"\x89PNG", b"\xff\xd8\xff", b"GIF8", b"II*\0", b"MM\0*"), PICTURE),
    **dict.fromkeys((b"#ROSBAG", b"\x89MCAP"), "a ROS bag, not text; export its topic as CSV"),
    **dict.fromkeys((b"MATLAB 5.0 MAT", b"MATLAB 7.3 MAT"), "a MATLAB" + BINARY),
    **dict.fromkeys((b"<!doctype html", b"<html"), WEB),
    b"\x93NUMPY": "a NumPy" + BINARY, b"\x89HDF": "an HDF5" + BINARY, b"PAR1": "a Parquet" + BINARY,
    b"SQLite format 3": "an SQLite" + BINARY, b"%PDF": "a PDF" + BINARY, b"{\\rtf": "an RTF" + BINARY,
    b"version https://git-lfs": LFS,
}  # fmt: skip


def decoded(data: bytes, encoding: str | None = None) -> str:
    """The text of a file: UTF-8, UTF-16 or UTF-32 by its mark or its zeros, else UTF-8; ``encoding`` if given.

    Zeros at the end, which some programs leave, are dropped. Raises ValueError with half a sentence.
    """
    beginning = data[:100].lstrip()
    for start, what in OTHERS.items():
        if beginning.lower().startswith(start.lower()):
            raise ValueError(f"it is {what}")
    mark = next((name for mark, name in MARKS.items() if data.startswith(mark)), None)
    kind = mark or ("utf-8" if 0 not in data[:2] else "utf-16-be" if data[0] == 0 else "utf-16-le")
    try:
        text = data.decode(encoding or kind).lstrip("\ufeff").rstrip("\0\x1a")
    except LookupError:
        raise ValueError(f"encoding = {encoding} is not allowed: it must be a name such as utf-8 or cp1252") from None
    except UnicodeDecodeError as error:
        if not mark:
            _check(data.decode("latin-1"))
        line = data[: error.start].count(b"\n") + 1
        raise ValueError(
            f"line {line} is not {(encoding or kind).upper()}; save it as UTF-8 or name its encoding, such as cp1252"
        ) from None
    _check(text)
    return text


def _check(text: str) -> None:
    """Refuse what holds signs that only files of numbers, pictures and the like have, or where a disk was cut off."""
    if found := next((sign for sign in map(chr, (*range(9), *range(14, 26))) if sign in text), None):
        line = text.count("\n", 0, text.index(found)) + 1
        raise ValueError(f"it is no text, or damaged: line {line} holds the byte {ord(found):02x}; save it as text")
