/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * @brief The machine outside of the controller's pins: drum, encoder, carriage, switches, faults.
 *
 * An event-driven model on a virtual clock. The host asks for the time of the next event, executes
 * it, passes the pins that changed to the controller and the controller's step pulses back:
 *
 * @code
 * while (lw_plant_next_event_ns(&plant) <= until_ns) {
 *         uint32_t changed = lw_plant_advance(&plant);
 *         if (changed & LW_PLANT_ENCODER) {
 *                 int step = controller(plant.pins.encoder_a, plant.pins.encoder_b);
 *                 if (step != 0) {
 *                         lw_plant_step(&plant, step);
 *                 }
 *         }
 * }
 * @endcode
 *
 * The mechanics are integrated every #LW_PLANT_SUBSTEP_NS; pins change at the interpolated instants
 * in between. Two plants with the same configuration, seed and calls give the same trace.
 *
 * Position 0 is the middle of the travel; positive is towards the "plus" switch. A positive step
 * direction moves the carriage positive, a positive drum speed hauls rope in. No function may be
 * called from an interrupt, and none locks: one context owns a plant.
 */
#ifndef LW_PLANT_H
#define LW_PLANT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Period of the mechanics integration: the pull-out is that of the equation within 1.25 %
 * (tested). */
#define LW_PLANT_SUBSTEP_NS 200000u

/** Time that never comes. */
#define LW_PLANT_NEVER_NS UINT64_MAX

/** Largest number of points in a drum speed profile. */
#define LW_PLANT_PROFILE_POINTS_MAX 8192u

/** Largest drum speed, either direction. */
#define LW_PLANT_DRUM_MILLI_RPM_MAX 5000000

/** Index of a switch in the arrays of struct lw_plant_pins. */
enum lw_plant_side {
	LW_PLANT_PLUS = 0,
	LW_PLANT_MINUS = 1,
	LW_PLANT_SIDES = 2,
};

/** Bits of the mask that lw_plant_advance() returns: which pins changed. */
enum lw_plant_changed {
	LW_PLANT_ENCODER_A = 1 << 0,
	LW_PLANT_ENCODER_B = 1 << 1,
	LW_PLANT_ENCODER = LW_PLANT_ENCODER_A | LW_PLANT_ENCODER_B,
	LW_PLANT_LIMIT_PLUS = 1 << 2,
	LW_PLANT_LIMIT_MINUS = 1 << 3,
	LW_PLANT_OVERTRAVEL_PLUS = 1 << 4,
	LW_PLANT_OVERTRAVEL_MINUS = 1 << 5,
	LW_PLANT_ENCODER_INDEX = 1 << 6,
	LW_PLANT_STEPPER_ALARM = 1 << 7,
	LW_PLANT_TRIM_BUTTONS = 1 << 8,
};

/**
 * A machine: its physical constants, how it is wired, and what is broken from the beginning. Fill
 * with lw_plant_config_default(), then change what differs, by member or by name
 * (lw/plant_figures.h).
 */
struct lw_plant_config {
	/** Encoder pulses per encoder revolution; a pulse has four A/B transitions. */
	uint32_t encoder_pulses_per_rev;
	/** Encoder revolutions per drum revolution, as a fraction. */
	uint32_t encoder_revs_per_drum_rev_num;
	uint32_t encoder_revs_per_drum_rev_den;
	/** How fast the drum follows lw_plant_drum_target(). A profile is not limited by it. */
	double drum_acceleration_rpm_per_s;

	/** Carriage travel per screw revolution. */
	uint32_t screw_lead_um;
	/** Step pulses per screw revolution. */
	uint32_t usteps_per_rev;
	/** Full steps per motor revolution; four of them are one electrical period. */
	uint32_t full_steps_per_rev;

	/** Largest acceleration that the motor can give the carriage at standstill, a0. */
	double holding_acceleration_mm_per_s2;
	/** Speed v_half at which that has fallen to a half: a(v) = a0 / (1 + |v| / v_half). */
	double half_torque_speed_mm_per_s;
	/** Speed at which nothing is left of it; it falls straight to there. 0: never. */
	double top_speed_mm_per_s;
	/** Damping of the rotor in its field, as a fraction of critical damping at standstill. */
	double damping_ratio;
	/** Coulomb friction, sliding and at rest. */
	double friction_mm_per_s2;

