"""Mutants of supervisor.c that behave as the original, each with the reason."""

EQUIVALENT = {
    "return value < INT32_MAX ? (int32_t)value : INT32_MAX;: < -> <= at 18": "at the bound both sides are it",
    "return capped(a > b ? (uint32_t)a - (uint32_t)b : (uint32_t)b - (uint32_t)a);: > -> >= at 21": (
        "of equal numbers both differences are zero"
    ),
    "return heat < end ? (int16_t)(supervisor->derate_cN64_K_q8 * ((end - heat) >> 8) >> 16) : 0;"
    ": < -> <= at 17": "at the end the product is zero as well",
    "#define BIT(fault) ((uint32_t)1 << (fault)): 1 -> 2 at 31": "all faults move one bit up alike",
    "#define MASK(COLUMN_BIT) (0 FAULT_TABLE(COLUMN_BIT)): 0 -> 1 at 27": "bit 0 is that of no fault",
    "for (; fresh; fresh &= fresh - 1) /* a bit at a time */: 1 -> 2 at 36": (
        "takes the lowest bit as well, as bit 0 is that of no fault"
    ),
    "me->position_known = 1;: 1 -> 2 at 26": "only ever compared with zero",
    "supervisor->host_heard = 1;: 1 -> 2 at 30": "only ever compared with zero",
    "uint32_t time_us = settings->heat_time_ms * 1000, rest = settings->tick_us, rate = 0;: 0 -> 1 at 88": (
        "32 shifts leave nothing of the first value"
    ),
    "uint32_t time_us = settings->heat_time_ms * 1000, rest = settings->tick_us, rate = 0;"
    ": 0 -> (-1) at 88": ("32 shifts leave nothing of the first value"),
    "X(IMAGE_CORRUPT, ELSEWHERE, ANY, STOP, offset,: ANY -> GONE at 33": (
        "its condition never holds, so that it has always gone"
    ),
    "return (0 FAULT_TABLE(OR_MARGIN)) >= 0;: >= -> > at 39": "the long way finds what the short one does",
    "return (0 FAULT_TABLE(OR_MARGIN)) >= 0;: 0 -> 1 at 13": "the long way finds what the short one does",
    "return (0 FAULT_TABLE(OR_MARGIN)) >= 0;: 0 -> (-1) at 13": "the long way finds what the short one does",
    "return (0 FAULT_TABLE(OR_MARGIN)) >= 0;: 0 -> 1 at 42": "the long way finds what the short one does",
    "if (end_K_q16 > heat_K_q16): > -> >= at 19": "at the bound the step is nothing",
    "set->force_gain_q14 ? set->over_force_cN64 - found->force_cN64 : 0, "
    "found->force_cN64, set->over_force_cN64): 0 -> 1 at 72": "neither margin is below zero",
    "0, me->now.value, me->now.bound): 0 -> 1 at 7": "neither margin is below zero",
    "supervisor->present = 0;: 0 -> 1 at 31": "bit 0 is that of no fault",
}
