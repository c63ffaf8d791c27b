/* The requests of the force loop, on boards with a floating-point unit; included by link.c and link_commands.c alone. */
#ifndef FDVV_LINK_LOOP_H
#define FDVV_LINK_LOOP_H

#include "link_state.h"

/* The loop belongs to the connection in which it was closed: another host knows nothing of it. */
static inline void forget_loop(fdvv_link *link)
{
    fdvv_core_close_loop(link->core, 0);
    link->knows_loop = 0;
}

static inline void fit_cell(fdvv_link *link)
{
    static const fdvv_load_cell none;
    link->cell = link->board->cell ? *link->board->cell : none;
}

static inline uint8_t has_cell(const fdvv_link *link)
{
    return link->core->settings.force_gain_q14 && link->cell.stiffness_N_m > 0.0f;
}

static inline uint8_t loop_state(const fdvv_force_loop *loop)
{
    if (loop->fault)
        return FDVV_LOOP_STATE_FAILED;
    return loop->enabled ? FDVV_LOOP_STATE_CLOSED : FDVV_LOOP_STATE_OPEN;
}

static inline uint8_t read_force_loop(fdvv_link *link, const void *request)
{
    static const fdvv_load_cell none;
    fdvv_read_force_loop_reply *reply = (fdvv_read_force_loop_reply *)link->reply;
    const fdvv_load_cell *cell = has_cell(link) ? &link->cell : &none;
    link->knows_loop = ((const fdvv_read_force_loop_request *)request)->hash == FDVV_FORCE_LOOP_PROTOCOL_HASH;
    if (!link->knows_loop)
        return FDVV_REFUSAL_HASH_MISMATCH;
    reply->plate_kg = cell->plate_kg;
    reply->stiffness_N_m = cell->stiffness_N_m;
    reply->damping_N_s_m = cell->damping_N_s_m;
    reply->filter_s = cell->filter_s;
    reply->state = loop_state(&link->core->loop);
    reply->fault = fdvv_core_loop_fault(link->core);
    reply->spare = 0;
    return FDVV_REFUSAL_NONE;
}

/* Why the loop cannot be changed now; in a fault it may be opened, but not closed. */
static inline uint8_t check_change(const fdvv_link *link, uint8_t closes)
{
    uint8_t mode = link->core->supervisor.mode;
    if (!link->knows_loop)
        return FDVV_REFUSAL_WRONG_ORDER;
    return mode == FDVV_MODE_IDLE || (mode == FDVV_MODE_FAULT && !closes) ? FDVV_REFUSAL_NONE
                                                                          : FDVV_REFUSAL_WRONG_MODE;
}

/* Programs are forgotten: what was a table of commands becomes the loop's target, and the other way round. */
static inline uint8_t set_loop(fdvv_link *link, const fdvv_force_loop_gains *gains)
{
    fdvv_link_forget_programs(link);
    fdvv_core_close_loop(link->core, gains);
    return FDVV_REFUSAL_NONE;
}

static inline uint8_t write_load_cell(fdvv_link *link, const void *request)
{
    const fdvv_load_cell *cell = (const fdvv_load_cell *)request;
    uint8_t refusal = check_change(link, 0), invalid = fdvv_load_cell_check(cell);
    if (refusal != FDVV_REFUSAL_NONE)
        return refusal;
    if (invalid) {
        link->detail = (uint16_t)(invalid - 1);
        return FDVV_REFUSAL_BAD_VALUE;
    }
    link->cell = *cell;
    return set_loop(link, 0);
}

/* A loop computed for another tick would be unstable. */
static inline uint8_t has_other_tick(const fdvv_link *link, const fdvv_force_loop_gains *gains)
{
    float off_us = 1e6f * gains->tick_s - (float)link->core->settings.tick_us;
    return off_us < -0.01f || off_us > 0.01f;
}

static inline uint8_t close_force_loop(fdvv_link *link, const void *request)
{
    const fdvv_force_loop_gains *gains = (const fdvv_force_loop_gains *)request;
    uint8_t refusal = check_change(link, 1), invalid = fdvv_force_loop_check(gains);
    if (refusal != FDVV_REFUSAL_NONE)
        return refusal;
    if (!has_cell(link))
        return FDVV_REFUSAL_NO_LOAD_CELL;
    if (invalid || has_other_tick(link, gains)) {
        link->detail = (uint16_t)(invalid ? invalid - 1 : 0);
        return FDVV_REFUSAL_BAD_VALUE;
    }
    return set_loop(link, gains);
}

static inline uint8_t open_force_loop(fdvv_link *link, const void *request)
{
    uint8_t refusal = check_change(link, 0);
    (void)request;
    return refusal != FDVV_REFUSAL_NONE ? refusal : set_loop(link, 0);
}

#define LOOP_COMMANDS                                                                                          \
    {FDVV_MSG_READ_FORCE_LOOP, sizeof(fdvv_read_force_loop_request), sizeof(fdvv_read_force_loop_reply),        \
     read_force_loop},                                                                                          \
    {FDVV_MSG_WRITE_LOAD_CELL, sizeof(fdvv_load_cell), 0, write_load_cell},                                     \
    {FDVV_MSG_CLOSE_FORCE_LOOP, sizeof(fdvv_force_loop_gains), 0, close_force_loop},                            \
    {FDVV_MSG_OPEN_FORCE_LOOP, 0, 0, open_force_loop},

#endif
