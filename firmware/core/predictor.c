#include "predictor.h"

#define MAX_RESIDUAL_Q10 (FDVV_MAX_RESIDUAL_um16 * 1024)

/* value * gain with gain.shift already reduced by 16, rounded to nearest, halves up; |value| is at most 2^30. */
static inline int32_t scaled(int32_t value, fdvv_ratio gain)
{
    int32_t top = (value >> 16) * gain.mantissa + (int32_t)((((uint32_t)value & 0xffffu) * gain.mantissa) >> 16);
    return (top + (int32_t)((uint32_t)1 << gain.shift >> 1)) >> gain.shift;
}

/* ratio * 2^-right, in the form that scaled() needs. A gain below 2^-30 becomes 0, one of 1 or more 65535 / 65536. */
static FDVV_COLD fdvv_ratio gain_of(fdvv_ratio ratio, int32_t right)
{
    ratio.shift = (int16_t)(ratio.shift + right - 16);
    if (ratio.shift > 29)
        ratio.mantissa = ratio.shift = 0;
    if (ratio.shift < 0)
        ratio.mantissa = UINT16_MAX, ratio.shift = 0;
    return ratio;
}

/* A ratio cannot be 0: it is represented by 2^-100, which gain_of() turns into 0. */
static FDVV_COLD fdvv_ratio ratio_of(uint32_t value)
{
    fdvv_ratio ratio = fdvv_ratio_of(value ? value : 1u);
    if (!value)
        ratio.shift = 100;
    return ratio;
}

/* not inlined, to save flash */
static FDVV_COLD fdvv_ratio multiply(fdvv_ratio a, fdvv_ratio b)
{
    return fdvv_ratio_product(a, b);
}

static FDVV_COLD fdvv_ratio divide(fdvv_ratio ratio, uint32_t value)
{
    return fdvv_ratio_product(ratio, fdvv_ratio_inverse(fdvv_ratio_of(value)));
}

/* With q = 1 - p for a triple pole at p: 1 - p^3 = q (3 - 3 q + q^2), 1.5 q^2 (2 - q), q^3 / 2. */
static void compute_gains(fdvv_predictor *predictor, uint32_t q_q16)
{
    fdvv_ratio q = ratio_of(q_q16), square = multiply(q, q);
    uint32_t inner_q16 = 3 * 65536u - 3 * q_q16 + (q_q16 * q_q16 >> 16);
    predictor->position_gain = gain_of(multiply(q, ratio_of(inner_q16)), 32 + 6);
    predictor->velocity_gain = gain_of(multiply(square, ratio_of(3 * (131072u - q_q16))), 49 + 6);
    predictor->acceleration_gain = gain_of(multiply(square, q), 49);
}

FDVV_COLD void fdvv_predictor_init(fdvv_predictor *predictor, const fdvv_settings *settings)
{
    uint32_t tick_us = settings->tick_us, limit_us = tick_us < 1000 ? tick_us : 1000;
    fdvv_ratio thousand = ratio_of(1000);
    fdvv_ratio lead = divide(ratio_of(settings->lead_us), tick_us);
    fdvv_ratio brake = divide(ratio_of(settings->brake_lead_us), tick_us);
    fdvv_ratio drag = divide(multiply(ratio_of(settings->drag_q13), thousand), tick_us);
    fdvv_ratio friction = divide(ratio_of(settings->friction_cN64), settings->friction_mm_s16);
    predictor->enabled = settings->predictor_q16 != 0;
    predictor->initialized = 0;
    predictor->friction_cN64 = (int16_t)settings->friction_cN64;
    predictor->position_q10 = predictor->velocity_q10 = predictor->acceleration_q15 = 0;
    predictor->velocity_limit_q10 = (int32_t)(limit_us << 16);
    predictor->acceleration_limit_q15 = (int32_t)(limit_us * limit_us << 10);
    compute_gains(predictor, settings->predictor_q16);
    predictor->lead_per_velocity = gain_of(lead, 10);
    predictor->lead_per_acceleration = gain_of(multiply(lead, lead), 16);
    predictor->drag_per_velocity = gain_of(drag, 23);
    predictor->drag_per_acceleration = gain_of(multiply(drag, brake), 28);
    predictor->friction = gain_of(divide(multiply(friction, thousand), tick_us), 10);
}

