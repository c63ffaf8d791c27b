/* Commands to the vibration board over I2C, in the format of vibration_wire.h. */
#ifndef SAMD_VIBRATION_H
#define SAMD_VIBRATION_H

#include <stdint.h>

/* Start a vibration with its own amplitude. */
void vibration_play(uint8_t slot);

/* Silence the board; also used to detect it. */
void vibration_silence(void);

/* Start to send the waveforms of a checked program, which must stay in memory; vibration_step continues. */
void vibration_load(const uint8_t *image);

/* Queue the next message with waveforms, if the queue then still has room for a PLAY. */
void vibration_step(void);

#endif
