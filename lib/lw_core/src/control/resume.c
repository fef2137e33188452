/* SPDX-License-Identifier: Apache-2.0 */
#include "resume.h"

#include <string.h>

#include "lw/bytes/crc32.h"
#include "lw/bytes/require.h"
#include "lw/bytes/same.h"
#include "lw/control/controller.h"
#include "lw/motion/move.h"
#include "moving.h"

uint32_t lw_controller_pattern(const struct lw_controller *controller)
{
	/* 32-bit members only: no padding. */
	const struct lw_law_window window =
		lw_params_window(controller->params, controller->derived, 0, 0);
	uint8_t bytes[sizeof(window)];

	memcpy(bytes, &window, sizeof(window));
	return lw_crc32(bytes, sizeof(bytes));
}

/** The law as no edge changes it meanwhile: at rest, where edges are rare. */
static struct lw_law read_law(const struct lw_controller *controller)
{
	struct lw_law first;
	struct lw_law second = controller->motion.law;

	do {
		first = second;
		atomic_signal_fence(memory_order_seq_cst);
		second = controller->motion.law;
	} while (!lw_same(&first, &second, sizeof(first)));
	return second;
}

static void keep(struct lw_controller *controller)
{
	struct lw_resume *resume = &controller->resume;
	const uint32_t edges = (uint32_t)controller->motion.net_edges;

	if (resume->followed && resume->edges == edges) {
		return;
	}

	const struct lw_law law = read_law(controller);

	resume->known = true;
	resume->followed = true;
	resume->doubtful = false;
	resume->wanted = false;
	resume->edges = edges;
	resume->m = lw_law_m(&law);
	resume->u = law.u;
	resume->dwell_edges = law.dwell_edges;
	resume->cycle_plus = law.cycle_plus;
	resume->cycle_minus = law.cycle_minus;
	resume->pattern = lw_controller_pattern(controller);
}

/** Has the drum turned since, or may it have, unseen? */
static bool has_turned(const struct lw_controller *controller)
{
	const int32_t edges =
		(int32_t)((uint32_t)controller->motion.net_edges - controller->resume.edges);

	return (edges < 0 ? 0u - (uint32_t)edges : (uint32_t)edges) >
		       lw_carriage_tolerance_edges(controller) ||
	       controller->los.encoder.set || controller->odometer_doubtful;
}

void lw_resume_tick(struct lw_controller *controller)
{
	struct lw_resume *resume = &controller->resume;

	if (!controller->params->resume) {
		resume->known = false;
	} else if (controller->state != LW_STATE_TRACKING) {
		resume->followed = false;
		resume->doubtful |= resume->known && has_turned(controller);
	} else if (controller->speed.at_rest && !controller->motion.cam.on) {
		keep(controller);
	} else {
		resume->followed = false;
		resume->known = false; /* until the drum rests again: a cut at speed loses it */
	}
	resume->wanted &= resume->known && !resume->doubtful;
	if (controller->indexed && controller->speed.at_rest) {
		resume->stand_usteps = lw_carriage_pos_usteps(controller);
	}
}

void lw_resume_indexed(struct lw_controller *controller)
{
	struct lw_resume *resume = &controller->resume;
	const int32_t tolerance = controller->derived->switch_tolerance_usteps;
	const int32_t moved = controller->moving.shift_usteps;

	/* Stood it elsewhere than it was left, then what has moved it may have turned the drum. */
	resume->doubtful |= resume->known && (moved > tolerance || moved < -tolerance);
	resume->wanted = resume->known && !resume->doubtful;
	controller->moving.shift_usteps = 0;
}

/** Is a state one that the pattern itself reaches? The orbit of doc/control-law.md section 2. */
static bool on_orbit(const struct lw_law_window *window, int32_t m, int32_t u)
{
	const int64_t nr = window->ks / window->ka;
	const int region = lw_law_region(window, m);
	const int64_t j = region < 0 ? nr - u / window->ka : nr + u / window->ka;
	const int64_t way = window->ka * j * (2 * nr - 1 - j) / 2;

	if (u > window->ks || u < -window->ks || u % window->ka != 0) {
		return false;
	}
	if (region == 0) {
		return u == window->ks || u == -window->ks;
	}
	return region < 0 ? window->sweep_end <= m - way && m - way < window->sweep_end + window->ks
			  : window->sweep_begin - window->ks <= m + way &&
				    m + way < window->sweep_begin;
}

int lw_controller_resume_direction(const struct lw_controller *controller)
{
	const struct lw_resume *resume = &controller->resume;
	const struct lw_law_window window = lw_carriage_track_window(controller);

	if (!resume->known) {
		return 0;
	}
	if (resume->u != 0) {
		return resume->u > 0 ? 1 : -1;
	}
	return lw_law_region(&window, resume->m) < 0 ? -1 : 1; /* a far point: inward */
}

/** The state to take up: the one that was, or in a pattern with another trim the nearest sweep. */
static struct lw_law state_to_take_up(const struct lw_controller *controller,
				      const struct lw_law_window *window)
{
	const struct lw_resume *resume = &controller->resume;
	struct lw_law law;

	if (on_orbit(window, resume->m, resume->u)) {
		law = lw_law_at(window, resume->m, resume->u);
		law.dwell_edges = resume->dwell_edges;
	} else {
		const int region = lw_law_region(window, resume->m);
		const int32_t m = region < 0   ? window->sweep_end - LW_USTEP
				  : region > 0 ? window->sweep_begin
					       : resume->m;

		law = lw_law_at(window, m, lw_controller_resume_direction(controller) * window->ks);
	}
	law.cycle_plus = resume->cycle_plus;
	law.cycle_minus = resume->cycle_minus;
	return law;
}

bool lw_resume_approach(struct lw_controller *controller)
{
	struct lw_motion *motion = &controller->motion;
	struct lw_law_window *spare = lw_carriage_spare_window(controller);
	struct lw_law law;

	LW_REQUIRE(controller->indexed && motion->source == LW_EDGE_SOURCE_NONE);
	*spare = lw_carriage_track_window(controller);
	law = state_to_take_up(controller, spare);
	if (lw_moving_into(controller, lw_law_pos_usteps(lw_law_m(&law)), LW_STATE_CENTRING,
			   LW_STATE_READY)) {
		return true;
	}
	lw_motion_set_position(motion, spare, lw_law_m(&law), law.u);
	motion->law = law;
	motion->requests = 0;
	controller->on_orbit = true;
	controller->resume.taken_up++; /* and once it is followed it is kept, and wanted no more */
	return false;
}
