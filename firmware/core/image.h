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
    uint32_t crc;
    uint16_t size_bytes, at;
    uint16_t detail;  /* where it failed: offset in the image */
    uint8_t stage, result;
} fdvv_image_check;

/* size_bytes and crc32 as announced, before the image is looked at. */
void fdvv_image_check_begin(fdvv_image_check *check, const uint8_t *image, uint16_t size_bytes, uint32_t crc32);

/* Look at no more than about `bytes` more; FDVV_REFUSAL_BUSY while unfinished, else _NONE, _CHECKSUM,
 * _IMAGE_LAYOUT or _IMAGE_RANGE (force beyond the settings' limit included). */
uint8_t fdvv_image_check_step(fdvv_image_check *check, const fdvv_settings *settings, uint16_t bytes);

#endif
