/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Early and late reversal by hand, as spooling winches have it: a step of the live trim for each
 * press, at the side that the carriage moves toward.
 */
#include "lw/control/controller.h"

#include <errno.h>

#include "carriage_acts.h"

/** A button counts when so many polls in a row have told the same. */
#define BUTTON_POLLS 20

/** Outward no farther than the registers of the trim hold. Inward a switch is always nearer. */
#define TRIM_MAX_UM 20000

/** The reversal that the carriage is in, or moves toward. */
static int side_ahead(const struct lw_controller *controller)
{
	const struct lw_motion *motion = &controller->motion;
	const int region = lw_law_region(motion->window, lw_motion_m(motion));
	/* Not one step yet since power-up: where hauling in leads. */
	const int32_t direction = motion->last_step != 0 ? motion->last_step : motion->law.u;

	if (region != 0) {
		return region < 0 ? LW_PLUS : LW_MINUS;
	}
	return direction > 0 ? LW_PLUS : LW_MINUS;
}

/** The trim after one step more. */
static struct lw_trim stepped(const struct lw_controller *controller, int side, bool later)
{
	const int32_t step_um = controller->params->trim_step_um;
	const int32_t outward_um = later ? step_um : -step_um;
	struct lw_trim trim = controller->trim;

	if (side == LW_PLUS) {
		trim.plus_um += outward_um;
	} else {
		trim.minus_um -= outward_um;
	}
	return trim;
}

int lw_controller_allow_hand_trim(const struct lw_controller *controller, bool later,
				  struct lw_refusal *why)
{
	const struct lw_trim trim = stepped(controller, side_ahead(controller), later);

	if (controller->state != LW_STATE_TRACKING || controller->motion.cam.on) {
		return lw_carriage_busy(why, LW_REASON_TRIM_NOT_FOLLOWING);
	}
	if (trim.plus_um > TRIM_MAX_UM || trim.minus_um < -TRIM_MAX_UM) {
		why->reason = LW_REASON_OUT_OF_RANGE;
		return -EINVAL;
	}
	return lw_params_check_trim(controller->params, controller->derived, trim.plus_um,
				    trim.minus_um, why);
}

int32_t lw_controller_hand_trim(struct lw_controller *controller, bool later)
{
	const int side = side_ahead(controller);
	const struct lw_trim trim = stepped(controller, side, later);

	lw_controller_set_trim(controller, trim.plus_um, trim.minus_um);
	return side == LW_PLUS ? trim.plus_um : trim.minus_um;
}

unsigned int lw_controller_trim_buttons(struct lw_controller *controller, const bool pressed[2])
{
	unsigned int presses = 0;

	for (int later = 0; later < 2; later++) {
		struct lw_trim_button *button = &controller->trim_buttons[later];

		if (pressed[later] == button->pressed) {
			button->polls = 0;
		} else if (++button->polls == BUTTON_POLLS) {
			button->polls = 0;
			button->pressed = pressed[later];
			presses |= (unsigned int)pressed[later] << later;
		}
	}
	return presses;
}
