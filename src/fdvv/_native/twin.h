/* A whole press in one call: the rig, and the firmware's own core that runs it. */
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

/* What is random about it, n = settle_ticks + ticks; noise of a tick is that of the readings at its end. */
typedef struct {
    const double *position_m;   /* (n, reads) */
    const double *force_N;      /* (n,) */
    const double *keycap;       /* (n,) */
    const double *effort_ratio; /* (n,) at the end of each tick */
    const double *latency;      /* (n,) */
} fdvv_twin_noise;

/* Start a rig at rest under an armed core, its stop where the core has it, its exciter's board with the waveforms of
 * image, which the core renders; gives the readings of the first tick. 0, or 1 as fdvv_rig_start and fdvv_rig_load. */
int fdvv_twin_begin(const fdvv_core *core, fdvv_rig *rig, const fdvv_rig_model *model, const fdvv_rig_grid *grid,
                    const uint8_t *image, fdvv_inputs *inputs);

/* Go on for so many ticks, the host heard before each: the core on the readings, the rig on the core's outputs.
 * Unless rows is 0, writes rows, told and outputs as fdvv_twin_press does; noise begins with the first tick's. */
void fdvv_twin_run(fdvv_core *core, fdvv_rig *rig, int64_t ticks, const fdvv_twin_noise *noise, double *rows,
                   double *told, fdvv_outputs *outputs, fdvv_inputs *inputs);

/* Simulate one press from a cold, calibrated, armed rig at rest.
 *
 * settings and image are those of the firmware, both checked by the caller; image is four-byte aligned.
 * Writes, from the beginning of the record: rows (ticks * steps_per_tick / steps_per_row, FDVV_RIG_COLUMNS);
 * told (ticks, FDVV_RIG_TOLD) at each tick; outputs (ticks,) of the core.
 * Returns 0; 1 if a count of the grid is impossible; 2 if one of the plan is, or the core did not arm. */
int fdvv_twin_press(const fdvv_rig_model *model, const fdvv_rig_grid *grid, const fdvv_twin_press_plan *plan,
                    const fdvv_settings *settings, const uint8_t *image, const fdvv_twin_noise *noise, double *rows,
                    double *told, fdvv_outputs *outputs);

/* Sizes of the structures in bytes, for Python to compare with its own. */
void fdvv_twin_sizes(int64_t *plan_bytes, int64_t *noise_bytes, int64_t *outputs_bytes);

#endif
