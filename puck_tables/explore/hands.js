"use strict";
// What a hand does: sliders, the arrow, the ring, a target, keys, the address.
const inputs = {}, choice = document.createElement("select");
let held = null, since = 0, later = 0;
let grip = null;  // a corner of a drawn base that is held: its number, the corners at first, the frame they are seen in

function refresh(refit) {
  for (const [name, [slider, box]] of Object.entries(inputs)) {
    const digits = FIELDS[name][4];
    if (name === "height") slider.max = box.max = tallest().toFixed(1);
    if (document.activeElement !== box) box.value = Number(now[name].toFixed(digits));
    slider.value = now[name];
  }
  choice.value = now.law;
  document.body.classList.toggle("drawn", now.law === "drawn");
  inputs.radius[0].previousSibling.textContent = now.law === "drawn" ? "reach / mm" : "radius / mm";
  if (now.law === "drawn" && document.activeElement !== cornersBox) cornersBox.value = cornersText(0.01);
  const shown = draw(refit);
  clearTimeout(later);  // browsers allow an address to change some times a second only
  later = setTimeout(remember, 300);
  return shown;
}

function remember() {
  const kept = Object.keys(FIELDS).map((name) => `${name}=${Number(now[name].toPrecision(10))}`);
  const base = now.law === "drawn" ? `&corners=${encodeURIComponent(cornersText(1e-6))}` : "";
  history.replaceState(null, "", `#law=${now.law}&${kept.join("&")}${base}`);
}

function recall() {
  for (const [name, value] of new URLSearchParams(location.hash.slice(1))) {
    if (name === "law") setLaw(value);
    else if (name === "corners" && !takeText(value)) setTimeout(() => { cornersBox.value = value; takeText(value); });  // once it is shown
    else if (name in FIELDS) set(name, Number(value));
  }
}

function makeChoice() {
  const row = document.createElement("label"), word = document.createElement("span");
  word.textContent = "base";
  choice.name = "law";
  for (const [name, { title }] of Object.entries(puckLaws)) choice.append(new Option(title, name));
  choice.addEventListener("input", () => {
    setLaw(choice.value);
    now.target = null;
    refresh(true);
  });
  row.className = "choice";
  row.append(word, choice);
  document.getElementById("numbers").append(row);
}

function makeInputs() {
  for (const [name, [label, unit, low, high, digits]] of Object.entries(FIELDS)) {
    const row = document.createElement("label"), word = document.createElement("span");
    word.textContent = unit ? `${label} / ${unit}` : label;
    const pair = ["range", "number"].map((type) => Object.assign(document.createElement("input"), {
      type, min: low, max: high, step: type === "range" ? 10 ** -digits : "any", name: `${name}-${type}`,
    }));
    pair.forEach((input) => {
      input.setAttribute("aria-label", `${label}${unit ? ` in ${unit}` : ""}`);
      input.addEventListener("input", () => {
        if (input.value === "") return;
        set(name, Number(input.value));
        if (name !== "moment") now.target = null;
        refresh(name !== "moment");
      });
    });
    row.append(word, ...pair);
    document.getElementById("numbers").append(row);
    inputs[name] = pair;
  }
}

// A base that is drawn: its corners in mm as text, and under the hand.
const cornersBox = document.getElementById("corners"), base = document.getElementById("base");
const cornersText = (step) => drawn.corners.map((one) => one.map((x) => Number((Math.round(x * now.radius / step) * step).toPrecision(9))).join(",")).join("; ");
const cornersIn = (text) => text.split(/[;\n]/).filter((one) => one.trim()).map((one) => one.split(",").map(Number));

function takeText(text) {
  const corners = cornersIn(text), right = corners.every((one) => one.length === 2 && one.every(Number.isFinite));
  const taken = right && corners.length > 2 && setCorners(corners);
  cornersBox.setCustomValidity(taken ? "" : "x,y; x,y; x,y in mm: three corners or more, sides that do not cross, 5 to 200 mm from the middle");
  cornersBox.reportValidity();
  return taken;
}
cornersBox.addEventListener("input", () => { if (takeText(cornersBox.value)) refresh(true); });
for (const [name, corners] of Object.entries(SHAPES)) {
  const button = Object.assign(document.createElement("button"), { type: "button", textContent: name });
  button.addEventListener("click", () => { takeCorners(corners); now.target = null; refresh(true); });
  document.getElementById("shapes").append(button);
}

// Where a pointer is on the drawing, in radii; the number of the corner there, or of the side and a half.
function cornerAt(event) {
  const [px, py] = pointAt(event), size = Math.min(base.clientWidth, base.clientHeight) / 2 - 18;
  const x = (px - base.clientWidth / 2) / size, y = (base.clientHeight / 2 - py) / size;
  const near = ([cx, cy]) => Math.hypot(x - cx, y - cy) * size < 12;
  const middles = sidesOf(drawn.corners).map(([[ax, ay], [bx, by]]) => [(ax + bx) / 2, (ay + by) / 2]);
  return { x, y, corner: drawn.corners.findIndex(near), side: middles.findIndex(near) };
}

