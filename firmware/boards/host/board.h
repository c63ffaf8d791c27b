/* The firmware as a board without hardware: whoever calls it is clock, converter and cable. */
#ifndef FDVV_HOST_BOARD_H
#define FDVV_HOST_BOARD_H

#include "link.h"

#define FDVV_HOST_WORK 8       /* pieces of link work in a tick, as a board has time for */

typedef struct fdvv_host fdvv_host;

/* One board at a time and thread: the firmware's callbacks find the last one that was called. */
fdvv_host *fdvv_host_new(void);
void fdvv_host_free(fdvv_host *host);

/* One tick with a few pieces of link work after it. */
void fdvv_host_tick(fdvv_host *host, const fdvv_inputs *inputs, fdvv_outputs *outputs);

uint16_t fdvv_host_receive(fdvv_host *host, const uint8_t *bytes, uint16_t count);
uint16_t fdvv_host_transmit(fdvv_host *host, uint8_t *bytes, uint16_t room);

/* The program that is rendered, 0 if none. */
const uint8_t *fdvv_host_program(const fdvv_host *host);

/* The cable was pulled. */
void fdvv_host_unplug(fdvv_host *host);

#endif
