/* Simulation of a finger pressing a real button; SI units, x positive downward. */
#ifndef FDVV_BUTTON_H
#define FDVV_BUTTON_H

#include "fdvv.h"

/* Constant parameters. Forces of the button act between its slider and its housing, which moves with two modes of the
 * plate. A loss is 1.5 times alpha of Hunt and Crossley. */
typedef struct {
    fdvv_finger finger;
    fdvv_gesture gesture;
    double sensor_mass_kg;        /* or a bare patch of skin */
    double contact_stiffness_N_m;
    double contact_loss_s_m;
    double sensor_rc_s;
    double slider_mass_kg;
    double viscous_N_s_m;
    double bristle_m;             /* displacement after which sliding friction (or the dome's arm) is fully developed */
    double relax_1_s;             /* its relaxation rate at rest; 0: none */
    double law_ratio;             /* force increases by this times log(1 + speed / law_speed) */
    double law_speed_m_s;
    double law_s_m;               /* and by this times speed */
    double travel_m;
    double bottom_stiffness_N_m;
    double bottom_loss_s_m;
    double top_stiffness_N_m;
    double top_loss_s_m;
    double leaf_mass_kg;          /* 0: a dome, without leaf and cam */
    double leaf_stiffness_N_m;
    double leaf_preload_N;        /* of the leaf at 0, where it just touches the fixed contact */
    double leaf_damping_N_s_m;
    double cam_stiffness_N_m;     /* leaf on cam */
    double cam_loss_s_m;
    double fixed_stiffness_N_m;   /* fixed contact */
    double fixed_loss_s_m;
    double close_m;               /* a dome's circuit closes here */
    double open_m;                /* and opens here */
    double plate_1_kg[2];         /* 1 / modal mass; 0: fixed */
    double plate_rad_s[2];
    double plate_damping_1_s[2];  /* twice damping ratio times angular frequency */
    double snap_ratio;            /* fraction of the leaf's force on the fixed contact that drives the plate */
    double table_start_m;
    double table_step_m;
    double step_s;
} fdvv_button_model;

/* Discretization of a press. */
typedef struct {
    int64_t settle_ticks;    /* run before the record starts */
    int64_t ticks;           /* recorded */
    int64_t steps_per_tick;  /* of the motor noise */
    int64_t steps_per_row;   /* divides steps_per_tick */
    int64_t cells;           /* of the table */
    int64_t audit;           /* 1: compute the energy balance */
} fdvv_button_grid;

#define FDVV_BUTTON_COLUMNS 13
#define FDVV_BUTTON_CELL 13

/* Simulate one press.
 *
 * table (cells, FDVV_BUTTON_CELL), u running from 0 to 1 over a cell: four coefficients in u of the elastic
 * force N (spring or dome), four of the cam's height m, two of the rail's friction N (or the dome's arm), two
 * of the cam's friction coefficient, and the energy J of the elastic force at the cell's start.
 * effort_ratio (settle_ticks + ticks + 1,) modulates the muscle's force, offset_m (of the same shape) is added to the
 * referent; both are linear between ticks.
 * rows (FDVV_BUTTON_COLUMNS, ticks * steps_per_tick / steps_per_row), written: time s, slider m, m/s, m/s2,
 * contact force N, filtered force N, finger m, leaf m, force of the fixed contact N, plate m, plate m/s,
 * closed 0/1, energy unaccounted for J (0 without audit).
 * switching (2,), written: when the circuit first closed and when it last opened, NaN if it never did.
 * Returns 0, or 1 if the grid is invalid (nothing is written then).
 */
int fdvv_button_press(const fdvv_button_model *model, const fdvv_button_grid *grid, const double *table,
                      const double *effort_ratio, const double *offset_m, double *rows, double *switching);

/* Move the slider of a button with a fixed housing, as a force tester does: down by stroke_m plus 0.1 mm, and back, at
 * speed_m_s. rows (2 * count, 2), written: displacement m and force N (not negative: the tester cannot pull), press
 * then release, each at count equidistant displacements including the ends.
 * Returns 0, or 1 if an argument is out of range.
 */
int fdvv_button_probe(const fdvv_button_model *model, int64_t cells, const double *table, double stroke_m,
                      double speed_m_s, int64_t count, double *rows);

/* Sizes of the structures in bytes, for Python to compare with its own. */
void fdvv_button_sizes(int64_t *model_bytes, int64_t *grid_bytes);

#endif
