"use strict";
// What a hand does: sliders, the arrow, the ring, a target, keys, the address.
const inputs = {}, choice = document.createElement("select");
let held = null, since = 0, later = 0;

function refresh(refit) {
  for (const [name, [slider, box]] of Object.entries(inputs)) {
    const digits = FIELDS[name][4];
    if (name === "height") slider.max = box.max = tallest().toFixed(1);
    if (document.activeElement !== box) box.value = Number(now[name].toFixed(digits));
    slider.value = now[name];
  }
  choice.value = now.law;
  const shown = draw(refit);
  clearTimeout(later);  // browsers allow an address to change some times a second only
  later = setTimeout(remember, 300);
  return shown;
}

function remember() {
  const kept = Object.keys(FIELDS).map((name) => `${name}=${Number(now[name].toPrecision(10))}`);
  history.replaceState(null, "", `#law=${now.law}&${kept.join("&")}`);
}

function recall() {
  for (const [name, value] of new URLSearchParams(location.hash.slice(1))) {
    if (name === "law") setLaw(value);
    else if (name in FIELDS) set(name, Number(value));
  }
}

function makeChoice() {
  const row = document.createElement("label"), word = document.createElement("span");
  word.textContent = "pressure";
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

// The law and the radius of gyration, where they are not what a puck has that nothing is said of.
const kind = (before, between) => (now.law === "uniform" ? "" : `${before}${now.law}${between}${law().gyration}`);

function asPython() {
  const a = now.heading * Math.PI / 180, short = (x) => Number(x.toPrecision(9));
  return `import puck_tables as pt\npuck = pt.Puck(radius=${short(now.radius / 1000)}, height=${short(now.height / 1000)}, friction=${short(now.friction)}${kind(", pressure=\"", "\", gyration=")})\n` +
    `run = puck.simulate((${short(now.speed * Math.cos(a))}, ${short(now.speed * Math.sin(a))}), spin=${short(now.spin)})`;
}

function asCommand() {
  const a = now.heading * Math.PI / 180, short = (x) => Number(x.toPrecision(9));
  return `puck simulate --v0 ${short(now.speed * Math.cos(a))},${short(now.speed * Math.sin(a))} --w0 ${short(now.spin)} ` +
    `--radius ${short(now.radius / 1000)} --height ${short(now.height / 1000)} --friction ${short(now.friction)}${kind(" --pressure ", " --gyration ")}`;
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
globalThis.explorer = { now, run, set, setLaw, draw, refresh, aimAt, asPython, asCommand, tipOfArrow, knobOfRing, seen };
