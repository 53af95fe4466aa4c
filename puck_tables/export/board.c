#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "board.h"

enum { /*codes*/ };
static const struct { int32_t code; const char *text; } FAILURES[] = { /*failures*/ };

/* the engine: it plays what lies in the first slot of the arrays of a scene into the second */
int32_t puck_play(void *record, int32_t what, double until);
int32_t puck_see(void *record, double time);

/* addresses, as export/board_source.py lays them out */
struct puck_scene {
  void *record;
  double *row;
  int64_t *disc;
  double *time, *after, *numbers;
  int64_t *whole;
  double *pieces, *due, *found, *states;
  int64_t *moving, *contacts;
  double *depth;
  const double *first_numbers;
  const int64_t *first_whole;
  const double *first_pieces, *first_due;
  const int64_t *order, *discs, *driven;
  const double *radii, *limits;
  const struct { int64_t pucks, things, lines, numbers, whole, pieces, columns, event, events, shared, used; } *sizes;
  const char *names, *parts;
};

struct puck_board {
  const puck_scene *scene;
  double time, due;
  size_t pieces, room; /* numbers: in use, and for how many there is room */
  double *numbers, *piece;
  int64_t *whole;
  puck_event *events;
  int32_t count, space;
};

static char message[400];

static int32_t refuse(const char *format, ...) {
  va_list given;
  va_start(given, format);
  vsnprintf(message, sizeof message, format, given);
  va_end(given);
  return -1;
}

const char *puck_board_error(void) { return message; }

int32_t puck_scene_count(const puck_scene *scene) { return (int32_t)scene->sizes->pucks; }

const char *puck_scene_name(const puck_scene *scene, int32_t number) {
  int64_t at = number < 0 ? scene->sizes->pucks - 1 - (int64_t)number : number;
  const char *name = scene->names;
  if (number < 0 ? at >= scene->sizes->pucks + scene->sizes->things : at >= scene->sizes->pucks) return 0;
  while (at-- > 0) name += strlen(name) + 1;
  return name;
}

int32_t puck_scene_find(const puck_scene *scene, const char *name) {
  int32_t k = puck_scene_count(scene);
  while (--k >= 0 && strcmp(puck_scene_name(scene, k), name) != 0) {}
  return k;
}

double puck_scene_radius(const puck_scene *scene, int32_t puck) {
  return puck >= 0 && puck < scene->sizes->pucks ? scene->radii[puck] : NAN;
}

const char *puck_scene_parts(const puck_scene *scene) { return scene->parts; }

/* Take over a state; 0: there is no memory. */
static int keep(puck_board *board, double time, double due, const double *numbers, const int64_t *whole,
                const double *piece) {
  const puck_scene *scene = board->scene;
  size_t pieces = (size_t)((whole[scene->sizes->used] - scene->sizes->shared) * scene->sizes->columns);
  if (pieces > board->room) {
    double *more = realloc(board->piece, 2 * pieces * sizeof *more);
    if (!more) return 0;
    board->piece = more;
    board->room = 2 * pieces;
  }
  board->time = time;
  board->due = due;
  board->pieces = pieces;
  memcpy(board->numbers, numbers, (size_t)scene->sizes->numbers * sizeof *numbers);
  memcpy(board->whole, whole, (size_t)scene->sizes->whole * sizeof *whole);
  if (pieces) memcpy(board->piece, piece, pieces * sizeof *piece);
  return 1;
}

static puck_board *made(const puck_scene *scene, double time, double due, const double *numbers,
                        const int64_t *whole, const double *piece) {
  puck_board *board = calloc(1, sizeof *board);
  if (!board) return 0;
  board->scene = scene;
  board->numbers = malloc((size_t)scene->sizes->numbers * sizeof *numbers);
  board->whole = malloc((size_t)scene->sizes->whole * sizeof *whole);
  if (board->numbers && board->whole && keep(board, time, due, numbers, whole, piece)) return board;
  puck_board_free(board);
  return 0;
}

puck_board *puck_board_new(const puck_scene *scene) {
  return made(scene, 0.0, *scene->first_due, scene->first_numbers, scene->first_whole,
              scene->first_pieces);
}

puck_board *puck_board_copy(const puck_board *board) {
  return made(board->scene, board->time, board->due, board->numbers, board->whole, board->piece);
}

