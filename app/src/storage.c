#include "storage.h"

#include <string.h>

#include <zephyr/settings/settings.h>

#include "app.h"

#define TREE "levelwind"
#define KEY  "parameters"

/** Where storage_load() wants the record. */
struct destination {
	uint8_t *record;
	size_t size;
	size_t length;
};

static K_THREAD_STACK_DEFINE(stack, 2048);
static struct k_work_q queue;
static uint8_t record[LW_RECORD_SIZE]; /**< owned by the work while `writing` */
static bool writing;                   /**< under app_lock */

static void write_record(struct k_work *work)
{
	const int ret = settings_save_one(TREE "/" KEY, record, sizeof(record));

	ARG_UNUSED(work);
	k_mutex_lock(&app_lock, K_FOREVER);
	writing = false;
	lw_device_record_written(&app_device, ret);
	k_mutex_unlock(&app_lock);
}

static K_WORK_DEFINE(write_work, write_record);

int storage_start(void)
{
	const struct k_work_queue_config config = {.name = "storage"};

	k_work_queue_start(&queue, stack, K_THREAD_STACK_SIZEOF(stack), APP_PRIORITY_STORAGE,
			   &config);
	return settings_subsys_init();
}

static int load_one(const char *key, size_t length, settings_read_cb read, void *context,
		    void *param)
{
	struct destination *destination = param;

	if (strcmp(key, KEY) == 0 && length <= destination->size) {
		const ssize_t count = read(context, destination->record, length);

		destination->length = count > 0 ? (size_t)count : 0;
	}
	return 0;
}

size_t storage_load(uint8_t *destination_record, size_t size)
{
	struct destination destination = {.record = destination_record, .size = size};

	/* What cannot be read is as good as not there: the device starts with factory values. */
	(void)settings_load_subtree_direct(TREE, load_one, &destination);
	return destination.length;
}

void storage_serve(void)
{
	const uint8_t *pending = lw_device_pending_record(&app_device);

	if (pending == NULL || writing) {
		return;
	}
	memcpy(record, pending, sizeof(record));
	writing = true;
	k_work_submit_to_queue(&queue, &write_work);
}
