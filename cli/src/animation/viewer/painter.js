// Draws meshes, ground, tracks and shadows with WebGL 2. Places are relative to an origin that travels, so that 32 bits are enough.

const SOLID = [`#version 300 es
uniform mat4 camera, model; uniform vec3 squares; uniform float drop;
in vec3 position, normal; out vec3 n, p;
void main() {
  vec4 world = model * vec4(position, 1.0);
  if (drop > -1e5) { world.xy -= vec2(0.25, -0.18) * (world.z - drop); world.z = drop; }
  p = world.xyz; n = mat3(model) * (normal / squares);
  gl_Position = camera * world;
}`, `#version 300 es
precision highp float;
uniform vec4 color; uniform vec3 eye; uniform float lit, glass;
in vec3 n, p; out vec4 o;
void main() {
  vec3 N = normalize(n), V = normalize(eye - p);
  if (dot(N, V) < 0.0) N = -N;
  vec3 L = normalize(vec3(0.35, -0.45, 0.95)), H = normalize(L + V);
  float diffuse = max(dot(N, L), 0.0), sky = 0.5 + 0.5 * N.z, rim = 1.0 - max(dot(N, V), 0.0);
  vec3 c = mix(color.rgb, color.rgb * (0.30 + 0.34 * sky + 0.46 * diffuse) + 0.16 * pow(max(dot(N, H), 0.0), 40.0), lit);
  o = vec4(c, color.a * mix(1.0, 0.42 + 1.5 * rim * rim, glass));
}`];

const GROUND = [`#version 300 es
uniform mat4 camera; uniform float reach, level; in vec3 position; out vec2 p;
void main() { p = position.xy * reach; gl_Position = camera * vec4(p, level, 1.0); }`, `#version 300 es
precision highp float;
uniform vec3 paper, line; uniform vec2 offset; uniform float cell, reach; in vec2 p; out vec4 o;
float grid(float size) {
  vec2 x = (p + offset) / size, w = fwidth(x), d = abs(fract(x - 0.5) - 0.5) / max(w, 1e-6);
  vec2 a = (1.0 - min(d, 1.0)) * (1.0 - smoothstep(0.25, 0.8, w));
  return max(a.x, a.y);
}
void main() {
  float far = smoothstep(0.25, 1.0, length(p) / reach);
  float g = max(0.55 * grid(cell), grid(5.0 * cell));
  o = vec4(mix(paper, line, g * (1.0 - far)), 1.0);
}`];

class Painter {
  constructor(canvas) {
    this.canvas = canvas;
    const gl = (this.gl = canvas.getContext("webgl2", { alpha: false, antialias: true, stencil: true, preserveDrawingBuffer: true }));
    if (!gl) throw new Error("this browser offers no WebGL 2");
    this.solid = this.program(SOLID);
    this.ground = this.program(GROUND);
    this.quad = this.mesh(surface(1, 1, (u, v) => [[2 * u - 1, 2 * v - 1, 0], [0, 0, 1]]));
    this.ribbon = gl.createBuffer();
    gl.enable(gl.DEPTH_TEST);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }

