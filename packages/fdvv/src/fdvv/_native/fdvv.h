/* Functions of the compiled library for Python. All arrays are C-contiguous doubles owned by the caller. */
#ifndef FDVV_H
#define FDVV_H

#include <stdint.h>

/* -- spline.c -- */

/* Evaluate a spline of degree k (0 to 5) with n coefficients c on the clamped knots t (n + k + 1), or its derivative of
 * order nu (0 to k), at count places x within the knots. Writes y (count). Returns 0, or -1 for invalid sizes. */
int fdvv_spline_evaluate(long n, int k, const double *t, const double *c, int nu, long count, const double *x,
                         double *y);

/* -- spline_fit.c: free-knot least-squares B-splines -- */

/* Fit m coefficients of a degree (1 to 3) to n samples (x strictly increasing, y, weights w). Knots are at least
 * spacing apart; the search tries at most `exchanges` exchanges of knots. Writes t (m + degree + 1 clamped knots) and
 * c (m). Returns the weighted sum of squared errors, or -1 if there is not enough memory or the sizes are invalid. */
double fdvv_spline_free_knots(int n, const double *x, const double *y, const double *w, int degree, int m,
                              double spacing, int exchanges, double *t, double *c);

/* Search on from the knots in t, which are replaced; the rest is as above. */
double fdvv_spline_refine(int n, const double *x, const double *y, const double *w, int degree, int m, double spacing,
                          int exchanges, double *t, double *c);

/* Knots and squared errors of every number of coefficients from most (at most 64) down to least, each found from the one
 * before by removing a knot. Fewer than most are started with where the samples do not hold as many. Writes errors
 * [m] and knots[68 m ...], m + degree + 1 of them; both have room for most + 1 sizes, what is below least or above the
 * start stays as it is. Returns the size started with, or -1 as above. */
int fdvv_spline_path(int n, const double *x, const double *y, int degree, int least, int most, double spacing,
                     double *errors, double *knots);

/* -- finger and gesture, shared by the simulations; SI units, x positive downward -- */

/* The finger: a mass driven by a spring and a damper (the muscle), and a pulp with two Maxwell elements. */
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

/* Motion of the referent (equilibrium position): minimum jerk down, dwell, minimum jerk back. */
typedef struct {
    double start_m;
    double end_m;
    double onset_s;
    double press_s;
    double dwell_s;
    double release_s;
} fdvv_gesture;

#endif
