// What the page holds: a header in JSON, and arrays as base64 text of little-endian numbers, decoded when first needed.

const header = JSON.parse(document.getElementById("header").textContent);

function stored(name, Kind) {
  const text = document.getElementById(`array-${name}`).textContent;
  if (Uint8Array.fromBase64) return new Kind(Uint8Array.fromBase64(text).buffer);
  const decoded = atob(text);
  const bytes = new Uint8Array(decoded.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = decoded.charCodeAt(i);
  return new Kind(bytes.buffer);
}

// An output of every step. A number is stored in 16 bits between the least and the largest of its step and component.
const MISSING = 65535;

class Quantity {
  constructor(about) {
    Object.assign(this, about);
  }

  // Column `component` (from 0) of a step, SI; NaN where there is no value.
  column(step, component) {
    this.codes ??= stored(this.name, Uint16Array);
    const shown = Math.min(step, this.steps - 1);
    const [low, high] = this.ranges[component][shown];
    const scale = (high - low) / (MISSING - 1);
    const first = (shown * this.components + component) * this.rows;
    const values = new Float32Array(this.rows);
    for (let i = 0; i < this.rows; i++) {
      const code = this.codes[first + i];
      values[i] = code === MISSING ? NaN : low + scale * code;
    }
    return values;
  }

  columns(step) {
    return Array.from({ length: this.components }, (_, i) => this.column(step, i));
  }

  // What colours the shape: a component, or the length of a vector.
  shown(step, component) {
    if (component < this.components) return this.column(step, component);
    const columns = this.columns(step);
    return columns[0].map((_, row) => Math.hypot(...columns.map((column) => column[row])));
  }

  // Least and largest value of one step, or of all.
  range(component, step) {
    const ranges = this.ranges[component];
    if (step !== null) return ranges[Math.min(step, this.steps - 1)];
    return [Math.min(...ranges.map((r) => r[0])), Math.max(...ranges.map((r) => r[1]))];
  }

  // Symbol of a component or of the whole.
  letter(component) {
    return this.letters[component];
  }
}

const quantities = new Map(header.outputs.map((about) => [about.name, new Quantity(about)]));

// Numbers for people: about `count` round values from low to high, and texts of them with equal decimals.
const ROUND = [1, 2, 2.5, 5, 10], DEGREES = [1, 1.5, 3, 4.5, 9, 10];

function ticks(low, high, count, steps = ROUND) {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * steps.find((factor) => factor * power >= 0.999 * rough);
  const values = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) values.push(i * step);
  const largest = Math.max(Math.abs(low), Math.abs(high));
  if (largest >= 1e5 || largest < 1e-3) {
    return values.map((value) => [value, value ? value.toExponential(1).replaceAll("-", "−") : "0"]);
  }
  const exact = [0, 1, 2, 3, 4, 5, 6].find((places) => Math.abs(step * 10 ** places % 1) < 1e-6) ?? 6;
  return values.map((value) => [value, value.toFixed(exact).replace("-", "−")]);
}

function figures(value) {
  const size = Math.abs(value);
  const text = size && (size < 1e-3 || size >= 1e5) ? value.toExponential(3) : String(+value.toPrecision(4));
  return text.replace("-", "−");
}
