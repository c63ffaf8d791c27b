/* The handlers of the requests. Payloads are aligned and have the correct length. */
#include "link_state.h"

#ifdef FDVV_FORCE_LOOP
#include "link_loop.h"
#else
#define forget_loop(link) ((void)0)
#define LOOP_COMMANDS
#endif

#define FIRMWARE_VERSION 0x000200u /* 0.2.0 */

static uint8_t hello(fdvv_link *link, const void *request)
{
    const fdvv_hello_request *hello = (const fdvv_hello_request *)request;
    fdvv_hello_reply *reply = (fdvv_hello_reply *)link->reply;
    uint8_t i, same = hello->version == FDVV_PROTOCOL_VERSION && hello->hash == FDVV_PROTOCOL_HASH;
    link->host = same ? FDVV_HOST_KNOWN : FDVV_HOST_OTHER_HASH;
    forget_loop(link);
    reply->hash = FDVV_PROTOCOL_HASH;
    reply->firmware = FIRMWARE_VERSION;
    reply->serial = link->board->serial;
    reply->image_bytes = FDVV_IMAGE_BYTES;
    reply->travel_um16_256 = link->board->travel_limit_um16_256;
    reply->tick_us = link->core->settings.tick_us;
    reply->board_flags = link->board->flags;
    reply->mode = link->core->supervisor.mode;
    for (i = 0; i < sizeof reply->name; i++)
        reply->name[i] = (uint8_t)link->board->name[i];
    return FDVV_REFUSAL_NONE;
}

static uint8_t ping(fdvv_link *link, const void *request)
{
    fdvv_ping_reply *reply = (fdvv_ping_reply *)link->reply;
    const fdvv_supervisor *supervisor = &link->core->supervisor;
    reply->host_us = ((const fdvv_ping_request *)request)->host_us;
    reply->device_us = link->arrived_us;
    reply->tick = link->tick;
    reply->mode = supervisor->mode;
    reply->fault = supervisor->fault;
    reply->heat_K = (uint16_t)(supervisor->heat.coil_K_q16 >> 16);
    return FDVV_REFUSAL_NONE;
}

static uint8_t read_settings(fdvv_link *link, const void *request)
{
    fdvv_settings *reply = (fdvv_settings *)link->reply;
    (void)request;
    *reply = link->core->settings;
    return FDVV_REFUSAL_NONE;
}

static uint8_t read_limits(fdvv_link *link, const void *request)
{
    (void)request;
    *(fdvv_board_limits *)link->reply = *link->core->supervisor.limits;
    return FDVV_REFUSAL_NONE;
}

static uint8_t read_coil(fdvv_link *link, const void *request)
{
    fdvv_read_coil_reply *reply = (fdvv_read_coil_reply *)link->reply;
    const fdvv_supervisor *supervisor = &link->core->supervisor;
    (void)request;
    reply->heat_K = (uint16_t)(supervisor->heat.coil_K_q16 >> 16);
    reply->thermistor_K = (uint16_t)(FDVV_THERMISTOR(supervisor, is_known)
                                         ? FDVV_THERMISTOR(supervisor, reading_K_q16) >> 16
                                         : UINT16_MAX);
    reply->thermistor_counts = FDVV_THERMISTOR(supervisor, counts);
    reply->spare = 0;
    return FDVV_REFUSAL_NONE;
}

static uint8_t write_settings(fdvv_link *link, const void *request)
{
    const fdvv_settings *settings = (const fdvv_settings *)request;
    uint8_t invalid, mode = link->core->supervisor.mode;
    /* also allowed in mode fault, because wrong settings may be the cause of the fault */
    if (mode != FDVV_MODE_IDLE && mode != FDVV_MODE_FAULT)
        return FDVV_REFUSAL_WRONG_MODE;
    invalid = fdvv_settings_check(settings, link->core->supervisor.limits);
    if (invalid) {
        link->detail = (uint16_t)(invalid - 1);
        return FDVV_REFUSAL_BAD_VALUE;
    }
    /* they were checked against the old limits */
    fdvv_link_forget_programs(link);
    fdvv_core_set(link->core, settings);
    return FDVV_REFUSAL_NONE;
}

static uint8_t request_mode(fdvv_link *link, uint8_t what, uint8_t number)
{
    return fdvv_supervisor_ask(&link->core->supervisor, &link->core->settings, what, number);
}

static uint8_t arm(fdvv_link *link, const void *request)
{
    (void)request;
    return link->core->image ? request_mode(link, FDVV_ASK_ARM, 0) : FDVV_REFUSAL_NO_IMAGE;
}

static uint8_t disarm(fdvv_link *link, const void *request)
{
    (void)request;
    return request_mode(link, FDVV_ASK_DISARM, 0);
}

static uint8_t event(fdvv_link *link, const void *request)
{
    const fdvv_event_request *event = (const fdvv_event_request *)request;
    if (event->event > 31 || event->spare)
        return FDVV_REFUSAL_BAD_VALUE;
    fdvv_core_event(link->core, event->event);
    return FDVV_REFUSAL_NONE;
}

static uint8_t telemetry(fdvv_link *link, const void *request)
{
    const fdvv_telemetry_request *telemetry = (const fdvv_telemetry_request *)request;
    if (telemetry->spare)
        return FDVV_REFUSAL_BAD_VALUE;
    fdvv_link_set_telemetry(link, telemetry->every);
    return FDVV_REFUSAL_NONE;
}

