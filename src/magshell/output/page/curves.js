// The curves of the probes or of another series as SVG through all steps: a mark at every step of the page, hollow where unstable, a ring at
// the present one.

const SVG = "http://www.w3.org/2000/svg";

function svg(parent, name, attributes, text) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  parent.append(element);
  return element;
}

const MARKS = {
  o: "M-3.2,0a3.2,3.2 0 1,0 6.4,0a3.2,3.2 0 1,0 -6.4,0Z",
  s: "M-2.9,-2.9h5.8v5.8h-5.8Z",
  "^": "M-3.4,2.7h6.8l-3.4,-6.1Z",
  D: "M0,-6l5,6l-5,6l-5,-6Z",
};
const DASHES = { "-": "none", "--": "7 4", ":": "2 3" };

class Curves {
  // `steps` are those of the page; their numbers are their places in `x` of what curves are drawn over and in `y` of
  // each line. The first group of curves over the first of `over` is shown at first.
  constructor(plot, legend, groups, over, steps, chosen) {
    Object.assign(this, { plot, legend, groups, over, steps });
    plot.addEventListener("click", (event) => {
      const step = this.nearest(event);
      if (step !== null) chosen(step);
    });
    this.show(0, 0);
    new ResizeObserver(() => this.draw()).observe(plot);
  }

  // Show this group over that.
  show(group, over) {
    const { legend, groups, steps } = this;
    const { name, x, label, above, critical } = this.over[over];
    const rounds = name.endsWith(".angle") ? DEGREES : ROUND;
    const points = groups[group].critical.map((point, i) => ({ ...point, x: critical[i] }));
    const about = this.about = { ...groups[group], x, xlabel: label, rounds, above, critical: points };
    legend.replaceChildren();
    for (const line of about.lines) this.explain(legend, line);
    if (steps.some((step) => step.unstable)) this.remark(legend, MARKS.o, "hollow", "unstable");
    if (about.critical.length) this.remark(legend, MARKS.D, "critical", "critical point");
    if (about.note) legend.append(Object.assign(document.createElement("li"), { textContent: about.note }));
    this.draw();
  }

  explain(legend, { label, component, colour, dash, marker }) {
    const item = document.createElement("li");
    const sample = svg(item, "svg", { width: 34, height: 14, class: "line", style: `color:${colour}` });
    svg(sample, "path", { d: "M1,7H33", "stroke-dasharray": DASHES[dash], class: "stroke" });
    svg(sample, "path", { d: MARKS[marker], transform: "translate(17 7)", class: "mark" });
    const name = document.createElement("span");
    name.textContent = `${label} ${component}`.trim();
    item.append(name);
    legend.append(item);
  }

  remark(legend, d, kind, text) {
    const item = document.createElement("li");
    const sample = svg(item, "svg", { width: 20, height: 14, class: "remark" });
    svg(sample, "path", { d, transform: "translate(10 7)", class: kind });
    item.append(text);
    legend.append(item);
  }

  get all() {
    return this.about.lines.flatMap((line) => line.y);
  }

