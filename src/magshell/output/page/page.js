// The page: one state (step, colour, range, what is drawn), controls that change it, and everything that shows it.

const at = (id) => document.getElementById(id);
const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const channels = (name, opacity) => {
  const number = parseInt(ink(name).slice(1), 16);
  return [(number >> 16) / 255, ((number >> 8) & 255) / 255, (number & 255) / 255, opacity];
};

const state = { step: header.steps.length - 1, quantity: null, component: 0 };
let scene = null, body = null, camera = null, curves = null, probes = null, sight = null, pointer = null, playing = null, due = false;

// ---- the shape

function startShape() {
  const canvas = at("canvas");
  scene = new Scene(canvas);
  body = new Body(header.mesh);
  scene.setTriangles(body.triangles);
  const edges = () => at("edges").checked;
  const rest = () => at("undeformed").checked;
  const behind = { nearer: 0, behind: true };
  const pale = (opacity) => channels("--pale", opacity);
  scene.faint = scene.addLines(() => ({ ...behind, width: 0.8, ink: pale(0.4), shown: rest() && edges() }));
  scene.rest = scene.addLines(() => ({ ...behind, width: 1.5, ink: pale(1), shown: rest() }));
  scene.grid = scene.addLines(() => ({ width: 0.8, ink: channels("--line", 0.3), nearer: 2e-3, shown: edges() }));
  scene.rim = scene.addLines(() => ({ width: 1.5, ink: channels("--line", 1), nearer: 3e-3, shown: true }));
  scene.setInstances(scene.faint, "start", body.segments(body.reference, body.edges));
  scene.setInstances(scene.rest, "start", body.segments(body.reference, body.outline));
  for (const { array, colour, turns, shifts } of header.sources) {
    const rgb = [1, 3, 5].map((place) => parseInt(colour.slice(place, place + 2), 16) / 255);
    const pose = () => ({ turn: turns[state.step], shift: shifts[state.step], ink: [...rgb, 1] });
    scene.addSolid(stored(array, Float32Array), pose);
  }
  camera = new Camera(canvas, header.hull, header.view, redraw);
  probes = new Probes(at("probes"), header.probes);
  sight = new Sight(scene);
  pointer = new Pointer(canvas, at("hint"));
  new ResizeObserver(() => {
    canvas.width = Math.round(canvas.clientWidth * devicePixelRatio);
    canvas.height = Math.round(canvas.clientHeight * devicePixelRatio);
    camera.resized();
  }).observe(canvas);
}

function showShape() {
  if (!scene) return;
  const moved = scene.moved = body.moved(quantities.get("displacement").columns(state.step));
  const nodal = body.thick
    ? body.drawn(moved, quantities.get("director").columns(state.step), quantities.get("phi").column(state.step, 0))
    : moved;
  scene.drawn = nodal;
  body.place(nodal);
  scene.fill(scene.surface, "position", body.positions);
  scene.fill(scene.surface, "normal", body.normals);
  scene.setInstances(scene.rim, "start", body.segments(nodal, body.drawnOutline));
  if (at("edges").checked) scene.setInstances(scene.grid, "start", body.segments(nodal, body.drawnEdges));
  if (at("arrows").checked) {
    const { output, most, length } = header.arrows;
    const vectors = quantities.get(output).columns(state.step);
    scene.setInstances(scene.arrow, "middle", body.arrows(vectors, most, length));
  }
  redraw();
}

function showColours() {
  const { quantity, component, step } = state;
  const [low, high] = quantity.range(component, at("range").value === "step" ? step : null);
  const largest = Math.max(Math.abs(low), Math.abs(high));
  const flat = high - low <= 1e-9 * largest;
  const both = !flat && Math.min(-low, high) > 0.1 * largest;
  const half = 0.5 * (largest || 1 / quantity.factor);
  state.range = flat ? [low - half, high + half] : both ? [-largest, largest] : [low, high];
  const map = stored(both ? "diverging" : "sequential", Uint8Array);
  if (scene) {
    scene.setColours(map);
    body.paint(quantity.shown(step, component), quantity.where);
    scene.fill(scene.surface, "value", body.values);
  }
  showBar(map);
  redraw();
}

