/* One press on the rig: finger, contact, moving coil, sensors and the controller that runs it.
 *
 * Equations of motion in docs/explanation/twin.md. Fixed steps: third-order Adams-Bashforth, started by
 * two fourth-order Runge-Kutta steps wherever the drive jumps, so that one evaluation per step is enough.
 */
#include "finger.h"

#include <string.h>

enum { XF, VF, H1, H2, XT, VT, XC, VC, AMPS, LVDT, SENSED, WORK, LOSS, STATES };

/* what the equations are driven by between two ticks, and inverses that save divisions */
typedef struct {
    double finger_1_kg, sensor_1_kg, mover_1_kg, coil_1_H, fast_1_s, slow_1_s, rc_1_s;
    double drive;         /* V, or A behind a current loop */
    double effort;        /* modulation of the finger's force at the tick */
    double effort_per_s;  /* and its slope until the next */
    double tick_s;
    int audit;            /* whether to integrate work and loss */
} drive_input;

/* what the controller remembers */
typedef struct {
    double window_m[FDVV_TWIN_WINDOW];  /* raw positions for the sliding mean */
    double recent_m[FDVV_TWIN_WINDOW];  /* sensed positions, newest last */
    double sum_m, sum_t, sum_tt, sum_tm;
    int64_t raw_count, recent_count, inside_count;
    double extreme_m, speed_m_s, held_N;
    int release, decided;
    double sensed_m, sensed_N, command_N, drive;
    int saturated;
} controller;

static double clamp(double value, double low, double high) {
    return value < low ? low : value > high ? high : value;
}

static inline double force_constant(const fdvv_twin_model *m, double x) {
    double off = x - m->droop_centre_m;
    return m->force_constant_N_A * (1.0 - m->droop_1_m2 * off * off);
}

static inline double voltage(const fdvv_twin_model *m, double drive, double kt, double amps, double v) {
    if (m->current_loop_s <= 0.0) return drive;
    double wanted = m->resistance_ohm * amps - kt * v + m->inductance_H * (drive - amps) / m->current_loop_s;
    return clamp(wanted, -m->supply_V, m->supply_V);
}

static double contact_force(const fdvv_twin_model *m, const double *y) {
    return contact(m->contact_stiffness_N_m, m->contact_loss_s_m, y[XT] - y[XC], y[VT] - y[VC]);
}

static inline void rates(const fdvv_twin_model *m, const drive_input *in, double t, const double *y, double *dy) {
    double effort = 1.0 + in->effort + in->effort_per_s * (t - in->tick_s);
    double pull = effort * muscle(&m->finger, &m->gesture, t, y[XF], y[VF]);
    double squeeze_rate = y[VF] - y[VT], growth;
    double arms = y[H1] + y[H2];
    double pulp = squeeze(&m->finger, y[XF] - y[XT], squeeze_rate, arms, &growth);

    double touch = contact_force(m, y);
    double deep = y[XC] - m->travel_m;
    double stop = contact(m->stop_stiffness_N_m, m->stop_loss_s_m, deep, y[VC]);
    double top = contact(m->top_stiffness_N_m, m->top_loss_s_m, -y[XC], -y[VC]);
    double rub = m->coulomb_N * y[VC] / sqrt(y[VC] * y[VC] + m->coulomb_speed_m_s * m->coulomb_speed_m_s) +
                 m->viscous_N_s_m * y[VC];
    double kt = force_constant(m, y[XC]);
    double volts = voltage(m, in->drive, kt, y[AMPS], y[VC]);

    dy[XF] = y[VF];
    dy[VF] = (pull - pulp) * in->finger_1_kg;
    dy[H1] = m->finger.pulp_fast_ratio * growth - y[H1] * in->fast_1_s;
    dy[H2] = m->finger.pulp_slow_ratio * growth - y[H2] * in->slow_1_s;
    dy[XT] = y[VT];
    dy[VT] = (pulp - touch) * in->sensor_1_kg;
    dy[XC] = y[VC];
    dy[VC] = (touch - kt * y[AMPS] - rub - stop + top) * in->mover_1_kg + m->gravity_m_s2;
    dy[AMPS] = (volts - m->resistance_ohm * y[AMPS] + kt * y[VC]) * in->coil_1_H;
    dy[LVDT] = m->lvdt_rad_s * (y[XC] - y[LVDT]);
    dy[SENSED] = (pulp - y[SENSED]) * in->rc_1_s;
    dy[WORK] = dy[LOSS] = 0.0;
    if (!in->audit) return;
    dy[WORK] = pull * y[VF] + volts * y[AMPS];
    dy[LOSS] = m->resistance_ohm * y[AMPS] * y[AMPS] + rub * y[VC] + arms * squeeze_rate +
               (touch - elastic(m->contact_stiffness_N_m, y[XT] - y[XC])) * (y[VT] - y[VC]) +
               (stop - elastic(m->stop_stiffness_N_m, deep)) * y[VC] -
               (top - elastic(m->top_stiffness_N_m, -y[XC])) * y[VC];
}

