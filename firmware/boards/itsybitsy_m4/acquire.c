/* The tick and its readings, timed by hardware.
 *
 * Timer 0 overflows once per tick. Its event increments timer 1 and starts converter 0, which is free-running with a
 * reading per 1.08 us. The DMA controller stores the first `reads` readings of the position and stops. Then the program
 * has converter 1 read the load cell, so that its reading is the youngest, and returns them; until the next tick
 * converter 1 reads the supply, and at times converter 0 the thermistor. If the program is late, a tick has no readings, but timer 1 counts it. */
#include "board.h"
#include "chip.h"
#include "pins.h"

enum {
    CLOCK_MHZ = 48,
    PER_MHZ_Q20 = 21846, /* 2^20 / 48, rounded up: exact for every count of a tick */
    SETTLED = 24,        /* counts after which timer 1 has been incremented too */
    SUPPLY_GAIN_Q11 = 18150 /* 3300 mV / 4096 * (220 + 22) / 22 * 2^11 */
};

static struct {
    uint32_t tick_us;
    uint32_t time_us;   /* of `tick` */
    uint16_t tick;      /* of the last readings returned */
    uint16_t armed;     /* tick that will start the next burst */
    uint16_t supply_mV;
    uint16_t thermistor_counts;
    uint8_t reads;
    uint8_t since;      /* ticks since the thermistor was read */
} acquire;

static volatile uint16_t burst[BOARD_READS_MAX];
static dmac_descriptor descriptor __attribute__((aligned(16)));
static dmac_descriptor written_back __attribute__((aligned(16)));

static void sync_adc(uint32_t base)
{
    while (ADC_SYNCBUSY(base)) {
    }
}

static void sync_timer(uint32_t base)
{
    while (TC_SYNCBUSY(base)) {
    }
}

static uint16_t count_of(uint32_t base)
{
    TC_CTRLBSET(base) = TC_CTRLBSET_READSYNC;
    sync_timer(base);
    return TC_COUNT(base);
}

static void convert(uint32_t base, uint16_t input)
{
    ADC_INPUTCTRL(base) = (uint16_t)(input | ADC_INPUTCTRL_GROUND);
    sync_adc(base);
    ADC_INTFLAG(base) = ADC_INTFLAG_RESRDY;
    ADC_SWTRIG(base) = ADC_SWTRIG_START;
}

static uint16_t result(uint32_t base)
{
    while (!(ADC_INTFLAG(base) & ADC_INTFLAG_RESRDY)) {
    }
    return ADC_RESULT(base);
}

/* A flush lets a converter that still runs free start again, so the bit goes first. */
static void stop_position(void)
{
    ADC_CTRLB(ADC0_BASE) = 0;
    sync_adc(ADC0_BASE);
    ADC_SWTRIG(ADC0_BASE) = ADC_SWTRIG_FLUSH;
    sync_adc(ADC0_BASE);
}

/* Ratiometric from 0 to the supply; three fields of three bits each are its calibration. */
static void start_converter(uint32_t base, uint8_t clock, uint8_t calibration_at)
{
    uint32_t bias = NVM_CALIBRATION >> calibration_at;
    board_clock(clock, 1);
    ADC_CALIB(base) = (uint16_t)((bias & 7u) | ((bias >> 3 & 7u) << 8) | ((bias >> 6 & 7u) << 4));
    ADC_REFCTRL(base) = ADC_REFCTRL_SUPPLY;
    ADC_SAMPCTRL(base) = 0;
    ADC_CTRLB(base) = 0;
    ADC_CTRLA(base) = ADC_CTRLA_DIV4;
    sync_adc(base);
}

