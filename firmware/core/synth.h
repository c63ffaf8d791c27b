/* Vibration synthesiser: one voice, a decaying sine or a short sampled wave, as 12-bit samples at 16 kHz.
 *
 * Integers only, bit-identical on every machine and to the Python implementation in fdvv.program. A sample is computed
 * for the middle of the period during which the converter holds it. The envelope decays by the factor decay_q16 over
 * each block of 32 samples, linearly within a block. */
#ifndef FDVV_SYNTH_H
#define FDVV_SYNTH_H

#include <stdint.h>

#define FDVV_SYNTH_RATE_HZ 16000u
#define FDVV_SYNTH_BLOCK_SAMPLES 32u
#define FDVV_SYNTH_SILENCE 2048u        /* converter counts: the middle */
#define FDVV_SYNTH_AMPLITUDE_MAX 2047u  /* converter counts */
#define FDVV_SYNTH_STEADY_Q16 65535u    /* decay_q16 for a constant amplitude */
#define FDVV_SYNTH_SLOTS 16u
#define FDVV_SYNTH_POOL_BYTES 1024u     /* samples of all waves */
#define FDVV_SYNTH_WAVE_SAMPLES 512u    /* of one wave */

enum { FDVV_SYNTH_SINE = 0, FDVV_SYNTH_SAMPLED = 1, FDVV_SYNTH_SILENT = 255 };

/* A vibration. An empty slot has a duration of 0. */
typedef struct {
    uint16_t frequency_Hz16;   /* 1/16 Hz; frequency of the sine, or sample rate of the wave */
    uint16_t duration_samples; /* a sampled wave also ends with its last sample */
    uint16_t amplitude_counts; /* at the start; for a sampled wave, of a sample value of 128 */
    uint16_t decay_q16;        /* amplitude ratio over 32 samples; 65535: constant */
    uint16_t wave_at;          /* first sample in the pool; sampled waves only */
    uint16_t wave_samples;     /* sampled waves only */
    uint8_t waveform;          /* FDVV_SYNTH_SINE or FDVV_SYNTH_SAMPLED */
} fdvv_synth_slot;

/* All slots and their waves. */
typedef struct {
    fdvv_synth_slot slots[FDVV_SYNTH_SLOTS];
    uint32_t increments[FDVV_SYNTH_SLOTS]; /* phase increments, computed in advance */
    int8_t pool[FDVV_SYNTH_POOL_BYTES];
} fdvv_synth_bank;

/* State of a vibration being played. */
typedef struct {
    uint32_t phase;             /* sine: turns * 2^32; wave: samples * 2^16 */
    uint32_t increment;         /* of the phase per output sample */
    const int8_t *wave;         /* first sample of the wave */
    uint16_t wave_samples;
    uint16_t remaining_samples; /* until the end of the duration */
    uint16_t amplitude_q5;      /* counts * 32 */
    uint16_t block_end_q5;      /* amplitude at the end of this block */
    uint16_t step_q5;           /* decrease of the amplitude per sample in this block */
    uint16_t decay_q16;
    uint8_t block_samples;      /* left in this block */
    uint8_t waveform;           /* FDVV_SYNTH_SILENT after the end */
} fdvv_synth_voice;

/* Empty every slot. */
void fdvv_synth_init(fdvv_synth_bank *bank);

/* Store a slot. Returns 1, or 0 if a value is out of range; the slot is unchanged then. */
uint8_t fdvv_synth_set(fdvv_synth_bank *bank, uint8_t index, const fdvv_synth_slot *slot);

/* Copy samples into the pool. Returns 1, or 0 if they do not fit; the pool is unchanged then. */
uint8_t fdvv_synth_load(fdvv_synth_bank *bank, uint16_t at, const uint8_t *samples, uint8_t count);

/* Restart a voice in two steps, because the bytes of a command arrive one after the other: first choose the slot
 * (silent if it is empty or invalid), then start with a strength (255: the amplitude of the slot, 0: silent). */
void fdvv_synth_choose(fdvv_synth_voice *voice, const fdvv_synth_bank *bank, uint8_t index);
void fdvv_synth_start(fdvv_synth_voice *voice, uint8_t strength);

/* Silence a voice immediately. */
void fdvv_synth_stop(fdvv_synth_voice *voice);

/* Whether a voice is playing. Reads one byte only, so that an interrupt may end the voice at any time. */
static inline uint8_t fdvv_synth_playing(const fdvv_synth_voice *voice) {
    return voice->waveform != FDVV_SYNTH_SILENT;
}

/* The next sample, 0 to 4095; 2048 after the end of the voice. */
uint16_t fdvv_synth_sample(fdvv_synth_voice *voice);

/* Write the next count samples. */
void fdvv_synth_render(fdvv_synth_voice *voice, uint16_t *samples, uint32_t count);

#endif
