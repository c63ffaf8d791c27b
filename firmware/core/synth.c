#include "synth.h"

#include "synth_sine.h"

/* added to a product it gives a non-negative number, which can be shifted as unsigned */
#define MIDDLE_AND_HALF ((int32_t)FDVV_SYNTH_SILENCE * 131072 + 65536)

void fdvv_synth_init(fdvv_synth_bank *bank) {
    for (uint8_t i = 0; i < FDVV_SYNTH_SLOTS; i++) bank->slots[i].duration_samples = 0;
}

static uint8_t wave_fits(const fdvv_synth_slot *slot) {
    return slot->wave_samples >= 1 && slot->wave_samples <= FDVV_SYNTH_WAVE_SAMPLES &&
           slot->wave_at <= FDVV_SYNTH_POOL_BYTES - slot->wave_samples;
}

/* 2^32 / 256000 = 16777.216, the sixteenth-hertz of one turn; 0.216 = 14156 / 65536 */
static uint32_t turn_increment(uint16_t frequency_Hz16) {
    return (uint32_t)frequency_Hz16 * 16777u + (((uint32_t)frequency_Hz16 * 14156u) >> 16);
}

/* 2^16 / 256000, truncated: at most 1.3 samples of the wave late after the longest duration */
static uint32_t wave_increment(uint16_t rate_Hz16) {
    return ((uint32_t)rate_Hz16 * 16777u) >> 16;
}

uint8_t fdvv_synth_set(fdvv_synth_bank *bank, uint8_t index, const fdvv_synth_slot *slot) {
    if (index >= FDVV_SYNTH_SLOTS || slot->waveform > FDVV_SYNTH_SAMPLED) return 0;
    if (slot->amplitude_counts > FDVV_SYNTH_AMPLITUDE_MAX) return 0;
    if (slot->waveform == FDVV_SYNTH_SAMPLED && !wave_fits(slot)) return 0;
    bank->slots[index] = *slot;
    bank->increments[index] = slot->waveform == FDVV_SYNTH_SAMPLED ? wave_increment(slot->frequency_Hz16)
                                                                   : turn_increment(slot->frequency_Hz16);
    return 1;
}

uint8_t fdvv_synth_load(fdvv_synth_bank *bank, uint16_t at, const uint8_t *samples, uint8_t count) {
    if (count == 0 || at > FDVV_SYNTH_POOL_BYTES - count) return 0;
    for (uint8_t i = 0; i < count; i++)
        bank->pool[at + i] = (int8_t)(samples[i] < 128 ? samples[i] : samples[i] - 256);
    return 1;
}

static void begin_block(fdvv_synth_voice *voice) {
    const uint16_t start_q5 = voice->amplitude_q5;
    voice->block_samples = FDVV_SYNTH_BLOCK_SAMPLES;
    voice->block_end_q5 = start_q5;
    if (voice->decay_q16 != FDVV_SYNTH_STEADY_Q16)
        voice->block_end_q5 = (uint16_t)(((uint32_t)start_q5 * voice->decay_q16 + 32768u) >> 16);
    voice->step_q5 = (uint16_t)(start_q5 - voice->block_end_q5) / FDVV_SYNTH_BLOCK_SAMPLES;
}

void fdvv_synth_choose(fdvv_synth_voice *voice, const fdvv_synth_bank *bank, uint8_t index) {
    fdvv_synth_stop(voice);
    if (index >= FDVV_SYNTH_SLOTS || bank->slots[index].duration_samples == 0) return;
    const fdvv_synth_slot *slot = &bank->slots[index];
    voice->increment = bank->increments[index];
    voice->phase = voice->increment >> 1;
    voice->wave = &bank->pool[slot->waveform == FDVV_SYNTH_SAMPLED ? slot->wave_at : 0];
    voice->wave_samples = slot->wave_samples;
    voice->remaining_samples = slot->duration_samples;
    voice->amplitude_q5 = (uint16_t)(slot->amplitude_counts << 5);
    voice->decay_q16 = slot->decay_q16;
    voice->waveform = slot->waveform;
}

void fdvv_synth_start(fdvv_synth_voice *voice, uint8_t strength) {
    /* 255 becomes 256, a factor of exactly one */
    const uint16_t strength_q8 = (uint16_t)(strength + (strength >> 7));
    voice->amplitude_q5 = (uint16_t)(((uint32_t)voice->amplitude_q5 * strength_q8) >> 8);
    begin_block(voice);
    if (!strength) fdvv_synth_stop(voice);
}

void fdvv_synth_stop(fdvv_synth_voice *voice) {
    voice->waveform = FDVV_SYNTH_SILENT;
}

static int16_t sine_q12(uint32_t phase) {
    const uint8_t index = (uint8_t)(phase >> 24), fraction_q8 = (uint8_t)(phase >> 16);
    const int16_t here = FDVV_SYNTH_SINE_Q12(index), next = FDVV_SYNTH_SINE_Q12((uint8_t)(index + 1u));
    const int16_t rise = (int16_t)((int16_t)(next - here) * (int16_t)fraction_q8); /* within 101 * 255 */
    return (int16_t)(here + (int16_t)((uint16_t)((uint16_t)rise + 32768u) >> 8) - 128);
}

static int16_t wave_q12(const fdvv_synth_voice *voice) {
    const uint16_t index = (uint16_t)(voice->phase >> 16);
    const uint8_t fraction_q7 = (uint8_t)((uint8_t)(voice->phase >> 8) >> 1);
    const int16_t here = voice->wave[index];
    const int16_t next = index + 1u < voice->wave_samples ? voice->wave[index + 1u] : 0;
    const int16_t rise = (int16_t)((int16_t)(next - here) * (int16_t)fraction_q7); /* within 255 * 127 */
    return (int16_t)((int16_t)((uint16_t)(here * 128 + rise + 16384) >> 2) - 4096);
}

static void advance(fdvv_synth_voice *voice) {
    voice->phase += voice->increment;
    voice->amplitude_q5 = (uint16_t)(voice->amplitude_q5 - voice->step_q5);
    if (--voice->block_samples == 0) {
        voice->amplitude_q5 = voice->block_end_q5;
        begin_block(voice);
    }
    if (--voice->remaining_samples == 0 ||
        (voice->waveform == FDVV_SYNTH_SAMPLED && (uint16_t)(voice->phase >> 16) >= voice->wave_samples))
        fdvv_synth_stop(voice);
}

uint16_t fdvv_synth_sample(fdvv_synth_voice *voice) {
    if (!fdvv_synth_playing(voice)) return FDVV_SYNTH_SILENCE;
    const int16_t shape_q12 = voice->waveform == FDVV_SYNTH_SINE ? sine_q12(voice->phase) : wave_q12(voice);
    const int32_t product_q17 = (int32_t)shape_q12 * voice->amplitude_q5; /* within 4096 * 65504 */
    const uint16_t sample = (uint16_t)((uint16_t)((uint32_t)(product_q17 + MIDDLE_AND_HALF) >> 16) >> 1);
    advance(voice);
    return sample;
}

void fdvv_synth_render(fdvv_synth_voice *voice, uint16_t *samples, uint32_t count) {
    for (uint32_t i = 0; i < count; i++) samples[i] = fdvv_synth_sample(voice);
}
