/* One tick of the rig: set the actuators, integrate the motion, read the sensors. */
#include "rig_motion.h"

static double rounded(double value) { return floor(value + 0.5); }

/* -- actuators -- */

/* Set the duty of the bridge. A step of the voltage is a step of the current's slope: it is added to the stored slopes
 * too, so that the solver need not be restarted. */
static void set_drive(fdvv_rig *r, int duty_q15, int enable) {
    const fdvv_rig_model *m = &r->model;
    double ratio = (double)duty_q15 / 32768.0, was = r->drive, ohm = r->ohm;
    if (m->drive_lsb > 0.0) ratio = m->drive_lsb * rounded(ratio / m->drive_lsb);
    if (ratio < m->drive_low) ratio = m->drive_low;
    double copper = m->resistance_ohm * (1.0 + m->copper_1_K * r->heat_K);
    r->ohm = copper + m->bridge_ohm + m->source_ohm * ratio * ratio;
    r->drive = ratio * (m->current_loop_s > 0.0 ? m->supply_V / m->resistance_ohm : m->supply_V);
    if (!enable) r->y[AMPS] = 0.0;
    if (!enable != !r->enable || ((m->current_loop_s > 0.0 || r->grid.audit) && r->drive != was)) r->past_steps = 0;
    r->enable = (uint8_t)(enable != 0);
    double henry = m->inductance_H + m->reluctance_H_m * (r->y[XC] - m->droop_centre_m);
    double jump = (r->drive - was - (r->ohm - ohm) * r->y[AMPS]) / henry;
    r->past[0][AMPS] += jump, r->past[1][AMPS] += jump;
}

/* The servo samples its pulse once per frame, ignores small changes, and moves with limited speed and an exponential
 * approach to its target. Its backlash is above the stop after a move upward. */
static void move_servo(fdvv_rig *r, int stop_us, double span_s) {
    const fdvv_rig_model *m = &r->model;
    if (stop_us > 0 && r->time_s >= r->servo_next_s) {
        double requested = m->servo_m_us * ((double)stop_us - m->servo_zero_us);
        if (fabs(requested - r->servo_target_m) > m->servo_deadband_m) r->servo_target_m = requested;
        r->servo_next_s += m->servo_frame_s;
    }
    double distance = r->servo_target_m - r->servo_m, limit = m->servo_m_s * span_s;
    if (distance == 0.0) return;
    r->servo_m += clamp(distance * (span_s < m->servo_lag_s ? span_s / m->servo_lag_s : 1.0), -limit, limit);
    r->stop_m = clamp(r->stop_m, r->servo_m, r->servo_m + m->servo_play_m);
}

static void heat_coil(fdvv_rig *r, double span_s) {
    const fdvv_rig_model *m = &r->model;
    double copper = m->resistance_ohm * (1.0 + m->copper_1_K * r->heat_K);
    r->heat_K += span_s / m->heat_s * (copper * m->heat_K_W * r->y[AMPS] * r->y[AMPS] - r->heat_K);
    if (m->thermistor_kind > 0.0)
        r->bead_K += span_s / m->thermistor_lag_s * (m->thermistor_share * r->heat_K - r->bead_K);
}

/* -- vibration -- */

static void start_voice(fdvv_rig *r, uint8_t slot, double latency) {
    const fdvv_rig_model *m = &r->model;
    if (slot == FDVV_NONE || m->magnet_kg <= 0.0) return;
    double wait = m->vibration_latency_s + m->vibration_jitter_s * clamp(latency, -3.0, 3.0);
    r->slot = slot, r->waiting = 1;
    r->vibration_s = r->time_s + (wait > 0.0 ? wait : 0.0);
}

/* The DAC's sample at time t. */
static void sample_voice(fdvv_rig *r, double t) {
    if (r->waiting && t >= r->vibration_s) {
        fdvv_synth_choose(&r->voice, &r->bank, r->slot);
        fdvv_synth_start(&r->voice, 255);
        r->waiting = 0, r->sample_s = t;
    }
    while (fdvv_synth_playing(&r->voice) && t >= r->sample_s) {
        r->count = fdvv_synth_sample(&r->voice);
        r->sample_s += 1.0 / FDVV_SYNTH_RATE_HZ;
    }
    if (!fdvv_synth_playing(&r->voice) && t >= r->sample_s) r->count = FDVV_SYNTH_SILENCE;
}

