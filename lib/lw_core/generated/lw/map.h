/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The Modbus map: enumerations, structs, addresses, limits and defaults.
 * Generated from modbus_map/registers.yaml by: python3 modbus_map/generate.py
 * Do not edit.
 */
#ifndef LW_MAP_H
#define LW_MAP_H

#include <stdint.h>

#include "lw/map/point.h"

/* Product identification, and what the register self_test reads. */
#define LW_PRODUCT_VENDOR "levelwind"
#define LW_PRODUCT_CODE   "LW1"
#define LW_PRODUCT_NAME   "level wind controller"
#define LW_PRODUCT_URL    "https://github.com/levelwind/levelwind"
#define LW_VERSION_MAJOR  0
#define LW_VERSION_MINOR  1
#define LW_VERSION_PATCH  0
#define LW_VERSION_STRING "0.1.0"
#define LW_MAP_VERSION    1
#define LW_SELF_TEST      0x12345678u

/** What the controller is doing */
enum lw_state {
	/** Position unknown. Give the command index */
	LW_STATE_UNINDEXED = 0,
	/** Indexing: moving off a limit switch that was active at the start */
	LW_STATE_BACKING_OFF = 1,
	/** Indexing: moving toward the indexing switch */
	LW_STATE_SEEKING = 2,
	/** Indexing: switch found, turning round at the reversal point */
	LW_STATE_INDEX_REVERSAL = 3,
	/** Indexing: sweeping back to check the other switch */
	LW_STATE_SPAN_CHECK = 4,
	/** Indexing: coming to rest at the parking place */
	LW_STATE_PARKING = 5,
	/**
	 * Indexed and at rest. In mode track it follows the drum once that rests; after a stop,
	 * write the mode again
	 */
	LW_STATE_READY = 6,
	/** Following the drum */
	LW_STATE_TRACKING = 7,
	/**
	 * Moving to the centre, to where the rope goes on, or back into the sweep before a hand-
	 * over
	 */
	LW_STATE_CENTRING = 8,
	/** Held at the centre, the drum is not followed. For a launch set the mode to track */
	LW_STATE_CENTRED = 9,
	/** Moving by hand */
	LW_STATE_JOGGING = 10,
	/** Stepper without current, position unknown. Set the mode to track, then index */
	LW_STATE_OFF = 11,
	/** Stopped by a fault, see the register fault */
	LW_STATE_FAULT = 12,
	/**
	 * Taking up a turning drum after a restart in a launch: on the way to a limit switch, place
	 * unknown
	 */
	LW_STATE_REACQUIRING = 13,
};

/** What the carriage shall do */
enum lw_mode {
	/** Stepper without current. The index is lost */
	LW_MODE_OFF = 0,
	/** Follow the drum once indexed */
	LW_MODE_TRACK = 1,
	/** Hold the carriage at the centre, for pulling rope out */
	LW_MODE_CENTRE = 2,
};

/** Why the controller stopped */
enum lw_fault {
	/** No fault */
	LW_FAULT_NONE = 0,
	/**
	 * Indexing: no limit switch within the travel. Is the carriage free, is the stepper
	 * powered?
	 */
	LW_FAULT_INDEX_NO_SWITCH = 1,
	/**
	 * Indexing: the opposite switch came first. Check the stepper direction and which switch is
	 * which
	 */
	LW_FAULT_INDEX_WRONG_SWITCH = 2,
	/**
	 * Indexing: the other switch is not where it was calibrated. Check both switches, then
	 * their calibrated positions
	 */
	LW_FAULT_INDEX_SPAN = 3,
	/**
	 * Both limit switches, or both overtravel switches, are active at once. Check the switch
	 * wiring
	 */
	LW_FAULT_BOTH_SWITCHES_ACTIVE = 4,
	/**
	 * The limit switch did not release although the carriage moved away. Stuck switch, or the
	 * stepper does not move
	 */
	LW_FAULT_BACK_OFF_NO_RELEASE = 5,
	/**
	 * Plus limit switch: contacts contradict each other or both stay open. Broken wire or short
	 */
	LW_FAULT_WIRING_PLUS = 6,
	/**
	 * Minus limit switch: contacts contradict each other or both stay open. Broken wire or
	 * short
	 */
	LW_FAULT_WIRING_MINUS = 7,
	/**
	 * Plus overtravel switch: stepper disabled, only motion toward minus is allowed. If the
	 * carriage is not there, check this switch and its wire
	 */
	LW_FAULT_OVERTRAVEL_PLUS = 8,
	/**
	 * Minus overtravel switch: stepper disabled, only motion toward plus is allowed. If the
	 * carriage is not there, check this switch and its wire
	 */
	LW_FAULT_OVERTRAVEL_MINUS = 9,
	/** The drum turned faster than overspeed_trip_edges_per_s, the stepper cannot follow */
	LW_FAULT_OVERSPEED = 10,
	/** More losses of synchronization in one launch than los_recoveries_max */
	LW_FAULT_LOS_LIMIT = 11,
	/**
	 * The stepper driver reports an alarm: steps may be lost. Look at the driver, then index
	 * again
	 */
	LW_FAULT_STEPPER_ALARM = 12,
	/**
	 * Taking up a turning drum: no limit switch within the travel. Is the carriage free, is the
	 * stepper powered?
	 */
	LW_FAULT_REACQUIRE_NO_SWITCH = 13,
	/**
	 * Taking up a turning drum: the opposite switch came. Check the stepper direction and which
	 * switch is which
	 */
	LW_FAULT_REACQUIRE_WRONG_SWITCH = 14,
};

/** Momentary commands, by the register command or by the coil of the same name */
enum lw_command {
	/** Nothing */
	LW_COMMAND_NONE = 0,
	/** Find the position (homing). The drum must be at rest */
	LW_COMMAND_INDEX = 1,
	/** Stop every motion now. Always accepted */
	LW_COMMAND_STOP = 2,
	/** Acknowledge a fault whose cause is gone; indexing is needed afterwards */
	LW_COMMAND_CLEAR_FAULT = 3,
	/** Check the staged parameters as a whole and make them active */
	LW_COMMAND_APPLY = 4,
	/** Drop the staged parameters: staged becomes active again */
	LW_COMMAND_REVERT = 5,
	/** Write the active parameters to non-volatile storage */
	LW_COMMAND_SAVE = 6,
	/** Stage the factory values of everything but the line settings */
	LW_COMMAND_FACTORY_MOTION = 7,
	/** Stage the factory line settings */
	LW_COMMAND_FACTORY_LINE = 8,
	/** Stage all factory values */
	LW_COMMAND_FACTORY_ALL = 9,
	/**
	 * Use the active line settings now; the old ones again if no valid request comes within
	 * line_confirm_s
	 */
	LW_COMMAND_TRY_LINE = 10,
	/**
	 * Somebody has looked at the rope that was laid while the carriage stood; taken after an
	 * indexing only
	 */
	LW_COMMAND_ACKNOWLEDGE_ROPE = 11,
	/** So much rope is on the drum: set_rope_mm. The drum must be at rest */
	LW_COMMAND_SET_ROPE = 12,
	/**
	 * Reverse earlier at the side that the carriage moves toward: by trim_step_um, while
	 * tracking
	 */
	LW_COMMAND_TRIM_EARLY = 13,
	/**
	 * Reverse later at the side that the carriage moves toward: by trim_step_um, while tracking
	 */
	LW_COMMAND_TRIM_LATE = 14,
	/**
	 * Take up a turning drum from rest, after a restart in a launch: to the first limit switch,
	 * then on. The position must be unknown
	 */
	LW_COMMAND_REACQUIRE = 15,
	/** Check the uploaded cam table as a whole, and keep it */
	LW_COMMAND_CAM_CHECK = 30,
	/**
	 * Put the checked cam table in force: at once, or at the end of the cycle if a cam is
	 * running
	 */
	LW_COMMAND_CAM_ACTIVATE = 31,
	/** Drop the queued cam table, or else the upload */
	LW_COMMAND_CAM_DISCARD = 32,
};

/** How the last command ended */
enum lw_result {
	/** No command since power-up */
	LW_RESULT_NONE = 0,
	/** Accepted, still running */
	LW_RESULT_IN_PROGRESS = 1,
	/** Done */
	LW_RESULT_DONE = 2,
	/** Refused, nothing changed; see command_reason */
	LW_RESULT_REFUSED = 3,
	/** Started but did not succeed; see command_reason and fault */
	LW_RESULT_FAILED = 4,
};

