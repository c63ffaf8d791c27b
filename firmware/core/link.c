#include "link_state.h"

#ifdef FDVV_FORCE_LOOP
#include "link_loop.h"
#else
#define forget_loop(link) ((void)0)
#define fit_cell(link) ((void)0)
#endif

static uint8_t equal(const uint8_t *a, const uint8_t *b, uint16_t count)
{
    uint16_t i;
    for (i = 0; i < count; i++)
        if (a[i] != b[i])
            return 0;
    return 1;
}

/* Programs and a running self-test of the board are kept. */
static void reset_connection(fdvv_link *link)
{
    fdvv_frame_reader_reset(&link->reader);
    fdvv_ring_reset(&link->out);
    link->waiting = link->turn = link->sequence = 0;
    link->host = FDVV_HOST_UNKNOWN;
    link->last_request_bytes = 0;
    link->deferred = 0;
    link->every = 0;
    link->batch.count = 0;
    link->key_waits = link->fault_waits = 0;
    forget_loop(link);
}

void fdvv_link_init(fdvv_link *link, fdvv_core *core, const fdvv_board *board)
{
    link->core = core;
    link->board = board;
    link->tick = link->due_tick = 0;
    link->key = 0;
    link->faults = core->supervisor.faults;
    link->testing = 0;
    link->active = 0;
    fdvv_link_forget_programs(link);
    reset_connection(link);
    fit_cell(link);
}

void fdvv_link_reset(fdvv_link *link)
{
    reset_connection(link);
    fdvv_link_forget_upload(link);
}

uint16_t fdvv_link_receive(fdvv_link *link, const uint8_t *bytes, uint16_t count)
{
    uint16_t taken = 0;
    while (taken < count && !link->waiting) {
        uint8_t result;
        taken = (uint16_t)(taken + fdvv_frame_take(&link->reader, bytes + taken, (uint16_t)(count - taken), &result));
        if (result == FDVV_FRAME_BAD)
            link->board->counters->bad_frames++;
        if (result != FDVV_FRAME_WHOLE)
            continue;
        link->board->counters->frames++;
        link->waiting = 1;
        link->arrived_us = link->board->now_us();
        fdvv_supervisor_host_seen(&link->core->supervisor, link->arrived_us);
    }
    return taken;
}

uint16_t fdvv_link_transmit(fdvv_link *link, uint8_t *bytes, uint16_t room)
{
    return fdvv_ring_take(&link->out, bytes, room);
}

/* -- requests ----------------------------------------------------------------------------------------- */

static void send_reply(fdvv_link *link, uint8_t sequence)
{
    fdvv_frame_put(&link->out, link->last_reply_id, sequence, link->reply, link->last_reply_bytes);
}

static void set_reply(fdvv_link *link, uint8_t id, uint8_t refusal, uint8_t bytes)
{
    fdvv_refused_reply *refused = (fdvv_refused_reply *)link->reply;
    link->last_reply_id = (uint8_t)(id + 0x80);
    link->last_reply_bytes = bytes;
    if (refusal == FDVV_REFUSAL_NONE)
        return;
    link->board->counters->refused++;
    link->last_reply_id = FDVV_MSG_REFUSED + 0x80;
    link->last_reply_bytes = sizeof *refused;
    refused->request = id;
    refused->refusal = refusal;
    refused->detail = link->detail;
}

static uint8_t *last_request(fdvv_link *link)
{
    return (uint8_t *)link->last_request + 2;
}

/* Copied word by word, for speed. */
static void store_request(fdvv_link *link)
{
    uint8_t i;
    link->last_request_bytes = (uint16_t)(link->reader.length - 2);
    for (i = 0; 4 * i < link->reader.length + 2; i++)
        link->last_request[i] = link->reader.words[i];
}

void fdvv_link_answer_deferred(fdvv_link *link, uint8_t refusal)
{
    const fdvv_command *command = fdvv_link_command(link->deferred);
    set_reply(link, command->id, refusal, command->reply_bytes);
    /* the stored request is the last one received: replace it by this one, which has no payload */
    last_request(link)[0] = link->deferred;
    last_request(link)[1] = link->deferred_sequence;
    link->last_request_bytes = 2;
    link->deferred = 0;
    send_reply(link, link->deferred_sequence);
}

