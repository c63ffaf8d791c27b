#include "arithmetic.h"

#define FOUR(bits) bits, bits, bits, bits
#define SIXTEEN(bits) FOUR(bits), FOUR(bits), FOUR(bits), FOUR(bits)
#define SIXTY_FOUR(bits) SIXTEEN(bits), SIXTEEN(bits), SIXTEEN(bits), SIXTEEN(bits)
const uint8_t fdvv_byte_leading_zeros[256] = {
    8, 7, 6, 6, FOUR(5), FOUR(4), FOUR(4), SIXTEEN(3), SIXTEEN(2), SIXTEEN(2), SIXTY_FOUR(1),
    SIXTY_FOUR(0), SIXTY_FOUR(0),
};

fdvv_ratio fdvv_ratio_of_wide(uint64_t value)
{
    fdvv_ratio ratio;
    int16_t shifted = 0;
    while (value >> 32) {
        value >>= 4;
        shifted = (int16_t)(shifted + 4);
    }
    ratio = fdvv_ratio_of((uint32_t)value);
    ratio.shift = (int16_t)(ratio.shift - shifted);
    return ratio;
}

FDVV_COLD uint32_t fdvv_fraction_q32(uint32_t part, uint32_t whole)
{
    uint32_t quotient = 0;
    uint8_t bit;
    for (bit = 0; bit < 32; bit++) {
        part <<= 1;
        quotient <<= 1;
        if (part >= whole) {
            part -= whole;
            quotient |= 1;
        }
    }
    return quotient;
}
