"use strict";
// A base that is drawn: a polygon under uniform pressure, flat on the floor.  Its motion is integrated here, from
// the friction that exported files have (puckBase); its look-ups take what those of round pucks take.
const SHARE = 0.05, ROUGH = 0.2;  // of the slip, and rad: what a step takes at most; where a map is filled
const REST = 1e-7;  // of the slip of the launch: with less it rests
const SHAPES = {
  box: [[-2, -1], [2, -1], [2, 1], [-2, 1]],
  bar: [[-8, -1], [8, -1], [8, 1], [-8, 1]],
  triangle: [[-1, 0], [1, 0], [0, 3 ** 0.5]],
  "L": [[0, 0], [3, 0], [3, 1], [1, 1], [1, 3], [0, 3]],
};
const drawn = { corners: [], frame: [0, 0, 1], square: 0.5, path: null, friction: null, share: SHARE };

const sidesOf = (corners) => corners.map((one, n) => [one, corners[(n + 1) % corners.length]]);
const across = ([ax, ay], [bx, by]) => ax * by - ay * bx;
const from = ([ax, ay], [bx, by]) => [bx - ax, by - ay];

// Whether two sides that do not meet in a corner meet elsewhere.
function crossing(corners) {
  const sides = sidesOf(corners), apart = (a, b, c, d) => across(from(a, b), from(a, c)) * across(from(a, b), from(a, d)) > 0;
  return sides.some(([a, b], n) => sides.some(([c, d], m) =>
    m > n + 1 && (n > 0 || m < sides.length - 1) && !apart(a, b, c, d) && !apart(c, d, a, b)));
}

// Take corners (in any unit, any order round) about the middle of the area, the farthest at 1; returns the unit, the
// distance of the farthest, or 0 where they are no base.  Their radius of gyration is that of an even base.
function takeCorners(given) {
  const twice = sidesOf(given).reduce((sum, [a, b]) => sum + across(a, b), 0);
  const size = Math.max(...given.map(([x, y]) => Math.hypot(x - given[0][0], y - given[0][1])));
  if (given.length < 3 || !(Math.abs(twice) > 1e-4 * size * size) || crossing(given)) return 0;
  const middle = [0, 1].map((k) => sidesOf(given).reduce((sum, [a, b]) => sum + across(a, b) * (a[k] + b[k]), 0) / (3 * twice));
  const about = given.map((one) => from(middle, one)), unit = Math.max(...about.map(([x, y]) => Math.hypot(x, y)));
  const corners = about.map(([x, y]) => [x / unit, y / unit]);
  if (twice < 0) corners.reverse();
  const area = Math.abs(twice) / 2 / unit ** 2, lines = new Float64Array(5 * corners.length);
  let square = 0;
  sidesOf(corners).forEach(([a, b], n) => {
    const [x, y] = from(a, b), long = Math.hypot(x, y);
    lines.set([...a, x / long, y / long, long], 5 * n);
    square += across(a, b) * (a[0] * a[0] + a[0] * b[0] + b[0] * b[0] + a[1] * a[1] + a[1] * b[1] + b[1] * b[1]);
  });
  Object.assign(drawn, { corners, frame: [...middle, unit], square: square / 12 / area, path: null, friction: puckBase(lines, corners.length, area, 1) });
  return unit;
}

// The motion in radii: rows of t, x, y, angle, vx, vy, spin, path and the rates of x to spin, by Runge and Kutta's
// steps of order 4.
function pathOf(vx, vy, spin, decel) {
  const { share, square } = drawn, key = [vx, vy, spin, decel, share].join(), force = new Float64Array(3);
  if (drawn.path?.key === key) return drawn.path;
  const slip = (y) => Math.sqrt(y[4] * y[4] + y[5] * y[5] + square * y[6] * y[6]);
  const rates = (y) => {
    if (drawn.friction(y[4], y[5], y[6], y[3], force) !== 0) force.fill(0);
    return [1, y[4], y[5], y[6], decel * force[0], decel * force[1], decel * force[2] / square, Math.hypot(y[4], y[5])];
  };
  const moved = (y, r, h) => y.map((value, n) => value + h * r[n]);
  let y = [0, 0, 0, 0, vx, vy, spin, 0];
  const rows = [[y, rates(y)]], first = slip(y);
  while (slip(y) > REST * first) {
    const h = share * Math.min(slip(y) / decel, 1 / Math.abs(y[6])), one = rows[rows.length - 1][1];
    const two = rates(moved(y, one, h / 2)), three = rates(moved(y, two, h / 2)), four = rates(moved(y, three, h));
    y = y.map((value, n) => value + h / 6 * (one[n] + 2 * two[n] + 2 * three[n] + four[n]));
    rows.push([y, rates(y)]);
  }
  return (drawn.path = { key, rows });
}

// The state between rows, by cubics through states and rates; after the last it rests.
function between(rows, t) {
  let low = 0, high = rows.length - 1;
  if (t >= rows[high][0][0]) return rows[high][0].map((value, n) => (n > 3 && n < 7 ? 0 : value));
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (rows[middle][0][0] <= t) low = middle; else high = middle;
  }
  const [[a, da], [b, db]] = [rows[low], rows[high]], h = b[0] - a[0], s = (t - a[0]) / h, left = 1 - s;
  return a.map((value, n) => left * left * ((1 + 2 * s) * value + h * s * da[n]) + s * s * ((3 - 2 * s) * b[n] - h * left * db[n]));
}

// As the look-ups of exported files: a stop (time s, place m, path m, turn rad), a state (place, angle, velocity, spin).
const drawnTables = {
  stop(vx, vy, spin, _, decel, radius, out) {
    const { rows } = pathOf(vx / radius, vy / radius, spin, decel / radius), [t, x, y, angle, , , , path] = rows[rows.length - 1][0];
    out.set([t, radius * x, radius * y, radius * path, angle]);
    return 0;
  },
  state(vx, vy, spin, _, decel, radius, t, out) {
    const [, x, y, angle, ux, uy, turning] = between(pathOf(vx / radius, vy / radius, spin, decel / radius).rows, t);
    out.set([radius * x, radius * y, angle, radius * ux, radius * uy, turning]);
    return 0;
  },
};
