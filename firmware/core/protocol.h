/* Made by tools/make_protocol.py from protocol/fdvv.toml; do not edit. */
#ifndef FDVV_PROTOCOL_H
#define FDVV_PROTOCOL_H

#include <stdint.h>

#define FDVV_PROTOCOL_VERSION 1
#define FDVV_PROTOCOL_HASH 0xd7e0f6f6u

#define FDVV_FRAME_BYTES 232 /* largest frame before stuffing: id, sequence, payload, checksum; COBS adds one byte below 254 */
#define FDVV_DATA_BYTES 192 /* image bytes in one data message, a multiple of 4 */
#define FDVV_IMAGE_BYTES 7168 /* largest program; two banks of it leave the SAMD21 room for USB and stack */
#define FDVV_TELEMETRY_RECORDS 16 /* records in a full telemetry frame: 4 ms at 4 kHz */
#define FDVV_STATES 16 /* most states of a program; a vibration's mask of states has 16 bits */
#define FDVV_TRANSITIONS 48 /* most transitions of a program */
#define FDVV_SURFACES 16 /* most force surfaces of a program */
#define FDVV_SURFACE_VELOCITIES 16 /* most rows of a surface */
#define FDVV_SURFACE_DISPLACEMENTS 255 /* most columns of a surface */
#define FDVV_VIBRATIONS 32 /* most vibration events of a program */
#define FDVV_SLOTS 16 /* most waveforms that the vibration board holds for a program */
#define FDVV_NONE 255 /* no state, slot or surface */
#define FDVV_IMAGE_MAGIC 1347830854 /* FDVP, the first bytes of a program */
#define FDVV_IMAGE_VERSION 1 /* layout of a program */

/* what the supervisor lets the device do */
enum {
    FDVV_MODE_BOOT = 0,
    FDVV_MODE_SELFTEST = 1,
    FDVV_MODE_IDLE = 2,
    FDVV_MODE_ARMED = 3,
    FDVV_MODE_DERATED = 4,
    FDVV_MODE_FAULT = 5,
    FDVV_MODES = 6,
};

/* why the device fell to zero force; latched until cleared by its number */
enum {
    FDVV_FAULT_NONE = 0,
    FDVV_FAULT_POSITION_LOW = 1,
    FDVV_FAULT_POSITION_HIGH = 2,
    FDVV_FAULT_POSITION_STUCK = 3,
    FDVV_FAULT_POSITION_JUMP = 4,
    FDVV_FAULT_OVER_FORCE = 5,
    FDVV_FAULT_OVER_HEAT = 6,
    FDVV_FAULT_SUPPLY_LOW = 7,
    FDVV_FAULT_SUPPLY_HIGH = 8,
    FDVV_FAULT_HOST_LOST = 9,
    FDVV_FAULT_IMAGE_CORRUPT = 10,
    FDVV_FAULT_WATCHDOG = 11,
    FDVV_FAULT_BROWN_OUT = 12,
    FDVV_FAULT_LATE = 13,
    FDVV_FAULT_OUTPUT = 14,
    FDVV_FAULT_SETTINGS_CORRUPT = 15,
    FDVV_FAULT_VIBRATION_BOARD = 16,
    FDVV_FAULT_INTERNAL = 17,
    FDVV_FAULT_THERMISTOR_OPEN = 18,
    FDVV_FAULT_THERMISTOR_SHORT = 19,
    FDVV_FAULT_THERMISTOR_JUMP = 20,
    FDVV_FAULT_THERMISTOR_COLD = 21,
    FDVV_FAULTS = 22,
};

/* why a request was not carried out */
enum {
    FDVV_REFUSAL_NONE = 0,
    FDVV_REFUSAL_UNKNOWN_MESSAGE = 1,
    FDVV_REFUSAL_BAD_LENGTH = 2,
    FDVV_REFUSAL_BAD_VALUE = 3,
    FDVV_REFUSAL_WRONG_MODE = 4,
    FDVV_REFUSAL_WRONG_ORDER = 5,
    FDVV_REFUSAL_TOO_LARGE = 6,
    FDVV_REFUSAL_CHECKSUM = 7,
    FDVV_REFUSAL_IMAGE_LAYOUT = 8,
    FDVV_REFUSAL_IMAGE_RANGE = 9,
    FDVV_REFUSAL_NO_IMAGE = 10,
    FDVV_REFUSAL_FAULT_LATCHED = 11,
    FDVV_REFUSAL_BUSY = 12,
    FDVV_REFUSAL_HASH_MISMATCH = 13,
    FDVV_REFUSALS = 14,
};

/* when a transition fires; value's unit in brackets */
enum {
    FDVV_CONDITION_ALWAYS = 0,
    FDVV_CONDITION_DEEPER_THAN = 1,
    FDVV_CONDITION_SHALLOWER_THAN = 2,
    FDVV_CONDITION_TURNED_TO_PRESS = 3,
    FDVV_CONDITION_TURNED_TO_RELEASE = 4,
    FDVV_CONDITION_FASTER_THAN = 5,
    FDVV_CONDITION_SLOWER_THAN = 6,
    FDVV_CONDITION_AFTER_MS = 7,
    FDVV_CONDITION_HOST_EVENT = 8,
    FDVV_CONDITION_RISEN_BY = 9,
    FDVV_CONDITION_FALLEN_BY = 10,
    FDVV_CONDITIONS = 11,
};

/* which velocity chooses the row of a surface */
enum {
    FDVV_VELOCITY_SOURCE_ANNOUNCED = 0,
    FDVV_VELOCITY_SOURCE_DECIDED = 1,
    FDVV_VELOCITY_SOURCE_CONTINUOUS = 2,
    FDVV_VELOCITY_SOURCES = 3,
};

/* direction of a vibration event */
enum {
    FDVV_STROKE_PRESS = 0,
    FDVV_STROKE_RELEASE = 1,
    FDVV_STROKE_EITHER = 2,
    FDVV_STROKES = 3,
};

