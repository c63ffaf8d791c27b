/* An Uno in simavr: the MCP4921 on port D read back from its pins, the timer interrupt watched, and an I2C
 * master at 400 kHz that waits while the board holds the clock low. Time is counted in cycles of 16 MHz. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <avr_ioport.h>
#include <avr_twi.h>
#include <sim_avr.h>
#include <sim_elf.h>

enum { SELECT = 0x04, CLOCK = 0x08, DATA = 0x10, LATCH = 0x20, CONVERTER = 0x3C };
enum { DDRD = 0x2A, TWCR = 0xBC, TWDR = 0xBB, TWINT = 0x80 };
enum { TIMER1_COMPA = 11 * 4, RETI = 0x9518 };
enum { BIT_CYCLES = 40, BYTE_CYCLES = 9 * BIT_CYCLES, SIMAVR_CYCLES = 9 * 16 };

typedef struct {
    avr_t *avr;
    avr_twi_t *twi;
    uint8_t pins;
    uint16_t shift, input;
    int shifted;
    /* the records, each with room for `room` entries */
    uint64_t *sample_cycles, *interrupt_cycles;
    uint32_t *interrupt_spent;
    uint16_t *words;
    uint32_t room, samples, interrupts;
    uint32_t malformed; /* frames that had not 16 bits */
    uint64_t entered;   /* cycle of entry into the interrupt, or 0 */
} uno;

static void on_port(struct avr_irq_t *irq, uint32_t value, void *param) {
    uno *u = param;
    const uint8_t now = (uint8_t)value, rose = now & ~u->pins, fell = u->pins & ~now;
    (void)irq;
    u->pins = now;
    if ((u->avr->data[DDRD] & CONVERTER) != CONVERTER) return;
    if (fell & SELECT) u->shifted = 0;
    if ((rose & CLOCK) && !(now & SELECT)) u->shift = (uint16_t)(u->shift << 1 | !!(now & DATA)), u->shifted++;
    if (rose & SELECT) {
        if (u->shifted == 16) u->input = u->shift;
        else u->malformed++;
    }
    if ((fell & LATCH) && u->samples < u->room) {
        u->sample_cycles[u->samples] = u->avr->cycle;
        u->words[u->samples++] = u->input;
    }
}

/* In simavr 1.6 the flag of the bus outlives the one written to clear it, which only polling notices. simavr's
 * own handler of the register was there before and runs first. */
static void on_bus_control(struct avr_t *avr, avr_io_addr_t address, uint8_t value, void *param) {
    (void)param;
    if (value & TWINT) avr->data[address] &= (uint8_t)~TWINT;
}

/* simavr offers no door to the peripheral itself, but every peripheral is on one list */
static avr_twi_t *find_twi(avr_t *avr) {
    for (avr_io_t *io = avr->io_port; io; io = io->next)
        if (!strcmp(io->kind, "twi")) return (avr_twi_t *)io;
    return 0;
}

void uno_close(uno *u) {
    avr_terminate(u->avr);
    free(u->sample_cycles), free(u->interrupt_cycles), free(u->interrupt_spent), free(u->words);
    free(u);
}

uno *uno_open(const char *elf, uint32_t room) {
    elf_firmware_t firmware = {0};
    uno *u = calloc(1, sizeof *u);
    u->avr = avr_make_mcu_by_name("atmega328p");
    if (!u->avr || elf_read_firmware(elf, &firmware)) return 0;
    firmware.frequency = 16000000;
    avr_init(u->avr);
    u->avr->log = LOG_NONE;
    avr_load_firmware(u->avr, &firmware);
    u->avr->run_cycle_limit = 1; /* one instruction per avr_run */
    u->twi = find_twi(u->avr);
    avr_register_io_write(u->avr, TWCR, on_bus_control, u);
    u->room = room;
    u->sample_cycles = calloc(room, sizeof *u->sample_cycles);
    u->interrupt_cycles = calloc(room, sizeof *u->interrupt_cycles);
    u->interrupt_spent = calloc(room, sizeof *u->interrupt_spent);
    u->words = calloc(room, sizeof *u->words);
    avr_irq_register_notify(avr_io_getirq(u->avr, AVR_IOCTL_IOPORT_GETIRQ('D'), IOPORT_IRQ_REG_PORT), on_port, u);
    return u;
}

static void step(uno *u) {
    avr_t *avr = u->avr;
    const int leaving = u->entered && (avr->flash[avr->pc] | avr->flash[avr->pc + 1] << 8) == RETI;
    avr_run(avr);
    if (leaving && u->interrupts < u->room) {
        u->interrupt_cycles[u->interrupts] = u->entered;
        /* simavr enters an interrupt in no time, the ATmega328P in 4 cycles */
        u->interrupt_spent[u->interrupts++] = (uint32_t)(avr->cycle - u->entered) + 4;
    }
    if (leaving) u->entered = 0;
    if (avr->pc == TIMER1_COMPA) u->entered = avr->cycle;
}

