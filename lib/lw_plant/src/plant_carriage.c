/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * @brief Motor, screw and carriage.
 *
 * The rotor hangs in the motor's field as a pendulum in gravity: the field pulls with the sine of
 * the electrical angle between the two, weaker the faster the motor turns. Following, lagging,
 * pull-out, slipping, and falling back in at a slow field all come from this one equation.
 */
#include <math.h>

#include "plant_internal.h"

#define UM_PER_MM                        1000.0
#define TWO_PI                           6.283185307179586
#define FULL_STEPS_PER_ELECTRICAL_PERIOD 4.0

/** The field's speed is seen through a low-pass filter, so that a single step is no hammer blow. */
#define FIELD_SPEED_TIME_CONSTANT_S 1e-3

/** A field that is slower stands: the filter's smallest numbers would never go away. */
#define FIELD_STANDS_USTEPS_PER_S 1e-200

/** Part of the way to its value that a low-pass filter goes in a substep, at any length of it. */
#define FILTERED(time_constant_s) (1.0 - exp(-SUBSTEP_S / (time_constant_s)))

/** More than any rounding of what is added up in a substep. */
#define ROUNDING 1e-9

/** And the motor's through the coupling's elasticity. */
#define COUPLING_TIME_CONSTANT_S 5e-3

void lw_plant_carriage_init(struct lw_plant_carriage *carriage,
			    const struct lw_plant_config *config)
{
	double usteps_per_um = (double)config->usteps_per_rev / config->screw_lead_um;
	double usteps_per_mm = usteps_per_um * UM_PER_MM;
	double period = FULL_STEPS_PER_ELECTRICAL_PERIOD * config->usteps_per_rev /
			config->full_steps_per_rev;
	double holding_acceleration = config->holding_acceleration_mm_per_s2 * usteps_per_mm;
	/* Small oscillation about the field: omega^2 = d(a0 * sin(2 pi x / period)) / dx. */
	double natural_rad_per_s = sqrt(holding_acceleration * TWO_PI / period);

	*carriage = (struct lw_plant_carriage){
		.commanded_usteps = llround(config->start_um * usteps_per_um),
		.last_commanded_usteps = llround(config->start_um * usteps_per_um),
		.position_usteps = config->start_um * usteps_per_um,
		.load_usteps = config->start_um * usteps_per_um,
		.backlash_usteps = config->backlash_um * usteps_per_um,
		.grip_usteps_per_s2 = config->coupling_grip_mm_per_s2 * usteps_per_mm,
		.period_usteps = period,
		.periods_per_ustep = 1.0 / period,
		.holding_usteps_per_s2 = holding_acceleration,
		.half_torque_s_per_ustep =
			1.0 / (config->half_torque_speed_mm_per_s * usteps_per_mm),
		.top_s_per_ustep = config->top_speed_mm_per_s > 0.0
					   ? 1.0 / (config->top_speed_mm_per_s * usteps_per_mm)
					   : 0.0,
		.damping_per_s = 2.0 * config->damping_ratio * natural_rad_per_s,
		.friction_usteps_per_s2 = config->friction_mm_per_s2 * usteps_per_mm,
		.flange_usteps = config->flange_um * usteps_per_um,
		.usteps_per_um = usteps_per_um,
		.reversed = config->carriage_reversed,
		.loose = config->backlash_um > 0.0 || config->coupling_grip_mm_per_s2 > 0.0,
	};
}

/** fmin(fmax(value, least), most), of which no compiler makes two instructions: there is no NaN. */
static inline double between(double value, double least, double most)
{
	const double above = value > least ? value : least;

	return above < most ? above : most;
}

/** How far the rotor is behind the nearest place in step with its field. */
static double lag_usteps(const struct lw_plant_carriage *carriage)
{
	return (double)carriage->commanded_usteps - carriage->position_usteps -
	       (double)carriage->pole * carriage->period_usteps;
}

/**
 * Sine and cosine of an angle in electrical periods, from -1/2 to 1/2, to 1e-7: as series, for two
 * C libraries differ in the last bit, and a launch played elsewhere is to be the same to the bit.
 */
static void sine_and_cosine(double periods, double *sine, double *cosine)
{
	const bool far_side = fabs(periods) > 0.25;
	const double angle = TWO_PI * (far_side ? copysign(0.5, periods) - periods : periods);
	const double square = angle * angle;
	const double even =
		1.0 + square * (-1.0 / 2 +
				square * (1.0 / 24 +
					  square * (-1.0 / 720 +
						    square * (1.0 / 40320 +
							      square * (-1.0 / 3628800 +
									square / 479001600)))));

	*sine = angle *
		(1.0 + square * (-1.0 / 6 +
				 square * (1.0 / 120 +
					   square * (-1.0 / 5040 + square * (1.0 / 362880 -
									     square / 39916800)))));
	*cosine = far_side ? -even : even;
}