/* Low-pass filter and clipping amplifier, then the exciter's current at the end of this step. Its time constant is
 * about one step, so the solution is exact for a linearly extrapolated input. */
static double drive_magnet(fdvv_rig *r, double t) {
    const fdvv_rig_model *m = &r->model;
    if (r->waiting || fdvv_synth_playing(&r->voice) || r->count != FDVV_SYNTH_SILENCE) sample_voice(r, t);
    double volts = clamp(r->amplifier_V, -m->amplifier_clip_V, m->amplifier_clip_V);
    double input_V = m->amplifier_V_count * ((double)r->count - FDVV_SYNTH_SILENCE);
    double target_A = (volts - m->magnet_motor_N_A * (r->y[VM] - r->y[VC])) * r->magnet_1_ohm, was = r->magnet_target_A;
    r->amplifier_V = input_V + r->amplifier_keep * (r->amplifier_V - input_V);
    r->magnet_target_A = target_A;
    return r->magnet_keep * r->magnet_A + r->magnet_mean * target_A + r->magnet_slope * (target_A - was);
}

/* -- sensors -- */

/* ADC count from 0 to limit; NaN becomes 0. */
static inline uint32_t adc_count(double value, double limit) {
    return value > 0.0 ? (uint32_t)(value < limit ? value : limit) : 0u;
}

/* The nonlinearity is u - u^3 over half the range, with the maximum lvdt_linearity_m; mid scale is x = 0. */
static inline uint32_t read_position(const fdvv_rig_model *m, double lvdt_m, double noise_m) {
    double u = 2.0 * lvdt_m / m->lvdt_range_m, scale = 2.598076211353316; /* 1 / max(u - u^3) */
    double position_m = lvdt_m + m->lvdt_linearity_m * scale * u * (1.0 - u * u) + noise_m;
    double count = (position_m / m->lvdt_range_m + 0.5) * m->lvdt_steps + 0.5;
    return adc_count(count, m->lvdt_steps - 0.5);
}

/* Hysteresis of the finger's sensor, then gain, range and resolution. */
static double read_finger(fdvv_rig *r, double noise_N) {
    const fdvv_rig_model *m = &r->model;
    double half = 0.5 * m->sensor_hysteresis_N;
    r->hysteresis_N = clamp(r->hysteresis_N, r->y[SENSED] - half, r->y[SENSED] + half);
    double value = clamp(m->sensor_gain * r->hysteresis_N + noise_N, -m->sensor_full_scale_N, m->sensor_full_scale_N);
    return m->sensor_lsb_N > 0.0 ? m->sensor_lsb_N * rounded(value / m->sensor_lsb_N) : value;
}

/* The filter over one step, exact for what goes straight from one input to the other. */
static inline void filter_keycap(fdvv_rig *r, double from, double to) {
    double lag = r->keycap_lag_steps * (to - from);
    r->keycap = to - lag + r->keycap_keep * (r->keycap - from + lag);
    r->keycap_input = to;
}

static uint16_t read_keycap(const fdvv_rig *r, double noise) {
    const fdvv_rig_model *m = &r->model;
    if (m->keycap_kind <= 0.0) return 0;
    double ratio = m->keycap_gain * r->keycap / m->keycap_full_scale + m->keycap_offset + noise;
    double count = (0.5 + 0.5 * ratio) * m->keycap_steps + 0.5;
    return (uint16_t)adc_count(count, m->keycap_steps - 0.5);
}

static uint16_t read_supply_mV(const fdvv_rig *r) {
    const fdvv_rig_model *m = &r->model;
    double ratio = m->current_loop_s > 0.0 ? 0.0 : r->drive / m->supply_V;
    double volts = m->supply_V - m->source_ohm * ratio * (r->enable ? r->y[AMPS] : 0.0);
    return (uint16_t)adc_count(1000.0 * volts + 0.5, 65535.0);
}

/* Uniform from -1 to 1. */
static double draw(fdvv_rig *r) {
    r->thermistor_draw = r->thermistor_draw * 1664525u + 1013904223u;
    return (double)r->thermistor_draw / 2147483648.0 - 1.0;
}

