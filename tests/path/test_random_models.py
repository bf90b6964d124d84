"""A handful of the random models of `docs/path-following.md`: each ends, or says why not."""

from __future__ import annotations

import pathlib
import sys

import numpy as np
import pytest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "docs"))

from path_study.random_models import COARSE, ENDED, draw, ending_of

COUPLE = "couple at the limit of the micro-rotation"


@pytest.mark.parametrize(("which", "ending"), [(0, ENDED), (4, ENDED), (155, ENDED), (38, COUPLE), (92, COARSE)])
def test_a_path_ends_or_says_why(which: int, ending: str) -> None:
    found = ending_of(which)
    assert found.ending == ending, found.reason
    assert found.solves < 500, found.solves
    assert (found.reached == pytest.approx(1.0)) == (ending == ENDED)
    assert ("Likely cause" in found.reason) == (ending != ENDED)
    if which == 38:  # 78 % of the limit in the last state
        assert "where the load factor turned, and the micro-rotation" in found.reason, found.reason


def test_models_are_drawn_alike_and_cover_what_is_promised() -> None:
    drawn = [draw(which) for which in range(48)]
    models, words = [one.model for one in drawn], " ".join(one.words for one in drawn)
    again = draw(47).model
    assert np.array_equal(again.shell.remanence_at_points, models[-1].shell.remanence_at_points)
    assert np.array_equal(again.field.vector, models[-1].field.vector)
    ratios = [float(part.split(",")[0]) for part in words.split("L/h ")[1:]]
    assert min(ratios) < 10.0
    assert max(ratios) > 700.0
    kinds = ("rectangle", "annulus", "cylinder", "sphere patch", "constant", "radial", "smooth", "tabulated", "updown")
    for kind in (*kinds, "rotate", "load,"):
        assert kind in words, kind
    assert max(len(model.shell.mesh.elements) for model in models) <= 56
