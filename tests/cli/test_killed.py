"""Runs that are killed at random moments, again and again, until they are done: nothing is lost, no file is torn."""

from __future__ import annotations

import json
import os
import random
import re
import shutil
import signal
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from problem_files import STRIP, changed

from cli.forks import Forks, Kill
from magshell.errors import InputError
from magshell.output.checkpoint import read_step, step_files

# Of each problem. A run may make so many steps before, and compute so long after them or, with none, from the start, s.
STEPS, SHORT, LONG = 2, 0.04, 0.3
FIELD = 'flux_density = [0, 0, "2 mT"]\nstops = ["1 mT", "2 mT"]'
# Up and down with stops; a strip that buckles in a field against its remanence, and its branch.
PROBLEMS = {
    "stages": changed(STRIP, (FIELD, 'flux_density = [0, 0, "5 mT"]\nstops = ["1 mT"]\nhistory = [1, -0.5]')),
    "branch": changed(STRIP, (FIELD, 'flux_density = ["-9 mT", 0, 0]\nhistory = [1, 1.1]'))
    + '[[stages]]\n[[stages]]\ncontrol = "arc-length"\nbranch = 1\n',
}
pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork")


@pytest.fixture(scope="module")
def forks() -> Iterator[Forks]:
    with Forks() as running:
        yield running


@pytest.mark.parametrize(
    ("kills", "largest_step"),
    [pytest.param(3, 0.1, id="a few times"), pytest.param(26, 0.04, id="many times", marks=pytest.mark.verify)],
)
@pytest.mark.parametrize("name", PROBLEMS)
def test_killed_until_it_is_done(name: str, kills: int, largest_step: float, forks: Forks, tmp_path: Path) -> None:
    file, whole, out, shown = (tmp_path / part for part in (f"{name}.toml", "whole", "out", "shown.txt"))
    steps = f"[solver]\nfirst_step = {largest_step / 2}\nlargest_step = {largest_step}\n"
    file.write_text(PROBLEMS[name] + steps)
    assert forks.run(["run", str(file), "--out", str(whole)], tmp_path / "whole.txt") == 0
    moments, killed, kept, seen = random.Random(name), list[Kill](), [0], dict[Path, bytes]()
    while len(killed) < kills:
        begun = (out / "problem.toml").exists()
        arguments = ["run", "--resume", str(out)] if begun else ["run", str(file), "--out", str(out)]
        steps = moments.randint(0, STEPS)
        kill = Kill(str(out), kept[-1] + steps, moments.uniform(0.0, SHORT if steps else LONG))
        status = forks.run(arguments, shown, kill)
        where = f"after kills at {[(kill.steps, kill.seconds) for kill in killed]}:\n{shown.read_text()[-2000:]}"
        if status == 0:  # It was done before: begin again.
            check_finished(out, whole, where)
            shutil.rmtree(out)
            kept.append(0)
            continue
        assert status == -signal.SIGKILL, where
        killed.append(kill)
        if (out / "problem.toml").exists():
            kept.append(check_killed(out, whole, shown.read_text(), kept[-1], seen, where))
    stages = [steps for steps in set(kept) if 0 < steps < len(step_files(whole))]
    assert len(stages) > kills // 8, f"kills fell in few places of the path: {kept}"
    assert forks.run(["run", "--resume", str(out)], shown) == 0, where
    check_finished(out, whole, where)


def check_killed(out: Path, whole: Path, shown: str, before: int, seen: dict[Path, bytes], where: str) -> int:
    """Every file is whole, and has no more than the checkpoint, which has all that was said; how many steps it has.

    Steps that were looked at before and are the same bytes (`seen`) are not read again.
    """
    steps = step_files(out)
    assert len(steps) >= before, f"steps are lost {where}"
    for number, file in enumerate(steps):
        assert file.name == f"step-{number:04d}.npz", where
        if (content := file.read_bytes()) != seen.get(file):
            same_step(file, whole / "checkpoint" / file.name, where)
            seen[file] = content
    said = [int(number) for number in re.findall(r"^step (\d+)  .*residual", shown, re.MULTILINE)]
    assert max(said, default=-1) < len(steps), f"step {max(said, default=-1)} was said, but is lost {where}"
    for name in ("history.csv", "critical.csv"):
        if (out / name).exists():
            rows = (out / name).read_bytes()
            assert rows.endswith(b"\n"), f"{name} is torn {where}"
            assert (whole / name).read_bytes().startswith(rows), f"{name} differs {where}"
    if (out / "history.csv").exists():
        assert (out / "history.csv").read_bytes().count(b"\n") - 1 <= len(steps), where
    for part in ("steps", "critical"):
        for vtu in (out / part).glob("[!.]*"):
            assert vtu.read_bytes() == (whole / part / vtu.name).read_bytes(), f"{vtu} differs {where}"
    if (out / "shell.pvd").exists():
        series = ElementTree.parse(out / "shell.pvd").getroot().iter("DataSet")
        assert all((out / one.attrib["file"]).exists() for one in series), where
    if (out / "summary.json").exists():
        assert json.loads((out / "summary.json").read_text())["steps"] < len(steps), where
    for picture in out.glob("[!.]*.png"):
        assert picture.read_bytes().endswith(b"IEND\xaeB`\x82"), f"{picture} is torn {where}"
    return len(steps)


def check_finished(out: Path, whole: Path, where: str) -> None:
    """The folder is that of a run that was never stopped, to the last byte of each file but for the time it took."""
    ours, theirs = (
        {str(file.relative_to(folder)) for file in folder.rglob("*") if file.is_file() and file.name != ".lock"}
        for folder in (out, whole)
    )
    assert ours == theirs, where
    for name in sorted(ours):
        if name.endswith(".npz"):
            same_step(out / name, whole / name, where)
        elif name == "summary.json":
            one, other = (json.loads((folder / name).read_text()) for folder in (out, whole))
            assert one.pop("cpu_seconds") > 0.0 < other.pop("cpu_seconds")
            assert one == other, where
        elif name != "shape.png":
            assert (out / name).read_bytes() == (whole / name).read_bytes(), f"{name} differs {where}"


def same_step(one: Path, other: Path, where: str) -> None:
    """A step of the checkpoint is whole, and that of the other folder but for the time it took."""
    try:
        read_step(one)
    except InputError as error:
        raise AssertionError(f"{error} {where}") from None
    with np.load(one) as ours, np.load(other) as theirs:
        assert ours.files == theirs.files, where
        for name in set(ours.files) - {"cpu_seconds"}:
            assert ours[name].tobytes() == theirs[name].tobytes(), f"{name} of {one.name} differs {where}"
