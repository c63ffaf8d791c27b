#include "strip.h"

/* blue, green, red: a green zone, a white bullet */
enum { ZONE_BLUE = 0, ZONE_GREEN = 160, ZONE_RED = 0, BULLET = 255, HEAD = 0xE0 };
enum { REFRESH_us = 50000, LONGEST_FRAME_us = 3000, HEAD_BYTES = 4, PIXEL_BYTES = 4, LATCH_BYTES = 4 };

static void colour(uint8_t *bytes, uint8_t brightness, uint8_t blue, uint8_t green, uint8_t red)
{
    bytes[0] = (uint8_t)(HEAD | brightness);
    bytes[1] = blue;
    bytes[2] = green;
    bytes[3] = red;
}

static uint8_t has_come(uint32_t time_us, uint32_t now_us)
{
    return (int32_t)(now_us - time_us) >= 0;
}

static void go_dark(fdvv_strip *strip, uint8_t mode, uint32_t now_us)
{
    strip->mode = mode;
    strip->picture.first = strip->picture.last = strip->picture.bullet = FDVV_STRIP_NOWHERE;
    strip->frame_us = now_us;
}

/* When the bullet comes to a pixel, to the nearest microsecond. */
static uint32_t step_us(const fdvv_strip *strip, uint8_t pixel)
{
    uint32_t speed = strip->rules.speed_px_s;
    return strip->start_us + (pixel * 1000000ul + speed / 2) / speed;
}

/* How long before a step its frame begins, so that the bullet's pixel shows it in time; beyond the strip as for its
 * last pixel. */
static uint32_t lead_us(const fdvv_strip *strip, uint8_t pixel)
{
    uint16_t shown = pixel < strip->rules.pixels ? pixel : (uint16_t)(strip->rules.pixels - 1);
    uint16_t bytes = (uint16_t)(HEAD_BYTES + PIXEL_BYTES * (shown + 1));
    if (strip->rules.led == FDVV_STRIP_LED_TOGETHER)
        bytes = (uint16_t)(HEAD_BYTES + PIXEL_BYTES * strip->rules.pixels + LATCH_BYTES);
    return ((uint32_t)bytes * strip->byte_us16) >> 4;
}

void fdvv_strip_init(fdvv_strip *strip, uint8_t flags, uint8_t byte_us16)
{
    uint16_t i;
    for (i = 0; i < sizeof *strip; i++)
        ((uint8_t *)strip)[i] = 0;
    strip->flags = flags;
    strip->byte_us16 = byte_us16;
    strip->picture.pixels = FDVV_STRIP_MOST_PIXELS;
    fdvv_small_reader_reset(&strip->reader);
    go_dark(strip, FDVV_STRIP_MODE_IDLE, 0);
}

/* A division takes 40 us on an 8-bit processor: once per step, when its frame is not waited for. */
static void plan_step(fdvv_strip *strip)
{
    strip->bullet_us = step_us(strip, strip->step) - lead_us(strip, strip->step);
}

uint8_t fdvv_strip_is_playing(const fdvv_strip *strip)
{
    return strip->mode == FDVV_STRIP_MODE_WAITING || strip->mode == FDVV_STRIP_MODE_MOVING;
}

void fdvv_strip_begin(fdvv_strip *strip, const fdvv_strip_begin_request *rules, uint32_t now_us)
{
    strip->rules = *rules;
    strip->begun_us = now_us;
    strip->start_us = now_us + rules->delay_ms * 1000ul;
    strip->target_us = step_us(strip, rules->zone_px);
    strip->end_us = strip->target_us + rules->after_ms * 1000ul;
    strip->presses = strip->step = 0;
    plan_step(strip);
    strip->frames = strip->late_us = 0;
    strip->mode = FDVV_STRIP_MODE_WAITING;
    strip->picture.pixels = rules->pixels;
    strip->picture.first = (uint8_t)(rules->zone_px - rules->zone_half_px);
    strip->picture.last = (uint8_t)(rules->zone_px + rules->zone_half_px);
    strip->picture.bullet = FDVV_STRIP_NOWHERE;
    colour(strip->picture.lit, rules->brightness, ZONE_BLUE, ZONE_GREEN, ZONE_RED);
    colour(strip->picture.bullet_colour, rules->brightness, BULLET, BULLET, BULLET);
    strip->frame_us = now_us;
}

