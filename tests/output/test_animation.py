"""Animations and pictures of many steps: times, one camera, what is held, what is missing."""

from __future__ import annotations

import sys
from itertools import pairwise

import numpy as np
import pytest
from conftest import FakePath
from PIL import Image, ImageSequence

from magshell.errors import InputError
from magshell.output import animation
from magshell.output.animation import FILM_DPI, HELD, RATE, SECONDS, Frame, animate, draw_steps, film, frames, spread
from magshell.output.scene import axes_from
from magshell.output.shape import INCHES


def test_time_runs_evenly_along_the_path(path):
    shown = frames(path)
    assert [frame.step.number for frame in shown] == [0, 1, 2, 3, 4]
    expected = [*SECONDS * np.diff([step.arc_length for step in path.steps]) / path.steps[-1].arc_length, HELD]
    np.testing.assert_allclose([frame.seconds for frame in shown], expected)


def test_steps_that_would_only_flash_are_left_out():
    path = FakePath(loads=[0.0, 0.5, 0.5001, 0.5002, 0.9999, 1.0])
    shown = frames(path)
    assert [frame.step.number for frame in shown] == [0, 1, 5]
    assert sum(frame.seconds for frame in shown) == pytest.approx(SECONDS + HELD)


def test_path_of_one_step_is_one_frame():
    (frame,) = frames(FakePath(loads=[0.0]))
    assert frame.seconds == HELD


@pytest.mark.parametrize(("count", "numbers"), [(4, [2, 3, 4]), (1, [4]), (2, [3, 4])])
def test_chosen_steps_are_spread_along_the_path(path, count, numbers):
    assert [step.number for step in spread(path, count)] == numbers


def test_gif_has_every_frame_its_time_and_loops(path, tmp_path, can_draw):
    told = []
    file = animate(path, tmp_path / "größer.gif", "thickness_ratio", told.append)
    with Image.open(file) as gif:
        size, loop = gif.size, gif.info["loop"]
        durations = [frame.info["duration"] for frame in ImageSequence.Iterator(gif)]
        pictures = [np.asarray(frame.convert("RGB")).astype(int) for frame in ImageSequence.Iterator(gif)]
    assert size == tuple(round(FILM_DPI * inches) for inches in INCHES)
    assert loop == 0
    assert durations == [10 * round(100 * frame.seconds) for frame in frames(path)]
    assert told == pytest.approx([0.2, 0.4, 0.6, 0.8, 1.0])
    bar = np.s_[120:560, 880:]
    for one, other in pairwise(pictures):
        assert (one != other).any(axis=-1).mean() > 0.005, "the shape moves"
        assert np.abs(one[bar] - other[bar]).mean() < 2, "the bar stays"


def test_one_camera_sees_all_steps(path, can_draw):
    """What does not move is in the same place: the undeformed state alone fills as many pixels in any company."""
    first, last = path.steps[0], path.steps[-1]
    with film(path, [first, last], "u3", 60) as picture:
        one = np.asarray(picture(Frame(first, 0.0)))
        picture(Frame(last, 0.0))
        again = np.asarray(picture(Frame(first, 0.0)))
    np.testing.assert_array_equal(one, again)


def test_pictures_of_steps_are_named_by_their_numbers(path, tmp_path, can_draw):
    files = draw_steps(path, [path.steps[2], path.steps[4]], tmp_path / "new", "W")
    assert [file.name for file in files] == ["shape-0002.png", "shape-0004.png"]
    assert all(Image.open(file).size == (1600, 1120) for file in files)


def test_video_shows_every_frame_for_its_time(path, tmp_path, can_draw, monkeypatch):
    monkeypatch.setattr(animation, "FILM_DPI", 40)
    ffmpeg = pytest.importorskip("imageio_ffmpeg", reason="no video test: imageio-ffmpeg is not installed")
    file = animate(path, tmp_path / "shape.mp4")
    count, seconds = ffmpeg.count_frames_and_secs(str(file))
    assert seconds == pytest.approx(SECONDS + HELD, abs=2 / RATE)
    assert count == pytest.approx(RATE * (SECONDS + HELD), abs=2)


