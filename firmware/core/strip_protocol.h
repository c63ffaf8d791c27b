/* Made by tools/make_protocol.py from protocol/strip.toml; do not edit. */
#ifndef FDVV_STRIP_PROTOCOL_H
#define FDVV_STRIP_PROTOCOL_H

#include <stdint.h>

#define FDVV_STRIP_PROTOCOL_VERSION 1
#define FDVV_STRIP_PROTOCOL_HASH 0xfeae5a1eu

#define FDVV_STRIP_FRAME_BYTES 64 /* largest frame before stuffing: id, sequence, payload, checksum */
#define FDVV_STRIP_MOST_PIXELS 240 /* longest strip */
#define FDVV_STRIP_PRESSES 8 /* presses of a round that are kept; more are counted */
#define FDVV_STRIP_LIT_PIXELS 16 /* most pixels lit at once by show: a strip all white would take 8 A */
#define FDVV_STRIP_HOST_TIMEOUT_MS 500 /* silence of the host after which the strip goes dark */

/* what the board is at */
enum {
    FDVV_STRIP_MODE_IDLE = 0,
    FDVV_STRIP_MODE_WAITING = 1,
    FDVV_STRIP_MODE_MOVING = 2,
    FDVV_STRIP_MODE_OVER = 3,
    FDVV_STRIP_MODE_SHOWING = 4,
    FDVV_STRIP_MODE_LOST = 5,
    FDVV_STRIP_MODES = 6,
};

/* why a request was not carried out */
enum {
    FDVV_STRIP_REFUSAL_NONE = 0,
    FDVV_STRIP_REFUSAL_UNKNOWN_MESSAGE = 1,
    FDVV_STRIP_REFUSAL_BAD_LENGTH = 2,
    FDVV_STRIP_REFUSAL_BAD_VALUE = 3,
    FDVV_STRIP_REFUSAL_BUSY = 4,
    FDVV_STRIP_REFUSAL_HASH_MISMATCH = 5,
    FDVV_STRIP_REFUSALS = 6,
};

/* when a pixel shows what it was sent */
enum {
    FDVV_STRIP_LED_EACH = 0,
    FDVV_STRIP_LED_TOGETHER = 1,
    FDVV_STRIP_LEDS = 2,
};

/* bits of what happened to the board */
enum {
    FDVV_STRIP_BOARD_FLAG_WATCHDOG = 1 << 0,
    FDVV_STRIP_BOARD_FLAG_EDGES_LOST = 1 << 1,
};

/* who are you; must be the first request (request) */
typedef struct {
    uint16_t version; /* 0 to 65535 */
    uint16_t spare; /*  */
    uint32_t hash; /* 0 to 4294967295; of this definition */
} fdvv_strip_hello_request;
typedef char fdvv_strip_hello_request_has_8_bytes[sizeof(fdvv_strip_hello_request) == 8 ? 1 : -1];
#define FDVV_STRIP_HELLO_REQUEST_RANGES(X) \
    X(spare, 0, 0) \


/* who are you; must be the first request (reply) */
typedef struct {
    uint32_t hash; /* 0 to 4294967295; of the definition the board was built from */
    uint32_t firmware; /* 0 to 4294967295; version, major.minor.patch in bytes 2, 1, 0 */
    uint16_t most_pixels; /* px; 0 to 65535; longest strip */
    uint8_t mode; /* 0 to 5 */
    uint8_t flags; /* 0 to 255; bits of flags.board */
    uint8_t name[16]; /* ASCII; 0 to 126; kind of board */
} fdvv_strip_hello_reply;
typedef char fdvv_strip_hello_reply_has_28_bytes[sizeof(fdvv_strip_hello_reply) == 28 ? 1 : -1];
#define FDVV_STRIP_HELLO_REPLY_RANGES(X) \
    X(mode, 0, 5) \


/* I am here; how are you (reply) */
typedef struct {
    uint32_t time_us; /* us; 0 to 4294967295; the board's clock */
    uint32_t edges; /* 0 to 4294967295; of the key line since boot */
    uint32_t bad_frames; /* 0 to 4294967295; received with checksum, stuffing or length wrong */
    uint8_t key; /* 0 to 1; level of the key line */
    uint8_t mode; /* 0 to 5 */
    uint8_t flags; /* 0 to 255; bits of flags.board */
    uint8_t spare; /*  */
} fdvv_strip_status_reply;
typedef char fdvv_strip_status_reply_has_16_bytes[sizeof(fdvv_strip_status_reply) == 16 ? 1 : -1];
#define FDVV_STRIP_STATUS_REPLY_RANGES(X) \
    X(key, 0, 1) \
    X(mode, 0, 5) \
    X(spare, 0, 0) \


