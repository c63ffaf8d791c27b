/* Equations of motion of the rig (see docs/explanation/twin.md) and one step of their integration.
 *
 * Third-order Adams-Bashforth, started with two Runge-Kutta steps, so that one evaluation per step is enough. */
#ifndef FDVV_RIG_MOTION_H
#define FDVV_RIG_MOTION_H

#include "finger.h"
#include "rig.h"

#include <string.h>

#if defined(__GNUC__)
#define ALWAYS_INLINE inline __attribute__((always_inline))
#else
#define ALWAYS_INLINE inline
#endif

static inline double clamp(double value, double low, double high) {
    value = value < low ? low : value;
    return value > high ? high : value;
}

/* The conservative part of the force between cone and cap, or of the cell. */
static inline double contact_elastic(const fdvv_rig_model *m, double depth) {
    return m->cell_damping_N_s_m > 0.0 ? m->contact_stiffness_N_m * depth : elastic(m->contact_stiffness_N_m, depth);
}

static inline double cap_contact_force(const fdvv_rig *r, const double *y) {
    const fdvv_rig_model *m = &r->model;
    if (m->cell_damping_N_s_m > 0.0)
        return m->contact_stiffness_N_m * (y[XT] - y[XC]) + m->cell_damping_N_s_m * (y[VT] - y[VC]);
    return contact(m->contact_stiffness_N_m, m->contact_loss_s_m, y[XT] - y[XC], y[VT] - y[VC]);
}

/* Referent (or force) of a driven finger at t and its rate: the target line plus the decaying error. */
static inline void driven_referent(const fdvv_rig *r, double t, double *q, double *q_1_s) {
    double since = t - r->target_s, decay = exp(-r->tracking_1_s * since);
    double slope = r->error_1_s + r->tracking_1_s * r->error;
    *q = r->target + r->target_1_s * since + (r->error + slope * since) * decay;
    *q_1_s = r->target_1_s + (r->error_1_s - r->tracking_1_s * slope * since) * decay;
}

/* Force of the muscle on a finger at x, v. */
static inline double muscle_force(const fdvv_rig *r, double t, double x, double v) {
    double q, q_1_s;
    if (r->drive_mode == FDVV_RIG_GESTURE) return muscle(&r->finger, &r->gesture, t, x, v);
    driven_referent(r, t, &q, &q_1_s);
    if (r->drive_mode == FDVV_RIG_TARGET_FORCE) return q - r->finger.finger_damping_N_s_m * v;
    return r->finger.finger_stiffness_N_m * (q - x) + r->finger.finger_damping_N_s_m * (q_1_s - v);
}

/* Deflection of the bristle when the cap has moved to x: it follows until it slips. */
static inline double bristle_deflection(const fdvv_rig *r, double x) {
    return clamp(r->slip_m + (x - r->slip_at_m), -r->model.presliding_m, r->model.presliding_m);
}

static inline double volts_of(const fdvv_rig *r, double henry, double kt, double amps, double v) {
    const fdvv_rig_model *m = &r->model;
    if (m->current_loop_s <= 0.0) return r->drive;
    double required = (r->ohm + m->reluctance_H_m * v) * amps - kt * v + henry * (r->drive - amps) / m->current_loop_s;
    return clamp(required, -m->supply_V, m->supply_V);
}

/* Force of the pulp on cone or plate; a bare finger does not stick to the plate. */
static inline double pulp_on_cap(const fdvv_rig *r, const double *y, double *growth) {
    double force = pulp_force(&r->finger, y[XF] - y[XT], y[VF] - y[VT], y[H1] + y[H2], growth);
    return r->model.cell_damping_N_s_m > 0.0 && force < 0.0 ? 0.0 : force;
}

/* Force that the finger feels: at the cone's contact, or of the pulp on a cell's plate. */
static inline double finger_force(const fdvv_rig *r, const double *y) {
    double growth;
    return r->model.cell_damping_N_s_m > 0.0 ? pulp_on_cap(r, y, &growth) : cap_contact_force(r, y);
}

