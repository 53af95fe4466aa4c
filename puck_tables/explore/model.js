"use strict";
// What is shown: one puck and one launch, and all that follows from them, by the exported look-ups or on a drawn base.
const GRAVITY = 9.80665;
const STATES = 200;
const FIELDS = {  // label, unit, least, largest, digits of a step
  speed: ["speed", "m/s", 0, 5, 3],
  heading: ["heading", "°", -180, 180, 1],
  spin: ["spin", "rad/s", -150, 150, 2],
  radius: ["radius", "mm", 5, 200, 1],
  height: ["height", "mm", 0, 200, 1],
  friction: ["friction", "", 0.01, 1, 3],
  moment: ["time", "%", 0, 100, 0],
};
const now = { law: "uniform", speed: 2, heading: 10, spin: 60, radius: 38.1, height: 25.4, friction: 0.1, moment: 0, target: null };
const five = new Float64Array(5), six = new Float64Array(6), three = new Float64Array(3);

// Its law (title, gyration, tallest delta) and its look-ups, and the points of a map along a side: all are in puckLaws.
for (const one of Object.values(puckLaws)) one.map = 60;
puckLaws.drawn = { title: "a base you draw", tallest: 0, tables: drawnTables, map: 20 };
const law = () => puckLaws[now.law];

const scale = () => {
  const radius = now.radius / 1000, delta = Math.min(law().tallest, 2 * now.friction * now.height / now.radius);
  return { radius, decel: now.friction * GRAVITY, delta };
};

// Where the puck stops that has this speed (m/s) along the heading and this spin: time s, x, y m, path m, turn rad.
function stopOf(speed, spin) {
  const { radius, decel, delta } = scale(), a = now.heading * Math.PI / 180;
  law().tables.stop(speed * Math.cos(a), speed * Math.sin(a), spin, delta, decel, radius, five);
  return five;
}

// The run: states over time, the stop, and what the base carries at the moment that is looked at.
function run() {
  const { radius, decel, delta } = scale();
  const a = now.heading * Math.PI / 180, vx = now.speed * Math.cos(a), vy = now.speed * Math.sin(a);
  const code = law().tables.stop(vx, vy, now.spin, delta, decel, radius, five);
  if (code !== 0) return { code };
  const [time, x, y, path, turn] = five;
  const states = [];
  for (let n = 0; n <= STATES; n++) {
    const left = 1 - n / STATES, t = time * (1 - left * left);  // closer towards the stop
    states.push([t, ...stateAt(vx, vy, t)]);
  }
  const t = time * now.moment / 100, moment = stateAt(vx, vy, t).slice();
  return { code, time, x, y, path, turn, states, moment, t, tilt: tiltOf(moment) };
}

function stateAt(vx, vy, t) {
  const { radius, decel, delta } = scale();
  law().tables.state(vx, vy, now.spin, delta, decel, radius, t, six);
  return six;
}

// What the base carries at rest at a distance from its middle, over the most that it carries; its hole.
const LOADS = { "hertz": (rho) => Math.sqrt(1 - rho * rho) }, evenly = () => 1;
const HOLES = { "annulus:0.8": 0.8, "ring": 0.94 };  // the ring is a line, drawn so broad that it is seen

// How far friction tips the load: slopes of the pressure over that at rest, along x and y, per radius.
function tiltOf([, , , vx, vy, spin]) {
  const { radius, delta } = scale(), share = delta > 0 ? delta / law().tallest : 0;
  const v = Math.hypot(vx, vy), phi = Math.atan2(radius * spin, v);
  if (v === 0 || share === 0) return [0, 0];
  law().tables.resultants(phi, delta, three);
  const along = share * Math.cos(phi) * three[0], left = share * Math.sin(phi) * Math.cos(phi) * three[1];
  return [(along * vx - left * vy) / v, (along * vy + left * vx) / v];
}

// Speed and heading that stop at a place with the spin that is set: the distance of a stop grows with
// the speed, and turning the launch turns all of its motion; nearly so on a drawn base, which stays as it lies.
function aimAt(x, y) {
  const far = Math.hypot(x, y), top = FIELDS.speed[3], rounds = now.law === "drawn" ? 6 : 1;
  for (let round = 0; round < rounds; round++) {
    const miss = (speed) => Math.hypot(...stopOf(speed, now.spin).slice(1, 3)) - far;
    let [less, more, under, over] = [0, top, miss(0), miss(top)];
    if (over < 0) return false;
    for (let n = 0; n < 60 && more - less > 1e-12 * top; n++) {  // false position, halved where an end stays (Illinois)
      const middle = n % 3 === 2 ? 0.5 * (less + more) : less + (more - less) * under / (under - over), off = miss(middle);
      if (off < 0) [less, under] = [middle, off]; else [more, over] = [middle, off];
    }
    const end = stopOf(more, now.spin);
    now.speed = more;
    now.heading = turned(now.heading + (Math.atan2(y, x) - Math.atan2(end[2], end[1])) * 180 / Math.PI);
  }
  return true;
}

const turned = (degrees) => degrees - 360 * Math.round(degrees / 360);

// Stop times over speed and spin, count x count, up to the most that the page shows.
function stopTimes(fastest, most, count) {
  drawn.share = ROUGH;
  const times = Float64Array.from({ length: count * count }, (_, n) =>
    stopOf(fastest * (n % count) / (count - 1), most * (1 - 2 * Math.floor(n / count) / (count - 1)))[0]);
  drawn.share = SHARE;
  return times;
}

// Only as tall as the base stays loaded in every motion: delta = 2 f h / r up to 1 under uniform pressure.
const tallest = () => law().tallest * now.radius / (2 * now.friction);

function setLaw(name) {
  if (!Object.hasOwn(puckLaws, name)) return;
  now.law = name;
  now.height = Math.min(now.height, tallest());
  if (name === "drawn" && !drawn.corners.length) takeCorners(SHAPES.box);
}

// Draw a base of corners in mm; false where they are none, or none of a size that the page shows.
function setCorners(corners) {
  const [, , low, high] = FIELDS.radius, before = { ...drawn }, unit = takeCorners(corners);
  if (!(unit >= low && unit <= high)) {
    Object.assign(drawn, before);
    return false;
  }
  now.radius = unit;
  now.target = null;
  setLaw("drawn");
  return true;
}

function set(name, value) {
  const [, , low, high] = FIELDS[name];
  if (!Number.isFinite(value)) return;
  now[name] = Math.min(high, Math.max(low, name === "heading" ? turned(value) : value));
  now.height = Math.min(now.height, tallest());
}
