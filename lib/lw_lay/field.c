/* SPDX-License-Identifier: Apache-2.0 */
#include "lw_lay.h"

#include <errno.h>
#include <math.h>
#include <string.h>

/** Of the judged surface a twentieth lies below. */
#define LOW_PART 0.05

int lw_lay_bare(struct lw_lay_field *field, float *height_mm, int32_t first_column, int32_t columns,
		uint32_t rope_um)
{
	if (height_mm == NULL || columns < 1 || rope_um < 1 || rope_um > LW_LAY_ROPE_UM_MAX) {
		return -EINVAL;
	}
	field->height_mm = height_mm;
	field->first_column = first_column;
	field->columns = columns;
	field->half = (int32_t)(rope_um * LW_LAY_COLUMNS_PER_MM / 2000u);
	for (int32_t i = -field->half; i <= field->half; i++) {
		const double radius_mm = rope_um / 2000.0;
		const double off_mm = (double)i / LW_LAY_COLUMNS_PER_MM;

		field->rise_mm[field->half + i] =
			(float)sqrt(radius_mm * radius_mm - off_mm * off_mm);
	}
	memset(height_mm, 0, sizeof(*height_mm) * LW_LAY_ANGLES * (size_t)columns);
	return 0;
}

double lw_lay_rope(struct lw_lay_field *field, int angle, double position_mm)
{
	const int32_t centre =
		(int32_t)lrint(position_mm * LW_LAY_COLUMNS_PER_MM) - field->first_column;
	const int32_t from = centre - field->half > 0 ? centre - field->half : 0;
	const int32_t to =
		centre + field->half < field->columns ? centre + field->half : field->columns - 1;
	float *row = field->height_mm + (size_t)angle * (size_t)field->columns;
	/* On a bare drum it lies on its lowest point. */
	float rest = field->rise_mm[field->half];

	for (int32_t i = from; i <= to; i++) {
		const float touching = row[i] + field->rise_mm[i - centre + field->half];

		rest = touching > rest ? touching : rest;
	}
	for (int32_t i = from; i <= to; i++) {
		const float top = rest + field->rise_mm[i - centre + field->half];

		row[i] = top > row[i] ? top : row[i];
	}
	return (double)rest;
}

void lw_lay_path(struct lw_lay_field *field, const double *position_mm, size_t count,
		 double *centre_mm)
{
	for (size_t i = 0; i < count; i++) {
		const double rest = lw_lay_rope(field, (int)(i % LW_LAY_ANGLES), position_mm[i]);

		if (centre_mm != NULL) {
			centre_mm[i] = rest;
		}
	}
}

/** Put the value of a rank at its place; what stands before is not higher, what follows not lower.
 */
static float select_rank(float *values, size_t count, size_t rank)
{
	size_t from = 0;
	size_t to = count - 1;

	while (from < to) {
		const float pivot = values[from + (to - from) / 2];
		size_t low = from;
		size_t high = to;

		while (low <= high) {
			while (values[low] < pivot) {
				low++;
			}
			while (values[high] > pivot) {
				high--;
			}
			if (low <= high) {
				const float swapped = values[low];

				values[low++] = values[high];
				values[high] = swapped;
				if (high == 0) {
					break;
				}
				high--;
			}
		}
		if (rank <= high) {
			to = high;
		} else if (rank >= low) {
			from = low;
		} else {
			break;
		}
	}
	return values[rank];
}

int lw_lay_judge(const struct lw_lay_field *field, int32_t first_column, int32_t columns,
		 float *scratch, struct lw_lay_evenness *evenness)
{
	const int32_t first = first_column - field->first_column;

	if (columns < 1 || first < 0 || first > field->columns - columns) {
		return -EINVAL;
	}

	const size_t width = (size_t)columns;
	const size_t count = width * LW_LAY_ANGLES;
	double sum_mm = 0;
	double squares_mm2 = 0;
	float max_mm = 0;

	for (size_t angle = 0; angle < LW_LAY_ANGLES; angle++) {
		memcpy(scratch + angle * width,
		       field->height_mm + angle * (size_t)field->columns + first,
		       width * sizeof(*scratch));
	}
	for (size_t i = 0; i < count; i++) {
		sum_mm += (double)scratch[i];
		max_mm = scratch[i] > max_mm ? scratch[i] : max_mm;
	}
	evenness->max_mm = (double)max_mm;
	evenness->mean_mm = sum_mm / (double)count;
	for (size_t i = 0; i < count; i++) {
		const double off_mm = (double)scratch[i] - evenness->mean_mm;

		squares_mm2 += off_mm * off_mm;
	}
	evenness->std_mm = sqrt(squares_mm2 / (double)count);

	/* At least LW_LAY_ANGLES values: the rank above is one of them, too. */
	const double place = LOW_PART * (double)(count - 1);
	const size_t rank = (size_t)place;
	const float low_mm = select_rank(scratch, count, rank);
	float above_mm = scratch[rank + 1];

	for (size_t i = rank + 1; i < count; i++) {
		above_mm = scratch[i] < above_mm ? scratch[i] : above_mm;
	}
	evenness->p5_mm = (double)low_mm + (place - (double)rank) * (double)(above_mm - low_mm);
	return 0;
}
