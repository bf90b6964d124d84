"""Pictures: what they show, where they put it, and what happens where none can be drawn."""

from __future__ import annotations

import ctypes.util
import inspect
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from conftest import LENGTH, RADIUS, FakePath
from PIL import Image

from magshell.errors import InputError
from magshell.evaluation.converged import converged
from magshell.magnetics.fields.uniform import UniformField
from magshell.output import rendering
from magshell.output.abscissa import abscissae
from magshell.output.curve import curve_figure, displacements
from magshell.output.pictures import draw_curve, draw_pictures, draw_shape
from magshell.output.scene import best_axes, draw, fit, viewing_axes
from magshell.output.series import MOST_CURVES, some
from magshell.output.skin import skin_of
from magshell.output.tessellation import Tessellation, element_edges
from magshell.shell.shape_functions import NODES

FEW = 40


def test_surface_follows_the_tube(path):
    mesh = path.discretisation.mesh
    surface = Tessellation(mesh.elements, 6).surface(mesh.points)
    radial = surface.points * [0, 1, 1]
    radius = np.linalg.norm(radial, axis=1, keepdims=True)
    half_angle = np.pi / 4 / 8
    quadratic_error = half_angle**4
    assert np.abs(radius / RADIUS - 1).max() < quadratic_error
    assert np.abs(surface.normals - radial / radius).max() < half_angle**3
    a, b, c = np.moveaxis(surface.points[surface.triangles], 1, 0)
    pieces = np.cross(b - a, c - a)
    area = np.linalg.norm(pieces, axis=1).sum() / 2
    assert area == pytest.approx(LENGTH * RADIUS * np.pi / 2, rel=(half_angle / 6) ** 2), area
    outward = np.einsum("ij,ij->i", pieces, surface.normals[surface.triangles[:, 0]])
    assert outward.min() > 0


def test_edges_pass_through_their_nodes(path):
    mesh = path.discretisation.mesh
    triples = element_edges(mesh.elements)
    assert len(triples) == 8 * 7 + 9 * 6
    curves = Tessellation(mesh.elements, 6).edges(mesh.points, triples)
    np.testing.assert_allclose(curves[:, [0, -1, 3]], mesh.points[triples], atol=1e-12 * LENGTH)


def test_large_meshes_are_cut_less_finely():
    element = np.arange(8)[np.newaxis]
    points = NODES @ np.eye(2, 3)
    assert len(Tessellation(element).surface(points).triangles) == 72
    assert len(Tessellation(np.tile(element, (100_000, 1))).surface(points).triangles) == 2 * 100_000


@pytest.mark.parametrize("aspect", [0.5, 1.4, 3.0])
def test_camera_sees_everything_and_wastes_nothing(aspect):
    points = np.random.default_rng(2).normal(size=(50, 3)) * [5, 1, 2] + 7
    seen = fit(points, viewing_axes(-60, 24), aspect).on_picture(points)
    assert seen.min() > 0
    assert seen.max() < 1
    assert np.ptp(seen, axis=0).max() > 0.9


def test_view_is_upright_and_shows_a_plate_from_above():
    plate = np.random.default_rng(3).uniform(-1, 1, (100, 3)) * [1, 1, 0]
    axes = best_axes(plate)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(axes) == pytest.approx(1)
    assert axes[1, 2] > 0
    assert axes[2, 2] > 0


def test_scene_puts_body_and_arrow_where_the_camera_says(path, can_draw):
    mesh, u = path.discretisation.mesh, path.steps[-1].state.u
    skin = skin_of(path.model.shell)
    colours = np.tile(np.array([0, 120, 0], dtype=np.uint8), (len(skin.at_points(u)), 1))
    width, height = 400, 300
    placed = skin.placed(converged(path.discretisation, path.steps[-1]))
    scene, camera, arrow = draw(path.model.shell, placed, colours, np.array([0, 0, 1e-3]), [], (width, height))

    def pixel(point):
        x, y = camera.on_picture(point)
        return scene[int((1 - y) * height), int(x * width)].astype(int)

    assert scene.shape == (height, width, 4)
    assert scene[0, 0, 3] == scene[-1, -1, 3] == 0
    shaft = pixel(arrow.mean(axis=0))
    assert shaft[3] == 255
    assert shaft[0] > 2 * shaft[2], shaft
    corners, middles = mesh.elements[:, :4], mesh.elements[:, 4:]
    x = mesh.points + u
    centres = x[middles].sum(axis=1) / 2 - x[corners].sum(axis=1) / 4
    seen = np.array([pixel(centre) for centre in centres])
    assert (seen[:, 3] == 255).all()
    green = (seen[:, 1] > 2 * seen[:, 0]) & (seen[:, 1] > 2 * seen[:, 2])
    assert green.mean() > 0.8, green.mean()


