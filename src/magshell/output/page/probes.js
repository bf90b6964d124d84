// The probes on the body: a mark at each, and its name where there is room for it; of those that are hidden a pale mark.

const GAP = 10; // pixels from the middle of a mark to its name
const AROUND = Array.from({ length: 8 }, (_, i) => [Math.cos((i * Math.PI) / 4), Math.sin((i * Math.PI) / 4)]);
const LETTERS = 13;

class Probes {
  constructor(drawing, probes) {
    this.drawing = drawing;
    const pen = document.createElement("canvas").getContext("2d");
    pen.font = `600 ${LETTERS}px ${getComputedStyle(document.body).fontFamily}`;
    this.probes = probes.map((probe) => {
      const text = probe.name.length > 32 ? `${probe.name.slice(0, 31)}…` : probe.name;
      return { ...probe, text, width: pen.measureText(text).width };
    });
    this.marks = []; // where each is seen
  }

  // `seen`: of each whether it is, or null to draw none; `kept`: boxes (left, top, right, bottom) that no name may cover.
  draw(camera, moved, seen, kept) {
    const { drawing } = this;
    const { clientWidth: width, clientHeight: height } = camera.canvas;
    drawing.replaceChildren();
    drawing.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.marks = [];
    if (!seen) return;
    const { axes, centre, perPixel } = camera;
    const marks = this.probes.map((probe, i) => {
      const x = [0, 1, 2].map((k) => moved[3 * probe.node + k] - centre[k]);
      const place = { x: width / 2 + dot(axes[0], x) / perPixel, y: height / 2 - dot(axes[1], x) / perPixel };
      return { ...probe, ...place, seen: seen[i] };
    });
    this.marks = marks.sort((one, other) => one.seen - other.seen); // those in front last
    const boxes = [...kept, ...this.marks.map(({ x, y }) => [x - 5, y - 5, x + 5, y + 5])];
    const free = (box) => {
      if (box[0] < 2 || box[1] < 2 || box[2] > width - 2 || box[3] > height - 2) return false;
      return boxes.every((b) => box[2] < b[0] || box[0] > b[2] || box[3] < b[1] || box[1] > b[3]);
    };
    for (const { text, width: wide, x, y, colour, seen } of this.marks) {
      const style = `color:${colour ?? "var(--ink)"}`;
      svg(drawing, "circle", { cx: x, cy: y, r: 4.5, class: "probe line", style, opacity: seen ? 1 : 0.3 });
      if (!seen) continue;
      const box = ([u, v]) => {
        const [mx, my] = [x + u * (GAP + wide / 2), y + v * (GAP + LETTERS / 2)];
        return [mx - wide / 2 - 1, my - LETTERS / 2 - 1, mx + wide / 2 + 1, my + LETTERS / 2 + 1];
      };
      const place = AROUND.map(box).find(free);
      if (!place) continue;
      boxes.push(place);
      const [left, top, right, bottom] = place;
      svg(drawing, "text", { x: (left + right) / 2, y: (top + bottom) / 2 + 0.35 * LETTERS, class: "name" }, text);
    }
  }
}