/** Why a request, a command or a parameter set was refused */
enum lw_reason {
	/** Not refused */
	LW_REASON_NONE = 0,
	/** This function code is not supported */
	LW_REASON_UNKNOWN_FUNCTION = 1,
	/** No register or bit at this address */
	LW_REASON_UNKNOWN_ADDRESS = 2,
	/** This register can only be read */
	LW_REASON_NOT_WRITABLE = 3,
	/** A value of two registers must be written whole, in one request */
	LW_REASON_HALF_OF_PAIR = 4,
	/** The value is outside the limits of this register */
	LW_REASON_OUT_OF_RANGE = 5,
	/** The count is zero or too large for this function */
	LW_REASON_BAD_COUNT = 6,
	/** The request is shorter or longer than its function and count say */
	LW_REASON_BAD_LENGTH = 7,
	/** A coil is written with 0x0000 or 0xFF00 */
	LW_REASON_BAD_COIL_VALUE = 8,
	/**
	 * One request can give one command or jog, and a new trim beside neither a jog nor a trim
	 * command: send the other by itself
	 */
	LW_REASON_SEVERAL_COMMANDS = 9,
	/** Refused while tracking: stop, or set the mode to centre with the drum at rest */
	LW_REASON_BUSY_TRACKING = 10,
	/** Refused while the carriage moves by itself: wait or give stop */
	LW_REASON_BUSY_MOVING = 11,
	/** Refused while parameters are being saved: try again */
	LW_REASON_BUSY_SAVING = 12,
	/** The drum must be at rest for this */
	LW_REASON_DRUM_MOVING = 13,
	/** The cause of the fault is still there */
	LW_REASON_CAUSE_PRESENT = 15,
	/** Refused in mode off: set the mode to track or centre first */
	LW_REASON_MODE_OFF = 16,
	/** Only motion away from the active overtravel switch is allowed */
	LW_REASON_OVERTRAVEL = 17,
	/** The non-volatile storage reported an error */
	LW_REASON_STORAGE_FAILED = 18,
	/** Ended by stop, mode off or a lost input before it was complete */
	LW_REASON_STOPPED = 19,
	/** Ended by a fault, see the register fault */
	LW_REASON_FAULTED = 20,
	/** This sub-function or object is not supported */
	LW_REASON_UNDEFINED_SUB_FUNCTION = 21,
	/**
	 * The limit switch on that side is actuated: without an index only motion away from it is
	 * allowed
	 */
	LW_REASON_LIMIT_SWITCH = 22,
	/**
	 * The pitch asks for more than one step per encoder edge: finer encoder edges, fewer
	 * microsteps or a smaller pitch
	 */
	LW_REASON_SLOPE_ABOVE_ONE_STEP = 30,
	/** The pitch asks for less than 1/65536 step per edge */
	LW_REASON_SLOPE_TOO_SMALL = 31,
	/**
	 * No pair (Ka, Nr) meets pitch and overshoot within slope_tolerance_ppm: allow more
	 * tolerance
	 */
	LW_REASON_SLOPE_UNREACHABLE = 32,
	/** reversal_minus must lie at least 2 microsteps below reversal_plus */
	LW_REASON_REVERSALS_CROSSED = 33,
	/** switch_plus must lie inside reversal_plus */
	LW_REASON_SWITCH_PLUS_OUTSIDE = 34,
	/** switch_minus must lie inside reversal_minus */
	LW_REASON_SWITCH_MINUS_OUTSIDE = 35,
	/** switch_minus must lie below switch_plus by more than twice tolerance plus hysteresis */
	LW_REASON_SWITCHES_CROSSED = 36,
	/** The overshoot past reversal_plus reaches beyond flange_plus */
	LW_REASON_OVERSHOOT_BEYOND_FLANGE_PLUS = 37,
	/** The overshoot past reversal_minus reaches beyond flange_minus */
	LW_REASON_OVERSHOOT_BEYOND_FLANGE_MINUS = 38,
	/** The parking place needs its last reversal (plus overshoot) inside the sweep */
	LW_REASON_PARK_OUTSIDE = 39,
	/** centre_position must lie between the limit switches */
	LW_REASON_CENTRE_OUTSIDE = 40,
	/**
	 * Two ramps of one overshoot each must fit between the switches, less tolerance and
	 * hysteresis
	 */
	LW_REASON_RAMP_DOES_NOT_FIT = 41,
	/**
	 * A position or the travel is beyond 32700 microsteps: fewer microsteps per revolution or a
	 * shorter travel
	 */
	LW_REASON_POSITION_OVERFLOW = 42,
	/** travel must be at least the distance between the flanges */
	LW_REASON_TRAVEL_TOO_SHORT = 43,
	/** overspeed_warning must not be above overspeed_trip */
	LW_REASON_OVERSPEED_LIMITS_CROSSED = 44,
	/** A calibrated switch position plus its tolerance must stay inside the flange */
	LW_REASON_TOLERANCE_BEYOND_FLANGE = 45,
	/** The encoder ratio gives less than one edge per drum revolution */
	LW_REASON_TOO_FEW_EDGES = 46,
	/**
	 * At overspeed_warning_edges_per_s, or at the index rate, the carriage would pass the
	 * reversal point before the switch is debounced (and switch_delay_us is over)
	 */
	LW_REASON_DEBOUNCE_TOO_LONG = 47,
	/** breaker_cycles must be 0 (no ribbon breaker) or at least 2: up and down takes two */
	LW_REASON_BREAKER_ONE_CYCLE = 48,
	/** The bare drum cannot be thinner than the rope */
	LW_REASON_CORE_THINNER_THAN_ROPE = 49,
	/** rope_packing_permille must be 0 (not known) or at least 100 */
	LW_REASON_PACKING_TOO_SMALL = 50,
	/** The rope is thicker than the drum is wide between the far points of the reversals */
	LW_REASON_DRUM_NARROWER_THAN_ROPE = 51,
	/**
	 * At overspeed_warning_edges_per_s, or at the index rate, the carriage would pass the
	 * reversal point before the switch tells (switch_delay_us)
	 */
	LW_REASON_SWITCH_DELAY_TOO_LONG = 52,
	/** The write lock is closed: write the code to the register unlock */
	LW_REASON_LOCKED = 60,
	/** This is not the code of the write lock */
	LW_REASON_WRONG_CODE = 61,
	/** After a wrong code: wait before the next try, longer every time */
	LW_REASON_UNLOCK_WAIT = 62,
	/** No valid request came at the line settings on trial: the old ones are in use again */
	LW_REASON_LINE_NOT_CONFIRMED = 63,
	/** There is no file of this number */
	LW_REASON_UNKNOWN_FILE = 64,
	/** The file has no record of this number */
	LW_REASON_UNKNOWN_RECORD = 65,
	/** The reference type of a group of file records must be 6 */
	LW_REASON_BAD_REFERENCE_TYPE = 66,
	/** The answer would not fit into one frame: ask for fewer records */
	LW_REASON_ANSWER_TOO_LONG = 67,
	/** A cam table needs at least two rows */
	LW_REASON_CAM_TOO_FEW_ROWS = 70,
	/** The cam table has more rows than fit */
	LW_REASON_CAM_TOO_MANY_ROWS = 71,
	/** The first row of a cam table must have master 0 */
	LW_REASON_CAM_FIRST_MASTER = 72,
	/** The master positions of a cam table must ascend from row to row */
	LW_REASON_CAM_MASTER_NOT_ASCENDING = 73,
	/**
	 * The way from this cam row to the next is shorter than one encoder edge (in master units)
	 */
	LW_REASON_CAM_ROW_TOO_SHORT = 74,
	/**
	 * The way from this cam row to the next is too long for exact arithmetic (in master units):
	 * put a row between
	 */
	LW_REASON_CAM_ROW_TOO_LARGE = 75,
	/** The cycle of the cam table is too long (in master units) */
	LW_REASON_CAM_CYCLE_TOO_LONG = 76,
	/**
	 * The way from this cam row to the next asks for too many steps per edge (in steps per 1000
	 * edges, ramps included)
	 */
	LW_REASON_CAM_SLOPE = 77,
	/**
	 * The way from this cam row to the next asks for too many steps per second at
	 * overspeed_trip_edges_per_s
	 */
	LW_REASON_CAM_STEP_RATE = 78,
	/**
	 * Last minus first slave of the cam table differs from the declared advance (0 if cyclic)
	 */
	LW_REASON_CAM_WRAP = 79,
	/** The cam table names an unknown interpolation */
	LW_REASON_CAM_INTERPOLATION = 80,
	/**
	 * The cam table is not the one whose CRC was uploaded with it: upload it again as a whole
	 */
	LW_REASON_CAM_CRC = 81,
	/** A position of the cam table is beyond a flange (in microsteps) */
	LW_REASON_CAM_BEYOND_FLANGE = 82,
	/** There is no checked cam table for this: upload one and give cam_check */
	LW_REASON_CAM_NO_TABLE = 83,
	/** This cam bank is in force or queued: upload into the other one */
	LW_REASON_CAM_BANK_IN_USE = 84,
	/** A cam table is queued: wait for the end of the cycle, or give cam_discard */
	LW_REASON_CAM_QUEUED = 85,
	/**
	 * The new cam table must begin at the slave position where the one in force begins
	 * (cam_start other than relative)
	 */
	LW_REASON_CAM_DOES_NOT_JOIN = 86,
	/** A free axis has no position to begin at: cam_start must be relative */
	LW_REASON_CAM_FREE_AXIS = 87,
	/** A cam table that advances leaves the flanges behind: it needs cam_axis free */
	LW_REASON_CAM_ADVANCES = 88,
	/**
	 * One encoder channel changes and the other one does not follow: the drum may be turning.
	 * Wait until it rests; if it rests, look at the encoder and its wires
	 */
	LW_REASON_ENCODER_DOUBTFUL = 90,
	/** The master says that the drum turns: write drum_running 0 first */
	LW_REASON_DRUM_RUNNING = 91,
	/**
	 * Look at the rope and index first: rope laid while the carriage stood is acknowledged
	 * after an indexing
	 */
	LW_REASON_ROPE_INDEX_FIRST = 96,
	/**
	 * Metres of rope need rope_diameter_um, drum_core_diameter_um and rope_packing_permille:
	 * set them, apply, then set_rope
	 */
	LW_REASON_ROPE_NOT_DESCRIBED = 97,
	/** Write set_rope_mm first: so many millimetres of rope are on the drum */
	LW_REASON_ROPE_LENGTH_MISSING = 98,
	/**
	 * So much rope does not go onto this drum: check set_rope_mm, drum_core_diameter_um and
	 * rope_packing_permille
	 */
	LW_REASON_ROPE_TOO_LONG = 99,
	/**
	 * Only a carriage that follows the drum by the reversing screw has a reversal to make
	 * earlier or later
	 */
	LW_REASON_TRIM_NOT_FOLLOWING = 100,
	/** The drum must turn for this; at rest give index */
	LW_REASON_DRUM_AT_REST = 101,
	/** The position is known: write mode track, and the drum is followed once it rests */
	LW_REASON_POSITION_KNOWN = 102,
	/** A fault stands: remove its cause, then clear_fault first */
	LW_REASON_FAULT_STANDS = 103,
	/** Only in mode track with motion_profile screw */
	LW_REASON_NOT_MODE_TRACK = 104,
};

/** What runs the core */
enum lw_host {
	/** POSIX simulator */
	LW_HOST_SIMULATOR = 1,
	/** Zephyr native_sim */
	LW_HOST_NATIVE_SIM = 2,
	/** Zephyr in QEMU */
	LW_HOST_QEMU = 3,
	/** Zephyr on hardware */
	LW_HOST_HARDWARE = 4,
};

/** How a limit switch is wired */
enum lw_switch_contacts {
	/** Change-over switch, both contacts wired: no debounce delay, broken wires are found */
	LW_SWITCH_CONTACTS_NO_NC_PAIR = 0,
	/** One normally open contact */
	LW_SWITCH_CONTACTS_SINGLE_NO = 1,
	/** One normally closed contact */
	LW_SWITCH_CONTACTS_SINGLE_NC = 2,
};

/** A side of the drum */
enum lw_side {
	/** Plus side */
	LW_SIDE_PLUS = 0,
	/** Minus side */
	LW_SIDE_MINUS = 1,
};

/** Where indexing ends */
enum lw_park_at {
	/** At the far point of the reversal opposite to the indexing switch */
	LW_PARK_AT_FLANGE = 0,
	/** At park_position_um */
	LW_PARK_AT_POSITION = 1,
};

/** Data bits, parity, stop bits */
enum lw_line_format {
	/** 8 data bits, even parity, 1 stop bit (the standard's default) */
	LW_LINE_FORMAT_8E1 = 0,
	/** 8 data bits, odd parity, 1 stop bit */
	LW_LINE_FORMAT_8O1 = 1,
	/** 8 data bits, no parity, 1 stop bit */
	LW_LINE_FORMAT_8N1 = 2,
	/** 8 data bits, no parity, 2 stop bits */
	LW_LINE_FORMAT_8N2 = 3,
};

