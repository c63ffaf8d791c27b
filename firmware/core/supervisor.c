/* Two tables say what may happen: which mode a question leads to, and what is a fault. */
#include "supervisor.h"

#include "arithmetic.h"

/* -- asking ------------------------------------------------------------------------------------------------- */

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

/* Mode that a question leads to, or refusal. Zero force is never refused. */
static const uint8_t leads_to[FDVV_MODES][FDVV_ASKS] = {
    /*             booted  test     tested  arm     disarm   clear */
    /* boot */     {IDLE,   WRONG,   WRONG,  WRONG,  BOOT,    BOOT},
    /* selftest */ {BUSY,   BUSY,    IDLE,   BUSY,   TESTING, TESTING},
    /* idle */     {WRONG,  TESTING, WRONG,  ARMED,  IDLE,    IDLE},
    /* armed */    {WRONG,  WRONG,   WRONG,  WRONG,  IDLE,    ARMED},
    /* derated */  {WRONG,  WRONG,   WRONG,  WRONG,  IDLE,    DERATED},
    /* fault */    {FAULTY, FAULTY,  FAULTY, FAULTY, FAULT,   IDLE},
};

/* -- faults ------------------------------------------------------------------------------------------------- */

/* What the conditions look at, found once per tick. */
typedef struct {
    const fdvv_settings *set;
    const fdvv_inputs *in;
    int32_t moved_um16, jump_um16;  /* since the last tick, and allowed */
    int32_t silent_us, timeout_us;  /* of the host */
    int32_t force_cN64;             /* of the keycap, without its sign */
    uint32_t checksum;              /* of the settings as they are now */
} findings;

/* Each fault: whether it is looked for ALWAYS or while RENDERING, or ELSEWHERE (fdvv_supervisor_fault tells);
 * whether it may be cleared when its condition has GONE, at ANY time (it tells of the past) or NEVER (boot again);
 * whether it means STOP or only WARN, which leaves the mode as it is; the unit of value and bound in the evidence;
 * margin, which is below zero while the condition holds, value, bound. Of several in a tick that with the lowest
 * number is latched. */
#define FAULT_TABLE(X)                                                                                          \
    X(POSITION_LOW, ALWAYS, GONE, STOP, counts,                                                                 \
      in->lowest - set->reading_low, in->lowest, set->reading_low)                                              \
    X(POSITION_HIGH, ALWAYS, GONE, STOP, counts,                                                                \
      set->reading_high - in->highest, in->highest, set->reading_high)                                          \
    X(POSITION_STUCK, RENDERING, GONE, STOP, ticks,                                                             \
      set->stuck_ticks - 1 - me->equal_sums, me->equal_sums, set->stuck_ticks)                                  \
    X(POSITION_JUMP, RENDERING, GONE, STOP, um16,                                                               \
      found->jump_um16 - found->moved_um16, found->moved_um16, found->jump_um16)                                \
    X(OVER_FORCE, RENDERING, GONE, STOP, cN64,                                                                  \
      set->force_gain_q14 ? set->over_force_cN64 - found->force_cN64 : 0, found->force_cN64, set->over_force_cN64)\
    X(OVER_HEAT, ALWAYS, GONE, STOP, K,                                                                         \
      set->heat_limit_K - 1 - (int32_t)(me->heat_K_q16 >> 16), me->heat_K_q16 >> 16, set->heat_limit_K)         \
    X(SUPPLY_LOW, ALWAYS, GONE, STOP, mV,                                                                       \
      in->supply_mV - set->supply_low_mV, in->supply_mV, set->supply_low_mV)                                    \
    X(SUPPLY_HIGH, ALWAYS, GONE, STOP, mV,                                                                      \
      set->supply_high_mV - in->supply_mV, in->supply_mV, set->supply_high_mV)                                  \
    X(HOST_LOST, RENDERING, GONE, STOP, us,                                                                     \
      me->host_heard - 1, found->silent_us, found->timeout_us)                                                  \
    X(IMAGE_CORRUPT, ELSEWHERE, ANY, STOP, offset,                                                              \
      0, me->now.value, me->now.bound)                                                                          \
    X(WATCHDOG, ALWAYS, ANY, STOP, none,                                                                        \
      -(in->board & FDVV_BOARD_WATCHDOG), 0, 0)                                                                 \
    X(BROWN_OUT, ALWAYS, ANY, STOP, mV,                                                                         \
      -(in->board & FDVV_BOARD_BROWN_OUT), in->supply_mV, set->supply_low_mV)                                   \
    X(LATE, RENDERING, GONE, STOP, ticks,                                                                       \
      set->late_ticks - in->elapsed_ticks, in->elapsed_ticks, set->late_ticks)                                  \
    X(OUTPUT, ALWAYS, GONE, STOP, none,                                                                         \
      -(in->board & FDVV_BOARD_OUTPUT), 0, 0)                                                                   \
    X(SETTINGS_CORRUPT, ALWAYS, GONE, STOP, checksum,                                                           \
      -(found->checksum != me->settings_sum), found->checksum, me->settings_sum)                                \
    X(VIBRATION_BOARD, ALWAYS, GONE, WARN, none,                                                                \
      -(in->board & FDVV_BOARD_VIBRATION), 0, 0)                                                                \
    X(INTERNAL, ALWAYS, NEVER, STOP, mode,                                                                      \
      FDVV_MODES - 1 - me->mode, me->mode, FDVV_MODES - 1)