  program([vertex, fragment]) {
    const gl = this.gl, program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.bindAttribLocation(program, 0, "position");
    gl.bindAttribLocation(program, 1, "normal");
    gl.linkProgram(program);
    const uniforms = {}, count = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS);
    for (let k = 0; k < count; k++) {
      const { name } = gl.getActiveUniform(program, k);
      uniforms[name] = gl.getUniformLocation(program, name);
    }
    return { program, uniforms };
  }

  mesh({ positions, normals, triangles }) {
    const gl = this.gl, array = gl.createVertexArray();
    gl.bindVertexArray(array);
    for (const [k, values] of [[0, positions], [1, normals]]) {
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(values), gl.STATIC_DRAW);
      gl.enableVertexAttribArray(k);
      gl.vertexAttribPointer(k, 3, gl.FLOAT, false, 0, 0);
    }
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint16Array(triangles), gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    return { array, count: triangles.length };
  }

  // items: { mesh, model, color, glass }; tracks: { points (flat), color, width }; all relative to the origin of the camera.
  paint({ camera, eye, paper, line, ground, items, tracks, shadow }) {
    const gl = this.gl, ratio = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.round(this.canvas.clientWidth * ratio), height = Math.round(this.canvas.clientHeight * ratio);
    if (this.canvas.width !== width || this.canvas.height !== height) [this.canvas.width, this.canvas.height] = [width, height];
    gl.viewport(0, 0, width, height);
    gl.clearColor(...paper, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
    if (ground) {
      const { program, uniforms: u } = this.ground;
      gl.useProgram(program);
      gl.uniformMatrix4fv(u.camera, false, camera);
      gl.uniform3fv(u.paper, paper);
      gl.uniform3fv(u.line, line);
      gl.uniform2fv(u.offset, ground.offset);
      gl.uniform1f(u.cell, ground.cell);
      gl.uniform1f(u.reach, ground.reach);
      gl.uniform1f(u.level, ground.level);
      gl.depthMask(false);
      this.triangles(this.quad);
      gl.depthMask(true);
    }
    const { program, uniforms: u } = this.solid;
    gl.useProgram(program);
    gl.uniformMatrix4fv(u.camera, false, camera);
    gl.uniform3fv(u.eye, eye);
    gl.uniform1f(u.drop, -1e6);
    gl.enable(gl.BLEND);
    if (ground) {
      // every point of the ground is darkened once
      gl.enable(gl.STENCIL_TEST);
      gl.stencilFunc(gl.EQUAL, 0, 255);
      gl.stencilOp(gl.KEEP, gl.KEEP, gl.INCR);
      gl.depthMask(false);
      gl.uniform1f(u.drop, ground.level);
      for (const item of items) if (!item.bright && !item.glass) this.item(item, { ...item, color: shadow, glass: 0, lit: 0 }, u);
      gl.uniform1f(u.drop, -1e6);
      gl.disable(gl.STENCIL_TEST);
      for (const track of tracks) if (track.flat) this.track(track, u);
      gl.depthMask(true);
    }
    for (const track of tracks) if (!ground || !track.flat) this.track(track, u);
    gl.disable(gl.BLEND);
    for (const item of items) if (!item.bright && !item.glass && item.color[3] === 1) this.item(item, item, u);
    gl.enable(gl.BLEND);
    gl.enable(gl.CULL_FACE);
    gl.depthMask(false);
    for (const item of items) if (item.glass || item.color[3] < 1) this.item(item, item, u);
    gl.depthMask(true);
    gl.disable(gl.CULL_FACE);
    gl.disable(gl.BLEND);
    // forces and mass centers are seen through everything
    gl.clear(gl.DEPTH_BUFFER_BIT);
    for (const item of items) if (item.bright) this.item(item, item, u);
  }

  item({ mesh, model }, { color, glass, lit = 1 }, u) {
    const gl = this.gl;
    const square = (j) => model[j] ** 2 + model[j + 1] ** 2 + model[j + 2] ** 2 || 1;
    gl.uniformMatrix4fv(u.model, false, model);
    gl.uniform3f(u.squares, square(0), square(4), square(8));
    gl.uniform4fv(u.color, color);
    gl.uniform1f(u.glass, glass ? 1 : 0);
    gl.uniform1f(u.lit, lit);
    this.triangles(mesh);
  }

  triangles(mesh) {
    this.gl.bindVertexArray(mesh.array);
    this.gl.drawElements(this.gl.TRIANGLES, mesh.count, this.gl.UNSIGNED_SHORT, 0);
  }

  // A band in the plane across z (flat), or a line.
  track({ points, color, flat, width }, u) {
    const gl = this.gl, n = points.length;
    if (n < 2) return;
    const values = flat ? band(points, width / 2) : new Float32Array(points.flat());
    gl.bindVertexArray(null);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.ribbon);
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    gl.disableVertexAttribArray(1);
    gl.vertexAttrib3f(1, 0, 0, 1);
    gl.uniformMatrix4fv(u.model, false, matrix([0, 0, 0], IDENTITY));
    gl.uniform3f(u.squares, 1, 1, 1);
    gl.uniform4fv(u.color, color);
    gl.uniform1f(u.glass, 0);
    gl.uniform1f(u.lit, 0);
    gl.drawArrays(flat ? gl.TRIANGLE_STRIP : gl.LINE_STRIP, 0, values.length / 3);
  }
}

function band(points, half) {
  const values = new Float32Array(6 * points.length);
  let side = [0, half];
  points.forEach((p, k) => {
    const a = points[Math.max(k - 1, 0)], b = points[Math.min(k + 1, points.length - 1)];
    const d = [b[0] - a[0], b[1] - a[1]], length = Math.hypot(...d);
    if (length > 1e-9) side = [(-d[1] / length) * half, (d[0] / length) * half];
    values.set([p[0] + side[0], p[1] + side[1], p[2], p[0] - side[0], p[1] - side[1], p[2]], 6 * k);
  });
  return values;
}
