// A camera that stands at a distance from a target: azimuth from north over east, elevation above the horizon [degrees], lengths in metres.

const radians = Math.PI / 180;
const add = (a, b, k) => a.map((v, i) => v + k * b[i]);

export class OrbitCamera {
  constructor(start) {
    this.home = { fov: 35, azimuth: 150, elevation: 25, distance: 1, target: [0, 0, 0], ...start };
    this.orthographic = false;
    this.fit = 1;
    this.reset();
  }
  reset() {
    const { by_width: _, ...start } = this.home;
    Object.assign(this, start, { target: [...this.home.target] });
  }
  axes() {
    const a = this.azimuth * radians, e = this.elevation * radians;
    const out = [Math.sin(a) * Math.cos(e), Math.cos(a) * Math.cos(e), Math.sin(e)];
    const right = [-Math.cos(a), Math.sin(a), 0];
    const up = [out[1] * right[2] - out[2] * right[1], out[2] * right[0] - out[0] * right[2], out[0] * right[1] - out[1] * right[0]];
    return { out, right, up };
  }
  /// Steps back where the picture is narrow, so that what is framed stays inside.
  fitTo(aspect) { this.fit = Math.max(1, (this.home.by_width ?? 0) / (aspect * this.home.distance)); }
  /// Height of the picture at the target.
  span() { return 2 * this.distance * this.fit * Math.tan(0.5 * this.fov * radians); }
  turn(degreesAround, degreesUp) {
    this.azimuth = (((this.azimuth + degreesAround) % 360) + 360) % 360;
    this.elevation = Math.min(89.9, Math.max(-89.9, this.elevation + degreesUp));
  }
  /// By parts of the picture's height, to the right and up.
  move(right, up) {
    const axes = this.axes();
    this.target = add(add(this.target, axes.right, -right * this.span()), axes.up, -up * this.span());
  }
  /// Towards a point of the picture, in parts of its height from the middle.
  zoom(factor, right = 0, up = 0) {
    const before = this.span();
    this.distance = Math.min(1e9, Math.max(1e-5, this.distance * factor));
    const axes = this.axes(), lost = before - this.span();
    this.target = add(add(this.target, axes.right, right * lost), axes.up, up * lost);
  }
  look(view) {
    if (view === "home") this.reset();
    if (view === "top") Object.assign(this, { azimuth: 180, elevation: 89.9 });
    if (view === "south") Object.assign(this, { azimuth: 180, elevation: 5 });
    if (view === "east") Object.assign(this, { azimuth: 90, elevation: 5 });
  }
  /// Brings a box to the middle, a few times as large as it.
  goTo(low, high) {
    this.target = low.map((v, i) => 0.5 * (v + high[i]));
    const size = Math.hypot(...low.map((v, i) => high[i] - v));
    this.distance = Math.min(this.home.distance, Math.max(size * 4, 1e-4) / (2 * Math.tan(0.5 * this.fov * radians)));
  }
  parameters() {
    return { azimuth: this.azimuth.toFixed(4), elevation: this.elevation.toFixed(4), distance: this.distance * this.fit, target: this.target.join(","), fov: this.fov, orthographic: this.orthographic };
  }
}
