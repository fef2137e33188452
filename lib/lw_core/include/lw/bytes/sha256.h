/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * SHA-256 (FIPS 180-4): the name of a firmware image. Small rather than fast; not for interrupt
 * context, and not for secrets.
 */
#ifndef LW_SHA256_H
#define LW_SHA256_H

#include <stddef.h>
#include <stdint.h>

/** Bytes of a digest. */
#define LW_SHA256_SIZE 32u

/**
 * The digest of so many bytes, as `sha256sum` prints it.
 *
 * @param length any; 0 takes no bytes, and `bytes` may be NULL then
 */
void lw_sha256(const uint8_t *bytes, size_t length, uint8_t digest[LW_SHA256_SIZE]);

#endif /* LW_SHA256_H */
