/* The part that says no: modes, faults, limits. Zero force whenever anything is in doubt. */
#ifndef FDVV_SUPERVISOR_H
#define FDVV_SUPERVISOR_H

#include "inputs.h"

/* what may be asked of it */
enum {
    FDVV_ASK_BOOTED,      /* the board has started */
    FDVV_ASK_TEST,        /* begin the self-test */
    FDVV_ASK_TESTED,      /* the self-test has ended */
    FDVV_ASK_ARM,
    FDVV_ASK_DISARM,
    FDVV_ASK_CLEAR,       /* the latched fault, whose number goes along */
    FDVV_ASKS
};

typedef struct {
    uint8_t mode;             /* FDVV_MODE_… */
    uint8_t fault;            /* FDVV_FAULT_…, latched: the reason of the first until it is cleared */
    uint16_t faults;          /* found since boot, those that were not latched included; stays at 65535 */
    fdvv_evidence evidence;   /* of the latched one */
    fdvv_evidence now;        /* what the evidence would be: of the last tick */
    uint32_t present;         /* bit FDVV_FAULT_… : conditions that hold now */
    uint32_t last_sum;        /* for the stuck sensor */
    uint32_t host_seen_us;
    uint32_t settings_sum;    /* checksum of the settings meant */
    uint32_t heat_K_q16;      /* modelled rise of the coil */
    uint32_t heat_rest_q48;   /* what is below it */
    uint32_t heat_rate_q32;   /* tick over thermal time constant */
    uint32_t derate_cN64_K_q8; /* slope of the force limit */
    uint16_t equal_sums;
    uint8_t position_known;   /* now.displacement_um16 may be compared with */
    uint8_t host_heard;       /* within the timeout */
} fdvv_supervisor;

void fdvv_supervisor_init(fdvv_supervisor *supervisor);

/* These checked settings are meant from now on: keeps their checksum, forgets the position. Until it was called,
 * every check finds the settings corrupt. */
void fdvv_supervisor_settings(fdvv_supervisor *supervisor, const fdvv_settings *settings);

/* Ask for a change of mode; FDVV_REFUSAL_NONE if it was made, else _BAD_VALUE (no such question, another fault is
 * latched, settings that may not be used), _WRONG_MODE, _BUSY (self-test), _FAULT_LATCHED (or its cause is still
 * there). `number` is the fault to clear. */
uint8_t fdvv_supervisor_ask(fdvv_supervisor *supervisor, const fdvv_settings *settings, uint8_t ask, uint8_t number);

/* The host was heard at time_us. */
void fdvv_supervisor_host_seen(fdvv_supervisor *supervisor, uint32_t time_us);

/* Look at one tick before its command is computed; latches at most one fault. commanded_cN64 is that of the
 * last tick, program_state for the evidence. */
void fdvv_supervisor_check(fdvv_supervisor *supervisor, const fdvv_settings *settings, const fdvv_inputs *inputs,
                           int32_t displacement_um16, int16_t force_cN64, int16_t commanded_cN64,
                           uint8_t program_state);

/* Latch a fault found elsewhere (a corrupted image), with its evidence; a number that is none is internal. */
void fdvv_supervisor_fault(fdvv_supervisor *supervisor, uint8_t fault, int32_t value, int32_t bound);

/* The largest force allowed in this tick: 0 unless armed or derated. Sets the mode derated and back. */
int16_t fdvv_supervisor_limit_cN64(fdvv_supervisor *supervisor, const fdvv_settings *settings);

/* Account for the heat of a tick at that duty; elapsed_ticks as in the inputs. */
void fdvv_supervisor_heat(fdvv_supervisor *supervisor, const fdvv_settings *settings, int16_t duty_q15,
                          uint16_t elapsed_ticks);

/* Give 0 if the settings may be used, else 1 + the number of the first field that is out of range or at odds
 * with another. */
uint8_t fdvv_settings_check(const fdvv_settings *settings);

#endif
