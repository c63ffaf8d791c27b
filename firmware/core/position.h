/* Displacement of the cap and the direction of its motion. */
#ifndef FDVV_POSITION_H
#define FDVV_POSITION_H

#include "arithmetic.h"
#include "protocol.h"

#define FDVV_SLIDING_TICKS 32     /* maximum length of the moving average */
#define FDVV_LONGEST_um16 524287  /* range of the position sensor: 32.7 mm */
#define FDVV_FURTHEST_um16 (400000 + FDVV_LONGEST_um16)

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

/* gain * sum / 2^14, rounded to nearest, halves up, with its lowest 19 bits. A gain of 18 bits times a sum of 22 (64
 * readings of 16 bits) has 40: the sum is split into its lowest 8 bits and the others, so that 32 bits are enough. */
static inline uint32_t fdvv_way_um16(uint32_t gain_q14, uint32_t sum)
{
    uint32_t way_q6 = gain_q14 * (sum >> 8) + (gain_q14 * (sum & 0xffu) >> 8);
    return (way_q6 + 32u) << 7 >> 13;
}

/* Displacement for a sum of readings. It is at most FDVV_FURTHEST_um16 in magnitude for any sum, and exact for readings
 * within their range, whose way fdvv_settings_check holds to 19 bits. */
int32_t fdvv_displacement_um16(const fdvv_settings *settings, uint32_t sum);

#endif
