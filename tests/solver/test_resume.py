"""Going on from any step is going on as if nothing had been: the next waypoint is the same to the last bit."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest
from joints.bodies import folded_arm

import magshell as ms
from magshell import Model, Observer, Settings, Stage
from magshell.output.checkpoint import CheckpointWriter, Origin, content, read_step, step_files
from magshell.solver import resume
from magshell.solver.retracing import path_through
from magshell.solver.waypoint import Waypoint
from solver.arches import arch, to_the_crown_at
from solver.models import Record, arm, in_parts, strip
from solver.test_branching import along, buckling
from solver.test_own_field import two_strips
from solver.test_stages import strip as heavy_strip


def built_in(name: str, elements: Sequence[int]) -> Model:
    """A built-in problem on another mesh."""
    return ms.problem.load(name, {"mesh.elements": list(elements)}).model


CASES = {
    "field with stops": (lambda: built_in("strip-10", (4, 1)), Settings()),
    "cut before the first step": (strip, Settings(first_step=1.0)),
    "displacement": (lambda: arch([to_the_crown_at(0.3)]), Settings()),
    "displacement, then load": (lambda: arch([to_the_crown_at(0.05), Stage()], history=(1.0, 0.5)), Settings()),
    "load, and arc length past a limit point": (arch, Settings()),
    "arc-length": (lambda: built_in("magnetic-arch", (4, 1)), Settings()),
    "stages": (lambda: heavy_strip(gravity=(1, 1), history=(0, 1)), Settings()),
    "branches": (lambda: buckling([Stage(), along(1), along(-1)]), Settings()),
    "joints, hinges, a magnet on springs": (folded_arm, Settings()),
    "the body's own field": (lambda: two_strips(-20e-3, Stage(stops=2)), Settings()),
    "parts of several layers": (lambda: in_parts(arm()), Settings()),
}


class StopAtTheNext(Observer):
    """Presses Ctrl-C when a step is kept."""

    def kept(self, path: ms.Path) -> None:
        raise KeyboardInterrupt


def image(waypoint: Waypoint) -> bytes:
    """All of a waypoint but the time it took."""
    return content(waypoint._replace(cpu_seconds=0.0), Origin("", "", {}))


@pytest.mark.parametrize("name", CASES)
def test_next_step_is_the_same(name: str, tmp_path: Path) -> None:
    """From the files of every step. By induction, so are all that follow."""
    make, settings = CASES[name]
    model = make()
    whole = ms.solve(model, settings, [CheckpointWriter(tmp_path, "")])
    waypoints = [read_step(file)[0] for file in step_files(tmp_path)]
    assert len(waypoints) == len(whole.steps)
    for number in range(1, len(waypoints)):
        path = path_through(model, settings, waypoints[:number])
        assert not path.converged
        with pytest.raises(KeyboardInterrupt):
            resume(path, [StopAtTheNext()])
        assert image(path.trail[-1]) == image(waypoints[number]), f"step {number} of {len(waypoints) - 1}"
    path = path_through(model, settings, waypoints)
    assert path.converged
    assert path.summary == whole.summary | {"cpu_seconds": path.cpu_seconds}
    assert [image(one) for one in path.trail] == [image(one) for one in whole.trail]


def test_what_observers_are_told(tmp_path: Path) -> None:
    """One that knows nothing of it hears of all steps, the earlier ones at once."""
    model, record, again = strip(), Record(), Record()
    whole = ms.solve(model, observers=[record, CheckpointWriter(tmp_path, "")])
    waypoints = [read_step(file)[0] for file in step_files(tmp_path)][:4]
    path = resume(path_through(model, whole.settings, waypoints), [again])
    assert again.bytes == record.bytes
    assert again.calls[:5] == ["started", *["converged"] * 4]
    assert again.calls[-1] == "finished"
    assert again.path is path


def test_an_interrupted_path_goes_on_in_memory() -> None:
    record = Record()
    ms.solve(strip(), observers=[record])

    class Once(Record):
        def converged(self, step: ms.Step) -> None:
            super().converged(step)
            if step.number == 3 and self.calls.count("finished") == 0:
                raise KeyboardInterrupt

    once = Once()
    with pytest.raises(KeyboardInterrupt):
        ms.solve(strip(), observers=[once])
    assert once.path is not None
    again = Record()
    assert resume(once.path, [again]).converged
    assert again.bytes == record.bytes
