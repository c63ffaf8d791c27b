/* The firmware as a program, in lockstep with a simulated plant.
 *
 *   fdvv-host PLANT_IN PLANT_OUT [TTY]
 *
 * PLANT_IN and PLANT_OUT are file descriptors. The plant first sends the limits of the board: a program on a computer
 * is a build for the rig that it is connected to. For every tick it sends a `tick_request` and receives a
 * `tick_reply`; there is no other clock. The link to the host is TTY, or standard input and output. Both records count
 * the bytes sent over the link, so that a tick sees all that was written before it, regardless of buffering. The
 * program ends when the plant's pipe is closed. */
#define _XOPEN_SOURCE 600

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include "board.h"

typedef struct {
    fdvv_inputs inputs;
    uint32_t written;   /* bytes that the host has written to the link since it was connected */
    uint32_t plugged;   /* 0: disconnected; unread bytes are lost */
} tick_request;

typedef struct {
    fdvv_outputs outputs;
    uint32_t sent;      /* bytes that the device has written to the link since it was connected */
} tick_reply;

typedef char tick_request_has_32_bytes[sizeof(tick_request) == 32 ? 1 : -1];
typedef char tick_reply_has_24_bytes[sizeof(tick_reply) == 24 ? 1 : -1];

typedef struct {
    int in, out;
    uint8_t plugged;
    uint32_t received, sent;
    uint8_t waiting[4096]; /* received, but not yet accepted by the firmware */
    uint16_t first, count;
} connection;

static int read_whole(int file, void *to, size_t count)
{
    size_t have = 0;
    while (have < count) {
        ssize_t got = read(file, (char *)to + have, count - have);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return 0;
        have += (size_t)got;
    }
    return 1;
}

static int write_whole(int file, const void *from, size_t count)
{
    size_t done = 0;
    while (done < count) {
        ssize_t put = write(file, (const char *)from + done, count - done);
        if (put < 0 && errno == EINTR)
            continue;
        if (put <= 0)
            return 0;
        done += (size_t)put;
    }
    return 1;
}

static void disconnect(fdvv_host *host, connection *link)
{
    fdvv_host_unplug(host);
    link->plugged = 0;
    link->received = link->sent = 0;
    link->first = link->count = 0;
}

/* Pass on as many of the received bytes as the firmware accepts. */
static void forward(fdvv_host *host, connection *link)
{
    uint16_t taken = fdvv_host_receive(host, link->waiting + link->first, link->count);
    link->first = (uint16_t)(link->first + taken);
    link->count = (uint16_t)(link->count - taken);
}

/* Receive everything that the host has written; returns 0 if the other end was closed. */
static int receive(fdvv_host *host, connection *link, uint32_t written)
{
    forward(host, link);
    while (link->received != written && !link->count) {
        ssize_t got = read(link->in, link->waiting, sizeof link->waiting);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return 0;
        link->received += (uint32_t)got;
        link->first = 0;
        link->count = (uint16_t)got;
        forward(host, link);
    }
    return 1;
}

/* Send the output of the firmware; returns 0 if the other end was closed. */
static int transmit(fdvv_host *host, connection *link)
{
    uint8_t bytes[256];
    uint16_t count;
    while ((count = fdvv_host_transmit(host, bytes, sizeof bytes)) != 0) {
        if (!write_whole(link->out, bytes, count))
            return 0;
        link->sent += count;
    }
    return 1;
}

static void tick(fdvv_host *host, connection *link, const tick_request *request, tick_reply *reply)
{
    if (link->plugged && !request->plugged)
        disconnect(host, link);
    link->plugged = request->plugged != 0;
    if (link->plugged && !receive(host, link, request->written))
        disconnect(host, link);
    fdvv_host_tick(host, &request->inputs, &reply->outputs);
    if (link->plugged && !transmit(host, link))
        disconnect(host, link);
    reply->sent = link->sent;
}

/* Open a terminal in raw mode. */
static int open_raw(const char *path)
{
    struct termios mode;
    int file = open(path, O_RDWR | O_NOCTTY);
    if (file < 0 || tcgetattr(file, &mode))
        return -1;
    mode.c_iflag = 0;
    mode.c_oflag = 0;
    mode.c_lflag = 0;
    mode.c_cflag = (mode.c_cflag & ~(tcflag_t)(CSIZE | PARENB)) | CS8 | CREAD | CLOCAL;
    mode.c_cc[VMIN] = 1;
    mode.c_cc[VTIME] = 0;
    return tcsetattr(file, TCSANOW, &mode) ? -1 : file;
}

int main(int count, char **arguments)
{
    static connection link;
    fdvv_board_limits limits;
    uint32_t travel_um16;
    tick_request request;
    tick_reply reply = {{0, 0, 0, 0, 0, 0, {0, 0, 0, 0, 0, 0}}, 0};
    fdvv_host *host;
    int in, out;
    if (count < 3 || count > 4) {
        (void)fprintf(stderr, "usage: fdvv-host PLANT_IN PLANT_OUT [TTY]\n");
        return 2;
    }
    in = atoi(arguments[1]);
    out = atoi(arguments[2]);
    link.in = STDIN_FILENO;
    link.out = STDOUT_FILENO;
    if (count == 4 && (link.in = link.out = open_raw(arguments[3])) < 0) {
        perror(arguments[3]);
        return 1;
    }
    if (!read_whole(in, &limits, sizeof limits) || !read_whole(in, &travel_um16, sizeof travel_um16) ||
        !(host = fdvv_host_new(&limits, travel_um16)))
        return 1;
    while (read_whole(in, &request, sizeof request)) {
        tick(host, &link, &request, &reply);
        if (!write_whole(out, &reply, sizeof reply))
            break;
    }
    fdvv_host_free(host);
    return 0;
}