#define BIT(fault) ((uint32_t)1 << (fault))

/* The columns as masks of faults. */
enum { IS_ALWAYS, IS_RENDERING, IS_ELSEWHERE, IS_GONE, IS_ANY, IS_NEVER, IS_STOP, IS_WARN };
#define HAS(fault, is, wanted) | BIT(FDVV_FAULT_##fault) * (IS_##is == IS_##wanted)
#define RENDERING_BIT(fault, when, clear, effect, ...) HAS(fault, when, RENDERING)
#define ANY_BIT(fault, when, clear, effect, ...) HAS(fault, clear, ANY)
#define NEVER_BIT(fault, when, clear, effect, ...) HAS(fault, clear, NEVER)
#define STOP_BIT(fault, when, clear, effect, ...) HAS(fault, effect, STOP)
#define MASK(COLUMN_BIT) (0 FAULT_TABLE(COLUMN_BIT))
static const uint32_t while_rendering = MASK(RENDERING_BIT), cleared_any = MASK(ANY_BIT),
                      cleared_never = MASK(NEVER_BIT), stops = MASK(STOP_BIT);

static uint8_t renders(uint8_t mode)
{
    return mode == ARMED || mode == DERATED;
}

/* The usual tick: the OR of the margins is below zero if one of them is. */
static uint8_t is_usual(const fdvv_supervisor *me, const findings *found)
{
    const fdvv_settings *set = found->set;
    const fdvv_inputs *in = found->in;
#define OR_MARGIN(fault, when, clear, effect, unit, margin, value, bound) | (margin)
    return (0 FAULT_TABLE(OR_MARGIN)) >= 0;
}

