#include "predictor.h"

#define FURTHEST_Q10 (FDVV_FURTHEST_um16 * 1024)

/* A ratio that may be 0: scaled by 2^-100, nothing is left of anything. */
static fdvv_ratio ratio_or_none(uint32_t value)
{
    static const fdvv_ratio none = {FDVV_ONE_Q15, 100};
    return value ? fdvv_ratio_of(value) : none;
}

static fdvv_ratio shifted(fdvv_ratio ratio, int32_t right)
{
    ratio.shift = (int16_t)(ratio.shift + right);
    return ratio;
}

/* With q = 1 - p for a triple pole at p: 1 - p^3 = q (3 - 3 q + q^2), 1.5 q^2 (2 - q), q^3. */
static void find_gains(fdvv_predictor *predictor, uint32_t q_q16)
{
    fdvv_ratio q = shifted(ratio_or_none(q_q16), 16), square = fdvv_ratio_product(q, q);
    fdvv_ratio inner = shifted(fdvv_ratio_of(3 * 65536u - 3 * q_q16 + (q_q16 * q_q16 >> 16)), 16);
    fdvv_ratio rest = shifted(fdvv_ratio_of(3 * (131072u - q_q16)), 17);
    predictor->place_gain = fdvv_ratio_product(q, inner);
    predictor->step_gain = fdvv_ratio_product(square, rest);
    predictor->bend_gain = shifted(fdvv_ratio_product(square, q), -6);
}

void fdvv_predictor_init(fdvv_predictor *predictor, const fdvv_settings *settings)
{
    uint32_t tick_us = settings->tick_us;
    fdvv_ratio tick = fdvv_ratio_inverse(fdvv_ratio_of(tick_us));
    fdvv_ratio per_ms = fdvv_ratio_product(fdvv_ratio_of(1000), tick);
    fdvv_ratio lead = fdvv_ratio_product(ratio_or_none(settings->lead_us), tick);
    fdvv_ratio brake = fdvv_ratio_product(ratio_or_none(settings->brake_lead_us), tick);
    fdvv_ratio friction = fdvv_ratio_product(ratio_or_none(settings->friction_cN64),
                                             fdvv_ratio_inverse(fdvv_ratio_of(settings->friction_mm_s16)));
    predictor->on = settings->predictor_q16 != 0;
    predictor->known = 0;
    predictor->friction_cN64 = (int16_t)settings->friction_cN64;
    predictor->place_q10 = predictor->step_q10 = predictor->bend_q16 = 0;
    predictor->step_limit_q10 = (int32_t)(tick_us << 16);
    predictor->bend_limit_q16 = (int32_t)(tick_us * tick_us << 10);
    find_gains(predictor, settings->predictor_q16);
    predictor->lead_step = shifted(lead, 10);
    predictor->lead_bend = shifted(fdvv_ratio_product(lead, lead), 16);
    predictor->brake_bend = shifted(brake, 5);
    predictor->drag = shifted(fdvv_ratio_product(ratio_or_none(settings->drag_q13), per_ms), 23);
    predictor->friction = shifted(fdvv_ratio_product(friction, per_ms), 10);
}

/* Eight of these move the place by 2^29.3 at most, from 2^29.4. */
static void predict(fdvv_predictor *predictor)
{
    int32_t limit_q10 = predictor->step_limit_q10, bend_q16 = predictor->bend_q16;
    predictor->place_q10 += predictor->step_q10 + ((bend_q16 + 32) >> 6);
    predictor->step_q10 = fdvv_clamp(predictor->step_q10 + ((bend_q16 + 16) >> 5), -limit_q10, limit_q10);
}

/* |beyond| is 2^24 at most and the gains below 1, 1.5 and 64: every sum is below 2^31. */
static void correct(fdvv_predictor *predictor, int32_t beyond_q10)
{
    int32_t step_q10 = predictor->step_q10 + fdvv_scale(beyond_q10, predictor->step_gain);
    int32_t bend_q16 = predictor->bend_q16 + fdvv_scale(beyond_q10, predictor->bend_gain);
    predictor->place_q10 += fdvv_scale(beyond_q10, predictor->place_gain);
    predictor->step_q10 = fdvv_clamp(step_q10, -predictor->step_limit_q10, predictor->step_limit_q10);
    predictor->bend_q16 = fdvv_clamp(bend_q16, -predictor->bend_limit_q16, predictor->bend_limit_q16);
}

void fdvv_predictor_tick(fdvv_predictor *predictor, int32_t um16, uint16_t elapsed_ticks)
{
    int32_t sensed_q10 = um16 * 1024, beyond_q10 = INT32_MAX;
    if (!predictor->on)
        return;
    if (predictor->known && elapsed_ticks <= FDVV_PREDICTED_TICKS) {
        for (; elapsed_ticks; elapsed_ticks--)
            predict(predictor);
        beyond_q10 = sensed_q10 - predictor->place_q10;
    }
    if (beyond_q10 >= -FURTHEST_Q10 && beyond_q10 <= FURTHEST_Q10) {
        correct(predictor, beyond_q10);
        return;
    }
    predictor->known = 1;
    predictor->place_q10 = sensed_q10;
    predictor->step_q10 = predictor->bend_q16 = 0;
}

int32_t fdvv_predictor_ahead_um16(const fdvv_predictor *predictor)
{
    int32_t lead_um16 = fdvv_scale(predictor->step_q10, predictor->lead_step) +
                        fdvv_scale(predictor->bend_q16, predictor->lead_bend);
    return ((predictor->place_q10 + 512) >> 10) + fdvv_clamp(lead_um16, -FDVV_FURTHEST_um16, FDVV_FURTHEST_um16);
}

int32_t fdvv_predictor_resistance_cN64(const fdvv_predictor *predictor)
{
    int32_t limit_q10 = predictor->step_limit_q10, most_cN64 = predictor->friction_cN64;
    int32_t step_q10 = predictor->step_q10 + fdvv_scale(predictor->bend_q16, predictor->brake_bend);
    int32_t drag_cN64 = fdvv_scale(fdvv_clamp(step_q10, -limit_q10, limit_q10), predictor->drag);
    return drag_cN64 + fdvv_clamp(fdvv_scale(predictor->step_q10, predictor->friction), -most_cN64, most_cN64);
}
