#include "velocity.h"

/* The differences of 16 samples within it come to 16 * 16 * 240 * 32768 < 2^31 at most. */
#define SHORT_TICKS 480

/* In the window: below 2^15 samples, times below 2^15, places below 2^16. Among the newest: up to 16 samples,
 * times up to 960, places below 2^16. So every product of a sample is below 2^32, and every product in
 * line_slope below 2^62. */
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
static uint64_t times(uint32_t count, uint64_t sum)
{
    return fdvv_wide_product(count, (uint32_t)sum) + ((uint64_t)(count * (uint32_t)(sum >> 32)) << 32);
}

/* up / spread, parts of a slope, times a ratio, to the nearest. */
static uint16_t slope_of(fdvv_ratio up, fdvv_ratio spread, fdvv_ratio scale)
{
    fdvv_ratio slope = fdvv_ratio_product(fdvv_ratio_product(up, fdvv_ratio_inverse(spread)), scale);
    if (slope.shift < 0)
        return UINT16_MAX;
    if (slope.shift > 16)
        return 0;
    return (uint16_t)((((uint32_t)slope.mantissa << 1 >> slope.shift) + 1u) >> 1);
}

/* Slope of the line times a ratio, to the nearest; 0 if it does not rise. */
static uint16_t line_slope(const fdvv_line *line, fdvv_ratio scale)
{
    uint64_t up = times(line->count, line->tick_um16), down = fdvv_wide_product(line->ticks, line->um16);
    uint64_t spread = times(line->count, line->tick_tick) - fdvv_wide_product(line->ticks, line->ticks);
    if (up <= down || !spread)
        return 0;
    return slope_of(fdvv_ratio_of_wide(up - down), fdvv_ratio_of_wide(spread), scale);
}

/* The same of a short line, whose differences fit 32 bits even where their parts do not. */
static uint16_t short_line_slope(const fdvv_line *line, fdvv_ratio scale)
{
    int32_t up = (int32_t)(line->count * (uint32_t)line->tick_um16 - line->ticks * line->um16);
    uint32_t spread = line->count * (uint32_t)line->tick_tick - line->ticks * line->ticks;
    if (up <= 0 || !spread)
        return 0;
    return slope_of(fdvv_ratio_of((uint32_t)up), fdvv_ratio_of(spread), scale);
}

/* -- once per press ------------------------------------------------------------------------------------- */

static void forget_window(fdvv_velocity *velocity)
{
    line_reset(&velocity->inside);
    velocity->first_tick = velocity->now_tick;
}

/* Places count from 65535 um16 above the newest one, and those that lie further off (a button's whole travel) count
 * as the nearest that does not; so the sums fit 32 bits until the end. */
static inline uint32_t place_of(int32_t um16, int32_t from_um16)
{
    uint32_t place = (uint32_t)(um16 - from_um16);
    return place <= UINT16_MAX ? place : place >> 31 ? 0 : UINT16_MAX;
}

/* Fill a line with the newest few, between which no tick was missed: from the newest back, each partial sum once
 * more for each sample before it, which makes the products with the tick. */
static void even_line_of_newest(const fdvv_velocity *velocity, uint32_t few, fdvv_line *line)
{
    uint32_t at = velocity->next, um16 = 0, tick_um16 = 0, left = few;
    int32_t from_um16 = velocity->newest_um16[(at - 1) & (FDVV_NEWEST - 1)] - UINT16_MAX;
    do {
        at = (at - 1) & (FDVV_NEWEST - 1);
        tick_um16 += um16;
        um16 += place_of(velocity->newest_um16[at], from_um16);
    } while (--left);
    line->um16 = um16;
    line->tick_um16 = tick_um16;
    line->ticks = few * (few - 1) >> 1;
    line->tick_tick = line->ticks * (2 * few - 1) * 21846u >> 16; /* a third, exact below 2^15 */
}

/* The same where ticks may have been missed. */
static void line_of_newest(const fdvv_velocity *velocity, uint32_t few, fdvv_line *line)
{
    uint32_t at = (uint32_t)(velocity->next - few), ticks = 0, um16 = 0, tick_tick = 0, tick_um16 = 0, left;
    uint32_t first_tick = velocity->newest_tick[at & (FDVV_NEWEST - 1)];
    int32_t from_um16 = velocity->newest_um16[(velocity->next - 1) & (FDVV_NEWEST - 1)] - UINT16_MAX;
    for (left = few; left; left--, at++) {
        uint32_t tick = velocity->newest_tick[at & (FDVV_NEWEST - 1)] - first_tick;
        uint32_t place = place_of(velocity->newest_um16[at & (FDVV_NEWEST - 1)], from_um16);
        ticks += tick;
        um16 += place;
        tick_tick += tick * tick;
        tick_um16 += tick * place;
    }
    line->ticks = ticks;
    line->um16 = um16;
    line->tick_tick = tick_tick;
    line->tick_um16 = tick_um16;
}

/* Slope of the newest few, times a ratio. */
static uint16_t newest_slope(const fdvv_velocity *velocity, uint32_t few, fdvv_ratio scale)
{
    uint32_t first = (uint32_t)(velocity->next - few) & (FDVV_NEWEST - 1);
    uint32_t span_ticks = velocity->now_tick - velocity->newest_tick[first];
    fdvv_line line;
    line.count = few;
    if (span_ticks == few - 1)
        even_line_of_newest(velocity, few, &line);
    else
        line_of_newest(velocity, few, &line);
    return span_ticks <= SHORT_TICKS ? short_line_slope(&line, scale) : line_slope(&line, scale);
}

