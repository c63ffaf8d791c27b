/* Simulation of a whole press: the rig, controlled by the core of the firmware. */
#ifndef FDVV_TWIN_H
#define FDVV_TWIN_H

#include "core.h"
#include "rig.h"

/* One press: its time is 0 when the record begins, settle_ticks after the start. */
typedef struct {
    fdvv_gesture gesture;
    double stiffness_N_m;
    double damping_N_s_m;
    int64_t settle_ticks;
    int64_t ticks;
    int64_t announced_mm_s16;
} fdvv_twin_press_plan;

/* Random numbers of a press, with n = settle_ticks + ticks; those of a tick belong to the readings at its end. */
typedef struct {
    const double *position_m;   /* (n, reads) */
    const double *force_N;      /* (n,) */
    const double *keycap;       /* (n,) */
    const double *effort_ratio; /* (n,) at the end of each tick */
    const double *latency;      /* (n,) */
} fdvv_twin_noise;

/* Start a rig at rest with the travel stop of an armed core and the waveforms of image, which the core renders. Writes
 * the readings of the first tick. Returns 0, or 1 if fdvv_rig_start or fdvv_rig_load fails. */
int fdvv_twin_begin(const fdvv_core *core, fdvv_rig *rig, const fdvv_rig_model *model, const fdvv_rig_grid *grid,
                    const uint8_t *image, fdvv_inputs *inputs);

/* Run core and rig for a number of ticks, with a message of the host before each. Unless rows is 0, writes rows,
 * tick_rows and outputs as fdvv_twin_press does. noise begins with that of the first tick. */
void fdvv_twin_run(fdvv_core *core, fdvv_rig *rig, int64_t ticks, const fdvv_twin_noise *noise, double *rows,
                   double *tick_rows, fdvv_outputs *outputs, fdvv_inputs *inputs);

/* Simulate one press from a cold, calibrated, armed rig at rest.
 *
 * settings and image must be valid; loop: gains of the force loop, or 0; image is aligned to four bytes.
 * Writes, from the beginning of the record: rows (ticks * steps_per_tick / steps_per_row, FDVV_RIG_COLUMNS);
 * tick_rows (ticks, FDVV_RIG_TICK_COLUMNS) at each tick; outputs (ticks,) of the core.
 * Returns 0; 1 if the grid is invalid; 2 if the plan is invalid or the core did not arm. */
int fdvv_twin_press(const fdvv_rig_model *model, const fdvv_rig_grid *grid, const fdvv_twin_press_plan *plan,
                    const fdvv_settings *settings, const fdvv_board_limits *limits, const fdvv_force_loop_gains *loop,
                    const uint8_t *image, const fdvv_twin_noise *noise, double *rows, double *tick_rows,
                    fdvv_outputs *outputs);

/* Sizes of the structures in bytes, for Python to compare with its own. */
void fdvv_twin_sizes(int64_t *plan_bytes, int64_t *noise_bytes, int64_t *outputs_bytes);

#endif
