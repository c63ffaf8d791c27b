#include "arithmetic.h"

fdvv_ratio fdvv_ratio_of(uint32_t value)
{
    fdvv_ratio ratio;
    uint32_t bits;
    if (value >> 16) {
        bits = 16 - fdvv_headroom(value >> 16);
        value >>= bits;
        ratio.shift = (int16_t)-(int16_t)bits;
    } else {
        bits = fdvv_headroom(value);
        value <<= bits;
        ratio.shift = (int16_t)bits;
    }
    ratio.mantissa = (uint16_t)value;
    return ratio;
}

fdvv_ratio fdvv_ratio_of_wide(uint64_t value)
{
    fdvv_ratio ratio;
    int16_t dropped = 0;
    while (value >> 32) {
        value >>= 4;
        dropped = (int16_t)(dropped + 4);
    }
    ratio = fdvv_ratio_of((uint32_t)value);
    ratio.shift = (int16_t)(ratio.shift - dropped);
    return ratio;
}

fdvv_ratio fdvv_ratio_inverse(fdvv_ratio ratio)
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

fdvv_ratio fdvv_ratio_product(fdvv_ratio one, fdvv_ratio other)
{
    fdvv_ratio product;
    uint32_t wide = (uint32_t)one.mantissa * other.mantissa;
    int16_t cut = wide >> 31 ? 16 : 15;
    product.mantissa = (uint16_t)(wide >> cut);
    product.shift = (int16_t)(one.shift + other.shift - cut);
    return product;
}

int32_t fdvv_scale(int32_t value, fdvv_ratio ratio)
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

int32_t fdvv_scale_short(int32_t value, fdvv_ratio ratio)
{
    uint32_t size = value < 0 ? 0u - (uint32_t)value : (uint32_t)value;
    size = ((size * ratio.mantissa >> (ratio.shift - 1)) + 1u) >> 1;
    return value < 0 ? -(int32_t)size : (int32_t)size;
}

int32_t fdvv_part_q15(uint32_t way, uint32_t whole)
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

uint64_t fdvv_wide_product(uint32_t one, uint32_t other)
{
    uint32_t a = one >> 16, b = one & 0xffffu, c = other >> 16, d = other & 0xffffu;
    uint32_t low = b * d, middle = b * c, high = a * c, carry;
    if (!(a | c))
        return low;
    carry = (low >> 16) + (middle & 0xffffu) + ((a * d) & 0xffffu);
    high += (middle >> 16) + ((a * d) >> 16) + (carry >> 16);
    return (uint64_t)high << 32 | (carry << 16 | (low & 0xffffu));
}