/* what a slot plays */
enum {
    FDVV_WAVEFORM_DECAYING_SINE = 0,
    FDVV_WAVEFORM_SAMPLED = 1,
    FDVV_WAVEFORMS = 2,
};

/* parts of the self-test */
enum {
    FDVV_PART_POSITION_SENSOR = 0,
    FDVV_PART_SUPPLY = 1,
    FDVV_PART_FORCE_SENSOR = 2,
    FDVV_PART_VIBRATION_BOARD = 3,
    FDVV_PART_COIL = 4,
    FDVV_PART_MEMORY = 5,
    FDVV_PART_CLOCK = 6,
    FDVV_PART_THERMISTOR = 7,
    FDVV_PARTS = 8,
};

/* outcome of one part of the self-test */
enum {
    FDVV_VERDICT_NOT_TESTED = 0,
    FDVV_VERDICT_PASSED = 1,
    FDVV_VERDICT_FAILED = 2,
    FDVV_VERDICT_ABSENT = 3,
    FDVV_VERDICTS = 4,
};

/* bits of a telemetry record's flags */
enum {
    FDVV_TICK_FLAG_RELEASE = 1 << 0,
    FDVV_TICK_FLAG_LIMITED = 1 << 1,
    FDVV_TICK_FLAG_SLEWED = 1 << 2,
    FDVV_TICK_FLAG_DERATED = 1 << 3,
    FDVV_TICK_FLAG_KEY_DOWN = 1 << 4,
    FDVV_TICK_FLAG_VIBRATED = 1 << 5,
    FDVV_TICK_FLAG_LATE = 1 << 6,
    FDVV_TICK_FLAG_VELOCITY_KNOWN = 1 << 7,
};

/* bits of what a board has */
enum {
    FDVV_BOARD_FLAG_SIMULATED = 1 << 0,
    FDVV_BOARD_FLAG_EMULATED = 1 << 1,
    FDVV_BOARD_FLAG_FORCE_SENSOR = 1 << 2,
    FDVV_BOARD_FLAG_VIBRATION = 1 << 3,
    FDVV_BOARD_FLAG_SERVO = 1 << 4,
};

/* a rig's calibration and limits; written while idle or in fault, refused as a whole if one field is out of range */
typedef struct {
    int32_t position_gain_q14; /* um16 per count of the sum; -262143 to 262143; scale of the summed readings; its size times the largest sum stays below 2^33 - 2^14: 32.7 mm */
    int32_t position_offset_um16; /* um16; -400000 to 400000; displacement at a sum of 0 */
    int32_t duty_gain_q16; /* Q15 duty per cN64; 64 to 1048576; force to duty at mid stroke, supply nominal */
    int32_t force_gain_q14; /* cN64 per count; -262144 to 262144; scale of the keycap force sensor; 0: there is none */
    int32_t force_offset_counts; /* counts; 0 to 65535; its reading at no force */
    uint32_t heat_time_ms; /* ms; 100 to 600000; thermal time constant of the coil */
    uint16_t tick_us; /* us; 50 to 4000; period of the loop; the paper's is 1000 */
    uint16_t window_start_um16; /* um16; 800 to 48000; where the search for velocity begins; the paper's 0.5 mm */
    uint16_t window_end_um16; /* um16; 1600 to 64000; where velocity is decided; the paper's 1.0 mm; beyond the start */
    uint16_t reversal_um16; /* um16; 80 to 16000; way back that turns a press into a release */
    uint16_t rearm_um16; /* um16; 80 to 16000; height above which a new press begins */
    uint16_t velocity_scale_q12; /* 1024 to 16384; mean velocity of a stroke per velocity in the window */
    uint16_t announced_mm_s16; /* mm_s16; 8 to 16000; velocity assumed until one is found */
    int16_t force_limit_cN64; /* cN64; 64 to 32000; largest command, both signs; the paper's coil gives 440 cN */
    int16_t slew_cN64_tick; /* cN64 per tick; 16 to 32000; largest change of the command from tick to tick */
    uint16_t duty_limit_q15; /* Q15; 1024 to 32767; largest duty, both signs */
    uint16_t nominal_supply_mV; /* mV; 3000 to 48000; supply at which duty_gain_q16 holds */
    uint16_t supply_low_mV; /* mV; 2000 to 48000; below it the device falls to zero force */
    uint16_t supply_high_mV; /* mV; 3000 to 57000; above it the device falls to zero force */
    uint16_t reading_low; /* counts; 0 to 65535; a single reading below it is a broken wire */
    uint16_t reading_high; /* counts; 0 to 65535; a single reading above it is a short */
    uint16_t jump_um16; /* um16 per tick; 160 to 65535; no finger moves the cap further in a tick */
    uint16_t stuck_ticks; /* ticks; 20 to 65535; so many equal sums in a row are a dead sensor */
    uint16_t late_ticks; /* ticks; 1 to 1000; so many ticks missed at once are a fault */
    int16_t over_force_cN64; /* cN64; 64 to 32000; keycap force sensor above it is a fault; unused without one */
    uint16_t full_duty_rise_K; /* K; 1 to 20000; how much warmer the coil would end at full duty held for ever */
    uint16_t derate_start_K; /* K; 1 to 500; rise above which the force limit falls */
    uint16_t heat_limit_K; /* K; 2 to 600; rise at which the force limit has fallen to 0: a fault; above the start */
    uint16_t host_timeout_ms; /* ms; 20 to 5000; silence of the host that ends rendering */
    uint16_t vibration_latency_us; /* us; 0 to 30000; command to first motion of the exciter; the paper's 7000 */
    int16_t stop_us_mm; /* us/mm; -1000 to 1000; servo pulse per travel */
    uint16_t stop_zero_us; /* us; 400 to 2600; servo pulse at travel 0 */
    uint16_t predictor_q16; /* 0 to 65535; 1 - exp(-2 pi bandwidth tick) of the filter that looks ahead; 0: nothing looks ahead, and drag and friction are not taken off */
    uint16_t lead_us; /* us; 0 to 20000; the surface is read where the cap will be after so long */
    uint16_t brake_lead_us; /* us; 0 to 20000; the same for the speed that drag goes by */
    uint16_t drag_q13; /* cN64 per mm_s16; 0 to 49152; taken off the command per speed; the largest is 15 N s/m */
    uint16_t friction_cN64; /* cN64; 0 to 6400; taken off the command in the direction of motion */
    uint16_t friction_mm_s16; /* mm_s16; 64 to 16000; speed from which on friction counts in full, below it in proportion */
    uint32_t spare; /* the settings are 48 bytes times a whole number: their checksum takes twelve words at a time */
    uint8_t reads; /* 1 to 64; converter readings summed per tick; the paper's 25 */
    uint8_t sliding_ticks; /* 1 to 32; ticks of an additional sliding mean; 25 is the paper's literal reading */
    uint8_t fewest_samples; /* 3 to 16; samples that a velocity needs; the paper's 3 */
    uint8_t continuous_samples; /* 3 to 32; samples of the continuous estimate */
} fdvv_settings;
typedef char fdvv_settings_has_96_bytes[sizeof(fdvv_settings) == 96 ? 1 : -1];
#define FDVV_SETTINGS_RANGES(X) \
    X(position_gain_q14, -262143, 262143) \
    X(position_offset_um16, -400000, 400000) \
    X(duty_gain_q16, 64, 1048576) \
    X(force_gain_q14, -262144, 262144) \
    X(force_offset_counts, 0, 65535) \
    X(heat_time_ms, 100, 600000) \
    X(tick_us, 50, 4000) \
    X(window_start_um16, 800, 48000) \
    X(window_end_um16, 1600, 64000) \
    X(reversal_um16, 80, 16000) \
    X(rearm_um16, 80, 16000) \
    X(velocity_scale_q12, 1024, 16384) \
    X(announced_mm_s16, 8, 16000) \
    X(force_limit_cN64, 64, 32000) \
    X(slew_cN64_tick, 16, 32000) \
    X(duty_limit_q15, 1024, 32767) \
    X(nominal_supply_mV, 3000, 48000) \
    X(supply_low_mV, 2000, 48000) \
    X(supply_high_mV, 3000, 57000) \
    X(jump_um16, 160, 65535) \
    X(stuck_ticks, 20, 65535) \
    X(late_ticks, 1, 1000) \
    X(over_force_cN64, 64, 32000) \
    X(full_duty_rise_K, 1, 20000) \
    X(derate_start_K, 1, 500) \
    X(heat_limit_K, 2, 600) \
    X(host_timeout_ms, 20, 5000) \
    X(vibration_latency_us, 0, 30000) \
    X(stop_us_mm, -1000, 1000) \
    X(stop_zero_us, 400, 2600) \
    X(lead_us, 0, 20000) \
    X(brake_lead_us, 0, 20000) \
    X(drag_q13, 0, 49152) \
    X(friction_cN64, 0, 6400) \
    X(friction_mm_s16, 64, 16000) \
    X(spare, 0, 0) \
    X(reads, 1, 64) \
    X(sliding_ticks, 1, 32) \
    X(fewest_samples, 3, 16) \
    X(continuous_samples, 3, 32) \

