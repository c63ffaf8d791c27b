/* The inside of the link: for boards that place it, and for the link's own files. */
#ifndef FDVV_LINK_STATE_H
#define FDVV_LINK_STATE_H

#include "frame.h"
#include "link.h"

/* what is known of the host */
enum { FDVV_HOST_UNKNOWN, FDVV_HOST_OTHER_HASH, FDVV_HOST_KNOWN };

/* how far an upload has come */
enum { FDVV_UPLOAD_NONE, FDVV_UPLOAD_OPEN, FDVV_UPLOAD_READY };

/* what the check in progress is for */
enum { FDVV_CHECK_NONE, FDVV_CHECK_COMMIT, FDVV_CHECK_ACTIVE };

/* fewer than a frame may hold: stuffing must fit between two ticks of a Cortex-M0+ */
#define FDVV_BATCH_RECORDS 4
#define FDVV_REPLY_BYTES 96      /* largest reply: settings */
typedef char fdvv_settings_fit_a_reply[sizeof(fdvv_settings) <= FDVV_REPLY_BYTES ? 1 : -1];
#define FDVV_REPLY_ROOM (FDVV_REPLY_BYTES + 6)
#define FDVV_KEPT_ROOM (FDVV_REPLY_ROOM + 32) /* telemetry leaves it free for a reply and two notices */

/* a program in a bank, or none: size_bytes 0 */
typedef struct {
    uint32_t crc32;
    uint16_t size_bytes;
} fdvv_bank_content;

struct fdvv_link {
    fdvv_core *core;
    const fdvv_board *board;

    fdvv_frame_reader reader;
    fdvv_ring out;
    uint32_t arrived_us;         /* when the waiting frame was whole */
    uint8_t waiting;             /* a whole frame is to be answered */
    uint8_t turn;                /* frames and other work take turns */
    uint8_t host;                /* FDVV_HOST_… */
    uint8_t sequence;            /* of the next unasked frame */

    /* the last request answered, so that its repetition gets the same reply */
    uint32_t last_request[FDVV_FRAME_WORDS]; /* as in the reader, two bytes in */
    uint16_t last_request_bytes;             /* 0: none */
    uint8_t last_reply_id;
    uint8_t last_reply_bytes;
    uint32_t reply[FDVV_REPLY_BYTES / 4];

    /* a request whose answer takes several steps: 0, commit or self-test */
    uint8_t deferred;
    uint8_t deferred_sequence;
    uint8_t testing;             /* the board's self-test runs, whether or not anyone waits for it */

    uint8_t upload;              /* FDVV_UPLOAD_… */
    uint8_t checking;            /* FDVV_CHECK_… */
    uint8_t active;              /* bank that is rendered; uploads go into the other */
    uint16_t received;
    uint16_t detail;             /* of the refusal in the making */
    fdvv_image_check check;
    fdvv_bank_content content[2];

    uint32_t tick;               /* of the last tick */
    uint32_t due_tick;           /* of the next record */
    uint8_t every;               /* 0: no telemetry */
    uint8_t key;                 /* last told */
    uint8_t key_waits;
    uint8_t fault_waits;
    uint16_t faults;             /* last told */
    fdvv_key_request key_notice;
    fdvv_faulted_request fault_notice;
    fdvv_records_request batch;  /* followed by the records */
    fdvv_tick_record records[FDVV_BATCH_RECORDS];

    uint32_t banks[2][FDVV_IMAGE_BYTES / 4];
};
typedef char fdvv_link_stays_small[sizeof(struct fdvv_link) <= 2 * FDVV_IMAGE_BYTES + 1536 ? 1 : -1];

/* link_commands.c: carry out the waiting request; the reply's bytes are in link->reply. */
typedef struct {
    uint8_t id;
    uint8_t request_bytes;
    uint8_t reply_bytes;
    uint8_t (*handle)(fdvv_link *link, const void *request);
} fdvv_command;
const fdvv_command *fdvv_link_command(uint8_t id);
void fdvv_link_poll_selftest(fdvv_link *link);

/* link.c: answer the deferred request, refusal FDVV_REFUSAL_NONE if it was carried out. */
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