/** What a slot of the storage holds */
enum lw_slot_state {
	/** Never written, or erased */
	LW_SLOT_STATE_EMPTY = 0,
	/** An intact record of this firmware */
	LW_SLOT_STATE_GOOD = 1,
	/** An intact record of an older schema, converted when it was loaded */
	LW_SLOT_STATE_OLDER = 2,
	/**
	 * An intact record of newer firmware that this one cannot read. It is kept until two more
	 * SAVEs
	 */
	LW_SLOT_STATE_NEWER = 3,
	/** Cut short or changed: not used */
	LW_SLOT_STATE_DAMAGED = 4,
	/** An intact parameter set that this firmware does not accept: not used */
	LW_SLOT_STATE_REFUSED = 5,
};

/** What happened, in the event log */
enum lw_event {
	/** Empty record */
	LW_EVENT_NONE = 0,
	/** Power-up. Detail: firmware version, major * 10000 + minor * 100 + patch */
	LW_EVENT_POWER_UP = 1,
	/** The watchdog had restarted the controller */
	LW_EVENT_WATCHDOG_RESET = 2,
	/** No usable stored set: the factory values are active */
	LW_EVENT_DEFAULTS_LOADED = 3,
	/**
	 * A stored record was damaged. Detail: slot, 0 and 1 parameters, 2 and 3 log, 4 and 5 cam
	 * tables, 6 and 7 what needs a look at the rope
	 */
	LW_EVENT_SLOT_DAMAGED = 4,
	/** A stored record of newer firmware was not read. Detail: slot */
	LW_EVENT_SLOT_NEWER = 5,
	/** A stored parameter set was not accepted. Detail: slot */
	LW_EVENT_SLOT_REFUSED = 6,
	/** Another mode came into force */
	LW_EVENT_MODE_CHANGED = 10,
	/** Indexing began */
	LW_EVENT_INDEX_STARTED = 11,
	/** Indexing succeeded. Detail: span error in um */
	LW_EVENT_INDEX_DONE = 12,
	/** Indexing ended without success; without a fault it was stopped */
	LW_EVENT_INDEX_FAILED = 13,
	/** The carriage follows the drum */
	LW_EVENT_TRACKING_STARTED = 14,
	/** The carriage does not follow the drum any more */
	LW_EVENT_TRACKING_ENDED = 15,
	/** The command stop */
	LW_EVENT_STOPPED = 16,
	/** Stopped by a fault */
	LW_EVENT_FAULT_SET = 20,
	/** The fault was acknowledged */
	LW_EVENT_FAULT_CLEARED = 21,
	/**
	 * Synchronization lost (LOS type 1+): the reversal at plus was entered, its switch had not
	 * triggered. Detail: how many since power-up
	 */
	LW_EVENT_LOS1_PLUS = 22,
	/**
	 * Synchronization lost (LOS type 1-): the reversal at minus was entered, its switch had not
	 * triggered. Detail: how many since power-up
	 */
	LW_EVENT_LOS1_MINUS = 23,
	/**
	 * Synchronization lost (LOS type 2+): the plus switch triggered out of its place. Detail:
	 * how many since power-up
	 */
	LW_EVENT_LOS2_PLUS = 24,
	/**
	 * Synchronization lost (LOS type 2-): the minus switch triggered out of its place. Detail:
	 * how many since power-up
	 */
	LW_EVENT_LOS2_MINUS = 25,
	/** Wiring fault of the plus limit switch */
	LW_EVENT_WIRING_PLUS = 26,
	/** Wiring fault of the minus limit switch */
	LW_EVENT_WIRING_MINUS = 27,
	/** The drum exceeded overspeed_warning_edges_per_s. Detail: edges/s */
	LW_EVENT_OVERSPEED_WARNING = 28,
	/** A limit switch said what the known position makes impossible */
	LW_EVENT_SWITCH_IMPLAUSIBLE = 36,
	/** The Modbus master fell silent */
	LW_EVENT_MASTER_LOST = 30,
	/** The Modbus master is back */
	LW_EVENT_MASTER_BACK = 31,
	/** The encoder does not tell the drum's motion. A loss of synchronization */
	LW_EVENT_ENCODER_FAULT = 32,
	/**
	 * Bytes came on the line without a silence for more than a second. Detail: how often since
	 * power-up
	 */
	LW_EVENT_LINE_BABBLE = 34,
	/** The line gives back what is sent on it. Detail: echoes dropped since power-up */
	LW_EVENT_LINE_ECHO = 35,
	/** Staged parameters became active */
	LW_EVENT_APPLIED = 40,
	/** The staged parameters were not accepted */
	LW_EVENT_APPLY_REFUSED = 41,
	/** The active parameters were stored. Detail: sequence number of the record */
	LW_EVENT_SAVED = 42,
	/** The storage failed. Detail: its error number */
	LW_EVENT_SAVE_FAILED = 43,
	/** Factory values were staged */
	LW_EVENT_FACTORY_STAGED = 44,
	/** A cam table came into force. Detail: its version */
	LW_EVENT_CAM_ACTIVATED = 45,
	/** A parameter set was signed. Detail: accepted_crc; 0: the signature was taken back */
	LW_EVENT_ACCEPTED = 46,
	/** The write lock was opened */
	LW_EVENT_LOCK_OPENED = 50,
	/** The write lock closed */
	LW_EVENT_LOCK_CLOSED = 51,
	/** Rope was laid while the carriage stood. Detail: drum turns so far, in thousandths */
	LW_EVENT_ROPE_LAID_STANDING = 60,
	/**
	 * Rope laid while the carriage stood was acknowledged. Detail: drum turns, in thousandths
	 */
	LW_EVENT_ROPE_ACKNOWLEDGED = 61,
	/**
	 * The drum turned while the storage was written: edges may be missing. Detail: edges that
	 * were counted meanwhile
	 */
	LW_EVENT_ODOMETER_DOUBTFUL = 62,
	/**
	 * Since before this power-up the rope needs a look. Detail: bits as in look_before_power_up
	 */
	LW_EVENT_LOOK_PENDING = 63,
	/** The rope on the drum was told (set_rope). Detail: mm */
	LW_EVENT_ROPE_SET = 64,
	/** The reversals were trimmed by the buttons. Detail: the trim of that side, um */
	LW_EVENT_TRIMMED = 65,
	/** A trim by the buttons was refused */
	LW_EVENT_TRIM_REFUSED = 66,
	/**
	 * The carriage went to where the rope goes on, and takes up direction and slope there.
	 * Detail: position in um
	 */
	LW_EVENT_RESUMED = 67,
	/**
	 * The carriage began to take up a turning drum, after a restart in a launch. Detail: toward
	 * plus 1, toward minus -1
	 */
	LW_EVENT_REACQUIRE_STARTED = 68,
	/**
	 * It was indexed on a limit switch, and follows. The rope may be laid wrong until an
	 * indexing. Detail: how far it had been counted from its place, um
	 */
	LW_EVENT_REACQUIRE_DONE = 69,
	/** The processor started without its external clock */
	LW_EVENT_CLOCK_FALLBACK = 70,
	/**
	 * A bit of the active parameters or of the law in force had flipped in memory and was set
	 * right; the law also tells a LOS. Detail: how often since power-up
	 */
	LW_EVENT_MEMORY_CORRECTED = 71,
};

/** What is wrong with the encoder */
enum lw_encoder_fault {
	/** Nothing */
	LW_ENCODER_FAULT_NONE = 0,
	/** Channel A stands still while channel B changes */
	LW_ENCODER_FAULT_A_STILL = 1,
	/** Channel B stands still while channel A changes */
	LW_ENCODER_FAULT_B_STILL = 2,
	/** Channel A does not follow channel B: a loose wire, or a drum that chatters */
	LW_ENCODER_FAULT_A_FLICKERS = 3,
	/** Channel B does not follow channel A: a loose wire, or a drum that chatters */
	LW_ENCODER_FAULT_B_FLICKERS = 4,
	/** Both channels change at once more often than encoder_illegal_permille */
	LW_ENCODER_FAULT_ILLEGAL = 5,
	/** The index pulses do not fit the edges: edges are lost, or too many */
	LW_ENCODER_FAULT_INDEX_MISFIT = 6,
	/**
	 * The master says that the drum turns (drum_running), and no edge came for drum_watch_ms
	 */
	LW_ENCODER_FAULT_NO_EDGES = 7,
};

/** What the carriage follows the drum by */
enum lw_motion_profile {
	/** The reversing screw: level winding */
	LW_MOTION_PROFILE_SCREW = 0,
	/** The active cam table */
	LW_MOTION_PROFILE_CAM = 1,
};

/** How a cam begins at a hand-over */
enum lw_cam_start {
	/**
	 * The carriage goes to the slave position of the odometer's place in the cycle, then
	 * follows
	 */
	LW_CAM_START_ABSOLUTE = 0,
	/** The cycle begins here and now, the slave position where the carriage is */
	LW_CAM_START_RELATIVE = 1,
	/**
	 * The carriage goes to the table's first slave position and follows from the odometer's
	 * next begin of a cycle
	 */
	LW_CAM_START_NEXT_CYCLE = 2,
};

/** What a cam moves */
enum lw_cam_axis {
	/** The carriage, between the flanges */
	LW_CAM_AXIS_CARRIAGE = 0,
	/** An axis without ends; a table may advance. Its position is 0 wherever it is left */
	LW_CAM_AXIS_FREE = 1,
};

/** What a bank of cam tables holds */
enum lw_cam_bank_state {
	/** Nothing */
	LW_CAM_BANK_STATE_EMPTY = 0,
	/** Parts of an upload; give cam_check when it is complete */
	LW_CAM_BANK_STATE_LOADING = 1,
	/** A checked table that is not in force */
	LW_CAM_BANK_STATE_READY = 2,
	/** A checked table that waits for the end of the cycle */
	LW_CAM_BANK_STATE_QUEUED = 3,
	/** The table in force */
	LW_CAM_BANK_STATE_ACTIVE = 4,
};

/** How a cam table goes from row to row */
enum lw_cam_interpolation {
	/** Straight, at one gear ratio */
	LW_CAM_INTERPOLATION_LINEAR = 0,
	/** At rest in every row: ramp up, plateau, ramp down */
	LW_CAM_INTERPOLATION_TRAPEZOID = 1,
};

