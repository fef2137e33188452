/* SPDX-License-Identifier: Apache-2.0 */
#include "machine.h"

#define US_PER_MS 1000

/** Between flange and end stop, where the travel leaves less. */
#define END_ROOM_MIN_UM 2000

static int32_t larger(int32_t a, int32_t b)
{
	return a > b ? a : b;
}

/** An electrical period must be a whole number of microsteps. */
static uint32_t full_steps_of(uint32_t usteps_per_rev, uint32_t usual)
{
	while (4ull * usteps_per_rev % usual != 0) {
		usual--;
	}
	return usual;
}

static void place(const struct lw_params *params, struct lw_plant_config *machine)
{
	const int32_t plus_um = params->switch_plus_um;
	const int32_t minus_um = params->switch_minus_um;
	const int32_t flange_um = larger(larger(params->flange_plus_um, -params->flange_minus_um),
					 larger(plus_um, -minus_um));

	machine->limit_um[LW_PLANT_PLUS] = plus_um;
	machine->limit_um[LW_PLANT_MINUS] = minus_um;
	machine->flange_um = larger((int32_t)params->travel_um / 2, flange_um + END_ROOM_MIN_UM);
	/* As with the default machine: 83, 86 and 90 mm. */
	machine->overtravel_um = flange_um + (machine->flange_um - flange_um) * 3 / 7;
	if (plus_um <= 0 || minus_um >= 0) {
		machine->start_um = minus_um + (plus_um - minus_um) / 2;
	}
}

void lw_machine_of_params(const struct lw_params *params, struct lw_plant_config *machine)
{
	lw_plant_config_default(machine);
	machine->encoder_pulses_per_rev = (uint32_t)params->encoder_pulses_per_rev;
	machine->encoder_revs_per_drum_rev_num = (uint32_t)params->encoder_ratio_numerator;
	machine->encoder_revs_per_drum_rev_den = (uint32_t)params->encoder_ratio_denominator;
	machine->encoder_inverted[0] = params->encoder_invert_a != 0;
	machine->encoder_inverted[1] = params->encoder_invert_b != 0;
	machine->encoder_swapped = params->drum_direction_invert != 0;
	machine->carriage_reversed = params->carriage_direction_invert != 0;
	machine->screw_lead_um = (uint32_t)params->screw_lead_um;
	machine->usteps_per_rev = (uint32_t)params->microsteps_per_rev;
	machine->full_steps_per_rev =
		full_steps_of(machine->usteps_per_rev, machine->full_steps_per_rev);
	place(params, machine);
	if (params->switch_hysteresis_um <= machine->switch_hysteresis_um) {
		machine->switch_hysteresis_um = params->switch_hysteresis_um / 2;
	}
	if (params->switch_delay_us > 0) {
		const uint32_t delay_us = (uint32_t)params->switch_delay_us;

		if (machine->contact_transit_us > delay_us) {
			machine->contact_transit_us = delay_us;
		}
		machine->limit_shift_um_per_mm_per_s =
			(delay_us - machine->contact_transit_us) / (double)US_PER_MS;
	}
}
