/* Checksum of programs: CRC-32 as in zlib. */
#ifndef FDVV_CRC32_H
#define FDVV_CRC32_H

#include <stdint.h>

/* Continue a checksum (initially 0) with `count` more bytes. */
uint32_t fdvv_crc32(uint32_t crc, const uint8_t *bytes, uint16_t count);

#endif
