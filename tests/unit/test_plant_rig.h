/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * @brief What the tests of the plant share: running it, decoding its encoder, moving its carriage.
 */
#ifndef TEST_PLANT_RIG_H
#define TEST_PLANT_RIG_H

#include <math.h>
#include <unity.h>

#include <lw/plant.h>

#define MS 1000000ull
#define S  1000000000ull

/** A plant with a reference decoder on its encoder and a record of its last change. */
struct rig {
	struct lw_plant plant;
	/** Position by the pins, transitions; changes of both channels at once. */
	int64_t decoded;
	uint32_t illegal;
	/** Events in which an encoder pin changed. */
	uint32_t encoder_events;
	/** Events in which a pin of the plus limit switch changed. */
	uint32_t limit_plus_events;
};

static inline struct lw_plant_truth rig_truth(const struct rig *rig)
{
	struct lw_plant_truth truth;

	lw_plant_read_truth(&rig->plant, &truth);
	return truth;
}

static inline void rig_init(struct rig *rig, const struct lw_plant_config *config)
{
	*rig = (struct rig){0};
	TEST_ASSERT_EQUAL_INT(0, lw_plant_init(&rig->plant, config, 1));
	lw_plant_enable(&rig->plant, true);
}

static inline void rig_init_default(struct rig *rig)
{
	struct lw_plant_config config;

	lw_plant_config_default(&config);
	rig_init(rig, &config);
}

/** Position within a pulse, from the Gray code written down as a table. */
static inline int rig_quadrant(const struct lw_plant_pins *pins)
{
	static const int quadrant[2][2] = {{0, 3}, {1, 2}};

	return quadrant[pins->encoder_a][pins->encoder_b];
}

/** Execute one event; decode what it did to the encoder. */
static inline uint32_t rig_advance(struct rig *rig)
{
	int before = rig_quadrant(&rig->plant.pins);
	uint32_t changed = lw_plant_advance(&rig->plant);
	int moved = (rig_quadrant(&rig->plant.pins) - before) & 3;

	TEST_ASSERT_EQUAL(moved != 0, (changed & LW_PLANT_ENCODER) != 0);
	if (moved == 2) {
		rig->illegal++;
	} else {
		rig->decoded += moved == 3 ? -1 : moved;
	}
	rig->encoder_events += moved != 0;
	rig->limit_plus_events += (changed & LW_PLANT_LIMIT_PLUS) != 0;
	return changed;
}

/** Execute all events up to a time. */
static inline void rig_run_until(struct rig *rig, uint64_t until_ns)
{
	while (lw_plant_next_event_ns(&rig->plant) <= until_ns) {
		rig_advance(rig);
	}
}

static inline void rig_run(struct rig *rig, uint64_t duration_ns)
{
	rig_run_until(rig, rig->plant.now_ns + duration_ns);
}

/** Run until a pin of the mask changes. @return false if that takes longer than the limit */
static inline bool rig_run_to_change(struct rig *rig, uint32_t mask, uint64_t limit_ns)
{
	uint64_t end_ns = rig->plant.now_ns + limit_ns;

	while (lw_plant_next_event_ns(&rig->plant) <= end_ns) {
		if (rig_advance(rig) & mask) {
			return true;
		}
	}
	return false;
}

/** A motion command: what a controller would do to the carriage. */
struct rig_motion {
	double position_usteps;
	double speed_usteps_per_s;
	int64_t stepped_usteps;
};

#define RIG_TICK_NS 10000ull

/** Change the commanded speed to a target at an acceleration for a time, stepping the plant. */
static inline void rig_command(struct rig *rig, struct rig_motion *motion, double target_mm_per_s,
			       double acceleration_mm_per_s2, uint64_t duration_ns)
{
	double target = target_mm_per_s * 100.0;
	double most = acceleration_mm_per_s2 * 100.0 * 1e-9 * RIG_TICK_NS;
	uint64_t begin_ns = rig->plant.now_ns;

	for (uint64_t t = RIG_TICK_NS; t <= duration_ns; t += RIG_TICK_NS) {
		double missing = target - motion->speed_usteps_per_s;

		motion->speed_usteps_per_s += fmin(fmax(missing, -most), most);
		motion->position_usteps += motion->speed_usteps_per_s * 1e-9 * RIG_TICK_NS;
		rig_run_until(rig, begin_ns + t);
		while (motion->stepped_usteps < (int64_t)floor(motion->position_usteps)) {
			lw_plant_step(&rig->plant, 1);
			motion->stepped_usteps++;
		}
		while (motion->stepped_usteps > (int64_t)floor(motion->position_usteps)) {
			lw_plant_step(&rig->plant, -1);
			motion->stepped_usteps--;
		}
	}
}

#endif /* TEST_PLANT_RIG_H */
