/* Requests from the host and their replies. */
#include "strip.h"

#include "ranges.h"

enum { REPLY = 0x80, FIRMWARE = 0x000100 /* 0.1.0 */, HEAD_BYTES = 2 };

typedef struct {
    uint8_t refusal;
    uint8_t bytes; /* of the reply's payload */
    uint16_t detail;
} outcome;

/* the payload of any reply */
typedef union {
    fdvv_strip_hello_reply hello;
    fdvv_strip_status_reply status;
    fdvv_strip_begin_reply begin;
    fdvv_strip_read_round_reply round;
    fdvv_strip_refused_reply refused;
} reply;

static void copy(void *to, const void *from, uint8_t count)
{
    while (count--)
        ((uint8_t *)to)[count] = ((const uint8_t *)from)[count];
}

static outcome done(uint8_t bytes)
{
    outcome result = {FDVV_STRIP_REFUSAL_NONE, 0, 0};
    result.bytes = bytes;
    return result;
}

static outcome refuse(uint8_t refusal, uint16_t detail)
{
    outcome result = {0, 0, 0};
    result.refusal = refusal;
    result.detail = detail;
    return result;
}

static outcome reply_hello(fdvv_strip *strip, const uint8_t *payload, reply *out)
{
    static const char name[sizeof out->hello.name] = "uno-strip";
    fdvv_strip_hello_request request;
    copy(&request, payload, sizeof request);
    strip->is_known = request.hash == FDVV_STRIP_PROTOCOL_HASH;
    out->hello.hash = FDVV_STRIP_PROTOCOL_HASH;
    out->hello.firmware = FIRMWARE;
    out->hello.most_pixels = FDVV_STRIP_MOST_PIXELS;
    out->hello.mode = strip->mode;
    out->hello.flags = strip->flags;
    copy(out->hello.name, name, sizeof name);
    return done(sizeof out->hello);
}

static outcome reply_status(const fdvv_strip *strip, uint32_t now_us, uint8_t key, reply *out)
{
    out->status.time_us = now_us;
    out->status.edges = strip->edges;
    out->status.bad_frames = strip->bad_frames;
    out->status.key = key;
    out->status.mode = strip->mode;
    out->status.flags = strip->flags;
    out->status.spare = 0;
    return done(sizeof out->status);
}

/* 0, or the number (from 1) of the first field that is out of range. */
static uint8_t find_invalid_rule(const fdvv_strip_begin_request *rules)
{
    uint8_t number = 1;
#define CHECK(field, low, high) \
    number++; \
    if (fdvv_outside(rules->field, low, high)) return number;
    FDVV_STRIP_BEGIN_REQUEST_RANGES(CHECK)
#undef CHECK
    if (rules->zone_half_px >= rules->zone_px) return 7;
    return rules->zone_px + rules->zone_half_px >= rules->pixels ? 6 : 0;
}

static outcome reply_times(const fdvv_strip *strip, reply *out)
{
    out->begin.start_us = strip->start_us;
    out->begin.target_us = strip->target_us;
    out->begin.end_us = strip->end_us;
    return done(sizeof out->begin);
}

/* The same round again means that the reply was lost and the request was repeated. */
static outcome begin(fdvv_strip *strip, const uint8_t *payload, uint32_t now_us, reply *out)
{
    fdvv_strip_begin_request rules;
    uint8_t invalid;
    copy(&rules, payload, sizeof rules);
    if (fdvv_strip_is_playing(strip) && rules.round == strip->rules.round)
        return reply_times(strip, out);
    if (fdvv_strip_is_playing(strip))
        return refuse(FDVV_STRIP_REFUSAL_BUSY, strip->rules.round);
    invalid = find_invalid_rule(&rules);
    if (invalid)
        return refuse(FDVV_STRIP_REFUSAL_BAD_VALUE, invalid);
    fdvv_strip_begin(strip, &rules, now_us);
    return reply_times(strip, out);
}

static outcome reply_round(const fdvv_strip *strip, reply *out)
{
    out->round.round = strip->rules.round;
    out->round.mode = strip->mode;
    out->round.presses = strip->presses;
    out->round.start_us = strip->start_us;
    out->round.target_us = strip->target_us;
    out->round.frames = strip->frames;
    out->round.late_us = strip->late_us;
    copy(out->round.asynchronies_us, strip->asynchronies_us, sizeof out->round.asynchronies_us);
    return done(sizeof out->round);
}