enum {
    FDVV_SETTINGS_FIELD_position_gain_q14,
    FDVV_SETTINGS_FIELD_position_offset_um16,
    FDVV_SETTINGS_FIELD_duty_gain_q16,
    FDVV_SETTINGS_FIELD_force_gain_q14,
    FDVV_SETTINGS_FIELD_force_offset_counts,
    FDVV_SETTINGS_FIELD_heat_time_ms,
    FDVV_SETTINGS_FIELD_tick_us,
    FDVV_SETTINGS_FIELD_window_start_um16,
    FDVV_SETTINGS_FIELD_window_end_um16,
    FDVV_SETTINGS_FIELD_reversal_um16,
    FDVV_SETTINGS_FIELD_rearm_um16,
    FDVV_SETTINGS_FIELD_velocity_scale_q12,
    FDVV_SETTINGS_FIELD_announced_mm_s16,
    FDVV_SETTINGS_FIELD_force_limit_cN64,
    FDVV_SETTINGS_FIELD_slew_cN64_tick,
    FDVV_SETTINGS_FIELD_duty_limit_q15,
    FDVV_SETTINGS_FIELD_nominal_supply_mV,
    FDVV_SETTINGS_FIELD_supply_low_mV,
    FDVV_SETTINGS_FIELD_supply_high_mV,
    FDVV_SETTINGS_FIELD_reading_low,
    FDVV_SETTINGS_FIELD_reading_high,
    FDVV_SETTINGS_FIELD_jump_um16,
    FDVV_SETTINGS_FIELD_stuck_ticks,
    FDVV_SETTINGS_FIELD_late_ticks,
    FDVV_SETTINGS_FIELD_over_force_cN64,
    FDVV_SETTINGS_FIELD_full_duty_rise_K,
    FDVV_SETTINGS_FIELD_derate_start_K,
    FDVV_SETTINGS_FIELD_heat_limit_K,
    FDVV_SETTINGS_FIELD_host_timeout_ms,
    FDVV_SETTINGS_FIELD_vibration_latency_us,
    FDVV_SETTINGS_FIELD_stop_us_mm,
    FDVV_SETTINGS_FIELD_stop_zero_us,
    FDVV_SETTINGS_FIELD_predictor_q16,
    FDVV_SETTINGS_FIELD_lead_us,
    FDVV_SETTINGS_FIELD_brake_lead_us,
    FDVV_SETTINGS_FIELD_drag_q13,
    FDVV_SETTINGS_FIELD_friction_cN64,
    FDVV_SETTINGS_FIELD_friction_mm_s16,
    FDVV_SETTINGS_FIELD_spare,
    FDVV_SETTINGS_FIELD_reads,
    FDVV_SETTINGS_FIELD_sliding_ticks,
    FDVV_SETTINGS_FIELD_fewest_samples,
    FDVV_SETTINGS_FIELD_continuous_samples,
    FDVV_SETTINGS_FIELDS,
};


