/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Time in picoseconds, and one event for each part that does something by itself.
 *
 * While the processor runs, the time is that of its cycles; else it is set. No drift: the base
 * moves only when the frequency does, or when time passes without the processor.
 */
#include "parts.h"

typedef unsigned __int128 wide;

uint64_t ticks_in(uint64_t ps, uint64_t hz)
{
	return (uint64_t)((wide)ps * hz / PS_PER_S);
}

uint64_t ps_for(uint64_t ticks, uint64_t hz)
{
	return (uint64_t)(((wide)ticks * PS_PER_S + hz - 1) / hz);
}

uint64_t now_ps(const struct board *board)
{
	const struct clock *clock = &board->clock;

	if (clock->event_ps != 0) {
		return clock->event_ps;
	}

	const uint64_t q16 = board->core.cycles_q16 - clock->base_q16 +
			     (uint64_t)board->core.access_instructions *
				     board->config.cycles_permille * 65536u / 1000u;

	return clock->base_ps + (uint64_t)((wide)q16 * clock->ps_per_cycle_q32 >> 48);
}

uint64_t clock_q16_until(const struct board *board, uint64_t ps)
{
	const struct clock *clock = &board->clock;

	if (ps <= clock->base_ps) {
		return clock->base_q16;
	}
	return clock->base_q16 +
	       (uint64_t)(((wide)(ps - clock->base_ps) << 48) / clock->ps_per_cycle_q32) + 1;
}

void clock_set(struct board *board, uint64_t ps)
{
	board->clock.base_ps = ps;
	board->clock.base_q16 = board->core.cycles_q16;
}

void clock_frequency(struct board *board, uint32_t hclk_hz)
{
	/* An access in the middle of a block would change the time of what stands before it. */
	const uint32_t access = board->core.access_instructions;
	const uint64_t now = now_ps(board);

	board->core.access_instructions = 0;
	board->clock.base_q16 = board->core.cycles_q16 +
				(uint64_t)access * board->config.cycles_permille * 65536u / 1000u;
	board->clock.base_ps = now;
	board->core.access_instructions = access;
	board->clock.ps_per_cycle_q32 = (uint64_t)(((wide)PS_PER_S << 32) / hclk_hz);
}

void event_at(struct board *board, enum event event, uint64_t ps)
{
	struct clock *clock = &board->clock;

	clock->due_ps[event] = ps;
	clock->next_ps = NEVER_PS;
	for (int i = 0; i < EVENTS; i++) {
		if (clock->due_ps[i] < clock->next_ps) {
			clock->next_ps = clock->due_ps[i];
		}
	}
	if (board->core.running && clock->next_ps < clock->limit_ps) {
		clock->limit_ps = clock->next_ps;
		board->core.limit_q16 = clock_q16_until(board, clock->limit_ps);
	}
}

static void run_event(struct board *board, enum event event)
{
	switch (event) {
	case EVENT_PLANT:
		wiring_plant_event(board);
		break;
	case EVENT_CHANNEL_B:
		wiring_channel_b_event(board);
		break;
	case EVENT_RCC:
		rcc_event(board);
		break;
	case EVENT_SYSTICK:
		core_systick_event(board);
		break;
	case EVENT_TIM2_INPUT:
	case EVENT_TIM3_INPUT:
	case EVENT_TIM4_INPUT:
	case EVENT_TIM5_INPUT:
		timer_input_event(board, event - EVENT_TIM2_INPUT);
		break;
	case EVENT_TIM2:
	case EVENT_TIM3:
	case EVENT_TIM4:
	case EVENT_TIM5:
		timer_event(board, event - EVENT_TIM2);
		break;
	case EVENT_USART_TX:
		usart_tx_event(board);
		break;
	case EVENT_USART_RX:
		usart_rx_event(board);
		break;
	case EVENT_USART_IDLE:
		usart_idle_event(board);
		break;
	case EVENT_FLASH:
		flash_event(board);
		break;
	case EVENT_IWDG:
		iwdg_event(board);
		break;
	case EVENTS:
		break;
	}
}

void event_catch_up(struct board *board, enum event event)
{
	struct clock *clock = &board->clock;
	const uint64_t until_ps = now_ps(board);
	const uint64_t outer_ps = clock->event_ps;

	while (clock->due_ps[event] <= until_ps) {
		clock->event_ps = clock->due_ps[event];
		event_at(board, event, NEVER_PS);
		run_event(board, event);
		clock->event_ps = outer_ps;
	}
}

void clock_run_events(struct board *board)
{
	struct clock *clock = &board->clock;

	while (clock->next_ps <= now_ps(board)) {
		int event = 0;

		while (clock->due_ps[event] != clock->next_ps) {
			event++;
		}
		/* What happens, happens then, though the processor may be a few instructions on. */
		const uint64_t due_ps = clock->next_ps;

		event_at(board, event, NEVER_PS); /* whose event it is sets the next one */
		clock->event_ps = due_ps;
		run_event(board, event);
		clock->event_ps = 0;
	}
}
