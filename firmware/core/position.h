/* Where the cap is, and which way it goes. */
#ifndef FDVV_POSITION_H
#define FDVV_POSITION_H

#include "arithmetic.h"
#include "protocol.h"

#define FDVV_SLIDING_TICKS 32 /* longest sliding mean */

/* what happened to the direction in a tick */
enum {
    FDVV_TURNED_TO_PRESS = 1 << 0,
    FDVV_TURNED_TO_RELEASE = 1 << 1
};

typedef struct {
    int32_t um16;
    int32_t extreme_um16;  /* deepest of this press, highest of this release */
    int32_t sum_um16;      /* of the newest `count` */
    uint8_t count, next;
    uint8_t known;         /* a reading has been seen */
    uint8_t release;       /* the stroke: 0 press, 1 release */
    uint8_t turned;        /* FDVV_TURNED_… in this tick */
    uint8_t at_top;        /* above rearm_um16: the next press begins here */
    int32_t recent_um16[FDVV_SLIDING_TICKS];
} fdvv_position;

/* Forget every reading. */
void fdvv_position_init(fdvv_position *position);

/* Take the sum of one tick's readings. */
void fdvv_position_tick(fdvv_position *position, const fdvv_settings *settings, uint32_t sum);

/* Displacement at a sum: any 32-bit product shifted right by 14 has 18 bits, so that with the largest offset
 * the result lies within 662,144 um16 whatever the readings. It is exact (to the nearest, halves away from the
 * offset) while |gain| * sum < 2^32, which fdvv_settings_check ensures for readings within their bounds. */
int32_t fdvv_displacement_um16(const fdvv_settings *settings, uint32_t sum);

#endif
