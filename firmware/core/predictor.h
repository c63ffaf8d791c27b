/* Where the cap will be when the coil pushes, and what the rig's own friction takes at this speed. */
#ifndef FDVV_PREDICTOR_H
#define FDVV_PREDICTOR_H

#include "arithmetic.h"
#include "protocol.h"

#define FDVV_PREDICTED_TICKS 8       /* a longer gap is a new beginning */
#define FDVV_FURTHEST_um16 16000     /* a cap further from where it was predicted is a new beginning; so is the
                                      * longest look ahead */

/* A critically damped filter of third order (g-h-k); time in ticks, place in um16. */
typedef struct {
    uint8_t on;
    uint8_t known;           /* a place has been seen since the beginning */
    int16_t friction_cN64;
    int32_t place_q10;
    int32_t step_q10;        /* velocity, um16 per tick */
    int32_t bend_q16;        /* half the acceleration, um16 per tick^2 */
    int32_t step_limit_q10;  /* 4 m/s */
    int32_t bend_limit_q16;  /* 1953 m/s^2 */
    /* ratios whose shift is 16 less, 0 to 29 */
    fdvv_ratio place_gain, step_gain, bend_gain; /* of what is sensed beyond what was predicted, q16 */
    fdvv_ratio lead_step, lead_bend;             /* to um16 ahead */
    fdvv_ratio drag_step, drag_bend, friction;   /* to cN64 */
} fdvv_predictor;

/* Forget every place. */
void fdvv_predictor_init(fdvv_predictor *predictor, const fdvv_settings *settings);

/* Take this tick's place, within 662,144 um16, elapsed_ticks (at least 1) after the last. This and what follows:
 * only if on. */
void fdvv_predictor_tick(fdvv_predictor *predictor, int32_t um16, uint16_t elapsed_ticks);

/* Place of the cap lead_us from now. */
int32_t fdvv_predictor_ahead_um16(const fdvv_predictor *predictor);

/* Drag and friction, positive downward. */
int32_t fdvv_predictor_resistance_cN64(const fdvv_predictor *predictor);

#endif
