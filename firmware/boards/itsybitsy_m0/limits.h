/* Made by tools/make_board_limits.py from voltage.toml; do not edit.
 * No setting is looser than these. */
#ifndef ITSYBITSY_M0_LIMITS_H
#define ITSYBITSY_M0_LIMITS_H

#define BOARD_LIMITS \
    { \
        60000, /* heat_time_ms */ \
        27783, /* duty_gain_q16 */ \
        12000, /* nominal_supply_mV */ \
        14004, /* supply_high_mV */ \
        28160, /* force_limit_cN64 */ \
        32767, /* duty_limit_q15 */ \
        596, /* full_duty_rise_K */ \
        90, /* heat_limit_K */ \
        250, /* host_timeout_ms */ \
        250, /* tick_low_us */ \
        1000, /* tick_high_us */ \
        0, /* thermistor_lag_ms */ \
        256, /* thermistor_share_q8 */ \
        0, /* spare */ \
    }

#endif
