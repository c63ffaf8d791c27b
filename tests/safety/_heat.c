/* The supervisor's bound on the heat beside the coil that the board was built for, under random legal settings, rewrites,
 * restarts, missed ticks and supplies. The coil is exact: T <- T + (end - T) (1 - exp(-tick / time)). A thermistor follows
 * it with any lag and share that the board allows, in any room from 15 C on, with parts of 1 % and noise; its wire may
 * break at times. In guarded scenes the force is the one that the supervisor allows, and the power is cut at times. */
#include <math.h>
#include <string.h>

#include "supervisor.h"

typedef struct {
    double end_K, heat_K, time_s;
    double bead_K, lag_s, share, room_C, r25_ohm, beta_K, pull_up_ohm; /* of the thermistor */
    const fdvv_board_limits *limits;
} coil;

typedef struct {
    int64_t ticks;
    double least_margin_K; /* model less coil */
    double hottest_K;      /* coil */
    double mean_margin_K;
} heat_result;

int safety_heat(uint32_t seed, int scenes, double scene_s, int is_guarded, const fdvv_board_limits *limits,
                heat_result *result);

double safety_recovery_s(const fdvv_settings *settings, const fdvv_board_limits *limits, int counts);

double safety_late_K(const fdvv_settings *settings, const fdvv_board_limits *limits);

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

static double ratio(uint32_t *state, double low, double high)
{
    return low + (high - low) * between(state, 0, 1000) / 1000.0;
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
    settings.duty_gain_q16 = edge(state, 64, 1048576);
    settings.nominal_supply_mV = (uint16_t)edge(state, 3000, 48000);
    settings.supply_high_mV = (uint16_t)edge(state, 9001, 57000);
    fdvv_settings_tighten(&settings, limits);
    return settings;
}

/* The loosest that the board accepts but for the coil's time, of which it takes any. */
static fdvv_settings loosest(uint32_t *state, const fdvv_board_limits *limits)
{
    fdvv_settings settings = draw_settings(state, limits);
    settings.force_limit_cN64 = 32000;
    settings.duty_gain_q16 = 1048576;
    settings.nominal_supply_mV = limits->nominal_supply_mV;
    settings.supply_high_mV = 57000;
    settings.full_duty_rise_K = limits->full_duty_rise_K;
    settings.heat_limit_K = 600;
    fdvv_settings_tighten(&settings, limits);
    settings.derate_start_K = (uint16_t)edge(state, 1, settings.heat_limit_K - 1);
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
    return ldexp((double)me->heat.coil_K_q16, -16) + ldexp((double)me->heat.coil_rest_q48, -48);
}

/* Towards the end of the duty for so long. The bead is a little too late: it follows the coil of the start. */
static void warm(coil *it, double span_s)
{
    double way_K = it->share * it->heat_K - it->bead_K;
    if (it->limits->thermistor_lag_ms)
        it->bead_K += way_K * -expm1(-span_s / it->lag_s);
    it->heat_K = it->end_K + (it->heat_K - it->end_K) * exp(-span_s / it->time_s);
}

static coil draw_coil(uint32_t *state, const fdvv_board_limits *limits)
{
    double lag_s = limits->thermistor_lag_ms * 1e-3, share = limits->thermistor_share_q8 / 256.0;
    coil it = {0.0, 0.0, limits->heat_time_ms * 1e-3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, limits};
    it.lag_s = draw(state) % 2 ? lag_s : ratio(state, 0.25, 1.0) * lag_s;
    it.share = draw(state) % 2 ? share : ratio(state, share, 1.0);
    it.room_C = draw(state) % 2 ? 15.0 : ratio(state, 15.0, 40.0);
    it.r25_ohm = 1e4 * ratio(state, 0.99, 1.01);
    it.beta_K = 3435.0 * ratio(state, 0.99, 1.01);
    it.pull_up_ohm = 1e4 * ratio(state, 0.99, 1.01);
    return it;
}

