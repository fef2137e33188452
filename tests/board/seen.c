/* SPDX-License-Identifier: Apache-2.0 */
/*
 * What the pins did, and what the processor took for it.
 */
#include "parts.h"

#include <string.h>

/** A pulse that comes later than this is none of the edge's: the carriage moves by itself. */
#define EDGE_TO_STEP_MAX_PS (200ull * PS_PER_US)

static void least(uint64_t *value, uint64_t other)
{
	*value = other < *value ? other : *value;
}

static void most(uint64_t *value, uint64_t other)
{
	*value = other > *value ? other : *value;
}

void seen_clear(struct board *board)
{
	struct pins_seen *pins = &board->pins;

	memset(&pins->seen, 0, sizeof(pins->seen));
	memset(pins->costs, 0, sizeof(pins->costs));
	for (int i = 0; i < LW_BOARD_EXCEPTIONS; i++) {
		pins->costs[i].min_instructions = UINT32_MAX;
	}
	pins->seen.pulse_min_ns = UINT64_MAX;
	pins->seen.space_min_ns = UINT64_MAX;
	pins->seen.dir_setup_min_ns = UINT64_MAX;
	pins->seen.dir_hold_min_ns = UINT64_MAX;
	pins->seen.transition_spacing_min_ns = UINT64_MAX;
	pins->seen.de_before_min_ns = UINT64_MAX;
	pins->seen.de_after_min_ns = UINT64_MAX;
	pins->since_ps = now_ps(board);
	pins->cycles_q16 = board->core.cycles_q16;
	pins->instructions = board->core.instructions;
	pins->operations = board->flash.operations;
}

static void see_encoder(struct board *board, bool is_a, bool level)
{
	static const int8_t moves[4][4] = {/* from, to: A is bit 1, B bit 0; A leads for + */
					   {0, -1, 1, 0},
					   {1, 0, 0, -1},
					   {-1, 0, 0, 1},
					   {0, 1, -1, 0}};
	struct pins_seen *pins = &board->pins;
	const uint8_t bit = is_a ? 2 : 1;
	const uint8_t after = (uint8_t)((pins->encoder & ~bit) | (level ? bit : 0));
	const int8_t step = moves[pins->encoder][after];
	const uint64_t now = now_ps(board);

	pins->seen.transitions += step;
	if (is_a) {
		pins->seen.edges += step;
		pins->edge_ps = now;
	}
	pins->encoder = after;
	least(&pins->seen.transition_spacing_min_ns, (now - pins->encoder_ps) / PS_PER_NS);
	pins->encoder_ps = now;
}

static void see_step_pin(struct board *board, bool level)
{
	struct pins_seen *pins = &board->pins;
	const uint64_t now = now_ps(board);

	if (level) {
		pins->seen.pulses++;
		least(&pins->seen.space_min_ns, (now - pins->step_fall_ps) / PS_PER_NS);
		least(&pins->seen.dir_setup_min_ns, (now - pins->dir_ps) / PS_PER_NS);
		if (now - pins->edge_ps < EDGE_TO_STEP_MAX_PS) {
			most(&pins->seen.edge_to_step_max_ns, (now - pins->edge_ps) / PS_PER_NS);
		}
		pins->step_rise_ps = now;
	} else {
		least(&pins->seen.pulse_min_ns, (now - pins->step_rise_ps) / PS_PER_NS);
		most(&pins->seen.pulse_max_ns, (now - pins->step_rise_ps) / PS_PER_NS);
		pins->step_fall_ps = now;
	}
}

static void see_driver_enable(struct board *board, bool level)
{
	struct pins_seen *pins = &board->pins;
	const uint64_t now = now_ps(board);

	if (level) {
		pins->de_rise_ps = now;
	} else if (pins->sent_end_ps > pins->de_rise_ps) {
		least(&pins->seen.de_after_min_ns, (now - pins->sent_end_ps) / PS_PER_NS);
		most(&pins->seen.de_after_max_ns, (now - pins->sent_end_ps) / PS_PER_NS);
	}
}

