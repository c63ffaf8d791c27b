#include "force_loop.h"

#include <string.h>

/* Within this of a stop the cap may be held by it: no acceleration is expected, and the estimator is stiff. */
#define NEAR_STOP_m 2e-5f
enum { BETWEEN_STOPS, AT_TOP, AT_BOTTOM };
#define UNKNOWN_N 0.15f
#define FASTEST_m_s2 1000.0f
/* The controller fades in below the top stop and out above the bottom stop: against a stop it would wind up. */
#define TOP_FROM_m 2e-5f
#define TOP_WHOLE_m 1.2e-4f
#define BOTTOM_FROM_m 2e-5f
#define BOTTOM_WHOLE_m 6e-5f
/* A finger that touches with less than this has no weight yet: a loop on a free cap would shake it. */
#define CONTACT_FROM_N 0.005f
#define CONTACT_WHOLE_N 0.035f
/* Part of an upward correction that a free cap still gets, so that it follows a finger that leaves. */
#define FREE_PART 0.15f
#define ERROR_N 0.5f
#define FEEDBACK_N 3.0f
#define INTEGRAL_N 0.5f
/* The feedback takes over a step of the target with this lag: its lead would answer a step with a kick that throws the
 * cap off the finger. */
#define STEP_s 1e-3f
/* A cap that nothing touches and that is faster than any finger gets the drag that programs are checked with. */
#define FREE_m_s 0.3f
#define FREE_N_s_m 4.0f

/* Between the curves of both strokes the target rises by no more than this: what the loop holds under any finger. */
#define TURNING_N_m 800.0f
/* At a stop, which bears the difference, the other stroke's curve comes in within this time. */
#define TURNING_s 3e-3f
/* A cell of 12 bits repeats itself for this long under no cap that moves as fast as this. One of a fifth of a count of
 * noise does under a still cap. */
#define DEAD_ticks 200
#define MOVES_m_s 5e-3f
#define UNEXPLAINED_s 0.03f
/* A blow of a fast finger overloads a sound cell for some milliseconds, and a strong one at the stop for longer. */
#define OVERLOAD_s 0.02f
/* Ringing: the feedback changes its sign beyond LARGE_N more than RINGING_turns times in RINGING_s. */
#define LARGE_N 1.0f
#define RINGING_s 0.01f
#define RINGING_turns 3

static float clamp(float value, float low, float high)
{
    return value < low ? low : value > high ? high : value;
}

static float ramp(float value, float from, float whole)
{
    return clamp((value - from) / (whole - from), 0.0f, 1.0f);
}

static float gain_at(const fdvv_force_loop_gains *g, float x_m)
{
    return g->gain + x_m * (g->gain_1_m + x_m * g->gain_1_m2);
}

/* Linear between the values, held beyond. What is not a number stays one, and reads the first values. */
static float own_N(const fdvv_force_loop_gains *g, float x_m)
{
    enum { OWN_VALUES = sizeof g->own_N / sizeof *g->own_N };
    float at = clamp(x_m * g->own_per_m, 0.0f, (float)(OWN_VALUES - 1));
    int low = at >= (float)(OWN_VALUES - 2) ? OWN_VALUES - 2 : at > 0.0f ? (int)at : 0;
    return g->own_N[low] + (at - (float)low) * (g->own_N[low + 1] - g->own_N[low]);
}

/* Dry friction turns over a distance, not with the sign of the speed: that sign would shake a held cap. */
static float friction_N(const fdvv_force_loop *loop) { return loop->gains.friction_N * loop->slid; }

void fdvv_force_loop_init(fdvv_force_loop *loop, const fdvv_force_loop_gains *gains)
{
    memset(loop, 0, sizeof *loop);
    if (!gains)
        return;
    loop->gains = *gains;
    loop->scale = 1.0f;
    loop->enabled = 1;
    loop->state = FDVV_NO_STATE;
}