static void start_adc(void)
{
    ADC_CTRLA(ADC0_BASE) = ADC_CTRLA_DIV4; /* disabled while it is set up */
    ADC_CTRLA(ADC1_BASE) = ADC_CTRLA_DIV4;
    start_converter(ADC0_BASE, GCLK_ID_ADC0, 2);
    start_converter(ADC1_BASE, GCLK_ID_ADC1, 16);
    PORT_PMUX(PIN_POSITION) = PORT_MUX_B;
    PORT_PINCFG(PIN_POSITION) = PORT_PINCFG_PMUXEN;
    PORT_PMUX(PIN_THERMISTOR) = PORT_MUX_B;
    PORT_PINCFG(PIN_THERMISTOR) = PORT_PINCFG_PMUXEN;
    PORT_B_PMUX(PIN_B_FORCE) = PORT_MUX_B | (PORT_MUX_B << 4); /* and PIN_B_SUPPLY, in the same register */
    PORT_B_PINCFG(PIN_B_FORCE) = PORT_PINCFG_PMUXEN;
    PORT_B_PINCFG(PIN_B_SUPPLY) = PORT_PINCFG_PMUXEN;
    ADC_EVCTRL(ADC0_BASE) = ADC_EVCTRL_STARTEI;
    ADC_INPUTCTRL(ADC0_BASE) = AIN_POSITION | ADC_INPUTCTRL_GROUND;
    ADC_CTRLA(ADC0_BASE) = ADC_CTRLA_DIV4 | ADC_CTRLA_ENABLE;
    ADC_CTRLA(ADC1_BASE) = ADC_CTRLA_DIV4 | ADC_CTRLA_ENABLE;
    sync_adc(ADC0_BASE);
    sync_adc(ADC1_BASE);
    convert(ADC1_BASE, AIN_SUPPLY);
}

static void start_dma(void)
{
    descriptor.btctrl = DMAC_BTCTRL_VALID | DMAC_BTCTRL_HWORD | DMAC_BTCTRL_DSTINC;
    descriptor.btcnt = acquire.reads;
    descriptor.srcaddr = ADC0_BASE + 0x40;
    descriptor.dstaddr = (uint32_t)(uintptr_t)(burst + acquire.reads);
    descriptor.descaddr = 0;
    DMAC_BASEADDR = (uint32_t)(uintptr_t)&descriptor;
    DMAC_WRBADDR = (uint32_t)(uintptr_t)&written_back;
    DMAC_CTRL = DMAC_CTRL_DMAENABLE | DMAC_CTRL_LEVELS;
}

static void start_events(void)
{
    EVSYS_USER(EVSYS_USER_ADC0_START) = EVSYS_USER_OF(0);
    EVSYS_USER(EVSYS_USER_TC1) = EVSYS_USER_OF(0);
    EVSYS_CHANNEL(0) = EVSYS_CHANNEL_GENERATOR_TC0_OVF | EVSYS_CHANNEL_ASYNCHRONOUS;
}

static void start_timers(void)
{
    board_clock(GCLK_ID_TC0_TC1, 1);
    TC_WAVE(TC0_BASE) = TC_WAVE_MATCH_FREQUENCY;
    TC_CC0(TC0_BASE) = (uint16_t)(acquire.tick_us * CLOCK_MHZ - 1u);
    TC_EVCTRL(TC0_BASE) = TC_EVCTRL_OVFEO;
    sync_timer(TC0_BASE);
    TC_EVCTRL(TC1_BASE) = TC_EVCTRL_COUNT_EVENTS;
    TC_CTRLA(TC1_BASE) = TC_CTRLA_ENABLE;
    sync_timer(TC1_BASE);
    TC_CTRLA(TC0_BASE) = TC_CTRLA_ENABLE;
    sync_timer(TC0_BASE);
}

/* Stop the tick; the device clock keeps its value until start_timers. */
static void stop_tick(void)
{
    if (!acquire.tick_us) return;
    acquire.time_us = board_now_us();
    TC_CTRLA(TC0_BASE) = 0;
    sync_timer(TC0_BASE);
    TC_COUNT(TC0_BASE) = 0;
    sync_timer(TC0_BASE);
    DMAC_CHCTRLA = 0;
    acquire.tick = count_of(TC1_BASE);
}

