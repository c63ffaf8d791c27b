/* Connections; names in brackets are printed on the board. All digital pins are of port A. */
#ifndef ITSYBITSY_M4_PINS_H
#define ITSYBITSY_M4_PINS_H

#define BOARD_NAME "itsybitsy-m4"

/* plate kg, stiffness N/m, damping N s/m, filter s of the load cell in the rig to build; the host may write another */
#define BOARD_CELL {4e-4f, 5e5f, 1.414f, 3.98e-5f}

enum {
    PIN_SETPOINT = 2,   /* (A0) DAC0: current setpoint, half the supply is 0 */
    PIN_REFERENCE = 3,  /* (AREF) of DAC0; 3.3 V, tied on the board */
    PIN_POSITION = 4,   /* (A4) ADC0/AIN4 */
    PIN_THERMISTOR = 6, /* (A5) ADC0/AIN6, 10 kOhm to the supply, 100 nF to ground */
    PIN_SDA = 12,       /* (SDA) SERCOM2 */
    PIN_SCL = 13,       /* (SCL) SERCOM2 */
    PIN_KEY = 18,       /* (D7) high while the key is down; to the LED strip's board */
    PIN_STOP = 19,      /* (D9) TCC1/WO3, servo */
    PIN_FAULT = 20,     /* (D10) nFAULT of the current stage, pulled up here */
    PIN_ENABLE = 21,    /* (D11) enable of the current stage */
    PIN_USB_MINUS = 24,
    PIN_USB_PLUS = 25
};

/* of port B */
enum {
    PIN_B_FORCE = 8,    /* (A2) ADC1/AIN0, load cell in the cap */
    PIN_B_SUPPLY = 9    /* (A3) ADC1/AIN1, supply through 220 kOhm over 22 kOhm */
};

/* converter 0 reads position, thermistor and setpoint, converter 1 the others */
enum { AIN_POSITION = 4, AIN_THERMISTOR = 6, AIN_SETPOINT = 0, AIN_FORCE = 0, AIN_SUPPLY = 1 };

#define PIN_BIT(pin) (1u << (pin))

#endif
