/* Unsolicited messages: telemetry, whose records may be dropped (and are counted then), and notices. */
#include "link_state.h"

#define NOTICE_ROOM 20 /* a key notice, stuffed */

static void send(fdvv_link *link, uint8_t id, const void *payload, uint16_t count)
{
    fdvv_frame_put(&link->out, id, link->sequence++, payload, count);
}

/* A frame spans about FDVV_BATCH_RECORDS ticks, regardless of the interval between records. */
static uint8_t is_full(const fdvv_link *link)
{
    return link->batch.count && (uint32_t)link->batch.count * link->every >= FDVV_BATCH_RECORDS;
}

static void send_batch(fdvv_link *link)
{
    uint16_t count = (uint16_t)(sizeof link->batch + link->batch.count * sizeof link->records[0]);
    fdvv_read_counters_reply *counters = link->board->counters;
    if (!link->batch.count)
        return;
    if (fdvv_ring_room(&link->out) < count + 6 + FDVV_KEPT_ROOM) {
        counters->lost_records += link->batch.count;
    } else {
        link->batch.late = counters->late;
        link->batch.lost = counters->lost_records;
        send(link, FDVV_MSG_RECORDS, &link->batch, count);
    }
    link->batch.count = 0;
}

/* Called between ticks, because stuffing takes long; add_record sends only what has not been sent by then. */
uint8_t fdvv_link_send_batch(fdvv_link *link)
{
    if (!is_full(link))
        return 0;
    send_batch(link);
    return 1;
}

void fdvv_link_set_telemetry(fdvv_link *link, uint8_t every)
{
    send_batch(link);
    link->every = every;
    link->due_tick = link->tick + 1;
}

static void add_record(fdvv_link *link, const fdvv_inputs *inputs, const fdvv_outputs *outputs)
{
    fdvv_records_request *batch = &link->batch;
    /* the records of a frame are equidistant: after a missed tick a new frame begins */
    if (is_full(link) || batch->first_tick + (uint32_t)batch->count * link->every != link->tick)
        send_batch(link);
    if (!batch->count) {
        batch->first_tick = link->tick;
        batch->first_us = inputs->time_us;
        batch->every = link->every;
    }
    link->records[batch->count++] = outputs->record;
    batch->mode = outputs->mode;
    batch->key = outputs->key;
    link->due_tick = link->tick + link->every;
}

static void note_key(fdvv_link *link, const fdvv_inputs *inputs, const fdvv_outputs *outputs)
{
    if (outputs->key == link->key)
        return;
    link->key = outputs->key;
    link->key_notice.key = outputs->key;
    link->key_notice.state = outputs->record.state;
    link->key_notice.spare = 0;
    link->key_notice.tick = link->tick;
    link->key_notice.time_us = inputs->time_us;
    link->key_waits = 1; /* replaces an older one that was not sent yet */
}

static void note_fault(fdvv_link *link)
{
    const fdvv_supervisor *supervisor = &link->core->supervisor;
    if (supervisor->faults == link->faults)
        return;
    link->faults = supervisor->faults;
    link->fault_notice.fault = supervisor->fault;
    link->fault_notice.mode = supervisor->evidence.mode;
    link->fault_notice.spare = 0;
    link->fault_notice.time_us = supervisor->evidence.time_us;
    link->fault_waits = 1;
}

void fdvv_link_send_notices(fdvv_link *link)
{
    if (link->host != FDVV_HOST_KNOWN)
        return;
    if (link->fault_waits && fdvv_ring_room(&link->out) >= NOTICE_ROOM) {
        link->fault_waits = 0;
        send(link, FDVV_MSG_FAULTED, &link->fault_notice, sizeof link->fault_notice);
    }
    if (link->key_waits && fdvv_ring_room(&link->out) >= NOTICE_ROOM) {
        link->key_waits = 0;
        send(link, FDVV_MSG_KEY, &link->key_notice, sizeof link->key_notice);
    }
}

void fdvv_link_tick(fdvv_link *link, const fdvv_inputs *inputs, const fdvv_outputs *outputs)
{
    link->tick += inputs->elapsed_ticks;
    note_fault(link);
    note_key(link, inputs, outputs);
    if (link->every && (int32_t)(link->tick - link->due_tick) >= 0)
        add_record(link, inputs, outputs);
}
