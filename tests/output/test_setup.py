"""The picture before any solve: what is marked, where, and what it looks like."""

from __future__ import annotations

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

import magshell as ms
from magshell.errors import InputError
from magshell.output.marks import (
    MOST_ARROWS,
    Solids,
    body_marks,
    field_marks,
    hinge_marks,
    load_marks,
    probe_marks,
    remanence_marks,
    spread_out,
    support_marks,
)
from magshell.output.scene import viewing_axes
from magshell.output.setup import INCHES, _legend, draw_setup, setup_scene, tints
from magshell.output.style import DPI
from magshell.output.turns import field_turns, source_turns, turn_marks

LENGTH, WIDTH = 20e-3, 6e-3
RUBBER = ms.MicropolarNeoHookean(303e3, 7300e3, 30.3e3, 1e-4)
AXES = viewing_axes(-60.0, 36.0)
X3 = np.array([0.0, 0.0, 1.0])


def strip(remanence=None, elements=(20, 6), **options):
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, elements)
    groups = {"near": np.flatnonzero(mesh.points[mesh.elements[:, 0], 0] < 0.4 * LENGTH)}
    groups["far"] = np.setdiff1d(np.arange(len(mesh.elements)), groups["near"])
    mesh = ms.mesh.Mesh(mesh.points, mesh.elements, groups, mesh.edge_groups)
    shell = ms.Shell(mesh, 1e-3, RUBBER, remanence or ms.remanence.constant((0.1, 0, 0)), density=1200.0)
    options = {"field": ms.UniformField((0, 0, 5e-3)), "probes": {"tip": (LENGTH, 0, 0)}} | options
    return ms.Model(shell, [ms.Clamp("left")], **options)


def shown(model):
    mesh = model.shell.mesh
    return mesh.points[mesh.elements]


def test_arrows_are_as_the_remanence_at_their_places():
    """Direction and length; in the plane just above it, out of it beginning at it, into it ending at it."""
    turning = ms.remanence.profile((0.0, 0.1), (0, LENGTH), (1, 0, 0), (1, 0, 0), (0, 6 * np.pi), X3)
    model = strip(turning)
    (mark,) = remanence_marks(model, shown(model), AXES, template=False)
    assert mark.solids is Solids.ARROWS
    assert mark.name == "remanence, up to 97.5 mT"
    assert 0.7 * MOST_ARROWS < len(mark.places) <= MOST_ARROWS, len(mark.places)
    at = mark.places[:, 0]
    length = np.linalg.norm(mark.vectors, axis=1)
    θ = 6 * np.pi * at / LENGTH
    step = length.max() / 0.975
    expected = step * (at / LENGTH)[:, None] * np.stack([np.cos(θ), 0 * θ, np.sin(θ)], axis=1)
    assert np.abs(mark.vectors - expected).max() < 1e-12 * LENGTH
    lowest = np.minimum(mark.places[:, 2] - 0.5 * mark.vectors[:, 2], mark.places[:, 2] + 0.5 * mark.vectors[:, 2])
    assert lowest.min() > -1e-12 * LENGTH
    assert lowest.max() < 0.13 * step


def test_elements_without_remanence_have_no_arrows():
    model = strip(ms.remanence.by_group({"far": ms.remanence.constant((0.1, 0, 0))}))
    (mark,) = remanence_marks(model, shown(model), AXES, template=False)
    assert mark.places[:, 0].min() > 0.4 * LENGTH
    bare = strip(ms.remanence.constant((0, 0, 0)), loads=[ms.Gravity(-9.81 * X3)])
    assert remanence_marks(bare, shown(bare), AXES, template=False) == []