def test_shape_is_written_or_returned(path, tmp_path, can_draw):
    file = tmp_path / "shape.png"
    assert draw_shape(path, file) is None
    returned = draw_shape(path, None)
    np.testing.assert_array_equal(np.asarray(returned), np.asarray(Image.open(file)))
    picture = np.asarray(returned.convert("RGB")).astype(int)
    assert picture.shape == (1120, 1600, 3)
    assert (picture[0] == 255).all()
    yellow = (picture[..., 0] > 170) & (picture[..., 1] > 150) & (picture[..., 2] < 60)
    assert yellow[:, :1300].sum() > 1000, "the bright end of the colour scale is on the body"


@pytest.mark.parametrize("color", ["rotation", "b3", "thickness_ratio", "group", "phi", "W"])
def test_any_output_can_colour_the_shape(path, plain_picture, few_pixels, color):
    assert (np.asarray(draw_shape(path, None, color=color)) != plain_picture).mean() > 0.005


@pytest.fixture(scope="module")
def plain_picture(can_draw):
    """The shape coloured by u3, of few pixels."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("magshell.output.shape.DPI", FEW)
        return np.asarray(draw_shape(FakePath(), None))


@pytest.fixture
def few_pixels(monkeypatch):
    monkeypatch.setattr("magshell.output.shape.DPI", FEW)


def test_undeformed_state_without_field_is_drawn(path, few_pixels, can_draw):
    assert np.ptp(np.asarray(draw_shape(path, None, step=0))) > 0


def test_wrong_output_or_step_is_bad_input(path):
    with pytest.raises(InputError, match="Did you mean"):
        draw_shape(path, None, color="displacment")
    with pytest.raises(InputError, match="steps 0 to 4"):
        draw_shape(path, None, step=5)


def test_curve_shows_probes_over_field_and_load(path):
    axes = curve_figure(path).axes[0]
    lines = {line.get_label(): line for line in axes.lines if line.get_marker() != "None"}
    loads = np.array([step.load_factor for step in path.steps])
    for name, node in path.model.probe_nodes.items():
        u = np.array([step.state.u[node] for step in path.steps])
        for i in (1, 2, 3):
            line = lines.pop(f"{name}  $u_{i}$", None)
            if name == "tip" and i == 2:
                assert line is None
            else:
                np.testing.assert_allclose(line.get_xdata(), 20 * loads)
                np.testing.assert_allclose(line.get_ydata(), 1e3 * u[:, i - 1])
    unstable = [step.load_factor for step in path.steps if step.negative_pivots]
    assert lines.pop("unstable").get_markerfacecolor() == "white"
    assert len(lines) == 5, "one hollow mark on each curve"
    for label, line in lines.items():
        assert (label[0], line.get_markerfacecolor(), *line.get_xdata()) == ("_", "white", *(20 * np.array(unstable)))
    (above,) = axes.child_axes
    load = 1e3 * 20e-3 * 80e-3 / (135e3 * 4e-7 * np.pi)
    assert above._functions[0](20.0) == pytest.approx(load)


def test_stable_path_speaks_of_no_unstable_state(path):
    path.steps[3].negative_pivots = None
    assert "unstable" not in {line.get_label() for line in curve_figure(path).axes[0].lines}


def test_curve_marks_critical_points(path):
    path.critical_points = [path.steps[2]]
    axes = curve_figure(path).axes[0]
    diamonds = [line for line in axes.lines if line.get_marker() == "D" and len(line.get_xdata())]
    u = [1e3 * path.steps[2].state.u[node, i] for node in path.model.probe_nodes.values() for i in range(3)]
    assert len(diamonds) == 5, "one on each curve"
    for line in diamonds:
        assert line.get_xdata() == pytest.approx([20 * path.steps[2].load_factor])
        assert np.abs(np.array(u) - line.get_ydata()).min() < 1e-12


def test_curve_of_a_field_that_turns_is_over_its_angle(path):
    """Raised in the first stage, turned in the second; |B| and the load factor are there when asked for."""
    path.model.field = UniformField((0.0, 0.0, 20e-3), history=(1, 1), rotation_axis=(0, 1, 0), rotation=(0, 1))
    path.courses = [turning(start=(0.0, 0.0), end=(1.0, 0.0)), turning(start=(1.0, 0.0), end=(1.0, np.pi / 2))]
    for step in path.steps[2:]:
        step.stage = 1
    path.critical_points = [path.steps[3]]
    axes = curve_figure(path).axes[0]
    assert axes.get_xlabel() == "angle of the field (°)"
    assert not axes.child_axes
    np.testing.assert_allclose(axes.lines[0].get_xdata(), [0.0, 0.0, 27.0, 54.0, 90.0])
    (diamond,) = {
        float(line.get_xdata()[0]) for line in axes.lines if line.get_marker() == "D" and len(line.get_xdata())
    }
    assert diamond == pytest.approx(54.0)
    assert [one.name for one in abscissae(path)] == ["field.angle", "field", "load_factor"]
    axes = curve_figure(path, over="load_factor").axes[0]
    assert axes.get_xlabel() == "load factor"
    np.testing.assert_allclose(axes.lines[0].get_xdata(), [0.0, 0.1, 1.3, 1.6, 2.0])
    path.steps[4].flux_density = np.array([20e-3, 0.0, 0.0])
    assert curve_figure(path, over="field").axes[0].lines[0].get_xdata()[-1] == pytest.approx(20.0), "its magnitude"
    with pytest.raises(InputError, match=r"no 'angle' to draw curves over. Did you mean 'field.angle'"):
        curve_figure(path, over="angle")


def turning(start, end):
    """A stage through which the amounts of the field, multiplier and angle, go from start to end."""
    start, end = np.array(start), np.array(end)
    return SimpleNamespace(amounts=lambda load: SimpleNamespace(drives=start + load * (end - start)))


def test_curves_can_be_drawn_over_what_moves(path):
    """A magnet that is switched on, moved and turned; what stays is not offered."""
    path.model.field = SimpleNamespace(drives=("near.multiplier", "near.d1", "near.d3", "near.angle", "coil.current1"))
    path.courses = [turning((0.0, 0.0, 0.0, 0.0, 0.0), (1.0, 0.0, -20e-3, -np.pi, 2.0))]
    found = {one.name: one for one in abscissae(path)}
    assert list(found) == ["near.angle", "load_factor", "near.multiplier", "near.d3", "coil.current1"]
    ends = {name: (one.text, one.of(path.steps)[-1]) for name, one in found.items()}
    assert ends == {
        "near.angle": ("angle of near (°)", pytest.approx(-180.0)),
        "load_factor": ("load factor", 1.0),
        "near.multiplier": ("multiplier of near", 1.0),
        "near.d3": ("displacement of near along X₃ (mm)", pytest.approx(-20.0)),
        "coil.current1": ("current 1 of coil (A)", 2.0),
    }


def test_of_many_probes_some_are_drawn_and_the_picture_says_how_many():
    """The farthest and the stillest are among them, and the legend is in the picture."""
    mesh = FakePath().discretisation.mesh
    probes = {f"probe with number {i}": tuple(mesh.points[i]) for i in range(len(mesh.points))}
    path = FakePath(probes=probes)
    figure = curve_figure(path)
    labels = [text.get_text() for text in figure.legends[0].get_texts()]
    drawn = {curve.name for curve in some(displacements(path))[0]}
    assert 4 <= len(drawn) <= MOST_CURVES
    u = {name: np.abs(path.steps[-1].state.u[node]).max() for name, node in path.model.probe_nodes.items()}
    moving = {curve.name for curve in displacements(path)}
    assert {max(u, key=u.get), min(moving, key=u.get)} <= drawn
    assert f"{len(drawn)} of {len(probes)} probes are drawn; history.csv has all." in " ".join(labels[-1].split("\n"))
    assert inside(figure)
    assert len({line.get_color() for line in figure.axes[0].lines[:-2]}) > len(drawn) / 2


def inside(figure):
    """Whether the legend is."""
    figure.draw_without_rendering()
    box, page = figure.legends[0].get_window_extent(), figure.bbox
    return page.x0 <= box.x0 and box.x1 <= page.x1 and page.y0 <= box.y0 and box.y1 <= page.y1


@pytest.mark.parametrize("many", [20, 120])
def test_legend_of_long_names_and_many_columns_stays_in_the_picture(many):
    """Smaller letters, broken lines; beyond that it says how many more there are."""
    probes = {f"{i}: {'a very long $name_' * 9}": (LENGTH, 0, RADIUS) for i in range(3)}
    probes |= {f"p{i}": (LENGTH, RADIUS, 0) for i in range(many)}
    path = FakePath(probes=probes)
    assert inside(curve_figure(path))
    figure = curve_figure(path, [f"{name}.u3" for name in probes])
    assert inside(figure)
    texts = [text.get_text() for text in figure.legends[0].get_texts()]
    if many == 120:
        assert texts[-1] == f"and {many + 3 - len(texts) + 1 + 1} more", texts[-3:]
    assert figure.axes[0].get_position().width > 0.4


def test_curve_of_a_reversed_field_runs_to_the_left(path):
    path.steps[4].flux_density = -path.steps[4].flux_density
    assert curve_figure(path).axes[0].lines[0].get_xdata()[-1] == pytest.approx(-20.0)


def test_negligible_components_are_left_out():
    path = FakePath(probes={"edge": (LENGTH, RADIUS, 0)})
    for step in path.steps:
        step.state.u[:, 1] = 0.009 * step.state.u[:, 2]
    labels = {line.get_label() for line in curve_figure(path).axes[0].lines}
    assert {"edge  $u_1$", "edge  $u_3$"} <= labels
    assert "edge  $u_2$" not in labels


def test_curve_without_probes_field_or_plain_names(tmp_path):
    path = FakePath(probes={}, field=(0.0, 0.0, 0.0))
    axes = curve_figure(path).axes[0]
    assert axes.get_xlabel() == "load factor"
    assert not axes.child_axes
    largest = [1e3 * np.linalg.norm(step.state.u, axis=1).max() for step in path.steps]
    np.testing.assert_allclose(axes.lines[0].get_ydata(), largest)
    draw_curve(FakePath(probes={"a$b_{$_": (LENGTH, 0, RADIUS)}), tmp_path / "curve.png")
    assert Image.open(tmp_path / "curve.png").size == (1440, 896)
    assert draw_curve(path, None).size == (1440, 896)


@pytest.fixture
def fresh_trial():
    """The answer of the trial is kept per process: forget it before and after."""
    rendering._trial_failure.cache_clear()
    yield
    rendering._trial_failure.cache_clear()


@pytest.fixture
def impostor(fresh_trial, tmp_path, monkeypatch):
    """Let a module of this source stand in for PyVista in the process of the trial."""

    def install(source):
        folder = tmp_path / "impostor"
        folder.mkdir()
        (folder / "pyvista.py").write_text(inspect.cleandoc(source))
        monkeypatch.setenv("PYTHONPATH", str(folder))

    return install


def check_message(message):
    assert isinstance(message, str)
    for package in ("libegl1", "libgl1-mesa-dri", "libosmesa6"):
        assert package in message


def test_crash_of_the_trial_becomes_a_message(path, tmp_path, impostor):
    impostor("""
        import os, signal
        os.kill(os.getpid(), signal.SIGSEGV)
    """)
    (tmp_path / "pictures").mkdir()
    (tmp_path / "pictures" / "shape.png").touch()
    curve, message = draw_pictures(path, tmp_path / "pictures")
    assert curve == tmp_path / "pictures" / "curve.png"
    check_message(message)
    assert "signal 11" in message
    assert [item.name for item in (tmp_path / "pictures").iterdir()] == ["curve.png"]


def test_trial_that_raises_or_hangs_becomes_a_message(impostor, monkeypatch):
    impostor("""
        import os, time
        if os.environ["MOOD"] == "slow":
            time.sleep(60)
        raise ImportError("libGL.so.1 is missing")
    """)
    for mood, seconds, words in (("sick", 60.0, "libGL.so.1 is missing"), ("slow", 0.3, "more than 0.3 s")):
        monkeypatch.setenv("MOOD", mood)
        monkeypatch.setattr(rendering, "SECONDS", seconds)
        rendering._trial_failure.cache_clear()
        with pytest.raises(rendering.RenderingUnavailable, match=words) as caught:
            rendering.require_rendering()
        check_message(str(caught.value))


def test_a_file_beside_the_user_is_not_taken_for_a_module(fresh_trial, tmp_path, monkeypatch):
    (tmp_path / "pyvista.py").write_text("raise SystemExit('the file of the user')")
    monkeypatch.chdir(tmp_path)
    assert "the file of the user" not in rendering._trial_failure()


@pytest.mark.skipif(ctypes.util.find_library("OSMesa") is not None, reason="OSMesa can draw here")
def test_vtk_itself_crashing_becomes_a_message(path, tmp_path, fresh_trial, monkeypatch):
    monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", "vtkOSOpenGLRenderWindow")
    check_message(draw_pictures(path, tmp_path)[1])


def test_trial_is_made_once(fresh_trial, monkeypatch):
    calls = []

    def run(*arguments, **options):
        calls.append(arguments)
        return rendering.subprocess.CompletedProcess(arguments, 0, "", "")

    monkeypatch.setattr(rendering.subprocess, "run", run)
    rendering.require_rendering()
    rendering.require_rendering()
    assert len(calls) == 1


def test_nothing_heavy_is_imported_before_it_is_needed():
    modules = ("history", "summary", "vtu", "pictures")
    code = ";".join([*(f"import magshell.output.{name}" for name in modules), "import sys; print(*sys.modules)"])
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = {name.split(".")[0] for name in ran.stdout.split()}
    assert not loaded & {"pyvista", "vtkmodules", "matplotlib", "PIL"}
