// A board and the pucks on it, drawn on the canvas of a page; "film" says what there is.
let [left, right, low, high] = film.box;
const FLASH = 0.25;  // s of the viewer's time that an impact is seen
const canvas = document.getElementById("board"), pen = canvas.getContext("2d");
let scale = 1;  // pixels a metre

function fit() {
  const wide = Math.min(document.querySelector("main").clientWidth - 28, 1072);
  const tall = Math.max(window.innerHeight - 170, 240);
  scale = Math.min(wide / (right - left), tall / (high - low));
  const sharp = window.devicePixelRatio || 1;
  canvas.width = Math.round(scale * (right - left) * sharp);
  canvas.height = Math.round(scale * (high - low) * sharp);
  canvas.style.width = canvas.width / sharp + "px";
  canvas.style.height = canvas.height / sharp + "px";
  pen.setTransform(sharp, 0, 0, sharp, 0, 0);
}

const px = x => scale * (x - left), py = y => scale * (high - y);

function circle(x, y, radius, fill, stroke, width) {
  pen.beginPath();
  pen.arc(px(x), py(y), scale * radius, 0, 2 * Math.PI);
  if (fill) { pen.fillStyle = fill; pen.fill(); }
  if (stroke) { pen.strokeStyle = stroke; pen.lineWidth = width || 1; pen.stroke(); }
}

// A base that is not round, turned and at its place; its holes stay open.
function shape(body, x, y, angle, fill, stroke, width) {
  const c = Math.cos(angle), s = Math.sin(angle);
  pen.beginPath();
  for (const part of body.outline) {
    part.forEach(([a, b], n) => {
      const at = [px(x + c * a - s * b), py(y + s * a + c * b)];
      if (n) pen.lineTo(...at); else pen.moveTo(...at);
    });
    pen.closePath();
  }
  pen.fillStyle = fill; pen.fill();
  pen.strokeStyle = stroke; pen.lineWidth = width || 1; pen.stroke();
}

// A floor that moves: arrows on a lattice that goes with it, each as long as it is fast there.
function drawMotion(t) {
  if (!film.moving) return;
  const [vx, vy] = film.moving.velocity, [cx, cy] = film.moving.centre, w = film.moving.turning;
  const velocityAt = (x, y) => [vx - w * (y - cy), vy + w * (x - cx)];
  const cell = Math.max(right - left, high - low) / 9;
  const fastest = Math.max(...[[left, low], [left, high], [right, low], [right, high]]
    .map(corner => Math.hypot(...velocityAt(...corner))));
  // a point of the floor: it turns about the place that rests, and a belt has none
  const [ox, oy] = w ? [cx - vy / w, cy + vx / w] : [vx * t, vy * t];
  const c = Math.cos(w * t), s = Math.sin(w * t);
  const mx = (left + right) / 2 - ox, my = (low + high) / 2 - oy;
  const u = c * mx + s * my, v = c * my - s * mx;  // the middle of the board, on the lattice
  const far = Math.hypot(right - left, high - low) / 2;
  pen.strokeStyle = "#86aac6"; pen.lineWidth = 1.5;
  for (let i = Math.ceil((u - far) / cell); i * cell <= u + far; i++) {
    for (let j = Math.ceil((v - far) / cell); j * cell <= v + far; j++) {
      const x = ox + cell * (c * i - s * j), y = oy + cell * (s * i + c * j);
      const [along, up] = velocityAt(x, y).map(one => 0.6 * scale * cell * one / fastest);
      pen.beginPath();
      pen.moveTo(px(x), py(y));
      for (const side of [0.15, -0.15]) {  // of its head
        pen.lineTo(px(x) + along, py(y) - up);
        pen.lineTo(px(x) + 0.75 * along - side * up, py(y) - 0.75 * up - side * along);
      }
      pen.stroke();
    }
  }
  if (w) {
    pen.beginPath();
    pen.moveTo(px(cx) - 6, py(cy)); pen.lineTo(px(cx) + 6, py(cy));
    pen.moveTo(px(cx), py(cy) - 6); pen.lineTo(px(cx), py(cy) + 6);
    pen.strokeStyle = "#4a7fa8"; pen.stroke();
  }
}

