/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The parts of the board, and what they need of each other. Not for its users.
 *
 * Every part has its registers in one struct, `x_read()` and `x_write()` for the bus, and where it
 * does something by itself, one event in the queue of clock.c.
 */
#ifndef BOARD_PARTS_H
#define BOARD_PARTS_H

#include <unicorn/unicorn.h>

#include "board.h"
#include "lw/modbus/pdu.h"
#include "lw/plant_bench.h"

#define PS_PER_NS 1000u
#define PS_PER_US 1000000u
#define PS_PER_S  1000000000000u
#define NEVER_PS  UINT64_MAX

#define FLASH_BASE   0x08000000u
#define STORAGE_BASE 0x08040000u /**< sectors 6 and 7; the image is in those before */
#define RAM_BASE     0x20000000u
#define RAM_SIZE     0x20000u

/** In the order in which they happen at the same time. */
enum event {
	EVENT_PLANT,
	EVENT_CHANNEL_B,
	EVENT_RCC,
	EVENT_SYSTICK,
	EVENT_TIM2_INPUT,
	EVENT_TIM3_INPUT,
	EVENT_TIM4_INPUT,
	EVENT_TIM5_INPUT,
	EVENT_TIM2,
	EVENT_TIM3,
	EVENT_TIM4,
	EVENT_TIM5,
	EVENT_USART_TX,
	EVENT_USART_RX,
	EVENT_USART_IDLE,
	EVENT_FLASH,
	EVENT_IWDG,
	EVENTS,
};

/* ---- clock.c: time and the event queue ------------------------------------------------------ */

struct clock {
	uint64_t base_ps; /**< when the processor had done base_q16 cycles */
	uint64_t base_q16;
	uint64_t ps_per_cycle_q32;
	uint64_t due_ps[EVENTS];
	uint64_t next_ps;
	uint64_t limit_ps; /**< the processor runs up to here */
	uint64_t event_ps; /**< time of the event that is being run; 0: none is */
};

uint64_t now_ps(const struct board *board);
/** Ticks of a clock that have passed in a time, and the time at which as many have. */
uint64_t ticks_in(uint64_t ps, uint64_t hz);
uint64_t ps_for(uint64_t ticks, uint64_t hz);
void event_at(struct board *board, enum event event, uint64_t ps);
/** Time passes without the processor. */
void clock_set(struct board *board, uint64_t ps);
void clock_frequency(struct board *board, uint32_t hclk_hz);
/** Cycles, in 65536ths, that the processor may do until then. */
uint64_t clock_q16_until(const struct board *board, uint64_t ps);
void clock_run_events(struct board *board);
/** Before a part's registers are looked at: what fell into the block that is being executed. */
void event_catch_up(struct board *board, enum event event);

/* ---- core.c: exceptions, NVIC, SCB, SysTick ------------------------------------------------- */

enum exception {
	EXCEPTION_NMI = 2,
	EXCEPTION_HARD = 3,
	EXCEPTION_MEMORY = 4,
	EXCEPTION_BUS = 5,
	EXCEPTION_USAGE = 6,
	EXCEPTION_SVC = 11,
	EXCEPTION_PENDSV = 14,
	EXCEPTION_SYSTICK = 15,
	EXCEPTION_IRQ0 = 16,
};

struct active {
	uint16_t number;
	uint64_t own_instructions; /**< before the exceptions inside of it */
};

/** Instructions that are executed in one piece. */
struct block {
	uint16_t size;
	uint8_t instructions;
	uint8_t flags;
};

struct core {
	struct block *blocks;  /**< those of the image, by address; measured when first seen */
	uint64_t cycles_q16;   /**< done, up to the block that is being executed */
	uint64_t limit_q16;    /**< stop before the first block from here on */
	uint64_t instructions; /**< likewise */
	uint64_t measured_from;
	uint32_t block_address;
	uint32_t block_size;
	uint32_t block_instructions; /**< of the block that is being executed */
	uint32_t block_flags;
	uint32_t block_accesses;      /**< so far in it */
	uint32_t access_instructions; /**< of them before the access that is being done */
	bool running;
	uint64_t stop_at;            /**< instruction to stop before; UINT64_MAX: none */
	unsigned int hung_depth;     /**< what runs this deep hangs; 0: nothing does */
	unsigned int stop_exception; /**< stop before its first instruction; 0: none */
	uint32_t stop_address;       /**< the same, within the next block; 0: not yet */
	bool attention; /**< something has changed that the next block boundary must look at */
	bool sleeping;
	bool locked_up;
	bool reset_requested;
	uint32_t exc_return; /**< seen, not yet done; 0: none */
	uint32_t svc;
	uint32_t fault; /**< exception that an instruction has raised; 0: none */
	uint32_t fault_address;

