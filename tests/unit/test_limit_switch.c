/* SPDX-License-Identifier: Apache-2.0 */
/* Debouncing of a limit switch. */
#include <unity.h>

#include "lw/control/limit_switch.h"

static struct lw_limit_switch_config config;
static struct lw_limit_switch limit;
static struct lw_limit_switch_trigger trigger;
static uint64_t now_us;

void setUp(void)
{
	config = (struct lw_limit_switch_config){
		.contacts = LW_SWITCH_CONTACTS_NO_NC_PAIR,
		.transit_us = 20000,
		.debounce_us = 5000,
	};
	now_us = 1000000;
	lw_limit_switch_init(&limit, &config, false, true, now_us);
}

void tearDown(void)
{
}

static void use_single(enum lw_switch_contacts contacts)
{
	config.contacts = contacts;
	lw_limit_switch_init(&limit, &config, false, true, now_us);
}

/** The contacts, some time after the change before, with the carriage at a place. */
static void contacts(bool no_closed, bool nc_closed, int32_t pos_usteps, uint32_t after_us)
{
	const struct lw_limit_switch_trigger at = {.pos_usteps = pos_usteps, .direction = 1};

	now_us += after_us;
	lw_limit_switch_input(&limit, &config, no_closed, nc_closed, at, now_us);
}

static void tick(uint32_t after_us)
{
	now_us += after_us;
	lw_limit_switch_tick(&limit, &config, now_us);
}

static void assert_one_event(int32_t pos_usteps)
{
	TEST_ASSERT_TRUE(lw_limit_switch_take(&limit, &trigger));
	TEST_ASSERT_EQUAL_INT32(pos_usteps, trigger.pos_usteps);
	TEST_ASSERT_EQUAL_INT8(1, trigger.direction);
	TEST_ASSERT_FALSE(lw_limit_switch_take(&limit, &trigger));
}

static void test_pair_init_takes_the_present_contacts_without_an_event(void)
{
	TEST_ASSERT_FALSE(limit.active);
	lw_limit_switch_init(&limit, &config, true, false, now_us);
	TEST_ASSERT_TRUE(limit.active);
	TEST_ASSERT_FALSE(lw_limit_switch_take(&limit, &trigger));
	lw_limit_switch_init(&limit, &config, true, true, now_us);
	TEST_ASSERT_FALSE(limit.active);
	lw_limit_switch_init(&limit, &config, false, false, now_us);
	TEST_ASSERT_FALSE(limit.active);
}

static void test_pair_bounce_gives_one_event_with_the_first_closure(void)
{
	contacts(false, false, 100, 1000);
	TEST_ASSERT_FALSE(limit.active);
	contacts(true, false, 110, 1000);
	TEST_ASSERT_TRUE(limit.active); /* at once */
	for (int bounce = 0; bounce < 5; bounce++) {
		contacts(false, false, 111 + bounce, 50);
		TEST_ASSERT_TRUE(limit.active);
		contacts(true, false, 112 + bounce, 50);
		tick(100);
	}
	assert_one_event(110);
	TEST_ASSERT_EQUAL_UINT32(1, limit.triggers);
}

static void test_pair_releases_on_the_first_closure_of_nc(void)
{
	contacts(true, false, 110, 1000);
	assert_one_event(110);
	contacts(false, false, 105, 1000);
	TEST_ASSERT_TRUE(limit.active);
	contacts(false, true, 100, 1000);
	TEST_ASSERT_FALSE(limit.active);
	contacts(false, false, 99, 50);
	contacts(false, true, 98, 50);
	TEST_ASSERT_FALSE(lw_limit_switch_take(&limit, &trigger));
	contacts(true, false, 120, 1000);
	assert_one_event(120);
	TEST_ASSERT_EQUAL_UINT32(2, limit.triggers);
}

static void test_pair_contradicting_contacts_change_nothing(void)
{
	contacts(true, true, 110, 1000);
	TEST_ASSERT_FALSE(limit.active);
	contacts(true, false, 111, 10);
	TEST_ASSERT_TRUE(limit.active);
	contacts(true, true, 112, 10);
	TEST_ASSERT_TRUE(limit.active);
	assert_one_event(111);
}