/* Bits of the faults whose conditions hold. */
static uint32_t holding(const fdvv_supervisor *me, const findings *found)
{
    const fdvv_settings *set = found->set;
    const fdvv_inputs *in = found->in;
    uint32_t bits = 0;
#define LOOK(fault, when, clear, effect, unit, margin, value, bound)                                            \
    if ((margin) < 0)                                                                                           \
        bits |= BIT(FDVV_FAULT_##fault);
    FAULT_TABLE(LOOK)
    return renders(me->mode) ? bits : bits & ~while_rendering;
}

static void evidence_of(const fdvv_supervisor *me, const findings *found, uint8_t fault, fdvv_evidence *evidence)
{
    const fdvv_settings *set = found->set;
    const fdvv_inputs *in = found->in;
#define TELL(which, when, clear, effect, unit, margin, found_value, found_bound)                                \
    case FDVV_FAULT_##which:                                                                                    \
        evidence->value = (int32_t)(found_value);                                                               \
        evidence->bound = (int32_t)(found_bound);                                                               \
        break;
    switch (fault) {
        FAULT_TABLE(TELL)
    }
}

/* Which of them become the reason: a stop unless there is one, a warning unless there is any. */
static uint32_t reasons(const fdvv_supervisor *me, uint32_t faults)
{
    if (me->mode == FAULT)
        return 0;
    if (faults & stops)
        return faults & stops;
    return me->fault == FDVV_FAULT_NONE ? faults : 0;
}

static void count(fdvv_supervisor *me)
{
    if (me->faults < UINT16_MAX)
        me->faults++;
}

/* The reason and its evidence, of which value and bound are in `now`. */
static void latch(fdvv_supervisor *me, uint8_t fault)
{
    me->evidence = me->now;
    me->evidence.mode = me->mode < FDVV_MODES ? me->mode : FAULT;
    me->fault = fault;
    if (stops & BIT(fault))
        me->mode = FAULT;
}

static uint8_t lowest(uint32_t faults)
{
    uint8_t fault = FDVV_FAULT_NONE;
    while (!(faults & BIT(fault)))
        fault++;
    return fault;
}

/* A condition that has gone and come again is another fault; one that stays is a reason again once the reason
 * before it was cleared, unless it tells of the past. Apart, so that the usual tick keeps its registers. */
static __attribute__((noinline)) void judge(fdvv_supervisor *me, const findings *found)
{
    uint32_t present = holding(me, found), fresh = present & ~me->present;
    uint32_t candidates = reasons(me, present & (fresh | ~cleared_any));
    for (; fresh; fresh &= fresh - 1) /* a bit at a time */
        count(me);
    me->present = present;
    if (candidates) {
        evidence_of(me, found, lowest(candidates), &me->now);
        latch(me, lowest(candidates));
    }
}

/* -- looking ------------------------------------------------------------------------------------------------ */

/* settings are read as words, whatever their fields */
typedef uint32_t __attribute__((may_alias)) settings_word;

static uint32_t with(uint32_t sum, settings_word word)
{
    return (sum << 31 | sum >> 1) + word;
}

/* Changes with any one word and with their order; four at a time, as it is found anew in every tick. */
static uint32_t checksum(const fdvv_settings *settings)
{
    const settings_word *word = (const settings_word *)settings, *end = (const settings_word *)(settings + 1);
    uint32_t sum = 0;
    for (; word != end; word += 4)
        sum = with(with(with(with(sum, word[0]), word[1]), word[2]), word[3]);
    return sum;
}

static int32_t capped(uint32_t value)
{
    return value < INT32_MAX ? (int32_t)value : INT32_MAX;
}

static int32_t distance(int32_t a, int32_t b)
{
    return capped(a > b ? (uint32_t)a - (uint32_t)b : (uint32_t)b - (uint32_t)a);
}

/* Silence is judged here and remembered, so that it does not end when the clock wraps. */
static void watch_host(fdvv_supervisor *me, findings *found)
{
    found->silent_us = (int32_t)(found->in->time_us - me->host_seen_us);
    found->timeout_us = (int32_t)found->set->host_timeout_ms * 1000;
    if (found->silent_us > found->timeout_us)
        me->host_heard = 0;
}

static void watch_position(fdvv_supervisor *me, findings *found, int32_t displacement_um16, uint16_t elapsed_ticks)
{
    if (!me->position_known)
        me->now.displacement_um16 = displacement_um16;
    found->jump_um16 = capped((uint32_t)found->set->jump_um16 * elapsed_ticks);
    found->moved_um16 = distance(displacement_um16, me->now.displacement_um16);
    me->equal_sums++; /* may wrap while nothing is rendered: arming starts anew */
    if (found->in->sum != me->last_sum)
        me->equal_sums = 0;
    me->last_sum = found->in->sum;
    me->position_known = 1;
}

void fdvv_supervisor_check(fdvv_supervisor *supervisor, const fdvv_settings *settings, const fdvv_inputs *inputs,
                           int32_t displacement_um16, int16_t force_cN64, int16_t commanded_cN64,
                           uint8_t program_state)
{
    uint16_t elapsed_ticks = inputs->elapsed_ticks ? inputs->elapsed_ticks : 1;
    findings found;
    found.set = settings;
    found.in = inputs;
    found.force_cN64 = distance(force_cN64, 0);
    found.checksum = checksum(settings);
    watch_host(supervisor, &found);
    watch_position(supervisor, &found, displacement_um16, elapsed_ticks);
    supervisor->now.time_us = inputs->time_us;
    supervisor->now.tick += elapsed_ticks;
    supervisor->now.displacement_um16 = displacement_um16;
    supervisor->now.commanded_cN64 = commanded_cN64;
    supervisor->now.state = program_state;
    if (is_usual(supervisor, &found))
        supervisor->present = 0;
    else
        judge(supervisor, &found);
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
    count(supervisor);
    if (reasons(supervisor, BIT(fault)))
        latch(supervisor, fault);
}

/* -- modes -------------------------------------------------------------------------------------------------- */

/* Part of heat_time_ms that a tick is, rounded down: long division. */
static uint32_t heat_rate_q32(const fdvv_settings *settings)
{
    uint32_t time_us = settings->heat_time_ms * 1000, rest = settings->tick_us, rate = 0;
    uint8_t bit;
    for (bit = 0; bit < 32; bit++) {
        rest <<= 1;
        rate <<= 1;
        if (rest >= time_us) {
            rest -= time_us;
            rate |= 1;
        }
    }
    return rate;
}

void fdvv_supervisor_init(fdvv_supervisor *supervisor)
{
    static const fdvv_supervisor at_boot = {0};
    *supervisor = at_boot;
}

void fdvv_supervisor_settings(fdvv_supervisor *supervisor, const fdvv_settings *settings)
{
    uint32_t span_K = (uint32_t)settings->heat_limit_K - settings->derate_start_K;
    supervisor->settings_sum = checksum(settings);
    supervisor->heat_rate_q32 = heat_rate_q32(settings);
    supervisor->derate_cN64_K_q8 = ((uint32_t)settings->force_limit_cN64 << 8) / span_K;
    supervisor->position_known = 0;
}

static uint8_t clear(fdvv_supervisor *me, uint8_t fault)
{
    if (fault != me->fault || fault == FDVV_FAULT_NONE)
        return FDVV_REFUSAL_BAD_VALUE;
    if ((cleared_never | (me->present & ~cleared_any)) & BIT(fault))
        return FDVV_REFUSAL_FAULT_LATCHED;
    me->fault = FDVV_FAULT_NONE;
    return FDVV_REFUSAL_NONE;
}

static uint8_t arm(fdvv_supervisor *me, const fdvv_settings *settings)
{
    me->equal_sums = 0;
    return fdvv_settings_check(settings) ? FDVV_REFUSAL_BAD_VALUE : FDVV_REFUSAL_NONE;
}

uint8_t fdvv_supervisor_ask(fdvv_supervisor *supervisor, const fdvv_settings *settings, uint8_t ask, uint8_t number)
{
    uint8_t to, refusal = FDVV_REFUSAL_NONE;
    if (ask >= FDVV_ASKS)
        return FDVV_REFUSAL_BAD_VALUE;
    if (supervisor->mode >= FDVV_MODES)
        fdvv_supervisor_fault(supervisor, FDVV_FAULT_INTERNAL, supervisor->mode, FDVV_MODES - 1);
    to = leads_to[supervisor->mode][ask];
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
    uint32_t heat = supervisor->heat_K_q16;
    if (!renders(supervisor->mode))
        return 0;
    if (heat >= start)
        supervisor->mode = DERATED;
    else if (heat < start - (start >> 4)) /* back only when well below */
        supervisor->mode = ARMED;
    if (heat <= start)
        return settings->force_limit_cN64;
    /* no more than force_limit_cN64 << 16: the slope is that limit over the whole span */
    return heat < end ? (int16_t)(supervisor->derate_cN64_K_q8 * ((end - heat) >> 8) >> 16) : 0;
}

/* Heat as one number, K times 2^48: steps of a part in 2^32 of the way left add up exactly. */
void fdvv_supervisor_heat(fdvv_supervisor *supervisor, const fdvv_settings *settings, int16_t duty_q15,
                          uint16_t elapsed_ticks)
{
    /* rounded up: rather too warm than too cool */
    uint32_t duty_q16 = ((uint32_t)((int32_t)duty_q15 * duty_q15) + 0x3fff) >> 14;
    uint32_t end_K_q16 = settings->full_duty_rise_K * duty_q16;
    uint32_t heat_K_q16 = supervisor->heat_K_q16, rate_q32 = supervisor->heat_rate_q32;
    uint64_t heat_K_q48 = (uint64_t)heat_K_q16 << 32 | supervisor->heat_rest_q48;
    if (elapsed_ticks != 1) {
        uint64_t long_q32 = fdvv_wide_product(rate_q32, elapsed_ticks);
        rate_q32 = long_q32 >> 32 ? UINT32_MAX : (uint32_t)long_q32; /* beyond the time constant: at the end */
    }
    if (end_K_q16 > heat_K_q16)
        heat_K_q48 += fdvv_wide_product(end_K_q16 - heat_K_q16, rate_q32);
    else
        heat_K_q48 -= fdvv_wide_product(heat_K_q16 - end_K_q16, rate_q32);
    supervisor->heat_K_q16 = (uint32_t)(heat_K_q48 >> 32);
    supervisor->heat_rest_q48 = (uint32_t)heat_K_q48;
}
