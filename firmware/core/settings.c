/* Settings are valid if every field is in its range and the fields are consistent. */
#include "ranges.h"
#include "supervisor.h"

/* The displacement is computed with 32 bits: the largest sum times the gain must not overflow. */
static uint8_t gain_overflows(const fdvv_settings *settings)
{
    uint32_t largest_sum = (uint32_t)settings->reads * settings->reading_high;
    int32_t gain = settings->position_gain_q14;
    return gain == 0 || (uint32_t)(gain < 0 ? -gain : gain) > UINT32_MAX / largest_sum;
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
    if (gain_overflows(settings))
        return 1 + FDVV_SETTINGS_FIELD_position_gain_q14;
    return 0;
}

uint8_t fdvv_settings_check(const fdvv_settings *settings)
{
#define CHECK(field, low, high)                                                                             \
    if (fdvv_outside((int32_t)settings->field, low, high))                                                  \
        return 1 + FDVV_SETTINGS_FIELD_##field;
    FDVV_SETTINGS_RANGES(CHECK)
#undef CHECK
    return find_inconsistent(settings);
}
