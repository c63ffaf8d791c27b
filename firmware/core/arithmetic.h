/* Division by multiplication: no division, no float, every rounding defined. What every tick needs is inline.
 *
 * Right shifts of negative numbers are taken to be arithmetic, as every compiler used here makes them. */
#ifndef FDVV_ARITHMETIC_H
#define FDVV_ARITHMETIC_H

#include <stdint.h>

typedef char fdvv_right_shifts_keep_the_sign[(-1 >> 1) == -1 ? 1 : -1];

#define FDVV_ONE_Q15 32768

/* Runs once per change of settings: small rather than quick. */
#define FDVV_SELDOM __attribute__((cold, noinline))

/* mantissa / 2^shift; the mantissa has its highest bit set */
typedef struct {
    uint16_t mantissa;
    int16_t shift;
} fdvv_ratio;

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

/* By how many bits a byte must be shifted left to fill 8. */
extern const uint8_t fdvv_byte_headroom[256];

/* By how many bits value, 1 to 65535, must be shifted left to fill 16. */
static inline uint32_t fdvv_headroom(uint32_t value)
{
    return value >> 8 ? fdvv_byte_headroom[value >> 8] : 8u + fdvv_byte_headroom[value];
}

/* 2^31 / mantissa for 2^15 < mantissa < 2^16, wrong by 5e-5 of it at most, below 2^16: Newton's iteration from
 * the line that is nearest after two steps. Every product stays below 2^32. */
static inline uint32_t fdvv_reciprocal(uint32_t mantissa)
{
    uint32_t guess = 95990u - mantissa;
    guess = (guess * (65536u - ((mantissa * guess) >> 16))) >> 15;
    return (guess * (65536u - ((mantissa * guess) >> 16))) >> 15;
}

/* The largest ratio not above value; value is at least 1. */
static inline fdvv_ratio fdvv_ratio_of(uint32_t value)
{
    fdvv_ratio ratio;
    int32_t bits = (int32_t)fdvv_headroom(value >> 16 ? value >> 16 : value);
    if (value >> 16)
        bits -= 16, value >>= -bits;
    else
        value <<= bits;
    ratio.shift = (int16_t)bits;
    ratio.mantissa = (uint16_t)value;
    return ratio;
}

fdvv_ratio fdvv_ratio_of_wide(uint64_t value);

/* 1 / ratio, wrong by 5e-5 of it at most; powers of two exactly. */
static inline fdvv_ratio fdvv_ratio_inverse(fdvv_ratio ratio)
{
    fdvv_ratio inverse;
    if (ratio.mantissa == FDVV_ONE_Q15) {
        inverse.mantissa = FDVV_ONE_Q15;
        inverse.shift = (int16_t)(30 - ratio.shift);
        return inverse;
    }
    inverse.mantissa = (uint16_t)fdvv_reciprocal(ratio.mantissa);
    inverse.shift = (int16_t)(31 - ratio.shift);
    return inverse;
}

/* one * other, cut to 16 bits: wrong by 2^-15 of it at most. */
static inline fdvv_ratio fdvv_ratio_product(fdvv_ratio one, fdvv_ratio other)
{
    fdvv_ratio product;
    uint32_t wide = (uint32_t)one.mantissa * other.mantissa;
    int16_t cut = wide >> 31 ? 16 : 15;
    product.mantissa = (uint16_t)(wide >> cut);
    product.shift = (int16_t)(one.shift + other.shift - cut);
    return product;
}

/* value * ratio to the nearest integer, halves away from zero. With a shift below 17, |value| * 2^(17 - shift)
 * must stay below 2^31. */
static inline int32_t fdvv_scale(int32_t value, fdvv_ratio ratio)
{
    uint32_t size = value < 0 ? 0u - (uint32_t)value : (uint32_t)value, top;
    int16_t shift = ratio.shift;
    if (shift < 17) {
        size <<= 17 - shift;
        shift = 17;
    }
    if (shift > 48)
        return 0;
    /* the product without its lowest 16 bits, which no rounding can feel */
    top = (size >> 16) * ratio.mantissa + (((size & 0xffffu) * ratio.mantissa) >> 16);
    top = ((top >> (shift - 17)) + 1u) >> 1;
    return value < 0 ? -(int32_t)top : (int32_t)top;
}

/* The same for |value| below 2^16 and a shift of 1 to 32. */
static inline int32_t fdvv_scale_short(int32_t value, fdvv_ratio ratio)
{
    uint32_t size = value < 0 ? 0u - (uint32_t)value : (uint32_t)value;
    size = ((size * ratio.mantissa >> (ratio.shift - 1)) + 1u) >> 1;
    return value < 0 ? -(int32_t)size : (int32_t)size;
}

/* way / whole in Q15 for 0 <= way < whole < 2^26, cut, wrong by 5e-5 and, from 2^16 on, 2^-11 at most. */
static inline int32_t fdvv_part_q15(uint32_t way, uint32_t whole)
{
    uint32_t bits;
    if (whole >> 16) {
        bits = whole >> 21 ? 10 : 5;
        way >>= bits;
        whole >>= bits;
    }
    bits = fdvv_headroom(whole);
    way <<= bits;
    whole <<= bits;
    if (whole == FDVV_ONE_Q15)
        return (int32_t)way;
    return (int32_t)(way * fdvv_reciprocal(whole) >> 16);
}

/* one * other without the compiler's library. */
static inline uint64_t fdvv_wide_product(uint32_t one, uint32_t other)
{
    uint32_t a = one >> 16, b = one & 0xffffu, c = other >> 16, d = other & 0xffffu;
    uint32_t low = b * d, middle = b * c, high = a * c, carry;
    if (!(a | c))
        return low;
    carry = (low >> 16) + (middle & 0xffffu) + ((a * d) & 0xffffu);
    high += (middle >> 16) + ((a * d) >> 16) + (carry >> 16);
    return (uint64_t)high << 32 | (carry << 16 | (low & 0xffffu));
}

#endif
