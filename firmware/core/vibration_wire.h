/* The I2C messages between the rig's controller (master) and the vibration board (slave).
 *
 * To the board: header, payload, checksum; one message from START to STOP.
 *   header    command * 32 + bytes of payload
 *   checksum  CRC-8 of header and payload: polynomial x^8 + x^2 + x + 1, initial value 0, not reflected, not inverted
 * Two-byte numbers are little-endian. The board executes a message when it has received the checksum, before the STOP.
 * It ignores and counts a message with a wrong checksum, an unknown command, the wrong length for its command or a
 * value out of range, and an incomplete one. Bytes after the checksum are counted, but the message is executed. */
#ifndef FDVV_VIBRATION_WIRE_H
#define FDVV_VIBRATION_WIRE_H

#include <stdint.h>

#define FDVV_VIBRATION_VERSION 1u
#define FDVV_VIBRATION_ADDRESS 0x2Au
#define FDVV_VIBRATION_BUS_HZ 400000u

#define FDVV_VIBRATION_PLAY 1u /* slot, strength: 255 is the slot's amplitude, 0 silences the board */
#define FDVV_VIBRATION_SET 2u  /* slot, waveform, then six numbers in the order of fdvv_synth_slot */
#define FDVV_VIBRATION_LOAD 3u /* pool address (two bytes), then 1 to 28 samples */

#define FDVV_VIBRATION_PLAY_BYTES 2u /* of payload */
#define FDVV_VIBRATION_SET_BYTES 14u
#define FDVV_VIBRATION_LOAD_SAMPLES 28u
#define FDVV_VIBRATION_MESSAGE_BYTES 33u /* header, 31 of payload, checksum */
#define FDVV_VIBRATION_HEADER(command, bytes) ((uint8_t)((command) * 32u + (bytes)))

/* From the board: five bytes, the last one the checksum of the others. */
#define FDVV_VIBRATION_STATUS_BYTES 5u
#define FDVV_VIBRATION_PLAYING 1u  /* bit of flags: a voice is playing */
#define FDVV_VIBRATION_WATCHDOG 2u /* bit of flags: the last reset was caused by the watchdog; all slots are empty */

typedef struct {
    uint8_t version;
    uint8_t flags;
    uint8_t accepted; /* messages executed since reset, modulo 256 */
    uint8_t errors;   /* messages ignored since reset, modulo 256 */
    uint8_t checksum;
} fdvv_vibration_status;

/* Continue a checksum over one byte; begin with 0. */
uint8_t fdvv_vibration_checksum(uint8_t checksum, uint8_t byte);

#endif
