"""A plain index page over everything in results/."""

from __future__ import annotations

import os
from pathlib import Path

import jinja2

from dexrepro.storage import read_json

_TEMPLATE = jinja2.Environment(autoescape=True).from_string("""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>dexrepro</title>
<style>body{font-family:sans-serif;max-width:60rem;margin:auto;padding:1rem}img{max-width:100%}</style></head><body>
<h1>dexrepro</h1>
{% for result in results %}<h2>{{ result.title }}</h2>
<ul>{% for claim in result.claims %}
<li>{{ claim.id }} {{ claim.statement }}: <b>{{ claim.verdict }}</b></li>{% endfor %}</ul>
{% for figure in result.figures %}<p><img src="{{ figure }}" alt="{{ figure }}"></p>{% endfor %}
{% endfor %}</body></html>
""")


def build(results: Path) -> Path:
    """Write ``results/report/index.html`` and return its path."""
    folder = results / "report"
    folder.mkdir(parents=True, exist_ok=True)
    entries = []
    for run in sorted(results.glob("chapter*/*/run.json")):
        place = run.parent
        entries.append(
            {
                "title": f"{place.parent.name}: {place.name}",
                "claims": read_json(place / "claims.json"),
                "figures": [os.path.relpath(path, folder) for path in sorted((place / "figures").glob("*.png"))],
            }
        )
    page = folder / "index.html"
    page.write_text(_TEMPLATE.render(results=entries))
    return page
