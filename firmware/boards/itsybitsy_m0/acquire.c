/* The tick and its readings, timed by hardware.
 *
 * Timer 3 overflows once per tick. Its event increments timer 4 and starts the ADC, which is free-running with one
 * reading per 4 us. The DMA controller stores the first `reads` readings and stops. Then the program converts one other
 * input, returns the readings and arms ADC and DMA for the next tick. If it is late, a tick has no readings, but
 * timer 4 counts it. */
#include "board.h"
#include "pins.h"
#include "chip.h"

enum {
    CLOCK_MHZ = 48,
    PER_MHZ_Q20 = 21846, /* 2^20 / 48, rounded up: exact for every count of a tick */
    SETTLED = 24,        /* counts after which timer 4 has been incremented too */
    SUPPLY_GAIN_Q13 = 36600 /* 3300 mV / 4096 * (100 + 22) / 22 * 2^13 */
};

static struct {
    uint32_t tick_us;
    uint32_t time_us;   /* of `tick` */
    uint16_t tick;      /* of the last readings returned */
    uint16_t armed;     /* tick that will start the next burst */
    uint16_t supply_mV;
    uint16_t force_counts;
    uint16_t thermistor_counts;
    uint8_t reads;
    uint8_t turn;       /* of the other input: supply and force alternate, and at times the thermistor */
} acquire;

static volatile uint16_t burst[BOARD_READS_MAX];
static dmac_descriptor descriptor __attribute__((aligned(16)));
static dmac_descriptor written_back __attribute__((aligned(16)));

static void sync_adc(void)
{
    while (ADC_STATUS & ADC_STATUS_SYNCBUSY) {
    }
}

static void sync_timer(uint32_t base)
{
    while (TC_STATUS(base) & TC_STATUS_SYNCBUSY) {
    }
}

static void select_input(uint32_t input)
{
    ADC_INPUTCTRL = input | ADC_INPUTCTRL_GROUND | ADC_INPUTCTRL_HALF_GAIN;
    sync_adc();
}

/* A flush lets a converter that still runs free start again, so the bit goes first. */
static void stop_adc(void)
{
    ADC_CTRLB = ADC_CTRLB_12_BIT_DIV4;
    sync_adc();
    ADC_SWTRIG = ADC_SWTRIG_FLUSH;
    sync_adc();
}

static void start_adc(void)
{
    board_clock(GCLK_ID_ADC, 2); /* 8 MHz / 4: the maximum of the ADC is 2.1 MHz */
    PORT_PMUX(PIN_POSITION) = PORT_MUX_B;
    PORT_PMUX(PIN_SUPPLY) = PORT_MUX_B | (PORT_MUX_B << 4); /* and PIN_FORCE, in the same register */
    PORT_PINCFG(PIN_POSITION) = PORT_PINCFG_PMUXEN;
    PORT_PINCFG(PIN_SUPPLY) = PORT_PINCFG_PMUXEN;
    PORT_PINCFG(PIN_FORCE) = PORT_PINCFG_PMUXEN;
    PORT_B_PMUX(PIN_B_THERMISTOR) = PORT_MUX_B;
    PORT_B_PINCFG(PIN_B_THERMISTOR) = PORT_PINCFG_PMUXEN;
    uint32_t linearity = (NVM_CALIBRATION(0) >> 27) | ((NVM_CALIBRATION(1) & 7u) << 5);
    ADC_CALIB = (uint16_t)(linearity | (((NVM_CALIBRATION(1) >> 3) & 7u) << 8));
    ADC_REFCTRL = ADC_REFCTRL_HALF_SUPPLY; /* with gain 1/2: ratiometric from 0 to the supply */
    ADC_SAMPCTRL = 0;
    ADC_EVCTRL = ADC_EVCTRL_STARTEI;
    ADC_CTRLA = ADC_CTRLA_ENABLE;
    sync_adc();
}

static void start_dma(void)
{
    descriptor.btctrl = DMAC_BTCTRL_VALID | DMAC_BTCTRL_HWORD | DMAC_BTCTRL_DSTINC;
    descriptor.btcnt = acquire.reads;
    descriptor.srcaddr = ADC_RESULT_ADDRESS;
    descriptor.dstaddr = (uint32_t)(uintptr_t)(burst + acquire.reads);
    descriptor.descaddr = 0;
    DMAC_BASEADDR = (uint32_t)(uintptr_t)&descriptor;
    DMAC_WRBADDR = (uint32_t)(uintptr_t)&written_back;
    DMAC_CTRL = DMAC_CTRL_DMAENABLE | DMAC_CTRL_LEVELS;
    DMAC_CHID = 0; /* the only channel in use */
    DMAC_CHCTRLB = DMAC_CHCTRLB_TRIGGER_ADC | DMAC_CHCTRLB_ACTION_BEAT;
}

static void start_events(void)
{
    EVSYS_USER = EVSYS_USER_ADC_START | EVSYS_USER_OF(0);
    EVSYS_USER = EVSYS_USER_TC4 | EVSYS_USER_OF(0);
    EVSYS_CHANNEL = EVSYS_CHANNEL_GENERATOR_TC3_OVF | EVSYS_CHANNEL_ASYNCHRONOUS;
}

