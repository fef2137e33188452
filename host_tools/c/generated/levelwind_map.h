/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The Modbus map of the level wind controller, for its master.
 * Generated from modbus_map/registers.yaml by: python3 modbus_map/generate.py
 * Do not edit.
 */
#ifndef LEVELWIND_MAP_H
#define LEVELWIND_MAP_H

#include <stddef.h>
#include <stdint.h>

/* What this map expects in the registers map_version and self_test. */
#define LEVELWIND_MAP_VERSION 1
#define LEVELWIND_SELF_TEST   0x12345678u

/** What the controller is doing */
enum levelwind_state {
	/** Position unknown. Give the command index */
	LEVELWIND_STATE_UNINDEXED = 0,
	/** Indexing: moving off a limit switch that was active at the start */
	LEVELWIND_STATE_BACKING_OFF = 1,
	/** Indexing: moving toward the indexing switch */
	LEVELWIND_STATE_SEEKING = 2,
	/** Indexing: switch found, turning round at the reversal point */
	LEVELWIND_STATE_INDEX_REVERSAL = 3,
	/** Indexing: sweeping back to check the other switch */
	LEVELWIND_STATE_SPAN_CHECK = 4,
	/** Indexing: coming to rest at the parking place */
	LEVELWIND_STATE_PARKING = 5,
	/**
	 * Indexed and at rest. In mode track it follows the drum once that rests; after a stop,
	 * write the mode again
	 */
	LEVELWIND_STATE_READY = 6,
	/** Following the drum */
	LEVELWIND_STATE_TRACKING = 7,
	/**
	 * Moving to the centre, to where the rope goes on, or back into the sweep before a hand-
	 * over
	 */
	LEVELWIND_STATE_CENTRING = 8,
	/** Held at the centre, the drum is not followed. For a launch set the mode to track */
	LEVELWIND_STATE_CENTRED = 9,
	/** Moving by hand */
	LEVELWIND_STATE_JOGGING = 10,
	/** Stepper without current, position unknown. Set the mode to track, then index */
	LEVELWIND_STATE_OFF = 11,
	/** Stopped by a fault, see the register fault */
	LEVELWIND_STATE_FAULT = 12,
	/**
	 * Taking up a turning drum after a restart in a launch: on the way to a limit switch, place
	 * unknown
	 */
	LEVELWIND_STATE_REACQUIRING = 13,
};

/** What the carriage shall do */
enum levelwind_mode {
	/** Stepper without current. The index is lost */
	LEVELWIND_MODE_OFF = 0,
	/** Follow the drum once indexed */
	LEVELWIND_MODE_TRACK = 1,
	/** Hold the carriage at the centre, for pulling rope out */
	LEVELWIND_MODE_CENTRE = 2,
};

/** Why the controller stopped */
enum levelwind_fault {
	/** No fault */
	LEVELWIND_FAULT_NONE = 0,
	/**
	 * Indexing: no limit switch within the travel. Is the carriage free, is the stepper
	 * powered?
	 */
	LEVELWIND_FAULT_INDEX_NO_SWITCH = 1,
	/**
	 * Indexing: the opposite switch came first. Check the stepper direction and which switch is
	 * which
	 */
	LEVELWIND_FAULT_INDEX_WRONG_SWITCH = 2,
	/**
	 * Indexing: the other switch is not where it was calibrated. Check both switches, then
	 * their calibrated positions
	 */
	LEVELWIND_FAULT_INDEX_SPAN = 3,
	/**
	 * Both limit switches, or both overtravel switches, are active at once. Check the switch
	 * wiring
	 */
	LEVELWIND_FAULT_BOTH_SWITCHES_ACTIVE = 4,
	/**
	 * The limit switch did not release although the carriage moved away. Stuck switch, or the
	 * stepper does not move
	 */
	LEVELWIND_FAULT_BACK_OFF_NO_RELEASE = 5,
	/**
	 * Plus limit switch: contacts contradict each other or both stay open. Broken wire or short
	 */
	LEVELWIND_FAULT_WIRING_PLUS = 6,
	/**
	 * Minus limit switch: contacts contradict each other or both stay open. Broken wire or
	 * short
	 */
	LEVELWIND_FAULT_WIRING_MINUS = 7,
	/**
	 * Plus overtravel switch: stepper disabled, only motion toward minus is allowed. If the
	 * carriage is not there, check this switch and its wire
	 */
	LEVELWIND_FAULT_OVERTRAVEL_PLUS = 8,
	/**
	 * Minus overtravel switch: stepper disabled, only motion toward plus is allowed. If the
	 * carriage is not there, check this switch and its wire
	 */
	LEVELWIND_FAULT_OVERTRAVEL_MINUS = 9,
	/** The drum turned faster than overspeed_trip_edges_per_s, the stepper cannot follow */
	LEVELWIND_FAULT_OVERSPEED = 10,
	/** More losses of synchronization in one launch than los_recoveries_max */
	LEVELWIND_FAULT_LOS_LIMIT = 11,
	/**
	 * The stepper driver reports an alarm: steps may be lost. Look at the driver, then index
	 * again
	 */
	LEVELWIND_FAULT_STEPPER_ALARM = 12,
	/**
	 * Taking up a turning drum: no limit switch within the travel. Is the carriage free, is the
	 * stepper powered?
	 */
	LEVELWIND_FAULT_REACQUIRE_NO_SWITCH = 13,
	/**
	 * Taking up a turning drum: the opposite switch came. Check the stepper direction and which
	 * switch is which
	 */
	LEVELWIND_FAULT_REACQUIRE_WRONG_SWITCH = 14,
};

/** Momentary commands, by the register command or by the coil of the same name */
enum levelwind_command {
	/** Nothing */
	LEVELWIND_COMMAND_NONE = 0,
	/** Find the position (homing). The drum must be at rest */
	LEVELWIND_COMMAND_INDEX = 1,
	/** Stop every motion now. Always accepted */
	LEVELWIND_COMMAND_STOP = 2,
	/** Acknowledge a fault whose cause is gone; indexing is needed afterwards */
	LEVELWIND_COMMAND_CLEAR_FAULT = 3,
	/** Check the staged parameters as a whole and make them active */
	LEVELWIND_COMMAND_APPLY = 4,
	/** Drop the staged parameters: staged becomes active again */
	LEVELWIND_COMMAND_REVERT = 5,
	/** Write the active parameters to non-volatile storage */
	LEVELWIND_COMMAND_SAVE = 6,
	/** Stage the factory values of everything but the line settings */
	LEVELWIND_COMMAND_FACTORY_MOTION = 7,
	/** Stage the factory line settings */
	LEVELWIND_COMMAND_FACTORY_LINE = 8,
	/** Stage all factory values */
	LEVELWIND_COMMAND_FACTORY_ALL = 9,
	/**
	 * Use the active line settings now; the old ones again if no valid request comes within
	 * line_confirm_s
	 */
	LEVELWIND_COMMAND_TRY_LINE = 10,
	/**
	 * Somebody has looked at the rope that was laid while the carriage stood; taken after an
	 * indexing only
	 */
	LEVELWIND_COMMAND_ACKNOWLEDGE_ROPE = 11,
	/** So much rope is on the drum: set_rope_mm. The drum must be at rest */
	LEVELWIND_COMMAND_SET_ROPE = 12,
	/**
	 * Reverse earlier at the side that the carriage moves toward: by trim_step_um, while
	 * tracking
	 */
	LEVELWIND_COMMAND_TRIM_EARLY = 13,
	/**
	 * Reverse later at the side that the carriage moves toward: by trim_step_um, while tracking
	 */
	LEVELWIND_COMMAND_TRIM_LATE = 14,
	/**
	 * Take up a turning drum from rest, after a restart in a launch: to the first limit switch,
	 * then on. The position must be unknown
	 */
	LEVELWIND_COMMAND_REACQUIRE = 15,
	/** Check the uploaded cam table as a whole, and keep it */
	LEVELWIND_COMMAND_CAM_CHECK = 30,
	/**
	 * Put the checked cam table in force: at once, or at the end of the cycle if a cam is
	 * running
	 */
	LEVELWIND_COMMAND_CAM_ACTIVATE = 31,
	/** Drop the queued cam table, or else the upload */
	LEVELWIND_COMMAND_CAM_DISCARD = 32,
};

/** How the last command ended */
enum levelwind_result {
	/** No command since power-up */
	LEVELWIND_RESULT_NONE = 0,
	/** Accepted, still running */
	LEVELWIND_RESULT_IN_PROGRESS = 1,
	/** Done */
	LEVELWIND_RESULT_DONE = 2,
	/** Refused, nothing changed; see command_reason */
	LEVELWIND_RESULT_REFUSED = 3,
	/** Started but did not succeed; see command_reason and fault */
	LEVELWIND_RESULT_FAILED = 4,
};

