/* The registers of the SAMD21G18A that are used here. Names, addresses and bits as in the data sheet (SAM D21/DA1
 * Family, DS40001882). */
#ifndef ITSYBITSY_M0_CHIP_H
#define ITSYBITSY_M0_CHIP_H

#include <stdint.h>

#define REG8(address) (*(volatile uint8_t *)(address))
#define REG16(address) (*(volatile uint16_t *)(address))
#define REG32(address) (*(volatile uint32_t *)(address))

/* calibration written at production, and the serial number */
#define NVM_CALIBRATION(word) (*(const volatile uint32_t *)(0x00806020u + 4u * (word)))
#define NVM_SERIAL (*(const volatile uint32_t *)0x0080A00Cu)

/* Power Manager: reset cause and bus clocks */
#define PM_APBCMASK REG32(0x40000420)
#define PM_RCAUSE REG8(0x40000438)
enum {
    PM_RCAUSE_BOD12 = 1 << 1,
    PM_RCAUSE_BOD33 = 1 << 2,
    PM_RCAUSE_WDT = 1 << 5,
    PM_APBCMASK_EVSYS = 1 << 1,
    PM_APBCMASK_SERCOM3 = 1 << 5,
    PM_APBCMASK_TCC0 = 1 << 8,
    PM_APBCMASK_TCC1 = 1 << 9,
    PM_APBCMASK_TC3 = 1 << 11,
    PM_APBCMASK_TC4 = 1 << 12,
    PM_APBCMASK_ADC = 1 << 16
};

/* System Controller: DFLL48M and brown-out detector */
#define SYSCTRL_PCLKSR REG32(0x4000080C)
#define SYSCTRL_DFLLCTRL REG16(0x40000824)
#define SYSCTRL_DFLLVAL REG32(0x40000828)
#define SYSCTRL_DFLLMUL REG32(0x4000082C)
#define SYSCTRL_BOD33 REG32(0x40000834)
enum {
    SYSCTRL_PCLKSR_DFLLRDY = 1 << 4,
    SYSCTRL_PCLKSR_BOD33RDY = 1 << 9,
    SYSCTRL_PCLKSR_B33SRDY = 1 << 11,
    SYSCTRL_DFLLCTRL_ENABLE = 1 << 1,
    SYSCTRL_DFLLCTRL_MODE = 1 << 2,   /* closed loop */
    SYSCTRL_DFLLCTRL_USBCRM = 1 << 5, /* on USB's start of frame */
    SYSCTRL_DFLLCTRL_CCDIS = 1 << 8,
    SYSCTRL_DFLLCTRL_BPLCKC = 1 << 10,
    SYSCTRL_BOD33_ENABLE = 1 << 1,
    SYSCTRL_BOD33_HYST = 1 << 2,
    SYSCTRL_BOD33_RESET = 1 << 3
};
#define SYSCTRL_BOD33_LEVEL(level) ((uint32_t)(level) << 16)

/* Generic clocks */
#define GCLK_STATUS REG8(0x40000C01)
#define GCLK_CLKCTRL REG16(0x40000C02)
#define GCLK_GENCTRL REG32(0x40000C04)
#define GCLK_GENDIV REG32(0x40000C08)
enum {
    GCLK_STATUS_SYNCBUSY = 1 << 7,
    GCLK_CLKCTRL_CLKEN = 1 << 14,
    GCLK_GENCTRL_GENEN = 1 << 16,
    GCLK_GENCTRL_IDC = 1 << 17,
    GCLK_SOURCE_OSCULP32K = 3,
    GCLK_SOURCE_DFLL48M = 7,
    GCLK_ID_WDT = 0x03,
    GCLK_ID_USB = 0x06,
    GCLK_ID_SERCOM3_CORE = 0x17,
    GCLK_ID_TCC0_TCC1 = 0x1A,
    GCLK_ID_TCC2_TC3 = 0x1B,
    GCLK_ID_TC4_TC5 = 0x1C,
    GCLK_ID_ADC = 0x1E
};

