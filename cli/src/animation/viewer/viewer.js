// Puts data, view, figures and controls together.

const data = JSON.parse(document.getElementById("data").textContent);
const $ = (id) => document.getElementById(id);
const BODIES = ["#0072b2", "#e69f00", "#56b4e9", "#cc79a7", "#009e73", "#8a8f98"];
const NORMAL = "#009e73", FRICTION = "#d55e00", TIRE = ["#33363b", "#5b616b"], RIM = ["#aab0b8", "#c2c7ce"], MARK = "#d55e00";
// Frames shown per second of the film where a key steps.
const STEP = 1 / 60;

const film = data.kind === "run" ? new Recorded(data) : new Mode(data);
const scene = data.scene;
const state = { time: film.window[0], total: 0, playing: true, base: 1, dirty: true };
const layers = { forces: true, tracks: true, bodies: true, centers: false };
const request = new URLSearchParams(location.hash.slice(1));
const dark = () => document.documentElement.dataset.theme === "dark";

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

// ---- figures beside the view

const plots = [];
const phasors = [];

function besideRun() {
  const seek = (t) => go(t);
  data.plots.forEach((p, k) => plots.push(new Plot($("beside"), p, film.time, CURVES[k % CURVES.length], seek)));
}

function besideModes() {
  const host = $("beside");
  const row = (label) => {
    const r = element("label", host, undefined, { class: "row" });
    element("span", r, label);
    return r;
  };
  const select = (label, options, changed) => {
    const s = element("select", row(label));
    options.forEach((text, k) => element("option", s, text, { value: k }));
    s.addEventListener("change", () => changed(Number(s.value)));
    return s;
  };
  const oscillates = (m) => (m.im > 0 ? `${short(m.hz, 3)} Hz` : `${short(m.re, 3)} 1/s`);
  let point = Math.min(Number(request.get("point") ?? 0), data.points.length - 1), mode = 0;
  const list = element("select", row("mode"));
  const fill = () => {
    list.replaceChildren();
    data.points[point].modes.forEach((m, k) => element("option", list, `${m.name}, ${oscillates(m)}`, { value: k }));
  };
  const table = element("table", host);
  const chosen = () => {
    film.choose(point, mode);
    list.value = String(mode);
    // slow motions travel far: their path is left out at first
    film.path = film.oscillates && film.mode.im > 1;
    path.value = film.path ? "0" : "1";
    const m = film.mode;
    const rows = [["eigenvalue", `${short(m.re)}${m.im > 0 ? ` ± ${short(m.im)} j` : ""} 1/s`], ["damping ratio", short(m.damping, 3)]];
    if (m.im > 0) rows.unshift(["damped frequency", `${short(m.hz)} Hz`]);
    rows.push(["", m.re > 1e-6 ? "grows: unstable" : m.re < -1e-6 ? "fades: stable" : "neutral"]);
    table.replaceChildren();
    for (const [name, value] of rows) {
      const r = element("tr", table);
      element("td", r, name);
      element("td", r, value);
    }
    for (const p of phasors) p.show(m.phasors.filter((x) => (x.unit === "mm") === (p.unit === "mm")));
    $("slider").max = film.window[1];
    setBase();
    restart();
  };
  list.addEventListener("change", () => {
    mode = Number(list.value);
    chosen();
  });
  const name = () => data.points[point].modes[mode]?.name;
  if (data.points.length > 1) {
    const s = select("steady state", data.points.map((p) => p.label), (k) => {
      const before = name();
      point = k;
      fill();
      mode = Math.max(0, data.points[point].modes.findIndex((m) => m.name === before));
      chosen();
    });
    s.value = String(point);
    host.prepend(s.parentElement);
  } else {
    element("h2", host, data.points[0].label);
    host.prepend(host.lastChild);
  }
  const r = row("amplitude");
  const slider = element("input", r, undefined, { type: "range", min: 0, max: 0.5, step: "any" });
  const told = element("output", r);
  const set = (a) => {
    film.amplitude = a;
    slider.value = a;
    told.textContent = `${((a * 180) / Math.PI).toFixed(1)}°`;
    state.dirty = true;
  };
  slider.addEventListener("input", () => set(Number(slider.value)));
  set(Number(request.get("amplitude") ?? film.amplitude));
  select("moving frame", ["travels with the vehicle", "stays"], (k) => {
    film.travels = k === 0;
    restart();
  });
  const path = select("path of the mode", ["shown", "left out"], (k) => {
    film.path = k === 0;
    state.dirty = true;
  });
  select("amplitude over time", ["constant", "fades or grows"], (k) => {
    film.fades = k === 1;
    $("slider").max = film.window[1];
    restart();
  });
  const unit = data.points.some((p) => p.modes.some((m) => m.phasors.some((x) => x.unit === "rad"))) ? "rad" : "deg";
  phasors.push(new Phasors(host, unit), new Phasors(host, "mm"));
  fill();
  const wanted = request.get("mode");
  const modes = data.points[point].modes;
  const found = modes.findIndex((m, k) => m.name === wanted || String(k) === wanted);
  mode = Math.max(0, found >= 0 ? found : modes.findIndex((m) => m.im > 0));
  chosen();
}

// ---- time

// One second of the page is `base` seconds of the motion at speed 1: short and long motions are stretched.
function setBase() {
  const length = film.window[1] - film.window[0];
  if (data.kind === "run") state.base = length < 1.5 ? length / 6 : length > 120 ? length / 60 : 1;
  else state.base = film.oscillates && length > 0.8 && length < 4 ? 1 : length / (film.oscillates ? 1.6 : 4);
  rate();
}

