#include "core.h"

#ifdef FDVV_FORCE_LOOP
#include "core_loop.h"
#else
/* a board without a floating-point unit renders by tables */
#define is_closed(core) 0
#define fdvv_core_close_loop(core, gains) ((void)0)
#define estimate(core, force_counts, force_cN64) ((void)0)
#define see_estimates(core, in) ((void)0)
#define close_cN64(core, in) 0
#define open_cN64(core, force_cN64) (force_cN64)
#define advance(core) ((void)0)
#define fill_estimates(core, record) ((void)0)
#endif

/* Servo pulse for the travel of the program, rounded to nearest, within the range of servos. */
static uint16_t stop_pulse_us(const fdvv_settings *settings, const uint8_t *image)
{
    int32_t offset_us16000;
    if (!image)
        return settings->stop_zero_us;
    offset_us16000 = settings->stop_us_mm * fdvv_image_head(image)->travel_um16;
    offset_us16000 += offset_us16000 < 0 ? -8000 : 8000;
    return (uint16_t)fdvv_clamp(settings->stop_zero_us + offset_us16000 / 16000, 400, 2600);
}

void fdvv_core_init(fdvv_core *core, const fdvv_settings *settings, const fdvv_board_limits *limits)
{
    fdvv_supervisor_init(&core->supervisor, limits);
    core->image = 0;
    core->events = 0;
    fdvv_core_set(core, settings);
}

void fdvv_core_set(fdvv_core *core, const fdvv_settings *settings)
{
    core->settings = *settings;
    fdvv_supervisor_settings(&core->supervisor, &core->settings);
    core->announced_mm_s16 = settings->announced_mm_s16;
    core->command_cN64 = core->resistance_cN64 = 0;
    /* duty per force at 1 mV of supply */
    core->drive = fdvv_ratio_product(fdvv_ratio_of((uint32_t)settings->duty_gain_q16),
                                     fdvv_ratio_of(settings->nominal_supply_mV));
    core->drive.shift = (int16_t)(core->drive.shift + 16);
    core->stop_us = stop_pulse_us(settings, core->image);
    fdvv_position_init(&core->position);
    fdvv_velocity_init(&core->velocity, settings);
    fdvv_predictor_init(&core->predictor, settings);
    fdvv_core_close_loop(core, 0);
    fdvv_machine_init(&core->machine, settings);
}

void fdvv_core_activate(fdvv_core *core, const uint8_t *image)
{
    core->image = image;
    core->stop_us = stop_pulse_us(&core->settings, image);
    fdvv_machine_stop(&core->machine);
}

void fdvv_core_event(fdvv_core *core, uint8_t event)
{
    core->events |= (uint32_t)1 << (event & 31);
}

void fdvv_core_announce(fdvv_core *core, uint16_t velocity_mm_s16)
{
    core->announced_mm_s16 = velocity_mm_s16;
}

/* counts * gain >> 14. The gain is split into a * 2^9 + b, so that 32 bits are enough. */
static int16_t keycap_force_cN64(const fdvv_settings *settings, uint16_t counts)
{
    int32_t net_counts = (int32_t)counts - settings->force_offset_counts, gain = settings->force_gain_q14;
    int32_t coarse = net_counts * (gain >> 9), fine = net_counts * (gain & 511);
    return (int16_t)fdvv_clamp((coarse + (fine >> 9)) >> 5, -INT16_MAX, INT16_MAX);
}

/* Limit, rate-limit, limit again: the command follows a falling limit at once. Returns the flags it sets. */
static uint8_t limit_command(fdvv_core *core, int32_t requested_cN64, int32_t limit_cN64)
{
    int32_t last_cN64 = core->command_cN64, slew_cN64 = core->settings.slew_cN64_tick;
    int32_t limited_cN64 = fdvv_clamp(requested_cN64, -limit_cN64, limit_cN64);
    int32_t slewed_cN64 = fdvv_clamp(limited_cN64, last_cN64 - slew_cN64, last_cN64 + slew_cN64);
    int32_t command_cN64 = fdvv_clamp(slewed_cN64, -limit_cN64, limit_cN64);
    uint8_t flags = slewed_cN64 != limited_cN64 ? FDVV_TICK_FLAG_SLEWED : 0;
    if (limited_cN64 != requested_cN64 || command_cN64 != slewed_cN64)
        flags |= limit_cN64 < core->settings.force_limit_cN64 ? FDVV_TICK_FLAG_DERATED : FDVV_TICK_FLAG_LIMITED;
    core->command_cN64 = (int16_t)command_cN64;
    return flags;
}

/* Duty for the commanded force at the supply voltage of this tick, clamped to its valid range. Returns the flags it
 * sets. */
static uint8_t compute_duty(const fdvv_core *core, uint16_t supply_mV, int16_t *duty_q15)
{
    const fdvv_settings *settings = &core->settings;
    int32_t limit = settings->duty_limit_q15, duty;
    uint32_t supply = (uint32_t)fdvv_clamp(supply_mV, settings->supply_low_mV, settings->supply_high_mV);
    /* from 64 / 65536 * 3000 / 57000 to 384 Q15 per cN64: shifts from 30 to 7 */
    duty = fdvv_scale_short(core->command_cN64,
                            fdvv_ratio_product(core->drive, fdvv_ratio_inverse(fdvv_ratio_of(supply))));
    *duty_q15 = (int16_t)fdvv_clamp(duty, -limit, limit);
    return *duty_q15 != duty ? FDVV_TICK_FLAG_LIMITED : 0;
}

/* Predict the displacement at which the surface is evaluated, and the drag and friction to compensate. A fade starts
 * from the program's own force, which excludes the compensation. */
