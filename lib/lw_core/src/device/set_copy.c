/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/device/set_copy.h"

#include <string.h>

#include "lw/bytes/crc32.h"
#include "lw/bytes/same.h"

static uint32_t crc_of(const struct lw_params *params, const struct lw_derived *derived)
{
	const uint32_t crc = lw_crc32((const uint8_t *)params, sizeof(*params));

	return lw_crc32_add(crc, (const uint8_t *)derived, sizeof(*derived));
}

void lw_set_copy_keep(struct lw_set_copy *copy, const struct lw_params *params,
		      const struct lw_derived *derived)
{
	/* Byte by byte, what lies between the members included: so they are compared. */
	memcpy(&copy->params, params, sizeof(*params));
	memcpy(&copy->derived, derived, sizeof(*derived));
	copy->crc = crc_of(params, derived);
}

bool lw_set_copy_check(struct lw_set_copy *copy, struct lw_params *params,
		       struct lw_derived *derived)
{
	if (lw_same(&copy->params, params, sizeof(*params)) &&
	    lw_same(&copy->derived, derived, sizeof(*derived))) {
		return false;
	}
	if (crc_of(params, derived) == copy->crc) {
		lw_set_copy_keep(copy, params, derived);
	} else {
		/* Also if both are wrong: what was right a moment ago is near the truth. */
		memcpy(params, &copy->params, sizeof(*params));
		memcpy(derived, &copy->derived, sizeof(*derived));
		copy->crc = crc_of(params, derived);
	}
	lw_set_copy_count(copy);
	return true;
}

bool lw_set_copy_due(struct lw_set_copy *copy)
{
	if (++copy->ticks < LW_SET_COPY_TICKS) {
		return false;
	}
	copy->ticks = 0;
	return true;
}

void lw_set_copy_count(struct lw_set_copy *copy)
{
	if (copy->corrections < UINT16_MAX) {
		copy->corrections++;
	}
}