/** Why a request, a command or a parameter set was refused */
enum levelwind_reason {
	/** Not refused */
	LEVELWIND_REASON_NONE = 0,
	/** This function code is not supported */
	LEVELWIND_REASON_UNKNOWN_FUNCTION = 1,
	/** No register or bit at this address */
	LEVELWIND_REASON_UNKNOWN_ADDRESS = 2,
	/** This register can only be read */
	LEVELWIND_REASON_NOT_WRITABLE = 3,
	/** A value of two registers must be written whole, in one request */
	LEVELWIND_REASON_HALF_OF_PAIR = 4,
	/** The value is outside the limits of this register */
	LEVELWIND_REASON_OUT_OF_RANGE = 5,
	/** The count is zero or too large for this function */
	LEVELWIND_REASON_BAD_COUNT = 6,
	/** The request is shorter or longer than its function and count say */
	LEVELWIND_REASON_BAD_LENGTH = 7,
	/** A coil is written with 0x0000 or 0xFF00 */
	LEVELWIND_REASON_BAD_COIL_VALUE = 8,
	/**
	 * One request can give one command or jog, and a new trim beside neither a jog nor a trim
	 * command: send the other by itself
	 */
	LEVELWIND_REASON_SEVERAL_COMMANDS = 9,
	/** Refused while tracking: stop, or set the mode to centre with the drum at rest */
	LEVELWIND_REASON_BUSY_TRACKING = 10,
	/** Refused while the carriage moves by itself: wait or give stop */
	LEVELWIND_REASON_BUSY_MOVING = 11,
	/** Refused while parameters are being saved: try again */
	LEVELWIND_REASON_BUSY_SAVING = 12,
	/** The drum must be at rest for this */
	LEVELWIND_REASON_DRUM_MOVING = 13,
	/** The cause of the fault is still there */
	LEVELWIND_REASON_CAUSE_PRESENT = 15,
	/** Refused in mode off: set the mode to track or centre first */
	LEVELWIND_REASON_MODE_OFF = 16,
	/** Only motion away from the active overtravel switch is allowed */
	LEVELWIND_REASON_OVERTRAVEL = 17,
	/** The non-volatile storage reported an error */
	LEVELWIND_REASON_STORAGE_FAILED = 18,
	/** Ended by stop, mode off or a lost input before it was complete */
	LEVELWIND_REASON_STOPPED = 19,
	/** Ended by a fault, see the register fault */
	LEVELWIND_REASON_FAULTED = 20,
	/** This sub-function or object is not supported */
	LEVELWIND_REASON_UNDEFINED_SUB_FUNCTION = 21,
	/**
	 * The limit switch on that side is actuated: without an index only motion away from it is
	 * allowed
	 */
	LEVELWIND_REASON_LIMIT_SWITCH = 22,
	/**
	 * The pitch asks for more than one step per encoder edge: finer encoder edges, fewer
	 * microsteps or a smaller pitch
	 */
	LEVELWIND_REASON_SLOPE_ABOVE_ONE_STEP = 30,
	/** The pitch asks for less than 1/65536 step per edge */
	LEVELWIND_REASON_SLOPE_TOO_SMALL = 31,
	/**
	 * No pair (Ka, Nr) meets pitch and overshoot within slope_tolerance_ppm: allow more
	 * tolerance
	 */
	LEVELWIND_REASON_SLOPE_UNREACHABLE = 32,
	/** reversal_minus must lie at least 2 microsteps below reversal_plus */
	LEVELWIND_REASON_REVERSALS_CROSSED = 33,
	/** switch_plus must lie inside reversal_plus */
	LEVELWIND_REASON_SWITCH_PLUS_OUTSIDE = 34,
	/** switch_minus must lie inside reversal_minus */
	LEVELWIND_REASON_SWITCH_MINUS_OUTSIDE = 35,
	/** switch_minus must lie below switch_plus by more than twice tolerance plus hysteresis */
	LEVELWIND_REASON_SWITCHES_CROSSED = 36,
	/** The overshoot past reversal_plus reaches beyond flange_plus */
	LEVELWIND_REASON_OVERSHOOT_BEYOND_FLANGE_PLUS = 37,
	/** The overshoot past reversal_minus reaches beyond flange_minus */
	LEVELWIND_REASON_OVERSHOOT_BEYOND_FLANGE_MINUS = 38,
	/** The parking place needs its last reversal (plus overshoot) inside the sweep */
	LEVELWIND_REASON_PARK_OUTSIDE = 39,
	/** centre_position must lie between the limit switches */
	LEVELWIND_REASON_CENTRE_OUTSIDE = 40,
	/**
	 * Two ramps of one overshoot each must fit between the switches, less tolerance and
	 * hysteresis
	 */
	LEVELWIND_REASON_RAMP_DOES_NOT_FIT = 41,
	/**
	 * A position or the travel is beyond 32700 microsteps: fewer microsteps per revolution or a
	 * shorter travel
	 */
	LEVELWIND_REASON_POSITION_OVERFLOW = 42,
	/** travel must be at least the distance between the flanges */
	LEVELWIND_REASON_TRAVEL_TOO_SHORT = 43,
	/** overspeed_warning must not be above overspeed_trip */
	LEVELWIND_REASON_OVERSPEED_LIMITS_CROSSED = 44,
	/** A calibrated switch position plus its tolerance must stay inside the flange */
	LEVELWIND_REASON_TOLERANCE_BEYOND_FLANGE = 45,
	/** The encoder ratio gives less than one edge per drum revolution */
	LEVELWIND_REASON_TOO_FEW_EDGES = 46,
	/**
	 * At overspeed_warning_edges_per_s, or at the index rate, the carriage would pass the
	 * reversal point before the switch is debounced (and switch_delay_us is over)
	 */
	LEVELWIND_REASON_DEBOUNCE_TOO_LONG = 47,
	/** breaker_cycles must be 0 (no ribbon breaker) or at least 2: up and down takes two */
	LEVELWIND_REASON_BREAKER_ONE_CYCLE = 48,
	/** The bare drum cannot be thinner than the rope */
	LEVELWIND_REASON_CORE_THINNER_THAN_ROPE = 49,
	/** rope_packing_permille must be 0 (not known) or at least 100 */
	LEVELWIND_REASON_PACKING_TOO_SMALL = 50,
	/** The rope is thicker than the drum is wide between the far points of the reversals */
	LEVELWIND_REASON_DRUM_NARROWER_THAN_ROPE = 51,
	/**
	 * At overspeed_warning_edges_per_s, or at the index rate, the carriage would pass the
	 * reversal point before the switch tells (switch_delay_us)
	 */
	LEVELWIND_REASON_SWITCH_DELAY_TOO_LONG = 52,
	/** The write lock is closed: write the code to the register unlock */
	LEVELWIND_REASON_LOCKED = 60,
	/** This is not the code of the write lock */
	LEVELWIND_REASON_WRONG_CODE = 61,
	/** After a wrong code: wait before the next try, longer every time */
	LEVELWIND_REASON_UNLOCK_WAIT = 62,
	/** No valid request came at the line settings on trial: the old ones are in use again */
	LEVELWIND_REASON_LINE_NOT_CONFIRMED = 63,
	/** There is no file of this number */
	LEVELWIND_REASON_UNKNOWN_FILE = 64,
	/** The file has no record of this number */
	LEVELWIND_REASON_UNKNOWN_RECORD = 65,
	/** The reference type of a group of file records must be 6 */
	LEVELWIND_REASON_BAD_REFERENCE_TYPE = 66,
	/** The answer would not fit into one frame: ask for fewer records */
	LEVELWIND_REASON_ANSWER_TOO_LONG = 67,
	/** A cam table needs at least two rows */
	LEVELWIND_REASON_CAM_TOO_FEW_ROWS = 70,
	/** The cam table has more rows than fit */
	LEVELWIND_REASON_CAM_TOO_MANY_ROWS = 71,
	/** The first row of a cam table must have master 0 */
	LEVELWIND_REASON_CAM_FIRST_MASTER = 72,
	/** The master positions of a cam table must ascend from row to row */
	LEVELWIND_REASON_CAM_MASTER_NOT_ASCENDING = 73,
	/**
	 * The way from this cam row to the next is shorter than one encoder edge (in master units)
	 */
	LEVELWIND_REASON_CAM_ROW_TOO_SHORT = 74,
	/**
	 * The way from this cam row to the next is too long for exact arithmetic (in master units):
	 * put a row between
	 */
	LEVELWIND_REASON_CAM_ROW_TOO_LARGE = 75,
	/** The cycle of the cam table is too long (in master units) */
	LEVELWIND_REASON_CAM_CYCLE_TOO_LONG = 76,
	/**
	 * The way from this cam row to the next asks for too many steps per edge (in steps per 1000
	 * edges, ramps included)
	 */
	LEVELWIND_REASON_CAM_SLOPE = 77,
	/**
	 * The way from this cam row to the next asks for too many steps per second at
	 * overspeed_trip_edges_per_s
	 */
	LEVELWIND_REASON_CAM_STEP_RATE = 78,
	/**
	 * Last minus first slave of the cam table differs from the declared advance (0 if cyclic)
	 */
	LEVELWIND_REASON_CAM_WRAP = 79,
	/** The cam table names an unknown interpolation */
	LEVELWIND_REASON_CAM_INTERPOLATION = 80,
	/**
	 * The cam table is not the one whose CRC was uploaded with it: upload it again as a whole
	 */
	LEVELWIND_REASON_CAM_CRC = 81,
	/** A position of the cam table is beyond a flange (in microsteps) */
	LEVELWIND_REASON_CAM_BEYOND_FLANGE = 82,
	/** There is no checked cam table for this: upload one and give cam_check */
	LEVELWIND_REASON_CAM_NO_TABLE = 83,
	/** This cam bank is in force or queued: upload into the other one */
	LEVELWIND_REASON_CAM_BANK_IN_USE = 84,
	/** A cam table is queued: wait for the end of the cycle, or give cam_discard */
	LEVELWIND_REASON_CAM_QUEUED = 85,
	/**
	 * The new cam table must begin at the slave position where the one in force begins
	 * (cam_start other than relative)
	 */
	LEVELWIND_REASON_CAM_DOES_NOT_JOIN = 86,
	/** A free axis has no position to begin at: cam_start must be relative */
	LEVELWIND_REASON_CAM_FREE_AXIS = 87,
	/** A cam table that advances leaves the flanges behind: it needs cam_axis free */
	LEVELWIND_REASON_CAM_ADVANCES = 88,
	/**
	 * One encoder channel changes and the other one does not follow: the drum may be turning.
	 * Wait until it rests; if it rests, look at the encoder and its wires
	 */
	LEVELWIND_REASON_ENCODER_DOUBTFUL = 90,
	/** The master says that the drum turns: write drum_running 0 first */
	LEVELWIND_REASON_DRUM_RUNNING = 91,
	/**
	 * Look at the rope and index first: rope laid while the carriage stood is acknowledged
	 * after an indexing
	 */
	LEVELWIND_REASON_ROPE_INDEX_FIRST = 96,
	/**
	 * Metres of rope need rope_diameter_um, drum_core_diameter_um and rope_packing_permille:
	 * set them, apply, then set_rope
	 */
	LEVELWIND_REASON_ROPE_NOT_DESCRIBED = 97,
	/** Write set_rope_mm first: so many millimetres of rope are on the drum */
	LEVELWIND_REASON_ROPE_LENGTH_MISSING = 98,
	/**
	 * So much rope does not go onto this drum: check set_rope_mm, drum_core_diameter_um and
	 * rope_packing_permille
	 */
	LEVELWIND_REASON_ROPE_TOO_LONG = 99,
	/**
	 * Only a carriage that follows the drum by the reversing screw has a reversal to make
	 * earlier or later
	 */
	LEVELWIND_REASON_TRIM_NOT_FOLLOWING = 100,
	/** The drum must turn for this; at rest give index */
	LEVELWIND_REASON_DRUM_AT_REST = 101,
	/** The position is known: write mode track, and the drum is followed once it rests */
	LEVELWIND_REASON_POSITION_KNOWN = 102,
	/** A fault stands: remove its cause, then clear_fault first */
	LEVELWIND_REASON_FAULT_STANDS = 103,
	/** Only in mode track with motion_profile screw */
	LEVELWIND_REASON_NOT_MODE_TRACK = 104,
};

