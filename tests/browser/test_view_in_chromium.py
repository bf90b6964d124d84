"""The page of a path in a browser: what a person does with it, and what then changes."""

from __future__ import annotations

import base64
import io
import json
import pathlib
import re
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from chromium import Browser, browser, missing
from joints.bodies import FOLD, extruded
from PIL import Image
from rolled import FIELD, WIDTH, mixed, plate, rolled
from rolled import LENGTH as ROLL
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from solver.models import LENGTH, THICKNESS, rubber, strip

import magshell as ms
from magshell.equations.discretisation import Discretisation
from magshell.evaluation.converged import converged
from magshell.evaluation.outputs import OUTPUTS
from magshell.linalg.ordering import nested_dissection
from magshell.output.history import history_text
from magshell.output.page import shown_steps, write_page
from magshell.output.page import steps as page_steps
from magshell.output.solid.slab import slab_of, volume
from magshell.output.tessellation import Tessellation
from magshell.solver import solve
from magshell.solver.critical import LIMIT_POINT, CriticalPoint
from magshell.solver.path import Path

STEPS, UNSTABLE, CRITICAL = 8, 5, 4
TITLE = 'Größe "5" & <b>bold</b> </script><script>fail()</script> 磁石'
PROBE = 'tip\'s "end" </script> <i>μ</i>'
SIZE = 1000, 700
AS_OPENED = """
play(false);
at("colour").value = header.colour;
at("range").value = "path";
for (const [box, on] of [["edges", header.edges], ["arrows", false], ["undeformed", true]]) at(box).checked = on;
choose();
camera.look(...header.view);
go(header.steps.length - 1);
"""
AFTER_DRAWING = "await new Promise(drawn => requestAnimationFrame(() => requestAnimationFrame(drawn)));"

pytestmark = pytest.mark.skipif(bool(missing()), reason=f"no test in a browser: {missing()} is not installed")


@pytest.fixture(scope="module")
def path() -> Path:
    """A plate rolled up in eight steps, with an unstable step, a critical point and a probe of an awkward name."""
    path = rolled(plate((10, 6)), STEPS, PROBE)
    path.steps[UNSTABLE] = path.steps[UNSTABLE]._replace(negative_pivots=1)
    at = path.steps[CRITICAL]
    mode = np.zeros((len(at.state.u), 11))
    path.critical_points.append(
        CriticalPoint(1, LIMIT_POINT, 0, at.load_factor, at.flux_density, at.arc_length, at.state, mode, (0, 1))
    )
    return path


