"use strict";
const BLUE = "#1560b3", ORANGE = "#c2550a", GREEN = "#1e7d32", GREY = "#6b7480", PALE = "#dfe4ea";
const CORNERS = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]];
const COLOURS = new Uint32Array(256).map((_, n) => {  // as pixels: alpha, blue, green, red
  const place = n / 255 * (CORNERS.length - 1), k = Math.min(Math.floor(place), CORNERS.length - 2);
  const [red, green, blue] = CORNERS[k].map((low, j) => Math.round(low + (place - k) * (CORNERS[k + 1][j] - low)));
  return (255 << 24 | blue << 16 | green << 8 | red) >>> 0;
});
const ARROW = 95, RING = 46, SPEEDS = 1.3, SPINS = 1.3;  // pixels; how much more than the launch a map shows
const view = { perMetre: 100, left: 0, high: 0, perSpeed: 50, perSpin: 0.05, fastest: 1, most: 1 };
const pictures = {}, papers = {};

// The canvas of a picture; its size is asked for once, for asking makes the browser lay the page out.
function paper(name) {
  const canvas = document.getElementById(name), ratio = window.devicePixelRatio || 1;
  const [width, height] = papers[name] ||= [canvas.clientWidth, canvas.clientHeight];
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const pen = canvas.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  pen.font = "12px system-ui, sans-serif";
  pen.lineJoin = "round";
  return { pen, width, height };
}

const colourOf = (share) => COLOURS[Math.round(255 * Math.min(1, Math.max(0, share)))];

// A round step so that some five fit.
function stepOf(span) {
  const power = 10 ** Math.floor(Math.log10(span / 5));
  return [1, 2, 5, 10].map((k) => k * power).find((step) => span / step <= 6) || power;
}

const written = (x) => String(Number(x.toPrecision(6)));

// Fit the plane and its handles to what is there; not while somebody drags.
function fitView(found) {
  const { width, height } = paper("plane");
  let [x0, x1, y0, y1] = [0, 0, 0, 0];
  for (const [, x, y] of found.states) {
    x0 = Math.min(x0, x); x1 = Math.max(x1, x); y0 = Math.min(y0, y); y1 = Math.max(y1, y);
  }
  const room = 75, size = 2 * now.radius / 1000;
  const wide = Math.max(x1 - x0, size), tall = Math.max(y1 - y0, size);
  view.perMetre = Math.min((width - 2 * room) / wide, (height - 2 * room) / tall);
  view.left = width / 2 - view.perMetre * (x0 + x1) / 2;
  view.high = height / 2 + view.perMetre * (y0 + y1) / 2;
  view.perSpeed = now.speed > 0 ? ARROW / now.speed : ARROW;
  view.perSpin = now.spin !== 0 ? 0.65 * 2 * Math.PI / Math.abs(now.spin) : 0.05;
  view.fastest = Math.max(0.2, SPEEDS * now.speed);
  view.most = Math.max(0.2 * 1000 / now.radius, SPINS * Math.abs(now.spin));
}

const seen = (x, y) => [view.left + view.perMetre * x, view.high - view.perMetre * y];
const placeOf = (px, py) => [(px - view.left) / view.perMetre, (view.high - py) / view.perMetre];

function tipOfArrow() {
  const [x, y] = seen(0, 0), a = now.heading * Math.PI / 180, long = RING + view.perSpeed * now.speed;
  return [x + long * Math.cos(a), y - long * Math.sin(a)];
}

function knobOfRing() {
  const [x, y] = seen(0, 0), a = Math.PI / 2 + view.perSpin * now.spin;
  return [x + RING * Math.cos(a), y - RING * Math.sin(a)];
}

function disc(pen, x, y, size, fill, line) {
  pen.beginPath();
  pen.arc(x, y, size, 0, 2 * Math.PI);
  if (fill) { pen.fillStyle = fill; pen.fill(); }
  if (line) { pen.strokeStyle = line; pen.lineWidth = 1.5; pen.stroke(); }
}

