"""Workers that are processes: of this machine, or of a Dask cluster; killed on the way, told to stop, left alone."""

from __future__ import annotations

import io
import logging
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from processes import PATIENCE, is_there, until

from magshell.errors import InputError
from magshell.problem.alternatives import Setting
from magshell.results import read
from magshell.sweep.display import Display
from magshell.sweep.executors import DaskWorkers, LocalWorkers
from magshell.sweep.folder import SweepFolder
from magshell.sweep.grid import Cell
from magshell.sweep.sweep import sweep
from sweep import cells as ends

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL")


@pytest.fixture(autouse=True)
def compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("magshell.shell.loops.are_compiled", lambda: True)


def test_a_process_computes_with_one_thread_and_leaves_ctrl_c_to_its_parent() -> None:
    before = dict(os.environ)
    workers = LocalWorkers(2)
    try:
        first, second = (workers.submit(ends.process_of) for _ in range(2))
        reasons = [first.result(PATIENCE).reason, second.result(PATIENCE).reason]
        again = workers.submit(ends.process_of).result(PATIENCE).reason
    finally:
        workers.close()
    assert all(reason.endswith("['1', '1', '1', '1'] True") for reason in reasons), reasons
    assert len({reason.split()[0] for reason in reasons}) == 2, "two processes"
    assert again in reasons, "a process that is free is used again"
    assert dict(os.environ) == before


def test_a_cell_whose_process_is_killed_is_solved_by_another(
    folder: SweepFolder,
    settings: list[Setting],
    cells: list[Cell],
    display: Display,
    shown: io.StringIO,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("magshell.sweep.sweep.solve_cell", ends.killed_once)
    outcomes = sweep(folder, settings, cells, LocalWorkers(1), display)
    assert all(outcome.converged for outcome in outcomes.values()), outcomes
    assert "cell 0002 (shell.thickness = 1 mm): its process was killed; it is tried again" in shown.getvalue()


def test_a_cell_that_kills_every_process_fails_and_the_others_go_on(
    folder: SweepFolder,
    settings: list[Setting],
    cells: list[Cell],
    display: Display,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("magshell.sweep.sweep.solve_cell", ends.killed_always)
    outcomes = sweep(folder, settings, cells, LocalWorkers(2), display)
    assert [outcomes[number].converged for number in (1, 2, 3)] == [True, False, True]
    assert "was killed, twice" in outcomes[2].reason
    assert '0002,0.001,False,"the process that solved it was killed, twice' in folder.table.read_text()


def test_ctrl_c_stops_the_processes(
    folder: SweepFolder,
    settings: list[Setting],
    cells: list[Cell],
    display: Display,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("magshell.sweep.sweep.solve_cell", ends.slow)
    asked = Display.running

    def interrupting(self: Display, count: int) -> None:
        if folder.cell("0002").exists():
            raise KeyboardInterrupt
        asked(self, count)

    monkeypatch.setattr(Display, "running", interrupting)
    with pytest.raises(KeyboardInterrupt):
        sweep(folder, settings, cells, LocalWorkers(1), display)
    assert (folder.cell("0002") / "stopped").exists()
    assert [line.split(",")[2] for line in folder.table.read_text().splitlines()[1:]] == ["True", "", ""]


def test_processes_end_with_their_parent(tmp_path: Path) -> None:
    """However it ends: no cell is written to by two sweeps."""
    script = tmp_path / "parent.py"
    script.write_text(
        "import os, signal\n"
        "from magshell.sweep.executors import LocalWorkers\n"
        "if __name__ == '__main__':\n"
        "    print(LocalWorkers(1).submit(os.getpid).result(), flush=True)\n"
        "    os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    child = int(subprocess.run([sys.executable, str(script)], stdout=subprocess.PIPE, text=True, check=False).stdout)
    until(lambda: not is_there(child))


@pytest.fixture(scope="module")
def cluster() -> Iterator[str]:
    """Address of a scheduler with two workers, each a process."""
    distributed = pytest.importorskip("distributed")
    quiet = {"distributed.admin.large-graph-warning-threshold": "1GB"}
    import dask

    with (
        dask.config.set(quiet),
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=60
        ) as cluster,
    ):
        yield cluster.scheduler_address


def test_a_dask_worker_is_killed_on_the_way(
    cluster: str,
    folder: SweepFolder,
    settings: list[Setting],
    cells: list[Cell],
    display: Display,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The cell goes to another worker, which goes on from the steps that had converged; nothing is lost."""
    monkeypatch.setattr("magshell.sweep.sweep.solve_cell", ends.killed_in_the_middle)
    outcomes = sweep(folder, settings, cells, DaskWorkers(cluster, folder.path), display)
    assert (folder.path / "killed").exists(), "no worker was killed"
    assert all(outcome.converged for outcome in outcomes.values()), outcomes
    for cell in cells:
        path = read(folder.cell(cell.name)).path
        assert path.converged
        assert path.summary["probes"]["tip"] == outcomes[cell.number].summary["probes"]["tip"]


def test_a_dask_cluster_that_cannot_solve(cluster: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=rf"--dask {cluster}: the worker .* does not see the folder {tmp_path}/no"):
        DaskWorkers(cluster, tmp_path / "no")


def test_a_dask_scheduler_that_goes_away(cluster: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def gone() -> None:
        raise RuntimeError("closed")

    workers = DaskWorkers(cluster, tmp_path)
    assert workers.places in (1, 2), "one may not be there yet again after the kill"
    monkeypatch.setattr(workers._client, "nthreads", gone)
    with pytest.raises(ConnectionError, match="the scheduler does not answer any more") as error:
        _ = workers.places
    workers.close()
    assert error.value.filename == cluster
    assert not logging.getLogger("distributed.client").isEnabledFor(logging.ERROR), "tracebacks of Dask are shown"


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "nonsense://x", "127.0.0.1:99999999"])
def test_no_dask_scheduler(address: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("magshell.sweep.executors.PATIENCE", "1s")
    with pytest.raises(InputError, match=f"--dask {address}: no scheduler answers"):
        DaskWorkers(address, tmp_path)


def test_without_dask(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(InputError, match=r"pip install 'magshell\[dask\]'"):
        DaskWorkers("tcp://127.0.0.1:8786", tmp_path)
