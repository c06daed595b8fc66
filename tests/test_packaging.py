"""What stands beside the package agrees with it: version, dependencies, container, workflows; what an import brings."""

from __future__ import annotations

import ast
import json
import re
import subprocess
import sys
import tomllib
from importlib.metadata import packages_distributions

import pytest
import yaml
from conftest import ROOT

from dexrepro.report.listing import listing

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]


PINS = re.findall(
    r"^([\w.-]+)==(\S+)((?: \\\n    --hash=\S+)+)$", (ROOT / ".ci/lock.txt").read_text("utf-8"), re.MULTILINE
)


def tool(*command: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=120)


def requirements(lines: list[str]) -> dict[str, str]:
    found = (re.fullmatch(r"([\w.-]+?)(-base|-python)? ?(>=[^;]*)?(;.*)?", line) for line in lines)
    return {match[1].lower(): match[3] or "" for match in found if match}


def test_the_version_is_the_same_everywhere() -> None:
    version = PROJECT["version"]
    assert yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))["version"] == version
    assert re.findall(r"^## (\S+)", (ROOT / "docs/changelog.md").read_text("utf-8"), re.M)[0] == version


def test_every_dependency_is_pinned_and_in_the_conda_environment() -> None:
    needed = requirements(PROJECT["dependencies"])
    conda = requirements([x for x in yaml.safe_load((ROOT / ".ci/environment.yml").read_text())["dependencies"]])
    assert {name: conda.get(name) for name in needed} == needed
    pinned = {name.lower().replace("_", "-") for name, *_ in PINS}
    extras = [line for extra in ("dev", "docs") for line in PROJECT["optional-dependencies"][extra]]
    assert {*needed, *requirements(extras)} <= pinned


def test_what_the_package_imports_is_a_dependency_of_it() -> None:
    trees = [ast.parse(path.read_text("utf-8")) for path in (ROOT / "dexrepro").rglob("*.py")]
    nodes = [node for tree in trees for node in ast.walk(tree)]
    named = [alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names]
    named += [node.module or "" for node in nodes if isinstance(node, ast.ImportFrom) and not node.level]
    tops = {name.partition(".")[0] for name in named} - {"dexrepro", *sys.stdlib_module_names}
    homes = packages_distributions()
    declared = requirements([*PROJECT["dependencies"], *PROJECT["optional-dependencies"]["data"]])
    assert not {top for top in tops if not {name.lower() for name in homes.get(top, [top])} & {*declared}}


def test_the_manual_says_why_of_every_dependency() -> None:
    said = (ROOT / "docs/reference/dependencies.md").read_text("utf-8").lower()
    named = {
        name.strip() for row in re.findall(r"^\| ([^|]+)\|", said, re.MULTILINE) for name in re.split(r"[,()`]", row)
    }
    every = [*PROJECT["dependencies"], *(line for lines in PROJECT["optional-dependencies"].values() for line in lines)]
    assert {re.match(r"[\w.-]+", line)[0].lower() for line in every} <= named  # type: ignore[index]


def test_every_file_that_is_installed_is_known_by_its_hash() -> None:
    assert len(PINS) > 100
    for name, _, hashes in PINS:
        assert re.findall(r"--hash=sha256:[0-9a-f]{64}\b", hashes), name


def test_the_container_is_as_the_linter_wants_it() -> None:
    hadolint = next(iter((ROOT / ".venv/bin").glob("hadolint")), "hadolint")
    try:
        done = tool(str(hadolint), ".devcontainer/Dockerfile")
    except FileNotFoundError:
        pytest.skip("hadolint is not installed")
    assert done.returncode == 0, done.stdout
    settings = json.loads((ROOT / ".devcontainer/devcontainer.json").read_text())
    assert (ROOT / ".devcontainer" / settings["build"]["dockerfile"]).exists()


@pytest.mark.parametrize(
    ("schema", "files"),
    [
        ("github-workflows", ".github/workflows/*.yml"),
        ("github-issue-forms", ".github/ISSUE_TEMPLATE/[!c]*.yml"),
        ("github-issue-config", ".github/ISSUE_TEMPLATE/config.yml"),
        ("citation-file-format", "CITATION.cff"),
    ],
)
def test_what_a_host_reads_is_as_it_expects(schema: str, files: str) -> None:
    paths = sorted(map(str, ROOT.glob(files)))
    assert paths
    done = tool(sys.executable, "-m", "check_jsonschema", "--builtin-schema", f"vendor.{schema}", *paths)
    assert done.returncode == 0, done.stdout


def test_workflows_name_tests_that_exist() -> None:
    named = set(re.findall(r"tests/[\w/.]+", (ROOT / ".github/workflows/ci.yml").read_text("utf-8")))
    assert named
    assert not [name for name in named if not (ROOT / name).exists()]


@pytest.mark.parametrize("module", ["control", "networks", "primitives"])
def test_the_library_brings_neither_simulation_nor_pictures_nor_configuration(module: str) -> None:
    code = f"import sys, pkgutil, importlib, dexrepro.{module} as library\n"
    code += "for found in pkgutil.walk_packages(library.__path__, library.__name__ + '.'):\n"
    code += "    importlib.import_module(found.name)\n"
    code += "print(*sorted({name.partition('.')[0] for name in sys.modules}))"
    done = tool(sys.executable, "-c", code)
    assert done.returncode == 0, done.stderr
    brought = set(done.stdout.split())
    assert "numpy" in brought
    assert not brought & {"pybullet", "matplotlib", "hydra", "omegaconf", "pandas", "rich", "yaml"}


def test_no_two_files_differ_in_case_alone_and_none_has_a_name_that_a_system_refuses() -> None:
    for chapter in listing()["chapters"]:
        for experiment in chapter["experiments"]:
            named = [*experiment["cases"], *experiment["figures"], *experiment["tables"]]
            assert len({name.lower() for name in named}) == len(named), experiment["name"]
            assert not [name for name in named if re.search(r'[<>:"/\\|?*]|[ .]$', name)]
            assert not {name.lower() for name in named} & {"con", "prn", "aux", "nul"}
    tracked = tool("git", "ls-files").stdout.splitlines()
    assert len({name.lower() for name in tracked}) == len(tracked)
