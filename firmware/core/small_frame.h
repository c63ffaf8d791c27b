/* The frames of frame.h for boards with little memory: buffers for one frame, and no table. */
#ifndef FDVV_SMALL_FRAME_H
#define FDVV_SMALL_FRAME_H

#include <stdint.h>

enum { FDVV_SMALL_FRAME_BYTES = 64, FDVV_SMALL_STUFFED_BYTES = FDVV_SMALL_FRAME_BYTES + 2 };

/* what a byte completed */
enum { FDVV_SMALL_FRAME_NOTHING, FDVV_SMALL_FRAME_WHOLE, FDVV_SMALL_FRAME_BAD };

/* A frame being received; after FDVV_SMALL_FRAME_WHOLE it is valid until the next byte. */
typedef struct {
    uint8_t bytes[FDVV_SMALL_FRAME_BYTES]; /* id, sequence, payload, checksum */
    uint8_t length;                        /* bytes so far */
    uint8_t left;                          /* bytes until the next code byte */
    uint8_t begun;                         /* a code byte was received */
    uint8_t broken;                        /* too long, or ended too early */
    uint8_t ended;                         /* the next byte starts another frame */
} fdvv_small_reader;

void fdvv_small_reader_reset(fdvv_small_reader *reader);
uint8_t fdvv_small_take(fdvv_small_reader *reader, uint8_t byte);

/* Encode `count` bytes (id, sequence, payload; at most FDVV_SMALL_FRAME_BYTES - 2) with their checksum into `stuffed`
 * (FDVV_SMALL_STUFFED_BYTES). Returns the number of bytes to send, including the final zero. */
uint8_t fdvv_small_put(const uint8_t *bytes, uint8_t count, uint8_t *stuffed);

#endif
