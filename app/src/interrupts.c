/* SPDX-License-Identifier: Apache-2.0 */
/*
 * Interrupts of one priority wait for each other, and the one with the lower number goes first: an
 * encoder that waits for a switch or for the kernel loses edges, but only at full speed. What may
 * ask for something of the motion must not interrupt who moves (lw/motion/motion.h). No test on a
 * desk finds either, so the devicetree is checked here.
 */
#include "interrupts.h"

#include <zephyr/devicetree.h>
#include <zephyr/irq.h>
#include <zephyr/sys/util.h>

#include "app.h"

#define NODE(property) DT_PHANDLE(APP_NODE, property)

/** The timer of a counter or of a step pulse: the node, or the one that it stands in. */
#define TIMER_PRIORITY(node)                                                                       \
	COND_CODE_1(DT_IRQ_HAS_IDX(node, 0), (DT_IRQ(node, priority)),                             \
		    (DT_IRQ(DT_PARENT(node), priority)))

#ifdef CONFIG_LW_SIMULATED_MACHINE

/* Encoder and switches are the system timer's interrupt, above all others. */
#ifdef CONFIG_CPU_CORTEX_M
BUILD_ASSERT(TIMER_PRIORITY(NODE(edge_timer)) == 0,
	     "edge-timer: a simulated switch would interrupt it; give it priority 0");
#endif

void interrupts_start(void)
{
}

#else

#if DT_HAS_COMPAT_STATUS_OKAY(st_stm32_exti)

/* A pin's interrupt is that of its EXTI line, which has the number of the pin on all ports. */
#define EXTI_NODE   DT_COMPAT_GET_ANY_STATUS_OKAY(st_stm32_exti)
#define FIRST(idx)  DT_PROP_BY_IDX(EXTI_NODE, line_ranges, UTIL_X2(idx))
#define BEHIND(idx) (FIRST(idx) + DT_PROP_BY_IDX(EXTI_NODE, line_ranges, UTIL_INC(UTIL_X2(idx))))

#define PRIORITY_IF_OWN(exti, property, idx, line)                                                 \
	+((line) >= FIRST(idx) && (line) < BEHIND(idx) ? DT_IRQ_BY_IDX(exti, idx, priority) : 0)
#define PIN_PRIORITY(node, gpios)                                                                  \
	(0 DT_FOREACH_PROP_ELEM_VARGS(EXTI_NODE, interrupt_names, PRIORITY_IF_OWN,                 \
				      DT_GPIO_PIN(node, gpios)))

/* The driver's interrupt also serves the first line behind its own, at its own priority. */
#define SERVES(idx, line) ((line) >= FIRST(idx) && (line) <= BEHIND(idx))
#define OR_SERVES_BOTH(exti, property, idx, line, other)                                           \
	|| (SERVES(idx, line) && SERVES(idx, other))
#define SHARED(node, gpios, other, other_gpios)                                                    \
	(0 DT_FOREACH_PROP_ELEM_VARGS(EXTI_NODE, interrupt_names, OR_SERVES_BOTH,                  \
				      DT_GPIO_PIN(node, gpios), DT_GPIO_PIN(other, other_gpios)))

#else

/* A pin's interrupt is that of its port. A port without one stops the build: say here what has. */
#define PIN_PRIORITY(node, gpios) DT_IRQ(DT_GPIO_CTLR(node, gpios), priority)
#define SHARED(node, gpios, other, other_gpios)                                                    \
	DT_SAME_NODE(DT_GPIO_CTLR(node, gpios), DT_GPIO_CTLR(other, other_gpios))

#endif

#if DT_NODE_HAS_COMPAT(NODE(encoder), levelwind_encoder_stm32)
#define ENCODER_PRIORITY           TIMER_PRIORITY(NODE(encoder))
#define SHARES_A_OR_B(node, gpios) 0
#else
#define ENCODER_PRIORITY PIN_PRIORITY(NODE(encoder), a_gpios)
#define SHARES_A_OR_B(node, gpios)                                                                 \
	(SHARED(node, gpios, NODE(encoder), a_gpios) || SHARED(node, gpios, NODE(encoder), b_gpios))