/** Threads of the firmware that the bench can hang, or break */
enum lw_bench_thread {
	/** None */
	LW_BENCH_THREAD_NONE = 0,
	/** Supervisor */
	LW_BENCH_THREAD_SUPERVISOR = 1,
	/** Limits thread */
	LW_BENCH_THREAD_LIMITS = 2,
	/** Modbus thread */
	LW_BENCH_THREAD_MODBUS = 3,
	/** Storage work queue */
	LW_BENCH_THREAD_STORAGE = 4,
	/** Modbus thread, by a fault of the processor */
	LW_BENCH_THREAD_FAULT = 5,
};

/** What the simulated machine saw when the watchdog restarted the controller */
enum lw_bench_restart {
	/** The last restart was not by the watchdog */
	LW_BENCH_RESTART_NONE = 0,
	/** The stepper had no current any more */
	LW_BENCH_RESTART_WITHOUT_CURRENT = 1,
	/** The stepper still had current */
	LW_BENCH_RESTART_WITH_CURRENT = 2,
};

/** Commands of the simulated plant */
enum lw_bench_command {
	/** Nothing */
	LW_BENCH_COMMAND_NONE = 0,
	/** Forget the drum speed profile */
	LW_BENCH_COMMAND_PROFILE_CLEAR = 1,
	/** Append the first bench_argument points of the window bench_profile */
	LW_BENCH_COMMAND_PROFILE_APPEND = 2,
	/** Play the profile from its beginning */
	LW_BENCH_COMMAND_PROFILE_START = 3,
	/** Restart the controller; the plant goes on */
	LW_BENCH_COMMAND_POWER_CUT = 4,
	/** The same, but what its memory keeps over a restart by the watchdog is kept */
	LW_BENCH_COMMAND_RESTART = 10,
	/** Move the carriage by bench_argument microsteps against the stepper */
	LW_BENCH_COMMAND_SLIP = 5,
	/** Swallow the next bench_argument encoder pulses */
	LW_BENCH_COMMAND_LOSE_PULSES = 6,
	/** Rock the encoder bench_argument times about the present edge */
	LW_BENCH_COMMAND_DITHER = 7,
	/** Change both encoder channels at once bench_argument times */
	LW_BENCH_COMMAND_ILLEGAL_TRANSITIONS = 8,
	/** Put the carriage at bench_argument micrometres by hand (stepper off) */
	LW_BENCH_COMMAND_PLACE_CARRIAGE = 9,
};

/** Faults of a simulated encoder channel */
enum lw_channel_fault {
	/** Works */
	LW_CHANNEL_FAULT_NONE = 0,
	/** Always low */
	LW_CHANNEL_FAULT_STUCK_LOW = 1,
	/** Always high */
	LW_CHANNEL_FAULT_STUCK_HIGH = 2,
	/** A loose wire: low for a millisecond or two, then right for as long, at random */
	LW_CHANNEL_FAULT_FLICKER = 3,
};

/** Faults of a simulated limit switch */
enum lw_switch_fault {
	/** Works */
	LW_SWITCH_FAULT_NONE = 0,
	/** Never actuates */
	LW_SWITCH_FAULT_STUCK_RELEASED = 1,
	/** Always actuated */
	LW_SWITCH_FAULT_STUCK_ACTUATED = 2,
	/** NO contact never seen closed */
	LW_SWITCH_FAULT_NO_WIRE_BROKEN = 3,
	/** NC contact never seen closed */
	LW_SWITCH_FAULT_NC_WIRE_BROKEN = 4,
	/** Both contacts seen closed */
	LW_SWITCH_FAULT_SHORTED = 5,
};

/** Faults that an armed position can release */
enum lw_trigger_fault {
	/** Not armed */
	LW_TRIGGER_FAULT_NONE = 0,
	/** Hold the carriage for bench_trigger_argument milliseconds */
	LW_TRIGGER_FAULT_STALL = 1,
	/** Move the carriage by bench_trigger_argument microsteps */
	LW_TRIGGER_FAULT_SLIP = 2,
	/** Swallow bench_trigger_argument encoder pulses */
	LW_TRIGGER_FAULT_LOSE_PULSES = 3,
};

/** Discrete inputs; bit n of lw_status.flags is n, of lw_status.flags_2 32 + n */
enum lw_flag {
	/** The position is known */
	LW_FLAG_INDEXED = 0,
	/** The carriage follows the drum */
	LW_FLAG_TRACKING = 1,
	/** A launch may begin; see launch_inhibit if not */
	LW_FLAG_LAUNCH_PERMIT = 2,
	/** The carriage moves by itself (indexing, centring, jogging) */
	LW_FLAG_MOVING = 3,
	/** The drum is slower than rest_edges_per_s for rest_time_ms */
	LW_FLAG_DRUM_AT_REST = 4,
	/** Stopped by a fault */
	LW_FLAG_FAULTED = 5,
	/**
	 * Any loss of synchronization since the last indexing, also before a power cut: the rope
	 * may be laid wrong
	 */
	LW_FLAG_LOS = 6,
	/** LOS type 1+: reversal at plus entered, its switch did not trigger on the way */
	LW_FLAG_LOS1_PLUS = 7,
	/** LOS type 1-: reversal at minus entered, its switch did not trigger on the way */
	LW_FLAG_LOS1_MINUS = 8,
	/**
	 * LOS type 2+: plus switch triggered outside its tolerance, or memory had changed the law
	 */
	LW_FLAG_LOS2_PLUS = 9,
	/**
	 * LOS type 2-: minus switch triggered outside its tolerance, or memory had changed the law
	 */
	LW_FLAG_LOS2_MINUS = 10,
	/** Plus limit switch actuated (debounced) */
	LW_FLAG_SWITCH_PLUS = 11,
	/** Minus limit switch actuated (debounced) */
	LW_FLAG_SWITCH_MINUS = 12,
	/** Plus limit switch wiring fault */
	LW_FLAG_WIRING_PLUS = 13,
	/** Minus limit switch wiring fault */
	LW_FLAG_WIRING_MINUS = 14,
	/** Plus overtravel switch actuated */
	LW_FLAG_OVERTRAVEL_PLUS = 15,
	/** Minus overtravel switch actuated */
	LW_FLAG_OVERTRAVEL_MINUS = 16,
	/** The drum is faster than overspeed_warning_edges_per_s */
	LW_FLAG_OVERSPEED_WARNING = 17,
	/** The drum was faster than overspeed_trip_edges_per_s (sticky until clear_fault) */
	LW_FLAG_OVERSPEED_TRIP = 18,
	/** No valid request for master_timeout_ms */
	LW_FLAG_MASTER_LOST = 19,
	/** Staged parameters differ from the active ones: APPLY or REVERT */
	LW_FLAG_STAGED = 20,
	/** Active parameters differ from the stored ones: SAVE to keep them */
	LW_FLAG_DIRTY = 21,
	/**
	 * No usable stored set was found at power-up: it began with the factory values, and nothing
	 * is stored until a SAVE
	 */
	LW_FLAG_DEFAULTS_LOADED = 22,
	/** A trim waits for the carriage to be in the sweep */
	LW_FLAG_TRIM_PENDING = 23,
	/** A re-index correction waits for the end of the reversal */
	LW_FLAG_CORRECTION_PENDING = 24,
	/** The stepper has current */
	LW_FLAG_STEPPER_ENABLED = 25,
	/** The active line settings differ from those in use: SAVE and restart */
	LW_FLAG_RESTART_NEEDED = 26,
	/** Stopped by command: write the mode, or index, to go on */
	LW_FLAG_HELD = 27,
	/** The write lock is closed: parameters cannot be changed */
	LW_FLAG_LOCKED = 28,
	/** Line settings are on trial: any valid request to this unit confirms them */
	LW_FLAG_LINE_TRIAL = 29,
	/**
	 * The last restart was made by the watchdog, or after a fault of the processor: a part of
	 * the firmware had stopped
	 */
	LW_FLAG_WATCHDOG_RESET = 30,
	/** A cam table waits for the end of the cycle */
	LW_FLAG_CAM_QUEUED = 31,
	/** Real hardware with factory values that nobody has saved: they describe another winch */
	LW_FLAG_SET_UNCONFIRMED = 32,
	/**
	 * Rope was laid while the carriage stood, also before a power cut: look at it, index, then
	 * acknowledge_rope
	 */
	LW_FLAG_ROPE_LAID_STANDING = 33,
	/**
	 * The drum turned while the storage was written, so edges may be missing in rope_mm and
	 * net_edges (until an indexing)
	 */
	LW_FLAG_ODOMETER_DOUBTFUL = 34,
	/**
	 * A limit switch says what the known position makes impossible: broken wire, stuck or moved
	 * switch
	 */
	LW_FLAG_SWITCH_IMPLAUSIBLE = 35,
	/** One encoder channel changes without the other: the drum may turn unseen. Not sticky */
	LW_FLAG_ENCODER_DOUBTFUL = 36,
	/**
	 * The encoder does not tell the drum's motion: a loss of synchronization, sticky until an
	 * indexing has succeeded
	 */
	LW_FLAG_ENCODER_FAULT = 37,
	/**
	 * The external clock of the processor is missing: it runs by its internal oscillator, which
	 * may be a few percent off
	 */
	LW_FLAG_CLOCK_FALLBACK = 38,
	/** Within the last 10 s bytes came on the line without a silence for more than a second */
	LW_FLAG_LINE_BABBLE = 39,
	/** Within the last 10 s the line gave back what was sent on it; that was dropped */
	LW_FLAG_LINE_ECHO = 40,
	/**
	 * The metres of rope on the drum may be wrong: not told since the power-up, or edges were
	 * lost. Give set_rope where they are known
	 */
	LW_FLAG_ROPE_DOUBTFUL = 41,
	/**
	 * The drum may have turned since it was kept where the rope goes on, or the carriage stood
	 * elsewhere: not gone to. Look where the rope leaves the drum
	 */
	LW_FLAG_RESUME_DOUBTFUL = 42,
	/**
	 * After a restart in a launch a turning drum was taken up at an unknown place: a loss of
	 * synchronization, until an indexing has succeeded
	 */
	LW_FLAG_REACQUIRED = 43,
	/**
	 * Nobody has accepted the parameter set that is active (levelwind commission). No launch is
	 * refused for it
	 */
	LW_FLAG_NOT_ACCEPTED = 44,
};