/** What runs the core */
enum levelwind_host {
	/** POSIX simulator */
	LEVELWIND_HOST_SIMULATOR = 1,
	/** Zephyr native_sim */
	LEVELWIND_HOST_NATIVE_SIM = 2,
	/** Zephyr in QEMU */
	LEVELWIND_HOST_QEMU = 3,
	/** Zephyr on hardware */
	LEVELWIND_HOST_HARDWARE = 4,
};

/** How a limit switch is wired */
enum levelwind_switch_contacts {
	/** Change-over switch, both contacts wired: no debounce delay, broken wires are found */
	LEVELWIND_SWITCH_CONTACTS_NO_NC_PAIR = 0,
	/** One normally open contact */
	LEVELWIND_SWITCH_CONTACTS_SINGLE_NO = 1,
	/** One normally closed contact */
	LEVELWIND_SWITCH_CONTACTS_SINGLE_NC = 2,
};

/** A side of the drum */
enum levelwind_side {
	/** Plus side */
	LEVELWIND_SIDE_PLUS = 0,
	/** Minus side */
	LEVELWIND_SIDE_MINUS = 1,
};

/** Where indexing ends */
enum levelwind_park_at {
	/** At the far point of the reversal opposite to the indexing switch */
	LEVELWIND_PARK_AT_FLANGE = 0,
	/** At park_position_um */
	LEVELWIND_PARK_AT_POSITION = 1,
};

/** Data bits, parity, stop bits */
enum levelwind_line_format {
	/** 8 data bits, even parity, 1 stop bit (the standard's default) */
	LEVELWIND_LINE_FORMAT_8E1 = 0,
	/** 8 data bits, odd parity, 1 stop bit */
	LEVELWIND_LINE_FORMAT_8O1 = 1,
	/** 8 data bits, no parity, 1 stop bit */
	LEVELWIND_LINE_FORMAT_8N1 = 2,
	/** 8 data bits, no parity, 2 stop bits */
	LEVELWIND_LINE_FORMAT_8N2 = 3,
};

/** What a slot of the storage holds */
enum levelwind_slot_state {
	/** Never written, or erased */
	LEVELWIND_SLOT_STATE_EMPTY = 0,
	/** An intact record of this firmware */
	LEVELWIND_SLOT_STATE_GOOD = 1,
	/** An intact record of an older schema, converted when it was loaded */
	LEVELWIND_SLOT_STATE_OLDER = 2,
	/**
	 * An intact record of newer firmware that this one cannot read. It is kept until two more
	 * SAVEs
	 */
	LEVELWIND_SLOT_STATE_NEWER = 3,
	/** Cut short or changed: not used */
	LEVELWIND_SLOT_STATE_DAMAGED = 4,
	/** An intact parameter set that this firmware does not accept: not used */
	LEVELWIND_SLOT_STATE_REFUSED = 5,
};

/** What is wrong with the encoder */
enum levelwind_encoder_fault {
	/** Nothing */
	LEVELWIND_ENCODER_FAULT_NONE = 0,
	/** Channel A stands still while channel B changes */
	LEVELWIND_ENCODER_FAULT_A_STILL = 1,
	/** Channel B stands still while channel A changes */
	LEVELWIND_ENCODER_FAULT_B_STILL = 2,
	/** Channel A does not follow channel B: a loose wire, or a drum that chatters */
	LEVELWIND_ENCODER_FAULT_A_FLICKERS = 3,
	/** Channel B does not follow channel A: a loose wire, or a drum that chatters */
	LEVELWIND_ENCODER_FAULT_B_FLICKERS = 4,
	/** Both channels change at once more often than encoder_illegal_permille */
	LEVELWIND_ENCODER_FAULT_ILLEGAL = 5,
	/** The index pulses do not fit the edges: edges are lost, or too many */
	LEVELWIND_ENCODER_FAULT_INDEX_MISFIT = 6,
	/**
	 * The master says that the drum turns (drum_running), and no edge came for drum_watch_ms
	 */
	LEVELWIND_ENCODER_FAULT_NO_EDGES = 7,
};

/** What the carriage follows the drum by */
enum levelwind_motion_profile {
	/** The reversing screw: level winding */
	LEVELWIND_MOTION_PROFILE_SCREW = 0,
	/** The active cam table */
	LEVELWIND_MOTION_PROFILE_CAM = 1,
};

/** How a cam begins at a hand-over */
enum levelwind_cam_start {
	/**
	 * The carriage goes to the slave position of the odometer's place in the cycle, then
	 * follows
	 */
	LEVELWIND_CAM_START_ABSOLUTE = 0,
	/** The cycle begins here and now, the slave position where the carriage is */
	LEVELWIND_CAM_START_RELATIVE = 1,
	/**
	 * The carriage goes to the table's first slave position and follows from the odometer's
	 * next begin of a cycle
	 */
	LEVELWIND_CAM_START_NEXT_CYCLE = 2,
};

/** What a cam moves */
enum levelwind_cam_axis {
	/** The carriage, between the flanges */
	LEVELWIND_CAM_AXIS_CARRIAGE = 0,
	/** An axis without ends; a table may advance. Its position is 0 wherever it is left */
	LEVELWIND_CAM_AXIS_FREE = 1,
};

/** What a bank of cam tables holds */
enum levelwind_cam_bank_state {
	/** Nothing */
	LEVELWIND_CAM_BANK_STATE_EMPTY = 0,
	/** Parts of an upload; give cam_check when it is complete */
	LEVELWIND_CAM_BANK_STATE_LOADING = 1,
	/** A checked table that is not in force */
	LEVELWIND_CAM_BANK_STATE_READY = 2,
	/** A checked table that waits for the end of the cycle */
	LEVELWIND_CAM_BANK_STATE_QUEUED = 3,
	/** The table in force */
	LEVELWIND_CAM_BANK_STATE_ACTIVE = 4,
};

/** How a cam table goes from row to row */
enum levelwind_cam_interpolation {
	/** Straight, at one gear ratio */
	LEVELWIND_CAM_INTERPOLATION_LINEAR = 0,
	/** At rest in every row: ramp up, plateau, ramp down */
	LEVELWIND_CAM_INTERPOLATION_TRAPEZOID = 1,
};