function line(pen, points, colour, width = 2, dash = []) {
  pen.beginPath();
  points.forEach(([x, y], n) => (n ? pen.lineTo(x, y) : pen.moveTo(x, y)));
  pen.strokeStyle = colour;
  pen.lineWidth = width;
  pen.setLineDash(dash);
  pen.stroke();
  pen.setLineDash([]);
}

function drawPlane(found) {
  const { pen, width, height } = paper("plane");
  const step = stepOf(width / view.perMetre), [x0, y0] = placeOf(0, height), [x1, y1] = placeOf(width, 0);
  pen.fillStyle = GREY;
  for (let x = Math.ceil(x0 / step) * step; x < x1; x += step) {
    line(pen, [[seen(x, 0)[0], 0], [seen(x, 0)[0], height]], PALE, 1);
    pen.fillText(written(x), seen(x, 0)[0] + 3, height - 5);
  }
  for (let y = Math.ceil(y0 / step) * step; y < y1; y += step) {
    line(pen, [[0, seen(0, y)[1]], [width, seen(0, y)[1]]], PALE, 1);
    pen.fillText(written(y), 3, seen(0, y)[1] - 3);
  }
  pen.fillText("x, y / m", width - 52, 14);
  line(pen, found.states.map(([, x, y]) => seen(x, y)), BLUE, 2.5);
  const body = Math.max(7, view.perMetre * now.radius / 1000);
  for (let n = 0; n <= STATES; n += 25) drawPuck(pen, found.states[n], body, "#9aa5b4");
  drawPuck(pen, [0, ...found.moment], body, BLUE);
  const [ex, ey] = seen(found.x, found.y);
  pen.fillStyle = ORANGE;
  pen.fillRect(ex - 5, ey - 5, 10, 10);
  if (now.target) {
    const [tx, ty] = seen(...now.target);
    line(pen, [[tx - 9, ty], [tx + 9, ty]], "#b3202a");
    line(pen, [[tx, ty - 9], [tx, ty + 9]], "#b3202a");
  }
  const [ox, oy] = seen(0, 0), [ax, ay] = tipOfArrow(), [kx, ky] = knobOfRing();
  disc(pen, ox, oy, RING, null, "#b9c2ce");
  pen.beginPath();
  const from = -Math.PI / 2, to = from - view.perSpin * now.spin;
  pen.arc(ox, oy, RING, from, to, now.spin > 0);
  pen.strokeStyle = ORANGE;
  pen.lineWidth = 4;
  pen.stroke();
  disc(pen, kx, ky, 9, ORANGE, "#fff");
  line(pen, [[ox, oy], [ax, ay]], GREEN, 3.5);
  disc(pen, ax, ay, 9, GREEN, "#fff");
}

function drawPuck(pen, [, x, y, angle], size, colour) {
  const [px, py] = seen(x, y);
  if (now.law === "drawn") outline(pen, drawn.corners.map((one) => placed(one, px, py, size, angle)), null, colour);
  else disc(pen, px, py, size, null, colour);
  line(pen, [[px, py], [px + size * Math.cos(angle), py - size * Math.sin(angle)]], colour, 1.5);
}

// A corner of a drawn base in pixels, about its middle.
const placed = ([x, y], px, py, size, angle) =>
  [px + size * (x * Math.cos(angle) - y * Math.sin(angle)), py - size * (x * Math.sin(angle) + y * Math.cos(angle))];

function outline(pen, points, fill, colour) {
  line(pen, [...points, points[0], points[1]], colour, 1.5);
  if (fill) { pen.fillStyle = fill; pen.fill(); }
}

// Curves over time: [colour, points (t, value), name, dashed].
function drawCurves(name, time, top, curves) {
  const { pen, width, height } = paper(name), left = 34, low = height - 20, wide = width - left - 8, tall = low - 10;
  const at = ([t, value]) => [left + wide * t / time, low - tall * Math.min(value, 1.05 * top) / top];
  pen.fillStyle = GREY;
  const rise = stepOf(top), run = stepOf(time);
  for (let value = 0; value <= top; value += rise) {
    line(pen, [at([0, value]), at([time, value])], PALE, 1);
    pen.fillText(written(value), 3, at([0, value])[1] + 4);
  }
  pen.textAlign = "center";
  for (let t = 0; at([t, 0])[0] < width - 28; t += run) pen.fillText(written(t), at([t, 0])[0], height - 5);
  pen.fillText("s", width - 10, height - 5);
  pen.textAlign = "left";
  curves.forEach(([colour, points, label, dash], n) => {
    line(pen, points.map(at), colour, 2, dash || []);
    pen.fillStyle = colour;
    pen.fillText(label, left + 8 + 62 * n, 14);
  });
}

