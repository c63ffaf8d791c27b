#include "machine.h"

#include "surface.h"

void fdvv_machine_init(fdvv_machine *machine, const fdvv_settings *settings)
{
    /* plus half a tick, because a crossing is detected half a tick late on average */
    uint32_t lead_us = settings->vibration_latency_us + ((uint32_t)settings->tick_us >> 1);
    machine->lead = fdvv_ratio_product(fdvv_ratio_of(lead_us), fdvv_ratio_inverse(fdvv_ratio_of(1000)));
    machine->state = 0;
    machine->ms = machine->us = machine->repeat_due_ms = 0;
    machine->deepest_um16 = machine->highest_um16 = 0;
    machine->reached_um16 = machine->next_um16 = 0;
    machine->from_cN64 = 0;
    fdvv_machine_stop(machine);
}

void fdvv_machine_stop(fdvv_machine *machine)
{
    machine->running = 0;
    machine->now = 0;
    machine->events = 0;
    machine->turned = 0;
    machine->slot = FDVV_NONE;
}

/* The velocity, never negative, that selects the force curve in the current state. */
static uint16_t selected_velocity_mm_s16(const fdvv_machine *machine, const fdvv_machine_inputs *in)
{
    const fdvv_velocity *velocity = in->velocity;
    uint8_t source = machine->now->velocity_source;
    if (source == FDVV_VELOCITY_SOURCE_CONTINUOUS)
        return (uint16_t)(velocity->continuous_mm_s16 < 0 ? -velocity->continuous_mm_s16
                                                          : velocity->continuous_mm_s16);
    if (source == FDVV_VELOCITY_SOURCE_DECIDED && velocity->decided)
        return velocity->decided_mm_s16;
    return in->announced_mm_s16;
}

static void enter(fdvv_machine *machine, const uint8_t *image, uint8_t state, const fdvv_machine_inputs *in)
{
    machine->state = state;
    machine->now = fdvv_image_state(image, state);
    machine->ms = machine->us = 0;
    machine->repeat_due_ms = machine->now->repeat_ms;
    machine->deepest_um16 = machine->highest_um16 = in->position->um16;
    machine->from_cN64 = in->command_cN64;
}

/* Move whole milliseconds from us to ms, without a division: at most 19 steps, even after missed ticks. */
static void advance_time(fdvv_machine *machine, uint32_t elapsed_us)
{
    uint32_t us = machine->us + elapsed_us, ms = machine->ms;
    int32_t step = us < 2000 ? 0 : us < 8000 ? 2 : us >> 26 ? 18 : 16;
    machine->us = us;
    if (us < 1000)
        return;
    for (; us >= 1000; step--)
        if (us >= 1000u << step) {
            us -= 1000u << step;
            ms += 1u << step;
        }
    machine->us = us;
    machine->ms = ms > INT32_MAX ? INT32_MAX : ms;
}

static void update_extremes(fdvv_machine *machine, int32_t displacement_um16)
{
    if (displacement_um16 > machine->deepest_um16)
        machine->deepest_um16 = displacement_um16;
    if (displacement_um16 < machine->highest_um16)
        machine->highest_um16 = displacement_um16;
}

/* Only the first slot of a tick is played. */
static void play(fdvv_machine *machine, uint8_t slot)
{
    if (machine->slot == FDVV_NONE)
        machine->slot = slot;
}

/* -- transitions ---------------------------------------------------------------------------------------- */

