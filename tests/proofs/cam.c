/* SPDX-License-Identifier: Apache-2.0 */
/*
 * An edge inside of a piece of a cam, with numerators of 32 bit (lw/cam/cam.h): the sum is exact,
 * nothing overflows, and the edge the other way undoes it. doc/cam.md.
 */
#include "lw/cam/cam.h"

/*@
  logic integer den(struct lw_cam *cam) = cam->piece.den;
  logic integer remainder(struct lw_cam *cam) = cam->point.numbers.remainder;
  logic integer slope(struct lw_cam *cam) = cam->point.numbers.slope;
  logic integer whole(struct lw_cam *cam) = cam->point.numbers.whole;
  logic integer curve(struct lw_cam *cam) = cam->piece.curve;
  logic integer whole_curve(struct lw_cam *cam) = cam->piece.whole_curve;

  // What the evaluation of a piece makes, kinds STRAIGHT and CURVED; test_cam.c tries it.
  predicate narrow(struct lw_cam *cam) =
    1 <= den(cam) <= 0x3FFFFFFF && 0 <= remainder(cam) < den(cam) && 0 <= slope(cam) < den(cam) &&
    0 <= curve(cam) < den(cam) && -1000 <= whole(cam) <= 1000 &&
    -1000 <= whole_curve(cam) <= 1000;
*/

/*@
  requires \valid(cam) && (dd == 1 || dd == -1) && narrow(cam);
  assigns cam->point.numbers.remainder;
  ensures 0 <= remainder(cam) < den(cam);
  behavior forward:
    assumes dd == 1;
    // steps * den + remainder == the remainder before + whole * den + slope, without a product.
    ensures (\result == whole(cam) && remainder(cam) == \old(remainder(cam)) + slope(cam)) ||
      (\result == whole(cam) + 1 &&
       remainder(cam) == \old(remainder(cam)) + slope(cam) - den(cam));
  behavior backward:
    assumes dd == -1;
    ensures (\result == -whole(cam) && remainder(cam) == \old(remainder(cam)) - slope(cam)) ||
      (\result == -whole(cam) - 1 &&
       remainder(cam) == \old(remainder(cam)) - slope(cam) + den(cam));
*/
static inline int lw_cam_inside_straight(struct lw_cam *cam, int dd);

/*@
  requires \valid(cam) && (dd == 1 || dd == -1) && narrow(cam);
  requires dd == -1 ==> -999 <= whole(cam) - whole_curve(cam) <= 1000;
  assigns cam->point.numbers.remainder, cam->point.numbers.slope, cam->point.numbers.whole;
  ensures 0 <= remainder(cam) < den(cam) && 0 <= slope(cam) < den(cam);
  behavior forward:
    assumes dd == 1;
    ensures (\result == \old(whole(cam)) &&
	     remainder(cam) == \old(remainder(cam)) + \old(slope(cam))) ||
      (\result == \old(whole(cam)) + 1 &&
       remainder(cam) == \old(remainder(cam)) + \old(slope(cam)) - den(cam));
    ensures (whole(cam) == \old(whole(cam)) + whole_curve(cam) &&
	     slope(cam) == \old(slope(cam)) + curve(cam)) ||
      (whole(cam) == \old(whole(cam)) + whole_curve(cam) + 1 &&
       slope(cam) == \old(slope(cam)) + curve(cam) - den(cam));
  behavior backward:
    assumes dd == -1;
    ensures (whole(cam) == \old(whole(cam)) - whole_curve(cam) &&
	     slope(cam) == \old(slope(cam)) - curve(cam)) ||
      (whole(cam) == \old(whole(cam)) - whole_curve(cam) - 1 &&
       slope(cam) == \old(slope(cam)) - curve(cam) + den(cam));
    ensures (\result == -whole(cam) && remainder(cam) == \old(remainder(cam)) - slope(cam)) ||
      (\result == -whole(cam) - 1 &&
       remainder(cam) == \old(remainder(cam)) - slope(cam) + den(cam));
*/
static inline int lw_cam_inside_curved(struct lw_cam *cam, int dd);

