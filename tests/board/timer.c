/* SPDX-License-Identifier: Apache-2.0 */
/*
 * General-purpose timers TIM2 to TIM5: RM0390, 17.3.1 (time base), 17.3.2 (counting up), 17.3.8 and
 * 17.3.9 (output compare, PWM), 17.3.10 (one pulse), 17.3.12 (encoder), 17.4 (registers). Not here:
 * counting down or centred other than by an encoder, input capture, slave modes but the encoder's,
 * DMA.
 */
#include "parts.h"

#define CR1_CEN  (1u << 0)
#define CR1_UDIS (1u << 1)
#define CR1_URS  (1u << 2)
#define CR1_OPM  (1u << 3)
#define CR1_DIR  (1u << 4)
#define CR1_CMS  (3u << 5)
#define CR1_ARPE (1u << 7)
#define SR_UIF   1u
#define EGR_UG   1u

enum {
	OC_FROZEN,
	OC_ACTIVE,
	OC_INACTIVE,
	OC_TOGGLE,
	OC_LOW,
	OC_HIGH,
	OC_PWM1,
	OC_PWM2
};

/** Pins that a channel can have: the data sheet's table 11. */
static const struct {
	uint8_t timer; /**< 0: TIM2 */
	uint8_t channel;
	uint8_t port;
	uint8_t pin;
	uint8_t function;
} pins[] = {
	{0, 0, 0, 0, 1}, {0, 0, 0, 5, 1},  {0, 0, 0, 15, 1}, {0, 1, 0, 1, 1}, {0, 1, 1, 3, 1},
	{0, 2, 0, 2, 1}, {0, 2, 1, 10, 1}, {0, 3, 0, 3, 1},  {0, 3, 1, 2, 1}, {1, 0, 0, 6, 2},
	{1, 0, 1, 4, 2}, {1, 0, 2, 6, 2},  {1, 1, 0, 7, 2},  {1, 1, 1, 5, 2}, {1, 1, 2, 7, 2},
	{1, 2, 1, 0, 2}, {1, 2, 2, 8, 2},  {1, 3, 1, 1, 2},  {1, 3, 2, 9, 2}, {2, 0, 1, 6, 2},
	{2, 1, 1, 7, 2}, {2, 2, 1, 8, 2},  {2, 3, 1, 9, 2},  {3, 0, 0, 0, 2}, {3, 1, 0, 1, 2},
	{3, 2, 0, 2, 2}, {3, 3, 0, 3, 2},
};

static const uint8_t irqs[TIMERS] = {28, 29, 30, 50};

/** TIM3 and TIM4 have 16 bits (17.1). */
static uint32_t width_mask(unsigned int index)
{
	return index == 0 || index == 3 ? 0xFFFFFFFFu : 0xFFFFu;
}

static bool by_encoder(const struct timer *timer)
{
	const uint32_t mode = timer->smcr & 7u;

	return mode >= 1 && mode <= 3;
}

/** A channel is an output, or an input of its own pin or the other's (17.4.7, CCxS). */
static unsigned int selection(const struct timer *timer, unsigned int channel)
{
	return timer->ccmr[channel / 2] >> (8 * (channel % 2)) & 3u;
}

/** ARR 0 blocks the counter (17.4.12). */
static bool counts(const struct timer *timer)
{
	return (timer->cr1 & CR1_CEN) != 0 && timer->arr_now != 0 && !by_encoder(timer);
}

static uint64_t tick_hz(const struct board *board)
{
	return board->rcc.timer_hz[0];
}

static uint32_t count_now(const struct board *board, const struct timer *timer)
{
	if (!counts(timer)) {
		return timer->base_count;
	}
	return timer->base_count +
	       (uint32_t)(ticks_in(now_ps(board) - timer->base_ps, tick_hz(board)) /
			  (timer->psc_now + 1));
}

static void update_line(struct board *board, unsigned int index)
{
	const struct timer *timer = &board->timers[index];

	core_line(board, irqs[index], (timer->sr & timer->dier & 0x5Fu) != 0);
}

static unsigned int oc_mode(const struct timer *timer, unsigned int channel)
{
	return timer->ccmr[channel / 2] >> (8 * (channel % 2) + 4) & 7u;
}

/** A compare value comes into force with the next update event only (17.4.7, OCxPE). */
static bool preloads(const struct timer *timer, unsigned int channel)
{
	return selection(timer, channel) == 0 &&
	       (timer->ccmr[channel / 2] >> (8 * (channel % 2) + 3) & 1u) != 0;
}