/* Correct the prediction by the position's reading, which lags: it is compared with a lagging copy of the state. */
static void correct(fdvv_force_loop *loop, float position_m)
{
    const float *gain = loop->at_stop ? loop->gains.stop_gains : loop->gains.free_gains;
    float residual_m = position_m - loop->lagging_m;
    loop->x_m += gain[0] * residual_m;
    loop->v_m_s += gain[1] * residual_m;
    if (!loop->at_stop)
        loop->unknown_N += gain[2] * residual_m;
    loop->lagging_m += gain[3] * residual_m;
    loop->unknown_N = clamp(loop->unknown_N, -UNKNOWN_N, UNKNOWN_N);
}

/* A stop bears what presses the cap against it: only what lifts it off accelerates it. */
static float off_stop(const fdvv_force_loop *loop, float a_m_s2, float cell_N, float travel_m)
{
    if (loop->x_m < 0.5f * travel_m)
        return cell_N > 0.9f * loop->cell_coil_N ? clamp(a_m_s2, 0.0f, FASTEST_m_s2) : 0.0f;
    return cell_N < loop->cell_coil_N ? clamp(a_m_s2, -FASTEST_m_s2, 0.0f) : 0.0f;
}

/* The force that the model does not know rests on its bound where the cell tells another force than the motion. */
static uint8_t is_unexplained(const fdvv_force_loop *loop)
{
    return !loop->at_stop && (loop->unknown_N >= UNKNOWN_N || loop->unknown_N <= -UNKNOWN_N);
}

void fdvv_force_loop_watch(fdvv_force_loop *loop, uint16_t counts, uint16_t middle)
{
    if (loop->fault)
        return;
    if (counts != loop->counts)
        loop->same_ticks = 0;
    else if (loop->v_m_s > MOVES_m_s || loop->v_m_s < -MOVES_m_s)
        loop->same_ticks++;
    loop->unexplained_ticks = (uint16_t)(is_unexplained(loop) ? loop->unexplained_ticks + 1 : 0);
    loop->counts = counts;
    if (counts >= 2 && (uint32_t)counts + 2 <= 2u * middle)
        loop->saturated_ticks = 0;
    else if (!loop->saturated_ticks || counts < middle || loop->at_stop != AT_BOTTOM)
        loop->saturated_ticks++;
    if ((float)loop->saturated_ticks * loop->gains.tick_s > OVERLOAD_s)
        loop->fault = FDVV_LOOP_FAULT_CELL_SATURATED;
    else if (loop->same_ticks > DEAD_ticks && !loop->saturated_ticks)
        loop->fault = FDVV_LOOP_FAULT_CELL_DEAD;
    else if ((float)loop->unexplained_ticks * loop->gains.tick_s > UNEXPLAINED_s)
        loop->fault = FDVV_LOOP_FAULT_CELL_WRONG;
}

uint8_t fdvv_force_loop_fault(const fdvv_force_loop *loop) { return loop->fault; }

uint8_t fdvv_force_loop_is_closed(const fdvv_force_loop *loop)
{
    return loop->enabled && !loop->fault && !loop->saturated_ticks;
}

void fdvv_force_loop_rest(fdvv_force_loop *loop)
{
    fdvv_force_loop_gains gains = loop->gains;
    uint8_t enabled = loop->enabled, fault = loop->fault;
    float scale = loop->scale;
    if (!loop->started)
        return;
    fdvv_force_loop_init(loop, &gains);
    loop->enabled = enabled;
    loop->fault = fault;
    loop->scale = scale;
}

void fdvv_force_loop_open(fdvv_force_loop *loop)
{
    loop->enabled = 0;
}

/* A comparison with what is not a number is false. */
#define CHECK(field, low, high)                                                                             \
    place++;                                                                                                \
    if (!(record->field >= (low) && record->field <= (high)))                                               \
        return place;

uint8_t fdvv_force_loop_check(const fdvv_force_loop_gains *record)
{
    uint8_t place = 0;
    FDVV_FORCE_LOOP_GAINS_RANGES(CHECK)
    return 0;
}

uint8_t fdvv_load_cell_check(const fdvv_load_cell *record)
{
    uint8_t place = 0;
    FDVV_LOAD_CELL_RANGES(CHECK)
    return 0;
}
#undef CHECK

