/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The Modbus map of the level wind controller: tables for its master.
 * Generated from modbus_map/registers.yaml by: python3 modbus_map/generate.py
 * Do not edit.
 */
#include "levelwind_map.h"

static const struct levelwind_value state_values[] = {
	{0, "unindexed", "Position unknown. Give the command index"},
	{1, "backing_off", "Indexing: moving off a limit switch that was active at the start"},
	{2, "seeking", "Indexing: moving toward the indexing switch"},
	{3, "index_reversal", "Indexing: switch found, turning round at the reversal point"},
	{4, "span_check", "Indexing: sweeping back to check the other switch"},
	{5, "parking", "Indexing: coming to rest at the parking place"},
	{
		6, "ready",
		"Indexed and at rest. In mode track it follows the drum once that rests; after a stop, write the mode again",
	},
	{7, "tracking", "Following the drum"},
	{
		8, "centring",
		"Moving to the centre, to where the rope goes on, or back into the sweep before a hand-over",
	},
	{
		9, "centred",
		"Held at the centre, the drum is not followed. For a launch set the mode to track",
	},
	{10, "jogging", "Moving by hand"},
	{11, "off", "Stepper without current, position unknown. Set the mode to track, then index"},
	{12, "fault", "Stopped by a fault, see the register fault"},
	{
		13, "reacquiring",
		"Taking up a turning drum after a restart in a launch: on the way to a limit switch, place unknown",
	},
};

static const struct levelwind_value mode_values[] = {
	{0, "off", "Stepper without current. The index is lost"},
	{1, "track", "Follow the drum once indexed"},
	{2, "centre", "Hold the carriage at the centre, for pulling rope out"},
};

static const struct levelwind_value fault_values[] = {
	{0, "none", "No fault"},
	{
		1, "index_no_switch",
		"Indexing: no limit switch within the travel. Is the carriage free, is the stepper powered?",
	},
	{
		2, "index_wrong_switch",
		"Indexing: the opposite switch came first. Check the stepper direction and which switch is which",
	},
	{
		3, "index_span",
		"Indexing: the other switch is not where it was calibrated. Check both switches, then their calibrated positions",
	},
	{
		4, "both_switches_active",
		"Both limit switches, or both overtravel switches, are active at once. Check the switch wiring",
	},
	{
		5, "back_off_no_release",
		"The limit switch did not release although the carriage moved away. Stuck switch, or the stepper does not move",
	},
	{
		6, "wiring_plus",
		"Plus limit switch: contacts contradict each other or both stay open. Broken wire or short",
	},
	{
		7, "wiring_minus",
		"Minus limit switch: contacts contradict each other or both stay open. Broken wire or short",
	},
	{
		8, "overtravel_plus",
		"Plus overtravel switch: stepper disabled, only motion toward minus is allowed. If the carriage is not there, check this switch and its wire",
	},
	{
		9, "overtravel_minus",
		"Minus overtravel switch: stepper disabled, only motion toward plus is allowed. If the carriage is not there, check this switch and its wire",
	},
	{
		10, "overspeed",
		"The drum turned faster than overspeed_trip_edges_per_s, the stepper cannot follow",
	},
	{11, "los_limit", "More losses of synchronization in one launch than los_recoveries_max"},
	{
		12, "stepper_alarm",
		"The stepper driver reports an alarm: steps may be lost. Look at the driver, then index again",
	},
	{
		13, "reacquire_no_switch",
		"Taking up a turning drum: no limit switch within the travel. Is the carriage free, is the stepper powered?",
	},
	{
		14, "reacquire_wrong_switch",
		"Taking up a turning drum: the opposite switch came. Check the stepper direction and which switch is which",
	},
};

static const struct levelwind_value command_values[] = {
	{0, "none", "Nothing"},
	{1, "index", "Find the position (homing). The drum must be at rest"},
	{2, "stop", "Stop every motion now. Always accepted"},
	{
		3, "clear_fault",
		"Acknowledge a fault whose cause is gone; indexing is needed afterwards",
	},
	{4, "apply", "Check the staged parameters as a whole and make them active"},
	{5, "revert", "Drop the staged parameters: staged becomes active again"},
	{6, "save", "Write the active parameters to non-volatile storage"},
	{7, "factory_motion", "Stage the factory values of everything but the line settings"},
	{8, "factory_line", "Stage the factory line settings"},
	{9, "factory_all", "Stage all factory values"},
	{
		10, "try_line",
		"Use the active line settings now; the old ones again if no valid request comes within line_confirm_s",
	},
	{
		11, "acknowledge_rope",
		"Somebody has looked at the rope that was laid while the carriage stood; taken after an indexing only",
	},
	{12, "set_rope", "So much rope is on the drum: set_rope_mm. The drum must be at rest"},
	{
		13, "trim_early",
		"Reverse earlier at the side that the carriage moves toward: by trim_step_um, while tracking",
	},
	{
		14, "trim_late",
		"Reverse later at the side that the carriage moves toward: by trim_step_um, while tracking",
	},
	{
		15, "reacquire",
		"Take up a turning drum from rest, after a restart in a launch: to the first limit switch, then on. The position must be unknown",
	},
	{30, "cam_check", "Check the uploaded cam table as a whole, and keep it"},
	{
		31, "cam_activate",
		"Put the checked cam table in force: at once, or at the end of the cycle if a cam is running",
	},
	{32, "cam_discard", "Drop the queued cam table, or else the upload"},
};

static const struct levelwind_value result_values[] = {
	{0, "none", "No command since power-up"},
	{1, "in_progress", "Accepted, still running"},
	{2, "done", "Done"},
	{3, "refused", "Refused, nothing changed; see command_reason"},
	{4, "failed", "Started but did not succeed; see command_reason and fault"},
};

static const struct levelwind_value reason_values[] = {
	{0, "none", "Not refused"},
	{1, "unknown_function", "This function code is not supported"},
	{2, "unknown_address", "No register or bit at this address"},
	{3, "not_writable", "This register can only be read"},
	{4, "half_of_pair", "A value of two registers must be written whole, in one request"},
	{5, "out_of_range", "The value is outside the limits of this register"},
	{6, "bad_count", "The count is zero or too large for this function"},
	{7, "bad_length", "The request is shorter or longer than its function and count say"},
	{8, "bad_coil_value", "A coil is written with 0x0000 or 0xFF00"},
	{
		9, "several_commands",
		"One request can give one command or jog, and a new trim beside neither a jog nor a trim command: send the other by itself",
	},
	{
		10, "busy_tracking",
		"Refused while tracking: stop, or set the mode to centre with the drum at rest",
	},
	{11, "busy_moving", "Refused while the carriage moves by itself: wait or give stop"},
	{12, "busy_saving", "Refused while parameters are being saved: try again"},
	{13, "drum_moving", "The drum must be at rest for this"},
	{15, "cause_present", "The cause of the fault is still there"},
	{16, "mode_off", "Refused in mode off: set the mode to track or centre first"},
	{17, "overtravel", "Only motion away from the active overtravel switch is allowed"},
	{18, "storage_failed", "The non-volatile storage reported an error"},
	{19, "stopped", "Ended by stop, mode off or a lost input before it was complete"},
	{20, "faulted", "Ended by a fault, see the register fault"},
	{21, "undefined_sub_function", "This sub-function or object is not supported"},
	{
		22, "limit_switch",
		"The limit switch on that side is actuated: without an index only motion away from it is allowed",
	},
	{
		30, "slope_above_one_step",
		"The pitch asks for more than one step per encoder edge: finer encoder edges, fewer microsteps or a smaller pitch",
	},
	{31, "slope_too_small", "The pitch asks for less than 1/65536 step per edge"},
	{
		32, "slope_unreachable",
		"No pair (Ka, Nr) meets pitch and overshoot within slope_tolerance_ppm: allow more tolerance",
	},
	{
		33, "reversals_crossed",
		"reversal_minus must lie at least 2 microsteps below reversal_plus",
	},
	{34, "switch_plus_outside", "switch_plus must lie inside reversal_plus"},
	{35, "switch_minus_outside", "switch_minus must lie inside reversal_minus"},
	{
		36, "switches_crossed",
		"switch_minus must lie below switch_plus by more than twice tolerance plus hysteresis",
	},
	{
		37, "overshoot_beyond_flange_plus",
		"The overshoot past reversal_plus reaches beyond flange_plus",
	},
	{
		38, "overshoot_beyond_flange_minus",
		"The overshoot past reversal_minus reaches beyond flange_minus",
	},
	{
		39, "park_outside",
		"The parking place needs its last reversal (plus overshoot) inside the sweep",
	},
	{40, "centre_outside", "centre_position must lie between the limit switches"},
	{
		41, "ramp_does_not_fit",
		"Two ramps of one overshoot each must fit between the switches, less tolerance and hysteresis",
	},
	{
		42, "position_overflow",
		"A position or the travel is beyond 32700 microsteps: fewer microsteps per revolution or a shorter travel",
	},
	{43, "travel_too_short", "travel must be at least the distance between the flanges"},
	{44, "overspeed_limits_crossed", "overspeed_warning must not be above overspeed_trip"},
	{
		45, "tolerance_beyond_flange",
		"A calibrated switch position plus its tolerance must stay inside the flange",
	},
	{46, "too_few_edges", "The encoder ratio gives less than one edge per drum revolution"},
	{
		47, "debounce_too_long",
		"At overspeed_warning_edges_per_s, or at the index rate, the carriage would pass the reversal point before the switch is debounced (and switch_delay_us is over)",
	},
	{
		48, "breaker_one_cycle",
		"breaker_cycles must be 0 (no ribbon breaker) or at least 2: up and down takes two",
	},
	{49, "core_thinner_than_rope", "The bare drum cannot be thinner than the rope"},
	{50, "packing_too_small", "rope_packing_permille must be 0 (not known) or at least 100"},
	{
		51, "drum_narrower_than_rope",
		"The rope is thicker than the drum is wide between the far points of the reversals",
	},
	{
		52, "switch_delay_too_long",
		"At overspeed_warning_edges_per_s, or at the index rate, the carriage would pass the reversal point before the switch tells (switch_delay_us)",
	},
	{60, "locked", "The write lock is closed: write the code to the register unlock"},
	{61, "wrong_code", "This is not the code of the write lock"},
	{62, "unlock_wait", "After a wrong code: wait before the next try, longer every time"},
	{
		63, "line_not_confirmed",
		"No valid request came at the line settings on trial: the old ones are in use again",
	},
	{64, "unknown_file", "There is no file of this number"},
	{65, "unknown_record", "The file has no record of this number"},
	{66, "bad_reference_type", "The reference type of a group of file records must be 6"},
	{67, "answer_too_long", "The answer would not fit into one frame: ask for fewer records"},
	{70, "cam_too_few_rows", "A cam table needs at least two rows"},
	{71, "cam_too_many_rows", "The cam table has more rows than fit"},
	{72, "cam_first_master", "The first row of a cam table must have master 0"},
	{
		73, "cam_master_not_ascending",
		"The master positions of a cam table must ascend from row to row",
	},
	{
		74, "cam_row_too_short",
		"The way from this cam row to the next is shorter than one encoder edge (in master units)",
	},
	{
		75, "cam_row_too_large",
		"The way from this cam row to the next is too long for exact arithmetic (in master units): put a row between",
	},
	{76, "cam_cycle_too_long", "The cycle of the cam table is too long (in master units)"},
	{
		77, "cam_slope",
		"The way from this cam row to the next asks for too many steps per edge (in steps per 1000 edges, ramps included)",
	},
	{
		78, "cam_step_rate",
		"The way from this cam row to the next asks for too many steps per second at overspeed_trip_edges_per_s",
	},
	{
		79, "cam_wrap",
		"Last minus first slave of the cam table differs from the declared advance (0 if cyclic)",
	},
	{80, "cam_interpolation", "The cam table names an unknown interpolation"},
	{
		81, "cam_crc",
		"The cam table is not the one whose CRC was uploaded with it: upload it again as a whole",
	},
	{82, "cam_beyond_flange", "A position of the cam table is beyond a flange (in microsteps)"},
	{
		83, "cam_no_table",
		"There is no checked cam table for this: upload one and give cam_check",
	},
	{84, "cam_bank_in_use", "This cam bank is in force or queued: upload into the other one"},
	{
		85, "cam_queued",
		"A cam table is queued: wait for the end of the cycle, or give cam_discard",
	},
	{
		86, "cam_does_not_join",
		"The new cam table must begin at the slave position where the one in force begins (cam_start other than relative)",
	},
	{
		87, "cam_free_axis",
		"A free axis has no position to begin at: cam_start must be relative",
	},
	{
		88, "cam_advances",
		"A cam table that advances leaves the flanges behind: it needs cam_axis free",
	},
	{
		90, "encoder_doubtful",
		"One encoder channel changes and the other one does not follow: the drum may be turning. Wait until it rests; if it rests, look at the encoder and its wires",
	},
	{91, "drum_running", "The master says that the drum turns: write drum_running 0 first"},
	{
		96, "rope_index_first",
		"Look at the rope and index first: rope laid while the carriage stood is acknowledged after an indexing",
	},
	{
		97, "rope_not_described",
		"Metres of rope need rope_diameter_um, drum_core_diameter_um and rope_packing_permille: set them, apply, then set_rope",
	},
	{
		98, "rope_length_missing",
		"Write set_rope_mm first: so many millimetres of rope are on the drum",
	},
	{
		99, "rope_too_long",
		"So much rope does not go onto this drum: check set_rope_mm, drum_core_diameter_um and rope_packing_permille",
	},
	{
		100, "trim_not_following",
		"Only a carriage that follows the drum by the reversing screw has a reversal to make earlier or later",
	},
	{101, "drum_at_rest", "The drum must turn for this; at rest give index"},
	{
		102, "position_known",
		"The position is known: write mode track, and the drum is followed once it rests",
	},
	{103, "fault_stands", "A fault stands: remove its cause, then clear_fault first"},
	{104, "not_mode_track", "Only in mode track with motion_profile screw"},
};