uint64_t uno_cycle(const uno *u) {
    return u->avr->cycle;
}

void uno_run(uno *u, uint64_t until_cycle) {
    while (u->avr->cycle < until_cycle) step(u);
}

uint8_t uno_peek(const uno *u, uint16_t address) {
    return u->avr->data[address];
}

void uno_poke(uno *u, uint16_t address, uint8_t value) {
    avr_core_watch_write(u->avr, address, value);
}

/* A byte or condition that is over at a cycle: simavr tells the firmware 9 us after it has heard of it. Its
 * states as a slave are wrong in version 1.6, so the right one is put in its place. */
static void deliver(uno *u, uint64_t over_cycle, uint8_t condition, uint8_t byte, uint8_t state) {
    uno_run(u, over_cycle - SIMAVR_CYCLES);
    avr_raise_irq(u->twi->io.irq + TWI_IRQ_INPUT, avr_twi_irq_msg(condition, 0x2A, byte));
    u->twi->next_twstate = state;
    while (!(u->avr->data[TWCR] & TWINT)) step(u);
}

/* Run until the board releases the clock; return the cycle, or 0 if it does not within 20 ms. */
static uint64_t released(uno *u) {
    const uint64_t limit = u->avr->cycle + 320000;
    while (u->avr->data[TWCR] & TWINT)
        if (u->avr->cycle > limit) return 0;
        else step(u);
    return u->avr->cycle;
}

/* Send bytes from a START at or after a cycle, with or without a STOP; return the cycle of the START, or 0 if
 * the board held the clock for good. */
uint64_t uno_write(uno *u, const uint8_t *bytes, uint32_t count, uint64_t start_cycle, int stop) {
    uno_run(u, start_cycle);
    const uint64_t start = u->avr->cycle;
    deliver(u, start + BIT_CYCLES + BYTE_CYCLES, TWI_COND_START | TWI_COND_ADDR | TWI_COND_WRITE, 0, 0x60);
    for (uint32_t i = 0; i < count; i++) {
        const uint64_t free_cycle = released(u);
        if (!free_cycle) return 0;
        deliver(u, free_cycle + BYTE_CYCLES, TWI_COND_WRITE, bytes[i], 0x80);
    }
    if (!released(u)) return 0;
    if (stop) deliver(u, u->avr->cycle + SIMAVR_CYCLES, TWI_COND_STOP, 0, 0xA0);
    return released(u) ? start : 0;
}

/* Read bytes from a START at or after a cycle; return as uno_write does. */
uint64_t uno_read(uno *u, uint8_t *bytes, uint32_t count, uint64_t start_cycle) {
    uno_run(u, start_cycle);
    const uint64_t start = u->avr->cycle;
    deliver(u, start + BIT_CYCLES + BYTE_CYCLES, TWI_COND_START | TWI_COND_ADDR, 0, 0xA8);
    for (uint32_t i = 0; i < count; i++) {
        const uint64_t free_cycle = released(u);
        if (!free_cycle) return 0;
        bytes[i] = u->avr->data[TWDR];
        /* a write is only simavr's way of telling that nine clocks have passed */
        deliver(u, free_cycle + BYTE_CYCLES, TWI_COND_WRITE, 0, i + 1 < count ? 0xB8 : 0xC0);
    }
    return released(u) ? start : 0;
}

/* Two masters or a disturbed line: a START or STOP where none may be. */
void uno_disturb(uno *u) {
    deliver(u, u->avr->cycle + SIMAVR_CYCLES, TWI_COND_STOP, 0, 0x00);
    released(u);
}

/* Copy the records: samples (cycle of the latch, word), then interrupts (cycle of entry, cycles spent). */
uint32_t uno_samples(const uno *u, uint64_t *cycles, uint16_t *words) {
    memcpy(cycles, u->sample_cycles, u->samples * sizeof *cycles);
    memcpy(words, u->words, u->samples * sizeof *words);
    return u->samples;
}

uint32_t uno_interrupts(const uno *u, uint64_t *cycles, uint32_t *spent) {
    memcpy(cycles, u->interrupt_cycles, u->interrupts * sizeof *cycles);
    memcpy(spent, u->interrupt_spent, u->interrupts * sizeof *spent);
    return u->interrupts;
}

uint32_t uno_malformed(const uno *u) {
    return u->malformed;
}