function showBar(map) {
  const { quantity, component, range } = state;
  const unit = quantity.unit ? ` (${quantity.unit})` : "";
  at("quantity").textContent = quantity.letter(component) + unit;
  at("meaning").textContent = quantity.sentence;
  at("colour").title = quantity.sentence;
  const stops = Array.from({ length: 17 }, (_, i) => {
    const first = 3 * Math.round((i / 16) * (map.length / 3 - 1));
    return `rgb(${map[first]} ${map[first + 1]} ${map[first + 2]})`;
  });
  state.stops = stops;
  at("scale").style.background = `linear-gradient(to top, ${stops})`;
  const [low, high] = range.map((value) => value * quantity.factor);
  at("ticks").replaceChildren(...ticks(low, high, 6).map(([value, text]) => {
    const tick = document.createElement("li");
    tick.style.bottom = `${(100 * (value - low)) / (high - low)}%`;
    tick.textContent = text;
    return tick;
  }));
}

function drawScene() {
  scene.draw(camera, state.range, at("arrows").checked && channels("--magnet", 1));
}

// Boxes of what lies over the canvas, which names of probes keep clear of.
function covered() {
  const stage = at("stage").getBoundingClientRect();
  return ["bar", "ticks", "quantity", "compass", "views"].map((id) => {
    const { left, top, right, bottom } = at(id).getBoundingClientRect();
    return [left - stage.left, top - stage.top, right - stage.left, bottom - stage.top];
  });
}

// Of each probe, whether it is seen: on one of the faces where these are drawn.
function seenProbes() {
  const over = header.probes.map(({ node }) => body.over(node));
  const points = over.flat().flatMap((i) => [...scene.drawn.subarray(3 * i, 3 * i + 3)]);
  const seen = points.length ? sight.of(new Float32Array(points), camera) : [];
  let at = 0;
  return over.map((own) => seen.slice(at, (at += own.length)).some(Boolean));
}

function redraw() {
  if (due || !scene) return;
  due = true;
  requestAnimationFrame(() => {
    due = false;
    const { canvas } = scene.gl;
    if (!state.range || !canvas.width || !canvas.height) return;
    drawScene();
    showCompass();
    probes.draw(camera, scene.moved, at("marks").checked ? seenProbes() : null, covered());
    pointer.show();
    if (!performance.getEntriesByName("drawn").length) requestAnimationFrame(() => performance.mark("drawn"));
  });
}

// The directions of space and of the field, turned with the shape; the field's arrow is as long as the field is strong.
function showCompass() {
  const compass = at("compass");
  compass.replaceChildren();
  const { axes } = camera;
  const arrow = (vector, length, kind, text, from = 0) => {
    const tip = [length * dot(axes[0], vector), -length * dot(axes[1], vector)];
    const size = Math.hypot(...tip);
    const group = svg(compass, "g", { class: kind, transform: `translate(${from} 0)` });
    svg(group, "path", { d: `M0,0L${tip[0]},${tip[1]}` });
    if (size > 4) {
      const turn = (Math.atan2(tip[1], tip[0]) * 180) / Math.PI;
      svg(group, "path", { d: "M1,0L-7,3.4V-3.4Z", transform: `translate(${tip}) rotate(${turn})`, class: "head" });
    }
    const beyond = size > 4 ? 1 + 11 / size : 1;
    const place = { x: tip[0] * beyond + (size > 4 ? 0 : 9), y: tip[1] * beyond + 4 };
    svg(group, "text", { ...place, "text-anchor": "middle" }, text);
  };
  const order = [0, 1, 2].sort((i, j) => axes[2][i] - axes[2][j]);
  for (const i of order) arrow([0, 1, 2].map((k) => +(k === i)), 34, "direction", "X" + "₁₂₃"[i]);
  const { field, magnitude } = header.steps[state.step];
  if (magnitude > 0) arrow(field.map((b) => b / magnitude), 12 + (40 * magnitude) / header.strongest, "field", "B", 92);
}

// ---- step, and what is said of it

function go(step) {
  state.step = Math.max(0, Math.min(header.steps.length - 1, step));
  const about = header.steps[state.step];
  at("slider").value = state.step;
  at("step").textContent = `step ${about.number} of ${header.steps.at(-1).number}`;
  const known = `|B| = ${figures(about.magnitude * 1e3)} mT${header.where}`;
  at("field").textContent =
    about.magnitude === null ? "field not known at the centre" : header.strongest > 0 ? known : "no field";
  const stage = header.stages > 1 ? `stage ${about.stage}, ` : "";
  const turned = header.over.find(({ name }) => name.endsWith(".angle"));
  const angle = turned ? `, ${turned.label.replace(" (°)", "")} ${figures(turned.x[about.number])}°` : "";
  at("load").textContent = `${stage}load factor ${figures(about.load_factor)}${angle}`;
  at("unstable").hidden = !about.unstable;
  curves?.mark(state.step);
  showShape();
  showColours();
}