def test_chosen_points_are_spread_out():
    points = np.random.default_rng(8).uniform(0, 1, (2000, 3)) * [4, 1, 0]
    chosen = spread_out(points, 100)
    assert 90 <= len(chosen) <= 100
    apart = np.linalg.norm(points[chosen][:, None] - points[chosen], axis=2) + 9 * np.eye(len(chosen))
    even = np.sqrt(4 / len(chosen))
    assert apart.min() > 0.4 * even, apart.min() / even
    farthest = np.linalg.norm(points[:, None] - points[chosen], axis=2).min(axis=1).max()
    assert farthest < 1.3 * even, farthest / even
    assert np.array_equal(spread_out(points[:5], 9), np.arange(5))


def test_the_template_carries_a_uniform_remanence():
    fold = ms.remanence.Fold((0.4 * LENGTH, 0, 0), (1, 0, 0), X3, np.pi / 2)
    model = strip(ms.remanence.by_group({"far": ms.remanence.template(ms.remanence.folded(fold), 0.1, X3)}))
    (mark,) = remanence_marks(model, shown(model), AXES, template=True)
    length = np.linalg.norm(mark.vectors, axis=1)
    assert np.abs(mark.vectors - length[:, None] * X3).max() < 1e-12 * LENGTH
    with pytest.raises(InputError, match="no part of it has a template"):
        draw_setup(strip(), template=True)


def test_field_arrows_one_for_each_direction():
    extent = shown(strip()).reshape(-1, 3)
    (mark,) = field_marks(strip(), extent, AXES)
    assert mark.name == "field, 5 mT"
    assert np.abs(mark.vectors[0] / np.linalg.norm(mark.vectors[0]) - X3).max() < 1e-15
    assert ((mark.extent @ AXES[0]) < (extent @ AXES[0]).min()).all(), "left of the part"
    turning = ms.UniformField((0, 0, 5e-3), rotation_axis=(0, 1, 0), rotation=(0, np.pi / 2, np.pi / 2))
    marks = field_marks(strip(field=turning), extent, AXES)
    assert [mark.name for mark in marks] == ["field 1, 5 mT", "field 2, 5 mT"]
    assert [mark.letters[0][0] for mark in marks] == ["$B_{1}$", "$B_{2}$"]
    assert abs(marks[0].vectors[0] @ marks[1].vectors[0]) < 1e-12
    assert field_marks(strip(field=ms.UniformField((0, 0, 0)), loads=[ms.Gravity(-X3)]), extent, AXES) == []


def test_supports_and_probes_are_where_they_are():
    model = strip()
    (clamp,) = support_marks(model, LENGTH, AXES)
    assert (clamp.name, clamp.solids) == ("left: clamp", Solids.CUBES)
    assert np.abs(clamp.places[:, :1]).max() < 0.02 * LENGTH
    (probes,) = probe_marks(model, LENGTH, AXES)
    ((text, place, _),) = probes.letters
    assert text == "tip"
    assert np.array_equal(place, [LENGTH, 0, 0])
    others = [ms.SimpleSupport("left"), ms.SymmetryPlane("right", (1, 0, 0)), ms.Prescribe("right", "u", 3, 1e-3)]
    model = ms.Model(model.shell, [*others, ms.Prescribe("left", "omega")], model.field)
    names = [mark.name for mark in support_marks(model, LENGTH, AXES)]
    assert names == ["left: simple support", "right: symmetry", "right: u3 given", "left: omega given"]
    assert probe_marks(model, LENGTH, AXES) == []


def test_loads_begin_on_the_part_or_end_there():
    loads = [
        ms.Force("right", (0, 0, 2e-3)),
        ms.Moment("right", (0, 1e-5, 0)),
        ms.Traction("far", (0, 0, -5.0)),
        ms.Pressure("near", 8.0),
        ms.Gravity((0, 0, -9.81)),
    ]
    marks = load_marks(strip(loads=loads), LENGTH, AXES)
    assert [mark.name for mark in marks] == [
        "right: force, 2 mN",
        "right: moment, 0.01 N mm",
        "far: traction, 5 Pa",
        "near: pressure, 8 Pa",
        "gravity, 9.81 m/s^2",
    ]
    for mark, sign in zip(marks, (1, 0, -1, 1, -1), strict=True):
        assert (np.sign(mark.vectors[:, 2]) == sign).all()
        near = mark.places - 0.5 * np.sign(sign) * mark.vectors
        if sign:
            assert np.abs(near[:, 2]).max() < 1e-12 * LENGTH, mark.name


