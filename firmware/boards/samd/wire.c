/* Non-blocking I2C master: each step transfers one byte, or makes one edge of the bus recovery. */
#include "board.h"
#include "i2c.h"
#include "pins.h"

enum {
    BAUD_400_KHZ = 48,        /* 48 MHz / (10 + 2 * 48 + 14), the 14 for 300 ns of rise */
    TIMEOUT_US = 2000,        /* a message takes at most 750 us */
    EDGE_US = 5,
    RECOVERY_EDGES = 18       /* nine clock pulses release any slave */
};

typedef enum { BUS_IDLE, BUS_SENDING, BUS_RECOVERING } bus_state;

typedef struct {
    uint8_t address, count;
    uint8_t bytes[BOARD_MESSAGE_BYTES];
} message;

static struct {
    message queue[BOARD_MESSAGES];
    uint32_t since_us;
    uint32_t errors;
    bus_state state;
    uint8_t first, waiting; /* in the queue */
    uint8_t at;             /* next byte of the first message */
    uint8_t edge;           /* of the recovery */
    uint8_t answers;        /* the last message was acknowledged */
} bus;

static void sync_bus(void)
{
    while (I2C_SYNCBUSY) {
    }
}

static void open_bus(void)
{
    I2C_CTRLA = I2C_CTRLA_SWRST;
    sync_bus();
    I2C_CTRLA = I2C_CTRLA_MASTER | I2C_CTRLA_SDAHOLD_300_NS;
    I2C_BAUD = BAUD_400_KHZ;
    I2C_CTRLA = I2C_CTRLA_MASTER | I2C_CTRLA_SDAHOLD_300_NS | I2C_CTRLA_ENABLE;
    sync_bus();
    I2C_STATUS = I2C_STATUS_IDLE;
    sync_bus();
    board_pin(PIN_SDA, PORT_MUX_C);
    board_pin(PIN_SCL, PORT_MUX_C);
    bus.state = BUS_IDLE;
}

void board_wire_start(void)
{
    I2C_POWER();
    board_clock(I2C_GCLK_ID, I2C_GENERATOR);
    PORT_OUTCLR = PIN_BIT(PIN_SDA) | PIN_BIT(PIN_SCL); /* open drain: low as output, released as input */
    bus.answers = 1;
    open_bus();
}

uint8_t board_wire_send(uint8_t address, const uint8_t *bytes, uint8_t count)
{
    if (bus.waiting == BOARD_MESSAGES || count > BOARD_MESSAGE_BYTES) return 0;
    message *slot = &bus.queue[(bus.first + bus.waiting) % BOARD_MESSAGES];
    slot->address = address;
    slot->count = count;
    for (unsigned i = 0; i < count; i++) slot->bytes[i] = bytes[i];
    bus.waiting++;
    return 1;
}

static void drop_first(void)
{
    bus.first = (uint8_t)((bus.first + 1u) % BOARD_MESSAGES);
    bus.waiting--;
}

/* A failed message is not repeated, because the vibration would be too late. */
static void recover(uint32_t now_us)
{
    bus.errors++;
    bus.answers = 0;
    drop_first();
    PORT_PINCFG(PIN_SDA) = PORT_PINCFG_INEN;
    PORT_PINCFG(PIN_SCL) = PORT_PINCFG_INEN;
    bus.edge = 0;
    bus.since_us = now_us;
    bus.state = BUS_RECOVERING;
}

static void step_recovery(uint32_t now_us)
{
    if (now_us - bus.since_us < EDGE_US) return;
    bus.since_us = now_us;
    if (bus.edge == RECOVERY_EDGES) {
        PORT_DIRCLR = PIN_BIT(PIN_SDA) | PIN_BIT(PIN_SCL); /* SDA rises while SCL is high: STOP */
        open_bus();
        return;
    }
    if (bus.edge & 1u) {
        PORT_DIRCLR = PIN_BIT(PIN_SCL);
    } else {
        PORT_DIRSET = PIN_BIT(PIN_SCL);
        if (bus.edge == RECOVERY_EDGES - 2) PORT_DIRSET = PIN_BIT(PIN_SDA);
    }
    bus.edge++;
}

static void stop(void)
{
    I2C_CTRLB = I2C_CTRLB_CMD_STOP;
    sync_bus();
    bus.state = BUS_IDLE;
}

static void step_sending(uint32_t now_us)
{
    uint16_t status = I2C_STATUS;
    if (now_us - bus.since_us > TIMEOUT_US || (status & (I2C_STATUS_BUSERR | I2C_STATUS_ARBLOST))) {
        recover(now_us);
    } else if (I2C_INTFLAG & I2C_INTFLAG_MB) {
        if (status & I2C_STATUS_RXNACK) {
            bus.errors++;
            bus.answers = 0;
            stop();
            drop_first();
        } else if (bus.at < bus.queue[bus.first].count) {
            I2C_DATA = bus.queue[bus.first].bytes[bus.at++];
        } else {
            bus.answers = 1;
            stop();
            drop_first();
        }
    }
}

void board_wire_step(uint32_t now_us)
{
    if (bus.state == BUS_SENDING) {
        step_sending(now_us);
    } else if (bus.state == BUS_RECOVERING) {
        step_recovery(now_us);
    } else if (bus.waiting) {
        bus.at = 0;
        bus.since_us = now_us;
        bus.state = BUS_SENDING;
        I2C_ADDR = (uint32_t)bus.queue[bus.first].address << 1;
    }
}

uint8_t board_wire_room(void)
{
    return (uint8_t)(BOARD_MESSAGES - bus.waiting);
}

uint8_t board_wire_answers(void)
{
    return bus.answers;
}

uint32_t board_wire_errors(void)
{
    return bus.errors;
}
