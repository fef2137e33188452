/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Independent watchdog: RM0390, 20.3 and 20.4. It runs on LSI, also while the flash is erased, and
 * nothing stops it but a reset.
 */
#include "parts.h"

#define KEY_RELOAD 0xAAAAu
#define KEY_ACCESS 0x5555u
#define KEY_START  0xCCCCu

/** Ticks of LSI that a change of prescaler or reload value takes (20.4.4: up to 5). */
#define UPDATE_TICKS 5u

static void plan(struct board *board)
{
	const struct iwdg *iwdg = &board->iwdg;
	const uint64_t divider = 4u << (iwdg->pr > 6 ? 6 : iwdg->pr);

	event_at(board, EVENT_IWDG,
		 iwdg->started ? iwdg->reloaded_ps +
					 ps_for((iwdg->rlr + 1u) * divider, board->config.lsi_hz)
			       : NEVER_PS);
}

void iwdg_event(struct board *board)
{
	board_reset(board, LW_BOARD_RESET_WATCHDOG);
}

void iwdg_reset(struct board *board)
{
	board->iwdg = (struct iwdg){.rlr = 0xFFF};
	event_at(board, EVENT_IWDG, NEVER_PS);
}

uint32_t iwdg_read(struct board *board, uint32_t offset)
{
	const struct iwdg *iwdg = &board->iwdg;

	switch (offset) {
	case 0x04:
		return iwdg->pr;
	case 0x08:
		return iwdg->rlr;
	case 0x0C:
		return (now_ps(board) < iwdg->pr_busy_ps ? 1u : 0) |
		       (now_ps(board) < iwdg->rlr_busy_ps ? 2u : 0);
	default:
		return 0;
	}
}

void iwdg_write(struct board *board, uint32_t offset, uint32_t value)
{
	struct iwdg *iwdg = &board->iwdg;
	const uint64_t updated_ps = now_ps(board) + ps_for(UPDATE_TICKS, board->config.lsi_hz);

	switch (offset) {
	case 0x00:
		iwdg->unlocked = value == KEY_ACCESS;
		if (value == KEY_START) {
			iwdg->started = true;
		}
		if (value == KEY_START || value == KEY_RELOAD) {
			iwdg->reloaded_ps = now_ps(board);
		}
		break;
	case 0x04:
	case 0x08:
		if (!iwdg->unlocked) {
			board_complain(board, "IWDG written without its key");
			return;
		}
		if (offset == 0x04) {
			iwdg->pr = value & 7u;
			iwdg->pr_busy_ps = updated_ps;
		} else {
			iwdg->rlr = value & 0xFFFu;
			iwdg->rlr_busy_ps = updated_ps;
		}
		break;
	default:
		return;
	}
	plan(board);
}