/** Bit numbers of lw_status.launch_inhibit */
enum lw_launch_inhibit_bit {
	/** The carriage does not follow the drum: the state says what to do */
	LW_LAUNCH_INHIBIT_NOT_TRACKING = 0,
	/** Synchronization was lost: look at the rope first, then index */
	LW_LAUNCH_INHIBIT_LOS = 1,
	/** A fault stands: remove its cause, then index */
	LW_LAUNCH_INHIBIT_FAULT = 2,
	/** A limit switch has a wiring fault: mend it, then clear_fault */
	LW_LAUNCH_INHIBIT_WIRING = 3,
	/**
	 * An overtravel switch is actuated: index moves the carriage off it, or check the switch
	 * and its wire
	 */
	LW_LAUNCH_INHIBIT_OVERTRAVEL = 4,
	/** The drum tripped the overspeed limit: stop it, then index */
	LW_LAUNCH_INHIBIT_OVERSPEED = 5,
	/** The Modbus master is silent: check the panel or PLC and its line */
	LW_LAUNCH_INHIBIT_MASTER_LOST = 6,
	/**
	 * A re-index correction waits for the sweep: turn the drum slowly until it is made, or
	 * index
	 */
	LW_LAUNCH_INHIBIT_CORRECTION = 7,
	/** The stepper driver reports an alarm: look at the driver, then index */
	LW_LAUNCH_INHIBIT_STEPPER_ALARM = 8,
	/**
	 * The motion profile is cam and its table cannot be followed, see cam_reason: upload
	 * another, or set motion_profile to screw
	 */
	LW_LAUNCH_INHIBIT_CAM = 9,
	/**
	 * The factory values are in force, which describe another winch: set the parameters of this
	 * one, apply and save
	 */
	LW_LAUNCH_INHIBIT_SET_UNCONFIRMED = 10,
	/**
	 * Rope was laid while the carriage stood: look at the rope, index, then acknowledge_rope
	 */
	LW_LAUNCH_INHIBIT_ROPE_LAID_STANDING = 11,
	/**
	 * A limit switch says what the known position makes impossible: look at both switches and
	 * their wires, then index
	 */
	LW_LAUNCH_INHIBIT_SWITCH_IMPLAUSIBLE = 12,
	/**
	 * The encoder's signals do not fit the drum, or did not since the last indexing: rest the
	 * drum, check the encoder and its wires, look at the rope, then index
	 */
	LW_LAUNCH_INHIBIT_ENCODER = 13,
};

/* Protocol addresses. Discrete inputs: enum lw_flag is the address. */

/* Coils. */
#define LW_ADDRESS_INDEX            0
#define LW_ADDRESS_STOP             1
#define LW_ADDRESS_CLEAR_FAULT      2
#define LW_ADDRESS_APPLY            3
#define LW_ADDRESS_REVERT           4
#define LW_ADDRESS_SAVE             5
#define LW_ADDRESS_JOG_PLUS         6
#define LW_ADDRESS_JOG_MINUS        7
#define LW_ADDRESS_ACKNOWLEDGE_ROPE 8
#define LW_ADDRESS_SET_ROPE         9
#define LW_ADDRESS_TRIM_EARLY       10
#define LW_ADDRESS_TRIM_LATE        11
#define LW_ADDRESS_REACQUIRE        12

/* Block setpoints: holding registers. */
#define LW_ADDRESS_COMMAND         0
#define LW_ADDRESS_MODE            1
#define LW_ADDRESS_JOG             2
#define LW_ADDRESS_TRIM_PLUS_UM    3
#define LW_ADDRESS_TRIM_MINUS_UM   4
#define LW_ADDRESS_DRUM_RUNNING    5
#define LW_ADDRESS_SET_ROPE_MM     6
#define LW_ADDRESS_UNLOCK          10
#define LW_ADDRESS_CAM_PHASE_EDGES 630

/* Block parameters: holding registers. */
#define LW_ADDRESS_ENCODER_PULSES_PER_REV          100
#define LW_ADDRESS_ENCODER_EDGES_PER_PULSE         101
#define LW_ADDRESS_ENCODER_RATIO_NUMERATOR         102
#define LW_ADDRESS_ENCODER_RATIO_DENOMINATOR       103
#define LW_ADDRESS_ENCODER_INVERT_A                104
#define LW_ADDRESS_ENCODER_INVERT_B                105
#define LW_ADDRESS_DRUM_DIRECTION_INVERT           106
#define LW_ADDRESS_ROPE_PER_DRUM_REV_UM            107
#define LW_ADDRESS_SCREW_LEAD_UM                   110
#define LW_ADDRESS_MICROSTEPS_PER_REV              112
#define LW_ADDRESS_CARRIAGE_DIRECTION_INVERT       113
#define LW_ADDRESS_PITCH_UM                        114
#define LW_ADDRESS_OVERSHOOT_UM                    116
#define LW_ADDRESS_SLOPE_TOLERANCE_PPM             118
#define LW_ADDRESS_REVERSAL_PLUS_UM                120
#define LW_ADDRESS_REVERSAL_MINUS_UM               122
#define LW_ADDRESS_FLANGE_PLUS_UM                  124
#define LW_ADDRESS_FLANGE_MINUS_UM                 126
#define LW_ADDRESS_SWITCH_PLUS_UM                  128
#define LW_ADDRESS_SWITCH_MINUS_UM                 130
#define LW_ADDRESS_SWITCH_TOLERANCE_UM             132
#define LW_ADDRESS_SWITCH_HYSTERESIS_UM            133
#define LW_ADDRESS_SWITCH_CONTACTS                 134
#define LW_ADDRESS_SWITCH_TRANSIT_MS               135
#define LW_ADDRESS_SWITCH_DEBOUNCE_MS              136
#define LW_ADDRESS_TRAVEL_UM                       137
#define LW_ADDRESS_SWITCH_DELAY_US                 139
#define LW_ADDRESS_INDEX_SWITCH                    140
#define LW_ADDRESS_INDEX_RATE_EDGES_PER_S          141
#define LW_ADDRESS_PARK_AT                         142
#define LW_ADDRESS_PARK_POSITION_UM                143
#define LW_ADDRESS_SPAN_TOLERANCE_UM               145
#define LW_ADDRESS_HANDOVER_DIRECTION              146
#define LW_ADDRESS_REST_EDGES_PER_S                147
#define LW_ADDRESS_REST_TIME_MS                    148
#define LW_ADDRESS_CENTRE_POSITION_UM              149
#define LW_ADDRESS_JOG_RATE_EDGES_PER_S            151
#define LW_ADDRESS_JOG_HOLD_MS                     152
#define LW_ADDRESS_LOS_RECOVERIES_MAX              160
#define LW_ADDRESS_OVERSPEED_WARNING_EDGES_PER_S   161
#define LW_ADDRESS_OVERSPEED_TRIP_EDGES_PER_S      163
#define LW_ADDRESS_MASTER_TIMEOUT_MS               165
#define LW_ADDRESS_DWELL_PLUS_MILLIREV             166
#define LW_ADDRESS_DWELL_MINUS_MILLIREV            167
#define LW_ADDRESS_BREAKER_MILLIREV                168
#define LW_ADDRESS_BREAKER_CYCLES                  169
#define LW_ADDRESS_EXPERT_MODE                     170
#define LW_ADDRESS_RAW_KA                          171
#define LW_ADDRESS_RAW_NR                          172
#define LW_ADDRESS_RAW_REVERSAL_PLUS_USTEPS        173
#define LW_ADDRESS_RAW_REVERSAL_MINUS_USTEPS       174
#define LW_ADDRESS_UNIT_ID                         180
#define LW_ADDRESS_BAUD_RATE                       181
#define LW_ADDRESS_LINE_FORMAT                     183
#define LW_ADDRESS_LOCK_CODE                       184
#define LW_ADDRESS_LOCK_TIMEOUT_S                  186
#define LW_ADDRESS_LINE_CONFIRM_S                  187
#define LW_ADDRESS_ENCODER_WATCH_TRANSITIONS_PER_S 190
#define LW_ADDRESS_ENCODER_WATCH_MS                192
#define LW_ADDRESS_ENCODER_ILLEGAL_PERMILLE        193
#define LW_ADDRESS_DRUM_WATCH_MS                   194
#define LW_ADDRESS_STANDING_TURNS_PERMILLE         199
#define LW_ADDRESS_ROPE_DIAMETER_UM                200
#define LW_ADDRESS_DRUM_CORE_DIAMETER_UM           201
#define LW_ADDRESS_ROPE_PACKING_PERMILLE           203
#define LW_ADDRESS_TRIM_STEP_UM                    204
#define LW_ADDRESS_RESUME                          205
#define LW_ADDRESS_REACQUIRE_AFTER_RESTART         206
#define LW_ADDRESS_ACCEPTED_CRC                    207
#define LW_ADDRESS_MOTION_PROFILE                  600
#define LW_ADDRESS_CAM_START                       601
#define LW_ADDRESS_CAM_MASTER_EDGES                602
#define LW_ADDRESS_CAM_MASTER_UNITS                603
#define LW_ADDRESS_CAM_SLAVE_USTEPS                604
#define LW_ADDRESS_CAM_SLAVE_UNITS                 605
#define LW_ADDRESS_CAM_RAMP_DIVISOR                606
#define LW_ADDRESS_CAM_AXIS                        607
#define LW_ADDRESS_CAM_STEPS_PER_S_MAX             608

/* Added to an address of block parameters: the active set, as input registers. */
#define LW_MAP_ACTIVE_ADDRESS_OFFSET 1000

/* Added to an address of block parameters: the stored set, as input registers. */
#define LW_MAP_STORED_ADDRESS_OFFSET 2000

