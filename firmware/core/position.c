#include "position.h"

int32_t fdvv_displacement_um16(const fdvv_settings *settings, uint32_t sum)
{
    int32_t gain = settings->position_gain_q14;
    int32_t way_um16 = (int32_t)fdvv_way_um16(gain < 0 ? 0u - (uint32_t)gain : (uint32_t)gain, sum);
    return settings->position_offset_um16 + (gain < 0 ? -way_um16 : way_um16);
}

void fdvv_position_init(fdvv_position *position)
{
    position->um16 = position->extreme_um16 = position->sum_um16 = 0;
    position->count = position->next = 0;
    position->initialized = position->release = position->turned = 0;
    position->at_top = 1;
}

/* sum / count, rounded to nearest, halves up: two approximations with the reciprocal, then an exact correction. */
static int32_t divide(int32_t sum, int32_t count)
{
    fdvv_ratio reciprocal = fdvv_ratio_inverse(fdvv_ratio_of((uint32_t)count));
    int32_t quotient, remainder = sum + (count >> 1);
    quotient = fdvv_scale(remainder, reciprocal);
    quotient += fdvv_scale(remainder - quotient * count, reciprocal);
    remainder -= quotient * count;
    return remainder < 0 ? quotient - 1 : remainder >= count ? quotient + 1 : quotient;
}

/* The sum cannot overflow: 32 * 924,287 is far below 2^31. */
static int32_t sliding_mean(fdvv_position *position, uint8_t ticks, int32_t um16)
{
    if (position->count == ticks)
        position->sum_um16 -= position->recent_um16[position->next];
    else
        position->count++;
    position->recent_um16[position->next] = um16;
    position->sum_um16 += um16;
    if (++position->next == ticks)
        position->next = 0;
    return divide(position->sum_um16, position->count);
}

/* The direction reverses when the cap has moved back by reversal_um16 from its extreme. At the top it is a press. */
static void update_direction(fdvv_position *position, const fdvv_settings *settings)
{
    int32_t x = position->um16, extreme = position->extreme_um16;
    position->turned = 0;
    if (!position->release) {
        if (x < extreme - settings->reversal_um16)
            position->turned = FDVV_TURNED_TO_RELEASE;
        else if (x < extreme)
            return;
    } else {
        if (x > extreme + settings->reversal_um16 || position->at_top)
            position->turned = FDVV_TURNED_TO_PRESS;
        else if (x > extreme)
            return;
    }
    position->extreme_um16 = x;
    if (position->turned)
        position->release = position->turned == FDVV_TURNED_TO_RELEASE;
}

void fdvv_position_tick(fdvv_position *position, const fdvv_settings *settings, uint32_t sum)
{
    int32_t um16 = fdvv_displacement_um16(settings, sum);
    if (settings->sliding_ticks > 1)
        um16 = sliding_mean(position, settings->sliding_ticks, um16);
    position->um16 = um16;
    position->at_top = um16 < settings->rearm_um16;
    if (!position->initialized) {
        position->initialized = 1;
        position->extreme_um16 = um16;
    }
    update_direction(position, settings);
}
