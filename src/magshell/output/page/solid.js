// The body of a step with its true thickness, as the bytes of a closed binary STL file, in mm.

// Points (flat, mm): each lies on the lower or upper face of an element, between levels x + t d of its nodes.
function solidPoints(step) {
  const { heights, kinds } = header.solid;
  const [u, d] = ["displacement", "director"].map((name) => quantities.get(name).columns(step));
  const t = new Quantity(heights).column(step, 0);
  const phi = quantities.get("phi").column(step, 0);
  const moved = Float64Array.from(stored("points", Float32Array));
  for (let i = 0; i < moved.length; i++) moved[i] += u[i % 3][Math.floor(i / 3)];
  const nodes = stored("solid-nodes", Uint32Array);
  const level = new Float64Array(3 * nodes.length);
  nodes.forEach((node, i) => {
    for (let c = 0; c < 3; c++) level[3 * i + c] = moved[3 * node + c] + t[i] * d[c][node];
  });
  const [mitres, numbers] = [stored("solid-mitres", Uint32Array), stored("solid-mitre-numbers", Float32Array)];
  mitre(level, mitres, numbers, moved, nodes, d, phi);
  const parts = kinds.map(({ N }, i) => {
    const levels = stored(`solid-levels-${i}`, Uint32Array);
    return { N, levels, size: (levels.length / N[0].length) * N.length };
  });
  const places = stored("solid-places", Uint32Array);
  const points = new Float32Array(3 * places.length);
  places.forEach((place, i) => {
    let k = 0;
    while (place >= parts[k].size) place -= parts[k++].size;
    const { N, levels } = parts[k];
    const [face, f] = [Math.floor(place / N.length), N[place % N.length]];
    const sum = [0, 0, 0];
    for (let n = 0; n < f.length; n++) {
      for (let c = 0; c < 3; c++) sum[c] += f[n] * level[3 * levels[face * f.length + n] + c];
    }
    points.set(sum.map((x) => 1e3 * x), 3 * i);
  });
  return points;
}

// Triangles whose corners are not one point: where neighbours are as thick as each other at this step only.
function solidTriangles(points) {
  const all = stored("solid-triangles", Uint32Array);
  const same = (i, j) => [0, 1, 2].every((c) => points[3 * i + c] === points[3 * j + c]);
  const kept = [];
  for (let t = 0; t < all.length; t += 3) {
    const [a, b, c] = all.subarray(t, t + 3);
    if (!same(a, b) && !same(b, c) && !same(c, a)) kept.push(a, b, c);
  }
  return kept;
}

function solidFile(step) {
  const points = solidPoints(step);
  const triangles = solidTriangles(points);
  const file = new DataView(new ArrayBuffer(84 + (50 * triangles.length) / 3));
  [..."magshell: deformed body, lengths in mm"].forEach((letter, i) => file.setUint8(i, letter.charCodeAt(0)));
  file.setUint32(80, triangles.length / 3, true);
  for (let t = 0, at = 84; t < triangles.length; t += 3, at += 50) {
    const [a, b, c] = [0, 1, 2].map((i) => points.subarray(3 * triangles[t + i], 3 * triangles[t + i] + 3));
    const [p, q] = [b, c].map((end) => [0, 1, 2].map((k) => end[k] - a[k]));
    const normal = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
    const length = Math.hypot(...normal) || 1;
    [...normal.map((x) => x / length), ...a, ...b, ...c].forEach((x, i) => file.setFloat32(at + 4 * i, x, true));
  }
  return file.buffer;
}

function saveSolid(step) {
  save(solidFile(step), "model/stl", `${document.title}, step ${header.steps[step].number}.stl`);
}
