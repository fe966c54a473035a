// Where everything is at a time: a recorded motion, or a mode about a steady state.

const WORLD = { p: [0, 0, 0], q: IDENTITY };
// Most points of a track.
const TRACK = 800;

// Poses of all bodies in one frame of an array of seven numbers per body.
function frame(array, bodies, k) {
  const poses = [WORLD];
  for (let b = 0; b < bodies - 1; b++) {
    const at = 7 * (k * (bodies - 1) + b);
    poses.push({ p: [...array.subarray(at, at + 3)], q: [...array.subarray(at + 3, at + 7)] });
  }
  return poses;
}

const placed = ({ p, q }, point) => add(p, turned(q, point));

// Where a round body touches the level ground: the lowest point of its crown.
function touching({ body, center, axis, radius, crown }, poses) {
  const n = turned(poses[body].q, axis), c = placed(poses[body], center);
  const x = unit(cross(n, [0, 0, 1])), e = cross(x, n);
  const cosine = Math.hypot(n[0], n[1]), sine = n[2];
  return sub(c, add(scale(e, radius - crown + crown * cosine), scale(n, crown * sine)));
}

class Recorded {
  constructor({ scene, count, time, poses, contacts }) {
    this.scene = scene;
    this.count = count;
    this.bodies = scene.bodies.length;
    this.time = numbers(time);
    this.poses = numbers(poses);
    this.contacts = numbers(contacts);
    this.start = this.time[0];
    this.end = this.time[count - 1];
    this.strongest = 0;
    for (let k = 0; k < this.contacts.length; k += 9) {
      this.strongest = Math.max(this.strongest, norm(this.contacts.subarray(k + 3, k + 6)) || 0);
    }
  }

  get window() {
    return [this.start, this.end];
  }

  // The sample before a time and the share of the way to the next.
  sample(t) {
    let [low, high] = [0, this.count - 1];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (this.time[middle] <= t) low = middle;
      else high = middle;
    }
    const span = this.time[high] - this.time[low];
    return [low, span > 0 ? Math.max(0, Math.min(1, (t - this.time[low]) / span)) : 0];
  }

  at(t) {
    const [k, share] = this.sample(t);
    const a = frame(this.poses, this.bodies, k), b = frame(this.poses, this.bodies, Math.min(k + 1, this.count - 1));
    const poses = a.map((pose, i) => ({ p: mix(pose.p, b[i].p, share), q: between(pose.q, b[i].q, share) }));
    const contacts = this.scene.contacts.map((_, c) => {
      const numbers = mix(this.contact(k, c), this.contact(Math.min(k + 1, this.count - 1), c), share);
      return { point: numbers.slice(0, 3), normal: numbers.slice(3, 6), friction: numbers.slice(6, 9) };
    });
    return { poses, contacts };
  }

  contact(k, c) {
    const at = 9 * (k * this.scene.contacts.length + c);
    return [...this.contacts.subarray(at, at + 9)];
  }

  // Points of the whole way, thinned evenly: of the contacts, or else of the mass centers.
  get way() {
    if (this.kept) return this.kept;
    const stride = Math.ceil(this.count / TRACK), samples = [];
    for (let k = 0; k < this.count; k += stride) samples.push(k);
    const { contacts } = this.scene;
    if (contacts.length) this.kept = contacts.map((_, c) => samples.map((k) => this.contact(k, c).slice(0, 3)));
    else {
      this.centers = this.scene.bodies.map((b) => b.shapes.find((s) => s.kind === "center")?.at);
      const frames = samples.map((k) => frame(this.poses, this.bodies, k));
      this.kept = this.centers.map((at, b) => (at ? frames.map((poses) => placed(poses[b], at)) : []));
    }
    this.stride = stride;
    return this.kept;
  }

  // Ways up to a time.
  tracks(t, _, now) {
    const way = this.way, behind = Math.floor(this.sample(t)[0] / this.stride) + 1;
    const here = (c) => (this.scene.contacts.length ? now.contacts[c].point : placed(now.poses[c], this.centers[c]));
    return way.map((points, c) => (points.length ? [...points.slice(0, behind), here(c)] : []));
  }
}