/* Kinetic, elastic, magnetic and gravitational energy. */
static double stored(const fdvv_twin_model *m, const double *y) {
    const fdvv_finger *f = &m->finger;
    double squeezed = y[XF] - y[XT];
    double depth = fmax(y[XT] - y[XC], 0.0), deep = fmax(y[XC] - m->travel_m, 0.0), high = fmax(-y[XC], 0.0);
    double moving = f->finger_mass_kg * y[VF] * y[VF] + m->sensor_mass_kg * y[VT] * y[VT] +
                    m->moving_mass_kg * y[VC] * y[VC] + m->inductance_H * y[AMPS] * y[AMPS];
    double springs = m->contact_stiffness_N_m * depth * depth + m->stop_stiffness_N_m * deep * deep +
                     m->top_stiffness_N_m * high * high;
    return 0.5 * (moving + springs) + f->pulp_relaxed_ratio * swollen(f, squeezed) -
           f->strap_N * (squeezed + f->strap_m) - m->moving_mass_kg * m->gravity_m_s2 * y[XC];
}

static void runge_kutta(const fdvv_twin_model *m, const drive_input *in, double t, double *y, const double *now) {
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

/* Advance one step; past holds the rates of the two steps before, fresh how many of them still count. */
static void advance(const fdvv_twin_model *m, const drive_input *in, double t, double *y, double past[2][STATES],
                    int *fresh) {
    double now[STATES], h = m->step_s / 12.0;
    rates(m, in, t, y, now);
    if (*fresh < 2) {
        runge_kutta(m, in, t, y, now);
        memcpy(past[1], past[0], sizeof now);
        memcpy(past[0], now, sizeof now);
        *fresh += 1;
        return;
    }
    int states = in->audit ? STATES : WORK; /* work and loss come last */
    for (int j = 0; j < states; j++) {
        y[j] += h * (23.0 * now[j] - 16.0 * past[0][j] + 5.0 * past[1][j]);
        past[1][j] = past[0][j];
        past[0][j] = now[j];
    }
}

/* -- the controller -- */

static double converter(double value, double lsb) {
    if (lsb <= 0.0) return value;
    double steps = value / lsb + 0.5, whole = (double)(int64_t)steps;
    return lsb * (whole > steps ? whole - 1.0 : whole);
}

/* The scale bends as u - u^3 over half the range, by lvdt_linearity_m where it bends most. */
static double read_position(const fdvv_twin_model *m, double lvdt_m, double noise_m) {
    double u = 2.0 * lvdt_m / m->lvdt_range_m, most = 2.598076211353316; /* 1 / max(u - u^3) */
    return converter(lvdt_m + m->lvdt_linearity_m * most * u * (1.0 - u * u) + noise_m, m->lvdt_lsb_m);
}

/* The play of the sensor, then gain, range and converter. */
static void read_force(const fdvv_twin_model *m, controller *c, double filtered_N, double noise_N) {
    double half = 0.5 * m->sensor_hysteresis_N;
    c->held_N = clamp(c->held_N, filtered_N - half, filtered_N + half);
    double value = m->sensor_gain * c->held_N + noise_N;
    c->sensed_N = converter(clamp(value, -m->sensor_full_scale_N, m->sensor_full_scale_N), m->sensor_lsb_N);
}

static double sliding_mean(const fdvv_twin_grid *g, controller *c, double raw_m) {
    c->window_m[c->raw_count++ % g->average_ticks] = raw_m;
    int64_t n = c->raw_count < g->average_ticks ? c->raw_count : g->average_ticks;
    double sum = 0.0;
    for (int64_t j = 0; j < n; j++) sum += c->window_m[j];
    return sum / (double)n;
}

/* Turn round once the cap has come back by reversal_m from its extreme; rearm at the top. */
static void find_direction(const fdvv_twin_model *m, controller *c) {
    double x = c->sensed_m;
    if (!c->release) {
        if (x > c->extreme_m) c->extreme_m = x;
        if (x < c->extreme_m - m->reversal_m) c->release = 1, c->extreme_m = x;
    } else {
        if (x < c->extreme_m) c->extreme_m = x;
        if (x > c->extreme_m + m->reversal_m || x < m->rearm_m) c->release = 0, c->extreme_m = x;
    }
    if (x < m->rearm_m) {
        c->decided = 0, c->inside_count = 0, c->speed_m_s = m->announced_m_s;
        c->sum_m = c->sum_t = c->sum_tt = c->sum_tm = 0.0;
    }
}

/* Least squares over the samples inside the window, or over the newest few if it held too few. */
static void find_speed(const fdvv_twin_model *m, const fdvv_twin_grid *g, controller *c, double tick_s) {
    int64_t few = g->fewest_samples;
    memmove(c->recent_m, c->recent_m + 1, (size_t)(few - 1) * sizeof(double));
    c->recent_m[few - 1] = c->sensed_m;
    c->recent_count++;
    if (c->decided || c->release || c->sensed_m < m->window_start_m) return;
    if (c->sensed_m <= m->window_end_m) {
        double t = (double)c->inside_count++ * tick_s;
        c->sum_m += c->sensed_m, c->sum_t += t, c->sum_tt += t * t, c->sum_tm += t * c->sensed_m;
        return;
    }
    if (c->inside_count < few) {
        if (c->recent_count < few) return;
        c->inside_count = few, c->sum_m = c->sum_t = c->sum_tt = c->sum_tm = 0.0;
        for (int64_t j = 0; j < few; j++) {
            double t = (double)j * tick_s, x = c->recent_m[j];
            c->sum_m += x, c->sum_t += t, c->sum_tt += t * t, c->sum_tm += t * x;
        }
    }
    double n = (double)c->inside_count;
    double slope = (n * c->sum_tm - c->sum_t * c->sum_m) / (n * c->sum_tt - c->sum_t * c->sum_t);
    c->speed_m_s = m->velocity_scale * slope;
    c->decided = 1;
}

static double look_up(const fdvv_twin_model *m, const fdvv_twin_grid *g, const double *speeds, const double *table,
                      const controller *c) {
    const double *stroke = table + (c->release ? g->velocities * g->displacements : 0);
    double place = clamp((c->sensed_m - m->table_start_m) / m->table_step_m, 0.0, (double)(g->displacements - 1));
    int64_t i = (int64_t)place, j = 0;
    if (i > g->displacements - 2) i = g->displacements - 2;
    double part = place - (double)i, mix = 0.0;
    while (j < g->velocities - 2 && c->speed_m_s >= speeds[j + 1]) j++;
    if (g->velocities > 1) mix = clamp((c->speed_m_s - speeds[j]) / (speeds[j + 1] - speeds[j]), 0.0, 1.0);
    const double *row = stroke + j * g->displacements + i;
    double low = row[0] + part * (row[1] - row[0]);
    if (mix <= 0.0) return low;
    row += g->displacements;
    return low + mix * (row[0] + part * (row[1] - row[0]) - low);
}

/* Force to drive: limit, scale, quantise. */
static void set_command(const fdvv_twin_model *m, controller *c, double wanted_N) {
    c->command_N = clamp(wanted_N, -m->force_limit_N, m->force_limit_N);
    double raw = c->command_N * m->drive_per_N;
    double drive = clamp(raw, m->drive_low, m->drive_high);
    c->saturated = c->command_N != wanted_N || drive != raw;
    c->drive = converter(drive, m->drive_lsb);
}

/* -- the press -- */

static int usable(const fdvv_twin_grid *g) {
    return g->settle_ticks >= 0 && g->ticks > 0 && g->steps_per_row > 0 && g->steps_per_tick > 0 &&
           g->steps_per_tick % g->steps_per_row == 0 && g->delay_steps >= 0 && g->delay_steps < g->steps_per_tick &&
           g->reads > 0 && g->read_steps > 0 && (g->reads - 1) * g->read_steps < g->steps_per_tick &&
           g->average_ticks > 0 && g->average_ticks <= FDVV_TWIN_WINDOW && g->fewest_samples > 1 &&
           g->fewest_samples <= FDVV_TWIN_WINDOW && g->displacements > 1 && g->velocities > 0;
}

static void write_row(const fdvv_twin_model *m, const controller *c, const double *y, double t, int tick,
                      int audit, double energy_J, double *row) {
    row[0] = t;
    row[1] = y[XC], row[2] = y[VC], row[3] = contact_force(m, y);
    row[4] = c->sensed_m, row[5] = c->sensed_N, row[6] = c->command_N;
    row[7] = c->saturated, row[8] = c->release, row[9] = tick;
    row[10] = y[AMPS], row[11] = y[XF];
    row[12] = audit ? stored(m, y) - energy_J - y[WORK] + y[LOSS] : 0.0;
}

static void start(const fdvv_twin_model *m, double *y, drive_input *in, controller *c) {
    memset(in, 0, sizeof *in);
    in->finger_1_kg = 1.0 / m->finger.finger_mass_kg, in->sensor_1_kg = 1.0 / m->sensor_mass_kg;
    in->mover_1_kg = 1.0 / m->moving_mass_kg, in->coil_1_H = 1.0 / m->inductance_H;
    in->fast_1_s = 1.0 / m->finger.pulp_fast_s, in->slow_1_s = 1.0 / m->finger.pulp_slow_s;
    in->rc_1_s = 1.0 / m->sensor_rc_s;
    memset(y, 0, STATES * sizeof *y);
    memset(c, 0, sizeof *c);
    y[XF] = y[XT] = m->gesture.start_m < 0.0 ? m->gesture.start_m : 0.0;
    c->speed_m_s = m->announced_m_s;
}

/* Let the controller run once on what the sensors gave. */
static void run_tick(const fdvv_twin_model *m, const fdvv_twin_grid *g, const double *speeds_m_s,
                     const double *table_N, double raw_m, double filtered_N, double noise_N, controller *c) {
    double tick_s = m->step_s * (double)g->steps_per_tick;
    c->sensed_m = sliding_mean(g, c, raw_m);
    read_force(m, c, filtered_N, noise_N);
    find_direction(m, c);
    find_speed(m, g, c, tick_s);
    set_command(m, c, look_up(m, g, speeds_m_s, table_N, c));
}

int fdvv_twin_press(const fdvv_twin_model *m, const fdvv_twin_grid *g, const double *speeds_m_s,
                    const double *table_N, const double *position_noise_m, const double *force_noise_N,
                    const double *effort_ratio, double *rows) {
    if (!usable(g)) return 1;
    double y[STATES], past[2][STATES], energy_J, raw_m;
    double tick_s = m->step_s * (double)g->steps_per_tick;
    int64_t last = g->settle_ticks + g->ticks - 1, first_read = g->steps_per_tick - (g->reads - 1) * g->read_steps;
    int fresh = 0;
    controller c;
    drive_input in;
    start(m, y, &in, &c);
    in.audit = g->audit != 0;
    memset(past, 0, sizeof past);
    energy_J = stored(m, y);
    raw_m = read_position(m, 0.0, 0.0);

    for (int64_t k = 0; k <= last; k++) {
        int64_t next_row = k < g->settle_ticks ? g->steps_per_tick : 0, next_read = first_read;
        /* the reads of the last tick are never used: any noise will do */
        const double *noise_m = position_noise_m + (k < last ? k + 1 : k) * g->reads;
        double sum_m = 0.0;
        in.tick_s = tick_s * (double)(k - g->settle_ticks);
        in.effort = effort_ratio[k];
        in.effort_per_s = (effort_ratio[k + 1] - effort_ratio[k]) / tick_s;
        run_tick(m, g, speeds_m_s, table_N, raw_m, y[SENSED], force_noise_N[k], &c);
        for (int64_t s = 0; s < g->steps_per_tick; s++) {
            double t = in.tick_s + m->step_s * (double)s;
            if (s == g->delay_steps && in.drive != c.drive) in.drive = c.drive, fresh = 0;
            if (s == next_row) {
                write_row(m, &c, y, t, s == 0, in.audit, energy_J, rows);
                rows += FDVV_TWIN_COLUMNS, next_row += g->steps_per_row;
            }
            advance(m, &in, t, y, past, &fresh);
            if (s + 1 == next_read) {
                sum_m += read_position(m, y[LVDT], *noise_m++);
                next_read += g->read_steps;
            }
        }
        raw_m = sum_m / (double)g->reads;
    }
    return 0;
}

void fdvv_twin_sizes(int64_t *model_bytes, int64_t *grid_bytes) {
    *model_bytes = (int64_t)sizeof(fdvv_twin_model);
    *grid_bytes = (int64_t)sizeof(fdvv_twin_grid);
}
