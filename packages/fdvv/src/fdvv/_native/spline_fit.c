/* Free-knot least-squares B-splines.
 *
 * The error depends on the knots alone once the coefficients are eliminated (variable projection, Golub &
 * Pereyra 1973). The fit starts with many knots and removes the least important ones one by one (Lyche & Morken 1987).
 * Then a pattern search moves each knot, and knots are exchanged: one is removed where that increases the error least
 * and inserted where it decreases the error most. Everything is deterministic.
 *
 * Cost: moving a knot changes only two intervals. The moments sum(w u^k) and sum(w y u^k) of the samples in an
 * interval, in its own coordinate u in [-1, 1], are cached, so that the normal equations are assembled from 15 intervals rather
 * than from hundreds of samples. */
#include "fdvv.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_DEGREE = 3, MAX_COEFFICIENTS = 64, ORDER = MAX_DEGREE + 1, MAX_KNOTS = MAX_COEFFICIENTS + ORDER };

typedef struct { /* moments of the samples in one knot interval */
    double from, to;
    double power[2 * MAX_DEGREE + 1]; /* sum of w u^k */
    double weighted[ORDER];           /* sum of w y u^k */
} Moments;

typedef struct {
    int n, degree;
    const double *x, *y, *w;
    double y_mean, y_squares, spacing;
    Moments cache[MAX_KNOTS];        /* by interval, for the last knots used */
    double band[MAX_COEFFICIENTS][ORDER], right[MAX_COEFFICIENTS];
} Problem;

static int first_at_least(const Problem *p, double value) {
    int low = 0, high = p->n;
    while (low < high) {
        int middle = (low + high) / 2;
        if (p->x[middle] < value) low = middle + 1;
        else high = middle;
    }
    return low;
}

static void gather(const Problem *p, double from, double to, int last, Moments *moments) {
    double middle = 0.5 * (from + to), scale = 2.0 / (to - from);
    int begin = first_at_least(p, from), end = last ? p->n : first_at_least(p, to), degree = p->degree;
    memset(moments, 0, sizeof *moments);
    moments->from = from;
    moments->to = to;
    for (int i = begin; i < end; i++) {
        double u = (p->x[i] - middle) * scale, y = p->y[i] - p->y_mean, power = p->w[i];
        for (int k = 0; k <= degree; k++, power *= u) {
            moments->power[k] += power;
            moments->weighted[k] += y * power;
        }
        for (int k = degree + 1; k <= 2 * degree; k++, power *= u) moments->power[k] += power;
    }
}

/* Coefficients in u of the degree + 1 basis functions that are non-zero on interval s (de Boor's recurrence). */
static void local_basis(const double *t, int s, int degree, double basis[ORDER][ORDER]) {
    double middle = 0.5 * (t[s] + t[s + 1]), half = 0.5 * (t[s + 1] - t[s]);
    memset(basis, 0, sizeof(double) * ORDER * ORDER);
    basis[0][0] = 1.0;
    for (int d = 1; d <= degree; d++) {
        double next[ORDER][ORDER] = {{0}};
        for (int r = 0; r < d; r++) {
            double left = t[s + r - d + 1], right = t[s + r + 1], inverse = 1.0 / (right - left);
            for (int k = 0; k < d; k++) {
                double value = basis[r][k] * inverse;
                next[r][k] += (right - middle) * value;
                next[r][k + 1] -= half * value;
                next[r + 1][k] += (middle - left) * value;
                next[r + 1][k + 1] += half * value;
            }
        }
        memcpy(basis, next, sizeof next);
    }
}

static void add_interval(Problem *p, const Moments *moments, const double basis[ORDER][ORDER], int first) {
    for (int r = 0; r <= p->degree; r++) {
        double column[ORDER];
        for (int l = 0; l <= p->degree; l++) {
            column[l] = 0.0;
            for (int k = 0; k <= p->degree; k++) column[l] += basis[r][k] * moments->power[k + l];
        }
        for (int q = 0; q <= r; q++)
            for (int l = 0; l <= p->degree; l++)
                p->band[first + r][r - q] += basis[q][l] * column[l];
        for (int k = 0; k <= p->degree; k++) p->right[first + r] += basis[r][k] * moments->weighted[k];
    }
}

