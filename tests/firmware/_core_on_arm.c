/* The core alone on a Cortex-M, called function by function from an emulator: no board, no start-up.
 *
 * The table at the first address tells where everything is.
 */
#include "core.h"

#define TICKS 256

static fdvv_core core;
static fdvv_settings settings;
static fdvv_board_limits limits;
static uint32_t image[FDVV_IMAGE_BYTES / 4];
static fdvv_inputs inputs[TICKS];
static fdvv_outputs outputs[TICKS];

static void begin(void)
{
    fdvv_core_init(&core, &settings, &limits);
    fdvv_core_activate(&core, (const uint8_t *)image);
    fdvv_supervisor_ask(&core.supervisor, &core.settings, FDVV_ASK_BOOTED, 0);
    fdvv_supervisor_ask(&core.supervisor, &core.settings, FDVV_ASK_ARM, 0);
}

static uint32_t check(uint32_t size_bytes, uint32_t crc32)
{
    fdvv_image_check state;
    uint8_t result;
    fdvv_image_check_begin(&state, (const uint8_t *)image, (uint16_t)size_bytes, crc32);
    do result = fdvv_image_check_step(&state, &core.settings, 256);
    while (result == FDVV_REFUSAL_BUSY);
    return result;
}

static void event(uint32_t number)
{
    fdvv_core_event(&core, (uint8_t)number);
}

static void announce(uint32_t velocity_mm_s16)
{
    fdvv_core_announce(&core, (uint16_t)velocity_mm_s16);
}

static void run(uint32_t ticks)
{
    for (uint32_t i = 0; i < ticks; i++) {
        fdvv_supervisor_host_seen(&core.supervisor, inputs[i].time_us);
        fdvv_core_tick(&core, &inputs[i], &outputs[i]);
        fdvv_core_after_tick(&core, &inputs[i]);
    }
}

#ifdef FDVV_FORCE_LOOP
static fdvv_force_loop_gains gains;

static void close_loop(void)
{
    fdvv_core_close_loop(&core, &gains);
}
#endif

typedef void (*function)(void);

__attribute__((section(".table"), used)) static const struct {
    uint32_t ticks;
    void *data[5];
    function functions[5];
#ifdef FDVV_FORCE_LOOP
    void *gains;
    function close_loop;
#endif
} table = {
    TICKS,
    {&settings, image, inputs, outputs, &limits},
    {(function)begin, (function)check, (function)event, (function)announce, (function)run},
#ifdef FDVV_FORCE_LOOP
    &gains,
    (function)close_loop,
#endif
};
