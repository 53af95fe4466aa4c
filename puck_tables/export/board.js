// /*title*/: a board that is played exactly, in WebAssembly; made by puck-tables /*version*/.
//
//   const board = await puckBoard.load();
//   board.strike(/*puck*/, { velocity: [1.0, 0.0], spin: 5.0 });
//   for (const event of board.advance(1 / 60)) console.log(event.time, event.what, event.puck);
//   const { x, y, angle } = board.state()[0];
//
// Lengths are in m, times in s, angles in rad, masses in kg.  Nothing is stepped: a call costs what
// happens in it, and the same calls give the same bits in every browser.
/*licence*/
(function () {
"use strict";
const SCENE = /*scene*/;
const CODE = "/*code*/";
const COUNT = SCENE.pucks.length, { codes, layout } = SCENE;
const X = 0, ANGLE = 2, VX = 3, SPIN = 5; // of a state
let engine;

/** The machine code and its memory, once for all boards. */
async function start() {
  const packed = Uint8Array.from(atob(CODE), (one) => one.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  const bytes = await new Response(stream).arrayBuffer();
  const { exports } = (await WebAssembly.instantiate(bytes, {})).instance;
  exports._initialize();
  const table = [...new Uint32Array(exports.memory.buffer, exports.board.value, SCENE.arrays.length + 1)];
  const record = table[0], at = (name) => table[1 + SCENE.arrays.indexOf(name)];
  const floats = (name, size) => new Float64Array(exports.memory.buffer, at(name), size);
  const wholes = (name, size) => new BigInt64Array(exports.memory.buffer, at(name), size);
  return {
    play: (what, time) => exports.puck_play(record, what, time),
    see: (time) => exports.puck_see(record, time),
    numbers: floats("numbers", layout.numbers), whole: wholes("whole", layout.whole),
    pieces: floats("pieces", layout.pieces), due: floats("due", 1),
    newNumbers: floats("numbers", 2 * layout.numbers).subarray(layout.numbers),
    newWhole: wholes("whole", 2 * layout.whole).subarray(layout.whole),
    newPieces: floats("pieces", 2 * layout.pieces).subarray(layout.pieces),
    newDue: floats("due", 2).subarray(1),
    row: floats("row", 6), disc: wholes("disc", 1), time: floats("time", 1), after: floats("after", 1),
    found: floats("found", layout.event * layout.events), states: floats("states", 6 * COUNT),
    moving: wholes("moving", COUNT), contact: wholes("contacts", 2), depth: floats("depth", 1),
  };
}

/** What a board keeps; of the pieces of paths those in use. */
function kept(time, numbers, whole, pieces, due) {
  const used = Number(whole[layout.used]) - layout.shared;
  return { time, numbers: numbers.slice(), whole: whole.slice(), due: due[0],
           pieces: pieces.slice(0, used * layout.columns) };
}

function number(name, value) {
  if (typeof value !== "number" || !Number.isFinite(value)) {
    throw new TypeError(`${name} must be a finite number, got ${value}`);
  }
  return value;
}

function pair(name, value) {
  if (!value || value.length !== 2) throw new TypeError(`${name} must be [x, y], got ${value}`);
  return [number(name, value[0]), number(name, value[1])];
}

/** What a call is given by name: nothing else, and no array. */
function checked(given, ...names) {
  if (typeof given !== "object" || given === null || Array.isArray(given)) {
    throw new TypeError(`give an object of ${names.join(", ")}, got ${given}`);
  }
  for (const name of Object.keys(given)) {
    if (!names.includes(name)) {
      throw new TypeError(`there is no ${name}, there are ${names.join(", ")}`);
    }
  }
  return given;
}

/** A disc or an obstacle of the engine, or a line, in words. */
function called(partner) {
  if (partner >= 0) return SCENE.pucks[SCENE.order[partner]];
  const things = [...SCENE.obstacles, ...SCENE.lines];
  return things[-1 - partner];
}

class Board {
  #now;

  constructor(now) { this.#now = now; }

  /** Now, s. */
  get time() { return this.#now.time; }

  /** What the pucks are called: by these names or their numbers they are asked for. */
  get names() { return [...SCENE.pucks]; }

  /**
   * Where all pucks are, how they move, and whether they are in play.
   * @returns {{x: number, y: number, angle: number, vx: number, vy: number, spin: number,
   *            moving: boolean, inPlay: boolean}[]}
   */
  state() {
    this.#put();
    engine.see(this.#now.time);
    return SCENE.pucks.map((_, k) => {
      const [x, y, angle, vx, vy, spin] = engine.states.subarray(6 * k, 6 * k + 6);
      const inPlay = this.#kind(k) !== codes.GONE;
      return { x, y, angle, vx, vy, spin, moving: engine.moving[k] > 0n, inPlay };
    });
  }

  /**
   * Let time pass; what happened in it.
   * @param {number} duration s, from 0 on; Infinity: until nothing more can happen
   * @returns {{time: number, what: string, puck: string, partner: string, x: number, y: number,
   *            approach: number, slip: number, impulse: number, rub: number, lost: number}[]}
   */
  advance(duration) {
    if (duration !== Infinity) number("duration", duration);
    if (duration < 0) throw new RangeError(`duration must not be negative, got ${duration} s`);
    const before = this.#now;
    try {
      return this.#until(this.#now.time + duration);
    } catch (error) {
      this.#now = before;
      throw error;
    }
  }

  /**
   * Send a puck off, now; what is left out stays as it is.
   * @param {number | string} puck
   * @param {{velocity?: [number, number], spin?: number}} given m/s, rad/s
   */
  strike(puck, given) {
    const k = this.#inPlay(puck);
    if (SCENE.driven[k]) throw new RangeError(`${SCENE.pucks[k]} is driven: use drive`);
    this.#hand(codes.STRUCK, k, checked(given, "velocity", "spin"));
  }

  /**
   * Put a puck somewhere, now, also back from a pocket; what is left out stays as it is.
   * @param {number | string} puck
   * @param {{position?: [number, number], angle?: number, velocity?: [number, number],
   *          spin?: number}} given m, rad, m/s, rad/s
   */
  place(puck, given) {
    const k = this.#number(puck);
    checked(given, "position", "angle", "velocity", "spin");
    if (!given.position && this.#kind(k) === codes.GONE) {
      throw new RangeError(`${SCENE.pucks[k]} is not in play: give the position to put it at`);
    }
    this.#hand(codes.PLACED, k, given);
  }

  /**
   * Take a puck out of play, now.
   * @param {number | string} puck
   */
  remove(puck) { this.#hand(codes.REMOVED, this.#inPlay(puck), {}); }

  /**
   * Move a puck that is led by hand, from now on until the next call: a mallet.
   * @param {number | string} puck
   * @param {[number, number]} velocity m/s
   * @param {number} spin rad/s
   */
  drive(puck, velocity, spin = 0) {
    const k = this.#inPlay(puck);
    if (!SCENE.driven[k]) throw new RangeError(`${SCENE.pucks[k]} is not led by hand: strike it`);
    this.#hand(codes.LED, k, { velocity: pair("velocity", velocity), spin });
  }

  /** A board of its own that goes on from here, to look ahead. */
  copy() { return new Board(this.#now); }

  #put() {
    const { numbers, whole, pieces, due, time } = this.#now;
    engine.numbers.set(numbers);
    engine.whole.set(whole);
    engine.pieces.set(pieces);
    [engine.due[0], engine.time[0]] = [due, time];
  }

  /** What happens up to a time; what the engine has no room for at once goes in two halves. */
  #until(time, depth = 0) {
    this.#put();
    const count = engine.play(codes.LET_GO, time);
    if (count >= 0) return this.#taken(count);
    if (count === codes.NOTHING_HAPPENS) {
      this.#now = { ...this.#now, time };
      return [];
    }
    const now = this.#now.time, middle = time === Infinity ? now + 1 : now + (time - now) / 2;
    if ([codes.FULL, codes.PAUSED, codes.LACKS_PIECES].includes(count) && middle > now && depth < 40) {
      return [...this.#until(middle, depth + 1), ...this.#until(time, depth + 1)];
    }
    throw this.#failure(count, time - now);
  }

  #hand(what, k, { position, angle, velocity, spin }) {
    engine.row.fill(NaN);
    if (position !== undefined) engine.row.set(pair("position", position), X);
    if (angle !== undefined) engine.row[ANGLE] = number("angle", angle);
    if (velocity !== undefined) engine.row.set(pair("velocity", velocity), VX);
    if (spin !== undefined) engine.row[SPIN] = number("spin", spin);
    engine.disc[0] = BigInt(SCENE.order.indexOf(k));
    this.#put();
    const count = engine.play(what, this.#now.time);
    if (count < 0) throw this.#failure(count);
    this.#taken(count);
  }

  /** Take over what the board has become; its events. */
  #taken(count) {
    const { newNumbers, newWhole, newPieces, newDue, after, found } = engine;
    this.#now = kept(after[0], newNumbers, newWhole, newPieces, newDue);
    const events = Array.from({ length: count }, (_, n) => {
      const at = n * layout.event;
      const [time, what, who, partner, x, y, approach, slip, impulse, rub, lost] =
        found.subarray(at + 1, at + layout.event);
      return { time, what: SCENE.events[what], puck: called(who), partner: called(partner), x, y,
               approach, slip, impulse, rub, lost };
    });
    return SCENE.lines.length ? events.sort((one, other) => one.time - other.time) : events;
  }

  #failure(code, duration = 0) {
    if (code === codes.TOO_FAST) {
      return new RangeError(`a slip is faster than ${SCENE.fastest} m/s: beyond, nothing is known`);
    }
    if (code === codes.MISPLACED) {
      const [one, other] = [...engine.contact].map((partner) => called(Number(partner)));
      const depth = engine.depth[0].toPrecision(3);
      return new RangeError(`${one} would overlap ${other} by ${depth} m: put it elsewhere`);
    }
    return new Error(`the board cannot go on at ${this.#now.time} s: ${SCENE.failures[code] ??
      this.#squeezed(duration) ?? "what touches meets again and again"}`);
  }

  /** Who squeezes whom, if a puck that is driven comes to another within a duration. */
  #squeezed(duration) {
    const now = this.state(), fast = ({ vx, vy }) => Math.hypot(vx, vy);
    for (const [k, one] of now.entries()) {
      const near = now.findIndex((other, j) => SCENE.driven[k] && j !== k && other.inPlay
        && Math.hypot(one.x - other.x, one.y - other.y) - SCENE.radii[j] - SCENE.radii[k]
          <= (fast(one) + fast(other)) * Math.min(duration, 1) + 1e-6 * SCENE.radii[k]);
      if (near >= 0) {
        return `${SCENE.pucks[k]}, which is driven, squeezes ${SCENE.pucks[near]} against what ` +
          "does not give way: lead it elsewhere";
      }
    }
  }

  #number(puck) {
    const k = typeof puck === "string" ? SCENE.pucks.indexOf(puck) : puck;
    if (Number.isInteger(k) && k >= 0 && k < COUNT) return k;
    throw new RangeError(`there is no puck ${puck}: ${SCENE.pucks.join(", ")}`);
  }

  #kind(k) { return Number(this.#now.whole[SCENE.order.indexOf(k)]); }

  #inPlay(puck) {
    const k = this.#number(puck);
    if (this.#kind(k) !== codes.GONE) return k;
    throw new RangeError(`${SCENE.pucks[k]} is no longer in play: place puts it back`);
  }
}

let first;

/**
 * A board at the start of its scene.
 * @returns {Promise<Board>}
 */
async function load() {
  engine ??= await start();
  first ??= kept(0, engine.numbers, engine.whole, engine.pieces, engine.due);
  return new Board(first);
}

globalThis.puckBoard = { load, scene: SCENE };
(globalThis.puckBoards ??= {})[SCENE.title] = globalThis.puckBoard; // of several files
if (typeof module === "object") module.exports = globalThis.puckBoard;
})();
