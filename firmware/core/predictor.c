#include "predictor.h"

#define FURTHEST_Q10 (FDVV_FURTHEST_um16 * 1024)

/* value * gain to the nearest, halves up, of the product without its lowest 16 bits; |value| is 2^30 at most. */
static inline int32_t scaled(int32_t value, fdvv_ratio gain)
{
    int32_t top = (value >> 16) * gain.mantissa + (int32_t)((((uint32_t)value & 0xffffu) * gain.mantissa) >> 16);
    return (top + (int32_t)((uint32_t)1 << gain.shift >> 1)) >> gain.shift;
}

/* A ratio times 2^-right for scaled(). Below 2^-30 it is nothing, as 0 is, which a ratio cannot be. */
static FDVV_SELDOM fdvv_ratio gain_of(fdvv_ratio ratio, int32_t right)
{
    ratio.shift = (int16_t)(ratio.shift + right - 16);
    if (ratio.shift > 29)
        ratio.mantissa = ratio.shift = 0;
    return ratio;
}

/* 0 is 2^-100 of one, which gain_of() makes nothing. */
static FDVV_SELDOM fdvv_ratio ratio_of(uint32_t value)
{
    fdvv_ratio ratio = fdvv_ratio_of(value ? value : 1u);
    if (!value)
        ratio.shift = 100;
    return ratio;
}

/* called, not copied: the flash is small */
static FDVV_SELDOM fdvv_ratio times(fdvv_ratio one, fdvv_ratio other)
{
    return fdvv_ratio_product(one, other);
}

static FDVV_SELDOM fdvv_ratio over(fdvv_ratio one, uint32_t value)
{
    return fdvv_ratio_product(one, fdvv_ratio_inverse(fdvv_ratio_of(value)));
}

/* With q = 1 - p for a triple pole at p: 1 - p^3 = q (3 - 3 q + q^2), 1.5 q^2 (2 - q), q^3 / 2. */
static void find_gains(fdvv_predictor *predictor, uint32_t q_q16)
{
    fdvv_ratio q = ratio_of(q_q16), square = times(q, q);
    uint32_t inner_q16 = 3 * 65536u - 3 * q_q16 + (q_q16 * q_q16 >> 16);
    predictor->place_gain = gain_of(times(q, ratio_of(inner_q16)), 32 + 6);
    predictor->step_gain = gain_of(times(square, ratio_of(3 * (131072u - q_q16))), 49 + 6);
    predictor->bend_gain = gain_of(times(square, q), 49);
}

FDVV_SELDOM void fdvv_predictor_init(fdvv_predictor *predictor, const fdvv_settings *settings)
{
    uint32_t tick_us = settings->tick_us;
    fdvv_ratio thousand = ratio_of(1000);
    fdvv_ratio lead = over(ratio_of(settings->lead_us), tick_us);
    fdvv_ratio brake = over(ratio_of(settings->brake_lead_us), tick_us);
    fdvv_ratio drag = over(times(ratio_of(settings->drag_q13), thousand), tick_us);
    fdvv_ratio friction = over(ratio_of(settings->friction_cN64), settings->friction_mm_s16);
    predictor->on = settings->predictor_q16 != 0;
    predictor->known = 0;
    predictor->friction_cN64 = (int16_t)settings->friction_cN64;
    predictor->place_q10 = predictor->step_q10 = predictor->bend_q16 = 0;
    predictor->step_limit_q10 = (int32_t)(tick_us << 16);
    predictor->bend_limit_q16 = (int32_t)(tick_us * tick_us << 10);
    find_gains(predictor, settings->predictor_q16);
    predictor->lead_step = gain_of(lead, 10);
    predictor->lead_bend = gain_of(times(lead, lead), 16);
    predictor->drag_step = gain_of(drag, 23);
    predictor->drag_bend = gain_of(times(drag, brake), 28);
    predictor->friction = gain_of(over(times(friction, thousand), tick_us), 10);
}

/* Eight of these move the place by 2^29.3 at most, from 2^29.4. */
static void predict(fdvv_predictor *predictor)
{
    int32_t limit_q10 = predictor->step_limit_q10, bend_q16 = predictor->bend_q16;
    predictor->place_q10 += predictor->step_q10 + ((bend_q16 + 32) >> 6);
    predictor->step_q10 = fdvv_clamp(predictor->step_q10 + ((bend_q16 + 16) >> 5), -limit_q10, limit_q10);
}

/* |beyond_q16| is below 2^30 and the gains below 1, 1.5 and 0.5, the first two less 2^6: sums stay below 2^31. */
static void correct(fdvv_predictor *predictor, int32_t beyond_q16)
{
    int32_t step_q10 = predictor->step_q10 + scaled(beyond_q16, predictor->step_gain);
    int32_t bend_q16 = predictor->bend_q16 + scaled(beyond_q16, predictor->bend_gain);
    predictor->place_q10 += scaled(beyond_q16, predictor->place_gain);
    predictor->step_q10 = fdvv_clamp(step_q10, -predictor->step_limit_q10, predictor->step_limit_q10);
    predictor->bend_q16 = fdvv_clamp(bend_q16, -predictor->bend_limit_q16, predictor->bend_limit_q16);
}

__attribute__((noinline)) void fdvv_predictor_tick(fdvv_predictor *predictor, int32_t um16, uint16_t elapsed_ticks)
{
    int32_t sensed_q10 = um16 * 1024, beyond_q10 = INT32_MAX;
    if (predictor->known && elapsed_ticks <= FDVV_PREDICTED_TICKS) {
        for (; elapsed_ticks; elapsed_ticks--)
            predict(predictor);
        beyond_q10 = sensed_q10 - predictor->place_q10;
    }
    if (beyond_q10 >= -FURTHEST_Q10 && beyond_q10 <= FURTHEST_Q10) {
        correct(predictor, beyond_q10 * 64);
        return;
    }
    predictor->known = 1;
    predictor->place_q10 = sensed_q10;
    predictor->step_q10 = predictor->bend_q16 = 0;
}

int32_t fdvv_predictor_ahead_um16(const fdvv_predictor *predictor)
{
    int32_t lead_um16 =
        scaled(predictor->step_q10, predictor->lead_step) + scaled(predictor->bend_q16, predictor->lead_bend);
    return ((predictor->place_q10 + 512) >> 10) + fdvv_clamp(lead_um16, -FDVV_FURTHEST_um16, FDVV_FURTHEST_um16);
}

int32_t fdvv_predictor_resistance_cN64(const fdvv_predictor *predictor)
{
    int32_t most_cN64 = predictor->friction_cN64;
    int32_t drag_cN64 =
        scaled(predictor->step_q10, predictor->drag_step) + scaled(predictor->bend_q16, predictor->drag_bend);
    return drag_cN64 + fdvv_clamp(scaled(predictor->step_q10, predictor->friction), -most_cN64, most_cN64);
}
