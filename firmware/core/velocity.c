#include "velocity.h"

/* Longest span for which the 32-bit sums of 16 samples suffice: 16 * 16 * 240 * 32768 < 2^31. */
#define SHORT_TICKS 480

/* In the window there are less than 2^15 samples, with times below 2^15 and offsets below 2^16. A fit of the recent
 * samples has up to 16, with times up to 960 and offsets below 2^16. So the products of a sample are below 2^32, and
 * those in line_slope below 2^62. */
static void line_reset(fdvv_line *line)
{
    line->tick_tick = line->tick_um16 = 0;
    line->ticks = line->um16 = line->count = 0;
}

static void line_add(fdvv_line *line, uint32_t tick, uint32_t um16)
{
    line->count++;
    line->ticks += tick;
    line->um16 += um16;
    line->tick_tick += tick * tick;
    line->tick_um16 += tick * um16;
}

/* count * sum for count below 2^15 and a sum below 2^47. */
static uint64_t multiply(uint32_t count, uint64_t sum)
{
    return fdvv_wide_product(count, (uint32_t)sum) + ((uint64_t)(count * (uint32_t)(sum >> 32)) << 32);
}

/* covariance / variance * scale, rounded to nearest. */
static uint16_t scaled_slope(fdvv_ratio covariance, fdvv_ratio variance, fdvv_ratio scale)
{
    fdvv_ratio slope = fdvv_ratio_product(fdvv_ratio_product(covariance, fdvv_ratio_inverse(variance)), scale);
    if (slope.shift < 0)
        return UINT16_MAX;
    if (slope.shift > 16)
        return 0;
    return (uint16_t)((((uint32_t)slope.mantissa << 1 >> slope.shift) + 1u) >> 1);
}

/* Least-squares slope times scale, rounded to nearest; 0 if it is not positive. */
static uint16_t line_slope(const fdvv_line *line, fdvv_ratio scale)
{
    uint64_t mixed = multiply(line->count, line->tick_um16), product = fdvv_wide_product(line->ticks, line->um16);
    uint64_t variance = multiply(line->count, line->tick_tick) - fdvv_wide_product(line->ticks, line->ticks);
    if (mixed <= product || !variance)
        return 0;
    return scaled_slope(fdvv_ratio_of_wide(mixed - product), fdvv_ratio_of_wide(variance), scale);
}

/* The same for a short span, where the differences fit into 32 bits even if their terms overflow. */
static uint16_t short_line_slope(const fdvv_line *line, fdvv_ratio scale)
{
    int32_t covariance = (int32_t)(line->count * (uint32_t)line->tick_um16 - line->ticks * line->um16);
    uint32_t variance = line->count * (uint32_t)line->tick_tick - line->ticks * line->ticks;
    if (covariance <= 0 || !variance)
        return 0;
    return scaled_slope(fdvv_ratio_of((uint32_t)covariance), fdvv_ratio_of(variance), scale);
}

/* -- once per press ------------------------------------------------------------------------------------- */

static void reset_window(fdvv_velocity *velocity)
{
    line_reset(&velocity->window);
    velocity->first_tick = velocity->now_tick;
}

/* Offset from 65535 um16 above the newest sample, clamped to 16 bits (the whole travel of a button), so that the sums
 * fit into 32 bits. */
static inline uint32_t clamped_offset(int32_t um16, int32_t origin_um16)
{
    uint32_t offset = (uint32_t)(um16 - origin_um16);
    return offset <= UINT16_MAX ? offset : offset >> 31 ? 0 : UINT16_MAX;
}

/* Sums of the latest samples if no tick was missed between them. Going back from the newest, adding up the partial
 * sums gives the sum of tick times offset without a multiplication. */
static void sum_contiguous(const fdvv_velocity *velocity, uint32_t count, fdvv_line *line)
{
    uint32_t at = velocity->next, um16 = 0, tick_um16 = 0, left = count;
    int32_t origin_um16 = velocity->recent_um16[(at - 1) & (FDVV_RECENT_SAMPLES - 1)] - UINT16_MAX;
    do {
        at = (at - 1) & (FDVV_RECENT_SAMPLES - 1);
        tick_um16 += um16;
        um16 += clamped_offset(velocity->recent_um16[at], origin_um16);
    } while (--left);
    line->um16 = um16;
    line->tick_um16 = tick_um16;
    line->ticks = count * (count - 1) >> 1;
    line->tick_tick = line->ticks * (2 * count - 1) * 21846u >> 16; /* / 3, exact below 2^15 */
}

/* The same if ticks were missed. */
static void sum_with_gaps(const fdvv_velocity *velocity, uint32_t count, fdvv_line *line)
{
    uint32_t at = (uint32_t)(velocity->next - count), ticks = 0, um16 = 0, tick_tick = 0, tick_um16 = 0, left;
    uint32_t first_tick = velocity->recent_tick[at & (FDVV_RECENT_SAMPLES - 1)];
    int32_t origin_um16 = velocity->recent_um16[(velocity->next - 1) & (FDVV_RECENT_SAMPLES - 1)] - UINT16_MAX;
    for (left = count; left; left--, at++) {
        uint32_t tick = velocity->recent_tick[at & (FDVV_RECENT_SAMPLES - 1)] - first_tick;
        uint32_t offset = clamped_offset(velocity->recent_um16[at & (FDVV_RECENT_SAMPLES - 1)], origin_um16);
        ticks += tick;
        um16 += offset;
        tick_tick += tick * tick;
        tick_um16 += tick * offset;
    }
    line->ticks = ticks;
    line->um16 = um16;
    line->tick_tick = tick_tick;
    line->tick_um16 = tick_um16;
}

