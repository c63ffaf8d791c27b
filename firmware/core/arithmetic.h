/* Fixed-point arithmetic without division and floating point; every rounding is defined. What every tick needs is
 * inline.
 *
 * Right shifts of negative numbers must be arithmetic. */
#ifndef FDVV_ARITHMETIC_H
#define FDVV_ARITHMETIC_H

#include <stdint.h>

typedef char fdvv_right_shifts_keep_the_sign[(-1 >> 1) == -1 ? 1 : -1];

#define FDVV_ONE_Q15 32768

/* For functions that run once per change of settings: optimise for size, not speed. */
#define FDVV_COLD __attribute__((cold, noinline))

/* mantissa / 2^shift; the highest bit of the mantissa is set */
typedef struct {
    uint16_t mantissa;
    int16_t shift;
} fdvv_ratio;

static inline int32_t fdvv_clamp(int32_t value, int32_t low, int32_t high)
{
    return value < low ? low : value > high ? high : value;
}

/* Linear interpolation between two 16-bit values, rounded to nearest, halves up. Cannot overflow:
 * 65535 * 32768 + 16384 is below 2^31. */
static inline int32_t fdvv_interpolate(int32_t from, int32_t to, int32_t fraction_q15)
{
    return from + (((to - from) * fraction_q15 + (FDVV_ONE_Q15 >> 1)) >> 15);
}

/* Leading zeros of a byte. */
extern const uint8_t fdvv_byte_leading_zeros[256];

/* Leading zeros of a 16-bit value from 1 to 65535. */
static inline uint32_t fdvv_leading_zeros(uint32_t value)
{
    return value >> 8 ? fdvv_byte_leading_zeros[value >> 8] : 8u + fdvv_byte_leading_zeros[value];
}

/* 2^31 / mantissa for 2^15 < mantissa < 2^16, with a relative error of at most 5e-5; the result is below 2^16. Two
 * steps of Newton's method, from the linear estimate with the smallest final error. Every product is below 2^32. */
static inline uint32_t fdvv_reciprocal(uint32_t mantissa)
{
    uint32_t estimate = 95990u - mantissa;
    estimate = (estimate * (65536u - ((mantissa * estimate) >> 16))) >> 15;
    return (estimate * (65536u - ((mantissa * estimate) >> 16))) >> 15;
}

/* value, which is at least 1, rounded down to 16 significant bits. */
static inline fdvv_ratio fdvv_ratio_of(uint32_t value)
{
    fdvv_ratio ratio;
    int32_t bits = (int32_t)fdvv_leading_zeros(value >> 16 ? value >> 16 : value);
    if (value >> 16)
        bits -= 16, value >>= -bits;
    else
        value <<= bits;
    ratio.shift = (int16_t)bits;
    ratio.mantissa = (uint16_t)value;
    return ratio;
}

fdvv_ratio fdvv_ratio_of_wide(uint64_t value);

/* part / whole in Q32 for part < whole < 2^31, rounded down, by long division. */
uint32_t fdvv_fraction_q32(uint32_t part, uint32_t whole);

/* 1 / ratio, with a relative error of at most 5e-5; exact for powers of two. */
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

/* a * b, truncated to 16 bits: the relative error is at most 2^-15. */
static inline fdvv_ratio fdvv_ratio_product(fdvv_ratio a, fdvv_ratio b)
{
    fdvv_ratio product;
    uint32_t wide = (uint32_t)a.mantissa * b.mantissa;
    int16_t excess = wide >> 31 ? 16 : 15;
    product.mantissa = (uint16_t)(wide >> excess);
    product.shift = (int16_t)(a.shift + b.shift - excess);
    return product;
}

/* value * ratio, rounded to nearest, halves away from zero. For shifts below 17, |value| * 2^(17 - shift) must be
 * below 2^31. */
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
    /* the product without its lowest 16 bits, which do not affect the rounding */
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

/* part / whole in Q15 for 0 <= part < whole < 2^26, truncated. The error is at most 5e-5, or 2^-11 if whole is at
 * least 2^16. */
static inline int32_t fdvv_fraction_q15(uint32_t part, uint32_t whole)
{
    uint32_t bits;
    if (whole >> 16) {
        bits = whole >> 21 ? 10 : 5;
        part >>= bits;
        whole >>= bits;
    }
    bits = fdvv_leading_zeros(whole);
    part <<= bits;
    whole <<= bits;
    if (whole == FDVV_ONE_Q15)
        return (int32_t)part;
    return (int32_t)(part * fdvv_reciprocal(whole) >> 16);
}

/* x * y, without a call of the compiler's 64-bit multiplication. */
static inline uint64_t fdvv_wide_product(uint32_t x, uint32_t y)
{
    uint32_t a = x >> 16, b = x & 0xffffu, c = y >> 16, d = y & 0xffffu;
    uint32_t low = b * d, middle = b * c, high = a * c, carry;
    if (!(a | c))
        return low;
    carry = (low >> 16) + (middle & 0xffffu) + ((a * d) & 0xffffu);
    high += (middle >> 16) + ((a * d) >> 16) + (carry >> 16);
    return (uint64_t)high << 32 | (carry << 16 | (low & 0xffffu));
}

#endif