void fdvv_force_loop_estimate(fdvv_force_loop *loop, float position_m, float cell_N, float travel_m)
{
    const fdvv_force_loop_gains *g = &loop->gains;
    if (!loop->started) {
        loop->x_m = loop->lagging_m = loop->last_m = loop->slid_m = position_m;
        loop->started = 1;
    }
    loop->at_stop = loop->x_m > travel_m - NEAR_STOP_m ? AT_BOTTOM : loop->x_m < NEAR_STOP_m ? AT_TOP : BETWEEN_STOPS;
    correct(loop, position_m);
    loop->slid = clamp(loop->slid + (loop->x_m - loop->slid_m) / g->friction_m, -1.0f, 1.0f);
    loop->slid_m = loop->x_m;
    loop->a_m_s2 = (cell_N + g->plate_kg * loop->a_m_s2 - loop->cell_coil_N - g->drag_N_s_m * loop->v_m_s -
                    friction_N(loop) - own_N(g, loop->x_m) + loop->unknown_N) / g->mass_kg;
    if (loop->at_stop)
        loop->a_m_s2 = off_stop(loop, loop->a_m_s2, cell_N, travel_m);
    loop->force_N = cell_N + g->plate_kg * loop->a_m_s2;
}

/* Part of the way between the curves per metre: a step would throw a held cap to and fro. It follows the displacement
 * without play, since a force that trails the displacement feeds a swing. */
void fdvv_force_loop_turn(fdvv_force_loop *loop, float apart_N, float reversal_m, float travel_m)
{
    float steepest_1_m = TURNING_N_m / (apart_N < 0.0f ? -apart_N : apart_N);
    float at_stop = loop->gains.tick_s / TURNING_s;
    loop->turning_1_m = steepest_1_m * reversal_m < 1.0f ? steepest_1_m : 1.0f / reversal_m;
    loop->release -= loop->turning_1_m * (loop->x_m - loop->last_m);
    loop->release += at_stop * (1.0f - ramp(travel_m - loop->x_m, BOTTOM_FROM_m, BOTTOM_WHOLE_m));
    loop->release -= at_stop * (1.0f - ramp(loop->x_m, TOP_FROM_m, TOP_WHOLE_m));
    loop->release = clamp(loop->release, 0.0f, 1.0f);
    loop->last_m = loop->x_m;
}

float fdvv_force_loop_release_at(const fdvv_force_loop *loop, float x_m)
{
    return clamp(loop->release - loop->turning_1_m * (x_m - loop->x_m), 0.0f, 1.0f);
}

float fdvv_force_loop_ahead_m(const fdvv_force_loop *loop)
{
    float lead_s = loop->gains.lead_s;
    return loop->x_m + lead_s * (loop->v_m_s + 0.5f * lead_s * loop->a_m_s2);
}

/* Weight of a correction: one-sided at the stops, and small while nothing touches. It lies behind the derivative;
 * before it, the gate itself would be differentiated and a free cap would cycle. */
static float gate(const fdvv_force_loop *loop, float feedback_N, float top, float bottom)
{
    if (feedback_N > 0.0f)
        return top * (FREE_PART + (1.0f - FREE_PART) * loop->contact);
    return bottom * (loop->release > 0.5f ? top : 1.0f) * loop->contact;
}

/* A finger stiffer than any that the gains were chosen for makes the loop ring: halve them, for good. What is watched is
 * not halved with them: a tip of steel would go on ringing at whatever gain passes unseen. */
static void watch_ringing(fdvv_force_loop *loop, float fed_N)
{
    int8_t side = (int8_t)(fed_N > LARGE_N ? 1 : fed_N < -LARGE_N ? -1 : 0);
    if ((float)++loop->ringing_ticks * loop->gains.tick_s > RINGING_s)
        loop->ringing_ticks = 0, loop->turns = 0;
    if (!side || side == loop->side)
        return;
    if (loop->side && ++loop->turns > RINGING_turns)
        loop->scale *= 0.5f, loop->turns = 0;
    loop->side = side;
}