/* A divider of pull-up and thermistor, ratiometric, 12 bits. */
static uint16_t read_thermistor(fdvv_rig *r, double noise) {
    const fdvv_rig_model *m = &r->model;
    double warm_1_K = 1.0 / (m->room_C + r->bead_K + 273.15) - 1.0 / 298.15;
    double ohm = m->thermistor_25_ohm * exp(m->thermistor_beta_K * warm_1_K);
    if (m->thermistor_kind <= 0.0) return 0;
    if (m->thermistor_kind > 1.0) return m->thermistor_kind > 2.0 ? 0 : 4095;
    return (uint16_t)adc_count(4096.0 * ohm / (ohm + m->pull_up_ohm) + noise + 0.5, 4095.5);
}

static void read_sensors(fdvv_rig *r, const fdvv_rig_noise *noise, fdvv_inputs *inputs) {
    r->sensed_N = read_finger(r, noise->force_N);
    inputs->time_us += (uint32_t)(1e6 * r->model.step_s * (double)r->grid.steps_per_tick + 0.5);
    inputs->elapsed_ticks = 1;
    inputs->supply_mV = read_supply_mV(r);
    inputs->force_counts = read_keycap(r, noise->keycap);
    if (r->model.thermistor_kind > 0.0) /* the sum of six: nearly normal, of a standard deviation of sqrt(2) */
        inputs->thermistor_counts = read_thermistor(
            r, r->model.thermistor_noise / sqrt(2.0) * (draw(r) + draw(r) + draw(r) + draw(r) + draw(r) + draw(r)));
    inputs->board = 0;
}

static inline void add_read(fdvv_inputs *inputs, uint32_t count) {
    inputs->sum += count;
    if (count < inputs->lowest) inputs->lowest = (uint16_t)count;
    if (count > inputs->highest) inputs->highest = (uint16_t)count;
}

/* -- a tick -- */

static void write_row(const fdvv_rig *r, double t, const double *dy, double *row) {
    const double *y = r->y;
    row[FDVV_RIG_TIME] = t;
    row[FDVV_RIG_CAP] = y[XC], row[FDVV_RIG_SPEED] = y[VC], row[FDVV_RIG_ACCELERATION] = dy[VC];
    row[FDVV_RIG_FORCE] = finger_force(r, y), row[FDVV_RIG_SENSED] = r->sensed_N;
    row[FDVV_RIG_CURRENT] = y[AMPS], row[FDVV_RIG_FINGER] = y[XF], row[FDVV_RIG_MAGNET] = y[XM];
    row[FDVV_RIG_ENERGY] = r->grid.audit ? stored(r, y) - r->energy_J - y[WORK] + y[LOSS] : 0.0;
}

static ALWAYS_INLINE void run(fdvv_rig *r, const fdvv_outputs *out, const fdvv_rig_noise *noise, double *rows,
                              fdvv_inputs *inputs, int magnet, int audit) {
    const fdvv_rig_grid *g = &r->grid;
    const double *noise_m = noise->position_m, h = r->model.step_s;
    double now[FDVV_RIG_STATES] = {0}, next_read = (double)g->steps_per_tick - (double)(g->reads - 1) * g->read_steps;
    int64_t next_row = rows ? 0 : g->steps_per_tick;
    for (int64_t s = 0; s < g->steps_per_tick; s++) {
        double t = r->tick_s + h * (double)s, before = r->y[LVDT];
        if (s == g->delay_steps) set_drive(r, out->duty_q15, out->enable);
        double next_A = magnet ? drive_magnet(r, t) : 0.0;
        if (s == next_row) {
            double slope[FDVV_RIG_STATES] = {0};
            rates(r, t, r->y, slope, magnet, audit);
            write_row(r, t, slope, rows);
            rows += FDVV_RIG_COLUMNS, next_row += g->steps_per_row;
        }
        advance(r, t, now, magnet, audit);
        r->magnet_A = next_A;
        if (r->model.keycap_kind > 1.0) filter_keycap(r, now[VC], now[VC]);
        else if (r->model.keycap_kind > 0.0) filter_keycap(r, r->keycap_input, cap_contact_force(r, r->y));
        for (double end = (double)(s + 1) + 1e-9; next_read <= end; next_read += g->read_steps) {
            double part = next_read - (double)s, line = h * now[LVDT] * part; /* parabola through both ends */
            double bend = (r->y[LVDT] - before - h * now[LVDT]) * part * part;
            add_read(inputs, read_position(&r->model, before + line + bend, *noise_m++));
            if (noise_m == noise->position_m + g->reads) next_read = 1e18;
        }
    }
}