	/** Where the carriage is at power-up. */
	int32_t start_um;
	/** Mechanical end stops at plus and minus this position. */
	int32_t flange_um;
	/** Overtravel switches trigger at plus and minus this position. */
	int32_t overtravel_um;
	/** Limit switches trigger at these positions (the minus one is negative) at zero speed. */
	int32_t limit_um[LW_PLANT_SIDES];
	/** Every switch releases this much further inward. */
	int32_t switch_hysteresis_um;
	/** A limit switch triggers, and releases, later in the direction of motion by this. */
	double limit_shift_um_per_mm_per_s;
	/** Both contacts of a limit switch are open for this time while the pole moves. */
	uint32_t contact_transit_us;
	/** The contact that closes bounces for this time. */
	uint32_t bounce_duration_us;
	/** Mean time between two changes of a bouncing contact. */
	uint32_t bounce_interval_us;

	/** Way that the screw goes before it takes the carriage along after a change of direction.
	 */
	double backlash_um;
	/** Largest acceleration, friction included, that the coupling between motor and screw
	 * holds; beyond it slips. 0: it never does. */
	double coupling_grip_mm_per_s2;
	/** Standard deviation of the place at which a limit switch triggers, from time to time. */
	double limit_scatter_um[LW_PLANT_SIDES];
	/** How far outward each actuation moves that place. */
	double limit_drift_um[LW_PLANT_SIDES];
	/** Of a million bytes on the line so many are disturbed; and while the carriage moves. */
	uint32_t line_errors_ppm;
	uint32_t line_errors_moving_ppm;

	/** The motor turns the wrong way. */
	bool carriage_reversed;
	/** Each encoder channel is wired to the other's pin. */
	bool encoder_swapped;
	/** Channel A, B reads low where it is high. */
	bool encoder_inverted[2];
	/** The encoder's index channel is not wired. */
	bool encoder_index_open;
	/** Each limit switch, each overtravel switch, is wired to the other side's pins. */
	bool limit_swapped;
	bool overtravel_swapped;
	/** A limit switch's NO and NC wires are exchanged. */
	bool limit_contacts_swapped[LW_PLANT_SIDES];
	/** enum lw_plant_switch_fault, and of an overtravel switch without the wires. */
	uint8_t limit_fault[LW_PLANT_SIDES];
	uint8_t overtravel_fault[LW_PLANT_SIDES];
	/** enum lw_plant_channel_fault of channel A, B. */
	uint8_t encoder_fault[2];
};

/** Levels that the controller can see. Written by lw_plant_advance() only; the host reads. */
struct lw_plant_pins {
	/** Quadrature channels; A leads B when the drum hauls in. */
	bool encoder_a;
	bool encoder_b;
	/** Index pulse of the encoder: one transition long, once per encoder revolution. */
	bool encoder_index;
	/** The stepper driver reports an alarm. */
	bool stepper_alarm;
	/** Contacts of the change-over limit switches. Actuated: NO closed, NC open. */
	struct {
		bool no_closed;
		bool nc_closed;
	} limit[LW_PLANT_SIDES];
	/** Overtravel switches, true when actuated. */
	bool overtravel[LW_PLANT_SIDES];
	/** Buttons for early and late reversal, true when pressed. */
	bool trim_buttons[2];
};

/** The rope on the drum: layer on layer, each of which makes the drum thicker. */
struct lw_plant_rope {
	/** Thickness of a layer; 0: the drum stays as thick as its core. */
	double layer_um;
	double turns_per_layer;
	/** Diameter of the bare drum. */
	double core_um;
};