def test_groups_have_tints_and_a_part_of_one_piece_is_plain():
    model = strip()
    colours = tints(model.shell)
    near, far = (model.shell.mesh.elements_of(name) for name in ("near", "far"))
    assert len(np.unique(colours[near], axis=0)) == len(np.unique(colours[far], axis=0)) == 1
    assert (colours[near[0]] != colours[far[0]]).any()
    assert len(np.unique(tints(dataclasses.replace(model.shell, mesh=ms.mesh.rectangle(1, 1, (2, 2)))), axis=0)) == 1


def legend(element_groups):
    figure = Figure(figsize=INCHES, dpi=DPI)
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (2, 1))
    model = strip()
    _legend(
        figure,
        dataclasses.replace(model.shell, mesh=ms.mesh.Mesh(mesh.points, mesh.elements, element_groups)),
        SimpleNamespace(marks=remanence_marks(model, shown(model), AXES, False), sources=set()),
        False,
    )
    figure.draw_without_rendering()
    return figure


def test_the_legend_has_the_groups_that_show():
    """Of one that others cover there is no tint in the picture."""
    figure = legend({"all": [0, 1], "left": [0], "tongue": [1]})
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["remanence, 100\u00a0mT", "left", "tongue"]


def test_the_legend_fits():
    figure = legend({"MAGNETISIERUNGSKLAPPENAUSSEN": [0], "lower": [1]})
    assert figure.legends[0].get_window_extent().x1 < figure.bbox.x1


def end_of(mark):
    """Angle of the arc's end about the axis, from its beginning."""
    centre, axis = mark.places[0], mark.vectors[0] / np.linalg.norm(mark.vectors[0])
    first, last = mark.arc[0] - centre, mark.arc[-1] - centre
    radius = np.linalg.norm(mark.vectors[0])
    assert np.linalg.norm(mark.arc - centre, axis=1) == pytest.approx(radius)
    assert np.abs((mark.arc - centre) @ axis).max() < 1e-12 * radius
    return np.arctan2(np.cross(first, last) @ axis, first @ last)


def test_prescribed_rotations_are_arcs_about_their_axis():
    """As far as the group is turned, in its direction, about the point that it is turned about, with the angle."""
    model = strip()
    through = (0.0, WIDTH, 1e-3)
    supports = [
        ms.Turn("left", (0, 2, 0), -np.pi / 3, through),
        ms.Prescribe("right", "omega", 1, np.pi / 2),
        ms.Prescribe("right", "u", 3, 1e-3),
        ms.Prescribe("right", "omega", 2),
    ]
    model = ms.Model(model.shell, supports, model.field)
    turn, twist = turn_marks(model, LENGTH)
    assert turn.places[0] == pytest.approx(through)
    assert twist.places[0] == pytest.approx((LENGTH, WIDTH / 2, 0))
    assert end_of(turn) * np.sign(turn.vectors[0] @ (0, 1, 0)) == pytest.approx(-np.pi / 3)
    assert end_of(twist) * np.sign(twist.vectors[0] @ (1, 0, 0)) == pytest.approx(np.pi / 2)
    assert [mark.letters[0][0] for mark in (turn, twist)] == ["60°", "90°"]
    assert [mark.name for mark in support_marks(model, LENGTH, AXES)][:1] == ["left: turned by -60 deg"]
    assert turn_marks(strip(), LENGTH) == []


