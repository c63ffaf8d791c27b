/* The thermistor at the coil: from its readings, a bound on how warm the coil is. */
#ifndef FDVV_THERMISTOR_H
#define FDVV_THERMISTOR_H

#include "protocol.h"

enum {
    FDVV_THERMISTOR_TICKS = 100,     /* between two samples */
    FDVV_THERMISTOR_SHORT = 64,      /* counts: below it, beyond 175 C, it is shorted */
    FDVV_THERMISTOR_OPEN = 3900,     /* above it, below -30 C, it is open */
    FDVV_THERMISTOR_COLD_K = 10      /* so much colder than half of what the coil should warm it is a fault */
};

/* what is wrong with it */
enum {
    FDVV_THERMISTOR_IS_OPEN = 1 << 0,
    FDVV_THERMISTOR_IS_SHORT = 1 << 1,
    FDVV_THERMISTOR_JUMPS = 1 << 2,
    FDVV_THERMISTOR_IS_COLD = 1 << 3
};

typedef struct {
    uint64_t load_K_q16;      /* sum of the rises at which the duties of the ticks since the last sample would end */
    uint32_t end_K_q16;       /* that of the last tick */
    uint32_t excess_K_q16;    /* the coil is warmer than its reading by no more than this */
    uint32_t least_K_q16;     /* half of the rise that the coil should have */
    uint32_t follower_K_q16;  /* the same behind the lag */
    uint32_t reading_K_q16;   /* the last one: rise that the coil would have after the lag; never too cold */
    uint32_t keep_q32;        /* part of the excess that is left after a sample */
    uint32_t warming_q32;     /* part of load_K_q16 that warms least_K_q16 */
    uint32_t cooling_q32;     /* part of least_K_q16 that is lost from sample to sample */
    uint32_t share_1_q16;     /* greatest rise of the coil per rise of the thermistor */
    uint32_t jump_K_q16;      /* no reading changes by more from sample to sample */
    int16_t value, bound;     /* evidence of `faults` */
    uint16_t ticks;           /* since the last sample */
    uint16_t counts;          /* of the last sample */
    uint8_t is_fitted;
    uint8_t is_known;         /* excess_K_q16 and reading_K_q16 are valid */
    uint8_t faults;           /* bits FDVV_THERMISTOR_… of the last sample */
} fdvv_thermistor;

#ifdef FDVV_NO_THERMISTOR /* a board that is built for a rig without one, to save its flash */
#define FDVV_THERMISTOR(supervisor, field) 0
#else
#define FDVV_THERMISTOR(supervisor, field) ((supervisor)->heat.thermistor.field)

/* Use this tick and these limits. heating_q32: as in the thermal model, of the ticks so far. */
void fdvv_thermistor_set(fdvv_thermistor *thermistor, const fdvv_board_limits *limits, const fdvv_settings *settings,
                         uint32_t heating_q32);

/* Take a sample, and return the bound on the coil's rise, which so far was heat_K_q16. The coil is warmer than the
 * thermistor says by an excess that falls with the lag, and grows by no more than the drive warms the coil:
 *
 *   excess <- excess exp(-t / lag) + load t / time,   bound <- reading + excess, or heat_K_q16 if that is lower
 *
 * and it is at least as warm as the thermistor. After a fault the excess begins anew, with all that heat_K_q16 allows. */
uint32_t fdvv_thermistor_sample(fdvv_thermistor *thermistor, uint16_t counts, uint32_t heat_K_q16, uint32_t heating_q32);
#endif

#endif
