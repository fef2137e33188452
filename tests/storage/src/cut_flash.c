/* SPDX-License-Identifier: Apache-2.0 */
#include "cut_flash.h"

#include <errno.h>
#include <string.h>

#include <zephyr/device.h>
#include <zephyr/drivers/flash.h>

#define DT_DRV_COMPAT levelwind_cut_flash

#define WORD 4u

uint8_t cut_flash[CUT_FLASH_SIZE];
unsigned int cut_flash_operations;
unsigned int cut_flash_erasures;
unsigned int cut_flash_overwrites;

static uint32_t cut_operation = UINT32_MAX;
static enum cut cut_how;
static enum cut_effect cut_effect;
static bool dead;

uint32_t cut_flash_random(void)
{
	static uint32_t state = 1;

	state ^= state << 13;
	state ^= state >> 17;
	state ^= state << 5;
	return state;
}

void cut_flash_power_up(void)
{
	dead = false;
	cut_operation = UINT32_MAX;
	cut_flash_operations = 0;
	cut_flash_erasures = 0;
	cut_flash_overwrites = 0;
}

void cut_flash_at(unsigned int operation, enum cut cut, enum cut_effect effect)
{
	cut_operation = cut_flash_operations + operation;
	cut_how = cut;
	cut_effect = effect;
}

/** Is this the operation that is cut? Counts it. */
static bool is_cut(void)
{
	if (cut_flash_operations++ != cut_operation) {
		return false;
	}
	dead = cut_effect == CUT_POWER;
	return true;
}

static int write_word(uint8_t *cells, const uint8_t *bytes)
{
	const bool cut = is_cut();

	cut_flash_overwrites += memcmp(cells, (uint8_t[]){0xFF, 0xFF, 0xFF, 0xFF}, WORD) != 0;
	for (unsigned int i = 0; i < WORD; i++) {
		uint8_t kept = 0;

		if (cut && cut_how != CUT_AFTER) {
			kept = cut_how == CUT_BEFORE ? UINT8_MAX : (uint8_t)cut_flash_random();
		}
		cells[i] &= bytes[i] | kept; /* bits can only become 0 */
	}
	return cut && cut_effect != CUT_SILENT ? -EIO : 0;
}

static void half_erase(uint8_t *cells, size_t size)
{
	const size_t part = cut_flash_random() % size;

	for (size_t i = 0; i < size; i++) {
		const uint8_t garbage = (uint8_t)cut_flash_random();
		const uint8_t mixed[] = {cells[i], UINT8_MAX, 0, garbage};
		/* One choice for each word. */
		static uint32_t choice;

		if (i % WORD == 0) {
			choice = cut_flash_random();
		}
		switch (cut_how) {
		case CUT_PARTLY:
			cells[i] = i < part ? UINT8_MAX : cells[i];
			break;
		case CUT_PARTLY_2:
			cells[i] = i < part ? cells[i] : UINT8_MAX;
			break;
		case CUT_PROGRAMMED:
			cells[i] = 0;
			break;
		case CUT_GARBAGE:
			cells[i] = garbage;
			break;
		case CUT_BEHIND:
			cells[i] = i < part ? cells[i] : garbage;
			break;
		case CUT_MIXED:
			cells[i] = mixed[choice % ARRAY_SIZE(mixed)];
			break;
		default:
			break;
		}
	}
}

static int flash_read_cells(const struct device *dev, off_t offset, void *bytes, size_t size)
{
	ARG_UNUSED(dev);
	if (dead) {
		return -EIO;
	}
	if (offset < 0 || (size_t)offset + size > sizeof(cut_flash)) {
		return -EINVAL;
	}
	memcpy(bytes, cut_flash + offset, size);
	return 0;
}

static int flash_write_cells(const struct device *dev, off_t offset, const void *bytes, size_t size)
{
	int ret = 0;

	ARG_UNUSED(dev);
	if (offset % (off_t)WORD != 0 || size % WORD != 0 ||
	    (size_t)offset + size > sizeof(cut_flash)) {
		return -EINVAL;
	}
	for (size_t i = 0; ret == 0 && i < size; i += WORD) {
		ret = dead ? -EIO : write_word(cut_flash + offset + i, (const uint8_t *)bytes + i);
	}
	return ret;
}

static int flash_erase_cells(const struct device *dev, off_t offset, size_t size)
{
	ARG_UNUSED(dev);
	if (dead) {
		return -EIO;
	}
	if (offset % CUT_FLASH_PAGE_SIZE != 0 || size % CUT_FLASH_PAGE_SIZE != 0 ||
	    (size_t)offset + size > sizeof(cut_flash)) {
		return -EINVAL;
	}
	cut_flash_erasures++;
	if (is_cut()) {
		if (cut_how == CUT_AFTER) {
			memset(cut_flash + offset, UINT8_MAX, size);
		} else {
			half_erase(cut_flash + offset, size);
		}
		return cut_effect == CUT_SILENT ? 0 : -EIO;
	}
	memset(cut_flash + offset, UINT8_MAX, size);
	return 0;
}

static const struct flash_parameters *get_parameters(const struct device *dev)
{
	static const struct flash_parameters parameters = {
		.write_block_size = WORD,
		.erase_value = UINT8_MAX,
	};

	ARG_UNUSED(dev);
	return &parameters;
}

static void page_layout(const struct device *dev, const struct flash_pages_layout **layout,
			size_t *layout_size)
{
	static const struct flash_pages_layout pages = {
		.pages_count = CUT_FLASH_PAGES,
		.pages_size = CUT_FLASH_PAGE_SIZE,
	};

	ARG_UNUSED(dev);
	*layout = &pages;
	*layout_size = 1;
}

static const struct flash_driver_api api = {
	.read = flash_read_cells,
	.write = flash_write_cells,
	.erase = flash_erase_cells,
	.get_parameters = get_parameters,
	.page_layout = page_layout,
};

DEVICE_DT_INST_DEFINE(0, NULL, NULL, NULL, NULL, POST_KERNEL, CONFIG_FLASH_INIT_PRIORITY, &api);