def test_turns_of_magnets_are_arcs_about_their_axis():
    """At the point of the axis that moves with the magnet, in each stage that turns it; none far from the part."""
    centre, rise = np.array((LENGTH, 0.0, LENGTH)), np.array((0.0, 0.0, 5e-3))

    def turning(centre):
        motion = ms.Motion((1, 1, 1), (rise, rise, rise), (0, 3, 0), (0.0, np.pi / 2, -np.pi / 6), tuple(centre))
        source = ms.fields.Source(ms.fields.Dipole((0, 0, 0.1)), (0, 0, 2 * LENGTH))
        still = ms.MagnetField([source], ms.Motion((1, 1, 1)), name="still")
        both = still + ms.MagnetField([source], motion, name="arm")
        return strip(field=both, stages=[ms.Stage()] * 3)

    extent = strip().shell.mesh.points
    first, second = source_turns(turning(centre), extent, LENGTH)
    assert [mark.name for mark in (first, second)] == ["arm turns by 90° in stage 2", "arm turns by -120° in stage 3"]
    for mark, angle in ((first, np.pi / 2), (second, -2 * np.pi / 3)):
        assert mark.places[0] == pytest.approx(centre + rise)
        assert np.linalg.norm(mark.vectors[0]) > np.hypot(LENGTH, LENGTH), "the arc is hidden in what turns"
        assert end_of(mark) * np.sign(mark.vectors[0] @ (0, 1, 0)) == pytest.approx(angle)
    assert source_turns(turning(100 * centre), extent, LENGTH) == []


def test_turns_of_the_field_are_arcs_at_its_arrow():
    """One for each stage that turns it, from where it is; of more than a turn the picture says how far."""
    turning = ms.UniformField(
        (0, 1e-3, 5e-3), history=(1, 1, 1, 1), rotation_axis=(0, 1, 0), rotation=(0, np.pi / 2, np.pi / 2, 5 * np.pi)
    )
    model = strip(field=turning, stages=[ms.Stage()] * 4)
    arrows = field_marks(model, shown(model).reshape(-1, 3), AXES)
    quarter, more = field_turns(model, arrows, LENGTH)
    assert [mark.name for mark in (quarter, more)] == [
        "field turns by 90° in stage 2",
        "field turns by 810° in stage 4",
    ]
    assert np.cross(quarter.vectors[0], (0, 1, 0)) == pytest.approx(np.zeros(3))
    begin, end = (quarter.arc[i] - quarter.places[0] for i in (0, -1))
    radius = np.linalg.norm(begin)
    assert begin / radius == pytest.approx((0, 0, 1))
    assert end / radius == pytest.approx((1, 0, 0))
    assert np.linalg.norm(np.diff(more.arc, axis=0), axis=1).sum() < 2 * np.pi * radius, "less than a full circle"
    assert field_turns(strip(), field_marks(strip(), shown(strip()).reshape(-1, 3), AXES), LENGTH) == []
    along = ms.UniformField((0, 5e-3, 0), history=(1, 1), rotation_axis=(0, 1, 0), rotation=(0, 1))
    model = strip(field=along, stages=[ms.Stage()] * 2)
    assert field_turns(model, field_marks(model, shown(model).reshape(-1, 3), AXES), LENGTH) == []


@pytest.fixture
def figure_of(monkeypatch):
    """The figure of a picture before it is delivered."""

    def figure(model, **options):
        kept = []
        monkeypatch.setattr("magshell.output.setup.deliver", lambda figure, file: kept.append(figure))
        draw_setup(model, None, **options)
        kept[0].draw_without_rendering()
        return kept[0]

    return figure


def test_names_of_many_probes_do_not_cover_each_other(figure_of, can_draw):
    """Those without room are left out, and the legend says how many."""
    mesh = ms.mesh.rectangle(LENGTH, WIDTH, (20, 6))
    probes = {f"probe-{i}": tuple(point) for i, point in enumerate(mesh.points[::8])}
    figure = figure_of(strip(probes=probes))
    written = [text for text in figure.axes[0].texts if text.get_text().startswith("probe-")]
    boxes = np.array([text.get_window_extent().extents for text in written])
    a, b = boxes[:, None], boxes[None]
    assert ((a[..., :2] < b[..., 2:]) & (a[..., 2:] > b[..., :2])).all(axis=-1).sum() == len(written) > 10
    words = " ".join(" ".join(text.get_text().split()) for text in figure.legends[0].get_texts())
    assert f"probes, {len(written)} of {len(probes)} named" in words


