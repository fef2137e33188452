/* SPDX-License-Identifier: Apache-2.0 */
#include "lw/bytes/numbers.h"

int32_t lw_integer_sqrt(int64_t value)
{
	int64_t root = 0;

	for (int64_t bit = (int64_t)1 << 30; bit > 0; bit >>= 1) {
		if ((root + bit) * (root + bit) <= value) {
			root += bit;
		}
	}
	return (int32_t)root;
}
