# SPDX-License-Identifier: Apache-2.0
"""The Modbus map: every point, enumeration, limit and default.

Generated from modbus_map/registers.yaml by: python3 modbus_map/generate.py
Do not edit.
"""
# ruff: noqa: E501

import builtins
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Literal

Space = Literal["coil", "discrete", "holding", "input"]
PointType = Literal["bit", "u16", "i16", "u32", "i32", "i64"]


class MapEnum(IntEnum):
    """An enumeration of the map. Members know their name in the map and their text."""

    label: str
    text: str

    def __new__(cls, value: int, label: str = "", text: str = "") -> "MapEnum":
        member = int.__new__(cls, value)
        member._value_ = value
        member.label = label
        member.text = text
        return member


class State(MapEnum):
    """What the controller is doing."""

    UNINDEXED = 0, "unindexed", "Position unknown. Give the command index"
    BACKING_OFF = (
        1,
        "backing_off",
        "Indexing: moving off a limit switch that was active at the start",
    )
    SEEKING = 2, "seeking", "Indexing: moving toward the indexing switch"
    INDEX_REVERSAL = (
        3,
        "index_reversal",
        "Indexing: switch found, turning round at the reversal point",
    )
    SPAN_CHECK = 4, "span_check", "Indexing: sweeping back to check the other switch"
    PARKING = 5, "parking", "Indexing: coming to rest at the parking place"
    READY = (
        6,
        "ready",
        "Indexed and at rest. In mode track it follows the drum once that rests; after a stop, write the mode again",
    )
    TRACKING = 7, "tracking", "Following the drum"
    CENTRING = (
        8,
        "centring",
        "Moving to the centre, to where the rope goes on, or back into the sweep before a hand-over",
    )
    CENTRED = (
        9,
        "centred",
        "Held at the centre, the drum is not followed. For a launch set the mode to track",
    )
    JOGGING = 10, "jogging", "Moving by hand"
    OFF = 11, "off", "Stepper without current, position unknown. Set the mode to track, then index"
    FAULT = 12, "fault", "Stopped by a fault, see the register fault"
    REACQUIRING = (
        13,
        "reacquiring",
        "Taking up a turning drum after a restart in a launch: on the way to a limit switch, place unknown",
    )


class Mode(MapEnum):
    """What the carriage shall do."""

    OFF = 0, "off", "Stepper without current. The index is lost"
    TRACK = 1, "track", "Follow the drum once indexed"
    CENTRE = 2, "centre", "Hold the carriage at the centre, for pulling rope out"


class Fault(MapEnum):
    """Why the controller stopped."""

    NONE = 0, "none", "No fault"
    INDEX_NO_SWITCH = (
        1,
        "index_no_switch",
        "Indexing: no limit switch within the travel. Is the carriage free, is the stepper powered?",
    )
    INDEX_WRONG_SWITCH = (
        2,
        "index_wrong_switch",
        "Indexing: the opposite switch came first. Check the stepper direction and which switch is which",
    )
    INDEX_SPAN = (
        3,
        "index_span",
        "Indexing: the other switch is not where it was calibrated. Check both switches, then their calibrated positions",
    )
    BOTH_SWITCHES_ACTIVE = (
        4,
        "both_switches_active",
        "Both limit switches, or both overtravel switches, are active at once. Check the switch wiring",
    )
    BACK_OFF_NO_RELEASE = (
        5,
        "back_off_no_release",
        "The limit switch did not release although the carriage moved away. Stuck switch, or the stepper does not move",
    )
    WIRING_PLUS = (
        6,
        "wiring_plus",
        "Plus limit switch: contacts contradict each other or both stay open. Broken wire or short",
    )
    WIRING_MINUS = (
        7,
        "wiring_minus",
        "Minus limit switch: contacts contradict each other or both stay open. Broken wire or short",
    )
    OVERTRAVEL_PLUS = (
        8,
        "overtravel_plus",
        "Plus overtravel switch: stepper disabled, only motion toward minus is allowed. If the carriage is not there, check this switch and its wire",
    )
    OVERTRAVEL_MINUS = (
        9,
        "overtravel_minus",
        "Minus overtravel switch: stepper disabled, only motion toward plus is allowed. If the carriage is not there, check this switch and its wire",
    )
    OVERSPEED = (
        10,
        "overspeed",
        "The drum turned faster than overspeed_trip_edges_per_s, the stepper cannot follow",
    )
    LOS_LIMIT = (
        11,
        "los_limit",
        "More losses of synchronization in one launch than los_recoveries_max",
    )
    STEPPER_ALARM = (
        12,
        "stepper_alarm",
        "The stepper driver reports an alarm: steps may be lost. Look at the driver, then index again",
    )
    REACQUIRE_NO_SWITCH = (
        13,
        "reacquire_no_switch",
        "Taking up a turning drum: no limit switch within the travel. Is the carriage free, is the stepper powered?",
    )
    REACQUIRE_WRONG_SWITCH = (
        14,
        "reacquire_wrong_switch",
        "Taking up a turning drum: the opposite switch came. Check the stepper direction and which switch is which",
    )


class Command(MapEnum):
    """Momentary commands, by the register command or by the coil of the same name."""

    NONE = 0, "none", "Nothing"
    INDEX = 1, "index", "Find the position (homing). The drum must be at rest"
    STOP = 2, "stop", "Stop every motion now. Always accepted"
    CLEAR_FAULT = (
        3,
        "clear_fault",
        "Acknowledge a fault whose cause is gone; indexing is needed afterwards",
    )
    APPLY = 4, "apply", "Check the staged parameters as a whole and make them active"
    REVERT = 5, "revert", "Drop the staged parameters: staged becomes active again"
    SAVE = 6, "save", "Write the active parameters to non-volatile storage"
    FACTORY_MOTION = (
        7,
        "factory_motion",
        "Stage the factory values of everything but the line settings",
    )
    FACTORY_LINE = 8, "factory_line", "Stage the factory line settings"
    FACTORY_ALL = 9, "factory_all", "Stage all factory values"
    TRY_LINE = (
        10,
        "try_line",
        "Use the active line settings now; the old ones again if no valid request comes within line_confirm_s",
    )
    ACKNOWLEDGE_ROPE = (
        11,
        "acknowledge_rope",
        "Somebody has looked at the rope that was laid while the carriage stood; taken after an indexing only",
    )
    SET_ROPE = 12, "set_rope", "So much rope is on the drum: set_rope_mm. The drum must be at rest"
    TRIM_EARLY = (
        13,
        "trim_early",
        "Reverse earlier at the side that the carriage moves toward: by trim_step_um, while tracking",
    )
    TRIM_LATE = (
        14,
        "trim_late",
        "Reverse later at the side that the carriage moves toward: by trim_step_um, while tracking",
    )
    REACQUIRE = (
        15,
        "reacquire",
        "Take up a turning drum from rest, after a restart in a launch: to the first limit switch, then on. The position must be unknown",
    )
    CAM_CHECK = 30, "cam_check", "Check the uploaded cam table as a whole, and keep it"
    CAM_ACTIVATE = (
        31,
        "cam_activate",
        "Put the checked cam table in force: at once, or at the end of the cycle if a cam is running",
    )
    CAM_DISCARD = 32, "cam_discard", "Drop the queued cam table, or else the upload"


class Result(MapEnum):
    """How the last command ended."""

    NONE = 0, "none", "No command since power-up"
    IN_PROGRESS = 1, "in_progress", "Accepted, still running"
    DONE = 2, "done", "Done"
    REFUSED = 3, "refused", "Refused, nothing changed; see command_reason"
    FAILED = 4, "failed", "Started but did not succeed; see command_reason and fault"


class Reason(MapEnum):
    """Why a request, a command or a parameter set was refused."""

    NONE = 0, "none", "Not refused"
    UNKNOWN_FUNCTION = 1, "unknown_function", "This function code is not supported"
    UNKNOWN_ADDRESS = 2, "unknown_address", "No register or bit at this address"
    NOT_WRITABLE = 3, "not_writable", "This register can only be read"
    HALF_OF_PAIR = (
        4,
        "half_of_pair",
        "A value of two registers must be written whole, in one request",
    )
    OUT_OF_RANGE = 5, "out_of_range", "The value is outside the limits of this register"
    BAD_COUNT = 6, "bad_count", "The count is zero or too large for this function"
    BAD_LENGTH = 7, "bad_length", "The request is shorter or longer than its function and count say"
    BAD_COIL_VALUE = 8, "bad_coil_value", "A coil is written with 0x0000 or 0xFF00"
    SEVERAL_COMMANDS = (
        9,
        "several_commands",
        "One request can give one command or jog, and a new trim beside neither a jog nor a trim command: send the other by itself",
    )
    BUSY_TRACKING = (
        10,
        "busy_tracking",
        "Refused while tracking: stop, or set the mode to centre with the drum at rest",
    )
    BUSY_MOVING = 11, "busy_moving", "Refused while the carriage moves by itself: wait or give stop"
    BUSY_SAVING = 12, "busy_saving", "Refused while parameters are being saved: try again"
    DRUM_MOVING = 13, "drum_moving", "The drum must be at rest for this"
    CAUSE_PRESENT = 15, "cause_present", "The cause of the fault is still there"
    MODE_OFF = 16, "mode_off", "Refused in mode off: set the mode to track or centre first"
    OVERTRAVEL = 17, "overtravel", "Only motion away from the active overtravel switch is allowed"
    STORAGE_FAILED = 18, "storage_failed", "The non-volatile storage reported an error"
    STOPPED = 19, "stopped", "Ended by stop, mode off or a lost input before it was complete"
    FAULTED = 20, "faulted", "Ended by a fault, see the register fault"
    UNDEFINED_SUB_FUNCTION = (
        21,
        "undefined_sub_function",
        "This sub-function or object is not supported",
    )
    LIMIT_SWITCH = (
        22,
        "limit_switch",
        "The limit switch on that side is actuated: without an index only motion away from it is allowed",
    )
    SLOPE_ABOVE_ONE_STEP = (
        30,
        "slope_above_one_step",
        "The pitch asks for more than one step per encoder edge: finer encoder edges, fewer microsteps or a smaller pitch",
    )
    SLOPE_TOO_SMALL = 31, "slope_too_small", "The pitch asks for less than 1/65536 step per edge"
    SLOPE_UNREACHABLE = (
        32,
        "slope_unreachable",
        "No pair (Ka, Nr) meets pitch and overshoot within slope_tolerance_ppm: allow more tolerance",
    )
    REVERSALS_CROSSED = (
        33,
        "reversals_crossed",
        "reversal_minus must lie at least 2 microsteps below reversal_plus",
    )
    SWITCH_PLUS_OUTSIDE = 34, "switch_plus_outside", "switch_plus must lie inside reversal_plus"
    SWITCH_MINUS_OUTSIDE = 35, "switch_minus_outside", "switch_minus must lie inside reversal_minus"
    SWITCHES_CROSSED = (
        36,
        "switches_crossed",
        "switch_minus must lie below switch_plus by more than twice tolerance plus hysteresis",
    )
    OVERSHOOT_BEYOND_FLANGE_PLUS = (
        37,
        "overshoot_beyond_flange_plus",
        "The overshoot past reversal_plus reaches beyond flange_plus",
    )
    OVERSHOOT_BEYOND_FLANGE_MINUS = (
        38,
        "overshoot_beyond_flange_minus",
        "The overshoot past reversal_minus reaches beyond flange_minus",
    )
    PARK_OUTSIDE = (
        39,
        "park_outside",
        "The parking place needs its last reversal (plus overshoot) inside the sweep",
    )
    CENTRE_OUTSIDE = 40, "centre_outside", "centre_position must lie between the limit switches"
    RAMP_DOES_NOT_FIT = (
        41,
        "ramp_does_not_fit",
        "Two ramps of one overshoot each must fit between the switches, less tolerance and hysteresis",
    )
    POSITION_OVERFLOW = (
        42,
        "position_overflow",
        "A position or the travel is beyond 32700 microsteps: fewer microsteps per revolution or a shorter travel",
    )
    TRAVEL_TOO_SHORT = (
        43,
        "travel_too_short",
        "travel must be at least the distance between the flanges",
    )
    OVERSPEED_LIMITS_CROSSED = (
        44,
        "overspeed_limits_crossed",
        "overspeed_warning must not be above overspeed_trip",
    )
    TOLERANCE_BEYOND_FLANGE = (
        45,
        "tolerance_beyond_flange",
        "A calibrated switch position plus its tolerance must stay inside the flange",
    )
    TOO_FEW_EDGES = (
        46,
        "too_few_edges",
        "The encoder ratio gives less than one edge per drum revolution",
    )
    DEBOUNCE_TOO_LONG = (
        47,
        "debounce_too_long",
        "At overspeed_warning_edges_per_s, or at the index rate, the carriage would pass the reversal point before the switch is debounced (and switch_delay_us is over)",
    )
    BREAKER_ONE_CYCLE = (
        48,
        "breaker_one_cycle",
        "breaker_cycles must be 0 (no ribbon breaker) or at least 2: up and down takes two",
    )
    CORE_THINNER_THAN_ROPE = (
        49,
        "core_thinner_than_rope",
        "The bare drum cannot be thinner than the rope",
    )
    PACKING_TOO_SMALL = (
        50,
        "packing_too_small",
        "rope_packing_permille must be 0 (not known) or at least 100",
    )
    DRUM_NARROWER_THAN_ROPE = (
        51,
        "drum_narrower_than_rope",
        "The rope is thicker than the drum is wide between the far points of the reversals",
    )
    SWITCH_DELAY_TOO_LONG = (
        52,
        "switch_delay_too_long",
        "At overspeed_warning_edges_per_s, or at the index rate, the carriage would pass the reversal point before the switch tells (switch_delay_us)",
    )
    LOCKED = 60, "locked", "The write lock is closed: write the code to the register unlock"
    WRONG_CODE = 61, "wrong_code", "This is not the code of the write lock"
    UNLOCK_WAIT = (
        62,
        "unlock_wait",
        "After a wrong code: wait before the next try, longer every time",
    )
    LINE_NOT_CONFIRMED = (
        63,
        "line_not_confirmed",
        "No valid request came at the line settings on trial: the old ones are in use again",
    )
    UNKNOWN_FILE = 64, "unknown_file", "There is no file of this number"
    UNKNOWN_RECORD = 65, "unknown_record", "The file has no record of this number"
    BAD_REFERENCE_TYPE = (
        66,
        "bad_reference_type",
        "The reference type of a group of file records must be 6",
    )
    ANSWER_TOO_LONG = (
        67,
        "answer_too_long",
        "The answer would not fit into one frame: ask for fewer records",
    )
    CAM_TOO_FEW_ROWS = 70, "cam_too_few_rows", "A cam table needs at least two rows"
    CAM_TOO_MANY_ROWS = 71, "cam_too_many_rows", "The cam table has more rows than fit"
    CAM_FIRST_MASTER = 72, "cam_first_master", "The first row of a cam table must have master 0"
    CAM_MASTER_NOT_ASCENDING = (
        73,
        "cam_master_not_ascending",
        "The master positions of a cam table must ascend from row to row",
    )
    CAM_ROW_TOO_SHORT = (
        74,
        "cam_row_too_short",
        "The way from this cam row to the next is shorter than one encoder edge (in master units)",
    )
    CAM_ROW_TOO_LARGE = (
        75,
        "cam_row_too_large",
        "The way from this cam row to the next is too long for exact arithmetic (in master units): put a row between",
    )
    CAM_CYCLE_TOO_LONG = (
        76,
        "cam_cycle_too_long",
        "The cycle of the cam table is too long (in master units)",
    )
    CAM_SLOPE = (
        77,
        "cam_slope",
        "The way from this cam row to the next asks for too many steps per edge (in steps per 1000 edges, ramps included)",
    )
    CAM_STEP_RATE = (
        78,
        "cam_step_rate",
        "The way from this cam row to the next asks for too many steps per second at overspeed_trip_edges_per_s",
    )
    CAM_WRAP = (
        79,
        "cam_wrap",
        "Last minus first slave of the cam table differs from the declared advance (0 if cyclic)",
    )
    CAM_INTERPOLATION = 80, "cam_interpolation", "The cam table names an unknown interpolation"
    CAM_CRC = (
        81,
        "cam_crc",
        "The cam table is not the one whose CRC was uploaded with it: upload it again as a whole",
    )
    CAM_BEYOND_FLANGE = (
        82,
        "cam_beyond_flange",
        "A position of the cam table is beyond a flange (in microsteps)",
    )
    CAM_NO_TABLE = (
        83,
        "cam_no_table",
        "There is no checked cam table for this: upload one and give cam_check",
    )
    CAM_BANK_IN_USE = (
        84,
        "cam_bank_in_use",
        "This cam bank is in force or queued: upload into the other one",
    )
    CAM_QUEUED = (
        85,
        "cam_queued",
        "A cam table is queued: wait for the end of the cycle, or give cam_discard",
    )
    CAM_DOES_NOT_JOIN = (
        86,
        "cam_does_not_join",
        "The new cam table must begin at the slave position where the one in force begins (cam_start other than relative)",
    )
    CAM_FREE_AXIS = (
        87,
        "cam_free_axis",
        "A free axis has no position to begin at: cam_start must be relative",
    )
    CAM_ADVANCES = (
        88,
        "cam_advances",
        "A cam table that advances leaves the flanges behind: it needs cam_axis free",
    )
    ENCODER_DOUBTFUL = (
        90,
        "encoder_doubtful",
        "One encoder channel changes and the other one does not follow: the drum may be turning. Wait until it rests; if it rests, look at the encoder and its wires",
    )
    DRUM_RUNNING = (
        91,
        "drum_running",
        "The master says that the drum turns: write drum_running 0 first",
    )
    ROPE_INDEX_FIRST = (
        96,
        "rope_index_first",
        "Look at the rope and index first: rope laid while the carriage stood is acknowledged after an indexing",
    )
    ROPE_NOT_DESCRIBED = (
        97,
        "rope_not_described",
        "Metres of rope need rope_diameter_um, drum_core_diameter_um and rope_packing_permille: set them, apply, then set_rope",
    )
    ROPE_LENGTH_MISSING = (
        98,
        "rope_length_missing",
        "Write set_rope_mm first: so many millimetres of rope are on the drum",
    )
    ROPE_TOO_LONG = (
        99,
        "rope_too_long",
        "So much rope does not go onto this drum: check set_rope_mm, drum_core_diameter_um and rope_packing_permille",
    )
    TRIM_NOT_FOLLOWING = (
        100,
        "trim_not_following",
        "Only a carriage that follows the drum by the reversing screw has a reversal to make earlier or later",
    )
    DRUM_AT_REST = 101, "drum_at_rest", "The drum must turn for this; at rest give index"
    POSITION_KNOWN = (
        102,
        "position_known",
        "The position is known: write mode track, and the drum is followed once it rests",
    )
    FAULT_STANDS = 103, "fault_stands", "A fault stands: remove its cause, then clear_fault first"
    NOT_MODE_TRACK = 104, "not_mode_track", "Only in mode track with motion_profile screw"