/** What lw_plant_inject() can do. The comment says what the argument is. */
enum lw_plant_fault {
	/** Lock the carriage where it is: for N ms; 0 releases; negative until released. */
	LW_PLANT_FAULT_STALL,
	/**
	 * Move the carriage by N microsteps against its field, rounded to whole electrical periods
	 * because between those the rotor has no equilibrium. Not less than half a period.
	 */
	LW_PLANT_FAULT_SLIP,
	/** Constant load on the carriage in mm/s^2, positive pushes it positive; 0 ends it. */
	LW_PLANT_FAULT_SIDE_LOAD,
	/** Bounce duration of the limit switches in us. */
	LW_PLANT_FAULT_BOUNCE,
	/** State of a limit switch: enum lw_plant_switch_fault. */
	LW_PLANT_FAULT_LIMIT_PLUS,
	LW_PLANT_FAULT_LIMIT_MINUS,
	/** State of an overtravel switch: enum lw_plant_switch_fault without the wires. */
	LW_PLANT_FAULT_OVERTRAVEL_PLUS,
	LW_PLANT_FAULT_OVERTRAVEL_MINUS,
	/** Hide the next N whole encoder pulses (4 transitions each) from the pins. */
	LW_PLANT_FAULT_ENCODER_LOSE_PULSES,
	/** Merge the next N pairs of transitions: both channels change at once, N times. */
	LW_PLANT_FAULT_ENCODER_ILLEGAL,
	/** Rock the encoder N times one transition forth and back, 20 us each way. */
	LW_PLANT_FAULT_ENCODER_DITHER,
	/** Put the carriage at a position in um, at rest; within the end stops. */
	LW_PLANT_FAULT_PLACE_CARRIAGE,
	/** 1: the motor turns the wrong way; 0: the right way. */
	LW_PLANT_FAULT_CARRIAGE_REVERSED,
	/** Show N whole pulses (4 transitions each, 20 us apart) that the drum has not made. */
	LW_PLANT_FAULT_ENCODER_EXTRA_PULSES,
	/** 1: the stepper driver reports an alarm, and its motor has no current; 0: it works. */
	LW_PLANT_FAULT_STEPPER_ALARM,
	/** State of an encoder channel: enum lw_plant_channel_fault. */
	LW_PLANT_FAULT_ENCODER_A,
	LW_PLANT_FAULT_ENCODER_B,
	/** 1: the encoder gives index pulses; 0: its index channel is not wired. */
	LW_PLANT_FAULT_ENCODER_INDEX,
	/** An overtravel switch reads actuated for N us: a contact that opens for a moment. */
	LW_PLANT_FAULT_BLIP_PLUS,
	LW_PLANT_FAULT_BLIP_MINUS,
	/** No faults: 1 presses the button for early, or late, reversal; 0 lets go of it. */
	LW_PLANT_FAULT_TRIM_EARLY,
	LW_PLANT_FAULT_TRIM_LATE,
	/** The limit switches trigger, and release, N us late, as limit_shift_um_per_mm_per_s. */
	LW_PLANT_FAULT_SWITCH_LATE,
	LW_PLANT_FAULT_COUNT,
};

/** Ways in which a channel of the encoder can be broken. */
enum lw_plant_channel_fault {
	LW_PLANT_CHANNEL_OK,
	LW_PLANT_CHANNEL_STUCK_LOW,
	LW_PLANT_CHANNEL_STUCK_HIGH,
	/** A loose wire: low, then right, each for a random 1 to 3 ms. */
	LW_PLANT_CHANNEL_FLICKER,
	LW_PLANT_CHANNEL_FAULT_COUNT,
};

/** Ways in which a switch can be broken. */
enum lw_plant_switch_fault {
	LW_PLANT_SWITCH_OK,
	/** The pole does not move any more from, or returns to, the released position. */
	LW_PLANT_SWITCH_STUCK_RELEASED,
	/** The same, actuated. */
	LW_PLANT_SWITCH_STUCK_ACTUATED,
	/** The wire of the NO contact is broken: it reads open. */
	LW_PLANT_SWITCH_NO_BROKEN,
	/** The wire of the NC contact is broken: it reads open. */
	LW_PLANT_SWITCH_NC_BROKEN,
	/** The wires are shorted: both contacts read closed. */
	LW_PLANT_SWITCH_SHORTED,
	LW_PLANT_SWITCH_FAULT_COUNT,
};

/** One point of a drum speed profile; the speed is linear between points. */
struct lw_plant_profile_point {
	uint32_t time_ms;
	int32_t drum_milli_rpm;
};

