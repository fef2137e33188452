/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * What the carriage shall do: off, follow the drum, stand at the centre.
 */
#ifndef LW_MODES_H
#define LW_MODES_H

#include "lw/control/carriage.h"

/** Bring the requested mode into force, as soon as that may be. Every tick. */
void lw_modes_tick(struct lw_controller *controller);

#endif /* LW_MODES_H */
