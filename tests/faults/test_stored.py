"""Files that are damaged, foreign or missing: run again with a word, or named in one sentence; nothing else is lost."""

from __future__ import annotations

import gzip
import json
import os
import random
import resource
import shutil
import time
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from conftest import Command

from dexrepro import baselines
from dexrepro.damage import is_safe
from dexrepro.errors import InputError
from dexrepro.storage import read_json, write_json
from dexrepro.study import samples

pytestmark = pytest.mark.usefixtures("bounded")
Damage = Callable[[Path], object]
RESULT = Path("results/chapter90/decay")


def text(name: str, content: str | bytes) -> Damage:
    return lambda folder: (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())


def short(name: str, size: int) -> Damage:
    return lambda folder: (folder / name).write_bytes((folder / name).read_bytes()[:size])


def gone(name: str) -> Damage:
    def remove(folder: Path) -> None:
        shutil.rmtree(folder / name) if (folder / name).is_dir() else (folder / name).unlink()

    return remove


def flipped(name: str) -> Damage:
    def flip(folder: Path) -> None:
        content = bytearray((folder / name).read_bytes())
        content[len(content) // 2] ^= 255
        (folder / name).write_bytes(content)

    return flip


def pipe(name: str) -> Damage:
    return lambda folder: ((folder / name).unlink(), os.mkfifo(folder / name))


def link_to_itself(name: str) -> Damage:
    return lambda folder: ((folder / name).unlink(), (folder / name).symlink_to(Path(name).name))


def changed(name: str, change: Callable[[dict], object]) -> Damage:
    def edit(folder: Path) -> None:
        data = read_json(folder / name)
        change(data)
        write_json(folder / name, data)

    return edit


# ----------------------------------------------------------------------------------------------------------- the cache

CACHE = {
    "empty": text("case.json", ""),
    "cut short": short("case.json", 200),
    "a list": text("case.json", "[]"),
    "null": text("case.json", "null"),
    "binary": text("case.json", b"\xff\xfe\x00"),
    "no entry": changed("case.json", lambda data: data.pop("entry")),
    "other entry": changed("case.json", lambda data: data.update(entry={"wall": 1})),
    "no metrics": changed("case.json", lambda data: data.update(metrics=None)),
    "no files": changed("case.json", lambda data: data.pop("files")),
    "no case.json": gone("case.json"),
    "series cut short": short("series/plain.csv.gz", 100),
    "series empty": text("series/plain.csv.gz", b""),
    "series gone": gone("series/plain.csv.gz"),
    "no series": gone("series"),
    "a flipped byte": flipped("series/plain.csv.gz"),
}


@pytest.mark.parametrize("kind", CACHE)
def test_a_damaged_case_is_run_again_with_a_word(toy_result: Path, command: Command, kind: str) -> None:
    before = (toy_result / "metrics.json").read_bytes()
    shutil.rmtree(toy_result)
    CACHE[kind](next(Path("results/.cache/decay").glob("plain-*")))
    status, said = command("run workers=1")
    assert status == 0, said
    assert "decay.plain is damaged in results/.cache/decay: run again" in said
    assert "decay.fast:" not in said, "the others are still there"
    assert (toy_result / "metrics.json").read_bytes() == before


def test_a_cached_series_is_never_the_file_that_a_user_may_edit(toy_result: Path, command: Command) -> None:
    cached = next(Path("results/.cache/decay").glob("plain-*/series/plain.csv.gz"))
    assert cached.stat().st_nlink == (toy_result / "series/plain.csv.gz").stat().st_nlink == 1
    before = cached.read_bytes()
    with open(toy_result / "series/plain.csv.gz", "ab") as file:
        file.write(b"edited")
    assert cached.read_bytes() == before


WHOLE = {
    "metrics.json gone": gone("metrics.json"),
    "claims.json empty": text("claims.json", ""),
    "config.yaml gone": gone("config.yaml"),
    "a series gone": gone("series/fast.csv.gz"),
    "run.json null": text("run.json", "null"),
    "run.json cut short": short("run.json", 300),
    "run.json of another": changed("run.json", lambda data: data.update(contents={"plain": "0"})),
    "run.json of old": changed("run.json", lambda data: data.pop("contents")),
    "of other packages": changed("run.json", lambda data: data["packages"].update(numpy="1.0")),
}


@pytest.mark.parametrize("kind", WHOLE)
def test_a_result_that_is_not_whole_is_assembled_again(toy_result: Path, command: Command, kind: str) -> None:
    before = {name: (toy_result / name).read_bytes() for name in ("metrics.json", "claims.json", "config.yaml")}
    WHOLE[kind](toy_result)
    status, said = command("run workers=1")
    assert status == 0, said
    assert "decay.plain:" not in said, "nothing is simulated"
    assert {name: (toy_result / name).read_bytes() for name in before} == before


# --------------------------------------------------------------------------------------------------------- the results

BOMB = "a: &a [x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{new}: &{new} [{', '.join(['*' + old] * 9)}]\n" for old, new in zip("abcdefghijk", "bcdefghijkl", strict=True)
)