/* what a board was built for: settings may be tighter, and only another build is looser */
typedef struct {
    uint32_t heat_time_ms; /* ms; 100 to 600000; thermal time constant of the coil */
    int32_t duty_gain_q16; /* Q15 duty per cN64; 64 to 1048576; largest at the nominal supply, with room for calibration: what a cN of the force limit may be */
    uint16_t nominal_supply_mV; /* mV; 3000 to 48000; supply at which duty_gain_q16 and full_duty_rise_K hold */
    uint16_t supply_high_mV; /* mV; 3000 to 57000; largest */
    int16_t force_limit_cN64; /* cN64; 64 to 32000; largest */
    uint16_t duty_limit_q15; /* Q15; 1024 to 32767; largest */
    uint16_t full_duty_rise_K; /* K; 1 to 16383; least: rise of the coil at full duty and nominal supply held for ever, copper at the heat limit */
    uint16_t heat_limit_K; /* K; 2 to 600; largest */
    uint16_t host_timeout_ms; /* ms; 20 to 5000; longest */
    uint16_t tick_low_us; /* us; 50 to 4000; shortest tick */
    uint16_t tick_high_us; /* us; 50 to 4000; longest tick */
    uint16_t thermistor_lag_ms; /* ms; 0 to 60000; longest lag of the thermistor behind the coil, at least 500; 0: none is fitted */
    uint16_t thermistor_share_q8; /* 64 to 256; least rise of the thermistor per rise of the coil, once the lag has passed */
    uint16_t spare; /*  */
} fdvv_board_limits;
typedef char fdvv_board_limits_has_32_bytes[sizeof(fdvv_board_limits) == 32 ? 1 : -1];
#define FDVV_BOARD_LIMITS_RANGES(X) \
    X(heat_time_ms, 100, 600000) \
    X(duty_gain_q16, 64, 1048576) \
    X(nominal_supply_mV, 3000, 48000) \
    X(supply_high_mV, 3000, 57000) \
    X(force_limit_cN64, 64, 32000) \
    X(duty_limit_q15, 1024, 32767) \
    X(full_duty_rise_K, 1, 16383) \
    X(heat_limit_K, 2, 600) \
    X(host_timeout_ms, 20, 5000) \
    X(tick_low_us, 50, 4000) \
    X(tick_high_us, 50, 4000) \
    X(thermistor_lag_ms, 0, 60000) \
    X(thermistor_share_q8, 64, 256) \
    X(spare, 0, 0) \


/* first bytes of a program; the checksum covers everything after itself */
typedef struct {
    uint32_t magic; /* 0 to 4294967295; FDVP */
    uint32_t crc32; /* 0 to 4294967295; of all that follows, zlib's polynomial */
    int32_t travel_um16; /* um16; 1600 to 320000; where the bottom stop is set */
    uint16_t size_bytes; /* bytes; 32 to 7168; whole image, a multiple of 4 */
    uint8_t version; /* 1 to 1; layout */
    uint8_t start_state; /* 0 to 15; entered on activation and on arming */
    uint8_t states; /* 1 to 16; how many follow the header */
    uint8_t transitions; /* 0 to 48; how many follow the states */
    uint8_t surfaces; /* 1 to 16; how many follow the transitions */
    uint8_t vibrations; /* 0 to 32; how many follow the surfaces */
    uint8_t slots; /* 0 to 16; how many follow the vibrations; velocities, forces and waves follow in any order */
    uint8_t spare; /*  */
    uint8_t name[10]; /* ASCII; 0 to 126; for people, padded with zeros */
} fdvv_image_header;
typedef char fdvv_image_header_has_32_bytes[sizeof(fdvv_image_header) == 32 ? 1 : -1];
#define FDVV_IMAGE_HEADER_RANGES(X) \
    X(travel_um16, 1600, 320000) \
    X(size_bytes, 32, 7168) \
    X(version, 1, 1) \
    X(start_state, 0, 15) \
    X(states, 1, 16) \
    X(transitions, 0, 48) \
    X(surfaces, 1, 16) \
    X(vibrations, 0, 32) \
    X(slots, 0, 16) \
    X(spare, 0, 0) \


/* a force surface per stroke, an optional change over time, and what to report */
typedef struct {
    uint8_t press_surface; /* 0 to 15; looked up while pressing */
    uint8_t release_surface; /* 0 to 15; looked up while releasing */
    uint8_t velocity_source; /* 0 to 2; which velocity chooses the row */
    uint8_t key; /* 0 to 255; reported to the host: 0 up, else the level that is down */
    uint8_t first_transition; /* 0 to 48; of this state's run of transitions; the first that holds fires */
    uint8_t transitions; /* 0 to 48; how many */
    uint8_t enter_slot; /* 0 to 255; waveform played on entering, or none */
    uint8_t repeat_slot; /* 0 to 255; waveform played again and again while in this state, or none */
    uint16_t repeat_ms; /* ms; 0 to 65535; its period; 0 with none */
    uint16_t fade_ms; /* ms; 0 to 2000; the command moves from the last state's to this one's in this time */
    int16_t bias_cN64; /* cN64; -32000 to 32000; added to the surface's force */
    int16_t bias_end_cN64; /* cN64; -32000 to 32000; what the bias has become after bias_ms */
    uint16_t bias_ms; /* ms; 0 to 65535; time over which the bias changes; 0: it is bias_cN64 */
    uint16_t spare; /*  */
} fdvv_state;
typedef char fdvv_state_has_20_bytes[sizeof(fdvv_state) == 20 ? 1 : -1];
#define FDVV_STATE_RANGES(X) \
    X(press_surface, 0, 15) \
    X(release_surface, 0, 15) \
    X(velocity_source, 0, 2) \
    X(first_transition, 0, 48) \
    X(transitions, 0, 48) \
    X(fade_ms, 0, 2000) \
    X(bias_cN64, -32000, 32000) \
    X(bias_end_cN64, -32000, 32000) \
    X(spare, 0, 0) \


