/* The vibration board's side of vibration_wire.h: bytes in, slots and requests to play out. */
#ifndef FDVV_VIBRATION_RECEIVER_H
#define FDVV_VIBRATION_RECEIVER_H

#include "synth.h"
#include "vibration_wire.h"

/* What a byte brought. SLOT and STRENGTH of a PLAY are not yet checked; they are told so that the voice can be made
 * ready while the rest travels. RIGHT: they were. */
enum { FDVV_VIBRATION_NOTHING, FDVV_VIBRATION_SLOT, FDVV_VIBRATION_STRENGTH, FDVV_VIBRATION_RIGHT };

typedef struct {
    fdvv_synth_bank *bank;
    uint8_t message[FDVV_VIBRATION_MESSAGE_BYTES];
    uint8_t state;
    uint8_t received; /* bytes of this message */
    uint8_t checksum; /* of these bytes: what the next is if it is the last */
    uint8_t accepted, errors;
} fdvv_vibration_receiver;

/* Begin with no message, counting from zero. */
void fdvv_vibration_init(fdvv_vibration_receiver *receiver, fdvv_synth_bank *bank);

/* A START with the board's address: begin a message, counting one that was cut off. */
void fdvv_vibration_begin(fdvv_vibration_receiver *receiver);

/* Take one byte and say what it brought; a slot or a strength is that byte. */
uint8_t fdvv_vibration_byte(fdvv_vibration_receiver *receiver, uint8_t byte);

/* A STOP, or the bus in trouble: a message that is not complete is counted. */
void fdvv_vibration_end(fdvv_vibration_receiver *receiver);

/* Give the status, its checksum included. */
fdvv_vibration_status fdvv_vibration_report(const fdvv_vibration_receiver *receiver, uint8_t flags);

#endif