static void check_wiring_fault(bool both)
{
	contacts(both, both, 0, 1000);
	tick(20000);
	TEST_ASSERT_FALSE_MESSAGE(limit.wiring_fault, "in transit");
	tick(1);
	TEST_ASSERT_TRUE(limit.wiring_fault);
	contacts(false, true, 0, 1000);
	tick(0);
	TEST_ASSERT_FALSE_MESSAGE(limit.wiring_fault, "recovered");
	tick(100000);
	TEST_ASSERT_FALSE(limit.wiring_fault);
}

static void test_pair_both_open_or_both_closed_for_too_long(void)
{
	check_wiring_fault(false);
	check_wiring_fault(true);
}

static void check_single(bool no_when_actuated, bool nc_when_actuated)
{
	/* An actuation that bounces: the event comes late, the position is the first closure's. */
	contacts(no_when_actuated, nc_when_actuated, 110, 1000);
	contacts(!no_when_actuated, !nc_when_actuated, 111, 1000);
	contacts(no_when_actuated, nc_when_actuated, 112, 1000);
	tick(4999);
	TEST_ASSERT_FALSE(limit.active);
	TEST_ASSERT_FALSE(lw_limit_switch_take(&limit, &trigger));
	tick(1);
	TEST_ASSERT_TRUE(limit.active);
	assert_one_event(110);

	/* A release that bounces. */
	contacts(!no_when_actuated, !nc_when_actuated, 109, 100000);
	tick(4999);
	TEST_ASSERT_TRUE(limit.active);
	contacts(no_when_actuated, nc_when_actuated, 108, 0);
	contacts(!no_when_actuated, !nc_when_actuated, 107, 100);
	tick(4999);
	TEST_ASSERT_TRUE(limit.active);
	tick(1);
	TEST_ASSERT_FALSE(limit.active);
	TEST_ASSERT_FALSE(lw_limit_switch_take(&limit, &trigger));

	/* A glitch shorter than the debounce time. */
	contacts(no_when_actuated, nc_when_actuated, 90, 100000);
	contacts(!no_when_actuated, !nc_when_actuated, 91, 4000);
	tick(100000);
	TEST_ASSERT_FALSE(limit.active);
	TEST_ASSERT_FALSE(lw_limit_switch_take(&limit, &trigger));
	TEST_ASSERT_EQUAL_UINT32(1, limit.triggers);

	/* The next actuation has its own position, also if no tick came in between. */
	contacts(no_when_actuated, nc_when_actuated, 120, 1000);
	contacts(!no_when_actuated, !nc_when_actuated, 119, 6000);
	TEST_ASSERT_TRUE(limit.active);
	assert_one_event(120);
	TEST_ASSERT_EQUAL_UINT32(2, limit.triggers);

	/* The other contact is not looked at: nothing is a wiring fault. */
	tick(100000);
	TEST_ASSERT_FALSE(limit.active);
	TEST_ASSERT_FALSE(limit.wiring_fault);
}

/* Nothing tells which closure was the switch's: only the one that lasts is sure. */
static void check_chatter(bool no_when_actuated, bool nc_when_actuated)
{
	const uint32_t triggers = limit.triggers;

	for (int32_t pos_usteps = 10; pos_usteps < 1010; pos_usteps += 20) {
		contacts(no_when_actuated, nc_when_actuated, pos_usteps, 3000);
		contacts(!no_when_actuated, !nc_when_actuated, pos_usteps + 10, 3000);
	}
	tick(0);
	TEST_ASSERT_TRUE_MESSAGE(limit.wiring_fault, "chatter is told");
	contacts(no_when_actuated, nc_when_actuated, 1010, 3000);
	tick(5000);
	TEST_ASSERT_TRUE(limit.active);
	TEST_ASSERT_FALSE(limit.wiring_fault);
	TEST_ASSERT_TRUE(lw_limit_switch_take(&limit, &trigger));
	TEST_ASSERT_EQUAL_INT32(1010, trigger.pos_usteps);
	TEST_ASSERT_EQUAL_UINT32(triggers + 1, limit.triggers);
}

static void test_single_contact_that_chatters(void)
{
	use_single(LW_SWITCH_CONTACTS_SINGLE_NO);
	check_chatter(true, true);
	use_single(LW_SWITCH_CONTACTS_SINGLE_NC);
	check_chatter(false, false);
}

