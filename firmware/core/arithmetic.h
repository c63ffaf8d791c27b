/* Division by multiplication: no division, no float, every rounding defined.
 *
 * Right shifts of negative numbers are taken to be arithmetic, as every compiler used here makes them. */
#ifndef FDVV_ARITHMETIC_H
#define FDVV_ARITHMETIC_H

#include <stdint.h>

typedef char fdvv_right_shifts_keep_the_sign[(-1 >> 1) == -1 ? 1 : -1];

#define FDVV_ONE_Q15 32768

/* mantissa / 2^shift; the mantissa has its highest bit set */
typedef struct {
    uint16_t mantissa;
    int16_t shift;
} fdvv_ratio;

/* The largest ratio not above value; value is at least 1. */
fdvv_ratio fdvv_ratio_of(uint32_t value);
fdvv_ratio fdvv_ratio_of_wide(uint64_t value);

/* 1 / ratio, wrong by 5e-5 of it at most; powers of two exactly. */
fdvv_ratio fdvv_ratio_inverse(fdvv_ratio ratio);

/* one * other, cut to 16 bits: wrong by 2^-15 of it at most. */
fdvv_ratio fdvv_ratio_product(fdvv_ratio one, fdvv_ratio other);

/* value * ratio to the nearest integer, halves away from zero. With a shift below 17, |value| * 2^(17 - shift)
 * must stay below 2^31. */
int32_t fdvv_scale(int32_t value, fdvv_ratio ratio);

/* The same for |value| below 2^16 and a shift of 1 to 32. */
int32_t fdvv_scale_short(int32_t value, fdvv_ratio ratio);

/* way / whole in Q15 for 0 <= way < whole < 2^26, cut, wrong by 5e-5 and, from 2^16 on, 2^-11 at most. */
int32_t fdvv_part_q15(uint32_t way, uint32_t whole);

/* one * other without the compiler's library. */
uint64_t fdvv_wide_product(uint32_t one, uint32_t other);

static inline int32_t fdvv_clamp(int32_t value, int32_t low, int32_t high)
{
    return value < low ? low : value > high ? high : value;
}

/* From one at 0 to other at FDVV_ONE_Q15, to the nearest integer, halves up. Both are of 16 bits, so that
 * 65535 * 32768 + 16384 stays below 2^31. */
static inline int32_t fdvv_blend(int32_t one, int32_t other, int32_t part_q15)
{
    return one + (((other - one) * part_q15 + (FDVV_ONE_Q15 >> 1)) >> 15);
}

/* By how many bits value, 1 to 65535, must be shifted left to fill 16. */
static inline uint32_t fdvv_headroom(uint32_t value)
{
    uint32_t bits = 0;
    if (value < 1u << 8)
        value <<= 8, bits = 8;
    if (value < 1u << 12)
        value <<= 4, bits += 4;
    if (value < 1u << 14)
        value <<= 2, bits += 2;
    return value < 1u << 15 ? bits + 1 : bits;
}

/* 2^31 / mantissa for 2^15 < mantissa < 2^16, wrong by 5e-5 of it at most, below 2^16: Newton's iteration from
 * the line that is nearest after two steps. Every product stays below 2^32. */
static inline uint32_t fdvv_reciprocal(uint32_t mantissa)
{
    uint32_t guess = 95990u - mantissa;
    guess = (guess * (65536u - ((mantissa * guess) >> 16))) >> 15;
    return (guess * (65536u - ((mantissa * guess) >> 16))) >> 15;
}

#endif
