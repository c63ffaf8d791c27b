/* Force as a function of displacement and velocity. */
#ifndef FDVV_SURFACE_H
#define FDVV_SURFACE_H

#include "arithmetic.h"
#include "protocol.h"

/* Bilinear interpolation in a surface of a valid image, constant beyond its edges. The fractions in Q15 have an error of
 * at most 5e-5 of a cell; each of the three interpolations rounds to nearest, halves up. */
int32_t fdvv_surface_force_cN64(const fdvv_surface *surface, const uint8_t *image, int32_t displacement_um16,
                                uint16_t velocity_mm_s16);

#endif
