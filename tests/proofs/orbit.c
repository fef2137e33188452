/* SPDX-License-Identifier: Apache-2.0 */
#include "orbit.h"

/*@
  requires 1 <= ka <= 65535 && 1 <= nr <= 65535 && -nr < d <= nr;
  assigns \nothing;
  ensures run(ka, nr, d) >= 0;
*/
static void run_is_not_negative(int ka, int nr, int d)
{
	//@ assert (nr - d) * (nr - 1 + d) >= 0;
}

/*@
  requires 1 <= ka <= 65535 && 1 <= nr <= 65535 && -nr <= d <= nr;
  assigns \nothing;
  ensures run(ka, nr, d) <= run(ka, nr, 0);
*/
static void run_is_largest_at_rest(int ka, int nr, int d)
{
	//@ assert d * (d - 1) >= 0;
	//@ assert ka * (d * (d - 1)) >= 0;
}

/*@
  requires 1 <= ka <= 65535 && 1 <= nr <= 65535 && -nr <= d <= nr;
  assigns \nothing;
  ensures run(ka, nr, d - 1) == run(ka, nr, d) + 2 * (d * ka - ka);
  ensures run(ka, nr, d + 1) == run(ka, nr, d) - 2 * (d * ka);
*/
static void run_grows_by_the_slope(int ka, int nr, int d)
{
}

/*@
  requires 1 <= ka && 1 <= nr && ka * nr <= 65535;
  assigns \nothing;
  ensures ka <= 65535 && nr <= 65535;
*/
static void both_are_small(int ka, int nr)
{
}

/*@
  requires 1 <= ka <= 65535 && 1 <= nr <= 65535 && -nr <= d <= nr;
  assigns \nothing;
  ensures -(ka * nr) <= d * ka <= ka * nr;
  ensures d < nr ==> d * ka <= ka * nr - ka;
  ensures -nr < d ==> d * ka >= ka - ka * nr;
*/
static void slope_is_bounded(int ka, int nr, int d)
{
}

void orbit_is_kept(int begin, int end, int ka, int nr, int m, int u, int d, int dd)
{
	//@ assert -nr <= d <= nr;
	both_are_small(ka, nr);
	slope_is_bounded(ka, nr, d);
	run_is_largest_at_rest(ka, nr, d);
	run_is_largest_at_rest(ka, nr, -d);
	run_grows_by_the_slope(ka, nr, d);
	run_grows_by_the_slope(ka, nr, -d);
	if (-nr < d) {
		run_is_not_negative(ka, nr, d);
	}
	if (d < nr) {
		run_is_not_negative(ka, nr, -d);
	}
	if (-nr < d - 1) {
		run_is_not_negative(ka, nr, d - 1);
	}
	if (d + 1 < nr) {
		run_is_not_negative(ka, nr, -d - 1);
	}
	if (dd > 0) {
		if (m >= end) {
			//@ assert d - 1 > -nr ==> m + u - ka >= end;
			//@ assert d - 1 == -nr ==> begin <= m + u - ka < end;
			//@ assert orbit(begin, end, ka, nr, m + u - ka, u - ka, d - 1);
			//@ assert edge_stays(begin, end, ka, nr, m, u, d, dd);
		} else if (m < begin) {
			//@ assert d + 1 < nr ==> m + u + ka < begin;
			//@ assert d + 1 == nr ==> begin <= m + u + ka < end;
			//@ assert orbit(begin, end, ka, nr, m + u + ka, u + ka, d + 1);
			//@ assert edge_stays(begin, end, ka, nr, m, u, d, dd);
		} else {
			//@ assert orbit(begin, end, ka, nr, m + u, u, d);
			//@ assert edge_stays(begin, end, ka, nr, m, u, d, dd);
		}
	} else {
		if (m - u >= end) {
			//@ assert orbit(begin, end, ka, nr, m - u, u + ka, d + 1);
			//@ assert edge_stays(begin, end, ka, nr, m, u, d, dd);
		} else if (m - u < begin) {
			//@ assert orbit(begin, end, ka, nr, m - u, u - ka, d - 1);
			//@ assert edge_stays(begin, end, ka, nr, m, u, d, dd);
		} else {
			//@ assert orbit(begin, end, ka, nr, m - u, u, d);
			//@ assert edge_stays(begin, end, ka, nr, m, u, d, dd);
		}
	}
}

void far_point_is_on_orbit(int begin, int end, int ka, int nr, int m)
{
	both_are_small(ka, nr);
	//@ assert nr * (nr + 1) == nr * (nr - 1) + 2 * nr;
	//@ assert ka * (nr * (nr + 1)) == ka * (nr * (nr - 1)) + 2 * (ka * nr);
	//@ assert nr * (nr - 1) >= 0;
	//@ assert ka * (nr * (nr - 1)) >= 0;
	//@ assert run(ka, nr, 0) == ka * (nr * (nr - 1));
}

void orbit_is_reached(int begin, int end, int ka, int nr, int m, int u, int d, int dd, int m_after,
		      int u_after, int d_after)
{
}
