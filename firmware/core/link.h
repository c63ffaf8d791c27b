/* Link to the host: receives frames, sends replies, telemetry and notices. The work of every call is bounded. */
#ifndef FDVV_LINK_H
#define FDVV_LINK_H

#include "core.h"

/* identity and functions of the board; constant */
typedef struct {
    uint32_t serial;
    uint8_t flags;           /* FDVV_BOARD_FLAG_… */
    uint16_t travel_limit_um16_256;
    char name[16];
    /* Start or continue the self-test of the board; returns 1 once the reply is complete. */
    uint8_t (*selftest)(fdvv_selftest_reply *reply);
    /* Start to send the waveforms of a program to the vibration board; may be 0. */
    void (*load_slots)(const uint8_t *image);
    void (*play)(uint8_t slot);
    uint32_t (*now_us)(void);
    fdvv_read_counters_reply *counters;  /* the board updates ticks, late and worst_tick_us, the link the others */
#ifdef FDVV_FORCE_LOOP
    const fdvv_load_cell *cell;          /* fitted until the host writes another; 0: none */
#endif
} fdvv_board;

typedef struct fdvv_link fdvv_link; /* defined in link_state.h */

void fdvv_link_init(fdvv_link *link, fdvv_core *core, const fdvv_board *board);

/* Process bytes from the host; returns how many were accepted. */
uint16_t fdvv_link_receive(fdvv_link *link, const uint8_t *bytes, uint16_t count);

/* Write at most `room` bytes for the host; returns their number. */
uint16_t fdvv_link_transmit(fdvv_link *link, uint8_t *bytes, uint16_t room);

/* Call after every tick: records telemetry and notices of faults and keys. */
void fdvv_link_tick(fdvv_link *link, const fdvv_inputs *inputs, const fdvv_outputs *outputs);

/* Call between ticks, as often as there is time: processes one frame or a part of a check. */
void fdvv_link_work(fdvv_link *link);

/* The connection was lost: discard unfinished frames and uploads. The host timeout keeps running. */
void fdvv_link_reset(fdvv_link *link);

#endif