/** Discrete inputs; bit n of levelwind_status.flags is n, of flags_2 32 + n */
enum levelwind_flag {
	/** The position is known */
	LEVELWIND_FLAG_INDEXED = 0,
	/** The carriage follows the drum */
	LEVELWIND_FLAG_TRACKING = 1,
	/** A launch may begin; see launch_inhibit if not */
	LEVELWIND_FLAG_LAUNCH_PERMIT = 2,
	/** The carriage moves by itself (indexing, centring, jogging) */
	LEVELWIND_FLAG_MOVING = 3,
	/** The drum is slower than rest_edges_per_s for rest_time_ms */
	LEVELWIND_FLAG_DRUM_AT_REST = 4,
	/** Stopped by a fault */
	LEVELWIND_FLAG_FAULTED = 5,
	/**
	 * Any loss of synchronization since the last indexing, also before a power cut: the rope
	 * may be laid wrong
	 */
	LEVELWIND_FLAG_LOS = 6,
	/** LOS type 1+: reversal at plus entered, its switch did not trigger on the way */
	LEVELWIND_FLAG_LOS1_PLUS = 7,
	/** LOS type 1-: reversal at minus entered, its switch did not trigger on the way */
	LEVELWIND_FLAG_LOS1_MINUS = 8,
	/**
	 * LOS type 2+: plus switch triggered outside its tolerance, or memory had changed the law
	 */
	LEVELWIND_FLAG_LOS2_PLUS = 9,
	/**
	 * LOS type 2-: minus switch triggered outside its tolerance, or memory had changed the law
	 */
	LEVELWIND_FLAG_LOS2_MINUS = 10,
	/** Plus limit switch actuated (debounced) */
	LEVELWIND_FLAG_SWITCH_PLUS = 11,
	/** Minus limit switch actuated (debounced) */
	LEVELWIND_FLAG_SWITCH_MINUS = 12,
	/** Plus limit switch wiring fault */
	LEVELWIND_FLAG_WIRING_PLUS = 13,
	/** Minus limit switch wiring fault */
	LEVELWIND_FLAG_WIRING_MINUS = 14,
	/** Plus overtravel switch actuated */
	LEVELWIND_FLAG_OVERTRAVEL_PLUS = 15,
	/** Minus overtravel switch actuated */
	LEVELWIND_FLAG_OVERTRAVEL_MINUS = 16,
	/** The drum is faster than overspeed_warning_edges_per_s */
	LEVELWIND_FLAG_OVERSPEED_WARNING = 17,
	/** The drum was faster than overspeed_trip_edges_per_s (sticky until clear_fault) */
	LEVELWIND_FLAG_OVERSPEED_TRIP = 18,
	/** No valid request for master_timeout_ms */
	LEVELWIND_FLAG_MASTER_LOST = 19,
	/** Staged parameters differ from the active ones: APPLY or REVERT */
	LEVELWIND_FLAG_STAGED = 20,
	/** Active parameters differ from the stored ones: SAVE to keep them */
	LEVELWIND_FLAG_DIRTY = 21,
	/**
	 * No usable stored set was found at power-up: it began with the factory values, and nothing
	 * is stored until a SAVE
	 */
	LEVELWIND_FLAG_DEFAULTS_LOADED = 22,
	/** A trim waits for the carriage to be in the sweep */
	LEVELWIND_FLAG_TRIM_PENDING = 23,
	/** A re-index correction waits for the end of the reversal */
	LEVELWIND_FLAG_CORRECTION_PENDING = 24,
	/** The stepper has current */
	LEVELWIND_FLAG_STEPPER_ENABLED = 25,
	/** The active line settings differ from those in use: SAVE and restart */
	LEVELWIND_FLAG_RESTART_NEEDED = 26,
	/** Stopped by command: write the mode, or index, to go on */
	LEVELWIND_FLAG_HELD = 27,
	/** The write lock is closed: parameters cannot be changed */
	LEVELWIND_FLAG_LOCKED = 28,
	/** Line settings are on trial: any valid request to this unit confirms them */
	LEVELWIND_FLAG_LINE_TRIAL = 29,
	/**
	 * The last restart was made by the watchdog, or after a fault of the processor: a part of
	 * the firmware had stopped
	 */
	LEVELWIND_FLAG_WATCHDOG_RESET = 30,
	/** A cam table waits for the end of the cycle */
	LEVELWIND_FLAG_CAM_QUEUED = 31,
	/** Real hardware with factory values that nobody has saved: they describe another winch */
	LEVELWIND_FLAG_SET_UNCONFIRMED = 32,
	/**
	 * Rope was laid while the carriage stood, also before a power cut: look at it, index, then
	 * acknowledge_rope
	 */
	LEVELWIND_FLAG_ROPE_LAID_STANDING = 33,
	/**
	 * The drum turned while the storage was written, so edges may be missing in rope_mm and
	 * net_edges (until an indexing)
	 */
	LEVELWIND_FLAG_ODOMETER_DOUBTFUL = 34,
	/**
	 * A limit switch says what the known position makes impossible: broken wire, stuck or moved
	 * switch
	 */
	LEVELWIND_FLAG_SWITCH_IMPLAUSIBLE = 35,
	/** One encoder channel changes without the other: the drum may turn unseen. Not sticky */
	LEVELWIND_FLAG_ENCODER_DOUBTFUL = 36,
	/**
	 * The encoder does not tell the drum's motion: a loss of synchronization, sticky until an
	 * indexing has succeeded
	 */
	LEVELWIND_FLAG_ENCODER_FAULT = 37,
	/**
	 * The external clock of the processor is missing: it runs by its internal oscillator, which
	 * may be a few percent off
	 */
	LEVELWIND_FLAG_CLOCK_FALLBACK = 38,
	/** Within the last 10 s bytes came on the line without a silence for more than a second */
	LEVELWIND_FLAG_LINE_BABBLE = 39,
	/** Within the last 10 s the line gave back what was sent on it; that was dropped */
	LEVELWIND_FLAG_LINE_ECHO = 40,
	/**
	 * The metres of rope on the drum may be wrong: not told since the power-up, or edges were
	 * lost. Give set_rope where they are known
	 */
	LEVELWIND_FLAG_ROPE_DOUBTFUL = 41,
	/**
	 * The drum may have turned since it was kept where the rope goes on, or the carriage stood
	 * elsewhere: not gone to. Look where the rope leaves the drum
	 */
	LEVELWIND_FLAG_RESUME_DOUBTFUL = 42,
	/**
	 * After a restart in a launch a turning drum was taken up at an unknown place: a loss of
	 * synchronization, until an indexing has succeeded
	 */
	LEVELWIND_FLAG_REACQUIRED = 43,
	/**
	 * Nobody has accepted the parameter set that is active (levelwind commission). No launch is
	 * refused for it
	 */
	LEVELWIND_FLAG_NOT_ACCEPTED = 44,
};

/** Bit numbers of levelwind_status.launch_inhibit */
enum levelwind_launch_inhibit_bit {
	/** The carriage does not follow the drum: the state says what to do */
	LEVELWIND_LAUNCH_INHIBIT_NOT_TRACKING = 0,
	/** Synchronization was lost: look at the rope first, then index */
	LEVELWIND_LAUNCH_INHIBIT_LOS = 1,
	/** A fault stands: remove its cause, then index */
	LEVELWIND_LAUNCH_INHIBIT_FAULT = 2,
	/** A limit switch has a wiring fault: mend it, then clear_fault */
	LEVELWIND_LAUNCH_INHIBIT_WIRING = 3,
	/**
	 * An overtravel switch is actuated: index moves the carriage off it, or check the switch
	 * and its wire
	 */
	LEVELWIND_LAUNCH_INHIBIT_OVERTRAVEL = 4,
	/** The drum tripped the overspeed limit: stop it, then index */
	LEVELWIND_LAUNCH_INHIBIT_OVERSPEED = 5,
	/** The Modbus master is silent: check the panel or PLC and its line */
	LEVELWIND_LAUNCH_INHIBIT_MASTER_LOST = 6,
	/**
	 * A re-index correction waits for the sweep: turn the drum slowly until it is made, or
	 * index
	 */
	LEVELWIND_LAUNCH_INHIBIT_CORRECTION = 7,
	/** The stepper driver reports an alarm: look at the driver, then index */
	LEVELWIND_LAUNCH_INHIBIT_STEPPER_ALARM = 8,
	/**
	 * The motion profile is cam and its table cannot be followed, see cam_reason: upload
	 * another, or set motion_profile to screw
	 */
	LEVELWIND_LAUNCH_INHIBIT_CAM = 9,
	/**
	 * The factory values are in force, which describe another winch: set the parameters of this
	 * one, apply and save
	 */
	LEVELWIND_LAUNCH_INHIBIT_SET_UNCONFIRMED = 10,
	/**
	 * Rope was laid while the carriage stood: look at the rope, index, then acknowledge_rope
	 */
	LEVELWIND_LAUNCH_INHIBIT_ROPE_LAID_STANDING = 11,
	/**
	 * A limit switch says what the known position makes impossible: look at both switches and
	 * their wires, then index
	 */
	LEVELWIND_LAUNCH_INHIBIT_SWITCH_IMPLAUSIBLE = 12,
	/**
	 * The encoder's signals do not fit the drum, or did not since the last indexing: rest the
	 * drum, check the encoder and its wires, look at the rope, then index
	 */
	LEVELWIND_LAUNCH_INHIBIT_ENCODER = 13,
};

