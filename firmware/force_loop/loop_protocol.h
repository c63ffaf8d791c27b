/* Made by tools/make_protocol.py from protocol/force_loop.toml; do not edit. */
#ifndef FDVV_FORCE_LOOP_PROTOCOL_H
#define FDVV_FORCE_LOOP_PROTOCOL_H

#include <stdint.h>

#include "protocol.h"

#define FDVV_FORCE_LOOP_PROTOCOL_VERSION 1
#define FDVV_FORCE_LOOP_PROTOCOL_HASH 0x8fb59a2fu


/* why a request of the force loop was not carried out, beyond those of every request */
enum {
    FDVV_REFUSAL_NO_LOAD_CELL = 14,
};

/* of the force loop */
enum {
    FDVV_LOOP_STATE_OPEN = 0,
    FDVV_LOOP_STATE_CLOSED = 1,
    FDVV_LOOP_STATE_FAILED = 2,
    FDVV_LOOP_STATES = 3,
};

/* why the force loop was opened by itself, until it is closed anew */
enum {
    FDVV_LOOP_FAULT_SOUND = 0,
    FDVV_LOOP_FAULT_CELL_SATURATED = 1,
    FDVV_LOOP_FAULT_CELL_DEAD = 2,
    FDVV_LOOP_FAULT_CELL_WRONG = 3,
    FDVV_LOOP_FAULTS = 4,
};

/* bits of what a board has, beyond those of every board */
enum {
    FDVV_BOARD_FLAG_FORCE_LOOP = 1 << 5,
};

/* a load cell in the cap, from its data sheet; all 0: there is none */
typedef struct {
    float plate_kg; /* kg; 0.0 to 0.1; plate between finger and cell */
    float stiffness_N_m; /* N/m; 0.0 to 100000000.0; of the cell */
    float damping_N_s_m; /* N s/m; 0.0 to 10000.0; of the cell */
    float filter_s; /* s; 0.0 to 0.1; time constant of its filter */
} fdvv_load_cell;
typedef char fdvv_load_cell_has_16_bytes[sizeof(fdvv_load_cell) == 16 ? 1 : -1];
#define FDVV_LOAD_CELL_RANGES(X) \
    X(plate_kg, 0.0f, 0.1f) \
    X(stiffness_N_m, 0.0f, 100000000.0f) \
    X(damping_N_s_m, 0.0f, 10000.0f) \
    X(filter_s, 0.0f, 0.1f) \


/* constants of the force loop on one rig; docs/explanation/force-loop.md derives them */
typedef struct {
    float tick_s; /* s; 5e-05 to 0.002; period of the loop, that of the settings */
    float compute_ratio; /* ticks; 0.0 to 1.0; from the readings to the new drive */
    float mass_kg; /* kg; 0.0001 to 1.0; of all that moves, with the plate of the cell */
    float plate_kg; /* kg; 0.0 to 0.1; between finger and cell */
    float drag_N_s_m; /* N s/m; 0.0 to 100.0; of the bushing */
    float brake_N_s_m; /* N s/m; -100.0 to 100.0; of a coil driven by a voltage */
    float friction_N; /* N; 0.0 to 10.0 */
    float friction_m; /* m; 1e-06 to 0.01; displacement after a turn at which it has turned too */
    float own_N[8]; /* N; -10.0 to 10.0; the rig's own force against the finger, its weight included, at even steps from 0 */
    float own_per_m; /* 1/m; 0.0 to 1000000.0; steps per metre */
    float gain; /* 0.01 to 100.0; force per commanded force, a parabola over the displacement */
    float gain_1_m; /* 1/m; -100000.0 to 100000.0 */
    float gain_1_m2; /* 1/m2; -100000000.0 to 100000000.0 */
    float coil_rate; /* 0.0 to 1.0; lag of the coil's force */
    float cell_rate; /* 0.0 to 1.0; of the cell's filter */
    float position_rate; /* 0.0 to 1.0; of the position, less that of the cell */
    float free_gains[4]; /* -1000000000.0 to 1000000000.0; of the estimator: position, velocity, unknown force, lagging position */
    float stop_gains[4]; /* -1000000000.0 to 1000000000.0; the same at a stop */
    float lead_s; /* s; 0.0 to 0.05; from the state to the coil's force */
    float velocity_lead_s; /* s; -0.05 to 0.05; the same for the speed that drag goes by */
    float proportional; /* 0.0 to 1000.0; force per error of force */
    float derivative_s; /* s; 0.0 to 1.0 */
    float lowpass_rate; /* 0.0 to 1.0; twice in series behind both */
    float integral_1_s; /* 1/s; 0.0 to 100000.0 */
    float leak; /* 0.0 to 1.0; of the integral, per tick */
    float damping_N_s_m; /* N s/m; 0.0 to 10000.0; against the cap's fast motion */
    float highpass_rate; /* 0.0 to 1.0 */
    float contact_rate; /* 0.0 to 1.0; of the contact's weight */
} fdvv_force_loop_gains;
typedef char fdvv_force_loop_gains_has_164_bytes[sizeof(fdvv_force_loop_gains) == 164 ? 1 : -1];
#define FDVV_FORCE_LOOP_GAINS_RANGES(X) \
    X(tick_s, 5e-05f, 0.002f) \
    X(compute_ratio, 0.0f, 1.0f) \
    X(mass_kg, 0.0001f, 1.0f) \
    X(plate_kg, 0.0f, 0.1f) \
    X(drag_N_s_m, 0.0f, 100.0f) \
    X(brake_N_s_m, -100.0f, 100.0f) \
    X(friction_N, 0.0f, 10.0f) \
    X(friction_m, 1e-06f, 0.01f) \
    X(own_N[0], -10.0f, 10.0f) \
    X(own_N[1], -10.0f, 10.0f) \
    X(own_N[2], -10.0f, 10.0f) \
    X(own_N[3], -10.0f, 10.0f) \
    X(own_N[4], -10.0f, 10.0f) \
    X(own_N[5], -10.0f, 10.0f) \
    X(own_N[6], -10.0f, 10.0f) \
    X(own_N[7], -10.0f, 10.0f) \
    X(own_per_m, 0.0f, 1000000.0f) \
    X(gain, 0.01f, 100.0f) \
    X(gain_1_m, -100000.0f, 100000.0f) \
    X(gain_1_m2, -100000000.0f, 100000000.0f) \
    X(coil_rate, 0.0f, 1.0f) \
    X(cell_rate, 0.0f, 1.0f) \
    X(position_rate, 0.0f, 1.0f) \
    X(free_gains[0], -1000000000.0f, 1000000000.0f) \
    X(free_gains[1], -1000000000.0f, 1000000000.0f) \
    X(free_gains[2], -1000000000.0f, 1000000000.0f) \
    X(free_gains[3], -1000000000.0f, 1000000000.0f) \
    X(stop_gains[0], -1000000000.0f, 1000000000.0f) \
    X(stop_gains[1], -1000000000.0f, 1000000000.0f) \
    X(stop_gains[2], -1000000000.0f, 1000000000.0f) \
    X(stop_gains[3], -1000000000.0f, 1000000000.0f) \
    X(lead_s, 0.0f, 0.05f) \
    X(velocity_lead_s, -0.05f, 0.05f) \
    X(proportional, 0.0f, 1000.0f) \
    X(derivative_s, 0.0f, 1.0f) \
    X(lowpass_rate, 0.0f, 1.0f) \
    X(integral_1_s, 0.0f, 100000.0f) \
    X(leak, 0.0f, 1.0f) \
    X(damping_N_s_m, 0.0f, 10000.0f) \
    X(highpass_rate, 0.0f, 1.0f) \
    X(contact_rate, 0.0f, 1.0f) \


