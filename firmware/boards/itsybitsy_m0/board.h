/* What the application sees of the ItsyBitsy M0. Nothing here waits for the outside world. */
#ifndef ITSYBITSY_M0_BOARD_H
#define ITSYBITSY_M0_BOARD_H

#include <stdint.h>

enum { BOARD_READS_MAX = 64, BOARD_MESSAGE_BYTES = 33, BOARD_MESSAGES = 4 };

/* what started the program */
enum { BOARD_RESET_OTHER, BOARD_RESET_WATCHDOG, BOARD_RESET_BROWN_OUT };

/* one tick's readings */
typedef struct {
    uint32_t time_us;       /* device clock at the tick, which is when the first conversion started; wraps */
    uint32_t sum;           /* of the position readings */
    uint16_t lowest;        /* of them, counts */
    uint16_t highest;
    uint16_t elapsed_ticks; /* since the last readings: 1 unless ticks were missed */
    uint16_t supply_mV;
    uint16_t force_counts;
} board_readings;

/* clocks.c: 48 MHz from the crystalless DFLL, disciplined by USB. */
void board_clocks_start(void);

/* Route generic clock generator 0 (48 MHz), 1 (32.768 kHz) or 2 (8 MHz) to a peripheral. */
void board_clock(uint8_t peripheral, uint8_t generator);
void board_pin(uint8_t pin, uint8_t function);

/* acquire.c: a tick every tick_us (100 to 1000), which starts `reads` conversions of 4 us. May be called again with
 * others; the device clock goes on. */
void board_acquire_start(uint16_t tick_us, uint8_t reads);

/* Give 1 and the readings of a finished burst, else 0. */
uint8_t board_acquire(board_readings *readings);
uint32_t board_now_us(void);

/* drive.c */
void board_drive_start(void);

/* Mean voltage across the coil, Q15 of the supply. Not enabled: both bridge inputs low whatever the duty. */
void board_drive(int16_t duty_q15, uint8_t enable);

/* 1 if the bridge reports a fault, or its inputs are not low while it is off. */
uint8_t board_drive_fault(void);

/* The key line: high while the key is down. */
void board_key(uint8_t is_down);

/* The travel stop's servo pulse, held between 400 and 2600 us. */
void board_stop(uint16_t pulse_us);

/* wire.c: messages to the I2C bus, sent in order; 0 if the queue is full or the message too long. */
void board_wire_start(void);
uint8_t board_wire_send(uint8_t address, const uint8_t *bytes, uint8_t count);
uint8_t board_wire_room(void);                /* messages that the queue takes */
uint8_t board_wire_answers(void);             /* 0 if the last message was not acknowledged */
uint32_t board_wire_errors(void);

/* Move the bus on by at most one byte; call as often as there is time. */
void board_wire_step(uint32_t now_us);

/* guard.c */
uint8_t board_reset_cause(void);
void board_brown_out_start(void);

/* From here on about 2 ms without board_watchdog_clear is a reset. */
void board_watchdog_start(void);
void board_watchdog_clear(void);

/* usb.c: a serial port over USB. */
void board_usb_start(void);
void board_usb_step(void);
uint8_t board_usb_open(void);                 /* a program on the host holds the port */
uint16_t board_usb_room(void);
uint16_t board_usb_read(uint8_t *bytes, uint16_t room);
uint16_t board_usb_write(const uint8_t *bytes, uint16_t count);
uint32_t board_serial(void);

#endif
