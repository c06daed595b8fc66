"""The wheel carries configuration and baselines, and works from an empty folder."""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from pathlib import Path

from conftest import ROOT


def test_the_wheel_works_without_the_checkout(tmp_path: Path) -> None:
    build = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", str(tmp_path), str(ROOT)]
    done = subprocess.run(build, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    site, empty = tmp_path / "site", tmp_path / "empty"
    empty.mkdir()
    zipfile.ZipFile(next(tmp_path.glob("*.whl"))).extractall(site)
    shipped = {path.name for path in (ROOT / "conf/chapter").rglob("*.yaml")}
    assert {path.name for path in (site / "dexrepro/conf/chapter").rglob("*.yaml")} == shipped
    assert list((site / "dexrepro/baselines").glob("chapter*/*.json"))
    assert (site / "dexrepro/py.typed").is_file()
    run = [sys.executable, "-m", "dexrepro", "run", "chapter=2", "--cfg", "job"]
    env = {**os.environ, "PYTHONPATH": str(site)}
    done = subprocess.run(run, cwd=empty, env=env, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    assert "movement_estimation:" in done.stdout
    (empty / "mine/own").mkdir(parents=True)
    (empty / "mine/my_law.py").write_text("from dexrepro.control.holding_reference import ImpedanceReference as Mine\n")
    (empty / "mine/own/compare.yaml").write_text(
        "# @package _global_\nonly: movement_estimation\nmovement_estimation:\n  duration: 0.05\n  cases:\n"
        "    mine: {law._target_: my_law.Mine, stiffness: 35, period: 20}\n"
    )
    run = [sys.executable, "-m", "dexrepro", "run", "--config-dir", "mine", "+own=compare"]
    done = subprocess.run(run, cwd=empty, env=env, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done.stderr
    assert "movement_estimation.mine." in next(empty.glob("results/runs/*/metrics.json")).read_text()