/** Where a point belongs */
enum levelwind_block {
	/** Commands and set-points, effective at once, never stored */
	LEVELWIND_BLOCK_SETPOINTS = 0,
	/** Parameters (staged). APPLY makes them active, SAVE stores the active set */
	LEVELWIND_BLOCK_PARAMETERS = 1,
	/** Identity, live status, LOS records, counters, command results and derived values */
	LEVELWIND_BLOCK_STATUS = 2,
	/**
	 * The cam bank that is not in force, to write and to read. The same as the file record
	 * interface
	 */
	LEVELWIND_BLOCK_CAM_UPLOAD = 3,
};

/* Protocol addresses of holding and input registers. */
#define LEVELWIND_ADDRESS_COMMAND                         0
#define LEVELWIND_ADDRESS_MODE                            1
#define LEVELWIND_ADDRESS_JOG                             2
#define LEVELWIND_ADDRESS_TRIM_PLUS_UM                    3
#define LEVELWIND_ADDRESS_TRIM_MINUS_UM                   4
#define LEVELWIND_ADDRESS_DRUM_RUNNING                    5
#define LEVELWIND_ADDRESS_SET_ROPE_MM                     6
#define LEVELWIND_ADDRESS_UNLOCK                          10
#define LEVELWIND_ADDRESS_CAM_PHASE_EDGES                 630
#define LEVELWIND_ADDRESS_ENCODER_PULSES_PER_REV          100
#define LEVELWIND_ADDRESS_ENCODER_EDGES_PER_PULSE         101
#define LEVELWIND_ADDRESS_ENCODER_RATIO_NUMERATOR         102
#define LEVELWIND_ADDRESS_ENCODER_RATIO_DENOMINATOR       103
#define LEVELWIND_ADDRESS_ENCODER_INVERT_A                104
#define LEVELWIND_ADDRESS_ENCODER_INVERT_B                105
#define LEVELWIND_ADDRESS_DRUM_DIRECTION_INVERT           106
#define LEVELWIND_ADDRESS_ROPE_PER_DRUM_REV_UM            107
#define LEVELWIND_ADDRESS_SCREW_LEAD_UM                   110
#define LEVELWIND_ADDRESS_MICROSTEPS_PER_REV              112
#define LEVELWIND_ADDRESS_CARRIAGE_DIRECTION_INVERT       113
#define LEVELWIND_ADDRESS_PITCH_UM                        114
#define LEVELWIND_ADDRESS_OVERSHOOT_UM                    116
#define LEVELWIND_ADDRESS_SLOPE_TOLERANCE_PPM             118
#define LEVELWIND_ADDRESS_REVERSAL_PLUS_UM                120
#define LEVELWIND_ADDRESS_REVERSAL_MINUS_UM               122
#define LEVELWIND_ADDRESS_FLANGE_PLUS_UM                  124
#define LEVELWIND_ADDRESS_FLANGE_MINUS_UM                 126
#define LEVELWIND_ADDRESS_SWITCH_PLUS_UM                  128
#define LEVELWIND_ADDRESS_SWITCH_MINUS_UM                 130
#define LEVELWIND_ADDRESS_SWITCH_TOLERANCE_UM             132
#define LEVELWIND_ADDRESS_SWITCH_HYSTERESIS_UM            133
#define LEVELWIND_ADDRESS_SWITCH_CONTACTS                 134
#define LEVELWIND_ADDRESS_SWITCH_TRANSIT_MS               135
#define LEVELWIND_ADDRESS_SWITCH_DEBOUNCE_MS              136
#define LEVELWIND_ADDRESS_TRAVEL_UM                       137
#define LEVELWIND_ADDRESS_SWITCH_DELAY_US                 139
#define LEVELWIND_ADDRESS_INDEX_SWITCH                    140
#define LEVELWIND_ADDRESS_INDEX_RATE_EDGES_PER_S          141
#define LEVELWIND_ADDRESS_PARK_AT                         142
#define LEVELWIND_ADDRESS_PARK_POSITION_UM                143
#define LEVELWIND_ADDRESS_SPAN_TOLERANCE_UM               145
#define LEVELWIND_ADDRESS_HANDOVER_DIRECTION              146
#define LEVELWIND_ADDRESS_REST_EDGES_PER_S                147
#define LEVELWIND_ADDRESS_REST_TIME_MS                    148
#define LEVELWIND_ADDRESS_CENTRE_POSITION_UM              149
#define LEVELWIND_ADDRESS_JOG_RATE_EDGES_PER_S            151
#define LEVELWIND_ADDRESS_JOG_HOLD_MS                     152
#define LEVELWIND_ADDRESS_LOS_RECOVERIES_MAX              160
#define LEVELWIND_ADDRESS_OVERSPEED_WARNING_EDGES_PER_S   161
#define LEVELWIND_ADDRESS_OVERSPEED_TRIP_EDGES_PER_S      163
#define LEVELWIND_ADDRESS_MASTER_TIMEOUT_MS               165
#define LEVELWIND_ADDRESS_DWELL_PLUS_MILLIREV             166
#define LEVELWIND_ADDRESS_DWELL_MINUS_MILLIREV            167
#define LEVELWIND_ADDRESS_BREAKER_MILLIREV                168
#define LEVELWIND_ADDRESS_BREAKER_CYCLES                  169
#define LEVELWIND_ADDRESS_EXPERT_MODE                     170
#define LEVELWIND_ADDRESS_RAW_KA                          171
#define LEVELWIND_ADDRESS_RAW_NR                          172
#define LEVELWIND_ADDRESS_RAW_REVERSAL_PLUS_USTEPS        173
#define LEVELWIND_ADDRESS_RAW_REVERSAL_MINUS_USTEPS       174
#define LEVELWIND_ADDRESS_UNIT_ID                         180
#define LEVELWIND_ADDRESS_BAUD_RATE                       181
#define LEVELWIND_ADDRESS_LINE_FORMAT                     183
#define LEVELWIND_ADDRESS_LOCK_CODE                       184
#define LEVELWIND_ADDRESS_LOCK_TIMEOUT_S                  186
#define LEVELWIND_ADDRESS_LINE_CONFIRM_S                  187
#define LEVELWIND_ADDRESS_ENCODER_WATCH_TRANSITIONS_PER_S 190
#define LEVELWIND_ADDRESS_ENCODER_WATCH_MS                192
#define LEVELWIND_ADDRESS_ENCODER_ILLEGAL_PERMILLE        193
#define LEVELWIND_ADDRESS_DRUM_WATCH_MS                   194
#define LEVELWIND_ADDRESS_STANDING_TURNS_PERMILLE         199
#define LEVELWIND_ADDRESS_ROPE_DIAMETER_UM                200
#define LEVELWIND_ADDRESS_DRUM_CORE_DIAMETER_UM           201
#define LEVELWIND_ADDRESS_ROPE_PACKING_PERMILLE           203
#define LEVELWIND_ADDRESS_TRIM_STEP_UM                    204
#define LEVELWIND_ADDRESS_RESUME                          205
#define LEVELWIND_ADDRESS_REACQUIRE_AFTER_RESTART         206
#define LEVELWIND_ADDRESS_ACCEPTED_CRC                    207
#define LEVELWIND_ADDRESS_MOTION_PROFILE                  600
#define LEVELWIND_ADDRESS_CAM_START                       601
#define LEVELWIND_ADDRESS_CAM_MASTER_EDGES                602
#define LEVELWIND_ADDRESS_CAM_MASTER_UNITS                603
#define LEVELWIND_ADDRESS_CAM_SLAVE_USTEPS                604
#define LEVELWIND_ADDRESS_CAM_SLAVE_UNITS                 605
#define LEVELWIND_ADDRESS_CAM_RAMP_DIVISOR                606
#define LEVELWIND_ADDRESS_CAM_AXIS                        607
#define LEVELWIND_ADDRESS_CAM_STEPS_PER_S_MAX             608
#define LEVELWIND_ADDRESS_SELF_TEST                       0
#define LEVELWIND_ADDRESS_MAP_VERSION                     2
#define LEVELWIND_ADDRESS_VERSION_MAJOR                   3
#define LEVELWIND_ADDRESS_VERSION_MINOR                   4
#define LEVELWIND_ADDRESS_VERSION_PATCH                   5
#define LEVELWIND_ADDRESS_HOST                            6
#define LEVELWIND_ADDRESS_IMAGE_HASH_HIGH                 7
#define LEVELWIND_ADDRESS_IMAGE_HASH_LOW                  9
#define LEVELWIND_ADDRESS_STATE                           100
#define LEVELWIND_ADDRESS_ACTIVE_MODE                     101
#define LEVELWIND_ADDRESS_FAULT                           102
#define LEVELWIND_ADDRESS_FLAGS                           103
#define LEVELWIND_ADDRESS_LAUNCH_INHIBIT                  105
#define LEVELWIND_ADDRESS_POSITION_UM                     106
#define LEVELWIND_ADDRESS_POSITION_USTEPS                 108
#define LEVELWIND_ADDRESS_M                               109
#define LEVELWIND_ADDRESS_U                               111
#define LEVELWIND_ADDRESS_DRUM_SPEED_EDGES_PER_S          113
#define LEVELWIND_ADDRESS_ROPE_SPEED_MM_PER_S             115
#define LEVELWIND_ADDRESS_ROPE_MM                         117
#define LEVELWIND_ADDRESS_NET_EDGES                       119
#define LEVELWIND_ADDRESS_PATTERN_EDGES                   123
#define LEVELWIND_ADDRESS_UPTIME_MS                       127
#define LEVELWIND_ADDRESS_LOS_RECOVERIES                  129
#define LEVELWIND_ADDRESS_SPAN_ERROR_UM                   130
#define LEVELWIND_ADDRESS_FLAGS_2                         132
#define LEVELWIND_ADDRESS_ROPE_ON_DRUM_MM                 134
#define LEVELWIND_ADDRESS_ROPE_OUT_MM                     136
#define LEVELWIND_ADDRESS_ROPE_LAYER                      138
#define LEVELWIND_ADDRESS_ROPE_RADIUS_UM                  139
#define LEVELWIND_ADDRESS_RESUME_POSITION_UM              141
#define LEVELWIND_ADDRESS_RESUME_DIRECTION                143
#define LEVELWIND_ADDRESS_LOS1_PLUS_COUNT                 200
#define LEVELWIND_ADDRESS_LOS1_PLUS_POSITION_UM           201
#define LEVELWIND_ADDRESS_LOS1_PLUS_TIME_MS               203
#define LEVELWIND_ADDRESS_LOS1_MINUS_COUNT                210
#define LEVELWIND_ADDRESS_LOS1_MINUS_POSITION_UM          211
#define LEVELWIND_ADDRESS_LOS1_MINUS_TIME_MS              213
#define LEVELWIND_ADDRESS_LOS2_PLUS_COUNT                 220
#define LEVELWIND_ADDRESS_LOS2_PLUS_POSITION_UM           221
#define LEVELWIND_ADDRESS_LOS2_PLUS_TIME_MS               223
#define LEVELWIND_ADDRESS_LOS2_MINUS_COUNT                230
#define LEVELWIND_ADDRESS_LOS2_MINUS_POSITION_UM          231
#define LEVELWIND_ADDRESS_LOS2_MINUS_TIME_MS              233
#define LEVELWIND_ADDRESS_ILLEGAL_TRANSITIONS             300
#define LEVELWIND_ADDRESS_SWITCH_PLUS_TRIGGERS            302
#define LEVELWIND_ADDRESS_SWITCH_MINUS_TRIGGERS           304
#define LEVELWIND_ADDRESS_STEPS                           306
#define LEVELWIND_ADDRESS_REQUESTS                        308
#define LEVELWIND_ADDRESS_CRC_ERRORS                      310
#define LEVELWIND_ADDRESS_EXCEPTIONS                      312
#define LEVELWIND_ADDRESS_BOOTS                           314
#define LEVELWIND_ADDRESS_WATCHDOG_RESETS                 316
#define LEVELWIND_ADDRESS_POWERED_S                       318
#define LEVELWIND_ADDRESS_TRACKING_S                      320
#define LEVELWIND_ADDRESS_LOG_SEQUENCE                    322
#define LEVELWIND_ADDRESS_LOG_COUNT                       324
#define LEVELWIND_ADDRESS_LOG_UNSAVED                     325
#define LEVELWIND_ADDRESS_RECORD_SEQUENCE                 326
#define LEVELWIND_ADDRESS_RECORD_SCHEMA                   328
#define LEVELWIND_ADDRESS_SLOT_0                          329
#define LEVELWIND_ADDRESS_SLOT_1                          330
#define LEVELWIND_ADDRESS_SLOT_2                          331
#define LEVELWIND_ADDRESS_SLOT_3                          332
#define LEVELWIND_ADDRESS_ACTIVE_CRC                      333
#define LEVELWIND_ADDRESS_ENCODER_INTERRUPT_MAX_NS        340
#define LEVELWIND_ADDRESS_LATE_INTERRUPTS                 342
#define LEVELWIND_ADDRESS_ENCODER_INDEX_PULSES            344
#define LEVELWIND_ADDRESS_MISSED_EDGES                    346
#define LEVELWIND_ADDRESS_STACK_FREE_SUPERVISOR_BYTES     350
#define LEVELWIND_ADDRESS_STACK_FREE_LIMITS_BYTES         351
#define LEVELWIND_ADDRESS_STACK_FREE_MODBUS_BYTES         352
#define LEVELWIND_ADDRESS_STACK_FREE_STORAGE_BYTES        353
#define LEVELWIND_ADDRESS_STACK_FREE_INTERRUPTS_BYTES     354
#define LEVELWIND_ADDRESS_ENCODER_FAULT_KIND              360
#define LEVELWIND_ADDRESS_ENCODER_FAULT_COUNT             361
#define LEVELWIND_ADDRESS_ENCODER_FAULT_POSITION_UM       362
#define LEVELWIND_ADDRESS_ENCODER_FAULT_TIME_MS           364
#define LEVELWIND_ADDRESS_ENCODER_DOUBTS                  366
#define LEVELWIND_ADDRESS_ENCODER_MISFIT_EDGES            367
#define LEVELWIND_ADDRESS_MEMORY_CORRECTIONS              369
#define LEVELWIND_ADDRESS_LINE_BABBLES                    380
#define LEVELWIND_ADDRESS_LINE_ECHOES                     382
#define LEVELWIND_ADDRESS_LATE_REQUESTS                   384
#define LEVELWIND_ADDRESS_FOREIGN_ANSWERS                 386
#define LEVELWIND_ADDRESS_EVENTS_SKIPPED                  388
#define LEVELWIND_ADDRESS_ROPE_STANDING_MILLIREV          390
#define LEVELWIND_ADDRESS_ROPE_STANDING_POSITION_UM       392
#define LEVELWIND_ADDRESS_ROPE_STANDING_TIME_MS           394
#define LEVELWIND_ADDRESS_ROPE_STANDING_PLACE_KNOWN       396
#define LEVELWIND_ADDRESS_LOOK_BEFORE_POWER_UP            397
#define LEVELWIND_ADDRESS_COMMAND_SEQUENCE                400
#define LEVELWIND_ADDRESS_COMMAND_CODE                    401
#define LEVELWIND_ADDRESS_COMMAND_RESULT                  402
#define LEVELWIND_ADDRESS_COMMAND_REASON                  403
#define LEVELWIND_ADDRESS_COMMAND_ADDRESS                 404
#define LEVELWIND_ADDRESS_COMMAND_VALUE                   405
#define LEVELWIND_ADDRESS_COMMAND_LIMIT                   407
#define LEVELWIND_ADDRESS_LAST_ERROR_REASON               410
#define LEVELWIND_ADDRESS_LAST_ERROR_FUNCTION             411
#define LEVELWIND_ADDRESS_LAST_ERROR_EXCEPTION            412
#define LEVELWIND_ADDRESS_LAST_ERROR_ADDRESS              413
#define LEVELWIND_ADDRESS_LAST_ERROR_VALUE                414
#define LEVELWIND_ADDRESS_LAST_ERROR_LIMIT                416
#define LEVELWIND_ADDRESS_KA                              500
#define LEVELWIND_ADDRESS_NR                              502
#define LEVELWIND_ADDRESS_KS                              504
#define LEVELWIND_ADDRESS_REVERSAL_PLUS_USTEPS            506
#define LEVELWIND_ADDRESS_REVERSAL_MINUS_USTEPS           507
#define LEVELWIND_ADDRESS_OVERSHOOT_ACTUAL_UM             508
#define LEVELWIND_ADDRESS_SLOPE_ERROR_PPM                 510
#define LEVELWIND_ADDRESS_OVERSHOOT_ERROR_UM              512
#define LEVELWIND_ADDRESS_EDGES_PER_1000_DRUM_REVS        514
#define LEVELWIND_ADDRESS_DWELL_PLUS_EDGES                516
#define LEVELWIND_ADDRESS_DWELL_MINUS_EDGES               518
#define LEVELWIND_ADDRESS_BREAKER_EDGES                   520
#define LEVELWIND_ADDRESS_BREAKER_CYCLE_PLUS              522
#define LEVELWIND_ADDRESS_BREAKER_CYCLE_MINUS             523
#define LEVELWIND_ADDRESS_CAM_BANK_0_STATE                600
#define LEVELWIND_ADDRESS_CAM_BANK_1_STATE                601
#define LEVELWIND_ADDRESS_CAM_REASON                      602
#define LEVELWIND_ADDRESS_CAM_REASON_ROW                  603
#define LEVELWIND_ADDRESS_CAM_REASON_VALUE                604
#define LEVELWIND_ADDRESS_CAM_REASON_LIMIT                606
#define LEVELWIND_ADDRESS_CAM_VERSION                     608
#define LEVELWIND_ADDRESS_CAM_STORED                      610
#define LEVELWIND_ADDRESS_CAM_ROWS                        611
#define LEVELWIND_ADDRESS_CAM_CYCLE_EDGES                 612
#define LEVELWIND_ADDRESS_CAM_MIN_USTEPS                  614
#define LEVELWIND_ADDRESS_CAM_MAX_USTEPS                  616
#define LEVELWIND_ADDRESS_CAM_SLOPE_MAX_PERMILLE          618
#define LEVELWIND_ADDRESS_CAM_POSITION_USTEPS             619
#define LEVELWIND_ADDRESS_CAM_ROW                         621
#define LEVELWIND_ADDRESS_CAM_CYCLES                      622
#define LEVELWIND_ADDRESS_CAM_PHASE_IN_FORCE_EDGES        624
#define LEVELWIND_ADDRESS_CAM_WAITING                     626
#define LEVELWIND_ADDRESS_SLOT_4                          627
#define LEVELWIND_ADDRESS_SLOT_5                          628
#define LEVELWIND_ADDRESS_SLOT_6                          629
#define LEVELWIND_ADDRESS_SLOT_7                          630
#define LEVELWIND_ADDRESS_CAM_UPLOAD_NAME                 3000
#define LEVELWIND_ADDRESS_CAM_UPLOAD_VERSION              3008
#define LEVELWIND_ADDRESS_CAM_UPLOAD_INTERPOLATION        3010
#define LEVELWIND_ADDRESS_CAM_UPLOAD_ROW_COUNT            3011
#define LEVELWIND_ADDRESS_CAM_UPLOAD_ADVANCE              3012
#define LEVELWIND_ADDRESS_CAM_UPLOAD_CRC                  3014
#define LEVELWIND_ADDRESS_CAM_UPLOAD_FIRST_ROW            3016
#define LEVELWIND_ADDRESS_CAM_UPLOAD_ROWS                 3018

