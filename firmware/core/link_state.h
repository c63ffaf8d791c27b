/* The state of the link and the functions that its source files share; boards need it to allocate the link. */
#ifndef FDVV_LINK_STATE_H
#define FDVV_LINK_STATE_H

#include "frame.h"
#include "link.h"

/* what is known of the host */
enum { FDVV_HOST_UNKNOWN, FDVV_HOST_OTHER_HASH, FDVV_HOST_KNOWN };

/* state of an upload */
enum { FDVV_UPLOAD_NONE, FDVV_UPLOAD_OPEN, FDVV_UPLOAD_READY };

/* purpose of the check in progress */
enum { FDVV_CHECK_NONE, FDVV_CHECK_COMMIT, FDVV_CHECK_ACTIVE };

/* fewer than fit into a frame, because stuffing must fit between two ticks of a Cortex-M0+ */
#define FDVV_BATCH_RECORDS 4
#define FDVV_REPLY_BYTES 96      /* largest reply: settings */
typedef char fdvv_settings_fit_a_reply[sizeof(fdvv_settings) <= FDVV_REPLY_BYTES ? 1 : -1];
#define FDVV_REPLY_ROOM (FDVV_REPLY_BYTES + 6)
#define FDVV_KEPT_ROOM (FDVV_REPLY_ROOM + 32) /* telemetry keeps this free for a reply and two notices */

/* program in a bank; size_bytes is 0 if there is none */
typedef struct {
    uint32_t crc32;
    uint16_t size_bytes;
} fdvv_bank_content;

struct fdvv_link {
    fdvv_core *core;
    const fdvv_board *board;

    fdvv_frame_reader reader;
    fdvv_ring out;
    uint32_t arrived_us;         /* when the waiting frame was complete */
    uint8_t waiting;             /* a complete frame needs a reply */
    uint8_t turn;                /* alternates between frames and background work */
    uint8_t host;                /* FDVV_HOST_… */
    uint8_t sequence;            /* of the next unsolicited frame */

    /* the last request and its reply, so that a repeated request gets the same reply */
    uint32_t last_request[FDVV_FRAME_WORDS]; /* from the third byte on, as in the reader */
    uint16_t last_request_bytes;             /* 0: none */
    uint8_t last_reply_id;
    uint8_t last_reply_bytes;
    uint32_t reply[FDVV_REPLY_BYTES / 4];

    /* id of a request whose reply takes several steps: commit or self-test; 0: none */
    uint8_t deferred;
    uint8_t deferred_sequence;
    uint8_t testing;             /* the board's self-test is running, even if the host has disconnected */

    uint8_t upload;              /* FDVV_UPLOAD_… */
    uint8_t checking;            /* FDVV_CHECK_… */
    uint8_t active;              /* bank of the rendered program; uploads go into the other */
    uint16_t received;
    uint16_t detail;             /* of the next refusal */
    fdvv_image_check check;
    fdvv_bank_content content[2];

    uint32_t tick;               /* of the last tick */
    uint32_t due_tick;           /* of the next record */
    uint8_t every;               /* ticks per record; 0: no telemetry */
    uint8_t key;                 /* last state noticed */
    uint8_t key_waits;           /* the notice is to be sent */
    uint8_t fault_waits;
    uint16_t faults;             /* last count noticed */
    fdvv_key_request key_notice;
    fdvv_faulted_request fault_notice;
    fdvv_records_request batch;  /* followed by the records */
    fdvv_tick_record records[FDVV_BATCH_RECORDS];

#ifdef FDVV_FORCE_LOOP
    fdvv_load_cell cell;         /* all 0: none */
    uint8_t knows_loop;          /* the host has the same definition of the loop */
#endif

    uint32_t banks[2][FDVV_IMAGE_BYTES / 4];
};
typedef char fdvv_link_stays_small[sizeof(struct fdvv_link) <= 2 * FDVV_IMAGE_BYTES + 1536 ? 1 : -1];

/* link_commands.c: handle returns a refusal; it writes the payload of the reply to link->reply. */
typedef struct {
    uint8_t id;
    uint8_t request_bytes;
    uint8_t reply_bytes;
    uint8_t (*handle)(fdvv_link *link, const void *request);
} fdvv_command;
const fdvv_command *fdvv_link_command(uint8_t id);
void fdvv_link_poll_selftest(fdvv_link *link);

/* link.c: send the reply to the deferred request, or its refusal. */
void fdvv_link_answer_deferred(fdvv_link *link, uint8_t refusal);

/* link_upload.c */
uint8_t fdvv_link_begin(fdvv_link *link, const void *request);
uint8_t fdvv_link_data(fdvv_link *link, const void *request);
uint8_t fdvv_link_commit(fdvv_link *link, const void *request);
uint8_t fdvv_link_activate(fdvv_link *link, const void *request);
void fdvv_link_forget_upload(fdvv_link *link);
void fdvv_link_forget_programs(fdvv_link *link);
void fdvv_link_check(fdvv_link *link);

/* link_telemetry.c */
void fdvv_link_set_telemetry(fdvv_link *link, uint8_t every);
void fdvv_link_send_notices(fdvv_link *link);
uint8_t fdvv_link_send_batch(fdvv_link *link);

#endif
