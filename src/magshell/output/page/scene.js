// Drawing with WebGL 2: a parallel projection, the lit surface in the colours of its values, lines with width, arrows.

const PROJECTION = `#version 300 es
  precision highp float;
  uniform mat3 axes; uniform vec3 centre, span; uniform vec2 pixels; uniform float nearer;
  vec4 projected(vec3 point) {
    vec3 seen = axes * (point - centre);
    return vec4(seen.xy / span.xy, -seen.z / span.z - nearer, 1.0);
  }`;

const SURFACE = [`${PROJECTION}
  in vec3 position, normal; in float value; uniform vec2 range;
  out vec3 towards; out float share;
  void main() {
    towards = axes * normal;
    share = value > 1e37 ? -9.0 : (value - range.x) / (range.y - range.x);
    gl_Position = projected(position);
  }`, `#version 300 es
  precision highp float;
  in vec3 towards; in float share; uniform sampler2D colours; out vec4 colour;
  void main() {
    vec3 n = normalize(towards);
    n = n.z < 0.0 ? -n : n;
    float light = 0.56 + 0.46 * max(dot(n, normalize(vec3(-0.35, 0.55, 0.76))), 0.0);
    float gloss = 0.10 * pow(max(dot(n, normalize(vec3(-0.19, 0.29, 0.94))), 0.0), 24.0);
    vec3 base = share < -5.0 ? vec3(0.6) : texture(colours, vec2(clamp(share, 0.002, 0.998), 0.5)).rgb;
    colour = vec4(base * light + gloss, 1.0);
  }`];

const LINES = [`${PROJECTION}
  in vec3 start, end; uniform float width;
  void main() {
    vec4 a = projected(start), b = projected(end);
    vec2 along = (b.xy - a.xy) * pixels;
    vec2 unit = length(along) > 1e-6 ? normalize(along) : vec2(1.0, 0.0);
    float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
    float beyond = gl_VertexID < 2 ? -1.0 : 1.0;
    vec2 offset = (side * vec2(-unit.y, unit.x) + 0.5 * beyond * unit) * width / pixels;
    vec4 place = gl_VertexID < 2 ? a : b;
    gl_Position = vec4(place.xy + offset, place.zw);
  }`, `#version 300 es
  precision highp float;
  uniform vec4 ink; out vec4 colour;
  void main() { colour = vec4(ink.rgb * ink.a, ink.a); }`];

const ARROWS = [`${PROJECTION}
  in vec3 part, middle, vector; out vec3 towards;
  void main() {
    vec3 w = normalize(vector);
    vec3 u = normalize(cross(w, abs(w.z) < 0.9 ? vec3(0, 0, 1) : vec3(1, 0, 0)));
    mat3 frame = mat3(u, cross(w, u), w);
    towards = axes * (frame * vec3(part.xy, 0.02));
    gl_Position = projected(middle + length(vector) * (frame * part));
  }`, `#version 300 es
  precision highp float;
  in vec3 towards; uniform vec4 ink; out vec4 colour;
  void main() { colour = vec4(ink.rgb * (0.72 + 0.34 * normalize(towards).y), 1.0); }`];

// Magnets and coils: triangles in a frame that turns and moves.
const SOLID = [`${PROJECTION}
  in vec3 position, normal; uniform mat3 turn; uniform vec3 shift; out vec3 towards;
  void main() {
    towards = axes * (turn * normal);
    gl_Position = projected(turn * position + shift);
  }`, `#version 300 es
  precision highp float;
  in vec3 towards; uniform vec4 ink; out vec4 colour;
  void main() {
    vec3 n = normalize(towards);
    n = n.z < 0.0 ? -n : n;
    colour = vec4(ink.rgb * (0.62 + 0.4 * max(dot(n, normalize(vec3(-0.35, 0.55, 0.76))), 0.0)), 1.0);
  }`];

// Triangles of an arrow from (0, 0, -1/2) to (0, 0, 1/2): shaft and head.
function arrowParts(sides = 14) {
  const parts = [];
  const rings = [[-0.5, 0.035], [0.12, 0.035], [0.12, 0.11], [0.5, 0]];
  const at = ([z, radius], i) => {
    const angle = (2 * Math.PI * i) / sides;
    return [radius * Math.cos(angle), radius * Math.sin(angle), z];
  };
  for (let ring = 0; ring < 3; ring++) {
    for (let i = 0; i < sides; i++) {
      const [a, b] = [rings[ring], rings[ring + 1]];
      parts.push(...at(a, i), ...at(a, i + 1), ...at(b, i + 1), ...at(a, i), ...at(b, i + 1), ...at(b, i));
    }
  }
  return new Float32Array(parts);
}