BUILD_ASSERT(PIN_PRIORITY(NODE(encoder), b_gpios) == ENCODER_PRIORITY,
	     "encoder: the interrupts of A and B must have one priority");
#endif
#define EDGE_TIMER_PRIORITY   TIMER_PRIORITY(NODE(edge_timer))
#define UART_PRIORITY         DT_IRQ(NODE(modbus_uart), priority)
/** Above the switching of threads, which has the lowest. */
#define SYSTEM_TIMER_PRIORITY (IRQ_PRIO_LOWEST - 1)

BUILD_ASSERT(EDGE_TIMER_PRIORITY > ENCODER_PRIORITY,
	     "edge-timer: its interrupt needs a larger number, so that the encoder's is above it");
BUILD_ASSERT(UART_PRIORITY > EDGE_TIMER_PRIORITY,
	     "modbus-uart: its interrupt needs a larger number than the edge timer's");
BUILD_ASSERT(SYSTEM_TIMER_PRIORITY > UART_PRIORITY,
	     "modbus-uart: its interrupt needs a smaller number than the system timer's");
#if DT_HAS_COMPAT_STATUS_OKAY(levelwind_stm32_system_timer)
BUILD_ASSERT(TIMER_PRIORITY(DT_COMPAT_GET_ANY_STATUS_OKAY(levelwind_stm32_system_timer)) ==
		     SYSTEM_TIMER_PRIORITY,
	     "system-timer: its interrupt must be behind all others");
#endif

#if DT_NODE_HAS_PROP(NODE(encoder), index_gpios)
/* It is counted against the edges: neither waits for a switch, nor interrupts the other. */
BUILD_ASSERT(PIN_PRIORITY(NODE(encoder), index_gpios) == ENCODER_PRIORITY,
	     "encoder: the interrupt of the index must have the priority of A and B");
#define INDEX_SHARED(node, gpios) SHARED(node, gpios, NODE(encoder), index_gpios)
#else
#define INDEX_SHARED(node, gpios) 0
#endif

#if DT_NODE_HAS_COMPAT(NODE(stepper), levelwind_step_dir_stm32)
BUILD_ASSERT(TIMER_PRIORITY(NODE(stepper)) == ENCODER_PRIORITY,
	     "stepper: the interrupt of its timer must have the encoder's priority");
#endif

#define CHECK_CONTACT_PIN(node, gpios)                                                             \
	BUILD_ASSERT(PIN_PRIORITY(node, gpios) > EDGE_TIMER_PRIORITY,                              \
		     "a switch needs an interrupt of a larger number than the edge timer's");      \
	BUILD_ASSERT(PIN_PRIORITY(node, gpios) < SYSTEM_TIMER_PRIORITY,                            \
		     "a switch needs an interrupt of a smaller number than the system timer's");   \
	BUILD_ASSERT(!SHARES_A_OR_B(node, gpios) && !INDEX_SHARED(node, gpios),                    \
		     "a switch shares an interrupt with the encoder: give it another line");
#define CHECK_CONTACT(node, gpios)                                                                 \
	COND_CODE_1(DT_NODE_HAS_PROP(node, gpios), (CHECK_CONTACT_PIN(node, gpios)), ())
#define CHECK_SWITCH(node)                                                                         \
	CHECK_CONTACT(node, no_gpios)                                                              \
	CHECK_CONTACT(node, nc_gpios)

CHECK_SWITCH(NODE(limit_plus))
CHECK_SWITCH(NODE(limit_minus))
CHECK_SWITCH(NODE(overtravel_plus))
CHECK_SWITCH(NODE(overtravel_minus))

void interrupts_start(void)
{
#ifdef CONFIG_CORTEX_M_SYSTICK
	NVIC_SetPriority(SysTick_IRQn, _IRQ_PRIO_OFFSET + SYSTEM_TIMER_PRIORITY);
#endif
}

#endif
