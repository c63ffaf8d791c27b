/* The firmware's core for Python: sizes, many ticks in one call, and the state of the supervisor. */
#include "arithmetic.h"
#include "core.h"

#include <stddef.h>

/* Sizes and offsets, for Python to compare with its own. */
void fdvv_bridge_layout(int64_t layout[19]) {
    const int64_t values[19] = {
        sizeof(fdvv_core), sizeof(fdvv_inputs), sizeof(fdvv_outputs),
        offsetof(fdvv_inputs, time_us), offsetof(fdvv_inputs, sum), offsetof(fdvv_inputs, lowest),
        offsetof(fdvv_inputs, highest), offsetof(fdvv_inputs, elapsed_ticks), offsetof(fdvv_inputs, supply_mV),
        offsetof(fdvv_inputs, force_counts), offsetof(fdvv_inputs, thermistor_counts), offsetof(fdvv_inputs, board),
        offsetof(fdvv_outputs, duty_q15), offsetof(fdvv_outputs, enable), offsetof(fdvv_outputs, slot),
        offsetof(fdvv_outputs, stop_us), offsetof(fdvv_outputs, key), offsetof(fdvv_outputs, mode),
        offsetof(fdvv_outputs, record),
    };
    for (int i = 0; i < 19; i++) layout[i] = values[i];
}

/* Check a whole image; detail is the offset of what is invalid. */
uint8_t fdvv_bridge_check_image(const fdvv_core *core, const uint8_t *image, uint16_t size_bytes, uint32_t crc32,
                                uint16_t *detail) {
    fdvv_image_check check;
    uint8_t refusal;
    fdvv_image_check_begin(&check, image, size_bytes, crc32);
    do refusal = fdvv_image_check_step(&check, &core->settings, 256);
    while (refusal == FDVV_REFUSAL_BUSY);
    *detail = check.detail;
    return refusal;
}

uint8_t fdvv_bridge_ask(fdvv_core *core, uint8_t ask, uint8_t number) {
    return fdvv_supervisor_ask(&core->supervisor, &core->settings, ask, number);
}

void fdvv_bridge_hear(fdvv_core *core, uint32_t time_us) {
    fdvv_supervisor_host_seen(&core->supervisor, time_us);
}

void fdvv_bridge_fault(fdvv_core *core, uint8_t fault, int32_t value, int32_t bound) {
    fdvv_supervisor_fault(&core->supervisor, fault, value, bound);
}

uint8_t fdvv_bridge_mode(const fdvv_core *core) { return core->supervisor.mode; }

uint8_t fdvv_bridge_latched(const fdvv_core *core) { return core->supervisor.fault; }

const fdvv_evidence *fdvv_bridge_evidence(const fdvv_core *core) { return &core->supervisor.evidence; }

/* Run count ticks; if host_heard, a message of the host arrives before each of them. */
void fdvv_bridge_run(fdvv_core *core, const fdvv_inputs *inputs, fdvv_outputs *outputs, int64_t count,
                     int32_t host_heard) {
    for (int64_t i = 0; i < count; i++) {
        if (host_heard) fdvv_supervisor_host_seen(&core->supervisor, inputs[i].time_us);
        fdvv_core_tick(core, inputs + i, outputs + i);
        fdvv_core_after_tick(core, inputs + i);
    }
}

/* Functions that are inline in the core. */
int32_t fdvv_bridge_part_q15(uint32_t part, uint32_t whole) { return fdvv_fraction_q15(part, whole); }

uint64_t fdvv_bridge_wide_product(uint32_t x, uint32_t y) { return fdvv_wide_product(x, y); }