def chunk(kind: bytes, data: bytes) -> bytes:
    return len(data).to_bytes(4) + kind + data + zlib.crc32(kind + data).to_bytes(4)


SIZE = (60_000).to_bytes(4) * 2 + bytes((8, 2, 0, 0, 0))
PNG_BOMB = (
    b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", SIZE) + chunk(b"IDAT", zlib.compress(b"\0" * 999)) + chunk(b"IEND", b"")
)
DAMAGE: dict[str, tuple[Damage, str, str]] = {
    "run empty": (text("run.json", ""), "check", "run.json cannot be used"),
    "run a number": (text("run.json", "5"), "report", "run.json cannot be used"),
    "run of no chapter": (changed("run.json", lambda d: d.update(chapter="77")), "draw", "'decay' in a chapter '77'"),
    "run of no experiment": (changed("run.json", lambda d: d.update(experiment="x")), "check", "no experiment 'x'"),
    "chapter a list": (changed("run.json", lambda d: d.update(chapter=[1])), "report", "chapter = "),
    "cases a list": (changed("run.json", lambda d: d.update(cases=[1])), "check", "cases = '[1]' is of another kind"),
    "a case null": (changed("run.json", lambda d: d["cases"].update(plain=None)), "draw", "cases.plain holds no dict"),
    "no packages": (changed("run.json", lambda d: d.pop("packages")), "report", "it has no 'packages'"),
    "metrics a list": (text("metrics.json", "[1]"), "check", "metrics.json cannot be used"),
    "metric a text": (changed("metrics.json", lambda d: d.update({"decay.plain.final": "a"})), "check", "is no number"),
    "metric foreign": (changed("metrics.json", lambda d: d.update({"x": 1})), "report", "x is no number of decay"),
    "metric of 5000 digits": (text("metrics.json", '{"decay.a.b": ' + "9" * 5000 + "}"), "check", "metrics.json"),
    "deep metrics": (text("metrics.json", "[" * 100_000), "check", "metrics.json cannot be used"),
    "claims a dict": (text("claims.json", "{}"), "check", "it has no '0.id'"),
    "a claim a text": (text("claims.json", '["x"]'), "report", "claims.json cannot be used (0 holds no dict)"),
    "margin a text": (changed("claims.json", lambda d: d[0].update(margin="big")), "check", "0.margin is no number"),
    "claims latin": (text("claims.json", b'["\xe9"]'), "check", "claims.json cannot be used"),
    "config a list": (text("config.yaml", "[1]"), "draw", "config.yaml cannot be used (it holds no dict)"),
    "config a bomb": (text("config.yaml", BOMB), "draw", "stands for more than a million values"),
    "config of tabs": (text("config.yaml", "a:\n\tb: 1\n"), "draw", "config.yaml cannot be used"),
    "config deep": (text("config.yaml", "[" * 3000), "draw", "config.yaml cannot be used"),
    "series no gzip": (text("series/plain.csv.gz", "time,x"), "draw", "plain.csv.gz cannot be used"),
    "series cut": (short("series/plain.csv.gz", 200), "draw", "plain.csv.gz cannot be used"),
    "series of nothing": (text("series/plain.csv.gz", gzip.compress(b"")), "draw", "decay"),
    "table cut": (text("tables/T90.1.csv", '"a'), "check", "T90.1.csv cannot be used"),
    "table binary": (text("tables/T90.1.csv", b"\xff\x00\xfe"), "check", "T90.1.csv cannot be used"),
    "table empty": (text("tables/T90.1.csv", ""), "report", "T90.1.csv cannot be used"),
    "metrics a pipe": (pipe("metrics.json"), "show C90.01", "metrics.json cannot be used (it is no file)"),
    "metrics a loop": (link_to_itself("metrics.json"), "check", "metrics.json cannot be used (Too many levels"),
    "metrics of NUL": (text("metrics.json", b"\0" * 99), "show 90.10", "metrics.json cannot be used"),
    "a series a pipe": (pipe("series/fast.csv.gz"), "diff {0} {0}", "fast.csv.gz cannot be used (it is no file)"),
    "a picture a pipe": (pipe("figures/fig_90_10.png"), "report", "fig_90_10.png cannot be used (it is no file)"),
    "a picture cut": (short("figures/fig_90_10.png", 900), "report", "figures/fig_90_10.png cannot be used"),
    "a picture a bomb": (text("figures/fig_90_10.png", PNG_BOMB), "report", "decay/figures/fig_90_10.png"),
    "a case elsewhere": (changed("run.json", lambda d: d["cases"].update({"../../x": d["cases"]["fast"]})), "draw",
                         "'../../x' is no name of a case"),
    "a case of HTML": (changed("run.json", lambda d: d["cases"].update({"<b>": d["cases"]["fast"]})), "report",
                       "'<b>' is no name of a case"),
    "figure no SVG": (text("figures/fig_90_10.svg", b"\xff\xd8\x00"), "report", ""),
}  # fmt: skip


