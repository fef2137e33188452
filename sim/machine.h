/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The machine that a parameter set describes: the one on which that set is right.
 */
#ifndef LW_MACHINE_H
#define LW_MACHINE_H

#include "lw/control/params.h"
#include "lw/plant.h"

/**
 * @brief Make the machine that a parameter set describes.
 *
 * What a set does not say is as with the default machine: the motor, friction, bounce. The factory
 * set gives the default machine. A set whose travel has no room beyond its flanges gets a
 * machine with a little more. A switch_delay_us of 0 counts as not measured.
 *
 * @param params any set that lw_params_derive() takes
 * @param machine receives a configuration that lw_plant_config_check() takes
 */
void lw_machine_of_params(const struct lw_params *params, struct lw_plant_config *machine);

#endif /* LW_MACHINE_H */
