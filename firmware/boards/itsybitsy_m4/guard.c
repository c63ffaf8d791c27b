/* Watchdog, brown-out detector and cause of the last reset. */
#include "board.h"
#include "chip.h"

enum { BROWN_OUT_2_8_V = 216 /* 1.5 V + 216 * 6 mV */ };

uint8_t board_reset_cause(void)
{
    uint8_t cause = RSTC_RCAUSE;
    if (cause & RSTC_RCAUSE_WDT) return BOARD_RESET_WATCHDOG;
    if (cause & (RSTC_RCAUSE_BODVDD | RSTC_RCAUSE_BODCORE)) return BOARD_RESET_BROWN_OUT;
    return BOARD_RESET_OTHER;
}

void board_brown_out_start(void)
{
    SUPC_BOD33 &= ~(uint32_t)SUPC_BOD33_ENABLE; /* must be disabled before its configuration is changed */
    while (!(SUPC_STATUS & SUPC_STATUS_B33SRDY)) {
    }
    uint32_t setting = SUPC_BOD33_LEVEL(BROWN_OUT_2_8_V) | SUPC_BOD33_HYST(2);
    SUPC_BOD33 = setting | SUPC_BOD33_ENABLE; /* the reset is chosen only when the detector is ready */
    while (!(SUPC_STATUS & SUPC_STATUS_BOD33RDY)) {
    }
    SUPC_BOD33 = setting | SUPC_BOD33_ENABLE | SUPC_BOD33_ACTION_RESET;
}

/* This chip's watchdog has a fixed clock of 1.024 kHz: the shortest period is 8 cycles, 7.8 ms. */
void board_watchdog_start(void)
{
    WDT_CONFIG = WDT_CONFIG_8_CYCLES;
    WDT_CTRLA = WDT_CTRLA_ENABLE;
    while (WDT_SYNCBUSY) {
    }
}

void board_watchdog_clear(void)
{
    /* a write during synchronisation would stall the processor; a later tick clears the watchdog instead */
    if (!WDT_SYNCBUSY) WDT_CLEAR = WDT_CLEAR_KEY;
}
