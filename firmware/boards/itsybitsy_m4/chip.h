/* The registers of the SAMD51G19A that are used here. Names, addresses and bits as in the data sheet (SAM D5x/E5x
 * Family, DS60001507). */
#ifndef ITSYBITSY_M4_CHIP_H
#define ITSYBITSY_M4_CHIP_H

#include <stdint.h>

#define REG8(address) (*(volatile uint8_t *)(address))
#define REG16(address) (*(volatile uint16_t *)(address))
#define REG32(address) (*(volatile uint32_t *)(address))

/* calibration written at production, and the serial number */
#define NVM_CALIBRATION (*(const volatile uint32_t *)0x00800080u)
#define NVM_SERIAL (*(const volatile uint32_t *)0x008061FCu)

/* Main clocks of the buses; those not named here are on after a reset */
#define MCLK_APBAMASK REG32(0x40000814)
#define MCLK_APBBMASK REG32(0x40000818)
#define MCLK_APBDMASK REG32(0x40000820)
enum {
    MCLK_APBAMASK_TC0 = 1 << 14,
    MCLK_APBAMASK_TC1 = 1 << 15,
    MCLK_APBBMASK_USB = 1 << 0,
    MCLK_APBBMASK_EVSYS = 1 << 7,
    MCLK_APBBMASK_SERCOM2 = 1 << 9,
    MCLK_APBBMASK_TCC1 = 1 << 12,
    MCLK_APBDMASK_ADC0 = 1 << 7,
    MCLK_APBDMASK_ADC1 = 1 << 8,
    MCLK_APBDMASK_DAC = 1 << 9
};

/* Reset cause */
#define RSTC_RCAUSE REG8(0x40000C00)
enum { RSTC_RCAUSE_BODCORE = 1 << 1, RSTC_RCAUSE_BODVDD = 1 << 2, RSTC_RCAUSE_WDT = 1 << 5 };

/* Oscillators: DFLL48M and DPLL0 */
#define OSCCTRL_STATUS REG32(0x40001010)
#define OSCCTRL_DFLLCTRLA REG8(0x4000101C)
#define OSCCTRL_DFLLCTRLB REG8(0x40001020)
#define OSCCTRL_DFLLVAL REG32(0x40001024)
#define OSCCTRL_DFLLMUL REG32(0x40001028)
#define OSCCTRL_DFLLSYNC REG8(0x4000102C)
#define OSCCTRL_DPLLCTRLA REG8(0x40001030)
#define OSCCTRL_DPLLRATIO REG32(0x40001034)
#define OSCCTRL_DPLLCTRLB REG32(0x40001038)
#define OSCCTRL_DPLLSYNCBUSY REG32(0x4000103C)
#define OSCCTRL_DPLLSTATUS REG32(0x40001040)
enum {
    OSCCTRL_STATUS_DFLLRDY = 1 << 8,
    OSCCTRL_DFLLCTRLA_ENABLE = 1 << 1,
    OSCCTRL_DFLLCTRLB_MODE = 1 << 0,   /* closed loop */
    OSCCTRL_DFLLCTRLB_USBCRM = 1 << 3, /* on USB's start of frame */
    OSCCTRL_DFLLCTRLB_CCDIS = 1 << 4,
    OSCCTRL_DPLLCTRLA_ENABLE = 1 << 1,
    OSCCTRL_DPLLCTRLB_REFCLK_GCLK = 0 << 5,
    OSCCTRL_DPLLCTRLB_LBYPASS = 1 << 11,
    OSCCTRL_DPLLSTATUS_CLKRDY = 1 << 1
};

/* Generic clocks */
#define GCLK_SYNCBUSY REG32(0x40001C04)
#define GCLK_GENCTRL(generator) REG32(0x40001C20 + 4 * (generator))
#define GCLK_PCHCTRL(peripheral) REG32(0x40001C80 + 4 * (peripheral))
enum {
    GCLK_GENCTRL_GENEN = 1 << 8,
    GCLK_GENCTRL_IDC = 1 << 9,
    GCLK_PCHCTRL_CHEN = 1 << 6,
    GCLK_SOURCE_OSCULP32K = 4,
    GCLK_SOURCE_DFLL48M = 6,
    GCLK_SOURCE_DPLL0 = 7,
    GCLK_ID_FDPLL0 = 1,
    GCLK_ID_TC0_TC1 = 9,
    GCLK_ID_USB = 10,
    GCLK_ID_SERCOM2_CORE = 23,
    GCLK_ID_TCC0_TCC1 = 25,
    GCLK_ID_ADC0 = 40,
    GCLK_ID_ADC1 = 41,
    GCLK_ID_DAC = 42
};

