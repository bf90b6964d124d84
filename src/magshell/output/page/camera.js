// The eye: parallel projection, X3 upright, turned by azimuth and elevation; the pointers and keys that move it.

// Room kept free beside and below the shape, pixels.
const BAR = 105, COMPASS = 85;

const radians = (degrees) => (degrees * Math.PI) / 180;
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

class Camera {
  // `hull`: points that stand for everything to be seen.
  constructor(canvas, hull, view, changed) {
    Object.assign(this, { canvas, hull, changed, first: view });
    this.pointers = new Map();
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const name of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(name, (event) => this.pointers.delete(event.pointerId));
    }
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    canvas.addEventListener("dblclick", () => this.look(...this.first));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    this.look(...view);
  }

  // Look from here, with everything in the picture.
  look(azimuth, elevation) {
    Object.assign(this, { azimuth, elevation, fitted: true });
    this.fit();
    this.changed();
  }

  fit() {
    const axes = this.axes;
    const seen = axes.map((axis) => this.hull.map((point) => dot(axis, point)));
    const low = seen.map((values) => Math.min(...values));
    const high = seen.map((values) => Math.max(...values));
    const middle = low.map((value, i) => (value + high[i]) / 2);
    this.centre = [0, 1, 2].map((k) => axes[0][k] * middle[0] + axes[1][k] * middle[1] + axes[2][k] * middle[2]);
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const room = [Math.max(width - 30 - BAR, width / 2), Math.max(height - 30 - COMPASS, height / 2)];
    this.perPixel = Math.max((high[0] - low[0]) / room[0], (high[1] - low[1]) / room[1]) || 1e-30;
    const aside = [(width - room[0]) / 2 - 15, 15 - (height - room[1]) / 2];
    for (let k = 0; k < 3; k++) this.centre[k] += this.perPixel * (aside[0] * axes[0][k] + aside[1] * axes[1][k]);
  }

  resized() {
    if (this.fitted) this.fit();
    this.changed();
  }

  // Rows: to the right, up, towards the eye.
  get axes() {
    const [a, e] = [radians(this.azimuth), radians(this.elevation)];
    const [ca, sa, ce, se] = [Math.cos(a), Math.sin(a), Math.cos(e), Math.sin(e)];
    return [[-sa, ca, 0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]];
  }

  // Half the width, height and depth of what is seen.
  get span() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const depth = Math.max(...this.hull.map((point) => Math.hypot(...point.map((x, k) => x - this.centre[k]))));
    return [(this.perPixel * width) / 2, (this.perPixel * height) / 2, 1.1 * depth + 1e-30];
  }

  press(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    this.panning = event.button > 0 || event.shiftKey || event.ctrlKey;
  }

  move(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY];
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    if (this.pointers.size === 2) {
      const [id] = [...this.pointers.keys()].filter((key) => key !== event.pointerId);
      const other = this.pointers.get(id);
      const distance = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]) || 1;
      this.zoom(distance(before) / distance(now), (now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
      this.pan(dx / 2, dy / 2);
    } else if (this.panning) {
      this.pan(dx, dy);
    } else {
      this.turn(-0.4 * dx, 0.4 * dy);
    }
    this.pointers.set(event.pointerId, now);
  }

  turn(azimuth, elevation) {
    this.fitted = false;
    this.azimuth = (this.azimuth + azimuth) % 360;
    this.elevation = Math.max(-90, Math.min(90, this.elevation + elevation));
    this.changed();
  }

  pan(dx, dy) {
    this.fitted = false;
    const { axes, perPixel } = this;
    for (let k = 0; k < 3; k++) this.centre[k] += perPixel * (dy * axes[1][k] - dx * axes[0][k]);
    this.changed();
  }

  wheel(event) {
    event.preventDefault();
    this.zoom(Math.exp(0.0015 * Math.max(-200, Math.min(200, event.deltaY))), event.clientX, event.clientY);
  }

  // Zoom about the middle.
  nearer(factor) {
    const box = this.canvas.getBoundingClientRect();
    this.zoom(factor, box.left + box.width / 2, box.top + box.height / 2);
  }

  // Zoom by a factor; what is under (x, y) stays there.
  zoom(factor, x, y) {
    const box = this.canvas.getBoundingClientRect();
    const [dx, dy] = [x - box.left - box.width / 2, y - box.top - box.height / 2];
    this.pan((factor - 1) * dx, (factor - 1) * dy);
    this.perPixel *= factor;
    this.changed();
  }
}
