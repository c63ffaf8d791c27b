/* Controller of the rig: runs a tick as soon as its readings are available, and serves USB, link and vibration board
 * between ticks. */
#include "board.h"
#include "limits.h"
#include "link_state.h"
#include "pins.h"
#include "vibration.h"

enum {
    TRAVEL_LIMIT_UM16 = 99200, /* 6.2 mm, travel of the coil */
    PIECE_BYTES = 16           /* per call, because a byte of a frame takes up to 4 us */
};

static fdvv_core core;
static fdvv_link link;
static fdvv_board board;
static fdvv_read_counters_reply counters;
static fdvv_inputs inputs;       /* of the last tick */
static uint8_t reset_bits;       /* FDVV_BOARD_…: cause of the reset, until it was reported once */
static fdvv_kept_heat kept_heat __attribute__((section(".noinit")));
static uint8_t is_testing;
static uint16_t tick_us;
static uint8_t reads;

static void set_result(fdvv_selftest_reply *reply, uint8_t part, uint8_t verdict, uint16_t value)
{
    reply->verdicts[part] = verdict;
    reply->values[2 * part] = (uint8_t)value;
    reply->values[2 * part + 1] = (uint8_t)(value >> 8);
}

static uint8_t verdict_of(uint8_t is_ok)
{
    return is_ok ? FDVV_VERDICT_PASSED : FDVV_VERDICT_FAILED;
}

/* The vibration board is tested with a command that silences it: when the queue is empty, it has acknowledged it or
 * not. Nothing moves, so coil and force sensor are not tested. */
static uint8_t selftest(fdvv_selftest_reply *reply)
{
    const fdvv_settings *settings = &core.settings;
    if (!is_testing) vibration_silence();
    is_testing = board_wire_room() < BOARD_MESSAGES;
    if (is_testing) return 0;
    uint8_t is_in_range = inputs.lowest >= settings->reading_low && inputs.highest <= settings->reading_high;
    uint8_t is_supplied = inputs.supply_mV >= settings->supply_low_mV && inputs.supply_mV <= settings->supply_high_mV;
    set_result(reply, FDVV_PART_POSITION_SENSOR, verdict_of(is_in_range), inputs.lowest);
    set_result(reply, FDVV_PART_SUPPLY, verdict_of(is_supplied), inputs.supply_mV);
    set_result(reply, FDVV_PART_FORCE_SENSOR,
               settings->force_gain_q14 ? FDVV_VERDICT_NOT_TESTED : FDVV_VERDICT_ABSENT, inputs.force_counts);
    set_result(reply, FDVV_PART_VIBRATION_BOARD, verdict_of(board_wire_answers()), (uint16_t)board_wire_errors());
    set_result(reply, FDVV_PART_CLOCK, verdict_of(inputs.time_us != 0), tick_us);
    set_result(reply, FDVV_PART_THERMISTOR,
               FDVV_THERMISTOR(&core.supervisor, is_fitted) ? verdict_of(FDVV_THERMISTOR(&core.supervisor, is_known)) : FDVV_VERDICT_ABSENT,
               inputs.thermistor_counts);
    return 1;
}

static void describe(void)
{
    static const char name[] = BOARD_NAME;
    board.serial = board_serial();
    board.flags = FDVV_BOARD_FLAG_FORCE_SENSOR | FDVV_BOARD_FLAG_VIBRATION | FDVV_BOARD_FLAG_SERVO;
#ifdef FDVV_FORCE_LOOP
    static const fdvv_load_cell cell = BOARD_CELL;
    board.flags |= FDVV_BOARD_FLAG_FORCE_LOOP;
    board.cell = &cell;
#endif
    board.travel_limit_um16_256 = (TRAVEL_LIMIT_UM16 + 255) / 256;
    for (unsigned i = 0; i < sizeof name; i++) board.name[i] = name[i];
    board.selftest = selftest;
    board.load_slots = vibration_load;
    board.play = vibration_play;
    board.now_us = board_now_us;
    board.counters = &counters;
}

static uint8_t board_errors(void)
{
    uint8_t bits = reset_bits;
    reset_bits = 0;
    if (board_drive_fault()) bits |= FDVV_BOARD_OUTPUT;
    if (!board_wire_answers()) bits |= FDVV_BOARD_VIBRATION;
    return bits;
}

