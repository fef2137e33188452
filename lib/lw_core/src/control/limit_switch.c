/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/control/limit_switch.h"

static bool is_pair(const struct lw_limit_switch_config *config)
{
	return config->contacts == LW_SWITCH_CONTACTS_NO_NC_PAIR;
}

/** Single contact: actuated by its wire? A broken NC wire reads as actuated, the safe side. */
static bool single_actuated(const struct lw_limit_switch *limit_switch,
			    const struct lw_limit_switch_config *config)
{
	return config->contacts == LW_SWITCH_CONTACTS_SINGLE_NO ? limit_switch->no_closed
								: !limit_switch->nc_closed;
}

/** Single contact: has it been changing for longer than a contact bounces? */
static bool is_chatter(const struct lw_limit_switch *limit_switch,
		       const struct lw_limit_switch_config *config, uint64_t now_us)
{
	return now_us - limit_switch->restless_since_us > config->transit_us;
}

void lw_limit_switch_init(struct lw_limit_switch *limit_switch,
			  const struct lw_limit_switch_config *config, bool no_closed,
			  bool nc_closed, uint64_t now_us)
{
	*limit_switch = (struct lw_limit_switch){
		.no_closed = no_closed,
		.nc_closed = nc_closed,
		.changed_us = now_us,
		.restless_since_us = now_us,
	};
	limit_switch->active =
		is_pair(config) ? no_closed && !nc_closed : single_actuated(limit_switch, config);
}

void lw_limit_switch_input(struct lw_limit_switch *limit_switch,
			   const struct lw_limit_switch_config *config, bool no_closed,
			   bool nc_closed, struct lw_limit_switch_trigger at, uint64_t now_us)
{
	/* A debounce time may have run out unseen since the last tick. */
	lw_limit_switch_tick(limit_switch, config, now_us);

	if (now_us - limit_switch->changed_us >= config->debounce_us) {
		limit_switch->restless_since_us = now_us;
	}
	limit_switch->no_closed = no_closed;
	limit_switch->nc_closed = nc_closed;
	limit_switch->changed_us = now_us;

	if (is_pair(config)) {
		if (no_closed && !nc_closed && !limit_switch->active) {
			limit_switch->active = true;
			limit_switch->trigger = at;
			limit_switch->triggered = true;
			limit_switch->triggers++;
		} else if (nc_closed && !no_closed) {
			limit_switch->active = false;
		}
	} else if (single_actuated(limit_switch, config) && !limit_switch->active &&
		   (!limit_switch->candidate || is_chatter(limit_switch, config, now_us))) {
		limit_switch->candidate = true;
		limit_switch->trigger = at;
	}
}

void lw_limit_switch_tick(struct lw_limit_switch *limit_switch,
			  const struct lw_limit_switch_config *config, uint64_t now_us)
{
	const uint64_t quiet_us = now_us - limit_switch->changed_us;

	if (is_pair(config)) {
		/* Both open or both closed is legal only while the contact is in transit. */
		limit_switch->wiring_fault = limit_switch->no_closed == limit_switch->nc_closed &&
					     quiet_us > config->transit_us;
		return;
	}

	limit_switch->wiring_fault =
		quiet_us < config->debounce_us && is_chatter(limit_switch, config, now_us);
	if (quiet_us < config->debounce_us) {
		return;
	}
	if (single_actuated(limit_switch, config) && limit_switch->candidate) {
		limit_switch->active = true;
		limit_switch->triggered = true;
		limit_switch->triggers++;
	} else if (!single_actuated(limit_switch, config)) {
		limit_switch->active = false;
	}
	limit_switch->candidate = false;
}

bool lw_limit_switch_take(struct lw_limit_switch *limit_switch,
			  struct lw_limit_switch_trigger *trigger)
{
	if (!limit_switch->triggered) {
		return false;
	}
	*trigger = limit_switch->trigger;
	limit_switch->triggered = false;
	return true;
}
