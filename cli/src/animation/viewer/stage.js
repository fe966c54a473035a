// From poses to what is painted: shapes of bodies, springs, forces, tracks, ground; the camera's target; triad and legend.

const BODIES = ["#0072b2", "#e69f00", "#56b4e9", "#cc79a7", "#009e73", "#8a8f98"];
const NORMAL = "#009e73", FRICTION = "#cc79a7", TIRE = ["#33363b", "#5b616b"], RIM = ["#aab0b8", "#c2c7ce"], MARK = "#d55e00";

function color(hex, opacity = 1) {
  const n = parseInt(hex.slice(1), 16);
  return [(n >> 16) / 255, ((n >> 8) & 255) / 255, (n & 255) / 255, opacity];
}

let painter, camera;
const parts = [];
const meshes = {};

// The shapes of all bodies: mesh, place in the body, color.
function build() {
  const m = (name, make) => (meshes[name] ??= painter.mesh(make()));
  scene.bodies.forEach((body, b) => {
    const own = BODIES[(b - 1 + BODIES.length) % BODIES.length];
    const part = (mesh, p, q, s, more) => parts.push({ body: b, mesh, p, q, s, color: own, ...more });
    for (const shape of body.shapes) {
      const { kind, at = [0, 0, 0], turn = IDENTITY, radius: r } = shape;
      const painted = shape.color ? { rgba: shape.color } : {};
      if (kind === "strut") {
        const d = sub(shape.to, shape.from);
        part(m("cylinder", cylinder), shape.from, fromZ(unit(d)), [r, r, norm(d)]);
        for (const end of [shape.from, shape.to]) part(m("ball", ball), end, IDENTITY, [1.15 * r, 1.15 * r, 1.15 * r]);
      } else if (kind === "ellipsoid") {
        part(m("ball", ball), at, turn, shape.semi, { glass: true, layer: "bodies", opacity: 0.34 });
      } else if (kind === "center") {
        const s = 0.016 * scene.size;
        part(m("ball", ball), at, IDENTITY, [s, s, s], { layer: "centers", bright: true, color: "#cc3311" });
      } else if (kind === "bearing") {
        part(m("ball", ball), at, IDENTITY, [r, r, r], { color: "#8a8f98" });
      } else if (kind === "box") {
        part(m("block", block), at, turn, shape.size, painted);
      } else if (kind === "sphere") {
        part(m("ball", ball), at, turn, [r, r, r], painted);
      } else if (kind === "cylinder" || kind === "capsule") {
        const half = turned(turn, [0, 0, shape.length / 2]);
        part(m("cylinder", cylinder), sub(at, half), turn, [r, r, shape.length], painted);
        if (kind === "capsule") for (const end of [add(at, half), sub(at, half)]) part(m("ball", ball), end, turn, [r, r, r], painted);
      }
    }
  });
  scene.contacts.forEach(({ body, center, axis, radius, crown }, k) => {
    const q = fromZ(axis), one = [1, 1, 1];
    parts.push({ body, mesh: painter.mesh(tire(radius, crown)), p: center, q, s: one, shade: TIRE });
    parts.push({ body, mesh: painter.mesh(rim(radius, crown)), p: center, q, s: one, shade: RIM });
    // one spoke tells how far the wheel has turned
    const rho = Math.max(crown, 0.045 * radius);
    const length = radius - rho - Math.min(0.5 * rho, 0.16 * radius);
    const mark = moved(spoke(0, length, radius), matrix([0, 0, 0], IDENTITY, [1.004, 1.35, 1.35]));
    parts.push({ body, mesh: painter.mesh(mark), p: center, q, s: one, color: MARK });
  });
  m("cylinder", cylinder);
  m("cone", cone);
  m("coil", coil);
}

function shadeOf(part) {
  if (part.rgba) return [...part.rgba.slice(0, 3), part.rgba[3] ?? 1];
  return color(part.shade ? part.shade[dark() ? 1 : 0] : part.color, part.opacity ?? 1);
}

function itemsOf({ poses, contacts }, origin) {
  const items = [];
  for (const part of parts) {
    if (part.layer && !layers[part.layer]) continue;
    const { p, q } = poses[part.body];
    const model = matrix(sub(add(p, turned(q, part.p)), origin), product(q, part.q), part.s);
    items.push({ mesh: part.mesh, model, color: shadeOf(part), glass: part.glass, bright: part.bright });
  }
  for (const { kind, from, to } of scene.links) {
    const [a, b] = [from, to].map(([body, ...point]) => sub(placed(poses[body], point), origin));
    const d = sub(b, a), r = (kind === "spring" ? 0.03 : 0.012) * scene.size;
    const mesh = kind === "spring" ? meshes.coil : meshes.cylinder;
    items.push({ mesh, model: matrix(a, fromZ(unit(d)), [r, r, norm(d)]), color: color(kind === "spring" ? "#d55e00" : "#8a8f98") });
  }
  if (layers.forces) {
    for (const { point, normal, friction } of contacts) {
      pointer(items, sub(point, origin), scale(normal, state.perNewton), color(NORMAL));
      pointer(items, sub(point, origin), scale(friction, state.perNewton), color(FRICTION));
    }
  }
  return items;
}

