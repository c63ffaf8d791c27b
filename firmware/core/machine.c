#include "machine.h"

#include "surface.h"

void fdvv_machine_init(fdvv_machine *machine, const fdvv_settings *settings)
{
    /* half a tick, since crossings are noticed half a tick late on average */
    uint32_t lead_us = settings->vibration_latency_us + ((uint32_t)settings->tick_us >> 1);
    machine->lead = fdvv_ratio_product(fdvv_ratio_of(lead_us), fdvv_ratio_inverse(fdvv_ratio_of(1000)));
    machine->state = 0;
    machine->ms = machine->us = machine->repeat_due_ms = 0;
    machine->deepest_um16 = machine->highest_um16 = 0;
    machine->from_cN64 = 0;
    fdvv_machine_stop(machine);
}

void fdvv_machine_stop(fdvv_machine *machine)
{
    machine->running = 0;
    machine->events = machine->coming = machine->passed = 0;
    machine->turned = 0;
    machine->slot = FDVV_NONE;
}

static void enter(fdvv_machine *machine, const uint8_t *image, uint8_t state, const fdvv_moment *moment)
{
    machine->state = state;
    machine->ms = machine->us = 0;
    machine->repeat_due_ms = fdvv_image_state(image, state)->repeat_ms;
    machine->deepest_um16 = machine->highest_um16 = moment->displacement_um16;
    machine->from_cN64 = moment->command_cN64;
}

/* Whole milliseconds move from us to ms, by halving steps so that missed ticks cost no more than sixteen. */
static void pass_time(fdvv_machine *machine, uint32_t elapsed_us)
{
    uint32_t step = elapsed_us > 1000 ? 16 : 0, ms = machine->ms;
    machine->us += elapsed_us;
    do {
        if (machine->us >= 1000u << step) {
            machine->us -= 1000u << step;
            ms += 1u << step;
        }
    } while (step--);
    machine->ms = ms > INT32_MAX ? INT32_MAX : ms;
}

static void keep_extremes(fdvv_machine *machine, int32_t displacement_um16)
{
    if (displacement_um16 > machine->deepest_um16)
        machine->deepest_um16 = displacement_um16;
    if (displacement_um16 < machine->highest_um16)
        machine->highest_um16 = displacement_um16;
}

/* -- transitions ---------------------------------------------------------------------------------------- */