void fdvv_rig_tick(fdvv_rig *r, const fdvv_outputs *out, const fdvv_rig_noise *noise, double *rows,
                   fdvv_inputs *inputs) {
    double span_s = r->model.step_s * (double)r->grid.steps_per_tick;
    r->tick_s = r->time_s;
    r->effort_per_s = (noise->effort_ratio - r->effort) / span_s;
    start_voice(r, out->slot, noise->latency);
    move_servo(r, out->stop_us, span_s);
    inputs->sum = 0, inputs->lowest = 65535, inputs->highest = 0;
    if (r->grid.audit) run(r, out, noise, rows, inputs, 1, 1);
    else if (r->model.magnet_kg > 0.0) run(r, out, noise, rows, inputs, 1, 0);
    else run(r, out, noise, rows, inputs, 0, 0);
    r->effort = noise->effort_ratio;
    r->time_s = r->tick_s + span_s;
    heat_coil(r, span_s);
    read_sensors(r, noise, inputs);
}

void fdvv_rig_write_tick(const fdvv_rig *rig, double *tick_row) {
    tick_row[FDVV_RIG_TICK_FORCE_N] = rig->sensed_N, tick_row[FDVV_RIG_TICK_HEAT_K] = rig->heat_K;
    tick_row[FDVV_RIG_TICK_STOP_M] = rig->stop_m;
}

void fdvv_rig_step(fdvv_rig *rig, int duty_q15, int enable, int stop_us, int slot, const double *position_noise_m,
                   const double *noise, double *rows, double *tick_row, fdvv_inputs *inputs) {
    fdvv_outputs out;
    fdvv_rig_noise random = {position_noise_m, noise[0], noise[1], noise[2], noise[3]};
    memset(&out, 0, sizeof out);
    out.duty_q15 = (int16_t)duty_q15, out.enable = (uint8_t)enable;
    out.stop_us = (uint16_t)stop_us, out.slot = (uint8_t)slot;
    fdvv_rig_write_tick(rig, tick_row);
    fdvv_rig_tick(rig, &out, &random, rows, inputs);
}

/* -- before the first tick -- */

static int is_valid_grid(const fdvv_rig_grid *g) {
    return g->steps_per_row > 0 && g->steps_per_tick > 0 && g->steps_per_tick % g->steps_per_row == 0 &&
           g->delay_steps >= 0 && g->delay_steps < g->steps_per_tick && g->reads > 0 && g->read_steps > 0.0 &&
           (double)(g->reads - 1) * g->read_steps < (double)g->steps_per_tick;
}

int fdvv_rig_start(fdvv_rig *r, const fdvv_rig_model *m, const fdvv_rig_grid *grid, double stop_us) {
    if (!is_valid_grid(grid)) return 1;
    memset(r, 0, sizeof *r);
    r->model = *m, r->grid = *grid, r->finger = m->finger;
    r->finger_1_kg = 1.0 / m->finger.finger_mass_kg, r->sensor_1_kg = 1.0 / m->sensor_mass_kg;
    r->frame_1_kg = 1.0 / m->frame_mass_kg, r->magnet_1_kg = m->magnet_kg > 0.0 ? 1.0 / m->magnet_kg : 0.0;
    r->fast_rate = 1.0 / m->finger.pulp_fast_s, r->slow_rate = 1.0 / m->finger.pulp_slow_s;
    r->bristle_N_m = m->coulomb_N / m->presliding_m;
    r->ohm = m->resistance_ohm + m->bridge_ohm;
    r->servo_m = r->servo_target_m = m->servo_m_us * (stop_us - m->servo_zero_us);
    r->stop_m = r->servo_m;
    r->magnet_1_ohm = 1.0 / m->magnet_ohm;
    double x = m->step_s * m->magnet_ohm / m->magnet_H; /* exact for a linearly extrapolated input */
    r->magnet_keep = exp(-x), r->magnet_mean = -expm1(-x), r->magnet_slope = 1.0 + expm1(-x) / x;
    r->amplifier_keep = exp(-m->amplifier_rate * m->step_s);
    r->keycap_keep = exp(-m->keycap_rate * m->step_s);
    r->keycap_lag_steps = 1.0 / (m->keycap_rate * m->step_s);
    r->count = FDVV_SYNTH_SILENCE;
    fdvv_synth_init(&r->bank);
    fdvv_synth_stop(&r->voice);
    r->energy_J = stored(r, r->y);
    return 0;
}