function drawSpeeds(found) {
  const r = now.radius / 1000, states = found.states;
  const slide = states.map(([t, , , , vx, vy]) => [t, Math.hypot(vx, vy)]), rim = states.map((s) => [s[0], r * Math.abs(s[6])]);
  const top = 1.08 * Math.max(slide[0][1], rim[0][1], 1e-9);
  drawCurves("speeds", found.time, top, [[GREEN, slide, "v / m/s"], [ORANGE, rim, "r|ω| / m/s"]]);
}

function drawRatio(found) {
  const r = now.radius / 1000, points = [];
  for (const [t, , , , vx, vy, spin] of found.states) {
    if (spin !== 0) points.push([t, Math.hypot(vx, vy) / (r * Math.abs(spin))]);
  }
  const last = points.length ? points[points.length - 1][1] : 0;
  const top = points.length ? Math.min(3, 1.15 * Math.max(points[0][1], last, 0.8)) : 1;
  drawCurves("ratio", found.time, top, [[BLUE, points, points.length ? "" : "no spin"]]);
}

// The base that is drawn, as it is launched, and what takes hold of it: corners, and points between them.
function drawDrawn(found) {
  const { pen, width, height } = paper("base"), size = Math.min(width, height) / 2 - 18;
  const [mx, my, unit] = grip ? grip.frame : [0, 0, 1], at = ([x, y]) => [width / 2 + size * (mx + unit * x), height / 2 - size * (my + unit * y)];
  const corners = drawn.corners.map(at), [cx, cy] = at([0, 0]), [, , , , vx, vy] = found.states[0];
  outline(pen, corners, "#fde725", "#1d2430");
  corners.forEach(([x, y], n) => {
    const [bx, by] = corners[(n + 1) % corners.length];
    disc(pen, (x + bx) / 2, (y + by) / 2, 3.5, "#fff", BLUE);
    disc(pen, x, y, 6, BLUE, "#fff");
  });
  line(pen, [[cx - 5, cy], [cx + 5, cy]], "#1d2430", 1);
  line(pen, [[cx, cy - 5], [cx, cy + 5]], "#1d2430", 1);
  const v = Math.hypot(vx, vy);
  if (v > 0) line(pen, [[cx, cy], [cx + 0.6 * size * vx / v, cy - 0.6 * size * vy / v]], GREEN, 3);
}

function drawBase(found) {
  if (now.law === "drawn") return drawDrawn(found);
  const { pen, width, height } = paper("base"), size = Math.min(width, height) / 2 - 18, cells = 56, load = LOADS[now.law] || evenly;
  const picture = new ImageData(cells, cells), pixels = new Uint32Array(picture.data.buffer), [bx, by] = found.tilt;
  for (let row = 0; row < cells; row++) {
    for (let column = 0; column < cells; column++) {
      const x = 2 * (column + 0.5) / cells - 1, y = 1 - 2 * (row + 0.5) / cells;
      if (x * x + y * y < 1) pixels[row * cells + column] = colourOf(load(Math.hypot(x, y)) * (1 + bx * x + by * y) / 2);
    }
  }
  stamp(pen, "base", picture, width / 2 - size, height / 2 - size, 2 * size, 2 * size);
  disc(pen, width / 2, height / 2, size, null, "#1d2430");
  if (HOLES[now.law]) {
    pen.globalCompositeOperation = "destination-out";
    disc(pen, width / 2, height / 2, size * HOLES[now.law], "#000");
    pen.globalCompositeOperation = "source-over";
    disc(pen, width / 2, height / 2, size * HOLES[now.law], null, "#1d2430");
  }
  const [, , , vx, vy, spin] = found.moment, v = Math.hypot(vx, vy), q = Math.hypot(v, spin * now.radius / 1000);
  if (v > 0) {
    const long = size * v / q;
    line(pen, [[width / 2, height / 2], [width / 2 + long * vx / v, height / 2 - long * vy / v]], HOLES[now.law] ? GREEN : "#fff", 3);
    const away = v / (spin * now.radius / 1000);  // centre of rotation, in radii to the left
    if (Math.abs(away) < 1) disc(pen, width / 2 - size * away * vy / v, height / 2 - size * away * vx / v, 5, "#fff", "#1d2430");
  }
  pen.fillStyle = GREY;
  pen.fillText(`${written(Number((1 - Math.hypot(bx, by)).toFixed(3)))} to ${written(Number((1 + Math.hypot(bx, by)).toFixed(3)))} × at rest`, 6, height - 6);
}

