/* Displacement of the cap and the direction of its motion. */
#ifndef FDVV_POSITION_H
#define FDVV_POSITION_H

#include "arithmetic.h"
#include "protocol.h"

#define FDVV_SLIDING_TICKS 32 /* maximum length of the moving average */

/* reversals of the direction */
enum {
    FDVV_TURNED_TO_PRESS = 1 << 0,
    FDVV_TURNED_TO_RELEASE = 1 << 1
};

typedef struct {
    int32_t um16;
    int32_t extreme_um16;  /* maximum of this press, or minimum of this release */
    int32_t sum_um16;      /* of the moving average */
    uint8_t count, next;   /* of its samples; index of the next one */
    uint8_t initialized;   /* there was a reading */
    uint8_t release;       /* the stroke: 0 press, 1 release */
    uint8_t turned;        /* FDVV_TURNED_…, in this tick */
    uint8_t at_top;        /* above rearm_um16, where the next press begins */
    int32_t recent_um16[FDVV_SLIDING_TICKS];
} fdvv_position;

/* Reset to no reading. */
void fdvv_position_init(fdvv_position *position);

/* Process the sum of the readings of one tick. */
void fdvv_position_tick(fdvv_position *position, const fdvv_settings *settings, uint32_t sum);

/* Displacement for a sum of readings. It is at most 662,144 um16 in magnitude for any reading, because a 32-bit
 * product shifted right by 14 has 18 bits. It is exact (rounded to nearest, halves away from the offset) while
 * |gain| * sum < 2^32, which fdvv_settings_check ensures for readings within their range. */
int32_t fdvv_displacement_um16(const fdvv_settings *settings, uint32_t sum);

#endif
