/* Validates a program in steps, without reading outside of it. */
#include <stddef.h>

#include "crc32.h"
#include "image.h"
#include "ranges.h"

#define CHUNK_BYTES 32
#define CHUNK_NODES 16

enum { HEAD, CHECKSUM, COUNTS, SURFACES, FORCES, STATES, TRANSITIONS, VIBRATIONS, SLOTS, DONE };

static uint16_t refuse(fdvv_image_check *check, uint8_t refusal, const void *where)
{
    check->result = refusal;
    check->detail = (uint16_t)((const uint8_t *)where - check->image);
    return 0;
}

static void enter(fdvv_image_check *check, uint8_t stage)
{
    check->stage = stage;
    check->at = 0;
}

/* Refuse the record `it` if this field is out of range. */
#define CHECK(field, low, high)                                                                             \
    if (fdvv_outside((int32_t)it->field, low, high))                                                        \
        return refuse(check, FDVV_REFUSAL_IMAGE_RANGE, &it->field);

/* Refuse it if this index or offset is invalid. */
#define REQUIRE(condition, field)                                                                             \
    if (!(condition))                                                                                       \
        return refuse(check, FDVV_REFUSAL_IMAGE_LAYOUT, &it->field);

/* End of the tables. Velocities, forces and waves follow in any order. */
static uint16_t pool_at(const fdvv_image_header *head)
{
    return (uint16_t)(sizeof(fdvv_image_header) + head->states * sizeof(fdvv_state) +
                      head->transitions * sizeof(fdvv_transition) + head->surfaces * sizeof(fdvv_surface) +
                      head->vibrations * sizeof(fdvv_vibration) + head->slots * sizeof(fdvv_slot));
}

static uint8_t in_pool(const fdvv_image_check *check, uint32_t at, uint32_t bytes)
{
    return at >= pool_at(fdvv_image_head(check->image)) && at + bytes <= check->size_bytes;
}

static uint8_t is_slot_or_none(const fdvv_image_header *head, uint8_t slot)
{
    return slot < head->slots || slot == FDVV_NONE;
}

static uint16_t check_head(fdvv_image_check *check, const fdvv_settings *settings)
{
    const fdvv_image_header *it = fdvv_image_head(check->image);
    (void)settings;
    REQUIRE(it->magic == FDVV_IMAGE_MAGIC, magic)
    REQUIRE(it->size_bytes == check->size_bytes, size_bytes)
    if (it->crc32 != check->announced_crc32)
        return refuse(check, FDVV_REFUSAL_CHECKSUM, &it->crc32);
    enter(check, CHECKSUM);
    check->at = offsetof(fdvv_image_header, travel_um16);
    return sizeof *it;
}

static uint16_t check_checksum(fdvv_image_check *check, const fdvv_settings *settings)
{
    uint16_t left = (uint16_t)(check->size_bytes - check->at), count = left < CHUNK_BYTES ? left : CHUNK_BYTES;
    (void)settings;
    check->crc32 = fdvv_crc32(check->crc32, check->image + check->at, count);
    check->at = (uint16_t)(check->at + count);
    if (check->at < check->size_bytes)
        return count;
    if (check->crc32 != check->announced_crc32)
        return refuse(check, FDVV_REFUSAL_CHECKSUM, &fdvv_image_head(check->image)->crc32);
    enter(check, COUNTS);
    return count;
}

/* The name must be ASCII, padded with zeros. Returns the first invalid character, or 0. */
static const uint8_t *find_invalid_character(const fdvv_image_header *head)
{
    uint8_t i, ended = 0;
    for (i = 0; i < sizeof head->name; i++) {
        if (head->name[i] > 126 || (ended && head->name[i]))
            return &head->name[i];
        ended = !head->name[i];
    }
    return 0;
}

static uint16_t check_counts(fdvv_image_check *check, const fdvv_settings *settings)
{
    const fdvv_image_header *it = fdvv_image_head(check->image);
    const uint8_t *invalid = find_invalid_character(it);
    (void)settings;
    FDVV_IMAGE_HEADER_RANGES(CHECK)
    if (it->travel_um16 > check->travel_limit_um16)
        return refuse(check, FDVV_REFUSAL_IMAGE_RANGE, &it->travel_um16);
    if (invalid)
        return refuse(check, FDVV_REFUSAL_IMAGE_RANGE, invalid);
    REQUIRE(it->start_state < it->states, start_state)
    REQUIRE(pool_at(it) <= check->size_bytes, states)
    enter(check, SURFACES);
    return sizeof *it;
}

