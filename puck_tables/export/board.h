/* A board that is played exactly, from event to event; made by puck-tables /*version*/.

     #include "/*name*/.h"
     puck_board *board = puck_board_new(&/*name*/_scene);
     puck_board_strike(board, /*number*/, 1.0, 0.0, 5.0);              // /*puck*/
     const puck_event *events;
     int count = puck_board_advance(board, 1.0 / 60.0, &events);

   Lengths are in m, times in s, angles in rad, masses in kg.  Nothing is stepped: a call costs what
   happens in it, and the same calls give the same bits on every machine.  Calls that can be refused
   give -1 then, and change nothing; puck_board_error() says why.  One thread at a time calls.  Link
   lib/*name*/.a, and -lm where the machine has one.

/*licence*/*/
#ifndef PUCK_BOARD_H
#define PUCK_BOARD_H
#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif

typedef struct puck_scene puck_scene; /* a board at its start, and where it is played */
typedef struct puck_board puck_board; /* how it stands; any number of a scene */

typedef struct {
  double x, y, angle, vx, vy, spin;
  int32_t moving, in_play;
} puck_motion;

/* what happened: of this puck with its partner, from 0 on a puck, below a thing (puck_scene_name);
   m, m/s, kg m/s, J, as results.Event of the package */
typedef struct {
  double time;
  int32_t what, puck, partner, unused;
  double x, y, approach, slip, impulse, rub, lost;
} puck_event;

enum { /*events*/ };

/* Of a scene: how many pucks, the number of one by its name (-1: none is called so), the name of a
   puck or a thing (0: there is none), radius m, the whole as JSON for who draws. */
int32_t puck_scene_count(const puck_scene *scene);
int32_t puck_scene_find(const puck_scene *scene, const char *name);
const char *puck_scene_name(const puck_scene *scene, int32_t number);
double puck_scene_radius(const puck_scene *scene, int32_t puck);
const char *puck_scene_parts(const puck_scene *scene);

/* A board at the start of its scene; one that goes on from another, to look ahead; a board that
   becomes as another of its scene.  0 and -1 where there is no memory. */
puck_board *puck_board_new(const puck_scene *scene);
puck_board *puck_board_copy(const puck_board *board);
int32_t puck_board_become(puck_board *board, const puck_board *other);
void puck_board_free(puck_board *board);

/* Now, s; all pucks, in an array with room for them. */
double puck_board_time(const puck_board *board);
void puck_board_state(const puck_board *board, puck_motion *pucks);

/* Send a puck off; put it somewhere, also back from a pocket; take it out of play; move one that is
   led by hand, a mallet, until the next call. */
int32_t puck_board_strike(puck_board *board, int32_t puck, double vx, double vy, double spin);
int32_t puck_board_place(puck_board *board, int32_t puck, double x, double y, double angle, double vx,
                         double vy, double spin);
int32_t puck_board_remove(puck_board *board, int32_t puck);
int32_t puck_board_drive(puck_board *board, int32_t puck, double vx, double vy, double spin);

/* Let time pass, s (HUGE_VAL: until nothing more can happen): how many events there were; they stay
   until the next call, and events may be 0. */
int32_t puck_board_advance(puck_board *board, double duration, const puck_event **events);

/* Why the last call was refused. */
const char *puck_board_error(void);

#ifdef __cplusplus
}
#endif
#endif

#ifdef __cplusplus
extern "C"
#else
extern
#endif
const puck_scene /*name*/_scene;
