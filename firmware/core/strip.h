/* The LED strip's task: a bullet moves towards a target zone, and the times of key presses are recorded. It has no
 * hardware access: the board passes in time, bytes and edges, and shows the picture. */
#ifndef FDVV_STRIP_H
#define FDVV_STRIP_H

#include "small_frame.h"
#include "strip_protocol.h"

enum { FDVV_STRIP_NOWHERE = 255 };

/* Content of a frame of `pixels` pixels: those from first to last (none if first is FDVV_STRIP_NOWHERE) in one colour,
 * the bullet on top of them in another. A colour has the four bytes of an APA102. */
typedef struct {
    uint8_t pixels, first, last, bullet;
    uint8_t lit[4], bullet_colour[4];
} fdvv_strip_picture;

typedef struct {
    fdvv_strip_picture picture;
    fdvv_strip_begin_request rules;
    uint32_t begun_us, start_us, target_us, end_us;
    uint32_t bullet_us;         /* when the frame of the bullet's next step must start */
    uint32_t heard_us;          /* when the last complete frame of the host arrived */
    uint32_t frame_us;          /* when the next refresh must start */
    uint32_t edges, bad_frames;
    int32_t asynchronies_us[FDVV_STRIP_PRESSES];
    uint16_t frames, late_us;
    uint8_t step;               /* next pixel of the bullet */
    uint8_t mode, presses, flags;
    uint8_t is_known;           /* the host uses this protocol */
    uint8_t byte_us16;          /* time to send a byte to the strip, 1/16 us */
    fdvv_small_reader reader;
    uint8_t out[FDVV_SMALL_STUFFED_BYTES], out_at, out_end;
} fdvv_strip;

/* flags: FDVV_STRIP_BOARD_FLAG_…, cause of the reset. */
void fdvv_strip_init(fdvv_strip *strip, uint8_t flags, uint8_t byte_us16);

/* Call often. */
void fdvv_strip_tick(fdvv_strip *strip, uint32_t now_us);

/* The key line rose at this time; call in order of time. */
void fdvv_strip_edge(fdvv_strip *strip, uint32_t time_us);

/* 1 if a frame with strip->picture must be sent now; call fdvv_strip_sent when it has been sent. */
uint8_t fdvv_strip_frame(fdvv_strip *strip, uint32_t now_us);
void fdvv_strip_sent(fdvv_strip *strip);

/* Time until the bullet's next frame; UINT32_MAX if no bullet is moving. */
uint32_t fdvv_strip_spare_us(const fdvv_strip *strip, uint32_t now_us);

/* -- link: strip_link.c */

/* 1 if a byte is accepted, which is not the case until the last reply has been sent. */
uint8_t fdvv_strip_listens(const fdvv_strip *strip);
void fdvv_strip_receive(fdvv_strip *strip, uint8_t byte, uint32_t now_us, uint8_t key);

/* Returns 1 and the next byte to send, or 0 if there is none. */
uint8_t fdvv_strip_transmit(fdvv_strip *strip, uint8_t *byte);

/* -- commands of the link */

/* Start a round with checked rules. */
void fdvv_strip_begin(fdvv_strip *strip, const fdvv_strip_begin_request *rules, uint32_t now_us);
void fdvv_strip_stop(fdvv_strip *strip, uint32_t now_us);
void fdvv_strip_show(fdvv_strip *strip, const fdvv_strip_show_request *request, uint32_t now_us);
uint8_t fdvv_strip_is_playing(const fdvv_strip *strip);

#endif