static const struct levelwind_value host_values[] = {
	{1, "simulator", "POSIX simulator"},
	{2, "native_sim", "Zephyr native_sim"},
	{3, "qemu", "Zephyr in QEMU"},
	{4, "hardware", "Zephyr on hardware"},
};

static const struct levelwind_value switch_contacts_values[] = {
	{
		0, "no_nc_pair",
		"Change-over switch, both contacts wired: no debounce delay, broken wires are found",
	},
	{1, "single_no", "One normally open contact"},
	{2, "single_nc", "One normally closed contact"},
};

static const struct levelwind_value side_values[] = {
	{0, "plus", "Plus side"},
	{1, "minus", "Minus side"},
};

static const struct levelwind_value park_at_values[] = {
	{0, "flange", "At the far point of the reversal opposite to the indexing switch"},
	{1, "position", "At park_position_um"},
};

static const struct levelwind_value line_format_values[] = {
	{0, "8E1", "8 data bits, even parity, 1 stop bit (the standard's default)"},
	{1, "8O1", "8 data bits, odd parity, 1 stop bit"},
	{2, "8N1", "8 data bits, no parity, 1 stop bit"},
	{3, "8N2", "8 data bits, no parity, 2 stop bits"},
};

static const struct levelwind_value slot_state_values[] = {
	{0, "empty", "Never written, or erased"},
	{1, "good", "An intact record of this firmware"},
	{2, "older", "An intact record of an older schema, converted when it was loaded"},
	{
		3, "newer",
		"An intact record of newer firmware that this one cannot read. It is kept until two more SAVEs",
	},
	{4, "damaged", "Cut short or changed: not used"},
	{5, "refused", "An intact parameter set that this firmware does not accept: not used"},
};

static const struct levelwind_value encoder_fault_values[] = {
	{0, "none", "Nothing"},
	{1, "a_still", "Channel A stands still while channel B changes"},
	{2, "b_still", "Channel B stands still while channel A changes"},
	{
		3, "a_flickers",
		"Channel A does not follow channel B: a loose wire, or a drum that chatters",
	},
	{
		4, "b_flickers",
		"Channel B does not follow channel A: a loose wire, or a drum that chatters",
	},
	{5, "illegal", "Both channels change at once more often than encoder_illegal_permille"},
	{6, "index_misfit", "The index pulses do not fit the edges: edges are lost, or too many"},
	{
		7, "no_edges",
		"The master says that the drum turns (drum_running), and no edge came for drum_watch_ms",
	},
};

static const struct levelwind_value motion_profile_values[] = {
	{0, "screw", "The reversing screw: level winding"},
	{1, "cam", "The active cam table"},
};

static const struct levelwind_value cam_start_values[] = {
	{
		0, "absolute",
		"The carriage goes to the slave position of the odometer's place in the cycle, then follows",
	},
	{1, "relative", "The cycle begins here and now, the slave position where the carriage is"},
	{
		2, "next_cycle",
		"The carriage goes to the table's first slave position and follows from the odometer's next begin of a cycle",
	},
};

static const struct levelwind_value cam_axis_values[] = {
	{0, "carriage", "The carriage, between the flanges"},
	{
		1, "free",
		"An axis without ends; a table may advance. Its position is 0 wherever it is left",
	},
};

static const struct levelwind_value cam_bank_state_values[] = {
	{0, "empty", "Nothing"},
	{1, "loading", "Parts of an upload; give cam_check when it is complete"},
	{2, "ready", "A checked table that is not in force"},
	{3, "queued", "A checked table that waits for the end of the cycle"},
	{4, "active", "The table in force"},
};

static const struct levelwind_value cam_interpolation_values[] = {
	{0, "linear", "Straight, at one gear ratio"},
	{1, "trapezoid", "At rest in every row: ramp up, plateau, ramp down"},
};

static const struct levelwind_value flags_values[] = {
	{0, "indexed", "The position is known"},
	{1, "tracking", "The carriage follows the drum"},
	{2, "launch_permit", "A launch may begin; see launch_inhibit if not"},
	{3, "moving", "The carriage moves by itself (indexing, centring, jogging)"},
	{4, "drum_at_rest", "The drum is slower than rest_edges_per_s for rest_time_ms"},
	{5, "faulted", "Stopped by a fault"},
	{
		6, "los",
		"Any loss of synchronization since the last indexing, also before a power cut: the rope may be laid wrong",
	},
	{
		7, "los1_plus",
		"LOS type 1+: reversal at plus entered, its switch did not trigger on the way",
	},
	{
		8, "los1_minus",
		"LOS type 1-: reversal at minus entered, its switch did not trigger on the way",
	},
	{
		9, "los2_plus",
		"LOS type 2+: plus switch triggered outside its tolerance, or memory had changed the law",
	},
	{
		10, "los2_minus",
		"LOS type 2-: minus switch triggered outside its tolerance, or memory had changed the law",
	},
	{11, "switch_plus", "Plus limit switch actuated (debounced)"},
	{12, "switch_minus", "Minus limit switch actuated (debounced)"},
	{13, "wiring_plus", "Plus limit switch wiring fault"},
	{14, "wiring_minus", "Minus limit switch wiring fault"},
	{15, "overtravel_plus", "Plus overtravel switch actuated"},
	{16, "overtravel_minus", "Minus overtravel switch actuated"},
	{17, "overspeed_warning", "The drum is faster than overspeed_warning_edges_per_s"},
	{
		18, "overspeed_trip",
		"The drum was faster than overspeed_trip_edges_per_s (sticky until clear_fault)",
	},
	{19, "master_lost", "No valid request for master_timeout_ms"},
	{20, "staged", "Staged parameters differ from the active ones: APPLY or REVERT"},
	{21, "dirty", "Active parameters differ from the stored ones: SAVE to keep them"},
	{
		22, "defaults_loaded",
		"No usable stored set was found at power-up: it began with the factory values, and nothing is stored until a SAVE",
	},
	{23, "trim_pending", "A trim waits for the carriage to be in the sweep"},
	{24, "correction_pending", "A re-index correction waits for the end of the reversal"},
	{25, "stepper_enabled", "The stepper has current"},
	{
		26, "restart_needed",
		"The active line settings differ from those in use: SAVE and restart",
	},
	{27, "held", "Stopped by command: write the mode, or index, to go on"},
	{28, "locked", "The write lock is closed: parameters cannot be changed"},
	{
		29, "line_trial",
		"Line settings are on trial: any valid request to this unit confirms them",
	},
	{
		30, "watchdog_reset",
		"The last restart was made by the watchdog, or after a fault of the processor: a part of the firmware had stopped",
	},
	{31, "cam_queued", "A cam table waits for the end of the cycle"},
};

