/* Simulation of a whole press: the rig, controlled by the core of the firmware. */
#include "twin.h"

static int arm(fdvv_core *core) {
    return fdvv_supervisor_ask(&core->supervisor, &core->settings, FDVV_ASK_BOOTED, 0) == FDVV_REFUSAL_NONE &&
           fdvv_supervisor_ask(&core->supervisor, &core->settings, FDVV_ASK_ARM, 0) == FDVV_REFUSAL_NONE;
}

int fdvv_twin_begin(const fdvv_core *core, fdvv_rig *rig, const fdvv_rig_model *model, const fdvv_rig_grid *grid,
                    const uint8_t *image, fdvv_inputs *inputs) {
    if (fdvv_rig_start(rig, model, grid, core->stop_us) || !fdvv_rig_load(rig, image)) return 1;
    fdvv_rig_look(rig, inputs);
    return 0;
}

void fdvv_twin_run(fdvv_core *core, fdvv_rig *rig, int64_t ticks, const fdvv_twin_noise *noise, double *rows,
                   double *tick_rows, fdvv_outputs *outputs, fdvv_inputs *inputs) {
    int64_t row_doubles = FDVV_RIG_COLUMNS * rig->grid.steps_per_tick / rig->grid.steps_per_row;
    for (int64_t k = 0; k < ticks; k++) {
        fdvv_rig_noise tick_noise = {noise->position_m + k * rig->grid.reads, noise->force_N[k], noise->keycap[k],
                               noise->effort_ratio[k], noise->latency[k]};
        fdvv_outputs out;
        fdvv_supervisor_host_seen(&core->supervisor, inputs->time_us);
        fdvv_core_tick(core, inputs, &out);
        fdvv_core_after_tick(core, inputs);
        if (rows) {
            fdvv_rig_write_tick(rig, tick_rows + k * FDVV_RIG_TICK_COLUMNS);
            outputs[k] = out;
        }
        fdvv_rig_tick(rig, &out, &tick_noise, rows ? rows + k * row_doubles : 0, inputs);
    }
}

static fdvv_twin_noise from_tick(const fdvv_twin_noise *n, int64_t k, int64_t reads) {
    fdvv_twin_noise rest = {n->position_m + k * reads, n->force_N + k, n->keycap + k, n->effort_ratio + k,
                            n->latency + k};
    return rest;
}

int fdvv_twin_press(const fdvv_rig_model *model, const fdvv_rig_grid *grid, const fdvv_twin_press_plan *plan,
                    const fdvv_settings *settings, const fdvv_board_limits *limits, const fdvv_force_loop_gains *loop,
                    const uint8_t *image, const fdvv_twin_noise *noise, double *rows, double *tick_rows,
                    fdvv_outputs *outputs) {
    fdvv_rig rig;
    fdvv_core core;
    fdvv_inputs inputs;
    fdvv_core_init(&core, settings, limits);
    fdvv_core_close_loop(&core, loop);
    fdvv_core_activate(&core, image);
    fdvv_core_announce(&core, (uint16_t)plan->announced_mm_s16);
    if (plan->settle_ticks < 0 || plan->ticks < 1 || !arm(&core)) return 2;
    if (fdvv_twin_begin(&core, &rig, model, grid, image, &inputs)) return 1;
    fdvv_rig_press(&rig, &plan->gesture, plan->stiffness_N_m, plan->damping_N_s_m,
                   -(double)plan->settle_ticks * (double)grid->steps_per_tick * model->step_s);
    fdvv_twin_noise recorded = from_tick(noise, plan->settle_ticks, grid->reads);
    fdvv_twin_run(&core, &rig, plan->settle_ticks, noise, 0, 0, 0, &inputs);
    fdvv_twin_run(&core, &rig, plan->ticks, &recorded, rows, tick_rows, outputs, &inputs);
    return 0;
}

void fdvv_twin_sizes(int64_t *plan_bytes, int64_t *noise_bytes, int64_t *outputs_bytes) {
    *plan_bytes = (int64_t)sizeof(fdvv_twin_press_plan);
    *noise_bytes = (int64_t)sizeof(fdvv_twin_noise);
    *outputs_bytes = (int64_t)sizeof(fdvv_outputs);
}
