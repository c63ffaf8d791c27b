#include "small_frame.h"

/* CRC-16/CCITT-FALSE of one more byte, with shifts that an 8-bit processor does as moves. */
static uint16_t crc_step(uint16_t crc, uint8_t byte)
{
    uint8_t high = (uint8_t)((crc >> 8) ^ byte);
    high ^= high >> 4;
    return (uint16_t)((uint16_t)(crc << 8) ^ (uint16_t)((uint16_t)high << 12) ^ (uint16_t)((uint16_t)high << 5) ^ high);
}

static uint16_t crc_of(const uint8_t *bytes, uint8_t count)
{
    uint16_t crc = 0xffff;
    while (count--)
        crc = crc_step(crc, *bytes++);
    return crc;
}

/* -- in ----------------------------------------------------------------------------------------------- */

void fdvv_small_reader_reset(fdvv_small_reader *reader)
{
    reader->length = reader->left = 0;
    reader->begun = reader->broken = reader->ended = 0;
}

static void store(fdvv_small_reader *reader, uint8_t byte)
{
    if (reader->length == FDVV_SMALL_FRAME_BYTES)
        reader->broken = 1;
    else
        reader->bytes[reader->length++] = byte;
}

static uint8_t finish(fdvv_small_reader *reader)
{
    uint16_t received_crc;
    reader->ended = 1;
    if (!reader->begun)
        return FDVV_SMALL_FRAME_NOTHING; /* consecutive zeros are separators */
    if (reader->broken || reader->left || reader->length < 4)
        return FDVV_SMALL_FRAME_BAD;
    received_crc = (uint16_t)(reader->bytes[reader->length - 2] |
                              (uint16_t)((uint16_t)reader->bytes[reader->length - 1] << 8));
    return received_crc == crc_of(reader->bytes, (uint8_t)(reader->length - 2)) ? FDVV_SMALL_FRAME_WHOLE
                                                                                : FDVV_SMALL_FRAME_BAD;
}

uint8_t fdvv_small_take(fdvv_small_reader *reader, uint8_t byte)
{
    if (reader->ended)
        fdvv_small_reader_reset(reader);
    if (!byte)
        return finish(reader);
    if (reader->left) {
        reader->left--;
        store(reader, byte);
        return FDVV_SMALL_FRAME_NOTHING;
    }
    if (reader->begun)
        store(reader, 0); /* the zero that the code byte replaced */
    reader->begun = 1;
    reader->left = (uint8_t)(byte - 1);
    return FDVV_SMALL_FRAME_NOTHING;
}

/* -- out ---------------------------------------------------------------------------------------------- */

uint8_t fdvv_small_put(const uint8_t *bytes, uint8_t count, uint8_t *stuffed)
{
    uint16_t crc = crc_of(bytes, count);
    uint8_t code_at = 0, to = 1, i;
    for (i = 0; i < count + 2; i++, to++) {
        uint8_t byte = i < count ? bytes[i] : i == count ? (uint8_t)crc : (uint8_t)(crc >> 8);
        stuffed[to] = byte;
        if (byte)
            continue;
        stuffed[code_at] = (uint8_t)(to - code_at);
        code_at = to;
    }
    stuffed[code_at] = (uint8_t)(to - code_at);
    stuffed[to] = 0;
    return (uint8_t)(to + 1);
}
