/* Simulation of one press of a real button: finger, sensor or skin, slider, leaf and cam or dome, stops, plate.
 *
 * The equations of motion are in docs/explanation/real-buttons.md. Fixed steps: third-order Adams-Bashforth, started
 * with two fourth-order Runge-Kutta steps, so that one evaluation per step is enough. The speed is limited by the
 * longest chain of dependent operations, so three chains are kept short: the exponential of the pulp is a state
 * variable, corrected at every row; the cell of the table is cached; polynomials are split in halves.
 */
#include "button.h"
#include "finger.h"

#include <string.h>

enum { XF, VF, H1, H2, SW, XT, VT, XS, VS, YL, VL, ZF, Q1, P1, Q2, P2, SENSED, WORK, LOSS, STATES };

/* inputs of the equations between two ticks, and reciprocals that avoid divisions */
typedef struct {
    const double *table, *cell;  /* cell: that of the last look-up */
    double cells, place_1_m;
    double cell_place;           /* number of that cell */
    double finger_1_kg, sensor_1_kg, slider_1_kg, leaf_1_kg, fast_1_s, slow_1_s, rc_1_s, bristle_1_m;
    double law_1_s_m;
    double effort;        /* modulation of the muscle's force at the tick */
    double effort_per_s;  /* its slope until the next tick */
    double offset_m;      /* of the referent at the tick */
    double offset_m_s;    /* its slope until the next tick */
    double tick_s;
    int leaf, law, audit;
} drive_input;

/* reaction of the button */
typedef struct {
    double up_N;                /* on the slider */
    double fixed_N;             /* of the fixed contact on the leaf */
    double leaf_m_s2, z_1_s;    /* rates of leaf and friction */
    double loss_W;
} reaction;

/* The cell of x, usually that of the last look-up, and the position u in it. Constant beyond the ends. */
static inline const double *cell_at(const fdvv_button_model *m, drive_input *in, double x, double *u) {
    double place = (x - m->table_start_m) * in->place_1_m;
    *u = place - in->cell_place;
    if (*u >= 0.0 && *u < 1.0) return in->cell;
    if (!(place > 0.0)) place = 0.0; /* a press that diverged to NaN ends here too */
    if (place >= in->cells) place = in->cells - 1e-9;
    in->cell_place = (double)(int64_t)place;
    in->cell = in->table + (int64_t)place * FDVV_BUTTON_CELL;
    *u = place - in->cell_place;
    return in->cell;
}

static inline double cubic(const double *c, double u) { return (c[0] + u * c[1]) + u * u * (c[2] + u * c[3]); }

/* Natural logarithm of x >= 1, accurate to 1e-5, without a function call, which would spill registers: exponent plus
 * the series of log(1 + r) for the mantissa around 1.5. */
static inline double fast_log(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    double power = (double)(int64_t)((bits >> 52) - 1023), mantissa;
    bits = (bits & 0xFFFFFFFFFFFFFULL) | 0x3FF0000000000000ULL;
    memcpy(&mantissa, &bits, sizeof mantissa);
    double r = mantissa * (2.0 / 3.0) - 1.0, r2 = r * r, r4 = r2 * r2;
    double low = (r - 0.5 * r2) + r2 * (r * (1.0 / 3.0) - r2 * 0.25);
    double high = ((1.0 / 5.0) - r * (1.0 / 6.0)) + r2 * ((1.0 / 7.0) - r * 0.125);
    return (power * 0.6931471805599453 + 0.4054651081081644) + (low + r4 * r * high);
}

/* The part of the elastic force that depends on speed. */
static inline double speed_force(const fdvv_button_model *m, const drive_input *in, double force, double v) {
    double factor = m->law_s_m * v;
    if (m->law_ratio > 0.0) factor += m->law_ratio * copysign(fast_log(1.0 + fabs(v) * in->law_1_s_m), v);
    return force > 0.0 ? force * factor : 0.0;
}