/** What is really the case, whatever the pins say. */
struct lw_plant_truth {
	uint64_t time_ns;
	/** A/B transitions that the drum has really made, net, and its speed now. */
	int64_t drum_transitions;
	double drum_milli_rpm;
	/** Where the carriage really is, and how fast it goes. */
	double carriage_um;
	double carriage_usteps;
	double carriage_um_per_s;
	/** Where it would be, had it followed every step pulse; and how far it is behind. */
	int64_t commanded_usteps;
	double lag_usteps;
	/** Step pulses received, either direction. */
	uint64_t step_pulses;
	/** Lag in whole electrical periods (a multiple of 40 with the default motor); 0 in step. */
	int64_t slipped_usteps;
	/** How often the rotor has passed from one electrical period into a neighbouring one. */
	uint64_t pole_slips;
	/** The lag is less than half an electrical period. */
	bool in_sync;
	/** How far the coupling has slipped: the screw is behind the motor by so much. */
	double coupling_slip_um;
	/** Where the limit switches trigger next, at zero speed. */
	double limit_um[LW_PLANT_SIDES];
	/** Rope that lies on the drum, which was bare at the beginning: lw_plant_set_rope(). */
	double rope_um;
};

/** Private: one switch with its pole and its contacts. */
struct lw_plant_switch {
	uint64_t pole_ns;
	uint64_t contact_ns;
	uint64_t bounce_end_ns;
	uint64_t blip_end_ns;
	double trigger_usteps; /* where it actuates next, and where it then releases, outward */
	double release_usteps;
	double place_usteps; /* what trigger_usteps scatters about */
	double scatter_usteps;
	double drift_usteps;
	double shift_s;
	uint32_t transit_ns;
	uint32_t bounce_ns;
	uint8_t fault;
	int8_t outward;
	bool actuated;
	bool closed;
	bool contacts_swapped;
};

/** Private: the drum and its encoder. */
struct lw_plant_drum {
	uint64_t transition_ns;
	uint64_t profile_start_ns;
	int64_t transitions;
	int64_t held_transitions;
	int64_t extra_transitions;
	int32_t transitions_per_encoder_rev;
	int32_t past_index;
	double transitions_per_milli_rpm_s;
	double acceleration_milli_rpm_per_s;
	double speed_milli_rpm;
	double fraction;
	double moved_transitions;
	double first_ns; /* of the substep's transitions, from its beginning */
	double period_ns;
	double per_ns;   /* transitions, 1 / period_ns */
	uint32_t passed; /* of the substep's transitions */
	const struct lw_plant_profile_point *profile;
	size_t profile_count;
	size_t profile_index;
	uint64_t dither_ns;
	uint64_t flicker_ns;
	int32_t target_milli_rpm;
	uint32_t lose_pulses;
	uint32_t illegal_changes;
	uint32_t dither_changes;
	uint32_t extra_changes;
	int8_t direction;
	int8_t wired_direction; /* as the wires show it: -1 counts backward */
	uint8_t wired_offset;   /* and from this transition */
	bool dithered;
	uint8_t channel_fault[2];
	bool channel_open[2];
	uint8_t levels[4]; /* what arrives at the pins by the transition shown, A in bit 1 */
	bool index_open;
	bool wires_changed;
	bool plain;          /* no fault hides or bends a transition */
	int64_t shown_ahead; /* while plain: what dithers and extra pulses have added */
};

/** Private: motor, screw and carriage. */
struct lw_plant_carriage {
	uint64_t stall_end_ns;
	int64_t commanded_usteps;
	int64_t last_commanded_usteps;
	int64_t pole;
	uint64_t pole_slips;
	uint64_t step_pulses;
	double position_usteps; /* of the rotor */
	double speed_usteps_per_s;
	double path_usteps_per_s;
	double load_usteps; /* of the carriage: the same, but for backlash and a loose coupling */
	double load_path_usteps_per_s;
	double backlash_usteps;
	double grip_usteps_per_s2;
	double motor_usteps_per_s; /* speeds at both ends of the coupling, smoothed */
	double screw_usteps_per_s;
	double coupling_slip_usteps;
	double field_usteps_per_s;
	double side_load_usteps_per_s2;
	double period_usteps;
	double periods_per_ustep;
	double holding_usteps_per_s2;
	double half_torque_s_per_ustep; /* 1 / the speed at which half of it is left */
	double top_s_per_ustep;         /* 1 / top speed; 0: none */
	double damping_per_s;
	double friction_usteps_per_s2;
	double flange_usteps;
	double usteps_per_um;
	bool enabled;
	bool alarm;
	bool reversed;
	bool loose;
};

/** Private: the armed trigger. */
struct lw_plant_trigger {
	uint64_t fire_ns;
	double position_usteps;
	int32_t argument;
	enum lw_plant_fault fault;
	int8_t direction;
	bool armed;
};

