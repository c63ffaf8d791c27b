/* One tick: from readings to duty. The same code runs on the board, on a PC and inside the twin. */
#ifndef FDVV_CORE_H
#define FDVV_CORE_H

#include "image.h"
#include "machine.h"
#include "position.h"
#include "predictor.h"
#include "supervisor.h"
#include "velocity.h"

typedef struct {
    int16_t command_cN64;    /* of the last tick */
    int16_t resistance_cN64; /* taken off it then */
    uint16_t announced_mm_s16;
    uint16_t stop_us;        /* servo pulse for the program's travel */
    fdvv_ratio drive;        /* duty per force, times the supply in mV */
    const uint8_t *image;    /* active and checked, or 0 */
    uint32_t events;         /* host events not yet seen by the program, a bit each */
    fdvv_settings settings;
    fdvv_machine machine;
    fdvv_supervisor supervisor;
    fdvv_position position;
    fdvv_velocity velocity;
    fdvv_predictor predictor;
} fdvv_core;

/* Start with checked settings (fdvv_settings_check), no program, mode boot. */
void fdvv_core_init(fdvv_core *core, const fdvv_settings *settings);

/* Use other checked settings; forgets position and velocity. Only while idle. */
void fdvv_core_set(fdvv_core *core, const fdvv_settings *settings);

/* Render this checked image from the next tick on (0: none); enters its start state. */
void fdvv_core_activate(fdvv_core *core, const uint8_t *image);

/* A host event 0 to 31. */
void fdvv_core_event(fdvv_core *core, uint8_t event);

/* The next press is meant to be this fast. */
void fdvv_core_announce(fdvv_core *core, uint16_t velocity_mm_s16);

void fdvv_core_tick(fdvv_core *core, const fdvv_inputs *inputs, fdvv_outputs *outputs);

#endif
