/* Two tables define the safety behaviour: the mode transitions and the faults. */
#include "supervisor.h"

#include "arithmetic.h"

/* -- mode transitions --------------------------------------------------------------------------------------- */

#define BOOT FDVV_MODE_BOOT
#define TESTING FDVV_MODE_SELFTEST
#define IDLE FDVV_MODE_IDLE
#define ARMED FDVV_MODE_ARMED
#define DERATED FDVV_MODE_DERATED
#define FAULT FDVV_MODE_FAULT
#define REFUSED 0x80
#define WRONG (REFUSED | FDVV_REFUSAL_WRONG_MODE)
#define BUSY (REFUSED | FDVV_REFUSAL_BUSY)
#define FAULTY (REFUSED | FDVV_REFUSAL_FAULT_LATCHED)

/* The mode after each request, or its refusal. Disarming is never refused. */
static const uint8_t mode_transitions[FDVV_MODES][FDVV_ASKS] = {
    /*             booted  test     tested  arm     disarm   clear */
    /* boot */     {IDLE,   WRONG,   WRONG,  WRONG,  BOOT,    BOOT},
    /* selftest */ {BUSY,   BUSY,    IDLE,   BUSY,   TESTING, TESTING},
    /* idle */     {WRONG,  TESTING, WRONG,  ARMED,  IDLE,    IDLE},
    /* armed */    {WRONG,  WRONG,   WRONG,  WRONG,  IDLE,    ARMED},
    /* derated */  {WRONG,  WRONG,   WRONG,  WRONG,  IDLE,    DERATED},
    /* fault */    {FAULTY, FAULTY,  FAULTY, FAULTY, FAULT,   IDLE},
};

/* -- faults ------------------------------------------------------------------------------------------------- */

/* What the fault conditions depend on besides the supervisor's state; computed once per tick. */
typedef struct {
    const fdvv_settings *set;
    const fdvv_inputs *in;
    int32_t moved_um16, jump_um16;  /* displacement since the last tick, and its limit */
    int32_t silent_us, timeout_us;  /* time since the last message of the host, and its limit */
    int32_t force_cN64;             /* absolute value of the measured keycap force */
    uint32_t checksum;              /* of the settings in memory now */
} fault_inputs;

/* One row per fault. If several become active in one tick, the one with the lowest number is latched.
 *
 *   fault   FDVV_FAULT_...
 *   when    ALWAYS checked; checked while RENDERING (armed or derated); EXTERNAL: set by fdvv_supervisor_fault
 *   clear   allowed when INACTIVE; at ANYTIME, for a past event; NEVER, only by a reset
 *   effect  STOP: mode fault, zero force; WARN: the mode does not change
 *   unit    of value and bound in the evidence
 *   margin  the fault is active while this is negative
 *   value   the measured quantity
 *   bound   its limit */