static void assemble(Problem *p, int m, const double *t) {
    memset(p->band, 0, sizeof p->band[0] * (size_t)m);
    memset(p->right, 0, sizeof p->right[0] * (size_t)m);
    for (int s = p->degree; s < m; s++) {
        if (t[s + 1] <= t[s]) continue;
        Moments *moments = &p->cache[s];
        if (moments->from != t[s] || moments->to != t[s + 1]) gather(p, t[s], t[s + 1], s == m - 1, moments);
        double basis[ORDER][ORDER];
        local_basis(t, s, p->degree, basis);
        add_interval(p, moments, (const double(*)[ORDER])basis, s - p->degree);
    }
}

/* Solve the banded normal equations (Cholesky). Returns the squared error; writes the coefficients unless c is NULL. */
static double solve(Problem *p, int m, double *c) {
    double explained = 0.0, z[MAX_COEFFICIENTS];
    for (int i = 0; i < m; i++) {
        double *row = p->band[i];
        row[0] += 1e-10; /* regularization for basis functions without samples */
        for (int k = p->degree; k >= 0; k--) {
            int j = i - k;
            if (j < 0) continue;
            double value = row[k];
            for (int q = i - p->degree > 0 ? i - p->degree : 0; q < j; q++)
                if (j - q <= p->degree) value -= row[i - q] * p->band[j][j - q];
            if (k) row[k] = value / p->band[j][0];
            else row[0] = sqrt(value > 1e-12 ? value : 1e-12);
        }
        z[i] = p->right[i];
        for (int k = 1; k <= p->degree && k <= i; k++) z[i] -= row[k] * z[i - k];
        z[i] /= row[0];
        explained += z[i] * z[i];
    }
    if (c) {
        for (int i = m - 1; i >= 0; i--) {
            double value = z[i];
            for (int k = 1; k <= p->degree && i + k < m; k++) value -= p->band[i + k][k] * c[i + k];
            c[i] = value / p->band[i][0];
        }
        for (int i = 0; i < m; i++) c[i] += p->y_mean; /* the basis sums to one */
    }
    return p->y_squares - explained;
}

static double error_of(Problem *p, int m, const double *t) {
    assemble(p, m, t);
    return solve(p, m, NULL);
}

static void remove_knot(double *t, int count, int at) {
    memmove(t + at, t + at + 1, sizeof *t * (size_t)(count - at - 1));
}

static void insert_knot(double *t, int count, int at, double value) {
    memmove(t + at + 1, t + at, sizeof *t * (size_t)(count - at));
    t[at] = value;
}

/* Move one knot in one direction if that decreases the error. Returns whether it did. */
static int try_move(Problem *p, int m, double *t, int at, double to, double *best) {
    double low = t[at - 1] + p->spacing, high = t[at + 1] - p->spacing, was = t[at];
    if (to < low) to = low;
    if (to > high) to = high;
    if (low > high || to == was) return 0;
    t[at] = to;
    double error = error_of(p, m, t);
    if (error < *best) {
        *best = error;
        return 1;
    }
    t[at] = was;
    return 0;
}

/* Pattern search: every knot has its own step, which grows after a success and shrinks after a failure. */
static double optimize_knots(Problem *p, int m, double *t, int rounds) {
    int inner = m - p->degree - 1;
    double step[MAX_KNOTS], best = error_of(p, m, t), length = t[m] - t[0];
    for (int j = 0; j < inner; j++) step[j] = length / 60.0;
    for (int round = 0; round < rounds; round++) {
        double before = best, longest = 0.0;
        for (int j = 0; j < inner; j++) {
            int at = p->degree + 1 + j, moved = 0;
            for (int sign = -1; sign <= 1 && !moved; sign += 2) {
                while (moved < 4 && try_move(p, m, t, at, t[at] + sign * step[j], &best)) moved++;
            }
            step[j] *= moved ? 1.5 : 0.5;
            if (step[j] > longest) longest = step[j];
        }
        if (longest < 0.1 * p->spacing || (round > 8 && before - best < 1e-5 * best)) break;
    }
    return best;
}

