#include "heat.h"

#include "arithmetic.h"

#define HOTTEST_K 65533 /* with the two kelvins that are added to it, the most that 16 bits hold */

static uint32_t lower(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static uint32_t higher(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

/* rise_K at the highest supply, if it goes with the supply; rounded up, and kept to 16 bits. */
static uint32_t raised_K(const fdvv_board_limits *limits, uint32_t rise_K)
{
    return lower(rise_K * limits->supply_high_mV / limits->nominal_supply_mV + 1, HOTTEST_K);
}

/* Twice the longest period of a board's watchdog: a tick decides on its force before it counts the ticks that were missed. */
#define LATE_us 16000
#define MOST_LATE_K_q16 ((uint32_t)2 << 16) /* a coil that gains more has no board that could stop in time */

static uint32_t gain_when_late_K_q16(uint32_t highest_K, uint32_t time_us)
{
    uint64_t gain_q48 = fdvv_wide_product(highest_K << 16, fdvv_fraction_q32(LATE_us, time_us));
    return lower((uint32_t)(gain_q48 >> 32) + 1, MOST_LATE_K_q16);
}

/* The model is never cooler than the coil of the board, whatever the settings were and are: towards the higher of both
 * ends it heats with the shorter of both time constants and cools with the longer, so at the temperature of the coil it
 * never falls behind. tick / time is more than the part 1 - exp(-tick / time) of the way, tick / (time + tick) is less. */
FDVV_COLD void fdvv_heat_set(fdvv_heat *heat, const fdvv_board_limits *limits, const fdvv_settings *settings)
{
    uint32_t board_us = limits->heat_time_ms * 1000, time_us = settings->heat_time_ms * 1000, highest_K;
#ifndef FDVV_NO_THERMISTOR
    fdvv_thermistor_set(&heat->thermistor, limits, settings, heat->heating_q32);
#endif
    heat->heating_q32 = fdvv_fraction_q32(settings->tick_us, lower(time_us, board_us)) + 1;
    heat->cooling_q32 = fdvv_fraction_q32(settings->tick_us, higher(time_us, board_us) + settings->tick_us);
    heat->rise_K = (uint16_t)(highest_K = higher(settings->full_duty_rise_K, limits->full_duty_rise_K));
    heat->nominal_supply_mV = limits->nominal_supply_mV;
    if (limits->supply_high_mV > heat->nominal_supply_mV) {
        highest_K = raised_K(limits, raised_K(limits, heat->rise_K));
        heat->rise_K_mV_q16 =
            ((highest_K - heat->rise_K) << 16) / (limits->supply_high_mV - (uint32_t)heat->nominal_supply_mV) + 1;
    }
    heat->late_K_q16 = gain_when_late_K_q16(highest_K, lower(time_us, board_us));
}

/* Rise at which the coil would end at this duty, rounded up. A current drive heats with the square of the duty, a
 * voltage drive with that of duty times supply: the higher of the two. The chord from the nominal to the highest supply
 * lies above the square. Beyond the highest supply the duty is 0. */
static inline uint32_t end_K_q16(const fdvv_heat *me, int16_t duty_q15, uint16_t supply_mV)
{
    uint32_t rise_K = me->rise_K;
    if (supply_mV > me->nominal_supply_mV)
        rise_K += ((uint32_t)(supply_mV - me->nominal_supply_mV) * me->rise_K_mV_q16 >> 16) + 1;
    return rise_K * (((uint32_t)((int32_t)duty_q15 * duty_q15) + 0x3fff) >> 14);
}

static uint64_t coil_K_q48(const fdvv_heat *me)
{
    return (uint64_t)me->coil_K_q16 << 32 | me->coil_rest_q48;
}

static void set_coil_K_q48(fdvv_heat *me, uint64_t coil_q48)
{
    me->coil_K_q16 = (uint32_t)(coil_q48 >> 32);
    me->coil_rest_q48 = (uint32_t)coil_q48;
}

static FDVV_COLD uint64_t long_product(uint32_t x, uint32_t y)
{
    return fdvv_wide_product(x, y);
}

/* Of a coil that takes more than 65536 ticks to warm, with two multiplications less. */
static inline uint64_t part_q48(uint32_t way_q16, uint32_t part_q32)
{
    uint32_t low = (way_q16 & 0xffff) * part_q32, high = (way_q16 >> 16) * part_q32 + (low >> 16);
    if (part_q32 >> 16)
        return long_product(way_q16, part_q32);
    return (uint64_t)(high >> 16) << 32 | (high << 16 | (low & 0xffff));
}

/* Missed ticks had the duty of the last one: they may heat, and never cool. */
static __attribute__((noinline)) void heat_missed(fdvv_heat *me, uint32_t ticks)
{
    uint64_t part_q32;
    if (me->end_K_q16 <= me->coil_K_q16)
        return;
    part_q32 = part_q48(ticks, me->heating_q32);
    if (part_q32 >> 32) /* the whole way */
        set_coil_K_q48(me, (uint64_t)me->end_K_q16 << 32);
    else
        set_coil_K_q48(me, coil_K_q48(me) + fdvv_wide_product(me->end_K_q16 - me->coil_K_q16, (uint32_t)part_q32));
}

/* First-order thermal model. The temperature rise has 48 fractional bits, so that no step is too small. */
void fdvv_heat_tick(fdvv_heat *heat, int16_t duty_q15, uint16_t supply_mV, uint16_t elapsed_ticks)
{
    uint32_t end_q16 = end_K_q16(heat, duty_q15, supply_mV), coil_q16;
    if (elapsed_ticks > 1)
        heat_missed(heat, elapsed_ticks - 1u);
    heat->end_K_q16 = end_q16;
    coil_q16 = heat->coil_K_q16;
    if (end_q16 > coil_q16)
        set_coil_K_q48(heat, coil_K_q48(heat) + part_q48(end_q16 - coil_q16, heat->heating_q32));
    else
        set_coil_K_q48(heat, coil_K_q48(heat) - part_q48(coil_q16 - end_q16, heat->cooling_q32));
}

#ifndef FDVV_NO_THERMISTOR
void fdvv_heat_thermistor(fdvv_heat *heat, uint16_t counts, uint16_t elapsed_ticks)
{
    fdvv_thermistor *thermistor = &heat->thermistor;
    if (!thermistor->is_fitted)
        return;
    thermistor->load_K_q16 += heat->end_K_q16;
    if (elapsed_ticks > 1) /* missed ticks had the duty of the one before */
        thermistor->load_K_q16 += long_product(thermistor->end_K_q16, elapsed_ticks - 1u);
    thermistor->end_K_q16 = heat->end_K_q16;
    thermistor->ticks = (uint16_t)lower(thermistor->ticks + higher(elapsed_ticks, 1), UINT16_MAX);
    if (thermistor->ticks < FDVV_THERMISTOR_TICKS)
        return;
    heat->coil_K_q16 = fdvv_thermistor_sample(thermistor, counts, heat->coil_K_q16 + 1, heat->heating_q32);
    heat->coil_rest_q48 = 0;
}
#endif

void fdvv_heat_keep(const fdvv_heat *heat, fdvv_kept_heat *kept)
{
    kept->coil_K_q16 = heat->coil_K_q16 + (1 << 16);
    kept->check = ~kept->coil_K_q16;
}

FDVV_COLD void fdvv_heat_resume(fdvv_heat *heat, const fdvv_board_limits *limits, const fdvv_kept_heat *kept)
{
    if (kept->check == ~kept->coil_K_q16)
        heat->coil_K_q16 = kept->coil_K_q16;
    else /* no force, and no fault */
        heat->coil_K_q16 = ((uint32_t)limits->heat_limit_K << 16) - 1;
}
