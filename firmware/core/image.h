/* A program as it lies in memory: where its parts are, and whether it may be trusted. */
#ifndef FDVV_IMAGE_H
#define FDVV_IMAGE_H

#include "protocol.h"

/* An image is four-byte aligned. The accessors below trust it: call them on checked images only. */
const fdvv_image_header *fdvv_image_head(const uint8_t *image);
const fdvv_state *fdvv_image_state(const uint8_t *image, uint8_t state);
const fdvv_transition *fdvv_image_transition(const uint8_t *image, uint8_t transition);
const fdvv_surface *fdvv_image_surface(const uint8_t *image, uint8_t surface);
const fdvv_vibration *fdvv_image_vibration(const uint8_t *image, uint8_t vibration);
const fdvv_slot *fdvv_image_slot(const uint8_t *image, uint8_t slot);

/* A check in progress; a few hundred bytes a step, so that no tick is late. */
typedef struct {
    const uint8_t *image;
    uint32_t announced_crc32, crc32;
    int32_t travel_limit_um16;  /* deepest stop of the board; may be lowered after _begin */
    uint16_t size_bytes, at;    /* bytes summed, or number of the record */
    uint16_t node;              /* of the surface */
    uint16_t detail;            /* where it failed: offset in the image */
    uint8_t stage, result;
    int16_t lowest_cN64[FDVV_SURFACES], highest_cN64[FDVV_SURFACES];
} fdvv_image_check;

/* size_bytes and crc32 as announced, before the image is looked at. */
void fdvv_image_check_begin(fdvv_image_check *check, const uint8_t *image, uint16_t size_bytes, uint32_t crc32);

/* Look at `bytes` more and less than 64 beyond; FDVV_REFUSAL_BUSY while unfinished, else _NONE, _CHECKSUM,
 * _IMAGE_LAYOUT (sizes, offsets, indices) or _IMAGE_RANGE (values; force beyond the settings' limit included).
 * Nothing outside the size_bytes announced is read, whatever they hold. */
uint8_t fdvv_image_check_step(fdvv_image_check *check, const fdvv_settings *settings, uint16_t bytes);

#endif