/* Watchdog */
#define WDT_CTRL REG8(0x40001000)
#define WDT_CONFIG REG8(0x40001001)
#define WDT_STATUS REG8(0x40001007)
#define WDT_CLEAR REG8(0x40001008)
enum { WDT_CTRL_ENABLE = 1 << 1, WDT_CLEAR_KEY = 0xA5, WDT_STATUS_SYNCBUSY = 1 << 7, WDT_CONFIG_64_CYCLES = 3 };

/* Flash controller: wait states */
#define NVMCTRL_CTRLB REG32(0x41004004)
enum { NVMCTRL_CTRLB_ONE_WAIT_STATE = 1 << 1, NVMCTRL_CTRLB_MANW = 1 << 7 };

/* Port A */
#define PORT_DIRCLR REG32(0x41004404)
#define PORT_DIRSET REG32(0x41004408)
#define PORT_OUTCLR REG32(0x41004414)
#define PORT_OUTSET REG32(0x41004418)
#define PORT_IN REG32(0x41004420)
#define PORT_PMUX(pin) REG8(0x41004430 + (pin) / 2)
#define PORT_PINCFG(pin) REG8(0x41004440 + (pin))
#define PORT_B_PMUX(pin) REG8(0x410044B0 + (pin) / 2)
#define PORT_B_PINCFG(pin) REG8(0x410044C0 + (pin))
enum {
    PORT_PINCFG_PMUXEN = 1 << 0,
    PORT_PINCFG_INEN = 1 << 1,
    PORT_PINCFG_PULLEN = 1 << 2,
    PORT_MUX_B = 1, /* analogue */
    PORT_MUX_C = 2, /* SERCOM */
    PORT_MUX_E = 4, /* timers */
    PORT_MUX_F = 5, /* timers, second choice */
    PORT_MUX_G = 6  /* USB */
};

/* DMA controller */
#define DMAC_CTRL REG16(0x41004800)
#define DMAC_BASEADDR REG32(0x41004834)
#define DMAC_WRBADDR REG32(0x41004838)
#define DMAC_CHID REG8(0x4100483F)
#define DMAC_CHCTRLA REG8(0x41004840)
#define DMAC_CHCTRLB REG32(0x41004844)
#define DMAC_CHINTFLAG REG8(0x4100484E)
enum {
    DMAC_CTRL_DMAENABLE = 1 << 1,
    DMAC_CTRL_LEVELS = 0xF << 8,
    DMAC_CHCTRLA_ENABLE = 1 << 1,
    DMAC_CHCTRLB_TRIGGER_ADC = 0x27 << 8,
    DMAC_CHCTRLB_ACTION_BEAT = 2 << 22,
    DMAC_CHINTFLAG_TERR = 1 << 0,
    DMAC_CHINTFLAG_TCMPL = 1 << 1,
    DMAC_BTCTRL_VALID = 1 << 0,
    DMAC_BTCTRL_HWORD = 1 << 8,
    DMAC_BTCTRL_DSTINC = 1 << 11
};

typedef struct {
    uint16_t btctrl;
    uint16_t btcnt;
    uint32_t srcaddr; /* end of the block if the address is incremented, else the address */
    uint32_t dstaddr;
    uint32_t descaddr;
} dmac_descriptor;

/* Event system */
#define EVSYS_CHANNEL REG32(0x42000404)
#define EVSYS_USER REG16(0x42000408)
enum {
    EVSYS_CHANNEL_GENERATOR_TC3_OVF = 0x33 << 16,
    EVSYS_CHANNEL_ASYNCHRONOUS = 2 << 24,
    EVSYS_USER_TC4 = 0x13,
    EVSYS_USER_ADC_START = 0x17
};
#define EVSYS_USER_OF(channel) (uint16_t)(((channel) + 1u) << 8) /* 0 means no channel */

/* I2C master on SERCOM3 (samd/i2c.h) */
#define I2C_BASE 0x42001400u
#define I2C_GCLK_ID GCLK_ID_SERCOM3_CORE
#define I2C_GENERATOR 0
#define I2C_POWER() (PM_APBCMASK |= PM_APBCMASK_SERCOM3)

