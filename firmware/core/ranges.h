/* Range check of signed and unsigned fields. */
#ifndef FDVV_RANGES_H
#define FDVV_RANGES_H

#include <stdint.h>

static inline uint8_t fdvv_outside(int32_t value, int32_t low, int32_t high)
{
    return value < low || value > high;
}

#endif