@pytest.mark.parametrize("kind", DAMAGE)
def test_damage_is_named(toy_result: Path, command: Command, kind: str) -> None:
    damage, words, sentence = DAMAGE[kind]
    damage(toy_result)
    left = sorted(toy_result.rglob("*"))
    status, said = command(words.format(RESULT))
    assert sentence in " ".join(said.split()), said
    assert status in ((1, 2) if sentence else (0,))
    assert sorted(toy_result.rglob("*")) == left


def packed(name: str, block: bytes, times: int) -> Damage:
    """A member of gzip is packed once and repeated, as many times as it is to unpack."""
    return lambda folder: (folder / name).write_bytes(gzip.compress(block, 1) * times)


LARGE: dict[str, tuple[Damage, str]] = {
    "aliases": (text("config.yaml", BOMB), "draw"),
    "a series without end": (packed("series/plain.csv.gz", b"0.0,1.0\n" * (1 << 17), 300), "draw"),
    "a series of one line": (packed("series/plain.csv.gz", b"1" * (1 << 20), 40), "draw"),
    "a table of one line": (lambda folder: text("tables/T90.1.csv", "9" * (40 << 20))(folder), "check"),
    "metrics of one line": (lambda folder: text("metrics.json", '{"' + "x" * (60 << 20))(folder), "check"),
    "brackets": (lambda folder: text("run.json", "[" * (10 << 20))(folder), "report"),
}


@pytest.mark.parametrize("kind", LARGE)
def test_bombs_and_endless_lines_end_soon_and_in_bounded_memory(toy_result: Path, command: Command, kind: str) -> None:
    damage, words = LARGE[kind]
    damage(toy_result)
    (free, most), start = resource.getrlimit(resource.RLIMIT_AS), time.process_time()
    resource.setrlimit(resource.RLIMIT_AS, (_virtual() + (1 << 30), most))
    try:
        status, said = command(words)
    finally:
        resource.setrlimit(resource.RLIMIT_AS, (free, most))
    assert status in (1, 2), said
    assert "cannot be used" in " ".join(said.split())
    assert len(said) < 5000
    assert time.process_time() - start < 2


def _virtual() -> int:
    """Bytes of address space that this process has."""
    return int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()


def test_a_file_that_is_far_too_large_is_refused(toy_result: Path, command: Command) -> None:
    with open(toy_result / "metrics.json", "wb") as file:
        file.truncate(1 << 33)
    assert "metrics.json cannot be used (it is larger than 64 MB)" in command("check")[1]