function play(on) {
  clearInterval(playing);
  playing = null;
  at("play").textContent = on ? "❚❚" : "▶";
  at("play").setAttribute("aria-label", on ? "pause" : "play");
  if (!on) return;
  if (state.step === header.steps.length - 1) go(0);
  const pause = Math.max(60, Math.min(400, 4000 / header.steps.length));
  playing = setInterval(() => {
    go(state.step + 1);
    if (state.step === header.steps.length - 1) play(false);
  }, pause);
}

function fillMenu() {
  const menu = at("colour");
  for (const quantity of quantities.values()) {
    const group = document.createElement("optgroup");
    group.label = quantity.name.replaceAll("_", " ") + (quantity.unit ? ` (${quantity.unit})` : "");
    const columns = quantity.letters.keys();
    for (const component of columns) {
      const option = new Option(quantity.letter(component), `${quantity.name} ${component}`);
      option.title = quantity.sentence;
      group.append(option);
    }
    menu.append(group);
  }
  menu.value = header.colour;
}

function fillCurves() {
  header.curves.forEach(({ name }, i) => at("curve").append(new Option(name, i)));
  header.over.forEach(({ label }, i) => at("over").append(new Option(label, i)));
}

function choose() {
  const [name, component] = at("colour").value.split(" ");
  state.quantity = quantities.get(name);
  state.component = Number(component);
}

function listen() {
  at("colour").addEventListener("change", () => { choose(); showColours(); });
  at("range").addEventListener("change", showColours);
  at("stl").addEventListener("click", () => saveSolid(state.step));
  at("picture").addEventListener("click", savePicture);
  at("curves-picture").addEventListener("click", saveCurves);
  at("table").addEventListener("click", saveTable);
  for (const id of ["curve", "over"]) {
    at(id).addEventListener("change", () => curves.show(Number(at("curve").value), Number(at("over").value)));
  }
  at("marks").addEventListener("change", redraw);
  for (const id of ["edges", "arrows", "undeformed"]) at(id).addEventListener("change", showShape);
  at("slider").addEventListener("input", () => { play(false); go(Number(at("slider").value)); });
  at("play").addEventListener("click", () => play(!playing));
  for (const button of document.querySelectorAll("#views button")) {
    const view = button.dataset.view ? button.dataset.view.split(" ").map(Number) : header.view;
    button.addEventListener("click", () => camera?.look(...view));
  }
  const last = header.steps.length - 1;
  const keys = {
    ArrowRight: () => go(state.step + 1), ArrowLeft: () => go(state.step - 1), Home: () => go(0), End: () => go(last),
    " ": () => play(!playing), r: () => camera?.look(...header.view),
    "+": () => camera?.nearer(1 / 1.25), "-": () => camera?.nearer(1.25),
  };
  const turns = { ArrowRight: [10, 0], ArrowLeft: [-10, 0], ArrowUp: [0, 10], ArrowDown: [0, -10] };
  document.addEventListener("keydown", (event) => {
    if (event.shiftKey && turns[event.key] && !event.ctrlKey && !event.altKey && !event.metaKey) {
      event.preventDefault();
      camera?.turn(...turns[event.key]);
      return;
    }
    if (!keys[event.key] || event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.target.closest("select") || (event.key === " " && event.target.closest("button, input"))) return;
    event.preventDefault();
    if (event.key.startsWith("Arrow") || event.key === "Home" || event.key === "End") play(false);
    keys[event.key]();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
}

at("slider").max = header.steps.length - 1;
at("edges").checked = header.edges;
at("marks").parentElement.hidden = !header.probes.length;
fillMenu();
fillCurves();
choose();
try {
  startShape();
} catch (error) {
  scene = null;
  at("message").textContent = `This browser cannot draw the shape: ${error.message}.`;
}
curves = new Curves(at("plot"), at("legend"), header.curves, header.over, header.steps, (step) => { play(false); go(step); });
listen();
go(state.step);