/* Forces between slider (x, v relative to the housing) and housing, and the rates of leaf and friction. */
static inline void button(const fdvv_button_model *m, drive_input *in, double x, double v, double yl,
                          double vl, double z, double fixed_at, double fixed_rate, reaction *a) {
    double u, cam = 0.0, slope = 0.0;
    const double *c = cell_at(m, in, x, &u);
    double elastic_N = cubic(c, u);
    double friction_N = c[8] + u * c[9];
    a->fixed_N = a->leaf_m_s2 = a->loss_W = 0.0;
    if (in->leaf) {
        slope = (c[5] + u * (2.0 * c[6]) + u * u * (3.0 * c[7])) * in->place_1_m;
        double depth = cubic(c + 4, u) - yl, rate = slope * v - vl, deep = fixed_at - yl;
        double damping = m->leaf_damping_N_s_m * vl;
        cam = contact(m->cam_stiffness_N_m, m->cam_loss_s_m, depth, rate);
        a->fixed_N = contact(m->fixed_stiffness_N_m, m->fixed_loss_s_m, deep, fixed_rate - vl);
        a->leaf_m_s2 =
            (cam + a->fixed_N - m->leaf_preload_N - m->leaf_stiffness_N_m * yl - damping) * in->leaf_1_kg;
        friction_N += cam * (c[10] + u * c[11]);
        if (in->audit)
            a->loss_W = (cam - elastic(m->cam_stiffness_N_m, depth)) * rate + damping * vl +
                        (a->fixed_N - elastic(m->fixed_stiffness_N_m, deep)) * (fixed_rate - vl);
    }
    double speed = fabs(v);
    a->z_1_s = (v - speed * z) * in->bristle_1_m - z * m->relax_1_s;
    double drag = friction_N * z + m->viscous_N_s_m * v, speed_N = in->law ? speed_force(m, in, elastic_N, v) : 0.0;
    double deep = x - m->travel_m;
    double bottom = contact(m->bottom_stiffness_N_m, m->bottom_loss_s_m, deep, v);
    double top = contact(m->top_stiffness_N_m, m->top_loss_s_m, -x, -v);
    a->up_N = ((elastic_N + drag) + (bottom - top)) + (cam * slope + speed_N); /* the slowest operands come last */
    if (in->audit)
        a->loss_W += (drag + speed_N) * v + (bottom - elastic(m->bottom_stiffness_N_m, deep)) * v -
                     (top - elastic(m->top_stiffness_N_m, -x)) * v;
}

static double contact_force(const fdvv_button_model *m, const double *y) {
    return contact(m->contact_stiffness_N_m, m->contact_loss_s_m, y[XT] - y[XS], y[VT] - y[VS]);
}

static inline void rates(const fdvv_button_model *m, drive_input *in, double t, const double *y, double *dy) {
    double effort = 1.0 + in->effort + in->effort_per_s * (t - in->tick_s);
    double offset = in->offset_m + in->offset_m_s * (t - in->tick_s);
    double pull = effort * muscle(&m->finger, &m->gesture, t, y[XF] - offset, y[VF] - in->offset_m_s);
    double compression_rate = y[VF] - y[VT], growth = m->finger.pulp_exponent_1_m * y[SW] * compression_rate;
    double arms = y[H1] + y[H2];
    double pulp = m->finger.pulp_relaxed_ratio * (y[SW] - m->finger.pulp_scale_N) + (arms - m->finger.strap_N);
    double contact_N = contact_force(m, y);
    double plate = y[Q1] + y[Q2], plate_rate = y[P1] + y[P2];
    double snap = m->snap_ratio;
    reaction a;
    button(m, in, y[XS] - plate, y[VS] - plate_rate, y[YL], y[VL], y[ZF], snap * plate, snap * plate_rate, &a);
    double plate_N = a.up_N - snap * a.fixed_N;

    dy[XF] = y[VF];
    dy[VF] = (pull - pulp) * in->finger_1_kg;
    dy[H1] = m->finger.pulp_fast_ratio * growth - y[H1] * in->fast_1_s;
    dy[H2] = m->finger.pulp_slow_ratio * growth - y[H2] * in->slow_1_s;
    dy[SW] = growth;
    dy[XT] = y[VT];
    dy[VT] = (pulp - contact_N) * in->sensor_1_kg;
    dy[XS] = y[VS];
    dy[VS] = (contact_N - a.up_N) * in->slider_1_kg;
    dy[YL] = y[VL];
    dy[VL] = a.leaf_m_s2;
    dy[ZF] = a.z_1_s;
    for (int k = 0; k < 2; k++) {
        double w = m->plate_rad_s[k], q = y[Q1 + 2 * k], p = y[P1 + 2 * k];
        dy[Q1 + 2 * k] = p;
        dy[P1 + 2 * k] = plate_N * m->plate_1_kg[k] - m->plate_damping_1_s[k] * p - w * w * q;
    }
    dy[SENSED] = (pulp - y[SENSED]) * in->rc_1_s;
    dy[WORK] = dy[LOSS] = 0.0;
    if (!in->audit) return;
    dy[WORK] = pull * y[VF];
    dy[LOSS] = a.loss_W + arms * compression_rate +
               (contact_N - elastic(m->contact_stiffness_N_m, y[XT] - y[XS])) * (y[VT] - y[VS]);
    for (int k = 0; k < 2; k++)
        if (m->plate_1_kg[k] > 0.0)
            dy[LOSS] += m->plate_damping_1_s[k] / m->plate_1_kg[k] * y[P1 + 2 * k] * y[P1 + 2 * k];
}

