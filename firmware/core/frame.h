/* Frames on a byte stream: id, sequence, payload, CRC-16 (CCITT: polynomial 0x1021, start 0xffff, not
 * reflected), stuffed (COBS) and ended by a zero byte. */
#ifndef FDVV_FRAME_H
#define FDVV_FRAME_H

#include "protocol.h"

#define FDVV_FRAME_PAYLOAD_BYTES (FDVV_FRAME_BYTES - 4)
#define FDVV_RING_BYTES 512 /* a power of two: some telemetry frames and room for replies */

/* what bytes completed */
enum { FDVV_FRAME_NOTHING, FDVV_FRAME_WHOLE, FDVV_FRAME_BAD };

#define FDVV_FRAME_WORDS ((FDVV_FRAME_BYTES + 2 + 3) / 4)

/* A frame as it arrives. It starts two bytes into `words`, so that the payload may be read in place. */
typedef struct {
    uint32_t words[FDVV_FRAME_WORDS];
    uint16_t length;  /* bytes so far */
    uint8_t left;     /* bytes until the next code byte */
    uint8_t begun;    /* a code byte was seen */
    uint8_t broken;   /* too long */
    uint8_t ended;    /* the next byte begins another frame */
} fdvv_frame_reader;

/* Bytes on their way out. */
typedef struct {
    uint8_t bytes[FDVV_RING_BYTES];
    uint16_t head, tail; /* free running */
} fdvv_ring;

void fdvv_frame_reader_reset(fdvv_frame_reader *reader);

/* Take bytes up to the end of a frame, tell how many and what they completed. After FDVV_FRAME_WHOLE the frame
 * stays readable until the next call. */
uint16_t fdvv_frame_take(fdvv_frame_reader *reader, const uint8_t *bytes, uint16_t count, uint8_t *found);

const uint8_t *fdvv_frame_bytes(const fdvv_frame_reader *reader);

/* Give the payload, aligned to four bytes, and its length. */
const void *fdvv_frame_payload(const fdvv_frame_reader *reader, uint16_t *count);

void fdvv_ring_reset(fdvv_ring *ring);
uint16_t fdvv_ring_room(const fdvv_ring *ring);

/* Move at most `room` bytes out and tell how many. */
uint16_t fdvv_ring_take(fdvv_ring *ring, uint8_t *bytes, uint16_t room);

/* Stuff one frame into the ring; the caller has made sure of count + 6 bytes of room. */
void fdvv_frame_put(fdvv_ring *ring, uint8_t id, uint8_t sequence, const void *payload, uint16_t count);

#endif