	struct active active[32];
	unsigned int depth;
	bool pending[LW_BOARD_EXCEPTIONS];
	bool enabled[LW_BOARD_EXCEPTIONS];
	bool line[LW_BOARD_EXCEPTIONS];
	bool is_active[LW_BOARD_EXCEPTIONS];
	unsigned int pending_count;
	uint8_t priority[LW_BOARD_EXCEPTIONS];
	uint32_t vtor;
	uint32_t aircr;
	uint32_t scr;
	uint32_t ccr;
	uint32_t shcsr;
	uint32_t cfsr;
	uint32_t hfsr;
	uint32_t bfar;
	uint32_t other[64]; /**< MPU, CPACR and what else is kept, but does nothing */
	uint32_t dwt_ctrl;
	uint32_t demcr;
	uint64_t dwt_base_ps;

	uint32_t systick_ctrl;
	uint32_t systick_load;
	uint32_t systick_reload;  /**< the one that counts */
	uint64_t systick_zero_ps; /**< when it was 0 */
	bool systick_counted;

	bool masked;
	uint64_t masked_since;
};

bool core_create(struct board *board);
void core_reset(struct board *board);
/** Before an access to a peripheral by the processor: sets the time to that of its instruction. */
void core_access(struct board *board);
/** Run, sleep or wait until then, or until something stops it. */
void core_run(struct board *board, uint64_t until_ps);
void core_line(struct board *board, unsigned int irq, bool level);
void core_pend(struct board *board, unsigned int exception);
uint32_t core_read(struct board *board, uint32_t offset, unsigned int size);
void core_write(struct board *board, uint32_t offset, uint32_t value, unsigned int size);
void core_systick_event(struct board *board);
void core_systick_rebase(struct board *board);

/* ---- rcc.c: clocks and resets (RM0390, 6), PWR (5) ------------------------------------------- */

struct rcc {
	uint32_t cr;
	uint32_t pllcfgr;
	uint32_t cfgr;
	uint32_t cir;
	uint32_t reset[5];
	uint32_t enabled[5];
	uint32_t lowpower[5];
	uint32_t bdcr;
	uint32_t csr;
	uint32_t dckcfgr;
	uint32_t pwr_cr;
	uint32_t syscfg_memrmp;
	uint64_t hse_ready_ps;
	uint64_t pll_ready_ps;
	uint64_t lsi_ready_ps;
	uint64_t overdrive_ready_ps;
	uint32_t hclk_hz;
	uint32_t pclk_hz[2];
	uint32_t timer_hz[2];
};

void rcc_reset(struct board *board, enum lw_board_reset why);
uint32_t rcc_read(struct board *board, uint32_t offset);
void rcc_write(struct board *board, uint32_t offset, uint32_t value);
uint32_t pwr_read(struct board *board, uint32_t offset);
void pwr_write(struct board *board, uint32_t offset, uint32_t value);
void rcc_event(struct board *board);

/* ---- gpio.c (RM0390, 7) ---------------------------------------------------------------------- */

#define PORTS 8

enum drive {
	DRIVE_LOW,
	DRIVE_HIGH,
	DRIVE_FLOAT
};

struct port {
	uint32_t moder;
	uint32_t otyper;
	uint32_t ospeedr;
	uint32_t pupdr;
	uint32_t odr;
	uint32_t afr[2];
	uint8_t drive[16];
	uint16_t levels;
	uint16_t peripheral; /**< levels of the alternate functions */
	uint16_t recorded;   /**< pins whose changes are kept */
};

void gpio_reset(struct board *board);
uint32_t gpio_read(struct board *board, unsigned int port, uint32_t offset);
void gpio_write(struct board *board, unsigned int port, uint32_t offset, uint32_t value);
void gpio_drive(struct board *board, unsigned int port, unsigned int pin, enum drive drive);
/** The level that a peripheral gives a pin, wherever its alternate function is chosen. */
void gpio_peripheral(struct board *board, unsigned int port, unsigned int pin, bool level);
bool gpio_level(const struct board *board, unsigned int port, unsigned int pin);
/** Whether a pin is an alternate function, of this number. */
bool gpio_is(const struct board *board, unsigned int port, unsigned int pin, unsigned int function);
bool gpio_is_output(const struct board *board, unsigned int port, unsigned int pin);