/* Rank the inner knots by the error without them, and return the index of the one at this rank. */
static int least_important(Problem *p, int m, const double *t, int rank) {
    double error[MAX_KNOTS], trial[MAX_KNOTS + ORDER];
    int count = m + p->degree + 1, chosen = p->degree + 1;
    for (int j = p->degree + 1; j < m; j++) {
        memcpy(trial, t, sizeof *t * (size_t)count);
        remove_knot(trial, count, j);
        error[j] = error_of(p, m - 1, trial);
    }
    for (int r = 0; r <= rank; r++) {
        chosen = p->degree + 1;
        for (int j = p->degree + 1; j < m; j++)
            if (error[j] < error[chosen]) chosen = j;
        if (r < rank) error[chosen] = DBL_MAX;
    }
    return chosen;
}

/* Insert a knot where it decreases the error most, of three positions per interval. Returns 0 if there is no room. */
static int insert_best(Problem *p, int m, double *t) {
    double best = DBL_MAX, value = 0.0, trial[MAX_KNOTS + ORDER];
    int count = m + p->degree, at = 0; /* knots of m - 1 coefficients */
    for (int s = p->degree; s < m - 1; s++) {
        double length = t[s + 1] - t[s];
        if (length < 4.0 * p->spacing) continue;
        for (int part = 1; part < 4; part++) {
            memcpy(trial, t, sizeof *t * (size_t)count);
            insert_knot(trial, count, s + 1, t[s] + length * part / 4.0);
            double error = error_of(p, m, trial);
            if (error < best) best = error, at = s + 1, value = trial[s + 1];
        }
    }
    if (at) insert_knot(t, count, at, value);
    return at > 0;
}

/* Many knots, distributed half by x and half by the absolute change of y, so that steps get enough of them. */
static void dense_knots(const Problem *p, int m, double *t) {
    int inner = m - p->degree - 1, at = 0;
    double rise = 0.0, length = p->x[p->n - 1] - p->x[0], sum = 0.0, previous = p->x[0];
    for (int i = 1; i < p->n; i++) rise += fabs(p->y[i] - p->y[i - 1]);
    for (int k = 0; k <= p->degree; k++) t[k] = p->x[0], t[m + k] = p->x[p->n - 1];
    for (int j = 1; j <= inner; j++) {
        double wanted = (double)j / (inner + 1);
        while (at < p->n - 2 && sum < wanted) {
            at++;
            sum += 0.5 * (p->x[at] - p->x[at - 1]) / length;
            if (rise > 0.0) sum += 0.5 * fabs(p->y[at] - p->y[at - 1]) / rise;
        }
        double latest = p->x[p->n - 1] - (inner + 1 - j) * p->spacing, knot = p->x[at];
        if (knot < previous + p->spacing) knot = previous + p->spacing;
        if (knot > latest) knot = latest;
        t[p->degree + j] = previous = knot;
    }
}

static int prepare(Problem *p, int n, const double *x, const double *y, const double *w, int degree, int m, double spacing) {
    if (degree < 1 || degree > MAX_DEGREE || m <= degree || m > MAX_COEFFICIENTS || n < m) return 0;
    memset(p, 0, sizeof *p);
    p->n = n, p->x = x, p->y = y, p->w = w, p->degree = degree, p->spacing = spacing;
    for (int s = 0; s < MAX_KNOTS; s++) p->cache[s].from = NAN;
    for (int i = 0; i < n; i++) p->y_mean += y[i] / n;
    for (int i = 0; i < n; i++) p->y_squares += w[i] * (y[i] - p->y_mean) * (y[i] - p->y_mean);
    return 1;
}

