/* The LED strip's board: an Arduino Uno, a strip of APA102 or SK9822 (DotStar) and the key line of the rig's
 * controller.
 *
 * Timer 1 counts half microseconds and stores its count by itself when the key line rises: neither a frame that is
 * being sent nor an interrupt can move the time of an edge. Bytes of the host are stored by interrupt; everything else
 * is polled, and nothing is begun that could hold up the bullet's next frame. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/wdt.h>

#include "strip.h"

/* port B */
#define KEY 0x01u    /* D8, ICP1: the key line */
#define SELECT 0x04u /* D10: must be an output, or the SPI would take it for a master's select */
#define DATA 0x08u   /* D11, MOSI */
#define CLOCK 0x20u  /* D13, SCK */

enum {
    BAUD_115200 = 16,      /* UBRR at double speed: 117.6 kBd, as the Uno's USB side makes it of the same crystal */
    BYTE_us16 = 46,        /* counted: 32 cycles on the wire, 10 between two bytes, 16 more between two pixels */
    CALM_us = 600,         /* a request is carried out in less */
    OVERFLOW_us = 32768,
    WAITING_BYTES = 64,    /* a power of two, longer than what comes during the longest frame */
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

/* What a count means: an overflow of which the interrupt still waits is counted here. */
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

/* A byte too many is left out: its frame's checksum tells. */
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

/* Zeros end a frame too: an SK9822 shows the frame after 32 of them, and the clock of an APA102 is half a bit later
 * in every pixel. */
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

static void take_edges(void) {
    while (edges_out != edges_in) {
        fdvv_strip_edge(&strip, edges_us[edges_out]);
        edges_out = (uint8_t)(edges_out + 1u) % WAITING_EDGES;
    }
    if (is_edge_lost) strip.flags |= FDVV_STRIP_BOARD_FLAG_EDGES_LOST;
}

static void talk(uint32_t now) {
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
    SPCR = _BV(SPE) | _BV(MSTR); /* a quarter of 16 MHz, data taken at the clock's rise */
}

static void start_clock(void) {
    TCCR1A = 0;
    TIMSK1 = _BV(TOIE1) | _BV(ICIE1);
    /* a spike shorter than four cycles is no edge; rising; 2 MHz */
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
        /* fed only while the clock goes on; one that begins anew is none */
        if ((int32_t)(now - seen) > 0) {
            seen = now;
            wdt_reset();
        }
        take_edges();
        fdvv_strip_tick(&strip, now);
        if (fdvv_strip_frame(&strip, now))
            send_frame();
        else if (fdvv_strip_spare_us(&strip, now) > CALM_us)
            talk(now);
    }
}
