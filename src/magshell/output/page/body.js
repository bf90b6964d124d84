// Where sheets meet at a kink: puts the points (flat) of `mitres`, at nodes (flat), where the faces of the sheets cut each
// other, a sum of weight (z + phi z²) |d| along d'. `rows` has the row of each point in `nodes`, directors and phi.
function mitre(points, mitres, numbers, nodes, rows, directors, phi) {
  const length = (row) => Math.hypot(...directors.map((column) => column[row] || 0)) || 1;
  for (let i = 0; i < mitres.length; i += 3) {
    const n = rows[mitres[i]];
    for (let k = 0; k < 3; k++) points[3 * mitres[i] + k] = nodes[3 * n + k];
  }
  for (let i = 0, j = 0; i < mitres.length; i += 3, j += 2) {
    const [point, along, at] = mitres.subarray(i, i + 3);
    const [z, weight] = numbers.subarray(j, j + 2);
    const rise = (weight * z * (1 + z * (phi[at] || 0)) * length(at)) / length(along);
    for (let k = 0; k < 3; k++) points[3 * point + k] += rise * (directors[k][along] || 0);
  }
}

// The curved elements as small triangles and lines, interpolated between the nodes by the elements' own functions.

class Body {
  constructor(mesh) {
    this.reference = stored("points", Float32Array);
    this.kinds = mesh.kinds.map((kind, i) => ({
      ...kind,
      elements: stored(`elements-${i}`, Uint32Array),
      numbers: stored(`numbers-${i}`, Uint32Array),
    }));
    this.edges = stored("edges", Uint32Array);
    this.outline = stored("outline", Uint32Array);
    this.thick = mesh.thick; // both faces are drawn: nodes of their own, each at a height over one of the mesh
    this.nodes = this.thick && stored("nodes", Uint32Array);
    this.heights = this.thick && stored("heights", Float32Array);
    this.mitres = this.thick && stored("mitres", Uint32Array);
    this.mitreNumbers = this.thick && stored("mitre-numbers", Float32Array);
    this.drawnEdges = this.thick ? stored("drawn-edges", Uint32Array) : this.edges;
    this.drawnOutline = this.thick ? stored("drawn-outline", Uint32Array) : this.outline;
    this.along = mesh.along; // functions of an edge's nodes (end, end, middle) at points along it
    const size = this.kinds.reduce((sum, kind) => sum + kind.numbers.length * kind.N.length, 0);
    this.positions = new Float32Array(3 * size);
    this.normals = new Float32Array(3 * size);
    this.values = new Float32Array(size);
    this.triangles = this.joined();
  }

  joined() {
    const lists = [];
    let first = 0;
    for (const kind of this.kinds) {
      const list = new Uint32Array(3 * kind.triangles.length * kind.numbers.length);
      const pattern = kind.triangles.flat();
      for (let e = 0; e < kind.numbers.length; e++) {
        for (let i = 0; i < pattern.length; i++) list[e * pattern.length + i] = first + pattern[i];
        first += kind.N.length;
      }
      lists.push(list);
    }
    const all = new Uint32Array(lists.reduce((sum, list) => sum + list.length, 0));
    let at = 0;
    for (const list of lists) {
      all.set(list, at);
      at += list.length;
    }
    return all;
  }

  // Nodal positions (flat) at displacements, three columns.
  moved(columns) {
    const moved = new Float32Array(this.reference);
    for (let k = 0; k < 3; k++) for (let i = 0; i < columns[k].length; i++) moved[3 * i + k] += columns[k][i] || 0;
    return moved;
  }

  // Positions (flat) of the nodes that are drawn: x + z (1 + z phi) d at their heights z, or those of the mesh.
  drawn(moved, directors, phi) {
    if (!this.thick) return moved;
    const { nodes, heights } = this;
    const drawn = new Float32Array(3 * nodes.length);
    for (let i = 0; i < nodes.length; i++) {
      const n = nodes[i], z = heights[i] * (1 + heights[i] * (phi[n] || 0));
      for (let k = 0; k < 3; k++) drawn[3 * i + k] = moved[3 * n + k] + z * (directors[k][n] || 0);
    }
    mitre(drawn, this.mitres, this.mitreNumbers, moved, nodes, directors, phi);
    return drawn;
  }

  // Numbers of the drawn points that a node of the mesh has: itself, or those on the faces and walls over it.
  over(node) {
    if (!this.thick) return [node];
    if (!this.drawnOver) {
      this.meshNodes ??= stored("mesh-nodes", Uint32Array);
      this.drawnOver = new Map();
      this.nodes.forEach((row, i) => {
        const n = this.meshNodes[row];
        this.drawnOver.has(n) ? this.drawnOver.get(n).push(i) : this.drawnOver.set(n, [i]);
      });
    }
    return this.drawnOver.get(node);
  }

