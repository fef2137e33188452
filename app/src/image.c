/* SPDX-License-Identifier: Apache-2.0 */
#include "image.h"

#ifdef CONFIG_ARCH_POSIX

uint64_t image_sha256_head(void)
{
	return 0;
}

#else

#include <zephyr/linker/linker-defs.h>

#include "lw/bytes/big_endian.h"
#include "lw/bytes/sha256.h"

uint64_t image_sha256_head(void)
{
	uint8_t digest[LW_SHA256_SIZE];

	lw_sha256((const uint8_t *)__rom_region_start, (size_t)(uintptr_t)_flash_used, digest);
	return (uint64_t)lw_get32(&digest[0]) << 32 | lw_get32(&digest[4]);
}

#endif
