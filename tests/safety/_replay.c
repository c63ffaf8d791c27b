/* Play a script of calls on the supervisor and compare what it does with what the script expects. */
#include <stdio.h>
#include <string.h>

#include "supervisor.h"

enum { INIT, SETTINGS, ASK, HOST, CHECK, FAULT, LIMIT, HEAT, THERMISTOR, RESUME, POKE_MODE, POKE_FAULTS };

typedef struct {
    uint32_t call, settings;           /* which call; number of the settings */
    int32_t a, b, c;                   /* its arguments */
    fdvv_inputs inputs;
    int32_t displacement_um16;
    int16_t force_cN64, commanded_cN64;
    uint8_t state, mode, fault, spare; /* from mode on: what is expected */
    uint32_t heat_K_q16, heat_rest_q48;
    int32_t gives;
    uint16_t faults, spare2;
    fdvv_evidence evidence;
} step;

int safety_replay(const step *steps, int count, const fdvv_settings *settings, const fdvv_board_limits *limits);

static int32_t play(fdvv_supervisor *me, const step *it, const fdvv_settings *settings, const fdvv_board_limits *limits)
{
    fdvv_kept_heat kept;
    switch (it->call) {
    case INIT: fdvv_supervisor_init(me, limits + it->a); return 0;
    case SETTINGS: fdvv_supervisor_settings(me, settings); return 0;
    case ASK: return fdvv_supervisor_ask(me, settings, (uint8_t)it->a, (uint8_t)it->b);
    case HOST: fdvv_supervisor_host_seen(me, (uint32_t)it->a); return 0;
    case CHECK:
        fdvv_supervisor_check(me, settings, &it->inputs, it->displacement_um16, it->force_cN64, it->commanded_cN64,
                              it->state);
        return 0;
    case FAULT: fdvv_supervisor_fault(me, (uint8_t)it->a, it->b, it->c); return 0;
    case LIMIT: return fdvv_supervisor_limit_cN64(me, settings);
    case HEAT: fdvv_heat_tick(&me->heat, (int16_t)it->a, (uint16_t)it->b, (uint16_t)it->c); return 0;
    case THERMISTOR:
        fdvv_heat_thermistor(&me->heat, (uint16_t)it->a, (uint16_t)it->b);
        return me->heat.thermistor.counts;
    case RESUME: /* a restart: keep, spoil by b and c, start anew */
        fdvv_heat_keep(&me->heat, &kept);
        kept.coil_K_q16 ^= (uint32_t)it->b;
        kept.check ^= (uint32_t)it->c;
        fdvv_supervisor_init(me, me->limits);
        fdvv_supervisor_settings(me, settings);
        fdvv_heat_resume(&me->heat, me->limits, &kept);
        return 0;
    case POKE_MODE: me->mode = (uint8_t)it->a; return 0;
    case POKE_FAULTS: me->faults = (uint16_t)it->a; return 0;
    default: return -1;
    }
}

/* Give the number of the first step that goes otherwise than expected, or count. */
int safety_replay(const step *steps, int count, const fdvv_settings *settings, const fdvv_board_limits *limits)
{
    fdvv_supervisor me;
    int i;
    memset(&me, 0xa5, sizeof me);
    for (i = 0; i < count; i++) {
        const step *it = &steps[i];
        int32_t gave = play(&me, it, &settings[it->settings], limits);
        if (gave != it->gives || me.mode != it->mode || me.fault != it->fault || me.faults != it->faults ||
            me.heat.coil_K_q16 != it->heat_K_q16 || me.heat.coil_rest_q48 != it->heat_rest_q48 || memcmp(&me.evidence, &it->evidence, sizeof me.evidence))
            return i;
    }
    return count;
}

#ifdef REPLAY_MAIN
#include <stdlib.h>

/* All that a file holds; ends the program where there is none. */
static void *contents(const char *name, long *bytes)
{
    FILE *file = fopen(name, "rb");
    void *memory;
    if (!file || fseek(file, 0, SEEK_END) || (*bytes = ftell(file)) < 1 || !(memory = malloc((size_t)*bytes)))
        exit(2);
    rewind(file);
    if (fread(memory, (size_t)*bytes, 1, file) != 1)
        exit(2);
    fclose(file);
    return memory;
}

typedef struct {
    fdvv_settings settings;
    fdvv_board_limits limits;
    fdvv_settings tightened;
    uint32_t refused;
} check;

static int check_goes(const check *it)
{
    fdvv_settings settings = it->settings;
    if (fdvv_settings_check(&settings, &it->limits) != it->refused)
        return 0;
    fdvv_settings_tighten(&settings, &it->limits);
    return !memcmp(&settings, &it->tightened, sizeof settings);
}

/* Files of settings, of steps, of limits and of checks; 0: all went as expected, 1: it did not. */
int main(int count, char **names)
{
    long settings_bytes, steps_bytes, limits_bytes, checks_bytes;
    const check *checks;
    fdvv_settings *settings;
    fdvv_board_limits *limits;
    step *steps;
    if (count != 5)
        return 2;
    settings = contents(names[1], &settings_bytes);
    steps = contents(names[2], &steps_bytes);
    limits = contents(names[3], &limits_bytes);
    checks = contents(names[4], &checks_bytes);
    for (count = (int)(checks_bytes / (long)sizeof(check)); count; count--)
        if (!check_goes(&checks[count - 1]))
            return 1;
    count = (int)(steps_bytes / (long)sizeof(step));
    return safety_replay(steps, count, settings, limits) != count;
}
#endif
