#include "frame.h"

static const uint16_t crc_table[256] = {
    0x0000, 0x1021, 0x2042, 0x3063, 0x4084, 0x50a5, 0x60c6, 0x70e7, 0x8108, 0x9129, 0xa14a, 0xb16b,
    0xc18c, 0xd1ad, 0xe1ce, 0xf1ef, 0x1231, 0x0210, 0x3273, 0x2252, 0x52b5, 0x4294, 0x72f7, 0x62d6,
    0x9339, 0x8318, 0xb37b, 0xa35a, 0xd3bd, 0xc39c, 0xf3ff, 0xe3de, 0x2462, 0x3443, 0x0420, 0x1401,
    0x64e6, 0x74c7, 0x44a4, 0x5485, 0xa56a, 0xb54b, 0x8528, 0x9509, 0xe5ee, 0xf5cf, 0xc5ac, 0xd58d,
    0x3653, 0x2672, 0x1611, 0x0630, 0x76d7, 0x66f6, 0x5695, 0x46b4, 0xb75b, 0xa77a, 0x9719, 0x8738,
    0xf7df, 0xe7fe, 0xd79d, 0xc7bc, 0x48c4, 0x58e5, 0x6886, 0x78a7, 0x0840, 0x1861, 0x2802, 0x3823,
    0xc9cc, 0xd9ed, 0xe98e, 0xf9af, 0x8948, 0x9969, 0xa90a, 0xb92b, 0x5af5, 0x4ad4, 0x7ab7, 0x6a96,
    0x1a71, 0x0a50, 0x3a33, 0x2a12, 0xdbfd, 0xcbdc, 0xfbbf, 0xeb9e, 0x9b79, 0x8b58, 0xbb3b, 0xab1a,
    0x6ca6, 0x7c87, 0x4ce4, 0x5cc5, 0x2c22, 0x3c03, 0x0c60, 0x1c41, 0xedae, 0xfd8f, 0xcdec, 0xddcd,
    0xad2a, 0xbd0b, 0x8d68, 0x9d49, 0x7e97, 0x6eb6, 0x5ed5, 0x4ef4, 0x3e13, 0x2e32, 0x1e51, 0x0e70,
    0xff9f, 0xefbe, 0xdfdd, 0xcffc, 0xbf1b, 0xaf3a, 0x9f59, 0x8f78, 0x9188, 0x81a9, 0xb1ca, 0xa1eb,
    0xd10c, 0xc12d, 0xf14e, 0xe16f, 0x1080, 0x00a1, 0x30c2, 0x20e3, 0x5004, 0x4025, 0x7046, 0x6067,
    0x83b9, 0x9398, 0xa3fb, 0xb3da, 0xc33d, 0xd31c, 0xe37f, 0xf35e, 0x02b1, 0x1290, 0x22f3, 0x32d2,
    0x4235, 0x5214, 0x6277, 0x7256, 0xb5ea, 0xa5cb, 0x95a8, 0x8589, 0xf56e, 0xe54f, 0xd52c, 0xc50d,
    0x34e2, 0x24c3, 0x14a0, 0x0481, 0x7466, 0x6447, 0x5424, 0x4405, 0xa7db, 0xb7fa, 0x8799, 0x97b8,
    0xe75f, 0xf77e, 0xc71d, 0xd73c, 0x26d3, 0x36f2, 0x0691, 0x16b0, 0x6657, 0x7676, 0x4615, 0x5634,
    0xd94c, 0xc96d, 0xf90e, 0xe92f, 0x99c8, 0x89e9, 0xb98a, 0xa9ab, 0x5844, 0x4865, 0x7806, 0x6827,
    0x18c0, 0x08e1, 0x3882, 0x28a3, 0xcb7d, 0xdb5c, 0xeb3f, 0xfb1e, 0x8bf9, 0x9bd8, 0xabbb, 0xbb9a,
    0x4a75, 0x5a54, 0x6a37, 0x7a16, 0x0af1, 0x1ad0, 0x2ab3, 0x3a92, 0xfd2e, 0xed0f, 0xdd6c, 0xcd4d,
    0xbdaa, 0xad8b, 0x9de8, 0x8dc9, 0x7c26, 0x6c07, 0x5c64, 0x4c45, 0x3ca2, 0x2c83, 0x1ce0, 0x0cc1,
    0xef1f, 0xff3e, 0xcf5d, 0xdf7c, 0xaf9b, 0xbfba, 0x8fd9, 0x9ff8, 0x6e17, 0x7e36, 0x4e55, 0x5e74,
    0x2e93, 0x3eb2, 0x0ed1, 0x1ef0,
};

/* -- in ----------------------------------------------------------------------------------------------- */

void fdvv_frame_reader_reset(fdvv_frame_reader *reader)
{
    reader->length = 0;
    reader->left = 0;
    reader->begun = 0;
    reader->broken = 0;
    reader->ended = 0;
}

const uint8_t *fdvv_frame_bytes(const fdvv_frame_reader *reader)
{
    return (const uint8_t *)reader->words + 2;
}

static uint16_t crc_of(const uint8_t *bytes, uint16_t count)
{
    const uint8_t *end = bytes + count;
    uint32_t crc = 0xffff;
    while (bytes != end)
        crc = (crc << 8 & 0xffff) ^ crc_table[crc >> 8 ^ *bytes++];
    return (uint16_t)crc;
}

