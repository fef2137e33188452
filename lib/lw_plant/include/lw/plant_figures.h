/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The figures of a machine by name, in the units in which people measure them: what a machine file
 * holds. One table for every host and tool; a value that is no whole number is a double, and a word
 * is its number in the figure's list.
 */
#ifndef LW_PLANT_FIGURES_H
#define LW_PLANT_FIGURES_H

#include <stdbool.h>
#include <stddef.h>

#include "lw/plant.h"

/** One figure of struct lw_plant_config. */
struct lw_plant_figure {
	const char *name; /**< with its unit, as "screw_lead_mm"; NULL ends the table */
	double min;
	double max;
	const char *const *words; /**< what 0, 1, ... are called, NULL at the end; or NULL */
	bool whole;               /**< only whole numbers */
};

/** All figures, in the order in which a file tells them. */
extern const struct lw_plant_figure lw_plant_figures[];

/**
 * @brief Set a figure by name. What fits which other figure, lw_plant_config_check() says.
 *
 * @param value in the unit of the name; rounded to what the configuration holds, micrometres or
 *              microseconds
 *
 * @retval 0       set
 * @retval -ENOENT there is no such figure
 * @retval -ERANGE below min, above max, not finite, or not whole; nothing changed
 */
int lw_plant_config_set(struct lw_plant_config *config, const char *name, double value);

/**
 * @brief Read a figure by name.
 *
 * @retval 0       read
 * @retval -ENOENT there is no such figure
 */
int lw_plant_config_get(const struct lw_plant_config *config, const char *name, double *value);

#endif /* LW_PLANT_FIGURES_H */
