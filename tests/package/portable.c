/* What must come out the same, bit for bit, on every system: fits and the firmware's ticks. Prints a sum of each. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../firmware/boards/host/board.h"
#include "../../packages/fdvv/src/fdvv/_native/fdvv.h"

static uint64_t sum = 14695981039346656037u;

static void add(const void *bytes, size_t count)
{
    const unsigned char *byte = bytes;
    while (count--)
        sum = (sum ^ *byte++) * 1099511628211u;
}

static void tell(const char *name)
{
    printf("%s %08lx%08lx\n", name, (unsigned long)(sum >> 32), (unsigned long)(sum & 0xffffffffu));
}

static void fits(void)
{
    static double x[800], y[800], w[800], t[68], c[64];
    int i, degree, size;
    for (i = 0; i < 800; i++) {
        x[i] = i * 0.005;
        y[i] = (i * 7919) % 101 - 0.25 * i;
        w[i] = 1.0;
    }
    for (degree = 1; degree <= 3; degree++)
        for (size = degree + 1; size <= 64; size += 6) {
            double error = fdvv_spline_free_knots(800, x, y, w, degree, size, 0.004, 5, t, c);
            add(&error, sizeof error);
            add(t, (size_t)(size + degree + 1) * sizeof *t);
            add(c, (size_t)size * sizeof *c);
        }
    tell("fits");
}

static void ticks(void)
{
    fdvv_host *host = fdvv_host_new();
    uint32_t drawn = 1, tick;
    for (tick = 0; tick < 20000; tick++) {
        fdvv_inputs inputs;
        fdvv_outputs outputs;
        memset(&inputs, 0, sizeof inputs);
        drawn = drawn * 1664525u + 1013904223u;
        inputs.time_us = tick * 250;
        inputs.lowest = inputs.highest = (uint16_t)(1000 + (drawn >> 20));
        inputs.supply_mV = 12000;
        fdvv_host_tick(host, &inputs, &outputs);
        add(&outputs, sizeof outputs);
    }
    fdvv_host_free(host);
    tell("ticks");
}

int main(void)
{
    fits();
    ticks();
    return 0;
}