/**
 * Acceleration by the field. Damping acts through the field too, hence the cosine: it holds the
 * rotor in step, but gives a rotor that slips nothing on average, and never more than the field
 * has.
 */
static double field_acceleration(const struct lw_plant_carriage *carriage)
{
	const double most = carriage->holding_usteps_per_s2;
	const double speed = fabs(carriage->speed_usteps_per_s);
	const double left = 1.0 - speed * carriage->top_s_per_ustep;
	double sine;
	double cosine;
	double pull;

	sine_and_cosine(lag_usteps(carriage) * carriage->periods_per_ustep, &sine, &cosine);
	pull = most * sine + carriage->damping_per_s * cosine *
				     (carriage->field_usteps_per_s - carriage->speed_usteps_per_s);
	pull = between(pull, -most, most);
	return pull * (left > 0.0 ? left : 0.0) / (1.0 + speed * carriage->half_torque_s_per_ustep);
}

int64_t lw_plant_carriage_pole(const struct lw_plant_carriage *carriage, double position_usteps)
{
	return llround(((double)carriage->commanded_usteps - position_usteps) /
		       carriage->period_usteps);
}

static void count_pole_slips(struct lw_plant_carriage *carriage)
{
	if (fabs(lag_usteps(carriage)) > carriage->period_usteps / 2.0) {
		int64_t pole = lw_plant_carriage_pole(carriage, carriage->position_usteps);
		int64_t slips = pole - carriage->pole;

		carriage->pole_slips += (uint64_t)(slips < 0 ? -slips : slips);
		carriage->pole = pole;
	}
}

/**
 * Does friction hold a carriage that stands? Asked without the field's sine, which is never more
 * than its angle: where this says no, it may still hold.
 */
static bool friction_holds(const struct lw_plant_carriage *carriage)
{
	double most = fabs(carriage->side_load_usteps_per_s2);

	if (carriage->enabled && !carriage->alarm) {
		most += carriage->holding_usteps_per_s2 *
				fabs(lag_usteps(carriage) * TWO_PI * carriage->periods_per_ustep) +
			carriage->damping_per_s * fabs(carriage->field_usteps_per_s);
	}
	return most < carriage->friction_usteps_per_s2 * (1.0 - ROUNDING);
}

/**
 * A coupling slips by what the screw's speed lacks to the motor's. It is elastic: single microsteps
 * do not make it slip. Friction is on the screw's side: it hinders a start and helps a stop.
 */
static void slip_coupling(struct lw_plant_carriage *carriage)
{
	const double friction = carriage->friction_usteps_per_s2;

	carriage->motor_usteps_per_s +=
		(carriage->path_usteps_per_s - carriage->motor_usteps_per_s) *
		FILTERED(COUPLING_TIME_CONSTANT_S);

	const double missing = carriage->motor_usteps_per_s - carriage->screw_usteps_per_s;
	const bool faster = missing * carriage->screw_usteps_per_s >= 0.0;
	const double grip = carriage->grip_usteps_per_s2 + (faster ? -friction : friction);

	carriage->screw_usteps_per_s +=
		copysign(fmin(fabs(missing), fmax(grip, 0.0) * SUBSTEP_S), missing);
	carriage->coupling_slip_usteps +=
		(carriage->motor_usteps_per_s - carriage->screw_usteps_per_s) * SUBSTEP_S;
}

/** Plan where the carriage goes while the rotor goes its way. */
static void follow_rotor(struct lw_plant_carriage *carriage)
{
	if (!carriage->loose) {
		carriage->load_usteps = carriage->position_usteps;
		carriage->load_path_usteps_per_s = carriage->path_usteps_per_s;
		return;
	}
	if (carriage->grip_usteps_per_s2 > 0.0) {
		slip_coupling(carriage);
	}

	const double slack = carriage->backlash_usteps / 2.0;
	const double screw = carriage->position_usteps + carriage->path_usteps_per_s * SUBSTEP_S -
			     carriage->coupling_slip_usteps;
	const double pushed = fmin(fmax(carriage->load_usteps, screw - slack), screw + slack);
	const double end = fmin(fmax(pushed, -carriage->flange_usteps), carriage->flange_usteps);

	carriage->coupling_slip_usteps += pushed - end; /* the end stop holds the screw, too */
	carriage->load_path_usteps_per_s = (end - carriage->load_usteps) * SUBSTEPS_PER_S;
}