function pointer(items, at, vector, rgba) {
  const length = norm(vector), r = 0.007 * scene.size;
  if (!(length > 0.5 * r)) return;
  const head = Math.min(7 * r, 0.6 * length), q = fromZ(unit(vector)), way = unit(vector);
  items.push({ mesh: meshes.cylinder, model: matrix(at, q, [r, r, length - head]), color: rgba, bright: true });
  items.push({ mesh: meshes.cone, model: matrix(add(at, scale(way, length - head)), q, [2.6 * r, 2.6 * r, head]), color: rgba, bright: true });
}

// What the camera looks at, and its heading.
function targetOf(poses) {
  if (scene.follows === null) return [[0, 0, 0], 0];
  const { p, q } = poses[scene.follows];
  const rolling = scene.contacts.find((c) => c.body === scene.follows);
  const x = rolling ? cross(turned(q, rolling.axis), [0, 0, 1]) : turned(q, [1, 0, 0]);
  const heading = Math.atan2(x[1], x[0]);
  if (!state.offset) {
    const points = scene.bodies.flatMap((b, k) => b.shapes.filter((s) => s.kind === "center").map((s) => placed(poses[k], s.at)));
    points.push(...scene.contacts.map((c) => placed(poses[c.body], c.center)));
    const range = [0, 1, 2].map((i) => points.map((v) => v[i])).map((v) => (Math.min(...v) + Math.max(...v)) / 2);
    state.offset = turned(about([0, 0, 1], -heading), sub(range, [p[0], p[1], 0]));
  }
  return [add([p[0], p[1], 0], turned(about([0, 0, 1], heading), state.offset)), heading];
}

const nice = (x) => [1, 2, 5, 10].map((m) => m * 10 ** Math.floor(Math.log10(x))).find((v) => v >= x);

function paint(passed, jump) {
  const now = film.at(state.time, state.total);
  const [target, heading] = targetOf(now.poses);
  camera.follow(target, heading, passed, jump);
  const origin = camera.target, canvas = $("view");
  const view = camera.look(canvas.clientWidth / Math.max(canvas.clientHeight, 1));
  const flat = scene.ground;
  const tracks = !layers.tracks ? [] : film.tracks(state.time, state.total, now).map((points, k) => ({
    points: points.map((p) => [p[0] - origin[0], p[1] - origin[1], (flat ? 0 : p[2]) - origin[2]]),
    color: color(flat ? CURVES[k % 2] : BODIES[(k - 1 + BODIES.length) % BODIES.length], 0.85), flat, width: 0.014 * scene.size,
  }));
  const floor = flat ? 0 : scene.box[0][2] - 0.12 * camera.size;
  const solid = flat || (camera.thin !== 2 && !scene.weightless);
  const cell = state.cell;
  const ground = solid && {
    cell, level: floor - origin[2], reach: Math.max(view.distance * 9, 12 * camera.size),
    offset: [origin[0] % (5 * cell), origin[1] % (5 * cell)],
  };
  painter.paint({
    camera: view.matrix, eye: view.eye, ground, tracks, items: itemsOf(now, origin),
    paper: color(style("--paper")).slice(0, 3), line: color(dark() ? "#4a5361" : "#b9bfc8").slice(0, 3),
    shadow: [0, 0, 0, dark() ? 0.45 : 0.2],
  });
  triad();
}

function triad() {
  const axes = [["x", "#d55e00"], ["y", "#009e73"], ["z", "#0072b2"]].map(([name, paint], k) => {
    const [x, y, z] = [0, 1, 2].map((i) => camera.axes[4 * k + i]);
    const [u, v] = [26 * x, -26 * y];
    return [z, `<line x2="${u}" y2="${v}" stroke="${paint}" stroke-width="2.4" stroke-linecap="round"/>` +
      `<text x="${1.32 * u}" y="${1.32 * v}" fill="${paint}" text-anchor="middle" dominant-baseline="central">${name}</text>`];
  });
  $("triad").innerHTML = axes.sort((a, b) => a[0] - b[0]).map((a) => a[1]).join("");
}

function legend() {
  if (!painter) return;
  const entries = [];
  const forces = film.strongest > 0;
  if (forces && layers.forces) {
    entries.push([NORMAL, "normal force"], [FRICTION, `friction force, 1 m is ${short(1 / state.perNewton)} N`]);
  }
  if (layers.tracks && scene.contacts.length) scene.contacts.forEach((c, k) => entries.push([CURVES[k % 2], `track of ${c.name}`]));
  $("legend").replaceChildren(...entries.map(([paint, text]) => {
    const row = document.createElement("div");
    element("i", row).style.background = paint;
    row.append(text);
    return row;
  }));
  if (scene.ground) element("div", $("legend"), `grid ${short(state.cell)} m`).style.color = "var(--faint)";
}