function rate() {
  state.rate = state.base * 10 ** Number($("speed").value);
  $("rate").textContent = `× ${short(state.rate, 2)}`;
}

function restart() {
  [state.time, state.total] = [film.window[0], film.window[0]];
  jump();
}

function jump() {
  state.dirty = state.jumps = true;
}

function go(t) {
  const [start, end] = film.window;
  const to = Math.max(start, Math.min(end, t));
  state.total += to - state.time;
  state.time = to;
  if (data.kind === "run") state.total = to;
  jump();
}

function play(on) {
  state.playing = on;
  $("play").textContent = on ? "❚❚" : "▶";
}

function advance(passed) {
  const [start, end] = film.window, step = passed * state.rate;
  state.time += step;
  state.total += step;
  if (state.time <= end) return;
  const seamless = data.kind === "modes" && film.oscillates && !film.fades;
  state.time = seamless ? start + ((state.time - start) % (end - start)) : start;
  if (!seamless) {
    state.total = start;
    jump();
  }
}

let last;
function tick(now) {
  const passed = Math.min((now - (last ?? now)) / 1000, 0.1);
  last = now;
  if (state.playing) advance(passed);
  if (state.playing || state.dirty) show(passed);
  requestAnimationFrame(tick);
}

function show(passed) {
  if (painter) paint(passed, state.jumps);
  $("slider").value = state.time;
  const digits = film.window[1] - film.window[0] < 1 ? 4 : film.window[1] > 1000 ? 1 : 2;
  $("clock").textContent = `${state.time.toFixed(digits)} s`;
  if (plots.length) {
    const [k, share] = film.sample(state.time);
    for (const p of plots) p.move(state.time, k, share);
  }
  if (phasors.length) {
    const [size, phase] = film.state(state.time);
    for (const p of phasors) if (p.list) p.draw(film.amplitude, phase, size);
  }
  state.dirty = state.jumps = false;
}

// ---- controls

function controls() {
  $("play").addEventListener("click", () => play(!state.playing));
  $("slider").addEventListener("input", (e) => go(Number(e.target.value)));
  $("speed").addEventListener("input", rate);
  const group = (host, names, pressed, act) => {
    for (const [name, label] of Object.entries(names)) {
      const b = element("button", $(host), label);
      b.addEventListener("click", () => {
        act(name);
        update();
      });
      b.dataset.name = name;
    }
    const update = () => [...$(host).children].forEach((b) => b.setAttribute("aria-pressed", pressed(b.dataset.name)));
    update();
    return update;
  };
  const views = group("views", VIEWS, (name) => camera?.view === name, (name) => {
    camera?.set(name);
    jump();
  });
  const shown = { forces: "Forces", tracks: "Tracks", bodies: "Masses", centers: "Centers" };
  if (!film.strongest) delete shown.forces;
  group("layers", shown, (name) => layers[name], (name) => {
    layers[name] = !layers[name];
    legend();
    state.dirty = true;
  });
  $("theme").addEventListener("click", () => theme(dark() ? "light" : "dark"));
  document.addEventListener("keydown", (e) => {
    if (["SELECT", "INPUT"].includes(e.target.tagName) || e.ctrlKey || e.metaKey || e.altKey) return;
    const step = (e.shiftKey ? 10 : 1) * STEP * state.rate;
    const keys = {
      " ": () => play(!state.playing),
      ArrowRight: () => go(state.time + step),
      ArrowLeft: () => go(state.time - step),
      Home: () => go(film.window[0]),
      End: () => go(film.window[1]),
      ArrowUp: () => faster(0.1),
      ArrowDown: () => faster(-0.1),
    };
    const view = Object.keys(VIEWS)["1234".indexOf(e.key)];
    if (view && camera) {
      camera.set(view);
      views();
      jump();
    } else if (keys[e.key]) {
      if (e.key === " " && e.target.tagName === "BUTTON") return;
      keys[e.key]();
      e.preventDefault();
    }
  });
}

function faster(by) {
  $("speed").value = Number($("speed").value) + by;
  rate();
}

function theme(name) {
  document.documentElement.dataset.theme = name;
  for (const p of plots) p.draw();
  state.dirty = true;
}

function begin() {
  $("title").textContent = data.title;
  $("about").textContent = $("about").title = data.about;
  state.cell = nice(scene.size * 0.18);
  state.perNewton = film.strongest > 0 ? 1 / nice((film.strongest / (0.45 * scene.size)) * 0.5) : 0;
  try {
    painter = new Painter($("view"));
    camera = new Camera(scene, $("view"), () => (state.dirty = true));
    build();
  } catch (error) {
    painter = undefined;
    $("trouble").hidden = false;
    $("trouble").textContent = `${error.message}: the figures beside work all the same`;
  }
  if (data.kind === "run") besideRun();
  else besideModes();
  if (request.get("view") in VIEWS) camera?.set(request.get("view"));
  controls();
  [$("slider").min, $("slider").max] = film.window;
  setBase();
  const system = window.matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
  theme(request.get("theme") ?? system);
  legend();
  play(!request.has("time"));
  if (request.has("time")) {
    state.total = 0;
    go(Number(request.get("time")));
    // an address may ask for a later time of a motion that repeats
    if (data.kind === "modes") state.total = Number(request.get("time"));
  }
  new ResizeObserver(() => {
    for (const p of plots) p.draw();
    state.dirty = true;
  }).observe(document.body);
  show(0);
  document.documentElement.dataset.ready = "true";
  requestAnimationFrame(tick);
}

begin();
