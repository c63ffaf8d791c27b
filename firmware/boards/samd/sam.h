/* The part of the vendor's header that TinyUSB's driver for SAMD21 and SAMD51 needs: the registers of the USB device, and stubs for the
 * interrupt controller, because the driver is polled. Offsets as in the data sheet, chapter USB. */
#ifndef SAMD_SAM_H
#define SAMD_SAM_H

#include <stddef.h>
#include <stdint.h>

#include "chip.h"

#define USB_EPT_NUM 8
enum { USB_IRQn = 7, USB_0_IRQn = 80, USB_1_IRQn, USB_2_IRQn, USB_3_IRQn };
static inline void NVIC_EnableIRQ(int number) { (void)number; }
static inline void NVIC_DisableIRQ(int number) { (void)number; }

/* access to a register as a whole or by its bits */
#define SAM_REGISTER(name, type, ...) \
    typedef union { struct { __VA_ARGS__ } bit; type reg; } name

SAM_REGISTER(SAM_USB_CTRLA, uint8_t, uint8_t SWRST : 1; uint8_t ENABLE : 1; uint8_t RUNSTDBY : 1; uint8_t : 4; uint8_t MODE : 1;);
SAM_REGISTER(SAM_USB_SYNCBUSY, uint8_t, uint8_t SWRST : 1; uint8_t ENABLE : 1; uint8_t : 6;);
SAM_REGISTER(SAM_USB_QOSCTRL, uint8_t, uint8_t CQOS : 2; uint8_t DQOS : 2; uint8_t : 4;);
SAM_REGISTER(SAM_USB_CTRLB, uint16_t, uint16_t DETACH : 1; uint16_t UPRSM : 1; uint16_t SPDCONF : 2; uint16_t : 12;);
SAM_REGISTER(SAM_USB_DADD, uint8_t, uint8_t DADD : 7; uint8_t ADDEN : 1;);
SAM_REGISTER(SAM_USB_FNUM, uint16_t, uint16_t MFNUM : 3; uint16_t FNUM : 11; uint16_t : 2;);
SAM_REGISTER(SAM_USB_INTEN, uint16_t, uint16_t SUSPEND : 1; uint16_t : 1; uint16_t SOF : 1; uint16_t : 13;);
SAM_REGISTER(SAM_USB_INTFLAG, uint16_t, uint16_t all : 16;);
SAM_REGISTER(SAM_USB_EPINTSMRY, uint16_t, uint16_t all : 16;);
SAM_REGISTER(SAM_USB_DESCADD, uint32_t, uint32_t all : 32;);
SAM_REGISTER(SAM_USB_PADCAL, uint16_t, uint16_t TRANSP : 5; uint16_t : 1; uint16_t TRANSN : 5; uint16_t : 1; uint16_t TRIM : 3; uint16_t : 1;);
SAM_REGISTER(SAM_USB_EPCFG, uint8_t, uint8_t EPTYPE0 : 3; uint8_t : 1; uint8_t EPTYPE1 : 3; uint8_t : 1;);
SAM_REGISTER(SAM_USB_EPSTATUS, uint8_t, uint8_t all : 8;);
SAM_REGISTER(SAM_USB_EPINT, uint8_t, uint8_t TRCPT0 : 1; uint8_t TRCPT1 : 1; uint8_t TRFAIL0 : 1; uint8_t TRFAIL1 : 1; uint8_t RXSTP : 1; uint8_t STALL : 2; uint8_t : 1;);

typedef struct {
    volatile SAM_USB_EPCFG EPCFG;
    uint8_t reserved0[3];
    volatile SAM_USB_EPSTATUS EPSTATUSCLR;
    volatile SAM_USB_EPSTATUS EPSTATUSSET;
    volatile SAM_USB_EPSTATUS EPSTATUS;
    volatile SAM_USB_EPINT EPINTFLAG;
    volatile SAM_USB_EPINT EPINTENCLR;
    volatile SAM_USB_EPINT EPINTENSET;
    uint8_t reserved1[22];
} UsbDeviceEndpoint;

typedef struct {
    volatile SAM_USB_CTRLA CTRLA;
    uint8_t reserved0;
    volatile SAM_USB_SYNCBUSY SYNCBUSY;
    volatile SAM_USB_QOSCTRL QOSCTRL;
    uint8_t reserved1[4];
    volatile SAM_USB_CTRLB CTRLB;
    volatile SAM_USB_DADD DADD;
    uint8_t reserved2;
    volatile uint8_t STATUS;
    volatile uint8_t FSMSTATUS;
    uint8_t reserved3[2];
    volatile SAM_USB_FNUM FNUM;
    uint8_t reserved4[2];
    volatile SAM_USB_INTEN INTENCLR;
    uint8_t reserved5[2];
    volatile SAM_USB_INTEN INTENSET;
    uint8_t reserved6[2];
    volatile SAM_USB_INTFLAG INTFLAG;
    uint8_t reserved7[2];
    volatile SAM_USB_EPINTSMRY EPINTSMRY;
    uint8_t reserved8[2];
    volatile SAM_USB_DESCADD DESCADD;
    volatile SAM_USB_PADCAL PADCAL;
    uint8_t reserved9[214];
    UsbDeviceEndpoint DeviceEndpoint[USB_EPT_NUM];
} UsbDevice;

typedef union { UsbDevice DEVICE; } Usb;
#define USB ((Usb *)USB_BASE)

/* in RAM, one per endpoint and direction */
SAM_REGISTER(SAM_USB_ADDR, uint32_t, uint32_t all : 32;);
SAM_REGISTER(SAM_USB_PCKSIZE, uint32_t, uint32_t BYTE_COUNT : 14; uint32_t MULTI_PACKET_SIZE : 14; uint32_t SIZE : 3; uint32_t AUTO_ZLP : 1;);

