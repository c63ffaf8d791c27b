/* The I2C master of a SERCOM, alike in SAMD21 and SAMD51; chip.h says which one. */
#ifndef SAMD_I2C_H
#define SAMD_I2C_H

#include "chip.h"

#define I2C_CTRLA REG32(I2C_BASE + 0x00)
#define I2C_CTRLB REG32(I2C_BASE + 0x04)
#define I2C_BAUD REG32(I2C_BASE + 0x0C)
#define I2C_INTFLAG REG8(I2C_BASE + 0x18)
#define I2C_STATUS REG16(I2C_BASE + 0x1A)
#define I2C_SYNCBUSY REG32(I2C_BASE + 0x1C)
#define I2C_ADDR REG32(I2C_BASE + 0x24)
#define I2C_DATA REG8(I2C_BASE + 0x28)
enum {
    I2C_CTRLA_SWRST = 1 << 0,
    I2C_CTRLA_ENABLE = 1 << 1,
    I2C_CTRLA_MASTER = 5 << 2,
    I2C_CTRLA_SDAHOLD_300_NS = 2 << 20,
    I2C_CTRLB_CMD_STOP = 3 << 16,
    I2C_CTRLB_NACK = 1 << 18,
    I2C_INTFLAG_MB = 1 << 0,
    I2C_INTFLAG_SB = 1 << 1,
    I2C_STATUS_BUSERR = 1 << 0,
    I2C_STATUS_ARBLOST = 1 << 1,
    I2C_STATUS_RXNACK = 1 << 2,
    I2C_STATUS_IDLE = 1 << 4
};

#endif