/** A plant. Only @ref pins and @ref now_ns are meant to be read directly. */
struct lw_plant {
	struct lw_plant_pins pins;
	/** Time of the last event executed. */
	uint64_t now_ns;
	/* Private from here. */
	uint64_t event_ns;
	uint64_t slow_ns; /* everything but transitions */
	uint64_t rare_ns; /* everything but transitions and substeps */
	uint64_t substep_ns;
	double clear_usteps[LW_PLANT_SIDES]; /* between these no switch and no trigger is met */
	double clear_s;                      /* a switch that is late is met so much earlier */
	uint64_t random;
	uint64_t line_random; /* its own: how much is said on the line changes nothing else */
	uint32_t line_errors_ppm;
	uint32_t line_errors_moving_ppm;
	uint32_t bounce_interval_ns;
	struct lw_plant_drum drum;
	struct lw_plant_rope rope;
	bool trim_pressed[2];
	bool limit_swapped;
	bool overtravel_swapped;
	struct lw_plant_carriage carriage;
	struct lw_plant_switch limit[LW_PLANT_SIDES];
	struct lw_plant_switch overtravel[LW_PLANT_SIDES];
	struct lw_plant_trigger trigger;
};

/**
 * @brief Fill a configuration with the prototype's constants.
 *
 * 360 pulses, 4 encoder revolutions per drum revolution, 10 um per microstep, end stops at 90 mm,
 * overtravel at 86 mm, limits at 78.4 mm.
 */
void lw_plant_config_default(struct lw_plant_config *config);

/** Why a configuration is no machine: this figure must be in that relation to the other one. */
struct lw_plant_misfit {
	const char *figure;  /**< by its name in lw/plant_figures.h */
	const char *must_be; /**< "more than", "less than", ... */
	const char *other;   /**< a figure, or words; may be "" */
};

/**
 * @brief Whether a configuration is a machine.
 *
 * @param why receives what is wrong
 *
 * @retval 0       lw_plant_init() takes it
 * @retval -EINVAL a constant is out of range, or does not fit another one
 */
int lw_plant_config_check(const struct lw_plant_config *config, struct lw_plant_misfit *why);

/**
 * @brief Start a plant at time 0: drum at rest, motor current off, carriage at its start position.
 *
 * @param plant  plant to initialize
 * @param config constants; not needed after the call
 * @param seed   any value; equal seeds give equal traces
 *
 * @retval 0       ready
 * @retval -EINVAL lw_plant_config_check() says why; the plant is unchanged
 */
int lw_plant_init(struct lw_plant *plant, const struct lw_plant_config *config, uint64_t seed);

/** @brief Time of the next event: a pin that may change, or a substep of the mechanics. */
static inline uint64_t lw_plant_next_event_ns(const struct lw_plant *plant)
{
	return plant->event_ns;
}

/**
 * @brief Execute the next event and set plant->now_ns to its time.
 *
 * @return mask of the pins that changed, enum lw_plant_changed; 0 after an internal event
 */
uint32_t lw_plant_advance(struct lw_plant *plant);

/**
 * @brief Execute the next event, and those after it up to a time, while no pin changes and the next
 *        one begins no run.
 *
 * @return as lw_plant_advance(), of the last one
 */
uint32_t lw_plant_advance_to(struct lw_plant *plant, uint64_t until_ns);

/** @brief When a transition of the substep comes, from its beginning on: the nth, from 0. */
static inline double lw_plant_transition_ns(const struct lw_plant_drum *drum, uint32_t n)
{
	return drum->first_ns + n * drum->period_ns;
}

/** @brief Note when the next transition comes, if the substep that begins at begin_ns has one. */
static inline void lw_plant_plan_transition(struct lw_plant_drum *drum, uint64_t begin_ns)
{
	const double next_ns = lw_plant_transition_ns(drum, drum->passed);

	drum->transition_ns =
		next_ns < LW_PLANT_SUBSTEP_NS ? begin_ns + (uint32_t)next_ns : LW_PLANT_NEVER_NS;
}

/**
 * A run of transitions that no fault touches, and nothing lies between: most events by far. They
 * are taken together; lw_plant_run_end() gives them to the plant.
 */
struct lw_plant_run {
	uint32_t count;    /**< transitions, at least 1 */
	bool index_begins; /**< the index pulse begins with the last of them */
};