/* Supply controller: brown-out detector */
#define SUPC_STATUS REG32(0x4000180C)
#define SUPC_BOD33 REG32(0x40001810)
enum {
    SUPC_STATUS_BOD33RDY = 1 << 0,
    SUPC_STATUS_B33SRDY = 1 << 2,
    SUPC_BOD33_ENABLE = 1 << 1,
    SUPC_BOD33_ACTION_RESET = 1 << 2
};
#define SUPC_BOD33_HYST(steps) ((uint32_t)(steps) << 8)
#define SUPC_BOD33_LEVEL(level) ((uint32_t)(level) << 16)

/* Watchdog */
#define WDT_CTRLA REG8(0x40002000)
#define WDT_CONFIG REG8(0x40002001)
#define WDT_SYNCBUSY REG32(0x40002008)
#define WDT_CLEAR REG8(0x4000200C)
enum { WDT_CTRLA_ENABLE = 1 << 1, WDT_CLEAR_KEY = 0xA5, WDT_CONFIG_8_CYCLES = 0 };

/* Cache in front of the flash */
#define CMCC_CTRL REG32(0x41006008)
enum { CMCC_CTRL_CEN = 1 << 0 };

/* Port A, and the multiplexers of port B */
#define PORT_DIRCLR REG32(0x41008004)
#define PORT_DIRSET REG32(0x41008008)
#define PORT_OUTCLR REG32(0x41008014)
#define PORT_OUTSET REG32(0x41008018)
#define PORT_IN REG32(0x41008020)
#define PORT_PMUX(pin) REG8(0x41008030 + (pin) / 2)
#define PORT_PINCFG(pin) REG8(0x41008040 + (pin))
#define PORT_B_PMUX(pin) REG8(0x410080B0 + (pin) / 2)
#define PORT_B_PINCFG(pin) REG8(0x410080C0 + (pin))
enum {
    PORT_PINCFG_PMUXEN = 1 << 0,
    PORT_PINCFG_INEN = 1 << 1,
    PORT_PINCFG_PULLEN = 1 << 2,
    PORT_MUX_B = 1, /* analogue */
    PORT_MUX_C = 2, /* SERCOM */
    PORT_MUX_F = 5, /* timers */
    PORT_MUX_H = 7  /* USB */
};