static uint16_t check_surface(fdvv_image_check *check, const fdvv_settings *settings)
{
    const fdvv_surface *it = fdvv_image_surface(check->image, (uint8_t)check->at);
    const uint16_t *velocities;
    uint8_t row;
    (void)settings;
    FDVV_SURFACE_RANGES(CHECK)
    REQUIRE(it->velocities_at % 2 == 0 && in_pool(check, it->velocities_at, 2u * it->rows), velocities_at)
    REQUIRE(it->forces_at % 2 == 0 && in_pool(check, it->forces_at, 2u * it->rows * it->columns), forces_at)
    velocities = (const uint16_t *)(const void *)(check->image + it->velocities_at);
    for (row = 1; row < it->rows; row++)
        if (velocities[row] <= velocities[row - 1])
            return refuse(check, FDVV_REFUSAL_IMAGE_RANGE, &velocities[row]);
    check->lowest_cN64[check->at] = INT16_MAX;
    check->highest_cN64[check->at] = INT16_MIN;
    check->node = 0;
    check->stage = FORCES;
    return (uint16_t)(sizeof *it + 2u * it->rows);
}

/* Some nodes of the surface. Stores its extremes, to check the states that add a bias to it. */
static uint16_t check_forces(fdvv_image_check *check, const fdvv_settings *settings)
{
    const fdvv_surface *surface = fdvv_image_surface(check->image, (uint8_t)check->at);
    const int16_t *forces = (const int16_t *)(const void *)(check->image + surface->forces_at);
    uint16_t nodes = (uint16_t)(surface->rows * surface->columns), i;
    for (i = 0; i < CHUNK_NODES && check->node < nodes; i++, check->node++) {
        int16_t force_cN64 = forces[check->node];
        if (fdvv_outside(force_cN64, -settings->force_limit_cN64, settings->force_limit_cN64))
            return refuse(check, FDVV_REFUSAL_IMAGE_RANGE, &forces[check->node]);
        if (force_cN64 < check->lowest_cN64[check->at])
            check->lowest_cN64[check->at] = force_cN64;
        if (force_cN64 > check->highest_cN64[check->at])
            check->highest_cN64[check->at] = force_cN64;
    }
    if (check->node == nodes) {
        check->stage = SURFACES;
        check->at++;
    }
    return (uint16_t)(2 * i);
}

static uint8_t exceeds_force_limit(const fdvv_image_check *check, const fdvv_settings *settings, uint8_t surface,
                                   int16_t bias_cN64)
{
    return bias_cN64 + check->lowest_cN64[surface] < -settings->force_limit_cN64 ||
           bias_cN64 + check->highest_cN64[surface] > settings->force_limit_cN64;
}

static uint16_t check_state(fdvv_image_check *check, const fdvv_settings *settings)
{
    const fdvv_image_header *head = fdvv_image_head(check->image);
    const fdvv_state *it = fdvv_image_state(check->image, (uint8_t)check->at++);
    FDVV_STATE_RANGES(CHECK)
    REQUIRE(it->press_surface < head->surfaces, press_surface)
    REQUIRE(it->release_surface < head->surfaces, release_surface)
    REQUIRE(it->first_transition + it->transitions <= head->transitions, first_transition)
    REQUIRE(is_slot_or_none(head, it->enter_slot), enter_slot)
    REQUIRE(is_slot_or_none(head, it->repeat_slot), repeat_slot)
    if ((it->repeat_slot == FDVV_NONE) != (it->repeat_ms == 0))
        return refuse(check, FDVV_REFUSAL_IMAGE_RANGE, &it->repeat_ms);
    if (exceeds_force_limit(check, settings, it->press_surface, it->bias_cN64) ||
        exceeds_force_limit(check, settings, it->release_surface, it->bias_cN64))
        return refuse(check, FDVV_REFUSAL_IMAGE_RANGE, &it->bias_cN64);
    if (exceeds_force_limit(check, settings, it->press_surface, it->bias_end_cN64) ||
        exceeds_force_limit(check, settings, it->release_surface, it->bias_end_cN64))
        return refuse(check, FDVV_REFUSAL_IMAGE_RANGE, &it->bias_end_cN64);
    return sizeof *it;
}

