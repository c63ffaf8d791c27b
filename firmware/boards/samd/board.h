/* Board support of the ItsyBitsy M0 and M4. No function waits for external events. */
#ifndef SAMD_BOARD_H
#define SAMD_BOARD_H

#include <stdint.h>

enum { BOARD_READS_MAX = 64, BOARD_THERMISTOR_TICKS = 64, BOARD_MESSAGE_BYTES = 33, BOARD_MESSAGES = 4 };

/* cause of the last reset */
enum { BOARD_RESET_OTHER, BOARD_RESET_WATCHDOG, BOARD_RESET_BROWN_OUT };

/* one tick's readings */
typedef struct {
    uint32_t time_us;       /* device clock at the tick, when the first conversion started; wraps around */
    uint32_t sum;           /* of the position readings */
    uint16_t lowest;        /* of these readings, counts */
    uint16_t highest;
    uint16_t elapsed_ticks; /* since the last readings: 1 unless ticks were missed */
    uint16_t supply_mV;
    uint16_t force_counts;
    uint16_t thermistor_counts; /* read once in BOARD_THERMISTOR_TICKS */
} board_readings;

/* clocks.c: from the DFLL of 48 MHz, which is locked to USB's start of frame. */
void board_clocks_start(void);

/* Route a generic clock generator to a peripheral; clocks.c says which there are. */
void board_clock(uint8_t peripheral, uint8_t generator);
void board_pin(uint8_t pin, uint8_t function);

/* acquire.c: a tick every tick_us (100 to 1000) starts `reads` conversions. May be called again with other
 * values; the device clock continues. */
void board_acquire_start(uint16_t tick_us, uint8_t reads);

/* Returns 1 and the readings of a finished burst, or 0. */
uint8_t board_acquire(board_readings *readings);
uint32_t board_now_us(void);

/* drive.c */
void board_drive_start(void);

/* Set the drive in Q15: the mean voltage of the coil in parts of the supply, or its current in parts of what the supply
 * would drive through it. If not enabled, there is no current. */
void board_drive(int16_t duty_q15, uint8_t enable);

/* M4: compare what a converter reads at the setpoint's pin, in counts, with zero; while the drive is disabled. */
void board_drive_read_back(uint16_t counts);

/* 1 if the drive reports a fault, or its pins are not off while it is disabled, or its setpoint was not zero. */
uint8_t board_drive_fault(void);

/* The key line: high while the key is down. */
void board_key(uint8_t is_down);

/* Servo pulse of the travel stop, clamped to 400 to 2600 us. */
void board_stop(uint16_t pulse_us);

/* wire.c: I2C messages, sent in order. board_wire_send returns 0 if the queue is full or the message too long. */
void board_wire_start(void);
uint8_t board_wire_send(uint8_t address, const uint8_t *bytes, uint8_t count);
uint8_t board_wire_room(void);                /* free places in the queue */
uint8_t board_wire_answers(void);             /* 0 if the last message was not acknowledged */
uint32_t board_wire_errors(void);

/* Transfer at most one byte; call as often as there is time. */
void board_wire_step(uint32_t now_us);

/* guard.c */
uint8_t board_reset_cause(void);
void board_brown_out_start(void);

/* After this, 2 ms (M4: 8 ms) without board_watchdog_clear cause a reset. */
void board_watchdog_start(void);
void board_watchdog_clear(void);

/* usb.c: a serial port over USB. */
void board_usb_start(void);
void board_usb_step(void);
uint8_t board_usb_open(void);                 /* a program on the host has opened the port */
uint16_t board_usb_room(void);
uint16_t board_usb_read(uint8_t *bytes, uint16_t room);
uint16_t board_usb_write(const uint8_t *bytes, uint16_t count);
uint32_t board_serial(void);

#endif
