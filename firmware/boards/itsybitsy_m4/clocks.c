/* Clocks without a crystal: 48 MHz for USB, timers and converters, 120 MHz for the processor; and the routing of clocks and
 * pins to peripherals. Generators: 0 is 120 MHz, 1 48 MHz, 2 2 MHz (reference of the DPLL), 3 12 MHz (DAC). */
#include "board.h"
#include "chip.h"

enum {
    DFLL_MULTIPLIER = 48000, /* of USB's 1 kHz start of frame */
    DFLL_STEPS = (1 << 26) | (10 << 16),
    DPLL_RATIO = 59          /* 2 MHz * (59 + 1) */
};

static void generator(uint8_t id, uint32_t source, uint32_t divisor)
{
    GCLK_GENCTRL(id) = source | (divisor << 16) | GCLK_GENCTRL_GENEN | GCLK_GENCTRL_IDC;
    while (GCLK_SYNCBUSY) {
    }
}

static void sync_dfll(void)
{
    while (OSCCTRL_DFLLSYNC) {
    }
}

/* The bootloader has used the DFLL: the processor runs from the slow oscillator while it is set up again. It keeps its
 * calibrated value until USB's start of frame corrects it. */
static void start_dfll(void)
{
    generator(0, GCLK_SOURCE_OSCULP32K, 1);
    OSCCTRL_DFLLCTRLA = 0;
    OSCCTRL_DFLLMUL = DFLL_STEPS | DFLL_MULTIPLIER;
    sync_dfll();
    OSCCTRL_DFLLCTRLB = 0;
    sync_dfll();
    OSCCTRL_DFLLCTRLA = OSCCTRL_DFLLCTRLA_ENABLE;
    sync_dfll();
    OSCCTRL_DFLLVAL = OSCCTRL_DFLLVAL; /* loads the calibration */
    sync_dfll();
    while (!(OSCCTRL_STATUS & OSCCTRL_STATUS_DFLLRDY)) {
    }
    OSCCTRL_DFLLCTRLB = OSCCTRL_DFLLCTRLB_MODE | OSCCTRL_DFLLCTRLB_USBCRM | OSCCTRL_DFLLCTRLB_CCDIS;
    sync_dfll();
}

static void start_dpll(void)
{
    OSCCTRL_DPLLRATIO = DPLL_RATIO;
    while (OSCCTRL_DPLLSYNCBUSY) {
    }
    OSCCTRL_DPLLCTRLB = OSCCTRL_DPLLCTRLB_REFCLK_GCLK | OSCCTRL_DPLLCTRLB_LBYPASS;
    OSCCTRL_DPLLCTRLA = OSCCTRL_DPLLCTRLA_ENABLE;
    while (OSCCTRL_DPLLSYNCBUSY) {
    }
    while (!(OSCCTRL_DPLLSTATUS & OSCCTRL_DPLLSTATUS_CLKRDY)) {
    }
}

void board_clocks_start(void)
{
    start_dfll();
    generator(1, GCLK_SOURCE_DFLL48M, 1);
    generator(2, GCLK_SOURCE_DFLL48M, 24);
    generator(3, GCLK_SOURCE_DFLL48M, 4);
    board_clock(GCLK_ID_FDPLL0, 2);
    start_dpll();
    generator(0, GCLK_SOURCE_DPLL0, 1); /* the flash sets its wait states itself (AUTOWS, on after a reset) */
    CMCC_CTRL = CMCC_CTRL_CEN;
    MCLK_APBBMASK |= MCLK_APBBMASK_USB;
}

void board_clock(uint8_t peripheral, uint8_t source)
{
    GCLK_PCHCTRL(peripheral) = (uint32_t)source | GCLK_PCHCTRL_CHEN;
    while (!(GCLK_PCHCTRL(peripheral) & GCLK_PCHCTRL_CHEN)) {
    }
}

void board_pin(uint8_t pin, uint8_t function)
{
    uint8_t mux = PORT_PMUX(pin);
    if (pin & 1u) {
        mux = (uint8_t)((mux & 0x0Fu) | ((unsigned)function << 4));
    } else {
        mux = (uint8_t)((mux & 0xF0u) | function);
    }
    PORT_PMUX(pin) = mux;
    PORT_PINCFG(pin) = PORT_PINCFG_PMUXEN | PORT_PINCFG_INEN;
}
