"""Letters in pictures: beside what they name, clear of marks and of each other."""

from __future__ import annotations

import numpy as np

from magshell.output.lettering import Text, placed

PAGE = np.array([0.0, 0.0, 400.0, 300.0])
NONE = np.zeros((0, 4))


def texts(places, size=(40.0, 12.0), towards=(1.0, 0.0), needed=False):
    return [Text(np.array(place, dtype=float), size, towards, needed) for place in places]


def boxes(middles, size):
    return np.concatenate([middles - 0.5 * np.array(size), middles + 0.5 * np.array(size)], axis=1)


def crossings(one, other):
    a, b = one[:, None], other[None]
    return int(((a[..., :2] < b[..., 2:]) & (a[..., 2:] > b[..., :2])).all(axis=-1).sum())


def test_a_name_stands_where_it_is_wanted_and_off_its_mark():
    for towards in ((1, 0), (0, 1), (-0.6, 0.8)):
        (middle,) = placed(texts([(200, 150)], towards=towards), NONE, NONE, PAGE, 9.0)
        away = middle - (200, 150)
        assert away @ towards > 0.9 * np.linalg.norm(away) * np.linalg.norm(towards), (towards, away)
        left, bottom, right, top = boxes(middle[None], (40, 12))[0]
        gap = np.hypot(max(left - 200, 0, 200 - right), max(bottom - 150, 0, 150 - top))
        assert 0 < gap <= 9.0, gap


def test_names_cover_neither_marks_nor_each_other_nor_the_border():
    places = np.random.default_rng(4).uniform((0, 0), (400, 300), (60, 2))
    marks = np.concatenate([places - 4, places + 4], axis=1)
    middles = placed(texts(places), marks, NONE, PAGE, 9.0)
    found = boxes(middles[~np.isnan(middles[:, 0])], (40, 12))
    assert 15 < len(found) <= 60
    assert crossings(found, marks) == 0
    assert crossings(found, found) == len(found), "each crosses itself only"
    assert (found[:, :2] >= 0).all()
    assert (found[:, 2:] <= PAGE[2:]).all()


def test_what_is_needed_is_placed_and_what_has_no_room_is_left_out():
    wall = np.array([[0.0, 0.0, 400.0, 300.0]])
    middles = placed([*texts([(200, 150)]), *texts([(200, 150)], needed=True)], wall, NONE, PAGE, 9.0)
    assert np.isnan(middles[0]).all()
    assert np.isfinite(middles[1]).all()


def test_less_important_marks_are_covered_as_little_as_can_be():
    right = np.array([[205.0, 100.0, 300.0, 200.0]])
    (middle,) = placed(texts([(200, 150)]), NONE, right, PAGE, 9.0)
    assert crossings(boxes(middle[None], (40, 12)), right) == 0
    everywhere = np.array([[0.0, 0.0, 400.0, 300.0]])
    (middle,) = placed(texts([(200, 150)]), NONE, everywhere, PAGE, 9.0)
    assert np.isfinite(middle).all()


def test_letters_at_the_head_of_an_arrow_stay_there_if_they_may():
    (middle,) = placed(texts([(200, 150)], towards=(0, 0), needed=True), NONE, NONE, PAGE, 9.0)
    assert middle.tolist() == [200, 150]
    head = np.array([[195.0, 145.0, 205.0, 155.0]])
    (middle,) = placed(texts([(200, 150)], towards=(0, 0), needed=True), head, NONE, PAGE, 9.0)
    assert crossings(boxes(middle[None], (40, 12)), head) == 0