/* Repeated until no tick occurred meanwhile, so that it is known which tick starts the burst. */
static void arm(void)
{
    uint16_t before;
    do {
        before = count_of(TC1_BASE);
        stop_position();
        ADC_CTRLB(ADC0_BASE) = ADC_CTRLB_FREERUN; /* from the tick's event on */
        sync_adc(ADC0_BASE);
        ADC_INTFLAG(ADC0_BASE) = ADC_INTFLAG_RESRDY;
        DMAC_CHCTRLA = 0;
        DMAC_CHINTFLAG = DMAC_CHINTFLAG_TCMPL | DMAC_CHINTFLAG_TERR;
        DMAC_CHCTRLA = DMAC_CHCTRLA_TRIGGER_ADC0 | DMAC_CHCTRLA_ACTION_BURST | DMAC_CHCTRLA_ENABLE;
        acquire.armed = (uint16_t)(count_of(TC1_BASE) + 1u);
    } while ((uint16_t)(before + 1u) != acquire.armed);
}

/* Another input of converter 0 than the position. Between the burst and arm(). */
static uint16_t read_other(uint16_t input)
{
    uint16_t counts;
    stop_position();
    convert(ADC0_BASE, input);
    counts = result(ADC0_BASE);
    ADC_INPUTCTRL(ADC0_BASE) = AIN_POSITION | ADC_INPUTCTRL_GROUND;
    sync_adc(ADC0_BASE);
    return counts;
}

void board_acquire_start(uint16_t tick_us, uint8_t reads)
{
    MCLK_APBAMASK |= MCLK_APBAMASK_TC0 | MCLK_APBAMASK_TC1;
    MCLK_APBBMASK |= MCLK_APBBMASK_EVSYS;
    MCLK_APBDMASK |= MCLK_APBDMASK_ADC0 | MCLK_APBDMASK_ADC1;
    stop_tick();
    acquire.tick_us = tick_us;
    acquire.reads = reads > BOARD_READS_MAX ? BOARD_READS_MAX : reads;
    start_adc();
    read_other(AIN_SETPOINT); /* void, as the first after a choice of the reference */
    board_drive_read_back(read_other(AIN_SETPOINT));
    start_dma();
    start_events();
    start_timers();
    arm();
}

static void summarize(board_readings *readings)
{
    uint32_t sum = 0, lowest = 0xFFFF, highest = 0;
    for (unsigned i = 0; i < acquire.reads; i++) {
        uint32_t reading = burst[i];
        sum += reading;
        if (reading < lowest) lowest = reading;
        if (reading > highest) highest = reading;
    }
    readings->sum = sum;
    readings->lowest = (uint16_t)lowest;
    readings->highest = (uint16_t)highest;
}

static uint16_t millivolts(uint32_t counts)
{
    return (uint16_t)((counts * SUPPLY_GAIN_Q11) >> 11);
}

uint8_t board_acquire(board_readings *readings)
{
    if (!(DMAC_CHINTFLAG & DMAC_CHINTFLAG_TCMPL)) return 0;
    acquire.supply_mV = millivolts(result(ADC1_BASE));
    convert(ADC1_BASE, AIN_FORCE);
    summarize(readings); /* while the conversion is running */
    readings->force_counts = result(ADC1_BASE);
    convert(ADC1_BASE, AIN_SUPPLY);
    readings->elapsed_ticks = (uint16_t)(acquire.armed - acquire.tick);
    acquire.time_us += acquire.tick_us * readings->elapsed_ticks;
    acquire.tick = acquire.armed;
    readings->time_us = acquire.time_us;
    readings->supply_mV = acquire.supply_mV;
    if (++acquire.since == BOARD_THERMISTOR_TICKS) {
        acquire.since = 0;
        acquire.thermistor_counts = read_other(AIN_THERMISTOR);
    }
    readings->thermistor_counts = acquire.thermistor_counts;
    arm();
    return 1;
}

uint32_t board_now_us(void)
{
    uint32_t count;
    uint16_t tick;
    do {
        count = count_of(TC0_BASE);
        tick = count_of(TC1_BASE);
    } while (count < SETTLED || count_of(TC0_BASE) < count);
    uint32_t ticks = (uint16_t)(tick - acquire.tick);
    return acquire.time_us + ticks * acquire.tick_us + ((count * PER_MHZ_Q20) >> 20);
}