static uint8_t read_fault(fdvv_link *link, const void *request)
{
    fdvv_read_fault_reply *reply = (fdvv_read_fault_reply *)link->reply;
    const fdvv_supervisor *supervisor = &link->core->supervisor;
    const fdvv_evidence *evidence = &supervisor->evidence;
    (void)request;
    reply->fault = supervisor->fault;
    reply->spare = 0;
    reply->count = supervisor->faults;
    reply->time_us = evidence->time_us;
    reply->tick = evidence->tick;
    reply->value = evidence->value;
    reply->bound = evidence->bound;
    reply->displacement_um16 = evidence->displacement_um16;
    reply->commanded_cN64 = evidence->commanded_cN64;
    reply->state = evidence->state;
    reply->mode = evidence->mode;
    return FDVV_REFUSAL_NONE;
}

static uint8_t clear_fault(fdvv_link *link, const void *request)
{
    const fdvv_clear_fault_request *clear = (const fdvv_clear_fault_request *)request;
    return clear->spare ? FDVV_REFUSAL_BAD_VALUE : request_mode(link, FDVV_ASK_CLEAR, clear->fault);
}

static uint8_t selftest(fdvv_link *link, const void *request)
{
    uint8_t refusal = request_mode(link, FDVV_ASK_TEST, 0);
    (void)request;
    if (refusal != FDVV_REFUSAL_NONE)
        return refusal;
    link->testing = 1;
    link->deferred = FDVV_MSG_SELFTEST;
    return FDVV_REFUSAL_NONE;
}

void fdvv_link_poll_selftest(fdvv_link *link)
{
    fdvv_selftest_reply results, *reply = (fdvv_selftest_reply *)link->reply;
    uint8_t i;
    for (i = 0; i < sizeof results.values; i++)
        results.values[i] = 0;
    for (i = 0; i < sizeof results.verdicts; i++)
        results.verdicts[i] = FDVV_VERDICT_NOT_TESTED;
    if (!link->board->selftest(&results))
        return;
    link->testing = 0;
    (void)request_mode(link, FDVV_ASK_TESTED, 0);
    if (link->deferred != FDVV_MSG_SELFTEST)
        return; /* the host has disconnected meanwhile */
    *reply = results;
    fdvv_link_answer_deferred(link, FDVV_REFUSAL_NONE);
}

static uint8_t read_counters(fdvv_link *link, const void *request)
{
    fdvv_read_counters_reply *reply = (fdvv_read_counters_reply *)link->reply;
    (void)request;
    *reply = *link->board->counters;
    return FDVV_REFUSAL_NONE;
}

static uint8_t announce(fdvv_link *link, const void *request)
{
    const fdvv_announce_request *announce = (const fdvv_announce_request *)request;
    if (announce->velocity_mm_s16 < 8 || announce->velocity_mm_s16 > 16000 || announce->spare)
        return FDVV_REFUSAL_BAD_VALUE;
    fdvv_core_announce(link->core, announce->velocity_mm_s16);
    return FDVV_REFUSAL_NONE;
}

static uint8_t vibrate(fdvv_link *link, const void *request)
{
    const fdvv_vibrate_request *vibrate = (const fdvv_vibrate_request *)request;
    if (!link->core->image)
        return FDVV_REFUSAL_NO_IMAGE;
    if (vibrate->spare || vibrate->slot >= fdvv_image_head(link->core->image)->slots)
        return FDVV_REFUSAL_BAD_VALUE;
    link->board->play(vibrate->slot);
    return FDVV_REFUSAL_NONE;
}

static const fdvv_command commands[] = {
    {FDVV_MSG_HELLO, sizeof(fdvv_hello_request), sizeof(fdvv_hello_reply), hello},
    {FDVV_MSG_PING, sizeof(fdvv_ping_request), sizeof(fdvv_ping_reply), ping},
    {FDVV_MSG_READ_SETTINGS, 0, sizeof(fdvv_settings), read_settings},
    {FDVV_MSG_WRITE_SETTINGS, sizeof(fdvv_settings), 0, write_settings},
    {FDVV_MSG_BEGIN, sizeof(fdvv_begin_request), 0, fdvv_link_begin},
    {FDVV_MSG_DATA, sizeof(fdvv_data_request), sizeof(fdvv_data_reply), fdvv_link_data},
    {FDVV_MSG_COMMIT, 0, 0, fdvv_link_commit},
    {FDVV_MSG_ACTIVATE, 0, 0, fdvv_link_activate},
    {FDVV_MSG_ARM, 0, 0, arm},
    {FDVV_MSG_DISARM, 0, 0, disarm},
    {FDVV_MSG_EVENT, sizeof(fdvv_event_request), 0, event},
    {FDVV_MSG_TELEMETRY, sizeof(fdvv_telemetry_request), 0, telemetry},
    {FDVV_MSG_READ_FAULT, 0, sizeof(fdvv_read_fault_reply), read_fault},
    {FDVV_MSG_CLEAR_FAULT, sizeof(fdvv_clear_fault_request), 0, clear_fault},
    {FDVV_MSG_SELFTEST, 0, sizeof(fdvv_selftest_reply), selftest},
    {FDVV_MSG_READ_COUNTERS, 0, sizeof(fdvv_read_counters_reply), read_counters},
    {FDVV_MSG_ANNOUNCE, sizeof(fdvv_announce_request), 0, announce},
    {FDVV_MSG_VIBRATE, sizeof(fdvv_vibrate_request), 0, vibrate},
    {FDVV_MSG_READ_LIMITS, 0, sizeof(fdvv_board_limits), read_limits},
    {FDVV_MSG_READ_COIL, 0, sizeof(fdvv_read_coil_reply), read_coil},
    LOOP_COMMANDS
};

const fdvv_command *fdvv_link_command(uint8_t id)
{
    uint8_t i;
    for (i = 0; i < sizeof commands / sizeof commands[0]; i++)
        if (commands[i].id == id)
            return &commands[i];
    return 0;
}
