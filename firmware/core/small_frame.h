/* The frames of frame.h for boards with little memory: one frame in, one out, no table. */
#ifndef FDVV_SMALL_FRAME_H
#define FDVV_SMALL_FRAME_H

#include <stdint.h>

enum { FDVV_SMALL_FRAME_BYTES = 64, FDVV_SMALL_STUFFED_BYTES = FDVV_SMALL_FRAME_BYTES + 2 };

/* what a byte completed */
enum { FDVV_SMALL_FRAME_NOTHING, FDVV_SMALL_FRAME_WHOLE, FDVV_SMALL_FRAME_BAD };

/* A frame as it arrives; after FDVV_SMALL_FRAME_WHOLE readable until the next byte. */
typedef struct {
    uint8_t bytes[FDVV_SMALL_FRAME_BYTES]; /* id, sequence, payload, checksum */
    uint8_t length;                        /* of them so far */
    uint8_t left;                          /* bytes until the next code byte */
    uint8_t begun;                         /* a code byte was seen */
    uint8_t broken;                        /* too long, or ended too early */
    uint8_t ended;                         /* the next byte begins another frame */
} fdvv_small_reader;

void fdvv_small_reader_reset(fdvv_small_reader *reader);
uint8_t fdvv_small_take(fdvv_small_reader *reader, uint8_t byte);

/* Put checksum and stuffing to `count` bytes (id, sequence, payload; at most FDVV_SMALL_FRAME_BYTES - 2) and tell
 * how many bytes of `stuffed` (FDVV_SMALL_STUFFED_BYTES) are to be sent, the ending zero among them. */
uint8_t fdvv_small_put(const uint8_t *bytes, uint8_t count, uint8_t *stuffed);

#endif
