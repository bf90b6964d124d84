"""Files of the checkpoint: exact, whole or refused with what to do."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from faults.limits import bounded

from magshell.equations.instant import Increment
from magshell.errors import InputError
from magshell.evaluation.balance import Balance
from magshell.output import checkpoint
from magshell.output.checkpoint import CheckpointWriter, Origin, content, read_step, step_files
from magshell.shell.state import State
from magshell.solver import CriticalPoint, Settings, Step
from magshell.solver.track import Slope
from magshell.solver.waypoint import Waypoint

NODES, ELEMENTS = 13, 2
ORIGIN = Origin("0.1.0", "digest", {"tolerance": 1e-9, "linear_solver": "superlu"})


def waypoint(number: int = 7, plain: bool = False) -> Waypoint:
    """A step of random numbers; a plain one has no balance, no pivots and no critical point."""
    random = np.random.default_rng(number).normal

    def state() -> State:
        return State(
            random(size=(NODES, 3)), random(size=(NODES, 3)), random(size=NODES), random(size=(NODES, 4)),
            random(size=NODES), random(size=(ELEMENTS, 4, 3)),
        )  # fmt: skip

    balance = Balance(*(random(size=3) for _ in range(5)), 1e-12, 3e-13, 2.0, 0.1)
    point = CriticalPoint(
        2, "limit point", 1, random(), random(size=3), random(), state(), random(size=(NODES, 11)), (0, None)
    )
    step = Step(
        number, random(), state(), 4, 1e-11, None if plain else balance, random(), 1, random(size=3), random(size=2),
        None if plain else 3,
    )  # fmt: skip
    slope = Slope(Increment(random(size=(NODES, 11)), random(size=(ELEMENTS, 4, 3))), random())
    return Waypoint(step, () if plain else (point, point), slope, 3, 2, True, random(), 5, 41, 1.25)


def same(one: Waypoint, other: Waypoint) -> bool:
    return content(one, ORIGIN) == content(other, ORIGIN)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    written = tmp_path / "step-0007.npz"
    written.write_bytes(content(waypoint(), ORIGIN))
    return written


def test_scales_of_an_older_step_are_in_its_ratios(file: Path) -> None:
    with np.load(file) as arrays:
        older = {name: arrays[name] for name in arrays.files if not name.endswith(("_scale", "digest"))}
    np.savez(file, **older)
    written, read = waypoint().step.balance, read_step(file)[0].step.balance
    assert (read.force_imbalance, read.moment_imbalance) == (written.force_imbalance, written.moment_imbalance)
    force = np.linalg.norm(written.reaction_force + written.load_force)
    moment = np.linalg.norm(written.reaction_moment + written.load_moment + written.magnetic_torque)
    assert read.force_scale * read.force_imbalance == pytest.approx(force)
    assert read.moment_scale * read.moment_imbalance == pytest.approx(moment)


@pytest.mark.parametrize("plain", [False, True])
def test_every_bit_comes_back(file: Path, plain: bool) -> None:
    written = waypoint(plain=plain)
    file.write_bytes(content(written, ORIGIN))
    read, origin = read_step(file)
    assert origin == ORIGIN
    assert same(read, written)
    assert (read.step.balance is None) == (read.step.negative_pivots is None) == plain
    if not plain:
        assert read.critical_points[1].negative_pivots == (0, None)
        assert read.critical_points[0].kind == "limit point"


def test_a_file_is_readable_without_this_package(file: Path) -> None:
    with np.load(file, allow_pickle=False) as arrays:
        assert str(arrays["format"]) == "magshell checkpoint"
        assert int(arrays["version"]) == 2
        np.testing.assert_array_equal(arrays["u"], waypoint().step.state.u)


def test_torn_files(file: Path) -> None:
    """However much of it is missing."""
    whole = file.read_bytes()
    for length in np.linspace(0, len(whole) - 1, 60).astype(int):
        file.write_bytes(whole[:length])
        with pytest.raises(InputError, match=r"step-0007\.npz: is damaged .* then goes on from step 6"):
            read_step(file)


def test_flipped_bits(file: Path) -> None:
    """Refused, unless the bit says nothing: dates, and what the archive has twice, are a quarter of so small a file."""
    whole, refused = bytearray(file.read_bytes()), 0
    places = np.random.default_rng(1).integers(0, len(whole), 120).tolist()
    for place in places:
        whole[place] ^= 0x10
        file.write_bytes(whole)
        whole[place] ^= 0x10
        try:
            read, origin = read_step(file)
        except InputError:
            refused += 1
        else:
            assert same(read, waypoint()), f"byte {place}"
            assert origin == ORIGIN, f"byte {place}"
    assert refused > 0.6 * len(places), f"{refused} of {len(places)} were noticed"


def other(**changes: object) -> bytes:
    """A file without digest, as magshell 0.1.0 wrote it, with some arrays changed; None: left out."""
    with np.load(io.BytesIO(content(waypoint(), ORIGIN))) as arrays:
        all_of_them = {**arrays, "digest": None, **changes}
    made = io.BytesIO()
    np.savez(made, **{name: values for name, values in all_of_them.items() if values is not None})
    return made.getvalue()


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", r"is damaged .*goes on from step 6"),
        (b"PK not a zip file", r"is damaged"),
        (other(format="somebody's arrays"), r"is not a checkpoint of magshell. Delete it"),
        (other(version=3), r"has version 3 of the format, this magshell reads up to 2; update it"),
        (other(u=None), r"is damaged \(KeyError: 'u'\)"),
        (other(settings="{"), r"is damaged"),
        (other(number=8), r"holds step 8; it was renamed"),
        (other(settings="[1]"), r"is damaged or was changed: settings is not a table"),
        (other(flux_density=np.array([0.0, np.nan, 1.0])), r"is damaged or was changed: flux_density is not finite"),
        (other(load_factor=np.inf), r"is damaged or was changed: load_factor is not finite"),
        (other(phi=np.zeros(NODES, np.float32)), r"is damaged or was changed: phi is of the type float32"),
        (other(phi=np.zeros(NODES, complex)), r"is damaged or was changed: phi is of the type complex128"),
        (other(magshell="1" * 20_000), r"is damaged or was changed: magshell is a text of 80000 bytes"),
        (other(digest="0" * 64), r"is damaged or was changed: its numbers are not those that were written"),
    ],
)
def test_other_files(file: Path, content: bytes, message: str) -> None:
    file.write_bytes(content)
    with pytest.raises(InputError, match=rf"step-0007\.npz: {message}"):
        read_step(file)


def test_a_file_without_digest_is_read(file: Path) -> None:
    """As magshell 0.1.0 wrote it."""
    file.write_bytes(other())
    assert same(read_step(file)[0], waypoint())


def test_a_file_without_stretches_of_directors_is_read(file: Path) -> None:
    """As magshell 0.1.0 wrote it: states without s, increments and modes of ten columns."""
    with np.load(file) as arrays:
        narrow = {name: arrays[name][:, :10] for name in arrays.files if name.endswith(("increment", "_mode"))}
        states = [name for name in arrays.files if name == "s" or name.endswith("_s")]
    assert len(narrow) == len(states) == 3
    file.write_bytes(other(**narrow, **dict.fromkeys(states)))
    read, written = read_step(file)[0], waypoint()
    for state in (read.step.state, *(point.state for point in read.critical_points)):
        assert state.s.shape == (NODES,)
        assert not state.s.any()
    assert np.array_equal(read.step.state.alpha, written.step.state.alpha)
    mode, increment = read.critical_points[0].mode, read.slope.increment.nodal
    for wide, columns in ((mode, written.critical_points[0].mode), (increment, written.slope.increment.nodal)):
        assert np.array_equal(wide[:, :10], columns[:, :10])
        assert not wide[:, 10:].any()
        assert wide.shape == (NODES, 11)


def test_changed_numbers_are_noticed(file: Path) -> None:
    """Whoever loads the arrays, changes the last bit of one of them and saves them again."""
    with np.load(io.BytesIO(content(waypoint(), ORIGIN))) as arrays:
        all_of_them = dict(arrays)
    for name, values in all_of_them.items():
        if name in ("digest", "cpu_seconds") or values.dtype.kind != "f" or not values.size:
            continue
        changed = values.copy()
        changed.flat[-1] = np.nextafter(changed.flat[-1], 1e9)
        with file.open("wb") as opened:
            np.savez(opened, **{**all_of_them, name: changed})
        with pytest.raises(InputError, match="its numbers are not those that were written"):
            read_step(file)


def zeros(count: int) -> bytes:
    """An array file of zeros."""
    made = io.BytesIO()
    np.save(made, np.zeros(count))
    return made.getvalue()


def test_nothing_is_unpacked_that_is_larger_than_its_file(file: Path) -> None:
    """Zip bombs: compressed, entries that overlap, headers that claim more than there is."""
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("u.npy", zeros(10_000_000))
    with bounded(), pytest.raises(InputError, match="its arrays are compressed"):
        read_step(file)
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("u.npy", zeros(1_000_000))
        entry = archive.infolist()[0]
        archive.filelist += [entry] * 5000
    with bounded(), pytest.raises(InputError, match="claim to be larger than the file"):
        read_step(file)
    claimed = zeros(10).replace(b"(10,)", b"(10000000000,)").replace(b"          \n", b"\n", 1)
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("u.npy", claimed)
    with bounded(), pytest.raises(InputError, match="is damaged"):
        read_step(file)
    file.write_bytes(content(waypoint(), ORIGIN) + bytes(10_000_000))
    with pytest.raises(InputError, match="where at most 1000000 are possible"):
        read_step(file, 1_000_000)


def test_a_pickle_is_never_opened(file: Path) -> None:
    made = io.BytesIO()
    np.savez(made, format=np.array([print], dtype=object))
    file.write_bytes(made.getvalue())
    with pytest.raises(InputError, match="is damaged"):
        read_step(file)


def test_the_first_step_has_none_before_it(tmp_path: Path) -> None:
    (tmp_path / "step-0000.npz").touch()
    with pytest.raises(InputError, match="run the problem anew with --out"):
        read_step(tmp_path / "step-0000.npz")


def path_at(step: Waypoint) -> SimpleNamespace:
    return SimpleNamespace(trail=[step], settings=Settings())


def test_writer(tmp_path: Path) -> None:
    writer = CheckpointWriter(tmp_path, "digest")
    for number in (0, 1, 2, 10000):
        writer.kept(path_at(waypoint(number)))
    names = [file.name for file in step_files(tmp_path)]
    assert names == ["step-0000.npz", "step-0001.npz", "step-0002.npz", "step-10000.npz"]
    read, origin = read_step(step_files(tmp_path)[1])
    assert same(read, waypoint(1))
    assert origin.settings["max_iterations"] == Settings().max_iterations
    (tmp_path / "checkpoint" / "notes.txt").touch()
    writer.started(None, None)
    assert [file.name for file in (tmp_path / "checkpoint").iterdir()] == ["notes.txt"]


def test_forgotten_from_the_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """So that a path is left when that is broken off."""
    writer = CheckpointWriter(tmp_path, "digest")
    for number in range(4):
        writer.kept(path_at(waypoint(number)))
    gone = []
    monkeypatch.setattr(Path, "unlink", lambda file: gone.append(file.name))
    checkpoint.forget(tmp_path)
    assert gone == [f"step-000{number}.npz" for number in (3, 2, 1, 0)]


def test_full_disk_leaves_the_steps_before(tmp_path: Path) -> None:
    resource = pytest.importorskip("resource")
    writer = CheckpointWriter(tmp_path, "digest")
    writer.kept(path_at(waypoint(0)))
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4000, before[1]))
    try:
        with pytest.raises(OSError, match=r"step-0001\.npz"):
            writer.kept(path_at(waypoint(1)))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert [file.name for file in (tmp_path / "checkpoint").iterdir()] == ["step-0000.npz"]
    assert same(read_step(step_files(tmp_path)[0])[0], waypoint(0))