/* Block status: input registers. */
#define LW_ADDRESS_SELF_TEST                   0
#define LW_ADDRESS_MAP_VERSION                 2
#define LW_ADDRESS_VERSION_MAJOR               3
#define LW_ADDRESS_VERSION_MINOR               4
#define LW_ADDRESS_VERSION_PATCH               5
#define LW_ADDRESS_HOST                        6
#define LW_ADDRESS_IMAGE_HASH_HIGH             7
#define LW_ADDRESS_IMAGE_HASH_LOW              9
#define LW_ADDRESS_STATE                       100
#define LW_ADDRESS_ACTIVE_MODE                 101
#define LW_ADDRESS_FAULT                       102
#define LW_ADDRESS_FLAGS                       103
#define LW_ADDRESS_LAUNCH_INHIBIT              105
#define LW_ADDRESS_POSITION_UM                 106
#define LW_ADDRESS_POSITION_USTEPS             108
#define LW_ADDRESS_M                           109
#define LW_ADDRESS_U                           111
#define LW_ADDRESS_DRUM_SPEED_EDGES_PER_S      113
#define LW_ADDRESS_ROPE_SPEED_MM_PER_S         115
#define LW_ADDRESS_ROPE_MM                     117
#define LW_ADDRESS_NET_EDGES                   119
#define LW_ADDRESS_PATTERN_EDGES               123
#define LW_ADDRESS_UPTIME_MS                   127
#define LW_ADDRESS_LOS_RECOVERIES              129
#define LW_ADDRESS_SPAN_ERROR_UM               130
#define LW_ADDRESS_FLAGS_2                     132
#define LW_ADDRESS_ROPE_ON_DRUM_MM             134
#define LW_ADDRESS_ROPE_OUT_MM                 136
#define LW_ADDRESS_ROPE_LAYER                  138
#define LW_ADDRESS_ROPE_RADIUS_UM              139
#define LW_ADDRESS_RESUME_POSITION_UM          141
#define LW_ADDRESS_RESUME_DIRECTION            143
#define LW_ADDRESS_LOS1_PLUS_COUNT             200
#define LW_ADDRESS_LOS1_PLUS_POSITION_UM       201
#define LW_ADDRESS_LOS1_PLUS_TIME_MS           203
#define LW_ADDRESS_LOS1_MINUS_COUNT            210
#define LW_ADDRESS_LOS1_MINUS_POSITION_UM      211
#define LW_ADDRESS_LOS1_MINUS_TIME_MS          213
#define LW_ADDRESS_LOS2_PLUS_COUNT             220
#define LW_ADDRESS_LOS2_PLUS_POSITION_UM       221
#define LW_ADDRESS_LOS2_PLUS_TIME_MS           223
#define LW_ADDRESS_LOS2_MINUS_COUNT            230
#define LW_ADDRESS_LOS2_MINUS_POSITION_UM      231
#define LW_ADDRESS_LOS2_MINUS_TIME_MS          233
#define LW_ADDRESS_ILLEGAL_TRANSITIONS         300
#define LW_ADDRESS_SWITCH_PLUS_TRIGGERS        302
#define LW_ADDRESS_SWITCH_MINUS_TRIGGERS       304
#define LW_ADDRESS_STEPS                       306
#define LW_ADDRESS_REQUESTS                    308
#define LW_ADDRESS_CRC_ERRORS                  310
#define LW_ADDRESS_EXCEPTIONS                  312
#define LW_ADDRESS_BOOTS                       314
#define LW_ADDRESS_WATCHDOG_RESETS             316
#define LW_ADDRESS_POWERED_S                   318
#define LW_ADDRESS_TRACKING_S                  320
#define LW_ADDRESS_LOG_SEQUENCE                322
#define LW_ADDRESS_LOG_COUNT                   324
#define LW_ADDRESS_LOG_UNSAVED                 325
#define LW_ADDRESS_RECORD_SEQUENCE             326
#define LW_ADDRESS_RECORD_SCHEMA               328
#define LW_ADDRESS_SLOT_0                      329
#define LW_ADDRESS_SLOT_1                      330
#define LW_ADDRESS_SLOT_2                      331
#define LW_ADDRESS_SLOT_3                      332
#define LW_ADDRESS_ACTIVE_CRC                  333
#define LW_ADDRESS_ENCODER_INTERRUPT_MAX_NS    340
#define LW_ADDRESS_LATE_INTERRUPTS             342
#define LW_ADDRESS_ENCODER_INDEX_PULSES        344
#define LW_ADDRESS_MISSED_EDGES                346
#define LW_ADDRESS_STACK_FREE_SUPERVISOR_BYTES 350
#define LW_ADDRESS_STACK_FREE_LIMITS_BYTES     351
#define LW_ADDRESS_STACK_FREE_MODBUS_BYTES     352
#define LW_ADDRESS_STACK_FREE_STORAGE_BYTES    353
#define LW_ADDRESS_STACK_FREE_INTERRUPTS_BYTES 354
#define LW_ADDRESS_ENCODER_FAULT_KIND          360
#define LW_ADDRESS_ENCODER_FAULT_COUNT         361
#define LW_ADDRESS_ENCODER_FAULT_POSITION_UM   362
#define LW_ADDRESS_ENCODER_FAULT_TIME_MS       364
#define LW_ADDRESS_ENCODER_DOUBTS              366
#define LW_ADDRESS_ENCODER_MISFIT_EDGES        367
#define LW_ADDRESS_MEMORY_CORRECTIONS          369
#define LW_ADDRESS_LINE_BABBLES                380
#define LW_ADDRESS_LINE_ECHOES                 382
#define LW_ADDRESS_LATE_REQUESTS               384
#define LW_ADDRESS_FOREIGN_ANSWERS             386
#define LW_ADDRESS_EVENTS_SKIPPED              388
#define LW_ADDRESS_ROPE_STANDING_MILLIREV      390
#define LW_ADDRESS_ROPE_STANDING_POSITION_UM   392
#define LW_ADDRESS_ROPE_STANDING_TIME_MS       394
#define LW_ADDRESS_ROPE_STANDING_PLACE_KNOWN   396
#define LW_ADDRESS_LOOK_BEFORE_POWER_UP        397
#define LW_ADDRESS_COMMAND_SEQUENCE            400
#define LW_ADDRESS_COMMAND_CODE                401
#define LW_ADDRESS_COMMAND_RESULT              402
#define LW_ADDRESS_COMMAND_REASON              403
#define LW_ADDRESS_COMMAND_ADDRESS             404
#define LW_ADDRESS_COMMAND_VALUE               405
#define LW_ADDRESS_COMMAND_LIMIT               407
#define LW_ADDRESS_LAST_ERROR_REASON           410
#define LW_ADDRESS_LAST_ERROR_FUNCTION         411
#define LW_ADDRESS_LAST_ERROR_EXCEPTION        412
#define LW_ADDRESS_LAST_ERROR_ADDRESS          413
#define LW_ADDRESS_LAST_ERROR_VALUE            414
#define LW_ADDRESS_LAST_ERROR_LIMIT            416
#define LW_ADDRESS_KA                          500
#define LW_ADDRESS_NR                          502
#define LW_ADDRESS_KS                          504
#define LW_ADDRESS_REVERSAL_PLUS_USTEPS        506
#define LW_ADDRESS_REVERSAL_MINUS_USTEPS       507
#define LW_ADDRESS_OVERSHOOT_ACTUAL_UM         508
#define LW_ADDRESS_SLOPE_ERROR_PPM             510
#define LW_ADDRESS_OVERSHOOT_ERROR_UM          512
#define LW_ADDRESS_EDGES_PER_1000_DRUM_REVS    514
#define LW_ADDRESS_DWELL_PLUS_EDGES            516
#define LW_ADDRESS_DWELL_MINUS_EDGES           518
#define LW_ADDRESS_BREAKER_EDGES               520
#define LW_ADDRESS_BREAKER_CYCLE_PLUS          522
#define LW_ADDRESS_BREAKER_CYCLE_MINUS         523
#define LW_ADDRESS_CAM_BANK_0_STATE            600
#define LW_ADDRESS_CAM_BANK_1_STATE            601
#define LW_ADDRESS_CAM_REASON                  602
#define LW_ADDRESS_CAM_REASON_ROW              603
#define LW_ADDRESS_CAM_REASON_VALUE            604
#define LW_ADDRESS_CAM_REASON_LIMIT            606
#define LW_ADDRESS_CAM_VERSION                 608
#define LW_ADDRESS_CAM_STORED                  610
#define LW_ADDRESS_CAM_ROWS                    611
#define LW_ADDRESS_CAM_CYCLE_EDGES             612
#define LW_ADDRESS_CAM_MIN_USTEPS              614
#define LW_ADDRESS_CAM_MAX_USTEPS              616
#define LW_ADDRESS_CAM_SLOPE_MAX_PERMILLE      618
#define LW_ADDRESS_CAM_POSITION_USTEPS         619
#define LW_ADDRESS_CAM_ROW                     621
#define LW_ADDRESS_CAM_CYCLES                  622
#define LW_ADDRESS_CAM_PHASE_IN_FORCE_EDGES    624
#define LW_ADDRESS_CAM_WAITING                 626
#define LW_ADDRESS_SLOT_4                      627
#define LW_ADDRESS_SLOT_5                      628
#define LW_ADDRESS_SLOT_6                      629
#define LW_ADDRESS_SLOT_7                      630

/* Block cam_upload: holding registers. */
#define LW_ADDRESS_CAM_UPLOAD_NAME          3000
#define LW_ADDRESS_CAM_UPLOAD_VERSION       3008
#define LW_ADDRESS_CAM_UPLOAD_INTERPOLATION 3010
#define LW_ADDRESS_CAM_UPLOAD_ROW_COUNT     3011
#define LW_ADDRESS_CAM_UPLOAD_ADVANCE       3012
#define LW_ADDRESS_CAM_UPLOAD_CRC           3014
#define LW_ADDRESS_CAM_UPLOAD_FIRST_ROW     3016
#define LW_ADDRESS_CAM_UPLOAD_ROWS          3018

/* Block bench: holding registers. */
#define LW_ADDRESS_BENCH_ARGUMENT                         61440
#define LW_ADDRESS_BENCH_COMMAND                          61442
#define LW_ADDRESS_BENCH_DRUM_SPEED_MILLIRPM              61443
#define LW_ADDRESS_BENCH_DRUM_ACCELERATION_MILLIRPM_PER_S 61445
#define LW_ADDRESS_BENCH_SIDE_LOAD_MM_PER_S2              61447
#define LW_ADDRESS_BENCH_STALL                            61449
#define LW_ADDRESS_BENCH_BOUNCE_MS                        61450
#define LW_ADDRESS_BENCH_SWITCH_PLUS_FAULT                61451
#define LW_ADDRESS_BENCH_SWITCH_MINUS_FAULT               61452
#define LW_ADDRESS_BENCH_OVERTRAVEL_PLUS                  61453
#define LW_ADDRESS_BENCH_OVERTRAVEL_MINUS                 61454
#define LW_ADDRESS_BENCH_DIRECTION_REVERSED               61455
#define LW_ADDRESS_BENCH_TRIGGER_POSITION_UM              61456
#define LW_ADDRESS_BENCH_TRIGGER_DIRECTION                61458
#define LW_ADDRESS_BENCH_TRIGGER_ARGUMENT                 61459
#define LW_ADDRESS_BENCH_TRIGGER_FAULT                    61461
#define LW_ADDRESS_BENCH_STEPPER_ALARM                    61462
#define LW_ADDRESS_BENCH_HANG                             61463
#define LW_ADDRESS_BENCH_RESTART                          61464
#define LW_ADDRESS_BENCH_TRIM_EARLY                       61465
#define LW_ADDRESS_BENCH_TRIM_LATE                        61466
#define LW_ADDRESS_BENCH_RESULT                           61469
#define LW_ADDRESS_BENCH_CARRIAGE_UM                      61470
#define LW_ADDRESS_BENCH_CARRIAGE_MM_PER_S                61472
#define LW_ADDRESS_BENCH_COMMANDED_USTEPS                 61474
#define LW_ADDRESS_BENCH_SLIPPED_USTEPS                   61476
#define LW_ADDRESS_BENCH_TRANSITIONS                      61478
#define LW_ADDRESS_BENCH_DRUM_ACTUAL_MILLIRPM             61482
#define LW_ADDRESS_BENCH_PROFILE_POINTS                   61484
#define LW_ADDRESS_BENCH_PROFILE_RUNNING                  61485
#define LW_ADDRESS_BENCH_TIME_MS                          61486
#define LW_ADDRESS_BENCH_PROFILE                          61500
#define LW_ADDRESS_BENCH_ENCODER_A_FAULT                  61620
#define LW_ADDRESS_BENCH_ENCODER_B_FAULT                  61621
#define LW_ADDRESS_BENCH_INDEX_PULSES                     61622
#define LW_ADDRESS_BENCH_ROPE_LAYER_UM                    61623
#define LW_ADDRESS_BENCH_ROPE_LAYER_MILLITURNS            61624
#define LW_ADDRESS_BENCH_ROPE_CORE_UM                     61626
#define LW_ADDRESS_BENCH_ROPE_MM                          61628
#define LW_ADDRESS_BENCH_SWITCH_LATE_US                   61630

