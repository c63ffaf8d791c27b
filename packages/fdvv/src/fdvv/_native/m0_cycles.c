/* Timing of an emulated SAMD21, or SAMD51: the cycles of each block of Thumb code, and its peripheral registers.
 *
 * An instruction-set emulator calls fdvv_m0_block before each block of code, and fdvv_m0_read and fdvv_m0_write for
 * each access to a register. Cycle counts are those of the Cortex-M0+ (technical reference manual r0p1, table 3-1, with the
 * single-cycle multiplier), plus one wait state of the flash for each miss of a cache with eight lines of eight bytes,
 * or, pessimistically, for each fetched word. Instructions of 32 bits, which the Cortex-M4 alone has but for BL, MRS, MSR and
 * barriers, count as its manual (r0p1, tables 3-1 and 7-1) has them, divisions at their longest. Wait states of other data in flash, and of a bus occupied by DMA or USB,
 * are not modelled. */
#include <stdint.h>
#include <string.h>

enum { LINES = 8, LINE_SHIFT = 3, BLOCK_LINES = 24 };
enum { SLOW, CACHED, NO_WAIT }; /* flash wait states: for each fetched word, for each cache miss, none */
enum { CALL_WRITE = 1, CALL_READ = 2, WRITE_ONE_CLEARS = 4, COUNTER = 8, POLLED = 16 };

typedef struct {
    uint16_t size;          /* bytes; 0: not decoded yet */
    uint16_t cycles;        /* without wait states */
    uint16_t fetches;       /* words fetched, including literals */
    uint8_t is_conditional; /* ends with a branch that takes one more cycle if taken */
    uint8_t lines;
    uint16_t line[BLOCK_LINES]; /* of flash, in order of use */
} fdvv_m0_code;

typedef struct {
    uint64_t cycles;
    uint64_t next_event;          /* event() is called when cycles reach this; it must increase it */
    void (*event)(void);
    uint64_t (*read)(uint32_t address, uint32_t size);
    void (*write)(uint32_t address, uint32_t size, uint32_t value);
    const uint8_t *flash;         /* from address 0 */
    fdvv_m0_code *code;           /* one per halfword of flash */
    uint64_t counter_start;       /* of the register marked COUNTER: counts cycles since, modulo its period */
    uint64_t counter_period;      /* 0: the counter is stopped */
    uint64_t polled_at;           /* last read of the register marked POLLED */
    uint64_t longest_pass;        /* longest time between two reads of it; reset by the user */
    uint64_t shortest_pass;
    uint64_t passes;
    uint64_t touches;             /* of the cache */
    uint64_t line_used[LINES];    /* value of touches at the last use */
    uint32_t line[LINES];         /* 1 + line of flash; 0: empty */
    uint32_t flash_bytes;
    uint32_t bus_wait;            /* wait states of an access to a register */
    uint32_t waited;              /* wait states of the current block */
    uint32_t start;               /* address of the last block */
    uint32_t after;               /* address after it */
    uint32_t is_stopped;          /* before that block ran: fdvv_m0_block will be called for it again */
    uint32_t is_conditional;
    uint32_t is_cached;           /* SLOW, CACHED or NO_WAIT */
    uint32_t unclocked;           /* address of the first access to a peripheral without bus clock; 0: none */
    uint32_t clocks;              /* bus clocks: a bit per kilobyte of the window with `gated` set */
    uint32_t is_m4;               /* the processor is a Cortex-M4 */
} fdvv_m0;

typedef struct {
    fdvv_m0 *m0;
    uint8_t *memory;
    const uint8_t *kind;          /* of each register, at its first byte */
    uint32_t base;
    uint32_t gated;
} fdvv_m0_window;

static uint32_t halfword(const fdvv_m0 *m0, uint32_t address)
{
    return m0->flash[address] | ((uint32_t)m0->flash[address + 1] << 8);
}

static uint32_t bits_set(uint32_t value)
{
    uint32_t count = 0;
    for (; value; value &= value - 1) count++;
    return count;
}