static void move_rotor(struct lw_plant_carriage *carriage, uint64_t begin_ns)
{
	double steps = (double)(carriage->commanded_usteps - carriage->last_commanded_usteps);

	carriage->position_usteps += carriage->path_usteps_per_s * SUBSTEP_S;
	carriage->last_commanded_usteps = carriage->commanded_usteps;
	carriage->field_usteps_per_s += (steps * SUBSTEPS_PER_S - carriage->field_usteps_per_s) *
					FILTERED(FIELD_SPEED_TIME_CONSTANT_S);
	if (fabs(carriage->field_usteps_per_s) < FIELD_STANDS_USTEPS_PER_S) {
		carriage->field_usteps_per_s = 0.0; /* a processor is slow with what comes next */
	}
	count_pole_slips(carriage);
	if (begin_ns < carriage->stall_end_ns) {
		carriage->speed_usteps_per_s = 0.0;
		carriage->path_usteps_per_s = 0.0;
		return;
	}

	if (carriage->speed_usteps_per_s == 0.0 && carriage->path_usteps_per_s == 0.0 &&
	    friction_holds(carriage)) {
		return;
	}

	double acceleration = carriage->side_load_usteps_per_s2;

	if (carriage->enabled && !carriage->alarm) {
		acceleration += field_acceleration(carriage);
	}

	/* Friction takes speed away but cannot reverse it; what it takes wholly stands still. */
	double speed = carriage->speed_usteps_per_s + acceleration * SUBSTEP_S;

	double left = fabs(speed) - carriage->friction_usteps_per_s2 * SUBSTEP_S;

	speed = copysign(left > 0.0 ? left : 0.0, speed);

	double room = copysign(carriage->flange_usteps, speed) - carriage->position_usteps;

	if (fabs(speed) * SUBSTEP_S < fabs(room)) {
		carriage->speed_usteps_per_s = speed;
		carriage->path_usteps_per_s = speed;
	} else {
		carriage->speed_usteps_per_s = 0.0;
		carriage->path_usteps_per_s = room * SUBSTEPS_PER_S;
	}
}

void lw_plant_carriage_substep(struct lw_plant_carriage *carriage, uint64_t begin_ns)
{
	carriage->load_usteps += carriage->load_path_usteps_per_s * SUBSTEP_S;
	move_rotor(carriage, begin_ns);
	follow_rotor(carriage);
}

static double elapsed_s(const struct lw_plant *plant)
{
	return (double)(plant->now_ns - substep_begin_ns(plant)) * S_PER_NS;
}

double lw_plant_carriage_usteps(const struct lw_plant *plant)
{
	return plant->carriage.load_usteps +
	       plant->carriage.load_path_usteps_per_s * elapsed_s(plant);
}

double lw_plant_rotor_usteps(const struct lw_plant *plant)
{
	return plant->carriage.position_usteps +
	       plant->carriage.path_usteps_per_s * elapsed_s(plant);
}

void lw_plant_carriage_halt(struct lw_plant *plant)
{
	struct lw_plant_carriage *carriage = &plant->carriage;

	carriage->load_usteps = lw_plant_carriage_usteps(plant);
	carriage->load_path_usteps_per_s = 0.0;
	carriage->position_usteps = lw_plant_rotor_usteps(plant);
	carriage->speed_usteps_per_s = 0.0;
	carriage->path_usteps_per_s = 0.0;
	carriage->motor_usteps_per_s = 0.0;
	carriage->screw_usteps_per_s = 0.0;
}

void lw_plant_carriage_place(struct lw_plant *plant, double position_usteps)
{
	lw_plant_carriage_halt(plant);
	/* By hand the carriage turns the screw, and that the motor. */
	plant->carriage.position_usteps += position_usteps - plant->carriage.load_usteps;
	plant->carriage.load_usteps = position_usteps;
	if (!plant->carriage.loose) {
		plant->carriage.position_usteps = position_usteps;
	}
}

void lw_plant_enable(struct lw_plant *plant, bool enabled)
{
	plant->carriage.enabled = enabled;
}

void lw_plant_reference(struct lw_plant *plant)
{
	struct lw_plant_carriage *carriage = &plant->carriage;
	int64_t pole = lw_plant_carriage_pole(carriage, lw_plant_rotor_usteps(plant));
	int64_t slipped = pole * (int64_t)carriage->period_usteps;

	carriage->commanded_usteps -= slipped;
	carriage->last_commanded_usteps -= slipped;
	carriage->pole -= pole;
}