/* USB device (samd/sam.h); the calibration of the pads, written at production */
#define USB_BASE 0x41005000u
#define USB_GENERATOR 0
#define USB_MUX PORT_MUX_G
#define USB_FUSES_TRANSN_ADDR 0x00806024u
#define USB_FUSES_TRANSN_Pos 13
#define USB_FUSES_TRANSP_ADDR 0x00806024u
#define USB_FUSES_TRANSP_Pos 18
#define USB_FUSES_TRIM_ADDR 0x00806024u
#define USB_FUSES_TRIM_Pos 23

/* Timers 3 and 4 in 16-bit mode */
#define TC3_BASE 0x42002C00u
#define TC4_BASE 0x42003000u
#define TC_CTRLA(base) REG16((base) + 0x00)
#define TC_READREQ(base) REG16((base) + 0x02)
#define TC_EVCTRL(base) REG16((base) + 0x0A)
#define TC_STATUS(base) REG8((base) + 0x0F)
#define TC_COUNT(base) REG16((base) + 0x10)
#define TC_CC0(base) REG16((base) + 0x18)
enum {
    TC_CTRLA_ENABLE = 1 << 1,
    TC_CTRLA_MATCH_FREQUENCY = 1 << 5,
    TC_READREQ_COUNT_ALWAYS = (1 << 15) | (1 << 14) | 0x10,
    TC_EVCTRL_COUNT_EVENTS = 2 | (1 << 5),
    TC_EVCTRL_OVFEO = 1 << 8,
    TC_STATUS_SYNCBUSY = 1 << 7
};

/* Timers for control 0 (bridge) and 1 (servo) */
#define TCC0_BASE 0x42002000u
#define TCC1_BASE 0x42002400u
#define TCC_CTRLA(base) REG32((base) + 0x00)
#define TCC_SYNCBUSY(base) REG32((base) + 0x08)
#define TCC_WAVE(base) REG32((base) + 0x3C)
#define TCC_PER(base) REG32((base) + 0x40)
#define TCC_CC(base, n) REG32((base) + 0x44 + 4 * (n))
#define TCC_CCB(base, n) REG32((base) + 0x70 + 4 * (n))
enum {
    TCC_CTRLA_ENABLE = 1 << 1,
    TCC_CTRLA_DIV16 = 4 << 8,
    TCC_WAVE_SINGLE_SLOPE = 2,
    TCC_WAVE_DUAL_SLOPE = 5,       /* update at the bottom */
    TCC_WAVE_HIGH_BELOW = 0xF << 16 /* dual slope: high while the count is below the compare value */
};

/* Converter */
#define ADC_CTRLA REG8(0x42004000)
#define ADC_REFCTRL REG8(0x42004001)
#define ADC_SAMPCTRL REG8(0x42004003)
#define ADC_CTRLB REG16(0x42004004)
#define ADC_SWTRIG REG8(0x4200400C)
#define ADC_INPUTCTRL REG32(0x42004010)
#define ADC_EVCTRL REG8(0x42004014)
#define ADC_INTFLAG REG8(0x42004018)
#define ADC_STATUS REG8(0x42004019)
#define ADC_RESULT REG16(0x4200401A)
#define ADC_RESULT_ADDRESS 0x4200401Au
#define ADC_CALIB REG16(0x42004028)
enum {
    ADC_CTRLA_ENABLE = 1 << 1,
    ADC_REFCTRL_HALF_SUPPLY = 2,
    ADC_CTRLB_FREERUN = 1 << 2,
    ADC_CTRLB_12_BIT_DIV4 = 0,
    ADC_SWTRIG_FLUSH = 1 << 0,
    ADC_SWTRIG_START = 1 << 1,
    ADC_INPUTCTRL_GROUND = 0x18 << 8,
    ADC_INPUTCTRL_HALF_GAIN = 0xF << 24,
    ADC_EVCTRL_STARTEI = 1 << 0,
    ADC_INTFLAG_RESRDY = 1 << 0,
    ADC_STATUS_SYNCBUSY = 1 << 7
};

/* Processor: software reset */
#define SCB_AIRCR REG32(0xE000ED0C)
#define SCB_VTOR REG32(0xE000ED08)

#endif
