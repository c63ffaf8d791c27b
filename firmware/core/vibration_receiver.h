/* Receiver of the messages of vibration_wire.h on the vibration board. */
#ifndef FDVV_VIBRATION_RECEIVER_H
#define FDVV_VIBRATION_RECEIVER_H

#include "synth.h"
#include "vibration_wire.h"

/* Result of a byte. SLOT and STRENGTH of a PLAY are reported before the checksum, so that the voice can be prepared
 * while the rest is being received. RIGHT: the PLAY was valid. */
enum { FDVV_VIBRATION_NOTHING, FDVV_VIBRATION_SLOT, FDVV_VIBRATION_STRENGTH, FDVV_VIBRATION_RIGHT };

typedef struct {
    fdvv_synth_bank *bank;
    uint8_t message[FDVV_VIBRATION_MESSAGE_BYTES];
    uint8_t state;
    uint8_t received; /* bytes of this message */
    uint8_t checksum; /* of these bytes */
    uint8_t accepted, errors;
} fdvv_vibration_receiver;

/* Reset to no message; the counters start at zero. */
void fdvv_vibration_init(fdvv_vibration_receiver *receiver, fdvv_synth_bank *bank);

/* START with the address of the board: begin a message. An incomplete previous one is counted as an error. */
void fdvv_vibration_begin(fdvv_vibration_receiver *receiver);

/* Process one byte. Returns its result (FDVV_VIBRATION_…); a slot or a strength is the byte itself. */
uint8_t fdvv_vibration_byte(fdvv_vibration_receiver *receiver, uint8_t byte);

/* STOP, or a bus error: an incomplete message is counted as an error. */
void fdvv_vibration_end(fdvv_vibration_receiver *receiver);

/* The status with its checksum. */
fdvv_vibration_status fdvv_vibration_report(const fdvv_vibration_receiver *receiver, uint8_t flags);

#endif
