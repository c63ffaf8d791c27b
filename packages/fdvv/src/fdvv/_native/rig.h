/* Simulation of the rig as seen by the board: one call per tick, from duty to readings. Finger, contact, coil, mover,
 * stops, servo, exciter and sensors; no controller. SI units, x positive downward. */
#ifndef FDVV_RIG_H
#define FDVV_RIG_H

#include "fdvv.h"
#include "image.h"
#include "inputs.h"
#include "synth.h"

/* Constant parameters. A loss is 1.5 times alpha of Hunt and Crossley; a rate is in 1/s. */
typedef struct {
    fdvv_finger finger;
    double sensor_mass_kg;      /* of the worn cone, or of the cell's plate */
    double contact_stiffness_N_m;
    double contact_loss_s_m;
    double cell_damping_N_s_m;  /* above 0: the contact is a cell in the cap, a linear spring that also pulls */
    double force_constant_N_A;
    double droop_1_m2;
    double droop_centre_m;
    double resistance_ohm;      /* of the coil when cold */
    double bridge_ohm;
    double source_ohm;
    double inductance_H;        /* at the centre */
    double reluctance_H_m;      /* its slope */
    double copper_1_K;
    double heat_K_W;
    double heat_s;
    double supply_V;
    double current_loop_s;      /* 0: the bridge sets a voltage */
    double drive_lsb;           /* resolution of the duty ratio; 0: that of the duty */
    double drive_low;           /* smallest ratio */
    double mover_mass_kg;       /* the exciter's magnet included */
    double frame_mass_kg;       /* without it */
    double gravity_m_s2;
    double coulomb_N;
    double presliding_m;
    double viscous_N_s_m;
    double stop_stiffness_N_m;
    double stop_loss_s_m;
    double top_stiffness_N_m;
    double top_loss_s_m;
    double servo_zero_us;
    double servo_m_us;
    double servo_frame_s;
    double servo_deadband_m;
    double servo_m_s;
    double servo_lag_s;
    double servo_play_m;
    double magnet_kg;           /* 0: there is no exciter */
    double magnet_stiffness_N_m;
    double magnet_damping_N_s_m;
    double magnet_motor_N_A;
    double magnet_ohm;
    double magnet_H;
    double amplifier_V_count;
    double amplifier_clip_V;
    double amplifier_rate;
    double vibration_latency_s;
    double vibration_jitter_s;
    double lvdt_rate;
    double lvdt_linearity_m;
    double lvdt_range_m;
    double lvdt_steps;          /* of its ADC over the range */
    double sensor_rate;
    double sensor_gain;
    double sensor_hysteresis_N;
    double sensor_full_scale_N;
    double sensor_lsb_N;        /* 0: continuous */
    double keycap_kind;         /* 0 none, 1 force, 2 acceleration */
    double keycap_full_scale;   /* N or m/s2 */
    double keycap_rate;
    double keycap_gain;
    double keycap_offset;       /* relative to full scale */
    double keycap_steps;        /* of its ADC over both signs */
    double thermistor_kind;     /* 0 none, 1 sound, 2 open, 3 shorted */
    double thermistor_share;    /* of the coil's rise, where it ends */
    double thermistor_lag_s;
    double thermistor_25_ohm;
    double thermistor_beta_K;
    double pull_up_ohm;
    double thermistor_noise;    /* counts, rms */
    double room_C;
    double step_s;
} fdvv_rig_model;

/* Discretization of a tick. */
typedef struct {
    int64_t steps_per_tick;
    int64_t steps_per_row;      /* divides steps_per_tick */
    int64_t delay_steps;        /* from the tick to the new duty; below steps_per_tick */
    int64_t reads;              /* position readings per tick */
    double read_steps;          /* between two readings; the last one is at the tick */
    int64_t audit;              /* 1: compute the energy balance */
} fdvv_rig_grid;

/* Random numbers of one tick. */
typedef struct {
    const double *position_m;   /* (reads,) */
    double force_N;             /* of the finger's sensor */
    double keycap;              /* of the keycap's sensor, relative to its range */
    double effort_ratio;        /* modulation of the finger's force at the end of the tick */
    double latency;             /* of a vibration started now, in standard deviations */
} fdvv_rig_noise;

enum {
    FDVV_RIG_TIME, FDVV_RIG_CAP, FDVV_RIG_SPEED, FDVV_RIG_ACCELERATION, FDVV_RIG_FORCE, FDVV_RIG_SENSED,
    FDVV_RIG_CURRENT, FDVV_RIG_FINGER, FDVV_RIG_MAGNET, FDVV_RIG_ENERGY, FDVV_RIG_COLUMNS
};

/* state variables: those of the exciter, then those of the energy balance come last */
enum { XF, VF, H1, H2, XT, VT, XC, VC, AMPS, LVDT, SENSED, XM, VM, WORK, LOSS, FDVV_RIG_STATES };

