/* The tables of a program are contiguous: header, states, transitions, surfaces, vibrations, slots. */
#include "image.h"

const fdvv_image_header *fdvv_image_head(const uint8_t *image)
{
    return (const fdvv_image_header *)(const void *)image;
}

const fdvv_state *fdvv_image_state(const uint8_t *image, uint8_t state)
{
    return (const fdvv_state *)(const void *)(image + sizeof(fdvv_image_header)) + state;
}

const fdvv_transition *fdvv_image_transition(const uint8_t *image, uint8_t transition)
{
    return (const fdvv_transition *)(const void *)fdvv_image_state(image, fdvv_image_head(image)->states) + transition;
}

const fdvv_surface *fdvv_image_surface(const uint8_t *image, uint8_t surface)
{
    uint8_t before = fdvv_image_head(image)->transitions;
    return (const fdvv_surface *)(const void *)fdvv_image_transition(image, before) + surface;
}

const fdvv_vibration *fdvv_image_vibration(const uint8_t *image, uint8_t vibration)
{
    uint8_t before = fdvv_image_head(image)->surfaces;
    return (const fdvv_vibration *)(const void *)fdvv_image_surface(image, before) + vibration;
}

const fdvv_slot *fdvv_image_slot(const uint8_t *image, uint8_t slot)
{
    uint8_t before = fdvv_image_head(image)->vibrations;
    return (const fdvv_slot *)(const void *)fdvv_image_vibration(image, before) + slot;
}
