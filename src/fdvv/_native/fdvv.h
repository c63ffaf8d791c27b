/* What the compiled library offers to Python. All arrays are C-contiguous doubles owned by the caller. */
#ifndef FDVV_H
#define FDVV_H

/* spline_fit.c: least-squares B-splines with knots that are free to move.
 *
 * n samples (x rising strictly, y, weights w), m coefficients of a degree (1 to 3); no two knots closer than
 * spacing; the search ends after that many exchanges of knots. Fills t (m + degree + 1 clamped knots) and
 * c (m). Returns the weighted sum of squared errors, or -1 if memory or the sizes do not allow a fit. */
double fdvv_spline_free_knots(int n, const double *x, const double *y, const double *w, int degree, int m, double spacing,
                              int exchanges, double *t, double *c);

#endif
