/* The LED strip's board for Python: the firmware without hardware. */
#include "strip.h"

#include <stdlib.h>

enum { BYTE_us16 = 46 }; /* as on the board */

fdvv_strip *fdvv_strip_bridge_new(void) {
    fdvv_strip *strip = calloc(1, sizeof *strip);
    if (strip) fdvv_strip_init(strip, 0, BYTE_us16);
    return strip;
}

void fdvv_strip_bridge_free(fdvv_strip *strip) { free(strip); }

/* Advance to a time. Returns the pixel of the bullet, or FDVV_STRIP_NOWHERE. */
uint8_t fdvv_strip_bridge_run(fdvv_strip *strip, uint32_t now_us) {
    fdvv_strip_tick(strip, now_us);
    if (fdvv_strip_frame(strip, now_us)) fdvv_strip_sent(strip);
    return strip->picture.bullet;
}

/* Process received bytes and write the replies; `replies` has room for 70 bytes per received byte. Returns the number
 * of bytes written. */
uint32_t fdvv_strip_bridge_receive(fdvv_strip *strip, const uint8_t *bytes, uint32_t count, uint32_t now_us, uint8_t key,
                                   uint8_t *replies) {
    uint32_t written = 0;
    for (uint32_t i = 0; i < count; i++) {
        fdvv_strip_receive(strip, bytes[i], now_us, key);
        while (fdvv_strip_transmit(strip, replies + written)) written++;
    }
    return written;
}
