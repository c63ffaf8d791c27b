/* Settings are valid if every field is in its range, the fields are consistent, and none is looser than the board. */
#include <stddef.h>

#include "arithmetic.h"
#include "ranges.h"
#include "supervisor.h"

/* A gain of 0 would hide every displacement, and beyond the longest way they would wrap around. */
static uint8_t is_gain_invalid(const fdvv_settings *settings)
{
    uint32_t largest_sum = (uint32_t)settings->reads * settings->reading_high;
    int32_t gain = settings->position_gain_q14;
    /* below 2^33, half a um16 less */
    uint32_t steepest = (UINT32_MAX - (1u << 13)) / largest_sum * 2u;
    return gain == 0 || (uint32_t)(gain < 0 ? -gain : gain) > steepest;
}

static uint8_t find_inconsistent(const fdvv_settings *settings)
{
    if (settings->window_end_um16 <= settings->window_start_um16)
        return 1 + FDVV_SETTINGS_FIELD_window_end_um16;
    if (settings->supply_high_mV <= settings->supply_low_mV)
        return 1 + FDVV_SETTINGS_FIELD_supply_high_mV;
    if (settings->reading_high <= settings->reading_low)
        return 1 + FDVV_SETTINGS_FIELD_reading_high;
    if (settings->heat_limit_K <= settings->derate_start_K)
        return 1 + FDVV_SETTINGS_FIELD_heat_limit_K;
    if (is_gain_invalid(settings))
        return 1 + FDVV_SETTINGS_FIELD_position_gain_q14;
    return 0;
}

/* A setting of 16 bits that can only be tightened; where it and the board's limit are. */
typedef struct {
    uint8_t field, at, limit_at, is_least;
} tightened;

#define ROW(field, limit, is_least)                                                                              \
    {FDVV_SETTINGS_FIELD_##field, offsetof(fdvv_settings, field), offsetof(fdvv_board_limits, limit), is_least}

static const tightened rows[] = {
    ROW(tick_us, tick_high_us, 0),
    ROW(tick_us, tick_low_us, 1),
    ROW(force_limit_cN64, force_limit_cN64, 0),
    ROW(duty_limit_q15, duty_limit_q15, 0),
    ROW(supply_high_mV, supply_high_mV, 0),
    ROW(full_duty_rise_K, full_duty_rise_K, 1),
    ROW(heat_limit_K, heat_limit_K, 0),
    ROW(host_timeout_ms, host_timeout_ms, 0),
};

/* settings and limits are read by their places; none of them is negative */
typedef uint16_t __attribute__((may_alias)) number;

static uint16_t number_at(const void *record, uint8_t at)
{
    return *(const number *)(const void *)((const uint8_t *)record + at);
}

/* The first row that is looser than the board, or 0. */
static FDVV_COLD const tightened *find_loosened(const fdvv_settings *settings, const fdvv_board_limits *limits)
{
    uint8_t i;
    for (i = 0; i < sizeof rows / sizeof *rows; i++) {
        uint16_t value = number_at(settings, rows[i].at), limit = number_at(limits, rows[i].limit_at);
        if (rows[i].is_least ? value < limit : value > limit)
            return &rows[i];
    }
    return 0;
}

/* The largest duty per force, so that a force gets no more voltage than the board allows for it: gain * board / own,
 * rounded down. The gain is split into q * own + r: q * board stays below 2^25, and r * board below 2^32. */
static FDVV_COLD int32_t largest_gain_q16(const fdvv_settings *settings, const fdvv_board_limits *limits)
{
    uint32_t gain = (uint32_t)limits->duty_gain_q16, board = limits->nominal_supply_mV, own = settings->nominal_supply_mV;
    return (int32_t)(gain / own * board + gain % own * board / own);
}

FDVV_COLD void fdvv_settings_tighten(fdvv_settings *settings, const fdvv_board_limits *limits)
{
    const tightened *row;
    while ((row = find_loosened(settings, limits)) != 0)
        *(number *)(void *)((uint8_t *)settings + row->at) = number_at(limits, row->limit_at);
    if (settings->duty_gain_q16 > largest_gain_q16(settings, limits))
        settings->duty_gain_q16 = largest_gain_q16(settings, limits);
    if (settings->derate_start_K >= settings->heat_limit_K)
        settings->derate_start_K = (uint16_t)(settings->heat_limit_K - 1);
    if (settings->supply_low_mV >= settings->supply_high_mV)
        settings->supply_low_mV = (uint16_t)(settings->supply_high_mV - 1);
}

uint8_t fdvv_settings_check(const fdvv_settings *settings, const fdvv_board_limits *limits)
{
    const tightened *loosened;
    uint8_t invalid;
#define CHECK(field, low, high)                                                                             \
    if (fdvv_outside((int32_t)settings->field, low, high))                                                  \
        return 1 + FDVV_SETTINGS_FIELD_##field;
    FDVV_SETTINGS_RANGES(CHECK)
#undef CHECK
    invalid = find_inconsistent(settings);
    if (invalid)
        return invalid;
    if (settings->duty_gain_q16 > largest_gain_q16(settings, limits))
        return 1 + FDVV_SETTINGS_FIELD_duty_gain_q16;
    loosened = find_loosened(settings, limits);
    return loosened ? (uint8_t)(1 + loosened->field) : 0;
}