static uint8_t is_true(const fdvv_machine *machine, const fdvv_machine_inputs *in, int32_t velocity_mm_s16,
                       uint8_t condition, int32_t value)
{
    int32_t displacement_um16 = in->position->um16;
    switch (condition) {
    case FDVV_CONDITION_ALWAYS:
        return 1;
    case FDVV_CONDITION_DEEPER_THAN:
        return displacement_um16 > value;
    case FDVV_CONDITION_SHALLOWER_THAN:
        return displacement_um16 < value;
    case FDVV_CONDITION_TURNED_TO_PRESS:
        return machine->turned & FDVV_TURNED_TO_PRESS;
    case FDVV_CONDITION_TURNED_TO_RELEASE:
        return (machine->turned & FDVV_TURNED_TO_RELEASE) != 0;
    case FDVV_CONDITION_FASTER_THAN:
        return velocity_mm_s16 > value;
    case FDVV_CONDITION_SLOWER_THAN:
        return velocity_mm_s16 < value;
    case FDVV_CONDITION_AFTER_MS:
        return (int32_t)machine->ms >= value;
    case FDVV_CONDITION_HOST_EVENT:
        return value >= 0 && value < 32 && (machine->events >> value & 1u);
    case FDVV_CONDITION_RISEN_BY:
        return machine->deepest_um16 - displacement_um16 >= value;
    case FDVV_CONDITION_FALLEN_BY:
        return displacement_um16 - machine->highest_um16 >= value;
    default:
        return 0;
    }
}

/* A reversal or an event triggers one transition only. */
static void consume(fdvv_machine *machine, uint8_t condition, int32_t value)
{
    if (condition == FDVV_CONDITION_HOST_EVENT)
        machine->events &= ~((uint32_t)1 << (value & 31));
    else if (condition == FDVV_CONDITION_TURNED_TO_PRESS)
        machine->turned &= (uint8_t)~FDVV_TURNED_TO_PRESS;
    else if (condition == FDVV_CONDITION_TURNED_TO_RELEASE)
        machine->turned &= (uint8_t)~FDVV_TURNED_TO_RELEASE;
}

/* The first transition of the state whose condition and guard are true, or 0. */
static const fdvv_transition *find_transition(const fdvv_machine *machine, const uint8_t *image,
                                              const fdvv_machine_inputs *in)
{
    const fdvv_transition *transition;
    int32_t velocity_mm_s16;
    uint32_t left = machine->now->transitions;
    if (!left)
        return 0;
    velocity_mm_s16 = selected_velocity_mm_s16(machine, in);
    transition = fdvv_image_transition(image, machine->now->first_transition);
    for (; left; left--, transition++)
        if (is_true(machine, in, velocity_mm_s16, transition->condition, transition->value) &&
            (transition->guard == FDVV_CONDITION_ALWAYS ||
             is_true(machine, in, velocity_mm_s16, transition->guard, transition->guard_value)))
            return transition;
    return 0;
}

/* Make at most one transition. Reversals and events are valid in the tick in which they occur; after a transition,
 * those it did not consume remain valid for the new state. */
static void change_state(fdvv_machine *machine, const uint8_t *image, const fdvv_machine_inputs *in)
{
    const fdvv_transition *transition = find_transition(machine, image, in);
    if (!transition) {
        machine->events = 0;
        machine->turned = 0;
        return;
    }
    consume(machine, transition->condition, transition->value);
    consume(machine, transition->guard, transition->guard_value);
    enter(machine, image, transition->target, in);
    play(machine, transition->slot);
    play(machine, machine->now->enter_slot);
}

/* -- vibrations ----------------------------------------------------------------------------------------- */

static uint8_t applies(const fdvv_vibration *vibration, uint32_t state_bit, uint8_t other_stroke,
                       uint32_t velocity_mm_s16)
{
    return vibration->stroke != other_stroke && (vibration->states & state_bit) &&
           velocity_mm_s16 >= vibration->slowest_mm_s16 && velocity_mm_s16 < vibration->fastest_mm_s16;
}

/* Predicted displacement when a vibration started now begins to move; increases in the direction of the stroke. */
static int32_t look_ahead_um16(const fdvv_machine *machine, const fdvv_machine_inputs *in)
{
    int32_t ahead_um16 =
        in->position->um16 + fdvv_scale_short(in->velocity->continuous_mm_s16, machine->lead);
    return in->position->release ? -ahead_um16 : ahead_um16;
}

/* A stroke begins where the direction reversed, or where rendering started. */
static void begin_stroke(fdvv_machine *machine, const fdvv_machine_inputs *in)
{
    machine->reached_um16 = look_ahead_um16(machine, in);
    machine->next_um16 = INT32_MIN;
}

/* Start a vibration between the maximum reached in this stroke and the predicted displacement. The maximum only
 * increases, so no vibration starts twice in a stroke, and none that lies behind the reversal. */