/* -- energy -- */

static inline double spring_energy(double stiffness, double depth) {
    return depth > 0.0 ? 0.5 * stiffness * depth * depth : 0.0;
}

/* Energy of leaf, cam, fixed contact, stops and elastic force, with the slider at x relative to the housing. */
static double button_energy(const fdvv_button_model *m, drive_input *in, double x, double yl, double vl,
                            double fixed_at) {
    double u;
    const double *c = cell_at(m, in, x, &u);
    double area = u * (c[0] + u * (c[1] / 2.0 + u * (c[2] / 3.0 + u * c[3] / 4.0)));
    double sum = c[12] + area * m->table_step_m + spring_energy(m->bottom_stiffness_N_m, x - m->travel_m) +
                 spring_energy(m->top_stiffness_N_m, -x);
    if (!in->leaf) return sum;
    return sum + 0.5 * m->leaf_mass_kg * vl * vl + m->leaf_preload_N * yl +
           0.5 * m->leaf_stiffness_N_m * yl * yl + spring_energy(m->cam_stiffness_N_m, cubic(c + 4, u) - yl) +
           spring_energy(m->fixed_stiffness_N_m, fixed_at - yl);
}

static double stored(const fdvv_button_model *m, drive_input *in, const double *y) {
    const fdvv_finger *f = &m->finger;
    double compression = y[XF] - y[XT], plate = y[Q1] + y[Q2];
    double sum = 0.5 * (f->finger_mass_kg * y[VF] * y[VF] + m->sensor_mass_kg * y[VT] * y[VT] +
                        m->slider_mass_kg * y[VS] * y[VS]) +
                 f->pulp_relaxed_ratio * pulp_energy(f, compression) - f->strap_N * (compression + f->strap_m) +
                 spring_energy(m->contact_stiffness_N_m, y[XT] - y[XS]) +
                 button_energy(m, in, y[XS] - plate, y[YL], y[VL], m->snap_ratio * plate);
    for (int k = 0; k < 2; k++) {
        double w = m->plate_rad_s[k], q = y[Q1 + 2 * k], p = y[P1 + 2 * k];
        if (m->plate_1_kg[k] > 0.0) sum += 0.5 * (p * p + w * w * q * q) / m->plate_1_kg[k];
    }
    return sum;
}

/* -- steps -- */

static void runge_kutta(const fdvv_button_model *m, drive_input *in, double t, double *y, const double *now) {
    static const double reach[3] = {0.5, 0.5, 1.0}, weight[3] = {2.0, 2.0, 1.0};
    double h = m->step_s, slope[STATES], sum[STATES], stage[STATES];
    memcpy(slope, now, sizeof slope);
    memcpy(sum, now, sizeof sum);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < STATES; j++) stage[j] = y[j] + reach[i] * h * slope[j];
        rates(m, in, t + reach[i] * h, stage, slope);
        for (int j = 0; j < STATES; j++) sum[j] += weight[i] * slope[j];
    }
    for (int j = 0; j < STATES; j++) y[j] += h / 6.0 * sum[j];
}

/* The rates of this step and the two before it; the pointers are rotated instead of copying the rows. */
typedef struct {
    double rows[3][STATES];
    double *now, *last, *older;
    int past_steps; /* number of valid older rows */
} history;

/* Advance one step with the rates at its start in r->now. */
static inline void advance(const fdvv_button_model *m, drive_input *in, double t, double *restrict y,
                           history *r) {
    double h = m->step_s / 12.0, *restrict now = r->now, *restrict last = r->last, *restrict older = r->older;
    int states = in->audit ? STATES : WORK; /* work and loss come last */
    if (r->past_steps < 2)
        runge_kutta(m, in, t, y, now), r->past_steps++;
    else
        for (int j = 0; j < states; j++)
            y[j] = (y[j] + h * (5.0 * older[j] - 16.0 * last[j])) + 23.0 * h * now[j];
    r->now = older, r->older = last, r->last = now;
}

