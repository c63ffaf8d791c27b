/* Predicts the displacement when the coil acts, and estimates the drag and friction of the rig. */
#ifndef FDVV_PREDICTOR_H
#define FDVV_PREDICTOR_H

#include "arithmetic.h"
#include "protocol.h"

#define FDVV_PREDICTED_TICKS 8       /* a longer gap resets the filter */
#define FDVV_MAX_RESIDUAL_um16 16000 /* a larger residual resets the filter; also the longest prediction */

/* Critically damped g-h-k (alpha-beta-gamma) filter; time in ticks, position in um16. */
typedef struct {
    uint8_t enabled;
    uint8_t initialized;     /* there was a measurement since the reset */
    int16_t friction_cN64;
    int32_t position_q10;
    int32_t velocity_q10;           /* um16 per tick */
    int32_t acceleration_q15;       /* um16 per tick^2 */
    int32_t velocity_limit_q10;     /* 4 m/s; 4 mm per tick if ticks are longer than 1 ms */
    int32_t acceleration_limit_q15; /* 1953 m/s^2; the same way */
    /* ratios whose shift is reduced by 16, to 0 to 29 */
    fdvv_ratio position_gain, velocity_gain, acceleration_gain; /* of the residual: measured minus predicted, q16 */
    fdvv_ratio lead_per_velocity, lead_per_acceleration;        /* to um16 */
    fdvv_ratio drag_per_velocity, drag_per_acceleration, friction; /* to cN64 */
} fdvv_predictor;

/* Reset the filter. */
void fdvv_predictor_init(fdvv_predictor *predictor, const fdvv_settings *settings);

/* Process the displacement of this tick, within 924,287 um16, elapsed_ticks (at least 1) after the last one. This and
 * the functions below may be called only if enabled. */
void fdvv_predictor_tick(fdvv_predictor *predictor, int32_t um16, uint16_t elapsed_ticks);

/* Predicted displacement lead_us from now. */
int32_t fdvv_predictor_ahead_um16(const fdvv_predictor *predictor);

/* Drag and friction at the estimated velocity, positive downward. */
int32_t fdvv_predictor_resistance_cN64(const fdvv_predictor *predictor);

#endif
