/* Inputs of the core from the board in one tick, and its outputs. */
#ifndef FDVV_INPUTS_H
#define FDVV_INPUTS_H

#include "protocol.h"

/* errors that the board detects itself */
enum {
    FDVV_BOARD_WATCHDOG = 1 << 0,   /* the last reset was caused by the watchdog */
    FDVV_BOARD_BROWN_OUT = 1 << 1,  /* or by the brown-out detector, or it reports a dip */
    FDVV_BOARD_OUTPUT = 1 << 2,     /* the bridge reports a fault, or its inputs are not as commanded */
    FDVV_BOARD_VIBRATION = 1 << 3   /* the vibration board does not respond */
};

typedef struct {
    uint32_t time_us;        /* device clock when the first reading started; wraps around */
    uint32_t sum;            /* of settings.reads position readings, counts */
    uint16_t lowest;         /* of these readings */
    uint16_t highest;
    uint16_t elapsed_ticks;  /* since the last call: 1 unless ticks were missed */
    uint16_t supply_mV;
    uint16_t force_counts;   /* keycap force sensor; 0 if there is none */
    uint16_t thermistor_counts; /* of the coil; not read if the board's limits have none */
    uint8_t board;           /* bits FDVV_BOARD_… */
} fdvv_inputs;

typedef struct {
    int16_t duty_q15;        /* signed; 0 is zero force */
    uint8_t enable;          /* of the bridge; 0 unless rendering */
    uint8_t slot;            /* vibration to start now, or FDVV_NONE */
    uint16_t stop_us;        /* servo pulse */
    uint8_t key;             /* 1 if the key is down in the program's state */
    uint8_t mode;
    fdvv_tick_record record; /* of this tick */
} fdvv_outputs;

#endif
