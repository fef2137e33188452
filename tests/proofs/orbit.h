/* SPDX-License-Identifier: Apache-2.0 */
/*
 * The law in whole numbers, and the theorem about it: an edge leads from one place on the orbit to
 * another. doc/control-law.md, section 2, has both in words. The proof is in orbit.c; law.c proves
 * that lw/motion/law.h computes this law.
 *
 * ka: slope change per edge in a reversal; nr * ka: slope in the sweep; [begin, end): the sweep;
 * m: position; u: slope; d: the slope in units of ka, nr less the edges since the reversal began.
 */
#include <stdint.h>

/*@
  logic integer region(integer begin, integer end, integer m) =
    m < begin ? 1 : m >= end ? -1 : 0;

  // Change of the slope by an edge in direction dd, in units of ka.
  logic integer pull(integer begin, integer end, integer m, integer u, integer dd) =
    dd > 0 ? region(begin, end, m) : -region(begin, end, m - u);

  logic integer u_next(integer begin, integer end, integer ka, integer m, integer u, integer dd) =
    u + (pull(begin, end, m, u, dd) == 0 ? 0 : pull(begin, end, m, u, dd) > 0 ? ka : -ka);

  logic integer m_next(integer begin, integer end, integer ka, integer m, integer u, integer dd) =
    dd > 0 ? m + u_next(begin, end, ka, m, u, dd) : m - u;

  // Twice the way from the entry of the plus reversal to where the slope is d * ka; at 0 it is
  // twice the overshoot.
  logic integer run(integer ka, integer nr, integer d) = ka * ((nr - d) * (nr - 1 + d));

  // What lw_params_derive() guarantees; test_params.c has the same in C.
  predicate accepted(integer begin, integer end, integer ka, integer nr) =
    1 <= ka && 1 <= nr && ka * nr <= 65535 && end - begin >= 65536 &&
    2 * end + ka * nr * (nr - 1) <= 2 * (32699 * 65536) &&
    2 * begin - ka * nr * (nr - 1) >= -2 * (32699 * 65536);

  predicate orbit(integer begin, integer end, integer ka, integer nr,
		  integer m, integer u, integer d) =
    u == d * ka &&
    (m >= end  ? -nr < d <= nr && 0 <= 2 * (m - end) - run(ka, nr, d) < 2 * (ka * nr) :
     m < begin ? -nr <= d < nr && 0 < 2 * (begin - m) - run(ka, nr, -d) <= 2 * (ka * nr) :
     d == nr || d == -nr);

  predicate edge_stays(integer begin, integer end, integer ka, integer nr,
		       integer m, integer u, integer d, integer dd) =
    orbit(begin, end, ka, nr, m_next(begin, end, ka, m, u, dd), u_next(begin, end, ka, m, u, dd),
	  d + pull(begin, end, m, u, dd));
*/

/*@
  requires accepted(begin, end, ka, nr) && (dd == 1 || dd == -1);
  requires orbit(begin, end, ka, nr, m, u, d);
  assigns \nothing;
  ensures slope: -65535 <= -(ka * nr) <= u <= ka * nr <= 65535;
  ensures sweep: begin <= m < end ==> u == ka * nr || u == -(ka * nr);
  ensures plus: 2 * (m - end) < run(ka, nr, 0) + 2 * (ka * nr);
  ensures minus: 2 * (begin - m) <= run(ka, nr, 0) + 2 * (ka * nr);
  ensures small: -nr <= d <= nr && 1 <= nr <= 65535 && 1 <= ka <= 65535;
  ensures room: -65535 <= u_next(begin, end, ka, m, u, dd) <= 65535 &&
    -0x7FFFFFFF <= m_next(begin, end, ka, m, u, dd) <= 0x7FFFFFFF;
  ensures next: edge_stays(begin, end, ka, nr, m, u, d, dd);
*/
void orbit_is_kept(int begin, int end, int ka, int nr, int m, int u, int d, int dd);

/*@
  requires accepted(begin, end, ka, nr);
  requires 2 * (begin - m) == ka * (nr * (nr + 1)) || 2 * (m - end) == ka * (nr * (nr - 1));
  assigns \nothing;
  ensures orbit(begin, end, ka, nr, m, 0, 0);
*/
void far_point_is_on_orbit(int begin, int end, int ka, int nr, int m);

/*@
  requires edge_stays(begin, end, ka, nr, m, u, d, dd);
  requires m_after == m_next(begin, end, ka, m, u, dd);
  requires u_after == u_next(begin, end, ka, m, u, dd);
  requires d_after == d + pull(begin, end, m, u, dd);
  assigns \nothing;
  ensures orbit(begin, end, ka, nr, m_after, u_after, d_after);
*/
void orbit_is_reached(int begin, int end, int ka, int nr, int m, int u, int d, int dd, int m_after,
		      int u_after, int d_after);
