/* Force loop at the finger, for boards with a floating-point unit and a load cell in the cap: a state estimator, the
 * inverse of the identified rig at the predicted state, and a controller of force with lead. Single precision, SI
 * units, x positive downward. docs/explanation/force-loop.md derives it. */
#ifndef FDVV_FORCE_LOOP_H
#define FDVV_FORCE_LOOP_H

/* fdvv_force_loop_gains, the constants of one rig, and why the loop was opened; made from protocol/force_loop.toml */
#include "loop_protocol.h"

typedef struct {
    fdvv_force_loop_gains gains;
    float x_m, v_m_s, a_m_s2, unknown_N, lagging_m;
    float coil_N, cell_coil_N, last_N;
    float force_N;            /* at the finger */
    float error_N, low_N[2], integral_N, slow_m_s, contact;
    float target_N;           /* of the last tick: what a fade begins with */
    float step_N;             /* left of the last step of the target, which the feedback follows with a lag */
    float last_m;             /* displacement in the last tick */
    float turning_1_m;        /* part of the way between the strokes' curves per displacement */
    float release;            /* weight of the release's curve: 0 in a press, 1 once the cap has turned */
    float slid, slid_m;       /* part of the dry friction, -1 to 1, and the displacement it was taken at */
    float scale;              /* of what is fed back: halved at each ringing */
    uint16_t counts;          /* last reading of the cell */
    uint16_t same_ticks, saturated_ticks, unexplained_ticks, ringing_ticks;
    int8_t side;              /* of the last large feedback */
    uint8_t turns;            /* of its sign, in ringing_ticks */
    uint8_t enabled, started, at_stop, fault;
    uint8_t state;            /* of the program in the last tick; FDVV_NO_STATE before the first */
} fdvv_force_loop;

#define FDVV_NO_STATE 255

void fdvv_force_loop_init(fdvv_force_loop *loop, const fdvv_force_loop_gains *gains);

/* Estimate the state from the readings of a tick: position of the cap and force of the cell. */
void fdvv_force_loop_estimate(fdvv_force_loop *loop, float position_m, float cell_N, float travel_m);

/* Watch the cell, before the estimate of a tick: counts from 0 to 2 * middle. Sets fault. */
void fdvv_force_loop_watch(fdvv_force_loop *loop, uint16_t counts, uint16_t middle);

/* Why the loop was opened, FDVV_LOOP_FAULT_SOUND if it was not. */
uint8_t fdvv_force_loop_fault(const fdvv_force_loop *loop);

/* Does the loop use the cell in this tick? An overload opens the loop while it lasts. */
uint8_t fdvv_force_loop_is_closed(const fdvv_force_loop *loop);

/* Nothing is rendered: forget the estimates, keep gains and fault. */
void fdvv_force_loop_rest(fdvv_force_loop *loop);

/* Open the loop until the next fdvv_force_loop_init; the fault stays. */
void fdvv_force_loop_open(fdvv_force_loop *loop);

/* Return 0 if the constants are valid, else 1 + the number of the first that is not a number or out of its range. */
uint8_t fdvv_force_loop_check(const fdvv_force_loop_gains *gains);
uint8_t fdvv_load_cell_check(const fdvv_load_cell *cell);

/* Command for a target without the cell, after a fault: what the rig adds at rest is compensated. */
float fdvv_force_loop_open_N(const fdvv_force_loop *loop, float target_N, float x_m);

/* Follow the cap's turns: after each, the other stroke's curve comes in over reversal_m, or over more where the curves
 * lie far apart. apart_N: press less release, at the present displacement. */
void fdvv_force_loop_turn(fdvv_force_loop *loop, float apart_N, float reversal_m, float travel_m);

/* Weight of the release's curve at a displacement near the present one. */
float fdvv_force_loop_release_at(const fdvv_force_loop *loop, float x_m);

/* Displacement when the drive of this tick acts. */
float fdvv_force_loop_ahead_m(const fdvv_force_loop *loop);

/* Take note of the program's state and of its target at the present displacement: a target that steps from one state
 * to the next reaches the drive at once, and the feedback within a few milliseconds. */
void fdvv_force_loop_enter(fdvv_force_loop *loop, uint8_t state, float now_N);

/* Command for a target at the displacement ahead and one at the present displacement. */
float fdvv_force_loop_command_N(fdvv_force_loop *loop, float ahead_N, float now_N, float travel_m);

/* Predict the state at the next tick, under the command that the bridge received. */
void fdvv_force_loop_predict(fdvv_force_loop *loop, float command_N);

#endif