/* leads to another state when condition and guard both hold; at most one fires per tick */
typedef struct {
    uint8_t condition; /* 0 to 10; when */
    uint8_t guard; /* 0 to 10; and only if (always: no guard) */
    uint8_t target; /* 0 to 15; state to enter */
    uint8_t slot; /* 0 to 255; waveform played on the way, or none */
    int32_t value; /* as the condition says; -2147483648 to 2147483647 */
    int32_t guard_value; /* as the guard says; -2147483648 to 2147483647 */
} fdvv_transition;
typedef char fdvv_transition_has_12_bytes[sizeof(fdvv_transition) == 12 ? 1 : -1];
#define FDVV_TRANSITION_RANGES(X) \
    X(condition, 0, 10) \
    X(guard, 0, 10) \
    X(target, 0, 15) \


/* force on displacement and velocity, bilinear, held beyond its edges */
typedef struct {
    int32_t start_um16; /* um16; -32000 to 320000; displacement of the first column */
    uint16_t step_um16; /* um16; 16 to 16000; between two columns */
    uint8_t columns; /* 2 to 255; displacements */
    uint8_t rows; /* 1 to 16; velocities, rising */
    uint16_t velocities_at; /* bytes; 32 to 7168; offset in the image of u16 mm_s16 per row, a multiple of 2 */
    uint16_t forces_at; /* bytes; 32 to 7168; offset in the image of i16 cN64, row after row, a multiple of 2 */
} fdvv_surface;
typedef char fdvv_surface_has_12_bytes[sizeof(fdvv_surface) == 12 ? 1 : -1];
#define FDVV_SURFACE_RANGES(X) \
    X(start_um16, -32000, 320000) \
    X(step_um16, 16, 16000) \
    X(columns, 2, 255) \
    X(rows, 1, 16) \
    X(velocities_at, 32, 7168) \
    X(forces_at, 32, 7168) \


/* a waveform started at a displacement, led by the board's latency at the current velocity; once per stroke */
typedef struct {
    int32_t at_um16; /* um16; -32000 to 320000; displacement of the onset */
    uint16_t slowest_mm_s16; /* mm_s16; 0 to 65535; fires only at or above this velocity */
    uint16_t fastest_mm_s16; /* mm_s16; 0 to 65535; and below this one */
    uint16_t states; /* 0 to 65535; a bit for every state in which it fires */
    uint8_t stroke; /* 0 to 2; in which direction */
    uint8_t slot; /* 0 to 15; waveform */
} fdvv_vibration;
typedef char fdvv_vibration_has_12_bytes[sizeof(fdvv_vibration) == 12 ? 1 : -1];
#define FDVV_VIBRATION_RANGES(X) \
    X(at_um16, -32000, 320000) \
    X(stroke, 0, 2) \
    X(slot, 0, 15) \


/* a waveform of the vibration board, forwarded to it when the program is activated */
typedef struct {
    uint8_t waveform; /* 0 to 1; decaying sine or sampled */
    uint8_t spare; /*  */
    uint16_t frequency_Hz16; /* 1/16 Hz; 0 to 65535; of the sine; playback rate of a sampled wave */
    uint16_t duration_samples; /* 1/16000 s; 1 to 65535; after it, silence */
    uint16_t amplitude_counts; /* counts of a 12-bit converter; 0 to 2047; at the start */
    uint16_t decay_q16; /* per 32 samples; 0 to 65535; amplitude after 32 samples over amplitude before */
    uint16_t wave_at; /* bytes; 0 to 7168; offset in the image of i8 samples; 0 for a sine */
    uint16_t wave_samples; /* 0 to 512; how many; 0 for a sine */
    uint16_t spare2; /*  */
} fdvv_slot;
typedef char fdvv_slot_has_16_bytes[sizeof(fdvv_slot) == 16 ? 1 : -1];
#define FDVV_SLOT_RANGES(X) \
    X(waveform, 0, 1) \
    X(spare, 0, 0) \
    X(duration_samples, 1, 65535) \
    X(amplitude_counts, 0, 2047) \
    X(wave_at, 0, 7168) \
    X(wave_samples, 0, 512) \
    X(spare2, 0, 0) \


/* one tick as telemetry tells it */
typedef struct {
    int32_t displacement_um16; /* um16; -2147483648 to 2147483647; as sensed */
    int16_t velocity_mm_s16; /* mm_s16; -32768 to 32767; of the continuous estimate, positive downward */
    int16_t commanded_cN64; /* cN64; -32768 to 32767; after all limits */
    int16_t force_cN64; /* cN64; -32768 to 32767; of the keycap force sensor; 0 without one */
    uint8_t state; /* 0 to 15; of the program */
    uint8_t flags; /* 0 to 255; bits of flags.tick */
} fdvv_tick_record;
typedef char fdvv_tick_record_has_12_bytes[sizeof(fdvv_tick_record) == 12 ? 1 : -1];
#define FDVV_TICK_RECORD_RANGES(X) \
    X(state, 0, 15) \


/* what was so when a fault was latched */
typedef struct {
    uint32_t time_us; /* us; 0 to 4294967295; device clock */
    uint32_t tick; /* ticks; 0 to 4294967295; since boot */
    int32_t value; /* as the fault says; -2147483648 to 2147483647; what was found */
    int32_t bound; /* as the fault says; -2147483648 to 2147483647; what was allowed */
    int32_t displacement_um16; /* um16; -2147483648 to 2147483647 */
    int16_t commanded_cN64; /* cN64; -32768 to 32767; before it fell to zero */
    uint8_t state; /* 0 to 255; of the program */
    uint8_t mode; /* 0 to 5; before the fault */
} fdvv_evidence;
typedef char fdvv_evidence_has_24_bytes[sizeof(fdvv_evidence) == 24 ? 1 : -1];
#define FDVV_EVIDENCE_RANGES(X) \
    X(mode, 0, 5) \