/* Cycles of one 16-bit instruction, conditional branches as not taken. */
static uint32_t cost_16(uint32_t op)
{
    if ((op & 0xFF00) == 0x4700) return 2;                                   /* BX, BLX */
    if ((op & 0xFD00) == 0x4400 && (op & 0x87) == 0x87) return 2;            /* ADD, MOV to PC */
    if ((op & 0xF800) == 0x4800) return 2;                                   /* LDR literal */
    if (op >= 0x5000 && op < 0xA000) return 2;                               /* loads and stores */
    if ((op & 0xFE00) == 0xB400) return 1 + bits_set(op & 0x1FF);            /* PUSH */
    if ((op & 0xFF00) == 0xBC00) return 1 + bits_set(op & 0xFF);             /* POP */
    if ((op & 0xFF00) == 0xBD00) return 4 + bits_set(op & 0xFF);             /* POP with PC: 3 + N */
    if ((op & 0xF000) == 0xC000) return 1 + bits_set(op & 0xFF);             /* STM, LDM */
    if ((op & 0xF800) == 0xE000) return 2;                                   /* B */
    if ((op & 0xFFF0) == 0xBF20 || (op & 0xFFF0) == 0xBF30) return 2;        /* WFE, WFI */
    return 1;
}

/* Cycles of one 32-bit instruction of a Cortex-M4. */
static uint32_t cost_32(uint32_t op, uint32_t next)
{
    if ((op & 0xFE40) == 0xE800) return 1 + bits_set(next);                  /* LDM, STM */
    if ((op & 0xFE40) == 0xE840) return 3;                                   /* LDRD, STRD, TBB */
    if ((op & 0xFE20) == 0xEC20) return 1 + (next & 0xFF);                   /* VLDM, VSTM, VPUSH, VPOP */
    if ((op & 0xFE00) == 0xEC00) return 2;                                   /* VLDR, VSTR */
    if ((op & 0xFFB0) == 0xEE80) return 14;                                  /* VDIV */
    if ((op & 0xFFBF) == 0xEEB1 && (next & 0xFC0) == 0xAC0) return 14;       /* VSQRT */
    if ((op & 0xFFA0) == 0xEE00 || (op & 0xFFB0) == 0xEEA0) return 3;        /* VMLA, VFMA and the like */
    if ((op & 0xFF00) == 0xEE00) return 1;                                   /* other arithmetic of the FPU */
    if ((op & 0xF800) == 0xF000 && (next & 0x8000)) return 3;                /* branches, MRS, MSR, barriers */
    if ((op & 0xFE00) == 0xF800) return 2;                                   /* loads and stores */
    if ((op & 0xFFD0) == 0xFB90) return 12;                                  /* SDIV, UDIV */
    return 1;
}

static void need_line(fdvv_m0_code *code, uint32_t address)
{
    if (code->lines < BLOCK_LINES) {
        code->line[code->lines++] = (uint16_t)(address >> LINE_SHIFT);
    } else {
        code->cycles++; /* the list is full: count a miss */
    }
}

static void decode(const fdvv_m0 *m0, fdvv_m0_code *code, uint32_t address, uint32_t size)
{
    memset(code, 0, sizeof *code);
    code->size = (uint16_t)size;
    uint32_t line = UINT32_MAX, word = UINT32_MAX;
    for (uint32_t at = address; at < address + size; at += 2) {
        if (at >> LINE_SHIFT != line) need_line(code, at);
        if (at >> 2 != word) code->fetches++;
        line = at >> LINE_SHIFT;
        word = at >> 2;
        uint32_t op = halfword(m0, at);
        code->is_conditional = op >= 0xD000 && op < 0xDE00;
        if (op >= 0xE800) {
            /* BL, MRS, MSR and barriers: all of the Cortex-M0+ */
            code->cycles += (uint16_t)(m0->is_m4 ? cost_32(op, halfword(m0, at + 2)) : 3);
            at += 2;
            if (at >> LINE_SHIFT != line) need_line(code, at);
            if (at >> 2 != word) code->fetches++;
            line = at >> LINE_SHIFT;
            word = at >> 2;
            continue;
        }
        code->cycles += (uint16_t)cost_16(op);
        if ((op & 0xF800) == 0x4800) {
            need_line(code, ((at + 4) & ~3u) + (op & 0xFF) * 4);
            code->fetches++;
        }
    }
}