/**
 * Commands and set-points, effective at once, never stored. One member for each point, in the
 * memory type of lw/map/point.h.
 */
struct lw_setpoints {
	/** Writing a code runs the command; reads the last one (enum lw_command) */
	int32_t command;
	/** Requested mode, taken over when the drum is at rest (off: at once) (enum lw_mode) */
	int32_t mode;
	/** Held jog: -1, 0 or +1; write again within jog_hold_ms or it stops */
	int32_t jog;
	/** Live shift of reversal_plus, applied in the sweep only [um] */
	int32_t trim_plus_um;
	/** Live shift of reversal_minus, applied in the sweep only [um] */
	int32_t trim_minus_um;
	/** 1: the master says that the winch turns the drum; see drum_watch_ms */
	int32_t drum_running;
	/**
	 * What the command set_rope tells: so much rope is on the drum; -1: nothing was written
	 * [mm]
	 */
	int32_t set_rope_mm;
	/**
	 * Writing lock_code opens the write lock for lock_timeout_s, writing 0 closes it; reads 0
	 */
	uint32_t unlock;
	/** Live shift of the cam's master, one edge per edge until it is reached [edges] */
	int32_t cam_phase_edges;
};

/**
 * Parameters (staged). APPLY makes them active, SAVE stores the active set. One member for each
 * point, in the memory type of lw/map/point.h.
 */
struct lw_params {
	/** Encoder pulses per revolution of its shaft [pulses] */
	int32_t encoder_pulses_per_rev;
	/** Edges used per pulse [edges] */
	int32_t encoder_edges_per_pulse;
	/** Encoder revolutions per drum revolution, numerator */
	int32_t encoder_ratio_numerator;
	/** Encoder revolutions per drum revolution, denominator */
	int32_t encoder_ratio_denominator;
	/** 1 inverts encoder channel A */
	int32_t encoder_invert_a;
	/** 1 inverts encoder channel B */
	int32_t encoder_invert_b;
	/** 1 swaps the sign of drum motion; hauling rope in must count positive */
	int32_t drum_direction_invert;
	/** Rope hauled in per drum revolution, for the odometer [um] */
	uint32_t rope_per_drum_rev_um;
	/** Carriage travel per screw revolution [um] */
	uint32_t screw_lead_um;
	/** Microsteps per stepper revolution, as set at the stepper driver [usteps] */
	int32_t microsteps_per_rev;
	/** 1 inverts the stepper's direction output */
	int32_t carriage_direction_invert;
	/** Carriage travel per drum revolution [um] */
	uint32_t pitch_um;
	/** How far a reversal runs past the reversal point [um] */
	uint32_t overshoot_um;
	/** How far the pitch may be off to meet the overshoot [ppm] */
	int32_t slope_tolerance_ppm;
	/** Where the reversal at the plus side begins [um] */
	int32_t reversal_plus_um;
	/** Where the reversal at the minus side begins [um] */
	int32_t reversal_minus_um;
	/** Farthest place on the plus side that the carriage may be commanded to [um] */
	int32_t flange_plus_um;
	/** Farthest place on the minus side that the carriage may be commanded to [um] */
	int32_t flange_minus_um;
	/** Calibrated trigger position of the plus limit switch [um] */
	int32_t switch_plus_um;
	/** Calibrated trigger position of the minus limit switch [um] */
	int32_t switch_minus_um;
	/** A trigger further than this from its calibrated position is a LOS of type 2 [um] */
	int32_t switch_tolerance_um;
	/** Within this distance inward of its trigger point a switch has surely released [um] */
	int32_t switch_hysteresis_um;
	/** How the limit switches are wired (enum lw_switch_contacts) */
	int32_t switch_contacts;
	/**
	 * Both contacts of a pair open, or a single contact not at rest, for longer than this is a
	 * wiring fault [ms]
	 */
	int32_t switch_transit_ms;
	/** Debounce time of a single contact [ms] */
	int32_t switch_debounce_ms;
	/** Carriage travel between the mechanical end stops [um] */
	uint32_t travel_um;
	/**
	 * How late a limit switch tells that it was reached; `levelwind index --rates` measures it
	 * (0: at once) [us]
	 */
	int32_t switch_delay_us;
	/** Which limit switch is the indexing switch (enum lw_side) */
	int32_t index_switch;
	/** Rate of the simulated edges for indexing and centring [edges/s] */
	int32_t index_rate_edges_per_s;
	/** Where indexing ends (enum lw_park_at) */
	int32_t park_at;
	/** Parking place if park_at is position [um] */
	int32_t park_position_um;
	/** Indexing: how far the other switch may be from its calibrated position [um] */
	int32_t span_tolerance_um;
	/**
	 * Carriage direction on hand-over from a parking position or the centre, drum hauling in
	 * (enum lw_side)
	 */
	int32_t handover_direction;
	/** The drum counts as at rest below this rate [edges/s] */
	int32_t rest_edges_per_s;
	/** The drum counts as at rest after this time below rest_edges_per_s [ms] */
	int32_t rest_time_ms;
	/** Where mode centre holds the carriage [um] */
	int32_t centre_position_um;
	/** Rate of the simulated edges for jogging [edges/s] */
	int32_t jog_rate_edges_per_s;
	/** A jog stops when it is not written again within this time [ms] */
	int32_t jog_hold_ms;
	/** Stop after more LOS recoveries than this in one launch (0: never stop) */
	int32_t los_recoveries_max;
	/** Drum speed that sets the flag overspeed_warning [edges/s] */
	uint32_t overspeed_warning_edges_per_s;
	/** Drum speed that stops the controller [edges/s] */
	uint32_t overspeed_trip_edges_per_s;
	/** Without a valid request for this long the launch permit drops (0: not watched) [ms] */
	int32_t master_timeout_ms;
	/** Dwell at the far point of the plus reversal [1/1000 drum rev] */
	int32_t dwell_plus_millirev;
	/** Dwell at the far point of the minus reversal [1/1000 drum rev] */
	int32_t dwell_minus_millirev;
	/**
	 * Ribbon breaker: both dwells grow by up to this much and shrink again, from reversal to
	 * reversal of their side [1/1000 drum rev]
	 */
	int32_t breaker_millirev;
	/** Ribbon breaker: it goes up and down once in so many double traverses (0: off) */
	int32_t breaker_cycles;
	/** 1: the four raw_ values replace pitch, overshoot and reversal points */
	int32_t expert_mode;
	/** Slope change per edge in a reversal [usteps/65536] */
	int32_t raw_ka;
	/** Edges from sweep slope to zero slope; Ks = Ka * Nr [edges] */
	int32_t raw_nr;
	/** L+ [usteps] */
	int32_t raw_reversal_plus_usteps;
	/** L- [usteps] */
	int32_t raw_reversal_minus_usteps;
	/** Modbus unit id, effective after APPLY, SAVE and restart */
	int32_t unit_id;
	/** Line speed, effective after APPLY, SAVE and restart [baud] */
	uint32_t baud_rate;
	/**
	 * Data bits, parity, stop bits, effective after APPLY, SAVE and restart (enum
	 * lw_line_format)
	 */
	int32_t line_format;
	/**
	 * Code of the write lock, 0: no lock. Reads 1000000 if there is a code; writing 1000000
	 * keeps it
	 */
	uint32_t lock_code;
	/** The write lock closes by itself this long after it was opened [s] */
	int32_t lock_timeout_s;
	/** How long try_line waits for a valid request [s] */
	int32_t line_confirm_s;
	/**
	 * One encoder channel that changes faster than this without the other makes the encoder
	 * doubtful [transitions/s]
	 */
	uint32_t encoder_watch_transitions_per_s;
	/** An encoder that is doubtful for this long has a fault [ms] */
	int32_t encoder_watch_ms;
	/**
	 * Of 1000 transitions so many may change both channels at once, before the encoder has a
	 * fault (1000: any) [1/1000]
	 */
	int32_t encoder_illegal_permille;
	/**
	 * No edge for this long while drum_running is 1: the encoder has a fault (0: not watched)
	 * [ms]
	 */
	int32_t drum_watch_ms;
	/**
	 * Rope hauled in while the carriage stands sets rope_laid_standing from so many drum turns
	 * on (0: not watched) [1/1000 drum rev]
	 */
	int32_t standing_turns_permille;
	/** Diameter of the rope (0: not known) [um] */
	int32_t rope_diameter_um;
	/**
	 * Diameter of the bare drum (0: not known). With rope_diameter_um and
	 * rope_packing_permille, metres of rope follow the growing layers [um]
	 */
	uint32_t drum_core_diameter_um;
	/**
	 * How much of the room on the drum the rope fills, fitted from two known lengths; about 600
	 * to 900 (0: not known) [1/1000]
	 */
	int32_t rope_packing_permille;
	/** How far trim_early and trim_late shift a reversal point [um] */
	int32_t trim_step_um;
	/**
	 * 1: where the drum came to rest is kept, also over a power-off, and after an indexing the
	 * carriage first goes there and takes up direction and slope; 0: it begins where the
	 * indexing ends
	 */
	int32_t resume;
	/**
	 * 1: where the controller has restarted in a launch (memory kept, the drum still turns), it
	 * gives reacquire by itself. THE CARRIAGE MOVES UNASKED
	 */
	int32_t reacquire_after_restart;
	/**
	 * The set that somebody has accepted: active_crc as it was then, written by `levelwind
	 * commission` (0: none)
	 */
	uint32_t accepted_crc;
	/** What the carriage follows the drum by (enum lw_motion_profile) */
	int32_t motion_profile;
	/** How a cam begins at a hand-over (enum lw_cam_start) */
	int32_t cam_start;
	/** So many encoder edges are cam_master_units of a cam table's master column [edges] */
	int32_t cam_master_edges;
	/** See cam_master_edges */
	int32_t cam_master_units;
	/** So many microsteps are cam_slave_units of a cam table's slave column [usteps] */
	int32_t cam_slave_usteps;
	/** See cam_slave_usteps */
	int32_t cam_slave_units;
	/** Trapezoid rows: each ramp is this part of its row */
	int32_t cam_ramp_divisor;
	/** What a cam moves (enum lw_cam_axis) */
	int32_t cam_axis;
	/**
	 * Fastest step pulses that the stepper driver and the motor follow; a cam table may ask for
	 * no more at overspeed_trip_edges_per_s [usteps/s]
	 */
	uint32_t cam_steps_per_s_max;
};