static void prepare(const fdvv_button_model *m, int64_t cells, const double *table, drive_input *in) {
    memset(in, 0, sizeof *in);
    in->table = in->cell = table;
    in->place_1_m = 1.0 / m->table_step_m, in->cells = (double)cells;
    in->finger_1_kg = 1.0 / m->finger.finger_mass_kg, in->sensor_1_kg = 1.0 / m->sensor_mass_kg;
    in->slider_1_kg = 1.0 / m->slider_mass_kg;
    in->fast_1_s = 1.0 / m->finger.pulp_fast_s, in->slow_1_s = 1.0 / m->finger.pulp_slow_s;
    in->rc_1_s = 1.0 / m->sensor_rc_s, in->bristle_1_m = 1.0 / m->bristle_m;
    in->leaf = m->leaf_mass_kg > 0.0, in->law = m->law_s_m > 0.0 || m->law_ratio > 0.0;
    if (in->leaf) in->leaf_1_kg = 1.0 / m->leaf_mass_kg;
    if (m->law_speed_m_s > 0.0) in->law_1_s_m = 1.0 / m->law_speed_m_s;
}

/* Whether the circuit is closed: the leaf touches the fixed contact, or the dome is down. */
static inline int is_closed(const fdvv_button_model *m, const drive_input *in, const double *y, int before) {
    double plate = y[Q1] + y[Q2];
    if (in->leaf) return y[YL] < m->snap_ratio * plate;
    return y[XS] - plate >= (before ? m->open_m : m->close_m);
}

static void write_row(const fdvv_button_model *m, drive_input *in, const double *y, const double *now,
                      double t, int on, double energy_J, double *row, int64_t apart) {
    double plate = y[Q1] + y[Q2], plate_rate = y[P1] + y[P2];
    double deep = m->snap_ratio * plate - y[YL], rate = m->snap_ratio * plate_rate - y[VL];
    double values[FDVV_BUTTON_COLUMNS] = {
        t, y[XS], y[VS], now[VS], contact_force(m, y), y[SENSED], y[XF], y[YL],
        in->leaf ? contact(m->fixed_stiffness_N_m, m->fixed_loss_s_m, deep, rate) : 0.0,
        plate, plate_rate, on, in->audit ? stored(m, in, y) - energy_J - y[WORK] + y[LOSS] : 0.0};
    for (int k = 0; k < FDVV_BUTTON_COLUMNS; k++) row[k * apart] = values[k];
}

/* The exponential term of the pulp at a compression. */
static double pulp_exponential(const fdvv_finger *f, double depth) {
    return f->pulp_scale_N * exp(f->pulp_exponent_1_m * (depth + f->strap_m));
}

/* Start with the finger above the cap, or resting on it with the pulp relaxed (Newton's method). */
static void start(const fdvv_button_model *m, double *y) {
    const fdvv_finger *f = &m->finger;
    double from = m->gesture.start_m, x = 0.0;
    memset(y, 0, STATES * sizeof *y);
    for (int i = 0; i < 64 && from > 0.0; i++) {
        double exponential_N = f->pulp_relaxed_ratio * pulp_exponential(f, x);
        double pulp = exponential_N - f->pulp_relaxed_ratio * f->pulp_scale_N - f->strap_N;
        x += (f->finger_stiffness_N_m * (from - x) - pulp) /
             (f->finger_stiffness_N_m + f->pulp_exponent_1_m * exponential_N);
    }
    y[XF] = from > 0.0 ? x : from;
    y[XT] = from > 0.0 ? 0.0 : from;
    y[SW] = pulp_exponential(f, y[XF] - y[XT]);
}

/* Equilibrium of the leaf on the cam with the slider at x, from the balance of the springs. */
static double leaf_rest(const fdvv_button_model *m, drive_input *in, double x) {
    double u;
    const double *c = cell_at(m, in, x, &u);
    return (m->cam_stiffness_N_m * cubic(c + 4, u) - m->leaf_preload_N) /
           (m->cam_stiffness_N_m + m->leaf_stiffness_N_m);
}

static int is_valid_grid(const fdvv_button_grid *g) {
    return g->settle_ticks >= 0 && g->ticks > 0 && g->steps_per_row > 0 && g->steps_per_tick > 0 &&
           g->steps_per_tick % g->steps_per_row == 0 && g->cells > 0;
}

