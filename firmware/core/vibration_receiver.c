#include "vibration_receiver.h"

enum { IDLE, COLLECTING, OVER };

#define PLAY_HEADER FDVV_VIBRATION_HEADER(FDVV_VIBRATION_PLAY, FDVV_VIBRATION_PLAY_BYTES)

/* four bits at a time: a table of 16 bytes, and fast enough to check the last byte of a PLAY in a few microseconds */
static const uint8_t nibbles[16] = {0x00, 0x07, 0x0E, 0x09, 0x1C, 0x1B, 0x12, 0x15,
                                    0x38, 0x3F, 0x36, 0x31, 0x24, 0x23, 0x2A, 0x2D};

uint8_t fdvv_vibration_checksum(uint8_t checksum, uint8_t byte) {
    uint8_t rest = (uint8_t)(checksum ^ byte);
    rest = (uint8_t)((rest << 4) ^ nibbles[rest >> 4]);
    return (uint8_t)((rest << 4) ^ nibbles[rest >> 4]);
}

void fdvv_vibration_init(fdvv_vibration_receiver *receiver, fdvv_synth_bank *bank) {
    fdvv_synth_init(bank);
    receiver->bank = bank;
    receiver->state = IDLE;
    receiver->received = receiver->checksum = 0;
    receiver->accepted = receiver->errors = 0;
}

void fdvv_vibration_begin(fdvv_vibration_receiver *receiver) {
    fdvv_vibration_end(receiver);
    receiver->state = COLLECTING;
    receiver->received = receiver->checksum = 0;
}

void fdvv_vibration_end(fdvv_vibration_receiver *receiver) {
    /* an address without data is a bus scan */
    if (receiver->state == COLLECTING && receiver->received) receiver->errors++;
    receiver->state = IDLE;
}

static uint16_t number(const uint8_t *bytes) {
    return (uint16_t)(bytes[0] | (uint16_t)((uint16_t)bytes[1] << 8));
}

static uint8_t execute_set(fdvv_synth_bank *bank, const uint8_t *payload) {
    fdvv_synth_slot slot;
    slot.waveform = payload[1];
    slot.frequency_Hz16 = number(payload + 2);
    slot.duration_samples = number(payload + 4);
    slot.amplitude_counts = number(payload + 6);
    slot.decay_q16 = number(payload + 8);
    slot.wave_at = number(payload + 10);
    slot.wave_samples = number(payload + 12);
    return fdvv_synth_set(bank, payload[0], &slot);
}

static uint8_t execute(fdvv_vibration_receiver *receiver) {
    const uint8_t *payload = receiver->message + 1;
    const uint8_t command = receiver->message[0] >> 5, bytes = receiver->message[0] & 31u;
    if (command == FDVV_VIBRATION_PLAY && bytes == FDVV_VIBRATION_PLAY_BYTES)
        return payload[0] < FDVV_SYNTH_SLOTS && receiver->bank->slots[payload[0]].duration_samples;
    if (command == FDVV_VIBRATION_SET && bytes == FDVV_VIBRATION_SET_BYTES)
        return execute_set(receiver->bank, payload);
    if (command == FDVV_VIBRATION_LOAD && bytes > 2u && bytes <= 2u + FDVV_VIBRATION_LOAD_SAMPLES)
        return fdvv_synth_load(receiver->bank, number(payload), payload + 2, (uint8_t)(bytes - 2u));
    return 0;
}

static uint8_t finish(fdvv_vibration_receiver *receiver, uint8_t byte) {
    /* further bytes of an invalid message are not counted again */
    receiver->state = IDLE;
    if (byte != receiver->checksum || !execute(receiver)) {
        receiver->errors++;
        return FDVV_VIBRATION_NOTHING;
    }
    receiver->state = OVER;
    receiver->accepted++;
    return receiver->message[0] >> 5 == FDVV_VIBRATION_PLAY ? FDVV_VIBRATION_RIGHT : FDVV_VIBRATION_NOTHING;
}

static uint8_t collect(fdvv_vibration_receiver *receiver, uint8_t byte) {
    receiver->message[receiver->received++] = byte;
    receiver->checksum = fdvv_vibration_checksum(receiver->checksum, byte);
    if (receiver->message[0] != PLAY_HEADER || receiver->received == 1) return FDVV_VIBRATION_NOTHING;
    return receiver->received == 2 ? FDVV_VIBRATION_SLOT : FDVV_VIBRATION_STRENGTH;
}

uint8_t fdvv_vibration_byte(fdvv_vibration_receiver *receiver, uint8_t byte) {
    if (receiver->state == OVER) {
        receiver->errors++;
        receiver->state = IDLE;
    }
    if (receiver->state == IDLE) return FDVV_VIBRATION_NOTHING;
    if (receiver->received && receiver->received == (receiver->message[0] & 31u) + 1u)
        return finish(receiver, byte);
    return collect(receiver, byte);
}

fdvv_vibration_status fdvv_vibration_report(const fdvv_vibration_receiver *receiver, uint8_t flags) {
    fdvv_vibration_status status = {FDVV_VIBRATION_VERSION, flags, receiver->accepted, receiver->errors, 0};
    const uint8_t bytes[4] = {status.version, status.flags, status.accepted, status.errors};
    for (uint8_t i = 0; i < sizeof bytes; i++) status.checksum = fdvv_vibration_checksum(status.checksum, bytes[i]);
    return status;
}
