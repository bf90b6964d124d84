"""Every way to get regions and layers wrong that we could think of, and what the user is told."""

# ruff: noqa: E501 (a table reads best with one entry a line)

from __future__ import annotations

import pytest

import magshell as ms
from magshell.linalg import nested_dissection
from regions.models import ALONG, SOFT, STIFF, of_regions, strip


def bare(*regions, **options):
    return ms.Shell(strip(), regions=regions, **options)


LAYER = ms.Layer(1e-3, SOFT)
CLASSICAL = SOFT._replace(coupling_modulus=0.0, length_scale=0.0)
BAD = {
    "overlap": (
        lambda: of_regions(ms.Region("outer", 1e-3), ms.Region([1, 2], 2e-3)),
        r"^regions\[1\]: element 2 is already in the region 'outer'; an element has one region only$",
    ),
    "overlap of groups": (
        lambda: of_regions(ms.Region("outer", 1e-3), ms.Region(["inner", "outer"], 2e-3)),
        r"^regions\[1\] \('inner, outer'\): element 2 is already in the region 'outer'",
    ),
    "no elements": (lambda: of_regions(ms.Region([], 1e-3)), r"^regions\[0\]: has no elements$"),
    "none": (
        lambda: bare(ms.Region("outer", 1e-3, SOFT)),
        r"^shell: element 0 is in none of the regions \(outer\); put it into one, or give the shell a thickness and a "
        r"material, for all that are in none \(2 elements\)$",
    ),
    "none, half a default": (
        lambda: bare(ms.Region("outer", 1e-3, SOFT), thickness=1e-3),
        r"^shell: material is missing; element 0 is in none of the regions \(outer\)$",
    ),
    "nothing": (lambda: ms.Shell(strip()), "^shell: thickness is missing$"),
    "no material": (lambda: ms.Shell(strip(), 1e-3), "^shell: material is missing$"),
    "region without thickness": (lambda: bare(ms.Region("outer", material=SOFT)), r"'outer'\): thickness is missing$"),
    "region without material": (lambda: bare(ms.Region("outer", 1e-3)), r"'outer'\): material is missing$"),
    "region beside layers": (
        lambda: bare(ms.Region("outer", 1e-3), layers=[LAYER]),
        r"'outer'\): material is missing, and the shell has layers$",
    ),
    "unknown group": (lambda: of_regions(ms.Region("outre")), r"^regions\[0\] \('outre'\): There is no element group 'outre'. Did you mean 'outer'"),
    "group of edges": (lambda: of_regions(ms.Region("left")), "'left' is a group of edges, not of elements"),
    "number of no element": (lambda: of_regions(ms.Region([4])), "there is no element 4; the mesh has 4"),
    "number twice": (lambda: of_regions(ms.Region([1, 1])), "an element is listed twice"),
    "group of another type": (lambda: of_regions(ms.Region([0.5])), "it must be an element group, several, or numbers"),
    "thickness of zero": (lambda: of_regions(ms.Region("outer", 0.0)), r"'outer'\): thickness is 0 m; it must be positive"),
    "layer of zero": (
        lambda: of_regions(ms.Region("outer", layers=[LAYER, ms.Layer(0.0, SOFT)])),
        r"^regions\[0\] \('outer'\): layers\[1\]: thickness is 0 m; it must be positive and finite$",
    ),
    "layer of the shell": (lambda: bare(layers=[LAYER, ms.Layer(-1.0, SOFT)]), r"^shell: layers\[1\]: thickness is -1 m"),
    "thickness of text": (lambda: of_regions(ms.Region("outer", "1 mm")), r"thickness is '1 mm'; it must be a number \(m\)"),
    "thicker than the body": (lambda: of_regions(ms.Region("outer", 1.0)), "larger than the body .* check the units"),
    "layers thicker than the body": (lambda: bare(layers=30 * [LAYER]), r"^shell: thickness is 0.03 m, larger than"),
    "thickness beside layers": (lambda: of_regions(ms.Region("outer", 1e-3, layers=[LAYER])), r"thickness is given beside layers"),
    "material beside layers": (lambda: bare(material=SOFT, layers=[LAYER]), r"^shell: material is given beside layers"),
    "remanence beside layers": (lambda: bare(remanence=ALONG, layers=[LAYER]), r"^shell: remanence is given beside layers"),
    "remanence beside layers of a region": (
        lambda: of_regions(ms.Region("outer", remanence=ALONG, layers=[LAYER])), "remanence is given beside layers",
    ),
    "no layer": (lambda: of_regions(ms.Region("outer", layers=[1e-3])), r"layers\[0\] is 0.001; it must be a Layer"),
    "negative modulus": (
        lambda: of_regions(ms.Region("outer", material=SOFT._replace(shear_modulus=-1.0))),
        r"^regions\[0\] \('outer'\): material: shear_modulus is -1; it must be finite and positive$",
    ),
    "negative modulus of a layer": (
        lambda: bare(layers=[LAYER, ms.Layer(1e-3, STIFF._replace(lame_lambda=-1.0))]),
        r"^shell: layers\[1\]: material: lame_lambda is -1",
    ),
    "material by name": (lambda: of_regions(ms.Region("outer", material="soft")), "material is 'soft'; it must be a material law"),
    "coupling without micro-rotation": (
        lambda: of_regions(ms.Region("outer", material=SOFT), material=CLASSICAL, micro_rotation=False),
        r"'outer'\): material: coupling_modulus is 100000; without micro-rotation it must be 0",
    ),
    "layers without micro-rotation": (
        lambda: bare(layers=[ms.Layer(1e-3, CLASSICAL)], micro_rotation=False),
        r"^shell: micro_rotation is False beside layers, whose transverse shear is measured from the micro-rotation; leave "
        r"it out$",
    ),
    "a region of layers without micro-rotation": (
        lambda: of_regions(ms.Region("outer", layers=[ms.Layer(1e-3, CLASSICAL)]), material=CLASSICAL, micro_rotation=False),
        "^regions.*'outer'.*: micro_rotation is False beside layers",
    ),
    "layers that cannot stretch": (
        lambda: bare(layers=[LAYER], thickness_stretch="none"),
        r"^shell: thickness_stretch is 'none' beside layers, which always stretch, each by itself; leave it out$",
    ),
    "density of zero": (lambda: of_regions(ms.Region("outer", density=0.0)), r"'outer'\): density is 0 kg/m\^3"),
    "density of a layer": (lambda: bare(layers=[ms.Layer(1e-3, SOFT, density=-1.0)]), r"layers\[0\]: density is -1"),
    "offset": (lambda: of_regions(ms.Region("outer", offset="topp")), "offset is 'topp'; or give a length. Did you mean 'top'"),
    "offset of a list": (lambda: of_regions(ms.Region("outer", offset=[1])), r"offset is \[1\]; it must be a length"),
    "offset out of sight": (lambda: of_regions(offset=1.0), "offset is 1 m, larger than the body"),
    "one level": (lambda: of_regions(levels=1), r"levels is 1; it must be a whole number from 2 to 16 \(one level does not"),
    "no level": (lambda: bare(layers=[LAYER, LAYER], levels=0), "levels is 0; it must be a whole number from 1 to 16"),
    "half a level": (lambda: of_regions(ms.Region("outer", levels=2.5)), "levels is 2.5; it must be a whole number"),
    "infinite remanence": (
        lambda: bare(layers=[LAYER, ms.Layer(1e-3, SOFT, ms.remanence.function(lambda x: x / 0.0))]).parts,
        r"^shell: layers\[1\]: remanence: it is not finite in element 0$",
    ),
}  # fmt: skip


@pytest.mark.filterwarnings("ignore:(divide|invalid)")
@pytest.mark.parametrize("case", BAD, ids=str)
def test_bad_regions(case):
    made, words = BAD[case]
    with pytest.raises(ms.InputError, match=words):
        made()


@pytest.mark.parametrize(
    ("offset", "allowed"), [("middle", True), ("bottom", True), ("top", False), (-7e-3, True), (7e-3, False)]
)
def test_an_offset_beyond_the_curvature(offset, allowed):
    """A tube of 10 mm with outward normals: no face may reach its axis."""
    from magshell.equations.discretisation import Discretisation

    tube = ms.mesh.cylinder(10e-3, 20e-3, (8, 1))
    shell = ms.Shell(tube, 12e-3, SOFT, ms.remanence.constant([0.1, 0, 0]), offset=offset)
    model = ms.Model(shell, [ms.Clamp("start")], ms.UniformField([0, 1e-3, 0]))
    if allowed:
        Discretisation(model, nested_dissection)
        return
    with pytest.raises(
        ms.InputError, match=r"a face lies farther from the mesh than the curvature of element \d+ allows"
    ):
        Discretisation(model, nested_dissection)
