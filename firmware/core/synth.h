/* Vibration synthesiser: one voice, a decaying sine or a short sampled wave, as 12-bit samples at 16 kHz.
 *
 * Integers only and the same bits on every machine; fdvv.program renders the same in Python. A sample is held
 * by the converter for one period and is taken at the middle of it. The envelope falls by decay_q16 over each
 * block of 32 samples, linearly inside a block. */
#ifndef FDVV_SYNTH_H
#define FDVV_SYNTH_H

#include <stdint.h>

#define FDVV_SYNTH_RATE_HZ 16000u
#define FDVV_SYNTH_BLOCK_SAMPLES 32u
#define FDVV_SYNTH_SILENCE 2048u        /* converter counts: the middle */
#define FDVV_SYNTH_AMPLITUDE_MAX 2047u  /* converter counts */
#define FDVV_SYNTH_STEADY_Q16 65535u    /* a decay_q16 that keeps the amplitude exactly */
#define FDVV_SYNTH_SLOTS 16u
#define FDVV_SYNTH_POOL_BYTES 1024u     /* samples of all waves together */
#define FDVV_SYNTH_WAVE_SAMPLES 512u    /* of one wave */

enum { FDVV_SYNTH_SINE = 0, FDVV_SYNTH_SAMPLED = 1, FDVV_SYNTH_SILENT = 255 };

/* What a slot plays. An empty slot has a duration of 0. */
typedef struct {
    uint16_t frequency_Hz16;   /* 1/16 Hz; of the sine, or playback rate of the sampled wave */
    uint16_t duration_samples; /* silence after it; a sampled wave also ends with its last sample */
    uint16_t amplitude_counts; /* at the start; of a sampled wave: of a sample of 128 */
    uint16_t decay_q16;        /* amplitude after 32 samples over amplitude before; 65535: steady */
    uint16_t wave_at;          /* first sample in the pool; sampled waves only */
    uint16_t wave_samples;     /* how many; sampled waves only */
    uint8_t waveform;          /* FDVV_SYNTH_SINE or FDVV_SYNTH_SAMPLED */
} fdvv_synth_slot;

/* All that can be played. */
typedef struct {
    fdvv_synth_slot slots[FDVV_SYNTH_SLOTS];
    uint32_t increments[FDVV_SYNTH_SLOTS]; /* of their voices, so that a start need not compute them */
    int8_t pool[FDVV_SYNTH_POOL_BYTES];
} fdvv_synth_bank;

/* What is being played. */
typedef struct {
    uint32_t phase;             /* sine: turns * 2^32; wave: samples * 2^16 */
    uint32_t increment;         /* of the phase per output sample */
    const int8_t *wave;         /* first sample of the wave */
    uint16_t wave_samples;
    uint16_t remaining_samples; /* of the duration */
    uint16_t amplitude_q5;      /* counts * 32 */
    uint16_t block_end_q5;      /* amplitude at the end of this block */
    uint16_t step_q5;           /* fall of the amplitude per sample of this block */
    uint16_t decay_q16;
    uint8_t block_samples;      /* left in this block */
    uint8_t waveform;           /* FDVV_SYNTH_SILENT once it is over */
} fdvv_synth_voice;

/* Empty every slot. */
void fdvv_synth_init(fdvv_synth_bank *bank);

/* Store a slot; return 1, or 0 and change nothing if a number is out of range. */
uint8_t fdvv_synth_set(fdvv_synth_bank *bank, uint8_t index, const fdvv_synth_slot *slot);

/* Copy samples into the pool; return 1, or 0 and change nothing if they do not fit. */
uint8_t fdvv_synth_load(fdvv_synth_bank *bank, uint16_t at, const uint8_t *samples, uint8_t count);

/* Start a voice afresh, whatever it did before, in two parts because a command brings them one after the other:
 * which slot, silent if it is empty or unknown; then how strong, 255 being the slot's own amplitude and 0
 * silence. */
void fdvv_synth_choose(fdvv_synth_voice *voice, const fdvv_synth_bank *bank, uint8_t index);
void fdvv_synth_start(fdvv_synth_voice *voice, uint8_t strength);

/* End a voice at once. */
void fdvv_synth_stop(fdvv_synth_voice *voice);

/* Tell whether a voice is not over; one byte, so that an interrupt may end it meanwhile. */
static inline uint8_t fdvv_synth_playing(const fdvv_synth_voice *voice) {
    return voice->waveform != FDVV_SYNTH_SILENT;
}

/* Give the next sample, 0 to 4095 and 2048 once the voice is over. */
uint16_t fdvv_synth_sample(fdvv_synth_voice *voice);

/* Give the next count samples. */
void fdvv_synth_render(fdvv_synth_voice *voice, uint16_t *samples, uint32_t count);

#endif
