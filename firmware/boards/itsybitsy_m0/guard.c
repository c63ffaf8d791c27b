/* Watchdog, brown-out detector and cause of the last reset. */
#include "board.h"
#include "chip.h"

enum { BROWN_OUT_2_8_V = 39 };

uint8_t board_reset_cause(void)
{
    uint8_t cause = PM_RCAUSE;
    if (cause & PM_RCAUSE_WDT) return BOARD_RESET_WATCHDOG;
    if (cause & (PM_RCAUSE_BOD33 | PM_RCAUSE_BOD12)) return BOARD_RESET_BROWN_OUT;
    return BOARD_RESET_OTHER;
}

void board_brown_out_start(void)
{
    SYSCTRL_BOD33 = 0; /* must be disabled before its configuration is changed */
    while (!(SYSCTRL_PCLKSR & SYSCTRL_PCLKSR_B33SRDY)) {
    }
    uint32_t setting = SYSCTRL_BOD33_LEVEL(BROWN_OUT_2_8_V) | SYSCTRL_BOD33_HYST;
    SYSCTRL_BOD33 = setting | SYSCTRL_BOD33_ENABLE; /* the reset is enabled only when the detector is ready */
    while (!(SYSCTRL_PCLKSR & SYSCTRL_PCLKSR_BOD33RDY)) {
    }
    SYSCTRL_BOD33 = setting | SYSCTRL_BOD33_ENABLE | SYSCTRL_BOD33_RESET;
}

/* At 32.768 kHz instead of the usual 1.024 kHz, 64 cycles are 1.95 ms, or 1.7 to 2.5 ms with the tolerance of the
 * oscillator. */
void board_watchdog_start(void)
{
    board_clock(GCLK_ID_WDT, 1);
    WDT_CONFIG = WDT_CONFIG_64_CYCLES;
    while (WDT_STATUS & WDT_STATUS_SYNCBUSY) {
    }
    WDT_CTRL = WDT_CTRL_ENABLE;
    while (WDT_STATUS & WDT_STATUS_SYNCBUSY) {
    }
}

void board_watchdog_clear(void)
{
    /* a write during synchronisation would stall the processor; the next tick clears the watchdog instead */
    if (!(WDT_STATUS & WDT_STATUS_SYNCBUSY)) WDT_CLEAR = WDT_CLEAR_KEY;
}
