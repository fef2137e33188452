/* SPDX-License-Identifier: Apache-2.0 */
#include "lw_lay.h"

#include <errno.h>
#include <math.h>

#include "lw/motion/law.h"

/** The nearest column at or beyond a place. */
static int32_t column_before(double mm)
{
	return (int32_t)floor(mm * LW_LAY_COLUMNS_PER_MM);
}

int lw_lay_prepare(const struct lw_params *params, uint32_t rope_um, struct lw_lay_pattern *pattern,
		   struct lw_refusal *why)
{
	struct lw_derived derived;
	int ret;

	ret = lw_params_derive(params, &derived, why);
	if (ret) {
		return ret;
	}
	if (rope_um < 1 || rope_um > LW_LAY_ROPE_UM_MAX) {
		return -ERANGE;
	}

	const double mm_per_q16 =
		(double)params->screw_lead_um / params->microsteps_per_rev / LW_USTEP / 1000.0;
	const double edges_per_rev =
		(double)params->encoder_pulses_per_rev * params->encoder_edges_per_pulse *
		params->encoder_ratio_numerator / params->encoder_ratio_denominator;
	const double minus_mm =
		((double)derived.reversal_minus_usteps * LW_USTEP - derived.overshoot_q16) *
		mm_per_q16;
	const double plus_mm =
		((double)derived.reversal_plus_usteps * LW_USTEP + derived.overshoot_q16) *
		mm_per_q16;
	const int32_t half = (int32_t)(rope_um * LW_LAY_COLUMNS_PER_MM / 2000u);

	*pattern = (struct lw_lay_pattern){
		.window = lw_params_window(params, &derived, 0, 0),
		/* At least two microsteps lie between the reversals: this is in the sweep. */
		.m = ((derived.reversal_plus_usteps + derived.reversal_minus_usteps) >> 1) *
		     LW_USTEP,
		.u = derived.ks,
		.mm_per_q16 = mm_per_q16,
		.edges_per_angle = edges_per_rev / LW_LAY_ANGLES,
		.first_judged = column_before(minus_mm),
	};
	pattern->judged = -column_before(-plus_mm) - pattern->first_judged + 1;
	pattern->first_column = pattern->first_judged - half;
	pattern->columns = pattern->judged + 2 * half;
	return 0;
}

/**
 * In the sweep an edge adds the slope to the position and does nothing else: take as many at once
 * as stay in it. Most of a pattern is sweep, so this makes a search ten times faster.
 *
 * @return edges taken, 0 to `edges`
 */
static uint64_t glide(struct lw_law *law, uint64_t edges)
{
	if (law->rel >= law->span) {
		return 0;
	}

	const uint32_t room = law->u > 0 ? law->span - 1 - law->rel : law->rel;
	const uint64_t most = room / (uint32_t)(law->u > 0 ? law->u : -law->u);
	const uint64_t taken = edges < most ? edges : most;

	law->rel += (uint32_t)taken * (uint32_t)law->u;
	return taken;
}

void lw_lay_positions(const struct lw_lay_pattern *pattern, double *position_mm, size_t count)
{
	struct lw_law law = lw_law_at(&pattern->window, pattern->m, pattern->u);
	uint64_t edges = 0;

	for (size_t i = 0; i < count; i++) {
		const uint64_t until = (uint64_t)llrint((double)i * pattern->edges_per_angle);

		edges += glide(&law, until - edges);
		for (; edges < until; edges++) {
			(void)lw_law_edge(&law, 1);
		}
		position_mm[i] = lw_law_m(&law) * pattern->mm_per_q16;
	}
}

void lw_lay_double_traverses(const struct lw_lay_pattern *pattern, uint64_t *edges, size_t count)
{
	struct lw_law law = lw_law_at(&pattern->window, pattern->m, pattern->u);
	uint64_t since = 0;
	size_t far_points = 0; /* the first ends no double traverse */

	while (far_points <= count) {
		since += glide(&law, UINT64_MAX);

		const int32_t before = law.u;

		(void)lw_law_edge(&law, 1);
		since++;
		/* Toward plus the slope is positive until the far point is reached. */
		if (before > 0 && law.u == 0) {
			if (far_points > 0) {
				edges[far_points - 1] = since;
			}
			far_points++;
			since = 0;
		}
	}
}
