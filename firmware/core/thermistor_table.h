/* Made by tools/make_thermistor.py; do not edit. Rise of the thermistor above
 * 15 C in K, times 256, every 64 counts of 4096; it is at most
 * 3 K off, and that is added: never too cold. */
#ifndef FDVV_THERMISTOR_TABLE_H
#define FDVV_THERMISTOR_TABLE_H

#include <stdint.h>

enum { THERMISTOR_STEP_BITS = 6, THERMISTOR_MARGIN_K = 3 };

static const uint16_t thermistor_rise_K_q8[65] = {
    65535, 46190, 35739, 30349, 26782, 24137, 22044, 20314, 18840, 17556,
    16417, 15392, 14460, 13603, 12809, 12069, 11374, 10718, 10096,  9503,
     8936,  8391,  7867,  7361,  6870,  6393,  5928,  5475,  5031,  4595,
     4167,  3745,  3328,  2917,  2508,  2103,  1699,  1297,   895,   492,
       88,     0,     0,     0,     0,     0,     0,     0,     0,     0,
        0,     0,     0,     0,     0,     0,     0,     0,     0,     0,
        0,     0,     0,     0,     0,
};

#endif
