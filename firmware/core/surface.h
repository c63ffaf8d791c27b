/* Force on displacement and velocity. */
#ifndef FDVV_SURFACE_H
#define FDVV_SURFACE_H

#include "arithmetic.h"
#include "protocol.h"

/* Force of a surface of a checked image: bilinear, held beyond its edges. Parts of a cell are in Q15, wrong by
 * 5e-5 of a cell at most; each of the three blends rounds to the nearest, halves up. */
int32_t fdvv_surface_force_cN64(const fdvv_surface *surface, const uint8_t *image, int32_t displacement_um16,
                                uint16_t velocity_mm_s16);

#endif