/* A miss costs one wait state and replaces the least recently used line. */
static void touch(fdvv_m0 *m0, uint32_t line)
{
    uint32_t oldest = 0;
    m0->touches++;
    for (uint32_t i = 0; i < LINES; i++) {
        if (m0->line[i] == line + 1) {
            m0->line_used[i] = m0->touches;
            return;
        }
        if (m0->line_used[i] < m0->line_used[oldest]) oldest = i;
    }
    m0->line[oldest] = line + 1;
    m0->line_used[oldest] = m0->touches;
    m0->cycles++;
}

static void add_cycles(fdvv_m0 *m0, uint32_t address, uint32_t size)
{
    if (address + size > m0->flash_bytes) { /* code in RAM: none in this firmware */
        m0->cycles += size / 2;
        m0->is_conditional = 0;
        return;
    }
    fdvv_m0_code *code = &m0->code[address >> 1];
    if (code->size != size) decode(m0, code, address, size);
    m0->cycles += code->cycles;
    m0->is_conditional = code->is_conditional;
    if (m0->is_cached == CACHED) {
        for (uint32_t i = 0; i < code->lines; i++) touch(m0, code->line[i]);
    } else if (m0->is_cached == SLOW) {
        m0->cycles += code->fetches;
    }
}

void fdvv_m0_block(void *emulator, uint64_t address, uint32_t size, fdvv_m0 *m0)
{
    (void)emulator;
    if (m0->is_stopped && (uint32_t)address == m0->start) {
        m0->is_stopped = 0;
        return;
    }
    m0->is_stopped = 0;
    m0->cycles += m0->waited + (m0->is_conditional && (uint32_t)address != m0->after);
    m0->waited = 0;
    add_cycles(m0, (uint32_t)address, size);
    m0->start = (uint32_t)address;
    m0->after = (uint32_t)address + size;
    while (m0->cycles >= m0->next_event) m0->event();
}

static uint32_t is_clocked(fdvv_m0_window *window, uint32_t offset)
{
    if (!window->gated || (window->m0->clocks >> (offset >> 10)) & 1u) return 1;
    if (!window->m0->unclocked) window->m0->unclocked = window->base + offset;
    return 0;
}

static void note_poll(fdvv_m0 *m0)
{
    uint64_t pass = m0->cycles - m0->polled_at;
    m0->polled_at = m0->cycles;
    m0->passes++;
    if (pass > m0->longest_pass) m0->longest_pass = pass;
    if (pass < m0->shortest_pass) m0->shortest_pass = pass;
}

uint64_t fdvv_m0_read(void *emulator, uint64_t offset, uint32_t size, fdvv_m0_window *window)
{
    (void)emulator;
    fdvv_m0 *m0 = window->m0;
    m0->waited += m0->bus_wait;
    if (!is_clocked(window, (uint32_t)offset)) return 0;
    uint32_t kind = window->kind[offset];
    if (kind & CALL_READ) return m0->read(window->base + (uint32_t)offset, size);
    if (kind & COUNTER) return m0->counter_period ? (m0->cycles - m0->counter_start) % m0->counter_period : 0;
    if (kind & POLLED) note_poll(m0);
    uint64_t value = 0;
    memcpy(&value, window->memory + offset, size);
    return value;
}

void fdvv_m0_write(void *emulator, uint64_t offset, uint32_t size, uint64_t value, fdvv_m0_window *window)
{
    (void)emulator;
    fdvv_m0 *m0 = window->m0;
    m0->waited += m0->bus_wait;
    if (!is_clocked(window, (uint32_t)offset)) return;
    uint32_t kind = window->kind[offset];
    if (kind & CALL_WRITE) {
        m0->write(window->base + (uint32_t)offset, size, (uint32_t)value);
    } else if (kind & WRITE_ONE_CLEARS) {
        for (uint32_t i = 0; i < size; i++) window->memory[offset + i] &= (uint8_t)~(value >> (8 * i));
    } else {
        memcpy(window->memory + offset, &value, size);
    }
}

uint32_t fdvv_m0_bytes(uint32_t which)
{
    return which == 0 ? sizeof(fdvv_m0) : which == 1 ? sizeof(fdvv_m0_window) : sizeof(fdvv_m0_code);
}
