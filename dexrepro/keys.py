"""The keys that commands take as ``key=value``: help, check and completion are made from this table."""

from __future__ import annotations

KEYS = {
    "chapter": ("N", "chapters, such as 2 or 1,3; else those that the other keys imply, else all"),
    "only": ("EXPERIMENT", "one experiment, or several: only=a,b"),
    "figure": ("ID", "what makes a figure or table, such as 2.7 or T2.1"),
    "case": ("NAME", "some cases, by name or pattern such as tuned_*: a result of its own below runs/"),
    "seed": ("NUMBER", "root of every random number (0)"),
    "engine": ("NAME", "pybullet or mujoco"),
    "results": ("DIR", "where results are (results)"),
    "workers": ("NUMBER", "processes; one a core where it is not given"),
    "case_timeout": ("SECONDS", "ends a case after so much wall time"),
    "force": ("true|false", "run even what is there already"),
    "quiet": ("true|false", "say only what went wrong"),
    "gui": ("true|false", "show the simulation live in a window"),
    "format": ("KIND", "gif or mp4"),
    "style": ("NAME", "slides, paper or dark: figures for another place, in results/figures/NAME"),
    "allow": ("MODULE", "modules of somebody else's result that you trust"),
    "claim": ("ID", "the study of one claim's experiment"),
    "check.claim": ("ID", "one claim, with the metrics of the cases that it is about"),
    "run.claim": ("ID", "what one claim needs: those cases of its experiment that it is about"),
    "study.case": ("NAME", "some cases, by name or pattern, for the claims that are about no other"),
    "samples": ("NUMBER", "draws; where it is not given, until every claim is decided (16 to 100)"),
    "hours": ("NUMBER", "begin no draw after so many hours"),
    "tune.case": ("EXPERIMENT.CASE", "the case to be tuned"),
    "compare.case": ("EXPERIMENT.CASE", "the cases, with commas between them, whose law is replaced"),
    "draw.format": ("KIND", "pdf, png or svg, in results/figures/STYLE (of a changed run: STYLE/RUN)"),
    "laws": ("FOLDER|FILE", "laws of yours, which are to stand beside the book's"),
    "minimise": ("METRIC", "the metric of the case that is to be least; of A+B the sum"),
    "maximise": ("METRIC", "or the one that is to be greatest"),
    "limit": ("METRIC:NUMBER", "what another metric may be at most; several with commas between them"),
    "budget": ("NUMBER", "runs (32)"),
    "jobs": ("NUMBER", "jobs that share the draws, by hydra/launcher=joblib, ray or submitit_slurm"),
}  # fmt: skip
SELECTION = ("chapter", "only", "figure", "results")
TAKEN: dict[str, tuple[str, ...]] = {}
"""What each command takes, as it declares it (see ``commands``)."""


def described(command: str) -> str:
    """The keys of a command for its help, a line each."""
    rows = [(key, *KEYS.get(f"{command}.{key}", KEYS[key])) for key in TAKEN.get(command, ())]
    lines = [f"  {f'{key}={value}':<22}  {meaning}" for key, value, meaning in rows]
    return "\n".join(["keys:", *lines]) if lines else ""