static void start_vibrations(fdvv_machine *machine, const uint8_t *image, const fdvv_machine_inputs *in)
{
    int32_t ahead_um16 = look_ahead_um16(machine, in), reached_um16 = machine->reached_um16;
    int32_t next_um16 = INT32_MAX;
    const fdvv_vibration *vibration, *end;
    uint32_t velocity_mm_s16, state_bit = (uint32_t)1 << machine->state;
    uint8_t release = in->position->release, other_stroke = release ? FDVV_STROKE_PRESS : FDVV_STROKE_RELEASE;
    if (ahead_um16 <= reached_um16)
        return;
    machine->reached_um16 = ahead_um16;
    if (ahead_um16 < machine->next_um16)
        return;
    vibration = fdvv_image_vibration(image, 0);
    end = vibration + fdvv_image_head(image)->vibrations;
    velocity_mm_s16 = selected_velocity_mm_s16(machine, in);
    for (; vibration != end; vibration++) {
        int32_t at_um16 = release ? -vibration->at_um16 : vibration->at_um16;
        if (at_um16 > ahead_um16)
            next_um16 = at_um16 < next_um16 ? at_um16 : next_um16;
        else if (at_um16 > reached_um16 && machine->slot == FDVV_NONE &&
                 applies(vibration, state_bit, other_stroke, velocity_mm_s16))
            machine->slot = vibration->slot;
    }
    machine->next_um16 = next_um16;
}

static void repeat(fdvv_machine *machine)
{
    const fdvv_state *state = machine->now;
    if (state->repeat_slot == FDVV_NONE || !state->repeat_ms || machine->ms < machine->repeat_due_ms)
        return;
    play(machine, state->repeat_slot);
    machine->repeat_due_ms += state->repeat_ms;
    if (machine->repeat_due_ms <= machine->ms)
        machine->repeat_due_ms = machine->ms + state->repeat_ms;
}

void fdvv_machine_tick(fdvv_machine *machine, const uint8_t *image, const fdvv_machine_inputs *in)
{
    machine->slot = FDVV_NONE;
    if (!machine->running) {
        enter(machine, image, fdvv_image_head(image)->start_state, in);
        play(machine, machine->now->enter_slot);
        machine->running = 1;
        begin_stroke(machine, in);
    } else {
        advance_time(machine, in->elapsed_us);
        update_extremes(machine, in->position->um16);
        if (in->position->turned)
            begin_stroke(machine, in);
    }
    machine->turned |= in->position->turned;
    machine->events |= in->events;
    change_state(machine, image, in);
    start_vibrations(machine, image, in);
    repeat(machine);
}

/* -- force ---------------------------------------------------------------------------------------------- */

/* Time since the state was entered, as a fraction of a duration in Q15; at most 1. */
static int32_t progress_q15(const fdvv_machine *machine, uint16_t duration_ms)
{
    if (machine->ms >= duration_ms)
        return FDVV_ONE_Q15;
    return fdvv_fraction_q15(machine->ms * 1000u + machine->us, duration_ms * 1000u);
}

int16_t fdvv_machine_force_cN64(const fdvv_machine *machine, const uint8_t *image, const fdvv_machine_inputs *in)
{
    const fdvv_state *state = machine->now;
    const fdvv_surface *surface =
        fdvv_image_surface(image, in->position->release ? state->release_surface : state->press_surface);
    int32_t force_cN64 = fdvv_surface_force_cN64(surface, image, in->ahead_um16,
                                                 selected_velocity_mm_s16(machine, in));
    int32_t bias_cN64 = state->bias_cN64;
    if (state->bias_ms)
        bias_cN64 = fdvv_interpolate(bias_cN64, state->bias_end_cN64, progress_q15(machine, state->bias_ms));
    force_cN64 = fdvv_clamp(force_cN64 + bias_cN64, -INT16_MAX, INT16_MAX);
    if (state->fade_ms)
        force_cN64 = fdvv_interpolate(machine->from_cN64, force_cN64, progress_q15(machine, state->fade_ms));
    return (int16_t)force_cN64;
}
