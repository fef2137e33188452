/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What edge_cost.py counts the instructions of: the law alone, and whole encoder interrupts around
 * the core's real path, as they would be on an STM32F446. Its registers are plain memory here.
 */
#include <stddef.h>
#include <string.h>

#include "lw/control/cam_check.h"
#include "lw/control/controller.h"

/* Where these registers are is said by symbols that the linker is given (edge_cost.py). */

/** Timers 2 and 3: the one decodes the encoder, the other gives one pulse. */
extern struct {
	volatile uint32_t encoder_cr1;
	uint32_t reserved_1[3];
	volatile uint32_t encoder_sr;
	uint32_t reserved_2[251];
	volatile uint32_t pulse_cr1;
} timers_2_3;

/** The interrupts of pins, and timer 9 for one pulse. */
extern struct {
	uint32_t reserved_1[5];
	volatile uint32_t pr;
	uint32_t reserved_2[250];
	volatile uint32_t pulse_cr1;
} exti_timer_9;

extern volatile uint32_t encoder_idr; /**< of a port: channel B at pin 0, A at pin 1 */
extern volatile uint32_t dir;         /**< bit-band alias of one output */

#define CR1_DIR     (1u << 4)
#define CR1_OPM_CEN (1u << 3 | 1u << 0)

static struct lw_params params;
static struct lw_derived derived;
struct lw_controller controller;

static struct lw_cam_bank bank;
struct lw_cam_row cam_rows[LW_CAM_ROWS_MAX]; /**< written by edge_cost.py */

/** For edge_cost.py. */
const uint32_t law_offset = offsetof(struct lw_controller, motion.law);
const uint32_t law_size = sizeof(struct lw_law);

int setup(int32_t m, int32_t u);
int law_forward(struct lw_law *law);
int law_backward(struct lw_law *law);
void hardware_interrupt(void);
void software_interrupt(void);
int setup_cam(int interpolation, uint32_t count);
int cam_edge(int dd);
void prepare_cam(void);

/** The factory pattern, every transition an edge, at a position and slope. @return Ks */
int setup(int32_t m, int32_t u)
{
	const struct lw_inputs inputs = {0};
	struct lw_refusal why;

	params = lw_params_default;
	params.encoder_edges_per_pulse = 4;
	params.expert_mode = 1;
	if (lw_params_derive(&params, &derived, &why)) {
		return 0;
	}
	lw_controller_init(&controller, &params, &derived, &inputs, 0);
	lw_motion_set_position(&controller.motion, controller.motion.window, m,
			       u > 0 ? derived.ks : -derived.ks);
	lw_motion_set_source(&controller.motion, LW_EDGE_SOURCE_ENCODER);
	/* What the first edge after a change does. */
	controller.motion.law.open_span = controller.motion.law.span;
	return derived.ks;
}

int law_forward(struct lw_law *law)
{
	return lw_law_short_edge(law, law->open_span, 1);
}

int law_backward(struct lw_law *law)
{
	return lw_law_short_edge(law, law->open_span, -1);
}

static inline void give(int step, volatile uint32_t *pulse_cr1)
{
	if (step != 0) {
		dir = (uint32_t)(step >> 1); /* its lowest bit is the pin */
		*pulse_cr1 = CR1_OPM_CEN;
	}
}

/** The timer decodes and counts. */
void hardware_interrupt(void)
{
	timers_2_3.encoder_sr = 0;
	give(lw_controller_drum_edge(&controller, timers_2_3.encoder_cr1 & CR1_DIR ? -1 : 1),
	     &timers_2_3.pulse_cr1);
}

/** Every transition of a channel interrupts, and is decoded here. */
void software_interrupt(void)
{
	uint32_t levels;

	exti_timer_9.pr = 3;
	levels = encoder_idr;
	give(lw_controller_encoder(&controller, levels & 2, levels & 1), &exti_timer_9.pulse_cr1);
}

/** What the supervisor does for the cam in every tick. */
void prepare_cam(void)
{
	lw_cam_motion_prepare(&controller.motion.cam);
}

/** Follow the table in cam_rows from its begin. @return 0, or what is wrong with it */
int setup_cam(int interpolation, uint32_t count)
{
	struct lw_cam_refusal why;
	struct lw_cam_motion *cam = &controller.motion.cam;

	if (setup(0, 1) == 0) {
		return -1;
	}
	params.cam_start = LW_CAM_START_RELATIVE;
	params.cam_steps_per_s_max = 4 * params.overspeed_trip_edges_per_s;
	bank.table.interpolation = (uint16_t)interpolation;
	bank.table.row_count = (uint16_t)count;
	memcpy(bank.table.rows, cam_rows, count * sizeof(cam_rows[0]));
	bank.crc = lw_cam_bank_crc(&bank);
	if (lw_cam_bank_check(&bank, &params, &bank.statistics, &why)) {
		return why.reason;
	}

	const struct lw_cam_scale scale = lw_cam_params_scale(&params);

	lw_cam_start(&cam->cam, &bank.table, &scale, 0, 0);
	cam->steps_max = LW_CAM_STEPS_PER_EDGE_MAX;
	cam->unfollowed_edges = controller.motion.unfollowed_edges;
	cam->on = true;
	cam->ring.count = 0;
	prepare_cam();
	controller.motion.law.open_span = 0;
	/* What the first edge after a change does. */
	lw_cam_motion_open(cam, 1);
	return 0;
}

/** A drum edge that the cam takes: counted, and the long way. */
int cam_edge(int dd)
{
	return lw_motion_encoder_edge(&controller.motion, dd);
}

#if __ARM_ARCH == 6
/* Armv6-M has no atomic read-modify-write; on one core, with nothing that interrupts, this is. */
uint8_t __atomic_fetch_or_1(volatile void *at, uint8_t bits, int order);
uint8_t __atomic_fetch_and_1(volatile void *at, uint8_t bits, int order);

uint8_t __atomic_fetch_or_1(volatile void *at, uint8_t bits, int order)
{
	volatile uint8_t *byte = at;
	const uint8_t before = *byte;

	(void)order;
	*byte = before | bits;
	return before;
}

uint8_t __atomic_fetch_and_1(volatile void *at, uint8_t bits, int order)
{
	volatile uint8_t *byte = at;
	const uint8_t before = *byte;

	(void)order;
	*byte = before & bits;
	return before;
}
#endif
