"""The book's symbols, written in plain letters beside the parameters in conf/, as HTML."""

from __future__ import annotations

import re

from markupsafe import Markup, escape

_LOWER = (
    "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu "
    "nu xi omicron pi rho varsigma sigma tau upsilon phi chi psi omega"
)
GREEK = {name: chr(0x3B1 + index) for index, name in enumerate(_LOWER.split())}
GREEK |= {name.capitalize(): letter.upper() for name, letter in GREEK.items() if name != "varsigma"}
GREEK |= {"varpi": "\u03d6", "infty": "\u221e"}
_ACCENTS = {"hat": "\u0302", "bar": "\u0304", "under": "\u0332"}
_TOKEN = re.compile(
    r"(?P<script>[_^])(?:\{(?P<group>[^}]*)\}|(?P<word>\w+|\([^)]*\)))|(?P<letters>[A-Za-z]+)|(?P<other>.)"
)
_ACCENTED = re.compile(rf"(?P<base>\w+?)(?P<accent>{'|'.join(_ACCENTS)})?$")


def html(symbol: str) -> Markup:
    """``lambda_1`` with a Greek letter and an index, ``khat_o(0)`` with a hat, ``rho_{1,0}`` with "1,0" below."""
    parts = []
    for token in _TOKEN.finditer(symbol):
        if token["script"]:
            tag = "sub" if token["script"] == "_" else "sup"
            parts.append(f"<{tag}>{html(token['group'] or token['word'])}</{tag}>")
        elif token["letters"]:
            parts.append(f"<i>{_letter(token['letters'])}</i>")
        else:
            parts.append(str(escape(token["other"])))
    return Markup("".join(parts))


def text(symbol: str) -> str:
    """For the search: Greek letters, and the words they are typed as where these differ."""
    greek = re.sub("[A-Za-z]+", lambda match: _letter(match[0]), symbol)
    return symbol if greek == symbol else f"{greek} ({symbol})"


def greek(phrase: str) -> str:
    """A phrase whose words "alpha", "rho", ... are letters; "mu" and "psi" within other words stay."""
    return re.sub(r"(?<![\w.])[A-Za-z]{2,7}(?![A-Za-z.])", lambda match: GREEK.get(match[0], match[0]), phrase)


def _letter(word: str) -> str:
    if word in GREEK:
        return GREEK[word]
    match = _ACCENTED.match(word)
    base, accent = (match["base"], match["accent"] or "") if match else (word, "")
    return GREEK.get(base, base) + _ACCENTS.get(accent, "")
