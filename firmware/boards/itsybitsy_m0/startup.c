/* From reset to main: first switch off the bridge and release the key, then initialize the memory. */
#include "pins.h"
#include "chip.h"

extern uint32_t ld_stack_top, ld_data_from, ld_data_start, ld_data_end, ld_bss_start, ld_bss_end;

int main(void);
void board_reset(void);
void board_trap(void);

static void outputs_off(void)
{
    const uint32_t off = PIN_BIT(PIN_IN1) | PIN_BIT(PIN_IN2) | PIN_BIT(PIN_ENABLE) | PIN_BIT(PIN_KEY);
    PORT_PINCFG(PIN_IN1) = PORT_PINCFG_INEN; /* controlled by OUT, not by the timer */
    PORT_PINCFG(PIN_IN2) = PORT_PINCFG_INEN;
    PORT_OUTCLR = off;
    PORT_DIRSET = off;
}

/* After a processor fault no state is valid: switch off the outputs and reset. */
void board_trap(void)
{
    outputs_off();
    SCB_AIRCR = 0x05FA0004u;
    for (;;) {
    }
}

/* Everything is polled, so there are only exception vectors and no interrupt vectors. */
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