/* DMA controller, channel 0 */
#define DMAC_CTRL REG16(0x4100A000)
#define DMAC_BASEADDR REG32(0x4100A034)
#define DMAC_WRBADDR REG32(0x4100A038)
#define DMAC_CHCTRLA REG32(0x4100A040)
#define DMAC_CHINTFLAG REG8(0x4100A04E)
enum {
    DMAC_CTRL_DMAENABLE = 1 << 1,
    DMAC_CTRL_LEVELS = 0xF << 8,
    DMAC_CHCTRLA_ENABLE = 1 << 1,
    DMAC_CHCTRLA_TRIGGER_ADC0 = 68 << 8,
    DMAC_CHCTRLA_ACTION_BURST = 2 << 20,
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
#define EVSYS_CHANNEL(channel) REG32(0x4100E020 + 8 * (channel))
#define EVSYS_USER(user) REG32(0x4100E120 + 4 * (user))
enum {
    EVSYS_CHANNEL_GENERATOR_TC0_OVF = 73,
    EVSYS_CHANNEL_ASYNCHRONOUS = 2 << 8,
    EVSYS_USER_TC1 = 45,
    EVSYS_USER_ADC0_START = 55
};
#define EVSYS_USER_OF(channel) ((channel) + 1u) /* 0 means no channel */

/* Timers 0 and 1 in 16-bit mode */
#define TC0_BASE 0x40003800u
#define TC1_BASE 0x40003C00u
#define TC_CTRLA(base) REG32((base) + 0x00)
#define TC_CTRLBSET(base) REG8((base) + 0x05)
#define TC_EVCTRL(base) REG16((base) + 0x06)
#define TC_WAVE(base) REG8((base) + 0x0C)
#define TC_SYNCBUSY(base) REG32((base) + 0x10)
#define TC_COUNT(base) REG16((base) + 0x14)
#define TC_CC0(base) REG16((base) + 0x1C)
enum {
    TC_CTRLA_ENABLE = 1 << 1,
    TC_CTRLBSET_READSYNC = 4 << 5,
    TC_EVCTRL_COUNT_EVENTS = 2 | (1 << 5),
    TC_EVCTRL_OVFEO = 1 << 8,
    TC_WAVE_MATCH_FREQUENCY = 1
};

/* Timer for control 1: the servo */
#define TCC1_BASE 0x41018000u
#define TCC_CTRLA(base) REG32((base) + 0x00)
#define TCC_SYNCBUSY(base) REG32((base) + 0x08)
#define TCC_WAVE(base) REG32((base) + 0x3C)
#define TCC_PER(base) REG32((base) + 0x40)
#define TCC_CC(base, n) REG32((base) + 0x44 + 4 * (n))
#define TCC_CCBUF(base, n) REG32((base) + 0x70 + 4 * (n))
enum { TCC_CTRLA_ENABLE = 1 << 1, TCC_CTRLA_DIV16 = 4 << 8, TCC_WAVE_SINGLE_SLOPE = 2 };

/* Converters 0 and 1 */
#define ADC0_BASE 0x43001C00u
#define ADC1_BASE 0x43002000u
#define ADC_CTRLA(base) REG16((base) + 0x00)
#define ADC_EVCTRL(base) REG8((base) + 0x02)
#define ADC_INPUTCTRL(base) REG16((base) + 0x04)
#define ADC_CTRLB(base) REG16((base) + 0x06)
#define ADC_REFCTRL(base) REG8((base) + 0x08)
#define ADC_SAMPCTRL(base) REG8((base) + 0x0B)
#define ADC_SWTRIG(base) REG8((base) + 0x14)
#define ADC_INTFLAG(base) REG8((base) + 0x2E)
#define ADC_SYNCBUSY(base) REG32((base) + 0x30)
#define ADC_RESULT(base) REG16((base) + 0x40)
#define ADC_CALIB(base) REG16((base) + 0x48)
enum {
    ADC_CTRLA_ENABLE = 1 << 1,
    ADC_CTRLA_DIV4 = 1 << 8,
    ADC_CTRLB_FREERUN = 1 << 1, /* 12 bits */
    ADC_REFCTRL_SUPPLY = 3,     /* the analogue supply */
    ADC_SWTRIG_FLUSH = 1 << 0,
    ADC_SWTRIG_START = 1 << 1,
    ADC_INPUTCTRL_GROUND = 0x18 << 8,
    ADC_EVCTRL_STARTEI = 1 << 1,
    ADC_INTFLAG_RESRDY = 1 << 0
};

/* Digital-to-analogue converter 0 */
#define DAC_CTRLA REG8(0x43002400)
#define DAC_CTRLB REG8(0x43002401)
#define DAC_STATUS REG8(0x43002407)
#define DAC_SYNCBUSY REG32(0x43002408)
#define DAC_DACCTRL0 REG16(0x4300240C)
#define DAC_DATA0 REG16(0x43002410)
enum {
    DAC_CTRLA_ENABLE = 1 << 1,
    DAC_CTRLB_REFSEL_VREFPU = 0 << 1, /* pin VREFA, unbuffered */
    DAC_DACCTRL_ENABLE = 1 << 1,
    DAC_DACCTRL_CC12M = 2 << 2,
    DAC_DACCTRL_REFRESH_60_US = 2 << 8,
    DAC_STATUS_READY0 = 1 << 0
};

/* I2C master on SERCOM2 (samd/i2c.h) */
#define I2C_BASE 0x41012000u
#define I2C_GCLK_ID GCLK_ID_SERCOM2_CORE
#define I2C_GENERATOR 1
#define I2C_POWER() (MCLK_APBBMASK |= MCLK_APBBMASK_SERCOM2)

/* USB device (samd/sam.h); the calibration of the pads, written at production */
#define USB_BASE 0x41000000u
#define USB_GENERATOR 1
#define USB_MUX PORT_MUX_H
#define USB_FUSES_TRANSN_ADDR 0x00800084u
#define USB_FUSES_TRANSN_Pos 0
#define USB_FUSES_TRANSP_ADDR 0x00800084u
#define USB_FUSES_TRANSP_Pos 5
#define USB_FUSES_TRIM_ADDR 0x00800084u
#define USB_FUSES_TRIM_Pos 10

/* Processor: floating-point unit, software reset */
#define SCB_VTOR REG32(0xE000ED08)
#define SCB_AIRCR REG32(0xE000ED0C)
#define SCB_CPACR REG32(0xE000ED88)
enum { SCB_CPACR_FPU = 0xF << 20 };

#endif
