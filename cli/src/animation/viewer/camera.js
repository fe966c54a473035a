// The camera: follows at a distance with some delay, from the side, from above, or freely; mouse, touch and wheel move it.

const VIEWS = { follow: "Follow", side: "Side", top: "Top", free: "Free" };
// Time in which a following camera catches up, s of the film.
const DELAY = 0.35;

class Camera {
  // still: the box of a scene in which nothing travels; its thinnest direction is looked along.
  constructor(scene, canvas, moved) {
    this.scene = scene;
    this.travels = scene.follows !== null;
    const [low, high] = scene.box;
    this.middle = scale(add(low, high), 0.5);
    const extent = sub(high, low);
    this.size = this.travels ? scene.size : Math.max(norm(extent), scene.size);
    const least = Math.min(...extent);
    // a plane mechanism shows itself across its plane
    this.thin = least < 0.25 * Math.max(...extent) ? extent.indexOf(least) : null;
    this.distance = 1.0;
    this.set(this.travels || this.thin === null ? "follow" : this.thin === 2 ? "top" : "side");
    this.listen(canvas, moved);
  }

  set(view) {
    // a free camera goes on from where the last one stood
    const turned = this.turns ? this.heading || 0 : 0;
    this.view = view;
    const along = this.travels || this.thin !== 0 ? -Math.PI / 2 : 0;
    const angles = {
      follow: this.travels ? [Math.PI + 0.62, 0.3] : [along - 0.5, 0.32],
      side: [along, this.travels ? 0.06 : 0.0],
      top: [along, 1.5707],
      free: [(this.yaw ?? along) + turned, this.pitch ?? 0.3],
    };
    [this.yaw, this.pitch] = angles[view];
  }

  // Whether it turns with what it follows.
  get turns() {
    return this.view === "follow" || this.view === "side";
  }

  // target: what is followed; jump: no delay.
  follow(target, heading, passed, jump) {
    if (!this.travels) [target, heading] = [this.middle, 0];
    if (this.target === undefined || jump) [this.target, this.heading] = [target, heading];
    const t = 1 - Math.exp(-passed / DELAY);
    this.target = target;
    const turn = Math.atan2(Math.sin(heading - this.heading), Math.cos(heading - this.heading));
    this.heading += (this.view === "follow" ? t : 1) * turn;
  }

  // Matrix and eye relative to the target.
  look(aspect) {
    const yaw = this.yaw + (this.turns ? this.heading : 0);
    const wide = Math.min(1, aspect);
    const d = (this.distance * this.size * 2) / wide;
    const eye = [d * Math.cos(this.pitch) * Math.cos(yaw), d * Math.cos(this.pitch) * Math.sin(yaw), d * Math.sin(this.pitch)];
    const up = this.pitch > 1.5 ? [-Math.cos(yaw), -Math.sin(yaw), 0] : [0, 0, 1];
    this.axes = looking(eye, [0, 0, 0], up);
    return { matrix: times(perspective(0.6, aspect, d / 80, d * 40), this.axes), eye, distance: d };
  }

  listen(canvas, moved) {
    const fingers = new Map();
    canvas.addEventListener("pointerdown", (e) => {
      canvas.setPointerCapture(e.pointerId);
      fingers.set(e.pointerId, [e.clientX, e.clientY]);
    });
    const lifted = (e) => fingers.delete(e.pointerId);
    canvas.addEventListener("pointerup", lifted);
    canvas.addEventListener("pointercancel", lifted);
    const apart = () => {
      const [a, b] = [...fingers.values()];
      return Math.hypot(a[0] - b[0], a[1] - b[1]);
    };
    canvas.addEventListener("pointermove", (e) => {
      const before = fingers.get(e.pointerId);
      if (!before) return;
      if (fingers.size === 2) {
        const was = apart();
        fingers.set(e.pointerId, [e.clientX, e.clientY]);
        this.zoom(was / Math.max(apart(), 1));
      } else {
        fingers.set(e.pointerId, [e.clientX, e.clientY]);
        this.yaw -= (e.clientX - before[0]) * 0.007;
        this.pitch = Math.max(-1.2, Math.min(1.5707, this.pitch + (e.clientY - before[1]) * 0.007));
      }
      moved();
    });
    canvas.addEventListener("wheel", (e) => {
      e.preventDefault();
      this.zoom(Math.exp(e.deltaY * 0.0012));
      moved();
    }, { passive: false });
  }

  zoom(factor) {
    this.distance = Math.max(0.15, Math.min(12, this.distance * factor));
  }
}
