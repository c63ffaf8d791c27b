/* The LED strip's board: a bullet that runs towards a zone, and when the key went down meanwhile. Time, bytes and
 * edges are given to it; what it wants shown, it says. */
#ifndef FDVV_STRIP_H
#define FDVV_STRIP_H

#include "small_frame.h"
#include "strip_protocol.h"

enum { FDVV_STRIP_NOWHERE = 255 };

/* What a frame shows: `pixels` of them, those from first to last (none if first is FDVV_STRIP_NOWHERE) in one
 * colour, the bullet over them in another. A colour is four bytes as an APA102 takes them. */
typedef struct {
    uint8_t pixels, first, last, bullet;
    uint8_t lit[4], bullet_colour[4];
} fdvv_strip_picture;

typedef struct {
    fdvv_strip_picture picture;
    fdvv_strip_begin_request rules;
    uint32_t begun_us, start_us, target_us, end_us;
    uint32_t bullet_us;         /* when the frame of the bullet's next step is to begin */
    uint32_t heard_us;          /* the last whole frame of the host */
    uint32_t frame_us;          /* when the next other frame is to begin */
    uint32_t edges, bad_frames;
    int32_t asynchronies_us[FDVV_STRIP_PRESSES];
    uint16_t frames, late_us;
    uint8_t step;               /* the pixel where the next frame shows the bullet */
    uint8_t mode, presses, flags;
    uint8_t is_known;           /* the host speaks this protocol */
    uint8_t byte_us16;          /* time that a byte takes to the strip, 1/16 us */
    fdvv_small_reader reader;
    uint8_t out[FDVV_SMALL_STUFFED_BYTES], out_at, out_end;
} fdvv_strip;

/* flags: FDVV_STRIP_BOARD_FLAG_… of the reset. */
void fdvv_strip_init(fdvv_strip *strip, uint8_t flags, uint8_t byte_us16);

/* Let time pass; often. */
void fdvv_strip_tick(fdvv_strip *strip, uint32_t now_us);

/* The key line rose at a time, which is told in order. */
void fdvv_strip_edge(fdvv_strip *strip, uint32_t time_us);

/* 1 if a frame of strip->picture is to begin now; tell with fdvv_strip_sent when it is out. */
uint8_t fdvv_strip_frame(fdvv_strip *strip, uint32_t now_us);
void fdvv_strip_sent(fdvv_strip *strip);

/* Time until the bullet's next frame; large if no bullet is under way. */
uint32_t fdvv_strip_spare_us(const fdvv_strip *strip, uint32_t now_us);

/* -- link: strip_link.c */

/* 1 if a byte would be taken: not before the last reply has left. */
uint8_t fdvv_strip_listens(const fdvv_strip *strip);
void fdvv_strip_receive(fdvv_strip *strip, uint8_t byte, uint32_t now_us, uint8_t key);

/* Give 1 and the next byte to send, if there is one. */
uint8_t fdvv_strip_transmit(fdvv_strip *strip, uint8_t *byte);

/* -- what the link asks for */

/* Begin a round with checked rules. */
void fdvv_strip_begin(fdvv_strip *strip, const fdvv_strip_begin_request *rules, uint32_t now_us);
void fdvv_strip_stop(fdvv_strip *strip, uint32_t now_us);
void fdvv_strip_show(fdvv_strip *strip, const fdvv_strip_show_request *order, uint32_t now_us);
uint8_t fdvv_strip_is_playing(const fdvv_strip *strip);

#endif
