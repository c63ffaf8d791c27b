/* The least that lets the core run: arming, disarming and the force limit. */
#include "supervisor.h"

void fdvv_supervisor_init(fdvv_supervisor *supervisor)
{
    supervisor->mode = FDVV_MODE_BOOT;
    supervisor->fault = FDVV_FAULT_NONE;
    supervisor->faults = 0;
    supervisor->position_known = 0;
    supervisor->host_seen_us = 0;
    supervisor->heat_K_q16 = 0;
    supervisor->tick = 0;
}

uint8_t fdvv_supervisor_ask(fdvv_supervisor *supervisor, const fdvv_settings *settings, uint8_t ask, uint8_t number)
{
    static const uint8_t leads_to[FDVV_ASKS] = {FDVV_MODE_IDLE,  FDVV_MODE_SELFTEST, FDVV_MODE_IDLE,
                                                FDVV_MODE_ARMED, FDVV_MODE_IDLE,     FDVV_MODE_IDLE};
    (void)settings, (void)number;
    if (ask >= FDVV_ASKS)
        return FDVV_REFUSAL_BAD_VALUE;
    supervisor->mode = leads_to[ask];
    return FDVV_REFUSAL_NONE;
}

void fdvv_supervisor_host_seen(fdvv_supervisor *supervisor, uint32_t time_us)
{
    supervisor->host_seen_us = time_us;
}

void fdvv_supervisor_check(fdvv_supervisor *supervisor, const fdvv_settings *settings, const fdvv_inputs *inputs,
                           int32_t displacement_um16, int16_t force_cN64, int16_t commanded_cN64,
                           uint8_t program_state)
{
    (void)settings, (void)displacement_um16, (void)force_cN64, (void)commanded_cN64, (void)program_state;
    supervisor->tick += inputs->elapsed_ticks;
}

void fdvv_supervisor_fault(fdvv_supervisor *supervisor, uint8_t fault, int32_t value, int32_t bound)
{
    (void)value, (void)bound;
    supervisor->fault = fault;
    supervisor->mode = FDVV_MODE_FAULT;
}

int16_t fdvv_supervisor_limit_cN64(fdvv_supervisor *supervisor, const fdvv_settings *settings)
{
    return supervisor->mode == FDVV_MODE_ARMED ? settings->force_limit_cN64 : 0;
}

void fdvv_supervisor_heat(fdvv_supervisor *supervisor, const fdvv_settings *settings, int16_t duty_q15,
                          uint16_t elapsed_ticks)
{
    (void)supervisor, (void)settings, (void)duty_q15, (void)elapsed_ticks;
}

uint8_t fdvv_settings_check(const fdvv_settings *settings)
{
    (void)settings;
    return 0;
}
