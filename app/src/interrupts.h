/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The order of the interrupts: the encoder above all others, then the edge timer, then the
 * switches. The devicetree gives it; the build stops where it is another.
 */
#ifndef INTERRUPTS_H
#define INTERRUPTS_H

/**
 * Put the system timer, which the kernel starts at the encoder's priority, below the others. Call
 * it before any of them is enabled. Not for interrupt context.
 */
void interrupts_start(void);

#endif /* INTERRUPTS_H */
