"""Magnets, coils, gradients and grids in problem files: what becomes of them, their words, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from problem_files import STRIP, changed

import magshell as ms
from magshell.cli import main
from magshell.magnetics import fields
from magshell.magnetics.fields import (
    COILS,
    MAGNETS,
    FieldSum,
    GradientField,
    MagnetField,
    SampledField,
    SelfField,
    UniformField,
)
from magshell.problem.building import build
from magshell.problem.building.field import build_field
from magshell.problem.building.located import at
from magshell.problem.reading import check, parse
from magshell.problem.report import describe
from magshell.problem.schema import ProblemFile
from magshell.problem.source_report import lines
from problem.with_sources import EVERY, EVERY_SOURCE, GRADIENT, entry

MAGNET = """
[[magnets]]
shape = "cylinder"
diameter = "20 mm"
height = "10 mm"
polarisation = [0, 0, "1.3 T"]
position = [0, 0, "-30 mm"]
"""
POINTS = np.array([[0.001, 0.002, 0.003], [0.004, -0.006, 0.01]])


def read(*added: str, base: str = STRIP) -> ProblemFile:
    return check(parse(base + "".join(added), "test.toml"), "test.toml")


def field_of(*added: str, base: str = STRIP, folder=None) -> fields.Field:
    return build_field(read(*added, base=base), folder)


WITHOUT = changed(STRIP, ('flux_density = [0, 0, "2 mT"]\nstops = ["1 mT", "2 mT"]\n', ""), ("[field]\n", ""))


def test_all_kinds_are_here() -> None:
    assert set(EVERY) == {*MAGNETS, *COILS}


def test_a_uniform_field_alone_is_what_it_was() -> None:
    field = field_of()
    assert isinstance(field, UniformField)
    assert field.stops == (1e-3, 2e-3)
    assert build(read(), "test.toml").model.field.magnitude == 2e-3


@pytest.mark.parametrize("shape", EVERY)
def test_every_kind_has_a_finite_field_and_words(shape: str) -> None:
    placed = 'position = ["300 mm", 0, 0]\norientation_axis = [0, 1, 0]\norientation = "30 deg"'
    field = field_of(entry(shape, placed), base=WITHOUT)
    assert isinstance(field, MagnetField)
    values = field.at(field.ends(1)[1], POINTS)
    assert all(np.isfinite(array).all() and array.any() for array in values)
    ((label, text),) = lines(read(entry(shape, placed), base=WITHOUT))
    assert label == ("magnets[0]" if shape in MAGNETS else "coils[0]")
    assert text.endswith("at (300 mm, 0, 0), turned by 30 deg about (0, 1, 0)")


def test_placed_and_turned_in_si() -> None:
    placed = 'position = ["300 mm", 0, "-1 cm"]\norientation_axis = [0, 2, 0]\norientation = "30 deg"'
    (source,) = field_of(entry("cylinder", placed), base=WITHOUT).sources
    assert source.place == pytest.approx([0.3, 0.0, -0.01], abs=1e-16)
    assert source.rotation_vector == pytest.approx([0.0, np.pi / 6, 0.0], abs=1e-15)
    assert source.shape.polarisation == pytest.approx([4e-2 * np.pi, 0, 0])
    assert (source.shape.diameter, source.shape.height) == (0.02, 0.01)


def test_added_to_the_uniform_part() -> None:
    field = field_of(MAGNET)
    assert isinstance(field, FieldSum)
    uniform, magnets = field.fields
    found = field.at(field.ends(1)[1], POINTS).flux_density
    assert np.allclose(found, magnets.direct(POINTS).flux_density + np.array([0, 0, 2e-3]), atol=1e-17)
    assert uniform.stops == (1e-3, 2e-3)


def test_those_that_move_alike_are_one_field() -> None:
    approaching = 'displacement = [[0, 0, 0], [0, 0, "20 mm"]]\nhistory = [1, 1]'
    field = field_of(
        entry("cylinder", approaching), entry("loop", approaching), entry("sphere"), entry("helmholtz"), base=WITHOUT
    )
    moving, still = field.fields
    assert [source.shape.kind for source in moving.sources] == ["cylinder", "loop"]
    assert [source.shape.kind for source in still.sources] == ["sphere", "loop", "loop"]
    assert np.array_equal(moving.ends(2)[:, 3], [0.0, 0.0, 0.02])


def test_turning_in_its_place_or_about_a_centre() -> None:
    turning = 'position = ["50 mm", 0, 0]\nrotation_axis = [0, 0, 1]\nrotation = ["90 deg"]'
    circling = turning + '\nrotation_centre = [0, 0, 0]\nname = "arm"'
    field = field_of(entry("sphere", turning), entry("sphere", circling), base=WITHOUT)
    (one,), (other,) = (part.now(part.ends(1)[1]) for part in field.fields)
    assert one.place == pytest.approx([0.05, 0, 0], abs=1e-16)
    assert other.place == pytest.approx([0, 0.05, 0], abs=1e-16)
    assert field.drives[5] == "arm.multiplier"


def test_splines() -> None:
    base = changed(STRIP, ("stops = [", 'spline_spacing = "1 mm"\nstops = ['))
    assert field_of(MAGNET, base=base).fields[1].spacing == 1e-3
    assert ("splines", "spacing 1 mm") in list(lines(read(MAGNET, base=base)))


def test_the_bodys_own_field() -> None:
    """Beside the applied field, whose stops still hold, or alone; and what `check` says of it in any case."""
    asked = changed(STRIP, ("stops = [", "self_field = true\nstops = ["))
    field = field_of(base=asked)
    assert [type(part) for part in field.fields] == [UniformField, SelfField]
    model = build(read(base=asked), "test.toml").model
    assert model.course(0).stops() == [0.5, 1.0]
    assert model.loading(0.5).flux_density == pytest.approx([0, 0, 1e-3])
    alone = build(read("\n[field]\nself_field = true\n", base=WITHOUT), "test.toml")
    assert isinstance(alone.model.field, SelfField)
    assert alone.model.field_magnitude == 0.0
    for problem, ending in (
        (build(read(), "test.toml"), "left out (self_field)"),
        (build(read(base=asked), "test.toml"), "acts on it"),
        (alone, "acts on it"),
    ):
        told = dict(describe(problem).sections["Field"])["the body's own field"]
        assert told.startswith("up to ")
        assert told.endswith(ending)
        assert ("of the applied one" in told) == (problem is not alone)


def test_gradient() -> None:
    gradient = field_of(GRADIENT).fields[1]
    assert isinstance(gradient, GradientField)
    assert np.allclose(gradient.gradient, np.diag([1.0, 1.0, -2.0]))
    assert np.array_equal(gradient.centre, [5e-3, 0, 0])
    assert dict(lines(read(GRADIENT)))["gradient"].endswith("about (5 mm, 0, 0)")


def test_grid_and_coil_system(tmp_path) -> None:
    axes = [np.linspace(-100.0, 100.0, 5)] * 3
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    np.savez(tmp_path / "B.npz", x1=axes[0], x2=axes[1], x3=axes[2], B=0.0 * grid + [0, 0, 3.0])
    np.savetxt(tmp_path / "coils.csv", np.eye(8)[:, :2], delimiter=",")
    sampled = '\n[field.sampled]\nfile = "B.npz"\nflux_density_unit = "mT"\nlength_unit = "mm"\n'
    coils = '\n[field.coils]\ncalibration = "coils.csv"\ncurrents = [["2 A", "-1000 mA"]]\n'
    field = field_of(sampled, coils, folder=tmp_path)
    assert isinstance(field.fields[1], SampledField)
    assert np.allclose(field.at(field.ends(1)[1], POINTS).flux_density, [2.0, -1.0, 5e-3])
    assert {"sampled", "coil system"} <= dict(lines(read(sampled, coils))).keys()
    assert [name for _, name in read(sampled, coils).files()] == ["B.npz", "coils.csv"]
    (tmp_path / "coils.csv").write_text("1,2\n3\n")
    with pytest.raises(ms.InputError, match=r"field\.coils: coils\.csv: is not a table of numbers"):
        field_of(coils, folder=tmp_path)


def test_all_of_them_together() -> None:
    field = field_of(base=EVERY_SOURCE)
    assert len(field.fields) == 4, "the uniform part, those that stand still, those that move, the gradient"
    assert np.isfinite(field.at(field.ends(2)[2], POINTS + 1.0).flux_density).all()


def test_words_of_motion() -> None:
    how = (
        'history = [1, 0.5]\ndisplacement = [[0, 0, 0], [0, 0, "20 mm"]]\nrotation_axis = [0, 0, 1]\n'
        'rotation = [0, "90 deg"]\nrotation_centre = [0, 0, "1 mm"]'
    )
    ((_, text),) = lines(read(entry("loop", how), base=WITHOUT))
    assert text == (
        "loop ⌀ 80 mm, 10 turns, 2 A, at (0, 0, 0); multiplier 1, 0.5; displaced by (0, 0, 0), (0, 0, 20 mm); turns by "
        "0, 90 deg about (0, 0, 1) through (0, 0, 1 mm)"
    )
    ((_, text),) = lines(read(entry("halbach"), base=WITHOUT))
    assert text.startswith("halbach of 16, each a cuboid 10 mm × 10 mm × 20 mm, polarisation")


def test_the_model_has_it(tmp_path, capsys) -> None:
    problem = build(read(MAGNET), "test.toml")
    assert not problem.model.field.is_uniform
    assert problem.model.largest_field > 0.0
    (tmp_path / "magnet.toml").write_text(STRIP + MAGNET)
    assert main(["check", str(tmp_path / "magnet.toml")]) == 0
    assert "cylinder" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("text", "where", "what"),
    [
        (MAGNET.replace('shape = "cylinder"\n', ""), "magnets[0].shape", "is missing"),
        (MAGNET.replace('"cylinder"', '"cilinder"'), "magnets[0].shape", "'cilinder' is not known. Did you mean 'cyl"),
        (MAGNET.replace("polarisation = [0, 0, ", "#"), "magnets[0].polarisation", "is missing"),
        (MAGNET.replace('"1.3 T"', "0"), "magnets[0].polarisation", "is the zero vector"),
        (MAGNET.replace('"1.3 T"', '"1.3 Oe"'), "magnets[0].polarisation[2]", "is in oersted"),
        (MAGNET.replace('"20 mm"', '"0 mm"'), "magnets[0].diameter", "'0 mm' is not positive"),
        (MAGNET.replace('"20 mm"', "20"), "magnets[0].diameter", "has no unit where a length is expected"),
        (MAGNET.replace("diameter", "radius"), "magnets[0].radius", "is an unknown key"),
        (MAGNET.replace("[[magnets]]", "[magnets]"), "magnets", "is not a list: write [[magnets]]"),
        (MAGNET + "rotation = [1]", "magnets[0].rotation[0]", "has no unit where a angle is expected"),
        (MAGNET + 'rotation = ["1 deg"]', "magnets[0].rotation_axis", "is missing beside rotation"),
        (MAGNET + "rotation_axis = [0, 0, 1]", "magnets[0].rotation", "is missing beside rotation_axis"),
        (MAGNET + "rotation_centre = [0, 0, 0]", "magnets[0].rotation", "is missing beside rotation_centre"),
        (MAGNET + "orientation_axis = [0, 0, 1]", "magnets[0].orientation", "is missing beside orientation_axis"),
        (MAGNET + 'orientation = "1 deg"', "magnets[0].orientation_axis", "is missing beside orientation"),
        (MAGNET + "displacement = []", "magnets[0].displacement", "is empty; expected one displacement for each stage"),
        (entry("loop").replace('"2 A"', '"0 A"'), "coils[0].current", "is zero; leave the table out"),
        (entry("loop").replace('"2 A"', '"2 T"'), "coils[0].current", "is a magnetic flux density where a current is"),
        (entry("polygon").replace(', [0, "10 mm", 0]]', "]"), "coils[0].corners", "has 2 entries; expected three"),
        (entry("dipole").replace("A m^2", "A m"), "magnets[0].moment[2]", "has the unknown unit 'A m'"),
        (GRADIENT.replace('"1 T/m"', '"1 T"'), "field.gradient.tensor[0][0]", "is a magnetic flux density where a"),
        (GRADIENT.replace("tensor", "matrix"), "field.gradient.matrix", "is an unknown key"),
    ],
)  # fmt: skip
def test_refused_by_the_tables(text: str, where: str, what: str) -> None:
    with pytest.raises(ms.InputError) as caught:
        read(text)
    assert any(line.startswith(f"test.toml: {where}: ") and what in line for line in str(caught.value).splitlines()), (
        caught.value
    )


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            GRADIENT.replace('"-2 T/m"', '"2 T/m"'),
            r"field\.gradient: gradient: the diagonal of the gradient adds",
        ),
        (entry("halbach").replace("16", "60"), r"magnets\[0\]: halbach: 60 magnets of 0.01 × 0.01 m overlap"),
        (entry("ring").replace('"8 mm"', '"30 mm"'), r"magnets\[0\]: ring: inner_diameter is 30 mm"),
        (entry("solenoid").replace('spacing = "1 mm"', ""), r"coils\[0\]: solenoid: spacing is missing"),
        (
            '\n[field.sampled]\nfile = "no.csv"\nflux_density_unit = "T"\nlength_unit = "mm"\n',
            r"field\.sampled: .*no\.csv: there is no such file",
        ),
    ],
)
def test_refused_when_built(text: str, message: str, tmp_path) -> None:
    with pytest.raises(ms.InputError, match=message):
        field_of(text, folder=tmp_path)


def test_a_point_without_field_keeps_its_kind_when_it_is_located() -> None:
    field = field_of(entry("sphere"), base=WITHOUT)
    with (
        pytest.raises(fields.FieldUnknown, match=r"test\.toml: magnets: the point \(0, 0, 0\.01\) m is on the surface"),
        at("test.toml"),
    ):
        field.at(field.ends(1)[1], np.array([[0.0, 0.0, 0.01]]))


def test_an_empty_field_table() -> None:
    base = changed(STRIP, ('flux_density = [0, 0, "2 mT"]\nstops = ["1 mT", "2 mT"]\n', 'coupling = "couple"\n'))
    with pytest.raises(ms.InputError, match=r"field\.flux_density: is missing"):
        read(base=base)
    assert isinstance(field_of(MAGNET, base=base), MagnetField)