class Host(MapEnum):
    """What runs the core."""

    SIMULATOR = 1, "simulator", "POSIX simulator"
    NATIVE_SIM = 2, "native_sim", "Zephyr native_sim"
    QEMU = 3, "qemu", "Zephyr in QEMU"
    HARDWARE = 4, "hardware", "Zephyr on hardware"


class SwitchContacts(MapEnum):
    """How a limit switch is wired."""

    NO_NC_PAIR = (
        0,
        "no_nc_pair",
        "Change-over switch, both contacts wired: no debounce delay, broken wires are found",
    )
    SINGLE_NO = 1, "single_no", "One normally open contact"
    SINGLE_NC = 2, "single_nc", "One normally closed contact"


class Side(MapEnum):
    """A side of the drum."""

    PLUS = 0, "plus", "Plus side"
    MINUS = 1, "minus", "Minus side"


class ParkAt(MapEnum):
    """Where indexing ends."""

    FLANGE = 0, "flange", "At the far point of the reversal opposite to the indexing switch"
    POSITION = 1, "position", "At park_position_um"


class LineFormat(MapEnum):
    """Data bits, parity, stop bits."""

    FORMAT_8E1 = 0, "8E1", "8 data bits, even parity, 1 stop bit (the standard's default)"
    FORMAT_8O1 = 1, "8O1", "8 data bits, odd parity, 1 stop bit"
    FORMAT_8N1 = 2, "8N1", "8 data bits, no parity, 1 stop bit"
    FORMAT_8N2 = 3, "8N2", "8 data bits, no parity, 2 stop bits"


class SlotState(MapEnum):
    """What a slot of the storage holds."""

    EMPTY = 0, "empty", "Never written, or erased"
    GOOD = 1, "good", "An intact record of this firmware"
    OLDER = 2, "older", "An intact record of an older schema, converted when it was loaded"
    NEWER = (
        3,
        "newer",
        "An intact record of newer firmware that this one cannot read. It is kept until two more SAVEs",
    )
    DAMAGED = 4, "damaged", "Cut short or changed: not used"
    REFUSED = 5, "refused", "An intact parameter set that this firmware does not accept: not used"


class Event(MapEnum):
    """What happened, in the event log."""

    NONE = 0, "none", "Empty record"
    POWER_UP = (
        1,
        "power_up",
        "Power-up. Detail: firmware version, major * 10000 + minor * 100 + patch",
    )
    WATCHDOG_RESET = 2, "watchdog_reset", "The watchdog had restarted the controller"
    DEFAULTS_LOADED = 3, "defaults_loaded", "No usable stored set: the factory values are active"
    SLOT_DAMAGED = (
        4,
        "slot_damaged",
        "A stored record was damaged. Detail: slot, 0 and 1 parameters, 2 and 3 log, 4 and 5 cam tables, 6 and 7 what needs a look at the rope",
    )
    SLOT_NEWER = 5, "slot_newer", "A stored record of newer firmware was not read. Detail: slot"
    SLOT_REFUSED = 6, "slot_refused", "A stored parameter set was not accepted. Detail: slot"
    MODE_CHANGED = 10, "mode_changed", "Another mode came into force"
    INDEX_STARTED = 11, "index_started", "Indexing began"
    INDEX_DONE = 12, "index_done", "Indexing succeeded. Detail: span error in um"
    INDEX_FAILED = (
        13,
        "index_failed",
        "Indexing ended without success; without a fault it was stopped",
    )
    TRACKING_STARTED = 14, "tracking_started", "The carriage follows the drum"
    TRACKING_ENDED = 15, "tracking_ended", "The carriage does not follow the drum any more"
    STOPPED = 16, "stopped", "The command stop"
    FAULT_SET = 20, "fault_set", "Stopped by a fault"
    FAULT_CLEARED = 21, "fault_cleared", "The fault was acknowledged"
    LOS1_PLUS = (
        22,
        "los1_plus",
        "Synchronization lost (LOS type 1+): the reversal at plus was entered, its switch had not triggered. Detail: how many since power-up",
    )
    LOS1_MINUS = (
        23,
        "los1_minus",
        "Synchronization lost (LOS type 1-): the reversal at minus was entered, its switch had not triggered. Detail: how many since power-up",
    )
    LOS2_PLUS = (
        24,
        "los2_plus",
        "Synchronization lost (LOS type 2+): the plus switch triggered out of its place. Detail: how many since power-up",
    )
    LOS2_MINUS = (
        25,
        "los2_minus",
        "Synchronization lost (LOS type 2-): the minus switch triggered out of its place. Detail: how many since power-up",
    )
    WIRING_PLUS = 26, "wiring_plus", "Wiring fault of the plus limit switch"
    WIRING_MINUS = 27, "wiring_minus", "Wiring fault of the minus limit switch"
    OVERSPEED_WARNING = (
        28,
        "overspeed_warning",
        "The drum exceeded overspeed_warning_edges_per_s. Detail: edges/s",
    )
    SWITCH_IMPLAUSIBLE = (
        36,
        "switch_implausible",
        "A limit switch said what the known position makes impossible",
    )
    MASTER_LOST = 30, "master_lost", "The Modbus master fell silent"
    MASTER_BACK = 31, "master_back", "The Modbus master is back"
    ENCODER_FAULT = (
        32,
        "encoder_fault",
        "The encoder does not tell the drum's motion. A loss of synchronization",
    )
    LINE_BABBLE = (
        34,
        "line_babble",
        "Bytes came on the line without a silence for more than a second. Detail: how often since power-up",
    )
    LINE_ECHO = (
        35,
        "line_echo",
        "The line gives back what is sent on it. Detail: echoes dropped since power-up",
    )
    APPLIED = 40, "applied", "Staged parameters became active"
    APPLY_REFUSED = 41, "apply_refused", "The staged parameters were not accepted"
    SAVED = 42, "saved", "The active parameters were stored. Detail: sequence number of the record"
    SAVE_FAILED = 43, "save_failed", "The storage failed. Detail: its error number"
    FACTORY_STAGED = 44, "factory_staged", "Factory values were staged"
    CAM_ACTIVATED = 45, "cam_activated", "A cam table came into force. Detail: its version"
    ACCEPTED = (
        46,
        "accepted",
        "A parameter set was signed. Detail: accepted_crc; 0: the signature was taken back",
    )
    LOCK_OPENED = 50, "lock_opened", "The write lock was opened"
    LOCK_CLOSED = 51, "lock_closed", "The write lock closed"
    ROPE_LAID_STANDING = (
        60,
        "rope_laid_standing",
        "Rope was laid while the carriage stood. Detail: drum turns so far, in thousandths",
    )
    ROPE_ACKNOWLEDGED = (
        61,
        "rope_acknowledged",
        "Rope laid while the carriage stood was acknowledged. Detail: drum turns, in thousandths",
    )
    ODOMETER_DOUBTFUL = (
        62,
        "odometer_doubtful",
        "The drum turned while the storage was written: edges may be missing. Detail: edges that were counted meanwhile",
    )
    LOOK_PENDING = (
        63,
        "look_pending",
        "Since before this power-up the rope needs a look. Detail: bits as in look_before_power_up",
    )
    ROPE_SET = 64, "rope_set", "The rope on the drum was told (set_rope). Detail: mm"
    TRIMMED = (
        65,
        "trimmed",
        "The reversals were trimmed by the buttons. Detail: the trim of that side, um",
    )
    TRIM_REFUSED = 66, "trim_refused", "A trim by the buttons was refused"
    RESUMED = (
        67,
        "resumed",
        "The carriage went to where the rope goes on, and takes up direction and slope there. Detail: position in um",
    )
    REACQUIRE_STARTED = (
        68,
        "reacquire_started",
        "The carriage began to take up a turning drum, after a restart in a launch. Detail: toward plus 1, toward minus -1",
    )
    REACQUIRE_DONE = (
        69,
        "reacquire_done",
        "It was indexed on a limit switch, and follows. The rope may be laid wrong until an indexing. Detail: how far it had been counted from its place, um",
    )
    CLOCK_FALLBACK = 70, "clock_fallback", "The processor started without its external clock"
    MEMORY_CORRECTED = (
        71,
        "memory_corrected",
        "A bit of the active parameters or of the law in force had flipped in memory and was set right; the law also tells a LOS. Detail: how often since power-up",
    )


class EncoderFault(MapEnum):
    """What is wrong with the encoder."""

    NONE = 0, "none", "Nothing"
    A_STILL = 1, "a_still", "Channel A stands still while channel B changes"
    B_STILL = 2, "b_still", "Channel B stands still while channel A changes"
    A_FLICKERS = (
        3,
        "a_flickers",
        "Channel A does not follow channel B: a loose wire, or a drum that chatters",
    )
    B_FLICKERS = (
        4,
        "b_flickers",
        "Channel B does not follow channel A: a loose wire, or a drum that chatters",
    )
    ILLEGAL = 5, "illegal", "Both channels change at once more often than encoder_illegal_permille"
    INDEX_MISFIT = (
        6,
        "index_misfit",
        "The index pulses do not fit the edges: edges are lost, or too many",
    )
    NO_EDGES = (
        7,
        "no_edges",
        "The master says that the drum turns (drum_running), and no edge came for drum_watch_ms",
    )


class MotionProfile(MapEnum):
    """What the carriage follows the drum by."""

    SCREW = 0, "screw", "The reversing screw: level winding"
    CAM = 1, "cam", "The active cam table"


class CamStart(MapEnum):
    """How a cam begins at a hand-over."""

    ABSOLUTE = (
        0,
        "absolute",
        "The carriage goes to the slave position of the odometer's place in the cycle, then follows",
    )
    RELATIVE = (
        1,
        "relative",
        "The cycle begins here and now, the slave position where the carriage is",
    )
    NEXT_CYCLE = (
        2,
        "next_cycle",
        "The carriage goes to the table's first slave position and follows from the odometer's next begin of a cycle",
    )


class CamAxis(MapEnum):
    """What a cam moves."""

    CARRIAGE = 0, "carriage", "The carriage, between the flanges"
    FREE = (
        1,
        "free",
        "An axis without ends; a table may advance. Its position is 0 wherever it is left",
    )


class CamBankState(MapEnum):
    """What a bank of cam tables holds."""

    EMPTY = 0, "empty", "Nothing"
    LOADING = 1, "loading", "Parts of an upload; give cam_check when it is complete"
    READY = 2, "ready", "A checked table that is not in force"
    QUEUED = 3, "queued", "A checked table that waits for the end of the cycle"
    ACTIVE = 4, "active", "The table in force"


class CamInterpolation(MapEnum):
    """How a cam table goes from row to row."""

    LINEAR = 0, "linear", "Straight, at one gear ratio"
    TRAPEZOID = 1, "trapezoid", "At rest in every row: ramp up, plateau, ramp down"