/** @brief Does the next event begin a run, that is, is it a plain transition, not after a time? */
static inline bool lw_plant_next_is_run(const struct lw_plant *plant, uint64_t until_ns)
{
	return plant->drum.plain && plant->drum.transition_ns <= until_ns &&
	       plant->drum.transition_ns <= plant->slow_ns;
}

/**
 * @brief The run that begins with the next event: it ends before anything else happens.
 *
 * @param plant    for which lw_plant_next_is_run() holds
 * @param until_ns as for that: no transition is later
 * @param most     transitions, at least 1
 */
static inline struct lw_plant_run lw_plant_run_begin(const struct lw_plant *plant,
						     uint64_t until_ns, uint32_t most)
{
	const struct lw_plant_drum *drum = &plant->drum;
	const uint64_t begin_ns = plant->substep_ns - LW_PLANT_SUBSTEP_NS;
	const uint64_t last_ns = until_ns < plant->slow_ns ? until_ns : plant->slow_ns;
	const double last = (double)(last_ns - begin_ns) + 1.0;
	const double end_ns = last < LW_PLANT_SUBSTEP_NS ? last : LW_PLANT_SUBSTEP_NS;
	const int32_t to_index = drum->direction > 0
					 ? drum->transitions_per_encoder_rev - drum->past_index
				 : drum->past_index != 0 ? drum->past_index
							 : drum->transitions_per_encoder_rev;
	struct lw_plant_run run = {0};
	/* As many as end before it; the division may be one off. */
	uint32_t passed = (uint32_t)((end_ns - drum->first_ns) * drum->per_ns);

	while (passed > drum->passed && lw_plant_transition_ns(drum, passed - 1) >= end_ns) {
		passed--;
	}
	while (lw_plant_transition_ns(drum, passed) < end_ns) {
		passed++;
	}
	run.count = passed - drum->passed;
	run.count = run.count < most ? run.count : most;
	if (!drum->index_open && run.count >= (uint32_t)to_index) {
		run.count = (uint32_t)to_index;
		run.index_begins = true;
	}
	return run;
}

/** @brief Which way the encoder's pins count in a run: +1 or -1. */
static inline int lw_plant_run_direction(const struct lw_plant *plant)
{
	return plant->drum.direction * plant->drum.wired_direction;
}

/** @brief When a transition of a run that has not ended comes: the nth, from 1. */
static inline uint64_t lw_plant_run_ns(const struct lw_plant *plant, uint32_t n)
{
	return plant->substep_ns - LW_PLANT_SUBSTEP_NS +
	       (uint32_t)lw_plant_transition_ns(&plant->drum, plant->drum.passed + n - 1);
}

/** @brief Make the plant what it is behind the run's last transition. */
static inline void lw_plant_run_end(struct lw_plant *plant, const struct lw_plant_run *run)
{
	struct lw_plant_drum *drum = &plant->drum;
	const uint64_t begin_ns = plant->substep_ns - LW_PLANT_SUBSTEP_NS;
	const int32_t spacing = drum->transitions_per_encoder_rev;
	int32_t past_index = drum->past_index + drum->direction * (int32_t)run->count % spacing;
	unsigned int shown;

	past_index += past_index < 0 ? spacing : past_index >= spacing ? -spacing : 0;
	plant->now_ns = lw_plant_run_ns(plant, run->count);
	drum->past_index = past_index;
	drum->transitions += drum->direction * (int32_t)run->count;
	drum->passed += run->count;
	lw_plant_plan_transition(drum, begin_ns);
	shown = (unsigned int)(drum->wired_direction * (drum->transitions + drum->shown_ahead) +
			       drum->wired_offset);
	plant->pins.encoder_a = drum->levels[shown & 3u] >> 1;
	plant->pins.encoder_b = drum->levels[shown & 3u] & 1u;
	plant->pins.encoder_index = past_index == 0 && !drum->index_open;
	plant->event_ns =
		drum->transition_ns < plant->slow_ns ? drum->transition_ns : plant->slow_ns;
}

/**
 * @brief Step pulses. The rotor feels them from the next substep on.
 *
 * The driver counts pulses whether or not the motor current is on.
 *
 * @param plant plant
 * @param steps positive or negative
 */
