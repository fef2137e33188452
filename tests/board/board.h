/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * A Nucleo-F446RE around an emulated Cortex-M4, with the winch of lw_plant on its pins.
 *
 * Runs the image of `./dev firmware nucleo_f446re` as it is. Time is virtual, and goes on only in
 * lw_board_run() and lw_board_exchange(). What it shows is the image against our reading of the
 * reference manual RM0390; what is modelled and what is not: doc/board.md. Not for interrupts; one
 * thread owns a board. Python calls this by ctypes (board.py).
 */
#ifndef LW_BOARD_H
#define LW_BOARD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lw/plant.h"

/** Code, and the storage behind it. */
#define LW_BOARD_FLASH_SIZE (512u * 1024u)

/** Interrupts and exceptions, by exception number: 16 + number of the interrupt. */
#define LW_BOARD_EXCEPTIONS 113

/** What differs from run to run. */
struct lw_board_config {
	uint64_t seed;
	int32_t carriage_um;           /**< where the carriage is at power-up */
	uint32_t cycles_permille;      /**< thousandths of a cycle that an instruction takes */
	uint32_t hse_hz;               /**< clock on OSC_IN; 0: none */
	uint32_t lsi_hz;               /**< 17 to 47 kHz (data sheet, 6.3.9) */
	uint32_t flash_word_ns;        /**< time to program a word */
	uint32_t flash_erase_us;       /**< time to erase a sector of 128 KiB */
	uint32_t phase_error_permille; /**< channel B late by so much of a pulse: 125 is 45 degrees
					*/
	uint32_t encoder_pulses_per_rev;
	uint32_t line_echo; /**< 1: the transceiver hears itself */
	uint32_t button;    /**< 1: the blue button is held */
};

/** Where the power goes in an operation of the flash. */
enum lw_board_cut {
	LW_BOARD_CUT_NEVER,
	LW_BOARD_CUT_BEFORE,
	LW_BOARD_CUT_IN,
	LW_BOARD_CUT_AFTER,
};

/** Why the processor began anew. */
enum lw_board_reset {
	LW_BOARD_RESET_POWER,
	LW_BOARD_RESET_SOFTWARE,
	LW_BOARD_RESET_WATCHDOG,
	LW_BOARD_RESETS,
};

/** What the pins and the processor have done since lw_board_clear_seen(). Times in ns. */
struct lw_board_seen {
	int64_t steps;   /**< net pulses, with the level of DIR at each */
	uint64_t pulses; /**< rising edges of STEP */
	uint64_t pulse_min_ns;
	uint64_t pulse_max_ns;
	uint64_t space_min_ns;     /**< STEP low between two pulses */
	uint64_t dir_setup_min_ns; /**< DIR changed before STEP rises */
	uint64_t dir_hold_min_ns;  /**< STEP fell before DIR changes */
	int64_t transitions;       /**< of A and B, net, decoded four to a pulse */
	int64_t edges;             /**< of A, net: two to a pulse, as the factory set counts */
	uint64_t transition_spacing_min_ns;
	uint64_t edge_to_step_max_ns; /**< from A's last edge to STEP, if that is one of its own */
	uint64_t de_before_min_ns;    /**< DE up before the first start bit */
	uint64_t de_after_max_ns;     /**< DE down after the last stop bit */
	uint64_t de_after_min_ns;
	uint64_t sent_without_driver; /**< bytes sent with DE low: nobody heard them */
	uint64_t instructions;
	uint64_t cycles;     /**< at work, not asleep or stalled */
	uint64_t stalled_ns; /**< waiting for the flash */
	uint64_t stall_max_ns;
	uint64_t elapsed_ns;
	uint64_t masked_max_instructions; /**< longest with interrupts masked */
	uint64_t flash_operations;
	uint64_t resets[LW_BOARD_RESETS];
};

/** What one exception has cost since lw_board_clear_seen(), without those inside of it. */
struct lw_board_cost {
	uint64_t count;
	uint64_t sum_instructions;
	uint32_t min_instructions;
	uint32_t max_instructions;
};

/** A byte that the controller has put on the line. */
struct lw_board_byte {
	uint64_t start_ns; /**< of the start bit */
	uint64_t end_ns;   /**< of the last stop bit */
	uint32_t baud_millihz;
	uint8_t value;
	uint8_t parity; /**< 0 none, 1 odd, 2 even */
	uint8_t stop_bits;
};

/** A change of a pin that is recorded. */
struct lw_board_change {
	uint64_t time_ns;
	uint8_t port; /**< 0: A */
	uint8_t pin;
	uint8_t level;
};

struct board;

/** Constants of a board with nothing wrong: HSE of 8 MHz, 32 kHz LSI, typical flash. */
void lw_board_config_default(struct lw_board_config *config);

/**
 * A board without power.
 * @param flash LW_BOARD_FLASH_SIZE bytes, the caller's; what the firmware stores stays in them
 * @return NULL if there is no memory, or the emulator cannot be had
 */
struct board *lw_board_create(const struct lw_board_config *config, uint8_t *flash);

void lw_board_destroy(struct board *board);

/** Give it power: memory undefined, the machine as it stands. */
void lw_board_power_on(struct board *board);

