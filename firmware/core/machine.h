/* State machine of a program: transitions, vibrations and force. */
#ifndef FDVV_MACHINE_H
#define FDVV_MACHINE_H

#include "image.h"
#include "velocity.h"

/* inputs of one tick */
typedef struct {
    const fdvv_position *position;
    const fdvv_velocity *velocity;
    uint32_t elapsed_us;
    uint32_t events;           /* host events since the last tick, one bit each */
    uint16_t announced_mm_s16;
    int16_t command_cN64;      /* of the last tick, before drag and friction were subtracted */
    int32_t ahead_um16;        /* predicted displacement when the coil acts: the surface is evaluated there */
} fdvv_machine_inputs;

typedef struct {
    uint8_t state;
    uint8_t running;
    uint8_t turned;         /* pending reversals, FDVV_TURNED_… */
    uint8_t slot;           /* to start in this tick, or FDVV_NONE */
    int16_t from_cN64;      /* command on entering the state */
    fdvv_ratio lead;        /* ms from the command to the first motion of a vibration */
    const fdvv_state *now;  /* the state in the image; valid while running */
    uint32_t ms;            /* since the state was entered; saturates at INT32_MAX */
    uint32_t us;            /* the remainder below 1000 */
    uint32_t repeat_due_ms;
    int32_t deepest_um16, highest_um16; /* since the state was entered */
    uint32_t events;        /* pending host events */
    int32_t reached_um16;   /* largest predicted displacement in this stroke; increases in its direction */
    int32_t next_um16;      /* no vibration lies between reached_um16 and this */
} fdvv_machine;

void fdvv_machine_init(fdvv_machine *machine, const fdvv_settings *settings);

/* Stop the program: the next tick enters its start state. */
void fdvv_machine_stop(fdvv_machine *machine);

/* Advance by one tick: at most one transition and one vibration. */
void fdvv_machine_tick(fdvv_machine *machine, const uint8_t *image, const fdvv_machine_inputs *in);

/* Force of the state: its surface plus bias, faded in from the command of the last state; clamped to int16. */
int16_t fdvv_machine_force_cN64(const fdvv_machine *machine, const uint8_t *image, const fdvv_machine_inputs *in);

#endif
