/* How warm the coil can be: a thermal model that is never cooler than the coil, bounded by a thermistor where one is
 * fitted. */
#ifndef FDVV_HEAT_H
#define FDVV_HEAT_H

#include "thermistor.h"

typedef struct {
    uint32_t coil_K_q16;      /* temperature rise of the coil, from the thermal model */
    uint32_t coil_rest_q48;   /* the bits below those of coil_K_q16 */
    uint32_t end_K_q16;       /* rise at which the duty of the last tick would end */
    uint32_t heating_q32;     /* part of the way to end_K_q16 in a tick, rounded up */
    uint32_t cooling_q32;     /* the same on the way down, rounded down */
    uint32_t rise_K_mV_q16;   /* rise_K grows by it with every mV above the nominal supply */
    uint32_t late_K_q16;      /* by which full duty may warm the coil before the next two ticks, late as they may be */
    uint16_t rise_K;          /* at full duty and nominal supply, for ever */
    uint16_t nominal_supply_mV; /* of the board */
#ifndef FDVV_NO_THERMISTOR
    fdvv_thermistor thermistor;
#endif
} fdvv_heat;

/* The heat over a reset, in memory that start-up leaves alone. */
typedef struct {
    uint32_t coil_K_q16;
    uint32_t check;           /* ~coil_K_q16 */
} fdvv_kept_heat;

/* Use these limits and checked settings; the coil stays as warm as it is. */
void fdvv_heat_set(fdvv_heat *heat, const fdvv_board_limits *limits, const fdvv_settings *settings);

/* Advance the model to the end of the tick that begins with this duty at this supply; ticks missed before it had the
 * duty of the last call. */
void fdvv_heat_tick(fdvv_heat *heat, int16_t duty_q15, uint16_t supply_mV, uint16_t elapsed_ticks);

/* After fdvv_heat_tick, with the same ticks: where a thermistor is fitted, bound the heat by its reading, once in
 * FDVV_THERMISTOR_TICKS. */
void fdvv_heat_thermistor(fdvv_heat *heat, uint16_t counts, uint16_t elapsed_ticks);

/* After every tick: keep the heat, and a kelvin for what the coil may get until the watchdog resets a stopped board. */
void fdvv_heat_keep(const fdvv_heat *heat, fdvv_kept_heat *kept);

/* After a reset: go on with the heat that was kept. Where none was, as after a power cut, the coil may be as warm as a
 * coil of this board can be: start just below the limit of the board, at which there is no force. */
void fdvv_heat_resume(fdvv_heat *heat, const fdvv_board_limits *limits, const fdvv_kept_heat *kept);

#endif