static const struct levelwind_value launch_inhibit_values[] = {
	{0, "not_tracking", "The carriage does not follow the drum: the state says what to do"},
	{1, "los", "Synchronization was lost: look at the rope first, then index"},
	{2, "fault", "A fault stands: remove its cause, then index"},
	{3, "wiring", "A limit switch has a wiring fault: mend it, then clear_fault"},
	{
		4, "overtravel",
		"An overtravel switch is actuated: index moves the carriage off it, or check the switch and its wire",
	},
	{5, "overspeed", "The drum tripped the overspeed limit: stop it, then index"},
	{6, "master_lost", "The Modbus master is silent: check the panel or PLC and its line"},
	{
		7, "correction",
		"A re-index correction waits for the sweep: turn the drum slowly until it is made, or index",
	},
	{8, "stepper_alarm", "The stepper driver reports an alarm: look at the driver, then index"},
	{
		9, "cam",
		"The motion profile is cam and its table cannot be followed, see cam_reason: upload another, or set motion_profile to screw",
	},
	{
		10, "set_unconfirmed",
		"The factory values are in force, which describe another winch: set the parameters of this one, apply and save",
	},
	{
		11, "rope_laid_standing",
		"Rope was laid while the carriage stood: look at the rope, index, then acknowledge_rope",
	},
	{
		12, "switch_implausible",
		"A limit switch says what the known position makes impossible: look at both switches and their wires, then index",
	},
	{
		13, "encoder",
		"The encoder's signals do not fit the drum, or did not since the last indexing: rest the drum, check the encoder and its wires, look at the rope, then index",
	},
};

static const struct levelwind_value flags_2_values[] = {
	{
		0, "set_unconfirmed",
		"Real hardware with factory values that nobody has saved: they describe another winch",
	},
	{
		1, "rope_laid_standing",
		"Rope was laid while the carriage stood, also before a power cut: look at it, index, then acknowledge_rope",
	},
	{
		2, "odometer_doubtful",
		"The drum turned while the storage was written, so edges may be missing in rope_mm and net_edges (until an indexing)",
	},
	{
		3, "switch_implausible",
		"A limit switch says what the known position makes impossible: broken wire, stuck or moved switch",
	},
	{
		4, "encoder_doubtful",
		"One encoder channel changes without the other: the drum may turn unseen. Not sticky",
	},
	{
		5, "encoder_fault",
		"The encoder does not tell the drum's motion: a loss of synchronization, sticky until an indexing has succeeded",
	},
	{
		6, "clock_fallback",
		"The external clock of the processor is missing: it runs by its internal oscillator, which may be a few percent off",
	},
	{
		7, "line_babble",
		"Within the last 10 s bytes came on the line without a silence for more than a second",
	},
	{
		8, "line_echo",
		"Within the last 10 s the line gave back what was sent on it; that was dropped",
	},
	{
		9, "rope_doubtful",
		"The metres of rope on the drum may be wrong: not told since the power-up, or edges were lost. Give set_rope where they are known",
	},
	{
		10, "resume_doubtful",
		"The drum may have turned since it was kept where the rope goes on, or the carriage stood elsewhere: not gone to. Look where the rope leaves the drum",
	},
	{
		11, "reacquired",
		"After a restart in a launch a turning drum was taken up at an unknown place: a loss of synchronization, until an indexing has succeeded",
	},
	{
		12, "not_accepted",
		"Nobody has accepted the parameter set that is active (levelwind commission). No launch is refused for it",
	},
};

static const int32_t allowed_command[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 30, 31, 32};
static const int32_t allowed_encoder_edges_per_pulse[] = {1, 2, 4};
static const int32_t allowed_baud_rate[] = {1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200};

