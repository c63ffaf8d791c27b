/* What the compiled library offers to Python. All arrays are C-contiguous doubles owned by the caller. */
#ifndef FDVV_H
#define FDVV_H

#include <stdint.h>

/* -- spline_fit.c: least-squares B-splines with knots that are free to move -- */

/* n samples (x rising strictly, y, weights w), m coefficients of a degree (1 to 3); no two knots closer than
 * spacing; the search ends after that many exchanges of knots. Fills t (m + degree + 1 clamped knots) and
 * c (m). Returns the weighted sum of squared errors, or -1 if memory or the sizes do not allow a fit. */
double fdvv_spline_free_knots(int n, const double *x, const double *y, const double *w, int degree, int m,
                              double spacing, int exchanges, double *t, double *c);

/* -- twins: finger and gesture, shared; SI units, x positive downward -- */

/* The finger that presses: one mass on a spring and a damper, pulp with two relaxing arms. */
typedef struct {
    double finger_mass_kg;
    double finger_stiffness_N_m;
    double finger_damping_N_s_m;
    double pulp_scale_N;
    double pulp_exponent_1_m;
    double pulp_relaxed_ratio;
    double pulp_fast_ratio;
    double pulp_slow_ratio;
    double pulp_fast_s;
    double pulp_slow_s;
    double strap_N;
    double strap_m;
} fdvv_finger;

/* Where its referent goes: minimum jerk down, dwell, minimum jerk back. */
typedef struct {
    double start_m;
    double end_m;
    double onset_s;
    double press_s;
    double dwell_s;
    double release_s;
} fdvv_gesture;

/* -- twin.c: finger, rig and controller of one press -- */

/* What does not change during a press. A loss is 1.5 times Hunt and Crossley's alpha. */
typedef struct {
    fdvv_finger finger;
    double sensor_mass_kg;
    double contact_stiffness_N_m;
    double contact_loss_s_m;
    double force_constant_N_A;
    double droop_1_m2;
    double droop_centre_m;
    double resistance_ohm;
    double inductance_H;
    double supply_V;
    double current_loop_s;
    double moving_mass_kg;
    double gravity_m_s2;
    double coulomb_N;
    double coulomb_speed_m_s;
    double viscous_N_s_m;
    double travel_m;
    double stop_stiffness_N_m;
    double stop_loss_s_m;
    double top_stiffness_N_m;
    double top_loss_s_m;
    double lvdt_rad_s;
    double lvdt_linearity_m;
    double lvdt_range_m;
    double lvdt_lsb_m;
    double sensor_rc_s;
    double sensor_gain;
    double sensor_hysteresis_N;
    double sensor_full_scale_N;
    double sensor_lsb_N;
    double window_start_m;
    double window_end_m;
    double reversal_m;
    double rearm_m;
    double announced_m_s;
    double velocity_scale;
    double force_limit_N;
    double drive_per_N;
    double drive_lsb;
    double drive_low;
    double drive_high;
    fdvv_gesture gesture;
    double table_start_m;
    double table_step_m;
    double step_s;
} fdvv_twin_model;

/* How a press is cut into steps, ticks and rows, and how large its arrays are. */
typedef struct {
    int64_t settle_ticks;    /* run before the record starts */
    int64_t ticks;           /* recorded */
    int64_t steps_per_tick;
    int64_t steps_per_row;   /* divides steps_per_tick */
    int64_t delay_steps;     /* tick to command; less than steps_per_tick */
    int64_t reads;           /* converter reads averaged per tick */
    int64_t read_steps;      /* between two reads; reads * read_steps at most steps_per_tick */
    int64_t average_ticks;   /* sliding mean over ticks, 1 to FDVV_TWIN_WINDOW */
    int64_t fewest_samples;  /* for a velocity, 2 to FDVV_TWIN_WINDOW */
    int64_t displacements;   /* of the table */
    int64_t velocities;      /* of the table */
    int64_t audit;           /* 1: account for energy, an eighth slower */
} fdvv_twin_grid;

#define FDVV_TWIN_WINDOW 64
#define FDVV_TWIN_COLUMNS 13

/* Simulate one press.
 *
 * speeds_m_s (velocities,); table_N (2, velocities, displacements), press then release.
 * position_noise_m (settle_ticks + ticks, reads); force_noise_N (settle_ticks + ticks,);
 * effort_ratio (settle_ticks + ticks + 1,) modulates the finger's own force, linear between ticks.
 * rows (ticks * steps_per_tick / steps_per_row, FDVV_TWIN_COLUMNS), written: time s, cap m, cap m/s,
 * contact force N, sensed m, sensed N, commanded N, saturated 0/1, release 0/1, tick 0/1, current A,
 * finger m, energy unaccounted for J (0 without audit).
 * Returns 0, or 1 if a count or size is out of its bounds (nothing is written then).
 */
int fdvv_twin_press(const fdvv_twin_model *model, const fdvv_twin_grid *grid, const double *speeds_m_s,
                    const double *table_N, const double *position_noise_m, const double *force_noise_N,
                    const double *effort_ratio, double *rows);

/* Tell the sizes of the two structures in bytes, for Python to compare with its own. */
void fdvv_twin_sizes(int64_t *model_bytes, int64_t *grid_bytes);

#endif