/*@
  requires \valid(cam) && (dd == 1 || dd == -1) && narrow(cam);
  assigns cam->point.numbers.remainder;
  ensures remainder(cam) == \old(remainder(cam));
  ensures \result == 0;
*/
int straight_there_and_back(struct lw_cam *cam, int dd)
{
	const int there = lw_cam_inside_straight(cam, dd);

	return there + lw_cam_inside_straight(cam, -dd);
}

/*@
  requires \valid(cam) && (dd == 1 || dd == -1) && narrow(cam);
  requires -990 <= whole(cam) - whole_curve(cam) <= 990;
  requires -990 <= whole(cam) + whole_curve(cam) <= 990 && -990 <= whole(cam) <= 990;
  assigns cam->point.numbers.remainder, cam->point.numbers.slope, cam->point.numbers.whole;
  ensures remainder(cam) == \old(remainder(cam)) && slope(cam) == \old(slope(cam));
  ensures whole(cam) == \old(whole(cam));
  ensures \result == 0;
*/
int curved_there_and_back(struct lw_cam *cam, int dd)
{
	const int there = lw_cam_inside_curved(cam, dd);

	return there + lw_cam_inside_curved(cam, -dd);
}

/*@
  axiomatic conversion {
    axiom uint32_of_uint64: \forall integer x;
      0 <= x < 0x8000000000000000 ==> (uint32_t)x == x % 0x100000000;
  }

  logic integer wide_remainder(struct lw_cam *cam) =
    cam->point.numbers.remainder_high * 0x100000000 + cam->point.numbers.remainder;
  logic integer wide_slope(struct lw_cam *cam) =
    cam->point.numbers.slope_high * 0x100000000 + cam->point.numbers.slope;

  predicate wide(struct lw_cam *cam) =
    1 <= den(cam) <= 0x3FFFFFFFFFFFFFFF && 0 <= wide_remainder(cam) < den(cam) &&
    0 <= wide_slope(cam) < den(cam) && 0 <= curve(cam) < den(cam) &&
    -1000 <= whole(cam) <= 1000 && -1000 <= whole_curve(cam) <= 1000;
*/

/*@
  requires 0 <= high <= 0x7FFFFFFF;
  assigns \nothing;
  ensures \result == high * 0x100000000 + low;
*/
static inline int64_t lw_cam_numerator(uint32_t high, uint32_t low);

/*@
  requires \valid(cam) && (dd == 1 || dd == -1) && wide(cam);
  assigns cam->point.numbers.remainder, cam->point.numbers.slope, cam->point.numbers.whole,
  cam->point.numbers.remainder_high, cam->point.numbers.slope_high; ensures 0 <= wide_remainder(cam)
  < den(cam) && 0 <= wide_slope(cam) < den(cam); behavior forward: assumes dd == 1; ensures (\result
  == \old(whole(cam)) && wide_remainder(cam) == \old(wide_remainder(cam)) + \old(wide_slope(cam)))
  ||
      (\result == \old(whole(cam)) + 1 &&
       wide_remainder(cam) == \old(wide_remainder(cam)) + \old(wide_slope(cam)) - den(cam));
    ensures (whole(cam) == \old(whole(cam)) + whole_curve(cam) &&
	     wide_slope(cam) == \old(wide_slope(cam)) + curve(cam)) ||
      (whole(cam) == \old(whole(cam)) + whole_curve(cam) + 1 &&
       wide_slope(cam) == \old(wide_slope(cam)) + curve(cam) - den(cam));
  behavior backward:
    assumes dd == -1;
    ensures (whole(cam) == \old(whole(cam)) - whole_curve(cam) &&
	     wide_slope(cam) == \old(wide_slope(cam)) - curve(cam)) ||
      (whole(cam) == \old(whole(cam)) - whole_curve(cam) - 1 &&
       wide_slope(cam) == \old(wide_slope(cam)) - curve(cam) + den(cam));
    ensures (\result == -whole(cam) &&
	     wide_remainder(cam) == \old(wide_remainder(cam)) - wide_slope(cam)) ||
      (\result == -whole(cam) - 1 &&
       wide_remainder(cam) == \old(wide_remainder(cam)) - wide_slope(cam) + den(cam));
*/
static inline int lw_cam_inside_wide(struct lw_cam *cam, int dd);
