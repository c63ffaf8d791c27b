/* An Uno in simavr with a strip on its SPI, a line on its UART and a key line on D8. Time is counted in cycles of
 * 16 MHz; what happens at the pins happens at given cycles. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <avr_ioport.h>
#include <avr_spi.h>
#include <avr_uart.h>
#include <sim_avr.h>
#include <sim_elf.h>

enum { SPCR_ADDRESS = 0x4C, SPSR_ADDRESS = 0x4D, SPDR_ADDRESS = 0x4E, TCCR1B_ADDRESS = 0x81 };
enum { BYTE_CYCLES = 1360 /* ten bits at 117647 Bd */, ROOM = 4096 };

typedef struct {
    uint64_t cycle;
    uint8_t level;
} change;

typedef struct {
    avr_t *avr;
    avr_irq_t *key, *serial;
    /* what the strip was sent: bytes and the cycles at which their last bit was out */
    uint64_t *sent_cycles;
    uint8_t *sent;
    uint32_t room, sent_count;
    /* what the board sent to the host, not yet taken */
    uint8_t replies[ROOM];
    uint32_t reply_count;
    /* what is still to happen, in order */
    change keys[ROOM];
    uint32_t key_next, key_count;
    uint8_t asked[ROOM];
    uint32_t ask_next, ask_count;
    uint64_t ask_cycle; /* when the line is free for the next byte */
    uint64_t last_cycle; /* of the last byte to the strip */
    uint64_t zero_cycle; /* when the program's clock was started last */
} uno;

static void on_strip(struct avr_irq_t *irq, uint32_t value, void *param) {
    uno *u = param;
    (void)irq;
    u->last_cycle = u->avr->cycle;
    if (u->sent_count == u->room) return;
    u->sent_cycles[u->sent_count] = u->avr->cycle;
    u->sent[u->sent_count++] = (uint8_t)value;
}

static void on_serial(struct avr_irq_t *irq, uint32_t value, void *param) {
    uno *u = param;
    (void)irq;
    if (u->reply_count < ROOM) u->replies[u->reply_count++] = (uint8_t)value;
}

/* simavr offers no door to the peripheral itself, but every peripheral is on one list */
static void *find_spi(avr_t *avr) {
    for (avr_io_t *io = avr->io_port; io; io = io->next)
        if (!strcmp(io->kind, "spi")) return io;
    return 0;
}

/* simavr 1.6 takes 100 us for a byte whatever the clock. Its own handler of the register was there before and runs
 * first: what it has planned is put to the time that the registers ask for. */
static void on_byte(struct avr_t *avr, avr_io_addr_t address, uint8_t value, void *param) {
    static const uint8_t cycles_of_bit[] = {4, 16, 64, 128};
    uint32_t cycles = 8u * cycles_of_bit[avr->data[SPCR_ADDRESS] & 3u] >> (avr->data[SPSR_ADDRESS] & 1u);
    (void)address, (void)value;
    for (avr_cycle_timer_slot_p slot = avr->cycle_timers.timer; slot; slot = slot->next)
        if (slot->param == param) {
            avr_cycle_timer_t raise = slot->timer;
            avr_cycle_timer_cancel(avr, raise, param);
            avr_cycle_timer_register(avr, cycles, raise, param);
            return;
        }
}

static void on_clock(struct avr_t *avr, avr_io_addr_t address, uint8_t value, void *param) {
    (void)address, (void)value;
    ((uno *)param)->zero_cycle = avr->cycle;
}

void strip_close(uno *u) {
    avr_terminate(u->avr);
    free(u->sent_cycles), free(u->sent);
    free(u);
}

uno *strip_open(const char *elf, uint32_t room) {
    elf_firmware_t firmware = {0};
    uint32_t flags = 0; /* no sleep where the program looks at the UART again and again */
    uno *u = calloc(1, sizeof *u);
    u->avr = avr_make_mcu_by_name("atmega328p");
    if (!u->avr || elf_read_firmware(elf, &firmware)) return 0;
    firmware.frequency = 16000000;
    avr_init(u->avr);
    u->avr->log = LOG_NONE;
    avr_load_firmware(u->avr, &firmware);
    u->avr->run_cycle_limit = 1; /* one instruction per avr_run */
    avr_register_io_write(u->avr, SPDR_ADDRESS, on_byte, find_spi(u->avr));
    avr_register_io_write(u->avr, TCCR1B_ADDRESS, on_clock, u);
    avr_ioctl(u->avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    u->room = room;
    u->sent_cycles = calloc(room, sizeof *u->sent_cycles);
    u->sent = calloc(room, 1);
    u->key = avr_io_getirq(u->avr, AVR_IOCTL_IOPORT_GETIRQ('B'), 0);
    u->serial = avr_io_getirq(u->avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT);
    avr_irq_register_notify(avr_io_getirq(u->avr, AVR_IOCTL_SPI_GETIRQ(0), SPI_IRQ_OUTPUT), on_strip, u);
    avr_irq_register_notify(avr_io_getirq(u->avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), on_serial, u);
    avr_raise_irq(u->key, 0);
    return u;
}

uint64_t strip_cycle(const uno *u) { return u->avr->cycle; }

uint64_t strip_zero(const uno *u) { return u->zero_cycle; }

uint64_t strip_last(const uno *u) { return u->last_cycle; }

static void happen(uno *u) {
    const uint64_t now = u->avr->cycle;
    while (u->key_next < u->key_count && now >= u->keys[u->key_next].cycle)
        avr_raise_irq(u->key, u->keys[u->key_next++].level);
    if (u->ask_next < u->ask_count && now >= u->ask_cycle) {
        avr_raise_irq(u->serial, u->asked[u->ask_next++]);
        u->ask_cycle = now + BYTE_CYCLES;
    }
}

void strip_run(uno *u, uint64_t until_cycle) {
    while (u->avr->cycle < until_cycle) {
        happen(u);
        avr_run(u->avr);
    }
}

/* The key line goes to a level at a cycle; cycles in rising order. 0 if there is no room. */
int strip_key_at(uno *u, uint64_t cycle, uint8_t level) {
    if (u->key_next == u->key_count) u->key_next = u->key_count = 0;
    if (u->key_count == ROOM) return 0;
    u->keys[u->key_count++] = (change){cycle, level};
    return 1;
}

/* The host sends bytes, one after the other from now on. 0 if there is no room. */
int strip_ask(uno *u, const uint8_t *bytes, uint32_t count) {
    if (u->ask_next == u->ask_count) u->ask_next = u->ask_count = 0;
    if (u->ask_count + count > ROOM) return 0;
    memcpy(u->asked + u->ask_count, bytes, count);
    u->ask_count += count;
    if (u->ask_cycle < u->avr->cycle) u->ask_cycle = u->avr->cycle + BYTE_CYCLES;
    return 1;
}

uint32_t strip_replies(uno *u, uint8_t *bytes) {
    const uint32_t count = u->reply_count;
    memcpy(bytes, u->replies, count);
    u->reply_count = 0;
    return count;
}

uint32_t strip_sent(uno *u, uint64_t *cycles, uint8_t *bytes) {
    const uint32_t count = u->sent_count;
    memcpy(cycles, u->sent_cycles, count * sizeof *cycles);
    memcpy(bytes, u->sent, count);
    u->sent_count = 0;
    return count;
}

uint8_t strip_peek(const uno *u, uint16_t address) { return u->avr->data[address]; }

void strip_poke(uno *u, uint16_t address, uint8_t value) { avr_core_watch_write(u->avr, address, value); }
