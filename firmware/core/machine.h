/* The program machine: which state, for how long, what it plays and how its force changes. */
#ifndef FDVV_MACHINE_H
#define FDVV_MACHINE_H

#include "image.h"
#include "position.h"

/* what one tick tells the program */
typedef struct {
    int32_t displacement_um16;
    uint32_t elapsed_us;
    uint32_t events;                                 /* host events since the last tick, a bit each */
    uint16_t velocity_mm_s16[FDVV_VELOCITY_SOURCES]; /* by source, never negative */
    int16_t signed_mm_s16;                           /* continuous, positive downward */
    int16_t command_cN64;                            /* of the last tick */
    uint8_t release;
    uint8_t turned;                                  /* FDVV_TURNED_… */
} fdvv_moment;

typedef struct {
    uint32_t ms;            /* since the state was entered, exact over any number of ticks; stops at INT32_MAX */
    uint32_t us;            /* and the rest below 1000 */
    uint32_t repeat_due_ms;
    int32_t deepest_um16, highest_um16; /* since the state was entered */
    uint32_t events;        /* host events on offer */
    uint32_t coming;        /* vibrations whose point lies ahead in this stroke, a bit each */
    uint32_t passed;        /* vibrations whose point was crossed in this stroke */
    fdvv_ratio lead;        /* ms from now to the first motion of a vibration started now */
    int16_t from_cN64;      /* command on entering the state */
    uint8_t state;
    uint8_t running;
    uint8_t turned;         /* turns on offer */
    uint8_t slot;           /* to be played in this tick, or FDVV_NONE */
} fdvv_machine;

void fdvv_machine_init(fdvv_machine *machine, const fdvv_settings *settings);

/* The program is not rendered: the next tick enters its start state. */
void fdvv_machine_stop(fdvv_machine *machine);

/* Advance by a tick: at most one transition, at most one slot. */
void fdvv_machine_tick(fdvv_machine *machine, const uint8_t *image, const fdvv_moment *moment);

/* What the state wants: its surface and bias, faded from the last state's command; within int16. */
int16_t fdvv_machine_force_cN64(const fdvv_machine *machine, const uint8_t *image, const fdvv_moment *moment);

#endif
