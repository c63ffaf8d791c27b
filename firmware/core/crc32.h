/* The checksum of programs: zlib's CRC-32. */
#ifndef FDVV_CRC32_H
#define FDVV_CRC32_H

#include <stdint.h>

/* Go on from a checksum (0 at the start) over `count` more bytes. */
uint32_t fdvv_crc32(uint32_t crc, const uint8_t *bytes, uint16_t count);

#endif
