/* The rig as a board sees it: one call a tick, duty in, readings out. Finger, contact, coil, mover, stops,
 * servo, exciter and sensors; no controller. SI units, x positive downward. */
#ifndef FDVV_RIG_H
#define FDVV_RIG_H

#include "fdvv.h"
#include "image.h"
#include "inputs.h"
#include "synth.h"

/* What does not change while the rig runs. A loss is 1.5 times Hunt and Crossley's alpha; a rate is in 1/s. */
typedef struct {
    fdvv_finger finger;
    double sensor_mass_kg;
    double contact_stiffness_N_m;
    double contact_loss_s_m;
    double force_constant_N_A;
    double droop_1_m2;
    double droop_centre_m;
    double resistance_ohm;      /* of the coil when cold */
    double bridge_ohm;
    double source_ohm;
    double inductance_H;        /* at the centre */
    double reluctance_H_m;      /* and its slope */
    double copper_1_K;
    double heat_K_W;
    double heat_s;
    double supply_V;
    double current_loop_s;      /* 0: the bridge sets a voltage */
    double drive_lsb;           /* of the duty's ratio; 0: as fine as the duty is */
    double drive_low;           /* smallest ratio */
    double mover_mass_kg;       /* the exciter's magnet included */
    double frame_mass_kg;       /* and without it */
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
    double lvdt_steps;          /* of its converter over the range */
    double sensor_rate;
    double sensor_gain;
    double sensor_hysteresis_N;
    double sensor_full_scale_N;
    double sensor_lsb_N;        /* 0: continuous */
    double keycap_kind;         /* 0 none, 1 force, 2 acceleration */
    double keycap_full_scale;   /* N or m/s2 */
    double keycap_rate;
    double keycap_steps;        /* of its converter over both signs */
    double step_s;
} fdvv_rig_model;

/* How a tick is cut. */
typedef struct {
    int64_t steps_per_tick;
    int64_t steps_per_row;      /* divides steps_per_tick */
    int64_t delay_steps;        /* tick to new drive; below steps_per_tick */
    int64_t reads;              /* of the position per tick */
    double read_steps;          /* between two reads; the last one is at the tick */
    int64_t audit;              /* 1: account for energy */
} fdvv_rig_grid;

/* What is random about one tick. */
typedef struct {
    const double *position_m;   /* (reads,) */
    double force_N;             /* of the finger's sensor */
    double keycap;              /* of the cap's, in proportion to its range */
    double effort_ratio;        /* modulation of the finger's force at the end of the tick */
    double latency;             /* of a vibration that starts now, in standard deviations */
} fdvv_rig_noise;

enum {
    FDVV_RIG_TIME, FDVV_RIG_CAP, FDVV_RIG_SPEED, FDVV_RIG_ACCELERATION, FDVV_RIG_FORCE, FDVV_RIG_FELT,
    FDVV_RIG_CURRENT, FDVV_RIG_FINGER, FDVV_RIG_MAGNET, FDVV_RIG_ENERGY, FDVV_RIG_COLUMNS
};

/* states of the equations; the exciter's last but the audit's */
enum { XF, VF, H1, H2, XT, VT, XC, VC, AMPS, LVDT, SENSED, XM, VM, WORK, LOSS, FDVV_RIG_STATES };

/* what draws the finger */
enum { FDVV_RIG_LED_NOT, FDVV_RIG_LED_PLACE, FDVV_RIG_LED_PUSH };

typedef struct {
    fdvv_rig_model model;
    fdvv_rig_grid grid;
    fdvv_gesture gesture;
    fdvv_finger finger;            /* with the impedance of this gesture */
    double y[FDVV_RIG_STATES], past[2][FDVV_RIG_STATES];
    double finger_1_kg, sensor_1_kg, frame_1_kg, magnet_1_kg, fast_rate, slow_rate, bristle_N_m;
    double drive, ohm;             /* V (or A behind a current loop), and all resistance in that circle */
    double slip_m, slip_at_m;      /* stretch of the friction's bristle, and the cap's place at that moment */
    double effort, effort_per_s, tick_s;
    double time_s;                 /* of the gesture's clock */
    double goal, goal_1_s;         /* a finger that is led: the line it nears, m or N, from led_s on */
    double gap, gap_1_s, near_1_s, led_s; /* how far from it the finger is drawn then, and how fast it nears */
    double stop_m, servo_m, servo_heard_m, servo_next_s;
    double warm_K;
    double magnet_1_ohm, magnet_A, magnet_goal_A, magnet_keep, magnet_mean, magnet_slope, amplifier_V, amplifier_keep;
    double vibration_s, sample_s;  /* when the voice starts; when its next sample is due */
    double held_N, felt_N, keycap, keycap_keep, energy_J;
    fdvv_synth_bank bank;
    fdvv_synth_voice voice;
    uint16_t count;                /* of the vibration's converter */
    uint8_t waiting, slot, enable, led; /* led: FDVV_RIG_LED_… */
    int fresh;
} fdvv_rig;

/* Start at rest, cap up, coil cold, stop where stop_us sets it; 0, or 1 if a count of the grid is impossible. */
int fdvv_rig_start(fdvv_rig *rig, const fdvv_rig_model *model, const fdvv_rig_grid *grid, double stop_us);

/* Let the finger follow this gesture, whose time begins `ago` seconds before now. */
void fdvv_rig_press(fdvv_rig *rig, const fdvv_gesture *gesture, double stiffness_N_m, double damping_N_s_m,
                    double ago_s);

/* Lead the finger live: from now on its referent (LED_PLACE, m), or the force that its muscle pushes with in place of
 * a referent (LED_PUSH, N), nears the line goal + goal_1_s * (time - now), critically damped at the rate near_1_s.
 * Whatever led it before, a gesture included, the force of the muscle does not jump. */
void fdvv_rig_lead(fdvv_rig *rig, int led, double goal, double goal_1_s, double near_1_s);

/* Give the readings of a cap that rests, without noise: those of the first tick. */
void fdvv_rig_look(fdvv_rig *rig, fdvv_inputs *inputs);

/* Give the exciter's board the waveforms of a checked program; 1, or 0 if it has no room for one of them. */
uint8_t fdvv_rig_load(fdvv_rig *rig, const uint8_t *image);

/* Go on for one tick: the outputs take effect delay_steps after it. Writes steps_per_tick / steps_per_row rows
 * of FDVV_RIG_COLUMNS unless rows is 0, and the readings of the tick that then begins. */
void fdvv_rig_tick(fdvv_rig *rig, const fdvv_outputs *outputs, const fdvv_rig_noise *noise, double *rows,
                   fdvv_inputs *inputs);

enum { FDVV_RIG_FELT_N, FDVV_RIG_WARM_K, FDVV_RIG_STOP_M, FDVV_RIG_TOLD };

/* What stands at this tick (FDVV_RIG_TOLD numbers): the force that the finger's sensor told, warmth of the coil, bottom stop. */
void fdvv_rig_tell(const fdvv_rig *rig, double *told);

/* Tell, then go on for a tick, for callers without structures; noise is that of fdvv_rig_noise from force_N on. */
void fdvv_rig_step(fdvv_rig *rig, int duty_q15, int enable, int stop_us, int slot, const double *position_noise_m,
                   const double *noise, double *rows, double *told, fdvv_inputs *inputs);

/* Sizes in bytes of model, grid and rig, for Python to compare with its own. */
void fdvv_rig_sizes(int64_t *model_bytes, int64_t *grid_bytes, int64_t *rig_bytes);

#endif
