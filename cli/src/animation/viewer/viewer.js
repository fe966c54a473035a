// Puts data, view, figures and controls together.

const data = JSON.parse(document.getElementById("data").textContent);
const $ = (id) => document.getElementById(id);
// Frames shown per second of the film where a key steps.
const STEP = 1 / 60;

const film = data.kind === "run" ? new Recorded(data) : new Mode(data);
const scene = data.scene;
const state = { time: film.window[0], total: 0, playing: true, base: 1, dirty: true };
const layers = { forces: true, tracks: true, bodies: true, centers: false };
const request = new URLSearchParams(location.hash.slice(1));
const dark = () => document.documentElement.dataset.theme === "dark";

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
  const names = scene.follows === null ? { ...VIEWS, follow: "Oblique" } : VIEWS;
  const views = group("views", names, (name) => camera?.view === name, (name) => {
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
  keyboard(views);
}

function keyboard(views) {
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
  state.perNewton = film.strongest > 0 ? 1 / nice((film.strongest / (0.45 * scene.size)) * 0.5) : 0;
  try {
    painter = new Painter($("view"));
    camera = new Camera(scene, $("view"), () => (state.dirty = true));
    state.cell = nice(camera.size * 0.18);
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
