/* One tick: from readings to duty. The same code runs on the board, on a PC and inside the twin. */
#ifndef FDVV_CORE_H
#define FDVV_CORE_H

#include "image.h"
#include "machine.h"
#include "position.h"
#include "predictor.h"
#include "supervisor.h"
#include "velocity.h"

#ifdef FDVV_FORCE_LOOP
#include "force_loop.h"
#endif

typedef struct {
    fdvv_supervisor supervisor;
    int16_t command_cN64;    /* of the last tick */
    int16_t resistance_cN64; /* drag and friction subtracted from it */
    uint16_t announced_mm_s16;
    uint16_t stop_us;        /* servo pulse for the program's travel */
    fdvv_ratio drive;        /* duty per force, multiplied by the supply in mV */
    const uint8_t *image;    /* the active program, checked; or 0 */
    uint32_t events;         /* host events since the last tick, one bit each */
    fdvv_settings settings;
    fdvv_machine machine;
    fdvv_position position;
    fdvv_velocity velocity;
    fdvv_predictor predictor;
#ifdef FDVV_FORCE_LOOP
    fdvv_force_loop loop;
#endif
} fdvv_core;

/* Start in mode boot with checked settings (fdvv_settings_check) and no program. limits: as for fdvv_supervisor_init. */
void fdvv_core_init(fdvv_core *core, const fdvv_settings *settings, const fdvv_board_limits *limits);

/* Replace the settings by other checked ones; resets position and velocity. Only while idle. */
void fdvv_core_set(fdvv_core *core, const fdvv_settings *settings);

/* Render this checked image (0: none) from the next tick on, beginning with its start state. */
void fdvv_core_activate(fdvv_core *core, const uint8_t *image);

/* A host event 0 to 31. */
void fdvv_core_event(fdvv_core *core, uint8_t event);

/* Announce the velocity of the next press. */
void fdvv_core_announce(fdvv_core *core, uint16_t velocity_mm_s16);

#ifdef FDVV_FORCE_LOOP
/* Close the force loop with these gains from the next tick on; 0: render by tables. Only while idle. */
void fdvv_core_close_loop(fdvv_core *core, const fdvv_force_loop_gains *gains);

/* Why the loop was opened by itself: FDVV_LOOP_FAULT_… */
uint8_t fdvv_core_loop_fault(const fdvv_core *core);
#endif

void fdvv_core_tick(fdvv_core *core, const fdvv_inputs *inputs, fdvv_outputs *outputs);

/* After each tick, once its outputs are set: what can wait until then, with the same inputs. */
void fdvv_core_after_tick(fdvv_core *core, const fdvv_inputs *inputs);

#endif
