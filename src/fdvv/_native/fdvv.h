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

#endif