static void decide(fdvv_velocity *velocity, const fdvv_settings *settings)
{
    if (velocity->inside.count >= settings->fewest_samples)
        velocity->decided_mm_s16 = line_slope(&velocity->inside, velocity->decided_scale);
    else if (velocity->kept >= settings->fewest_samples)
        velocity->decided_mm_s16 = newest_slope(velocity, settings->fewest_samples, velocity->decided_scale);
    else
        return;
    velocity->decided = 1;
}

/* Collect the samples of one uninterrupted press inside the window; decide at the first one beyond it. */
static void watch_window(fdvv_velocity *velocity, const fdvv_settings *settings, const fdvv_position *position)
{
    int32_t um16 = position->um16;
    if (position->at_top) {
        velocity->decided = 0;
        forget_window(velocity);
        return;
    }
    if (position->release)
        forget_window(velocity);
    if (position->release || velocity->decided || um16 < settings->window_start_um16)
        return;
    if (um16 > settings->window_end_um16) {
        decide(velocity, settings);
        return;
    }
    if (!velocity->inside.count || velocity->now_tick - velocity->first_tick >= FDVV_WINDOW_TICKS)
        forget_window(velocity);
    line_add(&velocity->inside, velocity->now_tick - velocity->first_tick,
             (uint32_t)(um16 - settings->window_start_um16));
}

/* -- every tick ----------------------------------------------------------------------------------------- */

/* Keep the plain and the ramped sum of the newest samples that follow each other without a gap. */
static void slide(fdvv_velocity *velocity, uint8_t samples, int32_t um16)
{
    if (velocity->even == samples) {
        int32_t oldest = velocity->newest_um16[(velocity->next - samples) & (FDVV_NEWEST - 1)];
        velocity->sum_um16 -= oldest;
        velocity->ramp_um16 -= velocity->sum_um16;
        velocity->even--;
    }
    velocity->ramp_um16 += velocity->even * um16;
    velocity->sum_um16 += um16;
    velocity->even++;
}

/* Least squares of n samples in even time: 6 / (n (n^2 - 1)) * sum of (2 i - (n - 1)) x_i per tick. The sum stays
 * below 512 * 662,144 < 2^29, and below 2^24 where the scale's shift is below 17 (n < 6). */
static void estimate(fdvv_velocity *velocity)
{
    uint32_t n = velocity->even;
    if (n < 3)
        return;
    if (n != velocity->scaled_for) {
        velocity->scaled_for = velocity->even;
        velocity->slope_scale =
            fdvv_ratio_product(velocity->tick_rate, fdvv_ratio_inverse(fdvv_ratio_of(n * (n * n - 1))));
    }
    velocity->continuous_mm_s16 = (int16_t)fdvv_clamp(
        fdvv_scale(2 * velocity->ramp_um16 - (int32_t)(n - 1) * velocity->sum_um16, velocity->slope_scale), -INT16_MAX,
        INT16_MAX);
    velocity->continuous = 1;
}

static void take(fdvv_velocity *velocity, const fdvv_settings *settings, int32_t um16, uint16_t elapsed_ticks)
{
    velocity->now_tick += elapsed_ticks;
    if (elapsed_ticks > FDVV_GAP_TICKS) {
        velocity->kept = 0;
        forget_window(velocity);
    }
    if (elapsed_ticks != 1)
        velocity->even = 0, velocity->sum_um16 = velocity->ramp_um16 = 0;
    slide(velocity, settings->continuous_samples, um16);
    velocity->newest_um16[velocity->next] = um16;
    velocity->newest_tick[velocity->next] = velocity->now_tick;
    velocity->next = (uint8_t)((velocity->next + 1) & (FDVV_NEWEST - 1));
    if (velocity->kept < FDVV_NEWEST)
        velocity->kept++;
}

void fdvv_velocity_init(fdvv_velocity *velocity, const fdvv_settings *settings)
{
    fdvv_ratio tick = fdvv_ratio_inverse(fdvv_ratio_of(settings->tick_us));
    velocity->tick_rate = fdvv_ratio_product(fdvv_ratio_of(6000), tick);
    velocity->decided_scale = fdvv_ratio_product(fdvv_ratio_of(settings->velocity_scale_q12 * 1000u), tick);
    velocity->decided_scale.shift = (int16_t)(velocity->decided_scale.shift + 12);
    velocity->scaled_for = 0;
    velocity->now_tick = 0;
    velocity->sum_um16 = velocity->ramp_um16 = 0;
    velocity->next = velocity->kept = velocity->even = velocity->decided = velocity->continuous = 0;
    velocity->decided_mm_s16 = 0;
    velocity->continuous_mm_s16 = 0;
    forget_window(velocity);
}

void fdvv_velocity_tick(fdvv_velocity *velocity, const fdvv_settings *settings, const fdvv_position *position,
                        uint16_t elapsed_ticks)
{
    take(velocity, settings, position->um16, elapsed_ticks);
    estimate(velocity);
    watch_window(velocity, settings, position);
}
