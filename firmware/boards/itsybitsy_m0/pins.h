/* Connections; numbers are bits of port A, names in brackets are printed on the board. */
#ifndef ITSYBITSY_M0_PINS_H
#define ITSYBITSY_M0_PINS_H

#define BOARD_NAME "itsybitsy-m0"

enum {
    PIN_POSITION = 2,   /* (A0) AIN0 */
    PIN_SUPPLY = 4,     /* (A3) AIN4, supply through 100 kOhm over 22 kOhm */
    PIN_FORCE = 5,      /* (A4) AIN5, keycap force sensor, tied to ground if there is none */
    PIN_B_THERMISTOR = 2, /* (A5) of port B, AIN10, 10 kOhm to the supply, 100 nF to ground; read if limits.h has one */
    PIN_STOP = 7,       /* (D9) TCC1/WO1, servo */
    PIN_KEY = 14,       /* (D2) high while the key is down; to the LED strip's board */
    PIN_ENABLE = 16,    /* (D11) nSLEEP of the bridge */
    PIN_IN1 = 18,       /* (D10) TCC0/WO2 */
    PIN_IN2 = 19,       /* (D12) TCC0/WO3 */
    PIN_FAULT = 21,     /* (D7) nFAULT of the bridge, pulled up here */
    PIN_SDA = 22,       /* (SDA) SERCOM3 */
    PIN_SCL = 23,       /* (SCL) SERCOM3 */
    PIN_USB_MINUS = 24,
    PIN_USB_PLUS = 25
};

enum { AIN_POSITION = 0, AIN_SUPPLY = 4, AIN_FORCE = 5, AIN_THERMISTOR = 10 };

#define PIN_BIT(pin) (1u << (pin))

#endif
