#include "surface.h"

/* The last column at or before a displacement, and the fraction of the interval to the next one. */
static uint32_t column_at(const fdvv_surface *surface, int32_t displacement_um16, int32_t *fraction_q15)
{
    int32_t offset_um16 = displacement_um16 - surface->start_um16, step = surface->step_um16, column;
    int32_t last = surface->columns - 1;
    uint32_t bits, mantissa, reciprocal;
    *fraction_q15 = 0;
    if (offset_um16 <= 0)
        return 0;
    if (offset_um16 >= last * step) {
        *fraction_q15 = FDVV_ONE_Q15;
        return (uint32_t)(last - 1);
    }
    bits = fdvv_leading_zeros((uint32_t)step);
    mantissa = (uint32_t)step << bits;
    reciprocal = mantissa == FDVV_ONE_Q15 ? UINT16_MAX : fdvv_reciprocal(mantissa);
    /* offset_um16 << bits is below 254 * 2^16; truncated to 16 bits, the column is wrong by at most one */
    column = (int32_t)((((uint32_t)offset_um16 << bits) >> 8) * reciprocal >> 23);
    offset_um16 -= column * step;
    if (offset_um16 < 0)
        offset_um16 += step, column--;
    else if (offset_um16 >= step)
        offset_um16 -= step, column++;
    *fraction_q15 = (int32_t)(((uint32_t)offset_um16 << bits) * reciprocal >> 16);
    return (uint32_t)column;
}

/* The same for rows. */
static uint32_t row_at(const uint16_t *velocities_mm_s16, uint32_t rows, uint32_t velocity_mm_s16,
                       int32_t *fraction_q15)
{
    uint32_t row = 0;
    *fraction_q15 = 0;
    if (velocity_mm_s16 <= velocities_mm_s16[0])
        return 0;
    while (row + 1 < rows && velocities_mm_s16[row + 1] <= velocity_mm_s16)
        row++;
    if (row + 1 < rows)
        *fraction_q15 = fdvv_fraction_q15(velocity_mm_s16 - velocities_mm_s16[row],
                                  (uint32_t)velocities_mm_s16[row + 1] - velocities_mm_s16[row]);
    return row;
}

int32_t fdvv_surface_force_cN64(const fdvv_surface *surface, const uint8_t *image, int32_t displacement_um16,
                                uint16_t velocity_mm_s16)
{
    const uint16_t *velocities_mm_s16 = (const uint16_t *)(const void *)(image + surface->velocities_at);
    const int16_t *forces_cN64 = (const int16_t *)(const void *)(image + surface->forces_at);
    int32_t column_fraction_q15, row_fraction_q15, slow_cN64, fast_cN64;
    uint32_t column = column_at(surface, displacement_um16, &column_fraction_q15);
    uint32_t row = row_at(velocities_mm_s16, surface->rows, velocity_mm_s16, &row_fraction_q15);
    forces_cN64 += row * surface->columns + column;
    slow_cN64 = fdvv_interpolate(forces_cN64[0], forces_cN64[1], column_fraction_q15);
    if (!row_fraction_q15)
        return slow_cN64;
    forces_cN64 += surface->columns;
    fast_cN64 = fdvv_interpolate(forces_cN64[0], forces_cN64[1], column_fraction_q15);
    return fdvv_interpolate(slow_cN64, fast_cN64, row_fraction_q15);
}
