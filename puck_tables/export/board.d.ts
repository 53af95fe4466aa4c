// What a board in JavaScript, made by puck-tables, has for TypeScript; of several files it is one.
// Lengths are in m, times in s, angles in rad, masses in kg.
declare namespace puckBoard {
  /** A board at the start of its scene. */ function load(): Promise<Board>;
  var scene: Scene;
  interface Board {
    readonly time: number; readonly names: string[];
    /** Infinity: until nothing more can happen. */ advance(duration: number): Event[];
    strike(puck: number | string, given: Strike): void;
    place(puck: number | string, given: Place): void;
    remove(puck: number | string): void;
    /** Until the next call. */ drive(puck: number | string, velocity: Pair, spin?: number): void;
    state(): State[]; copy(): Board;
  }
  interface State {
    x: number; y: number; angle: number; vx: number; vy: number; spin: number;
    moving: boolean; inPlay: boolean;
  }
  interface Event {
    time: number; what: string; puck: string; partner: string; x: number; y: number;
    approach: number; slip: number; impulse: number; rub: number; lost: number;
  }
  interface Strike { velocity?: Pair; spin?: number; }
  interface Place { position?: Pair; angle?: number; velocity?: Pair; spin?: number; }
  interface Pair extends Readonly<[number, number]> {}
  interface Scene {
    title: string; pucks: string[]; radii: number[]; driven: boolean[];
    parts: { [name: string]: any }; // the scene as its file has it
  }
}
declare var puckBoards: { [title: string]: typeof puckBoard };