static void predict(fdvv_core *core, fdvv_machine_inputs *in)
{
    int32_t resistance_cN64;
    in->ahead_um16 = core->position.um16;
    in->command_cN64 = core->command_cN64;
    if (is_closed(core)) {
        see_estimates(core, in);
        return;
    }
    if (!core->predictor.enabled)
        return;
    in->ahead_um16 = fdvv_predictor_ahead_um16(&core->predictor);
    in->command_cN64 = (int16_t)fdvv_clamp(core->command_cN64 + core->resistance_cN64, -INT16_MAX, INT16_MAX);
    resistance_cN64 = fdvv_predictor_resistance_cN64(&core->predictor);
    core->resistance_cN64 = (int16_t)fdvv_clamp(resistance_cN64, -INT16_MAX, INT16_MAX);
}

/* Force of the program as a command. */
static int32_t requested_cN64(fdvv_core *core, fdvv_machine_inputs *in)
{
    if (is_closed(core))
        return close_cN64(core, in);
    return open_cN64(core, fdvv_machine_force_cN64(&core->machine, core->image, in)) - core->resistance_cN64;
}

/* One tick of a program. Returns the flags it sets. */
static uint8_t render(fdvv_core *core, const fdvv_inputs *inputs, uint16_t elapsed_ticks, int32_t limit_cN64,
                      fdvv_outputs *outputs)
{
    fdvv_machine *machine = &core->machine;
    const fdvv_state *state;
    fdvv_machine_inputs in;
    uint8_t flags;
    in.position = &core->position;
    in.velocity = &core->velocity;
    in.elapsed_us = (uint32_t)elapsed_ticks * core->settings.tick_us;
    in.events = core->events;
    in.announced_mm_s16 = core->announced_mm_s16;
    predict(core, &in);
    fdvv_machine_tick(machine, core->image, &in);
    state = machine->now;
    flags = limit_command(core, requested_cN64(core, &in), limit_cN64);
    flags |= compute_duty(core, inputs->supply_mV, &outputs->duty_q15);
    outputs->enable = 1;
    outputs->slot = machine->slot;
    outputs->key = state->key;
    if (state->key)
        flags |= FDVV_TICK_FLAG_KEY_DOWN;
    if (machine->slot != FDVV_NONE)
        flags |= FDVV_TICK_FLAG_VIBRATED;
    if (state->velocity_source == FDVV_VELOCITY_SOURCE_DECIDED ? core->velocity.decided
        : state->velocity_source == FDVV_VELOCITY_SOURCE_CONTINUOUS && core->velocity.continuous)
        flags |= FDVV_TICK_FLAG_VELOCITY_KNOWN;
    return flags;
}

/* Zero force immediately. */
static void stop_rendering(fdvv_core *core, fdvv_outputs *outputs)
{
    fdvv_machine_stop(&core->machine);
    core->command_cN64 = core->resistance_cN64 = 0;
    outputs->duty_q15 = 0;
    outputs->enable = 0;
    outputs->slot = FDVV_NONE;
    outputs->key = 0;
}

static void fill_record(const fdvv_core *core, uint8_t flags, int16_t force_cN64, fdvv_tick_record *record)
{
    record->displacement_um16 = core->position.um16;
    record->velocity_mm_s16 = core->velocity.continuous_mm_s16;
    record->commanded_cN64 = core->command_cN64;
    record->force_cN64 = force_cN64;
    record->state = core->machine.state;
    record->flags = flags;
    fill_estimates(core, record);
}

void fdvv_core_tick(fdvv_core *core, const fdvv_inputs *inputs, fdvv_outputs *outputs)
{
    const fdvv_settings *settings = &core->settings;
    fdvv_supervisor *supervisor = &core->supervisor;
    uint16_t elapsed_ticks = inputs->elapsed_ticks ? inputs->elapsed_ticks : 1;
    int16_t force_cN64 = keycap_force_cN64(settings, inputs->force_counts), limit_cN64;
    uint8_t flags = 0;
    fdvv_position_tick(&core->position, settings, inputs->sum);
    fdvv_velocity_tick(&core->velocity, settings, &core->position, elapsed_ticks);
    if (core->predictor.enabled)
        fdvv_predictor_tick(&core->predictor, core->position.um16, elapsed_ticks);
    estimate(core, inputs->force_counts, force_cN64);
    fdvv_supervisor_check(supervisor, settings, inputs, core->position.um16, force_cN64, core->command_cN64,
                          core->machine.state);
    limit_cN64 = fdvv_supervisor_limit_cN64(supervisor, settings);
    if (core->image && (supervisor->mode == FDVV_MODE_ARMED || supervisor->mode == FDVV_MODE_DERATED))
        flags = render(core, inputs, elapsed_ticks, limit_cN64, outputs);
    else
        stop_rendering(core, outputs);
    core->events = 0;
    advance(core);
    fdvv_heat_tick(&supervisor->heat, outputs->duty_q15, inputs->supply_mV, elapsed_ticks);
    if (core->position.release)
        flags |= FDVV_TICK_FLAG_RELEASE;
    if (elapsed_ticks > 1)
        flags |= FDVV_TICK_FLAG_LATE;
    outputs->stop_us = core->stop_us;
    outputs->mode = supervisor->mode;
    fill_record(core, flags, force_cN64, &outputs->record);
}

void fdvv_core_after_tick(fdvv_core *core, const fdvv_inputs *inputs)
{
#ifdef FDVV_NO_THERMISTOR
    (void)core, (void)inputs;
#else
    fdvv_heat_thermistor(&core->supervisor.heat, inputs->thermistor_counts, inputs->elapsed_ticks);
#endif
}
