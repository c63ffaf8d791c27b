/* Doors for the tests: how large the C structures are, and an image check that lays the image at the very end of
 * its memory, so that the address sanitiser sees the first byte read beyond it. */
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "crc32.h"
#include "image.h"
#include "supervisor.h"

int safety_supervisor_bytes(void);
int safety_inputs_bytes(void);
int safety_check(const uint8_t *bytes, int size, uint32_t crc32, const fdvv_settings *settings, int step_bytes,
                 int32_t travel_limit_um16, int *steps, int *detail);
void safety_fuzz(const uint8_t *images, const int *sizes, int images_count, const fdvv_settings *settings,
                 uint32_t seed, int count, int *verdicts);

int safety_supervisor_bytes(void)
{
    return sizeof(fdvv_supervisor);
}

int safety_inputs_bytes(void)
{
    return sizeof(fdvv_inputs);
}

int safety_check(const uint8_t *bytes, int size, uint32_t crc32, const fdvv_settings *settings, int step_bytes,
                 int32_t travel_limit_um16, int *steps, int *detail)
{
    fdvv_image_check check;
    uint8_t result, *image = malloc((size_t)size + !size);
    memcpy(image, bytes, (size_t)size);
    memset(&check, 0xa5, sizeof check);
    fdvv_image_check_begin(&check, image, (uint16_t)size, crc32);
    if (travel_limit_um16)
        check.travel_limit_um16 = travel_limit_um16;
    for (*steps = 1; (result = fdvv_image_check_step(&check, settings, (uint16_t)step_bytes)) == FDVV_REFUSAL_BUSY;)
        ++*steps;
    *detail = check.detail;
    free(image);
    return result;
}

static uint32_t draw(uint32_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return *state;
}

/* Read whatever the tick and the vibration board read of a program that was accepted. */
static uint32_t walk(const uint8_t *image)
{
    const fdvv_image_header *head = fdvv_image_head(image);
    uint32_t seen = fdvv_image_state(image, head->start_state)->key;
    int i, j;
    for (i = 0; i < head->states; i++) {
        const fdvv_state *state = fdvv_image_state(image, (uint8_t)i);
        seen += fdvv_image_surface(image, state->press_surface)->rows;
        seen += fdvv_image_surface(image, state->release_surface)->rows;
        for (j = 0; j < state->transitions; j++) {
            const fdvv_transition *transition = fdvv_image_transition(image, (uint8_t)(state->first_transition + j));
            seen += fdvv_image_state(image, transition->target)->key;
            if (transition->slot != FDVV_NONE)
                seen += fdvv_image_slot(image, transition->slot)->waveform;
            if (transition->condition == FDVV_CONDITION_HOST_EVENT)
                seen += (uint32_t)1 << transition->value;
        }
        if (state->enter_slot != FDVV_NONE)
            seen += fdvv_image_slot(image, state->enter_slot)->waveform;
        if (state->repeat_slot != FDVV_NONE)
            seen += fdvv_image_slot(image, state->repeat_slot)->waveform / state->repeat_ms;
    }
    for (i = 0; i < head->surfaces; i++) {
        const fdvv_surface *surface = fdvv_image_surface(image, (uint8_t)i);
        const uint16_t *velocities = (const uint16_t *)(const void *)(image + surface->velocities_at);
        const int16_t *forces = (const int16_t *)(const void *)(image + surface->forces_at);
        for (j = 0; j < surface->rows * surface->columns; j++)
            seen += (uint32_t)forces[j];
        for (j = 1; j < surface->rows; j++)
            seen += 1000000u / (uint32_t)(velocities[j] - velocities[j - 1]);
    }
    for (i = 0; i < head->vibrations; i++)
        seen += fdvv_image_slot(image, fdvv_image_vibration(image, (uint8_t)i)->slot)->waveform;
    for (i = 0; i < head->slots; i++) {
        const fdvv_slot *slot = fdvv_image_slot(image, (uint8_t)i);
        for (j = 0; j < slot->wave_samples; j++)
            seen += image[slot->wave_at + j];
    }
    return seen;
}

/* Change some bytes, mostly in the tables; sometimes cut or lengthen the image, sometimes leave the checksum. */
static int mutate(uint8_t *image, int size, uint32_t *state)
{
    static const uint8_t telling[] = {0, 1, 2, 15, 16, 31, 32, 47, 48, 127, 128, 254, 255};
    int changes = 1 + (int)(draw(state) % 4), reach = draw(state) % 4 ? (size < 600 ? size : 600) : size;
    while (changes--) {
        uint32_t at = draw(state) % (uint32_t)reach;
        image[at] = draw(state) % 2 ? (uint8_t)draw(state) : telling[draw(state) % sizeof telling];
    }
    if (draw(state) % 16 == 0)
        size = 4 + (int)(draw(state) % (uint32_t)size) / 4 * 4;
    if (draw(state) % 4 && size >= 32) { /* else the length in the header stays as it was, and refused as such */
        image[12] = (uint8_t)size;
        image[13] = (uint8_t)(size >> 8);
    }
    return size;
}

void safety_fuzz(const uint8_t *images, const int *sizes, int images_count, const fdvv_settings *settings,
                 uint32_t seed, int count, int *verdicts)
{
    static uint8_t image[FDVV_IMAGE_BYTES + 4];
    uint32_t state = seed;
    volatile uint32_t seen = 0;
    while (count--) {
        int which = (int)(draw(&state) % (uint32_t)images_count), i, size, steps, detail, verdict;
        const uint8_t *from = images;
        uint32_t crc32 = 0;
        for (i = 0; i < which; i++)
            from += sizes[i];
        memcpy(image, from, (size_t)sizes[which]);
        size = mutate(image, sizes[which], &state);
        if (size >= 8 && draw(&state) % 16) {
            crc32 = fdvv_crc32(0, image + 8, (uint16_t)(size - 8));
            memcpy(image + 4, &crc32, 4);
        }
        verdict = safety_check(image, size, crc32, settings, 1 + (int)(draw(&state) % 512), 0, &steps, &detail);
        verdicts[verdict]++;
        if (verdict == FDVV_REFUSAL_NONE) {
            uint8_t *exact = malloc((size_t)size);
            memcpy(exact, image, (size_t)size);
            seen += walk(exact);
            free(exact);
        }
    }
}