/* who are you; must be the first request (request) */
typedef struct {
    uint16_t version; /* 0 to 65535 */
    uint16_t spare; /*  */
    uint32_t hash; /* 0 to 4294967295; of this definition */
} fdvv_hello_request;
typedef char fdvv_hello_request_has_8_bytes[sizeof(fdvv_hello_request) == 8 ? 1 : -1];
#define FDVV_HELLO_REQUEST_RANGES(X) \
    X(spare, 0, 0) \


/* who are you; must be the first request (reply) */
typedef struct {
    uint32_t hash; /* 0 to 4294967295; of the definition the device was built from */
    uint32_t firmware; /* 0 to 4294967295; version, major.minor.patch in bytes 2, 1, 0 */
    uint32_t serial; /* 0 to 4294967295; of the board */
    uint16_t image_bytes; /* bytes; 0 to 65535; largest program */
    uint16_t travel_um16_256; /* 256 um16; 0 to 65535; deepest stop */
    uint16_t tick_us; /* us; 0 to 65535 */
    uint8_t board_flags; /* 0 to 255; bits of flags.board */
    uint8_t mode; /* 0 to 5 */
    uint8_t name[16]; /* ASCII; 0 to 126; kind of board */
} fdvv_hello_reply;
typedef char fdvv_hello_reply_has_36_bytes[sizeof(fdvv_hello_reply) == 36 ? 1 : -1];
#define FDVV_HELLO_REPLY_RANGES(X) \
    X(mode, 0, 5) \


/* I am here; feeds the host watch and relates the clocks (request) */
typedef struct {
    uint32_t host_us; /* us; 0 to 4294967295; echoed */
} fdvv_ping_request;
typedef char fdvv_ping_request_has_4_bytes[sizeof(fdvv_ping_request) == 4 ? 1 : -1];
#define FDVV_PING_REQUEST_RANGES(X) \


/* I am here; feeds the host watch and relates the clocks (reply) */
typedef struct {
    uint32_t host_us; /* us; 0 to 4294967295 */
    uint32_t device_us; /* us; 0 to 4294967295; when the request had arrived */
    uint32_t tick; /* ticks; 0 to 4294967295 */
    uint8_t mode; /* 0 to 5 */
    uint8_t fault; /* 0 to 255 */
    uint16_t heat_K; /* K; 0 to 65535; modelled rise of the coil */
} fdvv_ping_reply;
typedef char fdvv_ping_reply_has_16_bytes[sizeof(fdvv_ping_reply) == 16 ? 1 : -1];
#define FDVV_PING_REPLY_RANGES(X) \
    X(mode, 0, 5) \


/* a program follows into the bank that is not active; forgets an unfinished one (request) */
typedef struct {
    uint16_t size_bytes; /* bytes; 0 to 65535 */
    uint16_t spare; /*  */
    uint32_t crc32; /* 0 to 4294967295; as in the image */
} fdvv_begin_request;
typedef char fdvv_begin_request_has_8_bytes[sizeof(fdvv_begin_request) == 8 ? 1 : -1];
#define FDVV_BEGIN_REQUEST_RANGES(X) \
    X(spare, 0, 0) \


/* the next bytes of the program; a repeated offset is accepted if the bytes are the same (request) */
typedef struct {
    uint16_t offset; /* bytes; 0 to 65535; must be where the last one ended */
    uint16_t count; /* bytes; 1 to 192 */
    uint8_t bytes[192]; /* 0 to 255; only count of them are sent */
} fdvv_data_request;
typedef char fdvv_data_request_has_196_bytes[sizeof(fdvv_data_request) == 196 ? 1 : -1];
#define FDVV_DATA_REQUEST_RANGES(X) \
    X(count, 1, 192) \


/* the next bytes of the program; a repeated offset is accepted if the bytes are the same (reply) */
typedef struct {
    uint16_t received; /* bytes; 0 to 65535; so far */
    uint16_t spare; /*  */
} fdvv_data_reply;
typedef char fdvv_data_reply_has_4_bytes[sizeof(fdvv_data_reply) == 4 ? 1 : -1];
#define FDVV_DATA_REPLY_RANGES(X) \
    X(spare, 0, 0) \


/* something happened that the program may wait for (request) */
typedef struct {
    uint8_t event; /* 0 to 31 */
    uint8_t spare; /*  */
} fdvv_event_request;
typedef char fdvv_event_request_has_2_bytes[sizeof(fdvv_event_request) == 2 ? 1 : -1];
#define FDVV_EVENT_REQUEST_RANGES(X) \
    X(event, 0, 31) \
    X(spare, 0, 0) \


/* send a record of every n-th tick (request) */
typedef struct {
    uint8_t every; /* ticks; 0 to 255; 0: none */
    uint8_t spare; /*  */
} fdvv_telemetry_request;
typedef char fdvv_telemetry_request_has_2_bytes[sizeof(fdvv_telemetry_request) == 2 ? 1 : -1];
#define FDVV_TELEMETRY_REQUEST_RANGES(X) \
    X(spare, 0, 0) \


/* why are you in fault (reply) */
typedef struct {
    uint8_t fault; /* 0 to 255 */
    uint8_t spare; /*  */
    uint16_t count; /* 0 to 65535; faults since boot */
    uint32_t time_us; /* us; 0 to 4294967295; evidence from here */
    uint32_t tick; /* ticks; 0 to 4294967295 */
    int32_t value; /* -2147483648 to 2147483647 */
    int32_t bound; /* -2147483648 to 2147483647 */
    int32_t displacement_um16; /* um16; -2147483648 to 2147483647 */
    int16_t commanded_cN64; /* cN64; -32768 to 32767 */
    uint8_t state; /* 0 to 255 */
    uint8_t mode; /* 0 to 5 */
} fdvv_read_fault_reply;
typedef char fdvv_read_fault_reply_has_28_bytes[sizeof(fdvv_read_fault_reply) == 28 ? 1 : -1];
#define FDVV_READ_FAULT_REPLY_RANGES(X) \
    X(spare, 0, 0) \
    X(mode, 0, 5) \


