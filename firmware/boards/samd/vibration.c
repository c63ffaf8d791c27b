#include "vibration.h"

#include "board.h"
#include "image.h"
#include "vibration_wire.h"

enum { ROOM_FOR_PLAY = 2, FULL_STRENGTH = 255 };

/* progress of sending the waveforms of a program */
static struct {
    const uint8_t *image; /* 0: nothing to send */
    uint16_t pool_at;     /* end of the waves sent so far in the board's pool */
    uint16_t sent;        /* samples of the wave of this slot */
    uint8_t slot;
} load;

static void send(uint8_t command, const uint8_t *payload, uint8_t count)
{
    uint8_t bytes[FDVV_VIBRATION_MESSAGE_BYTES], checksum, i;
    bytes[0] = FDVV_VIBRATION_HEADER(command, count);
    checksum = fdvv_vibration_checksum(0, bytes[0]);
    for (i = 0; i < count; i++) {
        bytes[1 + i] = payload[i];
        checksum = fdvv_vibration_checksum(checksum, payload[i]);
    }
    bytes[1 + count] = checksum;
    board_wire_send(FDVV_VIBRATION_ADDRESS, bytes, (uint8_t)(count + 2));
}

void vibration_play(uint8_t slot)
{
    const uint8_t payload[FDVV_VIBRATION_PLAY_BYTES] = {slot, FULL_STRENGTH};
    send(FDVV_VIBRATION_PLAY, payload, sizeof payload);
}

void vibration_silence(void)
{
    const uint8_t payload[FDVV_VIBRATION_PLAY_BYTES] = {0, 0};
    send(FDVV_VIBRATION_PLAY, payload, sizeof payload);
}

void vibration_load(const uint8_t *image)
{
    load.image = image;
    load.pool_at = load.sent = load.slot = 0;
}

static void send_samples(const fdvv_slot *slot)
{
    uint8_t payload[2 + FDVV_VIBRATION_LOAD_SAMPLES], i;
    uint16_t left = (uint16_t)(slot->wave_samples - load.sent), at = (uint16_t)(load.pool_at + load.sent);
    uint8_t count = left < FDVV_VIBRATION_LOAD_SAMPLES ? (uint8_t)left : FDVV_VIBRATION_LOAD_SAMPLES;
    payload[0] = (uint8_t)at;
    payload[1] = (uint8_t)(at >> 8);
    for (i = 0; i < count; i++) payload[2 + i] = load.image[slot->wave_at + load.sent + i];
    load.sent = (uint16_t)(load.sent + count);
    send(FDVV_VIBRATION_LOAD, payload, (uint8_t)(2 + count));
}

static void send_slot(const fdvv_slot *slot)
{
    const uint16_t numbers[] = {slot->frequency_Hz16, slot->duration_samples, slot->amplitude_counts,
                                slot->decay_q16, slot->wave_samples ? load.pool_at : 0, slot->wave_samples};
    uint8_t payload[FDVV_VIBRATION_SET_BYTES] = {load.slot, slot->waveform}, i;
    for (i = 0; i < 6; i++) {
        payload[2 + 2 * i] = (uint8_t)numbers[i];
        payload[3 + 2 * i] = (uint8_t)(numbers[i] >> 8);
    }
    send(FDVV_VIBRATION_SET, payload, sizeof payload);
    load.pool_at = (uint16_t)(load.pool_at + slot->wave_samples);
    load.sent = 0;
    load.slot++;
}

void vibration_step(void)
{
    const fdvv_slot *slot;
    if (!load.image || board_wire_room() < ROOM_FOR_PLAY) return;
    if (load.slot == fdvv_image_head(load.image)->slots) {
        load.image = 0;
        return;
    }
    slot = fdvv_image_slot(load.image, load.slot);
    if (load.sent < slot->wave_samples) {
        send_samples(slot);
    } else {
        send_slot(slot);
    }
}