#define FAULT_TABLE(X)                                                                                          \
    /* Is the lowest position reading below the sensor's range? */                                              \
    X(POSITION_LOW, ALWAYS, INACTIVE, STOP, counts,                                                             \
      in->lowest - set->reading_low, in->lowest, set->reading_low)                                              \
    /* Is the highest position reading above the sensor's range? */                                             \
    X(POSITION_HIGH, ALWAYS, INACTIVE, STOP, counts,                                                            \
      set->reading_high - in->highest, in->highest, set->reading_high)                                          \
    /* Has the position reading been the same for too many ticks? */                                            \
    X(POSITION_STUCK, RENDERING, INACTIVE, STOP, ticks,                                                         \
      set->stuck_ticks - 1 - me->equal_sums, me->equal_sums, set->stuck_ticks)                                  \
    /* Did the position change by more than is possible since the last tick? */                                 \
    X(POSITION_JUMP, RENDERING, INACTIVE, STOP, um16,                                                           \
      derived->jump_um16 - derived->moved_um16, derived->moved_um16, derived->jump_um16)                        \
    /* Is the measured keycap force too large? (not checked without a force sensor) */                          \
    X(OVER_FORCE, RENDERING, INACTIVE, STOP, cN64,                                                              \
      set->force_gain_q14 ? set->over_force_cN64 - derived->force_cN64 : 0, derived->force_cN64, set->over_force_cN64) \
    /* Is the coil too warm, according to the thermal model? */                                                 \
    X(OVER_HEAT, ALWAYS, INACTIVE, STOP, K,                                                                     \
      set->heat_limit_K - 1 - (int32_t)(me->heat.coil_K_q16 >> 16), me->heat.coil_K_q16 >> 16, set->heat_limit_K) \
    /* Is the supply voltage too low? */                                                                        \
    X(SUPPLY_LOW, ALWAYS, INACTIVE, STOP, mV,                                                                   \
      in->supply_mV - set->supply_low_mV, in->supply_mV, set->supply_low_mV)                                    \
    /* Is the supply voltage too high? */                                                                       \
    X(SUPPLY_HIGH, ALWAYS, INACTIVE, STOP, mV,                                                                  \
      set->supply_high_mV - in->supply_mV, in->supply_mV, set->supply_high_mV)                                  \
    /* Has the host been silent for longer than its timeout? */                                                 \
    X(HOST_LOST, RENDERING, INACTIVE, STOP, us,                                                                 \
      me->host_heard - 1, derived->silent_us, derived->timeout_us)                                              \
    /* Did the link's periodic check find the active program corrupted? */                                      \
    X(IMAGE_CORRUPT, EXTERNAL, ANYTIME, STOP, offset,                                                           \
      0, me->now.value, me->now.bound)                                                                          \
    /* Was the last reset caused by the watchdog? */                                                            \
    X(WATCHDOG, ALWAYS, ANYTIME, STOP, none,                                                                    \
      -(in->board & FDVV_BOARD_WATCHDOG), 0, 0)                                                                 \
    /* Was there a brown-out? */                                                                                \
    X(BROWN_OUT, ALWAYS, ANYTIME, STOP, mV,                                                                     \
      -(in->board & FDVV_BOARD_BROWN_OUT), in->supply_mV, set->supply_low_mV)                                   \
    /* Were too many ticks missed? */                                                                           \
    X(LATE, RENDERING, INACTIVE, STOP, ticks,                                                                   \
      set->late_ticks - in->elapsed_ticks, in->elapsed_ticks, set->late_ticks)                                  \
    /* Does the bridge report a fault, or are its inputs not as commanded? */                                   \
    X(OUTPUT, ALWAYS, INACTIVE, STOP, none,                                                                     \
      -(in->board & FDVV_BOARD_OUTPUT), 0, 0)                                                                   \
    /* Do the settings differ from those that were set? */                                                      \
    X(SETTINGS_CORRUPT, ALWAYS, INACTIVE, STOP, checksum,                                                       \
      -(derived->checksum != me->settings_sum), derived->checksum, me->settings_sum)                            \
    /* Does the vibration board not respond? */                                                                 \
    X(VIBRATION_BOARD, ALWAYS, INACTIVE, WARN, none,                                                            \
      -(in->board & FDVV_BOARD_VIBRATION), 0, 0)                                                                \
    /* Is the mode invalid? */                                                                                  \
    X(INTERNAL, ALWAYS, NEVER, STOP, mode,                                                                      \
      FDVV_MODES - 1 - me->mode, me->mode, FDVV_MODES - 1)                                                      \
    /* Is the thermistor of the coil open, or its wire? */                                                      \
    X(THERMISTOR_OPEN, ALWAYS, INACTIVE, STOP, counts,                                                          \
      -(FDVV_THERMISTOR(me, faults) & FDVV_THERMISTOR_IS_OPEN), FDVV_THERMISTOR(me, value), FDVV_THERMISTOR(me, bound))\
    /* Is it shorted? */                                                                                        \
    X(THERMISTOR_SHORT, ALWAYS, INACTIVE, STOP, counts,                                                         \
      -(FDVV_THERMISTOR(me, faults) & FDVV_THERMISTOR_IS_SHORT), FDVV_THERMISTOR(me, value), FDVV_THERMISTOR(me, bound))\
    /* Did its reading change by more than a coil can? */                                                       \
    X(THERMISTOR_JUMP, ALWAYS, INACTIVE, STOP, K,                                                               \
      -(FDVV_THERMISTOR(me, faults) & FDVV_THERMISTOR_JUMPS), FDVV_THERMISTOR(me, value), FDVV_THERMISTOR(me, bound))\
    /* Does it stay cold while the coil warms? */                                                               \
    X(THERMISTOR_COLD, ALWAYS, INACTIVE, STOP, K,                                                               \
      -(FDVV_THERMISTOR(me, faults) & FDVV_THERMISTOR_IS_COLD), FDVV_THERMISTOR(me, value), FDVV_THERMISTOR(me, bound))

