"""Mutants that behave like the original, by source, each with the reason."""
# ruff: noqa: E501

SUPERVISOR = {
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
    "X(IMAGE_CORRUPT, EXTERNAL, ANYTIME, STOP, offset,: ANYTIME -> INACTIVE at 32": (
        "its condition is never true, so it is always inactive"
    ),
    "return (0 FAULT_TABLE(OR_MARGIN)) >= 0;: >= -> > at 39": "the slow path gives the same result",
    "return (0 FAULT_TABLE(OR_MARGIN)) >= 0;: 0 -> 1 at 13": "the slow path gives the same result",
    "return (0 FAULT_TABLE(OR_MARGIN)) >= 0;: 0 -> (-1) at 13": "the slow path gives the same result",
    "return (0 FAULT_TABLE(OR_MARGIN)) >= 0;: 0 -> 1 at 42": "the slow path gives the same result",
    "set->force_gain_q14 ? set->over_force_cN64 - derived->force_cN64 : 0, "
    "derived->force_cN64, set->over_force_cN64): 0 -> 1 at 74": "neither margin is negative",
    "0, me->now.value, me->now.bound): 0 -> 1 at 7": "neither margin is negative",
    "supervisor->active = 0;: 0 -> 1 at 30": "bit 0 belongs to no fault",
}
HEAT = {
    "if (elapsed_ticks > 1) /* missed ticks had the duty of the one before */: > -> >= at 23": "no missed tick adds nothing",
    "if (elapsed_ticks > 1) /* missed ticks had the duty of the one before */: 1 -> (0) at 25": "no missed tick adds nothing",
    "return a < b ? a : b;: < -> <= at 14": "equal numbers are each the lower one",
    "return a > b ? a : b;: > -> >= at 14": "equal numbers are each the higher one",
    "if (part_q32 >> 16): >> -> << at 18": "the long way is the same",
    "if (part_q32 >> 16): 16 -> (15) at 21": "the long way is the same",
    "if (end_q16 > coil_q16): > -> >= at 17": "at the end the step is zero",
    "if (elapsed_ticks > 1): > -> >= at 23": "no missed tick heats nothing",
    "if (elapsed_ticks > 1): 1 -> (0) at 25": "no missed tick heats nothing",
    "if (me->end_K_q16 <= me->coil_K_q16): <= -> < at 23": "at the end the step is zero",
}
THERMISTOR = {
    "return a > HOTTEST_K_q16 - b ? HOTTEST_K_q16 : a + b;: > -> >= at 14": "at the bound both are equal",
    "uint32_t last = me->reading_K_q16, change = reading > last ? reading - last : last - reading;: > -> >= at 57": (
        "both differences of equal numbers are zero"
    ),
    "me->excess_K_q16 = most > me->reading_K_q16 ? most - me->reading_K_q16 : 0;: > -> >= at 29": (
        "the difference of equal numbers is zero"
    ),
    "me->excess_K_q16 = most > me->reading_K_q16 ? most - me->reading_K_q16 : 0;: 0 -> 1 at 78": (
        "the bound is below the reading in this sample, and in the next the excess is 1 either way"
    ),
    "uint32_t lowest = rise > margin ? rise - margin : 0;: > -> >= at 28": "the difference of equal numbers is zero",
    "uint32_t lowest = rise > margin ? rise - margin : 0;: 0 -> 1 at 55": "the thermal model passes a heat of 1 or more",
    "if (heat > highest): > -> >= at 14": "at the bound both are equal",
    "return heat < lowest ? lowest : heat;: < -> <= at 17": "at the bound both are equal",
    "fail(me, FDVV_THERMISTOR_IS_OPEN, fdvv_clamp(counts, 0, INT16_MAX), FDVV_THERMISTOR_OPEN);: 0 -> 1 at 62": (
        "the counts are beyond those of an open wire"
    ),
    "fail(me, FDVV_THERMISTOR_IS_OPEN, fdvv_clamp(counts, 0, INT16_MAX), FDVV_THERMISTOR_OPEN);: 0 -> (-1) at 62": (
        "the counts are beyond those of an open wire"
    ),
    "me->is_known = 1;: 1 -> 2 at 20": "only compared with zero",
}
SETTINGS = {
    "return gain == 0 || (uint32_t)(gain < 0 ? -gain : gain) > steepest;: < -> <= at 41": (
        "a gain of zero was refused before"
    ),
    "return gain == 0 || (uint32_t)(gain < 0 ? -gain : gain) > steepest;: 0 -> 1 at 43": (
        "a gain of zero was refused before"
    ),
    "return 1 + FDVV_SETTINGS_FIELD_position_gain_q14;: + -> - at 18": "the number of this field is zero",
    "if (settings->duty_gain_q16 > largest_gain_q16(settings, limits)): > -> >= at 33": (
        "the largest gain is replaced by itself"
    ),
    "ROW(tick_us, tick_low_us, 1),: 1 -> 2 at 31": "only compared with zero",
    "ROW(full_duty_rise_K, full_duty_rise_K, 1),: 1 -> 2 at 45": "only compared with zero",
}
EQUIVALENT = {"supervisor": SUPERVISOR, "heat": HEAT, "thermistor": THERMISTOR, "settings": SETTINGS}