/* what drives the finger: a gesture, a target position of its referent, or a target force of its muscle */
enum { FDVV_RIG_GESTURE, FDVV_RIG_TARGET_POSITION, FDVV_RIG_TARGET_FORCE };

typedef struct {
    fdvv_rig_model model;
    fdvv_rig_grid grid;
    fdvv_gesture gesture;
    fdvv_finger finger;            /* with the impedance of this gesture */
    double y[FDVV_RIG_STATES], past[2][FDVV_RIG_STATES];
    double finger_1_kg, sensor_1_kg, frame_1_kg, magnet_1_kg, fast_rate, slow_rate, bristle_N_m;
    double drive, ohm;             /* V (or A with a current loop), and the total resistance of that circuit */
    double slip_m, slip_at_m;      /* deflection of the friction's bristle, and the cap's position at that moment */
    double effort, effort_per_s, tick_s;
    double time_s;                 /* relative to the start of the gesture */
    double target, target_1_s;     /* of a driven finger: a line from target_s on, m or N */
    double error, error_1_s;       /* of the referent (or force) to that line at target_s */
    double tracking_1_s, target_s; /* rate at which the error decays; start of the line */
    double stop_m, servo_m, servo_target_m, servo_next_s;
    double heat_K, bead_K;         /* of the coil, and of the thermistor at its bobbin */
    double magnet_1_ohm, magnet_A, magnet_target_A, magnet_keep, magnet_mean, magnet_slope, amplifier_V, amplifier_keep;
    double vibration_s, sample_s;  /* start of the voice; time of its next sample */
    double hysteresis_N, sensed_N, keycap, keycap_input, keycap_keep, keycap_lag_steps, energy_J;
    fdvv_synth_bank bank;
    fdvv_synth_voice voice;
    uint16_t count;                /* of the vibration board's DAC */
    uint8_t waiting, slot, enable, drive_mode; /* drive_mode: FDVV_RIG_GESTURE, … */
    int past_steps;                /* valid rows of past */
    uint32_t thermistor_draw;      /* state of the noise of its converter */
} fdvv_rig;

/* Start at rest: cap up, coil cold, stop at the position for stop_us. Returns 0, or 1 if the grid is invalid. */
int fdvv_rig_start(fdvv_rig *rig, const fdvv_rig_model *model, const fdvv_rig_grid *grid, double stop_us);

/* Let the finger follow this gesture; ago_s is the time since its start (negative: it starts later). */
void fdvv_rig_press(fdvv_rig *rig, const fdvv_gesture *gesture, double stiffness_N_m, double damping_N_s_m,
                    double ago_s);

/* Drive the finger interactively: from now on its referent (FDVV_RIG_TARGET_POSITION, m), or the force of its muscle
 * (FDVV_RIG_TARGET_FORCE, N), approaches the line target + target_1_s * (time - now), critically damped with the rate
 * tracking_1_s. The force of the muscle is continuous, whatever drove the finger before. */
void fdvv_rig_lead(fdvv_rig *rig, int drive_mode, double target, double target_1_s, double tracking_1_s);

/* The readings of the first tick: those of the cap at rest, without noise. */
void fdvv_rig_look(fdvv_rig *rig, fdvv_inputs *inputs);

/* Load the waveforms of a checked program into the vibration board. Returns 1, or 0 if they do not fit. */
uint8_t fdvv_rig_load(fdvv_rig *rig, const uint8_t *image);

/* Advance by one tick; the outputs take effect after delay_steps. Writes steps_per_tick / steps_per_row rows of
 * FDVV_RIG_COLUMNS unless rows is 0, and the readings of the next tick. */
void fdvv_rig_tick(fdvv_rig *rig, const fdvv_outputs *outputs, const fdvv_rig_noise *noise, double *rows,
                   fdvv_inputs *inputs);

enum { FDVV_RIG_TICK_FORCE_N, FDVV_RIG_TICK_HEAT_K, FDVV_RIG_TICK_STOP_M, FDVV_RIG_TICK_COLUMNS };

/* Write FDVV_RIG_TICK_COLUMNS numbers of this tick: reading of the finger's sensor, temperature rise of the coil,
 * position of the bottom stop. */
void fdvv_rig_write_tick(const fdvv_rig *rig, double *tick_row);

/* fdvv_rig_write_tick, then fdvv_rig_tick, without structures; noise: the members of fdvv_rig_noise from force_N on. */
void fdvv_rig_step(fdvv_rig *rig, int duty_q15, int enable, int stop_us, int slot, const double *position_noise_m,
                   const double *noise, double *rows, double *tick_row, fdvv_inputs *inputs);

/* Sizes in bytes of model, grid and rig, for Python to compare with its own. */
void fdvv_rig_sizes(int64_t *model_bytes, int64_t *grid_bytes, int64_t *rig_bytes);

#endif
