/* The vibration board: an Arduino Uno with the converter of an Adafruit Wave Shield.
 *
 * The interrupt of timer 1 outputs a sample every 1/16000 s and must not be delayed: the bus is polled, and no other
 * interrupt is enabled. A new PLAY is prepared in a second voice while the first one is playing; writing one byte
 * switches between them, so a sample never mixes two voices. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/wdt.h>

#include "vibration_receiver.h"

/* port D, connected to the MCP4921 by the Wave Shield */
#define SELECT 0x04u /* D2: chip select, active low */
#define CLOCK 0x08u  /* D3: data are sampled at its rising edge */
#define DATA 0x10u   /* D4: SEND assumes bit 4 */
#define LATCH 0x20u  /* D5: LDAC, its falling edge updates the output */
#define CONVERTER (SELECT | CLOCK | DATA | LATCH)

#define COMMAND 0x30u /* MCP4921, register 5-1, high byte: unbuffered reference, gain 1, output on */

/* TWI status codes in slave mode: ATmega328P data sheet, tables 22-4 and 22-5 */
#define BUS_ERROR 0x00u
#define ADDRESSED_TO_RECEIVE 0x60u
#define BYTE_RECEIVED 0x80u
#define ADDRESSED_TO_TRANSMIT 0xA8u
#define BYTE_TRANSMITTED 0xB8u

#define RELEASE (_BV(TWINT) | _BV(TWEA) | _BV(TWEN))

static fdvv_synth_bank bank;
static fdvv_vibration_receiver receiver;

static fdvv_synth_voice voices[2];
static volatile uint16_t next_sample[2];
static volatile uint8_t playing; /* index of the voice that the timer plays */
static volatile uint8_t ticks;

static fdvv_vibration_status status;
static uint8_t status_bytes_sent;
static uint8_t reset_flags;

/* compiler barrier */
#define MEMORY_BARRIER() __asm__ volatile("" ::: "memory")

/* Four cycles whatever the bit: data with the clock low, then the clock high by a write to PIND, which toggles. */
#define SEND(byte, bit)                                                                   \
    __asm__ volatile("bst %1, " #bit "\n\tbld %0, 4\n\tout %2, %0\n\tout %3, %4"            \
                     : "+r"(port)                                                         \
                     : "r"(byte), "I"(_SFR_IO_ADDR(PORTD)), "I"(_SFR_IO_ADDR(PIND)), "r"(clock))

static inline __attribute__((always_inline)) void send_byte(uint8_t port, uint8_t byte) {
    const uint8_t clock = CLOCK;
    SEND(byte, 7);
    SEND(byte, 6);
    SEND(byte, 5);
    SEND(byte, 4);
    SEND(byte, 3);
    SEND(byte, 2);
    SEND(byte, 1);
    SEND(byte, 0);
}

static inline __attribute__((always_inline)) void convert(uint16_t sample_counts) {
    const uint8_t others = (uint8_t)(PORTD & ~CONVERTER);
    send_byte(others | LATCH, (uint8_t)(COMMAND | (uint8_t)((sample_counts >> 8) & 0x0Fu)));
    send_byte(others | LATCH, (uint8_t)sample_counts);
    PORTD = (uint8_t)(others | SELECT | LATCH);
    PORTD = (uint8_t)(others | SELECT);
    PORTD = (uint8_t)(others | SELECT | LATCH);
}

ISR(TIMER1_COMPA_vect) {
    const uint8_t voice = playing;
    convert(next_sample[voice]);
    /* skip the call when silent, because a command has to wait during it */
    if (fdvv_synth_playing(&voices[voice]))
        next_sample[voice] = fdvv_synth_sample(&voices[voice]);
    else
        next_sample[voice] = FDVV_SYNTH_SILENCE;
    ticks++;
}