function drawMap() {
  const { pen, width, height } = paper("map"), left = 34, low = height - 20, wide = width - left - 8, tall = low - 8;
  const base = now.law === "drawn" ? [now.heading, drawn.corners] : [], count = law().map;
  const key = [now.law, now.radius, now.height, now.friction, view.fastest, view.most, ...base].join();
  if (pictures.key !== key && !(base.length && (held || grip))) {  // of a drawn base it takes a moment
    pictures.key = key;
    pictures.times = stopTimes(view.fastest, view.most, count);
    const longest = Math.max(...pictures.times), picture = new ImageData(count, count);
    new Uint32Array(picture.data.buffer).set(pictures.times.map((time) => colourOf(time / longest)));
    pictures.longest = longest;
    pictures.map = picture;
  }
  stamp(pen, "map", pictures.map, left, 8, wide, tall);
  pen.fillStyle = GREY;
  pen.fillText("0", left, height - 5);
  pen.fillText(`${view.fastest.toPrecision(3)} m/s`, width - 62, height - 5);
  pen.fillText(view.most.toPrecision(2), 3, 16);
  pen.fillText("rad/s", 3, 30);
  pen.fillText((-view.most).toPrecision(2), 3, low);
  pen.fillStyle = "#fff";
  pen.fillText(`up to ${pictures.longest.toPrecision(3)} s`, left + 5, 22);
  const x = left + wide * now.speed / view.fastest, y = 8 + tall * (1 - now.spin / view.most) / 2;
  if (x <= width - 8 && y > 8 && y < low) disc(pen, x, y, 6, null, "#fff");
}

function stamp(pen, name, picture, x, y, width, height) {
  const sheet = pictures[`${name} sheet`] ||= document.createElement("canvas");
  Object.assign(sheet, { width: picture.width, height: picture.height });
  sheet.getContext("2d").putImageData(picture, 0, 0);
  pen.imageSmoothingEnabled = true;
  pen.drawImage(sheet, x, y, width, height);
}

function draw(refit) {
  const found = run();
  if (found.code !== 0) return;
  if (refit) fitView(found);
  drawPlane(found);
  drawSpeeds(found);
  drawRatio(found);
  drawBase(found);
  drawMap();
  const side = found.y * Math.cos(now.heading * Math.PI / 180) - found.x * Math.sin(now.heading * Math.PI / 180);
  const bend = Math.abs(side) < 5e-5 ? "straight ahead" : `${(1000 * Math.abs(side)).toFixed(1)} mm to the ${side > 0 ? "left" : "right"}`;
  document.getElementById("told").textContent =
    `The puck stops after ${found.time.toFixed(4)} s at (${found.x.toFixed(4)}, ${found.y.toFixed(4)}) m, ${bend}. ` +
    `Its path is ${found.path.toFixed(4)} m long, and it turns ${(found.turn / 2 / Math.PI).toFixed(2)} times. ` +
    (now.law === "drawn" ? `It is flat, and even: k = ${(now.radius * drawn.square ** 0.5).toFixed(1)} mm.`
      : `δ = 2fh/r = ${scale().delta.toFixed(3)}, of ${law().tallest.toFixed(2)} at most.`);
  return found;
}
