/* What the compiled library offers to Python. All arrays are C-contiguous doubles owned by the caller. */
#ifndef FDVV_H
#define FDVV_H

/* spline_fit.c: least-squares B-splines with knots that are free to move.
 *
 * n samples (x rising strictly, y, weights w), m coefficients of a degree (1 to 3), t (m + degree + 1) clamped knots.
 * Each returns the weighted sum of squared errors, or -1 if memory or the sizes do not allow a fit. */
double fdvv_spline_lsq(int n, const double *x, const double *y, const double *w, int degree, int m, const double *t,
                       double *c);
double fdvv_spline_free_knots(int n, const double *x, const double *y, const double *w, int degree, int m, double spacing,
                              int exchanges, double *t, double *c);

#endif
