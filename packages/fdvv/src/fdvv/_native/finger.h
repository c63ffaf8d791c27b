/* Model of the finger: muscle, referent, pulp and contact. Shared by rig_motion.h and button.c. */
#ifndef FDVV_FINGER_H
#define FDVV_FINGER_H

#include "fdvv.h"

#include <math.h>

/* Hunt-Crossley contact: damping proportional to depth, no adhesion. */
static inline double contact(double stiffness, double loss, double depth, double rate) {
    if (depth <= 0.0) return 0.0;
    double force = stiffness * depth * (1.0 + loss * rate);
    return force > 0.0 ? force : 0.0;
}

/* The conservative part of a contact's force. */
static inline double elastic(double stiffness, double depth) { return depth > 0.0 ? stiffness * depth : 0.0; }

/* Minimum jerk from `from` to `to` in `duration`, evaluated `t` after its start (Flash and Hogan 1985). */
static inline void minimum_jerk(double from, double to, double duration, double t, double *x, double *v) {
    double s = t / duration, q = 1.0 - s;
    *x = from + (to - from) * s * s * s * (10.0 + s * (6.0 * s - 15.0));
    *v = (to - from) * 30.0 * s * s * q * q / duration;
}

/* Equilibrium position of the finger and its velocity. */
static inline void referent(const fdvv_gesture *g, double t, double *x, double *v) {
    double up = t - g->onset_s - g->press_s - g->dwell_s;
    *x = g->start_m, *v = 0.0;
    if (t <= g->onset_s || up >= g->release_s) return;
    if (t < g->onset_s + g->press_s)
        minimum_jerk(g->start_m, g->end_m, g->press_s, t - g->onset_s, x, v);
    else if (up <= 0.0)
        *x = g->end_m;
    else
        minimum_jerk(g->end_m, g->start_m, g->release_s, up, x, v);
}

/* Force of the muscle on the finger at x, v, without motor noise. */
static inline double muscle(const fdvv_finger *f, const fdvv_gesture *g, double t, double x, double v) {
    double xr, vr;
    referent(g, t, &xr, &vr);
    return f->finger_stiffness_N_m * (xr - x) + f->finger_damping_N_s_m * (vr - v);
}

/* Force of the pulp at a compression, minus that of the strap; `arms` is the sum of the Maxwell elements' forces.
 * growth is the rate of the exponential, which drives these elements. */
static inline double pulp_force(const fdvv_finger *f, double depth, double rate, double arms, double *growth) {
    double exponential = f->pulp_scale_N * exp(f->pulp_exponent_1_m * (depth + f->strap_m));
    *growth = f->pulp_exponent_1_m * exponential * rate;
    return f->pulp_relaxed_ratio * (exponential - f->pulp_scale_N) + arms - f->strap_N;
}

/* Integral of the static pulp force over its compression, including the strap. */
static inline double pulp_energy(const fdvv_finger *f, double depth) {
    double total = depth + f->strap_m;
    return f->pulp_scale_N * (exp(f->pulp_exponent_1_m * total) / f->pulp_exponent_1_m - total);
}

#endif