int32_t puck_board_become(puck_board *board, const puck_board *other) {
  if (board->scene != other->scene) return refuse("the boards are of two scenes");
  if (board == other) return 0;
  if (keep(board, other->time, other->due, other->numbers, other->whole, other->piece)) return 0;
  return refuse("there is no memory");
}

void puck_board_free(puck_board *board) {
  if (!board) return;
  free(board->numbers);
  free(board->whole);
  free(board->piece);
  free(board->events);
  free(board);
}

double puck_board_time(const puck_board *board) { return board->time; }

/* To the first slot, where the engine finds it. */
static const puck_scene *put(const puck_board *board) {
  const puck_scene *scene = board->scene;
  memcpy(scene->numbers, board->numbers, (size_t)scene->sizes->numbers * sizeof(double));
  memcpy(scene->whole, board->whole, (size_t)scene->sizes->whole * sizeof(int64_t));
  if (board->pieces) memcpy(scene->pieces, board->piece, board->pieces * sizeof(double));
  scene->due[0] = board->due;
  scene->time[0] = board->time;
  return scene;
}

static int in_play(const puck_board *board, int32_t puck) {
  return board->whole[board->scene->discs[puck]] != GONE;
}

void puck_board_state(const puck_board *board, puck_motion *pucks) {
  const puck_scene *scene = put(board);
  puck_see(scene->record, board->time);
  for (int32_t k = 0; k < scene->sizes->pucks; k++) {
    memcpy(&pucks[k], &scene->states[6 * k], 6 * sizeof(double));
    pucks[k].moving = scene->moving[k] > 0;
    pucks[k].in_play = in_play(board, k);
  }
}

static int32_t known(const puck_scene *scene, double partner) {
  return (int32_t)(partner < 0.0 ? partner : (double)scene->order[(int64_t)partner]);
}

/* Take over what the board has become, and its events; 0: there is no memory. */
static int taken(puck_board *board, int32_t count) {
  const puck_scene *scene = board->scene;
  if (board->count + count > board->space) {
    int32_t space = 2 * (board->count + count);
    puck_event *more = realloc(board->events, (size_t)space * sizeof *more);
    if (!more) return 0;
    board->events = more;
    board->space = space;
  }
  if (!keep(board, scene->after[0], scene->due[1], scene->numbers + scene->sizes->numbers,
            scene->whole + scene->sizes->whole, scene->pieces + scene->sizes->pieces)) return 0;
  for (int32_t n = 0; n < count; n++) {
    const double *row = scene->found + n * scene->sizes->event + 1;
    puck_event event = {row[0], (int32_t)row[1], known(scene, row[2]), known(scene, row[3]), 0, row[4],
                        row[5], row[6], row[7], row[8], row[9], row[10]};
    int32_t at = board->count++; /* passings of lines come last */
    for (; scene->sizes->lines && at > 0 && board->events[at - 1].time > event.time; at--) {
      board->events[at] = board->events[at - 1];
    }
    board->events[at] = event;
  }
  return 1;
}

/* Whom a puck that is driven squeezes within a duration, if that is why the engine cannot go on. */
static int32_t squeezed(const puck_board *board, double duration) {
  const puck_scene *scene = board->scene;
  int32_t count = puck_scene_count(scene);
  puck_motion *now = malloc((size_t)count * sizeof *now);
  if (!now) return refuse("there is no memory");
  puck_board_state(board, now);
  for (int32_t k = 0; k < count; k++) {
    for (int32_t j = 0; scene->driven[k] && j < count; j++) {
      double fast = hypot(now[k].vx, now[k].vy) + hypot(now[j].vx, now[j].vy);
      double gap = hypot(now[k].x - now[j].x, now[k].y - now[j].y) - scene->radii[j] - scene->radii[k];
      if (j == k || !now[j].in_play || gap > fast * fmin(duration, 1.0) + 1e-6 * scene->radii[k]) continue;
      free(now);
      return refuse("the board cannot go on at %g s: %s, which is driven, squeezes %s against what does "
                    "not give way: lead it elsewhere", board->time, puck_scene_name(scene, k),
                    puck_scene_name(scene, j));
    }
  }
  free(now);
  return refuse("the board cannot go on at %g s: what touches meets again and again", board->time);
}

