/* The vibration board: an Arduino Uno with Adafruit's Wave Shield, of which only the converter is used.
 *
 * Timer 1 takes every sample out at 16 kHz and nothing may delay it: the bus is polled, no other interrupt is
 * enabled and none is ever masked. A new PLAY is prepared beside the voice that sounds; one byte then hands the
 * converter over, so a sample is never half of one voice and half of another. */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/wdt.h>

#include "vibration_receiver.h"

/* port D, the Wave Shield's wiring of the MCP4921 */
#define SELECT 0x04u /* D2: chip select, active low */
#define CLOCK 0x08u  /* D3: data are taken at its rise */
#define DATA 0x10u   /* D4: bit 4, which SEND knows */
#define LATCH 0x20u  /* D5: LDAC, its fall moves the converter's output */
#define CONVERTER (SELECT | CLOCK | DATA | LATCH)

#define COMMAND 0x30u /* MCP4921, register 5-1, high byte: unbuffered reference, gain 1, output on */

/* states of the bus as slave: ATmega328P data sheet, tables 22-4 and 22-5 */
#define BUS_TROUBLE 0x00u
#define ADDRESSED_TO_LISTEN 0x60u
#define BYTE_CAME 0x80u
#define ADDRESSED_TO_SPEAK 0xA8u
#define BYTE_WENT 0xB8u

#define RELEASE (_BV(TWINT) | _BV(TWEA) | _BV(TWEN))

static fdvv_synth_bank bank;
static fdvv_vibration_receiver receiver;

static fdvv_synth_voice voices[2];
static volatile uint16_t next_sample[2];
static volatile uint8_t sounding; /* which of the two the timer plays */
static volatile uint8_t ticks;

static fdvv_vibration_status status;
static uint8_t told; /* bytes of the status sent */
static uint8_t reset_flags;

/* the compiler may move no access to memory across this */
#define IN_ORDER() __asm__ volatile("" ::: "memory")

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
    const uint8_t voice = sounding;
    convert(next_sample[voice]);
    /* a silent board is spared the call, during which a command would wait */
    if (fdvv_synth_playing(&voices[voice]))
        next_sample[voice] = fdvv_synth_sample(&voices[voice]);
    else
        next_sample[voice] = FDVV_SYNTH_SILENCE;
    ticks++;
}

/* The other voice is made ready byte by byte while the command still travels. */
static void take(uint8_t byte) {
    const uint8_t other = sounding ^ 1u;
    const uint8_t brought = fdvv_vibration_byte(&receiver, byte);
    if (brought == FDVV_VIBRATION_SLOT) fdvv_synth_choose(&voices[other], &bank, byte);
    if (brought == FDVV_VIBRATION_STRENGTH) {
        fdvv_synth_start(&voices[other], byte);
        next_sample[other] = fdvv_synth_sample(&voices[other]);
    }
    IN_ORDER();
    if (brought == FDVV_VIBRATION_RIGHT) sounding = other;
}

static void prepare_status(void) {
    uint8_t flags = reset_flags;
    IN_ORDER();
    if (fdvv_synth_playing(&voices[sounding])) flags |= FDVV_VIBRATION_PLAYING;
    status = fdvv_vibration_report(&receiver, flags);
    told = 0;
}

static void load_status_byte(void) {
    TWDR = told < sizeof status ? ((const uint8_t *)&status)[told] : 0xFFu;
    told++;
}

static void speak(uint8_t state) {
    if (state == ADDRESSED_TO_SPEAK) prepare_status();
    load_status_byte();
    TWCR = RELEASE;
}

/* The clock is held low until TWCR is written, so that comes first: the next byte travels meanwhile. */
static void listen(uint8_t state) {
    const uint8_t byte = TWDR;
    TWCR = state == BUS_TROUBLE ? RELEASE | _BV(TWSTO) : RELEASE;
    if (state == ADDRESSED_TO_LISTEN)
        fdvv_vibration_begin(&receiver);
    else if (state != BYTE_CAME)
        fdvv_vibration_end(&receiver);
    else
        take(byte);
}

static void serve_bus(void) {
    if (!(TWCR & _BV(TWINT))) return;
    const uint8_t state = TWSR & 0xF8u;
    if (state == ADDRESSED_TO_SPEAK || state == BYTE_WENT)
        speak(state);
    else
        listen(state);
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
    /* silence first, whatever the reason of the reset */
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
        /* fed only while the timer really takes samples out */
        if (ticks != seen) wdt_reset();
        seen = ticks;
    }
}