@pytest.fixture(scope="module")
def file(path: Path, tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """The page, in a folder with a blank and a letter that is not ASCII."""
    return write_page(path, tmp_path_factory.mktemp("Ergebnis größer") / "view.html", TITLE)


@pytest.fixture(scope="module")
def shared() -> Iterator[Browser]:
    """One browser for all tests."""
    with browser() as window:
        yield window


@pytest.fixture
def window(shared: Browser, file: pathlib.Path) -> Iterator[Browser]:
    """The page as it opens; whatever a test does, it complains of nothing and asks for nothing."""
    if shared.driver.current_url == file.as_uri():
        shared.size(*SIZE)
        shared.do(AS_OPENED)
        asked = set()
    else:
        shared.size(*SIZE)
        shared.requests()  # those of other pages
        shared.open(file)
        asked = {file.as_uri()}
    yield shared
    assert shared.console() == []
    assert {address for address in shared.requests() if not address.startswith("data:")} == asked


def shape(window: Browser) -> np.ndarray:
    """The pixels of the shape alone, without bar, letters and probes."""
    picture = window.do(AFTER_DRAWING + "drawScene(); return at('canvas').toDataURL();")
    drawn = Image.open(io.BytesIO(base64.b64decode(picture.partition(",")[2])))
    white = Image.new("RGBA", drawn.size, "white")
    return np.asarray(Image.alpha_composite(white, drawn).convert("RGB")).astype(int)


def text(window: Browser, identity: str) -> str:
    return window.driver.find_element(By.ID, identity).text


def ring(window: Browser) -> list[float]:
    """Where the present step is marked on the curves."""
    rings = window.driver.find_elements(By.CSS_SELECTOR, "#plot .ring")
    return [float(circle.get_attribute(name)) for circle in rings for name in ("cx", "cy")]


def differ(one: np.ndarray, other: np.ndarray) -> float:
    """Share of the pixels that differ."""
    return float((one != other).any(axis=-1).mean())


def choose(window: Browser, identity: str, value: str) -> None:
    window.do(
        "const menu = document.getElementById(given[0]); menu.value = given[1];"
        "menu.dispatchEvent(new Event('change'));" + AFTER_DRAWING,
        identity,
        value,
    )


@pytest.mark.parametrize(("width", "height", "dark"), [(1400, 900, False), (800, 600, True)])
def test_everything_is_there_at_first(window, path, tmp_path, width, height, dark):
    window.size(width, height, dark)
    window.do(AFTER_DRAWING)
    picture = window.picture()
    picture.save(tmp_path / "view.png")
    assert picture.size == (width, height)
    colours = len(picture.getcolors(width * height))
    assert colours > 1000, f"{colours} colours, see {tmp_path}"
    assert text(window, "field") == f"|B| = {1e3 * FIELD:g} mT"
    assert text(window, "step") == f"step {STEPS} of {STEPS}"
    assert text(window, "quantity") == "u₃ (mm)"
    assert len(window.driver.find_elements(By.CSS_SELECTOR, "#compass .field")) == 1
    overflow = window.driver.execute_script("return document.documentElement.scrollHeight - innerHeight")
    assert overflow <= 0, f"{overflow} pixels are below the window"


def test_names_are_shown_as_they_were_written(window):
    assert window.driver.title == TITLE
    assert window.driver.find_element(By.TAG_NAME, "h1").text == TITLE
    labels = [item.text for item in window.driver.find_elements(By.CSS_SELECTOR, "#legend li")]
    assert f"{PROBE} u₃" in labels, labels
    with_type = window.driver.find_elements(By.CSS_SELECTOR, "script[type]")
    assert len(window.driver.find_elements(By.TAG_NAME, "script")) == len(with_type) + 1


def test_slider_moves_shape_mark_and_field(window):
    slider = window.driver.find_element(By.ID, "slider")
    before, marked = shape(window), ring(window)
    slider.send_keys(Keys.ARROW_LEFT)
    slider.send_keys(Keys.ARROW_LEFT)
    after = shape(window)
    assert differ(before, after) > 0.02, differ(before, after)
    assert text(window, "field") == f"|B| = {1e3 * FIELD * (STEPS - 2) / STEPS:g} mT"
    moved = np.array(ring(window)) - np.array(marked)
    assert (moved[::2] < -20).all(), moved
    window.driver.find_element(By.TAG_NAME, "body").send_keys(Keys.HOME)
    assert text(window, "field") == "|B| = 0 mT"
    assert text(window, "step") == f"step 0 of {STEPS}"


def test_colour_changes_shape_bar_and_unit(window):
    first = shape(window)
    choose(window, "colour", "energy 0")
    energy = shape(window)
    assert differ(first, energy) > 0.02, differ(first, energy)
    assert text(window, "quantity") == "W (µJ)"
    assert text(window, "meaning") == OUTPUTS["energy"].sentence
    menu = window.driver.find_element(By.ID, "colour")
    assert menu.get_attribute("title") == OUTPUTS["energy"].sentence
    choose(window, "colour", "rotation 3")
    assert text(window, "quantity") == "|ϑ| (rad)"


def test_range_of_colours_is_that_of_path_or_step(window, path):
    def top() -> float:
        ticks = window.driver.find_elements(By.CSS_SELECTOR, "#ticks li")
        return max(float(tick.text.replace("−", "-")) for tick in ticks)

    window.do("go(1);" + AFTER_DRAWING)
    choose(window, "range", "path")
    of_path = top()
    choose(window, "range", "step")
    of_step = top()
    u = [1e3 * path.steps[number].state.u[:, 2].max() for number in range(STEPS + 1)]
    assert 0.7 * max(u) < of_path <= max(u), (of_path, u)
    assert 0.7 * u[1] < of_step <= u[1], (of_step, u)


def test_drag_wheel_and_buttons_move_the_eye(window):
    canvas = window.driver.find_element(By.ID, "canvas")
    first = shape(window)
    ActionChains(window.driver).move_to_element(canvas).click_and_hold().move_by_offset(120, 40).release().perform()
    turned = shape(window)
    assert differ(first, turned) > 0.05, differ(first, turned)
    ActionChains(window.driver).scroll_by_amount(0, -300).perform()
    window.do("canvas.dispatchEvent(new WheelEvent('wheel', {deltaY: -300, clientX: 300, clientY: 400}));")
    nearer = shape(window)
    assert differ(turned, nearer) > 0.05, differ(turned, nearer)
    ActionChains(window.driver).double_click(canvas).perform()
    assert differ(first, shape(window)) == 0
    window.driver.find_element(By.CSS_SELECTOR, "#views button:last-child").click()
    from_above = shape(window)
    assert differ(first, from_above) > 0.05, differ(first, from_above)


def test_two_fingers_zoom(window):
    finger = (
        "const touch = (kind, id, x, y) => canvas.dispatchEvent(new PointerEvent(kind, {pointerId: id, clientX: x,"
        " clientY: y, pointerType: 'touch'})); canvas.setPointerCapture = () => {}; const before = camera.perPixel;"
        "touch('pointerdown', 1, 300, 400); touch('pointerdown', 2, 400, 400); touch('pointermove', 2, 500, 400);"
        "touch('pointerup', 1, 300, 400); touch('pointerup', 2, 500, 400); return before / camera.perPixel;"
    )
    assert window.do(finger) == pytest.approx(2.0)


def test_click_on_a_curve_goes_to_its_step(window):
    plot = window.driver.find_element(By.ID, "plot")
    aside = window.driver.execute_script(
        "const box = plot.getBoundingClientRect(); const {x, lines} = curves.about;"
        "return [curves.px(x[3]) - box.width / 2, curves.py(lines[0].y[3]) - box.height / 2].map(Math.round)"
    )
    ActionChains(window.driver).move_to_element_with_offset(plot, *aside).click().perform()
    assert text(window, "step") == f"step 3 of {STEPS}"


def test_unstable_steps_and_critical_points_are_marked(window, path):
    script = "return curves.about.lines.length"
    lines = window.driver.execute_script(script)
    hollow = window.driver.find_elements(By.CSS_SELECTOR, "#plot .line .hollow")
    critical = window.driver.find_elements(By.CSS_SELECTOR, "#plot .critical")
    assert (len(hollow), len(critical)) == (lines, lines)
    badge = window.driver.find_element(By.ID, "unstable")
    assert not badge.is_displayed()
    window.do(f"go({UNSTABLE});")
    assert badge.is_displayed()


def test_play_runs_through_all_steps(window):
    window.do(
        "window.seen = []; new MutationObserver(() => seen.push(state.step)).observe(at('step'), {childList: true});"
    )
    window.driver.find_element(By.ID, "play").click()
    window.until(f"return playing === null && state.step === {STEPS} && seen.length > 0")
    assert window.do("return seen") == list(range(STEPS + 1))
    assert text(window, "step") == f"step {STEPS} of {STEPS}"


def test_marks_and_outlines_can_be_shown_and_hidden(window):
    for box in ("edges", "arrows", "undeformed"):
        before = shape(window)
        window.driver.find_element(By.ID, box).click()
        change = differ(before, shape(window))
        assert change > 5e-4, (box, change)


def test_numbers_of_the_page_are_those_of_the_path(window, path):
    """Sixteen bits between the least and the largest value of a step."""
    for name in ("displacement", "energy", "normal"):
        values = np.asarray(OUTPUTS[name].evaluate(converged(path.discretisation, path.steps[3]))).reshape(
            -1, OUTPUTS[name].components
        )
        script = "return JSON.stringify(quantities.get(given[0]).columns(3).map(column => [...column]))"
        read = np.array(json.loads(window.do(script, name))).T
        step = np.ptp(values, axis=0) / 65534
        assert (np.abs(read - values) <= 0.5 * step + 1e-6 * np.abs(values).max()).all(), name


def test_triangles_and_quadrilaterals_are_drawn_as_in_pictures(shared, tmp_path):
    """The surface that the page computes is that of the tessellation of all other pictures."""
    path = rolled(mixed(), 4)
    mesh, state = path.discretisation.mesh, path.steps[3].state
    assert mesh.triangles.sum() == 2
    shared.size(1400, 900)
    shared.open(write_page(path, tmp_path / "mixed.html"))
    script = "go(3); return JSON.stringify([body.positions, body.normals, body.triangles].map(list => [...list]))"
    points, normals, triangles = (np.array(list_) for list_ in json.loads(shared.do(script)))
    surface = Tessellation(mesh.elements, 6).surface(mesh.points + state.u)
    assert np.abs(points.reshape(-1, 3) - surface.points).max() < 1e-4 * mesh.size
    assert np.abs(normals.reshape(-1, 3) - surface.normals).max() < 2e-3
    np.testing.assert_array_equal(triangles.reshape(-1, 3), surface.triangles)
    assert shared.console() == []


def test_marks_of_a_page_that_leaves_out_steps_are_at_theirs(shared, tmp_path, monkeypatch):
    """The line goes through all steps; marks, the ring and a click are at those that are there."""
    path = rolled(plate((2, 2)), 9)
    monkeypatch.setattr(page_steps, "MOST_BYTES", 4.5 * page_steps._bytes_of_step(path))
    shared.open(write_page(path, tmp_path / "few.html"))
    numbers = [step.number for step in shown_steps(path)]
    assert len(numbers) == 4
    count = "return [...plot.querySelectorAll('.line')].map(line => line.querySelectorAll('.mark').length)"
    assert set(shared.driver.execute_script(count)) - {0} == {4}
    line = shared.driver.find_element(By.CSS_SELECTOR, "#plot polyline").get_attribute("points")
    assert len(line.split()) == len(path.steps)
    shared.do("go(2);" + AFTER_DRAWING)
    assert text(shared, "step") == f"step {numbers[2]} of 9"
    place = shared.driver.execute_script("return curves.px(curves.about.x[given])".replace("given", str(numbers[2])))
    assert ring(shared)[0] == pytest.approx(place)
    assert text(shared, "field") == f"|B| = {1e3 * FIELD * numbers[2] / 9:.4g} mT"
    nearest = "const box = plot.getBoundingClientRect(); const {x, lines} = curves.about; const i = given[0];"
    nearest += (
        "return curves.nearest({clientX: box.left + curves.px(x[i]), clientY: box.top + curves.py(lines[0].y[i])});"
    )
    assert [shared.do(nearest, number) for number in numbers] == [0, 1, 2, 3]
    assert shared.console() == []


def test_path_that_has_not_begun_is_shown(shared, tmp_path):
    """The undeformed state alone: no field, no extent of the curves, one value of every colour."""
    path = rolled(plate((2, 2)), 1)
    del path.steps[1:]
    path.converged, path.reason = False, "interrupted"
    shared.open(write_page(path, tmp_path / "begun.html"))
    assert text(shared, "field") == "no field"
    assert text(shared, "step") == "step 0 of 0"
    assert "NaN" not in shared.driver.execute_script("return document.querySelector('main').outerHTML")
    assert shared.console() == []


def test_browser_without_webgl_shows_the_curves(shared, file):
    without = "HTMLCanvasElement.prototype.getContext = () => null;"
    command = "Page.addScriptToEvaluateOnNewDocument"
    script = shared.driver.execute_cdp_cmd(command, {"source": without})
    try:
        shared.driver.get(file.as_uri())
        shared.do("go(2);" + AFTER_DRAWING)
        assert "WebGL 2 is missing" in text(shared, "message")
        assert text(shared, "step") == f"step 2 of {STEPS}"
        assert len(ring(shared)) > 0
        assert shared.console() == []
    finally:
        shared.driver.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", script)


def solid_of(window: Browser, step: int) -> bytes:
    """The STL file that the page makes of a step."""
    script = (
        "const bytes = new Uint8Array(solidFile(arguments[0])); let text = '';"
        "for (const byte of bytes) text += String.fromCharCode(byte); return btoa(text);"
    )
    return base64.b64decode(window.driver.execute_script(script, step))


def regions() -> Path:
    """Two materials, one thickness: their border is a step where the strip is bent, and none at rest."""
    whole = strip((4, 2))
    mesh = replace(whole.shell.mesh, element_groups={"far": np.array([2, 3, 6, 7])})
    shell = replace(whole.shell, mesh=mesh, regions=[ms.Region("far", material=rubber(THICKNESS, 0.2))])
    return solve(replace(whole, shell=shell))


def folded() -> Path:
    """Two sheets at a right angle, the second pulled at its end."""
    mesh = extruded(FOLD, 1, 1, width=10e-3, size=10e-3)
    shell = ms.Shell(mesh, 1e-3, ms.MicropolarNeoHookean(1e5, 1.7e5, length_scale=3e-5))
    return solve(ms.Model(shell, [ms.Clamp("near")], loads=[ms.Force("far", (4e-4, 2e-4, -2e-3))]))


@pytest.mark.parametrize("kind", ["quadrilaterals", "triangles too", "regions", "folded"])
def test_solid_of_a_step_is_closed(shared, path, tmp_path, kind):
    """As exact as the page's numbers of 16 bits; its volume is that of the body that the command exports."""
    trimesh = pytest.importorskip("trimesh")
    if kind != "quadrilaterals":
        path = {"regions": regions, "folded": folded, "triangles too": lambda: rolled(mixed(), 3)}[kind]()
    shared.open(write_page(path, tmp_path / "view.html"))
    for number in (0, len(path.steps) // 2):  # at the last, the ends of the roll touch
        content = solid_of(shared, number)
        body = trimesh.load(io.BytesIO(content), file_type="stl")
        assert body.is_watertight
        assert body.is_winding_consistent
        exact = volume(slab_of(converged(path.discretisation, path.steps[number])))
        assert 1e-9 * body.volume == pytest.approx(exact, rel=2e-2 if number else 1e-3)
    assert shared.console() == []


def test_button_saves_the_solid(shared, path, tmp_path):
    shared.open(write_page(path, tmp_path / "view.html", TITLE))
    kept = (
        "window.kept = []; HTMLAnchorElement.prototype.click = function () { kept.push([this.download, this.href]); }"
    )
    shared.driver.execute_script(kept)
    shared.driver.find_element(By.ID, "stl").click()
    ((name, address),) = shared.driver.execute_script("return kept")
    assert name == f"{TITLE}, step {len(path.steps) - 1}.stl"
    assert address.startswith("blob:")
    assert shared.console() == []


def test_other_curves_can_be_chosen(shared, tmp_path):
    path = solve(strip())
    shared.size(*SIZE)
    shared.open(write_page(path, tmp_path / "view.html"))
    names = shared.driver.execute_script("return [...document.querySelectorAll('#curve option')].map((o) => o.text)")
    series = ["reaction moment", "energy", "work", "magnetic torque", "largest stress", "largest strain"]
    assert names == ["displacement", *series]
    choose(shared, "curve", str(names.index("reaction moment")))
    assert shared.driver.find_element(By.CSS_SELECTOR, "#legend li").text == "left M₂"
    assert "reaction moment (mN mm)" in shared.driver.find_element(By.ID, "plot").text
    moment = 1e6 * path.table()["left.M2"]
    place = shared.driver.execute_script("return curves.py(arguments[0])", float(moment.iloc[-1]))
    assert ring(shared)[1] == pytest.approx(place, abs=1e-6)
    assert shared.console() == []


SAVED = """
window.saved = null;
HTMLAnchorElement.prototype.click = function () { window.named = this.download; };
const made = URL.createObjectURL;
URL.createObjectURL = (content) => {
  const reader = new FileReader();
  reader.onload = () => { window.saved = reader.result.split(",")[1]; };
  reader.readAsDataURL(content);
  return made.call(URL, content);
};
"""


def saved(window: Browser, button: str) -> tuple[str, bytes]:
    """Name and content of the file that a button makes."""
    window.driver.execute_script(SAVED)
    window.driver.find_element(By.ID, button).click()
    content = base64.b64decode(window.until("return window.saved"))
    return window.driver.execute_script("return named"), content


@pytest.fixture(scope="module")
def turned(tmp_path_factory: pytest.TempPathFactory) -> tuple[pathlib.Path, Path]:
    """The page and the path of a strip in a field that is raised and then turned by 30°."""
    field = ms.UniformField((0, 0, 2e-3), history=(1, 1), rotation_axis=(0, 1, 0), rotation=(0, np.pi / 6))
    probes = {"tip": (LENGTH, 0, 0), "corner": (LENGTH, strip().shell.mesh.points[:, 1].max(), 0), "root": (0, 0, 0)}
    path = solve(replace(strip(), field=field, stages=[ms.Stage(), ms.Stage(stops=2)], probes=probes))
    return write_page(path, tmp_path_factory.mktemp("turned") / "view.html", "Turned"), path


@pytest.fixture
def strip_page(shared: Browser, turned) -> Iterator[Browser]:
    file, _ = turned
    shared.size(*SIZE)
    shared.open(file)
    yield shared
    assert shared.console() == []


def test_curves_go_over_the_angle_of_a_field_that_turns(strip_page, turned):
    _, path = turned
    options = "return [...document.querySelectorAll('#over option')].map((option) => option.text)"
    assert strip_page.driver.execute_script(options) == ["angle of the field (°)", "|B| (mT)", "load factor"]
    assert "angle of the field (°)" in strip_page.driver.find_element(By.ID, "plot").text
    x = strip_page.driver.execute_script("return curves.about.x")
    angle = [np.degrees(np.arctan2(step.flux_density[0], step.flux_density[2])) for step in path.steps[1:]]
    assert x == pytest.approx([0.0, *angle], abs=1e-9)
    choose(strip_page, "over", "2")
    strip_page.do("go(2);")
    place = strip_page.driver.execute_script("return curves.px(arguments[0])", path.steps[2].load_factor)
    assert ring(strip_page)[0] == pytest.approx(place)


def test_probes_are_marked_on_the_body_with_their_names(strip_page, turned):
    """Where their nodes are seen; no name covers a mark or another name, or leaves the picture."""
    _, path = turned
    strip_page.do("go(header.steps.length - 1);" + AFTER_DRAWING)
    script = (
        "const {axes, centre, perPixel, canvas} = camera; return header.probes.map(({name}) => {"
        "const x = arguments[0][name].map((v, k) => v - centre[k]);"
        "const middle = [canvas.clientWidth / 2, canvas.clientHeight / 2];"
        "return [middle[0] + dot(axes[0], x) / perPixel, middle[1] - dot(axes[1], x) / perPixel]})"
    )
    mesh, state = path.discretisation.mesh, path.steps[-1].state
    there = {name: (mesh.points[node] + state.u[node]).tolist() for name, node in path.model.probe_nodes.items()}
    expected = np.array(strip_page.driver.execute_script(script, there))
    circles = strip_page.driver.find_elements(By.CSS_SELECTOR, "#probes circle")
    seen = np.array([[float(circle.get_attribute(name)) for name in ("cx", "cy")] for circle in circles])
    assert np.abs(seen - expected).max() < 0.5, (seen, expected)
    names = strip_page.driver.find_elements(By.CSS_SELECTOR, "#probes text")
    assert [name.text for name in names] == list(there)
    rects = "return [...document.querySelectorAll('#probes text, #probes circle')].map((one) => {"
    rects += "const {left, top, right, bottom} = one.getBoundingClientRect(); return [left, top, right, bottom]})"
    boxes = np.array(strip_page.driver.execute_script(rects))
    a, b = boxes[:, None], boxes[None]
    crossing = ((a[..., :2] < b[..., 2:] - 1) & (a[..., 2:] > b[..., :2] + 1)).all(axis=-1)
    assert crossing.sum() == len(boxes), boxes
    strip_page.driver.find_element(By.ID, "marks").click()
    strip_page.do(AFTER_DRAWING)
    assert not strip_page.driver.find_elements(By.CSS_SELECTOR, "#probes circle")


def point_at(window: Browser, place: np.ndarray) -> str:
    """Put the pointer over a place in space; what the page says there."""
    script = (
        "const {axes, centre, perPixel, canvas} = camera; const x = arguments[0].map((v, k) => v - centre[k]);"
        "return [dot(axes[0], x) / perPixel, -dot(axes[1], x) / perPixel]"
    )
    aside = np.array(window.driver.execute_script(script, place.tolist()))
    canvas = window.driver.find_element(By.ID, "canvas")
    ActionChains(window.driver).move_to_element_with_offset(canvas, *np.round(aside).astype(int).tolist()).perform()
    window.do(AFTER_DRAWING)
    return window.driver.execute_script("return at('hint').hidden ? '' : at('hint').innerText")


def numbers(text_: str) -> list[float]:
    return [float(one.replace("−", "-")) for one in re.findall(r"[−-]?\d+\.?\d*(?:e[−-]?\d+)?", text_)]


def test_pointer_tells_value_place_element_and_node(window, path):
    """At the middle of an element, within a pixel; with another colour its unit; nothing beside the body."""
    window.do("camera.look(-90, 90); go(2);" + AFTER_DRAWING)
    mesh, state = path.discretisation.mesh, path.steps[2].state
    element = 31
    nodes = mesh.elements[element]
    shares = np.array([-0.25] * 4 + [0.5] * 4)
    X, u = shares @ mesh.points[nodes], shares @ state.u[nodes]
    pixel = window.driver.execute_script("return camera.perPixel")
    value, now, before, last = point_at(window, X + u).split("\n")
    assert value.startswith("u₃ = ")
    assert value.endswith(" mm")
    assert numbers(value) == pytest.approx([1e3 * u[2]], abs=3e3 * pixel)
    assert numbers(now) == pytest.approx(1e3 * (X + u), abs=3e3 * pixel)
    assert numbers(before) == pytest.approx(1e3 * X, abs=3e3 * pixel)
    assert numbers(last)[0] == element
    assert numbers(last)[1] in nodes
    choose(window, "colour", "energy 0")
    assert point_at(window, X + u).startswith("W = ")
    assert " µJ" in point_at(window, X + u)
    assert point_at(window, np.array([-0.02 * mesh.size, 0, 0])) == ""


def test_pointer_on_a_probe_tells_its_name_and_node(strip_page, turned):
    _, path = turned
    strip_page.do("go(header.steps.length - 1);" + AFTER_DRAWING)
    node = path.model.probe_nodes["tip"]
    u = path.steps[-1].state.u[node]
    lines = point_at(strip_page, path.discretisation.mesh.points[node] + u).split("\n")
    assert lines[0] == "tip"
    assert numbers(lines[1])[-1] == pytest.approx(1e3 * u[2], rel=1e-3)
    assert lines[-1] == f"node {node}"


def test_button_saves_the_table(strip_page, turned):
    _, path = turned
    name, content = saved(strip_page, "table")
    assert name == "Turned, history.csv"
    assert content.decode() == history_text(path)


def test_buttons_save_pictures_of_shape_and_curves(strip_page):
    """Twice as sharp as the page, with body, colours of the bar, probes and field; with the colours of the curves."""
    strip_page.do("go(header.steps.length - 1);" + AFTER_DRAWING)
    name, content = saved(strip_page, "picture")
    last = strip_page.driver.execute_script("return header.steps.at(-1).number")
    assert name == f"Turned, step {last}.png"
    picture = Image.open(io.BytesIO(content)).convert("RGB")
    stage = strip_page.driver.execute_script("return [at('stage').clientWidth, at('stage').clientHeight]")
    assert picture.size == (2 * stage[0], 2 * (stage[1] + 56))
    counted = {colour: count for count, colour in picture.getcolors(picture.size[0] * picture.size[1])}
    assert counted[255, 255, 255] > 0.4 * picture.size[0] * picture.size[1]
    assert len(counted) > 500, "shades of the body and of the bar"
    assert counted[0xC2, 0x41, 0x0C] > 100, "the field's arrow"
    assert counted[0x1D, 0x4E, 0xD8] > 50, "the mark of the first probe"
    name, content = saved(strip_page, "curves-picture")
    assert name == "Turned, displacement.png"
    picture = Image.open(io.BytesIO(content)).convert("RGB")
    counted = {colour: count for count, colour in picture.getcolors(picture.size[0] * picture.size[1])}
    assert counted[0x1D, 0x4E, 0xD8] > 500, "its curve"


def test_keys_turn_and_zoom_the_view(window):
    body_ = window.driver.find_element(By.TAG_NAME, "body")
    before = window.do("return [camera.azimuth, camera.elevation, camera.perPixel, state.step]")
    body_.send_keys(Keys.SHIFT, Keys.ARROW_LEFT, Keys.ARROW_UP, Keys.NULL)
    body_.send_keys("+")
    after = window.do("return [camera.azimuth, camera.elevation, camera.perPixel, state.step]")
    assert after[0] - before[0] == pytest.approx(-10)
    assert after[1] - before[1] == pytest.approx(10)
    assert before[2] / after[2] == pytest.approx(1.25)
    assert after[3] == before[3]


def test_page_of_many_probes_names_those_that_have_room(shared, tmp_path):
    """All marks are there; the legend says how many curves are drawn."""
    path = rolled(plate((10, 6)), 2)
    points = path.discretisation.mesh.points
    model = replace(path.model, probes={f"point-{i}": tuple(x) for i, x in enumerate(points)})
    path = replace(path, model=model, discretisation=Discretisation(model, nested_dissection))
    shared.size(*SIZE)
    shared.open(write_page(path, tmp_path / "view.html"))
    assert len(shared.driver.find_elements(By.CSS_SELECTOR, "#probes circle")) == len(points)
    assert 3 < len(shared.driver.find_elements(By.CSS_SELECTOR, "#probes text")) < len(points)
    legend = shared.driver.find_element(By.ID, "legend").text
    assert f"of {len(points)} probes are drawn; history.csv has all." in legend
    assert shared.console() == []


@pytest.mark.parametrize("thick", [False, True], ids=["surface", "faces"])
def test_probes_behind_the_body_are_pale_and_have_no_name(shared, tmp_path, thick):
    """Around a rolled plate, seen from both sides: the near half hides the far half."""
    path = rolled(plate((20, 6)), 2)
    shares = (0.1, 0.25, 0.4, 0.6, 0.75, 0.9)
    at = {f"at {share}": (share * ROLL, 0.5 * WIDTH, 0) for share in shares}
    shell = replace(path.model.shell, offset="bottom") if thick else path.model.shell
    model = replace(path.model, shell=shell, probes=at)
    path = replace(path, model=model, discretisation=Discretisation(model, nested_dissection))
    shared.size(*SIZE)
    shared.open(write_page(path, tmp_path / "view.html"))
    assert shared.driver.execute_script("return Boolean(body.thick)") == thick
    near, far = [name for name in at if float(name[3:]) < 0.5], [name for name in at if float(name[3:]) > 0.5]
    for azimuth, seen, hidden in ((0, near, far), (180, far, near)):
        shared.do(f"camera.look({azimuth}, 15);" + AFTER_DRAWING)
        marks = shared.driver.execute_script("return probes.marks.map(({name, seen}) => [name, seen])")
        assert {name for name, is_seen in marks if is_seen} == set(seen)
        circles = shared.driver.find_elements(By.CSS_SELECTOR, "#probes circle")
        assert sorted(float(one.get_attribute("opacity")) for one in circles) == [0.3] * len(hidden) + [1.0] * len(seen)
        names = [one.text for one in shared.driver.find_elements(By.CSS_SELECTOR, "#probes text")]
        assert names
        assert set(names) <= set(seen)
        shared.picture().save(tmp_path / f"{azimuth}.png")
    assert shared.console() == []


@pytest.mark.parametrize("width", [1400, 900, 390])
def test_controls_stay_within_the_window(strip_page, width):
    """Also on a telephone: nothing scrolls sideways, and no control covers another."""
    strip_page.size(width, 844)
    strip_page.do(AFTER_DRAWING)
    assert strip_page.driver.execute_script("return document.documentElement.scrollWidth") <= width
    rects = "return [...document.querySelectorAll('select, button, input')].filter((one) => one.offsetParent)"
    rects += ".map((one) => {const {left, top, right, bottom} = one.getBoundingClientRect();"
    rects += " return [left, top, right, bottom]})"
    boxes = np.array(strip_page.driver.execute_script(rects))
    assert (boxes[:, 0] >= 0).all()
    assert (boxes[:, 2] <= width).all()
    if width > 640:  # below, the footer stays on top of what scrolls
        a, b = boxes[:, None], boxes[None]
        crossing = ((a[..., :2] < b[..., 2:]) & (a[..., 2:] > b[..., :2])).all(axis=-1)
        assert crossing.sum() == len(boxes)


def test_regions_are_drawn_with_their_thickness(shared, tmp_path):
    """Faces and walls of a strip with a step, flush at the bottom: as high as it is thick, and coloured all over."""
    model = strip()
    mesh = model.shell.mesh.select_elements("outer", x1=(0.5 * LENGTH, LENGTH))
    outer = ms.Region("outer", thickness=0.4 * THICKNESS)
    shell = replace(model.shell, mesh=mesh, regions=[outer], offset="bottom")
    path = solve(replace(model, shell=shell))
    shared.size(*SIZE)
    shared.open(write_page(path, tmp_path / "view.html"))
    shared.driver.execute_script("go(0)")
    thick, heights, values = shared.driver.execute_script(
        "const z = (part) => Array.from(body.positions).filter((_, i) => i % 3 === 2 && part(body.positions[i - 2]));"
        f"const half = {0.5 * LENGTH};"
        "const span = (list) => [Math.min(...list), Math.max(...list)];"
        "return [body.thick, [span(z((x) => x < 0.9 * half)), span(z((x) => x > 1.1 * half))],"
        "Array.from(body.values).every((value) => Number.isFinite(value))]"
    )
    assert thick
    assert values
    assert heights[0] == pytest.approx([0.0, THICKNESS], abs=1e-6 * LENGTH)
    assert heights[1] == pytest.approx([0.0, 0.4 * THICKNESS], abs=1e-6 * LENGTH)
    assert shared.console() == []