class BenchThread(MapEnum):
    """Threads of the firmware that the bench can hang, or break."""

    NONE = 0, "none", "None"
    SUPERVISOR = 1, "supervisor", "Supervisor"
    LIMITS = 2, "limits", "Limits thread"
    MODBUS = 3, "modbus", "Modbus thread"
    STORAGE = 4, "storage", "Storage work queue"
    FAULT = 5, "fault", "Modbus thread, by a fault of the processor"


class BenchRestart(MapEnum):
    """What the simulated machine saw when the watchdog restarted the controller."""

    NONE = 0, "none", "The last restart was not by the watchdog"
    WITHOUT_CURRENT = 1, "without_current", "The stepper had no current any more"
    WITH_CURRENT = 2, "with_current", "The stepper still had current"


class BenchCommand(MapEnum):
    """Commands of the simulated plant."""

    NONE = 0, "none", "Nothing"
    PROFILE_CLEAR = 1, "profile_clear", "Forget the drum speed profile"
    PROFILE_APPEND = (
        2,
        "profile_append",
        "Append the first bench_argument points of the window bench_profile",
    )
    PROFILE_START = 3, "profile_start", "Play the profile from its beginning"
    POWER_CUT = 4, "power_cut", "Restart the controller; the plant goes on"
    RESTART = (
        10,
        "restart",
        "The same, but what its memory keeps over a restart by the watchdog is kept",
    )
    SLIP = 5, "slip", "Move the carriage by bench_argument microsteps against the stepper"
    LOSE_PULSES = 6, "lose_pulses", "Swallow the next bench_argument encoder pulses"
    DITHER = 7, "dither", "Rock the encoder bench_argument times about the present edge"
    ILLEGAL_TRANSITIONS = (
        8,
        "illegal_transitions",
        "Change both encoder channels at once bench_argument times",
    )
    PLACE_CARRIAGE = (
        9,
        "place_carriage",
        "Put the carriage at bench_argument micrometres by hand (stepper off)",
    )


class ChannelFault(MapEnum):
    """Faults of a simulated encoder channel."""

    NONE = 0, "none", "Works"
    STUCK_LOW = 1, "stuck_low", "Always low"
    STUCK_HIGH = 2, "stuck_high", "Always high"
    FLICKER = (
        3,
        "flicker",
        "A loose wire: low for a millisecond or two, then right for as long, at random",
    )


class SwitchFault(MapEnum):
    """Faults of a simulated limit switch."""

    NONE = 0, "none", "Works"
    STUCK_RELEASED = 1, "stuck_released", "Never actuates"
    STUCK_ACTUATED = 2, "stuck_actuated", "Always actuated"
    NO_WIRE_BROKEN = 3, "no_wire_broken", "NO contact never seen closed"
    NC_WIRE_BROKEN = 4, "nc_wire_broken", "NC contact never seen closed"
    SHORTED = 5, "shorted", "Both contacts seen closed"


class TriggerFault(MapEnum):
    """Faults that an armed position can release."""

    NONE = 0, "none", "Not armed"
    STALL = 1, "stall", "Hold the carriage for bench_trigger_argument milliseconds"
    SLIP = 2, "slip", "Move the carriage by bench_trigger_argument microsteps"
    LOSE_PULSES = 3, "lose_pulses", "Swallow bench_trigger_argument encoder pulses"


class Flag(MapEnum):
    """Discrete inputs; bit n of the point flags is n, of flags_2 32 + n."""

    INDEXED = 0, "indexed", "The position is known"
    TRACKING = 1, "tracking", "The carriage follows the drum"
    LAUNCH_PERMIT = 2, "launch_permit", "A launch may begin; see launch_inhibit if not"
    MOVING = 3, "moving", "The carriage moves by itself (indexing, centring, jogging)"
    DRUM_AT_REST = 4, "drum_at_rest", "The drum is slower than rest_edges_per_s for rest_time_ms"
    FAULTED = 5, "faulted", "Stopped by a fault"
    LOS = (
        6,
        "los",
        "Any loss of synchronization since the last indexing, also before a power cut: the rope may be laid wrong",
    )
    LOS1_PLUS = (
        7,
        "los1_plus",
        "LOS type 1+: reversal at plus entered, its switch did not trigger on the way",
    )
    LOS1_MINUS = (
        8,
        "los1_minus",
        "LOS type 1-: reversal at minus entered, its switch did not trigger on the way",
    )
    LOS2_PLUS = (
        9,
        "los2_plus",
        "LOS type 2+: plus switch triggered outside its tolerance, or memory had changed the law",
    )
    LOS2_MINUS = (
        10,
        "los2_minus",
        "LOS type 2-: minus switch triggered outside its tolerance, or memory had changed the law",
    )
    SWITCH_PLUS = 11, "switch_plus", "Plus limit switch actuated (debounced)"
    SWITCH_MINUS = 12, "switch_minus", "Minus limit switch actuated (debounced)"
    WIRING_PLUS = 13, "wiring_plus", "Plus limit switch wiring fault"
    WIRING_MINUS = 14, "wiring_minus", "Minus limit switch wiring fault"
    OVERTRAVEL_PLUS = 15, "overtravel_plus", "Plus overtravel switch actuated"
    OVERTRAVEL_MINUS = 16, "overtravel_minus", "Minus overtravel switch actuated"
    OVERSPEED_WARNING = (
        17,
        "overspeed_warning",
        "The drum is faster than overspeed_warning_edges_per_s",
    )
    OVERSPEED_TRIP = (
        18,
        "overspeed_trip",
        "The drum was faster than overspeed_trip_edges_per_s (sticky until clear_fault)",
    )
    MASTER_LOST = 19, "master_lost", "No valid request for master_timeout_ms"
    STAGED = 20, "staged", "Staged parameters differ from the active ones: APPLY or REVERT"
    DIRTY = 21, "dirty", "Active parameters differ from the stored ones: SAVE to keep them"
    DEFAULTS_LOADED = (
        22,
        "defaults_loaded",
        "No usable stored set was found at power-up: it began with the factory values, and nothing is stored until a SAVE",
    )
    TRIM_PENDING = 23, "trim_pending", "A trim waits for the carriage to be in the sweep"
    CORRECTION_PENDING = (
        24,
        "correction_pending",
        "A re-index correction waits for the end of the reversal",
    )
    STEPPER_ENABLED = 25, "stepper_enabled", "The stepper has current"
    RESTART_NEEDED = (
        26,
        "restart_needed",
        "The active line settings differ from those in use: SAVE and restart",
    )
    HELD = 27, "held", "Stopped by command: write the mode, or index, to go on"
    LOCKED = 28, "locked", "The write lock is closed: parameters cannot be changed"
    LINE_TRIAL = (
        29,
        "line_trial",
        "Line settings are on trial: any valid request to this unit confirms them",
    )
    WATCHDOG_RESET = (
        30,
        "watchdog_reset",
        "The last restart was made by the watchdog, or after a fault of the processor: a part of the firmware had stopped",
    )
    CAM_QUEUED = 31, "cam_queued", "A cam table waits for the end of the cycle"
    SET_UNCONFIRMED = (
        32,
        "set_unconfirmed",
        "Real hardware with factory values that nobody has saved: they describe another winch",
    )
    ROPE_LAID_STANDING = (
        33,
        "rope_laid_standing",
        "Rope was laid while the carriage stood, also before a power cut: look at it, index, then acknowledge_rope",
    )
    ODOMETER_DOUBTFUL = (
        34,
        "odometer_doubtful",
        "The drum turned while the storage was written, so edges may be missing in rope_mm and net_edges (until an indexing)",
    )
    SWITCH_IMPLAUSIBLE = (
        35,
        "switch_implausible",
        "A limit switch says what the known position makes impossible: broken wire, stuck or moved switch",
    )
    ENCODER_DOUBTFUL = (
        36,
        "encoder_doubtful",
        "One encoder channel changes without the other: the drum may turn unseen. Not sticky",
    )
    ENCODER_FAULT = (
        37,
        "encoder_fault",
        "The encoder does not tell the drum's motion: a loss of synchronization, sticky until an indexing has succeeded",
    )
    CLOCK_FALLBACK = (
        38,
        "clock_fallback",
        "The external clock of the processor is missing: it runs by its internal oscillator, which may be a few percent off",
    )
    LINE_BABBLE = (
        39,
        "line_babble",
        "Within the last 10 s bytes came on the line without a silence for more than a second",
    )
    LINE_ECHO = (
        40,
        "line_echo",
        "Within the last 10 s the line gave back what was sent on it; that was dropped",
    )
    ROPE_DOUBTFUL = (
        41,
        "rope_doubtful",
        "The metres of rope on the drum may be wrong: not told since the power-up, or edges were lost. Give set_rope where they are known",
    )
    RESUME_DOUBTFUL = (
        42,
        "resume_doubtful",
        "The drum may have turned since it was kept where the rope goes on, or the carriage stood elsewhere: not gone to. Look where the rope leaves the drum",
    )
    REACQUIRED = (
        43,
        "reacquired",
        "After a restart in a launch a turning drum was taken up at an unknown place: a loss of synchronization, until an indexing has succeeded",
    )
    NOT_ACCEPTED = (
        44,
        "not_accepted",
        "Nobody has accepted the parameter set that is active (levelwind commission). No launch is refused for it",
    )


class LaunchInhibit(MapEnum):
    """Bit numbers of the point launch_inhibit."""

    NOT_TRACKING = (
        0,
        "not_tracking",
        "The carriage does not follow the drum: the state says what to do",
    )
    LOS = 1, "los", "Synchronization was lost: look at the rope first, then index"
    FAULT = 2, "fault", "A fault stands: remove its cause, then index"
    WIRING = 3, "wiring", "A limit switch has a wiring fault: mend it, then clear_fault"
    OVERTRAVEL = (
        4,
        "overtravel",
        "An overtravel switch is actuated: index moves the carriage off it, or check the switch and its wire",
    )
    OVERSPEED = 5, "overspeed", "The drum tripped the overspeed limit: stop it, then index"
    MASTER_LOST = (
        6,
        "master_lost",
        "The Modbus master is silent: check the panel or PLC and its line",
    )
    CORRECTION = (
        7,
        "correction",
        "A re-index correction waits for the sweep: turn the drum slowly until it is made, or index",
    )
    STEPPER_ALARM = (
        8,
        "stepper_alarm",
        "The stepper driver reports an alarm: look at the driver, then index",
    )
    CAM = (
        9,
        "cam",
        "The motion profile is cam and its table cannot be followed, see cam_reason: upload another, or set motion_profile to screw",
    )
    SET_UNCONFIRMED = (
        10,
        "set_unconfirmed",
        "The factory values are in force, which describe another winch: set the parameters of this one, apply and save",
    )
    ROPE_LAID_STANDING = (
        11,
        "rope_laid_standing",
        "Rope was laid while the carriage stood: look at the rope, index, then acknowledge_rope",
    )
    SWITCH_IMPLAUSIBLE = (
        12,
        "switch_implausible",
        "A limit switch says what the known position makes impossible: look at both switches and their wires, then index",
    )
    ENCODER = (
        13,
        "encoder",
        "The encoder's signals do not fit the drum, or did not since the last indexing: rest the drum, check the encoder and its wires, look at the rope, then index",
    )


# What names the detail of an event; the details of the others are plain numbers.
DETAIL_ENUMS: dict[MapEnum, type[MapEnum]] = {
    Event.MODE_CHANGED: Mode,
    Event.INDEX_FAILED: Fault,
    Event.TRACKING_ENDED: State,
    Event.FAULT_SET: Fault,
    Event.FAULT_CLEARED: Fault,
    Event.SWITCH_IMPLAUSIBLE: Side,
    Event.ENCODER_FAULT: EncoderFault,
    Event.APPLY_REFUSED: Reason,
    Event.FACTORY_STAGED: Command,
    Event.TRIM_REFUSED: Reason,
}


@dataclass(frozen=True)
class Point:
    """One value, array of values, or bit. Registers carry the high word first."""

    name: str
    address: int
    space: Space
    type: PointType
    text: str
    block: str
    words: int = 1  # registers of one element
    count: int = 1  # elements
    min: int | None = None  # what a write may carry; None where nothing can be written
    max: int | None = None
    allowed: tuple[int, ...] = ()  # the only values that a write may carry, if not empty
    default: int | None = None
    unit: str = ""
    scope: Literal["", "motion", "line"] = ""
    writable: bool = False
    command: bool = False  # writing a value other than 0 runs a command
    reindex: bool = False  # a change makes the index invalid
    secret: bool = False  # reads max if it is not 0; writing max keeps it
    enum: "builtins.type[MapEnum] | None" = None  # names of the values
    bits: "builtins.type[MapEnum] | None" = None  # names of the bits, by bit number
    bits_from: int = 0  # which of them bit 0 is
    mirrors: dict[str, int] = field(default_factory=dict)  # input register addresses by copy


MAP_VERSION = 1
SELF_TEST = 0x12345678
VENDOR = "levelwind"
PRODUCT_CODE = "LW1"
PRODUCT_NAME = "level wind controller"
PRODUCT_URL = "https://github.com/levelwind/levelwind"
PRODUCT_VERSION = "0.1.0"

