// Surfaces: positions, normals, triangles.

function surface(columns, rows, at) {
  const positions = [], normals = [], triangles = [];
  for (let j = 0; j <= rows; j++) {
    for (let i = 0; i <= columns; i++) {
      const [p, n] = at(i / columns, j / rows);
      positions.push(...p);
      normals.push(...unit(n));
    }
  }
  const w = columns + 1;
  for (let j = 0; j < rows; j++) {
    for (let i = 0; i < columns; i++) {
      const a = j * w + i;
      triangles.push(a, a + 1, a + w + 1, a, a + w + 1, a + w);
    }
  }
  return { positions, normals, triangles };
}

function joined(...meshes) {
  const all = { positions: [], normals: [], triangles: [] };
  for (const m of meshes) {
    const first = all.positions.length / 3;
    all.positions.push(...m.positions);
    all.normals.push(...m.normals);
    for (const t of m.triangles) all.triangles.push(t + first);
  }
  return all;
}

// Of a profile (radius, height) with its normals about z.
function revolved(profile, columns = 28) {
  const rows = profile.length - 1;
  return surface(columns, rows, (u, v) => {
    const [r, h, nr, nh] = profile[Math.round(v * rows)];
    const c = Math.cos(2 * Math.PI * u), s = Math.sin(2 * Math.PI * u);
    return [[r * c, r * s, h], [nr * c, nr * s, nh]];
  });
}

// From z = 0 to z = 1, radius 1.
const cylinder = () => revolved([[0, 0, 0, -1], [1, 0, 0, -1], [1, 0, 1, 0], [1, 1, 1, 0], [1, 1, 0, 1], [0, 1, 0, 1]], 20);
// An arrow from z = 0 to z = 1: the shaft up to the tip; the tip, of unit height, separately.
const cone = () => revolved([[0, 0, 0, -1], [1, 0, 0, -1], [1, 0, 1, 0.4], [0, 1, 1, 0.4]], 20);
const ball = () => surface(32, 20, (u, v) => {
  const a = 2 * Math.PI * u, b = Math.PI * (v - 0.5);
  const p = [Math.cos(a) * Math.cos(b), Math.sin(a) * Math.cos(b), Math.sin(b)];
  return [p, p];
});

function block() {
  const faces = [];
  for (const axis of [0, 1, 2]) {
    for (const side of [-1, 1]) {
      const n = [0, 0, 0];
      n[axis] = side;
      faces.push(surface(1, 1, (u, v) => {
        const p = [0, 0, 0];
        p[axis] = 0.5 * side;
        p[(axis + 1) % 3] = (side > 0 ? u : 1 - u) - 0.5;
        p[(axis + 2) % 3] = v - 0.5;
        return [p, n];
      }));
    }
  }
  return joined(...faces);
}

// A coil of unit length and radius along z between straight ends.
function coil(turns = 9, wire = 0.14) {
  const wound = surface(8, turns * 20, (u, v) => {
    const a = 2 * Math.PI * turns * v, b = 2 * Math.PI * u;
    const c = Math.cos(a), s = Math.sin(a);
    const n = [c * Math.cos(b), s * Math.cos(b), Math.sin(b)];
    return [[c * (1 - wire) + wire * n[0], s * (1 - wire) + wire * n[1], 0.14 + 0.72 * v + 0.011 * n[2]], n];
  });
  const end = (from) => moved(cylinder(), matrix([0, 0, from], IDENTITY, [wire, wire, 0.14]));
  return joined(wound, end(0), end(0.86));
}

// The tire of a wheel about z: the crown outside, flatter inside; a sharp edge gets a little body.
function tire(radius, crown) {
  const rho = Math.max(crown, 0.045 * radius), inner = Math.min(0.5 * rho, 0.16 * radius);
  const middle = radius - rho;
  return surface(72, 20, (u, v) => {
    const a = 2 * Math.PI * u, b = 2 * Math.PI * v;
    const out = Math.cos(b) > 0 ? rho : inner;
    const r = middle + out * Math.cos(b), h = rho * Math.sin(b);
    const n = [Math.cos(b) / out, Math.sin(b) / rho];
    const c = Math.cos(a), s = Math.sin(a);
    return [[r * c, r * s, h], [n[0] * c, n[0] * s, n[1]]];
  });
}

// Rim, hub and spokes; the rim is narrower than the tire.
function rim(radius, crown) {
  const rho = Math.max(crown, 0.045 * radius), inner = Math.min(0.5 * rho, 0.16 * radius);
  const r = radius - rho - inner, half = 0.6 * rho, t = 0.03 * radius;
  const ring = revolved([[r + t, -half, 0, -1], [r - t, -half, -0.2, -1], [r - t, -half, -1, 0], [r - t, half, -1, 0], [r - t, half, 0, 1], [r + t, half, 0, 1]], 72);
  const hub = revolved([[0, -half, 0, -1], [0.09 * radius, -half, 0, -1], [0.09 * radius, -half, 1, 0], [0.09 * radius, half, 1, 0], [0.09 * radius, half, 0, 1], [0, half, 0, 1]]);
  return joined(ring, hub, ...[...Array(5).keys()].map((k) => spoke((2 * Math.PI * k) / 5, r, radius)));
}

function spoke(angle, length, radius) {
  return moved(cylinder(), matrix([0, 0, 0], product(about([0, 0, 1], angle), fromZ([1, 0, 0])), [0.032 * radius, 0.032 * radius, length]));
}

function moved(mesh, m) {
  const positions = [], normals = [];
  const apply = (v, w) => [0, 1, 2].map((i) => m[i] * v[0] + m[4 + i] * v[1] + m[8 + i] * v[2] + w * m[12 + i]);
  const squares = [0, 1, 2].map((j) => m[4 * j] ** 2 + m[4 * j + 1] ** 2 + m[4 * j + 2] ** 2);
  for (let k = 0; k < mesh.positions.length; k += 3) {
    positions.push(...apply(mesh.positions.slice(k, k + 3), 1));
    normals.push(...unit(apply(mesh.normals.slice(k, k + 3).map((x, i) => x / squares[i]), 0)));
  }
  return { positions, normals, triangles: mesh.triangles };
}
