/* From reset to main: first switch off the drive and release the key, then the floating-point unit and the memory. This
 * file is compiled without floating-point registers, which cannot be used before the unit is on. */
#include "chip.h"
#include "pins.h"

extern uint32_t ld_stack_top, ld_data_from, ld_data_start, ld_data_end, ld_bss_start, ld_bss_end;

int main(void);
void board_reset(void);
void board_trap(void);

static void outputs_off(void)
{
    const uint32_t off = PIN_BIT(PIN_ENABLE) | PIN_BIT(PIN_KEY);
    PORT_PINCFG(PIN_ENABLE) = PORT_PINCFG_INEN;
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
    &ld_stack_top, board_reset, board_trap, board_trap, board_trap, board_trap, board_trap, 0,
    0, 0, 0, board_trap, board_trap, 0, board_trap, board_trap
};

static void start_fpu(void)
{
    SCB_CPACR |= SCB_CPACR_FPU;
    __asm__ volatile("dsb\n\tisb" ::: "memory");
}

void board_reset(void)
{
    outputs_off();
    SCB_VTOR = (uint32_t)(uintptr_t)vectors;
    start_fpu();
    const uint32_t *from = &ld_data_from;
    for (uint32_t *to = &ld_data_start; to < &ld_data_end;) *to++ = *from++;
    for (uint32_t *to = &ld_bss_start; to < &ld_bss_end;) *to++ = 0;
    main();
    board_trap();
}
