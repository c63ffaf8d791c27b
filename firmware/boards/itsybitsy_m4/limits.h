/* Made by tools/make_board_limits.py from recommended.toml; do not edit.
 * No setting is looser than these. */
#ifndef ITSYBITSY_M4_LIMITS_H
#define ITSYBITSY_M4_LIMITS_H

#define BOARD_LIMITS \
    { \
        60000, /* heat_time_ms */ \
        12995, /* duty_gain_q16 */ \
        24000, /* nominal_supply_mV */ \
        28008, /* supply_high_mV */ \
        28160, /* force_limit_cN64 */ \
        32767, /* duty_limit_q15 */ \
        3221, /* full_duty_rise_K */ \
        90, /* heat_limit_K */ \
        250, /* host_timeout_ms */ \
        100, /* tick_low_us */ \
        1000, /* tick_high_us */ \
        6000, /* thermistor_lag_ms */ \
        207, /* thermistor_share_q8 */ \
        0, /* spare */ \
    }

#endif