@pytest.mark.parametrize(
    "inside",
    [
        "<script>alert(1)</script>",
        '<rect onload="alert(1)"/>',
        '<a href="javascript:alert(1)"><text>x</text></a>',
        "<foreignObject><iframe src='https://example.org'/></foreignObject>",
        '<image href="https://example.org/x.png"/>',
        '<s:script xmlns:s="http://www.w3.org/2000/svg">alert(1)</s:script>',
        '<script xmlns="http://www.w3.org/1999/xhtml">alert(1)</script>',
        '<a href="java&#115;cript:alert(1)"><text>x</text></a>',
        '<use href="data:image/svg+xml;base64,PHN2Zy8+#x"/>',
        '<image xmlns:l="http://www.w3.org/1999/xlink" l:href="file:///etc/passwd"/>',
        '<set attributeName="onload" to="alert(1)"/>',
        '<animate attributeName="href" values="javascript:alert(1)"/>',
        "<style>@import 'https://example.org/x.css';</style>",
        '<rect style="fill: u\\72l(https://example.org/x)"/>',
        '<rect fill="url(https://example.org/x#y)"/>',
        '<rect\nOnClick = "alert(1)"/>',
        "<?xml-stylesheet href='https://example.org/x.css'?>",
        "<g>",
    ],
)
def test_a_received_picture_with_code_in_it_is_not_shown(toy_result: Path, command: Command, inside: str) -> None:
    path = toy_result / "figures/fig_90_10.svg"
    path.write_text(path.read_text().replace("</svg>", f"{inside}</svg>"))
    assert command("report")[0] == 0
    assert not list(Path("results/report").rglob("fig_90_10.svg"))
    assert "fig_90_10.svg" not in Path("results/report/chapter90.html").read_text()


def test_a_picture_with_an_entity_is_not_shown(toy_result: Path) -> None:
    path = toy_result / "figures/fig_90_10.svg"
    assert is_safe(path)
    text = path.read_text()
    path.write_text(
        text.replace(text[text.index("<!DOCTYPE") : text.index("<svg")], '<!DOCTYPE svg [<!ENTITY a "b">]>')
    )
    assert not is_safe(path)
    path.write_bytes(text.encode("utf-16"))
    assert not is_safe(path)


HTML = "</script><img src=x onerror=alert(1)>"


def test_what_a_received_result_says_is_text_on_the_page(toy_result: Path, command: Command) -> None:
    changed("claims.json", lambda d: [d[0].update({key: HTML for key in ("statement", "note", "where", "figure")})])(
        toy_result
    )
    changed("run.json", lambda d: d.update(revision=HTML, machine=HTML, python=HTML, differs=[HTML]))(toy_result)
    text("tables/T90.1.csv", f"case,{HTML}\n{HTML},1\n")(toy_result)
    series = gzip.decompress((toy_result / "series/plain.csv.gz").read_bytes()).replace(b"x,", HTML.encode() + b",")
    text("series/plain.csv.gz", gzip.compress(series))(toy_result)
    shutil.copytree(toy_result, toy_result.parents[1] / "runs/decay-0")
    assert command("report")[0] == 0
    changed("metrics.json", lambda d: d.update({f"decay.{HTML}": 1.0}))(toy_result.parents[1] / "runs/decay-0")
    assert command(f"diff {RESULT} results/runs/decay-0 --html results/report/diff.html")[0] == 0
    pages = [path.read_text("utf-8") for path in Path("results/report").rglob("*") if path.suffix in (".html", ".js")]
    assert any("&lt;img src=x onerror" in page for page in pages)
    assert not any(HTML in page for page in pages)


WORDS = ("check", "report", "draw", "diff {0} {0}", "show decay", "render {0}", "run only=decay workers=1",
         "study only=decay samples=1 workers=1")  # fmt: skip


def other_value(data: Any, rng: random.Random) -> bytes:
    """Data in which one value, at whatever depth, is of another kind."""
    node = data
    while True:
        key = rng.choice(list(node) if isinstance(node, dict) else range(len(node)))
        if not isinstance(node[key], dict | list) or not node[key] or rng.random() < 0.2:
            break
        node = node[key]
    node[key] = rng.choice([None, 5, "x", [], {}, True, -1, 1e308, "../../x", [[]], {"a": 1}])
    return json.dumps(data).encode()


