/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * Following the drum by the cam: how that begins.
 */
#ifndef LW_CAM_TRACKING_H
#define LW_CAM_TRACKING_H

#include "lw/control/carriage.h"

/**
 * Follow the drum by the cam from here, or go to where that begins; `cam_refusal` says if neither
 * can be.
 */
void lw_cam_hand_over(struct lw_controller *controller);

#endif /* LW_CAM_TRACKING_H */