/* play a round: show the zone, after the delay let the bullet run; the round that is already played only has its result repeated (request) */
typedef struct {
    uint16_t round; /* 0 to 65535; the host's number, another for every round */
    uint16_t speed_px_s; /* px/s; 20 to 200; of the bullet; a frame of the longest strip must fit into a step with time to spare */
    uint16_t delay_ms; /* ms; 50 to 10000; from now to the bullet's start */
    uint16_t after_ms; /* ms; 50 to 5000; from the target's time to the end of the round */
    uint8_t pixels; /* px; 8 to 240; length of the strip */
    uint8_t zone_px; /* px; 1 to 239; the zone's middle, counted from 0, reached at the target's time; all of the zone must lie on the strip */
    uint8_t zone_half_px; /* px; 0 to 7; pixels of the zone on either side of it */
    uint8_t brightness; /* 1/31; 1 to 31; of the pixels that are lit */
    uint8_t led; /* 0 to 1; kind of pixel */
    uint8_t spare; /*  */
} fdvv_strip_begin_request;
typedef char fdvv_strip_begin_request_has_14_bytes[sizeof(fdvv_strip_begin_request) == 14 ? 1 : -1];
#define FDVV_STRIP_BEGIN_REQUEST_RANGES(X) \
    X(speed_px_s, 20, 200) \
    X(delay_ms, 50, 10000) \
    X(after_ms, 50, 5000) \
    X(pixels, 8, 240) \
    X(zone_px, 1, 239) \
    X(zone_half_px, 0, 7) \
    X(brightness, 1, 31) \
    X(led, 0, 1) \
    X(spare, 0, 0) \


/* play a round: show the zone, after the delay let the bullet run; the round that is already played only has its result repeated (reply) */
typedef struct {
    uint32_t start_us; /* us; 0 to 4294967295; the bullet appears at pixel 0 */
    uint32_t target_us; /* us; 0 to 4294967295; it reaches the zone's middle */
    uint32_t end_us; /* us; 0 to 4294967295; presses are taken until then */
} fdvv_strip_begin_reply;
typedef char fdvv_strip_begin_reply_has_12_bytes[sizeof(fdvv_strip_begin_reply) == 12 ? 1 : -1];
#define FDVV_STRIP_BEGIN_REPLY_RANGES(X) \


/* how does the round go, or how did it (reply) */
typedef struct {
    uint16_t round; /* 0 to 65535; the host's number */
    uint8_t mode; /* 0 to 5 */
    uint8_t presses; /* 0 to 255; rising edges of the key line since the round began; 255 and more */
    uint32_t start_us; /* us; 0 to 4294967295; the bullet appeared at pixel 0 */
    uint32_t target_us; /* us; 0 to 4294967295; it reached the zone's middle */
    uint16_t frames; /* 0 to 65535; sent for steps of the bullet */
    uint16_t late_us; /* us; 0 to 65535; the latest of them was begun so long after its time */
    uint8_t asynchronies_us[32]; /* 0 to 255; eight i32: the first presses' times less the target's, us */
} fdvv_strip_read_round_reply;
typedef char fdvv_strip_read_round_reply_has_48_bytes[sizeof(fdvv_strip_read_round_reply) == 48 ? 1 : -1];
#define FDVV_STRIP_READ_ROUND_REPLY_RANGES(X) \
    X(mode, 0, 5) \


/* light a few pixels, to check the strip; not during a round (request) */
typedef struct {
    uint8_t first; /* px; 0 to 239; first pixel lit */
    uint8_t count; /* px; 0 to 16; how many */
    uint8_t red; /* 0 to 255 */
    uint8_t green; /* 0 to 255 */
    uint8_t blue; /* 0 to 255 */
    uint8_t brightness; /* 1/31; 1 to 31 */
} fdvv_strip_show_request;
typedef char fdvv_strip_show_request_has_6_bytes[sizeof(fdvv_strip_show_request) == 6 ? 1 : -1];
#define FDVV_STRIP_SHOW_REQUEST_RANGES(X) \
    X(first, 0, 239) \
    X(count, 0, 16) \
    X(brightness, 1, 31) \


/* reply to a request that was not carried out (sent as id + 0x80) (reply) */
typedef struct {
    uint8_t request; /* 0 to 255; id */
    uint8_t refusal; /* 0 to 255 */
    uint16_t detail; /* 0 to 65535; number of the field */
} fdvv_strip_refused_reply;
typedef char fdvv_strip_refused_reply_has_4_bytes[sizeof(fdvv_strip_refused_reply) == 4 ? 1 : -1];
#define FDVV_STRIP_REFUSED_REPLY_RANGES(X) \


/* name, id, bytes of the request (or of what is sent unasked), bytes of the reply */
#define FDVV_STRIP_MESSAGES(X) \
    X(HELLO, 0x01, 8, 28) \
    X(STATUS, 0x02, 0, 16) \
    X(BEGIN, 0x03, 14, 12) \
    X(READ_ROUND, 0x04, 0, 48) \
    X(STOP, 0x05, 0, 0) \
    X(SHOW, 0x06, 6, 0) \
    X(REFUSED, 0x7f, 0, 4) \

enum {
    FDVV_STRIP_MSG_HELLO = 0x01, /* who are you; must be the first request */
    FDVV_STRIP_MSG_STATUS = 0x02, /* I am here; how are you */
    FDVV_STRIP_MSG_BEGIN = 0x03, /* play a round: show the zone, after the delay let the bullet run; the round that is already played only has its result repeated */
    FDVV_STRIP_MSG_READ_ROUND = 0x04, /* how does the round go, or how did it */
    FDVV_STRIP_MSG_STOP = 0x05, /* end the round or what is shown; go dark */
    FDVV_STRIP_MSG_SHOW = 0x06, /* light a few pixels, to check the strip; not during a round */
    FDVV_STRIP_MSG_REFUSED = 0x7f, /* reply to a request that was not carried out (sent as id + 0x80) */
};

#endif
