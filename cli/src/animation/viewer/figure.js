// Figures beside the view: signals over time with a moving cursor, phasors of a mode.

// Okabe and Ito, as in the figures of the command.
const CURVES = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a7f87"];

function element(tag, parent, text, attributes = {}) {
  const e = document.createElement(tag);
  if (text !== undefined) e.textContent = text;
  for (const [name, value] of Object.entries(attributes)) e.setAttribute(name, value);
  parent.append(e);
  return e;
}

const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// A short decimal number.
function short(x, digits = 4) {
  if (!Number.isFinite(x)) return "–";
  const size = Math.abs(x);
  if (size >= 10 ** digits && size < 1e5) return x.toFixed(0);
  const text = size >= 1e5 || (size < 1e-3 && x !== 0) ? x.toExponential(digits - 2) : x.toPrecision(digits);
  return text.includes(".") && !text.includes("e") ? text.replace(/0+$/, "").replace(/\.$/, "") : text;
}

// Round values in an interval, about `count` of them.
function ticks(low, high, count) {
  const rough = (high - low) / count || 1;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].find((m) => m * power >= rough) * power;
  const list = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) list.push(Math.abs(k * step) < 1e-12 * step ? 0 : k * step);
  return list;
}

function sheet(canvas) {
  const ratio = window.devicePixelRatio || 1, w = canvas.clientWidth, h = canvas.clientHeight;
  [canvas.width, canvas.height] = [Math.round(w * ratio), Math.round(h * ratio)];
  const pen = canvas.getContext("2d");
  pen.scale(ratio, ratio);
  pen.font = "10.5px 'DejaVu Sans', 'Segoe UI', system-ui, sans-serif";
  return [pen, w, h];
}

class Plot {
  constructor(parent, { name, unit, about, values }, time, color, seek) {
    const box = element("div", parent, undefined, { class: "plot", title: about });
    const head = element("p", box);
    element("b", head, name);
    this.value = element("span", head);
    this.canvas = element("canvas", box);
    this.cursor = element("div", box);
    [this.time, this.values, this.unit, this.color] = [time, numbers(values), unit, color];
    const at = (e) => {
      const box = this.canvas.getBoundingClientRect();
      const share = (e.clientX - box.left - this.left) / (box.width - this.left - this.right);
      seek(this.time[0] + Math.max(0, Math.min(1, share)) * (this.time[this.time.length - 1] - this.time[0]));
    };
    this.canvas.addEventListener("pointerdown", (e) => {
      this.canvas.setPointerCapture(e.pointerId);
      at(e);
    });
    this.canvas.addEventListener("pointermove", (e) => e.buttons && at(e));
    [this.left, this.right] = [54, 8];
  }

  draw() {
    const [pen, w, h] = sheet(this.canvas);
    const [top, bottom] = [5, 18];
    const finite = this.values.filter(Number.isFinite);
    let low = finite.reduce((a, b) => Math.min(a, b), Infinity), high = finite.reduce((a, b) => Math.max(a, b), -Infinity);
    if (!(high >= low)) [low, high] = [-1, 1];
    // what varies by rounding only is a level line
    const least = Math.max(1e-6 * Math.max(Math.abs(low), Math.abs(high)), 1e-7);
    const room = high - low > least ? 0.07 * (high - low) : Math.max(0.1 * Math.abs(high), least);
    [low, high] = [low - room, high + room];
    const [start, end] = [this.time[0], this.time[this.time.length - 1]];
    const x = (t) => this.left + ((t - start) / (end - start || 1)) * (w - this.left - this.right);
    const y = (v) => top + (1 - (v - low) / (high - low)) * (h - top - bottom);
    pen.fillStyle = style("--paper");
    pen.fillRect(this.left, top, w - this.left - this.right, h - top - bottom);
    pen.lineWidth = 1;
    pen.strokeStyle = style("--grid");
    pen.fillStyle = style("--faint");
    pen.textBaseline = "middle";
    pen.textAlign = "right";
    for (const v of ticks(low, high, 3)) {
      line(pen, [[this.left, y(v)], [w - this.right, y(v)]]);
      pen.fillText(short(v, 4), this.left - 5, y(v));
    }
    pen.textAlign = "center";
    for (const t of ticks(start, end, 5)) {
      line(pen, [[x(t), top], [x(t), h - bottom]]);
      pen.fillText(short(t, 3), Math.min(x(t), w - 14), h - bottom + 9);
    }
    pen.strokeStyle = style("--faint");
    pen.strokeRect(this.left, top, w - this.left - this.right, h - top - bottom);
    pen.save();
    pen.beginPath();
    pen.rect(this.left, top, w - this.left - this.right, h - top - bottom);
    pen.clip();
    pen.strokeStyle = this.color;
    pen.lineWidth = 1.6;
    pen.lineJoin = "round";
    line(pen, Array.from(this.values, (v, k) => [x(this.time[k]), y(v)]));
    pen.restore();
    this.x = x;
  }

