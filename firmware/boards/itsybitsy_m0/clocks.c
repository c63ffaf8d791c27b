/* 48 MHz clock without a crystal, and the routing of clocks and pins to peripherals. */
#include "board.h"
#include "chip.h"

enum { DFLL_MULTIPLIER = 48000 /* of USB's 1 kHz start of frame */, COARSE_FALLBACK = 0x1F };

static void generator(uint8_t id, uint8_t source, uint8_t divisor)
{
    GCLK_GENDIV = (uint32_t)id | ((uint32_t)divisor << 8);
    GCLK_GENCTRL = (uint32_t)id | ((uint32_t)source << 8) | GCLK_GENCTRL_GENEN | GCLK_GENCTRL_IDC;
    while (GCLK_STATUS & GCLK_STATUS_SYNCBUSY) {
    }
}

static void wait_dfll(void)
{
    while (!(SYSCTRL_PCLKSR & SYSCTRL_PCLKSR_DFLLRDY)) {
    }
}

static void start_dfll(void)
{
    uint32_t coarse = NVM_CALIBRATION(1) >> 26;
    uint32_t fine = NVM_CALIBRATION(2) & 0x3FFu;
    if (coarse == 0x3F) coarse = COARSE_FALLBACK; /* not calibrated */
    SYSCTRL_DFLLCTRL = SYSCTRL_DFLLCTRL_ENABLE;   /* erratum 9905: clear ONDEMAND before any other access */
    wait_dfll();
    SYSCTRL_DFLLVAL = (coarse << 10) | fine;
    wait_dfll();
    SYSCTRL_DFLLMUL = (1u << 26) | (1u << 16) | DFLL_MULTIPLIER;
    wait_dfll();
    SYSCTRL_DFLLCTRL = SYSCTRL_DFLLCTRL_ENABLE | SYSCTRL_DFLLCTRL_MODE | SYSCTRL_DFLLCTRL_USBCRM |
                       SYSCTRL_DFLLCTRL_CCDIS | SYSCTRL_DFLLCTRL_BPLCKC;
    wait_dfll();
}

void board_clocks_start(void)
{
    NVMCTRL_CTRLB = NVMCTRL_CTRLB_ONE_WAIT_STATE | NVMCTRL_CTRLB_MANW; /* before the clock frequency is raised */
    start_dfll();
    generator(0, GCLK_SOURCE_DFLL48M, 1);
    generator(1, GCLK_SOURCE_OSCULP32K, 1);
    generator(2, GCLK_SOURCE_DFLL48M, 6);
}

void board_clock(uint8_t peripheral, uint8_t source)
{
    GCLK_CLKCTRL = (uint16_t)(peripheral | ((uint16_t)source << 8) | GCLK_CLKCTRL_CLKEN);
    while (GCLK_STATUS & GCLK_STATUS_SYNCBUSY) {
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
