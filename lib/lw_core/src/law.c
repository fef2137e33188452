#include "lw/law.h"

bool lw_law_rests(struct lw_law *law, int dd)
{
	const uint32_t at = dd > 0 ? law->rel : law->rel - (uint32_t)law->u;
	const uint32_t dwell_edges =
		at >= law->below_from ? law->dwell_minus_edges : law->dwell_plus_edges;

	if (at < law->span) {
		return false;
	}
	/* At the far point the dwell counts up going forward, down going back. */
	if (law->u == 0 && dd > 0 && law->dwell_edges < dwell_edges) {
		law->dwell_edges++;
		return true;
	}
	if (law->u == 0 && dd < 0 && law->dwell_edges > 0) {
		law->dwell_edges--;
		return true;
	}
	/* Going back to a far point: its whole dwell lies between there and the entry. */
	law->dwell_edges = dd < 0 && law->u == lw_law_slope_change(law, at) ? dwell_edges : 0;
	return false;
}
