/* How the core closes the force loop, on boards with a floating-point unit; included by core.c alone. */
#ifndef FDVV_CORE_LOOP_H
#define FDVV_CORE_LOOP_H

#include "core.h"

static float newtons(int32_t cN64) { return (float)cN64 * (1.0f / 6400.0f); }

static float metres(int32_t um16) { return (float)um16 * (1.0f / 16e6f); }

/* Rounded to nearest, between the limits; 0 for what is not a number. Processors convert a value that the integer
 * cannot hold each in its own way. */
static int32_t rounded(float value, float limit)
{
    if (value != value)
        return 0;
    value = value < -limit ? -limit : value > limit ? limit : value;
    return (int32_t)(value < 0.0f ? value - 0.5f : value + 0.5f);
}

static int16_t short_cN64(float force_N) { return (int16_t)rounded(6400.0f * force_N, INT16_MAX); }

/* The limit is beyond every displacement that a reading gives (position.h). */
static int32_t um16(float displacement_m) { return rounded(16e6f * displacement_m, 1048576.0f); }

static float travel_m(const fdvv_core *core)
{
    return core->image ? metres(fdvv_image_head(core->image)->travel_um16) : 1.0f;
}

static uint8_t is_closed(const fdvv_core *core) { return fdvv_force_loop_is_closed(&core->loop); }

void fdvv_core_close_loop(fdvv_core *core, const fdvv_force_loop_gains *gains)
{
    fdvv_force_loop_init(&core->loop, gains);
}

uint8_t fdvv_core_loop_fault(const fdvv_core *core) { return fdvv_force_loop_fault(&core->loop); }

/* A fault opens the loop for good, the loss of the host among them. While nothing is rendered the cap lies where its
 * weight holds it, which the estimator does not know. */
static uint8_t may_estimate(fdvv_core *core)
{
    uint8_t mode = core->supervisor.mode;
    if (mode == FDVV_MODE_FAULT)
        fdvv_force_loop_open(&core->loop);
    if (!core->loop.enabled)
        return 0;
    if (mode != FDVV_MODE_ARMED && mode != FDVV_MODE_DERATED)
        fdvv_force_loop_rest(&core->loop);
    return mode == FDVV_MODE_ARMED || mode == FDVV_MODE_DERATED;
}

static void estimate(fdvv_core *core, uint16_t force_counts, int16_t force_cN64)
{
    if (!may_estimate(core))
        return;
    fdvv_force_loop_watch(&core->loop, force_counts, core->settings.force_offset_counts);
    fdvv_force_loop_estimate(&core->loop, metres(core->position.um16), newtons(force_cN64), travel_m(core));
}

/* Conditions look at the estimated displacement, which has no lag, and a fade starts from the last target. */
static void see_estimates(fdvv_core *core, fdvv_machine_inputs *in)
{
    core->position.um16 = um16(core->loop.x_m);
    in->command_cN64 = short_cN64(core->loop.target_N);
}

/* The program's force of one stroke at a displacement. */
static float stroke_N(fdvv_core *core, fdvv_machine_inputs *in, float at_m, uint8_t release)
{
    uint8_t before = core->position.release;
    float force_N;
    in->ahead_um16 = um16(at_m);
    core->position.release = release;
    force_N = newtons(fdvv_machine_force_cN64(&core->machine, core->image, in));
    core->position.release = before;
    return force_N;
}

/* The program's force at a displacement: of one stroke, or between both after a turn. */
static float force_N(fdvv_core *core, fdvv_machine_inputs *in, float at_m)
{
    float weight = fdvv_force_loop_release_at(&core->loop, at_m);
    float press_N = weight < 1.0f ? stroke_N(core, in, at_m, 0) : 0.0f;
    float release_N = weight > 0.0f ? stroke_N(core, in, at_m, 1) : 0.0f;
    return press_N + weight * (release_N - press_N);
}

/* The program's force where the drive acts, and at the present displacement, turned into a command. */
static int32_t close_cN64(fdvv_core *core, fdvv_machine_inputs *in)
{
    fdvv_force_loop *loop = &core->loop;
    float press_N = stroke_N(core, in, loop->x_m, 0), release_N = stroke_N(core, in, loop->x_m, 1);
    float now_N, ahead_N;
    fdvv_force_loop_turn(loop, press_N - release_N, metres(core->settings.reversal_um16), travel_m(core));
    now_N = press_N + loop->release * (release_N - press_N);
    ahead_N = force_N(core, in, fdvv_force_loop_ahead_m(loop));
    fdvv_force_loop_enter(loop, core->machine.state, now_N);
    return short_cN64(fdvv_force_loop_command_N(loop, ahead_N, now_N, travel_m(core)));
}

static int32_t open_cN64(const fdvv_core *core, int16_t force_cN64)
{
    if (!core->loop.enabled)
        return force_cN64;
    return short_cN64(fdvv_force_loop_open_N(&core->loop, newtons(force_cN64), metres(core->position.um16)));
}

static void advance(fdvv_core *core)
{
    if (core->loop.enabled && core->loop.started)
        fdvv_force_loop_predict(&core->loop, newtons(core->command_cN64));
}

/* The estimates have no lag, and their force is the finger's, without the inertia of the plate. */
static void fill_estimates(const fdvv_core *core, fdvv_tick_record *record)
{
    if (!is_closed(core) || !core->loop.started)
        return;
    record->displacement_um16 = um16(core->loop.x_m);
    record->force_cN64 = short_cN64(core->loop.force_N);
}

#endif