base.addEventListener("pointerdown", (event) => {
  if (now.law !== "drawn") return;
  const { corner, side } = cornerAt(event), corners = drawn.corners.map((one) => [...one]);
  if (corner < 0 && side < 0) return;
  if (corner < 0) corners.splice(side + 1, 0, [0, 0]);
  base.setPointerCapture(event.pointerId);
  grip = { n: corner < 0 ? side + 1 : corner, corners, radius: now.radius, frame: [0, 0, 1] };
});
base.addEventListener("pointermove", (event) => {
  if (!grip) return;
  const { x, y } = cornerAt(event);
  grip.corners[grip.n] = [x, y];
  if (setCorners(grip.corners.map((one) => one.map((value) => value * grip.radius)))) grip.frame = drawn.frame.map((value) => value / grip.radius);
  refresh(false);
});
for (const end of ["pointerup", "pointercancel"]) {
  base.addEventListener(end, () => { if (grip) { grip = null; refresh(true); } });
}
base.addEventListener("dblclick", (event) => {
  if (now.law !== "drawn") return;
  const { corner } = cornerAt(event);
  if (corner >= 0 && setCorners(drawn.corners.filter((_, n) => n !== corner).map((one) => one.map((x) => x * now.radius)))) refresh(true);
});

const plane = document.getElementById("plane"), near = ([x, y], px, py) => Math.hypot(x - px, y - py) < 22;

function pointAt(event) {
  const box = event.currentTarget.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}

plane.addEventListener("pointerdown", (event) => {
  const [x, y] = pointAt(event), [ox, oy] = seen(0, 0);
  plane.setPointerCapture(event.pointerId);
  held = near(tipOfArrow(), x, y) ? "arrow" : near(knobOfRing(), x, y) ? "ring" : "target";
  since = Math.atan2(oy - y, x - ox);
  if (held === "target") moveTo(x, y);
});
plane.addEventListener("pointermove", (event) => { if (held) moveTo(...pointAt(event)); });
for (const end of ["pointerup", "pointercancel"]) {
  plane.addEventListener(end, () => { if (held) { held = null; refresh(true); } });
}

function moveTo(x, y) {
  const [ox, oy] = seen(0, 0), a = Math.atan2(oy - y, x - ox);
  if (held === "arrow") {
    set("speed", Math.max(0, Math.hypot(x - ox, y - oy) - RING) / view.perSpeed);
    set("heading", a * 180 / Math.PI);
    now.target = null;
  } else if (held === "ring") {
    const by = a - since - 2 * Math.PI * Math.round((a - since) / 2 / Math.PI);
    set("spin", now.spin + by / view.perSpin);
    since = a;
    now.target = null;
  } else {
    now.target = placeOf(x, y);
    aimAt(...now.target);
  }
  refresh(false);
}

plane.addEventListener("keydown", (event) => {
  const small = event.shiftKey ? 0.1 : 1, steps = {
    ArrowUp: ["speed", 0.05], ArrowDown: ["speed", -0.05], ArrowLeft: ["heading", 2], ArrowRight: ["heading", -2],
    "+": ["spin", 2], "=": ["spin", 2], "-": ["spin", -2],
  };
  if (!(event.key in steps)) return;
  event.preventDefault();
  const [name, by] = steps[event.key];
  set(name, now[name] + small * by);
  now.target = null;
  refresh(true);
});

const short = (x) => Number(x.toPrecision(9)), velocity = () => [Math.cos, Math.sin].map((f) => short(now.speed * f(now.heading * Math.PI / 180)));
// The puck in the words of Python and of commands; its law and radius of gyration where they are not those of a default one.
const inMetres = (between) => drawn.corners.map((one) => one.map((x) => short(x * now.radius / 1000)).join(",")).join(between);
const round = (size, height, before, between) => `${size}${short(now.radius / 1000)}${height}${short(now.height / 1000)}` +
  (now.law === "uniform" ? "" : `${before}${now.law}${between}${law().gyration}`);

function asPython() {
  const puck = now.law === "drawn" ? `base=pt.Base.polygon([(${inMetres("), (")})])` : round("radius=", ", height=", ", pressure=\"", "\", gyration=");
  return `import puck_tables as pt\npuck = pt.Puck(${puck}, friction=${short(now.friction)})\nrun = puck.simulate((${velocity().join(", ")}), spin=${short(now.spin)})`;
}

function asCommand() {
  const puck = now.law === "drawn" ? `--base "polygon:${inMetres(";")}"` : round("--radius ", " --height ", " --pressure ", " --gyration ");
  return `puck simulate --v0 ${velocity().join(",")} --w0 ${short(now.spin)} ${puck} --friction ${short(now.friction)}`;
}

function copy(text) {
  document.getElementById("copied").textContent = text;  // to be seen, and taken by hand where the clipboard is closed
  navigator.clipboard?.writeText(text).catch(() => {});
}
document.getElementById("python").addEventListener("click", () => copy(asPython()));
document.getElementById("command").addEventListener("click", () => copy(asCommand()));
document.getElementById("share").addEventListener("click", () => { remember(); copy(location.href); });
window.addEventListener("resize", () => {
  Object.keys(papers).forEach((name) => delete papers[name]);
  refresh(true);
});
window.addEventListener("hashchange", () => { recall(); refresh(true); });

makeChoice();
makeInputs();
recall();
refresh(true);
globalThis.explorer = { now, run, set, setLaw, draw, refresh, aimAt, asPython, asCommand, setCorners, drawn, tipOfArrow, knobOfRing, seen };