@pytest.mark.parametrize("number", range(12))
def test_random_damage_gives_a_sentence_or_nothing(toy_result: Path, command: Command, number: int) -> None:
    rng = random.Random(number)
    whole = {path: path.read_bytes() for path in toy_result.rglob("*") if path.is_file()}
    for path in rng.sample(sorted(whole), 2):
        content = bytearray(whole[path])
        if path.suffix == ".json" and rng.random() < 0.7:
            content = other_value(json.loads(content), rng)
        elif rng.random() < 0.5:
            del content[rng.randrange(len(content)) :]
        else:
            for _ in range(rng.randrange(1, 9)):
                content[rng.randrange(len(content))] ^= 1 << rng.randrange(8)
        path.write_bytes(content)
    status, _ = command(rng.choice(WORDS).format(RESULT))
    assert status in (0, 1, 2)


# ---------------------------------------------------------------------------------- baselines, studies, configuration

BASELINES = {
    "empty": "",
    "a list": "[]",
    "cut short": '{"metrics": {"decay.plain.final": {"value"',
    "other keys": '{"numbers": {}}',
    "claims a list": '{"metrics": {}, "claims": [1]}',
    "a number of 400 digits": '{"metrics": {"decay.plain.final": {"value": ' + "9" * 400 + ', "rtol": 0, "atol": 0}}}',
    "entries of another kind": '{"metrics": {"decay.plain.final": 3}, "claims": {}}',
    "infinite tolerance": '{"metrics": {"decay.plain.final": {"value": 1, "rtol": 0, "atol": Infinity}}, "claims": {}}',
    "absurd tolerance": '{"metrics": {"decay.plain.final": {"value": 1, "rtol": 50, "atol": 0}}, "claims": {}}',
    "unequal columns": '{"metrics": {}, "claims": {}, "tables": {"T90.1": {"a": [1], "b": []}}}',
}


@pytest.mark.parametrize("kind", BASELINES)
def test_a_damaged_baseline_is_named(toy_result: Path, command: Command, kind: str) -> None:
    path = baselines.baseline_file("90", "decay")
    path.write_text(BASELINES[kind])
    status, said = command("check")
    assert status == 2
    assert f"{path} is no baseline" in "".join(said.split("\n"))


HEAD = '{"chapter": "90", "experiment": "decay", "samples": 2, "failed": 0, "varied": {}, '
ROW = (
    '{"samples": 2, "holds": 1, "share": 0.5, "low": 0, "high": 1, "median_margin": 0, "parameter": null, '
    '"correlation": null, "quantiles": []}'
)
STUDIES = {
    "empty": "",
    "a list": "[]",
    "cut short": '{"chapter": "90", "exper',
    "null claims": HEAD + '"claims": null}',
    "a chapter of another kind": HEAD.replace('"90"', "[90]") + '"claims": {}}',
    "other rows": HEAD + '"claims": {"C": 1}}',
    "binary": "\x00\x01",
    "varied null": HEAD.replace('"varied": {}', '"varied": null') + '"claims": {}}',
    "an experiment of another kind": HEAD.replace('"decay"', "[1]") + '"claims": {}}',
    "a share a text": HEAD + f'"claims": {{"C90.01": {ROW.replace("0.5", "{}")}}}}}',
    "a parameter a list": HEAD + f'"claims": {{"C90.01": {ROW.replace("null", "[1]")}}}}}',
    "quantiles of texts": HEAD + f'"claims": {{"C90.01": {ROW.replace("[]", "[1, 2, 3, 4, {}]")}}}}}',
}


@pytest.mark.parametrize("kind", STUDIES)
def test_a_damaged_study_is_named(toy_result: Path, command: Command, kind: str) -> None:
    path = samples.summary_file("decay", Path("results"))
    path.parent.mkdir(parents=True)
    path.write_text(STUDIES[kind])
    status, said = command("report")
    assert status == 2
    assert f"{path} is no study" in said


@pytest.mark.parametrize(
    "content", ["", "5", "[null]", '[{"metrics": 5}]', '[{"metrics": [], "claims": []}]', "\0",
                '[{"chapter": "90", "experiment": {}, "version": "1", "compared": 1, "metrics": [], "claims": {}}]',
                '[{"chapter": "90", "experiment": "x", "version": "1", "compared": 1, "metrics": [5], "claims": {}}]'],
)  # fmt: skip
def test_a_damaged_crosscheck_is_named(toy_result: Path, command: Command, content: str) -> None:
    path = Path("results/crosscheck/crosscheck.json")
    path.parent.mkdir()
    path.write_text(content)
    status, said = command("report")
    assert status == 2
    assert f"{path} is no table of comparisons" in said


