/* The LED strip's board: an Arduino Uno, a strip of APA102 or SK9822 (DotStar) and the key line of the rig's
 * controller.
 *
 * Timer 1 counts half microseconds and captures its count in hardware when the key line rises, so neither a frame being
 * sent nor an interrupt can delay the time of an edge. Bytes from the host are stored by interrupt. Everything else is
 * polled, and nothing is started that could delay the bullet's next frame. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/wdt.h>

#include "strip.h"

/* port B */
#define KEY 0x01u    /* D8, ICP1: the key line */
#define SELECT 0x04u /* D10: must be an output, or the SPI would leave master mode */
#define DATA 0x08u   /* D11, MOSI */
#define CLOCK 0x20u  /* D13, SCK */

enum {
    BAUD_115200 = 16,      /* UBRR at double speed: 117.6 kBd, the same as the Uno's USB chip with its crystal */
    BYTE_us16 = 46,        /* from cycle counts: 32 on the wire, 10 between two bytes, 16 more between two pixels */
    REQUEST_us = 600,      /* upper limit of the time to execute a request */
    OVERFLOW_us = 32768,
    WAITING_BYTES = 64,    /* a power of two, more than arrive during the longest frame */
    WAITING_EDGES = 8
};

static fdvv_strip strip;

static volatile uint32_t overflow_us;
static volatile uint32_t edges_us[WAITING_EDGES];
static volatile uint8_t edges_in, is_edge_lost;
static volatile uint8_t bytes[WAITING_BYTES];
static volatile uint8_t bytes_in;
static uint8_t edges_out, bytes_out;

ISR(TIMER1_OVF_vect) {
    overflow_us += OVERFLOW_us;
}

/* Time of a timer count, including an overflow whose interrupt is still pending. */
static inline __attribute__((always_inline)) uint32_t time_us(uint16_t count) {
    uint32_t base_us = overflow_us;
    if ((TIFR1 & _BV(TOV1)) && count < 0x8000u) base_us += OVERFLOW_us;
    return base_us + (count >> 1);
}

ISR(TIMER1_CAPT_vect) {
    const uint32_t at_us = time_us(ICR1);
    const uint8_t next = (uint8_t)(edges_in + 1u) % WAITING_EDGES;
    if (next == edges_out) {
        is_edge_lost = 1;
    } else {
        edges_us[edges_in] = at_us;
        edges_in = next;
    }
}

/* If the buffer is full the byte is dropped, and the checksum of its frame will be wrong. */
ISR(USART_RX_vect) {
    const uint8_t byte = UDR0, next = (uint8_t)(bytes_in + 1u) % WAITING_BYTES;
    if (next == bytes_out) return;
    bytes[bytes_in] = byte;
    bytes_in = next;
}

static uint32_t now_us(void) {
    cli();
    const uint32_t now = time_us(TCNT1);
    sei();
    return now;
}

/* -- the strip ---------------------------------------------------------------------------------------- */

static inline __attribute__((always_inline)) void send(uint8_t byte) {
    SPDR = byte;
    while (!(SPSR & _BV(SPIF))) {
    }
}

static inline __attribute__((always_inline)) void send_pixel(const uint8_t *colour) {
    for (uint8_t i = 0; i < 4; i++) send(colour[i]);
}

/* A frame also ends with zeros: an SK9822 shows it after 32 of them, and every APA102 delays the clock by half a
 * bit. */
static void send_zeros(uint8_t count) {
    while (count--) send(0);
}

static void send_frame(void) {
    static const uint8_t dark[4] = {0xE0, 0, 0, 0};
    const fdvv_strip_picture *picture = &strip.picture;
    send_zeros(4);
    for (uint8_t pixel = 0; pixel < picture->pixels; pixel++) {
        const uint8_t *colour = dark;
        if (pixel >= picture->first && pixel <= picture->last) colour = picture->lit;
        if (pixel == picture->bullet) colour = picture->bullet_colour;
        send_pixel(colour);
    }
    send_zeros((uint8_t)(4u + (picture->pixels + 15u) / 16u));
    fdvv_strip_sent(&strip);
}

/* -- work --------------------------------------------------------------------------------------------- */

static void process_edges(void) {
    while (edges_out != edges_in) {
        fdvv_strip_edge(&strip, edges_us[edges_out]);
        edges_out = (uint8_t)(edges_out + 1u) % WAITING_EDGES;
    }
    if (is_edge_lost) strip.flags |= FDVV_STRIP_BOARD_FLAG_EDGES_LOST;
}

static void serve_link(uint32_t now) {
    uint8_t byte;
    if (bytes_out != bytes_in && fdvv_strip_listens(&strip)) {
        byte = bytes[bytes_out];
        bytes_out = (uint8_t)(bytes_out + 1u) % WAITING_BYTES;
        fdvv_strip_receive(&strip, byte, now, PINB & KEY);
    }
    if ((UCSR0A & _BV(UDRE0)) && fdvv_strip_transmit(&strip, &byte)) UDR0 = byte;
}

static void start_pins(void) {
    PORTB = 0;
    DDRB = SELECT | DATA | CLOCK;
    SPCR = _BV(SPE) | _BV(MSTR); /* 16 MHz / 4, data sampled at the rising edge of the clock */
}

static void start_clock(void) {
    TCCR1A = 0;
    TIMSK1 = _BV(TOIE1) | _BV(ICIE1);
    /* noise canceller (four cycles), rising edge, 2 MHz */
    TCCR1B = _BV(ICNC1) | _BV(ICES1) | _BV(CS11);
}

static void start_serial(void) {
    UBRR0 = BAUD_115200;
    UCSR0A = _BV(U2X0);
    UCSR0C = _BV(UCSZ01) | _BV(UCSZ00);
    UCSR0B = _BV(RXEN0) | _BV(TXEN0) | _BV(RXCIE0);
}

int main(void) {
    uint8_t cause = MCUSR & _BV(WDRF) ? FDVV_STRIP_BOARD_FLAG_WATCHDOG : 0;
    MCUSR = 0;
    wdt_enable(WDTO_30MS);
    start_pins();
    fdvv_strip_init(&strip, cause, BYTE_us16);
    start_clock();
    start_serial();
    sei();
    for (uint32_t seen = 0;;) {
        const uint32_t now = now_us();
        /* the watchdog is reset only while the time increases */
        if ((int32_t)(now - seen) > 0) {
            seen = now;
            wdt_reset();
        }
        process_edges();
        fdvv_strip_tick(&strip, now);
        if (fdvv_strip_frame(&strip, now))
            send_frame();
        else if (fdvv_strip_spare_us(&strip, now) > REQUEST_us)
            serve_link(now);
    }
}