def test_a_long_name_does_not_cover_its_probe(figure_of, can_draw):
    model = strip(probes={"a-long-name-of-the-tip": (LENGTH, 0, 0)})
    figure = figure_of(model)
    axes = figure.axes[0]
    (text,) = (text for text in axes.texts if "long" in text.get_text())
    camera = setup_scene(model, tuple(axes.images[0].get_array().shape[1::-1])).camera
    x, y = axes.transAxes.transform(camera.on_picture(np.array([LENGTH, 0, 0])))
    radius = 0.5 * 0.016 * LENGTH * axes.bbox.width / (2 * camera.half_width)
    left, bottom, right, top = text.get_window_extent().extents
    assert max(left - x, x - right, bottom - y, y - top) > radius


def test_picture(tmp_path, can_draw):
    """The remanence is blue, the field orange, the clamp green, all on white; the legend is not cut off."""
    file = tmp_path / "strip.png"
    model = strip(elements=(10, 3))
    assert draw_setup(model, file, "A strip") is None
    picture = np.asarray(Image.open(file)).astype(int)
    assert picture.shape == (1120, 1600, 3)
    red, green, blue = np.moveaxis(picture, 2, 0)
    counts = {
        "remanence": ((blue > 150) & (red < 80) & (green < 110)).sum(),
        "field": ((red > 150) & (green < 100) & (blue < 60)).sum(),
        "clamp": ((green > 90) & (red < 60) & (blue < 90)).sum(),
    }
    assert min(counts.values()) > 800, counts
    border = np.concatenate([picture[0], picture[-1], picture[:, 0], picture[:, -1]])
    assert (border == 255).all()


def test_rigid_bodies_magnets_and_hinges():
    """Balls on the nodes of a body, an arrow of its moment at its reference point, bars along the edges of a hinge."""
    points = {"left": (0, 0), "fold": (LENGTH / 2, 0), "right": (LENGTH, 0)}
    walls = {"one": ("left", "fold"), "two": ("fold", "right")}
    mesh = ms.mesh.profile(points, walls, WIDTH, elements=(2, 3), axis=(0, 1, 0), first=(1, 0, 0))
    rigid, hinges = [ms.RigidBody("right", "magnet", moment=(0, 0, 2e-3))], [ms.Hinge("fold", 1e-3)]
    shell = ms.Shell(mesh, 1e-3, RUBBER, rigid=rigid, hinges=hinges)
    model = ms.Model(shell, [ms.Turn("left", (0, 1, 0), 0.1)], ms.UniformField((5e-3, 0, 0)))
    body, magnet = body_marks(model, LENGTH, AXES)
    assert (body.name, magnet.name) == ("magnet: rigid body", "magnet: magnetic moment, 2 mA m^2")
    nodes = mesh.points[mesh.nodes_of("right")]
    assert np.linalg.norm(body.places[:, None] - nodes[None], axis=2).min(axis=1).max() < body.width
    assert np.cross(magnet.vectors[0], X3) == pytest.approx([0, 0, 0], abs=1e-15)
    assert np.linalg.norm(magnet.places[0] - 0.5 * magnet.vectors[0] - nodes.mean(axis=0)) < 0.05 * LENGTH
    (hinge,) = hinge_marks(model, LENGTH, AXES)
    assert hinge.name == "fold: hinge, 1 mN/rad"
    assert np.linalg.norm(hinge.vectors, axis=1).sum() == pytest.approx(WIDTH)
    assert np.abs(hinge.places[:, 0] - LENGTH / 2).max() < 0.01 * LENGTH
