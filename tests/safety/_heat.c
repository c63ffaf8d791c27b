/* The supervisor's thermal model beside the coil that the board was built for, under random legal settings, rewrites,
 * restarts, missed ticks and supplies. The coil is exact: T <- T + (end - T) (1 - exp(-tick / time)). */
#include <math.h>
#include <string.h>

#include "supervisor.h"

typedef struct {
    double end_K, heat_K, time_s;
    const fdvv_board_limits *limits;
} coil;

typedef struct {
    int64_t ticks;
    double least_margin_K; /* model less coil */
    double hottest_K;      /* coil */
    double mean_margin_K;
} heat_result;

int safety_heat(uint32_t seed, int scenes, double scene_s, const fdvv_board_limits *limits, heat_result *result);

static uint32_t draw(uint32_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 17;
    *state ^= *state << 5;
    return *state;
}

static int32_t between(uint32_t *state, int32_t low, int32_t high)
{
    return low + (int32_t)(draw(state) % (uint32_t)(high - low + 1));
}

/* Mostly an end of the range, where the defects are. */
static int32_t edge(uint32_t *state, int32_t low, int32_t high)
{
    uint32_t which = draw(state) % 4;
    return which == 0 ? low : which == 1 ? high : between(state, low, high);
}

/* Any settings that the board accepts, as far as they have to do with heat. */
static fdvv_settings draw_settings(uint32_t *state, const fdvv_board_limits *limits)
{
    static const fdvv_settings defaults = FDVV_SETTINGS_DEFAULTS;
    fdvv_settings settings = defaults;
    settings.tick_us = (uint16_t)(draw(state) % 16 ? 1000 : edge(state, limits->tick_low_us, limits->tick_high_us));
    settings.heat_time_ms = (uint32_t)edge(state, 100, draw(state) % 2 ? 600000 : 2000);
    settings.full_duty_rise_K = (uint16_t)edge(state, 1, draw(state) % 2 ? 20000 : 1000);
    settings.heat_limit_K = (uint16_t)edge(state, 2, 600);
    settings.derate_start_K = 1;
    settings.force_limit_cN64 = (int16_t)edge(state, 64, 32000);
    settings.duty_gain_q16 = edge(state, 64, 65535);
    settings.nominal_supply_mV = (uint16_t)edge(state, 3000, 36000);
    settings.supply_high_mV = (uint16_t)edge(state, 9001, 40000);
    fdvv_settings_tighten(&settings, limits);
    return settings;
}

static void load_coil(coil *it, int16_t duty_q15, uint16_t supply_mV)
{
    double nominal = it->limits->nominal_supply_mV, volts = supply_mV > nominal ? supply_mV / nominal : 1.0;
    double drive = duty_q15 / 32768.0 * volts;
    it->end_K = it->limits->full_duty_rise_K * drive * drive;
}

static double heat_of(const fdvv_supervisor *me)
{
    return ldexp((double)me->heat_K_q16, -16) + ldexp((double)me->heat_rest_q48, -48);
}

/* A stopped board: the coil keeps its duty until the watchdog resets the board, if that is less than the kelvin. */
static void restart(fdvv_supervisor *me, coil *it, const fdvv_settings *settings)
{
    double volts = (double)it->limits->supply_high_mV / it->limits->nominal_supply_mV, stopped_s = 8e-3;
    fdvv_kept_heat kept;
    fdvv_supervisor_keep_heat(me, &kept);
    if (it->limits->full_duty_rise_K * volts * volts * stopped_s < it->time_s)
        it->heat_K = it->end_K + (it->heat_K - it->end_K) * exp(-stopped_s / it->time_s);
    it->end_K = 0.0;
    fdvv_supervisor_init(me, it->limits);
    fdvv_supervisor_settings(me, settings);
    fdvv_supervisor_resume_heat(me, &kept, 0);
}

/* One scene; returns 0 where the model was cooler than the coil, or settings were refused. */
static int play(uint32_t *state, double scene_s, const fdvv_board_limits *limits, heat_result *result)
{
    fdvv_supervisor me;
    fdvv_settings settings = draw_settings(state, limits);
    coil it = {0.0, 0.0, limits->heat_time_ms * 1e-3, limits};
    double time_s = 0.0;
    fdvv_supervisor_init(&me, limits);
    fdvv_supervisor_settings(&me, &settings);
    while (time_s < scene_s) {
        double tick_s = settings.tick_us * 1e-6, keep = exp(-tick_s / it.time_s);
        int16_t duty_q15 = (int16_t)(draw(state) % 3 ? between(state, -32768, 32767) : draw(state) % 2 ? -32768 : 0);
        uint16_t supply_mV = (uint16_t)between(state, settings.supply_low_mV, settings.supply_high_mV);
        int32_t ticks = between(state, 1, draw(state) % 2 ? 200 : 8000);
        if (fdvv_settings_check(&settings, limits))
            return 0;
        for (; ticks; ticks--) {
            uint16_t elapsed = (uint16_t)(draw(state) % 1024 ? 1 : between(state, 2, 600));
            if (elapsed > 1)
                it.heat_K = it.end_K + (it.heat_K - it.end_K) * exp(-(elapsed - 1) * tick_s / it.time_s);
            load_coil(&it, duty_q15, supply_mV);
            it.heat_K = it.end_K + (it.heat_K - it.end_K) * keep;
            fdvv_supervisor_heat(&me, duty_q15, supply_mV, elapsed);
            double margin_K = heat_of(&me) - it.heat_K;
            result->ticks++;
            result->mean_margin_K += margin_K;
            if (margin_K < result->least_margin_K)
                result->least_margin_K = margin_K;
            if (it.heat_K > result->hottest_K)
                result->hottest_K = it.heat_K;
            if (margin_K < -1e-9) /* the coil itself is reckoned in doubles */
                return 0;
            time_s += elapsed * tick_s;
        }
        if (draw(state) % 8 == 0)
            restart(&me, &it, &settings);
        if (draw(state) % 4 == 0) {
            settings = draw_settings(state, limits);
            fdvv_supervisor_settings(&me, &settings);
        }
    }
    return 1;
}

/* Play so many scenes; returns how many went well before one did not. */
int safety_heat(uint32_t seed, int scenes, double scene_s, const fdvv_board_limits *limits, heat_result *result)
{
    int i;
    memset(result, 0, sizeof *result);
    for (i = 0; i < scenes; i++) {
        uint32_t state = (seed + (uint32_t)i) * 2654435761u | 1u;
        if (!play(&state, scene_s, limits, result))
            break;
    }
    if (result->ticks)
        result->mean_margin_K /= (double)result->ticks;
    return i;
}
