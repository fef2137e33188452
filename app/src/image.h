/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * What runs: the image in the flash.
 */
#ifndef IMAGE_H
#define IMAGE_H

#include <stdint.h>

/**
 * The first 8 bytes of the SHA-256 of the image, as `sha256sum zephyr.bin` prints them. It reads
 * the flash, for some 30 ms on the Nucleo: once, at the start. Not for interrupt context.
 *
 * @return 0 where there is no flash that the image runs from: native_sim is a program of its host
 */
uint64_t image_sha256_head(void);

#endif /* IMAGE_H */