void fdvv_rig_press(fdvv_rig *r, const fdvv_gesture *gesture, double stiffness_N_m, double damping_N_s_m, double ago_s) {
    int first = r->time_s == 0.0 && r->past_steps == 0 && r->gesture.press_s == 0.0;
    r->gesture = *gesture;
    r->finger.finger_stiffness_N_m = stiffness_N_m, r->finger.finger_damping_N_s_m = damping_N_s_m;
    r->servo_next_s += ago_s - r->time_s, r->vibration_s += ago_s - r->time_s, r->sample_s += ago_s - r->time_s;
    r->time_s = ago_s;
    r->drive_mode = FDVV_RIG_GESTURE;
    r->past_steps = 0;
    if (!first) return;
    r->y[XF] = gesture->start_m < 0.0 ? gesture->start_m : 0.0;
    /* a cone is worn on the finger, the plate of a cell rests on it */
    r->y[XT] = r->model.cell_damping_N_s_m > 0.0 ? 0.0 : r->y[XF];
    r->energy_J = stored(r, r->y);
}

/* When the mode changes, position and force are converted so that the force of the muscle is continuous. */
void fdvv_rig_lead(fdvv_rig *r, int drive_mode, double target, double target_1_s, double tracking_1_s) {
    double x = r->y[XF], v = r->y[VF], k = r->finger.finger_stiffness_N_m, b = r->finger.finger_damping_N_s_m;
    double q, q_1_s;
    if (r->drive_mode == FDVV_RIG_GESTURE) referent(&r->gesture, r->time_s, &q, &q_1_s);
    else driven_referent(r, r->time_s, &q, &q_1_s);
    if (drive_mode == FDVV_RIG_TARGET_FORCE && r->drive_mode != FDVV_RIG_TARGET_FORCE)
        q = k * (q - x) + b * q_1_s, q_1_s = k * (q_1_s - v);
    if (drive_mode == FDVV_RIG_TARGET_POSITION && r->drive_mode == FDVV_RIG_TARGET_FORCE) q = x + q / k, q_1_s = 0.0;
    r->drive_mode = (uint8_t)drive_mode, r->target_s = r->time_s;
    r->target = target, r->target_1_s = target_1_s, r->tracking_1_s = tracking_1_s;
    r->error = q - target, r->error_1_s = q_1_s - target_1_s;
}

void fdvv_rig_look(fdvv_rig *r, fdvv_inputs *inputs) {
    uint32_t count = read_position(&r->model, r->y[LVDT], 0.0);
    memset(inputs, 0, sizeof *inputs);
    inputs->sum = count * (uint32_t)r->grid.reads;
    inputs->lowest = inputs->highest = (uint16_t)count;
    inputs->elapsed_ticks = 1;
    inputs->supply_mV = read_supply_mV(r);
    inputs->force_counts = read_keycap(r, 0.0);
    inputs->thermistor_counts = read_thermistor(r, 0.0);
}

static uint8_t load_wave(fdvv_synth_bank *bank, uint16_t at, const uint8_t *samples, uint16_t count) {
    enum { PIECE = 128 };
    for (uint16_t done = 0; done < count; done = (uint16_t)(done + PIECE)) {
        uint8_t some = (uint8_t)(count - done < PIECE ? count - done : PIECE);
        if (!fdvv_synth_load(bank, (uint16_t)(at + done), samples + done, some)) return 0;
    }
    return 1;
}

uint8_t fdvv_rig_load(fdvv_rig *r, const uint8_t *image) {
    uint16_t at = 0;
    for (uint8_t i = 0; i < fdvv_image_head(image)->slots; i++) {
        const fdvv_slot *s = fdvv_image_slot(image, i);
        fdvv_synth_slot slot = {s->frequency_Hz16, s->duration_samples, s->amplitude_counts, s->decay_q16,
                                at, s->wave_samples, s->waveform};
        if (!load_wave(&r->bank, at, image + s->wave_at, s->wave_samples) || !fdvv_synth_set(&r->bank, i, &slot))
            return 0;
        at = (uint16_t)(at + s->wave_samples);
    }
    return 1;
}

void fdvv_rig_sizes(int64_t *model_bytes, int64_t *grid_bytes, int64_t *rig_bytes) {
    *model_bytes = (int64_t)sizeof(fdvv_rig_model);
    *grid_bytes = (int64_t)sizeof(fdvv_rig_grid);
    *rig_bytes = (int64_t)sizeof(fdvv_rig);
}
