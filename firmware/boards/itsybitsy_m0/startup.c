/* From reset to main: the bridge off and the key up first, then memory. */
#include "pins.h"
#include "samd21.h"

extern uint32_t ld_stack_top, ld_data_from, ld_data_start, ld_data_end, ld_bss_start, ld_bss_end;

int main(void);
void board_reset(void);
void board_trap(void);

static void outputs_off(void)
{
    const uint32_t off = PIN_BIT(PIN_IN1) | PIN_BIT(PIN_IN2) | PIN_BIT(PIN_ENABLE) | PIN_BIT(PIN_KEY);
    PORT_PINCFG(PIN_IN1) = PORT_PINCFG_INEN; /* the pin obeys OUT, not the timer */
    PORT_PINCFG(PIN_IN2) = PORT_PINCFG_INEN;
    PORT_OUTCLR = off;
    PORT_DIRSET = off;
}

/* Any fault of the processor: nothing can be trusted, so off and anew. */
void board_trap(void)
{
    outputs_off();
    SCB_AIRCR = 0x05FA0004u;
    for (;;) {
    }
}

/* No interrupt is ever enabled: everything is polled, so only the processor's own traps are listed. */
__attribute__((section(".vectors"), used)) static const void *const vectors[16] = {
    &ld_stack_top, board_reset, board_trap, board_trap, 0, 0, 0, 0,
    0, 0, 0, board_trap, 0, 0, board_trap, board_trap
};

void board_reset(void)
{
    outputs_off();
    SCB_VTOR = (uint32_t)(uintptr_t)vectors;
    const uint32_t *from = &ld_data_from;
    for (uint32_t *to = &ld_data_start; to < &ld_data_end;) *to++ = *from++;
    for (uint32_t *to = &ld_bss_start; to < &ld_bss_end;) *to++ = 0;
    main();
    board_trap();
}
