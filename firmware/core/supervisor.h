/* Safety supervisor: modes, faults and limits. In doubt, the force is zero. */
#ifndef FDVV_SUPERVISOR_H
#define FDVV_SUPERVISOR_H

#include "heat.h"
#include "inputs.h"

typedef char fdvv_settings_are_whole_dozens_of_words[sizeof(fdvv_settings) % 48 == 0 ? 1 : -1];

/* requests */
enum {
    FDVV_ASK_BOOTED,      /* the board has started */
    FDVV_ASK_TEST,        /* start the self-test */
    FDVV_ASK_TESTED,      /* the self-test has ended */
    FDVV_ASK_ARM,
    FDVV_ASK_DISARM,
    FDVV_ASK_CLEAR,       /* clear the latched fault, given by its number */
    FDVV_ASKS
};

typedef struct {
    uint8_t mode;             /* FDVV_MODE_… */
    uint8_t fault;            /* FDVV_FAULT_…: the first one, latched until it is cleared */
    uint8_t position_known;   /* now.displacement_um16 is valid */
    uint8_t host_heard;       /* a message came within the timeout */
    uint16_t faults;          /* count since boot, including those not latched; saturates at 65535 */
    uint16_t equal_sums;      /* ticks since last_sum changed */
    fdvv_evidence now;        /* as `evidence`, of the last tick */
    fdvv_heat heat;           /* of the coil */
    uint32_t derate_cN64_K_q8; /* force limit per degree of heat */
    uint32_t active;          /* bit FDVV_FAULT_…: its condition is true now */
    uint32_t last_sum;        /* of the position readings, to detect a stuck sensor */
    uint32_t host_seen_us;
    uint32_t settings_sum;    /* checksum of the settings as they were set */
    const fdvv_board_limits *limits;
    fdvv_evidence evidence;   /* of the latched fault */
} fdvv_supervisor;

/* limits: of the board; constant, and kept by reference. */
void fdvv_supervisor_init(fdvv_supervisor *supervisor, const fdvv_board_limits *limits);

/* Use these checked settings: stores their checksum and forgets the position, not the heat. Until this is called, every
 * check reports corrupt settings. */
void fdvv_supervisor_settings(fdvv_supervisor *supervisor, const fdvv_settings *settings);

/* Request a change of mode (FDVV_ASK_…); `number` is the fault to clear. Returns FDVV_REFUSAL_NONE if it was made,
 * else _BAD_VALUE (unknown request, `number` is not the latched fault, invalid settings), _WRONG_MODE, _BUSY
 * (self-test is running) or _FAULT_LATCHED (a fault is latched, or its condition is still true). */
uint8_t fdvv_supervisor_ask(fdvv_supervisor *supervisor, const fdvv_settings *settings, uint8_t ask, uint8_t number);

/* A message of the host arrived at time_us. */
void fdvv_supervisor_host_seen(fdvv_supervisor *supervisor, uint32_t time_us);

/* Check one tick before its command is computed; latches at most one fault. commanded_cN64 is the command of the
 * last tick; program_state is only recorded as evidence. */
void fdvv_supervisor_check(fdvv_supervisor *supervisor, const fdvv_settings *settings, const fdvv_inputs *inputs,
                           int32_t displacement_um16, int16_t force_cN64, int16_t commanded_cN64,
                           uint8_t program_state);

/* Latch a fault detected elsewhere (a corrupted image), with its evidence. An invalid number becomes
 * FDVV_FAULT_INTERNAL. */
void fdvv_supervisor_fault(fdvv_supervisor *supervisor, uint8_t fault, int32_t value, int32_t bound);

/* Largest force allowed in this tick: 0 unless armed or derated. Switches between these two modes. The heat
 * counts as higher by heat.late_K_q16. */
int16_t fdvv_supervisor_limit_cN64(fdvv_supervisor *supervisor, const fdvv_settings *settings);

/* Return 0 if the settings are valid, else 1 + the number of the first field that is out of range, inconsistent with
 * another one, or looser than the limits of the board. */
uint8_t fdvv_settings_check(const fdvv_settings *settings, const fdvv_board_limits *limits);

/* Tighten settings where they are looser than the limits. */
void fdvv_settings_tighten(fdvv_settings *settings, const fdvv_board_limits *limits);

#endif