static double squared_error(Problem *p, int m, const double *t, double *c) {
    assemble(p, m, t);
    double error = solve(p, m, c);
    return error > 0.0 ? error : 0.0;
}

/* The number of coefficients to start with: as many as wanted, as the samples hold. */
static int start_size(const Problem *p, int wanted, int m) {
    int room = (int)((p->x[p->n - 1] - p->x[0]) / p->spacing) - 1, many = wanted;
    if (many > MAX_COEFFICIENTS) many = MAX_COEFFICIENTS;
    if (many > p->n / 3) many = p->n / 3;
    if (many > room + p->degree + 1) many = room + p->degree + 1;
    return many < m ? m : many;
}

/* Exchange and move the knots of m coefficients until the search ends. */
static void refine(Problem *p, int m, int exchanges, double *t) {
    double trial[MAX_KNOTS + ORDER], best = optimize_knots(p, m, t, 25);
    for (int k = 0, rank = 0; k < exchanges && rank < m - p->degree - 1; k++) {
        memcpy(trial, t, sizeof *t * (size_t)(m + p->degree + 1));
        remove_knot(trial, m + p->degree + 1, least_important(p, m, trial, rank));
        double error = insert_best(p, m, trial) ? optimize_knots(p, m, trial, 15) : DBL_MAX;
        if (error < best * (1.0 - 1e-4)) {
            best = error, rank = 0;
            memcpy(t, trial, sizeof *t * (size_t)(m + p->degree + 1));
        } else rank++;
    }
    optimize_knots(p, m, t, 40);
}

double fdvv_spline_free_knots(int n, const double *x, const double *y, const double *w, int degree, int m, double spacing,
                              int exchanges, double *t, double *c) {
    Problem *p = malloc(sizeof *p);
    if (!p || !prepare(p, n, x, y, w, degree, m, spacing)) {
        free(p);
        return -1.0;
    }
    double knots[MAX_KNOTS + ORDER];
    int many = start_size(p, 2 * m + 10, m);
    dense_knots(p, many, knots);
    for (; many > m; many--) {
        remove_knot(knots, many + degree + 1, least_important(p, many, knots, 0));
        if (many - m < 10) optimize_knots(p, many - 1, knots, 1);
    }
    refine(p, m, exchanges, knots);
    memcpy(t, knots, sizeof *t * (size_t)(m + degree + 1));
    double error = squared_error(p, m, t, c);
    free(p);
    return error;
}

int fdvv_spline_path(int n, const double *x, const double *y, int degree, int least, int most, double spacing, double *errors,
                     double *knots) {
    Problem *p = malloc(sizeof *p);
    double *w = malloc(sizeof *w * (size_t)(n > 0 ? n : 1)), t[MAX_KNOTS + ORDER];
    for (int i = 0; w && i < n; i++) w[i] = 1.0;
    int many = -1, ready = p && w && most <= MAX_COEFFICIENTS && prepare(p, n, x, y, w, degree, least, spacing);
    if (ready) {
        int m = many = start_size(p, most, least);
        dense_knots(p, m, t);
        for (optimize_knots(p, m, t, 3);; m--) {
            errors[m] = squared_error(p, m, t, NULL);
            memcpy(knots + (size_t)m * MAX_KNOTS, t, sizeof *t * (size_t)(m + degree + 1));
            if (m == least) break;
            remove_knot(t, m + degree + 1, least_important(p, m, t, 0));
            optimize_knots(p, m - 1, t, 1);
        }
    }
    free(w);
    free(p);
    return many;
}

double fdvv_spline_refine(int n, const double *x, const double *y, const double *w, int degree, int m, double spacing,
                          int exchanges, double *t, double *c) {
    Problem *p = malloc(sizeof *p);
    if (!p || !prepare(p, n, x, y, w, degree, m, spacing)) {
        free(p);
        return -1.0;
    }
    refine(p, m, exchanges, t);
    double error = squared_error(p, m, t, c);
    free(p);
    return error;
}