/* Added to the address of a parameter: its read-only copies, input registers. */
#define LEVELWIND_ACTIVE_ADDRESS_OFFSET 1000
#define LEVELWIND_STORED_ADDRESS_OFFSET 2000

/** Identity, live status, LOS records, counters, command results and derived values */
struct levelwind_status {
	/** Always 0x12345678: the master's word order is right when it reads so */
	uint32_t self_test;
	/** Version of this map */
	int32_t map_version;
	/** Firmware version, major */
	int32_t version_major;
	/** Firmware version, minor */
	int32_t version_minor;
	/** Firmware version, patch */
	int32_t version_patch;
	/** What runs the core (enum levelwind_host) */
	int32_t host;
	/**
	 * What runs: bytes 0 to 3 of the SHA-256 of zephyr.bin, worked out over the flash at power-
	 * up (0, and so the low half: not known, as on the simulators)
	 */
	uint32_t image_hash_high;
	/** Bytes 4 to 7 of it */
	uint32_t image_hash_low;
	/** What the controller is doing (enum levelwind_state) */
	int32_t state;
	/** Mode in force (the requested one waits for the drum to rest) (enum levelwind_mode) */
	int32_t active_mode;
	/** Why the controller stopped (enum levelwind_fault) */
	int32_t fault;
	/**
	 * The first 32 discrete inputs, bit number = discrete input address (bits: enum
	 * levelwind_flag)
	 */
	uint32_t flags;
	/**
	 * Why a launch is not permitted; 0 means launch permit (bits: enum
	 * levelwind_launch_inhibit_bit)
	 */
	int32_t launch_inhibit;
	/** Carriage position [um] */
	int32_t position_um;
	/** Carriage position, whole microsteps; a free axis goes on modulo 65536 [usteps] */
	int32_t position_usteps;
	/** Carriage position, Q16.16 [usteps/65536] */
	int32_t m;
	/** Slope: microsteps that one forward edge moves the carriage, Q16.16 [usteps/65536] */
	int32_t u;
	/** Drum speed, positive hauls rope in [edges/s] */
	int32_t drum_speed_edges_per_s;
	/** Rope speed, positive hauls in; by rope_radius_um where that is known [mm/s] */
	int32_t rope_speed_mm_per_s;
	/**
	 * Rope hauled in (positive) or paid out since power-up, by the growing layers where the
	 * rope on the drum is known; stands still at its limits, 2147 km [mm]
	 */
	int32_t rope_mm;
	/** Odometer: net drum edges since power-up [edges] */
	int64_t net_edges;
	/** Net edges followed since the last hand-over [edges] */
	int64_t pattern_edges;
	/** Time since power-up; begins anew at 0 after 49.7 days [ms] */
	uint32_t uptime_ms;
	/** Re-indexings after a LOS in this launch */
	int32_t los_recoveries;
	/** Last indexing: found minus calibrated position of the other switch [um] */
	int32_t span_error_um;
	/**
	 * The discrete inputs from 32 on, bit number = discrete input address - 32 (bits: enum
	 * levelwind_flag)
	 */
	uint32_t flags_2;
	/** Rope on the drum; 0 until set_rope. It may be wrong while rope_doubtful is on [mm] */
	int32_t rope_on_drum_mm;
	/** Rope wound off since set_rope: what is out, if it was told with all rope in [mm] */
	int32_t rope_out_mm;
	/** Layers of rope on the drum, begun ones too; 0: bare, or not known */
	int32_t rope_layer;
	/** Radius of what is wound, from the drum's axis; 0: not known [um] */
	uint32_t rope_radius_um;
	/**
	 * Where the rope goes on: carriage position when the drum came to rest, also before a
	 * power-off; 0 while resume_direction is 0 [um]
	 */
	int32_t resume_position_um;
	/**
	 * Direction of the carriage there while the drum hauls in: +1 or -1; 0: not known, or
	 * resume is 0
	 */
	int32_t resume_direction;
	/** LOS type 1+ since power-up */
	int32_t los1_plus_count;
	/** Position of the first since the last indexing [um] */
	int32_t los1_plus_position_um;
	/** Its time since power-up, of that power-up [ms] */
	uint32_t los1_plus_time_ms;
	/** LOS type 1- since power-up */
	int32_t los1_minus_count;
	/** Position of the first since the last indexing [um] */
	int32_t los1_minus_position_um;
	/** Its time since power-up, of that power-up [ms] */
	uint32_t los1_minus_time_ms;
	/** LOS type 2+ since power-up */
	int32_t los2_plus_count;
	/** Position of the first since the last indexing [um] */
	int32_t los2_plus_position_um;
	/** Its time since power-up, of that power-up [ms] */
	uint32_t los2_plus_time_ms;
	/** LOS type 2- since power-up */
	int32_t los2_minus_count;
	/** Position of the first since the last indexing [um] */
	int32_t los2_minus_position_um;
	/** Its time since power-up, of that power-up [ms] */
	uint32_t los2_minus_time_ms;
	/** Encoder transitions of both channels at once since power-up */
	uint32_t illegal_transitions;
	/** Trigger events of the plus limit switch */
	uint32_t switch_plus_triggers;
	/** Trigger events of the minus limit switch */
	uint32_t switch_minus_triggers;
	/** Step pulses given since power-up [usteps] */
	uint32_t steps;
	/** Modbus requests answered or executed */
	uint32_t requests;
	/** Modbus frames with a wrong CRC */
	uint32_t crc_errors;
	/** Modbus exceptions answered */
	uint32_t exceptions;
	/** Power-ups. Survives power-off */
	uint32_t boots;
	/** Restarts by the watchdog. Survives power-off */
	uint32_t watchdog_resets;
	/** Time under power. Survives power-off but for up to 15 minutes [s] */
	uint32_t powered_s;
	/**
	 * Time in the state tracking. Survives power-off but for what came after the last write [s]
	 */
	uint32_t tracking_s;
	/** Event log: sequence number of the newest event, 0 if there is none */
	uint32_t log_sequence;
	/** Event log: events that can be read */
	int32_t log_count;
	/** Event log: events that are not stored yet; they wait until the drum rests */
	int32_t log_unsaved;
	/** Sequence number of the stored parameter set in use, 0 if there is none */
	uint32_t record_sequence;
	/** Its schema; an older one becomes the present one by SAVE */
	int32_t record_schema;
	/** Storage: first slot of the parameters (enum levelwind_slot_state) */
	int32_t slot_0;
	/** Storage: second slot of the parameters (enum levelwind_slot_state) */
	int32_t slot_1;
	/** Storage: first slot of event log and counters (enum levelwind_slot_state) */
	int32_t slot_2;
	/** Storage: second slot of event log and counters (enum levelwind_slot_state) */
	int32_t slot_3;
	/**
	 * Names the active set by its values, those of the line and the lock's code left out; never
	 * 0. See accepted_crc
	 */
	uint32_t active_crc;
	/**
	 * Longest time in the encoder interrupt since power-up, without the operating system's
	 * share (0: not measured) [ns]
	 */
	uint32_t encoder_interrupt_max_ns;
	/**
	 * Encoder interrupts that found nothing changed: transitions came closer than the interrupt
	 * is fast
	 */
	uint32_t late_interrupts;
	/** Index pulses (Z) of the encoder since power-up (0: not wired, or it has not turned) */
	uint32_t encoder_index_pulses;
	/** Edges that were missing, or too many, between index pulses since power-up [edges] */
	uint32_t missed_edges;
	/** Stack that the supervisor has never used (0: not measured) [bytes] */
	int32_t stack_free_supervisor_bytes;
	/** Stack that the limits thread has never used (0: not measured) [bytes] */
	int32_t stack_free_limits_bytes;
	/** Stack that the Modbus thread has never used (0: not measured) [bytes] */
	int32_t stack_free_modbus_bytes;
	/** Stack that the storage work queue has never used (0: not measured) [bytes] */
	int32_t stack_free_storage_bytes;
	/** Stack that the interrupts have never used (0: not measured) [bytes] */
	int32_t stack_free_interrupts_bytes;
	/**
	 * What was wrong with the encoder first since the last indexing (and since the power-up)
	 * (enum levelwind_encoder_fault)
	 */
	int32_t encoder_fault_kind;
	/** Encoder faults since power-up */
	int32_t encoder_fault_count;
	/** Position of the first since the last indexing [um] */
	int32_t encoder_fault_position_um;
	/** Its time since power-up [ms] */
	uint32_t encoder_fault_time_ms;
	/** How often the encoder became doubtful since power-up */
	int32_t encoder_doubts;
	/**
	 * By how many edges the index pulses contradict the count, net, since the last indexing
	 * [edges]
	 */
	int32_t encoder_misfit_edges;
	/**
	 * Bits of the active parameters and of the law in force that had flipped in memory and were
	 * set right since power-up
	 */
	int32_t memory_corrections;
	/**
	 * Times that bytes came on the line without a silence for more than a second, since power-
	 * up
	 */
	uint32_t line_babbles;
	/** Own answers that the line gave back, dropped */
	uint32_t line_echoes;
	/** Requests that had waited too long and were dropped */
	uint32_t late_requests;
	/**
	 * Answers of another device as this unit, dropped: two devices have this unit_id, or an
	 * echo comes late
	 */
	uint32_t foreign_answers;
	/** Events that were not logged because their cause comes and goes too often */
	uint32_t events_skipped;
	/**
	 * Drum turns of rope laid while the carriage stood, since the last acknowledgement [1/1000
	 * drum rev]
	 */
	uint32_t rope_standing_millirev;
	/** Where the carriage stood at the first of them [um] */
	int32_t rope_standing_position_um;
	/** When, since power-up, of that power-up [ms] */
	uint32_t rope_standing_time_ms;
	/** 1: that position was known; 0: the position had been unknown before */
	int32_t rope_standing_place_known;
	/**
	 * What needs a look at the rope since before this power-up: 1 LOS 1+, 2 LOS 1-, 4 LOS 2+, 8
	 * LOS 2-, 16 rope laid while the carriage stood, 32 encoder fault, 64 re-acquired
	 */
	int32_t look_before_power_up;
	/** Counts every command, also refused ones */
	int32_t command_sequence;
	/** The last command (enum levelwind_command) */
	int32_t command_code;
	/** How it ended (enum levelwind_result) */
	int32_t command_result;
	/** Why it was refused or failed (enum levelwind_reason) */
	int32_t command_reason;
	/** Offending holding register, 65535 if none */
	int32_t command_address;
	/** Offending value */
	int32_t command_value;
	/** The limit that it broke */
	int32_t command_limit;
	/** Why the last refused request was refused (enum levelwind_reason) */
	int32_t last_error_reason;
	/** Its function code */
	int32_t last_error_function;
	/** The exception answered */
	int32_t last_error_exception;
	/** The offending address */
	int32_t last_error_address;
	/** The offending value */
	int32_t last_error_value;
	/** The limit that it broke */
	int32_t last_error_limit;
	/** Slope change per edge in a reversal, in force [usteps/65536] */
	int32_t ka;
	/** Edges from sweep slope to zero slope, in force [edges] */
	int32_t nr;
	/** Sweep slope per edge, in force: Ks = Ka * Nr [usteps/65536] */
	int32_t ks;
	/** L+ in force, trim included [usteps] */
	int32_t reversal_plus_usteps;
	/** L- in force, trim included [usteps] */
	int32_t reversal_minus_usteps;
	/** Overshoot in force: Ks * (Nr - 1) / 2 [um] */
	int32_t overshoot_actual_um;
	/** Residual error of the pitch [ppm] */
	int32_t slope_error_ppm;
	/** Residual error of the overshoot [um] */
	int32_t overshoot_error_um;
	/** Used encoder edges per 1000 drum revolutions, rounded [edges] */
	uint32_t edges_per_1000_drum_revs;
	/** Dwell at the plus side [edges] */
	uint32_t dwell_plus_edges;
	/** Dwell at the minus side [edges] */
	uint32_t dwell_minus_edges;
	/** Ribbon breaker: most that it adds to a dwell [edges] */
	uint32_t breaker_edges;
	/**
	 * Ribbon breaker: far points passed at plus since the hand-over after the last indexing,
	 * net, modulo breaker_cycles
	 */
	int32_t breaker_cycle_plus;
	/** Ribbon breaker: those at minus */
	int32_t breaker_cycle_minus;
	/** What the first bank of cam tables holds (enum levelwind_cam_bank_state) */
	int32_t cam_bank_0_state;
	/** What the second bank of cam tables holds (enum levelwind_cam_bank_state) */
	int32_t cam_bank_1_state;
	/**
	 * Why the last check of a cam table refused it, or why the active one cannot be followed
	 * (enum levelwind_reason)
	 */
	int32_t cam_reason;
	/** The offending row, counted from 1; 0 if no single row is to blame */
	int32_t cam_reason_row;
	/** The offending value */
	int32_t cam_reason_value;
	/** The limit that it broke */
	int32_t cam_reason_limit;
	/** Version of the active cam table */
	uint32_t cam_version;
	/** 1 when it is stored, so that the next power-up begins with it; written at rest only */
	int32_t cam_stored;
	/** Its rows; 0: there is none */
	int32_t cam_rows;
	/** Length of its cycle [edges] */
	uint32_t cam_cycle_edges;
	/** Its lowest position [usteps] */
	int32_t cam_min_usteps;
	/** Its highest position [usteps] */
	int32_t cam_max_usteps;
	/** Its steepest slope, ramps included [usteps/1000 edges] */
	int32_t cam_slope_max_permille;
	/** Slave position by the table, modulo 2^32 [usteps] */
	int32_t cam_position_usteps;
	/** Row behind the master, counted from 1; 0: no cam is running */
	int32_t cam_row;
	/** Net cycles since the hand-over */
	int32_t cam_cycles;
	/** How much of cam_phase_edges is reached [edges] */
	int32_t cam_phase_in_force_edges;
	/** 1 while a cam waits for the begin of the next cycle */
	int32_t cam_waiting;
	/** Storage: first slot of cam tables (enum levelwind_slot_state) */
	int32_t slot_4;
	/** Storage: second slot of cam tables (enum levelwind_slot_state) */
	int32_t slot_5;
	/** Storage: first slot of what needs a look at the rope (enum levelwind_slot_state) */
	int32_t slot_6;
	/** Storage: second slot of what needs a look at the rope (enum levelwind_slot_state) */
	int32_t slot_7;
};