/** What the outputs are at a count. */
static void show(struct board *board, unsigned int index, uint32_t count)
{
	struct timer *timer = &board->timers[index];

	for (unsigned int channel = 0; channel < 4; channel++) {
		const bool below = count < timer->ccr_now[channel];
		const uint32_t bits = timer->ccer >> (4 * channel) & 3u;
		bool reference = timer->references >> channel & 1u;

		if (selection(timer, channel) != 0) {
			continue;
		}
		switch (oc_mode(timer, channel)) {
		case OC_LOW:
			reference = false;
			break;
		case OC_HIGH:
			reference = true;
			break;
		case OC_PWM1:
			reference = below;
			break;
		case OC_PWM2:
			reference = !below;
			break;
		default:
			break;
		}
		timer->references = (uint8_t)((timer->references & ~(1u << channel)) |
					      (uint32_t)reference << channel);
		for (size_t i = 0; i < sizeof(pins) / sizeof(pins[0]); i++) {
			if (pins[i].timer == index && pins[i].channel == channel &&
			    gpio_is(board, pins[i].port, pins[i].pin, pins[i].function)) {
				gpio_peripheral(board, pins[i].port, pins[i].pin,
						(bits & 1u) != 0 &&
							reference != ((bits & 2u) != 0));
			}
		}
	}
}

static void plan(struct board *board, unsigned int index)
{
	struct timer *timer = &board->timers[index];
	const uint32_t count = count_now(board, timer);
	uint32_t next = timer->arr_now + 1; /* 0 where 32 bits run over */

	if (!counts(timer)) {
		event_at(board, EVENT_TIM2 + index, NEVER_PS);
		return;
	}
	for (unsigned int channel = 0; channel < 4; channel++) {
		const uint32_t match = timer->ccr_now[channel];

		if (match > count && match <= timer->arr_now && match - 1 < next - 1) {
			next = match;
		}
	}
	if (count > timer->arr_now) {
		next = 0; /* ARR was lowered below it: to the end of its width */
	}
	timer->next_count = next;

	const uint64_t ticks =
		(uint64_t)(next != 0 ? next : width_mask(index) + 1ull) - timer->base_count;

	event_at(board, EVENT_TIM2 + index,
		 timer->base_ps + ps_for(ticks * (timer->psc_now + 1), tick_hz(board)));
}

/** An update event: preloads come into force, and one pulse ends (17.3.2, 17.3.10). */
static void update_event(struct timer *timer, bool by_software)
{
	if (timer->cr1 & CR1_UDIS) {
		return;
	}
	timer->psc_now = timer->psc;
	timer->arr_now = timer->arr;
	for (unsigned int channel = 0; channel < 4; channel++) {
		timer->ccr_now[channel] = timer->ccr[channel];
	}
	if (!by_software || (timer->cr1 & CR1_URS) == 0) {
		timer->sr |= SR_UIF;
	}
	if (timer->cr1 & CR1_OPM) {
		timer->cr1 &= ~CR1_CEN;
	}
}

static void matched(struct timer *timer, uint32_t count)
{
	for (unsigned int channel = 0; channel < 4; channel++) {
		const uint8_t bit = (uint8_t)(1u << channel);

		if (timer->ccr_now[channel] != count || selection(timer, channel) != 0) {
			continue;
		}
		timer->sr |= 2u << channel;
		switch (oc_mode(timer, channel)) {
		case OC_ACTIVE:
			timer->references |= bit;
			break;
		case OC_INACTIVE:
			timer->references &= (uint8_t)~bit;
			break;
		case OC_TOGGLE:
			timer->references ^= bit;
			break;
		default:
			break;
		}
	}
}

void timer_event(struct board *board, unsigned int index)
{
	struct timer *timer = &board->timers[index];

	timer->base_ps = now_ps(board);
	timer->base_count = timer->next_count;
	if (timer->next_count == timer->arr_now + 1 || timer->next_count == 0) {
		timer->base_count = 0;
		update_event(timer, false);
	}
	matched(timer, timer->base_count);
	show(board, index, timer->base_count);
	update_line(board, index);
	plan(board, index);
}

void timer_rebase(struct board *board)
{
	for (unsigned int i = 0; i < TIMERS; i++) {
		struct timer *timer = &board->timers[i];

		if (counts(timer)) {
			board_complain(board, "the clock of TIM%u changes while it counts", i + 2);
			timer->base_ps = now_ps(board);
		}
		plan(board, i);
	}
}