/* Least-squares slope of the latest samples times scale. */
static uint16_t recent_slope(const fdvv_velocity *velocity, uint32_t count, fdvv_ratio scale)
{
    uint32_t first = (uint32_t)(velocity->next - count) & (FDVV_RECENT_SAMPLES - 1);
    uint32_t span_ticks = velocity->now_tick - velocity->recent_tick[first];
    fdvv_line line;
    line.count = count;
    if (span_ticks == count - 1)
        sum_contiguous(velocity, count, &line);
    else
        sum_with_gaps(velocity, count, &line);
    return span_ticks <= SHORT_TICKS ? short_line_slope(&line, scale) : line_slope(&line, scale);
}

static void decide(fdvv_velocity *velocity, const fdvv_settings *settings)
{
    if (velocity->window.count >= settings->fewest_samples)
        velocity->decided_mm_s16 = line_slope(&velocity->window, velocity->decided_scale);
    else if (velocity->stored >= settings->fewest_samples)
        velocity->decided_mm_s16 = recent_slope(velocity, settings->fewest_samples, velocity->decided_scale);
    else
        return;
    velocity->decided = 1;
}

/* Collect the samples of one press inside the window. The first sample beyond it decides the velocity. */
static void update_window(fdvv_velocity *velocity, const fdvv_settings *settings, const fdvv_position *position)
{
    int32_t um16 = position->um16;
    if (position->at_top) {
        velocity->decided = 0;
        reset_window(velocity);
        return;
    }
    if (position->release)
        reset_window(velocity);
    if (position->release || velocity->decided || um16 < settings->window_start_um16)
        return;
    if (um16 > settings->window_end_um16) {
        decide(velocity, settings);
        return;
    }
    if (!velocity->window.count || velocity->now_tick - velocity->first_tick >= FDVV_WINDOW_TICKS)
        reset_window(velocity);
    line_add(&velocity->window, velocity->now_tick - velocity->first_tick,
             (uint32_t)(um16 - settings->window_start_um16));
}

/* -- every tick ----------------------------------------------------------------------------------------- */

/* Update the plain and the weighted sum of the latest samples that have no gap between them. */
static void update_sums(fdvv_velocity *velocity, uint8_t samples, int32_t um16)
{
    if (velocity->contiguous == samples) {
        int32_t oldest = velocity->recent_um16[(velocity->next - samples) & (FDVV_RECENT_SAMPLES - 1)];
        velocity->sum_um16 -= oldest;
        velocity->weighted_um16 -= velocity->sum_um16;
        velocity->contiguous--;
    }
    velocity->weighted_um16 += velocity->contiguous * um16;
    velocity->sum_um16 += um16;
    velocity->contiguous++;
}

/* Least-squares slope of n equidistant samples: 6 / (n (n^2 - 1)) * sum of (2 i - (n - 1)) x_i per tick. The sum is
 * below 512 * 924,287 < 2^29, and below 2^24 if the shift of the scale is below 17 (n < 6). */
static void estimate(fdvv_velocity *velocity)
{
    uint32_t n = velocity->contiguous;
    if (n < 3)
        return;
    if (n != velocity->scale_samples) {
        velocity->scale_samples = velocity->contiguous;
        velocity->continuous_scale =
            fdvv_ratio_product(velocity->tick_rate, fdvv_ratio_inverse(fdvv_ratio_of(n * (n * n - 1))));
    }
    velocity->continuous_mm_s16 = (int16_t)fdvv_clamp(
        fdvv_scale(2 * velocity->weighted_um16 - (int32_t)(n - 1) * velocity->sum_um16, velocity->continuous_scale),
        -INT16_MAX, INT16_MAX);
    velocity->continuous = 1;
}

static void add_sample(fdvv_velocity *velocity, const fdvv_settings *settings, int32_t um16, uint16_t elapsed_ticks)
{
    velocity->now_tick += elapsed_ticks;
    if (elapsed_ticks > FDVV_GAP_TICKS) {
        velocity->stored = 0;
        reset_window(velocity);
    }
    if (elapsed_ticks != 1)
        velocity->contiguous = 0, velocity->sum_um16 = velocity->weighted_um16 = 0;
    update_sums(velocity, settings->continuous_samples, um16);
    velocity->recent_um16[velocity->next] = um16;
    velocity->recent_tick[velocity->next] = velocity->now_tick;
    velocity->next = (uint8_t)((velocity->next + 1) & (FDVV_RECENT_SAMPLES - 1));
    if (velocity->stored < FDVV_RECENT_SAMPLES)
        velocity->stored++;
}

void fdvv_velocity_init(fdvv_velocity *velocity, const fdvv_settings *settings)
{
    fdvv_ratio tick = fdvv_ratio_inverse(fdvv_ratio_of(settings->tick_us));
    velocity->tick_rate = fdvv_ratio_product(fdvv_ratio_of(6000), tick);
    velocity->decided_scale = fdvv_ratio_product(fdvv_ratio_of(settings->velocity_scale_q12 * 1000u), tick);
    velocity->decided_scale.shift = (int16_t)(velocity->decided_scale.shift + 12);
    velocity->scale_samples = 0;
    velocity->now_tick = 0;
    velocity->sum_um16 = velocity->weighted_um16 = 0;
    velocity->next = velocity->stored = velocity->contiguous = velocity->decided = velocity->continuous = 0;
    velocity->decided_mm_s16 = 0;
    velocity->continuous_mm_s16 = 0;
    reset_window(velocity);
}

void fdvv_velocity_tick(fdvv_velocity *velocity, const fdvv_settings *settings, const fdvv_position *position,
                        uint16_t elapsed_ticks)
{
    add_sample(velocity, settings, position->um16, elapsed_ticks);
    estimate(velocity);
    update_window(velocity, settings, position);
}
