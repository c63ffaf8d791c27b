/* The firmware as a program, in lockstep with a plant.
 *
 *   fdvv-host PLANT_IN PLANT_OUT [TTY]
 *
 * PLANT_IN and PLANT_OUT are file descriptors. For every tick the plant sends a `question` and gets an
 * `answer`; time passes only so. The host's link is TTY, else standard input and output. Both records count
 * the bytes that went over the link, so that a tick sees what was written before it, whatever the system
 * does with its buffers. Ends when the plant's pipe is closed. */
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
    uint32_t written;   /* bytes that the host has put on the link since the cable was plugged in */
    uint32_t plugged;   /* 0: the cable is out, and what was on it is lost */
} question;

typedef struct {
    fdvv_outputs outputs;
    uint32_t sent;      /* bytes that the device has put on the link since the cable was plugged in */
} answer;

typedef char question_has_28_bytes[sizeof(question) == 28 ? 1 : -1];
typedef char answer_has_24_bytes[sizeof(answer) == 24 ? 1 : -1];

typedef struct {
    int in, out;
    uint8_t plugged;
    uint32_t heard, sent;
    uint8_t waiting[4096]; /* read, but not yet taken by the firmware */
    uint16_t first, count;
} cable;

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

static void pull(fdvv_host *host, cable *link)
{
    fdvv_host_unplug(host);
    link->plugged = 0;
    link->heard = link->sent = 0;
    link->first = link->count = 0;
}

/* Take what the firmware has room for out of what was read. */
static void hand_over(fdvv_host *host, cable *link)
{
    uint16_t taken = fdvv_host_receive(host, link->waiting + link->first, link->count);
    link->first = (uint16_t)(link->first + taken);
    link->count = (uint16_t)(link->count - taken);
}

/* Read until all that the host has written is here; give 0 if the other end is gone. */
static int hear(fdvv_host *host, cable *link, uint32_t written)
{
    hand_over(host, link);
    while (link->heard != written && !link->count) {
        ssize_t got = read(link->in, link->waiting, sizeof link->waiting);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return 0;
        link->heard += (uint32_t)got;
        link->first = 0;
        link->count = (uint16_t)got;
        hand_over(host, link);
    }
    return 1;
}

/* Write what the firmware has to say; give 0 if the other end is gone. */
static int speak(fdvv_host *host, cable *link)
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

static void tick(fdvv_host *host, cable *link, const question *asked, answer *given)
{
    if (link->plugged && !asked->plugged)
        pull(host, link);
    link->plugged = asked->plugged != 0;
    if (link->plugged && !hear(host, link, asked->written))
        pull(host, link);
    fdvv_host_tick(host, &asked->inputs, &given->outputs);
    if (link->plugged && !speak(host, link))
        pull(host, link);
    given->sent = link->sent;
}

/* A terminal that changes no byte. */
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

int main(int count, char **words)
{
    static cable link;
    question asked;
    answer given = {{0, 0, 0, 0, 0, 0, {0, 0, 0, 0, 0, 0}}, 0};
    fdvv_host *host = fdvv_host_new();
    int in, out;
    if (!host || count < 3 || count > 4) {
        (void)fprintf(stderr, "usage: fdvv-host PLANT_IN PLANT_OUT [TTY]\n");
        return 2;
    }
    in = atoi(words[1]);
    out = atoi(words[2]);
    link.in = STDIN_FILENO;
    link.out = STDOUT_FILENO;
    if (count == 4 && (link.in = link.out = open_raw(words[3])) < 0) {
        perror(words[3]);
        return 1;
    }
    while (read_whole(in, &asked, sizeof asked)) {
        tick(host, &link, &asked, &given);
        if (!write_whole(out, &given, sizeof given))
            break;
    }
    fdvv_host_free(host);
    return 0;
}