/** One count either way, by a channel's edge and the level of the other (17.3.12, table 93). */
static void encoder_edge(struct board *board, unsigned int index, unsigned int channel, bool input)
{
	struct timer *timer = &board->timers[index];
	const bool other = timer->inputs >> (1 - channel) & 1u;
	const bool up = channel == 0 ? input != other : input == other;

	timer->inputs = (uint8_t)((timer->inputs & ~(1u << channel)) | (uint32_t)input << channel);
	/* Mode 1 counts TI2's edges, mode 2 TI1's, mode 3 both (17.4.3). */
	if (!by_encoder(timer) || (timer->cr1 & CR1_CEN) == 0 ||
	    (timer->smcr & 7u) == 1u + channel) {
		return;
	}
	timer->cr1 = up ? timer->cr1 & ~CR1_DIR : timer->cr1 | CR1_DIR;
	if (up) {
		timer->base_count = timer->base_count == timer->arr_now ? 0 : timer->base_count + 1;
	} else {
		timer->base_count = timer->base_count == 0 ? timer->arr_now : timer->base_count - 1;
	}
	if (timer->base_count == (up ? 0 : timer->arr_now)) {
		update_event(timer, false);
	}
	matched(timer, timer->base_count);
	update_line(board, index);
}

/** Time between two samples of an input's filter, and how many alike it wants (17.4.7, ICxF). */
static void filter_of(const struct board *board, const struct timer *timer, unsigned int channel,
		      uint64_t *period_ps, unsigned int *samples)
{
	static const struct {
		uint8_t divider; /**< of fDTS; 0: CK_INT itself */
		uint8_t samples;
	} filters[16] = {
		{1, 1}, {0, 2}, {0, 4},  {0, 8},  {2, 6},  {2, 8},  {4, 6},  {4, 8},
		{8, 6}, {8, 8}, {16, 5}, {16, 6}, {16, 8}, {32, 5}, {32, 6}, {32, 8},
	};
	const unsigned int code = timer->ccmr[0] >> (8 * channel + 4) & 15u;
	const uint64_t dts = 1ull << (timer->cr1 >> 8 & 3u); /* CKD (17.4.1) */
	const unsigned int divider = filters[code].divider;

	*samples = filters[code].samples;
	*period_ps = ps_for(divider == 0 ? 1 : divider * dts, tick_hz(board));
}

static void plan_inputs(struct board *board, unsigned int index)
{
	const struct timer *timer = &board->timers[index];

	event_at(board, EVENT_TIM2_INPUT + index,
		 timer->input_ps[0] < timer->input_ps[1] ? timer->input_ps[0] : timer->input_ps[1]);
}

void timer_input_event(struct board *board, unsigned int index)
{
	struct timer *timer = &board->timers[index];
	const unsigned int channel = timer->input_ps[0] <= timer->input_ps[1] ? 0 : 1;

	timer->input_ps[channel] = NEVER_PS;
	encoder_edge(board, index, channel, !(timer->inputs >> channel & 1u));
	plan_inputs(board, index);
}

void timer_pass_filters(struct board *board)
{
	for (unsigned int index = 0; index < TIMERS; index++) {
		struct timer *timer = &board->timers[index];

		for (unsigned int channel = 0; channel < 2; channel++) {
			if (timer->input_ps[channel] != NEVER_PS) {
				timer->input_ps[channel] = now_ps(board);
			}
		}
		plan_inputs(board, index);
	}
}

/** A level counts when it has been the same in as many samples as the filter wants (17.4.7). */
void timer_pin(struct board *board, unsigned int port, unsigned int pin, bool level)
{
	for (size_t i = 0; i < sizeof(pins) / sizeof(pins[0]); i++) {
		const unsigned int index = pins[i].timer;
		const unsigned int channel = pins[i].channel;
		struct timer *timer = &board->timers[index];
		uint64_t period_ps;
		uint64_t first;
		unsigned int samples;
		bool input;

		if (channel > 1 || pins[i].port != port || pins[i].pin != pin ||
		    !gpio_is(board, port, pin, pins[i].function) ||
		    selection(timer, channel) != 1) {
			continue;
		}
		input = level != ((timer->ccer >> (4 * channel + 1) & 1u) != 0);
		timer->input_ps[channel] = NEVER_PS;
		if (input != (timer->inputs >> channel & 1u)) {
			filter_of(board, timer, channel, &period_ps, &samples);
			first = (now_ps(board) + period_ps - 1) / period_ps;
			if (samples == 1) {
				encoder_edge(board, index, channel, input);
			} else {
				timer->input_ps[channel] = (first + samples - 1) * period_ps;
			}
		}
		plan_inputs(board, index);
	}
}

/** What stands on the pins when they become inputs of the timer has been there before. */
static void look_at_inputs(struct board *board, unsigned int index)
{
	struct timer *timer = &board->timers[index];

	for (size_t i = 0; i < sizeof(pins) / sizeof(pins[0]); i++) {
		const unsigned int channel = pins[i].channel;

		if (pins[i].timer == index && channel < 2 && selection(timer, channel) == 1 &&
		    gpio_is(board, pins[i].port, pins[i].pin, pins[i].function)) {
			const bool input = gpio_level(board, pins[i].port, pins[i].pin) !=
					   ((timer->ccer >> (4 * channel + 1) & 1u) != 0);

			timer->inputs = (uint8_t)((timer->inputs & ~(1u << channel)) |
						  (uint32_t)input << channel);
			timer->input_ps[channel] = NEVER_PS;
		}
	}
	plan_inputs(board, index);
}