static int32_t failed(const puck_board *board, int32_t code, double duration) {
  const puck_scene *scene = board->scene;
  if (code == TOO_FAST) {
    return refuse("a slip is faster than %g m/s: beyond, nothing is known", scene->limits[FASTEST]);
  }
  if (code == MISPLACED) {
    const char *one = puck_scene_name(scene, known(scene, (double)scene->contacts[0]));
    const char *other = puck_scene_name(scene, known(scene, (double)scene->contacts[1]));
    return refuse("%s would overlap %s by %.3g m: put it elsewhere", one, other, scene->depth[0]);
  }
  for (size_t n = 0; n < sizeof FAILURES / sizeof *FAILURES; n++) {
    if (FAILURES[n].code == code) {
      return refuse("the board cannot go on at %g s: %s", board->time, FAILURES[n].text);
    }
  }
  return squeezed(board, duration);
}

/* What happens up to a time; what the engine has no room for at once goes in two halves. */
static int32_t until(puck_board *board, double time, int depth) {
  double now = board->time, middle = time == HUGE_VAL ? now + 1.0 : now + (time - now) / 2.0;
  int32_t count = puck_play(put(board)->record, LET_GO, time);
  if (count >= 0) return taken(board, count) ? 0 : refuse("there is no memory");
  if (count == NOTHING_HAPPENS) {
    board->time = time;
    return 0;
  }
  if (!(count == FULL || count == PAUSED || count == LACKS_PIECES) || !(middle > now) || depth == 40) {
    return failed(board, count, time - now);
  }
  puck_board *before = depth ? 0 : puck_board_copy(board);
  if (!depth && !before) return refuse("there is no memory");
  int32_t done = until(board, middle, depth + 1) < 0 ? -1 : until(board, time, depth + 1);
  if (done < 0 && before) puck_board_become(board, before);
  puck_board_free(before);
  return done;
}

int32_t puck_board_advance(puck_board *board, double duration, const puck_event **events) {
  if (!(duration >= 0.0)) return refuse("duration must not be negative, got %g s", duration);
  board->count = 0;
  int32_t done = until(board, board->time + duration, 0);
  if (events) *events = board->events;
  return done < 0 ? done : board->count;
}

/* Do something to a puck: a row of its place, angle, velocity and spin; NAN: as it is. */
static int32_t hand(puck_board *board, int32_t what, int32_t puck, const double *row, int given) {
  const puck_scene *scene = board->scene;
  if (puck < 0 || puck >= scene->sizes->pucks) return refuse("there is no puck %d", (int)puck);
  const char *name = puck_scene_name(scene, puck);
  for (int n = 6 - given; n < 6; n++) {
    if (!isfinite(row[n])) return refuse("what is given to %s must be finite numbers, got %g", name, row[n]);
  }
  if (what != PLACED && !in_play(board, puck)) {
    return refuse("%s is no longer in play: place puts it back", name);
  }
  if (what == STRUCK && scene->driven[puck]) return refuse("%s is driven: use drive", name);
  if (what == LED && !scene->driven[puck]) return refuse("%s is not led by hand: strike it", name);
  for (int n = 0; n < 6; n++) scene->row[n] = n < 6 - given ? NAN : row[n];
  scene->disc[0] = scene->discs[puck];
  int32_t count = puck_play(put(board)->record, what, board->time);
  if (count < 0) return failed(board, count, 0.0);
  board->count = 0;
  return taken(board, count) ? 0 : refuse("there is no memory");
}

int32_t puck_board_strike(puck_board *board, int32_t puck, double vx, double vy, double spin) {
  return hand(board, STRUCK, puck, (double[]){0.0, 0.0, 0.0, vx, vy, spin}, 3);
}

int32_t puck_board_place(puck_board *board, int32_t puck, double x, double y, double angle, double vx,
                         double vy, double spin) {
  return hand(board, PLACED, puck, (double[]){x, y, angle, vx, vy, spin}, 6);
}

int32_t puck_board_remove(puck_board *board, int32_t puck) {
  return hand(board, REMOVED, puck, (double[6]){0.0}, 0);
}

int32_t puck_board_drive(puck_board *board, int32_t puck, double vx, double vy, double spin) {
  return hand(board, LED, puck, (double[]){0.0, 0.0, 0.0, vx, vy, spin}, 3);
}
