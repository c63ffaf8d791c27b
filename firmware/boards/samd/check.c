/* A program that exercises every part of the board, to commission it and for tests: the cap acts as a spring,
 * bytes from the host are echoed, and each tick is reported. */
#include "board.h"

enum {
    TICK_US = 250,
    READS = 25,
    CENTRE = 2048 * READS,
    FRAME_TICK = 'T',
    FRAME_ECHO = 'E',
    VIBRATION_BOARD = 0x2A
};

typedef struct {
    uint8_t kind, size, reset_cause, elapsed_ticks;
    uint32_t time_us, sum;
    uint16_t lowest, highest, supply_mV, force_counts;
    int16_t duty_q15;
    uint16_t served_us; /* from the tick to the new duty */
} tick_frame;

static int16_t spring(uint32_t sum)
{
    int32_t duty = ((int32_t)sum - CENTRE) / 2;
    return (int16_t)(duty > 32767 ? 32767 : duty < -32767 ? -32767 : duty);
}

static void report(const board_readings *readings, int16_t duty_q15, uint16_t served_us)
{
    tick_frame frame = {FRAME_TICK, sizeof frame, board_reset_cause(), (uint8_t)readings->elapsed_ticks,
                        readings->time_us, readings->sum, readings->lowest, readings->highest,
                        readings->supply_mV, readings->force_counts, duty_q15, served_us};
    if (board_usb_room() >= sizeof frame) board_usb_write((const uint8_t *)&frame, sizeof frame);
}

static void serve(const board_readings *readings)
{
    static uint8_t was_deep;
    int16_t duty_q15 = spring(readings->sum);
    board_drive(duty_q15, readings->supply_mV > 9000);
    uint16_t served_us = (uint16_t)(board_now_us() - readings->time_us);
    board_watchdog_clear();
    board_stop((uint16_t)(500 + readings->force_counts));
    uint8_t is_deep = readings->sum > CENTRE;
    if (is_deep && !was_deep) board_wire_send(VIBRATION_BOARD, (const uint8_t[]){0x22, 1, 255, 0x5B}, 4);
    was_deep = is_deep;
    report(readings, duty_q15, served_us);
}

static void echo(void)
{
    uint8_t frame[2 + 32];
    if (board_usb_room() < sizeof frame) return;
    uint16_t count = board_usb_read(frame + 2, 32);
    if (!count) return;
    frame[0] = FRAME_ECHO;
    frame[1] = (uint8_t)(count + 2);
    board_usb_write(frame, (uint16_t)(count + 2));
}

int main(void)
{
    board_readings readings;
    board_clocks_start();
    board_brown_out_start();
    board_drive_start();
    board_wire_start();
    board_usb_start();
    board_acquire_start(TICK_US, READS);
    board_watchdog_start();
    for (;;) {
        if (board_acquire(&readings)) serve(&readings);
        board_usb_step();
        board_wire_step(board_now_us());
        if (board_usb_open()) echo();
    }
}