void seen_sent(struct board *board, uint64_t start_ps, uint64_t end_ps)
{
	struct pins_seen *pins = &board->pins;

	/* The first byte since the driver was turned on. */
	if (pins->sent_end_ps <= pins->de_rise_ps && start_ps >= pins->de_rise_ps) {
		least(&pins->seen.de_before_min_ns, (start_ps - pins->de_rise_ps) / PS_PER_NS);
	}
	pins->sent_end_ps = end_ps;
}

void seen_step(struct board *board, int direction)
{
	board->pins.seen.steps += direction;
}

void seen_pin(struct board *board, unsigned int port, unsigned int pin, bool level)
{
	struct pins_seen *pins = &board->pins;

	if (board->ports[port].recorded >> pin & 1u && pins->change_count < CHANGES_MAX) {
		pins->changes[pins->change_count++] = (struct lw_board_change){
			.time_ns = now_ps(board) / PS_PER_NS,
			.port = (uint8_t)port,
			.pin = (uint8_t)pin,
			.level = level,
		};
	}
	if (is_pin(port, pin, PIN_A) || is_pin(port, pin, PIN_B)) {
		see_encoder(board, is_pin(port, pin, PIN_A), level);
	} else if (is_pin(port, pin, PIN_STEP)) {
		see_step_pin(board, level);
	} else if (is_pin(port, pin, PIN_DIR)) {
		if (pins->step_fall_ps > 0) {
			least(&pins->seen.dir_hold_min_ns,
			      (now_ps(board) - pins->step_fall_ps) / PS_PER_NS);
		}
		pins->dir_ps = now_ps(board);
	} else if (is_pin(port, pin, PIN_DE)) {
		see_driver_enable(board, level);
	}
}

void seen_cost(struct board *board, unsigned int exception, uint64_t instructions)
{
	struct lw_board_cost *cost = &board->pins.costs[exception];

	cost->count++;
	cost->sum_instructions += instructions;
	if (instructions < cost->min_instructions) {
		cost->min_instructions = (uint32_t)instructions;
	}
	if (instructions > cost->max_instructions) {
		cost->max_instructions = (uint32_t)instructions;
	}
}

void seen_stall(struct board *board, uint64_t from_ps, uint64_t to_ps)
{
	struct pins_seen *pins = &board->pins;

	/* One wait comes in pieces, between the events that fall into it. */
	if (from_ps != pins->stall_to_ps) {
		pins->stall_from_ps = from_ps;
	}
	pins->stall_to_ps = to_ps;
	pins->seen.stalled_ns += (to_ps - from_ps) / PS_PER_NS;
	most(&pins->seen.stall_max_ns, (to_ps - pins->stall_from_ps) / PS_PER_NS);
}

void lw_board_clear_seen(struct board *board)
{
	seen_clear(board);
}

void lw_board_seen(struct board *board, struct lw_board_seen *seen)
{
	const struct pins_seen *pins = &board->pins;

	*seen = pins->seen;
	seen->instructions = board->core.instructions - pins->instructions;
	seen->cycles = (board->core.cycles_q16 - pins->cycles_q16) >> 16;
	seen->elapsed_ns = (now_ps(board) - pins->since_ps) / PS_PER_NS;
	seen->flash_operations = board->flash.operations - pins->operations;
}

void lw_board_cost(const struct board *board, struct lw_board_cost costs[LW_BOARD_EXCEPTIONS])
{
	memcpy(costs, board->pins.costs, sizeof(board->pins.costs));
}

void lw_board_record(struct board *board, unsigned int port, unsigned int pin, bool on)
{
	struct port *it = &board->ports[port];

	it->recorded = (uint16_t)(on ? it->recorded | 1u << pin : it->recorded & ~(1u << pin));
}

size_t lw_board_recorded(struct board *board, struct lw_board_change *changes, size_t size)
{
	struct pins_seen *pins = &board->pins;
	const size_t count = pins->change_count < size ? pins->change_count : size;

	memcpy(changes, pins->changes, count * sizeof(*changes));
	memmove(pins->changes, pins->changes + count,
		(pins->change_count - count) * sizeof(*changes));
	pins->change_count -= count;
	return count;
}