/**
 * Identity, live status, LOS records, counters, command results and derived values. One member for
 * each point, in the memory type of lw/map/point.h.
 */
struct lw_status {
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
	/** What runs the core (enum lw_host) */
	int32_t host;
	/**
	 * What runs: bytes 0 to 3 of the SHA-256 of zephyr.bin, worked out over the flash at power-
	 * up (0, and so the low half: not known, as on the simulators)
	 */
	uint32_t image_hash_high;
	/** Bytes 4 to 7 of it */
	uint32_t image_hash_low;
	/** What the controller is doing (enum lw_state) */
	int32_t state;
	/** Mode in force (the requested one waits for the drum to rest) (enum lw_mode) */
	int32_t active_mode;
	/** Why the controller stopped (enum lw_fault) */
	int32_t fault;
	/**
	 * The first 32 discrete inputs, bit number = discrete input address (bits: enum lw_flag)
	 */
	uint32_t flags;
	/**
	 * Why a launch is not permitted; 0 means launch permit (bits: enum lw_launch_inhibit_bit)
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
	 * lw_flag)
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
	/** Storage: first slot of the parameters (enum lw_slot_state) */
	int32_t slot_0;
	/** Storage: second slot of the parameters (enum lw_slot_state) */
	int32_t slot_1;
	/** Storage: first slot of event log and counters (enum lw_slot_state) */
	int32_t slot_2;
	/** Storage: second slot of event log and counters (enum lw_slot_state) */
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
	 * (enum lw_encoder_fault)
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
	/** The last command (enum lw_command) */
	int32_t command_code;
	/** How it ended (enum lw_result) */
	int32_t command_result;
	/** Why it was refused or failed (enum lw_reason) */
	int32_t command_reason;
	/** Offending holding register, 65535 if none */
	int32_t command_address;
	/** Offending value */
	int32_t command_value;
	/** The limit that it broke */
	int32_t command_limit;
	/** Why the last refused request was refused (enum lw_reason) */
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
	/** What the first bank of cam tables holds (enum lw_cam_bank_state) */
	int32_t cam_bank_0_state;
	/** What the second bank of cam tables holds (enum lw_cam_bank_state) */
	int32_t cam_bank_1_state;
	/**
	 * Why the last check of a cam table refused it, or why the active one cannot be followed
	 * (enum lw_reason)
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
	/** Storage: first slot of cam tables (enum lw_slot_state) */
	int32_t slot_4;
	/** Storage: second slot of cam tables (enum lw_slot_state) */
	int32_t slot_5;
	/** Storage: first slot of what needs a look at the rope (enum lw_slot_state) */
	int32_t slot_6;
	/** Storage: second slot of what needs a look at the rope (enum lw_slot_state) */
	int32_t slot_7;
};

/**
 * The cam bank that is not in force, to write and to read. The same as the file record interface.
 * One member for each point, in the memory type of lw/map/point.h.
 */
struct lw_cam_upload {
	/** Name, two characters of ASCII in a register */
	int32_t cam_upload_name[8];
	/** Version, for people */
	uint32_t cam_upload_version;
	/** How to go from row to row (enum lw_cam_interpolation) */
	int32_t cam_upload_interpolation;
	/** Rows */
	int32_t cam_upload_row_count;
	/** Slave units that a cycle adds; 0: cyclic */
	int32_t cam_upload_advance;
	/** CRC-32 of the 14 registers before and 4 per row, high word first */
	int32_t cam_upload_crc[2];
	/** Row that cam_upload_rows begins at, counted from 1; may stand in the same request */
	int32_t cam_upload_first_row;
	/** Window of 30 rows: master, slave, alternating */
	int32_t cam_upload_rows[60];
};

/**
 * The simulated plant (only in builds that have one). One member for each point, in the memory type
 * of lw/map/point.h.
 */
struct lw_bench {
	/** Argument of bench_command; may stand in the same request */
	int32_t bench_argument;
	/** Writing a code runs it (enum lw_bench_command) */
	int32_t bench_command;
	/** Drum speed asked for; writing it ends a profile [millirpm] */
	int32_t bench_drum_speed_millirpm;
	/** How fast the drum reaches it [millirpm/s] */
	uint32_t bench_drum_acceleration_millirpm_per_s;
	/** Side load on the carriage, as acceleration [mm/s2] */
	int32_t bench_side_load_mm_per_s2;
	/** 1 holds the carriage where it is */
	int32_t bench_stall;
	/** Bounce of the limit switches [ms] */
	int32_t bench_bounce_ms;
	/** Fault of the plus limit switch (enum lw_switch_fault) */
	int32_t bench_switch_plus_fault;
	/** Fault of the minus limit switch (enum lw_switch_fault) */
	int32_t bench_switch_minus_fault;
	/** 1 actuates the plus overtravel switch */
	int32_t bench_overtravel_plus;
	/** 1 actuates the minus overtravel switch */
	int32_t bench_overtravel_minus;
	/** 1 swaps the stepper's direction wire */
	int32_t bench_direction_reversed;
	/** Armed fault: real carriage position that releases it [um] */
	int32_t bench_trigger_position_um;
	/** Armed fault: only when passing in this direction (0: either) */
	int32_t bench_trigger_direction;
	/** Armed fault: its argument */
	int32_t bench_trigger_argument;
	/** Writing it arms the fault; reads 0 once released (enum lw_trigger_fault) */
	int32_t bench_trigger_fault;
	/** 1 lets the stepper driver report an alarm and switch its motor off */
	int32_t bench_stepper_alarm;
	/**
	 * Writing a code hangs that thread; refused by the simulator, which has none (enum
	 * lw_bench_thread)
	 */
	int32_t bench_hang;
	/** The last restart by the watchdog, as the stepper saw it (enum lw_bench_restart) */
	int32_t bench_restart;
	/** 1 presses the button for early reversal */
	int32_t bench_trim_early;
	/** 1 presses the button for late reversal */
	int32_t bench_trim_late;
	/**
	 * 0: the last bench command or armed fault was accepted; else the POSIX error number why
	 * not
	 */
	int32_t bench_result;
	/** Real carriage position [um] */
	int32_t bench_carriage_um;
	/** Real carriage velocity [mm/s] */
	int32_t bench_carriage_mm_per_s;
	/** Net step pulses received by the stepper [usteps] */
	int32_t bench_commanded_usteps;
	/** Microsteps lost by the stepper, net [usteps] */
	int32_t bench_slipped_usteps;
	/** Net A/B transitions of the encoder shaft */
	int64_t bench_transitions;
	/** Real drum speed [millirpm] */
	int32_t bench_drum_actual_millirpm;
	/** Points of the profile in memory */
	int32_t bench_profile_points;
	/** 1 while the profile is played */
	int32_t bench_profile_running;
	/** Plant time [ms] */
	uint32_t bench_time_ms;
	/** Window of 30 profile points: time in ms, drum speed in millirpm, alternating */
	int32_t bench_profile[60];
	/** Fault of encoder channel A (enum lw_channel_fault) */
	int32_t bench_encoder_a_fault;
	/** Fault of encoder channel B (enum lw_channel_fault) */
	int32_t bench_encoder_b_fault;
	/** 0: the encoder's index channel is not wired */
	int32_t bench_index_pulses;
	/**
	 * How much each layer of rope makes the drum thicker (its radius); 0: the drum stays as it
	 * is [um]
	 */
	int32_t bench_rope_layer_um;
	/** Turns of a layer [1/1000 turn] */
	uint32_t bench_rope_layer_milliturns;
	/** Diameter of the bare drum [um] */
	uint32_t bench_rope_core_um;
	/** Rope that is really on the drum, beginning bare [mm] */
	int32_t bench_rope_mm;
	/**
	 * How late the limit switches trigger and release, before the millisecond that a contact
	 * travels [us]
	 */
	int32_t bench_switch_late_us;
};

#define LW_MAP_SETPOINTS_COUNT 9

/**
 * Commands and set-points, effective at once, never stored: holding registers, offsets in struct
 * lw_setpoints
 */
extern const struct lw_point lw_map_setpoints[LW_MAP_SETPOINTS_COUNT];

#define LW_MAP_PARAMS_COUNT 78

/**
 * Parameters (staged). APPLY makes them active, SAVE stores the active set: holding registers,
 * offsets in struct lw_params
 */
extern const struct lw_point lw_map_params[LW_MAP_PARAMS_COUNT];

#define LW_MAP_STATUS_COUNT 140

/**
 * Identity, live status, LOS records, counters, command results and derived values: input
 * registers, offsets in struct lw_status
 */
extern const struct lw_point lw_map_status[LW_MAP_STATUS_COUNT];

#define LW_MAP_CAM_UPLOAD_COUNT 8

/**
 * The cam bank that is not in force, to write and to read. The same as the file record interface:
 * holding registers, offsets in struct lw_cam_upload
 */
extern const struct lw_point lw_map_cam_upload[LW_MAP_CAM_UPLOAD_COUNT];

#define LW_MAP_BENCH_COUNT 40

/**
 * The simulated plant (only in builds that have one): holding registers, offsets in struct lw_bench
 */
extern const struct lw_point lw_map_bench[LW_MAP_BENCH_COUNT];

#define LW_MAP_COILS_COUNT 13

/** Coils, indexed by address */
extern const struct lw_point lw_map_coils[LW_MAP_COILS_COUNT];

#define LW_MAP_DISCRETES_COUNT 45

/** Discrete inputs, indexed by address */
extern const struct lw_point lw_map_discretes[LW_MAP_DISCRETES_COUNT];

/** enum lw_command that a coil runs, indexed by address; 0: the coil jogs */
extern const uint8_t lw_map_coil_command[LW_MAP_COILS_COUNT];

/** Direction in which a coil jogs, indexed by address; 0: it runs a command */
extern const int8_t lw_map_coil_jog[LW_MAP_COILS_COUNT];

/** The factory values of all parameters */
extern const struct lw_params lw_params_default;

#endif /* LW_MAP_H */
