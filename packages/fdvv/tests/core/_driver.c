/* The core as a program of its own: settings, limits, an image and inputs on stdin, outputs on stdout. Armed whenever
 * possible, so that faults do not end the run. */
#include "core.h"

#include <stdio.h>

static uint32_t words[FDVV_IMAGE_BYTES / 4];

static void rearm(fdvv_core *core)
{
    fdvv_supervisor *supervisor = &core->supervisor;
    if (supervisor->mode == FDVV_MODE_FAULT)
        fdvv_supervisor_ask(supervisor, &core->settings, FDVV_ASK_CLEAR, supervisor->fault);
    fdvv_supervisor_ask(supervisor, &core->settings, FDVV_ASK_BOOTED, 0);
    fdvv_supervisor_ask(supervisor, &core->settings, FDVV_ASK_ARM, 0);
}

int main(void)
{
    fdvv_settings settings;
    fdvv_board_limits limits;
    fdvv_inputs inputs;
    fdvv_outputs outputs;
    fdvv_core core;
    uint32_t size_bytes;
    while (fread(&settings, sizeof settings, 1, stdin) == 1) {
        uint32_t count;
        if (fread(&limits, sizeof limits, 1, stdin) != 1 || fdvv_settings_check(&settings, &limits) ||
            fread(&size_bytes, 4, 1, stdin) != 1 || size_bytes > sizeof words ||
            fread(words, 1, size_bytes, stdin) != size_bytes || fread(&count, 4, 1, stdin) != 1)
            return 1;
        fdvv_core_init(&core, &settings, &limits);
        fdvv_core_activate(&core, (const uint8_t *)words);
        for (; count; count--) {
            if (fread(&inputs, sizeof inputs, 1, stdin) != 1)
                return 1;
            fdvv_supervisor_host_seen(&core.supervisor, inputs.time_us);
            rearm(&core);
            fdvv_core_event(&core, (uint8_t)(inputs.sum & 31));
            fdvv_core_tick(&core, &inputs, &outputs);
            if (fwrite(&outputs, sizeof outputs, 1, stdout) != 1)
                return 1;
        }
    }
    return 0;
}