int fdvv_button_press(const fdvv_button_model *m, const fdvv_button_grid *g, const double *table,
                      const double *effort_ratio, const double *offset_m, double *rows,
                      double *switching) {
    if (!is_valid_grid(g)) return 1;
    double y[STATES], tick_s = m->step_s * (double)g->steps_per_tick;
    int on = 0;
    history r = {.past_steps = 0};
    r.now = r.rows[0], r.last = r.rows[1], r.older = r.rows[2];
    drive_input in;
    prepare(m, g->cells, table, &in);
    in.audit = g->audit != 0;
    start(m, y);
    if (in.leaf) y[YL] = leaf_rest(m, &in, 0.0);
    switching[0] = switching[1] = NAN;
    double energy_J = stored(m, &in, y);
    int64_t count = g->ticks * (g->steps_per_tick / g->steps_per_row);

    for (int64_t k = 0; k < g->settle_ticks + g->ticks; k++) {
        int64_t until_row = 0;
        in.tick_s = tick_s * (double)(k - g->settle_ticks);
        in.effort = effort_ratio[k];
        in.effort_per_s = (effort_ratio[k + 1] - effort_ratio[k]) / tick_s;
        in.offset_m = offset_m[k];
        in.offset_m_s = (offset_m[k + 1] - offset_m[k]) / tick_s;
        for (int64_t s = 0; s < g->steps_per_tick; s++) {
            double t = in.tick_s + m->step_s * (double)s;
            int was = on;
            on = is_closed(m, &in, y, was);
            if (on && !was && isnan(switching[0])) switching[0] = t;
            if (!on && was) switching[1] = t;
            int row = until_row-- == 0;
            if (row) y[SW] = pulp_exponential(&m->finger, y[XF] - y[XT]), until_row = g->steps_per_row - 1;
            rates(m, &in, t, y, r.now);
            if (row && k >= g->settle_ticks) write_row(m, &in, y, r.now, t, on, energy_J, rows++, count);
            advance(m, &in, t, y, &r);
        }
    }
    return 0;
}

#define PROBE_OVERRUN_m 1e-4

/* One step of leaf and friction (the three states) at a given slider position. */
static void quasi_static_step(const fdvv_button_model *m, drive_input *in, double h, double x, double v,
                              double *state) {
    reaction a;
    button(m, in, x, v, state[0], state[1], state[2], 0.0, 0.0, &a);
    state[1] += h * a.leaf_m_s2;
    state[0] += h * state[1];
    state[2] += h * a.z_1_s;
}

int fdvv_button_probe(const fdvv_button_model *m, int64_t cells, const double *table, double stroke_m,
                      double speed_m_s, int64_t count, double *rows) {
    if (cells < 1 || count < 2 || !(speed_m_s > 0.0) || !(stroke_m > 0.0)) return 1;
    double spacing_m = stroke_m / (double)(count - 1), state[3] = {0.0, 0.0, 0.0};
    int64_t steps = (int64_t)ceil(spacing_m / (speed_m_s * m->step_s));
    double h = spacing_m / speed_m_s / (double)steps;
    int64_t overrun = (int64_t)(PROBE_OVERRUN_m / speed_m_s / h);
    drive_input in;
    prepare(m, cells, table, &in);
    if (in.leaf) state[0] = leaf_rest(m, &in, 0.0);
    for (int64_t i = 0; i < 2 * count; i++) {
        double to = spacing_m * (double)(i < count ? i : 2 * count - 1 - i);
        double v = i < count ? speed_m_s : -speed_m_s;
        if (i == count) { /* beyond the end and back, so that friction has reversed */
            for (int64_t s = 0; s < overrun; s++)
                quasi_static_step(m, &in, h, stroke_m - v * h * (double)s, -v, state);
            for (int64_t s = overrun; s > 0; s--)
                quasi_static_step(m, &in, h, stroke_m - v * h * (double)s, v, state);
        } else if (i)
            for (int64_t s = steps; s > 0; s--) quasi_static_step(m, &in, h, to - v * h * (double)s, v, state);
        reaction a;
        button(m, &in, to, v, state[0], state[1], state[2], 0.0, 0.0, &a);
        rows[2 * i] = to, rows[2 * i + 1] = fmax(a.up_N, 0.0);
    }
    return 0;
}

void fdvv_button_sizes(int64_t *model_bytes, int64_t *grid_bytes) {
    *model_bytes = (int64_t)sizeof(fdvv_button_model);
    *grid_bytes = (int64_t)sizeof(fdvv_button_grid);
}