static inline void lw_plant_step(struct lw_plant *plant, int steps)
{
	plant->carriage.commanded_usteps += plant->carriage.reversed ? -steps : steps;
	plant->carriage.step_pulses += (uint64_t)(steps < 0 ? -steps : steps);
}

/**
 * @brief Motor current on or off.
 *
 * Off, only friction holds the carriage. On again, the rotor is drawn to the nearest position that
 * is whole electrical periods away from the commanded one.
 */
void lw_plant_enable(struct lw_plant *plant, bool enabled);

/**
 * @brief Declare the rotor's present electrical period the right one, as an indexing does.
 *
 * Clears the slip in struct lw_plant_truth (not the pole_slips counter); nothing moves.
 */
void lw_plant_reference(struct lw_plant *plant);

/**
 * @brief Let the drum go to a speed, limited by the configured acceleration; ends a profile.
 *
 * @retval 0       accepted
 * @retval -ERANGE beyond #LW_PLANT_DRUM_MILLI_RPM_MAX; nothing changed
 */
int lw_plant_drum_target(struct lw_plant *plant, int32_t drum_milli_rpm);

/**
 * @brief Choose the rope that lies on the drum.
 *
 * @retval 0       accepted
 * @retval -ERANGE not finite, negative, or no turns in a layer; nothing changed
 */
int lw_plant_set_rope(struct lw_plant *plant, const struct lw_plant_rope *rope);

/**
 * @brief Change how fast the drum follows lw_plant_drum_target().
 *
 * @retval 0       accepted
 * @retval -ERANGE not finite, or not above 0; nothing changed
 */
int lw_plant_drum_acceleration(struct lw_plant *plant, double drum_rpm_per_s);

/**
 * @brief Play a speed profile, from the next substep on.
 *
 * The drum takes the profile's speed without an acceleration limit: a first point that differs from
 * the present speed is a lurch. Before the first point's time its speed holds, after the last
 * point the last speed stays as the target.
 *
 * @param plant  plant
 * @param points times strictly increasing; must stay valid and unchanged while it plays
 * @param count  1 to #LW_PLANT_PROFILE_POINTS_MAX
 *
 * @retval 0       started
 * @retval -EINVAL count out of range or times not increasing; nothing changed
 * @retval -ERANGE a speed beyond #LW_PLANT_DRUM_MILLI_RPM_MAX; nothing changed
 */
int lw_plant_drum_play(struct lw_plant *plant, const struct lw_plant_profile_point *points,
		       size_t count);

/** @brief Whether a profile is playing. */
bool lw_plant_drum_playing(const struct lw_plant *plant);

/**
 * @brief Inject a fault, or end it, at plant->now_ns.
 *
 * Pins that change because of it change in an event at plant->now_ns.
 *
 * @retval 0       done
 * @retval -EINVAL unknown fault, or an argument that it does not know; nothing changed
 * @retval -ERANGE argument out of range; nothing changed
 */
int lw_plant_inject(struct lw_plant *plant, enum lw_plant_fault fault, int32_t argument);

/**
 * @brief Inject a fault when the carriage next passes a position. One trigger can be armed.
 *
 * @param plant       plant
 * @param position_um where
 * @param direction   +1 or -1: only when it passes in that direction; 0: in either
 * @param fault       as for lw_plant_inject()
 * @param argument    as for lw_plant_inject()
 *
 * @retval 0       armed; a trigger armed before is forgotten
 * @retval -EINVAL as lw_plant_inject(), or a direction other than +1, 0, -1; nothing changed
 * @retval -ERANGE as lw_plant_inject(), or a position beyond the end stops; nothing changed
 */
int lw_plant_arm(struct lw_plant *plant, int32_t position_um, int direction,
		 enum lw_plant_fault fault, int32_t argument);

/** @brief Whether a trigger is armed that has not fired. */
bool lw_plant_armed(const struct lw_plant *plant);

/**
 * @brief Disturb what goes over the line, as the machine does: a bit here and there.
 *
 * @return bytes that are wrong now
 */
size_t lw_plant_disturb(struct lw_plant *plant, uint8_t *bytes, size_t count);

/** @brief Read what is really the case at plant->now_ns. */
void lw_plant_read_truth(const struct lw_plant *plant, struct lw_plant_truth *truth);

#ifdef __cplusplus
}
#endif

#endif /* LW_PLANT_H */