static outcome show(fdvv_strip *strip, const uint8_t *payload, uint32_t now_us)
{
    fdvv_strip_show_request picture;
    copy(&picture, payload, sizeof picture);
    if (fdvv_strip_is_playing(strip))
        return refuse(FDVV_STRIP_REFUSAL_BUSY, strip->rules.round);
    if (fdvv_outside(picture.count, 0, FDVV_STRIP_LIT_PIXELS) || picture.first + picture.count > FDVV_STRIP_MOST_PIXELS)
        return refuse(FDVV_STRIP_REFUSAL_BAD_VALUE, 2);
    if (fdvv_outside(picture.brightness, 1, 31))
        return refuse(FDVV_STRIP_REFUSAL_BAD_VALUE, 6);
    fdvv_strip_show(strip, &picture, now_us);
    return done(0);
}

/* Payload size of a request; 255 for an unknown message. */
static uint8_t request_bytes(uint8_t message)
{
    switch (message) {
#define CASE(name, id, request, reply) case id: return id == FDVV_STRIP_MSG_REFUSED ? 255 : request;
        FDVV_STRIP_MESSAGES(CASE)
#undef CASE
    default:
        return 255;
    }
}

static outcome execute(fdvv_strip *strip, uint32_t now_us, uint8_t key, reply *out)
{
    const uint8_t message = strip->reader.bytes[0], *payload = strip->reader.bytes + HEAD_BYTES;
    uint8_t expected = request_bytes(message);
    if (expected == 255)
        return refuse(FDVV_STRIP_REFUSAL_UNKNOWN_MESSAGE, 0);
    if (strip->reader.length != expected + HEAD_BYTES + 2)
        return refuse(FDVV_STRIP_REFUSAL_BAD_LENGTH, strip->reader.length);
    if (message == FDVV_STRIP_MSG_HELLO)
        return reply_hello(strip, payload, out);
    if (!strip->is_known)
        return refuse(FDVV_STRIP_REFUSAL_HASH_MISMATCH, 0);
    if (message == FDVV_STRIP_MSG_STATUS)
        return reply_status(strip, now_us, key, out);
    if (message == FDVV_STRIP_MSG_BEGIN)
        return begin(strip, payload, now_us, out);
    if (message == FDVV_STRIP_MSG_READ_ROUND)
        return reply_round(strip, out);
    if (message == FDVV_STRIP_MSG_SHOW)
        return show(strip, payload, now_us);
    fdvv_strip_stop(strip, now_us);
    return done(0);
}

static void reply_to(fdvv_strip *strip, uint32_t now_us, uint8_t key)
{
    uint8_t frame[HEAD_BYTES + sizeof(reply)];
    reply out;
    outcome result = execute(strip, now_us, key, &out);
    frame[0] = (uint8_t)(strip->reader.bytes[0] + REPLY);
    frame[1] = strip->reader.bytes[1];
    if (result.refusal) {
        frame[0] = FDVV_STRIP_MSG_REFUSED + REPLY;
        out.refused.request = strip->reader.bytes[0];
        out.refused.refusal = result.refusal;
        out.refused.detail = result.detail;
        result.bytes = sizeof out.refused;
    }
    copy(frame + HEAD_BYTES, &out, result.bytes);
    strip->out_at = 0;
    strip->out_end = fdvv_small_put(frame, (uint8_t)(HEAD_BYTES + result.bytes), strip->out);
}

uint8_t fdvv_strip_listens(const fdvv_strip *strip)
{
    return strip->out_at == strip->out_end;
}

void fdvv_strip_receive(fdvv_strip *strip, uint8_t byte, uint32_t now_us, uint8_t key)
{
    uint8_t result = fdvv_small_take(&strip->reader, byte);
    if (result == FDVV_SMALL_FRAME_BAD)
        strip->bad_frames++;
    if (result != FDVV_SMALL_FRAME_WHOLE)
        return;
    strip->heard_us = now_us;
    reply_to(strip, now_us, key);
}

uint8_t fdvv_strip_transmit(fdvv_strip *strip, uint8_t *byte)
{
    if (strip->out_at == strip->out_end)
        return 0;
    *byte = strip->out[strip->out_at++];
    return 1;
}
