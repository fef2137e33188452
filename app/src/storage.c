/* SPDX-License-Identifier: Apache-2.0 */
#include "storage.h"

#include <string.h>

#include <zephyr/settings/settings.h>
#include <zephyr/storage/flash_map.h>

#include "app.h"
#include "modbus.h"
#include "settings_backend.h"
#include "watch.h"

#define TREE "levelwind"

/** Names of the settings, by slot. The first is as old as the firmware. */
static const char *const names[LW_STORE_SLOTS] = {
	TREE "/parameters", TREE "/parameters_b", TREE "/journal", TREE "/journal_b",
	TREE "/cam",        TREE "/cam_b",        TREE "/look",    TREE "/look_b",
};

/* Of each pair both slots. */
BUILD_ASSERT(FIXED_PARTITION_SIZE(storage_partition) / 2 >=
		     2 * (SETTINGS_BACKEND_ENTRY_SIZE(LW_PARAM_RECORD_SIZE) +
			  SETTINGS_BACKEND_ENTRY_SIZE(LW_STORE_JOURNAL_SIZE) +
			  SETTINGS_BACKEND_ENTRY_SIZE(LW_STORE_CAM_SIZE) +
			  SETTINGS_BACKEND_ENTRY_SIZE(LW_LOOK_RECORD_SIZE)) +
			     SETTINGS_BACKEND_ENTRY_SIZE(LW_STORE_SLOT_SIZE),
	     "storage_partition is too small for what settings_backend.h asks for");
BUILD_ASSERT(LW_STORE_SLOTS <= SETTINGS_BACKEND_VALUES_MAX);

static K_THREAD_STACK_DEFINE(stack, 1024);
static struct k_work_q queue;
static uint8_t bytes[LW_STORE_SLOT_SIZE]; /**< owned by the work while `writing` */
static size_t length;                     /**< likewise */
static unsigned int slot;                 /**< likewise */
static bool writing;                      /**< under app_lock */

static void write_slot(struct k_work *work)
{
	int ret;

	ARG_UNUSED(work);
	modbus_hold(WATCH_STORAGE);
	ret = settings_save_one(names[slot], bytes, length);
	modbus_release(settings_backend_has_erased() &&
		       IS_ENABLED(CONFIG_LW_FLASH_STOPS_PROCESSOR));
	k_mutex_lock(&app_lock, K_FOREVER);
	writing = false;
	lw_device_end_write(&app_device, ret);
	if (ret == 0 && slot / 2 == LW_STORE_JOURNAL / 2) {
		watch_stored();
	}
	k_mutex_unlock(&app_lock);
}

static K_WORK_DEFINE(write_work, write_slot);

static void report(struct k_work *work)
{
	watch_report(WATCH_STORAGE);
	(void)k_work_schedule_for_queue(&queue, k_work_delayable_from_work(work), WATCH_PERIOD);
}

static K_WORK_DELAYABLE_DEFINE(report_work, report);

int storage_start(void)
{
	const struct k_work_queue_config config = {.name = "storage"};
	const int ret = settings_subsys_init();
	int added;

	k_work_queue_start(&queue, stack, K_THREAD_STACK_SIZEOF(stack), APP_PRIORITY_STORAGE,
			   &config);
	added = watch_add(WATCH_STORAGE);
	(void)k_work_schedule_for_queue(&queue, &report_work, K_NO_WAIT);
	return ret ? ret : added;
}

static int load_one(const char *key, size_t size, settings_read_cb read, void *context, void *param)
{
	for (unsigned int i = 0; i < LW_STORE_SLOTS; i++) {
		if (strcmp(key, names[i] + sizeof(TREE)) == 0) {
			const ssize_t count = read(context, bytes, MIN(size, sizeof(bytes)));

			lw_store_load(param, i, bytes, count > 0 ? (size_t)count : 0);
		}
	}
	return 0;
}

void storage_load(struct lw_store *store)
{
	lw_store_init(store);
	/*
	 * What cannot be read is as good as not there: the device starts with factory values. The
	 * buffer is free: the settings let nobody in while they are being saved.
	 */
	(void)settings_load_subtree_direct(TREE, load_one, store);
}

void storage_serve(void)
{
	if (writing) {
		return;
	}
	length = lw_device_begin_write(&app_device, &slot, bytes);
	if (length > 0) {
		writing = true;
		k_work_submit_to_queue(&queue, &write_work);
	}
}