def test_damaged_samples_of_a_study_are_named(toy_result: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = Path("samples.jsonl.gz")
    for content in (b"no gzip", gzip.compress(b"{}")[:-9]):
        path.write_bytes(content)
        with pytest.raises(InputError, match=r"samples\.jsonl\.gz holds no samples of a study"):
            list(samples.read_samples(path))


@pytest.mark.parametrize("content", ["", "[]", '{"runs": [5]}', '{"runs": [{"content": "a", "value": "b"}]}', "\0"])
def test_a_damaged_search_is_run_again(toy_result: Path, command: Command, content: str) -> None:
    words = "tune case=decay.plain minimise=final budget=2 workers=1 decay.rate=1..3 law.denominator=1..3"
    said = command(words)[1]
    (path,) = Path("results/tuning").glob("*.json")
    before = path.read_text()
    path.write_text(content)
    assert command(words)[1] == said
    assert path.read_text() == before


LINES = ["", "null", "5", "[]", "{}", '{"index": "x"}', '{"index": 0}', '{"index": 0, "digest": 5}', "\x00", "{" * 5000]


def test_lines_of_a_study_that_are_none_do_not_count(toy_result: Path, command: Command) -> None:
    path = samples.summary_file("decay", Path("results")).with_suffix(".jsonl")
    path.parent.mkdir(parents=True)
    path.write_bytes("\n".join(LINES).encode() + b"\n\xff\xfe\n")
    status, said = command("study chapter=90 samples=2 workers=1")
    assert status == 0, said
    assert [json.loads(line)["index"] for line in path.read_text().splitlines()] == [0, 1]


def test_the_report_shows_the_parameters_of_its_runs_and_marks_what_is_out_of_date(
    toy_result: Path, toy_book: Path, command: Command
) -> None:
    def page() -> str:
        assert command("report")[0] == 0
        pages = (Path(f"results/report/{name}90.html").read_text() for name in ("chapter", "parameters"))
        return " ".join(" ".join(pages).split())

    assert "<td>1.0</td>" in page()
    assert "out of date" not in page()
    path = toy_book / "chapter90/decay/config.yaml"
    path.write_text(path.read_text().replace("start: 1.0", "start: 1.75"))
    assert "1.75" not in page()
    assert "out of date: plain and 4 more cases of another configuration or code than the present" in page()


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        ("rate:\n\t1.0\n", "config.yaml"),
        ("rate: [1, 2\n", "config.yaml"),
        ("rate: 1.0\nrate: 2.0\n", "rate"),
        ("- a\n", "config.yaml"),
        ("5\n", "config.yaml"),
        ("", "config.yaml"),
        (b"rate: caf\xe9\n", "config.yaml"),
    ],
)
def test_a_configuration_that_is_none_is_named(
    toy: Path, toy_book: Path, command: Command, content: str | bytes, sentence: str
) -> None:
    text("config.yaml", content)(toy_book / "chapter90/decay")
    status, said = command("run only=decay")
    assert status == 2
    assert sentence in said


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        ("'90.1': {'90.1': 1.5}", "90.1.90.1 = '1.5' must be LaTeX under a number as '2.32'"),
        ("'90.1': {first: x}", "90.1.first = 'x' must be LaTeX"),
        ("'90.1': {90.1: x}", "90.1.90.1 = 'x' must be LaTeX under a number"),
        ("'90.1': x", "must hold sections, and in each equations by number"),
        ("- a", "must hold sections"),
        ("", "must hold sections"),
        ("a: [", "must hold sections"),
        (b"\xff\xfe", "must hold sections"),
        ("'90.1': {'90.1': '\\frac{'}", "cannot be typeset"),
    ],
)
def test_equations_that_are_none_are_named(
    toy_result: Path, toy_book: Path, command: Command, content: str | bytes, sentence: str
) -> None:
    text("equations.yaml", content)(toy_book / "chapter90")
    status, said = command("report")
    assert status == 2
    assert sentence in " ".join(said.split())