function drawBoard(t) {
  pen.clearRect(0, 0, canvas.width, canvas.height);
  for (const one of film.shades) {
    if (one.corners) {
      pen.beginPath();
      for (const [x, y] of one.corners) pen.lineTo(px(x), py(y));
      pen.closePath();
      pen.fillStyle = one.colour; pen.fill();
      pen.strokeStyle = "#8a8a8a"; pen.lineWidth = 0.8; pen.stroke();
    } else circle(one.centre[0], one.centre[1], one.radius, one.colour, "#8a8a8a", 0.8);
  }
  drawMotion(t);
  for (const one of film.painted) {
    pen.beginPath();
    one.x.forEach((x, n) => pen.lineTo(px(x), py(one.y[n])));
    pen.strokeStyle = one.colour;
    pen.lineWidth = 1.2;
    pen.stroke();
  }
  for (const one of film.rounds) {
    if (one.kind === "arc") {
      pen.beginPath();
      pen.arc(px(one.x), py(one.y), scale * one.radius, -one.start, -one.start - one.span, true);
      pen.strokeStyle = "#000"; pen.lineWidth = 3; pen.stroke();
    } else if (one.kind === "post") circle(one.x, one.y, one.radius, "#606060", "#000");
    else circle(one.x, one.y, one.radius, "#d8d8d8", "#8a8a8a");
  }
  for (const one of film.lines) {
    pen.beginPath();
    pen.moveTo(px(one.x[0]), py(one.y[0]));
    pen.lineTo(px(one.x[1]), py(one.y[1]));
    pen.strokeStyle = one.kind === "edge" ? "#b3202a" : "#000";
    pen.lineWidth = one.kind === "edge" ? 1.2 : 3;
    pen.setLineDash(one.kind === "edge" ? [6, 4] : []);
    pen.stroke();
    pen.setLineDash([]);
  }
  drawScale();
}

// A bar of 1, 2 or 5 times a power of ten, about a tenth of the width.
function drawScale() {
  const rough = 0.15 * (right - left), ten = 10 ** Math.floor(Math.log10(rough));
  const size = [5, 2, 1].map(n => n * ten).find(n => n <= rough) || ten;
  const x = 12, y = scale * (high - low) - 8;
  pen.fillStyle = "#555"; pen.fillRect(x, y, scale * size, 2);
  pen.font = "11px system-ui, sans-serif";
  pen.fillText(size >= 1 ? size + " m" : +(100 * size).toPrecision(6) + " cm", x, y - 4);
}

// A puck at a place; one that is gone is pale.
function drawBody(body, x, y, angle, gone) {
  pen.globalAlpha = gone ? 0.25 : 1;
  const [fill, line, wide] = body.driven ? ["#fff", body.line, 3] : [body.colour, "#000", 1];
  if (body.outline.length) shape(body, x, y, angle, fill, line, wide);
  else circle(x, y, body.radius, fill, line, wide);
  pen.beginPath();  // a mark that turns with it
  pen.moveTo(px(x), py(y));
  const long = body.mark_length;
  pen.lineTo(px(x + long * Math.cos(angle)), py(y + long * Math.sin(angle)));
  pen.strokeStyle = body.mark;
  pen.lineWidth = Math.max(1, Math.min(3, 0.12 * scale * body.radius));
  pen.stroke();
  pen.globalAlpha = 1;
}

// An impact, seen for a while: its age, of that, from 0 to 1.
function drawFlash(one, age) {
  if (age < 0 || age > 1) return;
  pen.globalAlpha = 1 - age;
  pen.beginPath();
  pen.arc(px(one.x), py(one.y), 4 + 10 * age, 0, 2 * Math.PI);
  pen.strokeStyle = "#b3202a"; pen.lineWidth = 2; pen.stroke();
  pen.globalAlpha = 1;
}
