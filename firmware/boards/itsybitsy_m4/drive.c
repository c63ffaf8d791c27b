/* The setpoint of the current stage, the servo and the key line. */
#include "board.h"
#include "chip.h"
#include "pins.h"

enum {
    SETPOINT_ZERO = 2048,
    SETPOINT_SHIFT = 4,  /* Q15 to half of 12 bits */
    SETPOINT_ERROR = 128 /* 0.1 V: more than DAC and converter are off together */
};
/* 3 MHz: 50 Hz is 60000 steps */
enum { STOP_STEPS = 60000, STOP_STEPS_US = 3, STOP_LOWEST_US = 400, STOP_HIGHEST_US = 2600, STOP = 3 };

static uint8_t is_enabled, is_zero_wrong;

static void start_setpoint(void)
{
    board_clock(GCLK_ID_DAC, 3);
    PORT_PMUX(PIN_SETPOINT) = PORT_MUX_B | (PORT_MUX_B << 4); /* and PIN_REFERENCE, in the same register */
    PORT_PINCFG(PIN_REFERENCE) = PORT_PINCFG_PMUXEN;
    /* not the analogue supply: erratum 2.9.2, as MicroPython quotes it; code 0 gave half of it */
    DAC_CTRLB = DAC_CTRLB_REFSEL_VREFPU;
    DAC_DACCTRL0 = DAC_DACCTRL_ENABLE | DAC_DACCTRL_CC12M | DAC_DACCTRL_REFRESH_60_US;
    DAC_CTRLA = DAC_CTRLA_ENABLE;
    while (DAC_SYNCBUSY) {
    }
    while (!(DAC_STATUS & DAC_STATUS_READY0)) {
    }
    DAC_DATA0 = SETPOINT_ZERO;
    PORT_PINCFG(PIN_SETPOINT) = PORT_PINCFG_PMUXEN;
    PORT_OUTSET = PIN_BIT(PIN_FAULT); /* pull-up */
    PORT_PINCFG(PIN_FAULT) = PORT_PINCFG_INEN | PORT_PINCFG_PULLEN;
}

static void start_stop(void)
{
    board_clock(GCLK_ID_TCC0_TCC1, 1);
    TCC_WAVE(TCC1_BASE) = TCC_WAVE_SINGLE_SLOPE;
    TCC_PER(TCC1_BASE) = STOP_STEPS - 1;
    TCC_CC(TCC1_BASE, STOP) = 0; /* no pulse: the servo does not move before the first command */
    while (TCC_SYNCBUSY(TCC1_BASE)) {
    }
    TCC_CTRLA(TCC1_BASE) = TCC_CTRLA_ENABLE | TCC_CTRLA_DIV16;
    board_pin(PIN_STOP, PORT_MUX_F);
}

void board_drive_start(void)
{
    MCLK_APBBMASK |= MCLK_APBBMASK_TCC1;
    MCLK_APBDMASK |= MCLK_APBDMASK_DAC;
    start_setpoint();
    start_stop();
}

/* The setpoint is zero before the stage is enabled and after it is disabled. */
void board_drive(int16_t duty_q15, uint8_t enable)
{
    DAC_DATA0 = (uint16_t)(SETPOINT_ZERO + (enable ? duty_q15 / (1 << SETPOINT_SHIFT) : 0));
    if (enable)
        PORT_OUTSET = PIN_BIT(PIN_ENABLE);
    else
        PORT_OUTCLR = PIN_BIT(PIN_ENABLE);
    is_enabled = enable ? 1 : 0;
}

void board_drive_read_back(uint16_t counts)
{
    is_zero_wrong = counts < SETPOINT_ZERO - SETPOINT_ERROR || counts > SETPOINT_ZERO + SETPOINT_ERROR;
}

uint8_t board_drive_fault(void)
{
    uint32_t pins = PORT_IN;
    if (is_zero_wrong) return 1;
    return is_enabled ? !(pins & PIN_BIT(PIN_FAULT)) : (pins & PIN_BIT(PIN_ENABLE)) != 0;
}

void board_key(uint8_t is_down)
{
    if (is_down)
        PORT_OUTSET = PIN_BIT(PIN_KEY);
    else
        PORT_OUTCLR = PIN_BIT(PIN_KEY);
}

void board_stop(uint16_t pulse_us)
{
    if (pulse_us < STOP_LOWEST_US) pulse_us = STOP_LOWEST_US;
    if (pulse_us > STOP_HIGHEST_US) pulse_us = STOP_HIGHEST_US;
    TCC_CCBUF(TCC1_BASE, STOP) = (uint32_t)pulse_us * STOP_STEPS_US;
}