#define BIT(fault) ((uint32_t)1 << (fault))

/* The columns `when`, `clear` and `effect` as masks of faults. */
enum { IS_ALWAYS, IS_RENDERING, IS_EXTERNAL, IS_INACTIVE, IS_ANYTIME, IS_NEVER, IS_STOP, IS_WARN };
#define OR_BIT_IF(fault, cell, wanted) | BIT(FDVV_FAULT_##fault) * (IS_##cell == IS_##wanted)
#define RENDERING_BIT(fault, when, clear, effect, ...) OR_BIT_IF(fault, when, RENDERING)
#define ANYTIME_BIT(fault, when, clear, effect, ...) OR_BIT_IF(fault, clear, ANYTIME)
#define NEVER_BIT(fault, when, clear, effect, ...) OR_BIT_IF(fault, clear, NEVER)
#define STOP_BIT(fault, when, clear, effect, ...) OR_BIT_IF(fault, effect, STOP)
#define MASK(COLUMN_BIT) (0 FAULT_TABLE(COLUMN_BIT))
static const uint32_t rendering_faults = MASK(RENDERING_BIT), anytime_faults = MASK(ANYTIME_BIT),
                      never_faults = MASK(NEVER_BIT), stop_faults = MASK(STOP_BIT);

static uint8_t is_rendering(uint8_t mode)
{
    return mode == ARMED || mode == DERATED;
}

/* Fast path: the bitwise OR of the margins is negative if and only if at least one margin is. */
static uint8_t no_fault_active(const fdvv_supervisor *me, const fault_inputs *derived)
{
    const fdvv_settings *set = derived->set;
    const fdvv_inputs *in = derived->in;
#define OR_MARGIN(fault, when, clear, effect, unit, margin, value, bound) | (margin)
    return (0 FAULT_TABLE(OR_MARGIN)) >= 0;
}

