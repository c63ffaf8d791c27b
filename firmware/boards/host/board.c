#include "board.h"

#include <stdlib.h>

#include "link_state.h"

struct fdvv_host {
    fdvv_board_limits limits;
    fdvv_core core;
    fdvv_link link;
    fdvv_board board;
    fdvv_read_counters_reply counters;
    fdvv_inputs inputs;   /* of the last tick */
    uint8_t slot;         /* requested by the host, started with the next tick */
};

static fdvv_host *current; /* for the callbacks, which have no argument for it */

static uint32_t now_us(void)
{
    return current->inputs.time_us;
}

static void play(uint8_t slot)
{
    current->slot = slot;
}

static void set_result(fdvv_selftest_reply *reply, uint8_t part, uint8_t verdict, int32_t value)
{
    reply->verdicts[part] = verdict;
    reply->values[2 * part] = (uint8_t)value;
    reply->values[2 * part + 1] = (uint8_t)(value >> 8);
}

/* Tests the last readings only; nothing moves. */
static uint8_t selftest(fdvv_selftest_reply *reply)
{
    const fdvv_settings *settings = &current->core.settings;
    const fdvv_inputs *inputs = &current->inputs;
    uint8_t in_range = inputs->lowest >= settings->reading_low && inputs->highest <= settings->reading_high;
    uint8_t supplied = inputs->supply_mV >= settings->supply_low_mV && inputs->supply_mV <= settings->supply_high_mV;
    set_result(reply, FDVV_PART_POSITION_SENSOR, in_range ? FDVV_VERDICT_PASSED : FDVV_VERDICT_FAILED,
               inputs->lowest);
    set_result(reply, FDVV_PART_SUPPLY, supplied ? FDVV_VERDICT_PASSED : FDVV_VERDICT_FAILED, inputs->supply_mV);
    set_result(reply, FDVV_PART_FORCE_SENSOR,
               settings->force_gain_q14 ? FDVV_VERDICT_NOT_TESTED : FDVV_VERDICT_ABSENT, 0);
    set_result(reply, FDVV_PART_CLOCK, FDVV_VERDICT_PASSED, settings->tick_us);
    return 1;
}

static void describe(fdvv_board *board, fdvv_read_counters_reply *counters, uint32_t travel_um16)
{
    static const char name[] = "host";
    uint8_t i;
    board->flags = FDVV_BOARD_FLAG_SIMULATED | FDVV_BOARD_FLAG_VIBRATION | FDVV_BOARD_FLAG_SERVO;
#ifdef FDVV_FORCE_LOOP
    board->flags |= FDVV_BOARD_FLAG_FORCE_LOOP;
#endif
    board->travel_limit_um16_256 = (uint16_t)((travel_um16 + 255) / 256);
    for (i = 0; i < sizeof name; i++)
        board->name[i] = name[i];
    board->selftest = selftest;
    board->play = play;
    board->now_us = now_us;
    board->counters = counters;
}

fdvv_host *fdvv_host_new(const fdvv_board_limits *limits, uint32_t travel_um16)
{
    fdvv_settings settings = FDVV_SETTINGS_DEFAULTS;
    fdvv_host *host = (fdvv_host *)calloc(1, sizeof *host);
    if (!host)
        return 0;
    current = host;
    describe(&host->board, &host->counters, travel_um16);
    host->slot = FDVV_NONE;
    host->limits = *limits;
    fdvv_settings_tighten(&settings, &host->limits);
    fdvv_core_init(&host->core, &settings, &host->limits);
    (void)fdvv_supervisor_ask(&host->core.supervisor, &host->core.settings, FDVV_ASK_BOOTED, 0);
    fdvv_link_init(&host->link, &host->core, &host->board);
    return host;
}

void fdvv_host_free(fdvv_host *host)
{
    free(host);
}

void fdvv_host_tick(fdvv_host *host, const fdvv_inputs *inputs, fdvv_outputs *outputs)
{
    uint8_t i;
    current = host;
    host->inputs = *inputs;
    host->counters.ticks += inputs->elapsed_ticks;
    if (inputs->elapsed_ticks > 1) host->counters.late += inputs->elapsed_ticks - 1u; /* 0 would make it wrap around */
    fdvv_core_tick(&host->core, inputs, outputs);
    fdvv_core_after_tick(&host->core, inputs);
    if (host->slot != FDVV_NONE) {
        outputs->slot = host->slot;
        host->slot = FDVV_NONE;
    }
    fdvv_link_tick(&host->link, inputs, outputs);
    for (i = 0; i < FDVV_HOST_WORK; i++)
        fdvv_link_work(&host->link);
}

uint16_t fdvv_host_receive(fdvv_host *host, const uint8_t *bytes, uint16_t count)
{
    current = host;
    return fdvv_link_receive(&host->link, bytes, count);
}

uint16_t fdvv_host_transmit(fdvv_host *host, uint8_t *bytes, uint16_t room)
{
    return fdvv_link_transmit(&host->link, bytes, room);
}

const uint8_t *fdvv_host_program(const fdvv_host *host)
{
    return host->core.image;
}

uint16_t fdvv_host_announced_mm_s16(const fdvv_host *host)
{
    return host->core.announced_mm_s16;
}

void fdvv_host_unplug(fdvv_host *host)
{
    current = host;
    fdvv_link_reset(&host->link);
}
