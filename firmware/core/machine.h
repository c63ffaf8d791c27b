/* The program machine: which state, for how long, what it plays and how its force changes. */
#ifndef FDVV_MACHINE_H
#define FDVV_MACHINE_H

#include "image.h"
#include "velocity.h"

/* what one tick tells the program */
typedef struct {
    const fdvv_position *position;
    const fdvv_velocity *velocity;
    uint32_t elapsed_us;
    uint32_t events;           /* host events since the last tick, a bit each */
    uint16_t announced_mm_s16;
    int16_t command_cN64;      /* of the last tick, before drag and friction were taken off */
    int32_t ahead_um16;        /* where the cap will be when the coil pushes: the surface is looked up there */
} fdvv_moment;

typedef struct {
    uint8_t state;
    uint8_t running;
    uint8_t turned;         /* turns on offer */
    uint8_t slot;           /* to be played in this tick, or FDVV_NONE */
    int16_t from_cN64;      /* command on entering the state */
    fdvv_ratio lead;        /* ms from now to the first motion of a vibration started now */
    const fdvv_state *now;  /* the state in the image, while running */
    uint32_t ms;            /* since the state was entered, exact over any number of ticks; stops at INT32_MAX */
    uint32_t us;            /* and the rest below 1000 */
    uint32_t repeat_due_ms;
    int32_t deepest_um16, highest_um16; /* since the state was entered */
    uint32_t events;        /* host events on offer */
    int32_t reached_um16;   /* furthest in this stroke that a vibration started in time would be felt at */
    int32_t next_um16;      /* no vibration lies before it; both grow in the stroke's direction */
} fdvv_machine;

void fdvv_machine_init(fdvv_machine *machine, const fdvv_settings *settings);

/* The program is not rendered: the next tick enters its start state. */
void fdvv_machine_stop(fdvv_machine *machine);

/* Advance by a tick: at most one transition, at most one slot. */
void fdvv_machine_tick(fdvv_machine *machine, const uint8_t *image, const fdvv_moment *moment);

/* What the state wants: its surface and bias, faded from the last state's command; within int16. */
int16_t fdvv_machine_force_cN64(const fdvv_machine *machine, const uint8_t *image, const fdvv_moment *moment);

#endif