static uint16_t counts_of(const coil *it, uint32_t *state)
{
    double ohm = it->r25_ohm * exp(it->beta_K * (1.0 / (it->room_C + it->bead_K + 273.15) - 1.0 / 298.15));
    double counts = 4096.0 * ohm / (ohm + it->pull_up_ohm) + ratio(state, -3.0, 3.0);
    if (draw(state) % 1024 == 0)
        return draw(state) % 2 ? 0 : 4095;
    return (uint16_t)(counts < 0.0 ? 0.0 : counts > 4095.0 ? 4095.0 : counts);
}

static void start(fdvv_supervisor *me, const coil *it, const fdvv_settings *settings, const fdvv_kept_heat *kept)
{
    fdvv_supervisor_init(me, it->limits);
    fdvv_supervisor_settings(me, settings);
    fdvv_heat_resume(&me->heat, it->limits, kept);
}

/* A stopped board: the coil keeps its duty until the watchdog resets the board, if that is less than the kelvin. */
static void restart(fdvv_supervisor *me, coil *it, const fdvv_settings *settings)
{
    double volts = (double)it->limits->supply_high_mV / it->limits->nominal_supply_mV, stopped_s = 8e-3;
    fdvv_kept_heat kept;
    fdvv_heat_keep(&me->heat, &kept);
    if (it->limits->full_duty_rise_K * volts * volts * stopped_s < it->time_s)
        warm(it, stopped_s);
    it->end_K = 0.0;
    start(me, it, settings, &kept);
}

/* The power is off for a moment or minutes, and nothing is kept. */
static void cut(fdvv_supervisor *me, coil *it, const fdvv_settings *settings, uint32_t *state)
{
    static const fdvv_kept_heat damaged = {0, 0};
    double off_s = draw(state) % 2 ? 0.0 : ratio(state, 0.0, 60.0);
    it->end_K = 0.0;
    while ((off_s -= 0.1) > 0.0)
        warm(it, 0.1);
    start(me, it, settings, &damaged);
}

/* The largest duty that the supervisor allows in this tick, as in core.c. */
static int32_t allowed_q15(fdvv_supervisor *me, const fdvv_settings *settings, uint16_t supply_mV)
{
    double duty;
    if (me->heat.thermistor.faults)
        return 0;
    me->mode = FDVV_MODE_ARMED;
    duty = fdvv_supervisor_limit_cN64(me, settings) * (settings->duty_gain_q16 / 65536.0) * settings->nominal_supply_mV /
           supply_mV;
    return duty > settings->duty_limit_q15 ? settings->duty_limit_q15 : (int32_t)ceil(duty);
}

/* One scene; returns 0 where the bound was cooler than the coil, a guarded coil too warm, or settings were refused. */
static int play(uint32_t *state, double scene_s, int is_guarded, const fdvv_board_limits *limits, heat_result *result)
{
    static const fdvv_kept_heat cold = {0, UINT32_MAX};
    fdvv_supervisor me;
    fdvv_settings settings = is_guarded ? loosest(state, limits) : draw_settings(state, limits);
    coil it = draw_coil(state, limits);
    double time_s = 0.0;
    start(&me, &it, &settings, &cold);
    while (time_s < scene_s) {
        double tick_s = settings.tick_us * 1e-6;
        int32_t duty_q15 = draw(state) % 3 ? between(state, -32768, 32767) : draw(state) % 2 ? -32768 : 0;
        if (is_guarded && draw(state) % 8)
            duty_q15 = 32767;
        uint16_t supply_mV = (uint16_t)between(state, settings.supply_low_mV, settings.supply_high_mV);
        int32_t ticks = between(state, 1, draw(state) % 2 ? 200 : 8000), longest = is_guarded ? 8000 / settings.tick_us : 600;
        if (fdvv_settings_check(&settings, limits))
            return 0;
        for (; ticks; ticks--) {
            uint16_t elapsed = (uint16_t)(draw(state) % 1024 ? 1 : between(state, 2, longest));
            int32_t now_q15 = duty_q15, most_q15 = is_guarded ? allowed_q15(&me, &settings, supply_mV) : 32768;
            now_q15 = now_q15 > most_q15 ? most_q15 : now_q15 < -most_q15 ? -most_q15 : now_q15;
            if (elapsed > 1)
                warm(&it, (elapsed - 1) * tick_s);
            load_coil(&it, (int16_t)now_q15, supply_mV);
            warm(&it, tick_s);
            fdvv_heat_tick(&me.heat, (int16_t)now_q15, supply_mV, elapsed);
            if (limits->thermistor_lag_ms)
                fdvv_heat_thermistor(&me.heat, me.heat.thermistor.ticks + elapsed < 100 ? 0 : counts_of(&it, state), elapsed);
            double margin_K = heat_of(&me) - it.heat_K;
            result->ticks++;
            result->mean_margin_K += margin_K;
            if (margin_K < result->least_margin_K)
                result->least_margin_K = margin_K;
            if (it.heat_K > result->hottest_K)
                result->hottest_K = it.heat_K;
            if (margin_K < -1e-9 || (is_guarded && it.heat_K > limits->heat_limit_K)) /* the coil is reckoned in doubles */
                return 0;
            time_s += elapsed * tick_s;
        }
        if (draw(state) % 8 == 0)
            restart(&me, &it, &settings);
        if (is_guarded && draw(state) % 32 == 0)
            cut(&me, &it, &settings, state);
        if (draw(state) % 4 == 0) {
            settings = is_guarded && draw(state) % 8 ? loosest(state, limits) : draw_settings(state, limits);
            fdvv_supervisor_settings(&me, &settings);
        }
    }
    return 1;
}

