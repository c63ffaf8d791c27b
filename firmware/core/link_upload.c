/* Programs are uploaded in order into the inactive bank. Only a checked program can be activated. */
#include "link_state.h"

#define STEP_BYTES 64 /* checked per call, which must fit between two ticks of a Cortex-M0+ */

static uint8_t inactive_bank(const fdvv_link *link)
{
    return (uint8_t)(link->active ^ 1);
}

static uint8_t *bank_bytes(fdvv_link *link, uint8_t bank)
{
    return (uint8_t *)link->banks[bank];
}

void fdvv_link_forget_upload(fdvv_link *link)
{
    link->upload = FDVV_UPLOAD_NONE;
    link->received = 0;
    link->content[inactive_bank(link)].size_bytes = 0;
    if (link->checking == FDVV_CHECK_COMMIT)
        link->checking = FDVV_CHECK_NONE;
}

void fdvv_link_forget_programs(fdvv_link *link)
{
    fdvv_core_activate(link->core, 0);
    link->checking = FDVV_CHECK_NONE;
    link->content[link->active].size_bytes = 0;
    fdvv_link_forget_upload(link);
}

uint8_t fdvv_link_begin(fdvv_link *link, const void *request)
{
    const fdvv_begin_request *begin = (const fdvv_begin_request *)request;
    fdvv_bank_content *content;
    if (begin->size_bytes > FDVV_IMAGE_BYTES) {
        link->detail = FDVV_IMAGE_BYTES;
        return FDVV_REFUSAL_TOO_LARGE;
    }
    if (begin->size_bytes < sizeof(fdvv_image_header) || begin->size_bytes % 4 || begin->spare)
        return FDVV_REFUSAL_BAD_VALUE;
    fdvv_link_forget_upload(link);
    content = &link->content[inactive_bank(link)];
    content->size_bytes = begin->size_bytes;
    content->crc32 = begin->crc32;
    link->upload = FDVV_UPLOAD_OPEN;
    return FDVV_REFUSAL_NONE;
}

/* Offset of the first byte that differs from what was received before, or the end of the data. */
static uint16_t find_difference(fdvv_link *link, const fdvv_data_request *data)
{
    const uint8_t *bank = bank_bytes(link, inactive_bank(link));
    uint16_t i;
    for (i = 0; i < data->count; i++)
        if (bank[data->offset + i] != data->bytes[i])
            break;
    return (uint16_t)(data->offset + i);
}

/* Word by word where both are aligned, as all but the last piece of a program are. */
static void copy(uint8_t *to, const uint8_t *from, uint16_t count)
{
    uint16_t i = 0;
    if (((uintptr_t)to | (uintptr_t)from) % 4 == 0)
        for (; i + 4 <= count; i += 4)
            *(uint32_t *)(void *)(to + i) = *(const uint32_t *)(const void *)(from + i);
    for (; i < count; i++)
        to[i] = from[i];
}

static uint8_t append(fdvv_link *link, const fdvv_data_request *data)
{
    uint8_t *bank = bank_bytes(link, inactive_bank(link)) + link->received;
    if (data->count > link->content[inactive_bank(link)].size_bytes - link->received) {
        link->detail = link->content[inactive_bank(link)].size_bytes;
        return FDVV_REFUSAL_TOO_LARGE;
    }
    copy(bank, data->bytes, data->count);
    link->received = (uint16_t)(link->received + data->count);
    return FDVV_REFUSAL_NONE;
}

static uint8_t accept(fdvv_link *link, const fdvv_data_request *data)
{
    uint32_t end = (uint32_t)data->offset + data->count;
    link->detail = link->received;
    if (link->upload != FDVV_UPLOAD_OPEN)
        return FDVV_REFUSAL_WRONG_ORDER;
    if (data->count < 1 || data->count > FDVV_DATA_BYTES)
        return FDVV_REFUSAL_BAD_VALUE;
    if (data->offset == link->received)
        return append(link, data);
    if (end > link->received)
        return FDVV_REFUSAL_WRONG_ORDER;
    link->detail = find_difference(link, data);
    return link->detail == end ? FDVV_REFUSAL_NONE : FDVV_REFUSAL_BAD_VALUE;
}

uint8_t fdvv_link_data(fdvv_link *link, const void *request)
{
    fdvv_data_reply *reply = (fdvv_data_reply *)link->reply;
    uint8_t refusal = accept(link, (const fdvv_data_request *)request);
    reply->received = link->received;
    reply->spare = 0;
    return refusal;
}

static void begin_check(fdvv_link *link, uint8_t bank, uint8_t purpose)
{
    link->checking = purpose;
    fdvv_image_check_begin(&link->check, bank_bytes(link, bank), link->content[bank].size_bytes,
                           link->content[bank].crc32);
    link->check.travel_limit_um16 = (int32_t)link->board->travel_limit_um16_256 * 256;
}

uint8_t fdvv_link_commit(fdvv_link *link, const void *request)
{
    (void)request;
    link->detail = link->received;
    if (link->upload != FDVV_UPLOAD_OPEN || link->received != link->content[inactive_bank(link)].size_bytes)
        return FDVV_REFUSAL_WRONG_ORDER;
    begin_check(link, inactive_bank(link), FDVV_CHECK_COMMIT);
    link->deferred = FDVV_MSG_COMMIT;
    return FDVV_REFUSAL_NONE;
}

static void end_commit(fdvv_link *link, uint8_t refusal)
{
    link->detail = link->check.detail;
    if (refusal == FDVV_REFUSAL_NONE)
        link->upload = FDVV_UPLOAD_READY;
    else
        fdvv_link_forget_upload(link);
    fdvv_link_answer_deferred(link, refusal);
}

/* The active program is checked all the time, because memory may fail. */
static void end_recheck(fdvv_link *link, uint8_t refusal)
{
    if (refusal == FDVV_REFUSAL_NONE)
        return;
    fdvv_supervisor_fault(&link->core->supervisor, FDVV_FAULT_IMAGE_CORRUPT, link->check.detail, refusal);
    fdvv_core_activate(link->core, 0);
    link->content[link->active].size_bytes = 0;
}

void fdvv_link_check(fdvv_link *link)
{
    uint8_t purpose, refusal;
    if (link->checking == FDVV_CHECK_NONE)
        begin_check(link, link->active, FDVV_CHECK_ACTIVE);
    purpose = link->checking;
    refusal = fdvv_image_check_step(&link->check, &link->core->settings, STEP_BYTES);
    if (refusal == FDVV_REFUSAL_BUSY)
        return;
    link->checking = FDVV_CHECK_NONE;
    if (purpose == FDVV_CHECK_COMMIT)
        end_commit(link, refusal);
    else
        end_recheck(link, refusal);
}

uint8_t fdvv_link_activate(fdvv_link *link, const void *request)
{
    uint8_t mode = link->core->supervisor.mode;
    (void)request;
    if (link->upload != FDVV_UPLOAD_READY)
        return FDVV_REFUSAL_WRONG_ORDER;
    if (mode != FDVV_MODE_IDLE && mode != FDVV_MODE_ARMED && mode != FDVV_MODE_DERATED)
        return FDVV_REFUSAL_WRONG_MODE;
    link->active = inactive_bank(link);
    link->upload = FDVV_UPLOAD_NONE;
    link->checking = FDVV_CHECK_NONE;
    fdvv_core_activate(link->core, bank_bytes(link, link->active));
    if (link->board->load_slots)
        link->board->load_slots(bank_bytes(link, link->active));
    return FDVV_REFUSAL_NONE;
}