/* ---- exti.c: EXTI (RM0390, 10.2) and SYSCFG (8) ---------------------------------------------- */

struct exti {
	uint32_t imr;
	uint32_t emr;
	uint32_t rtsr;
	uint32_t ftsr;
	uint32_t pr;
	uint32_t exticr[4];
};

void exti_reset(struct board *board);
uint32_t exti_read(struct board *board, uint32_t offset);
void exti_write(struct board *board, uint32_t offset, uint32_t value);
uint32_t syscfg_read(struct board *board, uint32_t offset);
void syscfg_write(struct board *board, uint32_t offset, uint32_t value);
void exti_pin(struct board *board, unsigned int port, unsigned int pin, bool level);

/* ---- timer.c: TIM2 to TIM5 (RM0390, 17) ------------------------------------------------------ */

#define TIMERS 4

struct timer {
	uint32_t cr1;
	uint32_t cr2;
	uint32_t smcr;
	uint32_t dier;
	uint32_t sr;
	uint32_t ccmr[2];
	uint32_t ccer;
	uint32_t psc; /**< preloaded */
	uint32_t psc_now;
	uint32_t arr;
	uint32_t arr_now;
	uint32_t ccr[4]; /**< as written */
	uint32_t ccr_now[4];
	uint64_t base_ps; /**< when it stood at base_count */
	uint32_t base_count;
	uint32_t next_count;  /**< what its event is about; one above arr_now: it runs over */
	uint8_t references;   /**< OCxREF of the channels, by bit */
	uint8_t inputs;       /**< TI1 and TI2 behind their filters, by bit */
	uint64_t input_ps[2]; /**< when their filters take the other level */
};

void timer_reset(struct board *board, unsigned int index);
uint32_t timer_read(struct board *board, unsigned int index, uint32_t offset);
void timer_write(struct board *board, unsigned int index, uint32_t offset, uint32_t value);
void timer_event(struct board *board, unsigned int index);
void timer_input_event(struct board *board, unsigned int index);
void timer_rebase(struct board *board);
/** What waits in the filters of the inputs has been there long enough. */
void timer_pass_filters(struct board *board);
/** A pin with a timer's alternate function has changed. */
void timer_pin(struct board *board, unsigned int port, unsigned int pin, bool level);

/* ---- usart.c (RM0390, 25) -------------------------------------------------------------------- */

#define LINE_SIZE 8192

struct usart {
	uint32_t sr;
	uint32_t dr; /**< received */
	uint32_t brr;
	uint32_t cr[3];
	uint32_t tdr;
	bool tdr_full;
	bool sr_read;                  /**< the first half of the sequence that clears flags */
	struct lw_board_byte shifting; /**< end_ns 0: nothing is being sent */
	uint64_t shift_end_ps;
};

/** The other end of the line: the master's port. */
struct line {
	uint32_t baud;
	uint8_t parity;
	uint8_t stop_bits;
	uint8_t to_send[LINE_SIZE];
	size_t send_from;
	size_t send_to;
	bool sending;
	uint8_t byte;
	struct lw_board_byte heard[LINE_SIZE];
	size_t heard_count;
	uint64_t heard_total;
};

void usart_reset(struct board *board, unsigned int index);
uint32_t usart_read(struct board *board, unsigned int index, uint32_t offset);
void usart_write(struct board *board, unsigned int index, uint32_t offset, uint32_t value);
void usart_tx_event(struct board *board);
void usart_rx_event(struct board *board);
void usart_idle_event(struct board *board);

/* ---- flash.c (RM0390, 3) --------------------------------------------------------------------- */

struct flash {
	uint32_t acr;
	uint32_t sr;
	uint32_t cr;
	uint32_t optcr;
	uint32_t key;
	bool key_refused; /**< until a reset */
	uint64_t busy_until_ps;
	bool erasing;
	uint32_t target;
	uint32_t value;
	unsigned int size;
	uint64_t operations;
	uint64_t cut_operation;
	enum lw_board_cut cut;
};

void flash_reset(struct board *board);
uint32_t flash_read(struct board *board, uint32_t offset);
void flash_write(struct board *board, uint32_t offset, uint32_t value);
uint32_t flash_array_read(struct board *board, uint32_t offset, unsigned int size);
void flash_array_write(struct board *board, uint32_t offset, uint32_t value, unsigned int size);
void flash_event(struct board *board);
void flash_check_latency(struct board *board);

