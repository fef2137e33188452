/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What is on the pins (doc/wiring.md): the simulated winch, by lw_plant. Contacts close to ground,
 * so they read closed only where the firmware has its pull-up on.
 */
#include "parts.h"

static const struct {
	unsigned int no;
	unsigned int nc_port;
	unsigned int nc;
	unsigned int overtravel;
} sides[] = {
	[LW_PLANT_PLUS] = {4, PORT_B, 5, 8},
	[LW_PLANT_MINUS] = {10, PORT_A, 7, 9},
};

static void contact(struct board *board, unsigned int port, unsigned int pin, bool closed)
{
	gpio_drive(board, port, pin, closed ? DRIVE_LOW : DRIVE_FLOAT);
}

static void push_pull(struct board *board, unsigned int port, unsigned int pin, bool level)
{
	gpio_drive(board, port, pin, level ? DRIVE_HIGH : DRIVE_LOW);
}

static void show_b(struct board *board)
{
	event_at(board, EVENT_CHANNEL_B, NEVER_PS);
	push_pull(board, PIN_B, board->wiring.b);
}

void wiring_channel_b_event(struct board *board)
{
	show_b(board);
}

/** Channel B comes late by a part of a pulse, which is four transitions, but before A's next. */
static void show_encoder(struct board *board, uint32_t changed)
{
	struct wiring *wiring = &board->wiring;
	const uint64_t now = now_ps(board);
	const uint64_t late_ps =
		wiring->transition_spacing_ps * 4 * board->config.phase_error_permille / 1000;

	wiring->transition_spacing_ps = now - wiring->last_transition_ps;
	wiring->last_transition_ps = now;
	if (board->clock.due_ps[EVENT_CHANNEL_B] != NEVER_PS) {
		show_b(board);
	}
	wiring->b = wiring->plant.pins.encoder_b;
	if ((changed & LW_PLANT_ENCODER_B) != 0 && (changed & LW_PLANT_ENCODER_A) == 0 &&
	    late_ps > 0) {
		/* Slower than this, it is no matter. */
		event_at(board, EVENT_CHANNEL_B, now + (late_ps < PS_PER_S / 1000 ? late_ps : 1));
	} else if (changed & LW_PLANT_ENCODER_B) {
		show_b(board);
	}
	if (changed & LW_PLANT_ENCODER_A) {
		push_pull(board, PIN_A, wiring->plant.pins.encoder_a);
	}
}

static void show(struct board *board, uint32_t changed)
{
	const struct lw_plant_pins *pins = &board->wiring.plant.pins;

	if (changed & LW_PLANT_ENCODER) {
		show_encoder(board, changed);
	}
	if (changed & LW_PLANT_ENCODER_INDEX) {
		push_pull(board, PIN_INDEX, pins->encoder_index);
	}
	if (changed & LW_PLANT_STEPPER_ALARM) {
		contact(board, PORT_B, 6, pins->stepper_alarm);
	}
	if (changed & LW_PLANT_TRIM_BUTTONS) {
		contact(board, PORT_B, 14, pins->trim_buttons[0]); /* early */
		contact(board, PORT_B, 15, pins->trim_buttons[1]);
	}
	for (int side = 0; side < LW_PLANT_SIDES; side++) {
		if (changed & (LW_PLANT_LIMIT_PLUS << side)) {
			contact(board, PORT_B, sides[side].no, pins->limit[side].no_closed);
			contact(board, sides[side].nc_port, sides[side].nc,
				pins->limit[side].nc_closed);
		}
		if (changed & (LW_PLANT_OVERTRAVEL_PLUS << side)) {
			contact(board, PORT_B, sides[side].overtravel, !pins->overtravel[side]);
		}
	}
}

static void plan(struct board *board)
{
	event_at(board, EVENT_PLANT, lw_plant_next_event_ns(&board->wiring.plant) * PS_PER_NS);
}

void wiring_plant_event(struct board *board)
{
	show(board, lw_plant_advance(&board->wiring.plant));
	plan(board);
}

void wiring_show(struct board *board)
{
	board->wiring.b = board->wiring.plant.pins.encoder_b;
	gpio_drive(board, PORT_A, 10, DRIVE_HIGH); /* the line at rest */
	if (board->config.button) {
		gpio_drive(board, PORT_C, 13, DRIVE_LOW);
	} else {
		gpio_drive(board, PORT_C, 13, DRIVE_HIGH); /* the Nucleo has its own resistor */
	}
	show(board, UINT32_MAX);
}

/** The resistors that doc/wiring.md asks for keep enable high while the pin floats. */
static bool has_current(const struct board *board)
{
	return gpio_is_output(board, PIN_ENABLE) && !gpio_level(board, PIN_ENABLE);
}

void wiring_output(struct board *board, unsigned int port, unsigned int pin, bool level)
{
	struct wiring *wiring = &board->wiring;

	if (is_pin(port, pin, PIN_STEP) && level) {
		const int direction = gpio_level(board, PIN_DIR) ? 1 : -1;

		lw_plant_step(&wiring->plant, direction);
		seen_step(board, direction);
		plan(board);
	} else if (is_pin(port, pin, PIN_ENABLE)) {
		lw_plant_enable(&wiring->plant, has_current(board));
		plan(board);
	}
}

static bool never_running(const void *context)
{
	(void)context;
	return false;
}

bool wiring_create(struct board *board)
{
	struct wiring *wiring = &board->wiring;
	struct lw_plant_config config;

	lw_plant_config_default(&config);
	config.start_um = board->config.carriage_um;
	config.encoder_pulses_per_rev = board->config.encoder_pulses_per_rev;
	if (lw_plant_init(&wiring->plant, &config, board->config.seed) != 0) {
		return false;
	}
	lw_plant_bench_init(&wiring->bench, &wiring->plant);
	wiring->section = lw_plant_bench_section(&wiring->bench);
	wiring->bank = (struct lw_bank){.sections = &wiring->section, .section_count = 1};
	wiring->pdu_config = (struct lw_pdu_config){
		.bank = &wiring->bank,
		.is_running = never_running,
	};
	for (int i = 0; i < LW_DEVICE_ID_COUNT; i++) {
		wiring->pdu_config.device_id[i] = "";
	}
	lw_pdu_init(&wiring->pdu, &wiring->pdu_config);
	plan(board);
	return true;
}

size_t lw_board_bench(struct board *board, const uint8_t *request, size_t length, uint8_t *answer)
{
	struct wiring *wiring = &board->wiring;
	const size_t count = lw_pdu_handle(&wiring->pdu, request, length, answer);

	if (wiring->bench.power_cut) {
		wiring->bench.power_cut = false;
		if (wiring->bench.memory_kept) {
			board_reset(board, LW_BOARD_RESET_WATCHDOG);
		} else {
			lw_board_power_off(board);
			lw_board_power_on(board);
		}
	}
	plan(board);
	return count;
}

int lw_board_inject(struct board *board, int fault, int32_t argument)
{
	const int ret = lw_plant_inject(&board->wiring.plant, (enum lw_plant_fault)fault, argument);

	plan(board);
	return ret;
}

void lw_board_truth(struct board *board, struct lw_plant_truth *truth)
{
	lw_plant_read_truth(&board->wiring.plant, truth);
}