void fdvv_strip_stop(fdvv_strip *strip, uint32_t now_us)
{
    go_dark(strip, FDVV_STRIP_MODE_IDLE, now_us);
}

void fdvv_strip_show(fdvv_strip *strip, const fdvv_strip_show_request *order, uint32_t now_us)
{
    go_dark(strip, FDVV_STRIP_MODE_SHOWING, now_us);
    strip->picture.pixels = FDVV_STRIP_MOST_PIXELS;
    colour(strip->picture.lit, order->brightness, order->blue, order->green, order->red);
    if (!order->count)
        return;
    strip->picture.first = order->first;
    strip->picture.last = (uint8_t)(order->first + order->count - 1);
}

void fdvv_strip_edge(fdvv_strip *strip, uint32_t time_us)
{
    strip->edges++;
    /* an edge is told a little after it came, and then the round may have begun */
    if (!fdvv_strip_is_playing(strip) || has_come(strip->end_us, time_us) || !has_come(strip->begun_us, time_us))
        return;
    if (strip->presses < FDVV_STRIP_PRESSES)
        strip->asynchronies_us[strip->presses] = (int32_t)(time_us - strip->target_us);
    if (strip->presses < 255)
        strip->presses++;
}

void fdvv_strip_tick(fdvv_strip *strip, uint32_t now_us)
{
    if (strip->mode == FDVV_STRIP_MODE_IDLE || strip->mode == FDVV_STRIP_MODE_LOST)
        return;
    if (now_us - strip->heard_us > FDVV_STRIP_HOST_TIMEOUT_MS * 1000ul) {
        strip->end_us = fdvv_strip_is_playing(strip) ? now_us : strip->end_us;
        go_dark(strip, FDVV_STRIP_MODE_LOST, now_us);
    } else if (strip->mode == FDVV_STRIP_MODE_WAITING && has_come(strip->start_us, now_us)) {
        strip->mode = FDVV_STRIP_MODE_MOVING;
    } else if (strip->mode == FDVV_STRIP_MODE_MOVING && has_come(strip->end_us, now_us)) {
        strip->mode = FDVV_STRIP_MODE_OVER;
        strip->picture.bullet = FDVV_STRIP_NOWHERE;
        strip->frame_us = now_us;
    }
}

/* -- frames ------------------------------------------------------------------------------------------- */

static uint8_t is_bound(const fdvv_strip *strip)
{
    return fdvv_strip_is_playing(strip) && strip->step <= strip->rules.pixels;
}

uint32_t fdvv_strip_spare_us(const fdvv_strip *strip, uint32_t now_us)
{
    if (!is_bound(strip))
        return UINT32_MAX;
    return has_come(strip->bullet_us, now_us) ? 0 : strip->bullet_us - now_us;
}

/* The bullet's next step: one pixel beyond the strip it is gone. */
static void take_step(fdvv_strip *strip, uint32_t late_us)
{
    strip->picture.bullet = strip->step < strip->rules.pixels ? strip->step : FDVV_STRIP_NOWHERE;
    strip->step++;
    strip->frames++;
    if (late_us > strip->late_us)
        strip->late_us = late_us < UINT16_MAX ? (uint16_t)late_us : UINT16_MAX;
}

uint8_t fdvv_strip_frame(fdvv_strip *strip, uint32_t now_us)
{
    uint32_t spare_us = fdvv_strip_spare_us(strip, now_us);
    if (!spare_us)
        take_step(strip, now_us - strip->bullet_us);
    else if (!has_come(strip->frame_us, now_us) || spare_us < LONGEST_FRAME_us)
        return 0; /* a frame that only repeats must be over when the bullet's begins */
    strip->frame_us = now_us + REFRESH_us;
    return 1;
}

void fdvv_strip_sent(fdvv_strip *strip)
{
    if (is_bound(strip))
        plan_step(strip);
}
