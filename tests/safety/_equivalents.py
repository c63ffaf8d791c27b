"""Mutants of supervisor.c that behave like the original, each with the reason."""

EQUIVALENT = {
    "return value < INT32_MAX ? (int32_t)value : INT32_MAX;: < -> <= at 18": "at the bound both are equal",
    "return clamp_to_int32(a > b ? (uint32_t)a - (uint32_t)b : (uint32_t)b - (uint32_t)a);: > -> >= at 29": (
        "both differences of equal numbers are zero"
    ),
    "return heat < end ? (int16_t)(supervisor->derate_cN64_K_q8 * ((end - heat) >> 8) >> 16) : 0;"
    ": < -> <= at 17": "at the end the product is zero too",
    "#define BIT(fault) ((uint32_t)1 << (fault)): 1 -> 2 at 31": "all faults move up by one bit",
    "#define MASK(COLUMN_BIT) (0 FAULT_TABLE(COLUMN_BIT)): 0 -> 1 at 27": "bit 0 belongs to no fault",
    "for (; newly_active; newly_active &= newly_active - 1) /* clears the lowest bit */: 1 -> 2 at 57": (
        "clears the lowest bit as well, since bit 0 belongs to no fault"
    ),
    "me->position_known = 1;: 1 -> 2 at 26": "only compared with zero",
    "supervisor->host_heard = 1;: 1 -> 2 at 30": "only compared with zero",
    "uint32_t quotient = 0;: 0 -> 1 at 25": "32 shifts remove the initial value",
    "uint32_t quotient = 0;: 0 -> (-1) at 25": "32 shifts remove the initial value",
    "X(IMAGE_CORRUPT, EXTERNAL, ANYTIME, STOP, offset,: ANYTIME -> INACTIVE at 32": (
        "its condition is never true, so it is always inactive"
    ),
    "return (0 FAULT_TABLE(OR_MARGIN)) >= 0;: >= -> > at 39": "the slow path gives the same result",
    "return (0 FAULT_TABLE(OR_MARGIN)) >= 0;: 0 -> 1 at 13": "the slow path gives the same result",
    "return (0 FAULT_TABLE(OR_MARGIN)) >= 0;: 0 -> (-1) at 13": "the slow path gives the same result",
    "return (0 FAULT_TABLE(OR_MARGIN)) >= 0;: 0 -> 1 at 42": "the slow path gives the same result",
    "return a < b ? a : b;: < -> <= at 14": "equal numbers are each the lower one",
    "return a > b ? a : b;: > -> >= at 14": "equal numbers are each the higher one",
    "if (part_q32 >> 16): >> -> << at 18": "the long way is the same",
    "if (part_q32 >> 16): 16 -> (15) at 21": "the long way is the same",
    "if (end_q16 > heat_q16): > -> >= at 17": "at the end the step is zero",
    "if (elapsed_ticks > 1): > -> >= at 23": "no missed tick heats nothing",
    "if (elapsed_ticks > 1): 1 -> (0) at 25": "no missed tick heats nothing",
    "if (me->end_K_q16 <= me->heat_K_q16): <= -> < at 23": "at the end the step is zero",
    "set->force_gain_q14 ? set->over_force_cN64 - derived->force_cN64 : 0, "
    "derived->force_cN64, set->over_force_cN64): 0 -> 1 at 74": "neither margin is negative",
    "0, me->now.value, me->now.bound): 0 -> 1 at 7": "neither margin is negative",
    "supervisor->active = 0;: 0 -> 1 at 30": "bit 0 belongs to no fault",
}
