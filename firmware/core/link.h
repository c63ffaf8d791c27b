/* The wire: frames in, replies, telemetry and notices out. Work per call is bounded. */
#ifndef FDVV_LINK_H
#define FDVV_LINK_H

#include "core.h"

/* who the board is, and what of it the link may use; constant */
typedef struct {
    uint32_t serial;
    uint8_t flags;           /* FDVV_BOARD_FLAG_… */
    uint16_t travel_limit_um16_256;
    char name[16];
    /* Begin the self-test of the board's own parts; poll until it gives 1 and the reply is filled. */
    uint8_t (*selftest)(fdvv_selftest_reply *reply);
    /* Forward the waveforms of a program to the vibration board; may be 0. */
    void (*load_slots)(const uint8_t *image);
    void (*play)(uint8_t slot);
    uint32_t (*now_us)(void);
    fdvv_read_counters_reply *counters;  /* shared: the board counts ticks, late and worst_tick_us */
} fdvv_board;

typedef struct fdvv_link fdvv_link; /* defined in link_state.h, so that a board may place it */

void fdvv_link_init(fdvv_link *link, fdvv_core *core, const fdvv_board *board);

/* Bytes from the host; takes what it has room for and tells how many. */
uint16_t fdvv_link_receive(fdvv_link *link, const uint8_t *bytes, uint16_t count);

/* Bytes for the host; fills at most `room` and tells how many. */
uint16_t fdvv_link_transmit(fdvv_link *link, uint8_t *bytes, uint16_t room);

/* After every tick: telemetry, notices of faults and keys. */
void fdvv_link_tick(fdvv_link *link, const fdvv_inputs *inputs, const fdvv_outputs *outputs);

/* Between ticks, as often as there is time: one bounded piece of work (a frame, a part of a check). */
void fdvv_link_work(fdvv_link *link);

/* The cable was pulled or the port closed: forget unfinished frames and uploads; the host watch goes on. */
void fdvv_link_reset(fdvv_link *link);

#endif