/* Seconds after a power cut until a cold coil, whose thermistor gives these counts, has its whole force back. */
double safety_recovery_s(const fdvv_settings *settings, const fdvv_board_limits *limits, int counts)
{
    static const fdvv_kept_heat nothing = {0, 0};
    coil it = {0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, limits};
    fdvv_supervisor me;
    int32_t ticks;
    start(&me, &it, settings, &nothing);
    for (ticks = 0; ticks < 1000000; ticks++) {
        me.mode = FDVV_MODE_ARMED;
        if (fdvv_supervisor_limit_cN64(&me, settings) == settings->force_limit_cN64)
            break;
        fdvv_heat_tick(&me.heat, 0, limits->nominal_supply_mV, 1);
        fdvv_heat_thermistor(&me.heat, (uint16_t)counts, 1);
    }
    return ticks * 1e-6 * settings->tick_us;
}

/* The hottest that the coil gets where all force that is allowed is used, and every tick is late by as much as the watchdog
 * lets it be. */
double safety_late_K(const fdvv_settings *settings, const fdvv_board_limits *limits)
{
    static const fdvv_kept_heat cold = {0, UINT32_MAX};
    coil it = {0.0, 0.0, limits->heat_time_ms * 1e-3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, limits};
    uint16_t supply_mV = settings->supply_high_mV;
    double hottest_K = 0.0, tick_s = settings->tick_us * 1e-6, time_s;
    fdvv_supervisor me;
    start(&me, &it, settings, &cold);
    for (time_s = 0.0; time_s < it.time_s; time_s += 8e-3) {
        int16_t duty_q15 = (int16_t)allowed_q15(&me, settings, supply_mV);
        warm(&it, 8e-3 - tick_s);
        load_coil(&it, duty_q15, supply_mV);
        warm(&it, tick_s);
        hottest_K = it.heat_K > hottest_K ? it.heat_K : hottest_K;
        fdvv_heat_tick(&me.heat, duty_q15, supply_mV, (uint16_t)lround(8e-3 / tick_s));
    }
    return hottest_K;
}

/* Play so many scenes; returns how many went well before one did not. */
int safety_heat(uint32_t seed, int scenes, double scene_s, int is_guarded, const fdvv_board_limits *limits,
                heat_result *result)
{
    int i;
    memset(result, 0, sizeof *result);
    for (i = 0; i < scenes; i++) {
        uint32_t state = (seed + (uint32_t)i) * 2654435761u | 1u;
        if (!play(&state, scene_s, is_guarded, limits, result))
            break;
    }
    if (result->ticks)
        result->mean_margin_K /= (double)result->ticks;
    return i;
}