  move(t, k, share) {
    this.cursor.style.left = `${this.x(t)}px`;
    const v = this.values[k] + share * ((this.values[k + 1] ?? this.values[k]) - this.values[k]);
    this.value.textContent = `${short(v)} ${this.unit}`;
  }
}

function line(pen, points) {
  pen.beginPath();
  points.forEach(([x, y], k) => (k ? pen.lineTo(x, y) : pen.moveTo(x, y)));
  pen.stroke();
}

// Arrows in the complex plane, turned by the phase: angles in one plane, lengths in another.
class Phasors {
  constructor(parent, unit) {
    this.unit = unit;
    this.head = element("h2", parent, unit === "mm" ? "displacements" : "angles");
    this.canvas = element("canvas", parent, undefined, { class: "phasor" });
    this.key = element("ul", parent, undefined, { class: "key" });
  }

  show(list) {
    this.list = list;
    this.head.hidden = this.canvas.hidden = !list.length;
    this.key.replaceChildren();
    list.forEach((p, k) => {
      const row = element("li", this.key);
      element("i", row).style.background = CURVES[k % CURVES.length];
      row.append(p.name);
      element("span", row);
    });
  }

  draw(amplitude, turn, size) {
    if (!this.list.length) return;
    const [pen, w, h] = sheet(this.canvas);
    const largest = Math.max(...this.list.map((p) => Math.hypot(p.re, p.im)), 1e-30);
    const r = h / 2 - 14, [cx, cy] = [w / 2, h / 2];
    pen.strokeStyle = style("--grid");
    for (const part of [0.5, 1]) {
      pen.beginPath();
      pen.arc(cx, cy, part * r, 0, 2 * Math.PI);
      pen.stroke();
    }
    line(pen, [[cx - r, cy], [cx + r, cy]]);
    line(pen, [[cx, cy - r], [cx, cy + r]]);
    pen.fillStyle = style("--faint");
    pen.textBaseline = "middle";
    pen.fillText(`${short(amplitude * largest, 3)} ${this.unit}`, cx + 0.72 * r + 6, cy - 0.72 * r - 4);
    pen.fillText("Re", cx + r + 4, cy);
    pen.fillText("Im", cx - 6, cy - r - 8);
    this.list.forEach((p, k) => {
      const [c, s] = [Math.cos(turn), Math.sin(turn)];
      const z = [((p.re * c - p.im * s) / largest) * r, ((p.re * s + p.im * c) / largest) * r].map((x) => x * size);
      pen.strokeStyle = pen.fillStyle = CURVES[k % CURVES.length];
      pen.lineWidth = 2.2;
      arrow(pen, cx, cy, cx + z[0], cy - z[1]);
      // magnitude and phase
      const phase = (Math.atan2(p.im, p.re) * 180) / Math.PI;
      this.key.children[k].lastChild.textContent = `${short(amplitude * Math.hypot(p.re, p.im), 3)} ${p.unit} at ${phase.toFixed(0)}°`;
    });
  }
}

function arrow(pen, x0, y0, x1, y1) {
  line(pen, [[x0, y0], [x1, y1]]);
  const length = Math.hypot(x1 - x0, y1 - y0), head = Math.min(8, length);
  if (length < 1) return;
  const [ux, uy] = [(x1 - x0) / length, (y1 - y0) / length];
  pen.beginPath();
  pen.moveTo(x1, y1);
  pen.lineTo(x1 - head * ux - 0.45 * head * uy, y1 - head * uy + 0.45 * head * ux);
  pen.lineTo(x1 - head * ux + 0.45 * head * uy, y1 - head * uy - 0.45 * head * ux);
  pen.fill();
}
