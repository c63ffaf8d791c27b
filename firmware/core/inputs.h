/* What a board gives the core in a tick, and what it gets back. */
#ifndef FDVV_INPUTS_H
#define FDVV_INPUTS_H

#include "protocol.h"

/* what a board itself finds wrong */
enum {
    FDVV_BOARD_WATCHDOG = 1 << 0,   /* the last reset was the watchdog's */
    FDVV_BOARD_BROWN_OUT = 1 << 1,  /* or that of the brown-out detector, or it reports a dip */
    FDVV_BOARD_OUTPUT = 1 << 2,     /* the bridge reports a fault, or reads back otherwise than set */
    FDVV_BOARD_VIBRATION = 1 << 3   /* the vibration board does not answer */
};

typedef struct {
    uint32_t time_us;        /* device clock at the instant the readings were started; wraps */
    uint32_t sum;            /* of settings.reads position readings */
    uint16_t lowest;         /* of them, counts */
    uint16_t highest;
    uint16_t elapsed_ticks;  /* since the last call: 1 unless ticks were missed */
    uint16_t supply_mV;
    uint16_t force_counts;   /* keycap force sensor; 0 without one */
    uint8_t board;           /* bits FDVV_BOARD_… */
} fdvv_inputs;

typedef struct {
    int16_t duty_q15;        /* signed; 0 is zero force */
    uint8_t enable;          /* of the bridge; 0 whenever not rendering */
    uint8_t slot;            /* waveform to start now, or FDVV_NONE */
    uint16_t stop_us;        /* servo pulse */
    uint8_t key;             /* reported by the state */
    uint8_t mode;
    fdvv_tick_record record;      /* of this tick */
} fdvv_outputs;

#endif