static void start_timers(void)
{
    board_clock(GCLK_ID_TCC2_TC3, 0);
    board_clock(GCLK_ID_TC4_TC5, 0);
    TC_CC0(TC3_BASE) = (uint16_t)(acquire.tick_us * CLOCK_MHZ - 1u);
    TC_EVCTRL(TC3_BASE) = TC_EVCTRL_OVFEO;
    TC_EVCTRL(TC4_BASE) = TC_EVCTRL_COUNT_EVENTS;
    TC_CTRLA(TC4_BASE) = TC_CTRLA_ENABLE;
    sync_timer(TC4_BASE);
    TC_READREQ(TC4_BASE) = TC_READREQ_COUNT_ALWAYS;
    TC_CTRLA(TC3_BASE) = TC_CTRLA_MATCH_FREQUENCY | TC_CTRLA_ENABLE;
    sync_timer(TC3_BASE);
    TC_READREQ(TC3_BASE) = TC_READREQ_COUNT_ALWAYS;
}

/* Stop the tick; the device clock keeps its value until start_timers. */
static void stop_tick(void)
{
    if (!acquire.tick_us) return;
    acquire.time_us = board_now_us();
    TC_CTRLA(TC3_BASE) = TC_CTRLA_MATCH_FREQUENCY;
    sync_timer(TC3_BASE);
    TC_COUNT(TC3_BASE) = 0;
    sync_timer(TC3_BASE);
    DMAC_CHCTRLA = 0;
    acquire.tick = TC_COUNT(TC4_BASE);
}

/* Repeated until no tick occurred meanwhile, so that it is known which tick starts the burst. */
static void arm(void)
{
    uint16_t before;
    do {
        before = TC_COUNT(TC4_BASE);
        stop_adc();
        select_input(AIN_POSITION);
        ADC_INTFLAG = ADC_INTFLAG_RESRDY;
        DMAC_CHCTRLA = 0;
        DMAC_CHINTFLAG = DMAC_CHINTFLAG_TCMPL | DMAC_CHINTFLAG_TERR;
        DMAC_CHCTRLA = DMAC_CHCTRLA_ENABLE;
        ADC_CTRLB = ADC_CTRLB_12_BIT_DIV4 | ADC_CTRLB_FREERUN;
        sync_adc();
        acquire.armed = (uint16_t)(TC_COUNT(TC4_BASE) + 1u);
    } while ((uint16_t)(before + 1u) != acquire.armed);
}

void board_acquire_start(uint16_t tick_us, uint8_t reads)
{
    stop_tick();
    acquire.tick_us = tick_us;
    acquire.reads = reads > BOARD_READS_MAX ? BOARD_READS_MAX : reads;
    PM_APBCMASK |= PM_APBCMASK_EVSYS | PM_APBCMASK_TC3 | PM_APBCMASK_TC4 | PM_APBCMASK_ADC;
    start_adc();
    start_dma();
    start_events();
    start_timers();
    arm();
}

static uint32_t other_input(void)
{
    if (acquire.turn == BOARD_THERMISTOR_TICKS - 1) return AIN_THERMISTOR;
    return acquire.turn & 1u ? AIN_FORCE : AIN_SUPPLY;
}

static void convert_other(void)
{
    stop_adc();
    select_input(other_input());
    ADC_INTFLAG = ADC_INTFLAG_RESRDY;
    ADC_SWTRIG = ADC_SWTRIG_START;
}

static void read_other(void)
{
    while (!(ADC_INTFLAG & ADC_INTFLAG_RESRDY)) {
    }
    uint32_t counts = ADC_RESULT;
    switch (other_input()) {
    case AIN_SUPPLY: acquire.supply_mV = (uint16_t)((counts * SUPPLY_GAIN_Q13) >> 13); break;
    case AIN_FORCE: acquire.force_counts = (uint16_t)counts; break;
    default: acquire.thermistor_counts = (uint16_t)counts;
    }
    acquire.turn = (uint8_t)((acquire.turn + 1u) % BOARD_THERMISTOR_TICKS);
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

uint8_t board_acquire(board_readings *readings)
{
    if (!(DMAC_CHINTFLAG & DMAC_CHINTFLAG_TCMPL)) return 0;
    convert_other();
    summarize(readings); /* while the conversion is running */
    read_other();
    readings->elapsed_ticks = (uint16_t)(acquire.armed - acquire.tick);
    acquire.time_us += acquire.tick_us * readings->elapsed_ticks;
    acquire.tick = acquire.armed;
    readings->time_us = acquire.time_us;
    readings->supply_mV = acquire.supply_mV;
    readings->force_counts = acquire.force_counts;
    readings->thermistor_counts = acquire.thermistor_counts;
    arm();
    return 1;
}

uint32_t board_now_us(void)
{
    uint32_t count;
    uint16_t tick;
    do {
        count = TC_COUNT(TC3_BASE);
        tick = TC_COUNT(TC4_BASE);
    } while (count < SETTLED || TC_COUNT(TC3_BASE) < count);
    uint32_t ticks = (uint16_t)(tick - acquire.tick);
    return acquire.time_us + ticks * acquire.tick_us + ((count * PER_MHZ_Q20) >> 20);
}