static uint8_t operand_outside(uint8_t condition, int32_t value)
{
    if (condition == FDVV_CONDITION_HOST_EVENT)
        return fdvv_outside(value, 0, 31);
    return condition >= FDVV_CONDITION_AFTER_MS && value < 0;
}

static uint16_t check_transition(fdvv_image_check *check, const fdvv_settings *settings)
{
    const fdvv_transition *it = fdvv_image_transition(check->image, (uint8_t)check->at++);
    (void)settings;
    FDVV_TRANSITION_RANGES(CHECK)
    REQUIRE(it->target < fdvv_image_head(check->image)->states, target)
    REQUIRE(is_slot_or_none(fdvv_image_head(check->image), it->slot), slot)
    if (operand_outside(it->condition, it->value))
        return refuse(check, FDVV_REFUSAL_IMAGE_RANGE, &it->value);
    if (operand_outside(it->guard, it->guard_value))
        return refuse(check, FDVV_REFUSAL_IMAGE_RANGE, &it->guard_value);
    return sizeof *it;
}

static uint16_t check_vibration(fdvv_image_check *check, const fdvv_settings *settings)
{
    const fdvv_vibration *it = fdvv_image_vibration(check->image, (uint8_t)check->at++);
    (void)settings;
    FDVV_VIBRATION_RANGES(CHECK)
    REQUIRE(it->slot < fdvv_image_head(check->image)->slots, slot)
    REQUIRE(it->states >> fdvv_image_head(check->image)->states == 0, states)
    return sizeof *it;
}

static uint16_t check_slot(fdvv_image_check *check, const fdvv_settings *settings)
{
    const fdvv_slot *it = fdvv_image_slot(check->image, (uint8_t)check->at++);
    (void)settings;
    FDVV_SLOT_RANGES(CHECK)
    if (it->waveform == FDVV_WAVEFORM_DECAYING_SINE) {
        REQUIRE(it->wave_at == 0, wave_at)
        REQUIRE(it->wave_samples == 0, wave_samples)
    } else {
        REQUIRE(it->wave_samples > 0, wave_samples)
        REQUIRE(in_pool(check, it->wave_at, it->wave_samples), wave_at)
    }
    return sizeof *it;
}

/* Number of records in the table of this stage. */
static uint8_t record_count(const fdvv_image_header *head, uint8_t stage)
{
    switch (stage) {
    case SURFACES: return head->surfaces;
    case STATES: return head->states;
    case TRANSITIONS: return head->transitions;
    case VIBRATIONS: return head->vibrations;
    default: return head->slots;
    }
}

static uint16_t check_piece(fdvv_image_check *check, const fdvv_settings *settings)
{
    static uint16_t (*const stages[DONE])(fdvv_image_check *, const fdvv_settings *) = {
        check_head,  check_checksum,   check_counts,    check_surface, check_forces,
        check_state, check_transition, check_vibration, check_slot,
    };
    uint8_t table = check->stage >= SURFACES && check->stage != FORCES;
    if (!table || check->at < record_count(fdvv_image_head(check->image), check->stage))
        return stages[check->stage](check, settings);
    enter(check, check->stage == SURFACES ? STATES : (uint8_t)(check->stage + 1));
    if (check->stage == DONE)
        check->result = FDVV_REFUSAL_NONE;
    return 0;
}

void fdvv_image_check_begin(fdvv_image_check *check, const uint8_t *image, uint16_t size_bytes, uint32_t crc32)
{
    uint8_t is_valid_size =
        size_bytes >= sizeof(fdvv_image_header) && size_bytes <= FDVV_IMAGE_BYTES && size_bytes % 4 == 0;
    check->image = image;
    check->size_bytes = size_bytes;
    check->announced_crc32 = crc32;
    check->crc32 = 0;
    check->travel_limit_um16 = INT32_MAX;
    check->detail = is_valid_size ? 0 : (uint16_t)offsetof(fdvv_image_header, size_bytes);
    check->result = is_valid_size ? FDVV_REFUSAL_BUSY : FDVV_REFUSAL_IMAGE_LAYOUT;
    enter(check, HEAD);
}

uint8_t fdvv_image_check_step(fdvv_image_check *check, const fdvv_settings *settings, uint16_t bytes)
{
    uint32_t checked_bytes = 0;
    while (check->result == FDVV_REFUSAL_BUSY) {
        checked_bytes += check_piece(check, settings);
        if (checked_bytes >= bytes)
            break;
    }
    return check->result;
}