/* Store the bytes of a block up to a zero, which ends the frame too early; returns their number. */
static uint16_t store(fdvv_frame_reader *reader, const uint8_t *bytes, uint16_t count)
{
    uint8_t *to = (uint8_t *)reader->words + 2 + reader->length;
    uint16_t i;
    if (count > FDVV_FRAME_BYTES - reader->length) {
        reader->broken = 1;
        to = (uint8_t *)reader->words; /* any valid address: it will not be read */
        count = 1;
    }
    for (i = 0; i < count && bytes[i]; i++)
        to[i] = bytes[i];
    reader->left = (uint8_t)(reader->left - i);
    if (!reader->broken)
        reader->length = (uint16_t)(reader->length + i);
    return i;
}

/* A code byte: the previous block ended with a zero. Blocks of 254 bytes without one do not fit into a frame. */
static void open_block(fdvv_frame_reader *reader, uint8_t code)
{
    if (reader->begun && !reader->broken) {
        if (reader->length < FDVV_FRAME_BYTES)
            ((uint8_t *)reader->words)[2 + reader->length++] = 0;
        else
            reader->broken = 1;
    }
    reader->begun = 1;
    reader->left = (uint8_t)(code - 1);
}

static uint8_t finish(fdvv_frame_reader *reader)
{
    const uint8_t *bytes = fdvv_frame_bytes(reader);
    uint16_t received_crc;
    reader->ended = 1;
    if (!reader->begun)
        return FDVV_FRAME_NOTHING; /* consecutive zeros are separators */
    if (reader->broken || reader->left || reader->length < 4)
        return FDVV_FRAME_BAD;
    received_crc = (uint16_t)(bytes[reader->length - 2] | (uint16_t)(bytes[reader->length - 1] << 8));
    return received_crc == crc_of(bytes, (uint16_t)(reader->length - 2)) ? FDVV_FRAME_WHOLE : FDVV_FRAME_BAD;
}

static uint16_t take_block(fdvv_frame_reader *reader, const uint8_t *bytes, uint16_t count, uint8_t *result)
{
    if (reader->ended)
        fdvv_frame_reader_reset(reader);
    if (bytes[0] == 0) {
        *result = finish(reader);
        return 1;
    }
    if (reader->left)
        return store(reader, bytes, count < reader->left ? count : reader->left);
    open_block(reader, bytes[0]);
    return 1;
}

uint16_t fdvv_frame_take(fdvv_frame_reader *reader, const uint8_t *bytes, uint16_t count, uint8_t *result)
{
    uint16_t taken = 0;
    *result = FDVV_FRAME_NOTHING;
    while (taken < count && *result == FDVV_FRAME_NOTHING)
        taken = (uint16_t)(taken + take_block(reader, bytes + taken, (uint16_t)(count - taken), result));
    return taken;
}

const void *fdvv_frame_payload(const fdvv_frame_reader *reader, uint16_t *count)
{
    *count = (uint16_t)(reader->length - 4);
    return reader->words + 1;
}

/* -- out ---------------------------------------------------------------------------------------------- */

void fdvv_ring_reset(fdvv_ring *ring)
{
    ring->head = ring->tail = 0;
}

uint16_t fdvv_ring_room(const fdvv_ring *ring)
{
    return (uint16_t)(FDVV_RING_BYTES - (uint16_t)(ring->head - ring->tail));
}

uint16_t fdvv_ring_take(fdvv_ring *ring, uint8_t *bytes, uint16_t room)
{
    uint16_t count = 0;
    while (count < room && ring->tail != ring->head)
        bytes[count++] = ring->bytes[ring->tail++ % FDVV_RING_BYTES];
    return count;
}

/* a frame being encoded */
typedef struct {
    uint8_t *ring;
    uint32_t head;    /* where the next byte goes */
    uint32_t code_at; /* position of the last zero: replaced by the distance to the next one */
    uint32_t crc;
} stuffing;

/* One pass with all variables in registers, because it must fit between two ticks of a Cortex-M0+. */
static void stuff(stuffing *open, const uint8_t *bytes, uint16_t count)
{
    uint8_t *ring = open->ring;
    uint32_t head = open->head, code_at = open->code_at, crc = open->crc;
    const uint8_t *end = bytes + count;
    for (; bytes != end; head++) {
        uint32_t byte = *bytes++;
        crc = (crc << 8 & 0xffff) ^ crc_table[crc >> 8 ^ byte];
        if (byte) {
            ring[head % FDVV_RING_BYTES] = (uint8_t)byte;
        } else {
            ring[code_at % FDVV_RING_BYTES] = (uint8_t)(head - code_at);
            code_at = head;
        }
    }
    open->head = head;
    open->code_at = code_at;
    open->crc = crc;
}

void fdvv_frame_put(fdvv_ring *ring, uint8_t id, uint8_t sequence, const void *payload, uint16_t count)
{
    stuffing open;
    uint8_t ends[2];
    open.ring = ring->bytes;
    open.code_at = ring->head;
    open.head = open.code_at + 1;
    open.crc = 0xffff;
    ends[0] = id;
    ends[1] = sequence;
    stuff(&open, ends, 2);
    stuff(&open, (const uint8_t *)payload, count);
    ends[0] = (uint8_t)open.crc;
    ends[1] = (uint8_t)(open.crc >> 8);
    stuff(&open, ends, 2);
    ring->bytes[open.code_at % FDVV_RING_BYTES] = (uint8_t)(open.head - open.code_at);
    ring->bytes[open.head % FDVV_RING_BYTES] = 0;
    ring->head = (uint16_t)(open.head + 1);
}