/* ---- iwdg.c (RM0390, 20) --------------------------------------------------------------------- */

struct iwdg {
	uint32_t pr;
	uint32_t rlr;
	bool started;
	bool unlocked;
	uint64_t pr_busy_ps;
	uint64_t rlr_busy_ps;
	uint64_t reloaded_ps;
};

void iwdg_reset(struct board *board);
uint32_t iwdg_read(struct board *board, uint32_t offset);
void iwdg_write(struct board *board, uint32_t offset, uint32_t value);
void iwdg_event(struct board *board);

/* ---- wiring.c: what is on the pins ----------------------------------------------------------- */

struct wiring {
	struct lw_plant plant;
	struct lw_plant_bench bench;
	struct lw_bank_section section;
	struct lw_bank bank;
	struct lw_pdu_config pdu_config;
	struct lw_pdu pdu;
	uint64_t last_transition_ps;
	uint64_t transition_spacing_ps;
	bool b;
};

bool wiring_create(struct board *board);
/** All inputs anew, after a power-up. */
void wiring_show(struct board *board);
void wiring_plant_event(struct board *board);
void wiring_channel_b_event(struct board *board);
/** A pin that the controller drives has changed, or has been let go of. */
void wiring_output(struct board *board, unsigned int port, unsigned int pin, bool level);

/* ---- seen.c: what the pins did --------------------------------------------------------------- */

#define CHANGES_MAX 2000000u

struct pins_seen {
	struct lw_board_seen seen;
	struct lw_board_cost costs[LW_BOARD_EXCEPTIONS];
	uint64_t since_ps;
	uint64_t cycles_q16;
	uint64_t instructions;
	uint64_t operations;
	bool step;
	uint64_t step_rise_ps;
	uint64_t step_fall_ps;
	uint64_t dir_ps;
	uint64_t encoder_ps;
	uint64_t edge_ps; /**< the last one of A */
	uint8_t encoder;
	uint64_t de_rise_ps;
	uint64_t sent_end_ps;
	uint64_t stall_from_ps;
	uint64_t stall_to_ps;
	struct lw_board_change *changes;
	size_t change_count;
};

void seen_clear(struct board *board);
void seen_pin(struct board *board, unsigned int port, unsigned int pin, bool level);
void seen_sent(struct board *board, uint64_t start_ps, uint64_t end_ps);
void seen_step(struct board *board, int direction);
void seen_cost(struct board *board, unsigned int exception, uint64_t instructions);
void seen_stall(struct board *board, uint64_t from_ps, uint64_t to_ps);

/* ---- board.c --------------------------------------------------------------------------------- */

#define COMPLAINTS_SIZE 4096

struct board {
	struct lw_board_config config;
	uc_engine *uc;
	uint8_t *memory; /**< flash */
	uint8_t ram[RAM_SIZE];
	bool powered;
	uint64_t random;
	struct clock clock;
	struct core core;
	struct rcc rcc;
	struct port ports[PORTS];
	struct exti exti;
	struct timer timers[TIMERS];
	struct usart usarts[2]; /**< USART1, on the line, and USART2 */
	struct line line;
	struct flash flash;
	struct iwdg iwdg;
	struct wiring wiring;
	struct pins_seen pins;
	char complaints[COMPLAINTS_SIZE];
};

/** Uniformly distributed. */
uint32_t board_random(struct board *board);
/** The firmware does what the manual forbids. Told once. */
void board_complain(struct board *board, const char *format, ...)
	__attribute__((format(printf, 2, 3)));
/** Begin anew, with the reset cause in RCC_CSR. */
void board_reset(struct board *board, enum lw_board_reset why);
void board_lose_power(struct board *board);
uint32_t bus_read(struct board *board, uint32_t address, unsigned int size);
void bus_write(struct board *board, uint32_t address, uint32_t value, unsigned int size);

/** Pins of the board, as doc/wiring.md has them. */
#define PORT_A     0u
#define PORT_B     1u
#define PORT_C     2u
#define PIN_A      PORT_A, 0u
#define PIN_B      PORT_A, 1u
#define PIN_INDEX  PORT_C, 2u
#define PIN_STEP   PORT_B, 0u
#define PIN_DIR    PORT_C, 1u
#define PIN_ENABLE PORT_A, 4u
#define PIN_DE     PORT_A, 8u

static inline bool is_pin(unsigned int port, unsigned int pin, unsigned int of_port,
			  unsigned int of_pin)
{
	return port == of_port && pin == of_pin;
}

#endif /* BOARD_PARTS_H */