const struct levelwind_point levelwind_points[LEVELWIND_POINT_COUNT] = {
	{
		.name = "command", .unit = "",
		.text = "Writing a code runs the command; reads the last one",
		.block = LEVELWIND_BLOCK_SETPOINTS, .type = LEVELWIND_TYPE_U16, .address = 0,
		.words = 1, .min = 0, .max = 32, .default_value = 0, .allowed = allowed_command,
		.allowed_count = 19, .values = command_values, .value_count = 19,
	},
	{
		.name = "mode", .unit = "",
		.text = "Requested mode, taken over when the drum is at rest (off: at once)",
		.block = LEVELWIND_BLOCK_SETPOINTS, .type = LEVELWIND_TYPE_U16, .address = 1,
		.words = 1, .min = 0, .max = 2, .default_value = 1, .values = mode_values,
		.value_count = 3,
	},
	{
		.name = "jog", .unit = "",
		.text = "Held jog: -1, 0 or +1; write again within jog_hold_ms or it stops",
		.block = LEVELWIND_BLOCK_SETPOINTS, .type = LEVELWIND_TYPE_I16, .address = 2,
		.words = 1, .min = -1, .max = 1, .default_value = 0,
	},
	{
		.name = "trim_plus_um", .unit = "um",
		.text = "Live shift of reversal_plus, applied in the sweep only",
		.block = LEVELWIND_BLOCK_SETPOINTS, .type = LEVELWIND_TYPE_I16, .address = 3,
		.words = 1, .min = -20000, .max = 20000, .default_value = 0,
	},
	{
		.name = "trim_minus_um", .unit = "um",
		.text = "Live shift of reversal_minus, applied in the sweep only",
		.block = LEVELWIND_BLOCK_SETPOINTS, .type = LEVELWIND_TYPE_I16, .address = 4,
		.words = 1, .min = -20000, .max = 20000, .default_value = 0,
	},
	{
		.name = "drum_running", .unit = "",
		.text = "1: the master says that the winch turns the drum; see drum_watch_ms",
		.block = LEVELWIND_BLOCK_SETPOINTS, .type = LEVELWIND_TYPE_U16, .address = 5,
		.words = 1, .min = 0, .max = 1, .default_value = 0,
	},
	{
		.name = "set_rope_mm", .unit = "mm",
		.text = "What the command set_rope tells: so much rope is on the drum; -1: nothing was written",
		.block = LEVELWIND_BLOCK_SETPOINTS, .type = LEVELWIND_TYPE_I32, .address = 6,
		.words = 2, .min = -1, .max = 10000000, .default_value = -1,
	},
	{
		.name = "unlock", .unit = "",
		.text = "Writing lock_code opens the write lock for lock_timeout_s, writing 0 closes it; reads 0",
		.block = LEVELWIND_BLOCK_SETPOINTS, .type = LEVELWIND_TYPE_U32, .address = 10,
		.words = 2, .min = 0, .max = 999999, .default_value = 0,
	},
	{
		.name = "cam_phase_edges", .unit = "edges",
		.text = "Live shift of the cam's master, one edge per edge until it is reached",
		.block = LEVELWIND_BLOCK_SETPOINTS, .type = LEVELWIND_TYPE_I32, .address = 630,
		.words = 2, .min = -100000000, .max = 100000000, .default_value = 0,
	},
	{
		.name = "encoder_pulses_per_rev", .unit = "pulses",
		.text = "Encoder pulses per revolution of its shaft",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 100,
		.words = 1, .min = 1, .max = 10000, .default_value = 360,
	},
	{
		.name = "encoder_edges_per_pulse", .unit = "edges", .text = "Edges used per pulse",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 101,
		.words = 1, .min = 1, .max = 4, .default_value = 2,
		.allowed = allowed_encoder_edges_per_pulse, .allowed_count = 3,
	},
	{
		.name = "encoder_ratio_numerator", .unit = "",
		.text = "Encoder revolutions per drum revolution, numerator",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 102,
		.words = 1, .min = 1, .max = 100, .default_value = 4,
	},
	{
		.name = "encoder_ratio_denominator", .unit = "",
		.text = "Encoder revolutions per drum revolution, denominator",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 103,
		.words = 1, .min = 1, .max = 1000, .default_value = 1,
	},
	{
		.name = "encoder_invert_a", .unit = "", .text = "1 inverts encoder channel A",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 104,
		.words = 1, .min = 0, .max = 1, .default_value = 0,
	},
	{
		.name = "encoder_invert_b", .unit = "", .text = "1 inverts encoder channel B",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 105,
		.words = 1, .min = 0, .max = 1, .default_value = 0,
	},
	{
		.name = "drum_direction_invert", .unit = "",
		.text = "1 swaps the sign of drum motion; hauling rope in must count positive",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 106,
		.words = 1, .min = 0, .max = 1, .default_value = 0,
	},
	{
		.name = "rope_per_drum_rev_um", .unit = "um",
		.text = "Rope hauled in per drum revolution, for the odometer",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U32, .address = 107,
		.words = 2, .min = 1000, .max = 20000000, .default_value = 2400000,
	},
	{
		.name = "screw_lead_um", .unit = "um",
		.text = "Carriage travel per screw revolution", .block = LEVELWIND_BLOCK_PARAMETERS,
		.type = LEVELWIND_TYPE_U32, .address = 110, .words = 2, .min = 500, .max = 100000,
		.default_value = 20000,
	},
	{
		.name = "microsteps_per_rev", .unit = "usteps",
		.text = "Microsteps per stepper revolution, as set at the stepper driver",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 112,
		.words = 1, .min = 200, .max = 51200, .default_value = 2000,
	},
	{
		.name = "carriage_direction_invert", .unit = "",
		.text = "1 inverts the stepper's direction output",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 113,
		.words = 1, .min = 0, .max = 1, .default_value = 0,
	},
	{
		.name = "pitch_um", .unit = "um", .text = "Carriage travel per drum revolution",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U32, .address = 114,
		.words = 2, .min = 10, .max = 100000, .default_value = 12000,
	},
	{
		.name = "overshoot_um", .unit = "um",
		.text = "How far a reversal runs past the reversal point",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U32, .address = 116,
		.words = 2, .min = 1, .max = 50000, .default_value = 2500,
	},
	{
		.name = "slope_tolerance_ppm", .unit = "ppm",
		.text = "How far the pitch may be off to meet the overshoot",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 118,
		.words = 1, .min = 1, .max = 50000, .default_value = 500,
	},
	{
		.name = "reversal_plus_um", .unit = "um",
		.text = "Where the reversal at the plus side begins",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_I32, .address = 120,
		.words = 2, .min = -500000, .max = 500000, .default_value = 80000,
	},
	{
		.name = "reversal_minus_um", .unit = "um",
		.text = "Where the reversal at the minus side begins",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_I32, .address = 122,
		.words = 2, .min = -500000, .max = 500000, .default_value = -80000,
	},
	{
		.name = "flange_plus_um", .unit = "um",
		.text = "Farthest place on the plus side that the carriage may be commanded to",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_I32, .address = 124,
		.words = 2, .min = -500000, .max = 500000, .default_value = 83000,
	},
	{
		.name = "flange_minus_um", .unit = "um",
		.text = "Farthest place on the minus side that the carriage may be commanded to",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_I32, .address = 126,
		.words = 2, .min = -500000, .max = 500000, .default_value = -83000,
	},
	{
		.name = "switch_plus_um", .unit = "um",
		.text = "Calibrated trigger position of the plus limit switch",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_I32, .address = 128,
		.words = 2, .min = -500000, .max = 500000, .default_value = 78400,
	},
	{
		.name = "switch_minus_um", .unit = "um",
		.text = "Calibrated trigger position of the minus limit switch",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_I32, .address = 130,
		.words = 2, .min = -500000, .max = 500000, .default_value = -78400,
	},
	{
		.name = "switch_tolerance_um", .unit = "um",
		.text = "A trigger further than this from its calibrated position is a LOS of type 2",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 132,
		.words = 1, .min = 10, .max = 20000, .default_value = 1000,
	},
	{
		.name = "switch_hysteresis_um", .unit = "um",
		.text = "Within this distance inward of its trigger point a switch has surely released",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 133,
		.words = 1, .min = 10, .max = 20000, .default_value = 1500,
	},
	{
		.name = "switch_contacts", .unit = "", .text = "How the limit switches are wired",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 134,
		.words = 1, .min = 0, .max = 2, .default_value = 0,
		.values = switch_contacts_values, .value_count = 3,
	},
	{
		.name = "switch_transit_ms", .unit = "ms",
		.text = "Both contacts of a pair open, or a single contact not at rest, for longer than this is a wiring fault",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 135,
		.words = 1, .min = 1, .max = 90, .default_value = 20,
	},
	{
		.name = "switch_debounce_ms", .unit = "ms",
		.text = "Debounce time of a single contact", .block = LEVELWIND_BLOCK_PARAMETERS,
		.type = LEVELWIND_TYPE_U16, .address = 136, .words = 1, .min = 1, .max = 100,
		.default_value = 5,
	},
	{
		.name = "travel_um", .unit = "um",
		.text = "Carriage travel between the mechanical end stops",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U32, .address = 137,
		.words = 2, .min = 1000, .max = 600000, .default_value = 180000,
	},
	{
		.name = "switch_delay_us", .unit = "us",
		.text = "How late a limit switch tells that it was reached; `levelwind index --rates` measures it (0: at once)",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 139,
		.words = 1, .min = 0, .max = 20000, .default_value = 0,
	},
	{
		.name = "index_switch", .unit = "",
		.text = "Which limit switch is the indexing switch",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 140,
		.words = 1, .min = 0, .max = 1, .default_value = 0, .values = side_values,
		.value_count = 2,
	},
	{
		.name = "index_rate_edges_per_s", .unit = "edges/s",
		.text = "Rate of the simulated edges for indexing and centring",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 141,
		.words = 1, .min = 100, .max = 50000, .default_value = 10000,
	},
	{
		.name = "park_at", .unit = "", .text = "Where indexing ends",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 142,
		.words = 1, .min = 0, .max = 1, .default_value = 0, .values = park_at_values,
		.value_count = 2,
	},
	{
		.name = "park_position_um", .unit = "um",
		.text = "Parking place if park_at is position", .block = LEVELWIND_BLOCK_PARAMETERS,
		.type = LEVELWIND_TYPE_I32, .address = 143, .words = 2, .min = -500000,
		.max = 500000, .default_value = 0,
	},
	{
		.name = "span_tolerance_um", .unit = "um",
		.text = "Indexing: how far the other switch may be from its calibrated position",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 145,
		.words = 1, .min = 10, .max = 20000, .default_value = 1000,
	},
	{
		.name = "handover_direction", .unit = "",
		.text = "Carriage direction on hand-over from a parking position or the centre, drum hauling in",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 146,
		.words = 1, .min = 0, .max = 1, .default_value = 0, .values = side_values,
		.value_count = 2,
	},
	{
		.name = "rest_edges_per_s", .unit = "edges/s",
		.text = "The drum counts as at rest below this rate",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 147,
		.words = 1, .min = 1, .max = 5000, .default_value = 50,
	},
	{
		.name = "rest_time_ms", .unit = "ms",
		.text = "The drum counts as at rest after this time below rest_edges_per_s",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 148,
		.words = 1, .min = 10, .max = 10000, .default_value = 200,
	},
	{
		.name = "centre_position_um", .unit = "um",
		.text = "Where mode centre holds the carriage", .block = LEVELWIND_BLOCK_PARAMETERS,
		.type = LEVELWIND_TYPE_I32, .address = 149, .words = 2, .min = -500000,
		.max = 500000, .default_value = 0,
	},
	{
		.name = "jog_rate_edges_per_s", .unit = "edges/s",
		.text = "Rate of the simulated edges for jogging",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 151,
		.words = 1, .min = 100, .max = 50000, .default_value = 5000,
	},
	{
		.name = "jog_hold_ms", .unit = "ms",
		.text = "A jog stops when it is not written again within this time",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 152,
		.words = 1, .min = 50, .max = 5000, .default_value = 500,
	},
	{
		.name = "los_recoveries_max", .unit = "",
		.text = "Stop after more LOS recoveries than this in one launch (0: never stop)",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 160,
		.words = 1, .min = 0, .max = 1000, .default_value = 3,
	},
	{
		.name = "overspeed_warning_edges_per_s", .unit = "edges/s",
		.text = "Drum speed that sets the flag overspeed_warning",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U32, .address = 161,
		.words = 2, .min = 100, .max = 1000000, .default_value = 52000,
	},
	{
		.name = "overspeed_trip_edges_per_s", .unit = "edges/s",
		.text = "Drum speed that stops the controller", .block = LEVELWIND_BLOCK_PARAMETERS,
		.type = LEVELWIND_TYPE_U32, .address = 163, .words = 2, .min = 100, .max = 1000000,
		.default_value = 60000,
	},
	{
		.name = "master_timeout_ms", .unit = "ms",
		.text = "Without a valid request for this long the launch permit drops (0: not watched)",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 165,
		.words = 1, .min = 0, .max = 60000, .default_value = 0,
	},
	{
		.name = "dwell_plus_millirev", .unit = "1/1000 drum rev",
		.text = "Dwell at the far point of the plus reversal",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 166,
		.words = 1, .min = 0, .max = 10000, .default_value = 0,
	},
	{
		.name = "dwell_minus_millirev", .unit = "1/1000 drum rev",
		.text = "Dwell at the far point of the minus reversal",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 167,
		.words = 1, .min = 0, .max = 10000, .default_value = 0,
	},
	{
		.name = "breaker_millirev", .unit = "1/1000 drum rev",
		.text = "Ribbon breaker: both dwells grow by up to this much and shrink again, from reversal to reversal of their side",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 168,
		.words = 1, .min = 0, .max = 2000, .default_value = 0,
	},
	{
		.name = "breaker_cycles", .unit = "",
		.text = "Ribbon breaker: it goes up and down once in so many double traverses (0: off)",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 169,
		.words = 1, .min = 0, .max = 200, .default_value = 0,
	},
	{
		.name = "expert_mode", .unit = "",
		.text = "1: the four raw_ values replace pitch, overshoot and reversal points",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 170,
		.words = 1, .min = 0, .max = 1, .default_value = 0,
	},
	{
		.name = "raw_ka", .unit = "usteps/65536",
		.text = "Slope change per edge in a reversal", .block = LEVELWIND_BLOCK_PARAMETERS,
		.type = LEVELWIND_TYPE_U16, .address = 171, .words = 1, .min = 1, .max = 65535,
		.default_value = 23,
	},
	{
		.name = "raw_nr", .unit = "edges",
		.text = "Edges from sweep slope to zero slope; Ks = Ka * Nr",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 172,
		.words = 1, .min = 1, .max = 65535, .default_value = 1187,
	},
	{
		.name = "raw_reversal_plus_usteps", .unit = "usteps", .text = "L+",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_I16, .address = 173,
		.words = 1, .min = -32000, .max = 32000, .default_value = 8000,
	},
	{
		.name = "raw_reversal_minus_usteps", .unit = "usteps", .text = "L-",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_I16, .address = 174,
		.words = 1, .min = -32000, .max = 32000, .default_value = -8000,
	},
	{
		.name = "unit_id", .unit = "",
		.text = "Modbus unit id, effective after APPLY, SAVE and restart",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 180,
		.words = 1, .min = 1, .max = 247, .default_value = 1,
	},
	{
		.name = "baud_rate", .unit = "baud",
		.text = "Line speed, effective after APPLY, SAVE and restart",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U32, .address = 181,
		.words = 2, .min = 1200, .max = 115200, .default_value = 19200,
		.allowed = allowed_baud_rate, .allowed_count = 8,
	},
	{
		.name = "line_format", .unit = "",
		.text = "Data bits, parity, stop bits, effective after APPLY, SAVE and restart",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 183,
		.words = 1, .min = 0, .max = 3, .default_value = 0, .values = line_format_values,
		.value_count = 4,
	},
	{
		.name = "lock_code", .unit = "",
		.text = "Code of the write lock, 0: no lock. Reads 1000000 if there is a code; writing 1000000 keeps it",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U32, .address = 184,
		.words = 2, .min = 0, .max = 1000000, .default_value = 0,
	},
	{
		.name = "lock_timeout_s", .unit = "s",
		.text = "The write lock closes by itself this long after it was opened",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 186,
		.words = 1, .min = 10, .max = 3600, .default_value = 300,
	},
	{
		.name = "line_confirm_s", .unit = "s",
		.text = "How long try_line waits for a valid request",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 187,
		.words = 1, .min = 2, .max = 120, .default_value = 10,
	},
	{
		.name = "encoder_watch_transitions_per_s", .unit = "transitions/s",
		.text = "One encoder channel that changes faster than this without the other makes the encoder doubtful",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U32, .address = 190,
		.words = 2, .min = 100, .max = 1000000, .default_value = 2000,
	},
	{
		.name = "encoder_watch_ms", .unit = "ms",
		.text = "An encoder that is doubtful for this long has a fault",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 192,
		.words = 1, .min = 50, .max = 60000, .default_value = 500,
	},
	{
		.name = "encoder_illegal_permille", .unit = "1/1000",
		.text = "Of 1000 transitions so many may change both channels at once, before the encoder has a fault (1000: any)",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 193,
		.words = 1, .min = 1, .max = 1000, .default_value = 10,
	},
	{
		.name = "drum_watch_ms", .unit = "ms",
		.text = "No edge for this long while drum_running is 1: the encoder has a fault (0: not watched)",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 194,
		.words = 1, .min = 0, .max = 60000, .default_value = 0,
	},
	{
		.name = "standing_turns_permille", .unit = "1/1000 drum rev",
		.text = "Rope hauled in while the carriage stands sets rope_laid_standing from so many drum turns on (0: not watched)",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 199,
		.words = 1, .min = 0, .max = 10000, .default_value = 250,
	},
	{
		.name = "rope_diameter_um", .unit = "um",
		.text = "Diameter of the rope (0: not known)", .block = LEVELWIND_BLOCK_PARAMETERS,
		.type = LEVELWIND_TYPE_U16, .address = 200, .words = 1, .min = 0, .max = 50000,
		.default_value = 0,
	},
	{
		.name = "drum_core_diameter_um", .unit = "um",
		.text = "Diameter of the bare drum (0: not known). With rope_diameter_um and rope_packing_permille, metres of rope follow the growing layers",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U32, .address = 201,
		.words = 2, .min = 0, .max = 5000000, .default_value = 0,
	},
	{
		.name = "rope_packing_permille", .unit = "1/1000",
		.text = "How much of the room on the drum the rope fills, fitted from two known lengths; about 600 to 900 (0: not known)",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 203,
		.words = 1, .min = 0, .max = 1000, .default_value = 0,
	},
	{
		.name = "trim_step_um", .unit = "um",
		.text = "How far trim_early and trim_late shift a reversal point",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 204,
		.words = 1, .min = 1, .max = 5000, .default_value = 500,
	},
	{
		.name = "resume", .unit = "",
		.text = "1: where the drum came to rest is kept, also over a power-off, and after an indexing the carriage first goes there and takes up direction and slope; 0: it begins where the indexing ends",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 205,
		.words = 1, .min = 0, .max = 1, .default_value = 0,
	},
	{
		.name = "reacquire_after_restart", .unit = "",
		.text = "1: where the controller has restarted in a launch (memory kept, the drum still turns), it gives reacquire by itself. THE CARRIAGE MOVES UNASKED",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 206,
		.words = 1, .min = 0, .max = 1, .default_value = 0,
	},
	{
		.name = "accepted_crc", .unit = "",
		.text = "The set that somebody has accepted: active_crc as it was then, written by `levelwind commission` (0: none)",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U32, .address = 207,
		.words = 2, .min = 0, .max = 1073741823, .default_value = 0,
	},
	{
		.name = "motion_profile", .unit = "",
		.text = "What the carriage follows the drum by",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 600,
		.words = 1, .min = 0, .max = 1, .default_value = 0, .values = motion_profile_values,
		.value_count = 2,
	},
	{
		.name = "cam_start", .unit = "", .text = "How a cam begins at a hand-over",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 601,
		.words = 1, .min = 0, .max = 2, .default_value = 0, .values = cam_start_values,
		.value_count = 3,
	},
	{
		.name = "cam_master_edges", .unit = "edges",
		.text = "So many encoder edges are cam_master_units of a cam table's master column",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 602,
		.words = 1, .min = 1, .max = 10000, .default_value = 1,
	},
	{
		.name = "cam_master_units", .unit = "", .text = "See cam_master_edges",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 603,
		.words = 1, .min = 1, .max = 10000, .default_value = 1,
	},
	{
		.name = "cam_slave_usteps", .unit = "usteps",
		.text = "So many microsteps are cam_slave_units of a cam table's slave column",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 604,
		.words = 1, .min = 1, .max = 10000, .default_value = 1,
	},
	{
		.name = "cam_slave_units", .unit = "", .text = "See cam_slave_usteps",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 605,
		.words = 1, .min = 1, .max = 10000, .default_value = 1,
	},
	{
		.name = "cam_ramp_divisor", .unit = "",
		.text = "Trapezoid rows: each ramp is this part of its row",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 606,
		.words = 1, .min = 2, .max = 100, .default_value = 10,
	},
	{
		.name = "cam_axis", .unit = "", .text = "What a cam moves",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U16, .address = 607,
		.words = 1, .min = 0, .max = 1, .default_value = 0, .values = cam_axis_values,
		.value_count = 2,
	},
	{
		.name = "cam_steps_per_s_max", .unit = "usteps/s",
		.text = "Fastest step pulses that the stepper driver and the motor follow; a cam table may ask for no more at overspeed_trip_edges_per_s",
		.block = LEVELWIND_BLOCK_PARAMETERS, .type = LEVELWIND_TYPE_U32, .address = 608,
		.words = 2, .min = 1000, .max = 4000000, .default_value = 200000,
	},
	{
		.name = "self_test", .unit = "",
		.text = "Always 0x12345678: the master's word order is right when it reads so",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 0,
		.words = 2, .offset = offsetof(struct levelwind_status, self_test),
	},
	{
		.name = "map_version", .unit = "", .text = "Version of this map",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 2,
		.words = 1, .offset = offsetof(struct levelwind_status, map_version),
	},
	{
		.name = "version_major", .unit = "", .text = "Firmware version, major",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 3,
		.words = 1, .offset = offsetof(struct levelwind_status, version_major),
	},
	{
		.name = "version_minor", .unit = "", .text = "Firmware version, minor",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 4,
		.words = 1, .offset = offsetof(struct levelwind_status, version_minor),
	},
	{
		.name = "version_patch", .unit = "", .text = "Firmware version, patch",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 5,
		.words = 1, .offset = offsetof(struct levelwind_status, version_patch),
	},
	{
		.name = "host", .unit = "", .text = "What runs the core",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 6,
		.words = 1, .offset = offsetof(struct levelwind_status, host),
		.values = host_values, .value_count = 4,
	},
	{
		.name = "image_hash_high", .unit = "",
		.text = "What runs: bytes 0 to 3 of the SHA-256 of zephyr.bin, worked out over the flash at power-up (0, and so the low half: not known, as on the simulators)",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 7,
		.words = 2, .offset = offsetof(struct levelwind_status, image_hash_high),
	},
	{
		.name = "image_hash_low", .unit = "", .text = "Bytes 4 to 7 of it",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 9,
		.words = 2, .offset = offsetof(struct levelwind_status, image_hash_low),
	},
	{
		.name = "state", .unit = "", .text = "What the controller is doing",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 100,
		.words = 1, .offset = offsetof(struct levelwind_status, state),
		.values = state_values, .value_count = 14,
	},
	{
		.name = "active_mode", .unit = "",
		.text = "Mode in force (the requested one waits for the drum to rest)",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 101,
		.words = 1, .offset = offsetof(struct levelwind_status, active_mode),
		.values = mode_values, .value_count = 3,
	},
	{
		.name = "fault", .unit = "", .text = "Why the controller stopped",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 102,
		.words = 1, .offset = offsetof(struct levelwind_status, fault),
		.values = fault_values, .value_count = 15,
	},
	{
		.name = "flags", .unit = "",
		.text = "The first 32 discrete inputs, bit number = discrete input address",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 103,
		.words = 2, .offset = offsetof(struct levelwind_status, flags),
		.values = flags_values, .value_count = 32,
	},
	{
		.name = "launch_inhibit", .unit = "",
		.text = "Why a launch is not permitted; 0 means launch permit",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 105,
		.words = 1, .offset = offsetof(struct levelwind_status, launch_inhibit),
		.values = launch_inhibit_values, .value_count = 14,
	},
	{
		.name = "position_um", .unit = "um", .text = "Carriage position",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 106,
		.words = 2, .offset = offsetof(struct levelwind_status, position_um),
	},
	{
		.name = "position_usteps", .unit = "usteps",
		.text = "Carriage position, whole microsteps; a free axis goes on modulo 65536",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I16, .address = 108,
		.words = 1, .offset = offsetof(struct levelwind_status, position_usteps),
	},
	{
		.name = "m", .unit = "usteps/65536", .text = "Carriage position, Q16.16",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 109,
		.words = 2, .offset = offsetof(struct levelwind_status, m),
	},
	{
		.name = "u", .unit = "usteps/65536",
		.text = "Slope: microsteps that one forward edge moves the carriage, Q16.16",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 111,
		.words = 2, .offset = offsetof(struct levelwind_status, u),
	},
	{
		.name = "drum_speed_edges_per_s", .unit = "edges/s",
		.text = "Drum speed, positive hauls rope in", .block = LEVELWIND_BLOCK_STATUS,
		.type = LEVELWIND_TYPE_I32, .address = 113, .words = 2,
		.offset = offsetof(struct levelwind_status, drum_speed_edges_per_s),
	},
	{
		.name = "rope_speed_mm_per_s", .unit = "mm/s",
		.text = "Rope speed, positive hauls in; by rope_radius_um where that is known",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 115,
		.words = 2, .offset = offsetof(struct levelwind_status, rope_speed_mm_per_s),
	},
	{
		.name = "rope_mm", .unit = "mm",
		.text = "Rope hauled in (positive) or paid out since power-up, by the growing layers where the rope on the drum is known; stands still at its limits, 2147 km",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 117,
		.words = 2, .offset = offsetof(struct levelwind_status, rope_mm),
	},
	{
		.name = "net_edges", .unit = "edges",
		.text = "Odometer: net drum edges since power-up", .block = LEVELWIND_BLOCK_STATUS,
		.type = LEVELWIND_TYPE_I64, .address = 119, .words = 4,
		.offset = offsetof(struct levelwind_status, net_edges),
	},
	{
		.name = "pattern_edges", .unit = "edges",
		.text = "Net edges followed since the last hand-over",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I64, .address = 123,
		.words = 4, .offset = offsetof(struct levelwind_status, pattern_edges),
	},
	{
		.name = "uptime_ms", .unit = "ms",
		.text = "Time since power-up; begins anew at 0 after 49.7 days",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 127,
		.words = 2, .offset = offsetof(struct levelwind_status, uptime_ms),
	},
	{
		.name = "los_recoveries", .unit = "",
		.text = "Re-indexings after a LOS in this launch", .block = LEVELWIND_BLOCK_STATUS,
		.type = LEVELWIND_TYPE_U16, .address = 129, .words = 1,
		.offset = offsetof(struct levelwind_status, los_recoveries),
	},
	{
		.name = "span_error_um", .unit = "um",
		.text = "Last indexing: found minus calibrated position of the other switch",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 130,
		.words = 2, .offset = offsetof(struct levelwind_status, span_error_um),
	},
	{
		.name = "flags_2", .unit = "",
		.text = "The discrete inputs from 32 on, bit number = discrete input address - 32",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 132,
		.words = 2, .offset = offsetof(struct levelwind_status, flags_2),
		.values = flags_2_values, .value_count = 13,
	},
	{
		.name = "rope_on_drum_mm", .unit = "mm",
		.text = "Rope on the drum; 0 until set_rope. It may be wrong while rope_doubtful is on",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 134,
		.words = 2, .offset = offsetof(struct levelwind_status, rope_on_drum_mm),
	},
	{
		.name = "rope_out_mm", .unit = "mm",
		.text = "Rope wound off since set_rope: what is out, if it was told with all rope in",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 136,
		.words = 2, .offset = offsetof(struct levelwind_status, rope_out_mm),
	},
	{
		.name = "rope_layer", .unit = "",
		.text = "Layers of rope on the drum, begun ones too; 0: bare, or not known",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 138,
		.words = 1, .offset = offsetof(struct levelwind_status, rope_layer),
	},
	{
		.name = "rope_radius_um", .unit = "um",
		.text = "Radius of what is wound, from the drum's axis; 0: not known",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 139,
		.words = 2, .offset = offsetof(struct levelwind_status, rope_radius_um),
	},
	{
		.name = "resume_position_um", .unit = "um",
		.text = "Where the rope goes on: carriage position when the drum came to rest, also before a power-off; 0 while resume_direction is 0",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 141,
		.words = 2, .offset = offsetof(struct levelwind_status, resume_position_um),
	},
	{
		.name = "resume_direction", .unit = "",
		.text = "Direction of the carriage there while the drum hauls in: +1 or -1; 0: not known, or resume is 0",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I16, .address = 143,
		.words = 1, .offset = offsetof(struct levelwind_status, resume_direction),
	},
	{
		.name = "los1_plus_count", .unit = "", .text = "LOS type 1+ since power-up",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 200,
		.words = 1, .offset = offsetof(struct levelwind_status, los1_plus_count),
	},
	{
		.name = "los1_plus_position_um", .unit = "um",
		.text = "Position of the first since the last indexing",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 201,
		.words = 2, .offset = offsetof(struct levelwind_status, los1_plus_position_um),
	},
	{
		.name = "los1_plus_time_ms", .unit = "ms",
		.text = "Its time since power-up, of that power-up",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 203,
		.words = 2, .offset = offsetof(struct levelwind_status, los1_plus_time_ms),
	},
	{
		.name = "los1_minus_count", .unit = "", .text = "LOS type 1- since power-up",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 210,
		.words = 1, .offset = offsetof(struct levelwind_status, los1_minus_count),
	},
	{
		.name = "los1_minus_position_um", .unit = "um",
		.text = "Position of the first since the last indexing",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 211,
		.words = 2, .offset = offsetof(struct levelwind_status, los1_minus_position_um),
	},
	{
		.name = "los1_minus_time_ms", .unit = "ms",
		.text = "Its time since power-up, of that power-up",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 213,
		.words = 2, .offset = offsetof(struct levelwind_status, los1_minus_time_ms),
	},
	{
		.name = "los2_plus_count", .unit = "", .text = "LOS type 2+ since power-up",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 220,
		.words = 1, .offset = offsetof(struct levelwind_status, los2_plus_count),
	},
	{
		.name = "los2_plus_position_um", .unit = "um",
		.text = "Position of the first since the last indexing",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 221,
		.words = 2, .offset = offsetof(struct levelwind_status, los2_plus_position_um),
	},
	{
		.name = "los2_plus_time_ms", .unit = "ms",
		.text = "Its time since power-up, of that power-up",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 223,
		.words = 2, .offset = offsetof(struct levelwind_status, los2_plus_time_ms),
	},
	{
		.name = "los2_minus_count", .unit = "", .text = "LOS type 2- since power-up",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 230,
		.words = 1, .offset = offsetof(struct levelwind_status, los2_minus_count),
	},
	{
		.name = "los2_minus_position_um", .unit = "um",
		.text = "Position of the first since the last indexing",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 231,
		.words = 2, .offset = offsetof(struct levelwind_status, los2_minus_position_um),
	},
	{
		.name = "los2_minus_time_ms", .unit = "ms",
		.text = "Its time since power-up, of that power-up",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 233,
		.words = 2, .offset = offsetof(struct levelwind_status, los2_minus_time_ms),
	},
	{
		.name = "illegal_transitions", .unit = "",
		.text = "Encoder transitions of both channels at once since power-up",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 300,
		.words = 2, .offset = offsetof(struct levelwind_status, illegal_transitions),
	},
	{
		.name = "switch_plus_triggers", .unit = "",
		.text = "Trigger events of the plus limit switch", .block = LEVELWIND_BLOCK_STATUS,
		.type = LEVELWIND_TYPE_U32, .address = 302, .words = 2,
		.offset = offsetof(struct levelwind_status, switch_plus_triggers),
	},
	{
		.name = "switch_minus_triggers", .unit = "",
		.text = "Trigger events of the minus limit switch", .block = LEVELWIND_BLOCK_STATUS,
		.type = LEVELWIND_TYPE_U32, .address = 304, .words = 2,
		.offset = offsetof(struct levelwind_status, switch_minus_triggers),
	},
	{
		.name = "steps", .unit = "usteps", .text = "Step pulses given since power-up",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 306,
		.words = 2, .offset = offsetof(struct levelwind_status, steps),
	},
	{
		.name = "requests", .unit = "", .text = "Modbus requests answered or executed",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 308,
		.words = 2, .offset = offsetof(struct levelwind_status, requests),
	},
	{
		.name = "crc_errors", .unit = "", .text = "Modbus frames with a wrong CRC",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 310,
		.words = 2, .offset = offsetof(struct levelwind_status, crc_errors),
	},
	{
		.name = "exceptions", .unit = "", .text = "Modbus exceptions answered",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 312,
		.words = 2, .offset = offsetof(struct levelwind_status, exceptions),
	},
	{
		.name = "boots", .unit = "", .text = "Power-ups. Survives power-off",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 314,
		.words = 2, .offset = offsetof(struct levelwind_status, boots),
	},
	{
		.name = "watchdog_resets", .unit = "",
		.text = "Restarts by the watchdog. Survives power-off",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 316,
		.words = 2, .offset = offsetof(struct levelwind_status, watchdog_resets),
	},
	{
		.name = "powered_s", .unit = "s",
		.text = "Time under power. Survives power-off but for up to 15 minutes",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 318,
		.words = 2, .offset = offsetof(struct levelwind_status, powered_s),
	},
	{
		.name = "tracking_s", .unit = "s",
		.text = "Time in the state tracking. Survives power-off but for what came after the last write",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 320,
		.words = 2, .offset = offsetof(struct levelwind_status, tracking_s),
	},
	{
		.name = "log_sequence", .unit = "",
		.text = "Event log: sequence number of the newest event, 0 if there is none",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 322,
		.words = 2, .offset = offsetof(struct levelwind_status, log_sequence),
	},
	{
		.name = "log_count", .unit = "", .text = "Event log: events that can be read",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 324,
		.words = 1, .offset = offsetof(struct levelwind_status, log_count),
	},
	{
		.name = "log_unsaved", .unit = "",
		.text = "Event log: events that are not stored yet; they wait until the drum rests",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 325,
		.words = 1, .offset = offsetof(struct levelwind_status, log_unsaved),
	},
	{
		.name = "record_sequence", .unit = "",
		.text = "Sequence number of the stored parameter set in use, 0 if there is none",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 326,
		.words = 2, .offset = offsetof(struct levelwind_status, record_sequence),
	},
	{
		.name = "record_schema", .unit = "",
		.text = "Its schema; an older one becomes the present one by SAVE",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 328,
		.words = 1, .offset = offsetof(struct levelwind_status, record_schema),
	},
	{
		.name = "slot_0", .unit = "", .text = "Storage: first slot of the parameters",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 329,
		.words = 1, .offset = offsetof(struct levelwind_status, slot_0),
		.values = slot_state_values, .value_count = 6,
	},
	{
		.name = "slot_1", .unit = "", .text = "Storage: second slot of the parameters",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 330,
		.words = 1, .offset = offsetof(struct levelwind_status, slot_1),
		.values = slot_state_values, .value_count = 6,
	},
	{
		.name = "slot_2", .unit = "",
		.text = "Storage: first slot of event log and counters",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 331,
		.words = 1, .offset = offsetof(struct levelwind_status, slot_2),
		.values = slot_state_values, .value_count = 6,
	},
	{
		.name = "slot_3", .unit = "",
		.text = "Storage: second slot of event log and counters",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 332,
		.words = 1, .offset = offsetof(struct levelwind_status, slot_3),
		.values = slot_state_values, .value_count = 6,
	},
	{
		.name = "active_crc", .unit = "",
		.text = "Names the active set by its values, those of the line and the lock's code left out; never 0. See accepted_crc",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 333,
		.words = 2, .offset = offsetof(struct levelwind_status, active_crc),
	},
	{
		.name = "encoder_interrupt_max_ns", .unit = "ns",
		.text = "Longest time in the encoder interrupt since power-up, without the operating system's share (0: not measured)",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 340,
		.words = 2, .offset = offsetof(struct levelwind_status, encoder_interrupt_max_ns),
	},
	{
		.name = "late_interrupts", .unit = "",
		.text = "Encoder interrupts that found nothing changed: transitions came closer than the interrupt is fast",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 342,
		.words = 2, .offset = offsetof(struct levelwind_status, late_interrupts),
	},
	{
		.name = "encoder_index_pulses", .unit = "",
		.text = "Index pulses (Z) of the encoder since power-up (0: not wired, or it has not turned)",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 344,
		.words = 2, .offset = offsetof(struct levelwind_status, encoder_index_pulses),
	},
	{
		.name = "missed_edges", .unit = "edges",
		.text = "Edges that were missing, or too many, between index pulses since power-up",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 346,
		.words = 2, .offset = offsetof(struct levelwind_status, missed_edges),
	},
	{
		.name = "stack_free_supervisor_bytes", .unit = "bytes",
		.text = "Stack that the supervisor has never used (0: not measured)",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 350,
		.words = 1,
		.offset = offsetof(struct levelwind_status, stack_free_supervisor_bytes),
	},
	{
		.name = "stack_free_limits_bytes", .unit = "bytes",
		.text = "Stack that the limits thread has never used (0: not measured)",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 351,
		.words = 1, .offset = offsetof(struct levelwind_status, stack_free_limits_bytes),
	},
	{
		.name = "stack_free_modbus_bytes", .unit = "bytes",
		.text = "Stack that the Modbus thread has never used (0: not measured)",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 352,
		.words = 1, .offset = offsetof(struct levelwind_status, stack_free_modbus_bytes),
	},
	{
		.name = "stack_free_storage_bytes", .unit = "bytes",
		.text = "Stack that the storage work queue has never used (0: not measured)",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 353,
		.words = 1, .offset = offsetof(struct levelwind_status, stack_free_storage_bytes),
	},
	{
		.name = "stack_free_interrupts_bytes", .unit = "bytes",
		.text = "Stack that the interrupts have never used (0: not measured)",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 354,
		.words = 1,
		.offset = offsetof(struct levelwind_status, stack_free_interrupts_bytes),
	},
	{
		.name = "encoder_fault_kind", .unit = "",
		.text = "What was wrong with the encoder first since the last indexing (and since the power-up)",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 360,
		.words = 1, .offset = offsetof(struct levelwind_status, encoder_fault_kind),
		.values = encoder_fault_values, .value_count = 8,
	},
	{
		.name = "encoder_fault_count", .unit = "", .text = "Encoder faults since power-up",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 361,
		.words = 1, .offset = offsetof(struct levelwind_status, encoder_fault_count),
	},
	{
		.name = "encoder_fault_position_um", .unit = "um",
		.text = "Position of the first since the last indexing",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 362,
		.words = 2, .offset = offsetof(struct levelwind_status, encoder_fault_position_um),
	},
	{
		.name = "encoder_fault_time_ms", .unit = "ms", .text = "Its time since power-up",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 364,
		.words = 2, .offset = offsetof(struct levelwind_status, encoder_fault_time_ms),
	},
	{
		.name = "encoder_doubts", .unit = "",
		.text = "How often the encoder became doubtful since power-up",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 366,
		.words = 1, .offset = offsetof(struct levelwind_status, encoder_doubts),
	},
	{
		.name = "encoder_misfit_edges", .unit = "edges",
		.text = "By how many edges the index pulses contradict the count, net, since the last indexing",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 367,
		.words = 2, .offset = offsetof(struct levelwind_status, encoder_misfit_edges),
	},
	{
		.name = "memory_corrections", .unit = "",
		.text = "Bits of the active parameters and of the law in force that had flipped in memory and were set right since power-up",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 369,
		.words = 1, .offset = offsetof(struct levelwind_status, memory_corrections),
	},
	{
		.name = "line_babbles", .unit = "",
		.text = "Times that bytes came on the line without a silence for more than a second, since power-up",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 380,
		.words = 2, .offset = offsetof(struct levelwind_status, line_babbles),
	},
	{
		.name = "line_echoes", .unit = "",
		.text = "Own answers that the line gave back, dropped",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 382,
		.words = 2, .offset = offsetof(struct levelwind_status, line_echoes),
	},
	{
		.name = "late_requests", .unit = "",
		.text = "Requests that had waited too long and were dropped",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 384,
		.words = 2, .offset = offsetof(struct levelwind_status, late_requests),
	},
	{
		.name = "foreign_answers", .unit = "",
		.text = "Answers of another device as this unit, dropped: two devices have this unit_id, or an echo comes late",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 386,
		.words = 2, .offset = offsetof(struct levelwind_status, foreign_answers),
	},
	{
		.name = "events_skipped", .unit = "",
		.text = "Events that were not logged because their cause comes and goes too often",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 388,
		.words = 2, .offset = offsetof(struct levelwind_status, events_skipped),
	},
	{
		.name = "rope_standing_millirev", .unit = "1/1000 drum rev",
		.text = "Drum turns of rope laid while the carriage stood, since the last acknowledgement",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 390,
		.words = 2, .offset = offsetof(struct levelwind_status, rope_standing_millirev),
	},
	{
		.name = "rope_standing_position_um", .unit = "um",
		.text = "Where the carriage stood at the first of them",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 392,
		.words = 2, .offset = offsetof(struct levelwind_status, rope_standing_position_um),
	},
	{
		.name = "rope_standing_time_ms", .unit = "ms",
		.text = "When, since power-up, of that power-up", .block = LEVELWIND_BLOCK_STATUS,
		.type = LEVELWIND_TYPE_U32, .address = 394, .words = 2,
		.offset = offsetof(struct levelwind_status, rope_standing_time_ms),
	},
	{
		.name = "rope_standing_place_known", .unit = "",
		.text = "1: that position was known; 0: the position had been unknown before",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 396,
		.words = 1, .offset = offsetof(struct levelwind_status, rope_standing_place_known),
	},
	{
		.name = "look_before_power_up", .unit = "",
		.text = "What needs a look at the rope since before this power-up: 1 LOS 1+, 2 LOS 1-, 4 LOS 2+, 8 LOS 2-, 16 rope laid while the carriage stood, 32 encoder fault, 64 re-acquired",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 397,
		.words = 1, .offset = offsetof(struct levelwind_status, look_before_power_up),
	},
	{
		.name = "command_sequence", .unit = "",
		.text = "Counts every command, also refused ones", .block = LEVELWIND_BLOCK_STATUS,
		.type = LEVELWIND_TYPE_U16, .address = 400, .words = 1,
		.offset = offsetof(struct levelwind_status, command_sequence),
	},
	{
		.name = "command_code", .unit = "", .text = "The last command",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 401,
		.words = 1, .offset = offsetof(struct levelwind_status, command_code),
		.values = command_values, .value_count = 19,
	},
	{
		.name = "command_result", .unit = "", .text = "How it ended",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 402,
		.words = 1, .offset = offsetof(struct levelwind_status, command_result),
		.values = result_values, .value_count = 5,
	},
	{
		.name = "command_reason", .unit = "", .text = "Why it was refused or failed",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 403,
		.words = 1, .offset = offsetof(struct levelwind_status, command_reason),
		.values = reason_values, .value_count = 83,
	},
	{
		.name = "command_address", .unit = "",
		.text = "Offending holding register, 65535 if none",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 404,
		.words = 1, .offset = offsetof(struct levelwind_status, command_address),
	},
	{
		.name = "command_value", .unit = "", .text = "Offending value",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 405,
		.words = 2, .offset = offsetof(struct levelwind_status, command_value),
	},
	{
		.name = "command_limit", .unit = "", .text = "The limit that it broke",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 407,
		.words = 2, .offset = offsetof(struct levelwind_status, command_limit),
	},
	{
		.name = "last_error_reason", .unit = "",
		.text = "Why the last refused request was refused", .block = LEVELWIND_BLOCK_STATUS,
		.type = LEVELWIND_TYPE_U16, .address = 410, .words = 1,
		.offset = offsetof(struct levelwind_status, last_error_reason),
		.values = reason_values, .value_count = 83,
	},
	{
		.name = "last_error_function", .unit = "", .text = "Its function code",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 411,
		.words = 1, .offset = offsetof(struct levelwind_status, last_error_function),
	},
	{
		.name = "last_error_exception", .unit = "", .text = "The exception answered",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 412,
		.words = 1, .offset = offsetof(struct levelwind_status, last_error_exception),
	},
	{
		.name = "last_error_address", .unit = "", .text = "The offending address",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 413,
		.words = 1, .offset = offsetof(struct levelwind_status, last_error_address),
	},
	{
		.name = "last_error_value", .unit = "", .text = "The offending value",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 414,
		.words = 2, .offset = offsetof(struct levelwind_status, last_error_value),
	},
	{
		.name = "last_error_limit", .unit = "", .text = "The limit that it broke",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 416,
		.words = 2, .offset = offsetof(struct levelwind_status, last_error_limit),
	},
	{
		.name = "ka", .unit = "usteps/65536",
		.text = "Slope change per edge in a reversal, in force",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 500,
		.words = 2, .offset = offsetof(struct levelwind_status, ka),
	},
	{
		.name = "nr", .unit = "edges",
		.text = "Edges from sweep slope to zero slope, in force",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 502,
		.words = 2, .offset = offsetof(struct levelwind_status, nr),
	},
	{
		.name = "ks", .unit = "usteps/65536",
		.text = "Sweep slope per edge, in force: Ks = Ka * Nr",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 504,
		.words = 2, .offset = offsetof(struct levelwind_status, ks),
	},
	{
		.name = "reversal_plus_usteps", .unit = "usteps",
		.text = "L+ in force, trim included", .block = LEVELWIND_BLOCK_STATUS,
		.type = LEVELWIND_TYPE_I16, .address = 506, .words = 1,
		.offset = offsetof(struct levelwind_status, reversal_plus_usteps),
	},
	{
		.name = "reversal_minus_usteps", .unit = "usteps",
		.text = "L- in force, trim included", .block = LEVELWIND_BLOCK_STATUS,
		.type = LEVELWIND_TYPE_I16, .address = 507, .words = 1,
		.offset = offsetof(struct levelwind_status, reversal_minus_usteps),
	},
	{
		.name = "overshoot_actual_um", .unit = "um",
		.text = "Overshoot in force: Ks * (Nr - 1) / 2", .block = LEVELWIND_BLOCK_STATUS,
		.type = LEVELWIND_TYPE_I32, .address = 508, .words = 2,
		.offset = offsetof(struct levelwind_status, overshoot_actual_um),
	},
	{
		.name = "slope_error_ppm", .unit = "ppm", .text = "Residual error of the pitch",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 510,
		.words = 2, .offset = offsetof(struct levelwind_status, slope_error_ppm),
	},
	{
		.name = "overshoot_error_um", .unit = "um",
		.text = "Residual error of the overshoot", .block = LEVELWIND_BLOCK_STATUS,
		.type = LEVELWIND_TYPE_I32, .address = 512, .words = 2,
		.offset = offsetof(struct levelwind_status, overshoot_error_um),
	},
	{
		.name = "edges_per_1000_drum_revs", .unit = "edges",
		.text = "Used encoder edges per 1000 drum revolutions, rounded",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 514,
		.words = 2, .offset = offsetof(struct levelwind_status, edges_per_1000_drum_revs),
	},
	{
		.name = "dwell_plus_edges", .unit = "edges", .text = "Dwell at the plus side",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 516,
		.words = 2, .offset = offsetof(struct levelwind_status, dwell_plus_edges),
	},
	{
		.name = "dwell_minus_edges", .unit = "edges", .text = "Dwell at the minus side",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 518,
		.words = 2, .offset = offsetof(struct levelwind_status, dwell_minus_edges),
	},
	{
		.name = "breaker_edges", .unit = "edges",
		.text = "Ribbon breaker: most that it adds to a dwell",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 520,
		.words = 2, .offset = offsetof(struct levelwind_status, breaker_edges),
	},
	{
		.name = "breaker_cycle_plus", .unit = "",
		.text = "Ribbon breaker: far points passed at plus since the hand-over after the last indexing, net, modulo breaker_cycles",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 522,
		.words = 1, .offset = offsetof(struct levelwind_status, breaker_cycle_plus),
	},
	{
		.name = "breaker_cycle_minus", .unit = "", .text = "Ribbon breaker: those at minus",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 523,
		.words = 1, .offset = offsetof(struct levelwind_status, breaker_cycle_minus),
	},
	{
		.name = "cam_bank_0_state", .unit = "",
		.text = "What the first bank of cam tables holds", .block = LEVELWIND_BLOCK_STATUS,
		.type = LEVELWIND_TYPE_U16, .address = 600, .words = 1,
		.offset = offsetof(struct levelwind_status, cam_bank_0_state),
		.values = cam_bank_state_values, .value_count = 5,
	},
	{
		.name = "cam_bank_1_state", .unit = "",
		.text = "What the second bank of cam tables holds", .block = LEVELWIND_BLOCK_STATUS,
		.type = LEVELWIND_TYPE_U16, .address = 601, .words = 1,
		.offset = offsetof(struct levelwind_status, cam_bank_1_state),
		.values = cam_bank_state_values, .value_count = 5,
	},
	{
		.name = "cam_reason", .unit = "",
		.text = "Why the last check of a cam table refused it, or why the active one cannot be followed",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 602,
		.words = 1, .offset = offsetof(struct levelwind_status, cam_reason),
		.values = reason_values, .value_count = 83,
	},
	{
		.name = "cam_reason_row", .unit = "",
		.text = "The offending row, counted from 1; 0 if no single row is to blame",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 603,
		.words = 1, .offset = offsetof(struct levelwind_status, cam_reason_row),
	},
	{
		.name = "cam_reason_value", .unit = "", .text = "The offending value",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 604,
		.words = 2, .offset = offsetof(struct levelwind_status, cam_reason_value),
	},
	{
		.name = "cam_reason_limit", .unit = "", .text = "The limit that it broke",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 606,
		.words = 2, .offset = offsetof(struct levelwind_status, cam_reason_limit),
	},
	{
		.name = "cam_version", .unit = "", .text = "Version of the active cam table",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 608,
		.words = 2, .offset = offsetof(struct levelwind_status, cam_version),
	},
	{
		.name = "cam_stored", .unit = "",
		.text = "1 when it is stored, so that the next power-up begins with it; written at rest only",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 610,
		.words = 1, .offset = offsetof(struct levelwind_status, cam_stored),
	},
	{
		.name = "cam_rows", .unit = "", .text = "Its rows; 0: there is none",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 611,
		.words = 1, .offset = offsetof(struct levelwind_status, cam_rows),
	},
	{
		.name = "cam_cycle_edges", .unit = "edges", .text = "Length of its cycle",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U32, .address = 612,
		.words = 2, .offset = offsetof(struct levelwind_status, cam_cycle_edges),
	},
	{
		.name = "cam_min_usteps", .unit = "usteps", .text = "Its lowest position",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 614,
		.words = 2, .offset = offsetof(struct levelwind_status, cam_min_usteps),
	},
	{
		.name = "cam_max_usteps", .unit = "usteps", .text = "Its highest position",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 616,
		.words = 2, .offset = offsetof(struct levelwind_status, cam_max_usteps),
	},
	{
		.name = "cam_slope_max_permille", .unit = "usteps/1000 edges",
		.text = "Its steepest slope, ramps included", .block = LEVELWIND_BLOCK_STATUS,
		.type = LEVELWIND_TYPE_U16, .address = 618, .words = 1,
		.offset = offsetof(struct levelwind_status, cam_slope_max_permille),
	},
	{
		.name = "cam_position_usteps", .unit = "usteps",
		.text = "Slave position by the table, modulo 2^32", .block = LEVELWIND_BLOCK_STATUS,
		.type = LEVELWIND_TYPE_I32, .address = 619, .words = 2,
		.offset = offsetof(struct levelwind_status, cam_position_usteps),
	},
	{
		.name = "cam_row", .unit = "",
		.text = "Row behind the master, counted from 1; 0: no cam is running",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 621,
		.words = 1, .offset = offsetof(struct levelwind_status, cam_row),
	},
	{
		.name = "cam_cycles", .unit = "", .text = "Net cycles since the hand-over",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_I32, .address = 622,
		.words = 2, .offset = offsetof(struct levelwind_status, cam_cycles),
	},
	{
		.name = "cam_phase_in_force_edges", .unit = "edges",
		.text = "How much of cam_phase_edges is reached", .block = LEVELWIND_BLOCK_STATUS,
		.type = LEVELWIND_TYPE_I32, .address = 624, .words = 2,
		.offset = offsetof(struct levelwind_status, cam_phase_in_force_edges),
	},
	{
		.name = "cam_waiting", .unit = "",
		.text = "1 while a cam waits for the begin of the next cycle",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 626,
		.words = 1, .offset = offsetof(struct levelwind_status, cam_waiting),
	},
	{
		.name = "slot_4", .unit = "", .text = "Storage: first slot of cam tables",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 627,
		.words = 1, .offset = offsetof(struct levelwind_status, slot_4),
		.values = slot_state_values, .value_count = 6,
	},
	{
		.name = "slot_5", .unit = "", .text = "Storage: second slot of cam tables",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 628,
		.words = 1, .offset = offsetof(struct levelwind_status, slot_5),
		.values = slot_state_values, .value_count = 6,
	},
	{
		.name = "slot_6", .unit = "",
		.text = "Storage: first slot of what needs a look at the rope",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 629,
		.words = 1, .offset = offsetof(struct levelwind_status, slot_6),
		.values = slot_state_values, .value_count = 6,
	},
	{
		.name = "slot_7", .unit = "",
		.text = "Storage: second slot of what needs a look at the rope",
		.block = LEVELWIND_BLOCK_STATUS, .type = LEVELWIND_TYPE_U16, .address = 630,
		.words = 1, .offset = offsetof(struct levelwind_status, slot_7),
		.values = slot_state_values, .value_count = 6,
	},
	{
		.name = "cam_upload_name", .unit = "",
		.text = "Name, two characters of ASCII in a register",
		.block = LEVELWIND_BLOCK_CAM_UPLOAD, .type = LEVELWIND_TYPE_U16, .address = 3000,
		.words = 1, .min = 0, .max = 65535, .default_value = 0,
	},
	{
		.name = "cam_upload_version", .unit = "", .text = "Version, for people",
		.block = LEVELWIND_BLOCK_CAM_UPLOAD, .type = LEVELWIND_TYPE_U32, .address = 3008,
		.words = 2, .min = 0, .max = 2147483647, .default_value = 0,
	},
	{
		.name = "cam_upload_interpolation", .unit = "", .text = "How to go from row to row",
		.block = LEVELWIND_BLOCK_CAM_UPLOAD, .type = LEVELWIND_TYPE_U16, .address = 3010,
		.words = 1, .min = 0, .max = 1, .default_value = 0,
		.values = cam_interpolation_values, .value_count = 2,
	},
	{
		.name = "cam_upload_row_count", .unit = "", .text = "Rows",
		.block = LEVELWIND_BLOCK_CAM_UPLOAD, .type = LEVELWIND_TYPE_U16, .address = 3011,
		.words = 1, .min = 0, .max = 65535, .default_value = 0,
	},
	{
		.name = "cam_upload_advance", .unit = "",
		.text = "Slave units that a cycle adds; 0: cyclic",
		.block = LEVELWIND_BLOCK_CAM_UPLOAD, .type = LEVELWIND_TYPE_I32, .address = 3012,
		.words = 2, .min = -2147483647, .max = 2147483647, .default_value = 0,
	},
	{
		.name = "cam_upload_crc", .unit = "",
		.text = "CRC-32 of the 14 registers before and 4 per row, high word first",
		.block = LEVELWIND_BLOCK_CAM_UPLOAD, .type = LEVELWIND_TYPE_U16, .address = 3014,
		.words = 1, .min = 0, .max = 65535, .default_value = 0,
	},
	{
		.name = "cam_upload_first_row", .unit = "",
		.text = "Row that cam_upload_rows begins at, counted from 1; may stand in the same request",
		.block = LEVELWIND_BLOCK_CAM_UPLOAD, .type = LEVELWIND_TYPE_U16, .address = 3016,
		.words = 1, .min = 1, .max = 256, .default_value = 1,
	},
	{
		.name = "cam_upload_rows", .unit = "",
		.text = "Window of 30 rows: master, slave, alternating",
		.block = LEVELWIND_BLOCK_CAM_UPLOAD, .type = LEVELWIND_TYPE_I32, .address = 3018,
		.words = 2, .min = -2147483647, .max = 2147483647, .default_value = 0,
	},
};
