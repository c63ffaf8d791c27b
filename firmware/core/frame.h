/* Frames on a byte stream: id, sequence, payload, CRC-16/CCITT-FALSE (polynomial 0x1021, initial value 0xffff, not
 * reflected), encoded with COBS and terminated by a zero byte. */
#ifndef FDVV_FRAME_H
#define FDVV_FRAME_H

#include "protocol.h"

#define FDVV_FRAME_PAYLOAD_BYTES (FDVV_FRAME_BYTES - 4)
#define FDVV_RING_BYTES 512 /* a power of two; holds some telemetry frames and replies */

/* what the bytes completed */
enum { FDVV_FRAME_NOTHING, FDVV_FRAME_WHOLE, FDVV_FRAME_BAD };

#define FDVV_FRAME_WORDS ((FDVV_FRAME_BYTES + 2 + 3) / 4)

/* A frame being received. It starts at the third byte of `words`, so that the payload is aligned. */
typedef struct {
    uint32_t words[FDVV_FRAME_WORDS];
    uint16_t length;  /* bytes so far */
    uint8_t left;     /* bytes until the next code byte */
    uint8_t begun;    /* a code byte was received */
    uint8_t broken;   /* too long */
    uint8_t ended;    /* the next byte starts another frame */
} fdvv_frame_reader;

/* Bytes to be sent. */
typedef struct {
    uint8_t bytes[FDVV_RING_BYTES];
    uint16_t head, tail; /* free running */
} fdvv_ring;

void fdvv_frame_reader_reset(fdvv_frame_reader *reader);

/* Process bytes up to the end of a frame; returns their number and what they completed (FDVV_FRAME_…). After
 * FDVV_FRAME_WHOLE the frame is valid until the next call. */
uint16_t fdvv_frame_take(fdvv_frame_reader *reader, const uint8_t *bytes, uint16_t count, uint8_t *result);

const uint8_t *fdvv_frame_bytes(const fdvv_frame_reader *reader);

/* The payload, aligned to four bytes, and its length. */
const void *fdvv_frame_payload(const fdvv_frame_reader *reader, uint16_t *count);

void fdvv_ring_reset(fdvv_ring *ring);
uint16_t fdvv_ring_room(const fdvv_ring *ring);

/* Remove at most `room` bytes; returns their number. */
uint16_t fdvv_ring_take(fdvv_ring *ring, uint8_t *bytes, uint16_t room);

/* Append one encoded frame. The caller ensures that there are count + 6 bytes of room. */
void fdvv_frame_put(fdvv_ring *ring, uint8_t id, uint8_t sequence, const void *payload, uint16_t count);

#endif
