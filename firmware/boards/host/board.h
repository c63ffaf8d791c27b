/* The firmware as a board without hardware: the caller provides clock, readings and connection. */
#ifndef FDVV_HOST_BOARD_H
#define FDVV_HOST_BOARD_H

#include "link.h"

#define FDVV_HOST_WORK 8       /* calls of fdvv_link_work per tick, as many as a real board has time for */

typedef struct fdvv_host fdvv_host;

/* The limits are copied, and settings start as tight. Boards must not run concurrently: the firmware's callbacks refer to
 * the last one that was called. */
fdvv_host *fdvv_host_new(const fdvv_board_limits *limits, uint32_t travel_um16);
void fdvv_host_free(fdvv_host *host);

/* Run one tick and the link work after it. */
void fdvv_host_tick(fdvv_host *host, const fdvv_inputs *inputs, fdvv_outputs *outputs);

uint16_t fdvv_host_receive(fdvv_host *host, const uint8_t *bytes, uint16_t count);
uint16_t fdvv_host_transmit(fdvv_host *host, uint8_t *bytes, uint16_t room);

/* The active program, or 0. */
const uint8_t *fdvv_host_program(const fdvv_host *host);

/* The speed of the next press, which its host announced. */
uint16_t fdvv_host_announced_mm_s16(const fdvv_host *host);

/* The connection was lost. */
void fdvv_host_unplug(fdvv_host *host);

#endif