static float feedback_N(fdvv_force_loop *loop, float error_N, float top, float bottom)
{
    const fdvv_force_loop_gains *g = &loop->gains;
    float rate_N_s = (error_N - loop->error_N) / g->tick_s, fed_N;
    loop->error_N = error_N;
    loop->low_N[0] += g->lowpass_rate * (g->proportional * error_N + g->derivative_s * rate_N_s - loop->low_N[0]);
    loop->low_N[1] += g->lowpass_rate * (loop->low_N[0] - loop->low_N[1]);
    fed_N = clamp(loop->scale * loop->low_N[1], -FEEDBACK_N, FEEDBACK_N);
    watch_ringing(loop, loop->low_N[1]);
    loop->integral_N += g->integral_1_s * g->tick_s * error_N * top * bottom * loop->contact;
    loop->integral_N = clamp(loop->integral_N * (1.0f - g->leak), -INTEGRAL_N, INTEGRAL_N);
    return fed_N * gate(loop, fed_N, top, bottom) + loop->integral_N;
}

void fdvv_force_loop_enter(fdvv_force_loop *loop, uint8_t state, float now_N)
{
    if (loop->state != state && loop->state != FDVV_NO_STATE)
        loop->step_N += loop->target_N - now_N;
    loop->state = state;
    loop->target_N = now_N;
}

/* Force against a free cap that flies faster than a finger follows. */
static float free_drag_N(const fdvv_force_loop *loop)
{
    float beyond_m_s = loop->v_m_s - clamp(loop->v_m_s, -FREE_m_s, FREE_m_s);
    return (1.0f - loop->contact) * FREE_N_s_m * beyond_m_s;
}

float fdvv_force_loop_command_N(fdvv_force_loop *loop, float ahead_N, float now_N, float travel_m)
{
    const fdvv_force_loop_gains *g = &loop->gains;
    float top = ramp(loop->x_m, TOP_FROM_m, TOP_WHOLE_m);
    float bottom = ramp(travel_m - loop->x_m, BOTTOM_FROM_m, BOTTOM_WHOLE_m);
    /* a finger cannot be pulled */
    float wanted_N = now_N + loop->step_N > 0.0f ? now_N + loop->step_N : 0.0f;
    float error_N = clamp(wanted_N - loop->force_N, -ERROR_N, ERROR_N);
    float fast_m_s = loop->v_m_s + g->velocity_lead_s * loop->a_m_s2;
    float ahead_m = fdvv_force_loop_ahead_m(loop), helped, total_N;
    loop->contact += g->contact_rate * (ramp(loop->force_N, CONTACT_FROM_N, CONTACT_WHOLE_N) - loop->contact);
    /* at a stop the estimate is the sensor's noise, which would make the cap rattle */
    helped = top * bottom;
    total_N = ahead_N - own_N(g, ahead_m);
    total_N -= helped * ((g->drag_N_s_m + g->brake_N_s_m) * fast_m_s + friction_N(loop));
    total_N += feedback_N(loop, error_N, top, bottom) + free_drag_N(loop);
    loop->step_N -= loop->step_N * (g->tick_s < STEP_s ? g->tick_s / STEP_s : 1.0f);
    loop->slow_m_s += g->highpass_rate * (loop->v_m_s - loop->slow_m_s);
    total_N += loop->scale * g->damping_N_s_m * (loop->v_m_s - loop->slow_m_s) * top * bottom * loop->contact;
    return total_N / gain_at(g, ahead_m);
}

float fdvv_force_loop_open_N(const fdvv_force_loop *loop, float target_N, float x_m)
{
    return (target_N - own_N(&loop->gains, x_m)) / gain_at(&loop->gains, x_m);
}

void fdvv_force_loop_predict(fdvv_force_loop *loop, float command_N)
{
    const fdvv_force_loop_gains *g = &loop->gains;
    float mean_N = command_N + g->compute_ratio * (loop->last_N - command_N);
    float held_N = gain_at(g, loop->x_m) * mean_N + g->brake_N_s_m * loop->v_m_s;
    loop->last_N = command_N;
    loop->coil_N += g->coil_rate * (held_N - loop->coil_N);
    loop->cell_coil_N += g->cell_rate * (loop->coil_N - loop->cell_coil_N);
    loop->x_m += g->tick_s * (loop->v_m_s + 0.5f * g->tick_s * loop->a_m_s2);
    loop->v_m_s += g->tick_s * loop->a_m_s2;
    if (loop->at_stop)
        loop->v_m_s *= 0.9f;
    loop->lagging_m += g->position_rate * (loop->x_m - loop->lagging_m);
}
