/* Values of a B-spline and of its derivatives.
 *
 * The recurrence is de Boor's (A Practical Guide to Splines, ch. X), in the order of operations of SciPy's
 * scipy.interpolate.BSpline, so that the bits are the same. */
#include "fdvv.h"

#include <string.h>

enum { MAX_DEGREE = 5 };

/* Write the k + 1 basis functions, or their derivatives of order nu, that are not zero on [t[ell], t[ell + 1]). */
static void basis(const double *t, double x, int k, long ell, int nu, double *h) {
    double before[MAX_DEGREE + 1];
    h[0] = 1.0;
    for (int j = 1; j <= k; j++) {
        memcpy(before, h, (size_t)j * sizeof(double));
        h[0] = 0.0;
        for (int n = 1; n <= j; n++) {
            double right = t[ell + n], left = t[ell + n - j];
            if (right == left) {
                h[n] = 0.0;
            } else if (j <= k - nu) {
                double w = before[n - 1] / (right - left);
                h[n - 1] += w * (right - x);
                h[n] = w * (x - left);
            } else {
                double w = j * before[n - 1] / (right - left);
                h[n - 1] -= w;
                h[n] = w;
            }
        }
    }
}

int fdvv_spline_evaluate(long n, int k, const double *t, const double *c, int nu, long count, const double *x,
                         double *y) {
    if (k < 0 || k > MAX_DEGREE || n < k + 1 || nu < 0 || nu > k) return -1;
    double h[MAX_DEGREE + 1];
    long ell = k;
    for (long i = 0; i < count; i++) {
        while (ell > k && x[i] < t[ell]) ell--;
        while (ell < n - 1 && x[i] >= t[ell + 1]) ell++;
        basis(t, x[i], k, ell, nu, h);
        y[i] = 0.0;
        for (int a = 0; a <= k; a++) y[i] += c[ell + a - k] * h[a];
    }
    return 0;
}