typedef struct {
    volatile SAM_USB_ADDR ADDR;
    volatile SAM_USB_PCKSIZE PCKSIZE;
    volatile uint16_t EXTREG;
    volatile uint8_t STATUS_BK;
    uint8_t reserved[5];
} UsbDeviceDescBank;

#define SAM_AT(structure, member, offset) _Static_assert(offsetof(structure, member) == (offset), #member)
SAM_AT(UsbDevice, SYNCBUSY, 0x02);
SAM_AT(UsbDevice, QOSCTRL, 0x03);
SAM_AT(UsbDevice, CTRLB, 0x08);
SAM_AT(UsbDevice, DADD, 0x0A);
SAM_AT(UsbDevice, STATUS, 0x0C);
SAM_AT(UsbDevice, FNUM, 0x10);
SAM_AT(UsbDevice, INTENCLR, 0x14);
SAM_AT(UsbDevice, INTENSET, 0x18);
SAM_AT(UsbDevice, INTFLAG, 0x1C);
SAM_AT(UsbDevice, EPINTSMRY, 0x20);
SAM_AT(UsbDevice, DESCADD, 0x24);
SAM_AT(UsbDevice, PADCAL, 0x28);
SAM_AT(UsbDevice, DeviceEndpoint, 0x100);
SAM_AT(UsbDeviceEndpoint, EPSTATUSCLR, 0x04);
SAM_AT(UsbDeviceEndpoint, EPSTATUSSET, 0x05);
SAM_AT(UsbDeviceEndpoint, EPSTATUS, 0x06);
SAM_AT(UsbDeviceEndpoint, EPINTFLAG, 0x07);
SAM_AT(UsbDeviceEndpoint, EPINTENCLR, 0x08);
SAM_AT(UsbDeviceEndpoint, EPINTENSET, 0x09);
SAM_AT(UsbDeviceDescBank, PCKSIZE, 0x04);
SAM_AT(UsbDeviceDescBank, EXTREG, 0x08);
SAM_AT(UsbDeviceDescBank, STATUS_BK, 0x0A);
_Static_assert(sizeof(UsbDeviceEndpoint) == 0x20, "endpoints are 32 bytes apart");
_Static_assert(sizeof(UsbDeviceDescBank) == 0x10, "banks are 16 bytes apart");
_Static_assert(sizeof(SAM_USB_PCKSIZE) == 4 && sizeof(SAM_USB_CTRLB) == 2 && sizeof(SAM_USB_EPCFG) == 1, "sizes");

#define USB_CTRLA_MODE_DEVICE 0u
#define USB_CTRLA_ENABLE (1u << 1)
#define USB_CTRLA_RUNSTDBY (1u << 2)
#define USB_DEVICE_CTRLB_DETACH (1u << 0)
#define USB_DEVICE_CTRLB_SPDCONF_FS 0u
#define USB_DEVICE_DADD_DADD(address) ((uint8_t)((address) & 0x7Fu))
#define USB_DEVICE_DADD_ADDEN (1u << 7)
#define USB_DEVICE_INTFLAG_SUSPEND (1u << 0)
#define USB_DEVICE_INTENCLR_SUSPEND (1u << 0)
#define USB_DEVICE_INTENSET_SUSPEND (1u << 0)
#define USB_DEVICE_INTFLAG_SOF (1u << 2)
#define USB_DEVICE_INTFLAG_EORST (1u << 3)
#define USB_DEVICE_INTENSET_EORST (1u << 3)
#define USB_DEVICE_INTFLAG_WAKEUP (1u << 4)
#define USB_DEVICE_EPCFG_EPTYPE0(type) ((type) << 0)
#define USB_DEVICE_EPCFG_EPTYPE1(type) ((type) << 4)
#define USB_DEVICE_EPSTATUSCLR_DTGLOUT (1u << 0)
#define USB_DEVICE_EPSTATUSCLR_DTGLIN (1u << 1)
#define USB_DEVICE_EPSTATUSCLR_STALLRQ0 (1u << 4)
#define USB_DEVICE_EPSTATUSCLR_STALLRQ1 (1u << 5)
#define USB_DEVICE_EPSTATUSCLR_BK0RDY (1u << 6)
#define USB_DEVICE_EPSTATUSSET_STALLRQ0 (1u << 4)
#define USB_DEVICE_EPSTATUSSET_STALLRQ1 (1u << 5)
#define USB_DEVICE_EPSTATUSSET_BK1RDY (1u << 7)
#define USB_DEVICE_EPINTFLAG_TRCPT0 (1u << 0)
#define USB_DEVICE_EPINTFLAG_TRCPT1 (1u << 1)
#define USB_DEVICE_EPINTFLAG_TRFAIL0 (1u << 2)
#define USB_DEVICE_EPINTFLAG_TRFAIL1 (1u << 3)
#define USB_DEVICE_EPINTFLAG_RXSTP (1u << 4)
#define USB_DEVICE_EPINTENSET_TRCPT0 (1u << 0)
#define USB_DEVICE_EPINTENSET_TRCPT1 (1u << 1)
#define USB_DEVICE_EPINTENSET_RXSTP (1u << 4)

#define USB_FUSES_TRANSN_Msk (0x1Fu << USB_FUSES_TRANSN_Pos)
#define USB_FUSES_TRANSP_Msk (0x1Fu << USB_FUSES_TRANSP_Pos)
#define USB_FUSES_TRIM_Msk (0x7u << USB_FUSES_TRIM_Pos)

#endif