static void test_single_no(void)
{
	use_single(LW_SWITCH_CONTACTS_SINGLE_NO);
	TEST_ASSERT_FALSE(limit.active);
	check_single(true, false);
	contacts(false, false, 0, 1000);
	tick(100000);
	TEST_ASSERT_FALSE(limit.active);
	TEST_ASSERT_FALSE(limit.wiring_fault);
	lw_limit_switch_init(&limit, &config, true, true, now_us);
	TEST_ASSERT_TRUE(limit.active);
}

static void test_single_nc(void)
{
	use_single(LW_SWITCH_CONTACTS_SINGLE_NC);
	TEST_ASSERT_FALSE(limit.active);
	check_single(true, false);
	lw_limit_switch_init(&limit, &config, false, false, now_us);
	TEST_ASSERT_TRUE_MESSAGE(limit.active, "a broken wire reads as actuated");
}

static void test_single_held_from_power_up_stays_actuated(void)
{
	use_single(LW_SWITCH_CONTACTS_SINGLE_NO);
	lw_limit_switch_init(&limit, &config, true, false, now_us);
	tick(100000);
	TEST_ASSERT_TRUE(limit.active);
	TEST_ASSERT_FALSE(lw_limit_switch_take(&limit, &trigger));
	contacts(false, true, 0, 1000);
	tick(5000);
	TEST_ASSERT_FALSE(limit.active);
}

static void test_single_is_triggered_by_its_own_contact_alone(void)
{
	use_single(LW_SWITCH_CONTACTS_SINGLE_NO);
	/* The other one changes first, elsewhere. */
	contacts(false, false, 100, 100000);
	contacts(true, false, 110, 1000);
	tick(5000);
	assert_one_event(110);
	/* And once more while it is held. */
	contacts(true, true, 120, 100000);
	tick(100000);
	TEST_ASSERT_FALSE(lw_limit_switch_take(&limit, &trigger));
	TEST_ASSERT_TRUE(limit.active);
}

static void test_single_chatters_when_it_does_for_longer_than_its_transit(void)
{
	for (uint32_t longer_us = 0; longer_us <= 1; longer_us++) {
		use_single(LW_SWITCH_CONTACTS_SINGLE_NO);
		contacts(true, true, 10, 100000);
		for (int i = 0; i < 5; i++) {
			contacts(i % 2, true, 20, i < 4 ? 4000 : 4000 + longer_us);
		}
		tick(0);
		TEST_ASSERT_EQUAL(longer_us > 0, limit.wiring_fault);
	}
}

static void test_single_is_quiet_after_its_debounce_time(void)
{
	for (uint32_t sooner_us = 0; sooner_us <= 1; sooner_us++) {
		use_single(LW_SWITCH_CONTACTS_SINGLE_NO);
		contacts(true, true, 10, 100000);
		contacts(false, true, 10, 4000);
		contacts(true, true, 10, 5000 - sooner_us); /* restless since here, or before */
		for (int i = 0; i < 4; i++) {
			contacts(i % 2, true, 20, 4000);
		}
		tick(0);
		TEST_ASSERT_EQUAL(sooner_us > 0, limit.wiring_fault);
	}
}

int main(void)
{
	UNITY_BEGIN();
	RUN_TEST(test_pair_init_takes_the_present_contacts_without_an_event);
	RUN_TEST(test_pair_bounce_gives_one_event_with_the_first_closure);
	RUN_TEST(test_pair_releases_on_the_first_closure_of_nc);
	RUN_TEST(test_pair_contradicting_contacts_change_nothing);
	RUN_TEST(test_pair_both_open_or_both_closed_for_too_long);
	RUN_TEST(test_single_contact_that_chatters);
	RUN_TEST(test_single_no);
	RUN_TEST(test_single_nc);
	RUN_TEST(test_single_held_from_power_up_stays_actuated);
	RUN_TEST(test_single_is_triggered_by_its_own_contact_alone);
	RUN_TEST(test_single_chatters_when_it_does_for_longer_than_its_transit);
	RUN_TEST(test_single_is_quiet_after_its_debounce_time);
	return UNITY_END();
}
