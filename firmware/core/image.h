/* Program image: access to its tables, and its validation. */
#ifndef FDVV_IMAGE_H
#define FDVV_IMAGE_H

#include "protocol.h"

/* Images are aligned to four bytes. These accessors do not check anything: use them on valid images only. */
const fdvv_image_header *fdvv_image_head(const uint8_t *image);
const fdvv_state *fdvv_image_state(const uint8_t *image, uint8_t state);
const fdvv_transition *fdvv_image_transition(const uint8_t *image, uint8_t transition);
const fdvv_surface *fdvv_image_surface(const uint8_t *image, uint8_t surface);
const fdvv_vibration *fdvv_image_vibration(const uint8_t *image, uint8_t vibration);
const fdvv_slot *fdvv_image_slot(const uint8_t *image, uint8_t slot);

/* A check in progress. It is done in small steps, so that no tick is late. */
typedef struct {
    const uint8_t *image;
    uint32_t announced_crc32, crc32;
    int32_t travel_limit_um16;  /* largest travel of the board; may be lowered after _begin */
    uint16_t size_bytes;
    uint16_t at;                /* bytes of the checksum so far, or index of the record */
    uint16_t node;              /* of the surface */
    uint16_t detail;            /* offset in the image of what is invalid */
    uint8_t stage, result;
    int16_t lowest_cN64[FDVV_SURFACES], highest_cN64[FDVV_SURFACES];
} fdvv_image_check;

/* Start a check; size_bytes and crc32 are those announced by the host. */
void fdvv_image_check_begin(fdvv_image_check *check, const uint8_t *image, uint16_t size_bytes, uint32_t crc32);

/* Check `bytes` more bytes, or up to 63 beyond. Returns FDVV_REFUSAL_BUSY until finished, then _NONE, _CHECKSUM,
 * _IMAGE_LAYOUT (sizes, offsets, indices) or _IMAGE_RANGE (values, including forces beyond the settings' limit).
 * Never reads outside the announced size_bytes, whatever their content. */
uint8_t fdvv_image_check_step(fdvv_image_check *check, const fdvv_settings *settings, uint16_t bytes);

#endif