class Mode {
  constructor({ scene, points }) {
    this.scene = scene;
    this.bodies = scene.bodies.length;
    this.points = points;
    this.strongest = 0;
    Object.assign(this, { amplitude: 0.12, travels: true, fades: false, path: true });
    this.choose(0, 0);
  }

  choose(point, mode) {
    this.point = this.points[point];
    this.mode = this.point.modes[Math.min(mode, this.point.modes.length - 1)];
    this.steady = frame(numbers(this.point.poses), this.bodies, 0);
    this.twists = numbers(this.mode.twists);
    const { re, im } = this.mode;
    this.period = im > 0 ? (2 * Math.PI) / im : 0;
    this.oscillates = im > 0;
    this.length = this.oscillates ? this.period : 3 / Math.max(Math.abs(re), 1e-3);
  }

  // Oscillations repeat; what only fades or grows is shown over three time constants.
  get window() {
    const { re } = this.mode;
    const faded = this.fades && Math.abs(re) > 1e-6 ? Math.min(6 * this.length, Math.max(this.length, 3 / Math.abs(re))) : this.length;
    return [0, this.oscillates ? (this.fades ? faded : this.length) : this.length];
  }

  // Factor of the amplitude, and phase.
  state(t) {
    const { re, im } = this.mode, end = this.window[1];
    const bound = this.fades || !this.oscillates;
    return [bound ? Math.exp(re * (re > 0 ? t - end : t)) : 1, im * t];
  }

  // Steady motion of the moving frame.
  moving(t) {
    if (!this.travels) return WORLD;
    const [vx, vy, r] = this.point.velocity, a = r * t;
    const [s, c] = Math.abs(a) > 1e-6 ? [Math.sin(a) / r, (1 - Math.cos(a)) / r] : [t, (r * t * t) / 2];
    return { p: [vx * s - vy * c, vx * c + vy * s, 0], q: about([0, 0, 1], a) };
  }

  // local: time in the window; t: time that never returns.
  at(local, t = local) {
    const [size, phase] = this.state(local), a = this.amplitude * size;
    const [c, s] = [a * Math.cos(phase), a * Math.sin(phase)];
    const real = ([re, im]) => c * re - s * im;
    let base = this.moving(t);
    if (this.path) {
      const [x, y, heading] = this.mode.path.map(real);
      base = { p: placed(base, [x, y, 0]), q: product(base.q, about([0, 0, 1], heading)) };
    }
    const part = (b, k) => [0, 1, 2].map((i) => c * this.twists[12 * (b - 1) + k + i] - s * this.twists[12 * (b - 1) + 6 + k + i]);
    const poses = this.steady.map((pose, b) => {
      if (b === 0) return WORLD;
      const q = product(byVector(part(b, 0)), pose.q), p = add(pose.p, part(b, 3));
      return { p: placed(base, p), q: product(base.q, q) };
    });
    this.point.spins.forEach(({ body, axis, rate }, k) => {
      const angle = (this.travels ? rate * t : 0) + real(this.mode.spins[k]);
      poses[body].q = product(poses[body].q, about(axis, angle));
    });
    return { poses, contacts: [] };
  }

  tracks(local, t = local) {
    const [vx, vy] = this.point.velocity, speed = Math.hypot(vx, vy);
    if (!this.travels || speed < 1e-3 || !this.scene.contacts.length) return [];
    const span = Math.min((9 * this.scene.size) / speed, t), tracks = this.scene.contacts.map(() => []);
    for (let k = 0; k <= 160; k++) {
      const back = span * (1 - k / 160);
      // where the window begins anew the way behind is that of the oscillation
      if (local - back < 0 && (this.fades || !this.oscillates)) continue;
      const { poses } = this.at(local - back, t - back);
      this.scene.contacts.forEach((contact, c) => {
        const p = touching(contact, poses);
        tracks[c].push([p[0], p[1], 0]);
      });
    }
    return tracks;
  }
}