/* A bit for each fault whose condition is true in the present mode. */
static uint32_t active_faults(const fdvv_supervisor *me, const fault_inputs *derived)
{
    const fdvv_settings *set = derived->set;
    const fdvv_inputs *in = derived->in;
    uint32_t bits = 0;
#define SET_BIT_IF_ACTIVE(fault, when, clear, effect, unit, margin, value, bound)                               \
    if ((margin) < 0)                                                                                           \
        bits |= BIT(FDVV_FAULT_##fault);
    FAULT_TABLE(SET_BIT_IF_ACTIVE)
    return is_rendering(me->mode) ? bits : bits & ~rendering_faults;
}

static void fill_evidence(const fdvv_supervisor *me, const fault_inputs *derived, uint8_t fault,
                          fdvv_evidence *evidence)
{
    const fdvv_settings *set = derived->set;
    const fdvv_inputs *in = derived->in;
#define EVIDENCE_CASE(which, when, clear, effect, unit, margin, measured, limit)                                \
    case FDVV_FAULT_##which:                                                                                    \
        evidence->value = (int32_t)(measured);                                                                  \
        evidence->bound = (int32_t)(limit);                                                                     \
        break;
    switch (fault) {
        FAULT_TABLE(EVIDENCE_CASE)
    }
}

/* A STOP fault may be latched unless the mode is fault already; a WARN fault only if none is latched. */
static uint32_t latchable(const fdvv_supervisor *me, uint32_t faults)
{
    if (me->mode == FAULT)
        return 0;
    if (faults & stop_faults)
        return faults & stop_faults;
    return me->fault == FDVV_FAULT_NONE ? faults : 0;
}

static void count_fault(fdvv_supervisor *me)
{
    if (me->faults < UINT16_MAX)
        me->faults++;
}

/* Value and bound of the evidence are in `now` already. */
static void latch(fdvv_supervisor *me, uint8_t fault)
{
    me->evidence = me->now;
    me->evidence.mode = me->mode < FDVV_MODES ? me->mode : FAULT;
    me->fault = fault;
    if (stop_faults & BIT(fault))
        me->mode = FAULT;
}

static uint8_t lowest_fault(uint32_t faults)
{
    uint8_t fault = FDVV_FAULT_NONE;
    while (!(faults & BIT(fault)))
        fault++;
    return fault;
}

/* Count each fault that becomes active, and latch one. A fault that stays active is latched again after it was
 * cleared, unless it is a past event. Not inlined, so that the fast path needs fewer registers. */
static __attribute__((noinline)) void update_faults(fdvv_supervisor *me, const fault_inputs *derived)
{
    uint32_t active = active_faults(me, derived), newly_active = active & ~me->active;
    uint32_t candidates = latchable(me, active & (newly_active | ~anytime_faults));
    for (; newly_active; newly_active &= newly_active - 1) /* clears the lowest bit */
        count_fault(me);
    me->active = active;
    if (candidates) {
        fill_evidence(me, derived, lowest_fault(candidates), &me->now);
        latch(me, lowest_fault(candidates));
    }
}

/* -- checks of one tick ------------------------------------------------------------------------------------- */

/* settings are read word by word, regardless of the types of their fields */
typedef uint32_t __attribute__((may_alias)) settings_word;

static uint32_t rotate_add(uint32_t sum, settings_word word)
{
    return (sum << 31 | sum >> 1) + word;
}

/* Depends on every word and on their order. Unrolled by twelve, because it is computed in every tick. */
static uint32_t checksum(const fdvv_settings *settings)
{
    const settings_word *word = (const settings_word *)settings, *end = (const settings_word *)(settings + 1);
    uint32_t sum = 0;
    for (; word != end; word += 12) {
        sum = rotate_add(rotate_add(rotate_add(rotate_add(sum, word[0]), word[1]), word[2]), word[3]);
        sum = rotate_add(rotate_add(rotate_add(rotate_add(sum, word[4]), word[5]), word[6]), word[7]);
        sum = rotate_add(rotate_add(rotate_add(rotate_add(sum, word[8]), word[9]), word[10]), word[11]);
    }
    return sum;
}

static int32_t clamp_to_int32(uint32_t value)
{
    return value < INT32_MAX ? (int32_t)value : INT32_MAX;
}

static int32_t distance(int32_t a, int32_t b)
{
    return clamp_to_int32(a > b ? (uint32_t)a - (uint32_t)b : (uint32_t)b - (uint32_t)a);
}

/* The timeout is stored in host_heard, so that it does not end when the clock wraps around. */
static void check_host(fdvv_supervisor *me, fault_inputs *derived)
{
    derived->silent_us = (int32_t)(derived->in->time_us - me->host_seen_us);
    derived->timeout_us = (int32_t)derived->set->host_timeout_ms * 1000;
    if (derived->silent_us > derived->timeout_us)
        me->host_heard = 0;
}

static void check_position(fdvv_supervisor *me, fault_inputs *derived, int32_t displacement_um16,
                           uint16_t elapsed_ticks)
{
    if (!me->position_known)
        me->now.displacement_um16 = displacement_um16;
    derived->jump_um16 = clamp_to_int32((uint32_t)derived->set->jump_um16 * elapsed_ticks);
    derived->moved_um16 = distance(displacement_um16, me->now.displacement_um16);
    me->equal_sums++; /* may wrap around while not rendering; arming resets it */
    if (derived->in->sum != me->last_sum)
        me->equal_sums = 0;
    me->last_sum = derived->in->sum;
    me->position_known = 1;
}

void fdvv_supervisor_check(fdvv_supervisor *supervisor, const fdvv_settings *settings, const fdvv_inputs *inputs,
                           int32_t displacement_um16, int16_t force_cN64, int16_t commanded_cN64,
                           uint8_t program_state)
{
    uint16_t elapsed_ticks = inputs->elapsed_ticks ? inputs->elapsed_ticks : 1;
    fault_inputs derived;
    derived.set = settings;
    derived.in = inputs;
    derived.force_cN64 = distance(force_cN64, 0);
    derived.checksum = checksum(settings);
    check_host(supervisor, &derived);
    check_position(supervisor, &derived, displacement_um16, elapsed_ticks);
    supervisor->now.time_us = inputs->time_us;
    supervisor->now.tick += elapsed_ticks;
    supervisor->now.displacement_um16 = displacement_um16;
    supervisor->now.commanded_cN64 = commanded_cN64;
    supervisor->now.state = program_state;
    if (no_fault_active(supervisor, &derived))
        supervisor->active = 0;
    else
        update_faults(supervisor, &derived);
}

void fdvv_supervisor_host_seen(fdvv_supervisor *supervisor, uint32_t time_us)
{
    supervisor->host_seen_us = time_us;
    supervisor->host_heard = 1;
}

void fdvv_supervisor_fault(fdvv_supervisor *supervisor, uint8_t fault, int32_t value, int32_t bound)
{
    supervisor->now.value = value;
    supervisor->now.bound = bound;
    if (fault == FDVV_FAULT_NONE || fault >= FDVV_FAULTS) {
        supervisor->now.value = fault;
        fault = FDVV_FAULT_INTERNAL;
    }
    count_fault(supervisor);
    if (latchable(supervisor, BIT(fault)))
        latch(supervisor, fault);
}

/* -- modes -------------------------------------------------------------------------------------------------- */

void fdvv_supervisor_init(fdvv_supervisor *supervisor, const fdvv_board_limits *limits)
{
    static const fdvv_supervisor at_boot = {0};
    *supervisor = at_boot;
    supervisor->limits = limits;
}

void fdvv_supervisor_settings(fdvv_supervisor *supervisor, const fdvv_settings *settings)
{
    uint32_t span_K = (uint32_t)settings->heat_limit_K - settings->derate_start_K;
    supervisor->settings_sum = checksum(settings);
    fdvv_heat_set(&supervisor->heat, supervisor->limits, settings);
    supervisor->derate_cN64_K_q8 = ((uint32_t)settings->force_limit_cN64 << 8) / span_K;
    supervisor->position_known = 0;
}

static uint8_t clear(fdvv_supervisor *me, uint8_t fault)
{
    if (fault != me->fault || fault == FDVV_FAULT_NONE)
        return FDVV_REFUSAL_BAD_VALUE;
    if ((never_faults | (me->active & ~anytime_faults)) & BIT(fault))
        return FDVV_REFUSAL_FAULT_LATCHED;
    me->fault = FDVV_FAULT_NONE;
    return FDVV_REFUSAL_NONE;
}

static uint8_t arm(fdvv_supervisor *me, const fdvv_settings *settings)
{
    me->equal_sums = 0;
    return fdvv_settings_check(settings, me->limits) ? FDVV_REFUSAL_BAD_VALUE : FDVV_REFUSAL_NONE;
}

uint8_t fdvv_supervisor_ask(fdvv_supervisor *supervisor, const fdvv_settings *settings, uint8_t ask, uint8_t number)
{
    uint8_t to, refusal = FDVV_REFUSAL_NONE;
    if (ask >= FDVV_ASKS)
        return FDVV_REFUSAL_BAD_VALUE;
    if (supervisor->mode >= FDVV_MODES)
        fdvv_supervisor_fault(supervisor, FDVV_FAULT_INTERNAL, supervisor->mode, FDVV_MODES - 1);
    to = mode_transitions[supervisor->mode][ask];
    if (to & REFUSED)
        return to & ~REFUSED;
    if (ask == FDVV_ASK_CLEAR)
        refusal = clear(supervisor, number);
    if (ask == FDVV_ASK_ARM)
        refusal = arm(supervisor, settings);
    if (refusal == FDVV_REFUSAL_NONE)
        supervisor->mode = to;
    return refusal;
}

/* -- limits ------------------------------------------------------------------------------------------------- */

int16_t fdvv_supervisor_limit_cN64(fdvv_supervisor *supervisor, const fdvv_settings *settings)
{
    uint32_t start = (uint32_t)settings->derate_start_K << 16, end = (uint32_t)settings->heat_limit_K << 16;
    uint32_t heat = supervisor->heat.coil_K_q16 + supervisor->heat.late_K_q16;
    if (!is_rendering(supervisor->mode))
        return 0;
    if (heat >= start)
        supervisor->mode = DERATED;
    else if (heat < start - (start >> 4)) /* hysteresis */
        supervisor->mode = ARMED;
    if (heat <= start)
        return settings->force_limit_cN64;
    /* at most force_limit_cN64 << 16: the slope is the force limit divided by the span from start to end */
    return heat < end ? (int16_t)(supervisor->derate_cN64_K_q8 * ((end - heat) >> 8) >> 16) : 0;
}