void timer_reset(struct board *board, unsigned int index)
{
	board->timers[index] = (struct timer){
		.arr = width_mask(index),
		.arr_now = width_mask(index),
		.input_ps = {NEVER_PS, NEVER_PS},
	};
	plan_inputs(board, index);
	show(board, index, 0);
	update_line(board, index);
	plan(board, index);
}

uint32_t timer_read(struct board *board, unsigned int index, uint32_t offset)
{
	struct timer *timer = &board->timers[index];

	event_catch_up(board, EVENT_TIM2_INPUT + index);
	event_catch_up(board, EVENT_TIM2 + index);
	switch (offset) {
	case 0x00:
		return timer->cr1;
	case 0x04:
		return timer->cr2;
	case 0x08:
		return timer->smcr;
	case 0x0C:
		return timer->dier;
	case 0x10:
		return timer->sr;
	case 0x18:
	case 0x1C:
		return timer->ccmr[(offset - 0x18) / 4];
	case 0x20:
		return timer->ccer;
	case 0x24:
		return count_now(board, timer);
	case 0x28:
		return timer->psc;
	case 0x2C:
		return timer->arr;
	case 0x34:
	case 0x38:
	case 0x3C:
	case 0x40:
		return timer->ccr[(offset - 0x34) / 4];
	default:
		return 0;
	}
}

void timer_write(struct board *board, unsigned int index, uint32_t offset, uint32_t value)
{
	struct timer *timer = &board->timers[index];
	uint32_t count;

	event_catch_up(board, EVENT_TIM2_INPUT + index);
	event_catch_up(board, EVENT_TIM2 + index);
	count = count_now(board, timer);
	if (counts(timer) && (offset == 0x00 || offset == 0x08)) {
		/* What stops or starts keeps its count; the prescaler's part of one is lost. */
		timer->base_ps = now_ps(board);
		timer->base_count = count;
	}
	switch (offset) {
	case 0x00:
		if ((value & (CR1_CMS | CR1_DIR)) != 0 && !by_encoder(timer)) {
			board_complain(board, "TIM%u counts down: not modelled", index + 2);
		}
		if ((value & ~timer->cr1 & CR1_CEN) != 0) {
			timer->base_ps = now_ps(board);
			look_at_inputs(board, index);
		}
		/* DIR is read only where an encoder counts (17.4.1). */
		timer->cr1 = by_encoder(timer)
				     ? (value & 0x3FFu & ~CR1_DIR) | (timer->cr1 & CR1_DIR)
				     : value & 0x3FFu;
		break;
	case 0x04:
		timer->cr2 = value;
		break;
	case 0x08:
		if ((value & 7u) > 3) {
			board_complain(board, "TIM%u: slave mode %u is not modelled", index + 2,
				       value & 7u);
		}
		timer->smcr = value;
		break;
	case 0x0C:
		timer->dier = value;
		break;
	case 0x10: /* cleared by a 0 */
		timer->sr &= value;
		break;
	case 0x14:
		if (value & EGR_UG) {
			timer->base_ps = now_ps(board);
			timer->base_count = 0;
			update_event(timer, true);
		}
		timer->sr |= value & 0x1Eu;
		break;
	case 0x18:
	case 0x1C:
		timer->ccmr[(offset - 0x18) / 4] = value;
		look_at_inputs(board, index);
		break;
	case 0x20:
		timer->ccer = value;
		for (unsigned int channel = 0; channel < 4; channel++) {
			if ((value >> (4 * channel) & 1u) != 0 && selection(timer, channel) != 0) {
				board_complain(board, "TIM%u captures: not modelled", index + 2);
			}
		}
		break;
	case 0x24:
		timer->base_ps = now_ps(board);
		timer->base_count = value & width_mask(index);
		break;
	case 0x28:
		timer->psc = value & 0xFFFFu;
		break;
	case 0x2C:
		timer->arr = value & width_mask(index);
		if ((timer->cr1 & CR1_ARPE) == 0) {
			const bool stood = !counts(timer);

			timer->arr_now = timer->arr;
			if (stood) {
				timer->base_ps = now_ps(board);
			}
		}
		break;
	case 0x34:
	case 0x38:
	case 0x3C:
	case 0x40:
		timer->ccr[(offset - 0x34) / 4] = value & width_mask(index);
		if (!preloads(timer, (offset - 0x34) / 4)) {
			timer->ccr_now[(offset - 0x34) / 4] = value & width_mask(index);
		}
		break;
	default:
		return;
	}
	show(board, index, count_now(board, timer));
	update_line(board, index);
	plan(board, index);
}