/** Take it away; the pins float, the stepper has no current. */
void lw_board_power_off(struct board *board);

/** Whether it has power: a cut by lw_board_cut_power() ends it. */
bool lw_board_powered(const struct board *board);

/**
 * Keep the whole board as it is, its machine and its flash included.
 * @return for lw_board_restore() of the same board, any number of times; NULL without memory
 */
struct lw_board_state *lw_board_save(struct board *board);

/** As it was when it was kept, its time included. */
void lw_board_restore(struct board *board, const struct lw_board_state *state);

void lw_board_forget(struct lw_board_state *state);

/** Let time pass. @return true; false if the power went */
bool lw_board_run_ns(struct board *board, uint64_t duration_ns);

/**
 * Run until so many instructions have been executed from now on, to the instruction, but not into a
 * block of IT; not longer than the duration.
 * @return how many have been
 */
uint64_t lw_board_run_instructions(struct board *board, uint64_t instructions,
				   uint64_t duration_ns);

/**
 * Run until an exception's handler is about to begin, not longer than the duration.
 * @param exception its number: 16 + the interrupt's
 * @return it has come
 */
bool lw_board_run_to_exception(struct board *board, unsigned int exception, uint64_t duration_ns);

/** The handler that runs now runs for ever. What may interrupt it still does. */
void lw_board_hang_handler(struct board *board);

uint64_t lw_board_now_ns(const struct board *board);

/**
 * What the master's port is set to.
 * @param baud 0: always as the controller's is, as a pseudo terminal is
 * @param parity 0 none, 1 odd, 2 even
 */
void lw_board_line_settings(struct board *board, uint32_t baud, unsigned int parity,
			    unsigned int stop_bits);

/** Bytes of the master, one close behind the other from now on, or from the end of those waiting.
 */
void lw_board_line_send(struct board *board, const uint8_t *bytes, size_t count);

/** What the controller has sent. @return how many; they are forgotten here */
size_t lw_board_line_read(struct board *board, struct lw_board_byte *bytes, size_t size);

/** Whether the master's bytes are all out and nothing is being sent. */
bool lw_board_line_idle(const struct board *board);

/**
 * Run until an answer has come whole: bytes, and then silence of silence_ns.
 * @return bytes of the answer
 */
size_t lw_board_answer(struct board *board, uint8_t *answer, size_t size, uint64_t silence_ns,
		       uint64_t timeout_ns);

/** A request to the registers of the simulated machine (from 0xF000). @return bytes of the answer
 */
size_t lw_board_bench(struct board *board, const uint8_t *request, size_t length, uint8_t *answer);

/** The simulated machine: lw_plant_inject(), lw_plant_read_truth(). */
int lw_board_inject(struct board *board, int fault, int32_t argument);
void lw_board_truth(struct board *board, struct lw_plant_truth *truth);

/** Let the power go at an operation of the flash, counted from now on. */
void lw_board_cut_power(struct board *board, uint64_t operation, enum lw_board_cut when);

void lw_board_seen(struct board *board, struct lw_board_seen *seen);
void lw_board_clear_seen(struct board *board);
void lw_board_cost(const struct board *board, struct lw_board_cost costs[LW_BOARD_EXCEPTIONS]);

/** Keep the changes of a pin; `size` of them at most until they are read. */
void lw_board_record(struct board *board, unsigned int port, unsigned int pin, bool on);
size_t lw_board_recorded(struct board *board, struct lw_board_change *changes, size_t size);

/** What the firmware has done that the manual forbids, a line each; empty if nothing. */
const char *lw_board_complaints(const struct board *board);

/** A register or memory, as a debugger sees it; word-wise, with the side effects of an access. */
uint32_t lw_board_peek(struct board *board, uint32_t address);
void lw_board_poke(struct board *board, uint32_t address, uint32_t value);
/** The processor's general registers: 0 to 15. */
uint32_t lw_board_register(struct board *board, unsigned int number);
void lw_board_set_register(struct board *board, unsigned int number, uint32_t value);

/** Does the firmware keep interrupts away, by PRIMASK or BASEPRI? */
bool lw_board_masked(struct board *board);

/** The external clock comes or fails. @param hse_hz 0: it is gone */
void lw_board_set_hse(struct board *board, uint32_t hse_hz);

/** Drive a pin from outside: 0 low, 1 high, 2 let it float; and its level. */
void lw_board_drive(struct board *board, unsigned int port, unsigned int pin, unsigned int drive);
bool lw_board_level(const struct board *board, unsigned int port, unsigned int pin);

/** What changed at the inputs of timers has passed their filters now: as if it had come earlier. */
void lw_board_pass_filters(struct board *board);

/** Does the processor sleep? Then nothing is under way, in a thread or in an interrupt. */
bool lw_board_asleep(const struct board *board);

/** Copy RAM, as a debugger does: no side effects. The range must lie inside of it. */
void lw_board_read_ram(const struct board *board, uint32_t address, uint8_t *bytes, size_t count);

/** Frequencies that the firmware has set up: 0 HCLK, 1 PCLK1, 2 PCLK2. */
uint32_t lw_board_clock_hz(const struct board *board, unsigned int which);

#endif /* LW_BOARD_H */
