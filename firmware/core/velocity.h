/* Velocity of the cap: decided once per press, and estimated in every tick. */
#ifndef FDVV_VELOCITY_H
#define FDVV_VELOCITY_H

#include "position.h"

#define FDVV_RECENT_SAMPLES 32  /* size of the ring buffer, a power of two */
#define FDVV_GAP_TICKS 64       /* a longer gap discards all samples */
#define FDVV_WINDOW_TICKS 32768 /* a longer time in the window starts a new fit */

/* sums for the least-squares fit of a line; ticks from the first sample, um16 from an origin */
typedef struct {
    uint64_t tick_tick, tick_um16;
    uint32_t ticks, um16;
    uint32_t count;
} fdvv_line;

typedef struct {
    int16_t continuous_mm_s16;          /* positive downward */
    uint16_t decided_mm_s16;
    uint8_t decided;                    /* decided_mm_s16 is valid for this press */
    uint8_t continuous;                 /* continuous_mm_s16 is valid */
    uint8_t next, stored;               /* in the ring buffer: index of the next sample, number of samples */
    uint8_t contiguous;                 /* number of latest samples without a gap between them */
    uint8_t scale_samples;              /* number of samples for which continuous_scale is valid */
    fdvv_ratio continuous_scale;        /* from the weighted sum to mm_s16 */
    int32_t sum_um16, weighted_um16;    /* of these samples: plain, and weighted with 0, 1, 2, … from the oldest */
    uint32_t now_tick;
    uint32_t first_tick;                /* of the samples in the window */
    fdvv_ratio decided_scale;           /* from um16 per tick to mm_s16, mean over the stroke */
    fdvv_ratio tick_rate;               /* 6000 / tick_us */
    fdvv_line window;                   /* samples of this press in the window */
    int32_t recent_um16[FDVV_RECENT_SAMPLES];
    uint32_t recent_tick[FDVV_RECENT_SAMPLES];
} fdvv_velocity;

void fdvv_velocity_init(fdvv_velocity *velocity, const fdvv_settings *settings);

/* Process the position of this tick. */
void fdvv_velocity_tick(fdvv_velocity *velocity, const fdvv_settings *settings, const fdvv_position *position,
                        uint16_t elapsed_ticks);

#endif