static ALWAYS_INLINE void rates(const fdvv_rig *r, double t, const double *y, double *dy, int magnet, int audit) {
    const fdvv_rig_model *m = &r->model;
    double effort = 1.0 + r->effort + r->effort_per_s * (t - r->tick_s);
    double pull = effort * muscle_force(r, t, y[XF], y[VF]);
    double compression_rate = y[VF] - y[VT], arms = y[H1] + y[H2], growth;
    double pulp = pulp_on_cap(r, y, &growth);
    double v = y[VC], amps = y[AMPS];

    double contact_force = cap_contact_force(r, y), deep = y[XC] - r->stop_m;
    double stop = contact(m->stop_stiffness_N_m, m->stop_loss_s_m, deep, v);
    double top = contact(m->top_stiffness_N_m, m->top_loss_s_m, -y[XC], -v);
    double bristle = bristle_deflection(r, y[XC]);
    double friction = r->bristle_N_m * bristle + m->viscous_N_s_m * v;
    double off = y[XC] - m->droop_centre_m;
    double kt = m->force_constant_N_A * (1.0 - m->droop_1_m2 * off * off);
    double henry = m->inductance_H + m->reluctance_H_m * off;
    double volts = volts_of(r, henry, kt, amps, v), coil = kt * amps - 0.5 * m->reluctance_H_m * amps * amps;
    double exciter_force = 0.0;

    if (magnet) {
        double damped = m->magnet_damping_N_s_m * (y[VM] - v);
        exciter_force = m->magnet_stiffness_N_m * y[XM] + damped - m->magnet_motor_N_A * r->magnet_A;
        dy[XM] = y[VM] - v;
        dy[VM] = -exciter_force * r->magnet_1_kg;
    }
    dy[XF] = y[VF];
    dy[VF] = (pull - pulp) * r->finger_1_kg;
    dy[H1] = r->finger.pulp_fast_ratio * growth - y[H1] * r->fast_rate;
    dy[H2] = r->finger.pulp_slow_ratio * growth - y[H2] * r->slow_rate;
    dy[XT] = y[VT];
    dy[VT] = (pulp - contact_force) * r->sensor_1_kg;
    dy[XC] = v;
    dy[VC] = (contact_force - coil - friction - stop + top + exciter_force + m->mover_mass_kg * m->gravity_m_s2) *
             r->frame_1_kg;
    dy[AMPS] = r->enable ? (volts - (r->ohm + m->reluctance_H_m * v) * amps + kt * v) / henry : 0.0;
    dy[LVDT] = m->lvdt_rate * (y[XC] - y[LVDT]);
    dy[SENSED] = m->sensor_rate * (pulp - y[SENSED]);
    if (!audit) return;
    dy[WORK] = pull * y[VF] + (r->enable ? volts * amps : 0.0);
    dy[LOSS] = (r->enable ? r->ohm * amps * amps : 0.0) + m->viscous_N_s_m * v * v + arms * compression_rate +
               (contact_force - contact_elastic(m, y[XT] - y[XC])) * (y[VT] - y[VC]) +
               (stop - elastic(m->stop_stiffness_N_m, deep)) * v - (top - elastic(m->top_stiffness_N_m, -y[XC])) * v;
    /* where a bare finger would have to pull, its pulp follows without force: what it stored is lost */
    double unclamped = pulp_force(&r->finger, y[XF] - y[XT], compression_rate, arms, &growth);
    dy[LOSS] += (pulp - unclamped) * compression_rate;
    if (!magnet) return;
    dy[WORK] += m->magnet_motor_N_A * r->magnet_A * (y[VM] - v);
    dy[LOSS] += m->magnet_damping_N_s_m * (y[VM] - v) * (y[VM] - v);
}

/* Kinetic, elastic, magnetic and gravitational energy. */
static inline double stored(const fdvv_rig *r, const double *y) {
    const fdvv_rig_model *m = &r->model;
    const fdvv_finger *f = &r->finger;
    double compression = y[XF] - y[XT], henry = m->inductance_H + m->reluctance_H_m * (y[XC] - m->droop_centre_m);
    double depth = contact_elastic(m, y[XT] - y[XC]) / m->contact_stiffness_N_m, deep = fmax(y[XC] - r->stop_m, 0.0), high = fmax(-y[XC], 0.0);
    double bristle = bristle_deflection(r, y[XC]);
    double moving = f->finger_mass_kg * y[VF] * y[VF] + m->sensor_mass_kg * y[VT] * y[VT] +
                    m->frame_mass_kg * y[VC] * y[VC] + m->magnet_kg * y[VM] * y[VM] + henry * y[AMPS] * y[AMPS];
    double springs = m->contact_stiffness_N_m * depth * depth + m->stop_stiffness_N_m * deep * deep +
                     m->top_stiffness_N_m * high * high + r->bristle_N_m * bristle * bristle +
                     m->magnet_stiffness_N_m * y[XM] * y[XM];
    return 0.5 * (moving + springs) + f->pulp_relaxed_ratio * pulp_energy(f, compression) -
           f->strap_N * (compression + f->strap_m) - m->mover_mass_kg * m->gravity_m_s2 * y[XC];
}

static inline int used_states(int magnet, int audit) { return audit ? FDVV_RIG_STATES : magnet ? WORK : XM; }

static ALWAYS_INLINE void runge_kutta(fdvv_rig *r, double t, const double *now, int magnet, int audit) {
    static const double reach[3] = {0.5, 0.5, 1.0}, weight[3] = {2.0, 2.0, 1.0};
    double h = r->model.step_s, slope[FDVV_RIG_STATES] = {0}, sum[FDVV_RIG_STATES], stage[FDVV_RIG_STATES];
    int states = used_states(magnet, audit);
    memcpy(slope, now, sizeof slope);
    memcpy(sum, now, sizeof sum);
    memcpy(stage, r->y, sizeof stage);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < states; j++) stage[j] = r->y[j] + reach[i] * h * slope[j];
        rates(r, t + reach[i] * h, stage, slope, magnet, audit);
        for (int j = 0; j < states; j++) sum[j] += weight[i] * slope[j];
    }
    for (int j = 0; j < states; j++) r->y[j] += h / 6.0 * sum[j];
}

/* Advance one step; now receives the rates at its start. */
static ALWAYS_INLINE void advance(fdvv_rig *r, double t, double *now, int magnet, int audit) {
    double h = r->model.step_s / 12.0;
    rates(r, t, r->y, now, magnet, audit);
    if (r->past_steps < 2) {
        runge_kutta(r, t, now, magnet, audit);
        r->past_steps++;
        memcpy(r->past[1], r->past[0], sizeof r->past[0]);
        memcpy(r->past[0], now, sizeof r->past[0]);
    } else {
        int states = used_states(magnet, audit);
        for (int j = 0; j < states; j++) {
            r->y[j] += h * (23.0 * now[j] - 16.0 * r->past[0][j] + 5.0 * r->past[1][j]);
            r->past[1][j] = r->past[0][j];
            r->past[0][j] = now[j];
        }
    }
    double deflection = bristle_deflection(r, r->y[XC]);
    if (audit) r->y[LOSS] += r->model.coulomb_N * fabs(r->y[XC] - r->slip_at_m - (deflection - r->slip_m));
    r->slip_m = deflection;
    r->slip_at_m = r->y[XC];
}

#endif
