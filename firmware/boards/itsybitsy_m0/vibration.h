/* The vibration board, as vibration_wire.h speaks to it over the I2C bus. */
#ifndef ITSYBITSY_M0_VIBRATION_H
#define ITSYBITSY_M0_VIBRATION_H

#include <stdint.h>

/* Start a waveform at its own strength. */
void vibration_play(uint8_t slot);

/* Be silent: also how to find out whether the board is there. */
void vibration_silence(void);

/* Begin to forward the waveforms of a checked program, which stays where it is; vibration_step goes on with it. */
void vibration_load(const uint8_t *image);

/* Put one more message of the forwarding into the queue, if it has room beside a PLAY. */
void vibration_step(void);

#endif