static void set_inputs(const board_readings *readings)
{
    inputs.time_us = readings->time_us;
    inputs.sum = readings->sum;
    inputs.lowest = readings->lowest;
    inputs.highest = readings->highest;
    inputs.elapsed_ticks = readings->elapsed_ticks;
    inputs.supply_mV = readings->supply_mV;
    inputs.force_counts = readings->force_counts;
    inputs.thermistor_counts = readings->thermistor_counts;
    inputs.board = board_errors();
}

static void update_counters(const board_readings *readings)
{
    uint32_t served_us = board_now_us() - readings->time_us;
    if (served_us > counters.worst_tick_us) counters.worst_tick_us = served_us;
    counters.ticks += readings->elapsed_ticks;
    if (readings->elapsed_ticks > 1) counters.late += readings->elapsed_ticks - 1u; /* 0 would make it wrap around */
    counters.vibration_errors = board_wire_errors();
}

/* Returns 1 if there was a tick. */
static uint8_t serve_tick(void)
{
    board_readings readings;
    fdvv_outputs outputs;
    if (!board_acquire(&readings)) return 0;
    set_inputs(&readings);
    fdvv_core_tick(&core, &inputs, &outputs);
    board_key(outputs.key); /* 0 unless rendering, so never down in mode fault */
    board_drive(outputs.duty_q15, outputs.enable);
    fdvv_core_after_tick(&core, &inputs);
    fdvv_heat_keep(&core.supervisor.heat, &kept_heat);
    board_watchdog_clear();
    update_counters(&readings);
    board_stop(outputs.stop_us);
    if (outputs.slot != FDVV_NONE) vibration_play(outputs.slot);
    fdvv_link_tick(&link, &inputs, &outputs);
    return 1;
}

/* New settings may change the tick. The link accepts them only while idle or in mode fault. */
static void apply_settings(void)
{
    if (tick_us == core.settings.tick_us && reads == core.settings.reads) return;
    tick_us = core.settings.tick_us;
    reads = core.settings.reads;
    board_acquire_start(tick_us, reads);
}

static void receive(void)
{
    static uint8_t bytes[PIECE_BYTES];
    static uint16_t at, end;
    static uint8_t was_open;
    uint8_t is_open = board_usb_open();
    if (was_open && !is_open) {
        fdvv_link_reset(&link);
        at = end = 0;
    }
    was_open = is_open;
    if (at == end) {
        at = 0;
        end = board_usb_read(bytes, sizeof bytes);
    }
    at = (uint16_t)(at + fdvv_link_receive(&link, bytes + at, (uint16_t)(end - at)));
}

static void transmit(void)
{
    uint8_t bytes[PIECE_BYTES];
    uint16_t room = board_usb_room();
    if (!board_usb_open()) return;
    uint16_t filled = fdvv_link_transmit(&link, bytes, room < sizeof bytes ? room : sizeof bytes);
    if (filled) board_usb_write(bytes, filled);
}

static void work(void)
{
    fdvv_link_work(&link);
    apply_settings();
}

static void drive_vibration(void)
{
    vibration_step();
    board_wire_step(board_now_us());
}

static void start(void)
{
    static const fdvv_board_limits limits = BOARD_LIMITS;
    fdvv_settings settings = FDVV_SETTINGS_DEFAULTS;
    uint8_t cause = board_reset_cause();
    reset_bits = cause == BOARD_RESET_WATCHDOG    ? FDVV_BOARD_WATCHDOG
                 : cause == BOARD_RESET_BROWN_OUT ? FDVV_BOARD_BROWN_OUT
                                                  : 0;
    board_clocks_start();
    board_brown_out_start();
    board_drive_start();
    board_wire_start();
    board_usb_start();
    describe();
    fdvv_settings_tighten(&settings, &limits);
    fdvv_core_init(&core, &settings, &limits);
    fdvv_heat_resume(&core.supervisor.heat, core.supervisor.limits, &kept_heat);
    fdvv_supervisor_ask(&core.supervisor, &core.settings, FDVV_ASK_BOOTED, 0);
    fdvv_link_init(&link, &core, &board);
    vibration_silence();
    apply_settings();
    board_watchdog_start();
}

int main(void)
{
    static void (*const tasks[])(void) = {board_usb_step, receive, work, transmit, drive_vibration};
    start();
    for (;;) {
        for (unsigned i = 0; i < sizeof tasks / sizeof *tasks; i++) {
            while (serve_tick()) {
            }
            tasks[i]();
        }
    }
}