/** One value of an enumeration, or one bit number of a bit field */
struct levelwind_value {
	int32_t value;
	const char *name; /**< its name in the map */
	const char *text; /**< one line for a person in the field */
};

/** Types on the wire; 32 and 64 bit values carry the high word first */
enum levelwind_type {
	LEVELWIND_TYPE_U16, /**< in memory int32_t */
	LEVELWIND_TYPE_I16, /**< in memory int32_t */
	LEVELWIND_TYPE_U32, /**< in memory uint32_t */
	LEVELWIND_TYPE_I32, /**< in memory int32_t */
	LEVELWIND_TYPE_I64, /**< in memory int64_t */
};

/** One value of the map */
struct levelwind_point {
	const char *name;
	const char *unit; /**< "" if it has none */
	const char *text; /**< one line for a person in the field */
	enum levelwind_block block;
	enum levelwind_type type;
	uint16_t address; /**< first 0-based protocol address */
	uint16_t words;   /**< registers */
	size_t offset;    /**< of a status point: its member in struct levelwind_status */
	int32_t min;      /**< smallest value that may be written; not for status points */
	int32_t max;      /**< largest value that may be written */
	int32_t default_value;
	const int32_t *allowed; /**< the only values that may be written, or NULL */
	size_t allowed_count;
	const struct levelwind_value *values; /**< names of the values or bits, or NULL */
	size_t value_count;
};

#define LEVELWIND_POINT_COUNT 235

/** All points, by block and rising address */
extern const struct levelwind_point levelwind_points[LEVELWIND_POINT_COUNT];

#endif /* LEVELWIND_MAP_H */
