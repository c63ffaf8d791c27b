/* The finger as every twin has it: muscle, referent, pulp and contact. Included by twin.c and button.c. */
#ifndef FDVV_FINGER_H
#define FDVV_FINGER_H

#include "fdvv.h"

#include <math.h>

/* Hunt and Crossley: stiffness with a loss that grows with depth; never pulls. */
static inline double contact(double stiffness, double loss, double depth, double rate) {
    if (depth <= 0.0) return 0.0;
    double force = stiffness * depth * (1.0 + loss * rate);
    return force > 0.0 ? force : 0.0;
}

/* The part of a contact's force that it gives back. */
static inline double elastic(double stiffness, double depth) { return depth > 0.0 ? stiffness * depth : 0.0; }

/* Minimum jerk from `from` to `to` in `duration`, evaluated `t` after its start (Flash and Hogan 1985). */
static inline void minimum_jerk(double from, double to, double duration, double t, double *x, double *v) {
    double s = t / duration, q = 1.0 - s;
    *x = from + (to - from) * s * s * s * (10.0 + s * (6.0 * s - 15.0));
    *v = (to - from) * 30.0 * s * s * q * q / duration;
}

/* Where the finger means to be. */
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

/* What the referent pulls the finger at x, v with, without the noise of its effort. */
static inline double muscle(const fdvv_finger *f, const fdvv_gesture *g, double t, double x, double v) {
    double xr, vr;
    referent(g, t, &xr, &vr);
    return f->finger_stiffness_N_m * (xr - x) + f->finger_damping_N_s_m * (vr - v);
}

/* Force of the pulp beyond the strap's, squeezed by depth, its arms carrying `arms`; growth feeds the arms. */
static inline double squeeze(const fdvv_finger *f, double depth, double rate, double arms, double *growth) {
    double swelling = f->pulp_scale_N * exp(f->pulp_exponent_1_m * (depth + f->strap_m));
    *growth = f->pulp_exponent_1_m * swelling * rate;
    return f->pulp_relaxed_ratio * (swelling - f->pulp_scale_N) + arms - f->strap_N;
}

/* Integral of the pulp's static force over its squeeze, strap included. */
static inline double swollen(const fdvv_finger *f, double depth) {
    double deep = depth + f->strap_m;
    return f->pulp_scale_N * (exp(f->pulp_exponent_1_m * deep) / f->pulp_exponent_1_m - deep);
}

#endif
