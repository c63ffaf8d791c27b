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

static uint8_t is_past(uint32_t time_us, uint32_t now_us)
{
    return (int32_t)(now_us - time_us) >= 0;
}

static void turn_off(fdvv_strip *strip, uint8_t mode, uint32_t now_us)
{
    strip->mode = mode;
    strip->picture.first = strip->picture.last = strip->picture.bullet = FDVV_STRIP_NOWHERE;
    strip->frame_us = now_us;
}

/* Time when the bullet reaches a pixel, rounded to microseconds. */
static uint32_t step_us(const fdvv_strip *strip, uint8_t pixel)
{
    uint32_t speed = strip->rules.speed_px_s;
    return strip->start_us + (pixel * 1000000ul + speed / 2) / speed;
}

/* Time from the start of a frame until the bullet's pixel shows it. A position beyond the strip counts as its last
 * pixel. */
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
    turn_off(strip, FDVV_STRIP_MODE_IDLE, 0);
}

/* A division takes 40 us on an 8-bit processor, so this is done once per step, while there is time. */
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
    turn_off(strip, FDVV_STRIP_MODE_IDLE, now_us);
}

void fdvv_strip_show(fdvv_strip *strip, const fdvv_strip_show_request *request, uint32_t now_us)
{
    turn_off(strip, FDVV_STRIP_MODE_SHOWING, now_us);
    strip->picture.pixels = FDVV_STRIP_MOST_PIXELS;
    colour(strip->picture.lit, request->brightness, request->blue, request->green, request->red);
    if (!request->count)
        return;
    strip->picture.first = request->first;
    strip->picture.last = (uint8_t)(request->first + request->count - 1);
}

void fdvv_strip_edge(fdvv_strip *strip, uint32_t time_us)
{
    strip->edges++;
    /* an edge is reported with a delay, so the round may have started after it */
    if (!fdvv_strip_is_playing(strip) || is_past(strip->end_us, time_us) || !is_past(strip->begun_us, time_us))
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
        turn_off(strip, FDVV_STRIP_MODE_LOST, now_us);
    } else if (strip->mode == FDVV_STRIP_MODE_WAITING && is_past(strip->start_us, now_us)) {
        strip->mode = FDVV_STRIP_MODE_MOVING;
    } else if (strip->mode == FDVV_STRIP_MODE_MOVING && is_past(strip->end_us, now_us)) {
        strip->mode = FDVV_STRIP_MODE_OVER;
        strip->picture.bullet = FDVV_STRIP_NOWHERE;
        strip->frame_us = now_us;
    }
}

/* -- frames ------------------------------------------------------------------------------------------- */

static uint8_t has_next_step(const fdvv_strip *strip)
{
    return fdvv_strip_is_playing(strip) && strip->step <= strip->rules.pixels;
}

uint32_t fdvv_strip_spare_us(const fdvv_strip *strip, uint32_t now_us)
{
    if (!has_next_step(strip))
        return UINT32_MAX;
    return is_past(strip->bullet_us, now_us) ? 0 : strip->bullet_us - now_us;
}

/* Move the bullet by one pixel; it disappears at the end of the strip. */
static void advance_bullet(fdvv_strip *strip, uint32_t late_us)
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
        advance_bullet(strip, now_us - strip->bullet_us);
    else if (!is_past(strip->frame_us, now_us) || spare_us < LONGEST_FRAME_us)
        return 0; /* a refresh must end before the bullet's next frame starts */
    strip->frame_us = now_us + REFRESH_us;
    return 1;
}

void fdvv_strip_sent(fdvv_strip *strip)
{
    if (has_next_step(strip))
        plan_step(strip);
}
