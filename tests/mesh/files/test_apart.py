"""Calls in a process of their own: what comes back of results, errors and crashes, and that none is left behind."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys

import pytest
from processes import PATIENCE, hear_ctrl_c, is_there, until

from magshell.errors import InputError, MeshError
from magshell.mesh.files.apart import apart


def test_results_and_errors_come_back():
    """Of the class that they are; what is no InputError is told by its kind."""
    assert apart(divmod, 7, 2, program="gmsh", name="a.step") == (3, 1)
    with pytest.raises(MeshError, match=r"^element 3 is turned$"):
        apart(refuse, program="gmsh", name="a.step")
    with pytest.raises(InputError, match=r"^a.step: cannot be read by VTK: ZeroDivisionError; it is damaged$"):
        apart(divmod, 7, 0, program="VTK", name="a.step")


def refuse():
    raise MeshError("element 3 is turned")


def test_a_crash_is_an_error():
    with pytest.raises(InputError, match=r"^a.step: gmsh crashes on it: it is damaged, or too large for the memory$"):
        apart(os.abort, program="gmsh", name="a.step")


def test_an_end_is_no_crash():
    with pytest.raises(InputError, match=r"^a.geo: ends gmsh before all of it is read; a script must not have Exit$"):
        apart(os._exit, 0, program="gmsh", name="a.geo")


@pytest.mark.skipif(not hasattr(signal, "SIGXCPU"), reason="no limits of time")
def test_what_finds_no_end_is_ended():
    with pytest.raises(InputError, match=r"^a.vtu: VTK does not finish reading it: it is damaged$"):
        apart(turn_round, program="VTK", name="a.vtu", seconds=1)


def turn_round():
    while True:
        pass


def test_words_of_the_program_are_not_taken_for_the_answer(capfd):
    assert apart(os.system, "echo a word; echo another 1>&2", program="gmsh", name="a.step") == 0
    assert tuple(capfd.readouterr()) == ("", "")


def test_files_beside_the_user_are_not_taken_for_modules(tmp_path, monkeypatch):
    (tmp_path / "pickle.py").write_text("raise SystemExit")
    monkeypatch.chdir(tmp_path)
    assert apart(divmod, 7, 2, program="gmsh", name="a.step") == (3, 1)


def test_it_ends_quietly():
    """Also when nobody ends it: with an abort, systems would write its memory to the user's folder."""
    asked = pickle.dumps((divmod, (7, 2), "gmsh", "a.step", None))
    pipes = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.PIPE)
    with subprocess.Popen([sys.executable, "-m", apart.__module__], **pipes) as process:
        process.stdin.write(asked)
        process.stdin.flush()
        assert pickle.loads(process.stdout.read()) == (3, 1)
        assert process.wait() == 0


@pytest.mark.skipif(sys.platform == "win32", reason="no signals to another process")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
def test_it_ends_with_the_process_that_asked(tmp_path, number):
    new, file = tmp_path / "new", tmp_path / "asked"
    called = (
        f"import os, pathlib, time; pathlib.Path({str(new)!r}).write_text(str(os.getpid()));"
        f" os.rename({str(new)!r}, {str(file)!r}); time.sleep({2 * PATIENCE})"
    )
    code = f"from magshell.mesh.files.apart import apart\napart(exec, {called!r}, program='gmsh', name='a.step')"
    command = [sys.executable, "-c", code]
    with subprocess.Popen(command, stderr=subprocess.DEVNULL, preexec_fn=hear_ctrl_c) as process:
        until(file.exists, process)
        process.send_signal(number)
        process.wait(timeout=PATIENCE)
    asked = int(file.read_text())
    until(lambda: not is_there(asked))