/* the fault is understood; back to idle if its cause is gone (request) */
typedef struct {
    uint8_t fault; /* 0 to 255; must be the latched one */
    uint8_t spare; /*  */
} fdvv_clear_fault_request;
typedef char fdvv_clear_fault_request_has_2_bytes[sizeof(fdvv_clear_fault_request) == 2 ? 1 : -1];
#define FDVV_CLEAR_FAULT_REQUEST_RANGES(X) \
    X(spare, 0, 0) \


/* test your parts; idle only (reply) */
typedef struct {
    uint8_t verdicts[8]; /* 0 to 3; by part */
    uint8_t values[16]; /* 0 to 255; eight i16, what was found, as the part says */
} fdvv_selftest_reply;
typedef char fdvv_selftest_reply_has_24_bytes[sizeof(fdvv_selftest_reply) == 24 ? 1 : -1];
#define FDVV_SELFTEST_REPLY_RANGES(X) \


/* what went wrong so far (reply) */
typedef struct {
    uint32_t ticks; /* ticks; 0 to 4294967295 */
    uint32_t late; /* ticks; 0 to 4294967295; missed or served too late */
    uint32_t frames; /* 0 to 4294967295; received whole */
    uint32_t bad_frames; /* 0 to 4294967295; checksum, stuffing or length wrong */
    uint32_t refused; /* 0 to 4294967295; requests */
    uint32_t lost_records; /* 0 to 4294967295; telemetry for which there was no room */
    uint32_t worst_tick_us; /* us; 0 to 4294967295; from the tick to the new duty */
    uint32_t vibration_errors; /* 0 to 4294967295; of the vibration board and its wire */
} fdvv_read_counters_reply;
typedef char fdvv_read_counters_reply_has_32_bytes[sizeof(fdvv_read_counters_reply) == 32 ? 1 : -1];
#define FDVV_READ_COUNTERS_REPLY_RANGES(X) \


/* the next press is meant to be this fast (request) */
typedef struct {
    uint16_t velocity_mm_s16; /* mm_s16; 8 to 16000 */
    uint16_t spare; /*  */
} fdvv_announce_request;
typedef char fdvv_announce_request_has_4_bytes[sizeof(fdvv_announce_request) == 4 ? 1 : -1];
#define FDVV_ANNOUNCE_REQUEST_RANGES(X) \
    X(velocity_mm_s16, 8, 16000) \
    X(spare, 0, 0) \


/* play a waveform of the active program now (request) */
typedef struct {
    uint8_t slot; /* 0 to 15 */
    uint8_t spare; /*  */
} fdvv_vibrate_request;
typedef char fdvv_vibrate_request_has_2_bytes[sizeof(fdvv_vibrate_request) == 2 ? 1 : -1];
#define FDVV_VIBRATE_REQUEST_RANGES(X) \
    X(slot, 0, 15) \
    X(spare, 0, 0) \


/* how warm is the coil (reply) */
typedef struct {
    uint16_t heat_K; /* K; 0 to 65535; most that the coil's rise can be, rounded down */
    uint16_t thermistor_K; /* K; 0 to 65535; its last reading as a rise of the coil above a room of 15 C; 65535: none fitted, or not read yet */
    uint16_t thermistor_counts; /* counts; 0 to 65535; of its converter, at the last reading */
    uint16_t spare; /*  */
} fdvv_read_coil_reply;
typedef char fdvv_read_coil_reply_has_8_bytes[sizeof(fdvv_read_coil_reply) == 8 ? 1 : -1];
#define FDVV_READ_COIL_REPLY_RANGES(X) \
    X(spare, 0, 0) \


/* reply to a request that was not carried out (sent as id + 0x80) (reply) */
typedef struct {
    uint8_t request; /* 0 to 255; id */
    uint8_t refusal; /* 0 to 255 */
    uint16_t detail; /* 0 to 65535; where: offset or number of the field */
} fdvv_refused_reply;
typedef char fdvv_refused_reply_has_4_bytes[sizeof(fdvv_refused_reply) == 4 ? 1 : -1];
#define FDVV_REFUSED_REPLY_RANGES(X) \


/* telemetry; only count of the records are sent (request) */
typedef struct {
    uint32_t first_tick; /* ticks; 0 to 4294967295; of the first record */
    uint32_t first_us; /* us; 0 to 4294967295; device clock of that tick */
    uint32_t late; /* ticks; 0 to 4294967295; since boot */
    uint32_t lost; /* 0 to 4294967295; records since boot for which there was no room */
    uint8_t every; /* ticks; 1 to 255; between two records */
    uint8_t count; /* 1 to 16; records */
    uint8_t mode; /* 0 to 5 */
    uint8_t key; /* 0 to 255; reported by the current state */
} fdvv_records_request;
typedef char fdvv_records_request_has_20_bytes[sizeof(fdvv_records_request) == 20 ? 1 : -1];
#define FDVV_RECORDS_REQUEST_RANGES(X) \
    X(every, 1, 255) \
    X(count, 1, 16) \
    X(mode, 0, 5) \


/* a fault was latched; read_fault has the evidence (request) */
typedef struct {
    uint8_t fault; /* 0 to 255 */
    uint8_t mode; /* 0 to 5; before */
    uint16_t spare; /*  */
    uint32_t time_us; /* us; 0 to 4294967295 */
} fdvv_faulted_request;
typedef char fdvv_faulted_request_has_8_bytes[sizeof(fdvv_faulted_request) == 8 ? 1 : -1];
#define FDVV_FAULTED_REQUEST_RANGES(X) \
    X(mode, 0, 5) \
    X(spare, 0, 0) \


