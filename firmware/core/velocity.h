/* How fast the cap goes: decided once per press, and estimated anew every tick. */
#ifndef FDVV_VELOCITY_H
#define FDVV_VELOCITY_H

#include "position.h"

#define FDVV_NEWEST 32          /* samples kept */
#define FDVV_GAP_TICKS 64       /* a longer gap is a new beginning */
#define FDVV_WINDOW_TICKS 32768 /* a longer stay in the window is a new beginning */

/* sums of a straight line's least squares; time in ticks and place in um16 from the first sample */
typedef struct {
    uint64_t tick_tick, tick_um16;
    uint32_t ticks, um16;
    uint32_t count;
} fdvv_line;

typedef struct {
    int16_t continuous_mm_s16;          /* positive downward */
    uint16_t decided_mm_s16;
    uint8_t decided;                    /* this press has its velocity */
    uint8_t continuous;                 /* continuous_mm_s16 has been estimated */
    uint8_t next, kept;                 /* in the ring */
    uint8_t even;                       /* newest samples without a gap between them */
    uint8_t scaled_for;                 /* how many samples slope_scale holds for */
    fdvv_ratio slope_scale;             /* weighted sum of the newest to mm_s16 */
    int32_t sum_um16, ramp_um16;        /* of the newest `even`: plain, and times 0, 1, 2, … from the oldest */
    uint32_t now_tick;
    uint32_t first_tick;                /* of the samples in the window */
    fdvv_ratio decided_scale;           /* um16 per tick to mm_s16, mean over the stroke */
    fdvv_ratio tick_rate;               /* 6000 / tick_us */
    fdvv_line inside;                   /* samples of this press in the window */
    int32_t newest_um16[FDVV_NEWEST];
    uint32_t newest_tick[FDVV_NEWEST];
} fdvv_velocity;

void fdvv_velocity_init(fdvv_velocity *velocity, const fdvv_settings *settings);

/* Take this tick's position. */
void fdvv_velocity_tick(fdvv_velocity *velocity, const fdvv_settings *settings, const fdvv_position *position,
                        uint16_t elapsed_ticks);

#endif