/* have you a load cell, is the loop closed; must be the first request about the loop (request) */
typedef struct {
    uint32_t hash; /* 0 to 4294967295; of this definition; another one is refused */
} fdvv_read_force_loop_request;
typedef char fdvv_read_force_loop_request_has_4_bytes[sizeof(fdvv_read_force_loop_request) == 4 ? 1 : -1];
#define FDVV_READ_FORCE_LOOP_REQUEST_RANGES(X) \


/* have you a load cell, is the loop closed; must be the first request about the loop (reply) */
typedef struct {
    float plate_kg; /* kg; 0.0 to 0.1; the load cell in use; all 0: there is none */
    float stiffness_N_m; /* N/m; 0.0 to 100000000.0 */
    float damping_N_s_m; /* N s/m; 0.0 to 10000.0 */
    float filter_s; /* s; 0.0 to 0.1 */
    uint8_t state; /* 0 to 2; of enums.loop_state */
    uint8_t fault; /* 0 to 3; of enums.loop_fault */
    uint16_t spare; /*  */
} fdvv_read_force_loop_reply;
typedef char fdvv_read_force_loop_reply_has_20_bytes[sizeof(fdvv_read_force_loop_reply) == 20 ? 1 : -1];
#define FDVV_READ_FORCE_LOOP_REPLY_RANGES(X) \
    X(plate_kg, 0.0f, 0.1f) \
    X(stiffness_N_m, 0.0f, 100000000.0f) \
    X(damping_N_s_m, 0.0f, 10000.0f) \
    X(filter_s, 0.0f, 0.1f) \
    X(state, 0, 2) \
    X(fault, 0, 3) \
    X(spare, 0, 0) \


/* name, id, bytes of the request (or of what is sent unasked), bytes of the reply */
#define FDVV_FORCE_LOOP_MESSAGES(X) \
    X(READ_FORCE_LOOP, 0x13, 4, 20) \
    X(WRITE_LOAD_CELL, 0x14, 16, 0) \
    X(CLOSE_FORCE_LOOP, 0x15, 164, 0) \
    X(OPEN_FORCE_LOOP, 0x16, 0, 0) \

enum {
    FDVV_MSG_READ_FORCE_LOOP = 0x13, /* have you a load cell, is the loop closed; must be the first request about the loop */
    FDVV_MSG_WRITE_LOAD_CELL = 0x14, /* this load cell is fitted; while idle or in fault, opens the loop */
    FDVV_MSG_CLOSE_FORCE_LOOP = 0x15, /* close the loop with these constants; while idle, and the programs are forgotten */
    FDVV_MSG_OPEN_FORCE_LOOP = 0x16, /* render by tables; while idle or in fault, and the programs are forgotten */
};

#endif