  draw() {
    const { plot, about } = this;
    const { clientWidth: width, clientHeight: height } = plot;
    if (width < 80 || height < 80) return;
    plot.replaceChildren();
    plot.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const box = { left: 62, right: width - 16, top: about.above ? 50 : 16, bottom: height - 46 };
    const span = (values, margin) => {
      const [low, high] = [Math.min(...values), Math.max(...values)];
      const room = margin * (high - low || Math.abs(high) || 1);
      return [low - room, high + room];
    };
    const [left, right] = span(about.x, 0.03);
    const [below, above] = span([0, ...this.all], 0.05);
    this.px = (x) => box.left + ((x - left) / (right - left)) * (box.right - box.left);
    this.py = (y) => box.bottom - ((y - below) / (above - below)) * (box.bottom - box.top);
    const middle = (box.left + box.right) / 2;
    for (const [x, text] of ticks(left, right, Math.max(2, Math.min(7, width / 90)), about.rounds)) {
      svg(plot, "path", { d: `M${this.px(x)},${box.top}V${box.bottom}`, class: "grid" });
      svg(plot, "text", { x: this.px(x), y: box.bottom + 18, "text-anchor": "middle" }, text);
    }
    for (const [y, text] of ticks(below, above, Math.max(2, Math.min(8, height / 60)))) {
      svg(plot, "path", { d: `M${box.left},${this.py(y)}H${box.right}`, class: Math.abs(y) < 1e-12 ? "axis" : "grid" });
      svg(plot, "text", { x: box.left - 8, y: this.py(y) + 4, "text-anchor": "end" }, text);
    }
    svg(plot, "path", { d: `M${box.left},${box.top}V${box.bottom}H${box.right}`, class: "axis" });
    svg(plot, "text", { x: middle, y: height - 8, "text-anchor": "middle", class: "title" }, about.xlabel);
    const turned = `translate(15 ${(box.top + box.bottom) / 2}) rotate(-90)`;
    svg(plot, "text", { transform: turned, "text-anchor": "middle", class: "title" }, about.ylabel);
    if (about.above) this.second(box, left, right, middle);
    this.now = svg(plot, "path", { class: "now" });
    about.lines.forEach((line) => this.line(line));
    this.marks = svg(plot, "g", {});
    for (const point of about.critical) {
      for (const y of point.y) {
        const place = `translate(${this.px(point.x)} ${this.py(y)})`;
        svg(svg(plot, "path", { d: MARKS.D, transform: place, class: "critical" }), "title", {}, point.label);
      }
    }
    this.box = box;
    this.mark(this.step ?? 0);
  }

  second(box, left, right, middle) {
    const { factor, label } = this.about.above;
    svg(this.plot, "path", { d: `M${box.left},${box.top}H${box.right}`, class: "axis" });
    for (const [x, text] of ticks(factor * left, factor * right, Math.max(2, (box.right - box.left) / 100))) {
      const place = this.px(x / factor);
      svg(this.plot, "path", { d: `M${place},${box.top}v-5`, class: "axis" });
      svg(this.plot, "text", { x: place, y: box.top - 10, "text-anchor": "middle" }, text);
    }
    svg(this.plot, "text", { x: middle, y: 14, "text-anchor": "middle", class: "title" }, label);
  }

  line({ y, colour, dash, marker }) {
    const group = svg(this.plot, "g", { class: "line", style: `color:${colour}` });
    const points = y.map((value, i) => `${this.px(this.about.x[i])},${this.py(value)}`);
    svg(group, "polyline", { points: points.join(" "), "stroke-dasharray": DASHES[dash], class: "stroke" });
    for (const { number, unstable } of this.steps) {
      const place = `translate(${this.px(this.about.x[number])} ${this.py(y[number])})`;
      svg(group, "path", { d: MARKS[marker], transform: place, class: unstable ? "hollow" : "mark" });
    }
  }

  // Show which step is the present one.
  mark(step) {
    this.step = step;
    if (!this.marks) return;
    const { x, lines } = this.about;
    const { number } = this.steps[step];
    this.now.setAttribute("d", `M${this.px(x[number])},${this.box.top}V${this.box.bottom}`);
    this.marks.replaceChildren();
    for (const { y, colour } of lines) {
      const ring = { cx: this.px(x[number]), cy: this.py(y[number]), r: 7, class: "ring line", style: `color:${colour}` };
      svg(this.marks, "circle", ring);
    }
  }

  // The step whose mark is next to a click, if it was on the plot.
  nearest(event) {
    const place = this.plot.getBoundingClientRect();
    const [x, y] = [event.clientX - place.left, event.clientY - place.top];
    let best = null, least = Infinity;
    for (const line of this.about.lines) {
      this.steps.forEach(({ number }, i) => {
        const distance = Math.hypot(this.px(this.about.x[number]) - x, this.py(line.y[number]) - y);
        if (distance < least) [best, least] = [i, distance];
      });
    }
    return best;
  }
}
