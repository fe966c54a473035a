// What stands beside the view: signals of a motion, or the choice of a mode with its phasors.

const plots = [];
const phasors = [];

function besideRun() {
  data.plots.forEach((p, k) => plots.push(new Plot($("beside"), p, film.time, CURVES[k % CURVES.length], go)));
}

// A line with a label; the rest is put into it.
function row(label) {
  const line = element("label", $("beside"), undefined, { class: "row" });
  element("span", line, label);
  return line;
}

function select(label, options, changed) {
  const list = element("select", row(label));
  offer(list, options);
  list.addEventListener("change", () => changed(Number(list.value)));
  return list;
}

function offer(list, options) {
  list.replaceChildren();
  options.forEach((text, k) => element("option", list, text, { value: k }));
}

// `weave, 2.25 Hz`
const called = (m) => `${m.name}, ${m.im > 0 ? `${short(m.hz, 3)} Hz` : `${short(m.re, 3)} 1/s`}`;

function facts(m) {
  const stability = m.re > 1e-6 ? "grows: unstable" : m.re < -1e-6 ? "fades: stable" : "neutral";
  return [
    ...(m.im > 0 ? [["damped frequency", `${short(m.hz)} Hz`]] : []),
    ["eigenvalue", `${short(m.re)}${m.im > 0 ? ` ± ${short(m.im)} j` : ""} 1/s`],
    ["damping ratio", short(m.damping, 3)],
    ["", stability],
  ];
}

function tell(table, rows) {
  table.replaceChildren();
  for (const [name, value] of rows) {
    const line = element("tr", table);
    element("td", line, name);
    element("td", line, value);
  }
}

// The mode that the address asks for by name or number, or else the first oscillation.
function firstMode(modes) {
  const wanted = request.get("mode");
  const found = modes.findIndex((m, k) => m.name === wanted || String(k) === wanted);
  return Math.max(0, found >= 0 ? found : modes.findIndex((m) => m.im > 0));
}

function besideModes() {
  const host = $("beside"), last = data.points.length - 1;
  let point = Math.max(0, Math.min(Number(request.get("point") ?? 0), last)), mode;
  const modes = () => data.points[point].modes;
  if (last > 0) {
    const points = select("steady state", data.points.map((p) => p.label), (k) => {
      const before = modes()[mode].name;
      point = k;
      offer(list, modes().map(called));
      choose(Math.max(0, modes().findIndex((m) => m.name === before)));
    });
    points.value = String(point);
  } else element("h2", host, data.points[0].label);
  const list = select("mode", modes().map(called), (k) => choose(k));
  const table = element("table", host);
  amplitude();
  // a mechanism on a fixed base has neither
  const path = scene.follows !== null && select("path of the mode", ["shown", "left out"], (k) => {
    film.path = k === 0;
    state.dirty = true;
  });
  if (path) {
    select("moving frame", ["travels with the vehicle", "stays"], (k) => {
      film.travels = k === 0;
      restart();
    });
  }
  select("amplitude in time", ["constant", "fades or grows"], (k) => {
    film.fades = k === 1;
    $("slider").max = film.window[1];
    restart();
  });
  const radians = data.points.some((p) => p.modes.some((m) => m.phasors.some((x) => x.unit === "rad")));
  phasors.push(new Phasors(host, radians ? "rad" : "deg"), new Phasors(host, "mm"));
  const choose = (k) => {
    mode = k;
    list.value = String(k);
    film.choose(point, k);
    // slow motions travel far: their path is left out at first
    film.path = film.mode.im > 1;
    if (path) path.value = film.path ? "0" : "1";
    tell(table, facts(film.mode));
    for (const p of phasors) p.show(film.mode.phasors.filter((x) => x.unit === p.unit));
    $("slider").max = film.window[1];
    setBase();
    restart();
  };
  choose(firstMode(modes()));
}

function amplitude() {
  const line = row("amplitude");
  const slider = element("input", line, undefined, { type: "range", min: 0, max: 0.5, step: "any" });
  const told = element("output", line);
  const set = (a) => {
    film.amplitude = a;
    slider.value = a;
    told.textContent = `${((a * 180) / Math.PI).toFixed(1)}°`;
    state.dirty = true;
  };
  slider.addEventListener("input", () => set(Number(slider.value)));
  set(Number(request.get("amplitude") ?? film.amplitude));
}
