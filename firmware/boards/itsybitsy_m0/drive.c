/* The bridge, the servo and the key line. */
#include "board.h"
#include "pins.h"
#include "chip.h"

/* Dual slope: 48 MHz / (2 * 1024) = 23.4 kHz, which is inaudible; 1024 steps in each direction. */
enum { PWM_STEPS = 1024, PWM_SHIFT = 5 /* Q15 to steps */, IN1 = 2, IN2 = 3 };
/* 3 MHz: 50 Hz is 60000 steps */
enum { STOP_STEPS = 60000, STOP_STEPS_US = 3, STOP_LOWEST_US = 400, STOP_HIGHEST_US = 2600, STOP = 1 };

static uint8_t is_enabled;

static void start_bridge(void)
{
    TCC_WAVE(TCC0_BASE) = TCC_WAVE_DUAL_SLOPE | TCC_WAVE_HIGH_BELOW;
    TCC_PER(TCC0_BASE) = PWM_STEPS;
    TCC_CC(TCC0_BASE, IN1) = 0;
    TCC_CC(TCC0_BASE, IN2) = 0;
    while (TCC_SYNCBUSY(TCC0_BASE)) {
    }
    TCC_CTRLA(TCC0_BASE) = TCC_CTRLA_ENABLE;
    PORT_PMUX(PIN_IN1) = PORT_MUX_F | (PORT_MUX_F << 4); /* one register for both; connected when enabled */
    PORT_OUTSET = PIN_BIT(PIN_FAULT);                    /* pull-up */
    PORT_PINCFG(PIN_FAULT) = PORT_PINCFG_INEN | PORT_PINCFG_PULLEN;
}

static void start_stop(void)
{
    TCC_WAVE(TCC1_BASE) = TCC_WAVE_SINGLE_SLOPE;
    TCC_PER(TCC1_BASE) = STOP_STEPS - 1;
    TCC_CC(TCC1_BASE, STOP) = 0; /* no pulse: the servo does not move before the first command */
    while (TCC_SYNCBUSY(TCC1_BASE)) {
    }
    TCC_CTRLA(TCC1_BASE) = TCC_CTRLA_ENABLE | TCC_CTRLA_DIV16;
    board_pin(PIN_STOP, PORT_MUX_E);
}

void board_drive_start(void)
{
    PM_APBCMASK |= PM_APBCMASK_TCC0 | PM_APBCMASK_TCC1;
    board_clock(GCLK_ID_TCC0_TCC1, 0);
    start_bridge();
    start_stop();
}

static void connect(uint8_t enable)
{
    uint8_t config = enable ? PORT_PINCFG_INEN | PORT_PINCFG_PMUXEN : PORT_PINCFG_INEN;
    if (!enable) PORT_OUTCLR = PIN_BIT(PIN_ENABLE);
    PORT_PINCFG(PIN_IN1) = config; /* without PMUXEN the pin is controlled by OUT, which is always low */
    PORT_PINCFG(PIN_IN2) = config;
    if (enable) PORT_OUTSET = PIN_BIT(PIN_ENABLE);
    is_enabled = enable;
}

/* Slow decay: one input is high; the other is low in the driven part of the period and high in the rest, during which
 * the coil is shorted. So the mean voltage is duty times supply at any current, without a discontinuity at duty 0. The
 * two compare values may take effect one period (43 us) apart; either mixture drives less than commanded. */
void board_drive(int16_t duty_q15, uint8_t enable)
{
    int32_t steps = duty_q15 / (1 << PWM_SHIFT);
    TCC_CCB(TCC0_BASE, IN1) = (uint32_t)(steps >= 0 ? PWM_STEPS : PWM_STEPS + steps);
    TCC_CCB(TCC0_BASE, IN2) = (uint32_t)(steps >= 0 ? PWM_STEPS - steps : PWM_STEPS);
    enable = enable ? 1 : 0;
    if (enable != is_enabled) connect(enable);
}

uint8_t board_drive_fault(void)
{
    uint32_t pins = PORT_IN;
    if (!is_enabled) return (pins & (PIN_BIT(PIN_IN1) | PIN_BIT(PIN_IN2))) != 0;
    return !(pins & PIN_BIT(PIN_FAULT));
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
    TCC_CCB(TCC1_BASE, STOP) = (uint32_t)pulse_us * STOP_STEPS_US;
}