static uint8_t holds(const fdvv_machine *machine, const fdvv_moment *moment, int32_t velocity_mm_s16,
                     uint8_t condition, int32_t value)
{
    int32_t displacement_um16 = moment->displacement_um16;
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

/* A turn or an event serves one transition. */
static void use_up(fdvv_machine *machine, uint8_t condition, int32_t value)
{
    if (condition == FDVV_CONDITION_HOST_EVENT)
        machine->events &= ~((uint32_t)1 << (value & 31));
    else if (condition == FDVV_CONDITION_TURNED_TO_PRESS)
        machine->turned &= (uint8_t)~FDVV_TURNED_TO_PRESS;
    else if (condition == FDVV_CONDITION_TURNED_TO_RELEASE)
        machine->turned &= (uint8_t)~FDVV_TURNED_TO_RELEASE;
}

/* Give the first transition of the state that holds, or none. */
static const fdvv_transition *find_transition(const fdvv_machine *machine, const uint8_t *image,
                                              const fdvv_moment *moment)
{
    const fdvv_state *state = fdvv_image_state(image, machine->state);
    const fdvv_transition *transition = fdvv_image_transition(image, state->first_transition);
    int32_t velocity_mm_s16 = moment->velocity_mm_s16[state->velocity_source];
    uint8_t left;
    for (left = state->transitions; left; left--, transition++)
        if (holds(machine, moment, velocity_mm_s16, transition->condition, transition->value) &&
            holds(machine, moment, velocity_mm_s16, transition->guard, transition->guard_value))
            return transition;
    return 0;
}

/* Take the first transition that holds. What happened in a tick is on offer in that tick; what a transition did
 * not use of it stays on offer for the state it led to. */
static void change_state(fdvv_machine *machine, const uint8_t *image, const fdvv_moment *moment)
{
    const fdvv_transition *transition = find_transition(machine, image, moment);
    if (!transition) {
        machine->events = 0;
        machine->turned = 0;
        return;
    }
    use_up(machine, transition->condition, transition->value);
    use_up(machine, transition->guard, transition->guard_value);
    enter(machine, image, transition->target, moment);
    machine->slot = transition->slot;
    if (machine->slot == FDVV_NONE)
        machine->slot = fdvv_image_state(image, transition->target)->enter_slot;
}

/* -- vibrations ----------------------------------------------------------------------------------------- */

/* A slot is played unless another one is in this tick. */
static void play(fdvv_machine *machine, uint8_t slot)
{
    if (machine->slot == FDVV_NONE)
        machine->slot = slot;
}

static void fire(fdvv_machine *machine, const uint8_t *image, const fdvv_moment *moment,
                 const fdvv_vibration *vibration)
{
    uint32_t velocity_mm_s16 =
        moment->velocity_mm_s16[fdvv_image_state(image, machine->state)->velocity_source];
    if ((vibration->states >> machine->state & 1u) && velocity_mm_s16 >= vibration->slowest_mm_s16 &&
        velocity_mm_s16 < vibration->fastest_mm_s16)
        play(machine, vibration->slot);
}

/* Fire every vibration whose point will be crossed once a vibration started now is felt: once per stroke, and
 * only if the point lay ahead in the same stroke. */
static void vibrate(fdvv_machine *machine, const uint8_t *image, const fdvv_moment *moment)
{
    const fdvv_image_header *head = fdvv_image_head(image);
    const fdvv_vibration *vibration = fdvv_image_vibration(image, 0);
    int32_t ahead_um16 = moment->displacement_um16 + fdvv_scale(moment->signed_mm_s16, machine->lead);
    uint8_t other = moment->release ? FDVV_STROKE_PRESS : FDVV_STROKE_RELEASE, left;
    uint32_t bit = 1;
    for (left = head->vibrations; left; left--, bit <<= 1, vibration++) {
        if (vibration->stroke == other || machine->passed & bit)
            continue;
        if (moment->release ? ahead_um16 > vibration->at_um16 : ahead_um16 < vibration->at_um16) {
            machine->coming |= bit;
        } else if (machine->coming & bit) {
            machine->passed |= bit;
            fire(machine, image, moment, vibration);
        }
    }
}

static void repeat(fdvv_machine *machine, const uint8_t *image)
{
    const fdvv_state *state = fdvv_image_state(image, machine->state);
    if (state->repeat_slot == FDVV_NONE || !state->repeat_ms || machine->ms < machine->repeat_due_ms)
        return;
    play(machine, state->repeat_slot);
    machine->repeat_due_ms += state->repeat_ms;
    if (machine->repeat_due_ms <= machine->ms)
        machine->repeat_due_ms = machine->ms + state->repeat_ms;
}

void fdvv_machine_tick(fdvv_machine *machine, const uint8_t *image, const fdvv_moment *moment)
{
    machine->slot = FDVV_NONE;
    if (!machine->running) {
        enter(machine, image, fdvv_image_head(image)->start_state, moment);
        machine->slot = fdvv_image_state(image, machine->state)->enter_slot;
        machine->running = 1;
    } else {
        pass_time(machine, moment->elapsed_us);
        keep_extremes(machine, moment->displacement_um16);
    }
    if (moment->turned)
        machine->coming = machine->passed = 0;
    machine->turned |= moment->turned;
    machine->events |= moment->events;
    change_state(machine, image, moment);
    vibrate(machine, image, moment);
    repeat(machine, image);
}

/* -- force ---------------------------------------------------------------------------------------------- */

/* How much of a time since the state was entered has passed, in Q15. */
static int32_t progress_q15(const fdvv_machine *machine, uint16_t whole_ms)
{
    fdvv_ratio each;
    if (machine->ms >= whole_ms)
        return FDVV_ONE_Q15;
    each = fdvv_ratio_inverse(fdvv_ratio_of(whole_ms * 1000u));
    each.shift = (int16_t)(each.shift - 15);
    /* less time has passed than the whole, which keeps fdvv_scale within its range */
    return fdvv_clamp(fdvv_scale((int32_t)(machine->ms * 1000u + machine->us), each), 0, FDVV_ONE_Q15);
}

int16_t fdvv_machine_force_cN64(const fdvv_machine *machine, const uint8_t *image, const fdvv_moment *moment)
{
    const fdvv_state *state = fdvv_image_state(image, machine->state);
    const fdvv_surface *surface =
        fdvv_image_surface(image, moment->release ? state->release_surface : state->press_surface);
    int32_t force_cN64 = fdvv_surface_force_cN64(surface, image, moment->displacement_um16,
                                                 moment->velocity_mm_s16[state->velocity_source]);
    int32_t bias_cN64 = state->bias_cN64;
    if (state->bias_ms)
        bias_cN64 = fdvv_blend(bias_cN64, state->bias_end_cN64, progress_q15(machine, state->bias_ms));
    force_cN64 = fdvv_clamp(force_cN64 + bias_cN64, -INT16_MAX, INT16_MAX);
    if (state->fade_ms)
        force_cN64 = fdvv_blend(machine->from_cN64, force_cN64, progress_q15(machine, state->fade_ms));
    return (int16_t)force_cN64;
}
