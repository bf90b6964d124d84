// Which points are seen: those that neither the body nor a magnet hides, to within a pixel.

const CLOSE = 5e-3; // how much nearer something must be to hide a point, in depths of the picture
const ROW = 1024; // answers in a row of pixels

const SEEN = [`${PROJECTION}
  in vec3 position; uniform vec2 answers; out vec3 place;
  void main() {
    place = 0.5 * projected(position).xyz + 0.5;
    vec2 pixel = vec2(gl_VertexID % ${ROW}, gl_VertexID / ${ROW}) + 0.5;
    gl_Position = vec4(2.0 * pixel / answers - 1.0, 0.0, 1.0);
    gl_PointSize = 1.0;
  }`, `#version 300 es
  precision highp float;
  in vec3 place; uniform highp sampler2D depths; out vec4 seen;
  void main() {
    ivec2 size = textureSize(depths, 0), pixel = ivec2(floor(place.xy * vec2(size)));
    float farthest = 0.0;
    for (int i = -1; i <= 1; i++) for (int j = -1; j <= 1; j++) {
      farthest = max(farthest, texelFetch(depths, clamp(pixel + ivec2(i, j), ivec2(0), size - 1), 0).r);
    }
    seen = vec4(place.z <= farthest);
  }`];

class Sight {
  constructor(scene) {
    const { gl } = scene;
    this.scene = scene;
    this.points = scene.program(SEEN, { position: [3, 0] });
    this.depths = this.texture();
    this.answers = this.texture();
    this.depthBuffer = gl.createFramebuffer();
    this.answerBuffer = gl.createFramebuffer();
    gl.bindTexture(gl.TEXTURE_2D, scene.colours);
  }

  texture() {
    const { gl } = this.scene;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    return texture;
  }

  // Whether each of the points (flat) is seen.
  of(points, camera) {
    const { scene, scene: { gl } } = this;
    const { width, height } = gl.canvas;
    const count = points.length / 3, rows = Math.ceil(count / ROW);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.depthBuffer);
    gl.bindTexture(gl.TEXTURE_2D, this.depths);
    gl.texImage2D(
      gl.TEXTURE_2D, 0, gl.DEPTH_COMPONENT24, width, height, 0, gl.DEPTH_COMPONENT, gl.UNSIGNED_INT, null,
    );
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.depths, 0);
    gl.drawBuffers([gl.NONE]);
    gl.bindTexture(gl.TEXTURE_2D, scene.colours);
    gl.viewport(0, 0, width, height);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    scene.drawBodies(camera, [0, 1]);

    gl.bindFramebuffer(gl.FRAMEBUFFER, this.answerBuffer);
    gl.bindTexture(gl.TEXTURE_2D, this.answers);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, ROW, rows, 0, gl.RGBA, gl.UNSIGNED_BYTE, null);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.answers, 0);
    gl.bindTexture(gl.TEXTURE_2D, this.depths);
    gl.viewport(0, 0, ROW, rows);
    gl.disable(gl.DEPTH_TEST);
    scene.fill(this.points, "position", points);
    scene.begin(camera, this.points, { nearer: [CLOSE], answers: [ROW, rows] });
    gl.drawArrays(gl.POINTS, 0, count);
    const pixels = new Uint8Array(4 * ROW * rows);
    gl.readPixels(0, 0, ROW, rows, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    gl.enable(gl.DEPTH_TEST);
    gl.bindTexture(gl.TEXTURE_2D, scene.colours);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return Array.from({ length: count }, (_, i) => pixels[4 * i] > 0);
  }
}