/* Eight steps change the position by at most 2^29.3, from at most 2^29.9. */
static void predict(fdvv_predictor *predictor)
{
    int32_t limit_q10 = predictor->velocity_limit_q10, acceleration_q15 = predictor->acceleration_q15;
    predictor->position_q10 += predictor->velocity_q10 + ((acceleration_q15 + 32) >> 6);
    predictor->velocity_q10 =
        fdvv_clamp(predictor->velocity_q10 + ((acceleration_q15 + 16) >> 5), -limit_q10, limit_q10);
}

/* Sums are below 2^31: |residual_q16| is below 2^30, and the gains are below 1, 1.5 and 0.5, the first two of them
 * divided by 2^6. */
static void correct(fdvv_predictor *predictor, int32_t residual_q16)
{
    int32_t velocity_q10 = predictor->velocity_q10 + scaled(residual_q16, predictor->velocity_gain);
    int32_t acceleration_q15 = predictor->acceleration_q15 + scaled(residual_q16, predictor->acceleration_gain);
    predictor->position_q10 += scaled(residual_q16, predictor->position_gain);
    predictor->velocity_q10 = fdvv_clamp(velocity_q10, -predictor->velocity_limit_q10, predictor->velocity_limit_q10);
    predictor->acceleration_q15 =
        fdvv_clamp(acceleration_q15, -predictor->acceleration_limit_q15, predictor->acceleration_limit_q15);
}

__attribute__((noinline)) void fdvv_predictor_tick(fdvv_predictor *predictor, int32_t um16, uint16_t elapsed_ticks)
{
    int32_t measured_q10 = um16 * 1024, residual_q10 = INT32_MAX; /* below 2^29.9 */
    if (predictor->initialized && elapsed_ticks <= FDVV_PREDICTED_TICKS) {
        for (; elapsed_ticks; elapsed_ticks--)
            predict(predictor);
        /* below 2^31.3: what wraps around remains far beyond MAX_RESIDUAL_Q10 */
        residual_q10 = (int32_t)((uint32_t)measured_q10 - (uint32_t)predictor->position_q10);
    }
    if (residual_q10 >= -MAX_RESIDUAL_Q10 && residual_q10 <= MAX_RESIDUAL_Q10) {
        correct(predictor, residual_q10 * 64);
        return;
    }
    predictor->initialized = 1;
    predictor->position_q10 = measured_q10;
    predictor->velocity_q10 = predictor->acceleration_q15 = 0;
}

int32_t fdvv_predictor_ahead_um16(const fdvv_predictor *predictor)
{
    int32_t lead_um16 = scaled(predictor->velocity_q10, predictor->lead_per_velocity) +
                        scaled(predictor->acceleration_q15, predictor->lead_per_acceleration);
    return ((predictor->position_q10 + 512) >> 10) +
           fdvv_clamp(lead_um16, -FDVV_MAX_RESIDUAL_um16, FDVV_MAX_RESIDUAL_um16);
}

int32_t fdvv_predictor_resistance_cN64(const fdvv_predictor *predictor)
{
    int32_t limit_cN64 = predictor->friction_cN64;
    int32_t drag_cN64 = scaled(predictor->velocity_q10, predictor->drag_per_velocity) +
                        scaled(predictor->acceleration_q15, predictor->drag_per_acceleration);
    return drag_cN64 + fdvv_clamp(scaled(predictor->velocity_q10, predictor->friction), -limit_cN64, limit_cN64);
}
