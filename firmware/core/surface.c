#include "surface.h"

/* Give the last column at or before a displacement, and how far towards the next one it lies. */
static uint32_t column_at(const fdvv_surface *surface, int32_t displacement_um16, int32_t *part_q15)
{
    int32_t way = displacement_um16 - surface->start_um16, step = surface->step_um16, column;
    int32_t last = surface->columns - 1;
    uint32_t bits, filled, reciprocal;
    *part_q15 = 0;
    if (way <= 0)
        return 0;
    if (way >= last * step) {
        *part_q15 = FDVV_ONE_Q15;
        return (uint32_t)(last - 1);
    }
    bits = fdvv_headroom((uint32_t)step);
    filled = (uint32_t)step << bits;
    reciprocal = filled == FDVV_ONE_Q15 ? UINT16_MAX : fdvv_reciprocal(filled);
    /* way << bits is below 254 * 2^16; cut to 16 bits it misses the column by one at most */
    column = (int32_t)((((uint32_t)way << bits) >> 8) * reciprocal >> 23);
    way -= column * step;
    if (way < 0)
        way += step, column--;
    else if (way >= step)
        way -= step, column++;
    *part_q15 = (int32_t)(((uint32_t)way << bits) * reciprocal >> 16);
    return (uint32_t)column;
}

/* The same for rows. */
static uint32_t row_at(const uint16_t *velocities_mm_s16, uint32_t rows, uint32_t velocity_mm_s16, int32_t *part_q15)
{
    uint32_t row = 0;
    *part_q15 = 0;
    if (velocity_mm_s16 <= velocities_mm_s16[0])
        return 0;
    while (row + 1 < rows && velocities_mm_s16[row + 1] <= velocity_mm_s16)
        row++;
    if (row + 1 < rows)
        *part_q15 = fdvv_part_q15(velocity_mm_s16 - velocities_mm_s16[row],
                                  (uint32_t)velocities_mm_s16[row + 1] - velocities_mm_s16[row]);
    return row;
}

int32_t fdvv_surface_force_cN64(const fdvv_surface *surface, const uint8_t *image, int32_t displacement_um16,
                                uint16_t velocity_mm_s16)
{
    const uint16_t *velocities_mm_s16 = (const uint16_t *)(const void *)(image + surface->velocities_at);
    const int16_t *forces_cN64 = (const int16_t *)(const void *)(image + surface->forces_at);
    int32_t across_q15, along_q15, slow_cN64, fast_cN64;
    uint32_t column = column_at(surface, displacement_um16, &across_q15);
    uint32_t row = row_at(velocities_mm_s16, surface->rows, velocity_mm_s16, &along_q15);
    forces_cN64 += row * surface->columns + column;
    slow_cN64 = fdvv_blend(forces_cN64[0], forces_cN64[1], across_q15);
    if (!along_q15)
        return slow_cN64;
    forces_cN64 += surface->columns;
    fast_cN64 = fdvv_blend(forces_cN64[0], forces_cN64[1], across_q15);
    return fdvv_blend(slow_cN64, fast_cN64, along_q15);
}
