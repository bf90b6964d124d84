// What is under the pointer: the value of the colours there, the place, the element and its nearest node; or a probe.

const NEAR = 9; // pixels from the middle of a probe's mark

// The triangle in front at a place of the picture: its number, the shares of its corners there, and how near it is.
function inFront(triangles, corner, [x, y]) {
  let best = null;
  for (let t = 0; t < triangles; t++) {
    const [ax, ay, az] = corner(t, 0), [bx, by, bz] = corner(t, 1), [cx, cy, cz] = corner(t, 2);
    const area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    if (area === 0) continue;
    const b = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / area;
    const c = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / area;
    const a = 1 - b - c;
    if (a < 0 || b < 0 || c < 0) continue;
    const near = a * az + b * bz + c * cz;
    if (!best || near > best.near) best = { triangle: t, shares: [a, b, c], near };
  }
  return best;
}

class Pointer {
  constructor(canvas, hint) {
    Object.assign(this, { canvas, hint, place: null });
    const place = (event) => {
      const box = canvas.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    const pointed = (event) => {
      this.place = place(event);
      this.show();
    };
    canvas.addEventListener("pointermove", (event) => (event.buttons ? this.leave() : pointed(event)));
    canvas.addEventListener("pointerdown", (event) => (this.pressed = place(event)));
    canvas.addEventListener("pointerup", (event) => {
      const [x, y] = place(event);
      if (this.pressed && Math.hypot(x - this.pressed[0], y - this.pressed[1]) < 4) pointed(event);
    });
    canvas.addEventListener("pointerleave", (event) => event.pointerType === "mouse" && this.leave());
  }

  leave() {
    this.place = null;
    this.show();
  }

  // The surface at a place of the canvas, or null: nothing, or a magnet or coil, is there.
  surface(place) {
    const { triangles, positions } = body;
    const { axes, centre } = camera;
    const seen = new Float32Array(positions.length);
    for (let i = 0; i < positions.length; i += 3) {
      const [x, y, z] = [positions[i] - centre[0], positions[i + 1] - centre[1], positions[i + 2] - centre[2]];
      for (let k = 0; k < 3; k++) seen[i + k] = axes[k][0] * x + axes[k][1] * y + axes[k][2] * z;
    }
    const spot = [
      (place[0] - this.canvas.clientWidth / 2) * camera.perPixel,
      (this.canvas.clientHeight / 2 - place[1]) * camera.perPixel,
    ];
    const corner = (t, k) => seen.subarray(3 * triangles[3 * t + k], 3 * triangles[3 * t + k] + 3);
    const found = inFront(triangles.length / 3, corner, spot);
    if (!found) return null;
    for (const solid of scene.solids) {
      const { turn, shift } = solid.pose();
      const corner = (t, k) => {
        const p = solid.corners.subarray(9 * t + 3 * k, 9 * t + 3 * k + 3);
        const x = [0, 1, 2].map((i) => dot([turn[3 * i], turn[3 * i + 1], turn[3 * i + 2]], p) + shift[i] - centre[i]);
        return axes.map((axis) => dot(axis, x));
      };
      const before = inFront(solid.count / 3, corner, spot);
      if (before && before.near > found.near) return null;
    }
    const corners = [0, 1, 2].map((k) => triangles[3 * found.triangle + k]);
    return body.told(corners, found.shares, scene.moved);
  }

  // The probe whose mark is at a place, or null; rather one that is seen.
  probe(place) {
    const near = probes.marks.filter(({ x, y }) => Math.hypot(x - place[0], y - place[1]) < NEAR);
    const distance = ({ x, y }) => Math.hypot(x - place[0], y - place[1]);
    return near.sort((one, other) => other.seen - one.seen || distance(one) - distance(other))[0] ?? null;
  }

  show() {
    const { hint, place } = this;
    const lines = place && scene ? this.lines(place) : [];
    hint.hidden = !lines.length;
    this.canvas.classList.toggle("over", Boolean(lines.length));
    if (hint.hidden) return;
    hint.replaceChildren(...lines.map((text, i) => {
      return Object.assign(document.createElement(i ? "div" : "strong"), { textContent: text });
    }));
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const [wide, high] = [hint.offsetWidth, hint.offsetHeight];
    const left = place[0] + 14 + wide > width ? place[0] - 14 - wide : place[0] + 14;
    const top = place[1] + 14 + high > height ? place[1] - 14 - high : place[1] + 14;
    hint.style.left = `${Math.max(4, Math.min(width - wide - 4, left))}px`;
    hint.style.top = `${Math.max(4, Math.min(height - high - 4, top))}px`;
  }

  lines(place) {
    const { quantity, component } = state;
    const letter = quantity.letter(component);
    const said = (value) => {
      if (!(Math.abs(value) < 1e37)) return `${letter}: no value here`;
      return `${letter} = ${figures(value * quantity.factor)} ${quantity.unit}`.trim();
    };
    const mm = (point) => `(${point.map((x) => figures(+(1e3 * x).toPrecision(4))).join(", ")}) mm`;
    const where = (now, before) => [`at ${mm(now)}`, `undeformed ${mm(before)}`];
    const probe = this.probe(place);
    if (probe) {
      const now = [0, 1, 2].map((k) => scene.moved[3 * probe.node + k]);
      const before = [0, 1, 2].map((k) => body.reference[3 * probe.node + k]);
      const values = quantity.where === "point" ? [said(quantity.shown(state.step, component)[probe.node])] : [];
      return [probe.name, ...values, ...where(now, before), `node ${probe.node}`];
    }
    const found = this.surface(place);
    if (!found) return [];
    const lines = [said(found.value), ...where(found.now, found.before)];
    return [...lines, `element ${found.element}, nearest node ${found.node}`];
  }
}