/* Prepare the other voice byte by byte while the command is being received. */
static void process_byte(uint8_t byte) {
    const uint8_t other = playing ^ 1u;
    const uint8_t result = fdvv_vibration_byte(&receiver, byte);
    if (result == FDVV_VIBRATION_SLOT) fdvv_synth_choose(&voices[other], &bank, byte);
    if (result == FDVV_VIBRATION_STRENGTH) {
        fdvv_synth_start(&voices[other], byte);
        next_sample[other] = fdvv_synth_sample(&voices[other]);
    }
    MEMORY_BARRIER();
    if (result == FDVV_VIBRATION_RIGHT) playing = other;
}

static void prepare_status(void) {
    uint8_t flags = reset_flags;
    MEMORY_BARRIER();
    if (fdvv_synth_playing(&voices[playing])) flags |= FDVV_VIBRATION_PLAYING;
    status = fdvv_vibration_report(&receiver, flags);
    status_bytes_sent = 0;
}

static void load_status_byte(void) {
    TWDR = status_bytes_sent < sizeof status ? ((const uint8_t *)&status)[status_bytes_sent] : 0xFFu;
    status_bytes_sent++;
}

static void transmit(uint8_t state) {
    if (state == ADDRESSED_TO_TRANSMIT) prepare_status();
    load_status_byte();
    TWCR = RELEASE;
}

/* The bus clock is stretched until TWCR is written. Writing it first lets the next byte arrive meanwhile. */
static void receive(uint8_t state) {
    const uint8_t byte = TWDR;
    TWCR = state == BUS_ERROR ? RELEASE | _BV(TWSTO) : RELEASE;
    if (state == ADDRESSED_TO_RECEIVE)
        fdvv_vibration_begin(&receiver);
    else if (state != BYTE_RECEIVED)
        fdvv_vibration_end(&receiver);
    else
        process_byte(byte);
}

static void serve_bus(void) {
    if (!(TWCR & _BV(TWINT))) return;
    const uint8_t state = TWSR & 0xF8u;
    if (state == ADDRESSED_TO_TRANSMIT || state == BYTE_TRANSMITTED)
        transmit(state);
    else
        receive(state);
}

static void start_converter(void) {
    PORTD = (uint8_t)((PORTD & ~CONVERTER) | SELECT | LATCH);
    DDRD |= CONVERTER;
    convert(FDVV_SYNTH_SILENCE);
}

static void start_voices(void) {
    for (uint8_t i = 0; i < 2; i++) {
        fdvv_synth_stop(&voices[i]);
        next_sample[i] = FDVV_SYNTH_SILENCE;
    }
}

static void start_timer(void) {
    TCCR1A = 0;
    OCR1A = F_CPU / FDVV_SYNTH_RATE_HZ - 1u;
    TIMSK1 = _BV(OCIE1A);
    TCCR1B = _BV(WGM12) | _BV(CS10);
}

static void start_bus(void) {
    /* no internal pull-ups: they would lift the bus to 5 V */
    DDRC &= (uint8_t)~(_BV(PC4) | _BV(PC5));
    PORTC &= (uint8_t)~(_BV(PC4) | _BV(PC5));
    TWBR = (F_CPU / FDVV_VIBRATION_BUS_HZ - 16u) / 2u;
    TWAR = FDVV_VIBRATION_ADDRESS << 1;
    TWCR = _BV(TWEA) | _BV(TWEN);
}

int main(void) {
    /* silence first, regardless of the cause of the reset */
    start_converter();
    if (MCUSR & _BV(WDRF)) reset_flags = FDVV_VIBRATION_WATCHDOG;
    MCUSR = 0;
    wdt_enable(WDTO_15MS);
    start_voices();
    fdvv_vibration_init(&receiver, &bank);
    start_bus();
    start_timer();
    sei();
    for (uint8_t seen = 0;;) {
        serve_bus();
        /* the watchdog is reset only while the timer outputs samples */
        if (ticks != seen) wdt_reset();
        seen = ticks;
    }
}