class Scene {
  constructor(canvas) {
    this.gl = canvas.getContext("webgl2", { antialias: true, alpha: true, premultipliedAlpha: true });
    if (!this.gl) throw new Error("WebGL 2 is missing");
    const gl = this.gl;
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    this.surface = this.program(SURFACE, { position: [3, 0], normal: [3, 0], value: [1, 0] });
    this.arrow = this.program(ARROWS, { part: [3, 0], middle: [3, 6, 0], vector: [3, 6, 3] });
    const parts = arrowParts();
    this.fill(this.arrow, "part", parts);
    this.arrow.count = parts.length / 3;
    this.lines = [];
    this.solids = [];
    this.colours = gl.createTexture();
  }

  // A program with its vertex array; of each attribute: its size, then, for one that advances with the instance in a
  // shared buffer, the numbers of an instance and where in it this one begins.
  program([vertex, fragment], attributes) {
    const gl = this.gl;
    const program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    const result = { program, array: gl.createVertexArray(), buffers: {}, count: 0, places: new Map() };
    gl.bindVertexArray(result.array);
    let shared = null;
    for (const [name, [size, stride, begin]] of Object.entries(attributes)) {
      const place = gl.getAttribLocation(program, name);
      const buffer = stride && shared ? shared : gl.createBuffer();
      if (stride) shared = buffer;
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, 4 * stride, 4 * (begin ?? 0));
      if (stride) gl.vertexAttribDivisor(place, 1);
      result.buffers[name] = buffer;
    }
    return result;
  }

  fill(drawable, name, data) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, drawable.buffers[name]);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
  }

  setTriangles(triangles) {
    const gl = this.gl;
    gl.bindVertexArray(this.surface.array);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles, gl.STATIC_DRAW);
    this.surface.count = triangles.length;
  }

  setColours(bytes) {
    const gl = this.gl;
    gl.bindTexture(gl.TEXTURE_2D, this.colours);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB8, bytes.length / 3, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, bytes);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.LINEAR);
    for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
  }

  // A set of lines; `style()` gives width (pixels), ink (red, green, blue, opacity), nearer (depth), shown, and behind
  // for lines that everything else covers.
  addLines(style) {
    const lines = this.program(LINES, { start: [3, 6, 0], end: [3, 6, 3] });
    lines.style = style;
    this.lines.push(lines);
    return lines;
  }

  // A surface of magnets or coils: corners and normals of its triangles; `pose()` gives turn, shift and ink.
  addSolid(data, pose) {
    const solid = this.program(SOLID, { position: [3, 0], normal: [3, 0] });
    const part = (first) => Float32Array.from({ length: data.length / 2 }, (_, i) => {
      return data[6 * Math.floor(i / 3) + first + (i % 3)];
    });
    const corners = part(0);
    this.fill(solid, "position", corners);
    this.fill(solid, "normal", part(3));
    this.solids.push({ ...solid, pose, corners, count: data.length / 6 });
  }

  setInstances(drawable, name, data) {
    this.fill(drawable, name, data);
    drawable.instances = data.length / 6;
  }

  // Take up a program with its arrays, the camera's numbers, and values of its uniforms.
  begin(camera, { program, array }, values) {
    const { gl } = this;
    gl.useProgram(program);
    gl.bindVertexArray(array);
    const set = (name, ...numbers) => {
      const place = gl.getUniformLocation(program, name);
      if (numbers.length === 9) gl.uniformMatrix3fv(place, true, numbers);
      else if (place) gl[`uniform${numbers.length}f`](place, ...numbers);
    };
    set("axes", ...camera.axes.flat());
    set("centre", ...camera.centre);
    set("span", ...camera.span);
    set("pixels", gl.canvas.width, gl.canvas.height);
    for (const [name, value] of Object.entries(values)) set(name, ...value);
  }

  // What hides what is behind it: the body, magnets and coils.
  drawBodies(camera, range) {
    const { gl } = this;
    this.begin(camera, this.surface, { range, nearer: [0] });
    gl.drawElements(gl.TRIANGLES, this.surface.count, gl.UNSIGNED_INT, 0);
    for (const solid of this.solids) {
      this.begin(camera, solid, { ...solid.pose(), nearer: [0] });
      gl.drawArrays(gl.TRIANGLES, 0, solid.count);
    }
  }

  draw(camera, range, arrowInk) {
    const gl = this.gl;
    const { canvas } = gl;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const drawLines = (wanted) => {
      for (const lines of this.lines) {
        const { width, ink, nearer, shown, behind } = lines.style();
        if (!shown || Boolean(behind) !== wanted) continue;
        this.begin(camera, lines, { width: [(width * canvas.width) / canvas.clientWidth], ink, nearer: [nearer] });
        gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, lines.instances);
      }
    };
    gl.disable(gl.DEPTH_TEST);
    drawLines(true);
    gl.enable(gl.DEPTH_TEST);
    this.drawBodies(camera, range);
    drawLines(false);
    if (arrowInk && this.arrow.instances) {
      this.begin(camera, this.arrow, { ink: arrowInk, nearer: [4e-3] });
      gl.drawArraysInstanced(gl.TRIANGLES, 0, this.arrow.count, this.arrow.instances);
    }
  }
}
