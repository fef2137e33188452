/**
 * @file
 * What controller.c (inputs, modes, commands), homing.c (every motion by simulated edges),
 * tracking.c (following the drum, LOS) and cam_tracking.c (following it by the cam) share.
 */
#ifndef LW_CONTROLLER_INTERNAL_H
#define LW_CONTROLLER_INTERNAL_H

#include "lw/controller.h"

/** A trigger that the supervisor has taken, or none. */
struct lw_controller_trigger {
	bool taken;
	struct lw_limit_switch_trigger at;
};

/** Stop all step pulses now. What the interrupt was asked for is dropped. */
void lw_controller_cut(struct lw_controller *controller);

/** Stop with a named fault; the index is lost. */
void lw_controller_fail(struct lw_controller *controller, enum lw_fault fault);

/** The window that is not in force, to be filled before it is handed over. */
struct lw_law_window *lw_controller_spare_window(struct lw_controller *controller);

/** The law's window for tracking, trim included. */
struct lw_law_window lw_controller_track_window(const struct lw_controller *controller);

/** Ask the interrupt to take a window, in the manner of `request`. */
void lw_controller_request(struct lw_controller *controller, struct lw_law_window window,
			   enum lw_motion_request request, int32_t correction_usteps);

/** Direction of the carriage's motion toward `side`: true if it moves that way. */
bool lw_controller_moves_toward(int direction, int side);

/* homing.c */
void lw_homing_start(struct lw_controller *controller);
void lw_homing_tick(struct lw_controller *controller, const struct lw_controller_trigger *triggers);
/** Move the resting carriage, which is at m (Q16.16); on arrival enter `rest_state`. */
void lw_homing_move_to(struct lw_controller *controller, int32_t m, int32_t target_usteps,
		       enum lw_state moving_state, enum lw_state rest_state);
/** Ramp down; a carriage whose place is known stops inside the sweep. */
void lw_homing_halt(struct lw_controller *controller, enum lw_state rest_state);

/* tracking.c */
/** Let the drum move what has been placed, by the law or by a cam. */
void lw_tracking_begin(struct lw_controller *controller);
/** Follow the drum by the law from here. */
void lw_tracking_start(struct lw_controller *controller);
/** Stop following a resting drum. The carriage stands; it can go on as if nothing had been. */
void lw_tracking_leave(struct lw_controller *controller);
void lw_tracking_tick(struct lw_controller *controller,
		      const struct lw_controller_trigger *triggers);

/* cam_tracking.c */
/**
 * Follow the drum by the cam from here, or go to where that begins; `cam_refusal` says if neither
 * can be.
 */
void lw_cam_hand_over(struct lw_controller *controller);

#endif /* LW_CONTROLLER_INTERNAL_H */
