"""No volumetric locking up to a Poisson's ratio of 0.4999: a twin of the study on coarse meshes."""

from __future__ import annotations

import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "docs"))

import make_incompressible_study as study

NEARLY = (0.49, 0.4999)


@pytest.mark.parametrize(
    ("solve", "count", "exact", "allowed"),
    [
        (study.plate, 6, lambda nu: 0.00126532, 3e-3),
        (study.beam, 4, lambda nu: 1.0, 3e-3),
        (study.tube, 16, study.tube_exact, 2e-2),
    ],
    ids=["plate", "beam", "tube"],
)
def test_against_closed_forms(solve, count, exact, allowed):
    for nu in NEARLY:
        share = solve(nu, count) / exact(nu)
        assert abs(share - 1.0) < allowed, f"nu {nu}: {share:.5f} of the exact response"


@pytest.mark.parametrize("nu", NEARLY)
def test_cooks_membrane_against_a_finer_mesh(nu):
    share = study.cook(nu, 4) / study.cook(nu, 12)
    assert abs(share - 1.0) < 1e-2, f"{share:.5f} of the response of the finer mesh"


def test_a_coarse_mesh_loses_no_more_than_compressible_ones_in_membranes():
    """The error at 0.4999 is that at 0.3, but for a small part."""
    off = {nu: study.tube(nu, 16) / study.tube_exact(nu) for nu in (0.3, 0.4999)}
    assert abs(off[0.4999] - off[0.3]) < 4e-3, f"{off}"