def test_video_without_its_package_says_what_to_install(path, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(InputError, match=r"magshell\[video\]"):
        animate(path, tmp_path / "shape.mp4")


def test_suffix_that_is_none_is_bad_input_before_any_work(path, tmp_path, monkeypatch):
    monkeypatch.setattr(animation, "film", None)
    with pytest.raises(InputError, match=r"ends in \.gif, \.mp4, \.mov or \.m4v"):
        animate(path, tmp_path / "shape.avi")


def test_frames_between_the_steps(path):
    """At an even rate, each between the two steps around its place on the path; the last step is held."""
    shown = frames(path, 2.0, smooth=True)
    assert len(shown) == 2 * RATE + 1
    assert shown[-1] == Frame(path.steps[-1], HELD)
    places = [f.step.arc_length + f.share * (f.later.arc_length - f.step.arc_length) for f in shown[:-1]]
    np.testing.assert_allclose(places, path.steps[-1].arc_length * np.arange(2 * RATE) / (2 * RATE), atol=1e-12)
    assert all(frame.later.number == frame.step.number + 1 and 0.0 <= frame.share < 1.0 for frame in shown[:-1])
    assert sum(frame.seconds for frame in frames(path, 9.0)) == pytest.approx(9.0 + HELD)


def test_a_frame_between_two_steps_lies_between_their_pictures(path, can_draw):
    """Its ends are these pictures themselves."""
    first, last = path.steps[-2:]
    with film(path, [first, last], "u3", 60) as picture:
        shown = [np.asarray(picture(Frame(first, 0.0, last, share))).astype(int) for share in (0.0, 0.5, 1.0)]
        ends = [np.asarray(picture(Frame(step, 0.0))).astype(int) for step in (first, last)]
    label = np.s_[45:, :]
    assert (shown[0] == ends[0]).all()
    assert np.abs(shown[2][label] - ends[1][label]).mean() < 0.1
    apart = np.abs(ends[0] - ends[1]).mean()
    assert 0.0 < np.abs(shown[1] - ends[0]).mean() < apart
    assert 0.0 < np.abs(shown[1] - ends[1]).mean() < apart


def test_a_film_from_a_camera_of_ones_own(path, tmp_path, can_draw):
    animate(path, tmp_path / "a.gif", seconds=1.0, camera=(0, -1, 0), smooth=True)
    with Image.open(tmp_path / "a.gif") as gif:
        durations = [frame.info["duration"] for frame in ImageSequence.Iterator(gif)]
    assert sum(durations) == 1000 * (1.0 + HELD)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"seconds": 0.0}, "seconds is 0.0; a film takes more than 0"),
        ({"seconds": float("nan")}, "seconds is nan"),
        ({"camera": (0, 0, 0)}, r"camera is \(0, 0, 0\); it must be three numbers"),
        ({"camera": "left"}, "camera is 'left'"),
    ],
)
def test_films_that_make_no_sense(path, tmp_path, given, words):
    with pytest.raises(InputError, match=words):
        animate(path, tmp_path / "a.gif", **given)


@pytest.mark.parametrize(
    ("camera", "right", "up"),
    [((0, -1, 0), (1, 0, 0), (0, 0, 1)), ((0, 0, 5), (1, 0, 0), (0, 1, 0)), ((1, 0, 0), (0, 1, 0), (0, 0, 1))],
)
def test_cameras(camera, right, up):
    axes = axes_from(camera)
    np.testing.assert_allclose(axes, [right, up, np.array(camera) / np.linalg.norm(camera)], atol=1e-15)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(axes_from((1, -2, 0.5))) == pytest.approx(1.0)