# Every point of the map by its name, in the order of the map.
POINTS: dict[str, Point] = {
    point.name: point
    for point in (
        Point(
            name="index",
            address=0,
            space="coil",
            type="bit",
            text="Find the position (homing)",
            block="coils",
            min=0,
            max=1,
            default=0,
            writable=True,
            command=True,
        ),
        Point(
            name="stop",
            address=1,
            space="coil",
            type="bit",
            text="Stop every motion now",
            block="coils",
            min=0,
            max=1,
            default=0,
            writable=True,
            command=True,
        ),
        Point(
            name="clear_fault",
            address=2,
            space="coil",
            type="bit",
            text="Acknowledge a fault",
            block="coils",
            min=0,
            max=1,
            default=0,
            writable=True,
            command=True,
        ),
        Point(
            name="apply",
            address=3,
            space="coil",
            type="bit",
            text="Make the staged parameters active",
            block="coils",
            min=0,
            max=1,
            default=0,
            writable=True,
            command=True,
        ),
        Point(
            name="revert",
            address=4,
            space="coil",
            type="bit",
            text="Drop the staged parameters",
            block="coils",
            min=0,
            max=1,
            default=0,
            writable=True,
            command=True,
        ),
        Point(
            name="save",
            address=5,
            space="coil",
            type="bit",
            text="Save the active parameters",
            block="coils",
            min=0,
            max=1,
            default=0,
            writable=True,
            command=True,
        ),
        Point(
            name="jog_plus",
            address=6,
            space="coil",
            type="bit",
            text="Jog toward plus while held: write again within jog_hold_ms",
            block="coils",
            min=0,
            max=1,
            default=0,
            writable=True,
        ),
        Point(
            name="jog_minus",
            address=7,
            space="coil",
            type="bit",
            text="Jog toward minus while held: write again within jog_hold_ms",
            block="coils",
            min=0,
            max=1,
            default=0,
            writable=True,
        ),
        Point(
            name="acknowledge_rope",
            address=8,
            space="coil",
            type="bit",
            text="Rope laid while the carriage stood has been looked at",
            block="coils",
            min=0,
            max=1,
            default=0,
            writable=True,
            command=True,
        ),
        Point(
            name="set_rope",
            address=9,
            space="coil",
            type="bit",
            text="So much rope is on the drum: set_rope_mm",
            block="coils",
            min=0,
            max=1,
            default=0,
            writable=True,
            command=True,
        ),
        Point(
            name="trim_early",
            address=10,
            space="coil",
            type="bit",
            text="Reverse earlier where the carriage moves to",
            block="coils",
            min=0,
            max=1,
            default=0,
            writable=True,
            command=True,
        ),
        Point(
            name="trim_late",
            address=11,
            space="coil",
            type="bit",
            text="Reverse later where the carriage moves to",
            block="coils",
            min=0,
            max=1,
            default=0,
            writable=True,
            command=True,
        ),
        Point(
            name="reacquire",
            address=12,
            space="coil",
            type="bit",
            text="Take up a turning drum after a restart in a launch",
            block="coils",
            min=0,
            max=1,
            default=0,
            writable=True,
            command=True,
        ),
        Point(
            name="indexed",
            address=0,
            space="discrete",
            type="bit",
            text="The position is known",
            block="discretes",
        ),
        Point(
            name="tracking",
            address=1,
            space="discrete",
            type="bit",
            text="The carriage follows the drum",
            block="discretes",
        ),
        Point(
            name="launch_permit",
            address=2,
            space="discrete",
            type="bit",
            text="A launch may begin; see launch_inhibit if not",
            block="discretes",
        ),
        Point(
            name="moving",
            address=3,
            space="discrete",
            type="bit",
            text="The carriage moves by itself (indexing, centring, jogging)",
            block="discretes",
        ),
        Point(
            name="drum_at_rest",
            address=4,
            space="discrete",
            type="bit",
            text="The drum is slower than rest_edges_per_s for rest_time_ms",
            block="discretes",
        ),
        Point(
            name="faulted",
            address=5,
            space="discrete",
            type="bit",
            text="Stopped by a fault",
            block="discretes",
        ),
        Point(
            name="los",
            address=6,
            space="discrete",
            type="bit",
            text="Any loss of synchronization since the last indexing, also before a power cut: the rope may be laid wrong",
            block="discretes",
        ),
        Point(
            name="los1_plus",
            address=7,
            space="discrete",
            type="bit",
            text="LOS type 1+: reversal at plus entered, its switch did not trigger on the way",
            block="discretes",
        ),
        Point(
            name="los1_minus",
            address=8,
            space="discrete",
            type="bit",
            text="LOS type 1-: reversal at minus entered, its switch did not trigger on the way",
            block="discretes",
        ),
        Point(
            name="los2_plus",
            address=9,
            space="discrete",
            type="bit",
            text="LOS type 2+: plus switch triggered outside its tolerance, or memory had changed the law",
            block="discretes",
        ),
        Point(
            name="los2_minus",
            address=10,
            space="discrete",
            type="bit",
            text="LOS type 2-: minus switch triggered outside its tolerance, or memory had changed the law",
            block="discretes",
        ),
        Point(
            name="switch_plus",
            address=11,
            space="discrete",
            type="bit",
            text="Plus limit switch actuated (debounced)",
            block="discretes",
        ),
        Point(
            name="switch_minus",
            address=12,
            space="discrete",
            type="bit",
            text="Minus limit switch actuated (debounced)",
            block="discretes",
        ),
        Point(
            name="wiring_plus",
            address=13,
            space="discrete",
            type="bit",
            text="Plus limit switch wiring fault",
            block="discretes",
        ),
        Point(
            name="wiring_minus",
            address=14,
            space="discrete",
            type="bit",
            text="Minus limit switch wiring fault",
            block="discretes",
        ),
        Point(
            name="overtravel_plus",
            address=15,
            space="discrete",
            type="bit",
            text="Plus overtravel switch actuated",
            block="discretes",
        ),
        Point(
            name="overtravel_minus",
            address=16,
            space="discrete",
            type="bit",
            text="Minus overtravel switch actuated",
            block="discretes",
        ),
        Point(
            name="overspeed_warning",
            address=17,
            space="discrete",
            type="bit",
            text="The drum is faster than overspeed_warning_edges_per_s",
            block="discretes",
        ),
        Point(
            name="overspeed_trip",
            address=18,
            space="discrete",
            type="bit",
            text="The drum was faster than overspeed_trip_edges_per_s (sticky until clear_fault)",
            block="discretes",
        ),
        Point(
            name="master_lost",
            address=19,
            space="discrete",
            type="bit",
            text="No valid request for master_timeout_ms",
            block="discretes",
        ),
        Point(
            name="staged",
            address=20,
            space="discrete",
            type="bit",
            text="Staged parameters differ from the active ones: APPLY or REVERT",
            block="discretes",
        ),
        Point(
            name="dirty",
            address=21,
            space="discrete",
            type="bit",
            text="Active parameters differ from the stored ones: SAVE to keep them",
            block="discretes",
        ),
        Point(
            name="defaults_loaded",
            address=22,
            space="discrete",
            type="bit",
            text="No usable stored set was found at power-up: it began with the factory values, and nothing is stored until a SAVE",
            block="discretes",
        ),
        Point(
            name="trim_pending",
            address=23,
            space="discrete",
            type="bit",
            text="A trim waits for the carriage to be in the sweep",
            block="discretes",
        ),
        Point(
            name="correction_pending",
            address=24,
            space="discrete",
            type="bit",
            text="A re-index correction waits for the end of the reversal",
            block="discretes",
        ),
        Point(
            name="stepper_enabled",
            address=25,
            space="discrete",
            type="bit",
            text="The stepper has current",
            block="discretes",
        ),
        Point(
            name="restart_needed",
            address=26,
            space="discrete",
            type="bit",
            text="The active line settings differ from those in use: SAVE and restart",
            block="discretes",
        ),
        Point(
            name="held",
            address=27,
            space="discrete",
            type="bit",
            text="Stopped by command: write the mode, or index, to go on",
            block="discretes",
        ),
        Point(
            name="locked",
            address=28,
            space="discrete",
            type="bit",
            text="The write lock is closed: parameters cannot be changed",
            block="discretes",
        ),
        Point(
            name="line_trial",
            address=29,
            space="discrete",
            type="bit",
            text="Line settings are on trial: any valid request to this unit confirms them",
            block="discretes",
        ),
        Point(
            name="watchdog_reset",
            address=30,
            space="discrete",
            type="bit",
            text="The last restart was made by the watchdog, or after a fault of the processor: a part of the firmware had stopped",
            block="discretes",
        ),
        Point(
            name="cam_queued",
            address=31,
            space="discrete",
            type="bit",
            text="A cam table waits for the end of the cycle",
            block="discretes",
        ),
        Point(
            name="set_unconfirmed",
            address=32,
            space="discrete",
            type="bit",
            text="Real hardware with factory values that nobody has saved: they describe another winch",
            block="discretes",
        ),
        Point(
            name="rope_laid_standing",
            address=33,
            space="discrete",
            type="bit",
            text="Rope was laid while the carriage stood, also before a power cut: look at it, index, then acknowledge_rope",
            block="discretes",
        ),
        Point(
            name="odometer_doubtful",
            address=34,
            space="discrete",
            type="bit",
            text="The drum turned while the storage was written, so edges may be missing in rope_mm and net_edges (until an indexing)",
            block="discretes",
        ),
        Point(
            name="switch_implausible",
            address=35,
            space="discrete",
            type="bit",
            text="A limit switch says what the known position makes impossible: broken wire, stuck or moved switch",
            block="discretes",
        ),
        Point(
            name="encoder_doubtful",
            address=36,
            space="discrete",
            type="bit",
            text="One encoder channel changes without the other: the drum may turn unseen. Not sticky",
            block="discretes",
        ),
        Point(
            name="encoder_fault",
            address=37,
            space="discrete",
            type="bit",
            text="The encoder does not tell the drum's motion: a loss of synchronization, sticky until an indexing has succeeded",
            block="discretes",
        ),
        Point(
            name="clock_fallback",
            address=38,
            space="discrete",
            type="bit",
            text="The external clock of the processor is missing: it runs by its internal oscillator, which may be a few percent off",
            block="discretes",
        ),
        Point(
            name="line_babble",
            address=39,
            space="discrete",
            type="bit",
            text="Within the last 10 s bytes came on the line without a silence for more than a second",
            block="discretes",
        ),
        Point(
            name="line_echo",
            address=40,
            space="discrete",
            type="bit",
            text="Within the last 10 s the line gave back what was sent on it; that was dropped",
            block="discretes",
        ),
        Point(
            name="rope_doubtful",
            address=41,
            space="discrete",
            type="bit",
            text="The metres of rope on the drum may be wrong: not told since the power-up, or edges were lost. Give set_rope where they are known",
            block="discretes",
        ),
        Point(
            name="resume_doubtful",
            address=42,
            space="discrete",
            type="bit",
            text="The drum may have turned since it was kept where the rope goes on, or the carriage stood elsewhere: not gone to. Look where the rope leaves the drum",
            block="discretes",
        ),
        Point(
            name="reacquired",
            address=43,
            space="discrete",
            type="bit",
            text="After a restart in a launch a turning drum was taken up at an unknown place: a loss of synchronization, until an indexing has succeeded",
            block="discretes",
        ),
        Point(
            name="not_accepted",
            address=44,
            space="discrete",
            type="bit",
            text="Nobody has accepted the parameter set that is active (levelwind commission). No launch is refused for it",
            block="discretes",
        ),
        Point(
            name="command",
            address=0,
            space="holding",
            type="u16",
            text="Writing a code runs the command; reads the last one",
            block="setpoints",
            min=0,
            max=32,
            allowed=(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 30, 31, 32),
            default=0,
            writable=True,
            command=True,
            enum=Command,
        ),
        Point(
            name="mode",
            address=1,
            space="holding",
            type="u16",
            text="Requested mode, taken over when the drum is at rest (off: at once)",
            block="setpoints",
            min=0,
            max=2,
            default=1,
            writable=True,
            enum=Mode,
        ),
        Point(
            name="jog",
            address=2,
            space="holding",
            type="i16",
            text="Held jog: -1, 0 or +1; write again within jog_hold_ms or it stops",
            block="setpoints",
            min=-1,
            max=1,
            default=0,
            writable=True,
        ),
        Point(
            name="trim_plus_um",
            address=3,
            space="holding",
            type="i16",
            text="Live shift of reversal_plus, applied in the sweep only",
            block="setpoints",
            min=-20000,
            max=20000,
            default=0,
            unit="um",
            writable=True,
        ),
        Point(
            name="trim_minus_um",
            address=4,
            space="holding",
            type="i16",
            text="Live shift of reversal_minus, applied in the sweep only",
            block="setpoints",
            min=-20000,
            max=20000,
            default=0,
            unit="um",
            writable=True,
        ),
        Point(
            name="drum_running",
            address=5,
            space="holding",
            type="u16",
            text="1: the master says that the winch turns the drum; see drum_watch_ms",
            block="setpoints",
            min=0,
            max=1,
            default=0,
            writable=True,
        ),
        Point(
            name="set_rope_mm",
            address=6,
            space="holding",
            type="i32",
            text="What the command set_rope tells: so much rope is on the drum; -1: nothing was written",
            block="setpoints",
            words=2,
            min=-1,
            max=10000000,
            default=-1,
            unit="mm",
            writable=True,
        ),
        Point(
            name="unlock",
            address=10,
            space="holding",
            type="u32",
            text="Writing lock_code opens the write lock for lock_timeout_s, writing 0 closes it; reads 0",
            block="setpoints",
            words=2,
            min=0,
            max=999999,
            default=0,
            writable=True,
        ),
        Point(
            name="cam_phase_edges",
            address=630,
            space="holding",
            type="i32",
            text="Live shift of the cam's master, one edge per edge until it is reached",
            block="setpoints",
            words=2,
            min=-100000000,
            max=100000000,
            default=0,
            unit="edges",
            writable=True,
        ),
        Point(
            name="encoder_pulses_per_rev",
            address=100,
            space="holding",
            type="u16",
            text="Encoder pulses per revolution of its shaft",
            block="parameters",
            min=1,
            max=10000,
            default=360,
            unit="pulses",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1100, "stored": 2100},
        ),
        Point(
            name="encoder_edges_per_pulse",
            address=101,
            space="holding",
            type="u16",
            text="Edges used per pulse",
            block="parameters",
            min=1,
            max=4,
            allowed=(1, 2, 4),
            default=2,
            unit="edges",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1101, "stored": 2101},
        ),
        Point(
            name="encoder_ratio_numerator",
            address=102,
            space="holding",
            type="u16",
            text="Encoder revolutions per drum revolution, numerator",
            block="parameters",
            min=1,
            max=100,
            default=4,
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1102, "stored": 2102},
        ),
        Point(
            name="encoder_ratio_denominator",
            address=103,
            space="holding",
            type="u16",
            text="Encoder revolutions per drum revolution, denominator",
            block="parameters",
            min=1,
            max=1000,
            default=1,
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1103, "stored": 2103},
        ),
        Point(
            name="encoder_invert_a",
            address=104,
            space="holding",
            type="u16",
            text="1 inverts encoder channel A",
            block="parameters",
            min=0,
            max=1,
            default=0,
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1104, "stored": 2104},
        ),
        Point(
            name="encoder_invert_b",
            address=105,
            space="holding",
            type="u16",
            text="1 inverts encoder channel B",
            block="parameters",
            min=0,
            max=1,
            default=0,
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1105, "stored": 2105},
        ),
        Point(
            name="drum_direction_invert",
            address=106,
            space="holding",
            type="u16",
            text="1 swaps the sign of drum motion; hauling rope in must count positive",
            block="parameters",
            min=0,
            max=1,
            default=0,
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1106, "stored": 2106},
        ),
        Point(
            name="rope_per_drum_rev_um",
            address=107,
            space="holding",
            type="u32",
            text="Rope hauled in per drum revolution, for the odometer",
            block="parameters",
            words=2,
            min=1000,
            max=20000000,
            default=2400000,
            unit="um",
            scope="motion",
            writable=True,
            mirrors={"active": 1107, "stored": 2107},
        ),
        Point(
            name="screw_lead_um",
            address=110,
            space="holding",
            type="u32",
            text="Carriage travel per screw revolution",
            block="parameters",
            words=2,
            min=500,
            max=100000,
            default=20000,
            unit="um",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1110, "stored": 2110},
        ),
        Point(
            name="microsteps_per_rev",
            address=112,
            space="holding",
            type="u16",
            text="Microsteps per stepper revolution, as set at the stepper driver",
            block="parameters",
            min=200,
            max=51200,
            default=2000,
            unit="usteps",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1112, "stored": 2112},
        ),
        Point(
            name="carriage_direction_invert",
            address=113,
            space="holding",
            type="u16",
            text="1 inverts the stepper's direction output",
            block="parameters",
            min=0,
            max=1,
            default=0,
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1113, "stored": 2113},
        ),
        Point(
            name="pitch_um",
            address=114,
            space="holding",
            type="u32",
            text="Carriage travel per drum revolution",
            block="parameters",
            words=2,
            min=10,
            max=100000,
            default=12000,
            unit="um",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1114, "stored": 2114},
        ),
        Point(
            name="overshoot_um",
            address=116,
            space="holding",
            type="u32",
            text="How far a reversal runs past the reversal point",
            block="parameters",
            words=2,
            min=1,
            max=50000,
            default=2500,
            unit="um",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1116, "stored": 2116},
        ),
        Point(
            name="slope_tolerance_ppm",
            address=118,
            space="holding",
            type="u16",
            text="How far the pitch may be off to meet the overshoot",
            block="parameters",
            min=1,
            max=50000,
            default=500,
            unit="ppm",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1118, "stored": 2118},
        ),
        Point(
            name="reversal_plus_um",
            address=120,
            space="holding",
            type="i32",
            text="Where the reversal at the plus side begins",
            block="parameters",
            words=2,
            min=-500000,
            max=500000,
            default=80000,
            unit="um",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1120, "stored": 2120},
        ),
        Point(
            name="reversal_minus_um",
            address=122,
            space="holding",
            type="i32",
            text="Where the reversal at the minus side begins",
            block="parameters",
            words=2,
            min=-500000,
            max=500000,
            default=-80000,
            unit="um",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1122, "stored": 2122},
        ),
        Point(
            name="flange_plus_um",
            address=124,
            space="holding",
            type="i32",
            text="Farthest place on the plus side that the carriage may be commanded to",
            block="parameters",
            words=2,
            min=-500000,
            max=500000,
            default=83000,
            unit="um",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1124, "stored": 2124},
        ),
        Point(
            name="flange_minus_um",
            address=126,
            space="holding",
            type="i32",
            text="Farthest place on the minus side that the carriage may be commanded to",
            block="parameters",
            words=2,
            min=-500000,
            max=500000,
            default=-83000,
            unit="um",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1126, "stored": 2126},
        ),
        Point(
            name="switch_plus_um",
            address=128,
            space="holding",
            type="i32",
            text="Calibrated trigger position of the plus limit switch",
            block="parameters",
            words=2,
            min=-500000,
            max=500000,
            default=78400,
            unit="um",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1128, "stored": 2128},
        ),
        Point(
            name="switch_minus_um",
            address=130,
            space="holding",
            type="i32",
            text="Calibrated trigger position of the minus limit switch",
            block="parameters",
            words=2,
            min=-500000,
            max=500000,
            default=-78400,
            unit="um",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1130, "stored": 2130},
        ),
        Point(
            name="switch_tolerance_um",
            address=132,
            space="holding",
            type="u16",
            text="A trigger further than this from its calibrated position is a LOS of type 2",
            block="parameters",
            min=10,
            max=20000,
            default=1000,
            unit="um",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1132, "stored": 2132},
        ),
        Point(
            name="switch_hysteresis_um",
            address=133,
            space="holding",
            type="u16",
            text="Within this distance inward of its trigger point a switch has surely released",
            block="parameters",
            min=10,
            max=20000,
            default=1500,
            unit="um",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1133, "stored": 2133},
        ),
        Point(
            name="switch_contacts",
            address=134,
            space="holding",
            type="u16",
            text="How the limit switches are wired",
            block="parameters",
            min=0,
            max=2,
            default=0,
            scope="motion",
            writable=True,
            reindex=True,
            enum=SwitchContacts,
            mirrors={"active": 1134, "stored": 2134},
        ),
        Point(
            name="switch_transit_ms",
            address=135,
            space="holding",
            type="u16",
            text="Both contacts of a pair open, or a single contact not at rest, for longer than this is a wiring fault",
            block="parameters",
            min=1,
            max=90,
            default=20,
            unit="ms",
            scope="motion",
            writable=True,
            mirrors={"active": 1135, "stored": 2135},
        ),
        Point(
            name="switch_debounce_ms",
            address=136,
            space="holding",
            type="u16",
            text="Debounce time of a single contact",
            block="parameters",
            min=1,
            max=100,
            default=5,
            unit="ms",
            scope="motion",
            writable=True,
            mirrors={"active": 1136, "stored": 2136},
        ),
        Point(
            name="travel_um",
            address=137,
            space="holding",
            type="u32",
            text="Carriage travel between the mechanical end stops",
            block="parameters",
            words=2,
            min=1000,
            max=600000,
            default=180000,
            unit="um",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1137, "stored": 2137},
        ),
        Point(
            name="switch_delay_us",
            address=139,
            space="holding",
            type="u16",
            text="How late a limit switch tells that it was reached; `levelwind index --rates` measures it (0: at once)",
            block="parameters",
            min=0,
            max=20000,
            default=0,
            unit="us",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1139, "stored": 2139},
        ),
        Point(
            name="index_switch",
            address=140,
            space="holding",
            type="u16",
            text="Which limit switch is the indexing switch",
            block="parameters",
            min=0,
            max=1,
            default=0,
            scope="motion",
            writable=True,
            reindex=True,
            enum=Side,
            mirrors={"active": 1140, "stored": 2140},
        ),
        Point(
            name="index_rate_edges_per_s",
            address=141,
            space="holding",
            type="u16",
            text="Rate of the simulated edges for indexing and centring",
            block="parameters",
            min=100,
            max=50000,
            default=10000,
            unit="edges/s",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1141, "stored": 2141},
        ),
        Point(
            name="park_at",
            address=142,
            space="holding",
            type="u16",
            text="Where indexing ends",
            block="parameters",
            min=0,
            max=1,
            default=0,
            scope="motion",
            writable=True,
            reindex=True,
            enum=ParkAt,
            mirrors={"active": 1142, "stored": 2142},
        ),
        Point(
            name="park_position_um",
            address=143,
            space="holding",
            type="i32",
            text="Parking place if park_at is position",
            block="parameters",
            words=2,
            min=-500000,
            max=500000,
            default=0,
            unit="um",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1143, "stored": 2143},
        ),
        Point(
            name="span_tolerance_um",
            address=145,
            space="holding",
            type="u16",
            text="Indexing: how far the other switch may be from its calibrated position",
            block="parameters",
            min=10,
            max=20000,
            default=1000,
            unit="um",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1145, "stored": 2145},
        ),
        Point(
            name="handover_direction",
            address=146,
            space="holding",
            type="u16",
            text="Carriage direction on hand-over from a parking position or the centre, drum hauling in",
            block="parameters",
            min=0,
            max=1,
            default=0,
            scope="motion",
            writable=True,
            enum=Side,
            mirrors={"active": 1146, "stored": 2146},
        ),
        Point(
            name="rest_edges_per_s",
            address=147,
            space="holding",
            type="u16",
            text="The drum counts as at rest below this rate",
            block="parameters",
            min=1,
            max=5000,
            default=50,
            unit="edges/s",
            scope="motion",
            writable=True,
            mirrors={"active": 1147, "stored": 2147},
        ),
        Point(
            name="rest_time_ms",
            address=148,
            space="holding",
            type="u16",
            text="The drum counts as at rest after this time below rest_edges_per_s",
            block="parameters",
            min=10,
            max=10000,
            default=200,
            unit="ms",
            scope="motion",
            writable=True,
            mirrors={"active": 1148, "stored": 2148},
        ),
        Point(
            name="centre_position_um",
            address=149,
            space="holding",
            type="i32",
            text="Where mode centre holds the carriage",
            block="parameters",
            words=2,
            min=-500000,
            max=500000,
            default=0,
            unit="um",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1149, "stored": 2149},
        ),
        Point(
            name="jog_rate_edges_per_s",
            address=151,
            space="holding",
            type="u16",
            text="Rate of the simulated edges for jogging",
            block="parameters",
            min=100,
            max=50000,
            default=5000,
            unit="edges/s",
            scope="motion",
            writable=True,
            mirrors={"active": 1151, "stored": 2151},
        ),
        Point(
            name="jog_hold_ms",
            address=152,
            space="holding",
            type="u16",
            text="A jog stops when it is not written again within this time",
            block="parameters",
            min=50,
            max=5000,
            default=500,
            unit="ms",
            scope="motion",
            writable=True,
            mirrors={"active": 1152, "stored": 2152},
        ),
        Point(
            name="los_recoveries_max",
            address=160,
            space="holding",
            type="u16",
            text="Stop after more LOS recoveries than this in one launch (0: never stop)",
            block="parameters",
            min=0,
            max=1000,
            default=3,
            scope="motion",
            writable=True,
            mirrors={"active": 1160, "stored": 2160},
        ),
        Point(
            name="overspeed_warning_edges_per_s",
            address=161,
            space="holding",
            type="u32",
            text="Drum speed that sets the flag overspeed_warning",
            block="parameters",
            words=2,
            min=100,
            max=1000000,
            default=52000,
            unit="edges/s",
            scope="motion",
            writable=True,
            mirrors={"active": 1161, "stored": 2161},
        ),
        Point(
            name="overspeed_trip_edges_per_s",
            address=163,
            space="holding",
            type="u32",
            text="Drum speed that stops the controller",
            block="parameters",
            words=2,
            min=100,
            max=1000000,
            default=60000,
            unit="edges/s",
            scope="motion",
            writable=True,
            mirrors={"active": 1163, "stored": 2163},
        ),
        Point(
            name="master_timeout_ms",
            address=165,
            space="holding",
            type="u16",
            text="Without a valid request for this long the launch permit drops (0: not watched)",
            block="parameters",
            min=0,
            max=60000,
            default=0,
            unit="ms",
            scope="motion",
            writable=True,
            mirrors={"active": 1165, "stored": 2165},
        ),
        Point(
            name="dwell_plus_millirev",
            address=166,
            space="holding",
            type="u16",
            text="Dwell at the far point of the plus reversal",
            block="parameters",
            min=0,
            max=10000,
            default=0,
            unit="1/1000 drum rev",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1166, "stored": 2166},
        ),
        Point(
            name="dwell_minus_millirev",
            address=167,
            space="holding",
            type="u16",
            text="Dwell at the far point of the minus reversal",
            block="parameters",
            min=0,
            max=10000,
            default=0,
            unit="1/1000 drum rev",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1167, "stored": 2167},
        ),
        Point(
            name="breaker_millirev",
            address=168,
            space="holding",
            type="u16",
            text="Ribbon breaker: both dwells grow by up to this much and shrink again, from reversal to reversal of their side",
            block="parameters",
            min=0,
            max=2000,
            default=0,
            unit="1/1000 drum rev",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1168, "stored": 2168},
        ),
        Point(
            name="breaker_cycles",
            address=169,
            space="holding",
            type="u16",
            text="Ribbon breaker: it goes up and down once in so many double traverses (0: off)",
            block="parameters",
            min=0,
            max=200,
            default=0,
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1169, "stored": 2169},
        ),
        Point(
            name="expert_mode",
            address=170,
            space="holding",
            type="u16",
            text="1: the four raw_ values replace pitch, overshoot and reversal points",
            block="parameters",
            min=0,
            max=1,
            default=0,
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1170, "stored": 2170},
        ),
        Point(
            name="raw_ka",
            address=171,
            space="holding",
            type="u16",
            text="Slope change per edge in a reversal",
            block="parameters",
            min=1,
            max=65535,
            default=23,
            unit="usteps/65536",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1171, "stored": 2171},
        ),
        Point(
            name="raw_nr",
            address=172,
            space="holding",
            type="u16",
            text="Edges from sweep slope to zero slope; Ks = Ka * Nr",
            block="parameters",
            min=1,
            max=65535,
            default=1187,
            unit="edges",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1172, "stored": 2172},
        ),
        Point(
            name="raw_reversal_plus_usteps",
            address=173,
            space="holding",
            type="i16",
            text="L+",
            block="parameters",
            min=-32000,
            max=32000,
            default=8000,
            unit="usteps",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1173, "stored": 2173},
        ),
        Point(
            name="raw_reversal_minus_usteps",
            address=174,
            space="holding",
            type="i16",
            text="L-",
            block="parameters",
            min=-32000,
            max=32000,
            default=-8000,
            unit="usteps",
            scope="motion",
            writable=True,
            reindex=True,
            mirrors={"active": 1174, "stored": 2174},
        ),
        Point(
            name="unit_id",
            address=180,
            space="holding",
            type="u16",
            text="Modbus unit id, effective after APPLY, SAVE and restart",
            block="parameters",
            min=1,
            max=247,
            default=1,
            scope="line",
            writable=True,
            mirrors={"active": 1180, "stored": 2180},
        ),
        Point(
            name="baud_rate",
            address=181,
            space="holding",
            type="u32",
            text="Line speed, effective after APPLY, SAVE and restart",
            block="parameters",
            words=2,
            min=1200,
            max=115200,
            allowed=(1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200),
            default=19200,
            unit="baud",
            scope="line",
            writable=True,
            mirrors={"active": 1181, "stored": 2181},
        ),
        Point(
            name="line_format",
            address=183,
            space="holding",
            type="u16",
            text="Data bits, parity, stop bits, effective after APPLY, SAVE and restart",
            block="parameters",
            min=0,
            max=3,
            default=0,
            scope="line",
            writable=True,
            enum=LineFormat,
            mirrors={"active": 1183, "stored": 2183},
        ),
        Point(
            name="lock_code",
            address=184,
            space="holding",
            type="u32",
            text="Code of the write lock, 0: no lock. Reads 1000000 if there is a code; writing 1000000 keeps it",
            block="parameters",
            words=2,
            min=0,
            max=1000000,
            default=0,
            scope="motion",
            writable=True,
            secret=True,
            mirrors={"active": 1184, "stored": 2184},
        ),
        Point(
            name="lock_timeout_s",
            address=186,
            space="holding",
            type="u16",
            text="The write lock closes by itself this long after it was opened",
            block="parameters",
            min=10,
            max=3600,
            default=300,
            unit="s",
            scope="motion",
            writable=True,
            mirrors={"active": 1186, "stored": 2186},
        ),
        Point(
            name="line_confirm_s",
            address=187,
            space="holding",
            type="u16",
            text="How long try_line waits for a valid request",
            block="parameters",
            min=2,
            max=120,
            default=10,
            unit="s",
            scope="line",
            writable=True,
            mirrors={"active": 1187, "stored": 2187},
        ),
        Point(
            name="encoder_watch_transitions_per_s",
            address=190,
            space="holding",
            type="u32",
            text="One encoder channel that changes faster than this without the other makes the encoder doubtful",
            block="parameters",
            words=2,
            min=100,
            max=1000000,
            default=2000,
            unit="transitions/s",
            scope="motion",
            writable=True,
            mirrors={"active": 1190, "stored": 2190},
        ),
        Point(
            name="encoder_watch_ms",
            address=192,
            space="holding",
            type="u16",
            text="An encoder that is doubtful for this long has a fault",
            block="parameters",
            min=50,
            max=60000,
            default=500,
            unit="ms",
            scope="motion",
            writable=True,
            mirrors={"active": 1192, "stored": 2192},
        ),
        Point(
            name="encoder_illegal_permille",
            address=193,
            space="holding",
            type="u16",
            text="Of 1000 transitions so many may change both channels at once, before the encoder has a fault (1000: any)",
            block="parameters",
            min=1,
            max=1000,
            default=10,
            unit="1/1000",
            scope="motion",
            writable=True,
            mirrors={"active": 1193, "stored": 2193},
        ),
        Point(
            name="drum_watch_ms",
            address=194,
            space="holding",
            type="u16",
            text="No edge for this long while drum_running is 1: the encoder has a fault (0: not watched)",
            block="parameters",
            min=0,
            max=60000,
            default=0,
            unit="ms",
            scope="motion",
            writable=True,
            mirrors={"active": 1194, "stored": 2194},
        ),
        Point(
            name="standing_turns_permille",
            address=199,
            space="holding",
            type="u16",
            text="Rope hauled in while the carriage stands sets rope_laid_standing from so many drum turns on (0: not watched)",
            block="parameters",
            min=0,
            max=10000,
            default=250,
            unit="1/1000 drum rev",
            scope="motion",
            writable=True,
            mirrors={"active": 1199, "stored": 2199},
        ),
        Point(
            name="rope_diameter_um",
            address=200,
            space="holding",
            type="u16",
            text="Diameter of the rope (0: not known)",
            block="parameters",
            min=0,
            max=50000,
            default=0,
            unit="um",
            scope="motion",
            writable=True,
            mirrors={"active": 1200, "stored": 2200},
        ),
        Point(
            name="drum_core_diameter_um",
            address=201,
            space="holding",
            type="u32",
            text="Diameter of the bare drum (0: not known). With rope_diameter_um and rope_packing_permille, metres of rope follow the growing layers",
            block="parameters",
            words=2,
            min=0,
            max=5000000,
            default=0,
            unit="um",
            scope="motion",
            writable=True,
            mirrors={"active": 1201, "stored": 2201},
        ),
        Point(
            name="rope_packing_permille",
            address=203,
            space="holding",
            type="u16",
            text="How much of the room on the drum the rope fills, fitted from two known lengths; about 600 to 900 (0: not known)",
            block="parameters",
            min=0,
            max=1000,
            default=0,
            unit="1/1000",
            scope="motion",
            writable=True,
            mirrors={"active": 1203, "stored": 2203},
        ),
        Point(
            name="trim_step_um",
            address=204,
            space="holding",
            type="u16",
            text="How far trim_early and trim_late shift a reversal point",
            block="parameters",
            min=1,
            max=5000,
            default=500,
            unit="um",
            scope="motion",
            writable=True,
            mirrors={"active": 1204, "stored": 2204},
        ),
        Point(
            name="resume",
            address=205,
            space="holding",
            type="u16",
            text="1: where the drum came to rest is kept, also over a power-off, and after an indexing the carriage first goes there and takes up direction and slope; 0: it begins where the indexing ends",
            block="parameters",
            min=0,
            max=1,
            default=0,
            scope="motion",
            writable=True,
            mirrors={"active": 1205, "stored": 2205},
        ),
        Point(
            name="reacquire_after_restart",
            address=206,
            space="holding",
            type="u16",
            text="1: where the controller has restarted in a launch (memory kept, the drum still turns), it gives reacquire by itself. THE CARRIAGE MOVES UNASKED",
            block="parameters",
            min=0,
            max=1,
            default=0,
            scope="motion",
            writable=True,
            mirrors={"active": 1206, "stored": 2206},
        ),
        Point(
            name="accepted_crc",
            address=207,
            space="holding",
            type="u32",
            text="The set that somebody has accepted: active_crc as it was then, written by `levelwind commission` (0: none)",
            block="parameters",
            words=2,
            min=0,
            max=1073741823,
            default=0,
            scope="motion",
            writable=True,
            mirrors={"active": 1207, "stored": 2207},
        ),
        Point(
            name="motion_profile",
            address=600,
            space="holding",
            type="u16",
            text="What the carriage follows the drum by",
            block="parameters",
            min=0,
            max=1,
            default=0,
            scope="motion",
            writable=True,
            enum=MotionProfile,
            mirrors={"active": 1600, "stored": 2600},
        ),
        Point(
            name="cam_start",
            address=601,
            space="holding",
            type="u16",
            text="How a cam begins at a hand-over",
            block="parameters",
            min=0,
            max=2,
            default=0,
            scope="motion",
            writable=True,
            enum=CamStart,
            mirrors={"active": 1601, "stored": 2601},
        ),
        Point(
            name="cam_master_edges",
            address=602,
            space="holding",
            type="u16",
            text="So many encoder edges are cam_master_units of a cam table's master column",
            block="parameters",
            min=1,
            max=10000,
            default=1,
            unit="edges",
            scope="motion",
            writable=True,
            mirrors={"active": 1602, "stored": 2602},
        ),
        Point(
            name="cam_master_units",
            address=603,
            space="holding",
            type="u16",
            text="See cam_master_edges",
            block="parameters",
            min=1,
            max=10000,
            default=1,
            scope="motion",
            writable=True,
            mirrors={"active": 1603, "stored": 2603},
        ),
        Point(
            name="cam_slave_usteps",
            address=604,
            space="holding",
            type="u16",
            text="So many microsteps are cam_slave_units of a cam table's slave column",
            block="parameters",
            min=1,
            max=10000,
            default=1,
            unit="usteps",
            scope="motion",
            writable=True,
            mirrors={"active": 1604, "stored": 2604},
        ),
        Point(
            name="cam_slave_units",
            address=605,
            space="holding",
            type="u16",
            text="See cam_slave_usteps",
            block="parameters",
            min=1,
            max=10000,
            default=1,
            scope="motion",
            writable=True,
            mirrors={"active": 1605, "stored": 2605},
        ),
        Point(
            name="cam_ramp_divisor",
            address=606,
            space="holding",
            type="u16",
            text="Trapezoid rows: each ramp is this part of its row",
            block="parameters",
            min=2,
            max=100,
            default=10,
            scope="motion",
            writable=True,
            mirrors={"active": 1606, "stored": 2606},
        ),
        Point(
            name="cam_axis",
            address=607,
            space="holding",
            type="u16",
            text="What a cam moves",
            block="parameters",
            min=0,
            max=1,
            default=0,
            scope="motion",
            writable=True,
            enum=CamAxis,
            mirrors={"active": 1607, "stored": 2607},
        ),
        Point(
            name="cam_steps_per_s_max",
            address=608,
            space="holding",
            type="u32",
            text="Fastest step pulses that the stepper driver and the motor follow; a cam table may ask for no more at overspeed_trip_edges_per_s",
            block="parameters",
            words=2,
            min=1000,
            max=4000000,
            default=200000,
            unit="usteps/s",
            scope="motion",
            writable=True,
            mirrors={"active": 1608, "stored": 2608},
        ),
        Point(
            name="self_test",
            address=0,
            space="input",
            type="u32",
            text="Always 0x12345678: the master's word order is right when it reads so",
            block="status",
            words=2,
        ),
        Point(
            name="map_version",
            address=2,
            space="input",
            type="u16",
            text="Version of this map",
            block="status",
        ),
        Point(
            name="version_major",
            address=3,
            space="input",
            type="u16",
            text="Firmware version, major",
            block="status",
        ),
        Point(
            name="version_minor",
            address=4,
            space="input",
            type="u16",
            text="Firmware version, minor",
            block="status",
        ),
        Point(
            name="version_patch",
            address=5,
            space="input",
            type="u16",
            text="Firmware version, patch",
            block="status",
        ),
        Point(
            name="host",
            address=6,
            space="input",
            type="u16",
            text="What runs the core",
            block="status",
            enum=Host,
        ),
        Point(
            name="image_hash_high",
            address=7,
            space="input",
            type="u32",
            text="What runs: bytes 0 to 3 of the SHA-256 of zephyr.bin, worked out over the flash at power-up (0, and so the low half: not known, as on the simulators)",
            block="status",
            words=2,
        ),
        Point(
            name="image_hash_low",
            address=9,
            space="input",
            type="u32",
            text="Bytes 4 to 7 of it",
            block="status",
            words=2,
        ),
        Point(
            name="state",
            address=100,
            space="input",
            type="u16",
            text="What the controller is doing",
            block="status",
            enum=State,
        ),
        Point(
            name="active_mode",
            address=101,
            space="input",
            type="u16",
            text="Mode in force (the requested one waits for the drum to rest)",
            block="status",
            enum=Mode,
        ),
        Point(
            name="fault",
            address=102,
            space="input",
            type="u16",
            text="Why the controller stopped",
            block="status",
            enum=Fault,
        ),
        Point(
            name="flags",
            address=103,
            space="input",
            type="u32",
            text="The first 32 discrete inputs, bit number = discrete input address",
            block="status",
            words=2,
            bits=Flag,
        ),
        Point(
            name="launch_inhibit",
            address=105,
            space="input",
            type="u16",
            text="Why a launch is not permitted; 0 means launch permit",
            block="status",
            bits=LaunchInhibit,
        ),
        Point(
            name="position_um",
            address=106,
            space="input",
            type="i32",
            text="Carriage position",
            block="status",
            words=2,
            unit="um",
        ),
        Point(
            name="position_usteps",
            address=108,
            space="input",
            type="i16",
            text="Carriage position, whole microsteps; a free axis goes on modulo 65536",
            block="status",
            unit="usteps",
        ),
        Point(
            name="m",
            address=109,
            space="input",
            type="i32",
            text="Carriage position, Q16.16",
            block="status",
            words=2,
            unit="usteps/65536",
        ),
        Point(
            name="u",
            address=111,
            space="input",
            type="i32",
            text="Slope: microsteps that one forward edge moves the carriage, Q16.16",
            block="status",
            words=2,
            unit="usteps/65536",
        ),
        Point(
            name="drum_speed_edges_per_s",
            address=113,
            space="input",
            type="i32",
            text="Drum speed, positive hauls rope in",
            block="status",
            words=2,
            unit="edges/s",
        ),
        Point(
            name="rope_speed_mm_per_s",
            address=115,
            space="input",
            type="i32",
            text="Rope speed, positive hauls in; by rope_radius_um where that is known",
            block="status",
            words=2,
            unit="mm/s",
        ),
        Point(
            name="rope_mm",
            address=117,
            space="input",
            type="i32",
            text="Rope hauled in (positive) or paid out since power-up, by the growing layers where the rope on the drum is known; stands still at its limits, 2147 km",
            block="status",
            words=2,
            unit="mm",
        ),
        Point(
            name="net_edges",
            address=119,
            space="input",
            type="i64",
            text="Odometer: net drum edges since power-up",
            block="status",
            words=4,
            unit="edges",
        ),
        Point(
            name="pattern_edges",
            address=123,
            space="input",
            type="i64",
            text="Net edges followed since the last hand-over",
            block="status",
            words=4,
            unit="edges",
        ),
        Point(
            name="uptime_ms",
            address=127,
            space="input",
            type="u32",
            text="Time since power-up; begins anew at 0 after 49.7 days",
            block="status",
            words=2,
            unit="ms",
        ),
        Point(
            name="los_recoveries",
            address=129,
            space="input",
            type="u16",
            text="Re-indexings after a LOS in this launch",
            block="status",
        ),
        Point(
            name="span_error_um",
            address=130,
            space="input",
            type="i32",
            text="Last indexing: found minus calibrated position of the other switch",
            block="status",
            words=2,
            unit="um",
        ),
        Point(
            name="flags_2",
            address=132,
            space="input",
            type="u32",
            text="The discrete inputs from 32 on, bit number = discrete input address - 32",
            block="status",
            words=2,
            bits=Flag,
            bits_from=32,
        ),
        Point(
            name="rope_on_drum_mm",
            address=134,
            space="input",
            type="i32",
            text="Rope on the drum; 0 until set_rope. It may be wrong while rope_doubtful is on",
            block="status",
            words=2,
            unit="mm",
        ),
        Point(
            name="rope_out_mm",
            address=136,
            space="input",
            type="i32",
            text="Rope wound off since set_rope: what is out, if it was told with all rope in",
            block="status",
            words=2,
            unit="mm",
        ),
        Point(
            name="rope_layer",
            address=138,
            space="input",
            type="u16",
            text="Layers of rope on the drum, begun ones too; 0: bare, or not known",
            block="status",
        ),
        Point(
            name="rope_radius_um",
            address=139,
            space="input",
            type="u32",
            text="Radius of what is wound, from the drum's axis; 0: not known",
            block="status",
            words=2,
            unit="um",
        ),
        Point(
            name="resume_position_um",
            address=141,
            space="input",
            type="i32",
            text="Where the rope goes on: carriage position when the drum came to rest, also before a power-off; 0 while resume_direction is 0",
            block="status",
            words=2,
            unit="um",
        ),
        Point(
            name="resume_direction",
            address=143,
            space="input",
            type="i16",
            text="Direction of the carriage there while the drum hauls in: +1 or -1; 0: not known, or resume is 0",
            block="status",
        ),
        Point(
            name="los1_plus_count",
            address=200,
            space="input",
            type="u16",
            text="LOS type 1+ since power-up",
            block="status",
        ),
        Point(
            name="los1_plus_position_um",
            address=201,
            space="input",
            type="i32",
            text="Position of the first since the last indexing",
            block="status",
            words=2,
            unit="um",
        ),
        Point(
            name="los1_plus_time_ms",
            address=203,
            space="input",
            type="u32",
            text="Its time since power-up, of that power-up",
            block="status",
            words=2,
            unit="ms",
        ),
        Point(
            name="los1_minus_count",
            address=210,
            space="input",
            type="u16",
            text="LOS type 1- since power-up",
            block="status",
        ),
        Point(
            name="los1_minus_position_um",
            address=211,
            space="input",
            type="i32",
            text="Position of the first since the last indexing",
            block="status",
            words=2,
            unit="um",
        ),
        Point(
            name="los1_minus_time_ms",
            address=213,
            space="input",
            type="u32",
            text="Its time since power-up, of that power-up",
            block="status",
            words=2,
            unit="ms",
        ),
        Point(
            name="los2_plus_count",
            address=220,
            space="input",
            type="u16",
            text="LOS type 2+ since power-up",
            block="status",
        ),
        Point(
            name="los2_plus_position_um",
            address=221,
            space="input",
            type="i32",
            text="Position of the first since the last indexing",
            block="status",
            words=2,
            unit="um",
        ),
        Point(
            name="los2_plus_time_ms",
            address=223,
            space="input",
            type="u32",
            text="Its time since power-up, of that power-up",
            block="status",
            words=2,
            unit="ms",
        ),
        Point(
            name="los2_minus_count",
            address=230,
            space="input",
            type="u16",
            text="LOS type 2- since power-up",
            block="status",
        ),
        Point(
            name="los2_minus_position_um",
            address=231,
            space="input",
            type="i32",
            text="Position of the first since the last indexing",
            block="status",
            words=2,
            unit="um",
        ),
        Point(
            name="los2_minus_time_ms",
            address=233,
            space="input",
            type="u32",
            text="Its time since power-up, of that power-up",
            block="status",
            words=2,
            unit="ms",
        ),
        Point(
            name="illegal_transitions",
            address=300,
            space="input",
            type="u32",
            text="Encoder transitions of both channels at once since power-up",
            block="status",
            words=2,
        ),
        Point(
            name="switch_plus_triggers",
            address=302,
            space="input",
            type="u32",
            text="Trigger events of the plus limit switch",
            block="status",
            words=2,
        ),
        Point(
            name="switch_minus_triggers",
            address=304,
            space="input",
            type="u32",
            text="Trigger events of the minus limit switch",
            block="status",
            words=2,
        ),
        Point(
            name="steps",
            address=306,
            space="input",
            type="u32",
            text="Step pulses given since power-up",
            block="status",
            words=2,
            unit="usteps",
        ),
        Point(
            name="requests",
            address=308,
            space="input",
            type="u32",
            text="Modbus requests answered or executed",
            block="status",
            words=2,
        ),
        Point(
            name="crc_errors",
            address=310,
            space="input",
            type="u32",
            text="Modbus frames with a wrong CRC",
            block="status",
            words=2,
        ),
        Point(
            name="exceptions",
            address=312,
            space="input",
            type="u32",
            text="Modbus exceptions answered",
            block="status",
            words=2,
        ),
        Point(
            name="boots",
            address=314,
            space="input",
            type="u32",
            text="Power-ups. Survives power-off",
            block="status",
            words=2,
        ),
        Point(
            name="watchdog_resets",
            address=316,
            space="input",
            type="u32",
            text="Restarts by the watchdog. Survives power-off",
            block="status",
            words=2,
        ),
        Point(
            name="powered_s",
            address=318,
            space="input",
            type="u32",
            text="Time under power. Survives power-off but for up to 15 minutes",
            block="status",
            words=2,
            unit="s",
        ),
        Point(
            name="tracking_s",
            address=320,
            space="input",
            type="u32",
            text="Time in the state tracking. Survives power-off but for what came after the last write",
            block="status",
            words=2,
            unit="s",
        ),
        Point(
            name="log_sequence",
            address=322,
            space="input",
            type="u32",
            text="Event log: sequence number of the newest event, 0 if there is none",
            block="status",
            words=2,
        ),
        Point(
            name="log_count",
            address=324,
            space="input",
            type="u16",
            text="Event log: events that can be read",
            block="status",
        ),
        Point(
            name="log_unsaved",
            address=325,
            space="input",
            type="u16",
            text="Event log: events that are not stored yet; they wait until the drum rests",
            block="status",
        ),
        Point(
            name="record_sequence",
            address=326,
            space="input",
            type="u32",
            text="Sequence number of the stored parameter set in use, 0 if there is none",
            block="status",
            words=2,
        ),
        Point(
            name="record_schema",
            address=328,
            space="input",
            type="u16",
            text="Its schema; an older one becomes the present one by SAVE",
            block="status",
        ),
        Point(
            name="slot_0",
            address=329,
            space="input",
            type="u16",
            text="Storage: first slot of the parameters",
            block="status",
            enum=SlotState,
        ),
        Point(
            name="slot_1",
            address=330,
            space="input",
            type="u16",
            text="Storage: second slot of the parameters",
            block="status",
            enum=SlotState,
        ),
        Point(
            name="slot_2",
            address=331,
            space="input",
            type="u16",
            text="Storage: first slot of event log and counters",
            block="status",
            enum=SlotState,
        ),
        Point(
            name="slot_3",
            address=332,
            space="input",
            type="u16",
            text="Storage: second slot of event log and counters",
            block="status",
            enum=SlotState,
        ),
        Point(
            name="active_crc",
            address=333,
            space="input",
            type="u32",
            text="Names the active set by its values, those of the line and the lock's code left out; never 0. See accepted_crc",
            block="status",
            words=2,
        ),
        Point(
            name="encoder_interrupt_max_ns",
            address=340,
            space="input",
            type="u32",
            text="Longest time in the encoder interrupt since power-up, without the operating system's share (0: not measured)",
            block="status",
            words=2,
            unit="ns",
        ),
        Point(
            name="late_interrupts",
            address=342,
            space="input",
            type="u32",
            text="Encoder interrupts that found nothing changed: transitions came closer than the interrupt is fast",
            block="status",
            words=2,
        ),
        Point(
            name="encoder_index_pulses",
            address=344,
            space="input",
            type="u32",
            text="Index pulses (Z) of the encoder since power-up (0: not wired, or it has not turned)",
            block="status",
            words=2,
        ),
        Point(
            name="missed_edges",
            address=346,
            space="input",
            type="u32",
            text="Edges that were missing, or too many, between index pulses since power-up",
            block="status",
            words=2,
            unit="edges",
        ),
        Point(
            name="stack_free_supervisor_bytes",
            address=350,
            space="input",
            type="u16",
            text="Stack that the supervisor has never used (0: not measured)",
            block="status",
            unit="bytes",
        ),
        Point(
            name="stack_free_limits_bytes",
            address=351,
            space="input",
            type="u16",
            text="Stack that the limits thread has never used (0: not measured)",
            block="status",
            unit="bytes",
        ),
        Point(
            name="stack_free_modbus_bytes",
            address=352,
            space="input",
            type="u16",
            text="Stack that the Modbus thread has never used (0: not measured)",
            block="status",
            unit="bytes",
        ),
        Point(
            name="stack_free_storage_bytes",
            address=353,
            space="input",
            type="u16",
            text="Stack that the storage work queue has never used (0: not measured)",
            block="status",
            unit="bytes",
        ),
        Point(
            name="stack_free_interrupts_bytes",
            address=354,
            space="input",
            type="u16",
            text="Stack that the interrupts have never used (0: not measured)",
            block="status",
            unit="bytes",
        ),
        Point(
            name="encoder_fault_kind",
            address=360,
            space="input",
            type="u16",
            text="What was wrong with the encoder first since the last indexing (and since the power-up)",
            block="status",
            enum=EncoderFault,
        ),
        Point(
            name="encoder_fault_count",
            address=361,
            space="input",
            type="u16",
            text="Encoder faults since power-up",
            block="status",
        ),
        Point(
            name="encoder_fault_position_um",
            address=362,
            space="input",
            type="i32",
            text="Position of the first since the last indexing",
            block="status",
            words=2,
            unit="um",
        ),
        Point(
            name="encoder_fault_time_ms",
            address=364,
            space="input",
            type="u32",
            text="Its time since power-up",
            block="status",
            words=2,
            unit="ms",
        ),
        Point(
            name="encoder_doubts",
            address=366,
            space="input",
            type="u16",
            text="How often the encoder became doubtful since power-up",
            block="status",
        ),
        Point(
            name="encoder_misfit_edges",
            address=367,
            space="input",
            type="i32",
            text="By how many edges the index pulses contradict the count, net, since the last indexing",
            block="status",
            words=2,
            unit="edges",
        ),
        Point(
            name="memory_corrections",
            address=369,
            space="input",
            type="u16",
            text="Bits of the active parameters and of the law in force that had flipped in memory and were set right since power-up",
            block="status",
        ),
        Point(
            name="line_babbles",
            address=380,
            space="input",
            type="u32",
            text="Times that bytes came on the line without a silence for more than a second, since power-up",
            block="status",
            words=2,
        ),
        Point(
            name="line_echoes",
            address=382,
            space="input",
            type="u32",
            text="Own answers that the line gave back, dropped",
            block="status",
            words=2,
        ),
        Point(
            name="late_requests",
            address=384,
            space="input",
            type="u32",
            text="Requests that had waited too long and were dropped",
            block="status",
            words=2,
        ),
        Point(
            name="foreign_answers",
            address=386,
            space="input",
            type="u32",
            text="Answers of another device as this unit, dropped: two devices have this unit_id, or an echo comes late",
            block="status",
            words=2,
        ),
        Point(
            name="events_skipped",
            address=388,
            space="input",
            type="u32",
            text="Events that were not logged because their cause comes and goes too often",
            block="status",
            words=2,
        ),
        Point(
            name="rope_standing_millirev",
            address=390,
            space="input",
            type="u32",
            text="Drum turns of rope laid while the carriage stood, since the last acknowledgement",
            block="status",
            words=2,
            unit="1/1000 drum rev",
        ),
        Point(
            name="rope_standing_position_um",
            address=392,
            space="input",
            type="i32",
            text="Where the carriage stood at the first of them",
            block="status",
            words=2,
            unit="um",
        ),
        Point(
            name="rope_standing_time_ms",
            address=394,
            space="input",
            type="u32",
            text="When, since power-up, of that power-up",
            block="status",
            words=2,
            unit="ms",
        ),
        Point(
            name="rope_standing_place_known",
            address=396,
            space="input",
            type="u16",
            text="1: that position was known; 0: the position had been unknown before",
            block="status",
        ),
        Point(
            name="look_before_power_up",
            address=397,
            space="input",
            type="u16",
            text="What needs a look at the rope since before this power-up: 1 LOS 1+, 2 LOS 1-, 4 LOS 2+, 8 LOS 2-, 16 rope laid while the carriage stood, 32 encoder fault, 64 re-acquired",
            block="status",
        ),
        Point(
            name="command_sequence",
            address=400,
            space="input",
            type="u16",
            text="Counts every command, also refused ones",
            block="status",
        ),
        Point(
            name="command_code",
            address=401,
            space="input",
            type="u16",
            text="The last command",
            block="status",
            enum=Command,
        ),
        Point(
            name="command_result",
            address=402,
            space="input",
            type="u16",
            text="How it ended",
            block="status",
            enum=Result,
        ),
        Point(
            name="command_reason",
            address=403,
            space="input",
            type="u16",
            text="Why it was refused or failed",
            block="status",
            enum=Reason,
        ),
        Point(
            name="command_address",
            address=404,
            space="input",
            type="u16",
            text="Offending holding register, 65535 if none",
            block="status",
        ),
        Point(
            name="command_value",
            address=405,
            space="input",
            type="i32",
            text="Offending value",
            block="status",
            words=2,
        ),
        Point(
            name="command_limit",
            address=407,
            space="input",
            type="i32",
            text="The limit that it broke",
            block="status",
            words=2,
        ),
        Point(
            name="last_error_reason",
            address=410,
            space="input",
            type="u16",
            text="Why the last refused request was refused",
            block="status",
            enum=Reason,
        ),
        Point(
            name="last_error_function",
            address=411,
            space="input",
            type="u16",
            text="Its function code",
            block="status",
        ),
        Point(
            name="last_error_exception",
            address=412,
            space="input",
            type="u16",
            text="The exception answered",
            block="status",
        ),
        Point(
            name="last_error_address",
            address=413,
            space="input",
            type="u16",
            text="The offending address",
            block="status",
        ),
        Point(
            name="last_error_value",
            address=414,
            space="input",
            type="i32",
            text="The offending value",
            block="status",
            words=2,
        ),
        Point(
            name="last_error_limit",
            address=416,
            space="input",
            type="i32",
            text="The limit that it broke",
            block="status",
            words=2,
        ),
        Point(
            name="ka",
            address=500,
            space="input",
            type="i32",
            text="Slope change per edge in a reversal, in force",
            block="status",
            words=2,
            unit="usteps/65536",
        ),
        Point(
            name="nr",
            address=502,
            space="input",
            type="i32",
            text="Edges from sweep slope to zero slope, in force",
            block="status",
            words=2,
            unit="edges",
        ),
        Point(
            name="ks",
            address=504,
            space="input",
            type="i32",
            text="Sweep slope per edge, in force: Ks = Ka * Nr",
            block="status",
            words=2,
            unit="usteps/65536",
        ),
        Point(
            name="reversal_plus_usteps",
            address=506,
            space="input",
            type="i16",
            text="L+ in force, trim included",
            block="status",
            unit="usteps",
        ),
        Point(
            name="reversal_minus_usteps",
            address=507,
            space="input",
            type="i16",
            text="L- in force, trim included",
            block="status",
            unit="usteps",
        ),
        Point(
            name="overshoot_actual_um",
            address=508,
            space="input",
            type="i32",
            text="Overshoot in force: Ks * (Nr - 1) / 2",
            block="status",
            words=2,
            unit="um",
        ),
        Point(
            name="slope_error_ppm",
            address=510,
            space="input",
            type="i32",
            text="Residual error of the pitch",
            block="status",
            words=2,
            unit="ppm",
        ),
        Point(
            name="overshoot_error_um",
            address=512,
            space="input",
            type="i32",
            text="Residual error of the overshoot",
            block="status",
            words=2,
            unit="um",
        ),
        Point(
            name="edges_per_1000_drum_revs",
            address=514,
            space="input",
            type="u32",
            text="Used encoder edges per 1000 drum revolutions, rounded",
            block="status",
            words=2,
            unit="edges",
        ),
        Point(
            name="dwell_plus_edges",
            address=516,
            space="input",
            type="u32",
            text="Dwell at the plus side",
            block="status",
            words=2,
            unit="edges",
        ),
        Point(
            name="dwell_minus_edges",
            address=518,
            space="input",
            type="u32",
            text="Dwell at the minus side",
            block="status",
            words=2,
            unit="edges",
        ),
        Point(
            name="breaker_edges",
            address=520,
            space="input",
            type="u32",
            text="Ribbon breaker: most that it adds to a dwell",
            block="status",
            words=2,
            unit="edges",
        ),
        Point(
            name="breaker_cycle_plus",
            address=522,
            space="input",
            type="u16",
            text="Ribbon breaker: far points passed at plus since the hand-over after the last indexing, net, modulo breaker_cycles",
            block="status",
        ),
        Point(
            name="breaker_cycle_minus",
            address=523,
            space="input",
            type="u16",
            text="Ribbon breaker: those at minus",
            block="status",
        ),
        Point(
            name="cam_bank_0_state",
            address=600,
            space="input",
            type="u16",
            text="What the first bank of cam tables holds",
            block="status",
            enum=CamBankState,
        ),
        Point(
            name="cam_bank_1_state",
            address=601,
            space="input",
            type="u16",
            text="What the second bank of cam tables holds",
            block="status",
            enum=CamBankState,
        ),
        Point(
            name="cam_reason",
            address=602,
            space="input",
            type="u16",
            text="Why the last check of a cam table refused it, or why the active one cannot be followed",
            block="status",
            enum=Reason,
        ),
        Point(
            name="cam_reason_row",
            address=603,
            space="input",
            type="u16",
            text="The offending row, counted from 1; 0 if no single row is to blame",
            block="status",
        ),
        Point(
            name="cam_reason_value",
            address=604,
            space="input",
            type="i32",
            text="The offending value",
            block="status",
            words=2,
        ),
        Point(
            name="cam_reason_limit",
            address=606,
            space="input",
            type="i32",
            text="The limit that it broke",
            block="status",
            words=2,
        ),
        Point(
            name="cam_version",
            address=608,
            space="input",
            type="u32",
            text="Version of the active cam table",
            block="status",
            words=2,
        ),
        Point(
            name="cam_stored",
            address=610,
            space="input",
            type="u16",
            text="1 when it is stored, so that the next power-up begins with it; written at rest only",
            block="status",
        ),
        Point(
            name="cam_rows",
            address=611,
            space="input",
            type="u16",
            text="Its rows; 0: there is none",
            block="status",
        ),
        Point(
            name="cam_cycle_edges",
            address=612,
            space="input",
            type="u32",
            text="Length of its cycle",
            block="status",
            words=2,
            unit="edges",
        ),
        Point(
            name="cam_min_usteps",
            address=614,
            space="input",
            type="i32",
            text="Its lowest position",
            block="status",
            words=2,
            unit="usteps",
        ),
        Point(
            name="cam_max_usteps",
            address=616,
            space="input",
            type="i32",
            text="Its highest position",
            block="status",
            words=2,
            unit="usteps",
        ),
        Point(
            name="cam_slope_max_permille",
            address=618,
            space="input",
            type="u16",
            text="Its steepest slope, ramps included",
            block="status",
            unit="usteps/1000 edges",
        ),
        Point(
            name="cam_position_usteps",
            address=619,
            space="input",
            type="i32",
            text="Slave position by the table, modulo 2^32",
            block="status",
            words=2,
            unit="usteps",
        ),
        Point(
            name="cam_row",
            address=621,
            space="input",
            type="u16",
            text="Row behind the master, counted from 1; 0: no cam is running",
            block="status",
        ),
        Point(
            name="cam_cycles",
            address=622,
            space="input",
            type="i32",
            text="Net cycles since the hand-over",
            block="status",
            words=2,
        ),
        Point(
            name="cam_phase_in_force_edges",
            address=624,
            space="input",
            type="i32",
            text="How much of cam_phase_edges is reached",
            block="status",
            words=2,
            unit="edges",
        ),
        Point(
            name="cam_waiting",
            address=626,
            space="input",
            type="u16",
            text="1 while a cam waits for the begin of the next cycle",
            block="status",
        ),
        Point(
            name="slot_4",
            address=627,
            space="input",
            type="u16",
            text="Storage: first slot of cam tables",
            block="status",
            enum=SlotState,
        ),
        Point(
            name="slot_5",
            address=628,
            space="input",
            type="u16",
            text="Storage: second slot of cam tables",
            block="status",
            enum=SlotState,
        ),
        Point(
            name="slot_6",
            address=629,
            space="input",
            type="u16",
            text="Storage: first slot of what needs a look at the rope",
            block="status",
            enum=SlotState,
        ),
        Point(
            name="slot_7",
            address=630,
            space="input",
            type="u16",
            text="Storage: second slot of what needs a look at the rope",
            block="status",
            enum=SlotState,
        ),
        Point(
            name="cam_upload_name",
            address=3000,
            space="holding",
            type="u16",
            text="Name, two characters of ASCII in a register",
            block="cam_upload",
            count=8,
            min=0,
            max=65535,
            default=0,
            writable=True,
        ),
        Point(
            name="cam_upload_version",
            address=3008,
            space="holding",
            type="u32",
            text="Version, for people",
            block="cam_upload",
            words=2,
            min=0,
            max=2147483647,
            default=0,
            writable=True,
        ),
        Point(
            name="cam_upload_interpolation",
            address=3010,
            space="holding",
            type="u16",
            text="How to go from row to row",
            block="cam_upload",
            min=0,
            max=1,
            default=0,
            writable=True,
            enum=CamInterpolation,
        ),
        Point(
            name="cam_upload_row_count",
            address=3011,
            space="holding",
            type="u16",
            text="Rows",
            block="cam_upload",
            min=0,
            max=65535,
            default=0,
            writable=True,
        ),
        Point(
            name="cam_upload_advance",
            address=3012,
            space="holding",
            type="i32",
            text="Slave units that a cycle adds; 0: cyclic",
            block="cam_upload",
            words=2,
            min=-2147483647,
            max=2147483647,
            default=0,
            writable=True,
        ),
        Point(
            name="cam_upload_crc",
            address=3014,
            space="holding",
            type="u16",
            text="CRC-32 of the 14 registers before and 4 per row, high word first",
            block="cam_upload",
            count=2,
            min=0,
            max=65535,
            default=0,
            writable=True,
        ),
        Point(
            name="cam_upload_first_row",
            address=3016,
            space="holding",
            type="u16",
            text="Row that cam_upload_rows begins at, counted from 1; may stand in the same request",
            block="cam_upload",
            min=1,
            max=256,
            default=1,
            writable=True,
        ),
        Point(
            name="cam_upload_rows",
            address=3018,
            space="holding",
            type="i32",
            text="Window of 30 rows: master, slave, alternating",
            block="cam_upload",
            words=2,
            count=60,
            min=-2147483647,
            max=2147483647,
            default=0,
            writable=True,
        ),
        Point(
            name="bench_argument",
            address=61440,
            space="holding",
            type="i32",
            text="Argument of bench_command; may stand in the same request",
            block="bench",
            words=2,
            min=-10000000,
            max=10000000,
            default=0,
            writable=True,
        ),
        Point(
            name="bench_command",
            address=61442,
            space="holding",
            type="u16",
            text="Writing a code runs it",
            block="bench",
            min=0,
            max=10,
            default=0,
            writable=True,
            command=True,
            enum=BenchCommand,
        ),
        Point(
            name="bench_drum_speed_millirpm",
            address=61443,
            space="holding",
            type="i32",
            text="Drum speed asked for; writing it ends a profile",
            block="bench",
            words=2,
            min=-3000000,
            max=3000000,
            default=0,
            unit="millirpm",
            writable=True,
        ),
        Point(
            name="bench_drum_acceleration_millirpm_per_s",
            address=61445,
            space="holding",
            type="u32",
            text="How fast the drum reaches it",
            block="bench",
            words=2,
            min=1,
            max=100000000,
            default=200000,
            unit="millirpm/s",
            writable=True,
        ),
        Point(
            name="bench_side_load_mm_per_s2",
            address=61447,
            space="holding",
            type="i32",
            text="Side load on the carriage, as acceleration",
            block="bench",
            words=2,
            min=-1000000,
            max=1000000,
            default=0,
            unit="mm/s2",
            writable=True,
        ),
        Point(
            name="bench_stall",
            address=61449,
            space="holding",
            type="u16",
            text="1 holds the carriage where it is",
            block="bench",
            min=0,
            max=1,
            default=0,
            writable=True,
        ),
        Point(
            name="bench_bounce_ms",
            address=61450,
            space="holding",
            type="u16",
            text="Bounce of the limit switches",
            block="bench",
            min=0,
            max=100,
            default=3,
            unit="ms",
            writable=True,
        ),
        Point(
            name="bench_switch_plus_fault",
            address=61451,
            space="holding",
            type="u16",
            text="Fault of the plus limit switch",
            block="bench",
            min=0,
            max=5,
            default=0,
            writable=True,
            enum=SwitchFault,
        ),
        Point(
            name="bench_switch_minus_fault",
            address=61452,
            space="holding",
            type="u16",
            text="Fault of the minus limit switch",
            block="bench",
            min=0,
            max=5,
            default=0,
            writable=True,
            enum=SwitchFault,
        ),
        Point(
            name="bench_overtravel_plus",
            address=61453,
            space="holding",
            type="u16",
            text="1 actuates the plus overtravel switch",
            block="bench",
            min=0,
            max=1,
            default=0,
            writable=True,
        ),
        Point(
            name="bench_overtravel_minus",
            address=61454,
            space="holding",
            type="u16",
            text="1 actuates the minus overtravel switch",
            block="bench",
            min=0,
            max=1,
            default=0,
            writable=True,
        ),
        Point(
            name="bench_direction_reversed",
            address=61455,
            space="holding",
            type="u16",
            text="1 swaps the stepper's direction wire",
            block="bench",
            min=0,
            max=1,
            default=0,
            writable=True,
        ),
        Point(
            name="bench_trigger_position_um",
            address=61456,
            space="holding",
            type="i32",
            text="Armed fault: real carriage position that releases it",
            block="bench",
            words=2,
            min=-500000,
            max=500000,
            default=0,
            unit="um",
            writable=True,
        ),
        Point(
            name="bench_trigger_direction",
            address=61458,
            space="holding",
            type="i16",
            text="Armed fault: only when passing in this direction (0: either)",
            block="bench",
            min=-1,
            max=1,
            default=0,
            writable=True,
        ),
        Point(
            name="bench_trigger_argument",
            address=61459,
            space="holding",
            type="i32",
            text="Armed fault: its argument",
            block="bench",
            words=2,
            min=-10000000,
            max=10000000,
            default=0,
            writable=True,
        ),
        Point(
            name="bench_trigger_fault",
            address=61461,
            space="holding",
            type="u16",
            text="Writing it arms the fault; reads 0 once released",
            block="bench",
            min=0,
            max=3,
            default=0,
            writable=True,
            enum=TriggerFault,
        ),
        Point(
            name="bench_stepper_alarm",
            address=61462,
            space="holding",
            type="u16",
            text="1 lets the stepper driver report an alarm and switch its motor off",
            block="bench",
            min=0,
            max=1,
            default=0,
            writable=True,
        ),
        Point(
            name="bench_hang",
            address=61463,
            space="holding",
            type="u16",
            text="Writing a code hangs that thread; refused by the simulator, which has none",
            block="bench",
            min=0,
            max=5,
            default=0,
            writable=True,
            enum=BenchThread,
        ),
        Point(
            name="bench_restart",
            address=61464,
            space="holding",
            type="u16",
            text="The last restart by the watchdog, as the stepper saw it",
            block="bench",
            enum=BenchRestart,
        ),
        Point(
            name="bench_trim_early",
            address=61465,
            space="holding",
            type="u16",
            text="1 presses the button for early reversal",
            block="bench",
            min=0,
            max=1,
            default=0,
            writable=True,
        ),
        Point(
            name="bench_trim_late",
            address=61466,
            space="holding",
            type="u16",
            text="1 presses the button for late reversal",
            block="bench",
            min=0,
            max=1,
            default=0,
            writable=True,
        ),
        Point(
            name="bench_result",
            address=61469,
            space="holding",
            type="u16",
            text="0: the last bench command or armed fault was accepted; else the POSIX error number why not",
            block="bench",
        ),
        Point(
            name="bench_carriage_um",
            address=61470,
            space="holding",
            type="i32",
            text="Real carriage position",
            block="bench",
            words=2,
            unit="um",
        ),
        Point(
            name="bench_carriage_mm_per_s",
            address=61472,
            space="holding",
            type="i32",
            text="Real carriage velocity",
            block="bench",
            words=2,
            unit="mm/s",
        ),
        Point(
            name="bench_commanded_usteps",
            address=61474,
            space="holding",
            type="i32",
            text="Net step pulses received by the stepper",
            block="bench",
            words=2,
            unit="usteps",
        ),
        Point(
            name="bench_slipped_usteps",
            address=61476,
            space="holding",
            type="i32",
            text="Microsteps lost by the stepper, net",
            block="bench",
            words=2,
            unit="usteps",
        ),
        Point(
            name="bench_transitions",
            address=61478,
            space="holding",
            type="i64",
            text="Net A/B transitions of the encoder shaft",
            block="bench",
            words=4,
        ),
        Point(
            name="bench_drum_actual_millirpm",
            address=61482,
            space="holding",
            type="i32",
            text="Real drum speed",
            block="bench",
            words=2,
            unit="millirpm",
        ),
        Point(
            name="bench_profile_points",
            address=61484,
            space="holding",
            type="u16",
            text="Points of the profile in memory",
            block="bench",
        ),
        Point(
            name="bench_profile_running",
            address=61485,
            space="holding",
            type="u16",
            text="1 while the profile is played",
            block="bench",
        ),
        Point(
            name="bench_time_ms",
            address=61486,
            space="holding",
            type="u32",
            text="Plant time",
            block="bench",
            words=2,
            unit="ms",
        ),
        Point(
            name="bench_profile",
            address=61500,
            space="holding",
            type="i32",
            text="Window of 30 profile points: time in ms, drum speed in millirpm, alternating",
            block="bench",
            words=2,
            count=60,
            min=-3000000,
            max=100000000,
            default=0,
            writable=True,
        ),
        Point(
            name="bench_encoder_a_fault",
            address=61620,
            space="holding",
            type="u16",
            text="Fault of encoder channel A",
            block="bench",
            min=0,
            max=3,
            default=0,
            writable=True,
            enum=ChannelFault,
        ),
        Point(
            name="bench_encoder_b_fault",
            address=61621,
            space="holding",
            type="u16",
            text="Fault of encoder channel B",
            block="bench",
            min=0,
            max=3,
            default=0,
            writable=True,
            enum=ChannelFault,
        ),
        Point(
            name="bench_index_pulses",
            address=61622,
            space="holding",
            type="u16",
            text="0: the encoder's index channel is not wired",
            block="bench",
            min=0,
            max=1,
            default=1,
            writable=True,
        ),
        Point(
            name="bench_rope_layer_um",
            address=61623,
            space="holding",
            type="u16",
            text="How much each layer of rope makes the drum thicker (its radius); 0: the drum stays as it is",
            block="bench",
            min=0,
            max=50000,
            default=0,
            unit="um",
            writable=True,
        ),
        Point(
            name="bench_rope_layer_milliturns",
            address=61624,
            space="holding",
            type="u32",
            text="Turns of a layer",
            block="bench",
            words=2,
            min=1,
            max=100000000,
            default=33000,
            unit="1/1000 turn",
            writable=True,
        ),
        Point(
            name="bench_rope_core_um",
            address=61626,
            space="holding",
            type="u32",
            text="Diameter of the bare drum",
            block="bench",
            words=2,
            min=0,
            max=5000000,
            default=0,
            unit="um",
            writable=True,
        ),
        Point(
            name="bench_rope_mm",
            address=61628,
            space="holding",
            type="i32",
            text="Rope that is really on the drum, beginning bare",
            block="bench",
            words=2,
            unit="mm",
        ),
        Point(
            name="bench_switch_late_us",
            address=61630,
            space="holding",
            type="u16",
            text="How late the limit switches trigger and release, before the millisecond that a contact travels",
            block="bench",
            min=0,
            max=20000,
            default=500,
            unit="us",
            writable=True,
        ),
    )
}