/* the reported key changed (request) */
typedef struct {
    uint8_t key; /* 0 to 255 */
    uint8_t state; /* 0 to 15 */
    uint16_t spare; /*  */
    uint32_t tick; /* ticks; 0 to 4294967295 */
    uint32_t time_us; /* us; 0 to 4294967295 */
} fdvv_key_request;
typedef char fdvv_key_request_has_12_bytes[sizeof(fdvv_key_request) == 12 ? 1 : -1];
#define FDVV_KEY_REQUEST_RANGES(X) \
    X(state, 0, 15) \
    X(spare, 0, 0) \


/* name, id, bytes of the request (or of what is sent unasked), bytes of the reply */
#define FDVV_MESSAGES(X) \
    X(HELLO, 0x01, 8, 36) \
    X(PING, 0x02, 4, 16) \
    X(READ_SETTINGS, 0x03, 0, 96) \
    X(WRITE_SETTINGS, 0x04, 96, 0) \
    X(BEGIN, 0x05, 8, 0) \
    X(DATA, 0x06, 196, 4) \
    X(COMMIT, 0x07, 0, 0) \
    X(ACTIVATE, 0x08, 0, 0) \
    X(ARM, 0x09, 0, 0) \
    X(DISARM, 0x0a, 0, 0) \
    X(EVENT, 0x0b, 2, 0) \
    X(TELEMETRY, 0x0c, 2, 0) \
    X(READ_FAULT, 0x0d, 0, 28) \
    X(CLEAR_FAULT, 0x0e, 2, 0) \
    X(SELFTEST, 0x0f, 0, 24) \
    X(READ_COUNTERS, 0x10, 0, 32) \
    X(ANNOUNCE, 0x11, 4, 0) \
    X(VIBRATE, 0x12, 2, 0) \
    X(READ_LIMITS, 0x17, 0, 32) \
    X(READ_COIL, 0x18, 0, 8) \
    X(REFUSED, 0x7f, 0, 4) \
    X(RECORDS, 0xc0, 20, 0) \
    X(FAULTED, 0xc1, 8, 0) \
    X(KEY, 0xc2, 12, 0) \

enum {
    FDVV_MSG_HELLO = 0x01, /* who are you; must be the first request */
    FDVV_MSG_PING = 0x02, /* I am here; feeds the host watch and relates the clocks */
    FDVV_MSG_READ_SETTINGS = 0x03, /* report the settings */
    FDVV_MSG_WRITE_SETTINGS = 0x04, /* use these; while idle or in fault, all or none */
    FDVV_MSG_BEGIN = 0x05, /* a program follows into the bank that is not active; forgets an unfinished one */
    FDVV_MSG_DATA = 0x06, /* the next bytes of the program; a repeated offset is accepted if the bytes are the same */
    FDVV_MSG_COMMIT = 0x07, /* check what was received: checksum, layout, ranges; answers when done */
    FDVV_MSG_ACTIVATE = 0x08, /* make the checked program the active one between two ticks */
    FDVV_MSG_ARM = 0x09, /* render the active program */
    FDVV_MSG_DISARM = 0x0a, /* zero force */
    FDVV_MSG_EVENT = 0x0b, /* something happened that the program may wait for */
    FDVV_MSG_TELEMETRY = 0x0c, /* send a record of every n-th tick */
    FDVV_MSG_READ_FAULT = 0x0d, /* why are you in fault */
    FDVV_MSG_CLEAR_FAULT = 0x0e, /* the fault is understood; back to idle if its cause is gone */
    FDVV_MSG_SELFTEST = 0x0f, /* test your parts; idle only */
    FDVV_MSG_READ_COUNTERS = 0x10, /* what went wrong so far */
    FDVV_MSG_ANNOUNCE = 0x11, /* the next press is meant to be this fast */
    FDVV_MSG_VIBRATE = 0x12, /* play a waveform of the active program now */
    FDVV_MSG_READ_LIMITS = 0x17, /* report what the board was built for */
    FDVV_MSG_READ_COIL = 0x18, /* how warm is the coil */
    FDVV_MSG_REFUSED = 0x7f, /* reply to a request that was not carried out (sent as id + 0x80) */
    FDVV_MSG_RECORDS = 0xc0, /* telemetry; only count of the records are sent */
    FDVV_MSG_FAULTED = 0xc1, /* a fault was latched; read_fault has the evidence */
    FDVV_MSG_KEY = 0xc2, /* the reported key changed */
};

#define FDVV_SETTINGS_DEFAULTS \
    { \
        32512, /* position_gain_q14 */ \
        -101600, /* position_offset_um16 */ \
        20793, /* duty_gain_q16 */ \
        0, /* force_gain_q14 */ \
        0, /* force_offset_counts */ \
        60000, /* heat_time_ms */ \
        250, /* tick_us */ \
        8000, /* window_start_um16 */ \
        16000, /* window_end_um16 */ \
        1600, /* reversal_um16 */ \
        1600, /* rearm_um16 */ \
        4915, /* velocity_scale_q12 */ \
        1600, /* announced_mm_s16 */ \
        28160, /* force_limit_cN64 */ \
        4000, /* slew_cN64_tick */ \
        32767, /* duty_limit_q15 */ \
        12000, /* nominal_supply_mV */ \
        9000, /* supply_low_mV */ \
        14000, /* supply_high_mV */ \
        20, /* reading_low */ \
        4075, /* reading_high */ \
        8000, /* jump_um16 */ \
        2000, /* stuck_ticks */ \
        4, /* late_ticks */ \
        32000, /* over_force_cN64 */ \
        596, /* full_duty_rise_K */ \
        60, /* derate_start_K */ \
        90, /* heat_limit_K */ \
        250, /* host_timeout_ms */ \
        1000, /* vibration_latency_us */ \
        150, /* stop_us_mm */ \
        1000, /* stop_zero_us */ \
        0, /* predictor_q16 */ \
        0, /* lead_us */ \
        0, /* brake_lead_us */ \
        0, /* drag_q13 */ \
        0, /* friction_cN64 */ \
        160, /* friction_mm_s16 */ \
        0, /* spare */ \
        25, /* reads */ \
        1, /* sliding_ticks */ \
        3, /* fewest_samples */ \
        8, /* continuous_samples */ \
    }

#endif