  // Points and unit normals of the surface through nodes at these positions.
  place(nodal) {
    const { positions, normals } = this;
    let at = 0;
    for (const { elements, numbers, N, N1, N2 } of this.kinds) {
      const nodes = N[0].length;
      const x = new Float64Array(3 * nodes);
      for (let e = 0; e < numbers.length; e++) {
        for (let n = 0; n < nodes; n++) {
          const node = 3 * elements[e * nodes + n];
          for (let k = 0; k < 3; k++) x[3 * n + k] = nodal[node + k];
        }
        for (let m = 0; m < N.length; m++, at += 3) {
          let px = 0, py = 0, pz = 0, ax = 0, ay = 0, az = 0, bx = 0, by = 0, bz = 0;
          const f = N[m], f1 = N1[m], f2 = N2[m];
          for (let n = 0, i = 0; n < nodes; n++, i += 3) {
            const u = x[i], v = x[i + 1], w = x[i + 2];
            px += f[n] * u; py += f[n] * v; pz += f[n] * w;
            ax += f1[n] * u; ay += f1[n] * v; az += f1[n] * w;
            bx += f2[n] * u; by += f2[n] * v; bz += f2[n] * w;
          }
          const nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
          const length = Math.sqrt(nx * nx + ny * ny + nz * nz) || 1;
          positions[at] = px; positions[at + 1] = py; positions[at + 2] = pz;
          normals[at] = nx / length; normals[at + 1] = ny / length; normals[at + 2] = nz / length;
        }
      }
    }
  }

  // Values of nodes or elements at the points of the surface; 3e38 where there is none.
  paint(values, where) {
    let at = 0;
    for (const { elements, numbers, N } of this.kinds) {
      const nodes = N[0].length;
      for (let e = 0; e < numbers.length; e++) {
        for (let m = 0; m < N.length; m++, at++) {
          if (where === "cell") {
            const value = values[numbers[e]];
            this.values[at] = Number.isNaN(value) ? 3e38 : value;
            continue;
          }
          let sum = 0;
          for (let n = 0; n < nodes; n++) {
            const node = elements[e * nodes + n];
            sum += N[m][n] * values[this.thick ? this.nodes[node] : node];
          }
          this.values[at] = Number.isNaN(sum) ? 3e38 : sum;
        }
      }
    }
  }

  // What is at a point between three corners of triangles: value, place, place before, element, nearest node of the mesh.
  told(corners, shares, moved) {
    const sum = (of) => shares.reduce((total, share, i) => total + share * of(corners[i]), 0);
    let kind = 0, first = 0;
    const size = ({ N, numbers }) => N.length * numbers.length;
    while (corners[0] >= first + size(this.kinds[kind])) first += size(this.kinds[kind++]);
    const { elements, numbers, N } = this.kinds[kind];
    const e = Math.floor((corners[0] - first) / N.length);
    const count = N[0].length;
    const rows = Array.from(elements.subarray(e * count, (e + 1) * count), (n) => (this.thick ? this.nodes[n] : n));
    const before = [0, 1, 2].map((k) => sum((corner) => {
      const f = N[(corner - first) % N.length];
      return rows.reduce((total, row, n) => total + f[n] * this.reference[3 * row + k], 0);
    }));
    const now = [0, 1, 2].map((k) => sum((corner) => this.positions[3 * corner + k]));
    const away = (row) => Math.hypot(...now.map((x, k) => x - moved[3 * row + k]));
    const nearest = rows.reduce((best, row) => (away(row) < away(best) ? row : best));
    this.meshNodes ??= stored("mesh-nodes", Uint32Array);
    const node = this.meshNodes[nearest];
    const known = corners.every((corner) => this.values[corner] < 1e37);
    const value = known ? sum((corner) => this.values[corner]) : NaN;
    return { value, now, before, element: numbers[e], node };
  }

  // Straight segments (start, end) along edges through nodes at these positions.
  segments(nodal, triples) {
    const pieces = this.along.length - 1;
    const result = new Float32Array((triples.length / 3) * pieces * 6);
    let at = 0;
    for (let edge = 0; edge < triples.length; edge += 3) {
      for (let piece = 0; piece < pieces; piece++) {
        for (const f of [this.along[piece], this.along[piece + 1]]) {
          for (let k = 0; k < 3; k++, at++) {
            result[at] = f[0] * nodal[3 * triples[edge] + k] + f[1] * nodal[3 * triples[edge + 1] + k]
              + f[2] * nodal[3 * triples[edge + 2] + k];
          }
        }
      }
    }
    return result;
  }

  // Arrows (middle, vector) on up to `most` elements, spread evenly; `length` is that of the longest.
  arrows(columns, most, length) {
    const longest = Math.max(...columns[0].map((_, i) => Math.hypot(...columns.map((c) => c[i] || 0)))) || 1;
    const count = this.kinds.reduce((sum, kind) => sum + kind.tops, 0);
    const every = Math.max(1, Math.ceil(count / most));
    const result = [];
    let at = 0, seen = 0;
    for (const { numbers, N, tops } of this.kinds) {
      for (let e = 0; e < numbers.length; e++, at += 3 * N.length) {
        if (e >= tops || seen++ % every) continue;
        const vector = columns.map((column) => ((column[numbers[e]] || 0) * length) / longest);
        if (Math.hypot(...vector) < 1e-6 * length) continue;
        const middle = [0, 1, 2].map((k) => {
          let sum = 0;
          for (let m = 0; m < N.length; m++) sum += this.positions[at + 3 * m + k];
          return sum / N.length;
        });
        result.push(...middle, ...vector);
      }
    }
    return new Float32Array(result);
  }
}