/* Before a valid HELLO only HELLO and PING are allowed; while a reply is deferred, only these and DISARM. */
static uint8_t check_allowed(const fdvv_link *link, uint8_t id)
{
    if (id == FDVV_MSG_HELLO || id == FDVV_MSG_PING)
        return FDVV_REFUSAL_NONE;
    if (link->host == FDVV_HOST_OTHER_HASH)
        return FDVV_REFUSAL_HASH_MISMATCH;
    if (link->host == FDVV_HOST_UNKNOWN)
        return FDVV_REFUSAL_WRONG_ORDER;
    return link->deferred && id != FDVV_MSG_DISARM ? FDVV_REFUSAL_BUSY : FDVV_REFUSAL_NONE;
}

static uint8_t is_valid_length(const fdvv_command *command, const void *payload, uint16_t count)
{
    if (command->id != FDVV_MSG_DATA)
        return count == command->request_bytes;
    /* a data message carries only as many bytes as it has */
    return count >= 4 && count == 4 + ((const fdvv_data_request *)payload)->count;
}

static uint8_t execute(fdvv_link *link, uint8_t id, const void *payload, uint16_t count)
{
    const fdvv_command *command = fdvv_link_command(id);
    uint8_t refusal;
    link->detail = 0;
    if (!command)
        return FDVV_REFUSAL_UNKNOWN_MESSAGE;
    refusal = check_allowed(link, id);
    if (refusal != FDVV_REFUSAL_NONE)
        return refusal;
    if (!is_valid_length(command, payload, count)) {
        link->detail = count;
        return FDVV_REFUSAL_BAD_LENGTH;
    }
    return command->handle(link, payload);
}

/* A request is repeated if all its bytes but the checksum are the same. */
static uint8_t is_repeated(fdvv_link *link)
{
    return link->last_request_bytes == link->reader.length - 2 &&
           equal(last_request(link), fdvv_frame_bytes(&link->reader), link->last_request_bytes);
}

static void process_frame(fdvv_link *link)
{
    const uint8_t *frame = fdvv_frame_bytes(&link->reader);
    uint16_t count;
    const void *payload = fdvv_frame_payload(&link->reader, &count);
    const fdvv_command *command;
    uint8_t refusal;
    link->waiting = 0;
    if (link->deferred && frame[0] == link->deferred && frame[1] == link->deferred_sequence && !count)
        return; /* repeated while it is being processed; there will be one reply */
    if (is_repeated(link)) {
        send_reply(link, frame[1]);
        return;
    }
    refusal = execute(link, frame[0], payload, count);
    if (refusal == FDVV_REFUSAL_NONE && link->deferred == frame[0]) {
        link->deferred_sequence = frame[1];
        return;
    }
    command = fdvv_link_command(frame[0]);
    set_reply(link, frame[0], refusal, command ? command->reply_bytes : 0);
    store_request(link);
    send_reply(link, frame[1]);
}

static uint8_t do_background_work(fdvv_link *link)
{
    if (link->testing) {
        fdvv_link_poll_selftest(link);
        return 1;
    }
    if (link->checking == FDVV_CHECK_NONE && !link->content[link->active].size_bytes)
        return 0;
    fdvv_link_check(link);
    return 1;
}

void fdvv_link_work(fdvv_link *link)
{
    uint8_t has_room, may_reply;
    if (fdvv_link_send_batch(link))
        return;
    fdvv_link_send_notices(link);
    has_room = fdvv_ring_room(&link->out) >= FDVV_REPLY_ROOM;
    may_reply = link->waiting && has_room;
    link->turn ^= 1;
    if (may_reply && link->turn) {
        process_frame(link);
        return;
    }
    if (link->deferred && !has_room)
        return; /* its last step needs room for the reply */
    if (!do_background_work(link) && may_reply)
        process_frame(link);
}
