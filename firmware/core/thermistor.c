#include "thermistor.h"

#include "arithmetic.h"
#include "thermistor_table.h"

#ifndef FDVV_NO_THERMISTOR
#define HOTTEST_K_q16 UINT32_MAX
#define K_q16(kelvins) ((uint32_t)(kelvins) << 16)

static FDVV_COLD uint32_t part_of(uint32_t value, uint32_t part_q32)
{
    return (uint32_t)(fdvv_wide_product(value, part_q32) >> 32);
}

static uint32_t sum(uint32_t a, uint32_t b)
{
    return a > HOTTEST_K_q16 - b ? HOTTEST_K_q16 : a + b;
}

/* load * part, rounded up; at the end of the range for what would not fit. */
static uint32_t warmed_K_q16(uint64_t load_K_q16, uint32_t part_q32)
{
    uint64_t load_K_q8 = (load_K_q16 >> 8) + 1, warmed;
    if (load_K_q8 >> 32)
        return HOTTEST_K_q16;
    warmed = (fdvv_wide_product((uint32_t)load_K_q8, part_q32) >> 24) + 1;
    return warmed >> 32 ? HOTTEST_K_q16 : (uint32_t)warmed;
}

/* What the duties of the last ticks may have added to the excess, and to the least that the coil has warmed. */
static void take_load(fdvv_thermistor *me, uint32_t heating_q32)
{
    me->excess_K_q16 = sum(me->excess_K_q16, warmed_K_q16(me->load_K_q16, heating_q32));
    me->least_K_q16 = sum(me->least_K_q16, warmed_K_q16(me->load_K_q16, me->warming_q32));
    me->load_K_q16 = 0;
}

FDVV_COLD void fdvv_thermistor_set(fdvv_thermistor *me, const fdvv_board_limits *limits, const fdvv_settings *settings,
                                   uint32_t heating_q32)
{
    uint32_t lag_us = limits->thermistor_lag_ms * 1000u, time_us = limits->heat_time_ms * 1000u;
    uint32_t span_us = FDVV_THERMISTOR_TICKS * (uint32_t)settings->tick_us, rise_K = limits->full_duty_rise_K;
    take_load(me, heating_q32); /* with the tick that it was made with */
    me->is_fitted = lag_us != 0;
    me->keep_q32 = fdvv_fraction_q32(lag_us, lag_us + span_us) + 1;
    me->cooling_q32 = fdvv_fraction_q32(span_us, time_us + span_us);
    /* the load is that of the settings' coil, if that is warmer than the board's */
    me->warming_q32 = fdvv_fraction_q32(settings->tick_us, time_us) >> 1;
    if (settings->full_duty_rise_K > rise_K)
        me->warming_q32 = part_of(me->warming_q32, fdvv_fraction_q32(rise_K, settings->full_duty_rise_K));
    me->share_1_q16 = (fdvv_fraction_q32(1, limits->thermistor_share_q8) >> 8) + 1;
    me->jump_K_q16 = K_q16(8) + part_of(K_q16(4 * limits->heat_limit_K), ~me->keep_q32);
}

/* Rise of the thermistor above the coldest room, never too cold: the chord of a curve that bends upward. */
static uint32_t rise_K_q16(uint16_t counts)
{
    const uint16_t *row = thermistor_rise_K_q8 + (counts >> THERMISTOR_STEP_BITS);
    uint32_t fraction = counts & ((1u << THERMISTOR_STEP_BITS) - 1);
    return ((uint32_t)row[0] << 8) - ((uint32_t)(row[0] - row[1]) * fraction << 8 >> THERMISTOR_STEP_BITS);
}

static uint32_t as_coil_K_q16(const fdvv_thermistor *me, uint32_t rise_K_q16)
{
    return (uint32_t)(fdvv_wide_product(rise_K_q16, me->share_1_q16) >> 16) + 1;
}

static void fail(fdvv_thermistor *me, uint8_t fault, uint32_t value, uint32_t bound)
{
    me->faults = fault;
    me->value = (int16_t)value;
    me->bound = (int16_t)bound;
    me->is_known = 0;
}

static void check_wire(fdvv_thermistor *me, uint16_t counts)
{
    me->faults = 0;
    if (counts > FDVV_THERMISTOR_OPEN)
        fail(me, FDVV_THERMISTOR_IS_OPEN, fdvv_clamp(counts, 0, INT16_MAX), FDVV_THERMISTOR_OPEN);
    else if (counts < FDVV_THERMISTOR_SHORT)
        fail(me, FDVV_THERMISTOR_IS_SHORT, counts, FDVV_THERMISTOR_SHORT);
}

static void check_reading(fdvv_thermistor *me, uint32_t reading, uint8_t is_late)
{
    uint32_t last = me->reading_K_q16, change = reading > last ? reading - last : last - reading;
    if (me->is_known && !is_late && change > me->jump_K_q16)
        fail(me, FDVV_THERMISTOR_JUMPS, change >> 16, me->jump_K_q16 >> 16);
    else if (me->follower_K_q16 > reading + K_q16(FDVV_THERMISTOR_COLD_K))
        fail(me, FDVV_THERMISTOR_IS_COLD, reading >> 16, me->follower_K_q16 >> 16);
    me->reading_K_q16 = reading;
}

/* The excess that heat_K_q16 leaves room for, if the thermistor is as cold as its reading allows. */
static void begin(fdvv_thermistor *me, uint32_t heat_K_q16)
{
    uint32_t most = sum(heat_K_q16, as_coil_K_q16(me, K_q16(2 * THERMISTOR_MARGIN_K)));
    if (me->is_known)
        return;
    me->is_known = 1;
    me->excess_K_q16 = most > me->reading_K_q16 ? most - me->reading_K_q16 : 0;
}

static uint32_t bounded_K_q16(const fdvv_thermistor *me, uint32_t rise, uint32_t heat)
{
    uint32_t highest = sum(me->reading_K_q16, me->excess_K_q16), margin = K_q16(2 * THERMISTOR_MARGIN_K);
    uint32_t lowest = rise > margin ? rise - margin : 0;
    if (heat > highest)
        heat = highest;
    return heat < lowest ? lowest : heat;
}

FDVV_COLD uint32_t fdvv_thermistor_sample(fdvv_thermistor *me, uint16_t counts, uint32_t heat_K_q16, uint32_t heating_q32)
{
    uint8_t is_late = me->ticks >= 2 * FDVV_THERMISTOR_TICKS;
    uint32_t rise;
    me->ticks = 0;
    me->counts = counts;
    me->excess_K_q16 = part_of(me->excess_K_q16, me->keep_q32) + 1;
    me->least_K_q16 -= part_of(me->least_K_q16, me->cooling_q32);
    take_load(me, heating_q32);
    me->follower_K_q16 = part_of(me->follower_K_q16, me->keep_q32) + part_of(me->least_K_q16, ~me->keep_q32);
    check_wire(me, counts);
    if (me->faults)
        return heat_K_q16;
    rise = rise_K_q16(counts);
    check_reading(me, as_coil_K_q16(me, rise), is_late);
    if (me->faults)
        return heat_K_q16;
    begin(me, heat_K_q16);
    return bounded_K_q16(me, rise, heat_K_q16);
}
#else
typedef char fdvv_no_thermistor; /* a file may not be empty */
#endif
