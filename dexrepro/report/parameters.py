"""Parameters as the pages show them: value, unit, origin and the book's symbol, and where each symbol is set."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from dexrepro.cases import resolved_block
from dexrepro.checks import value_at
from dexrepro.provenance import Provenance, origin_of
from dexrepro.report import symbols


def table(
    experiment: str, composed: Mapping[str, Any], origins: Mapping[str, Provenance], run: Mapping[str, Any]
) -> list[dict[str, Any]]:
    """Every parameter of an experiment with its value in the run; ``home`` is the key whose comment names the symbol.

    ``home`` is None without a symbol; ``run`` is the configuration that was run, which may be another than the present.
    """
    rows = []
    used = {key: value for key, value in run.items() if key != "cases"}
    for key, value in _flat(used or resolved_block(composed, experiment), experiment):
        origin, home = origin_of(key, composed, origins)
        rows.append({"key": key, "value": value, "home": home, **shown(origin)})
    return rows


def index(
    composed: Mapping[str, Any], origins: Mapping[str, Provenance], rows: Iterable[Mapping[str, Any]]
) -> list[dict[str, Any]]:
    """A chapter's symbols in order: the key that sets each, and which of ``rows`` follows it in each experiment."""
    used: dict[str, dict[str, str]] = {}
    for row in rows:
        if row["home"]:
            used.setdefault(row["home"], {}).setdefault(row["key"].partition(".")[0], row["key"])
    found = [
        {"key": key, "value": value_of(composed, key), "used": used.get(key, {}), **shown(origin)}
        for key, origin in origins.items()
        if origin.symbol
    ]
    return sorted(found, key=lambda entry: (entry["plain"].lower(), entry["plain"], not entry["used"]))


def shown(origin: Provenance | None) -> dict[str, Any]:
    """Symbol, unit, origin and range as texts, empty where there is none."""
    if origin is None:
        return {"symbol": "", "plain": "", "unit": "", "kind": "", "text": "", "range": ""}
    plain = origin.symbol or ""
    return {"symbol": symbols.html(plain), "plain": plain, "unit": origin.unit, "kind": origin.kind,
            "text": origin.text, "range": origin.bounds}  # fmt: skip


def value_of(node: Any, dotted: str) -> Any:
    """The value of a key in a composed configuration, a block in one line."""
    node = value_at(node, dotted)
    if isinstance(node, Mapping):
        return ", ".join(f"{key}: {value}" for key, value in node.items() if key != "_target_")
    return node


def _flat(node: Mapping[str, Any], prefix: str) -> list[tuple[str, Any]]:
    rows: list[tuple[str, Any]] = []
    for key, value in node.items():
        if isinstance(value, Mapping):
            rows += _flat(value, f"{prefix}.{key}")
        else:
            rows.append((f"{prefix}.{key}", value))
    return rows
