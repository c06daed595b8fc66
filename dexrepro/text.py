"""Text from the bytes of a file, whatever program has saved it."""

from __future__ import annotations

import codecs

ARCHIVE = "a spreadsheet or an archive, not text; export or unpack it first"
BINARY = " file, not text; export its numbers as CSV"
WEB = "a web page; download the file itself that it shows"
MARKS = {codecs.BOM_UTF32_LE: "utf-32", codecs.BOM_UTF32_BE: "utf-32", codecs.BOM_UTF8: "utf-8-sig",
         codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}  # fmt: skip
LFS = "a pointer of Git LFS to the file; run: git lfs pull"
OTHERS = {b"PK\x03\x04": ARCHIVE, b"\x1f\x8b": ARCHIVE, b"\xd0\xcf\x11\xe0": ARCHIVE, b"\x93NUMPY": "a NumPy" + BINARY,
          b"MATLAB 5.0 MAT": "a MATLAB" + BINARY, b"\x89HDF": "an HDF5" + BINARY, b"PAR1": "a Parquet" + BINARY,
          b"#ROSBAG": "a ROS bag, not text; export its topic as CSV", b"version https://git-lfs": LFS,
          b"<!doctype html": WEB, b"<html": WEB}  # fmt: skip


def decoded(data: bytes, encoding: str | None = None) -> str:
    """The text of a file: UTF-8, UTF-16 or UTF-32 by its mark or its zeros, else UTF-8; ``encoding`` if given.

    Zeros at the end, which some programs leave, are dropped. Raises ValueError with half a sentence.
    """
    beginning = data[:100].lstrip()
    for mark, what in OTHERS.items():
        if beginning.lower().startswith(mark.lower()):
            raise ValueError(f"it is {what}")
    kind = next((name for mark, name in MARKS.items() if data.startswith(mark)), None)
    if not kind and 0 in data[:2]:
        kind = "utf-16-be" if data[0] == 0 else "utf-16-le"
    try:
        return data.decode(encoding or kind or "utf-8").lstrip("\ufeff").rstrip("\0\x1a")
    except LookupError:
        raise ValueError(f"encoding = {encoding} is not allowed: it must be a name such as utf-8 or cp1252") from None
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        wanted = (encoding or kind or "utf-8").upper()
        raise ValueError(
            f"line {line} is not {wanted}; save it as UTF-8 or name its encoding, such as cp1252"
        ) from None
