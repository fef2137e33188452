/**
 * @file
 * @brief What the parts of the plant need of each other. Not for hosts.
 *
 * The world is computed ahead by one substep: at its beginning the motion over the whole substep is
 * known (constant speed of drum and carriage), and so are the instants of what happens in it.
 */
#ifndef LW_PLANT_INTERNAL_H
#define LW_PLANT_INTERNAL_H

#include <lw/plant.h>

#define NS_PER_US 1000u
#define NS_PER_MS 1000000u
#define S_PER_NS  1e-9

/** The substep in seconds. */
#define SUBSTEP_S (LW_PLANT_SUBSTEP_NS * S_PER_NS)

/** Time between two changes of a dithering encoder, or of pulses that the drum has not made. */
#define DITHER_INTERVAL_NS 20000u

static inline uint64_t earlier_ns(uint64_t a_ns, uint64_t b_ns)
{
	return a_ns < b_ns ? a_ns : b_ns;
}

/** Beginning of the substep that is under way. */
static inline uint64_t substep_begin_ns(const struct lw_plant *plant)
{
	return plant->substep_ns - LW_PLANT_SUBSTEP_NS;
}

/** Uniformly distributed in [0, range). */
uint32_t lw_plant_random(struct lw_plant *plant, uint32_t range);

/** Plan when switches and trigger meet the carriage between now and the end of the substep. */
void lw_plant_plan_contacts(struct lw_plant *plant);

void lw_plant_drum_init(struct lw_plant_drum *drum, const struct lw_plant_config *config);
/** Plan the drum's motion over the substep that begins at begin_ns. */
void lw_plant_drum_substep(struct lw_plant_drum *drum, uint64_t begin_ns);
/** Execute the planned transition. @return pins that changed */
uint32_t lw_plant_drum_transition(struct lw_plant *plant);
/** Execute the planned change of a dither or an extra pulse. @return pins that changed */
uint32_t lw_plant_drum_dither(struct lw_plant *plant);

void lw_plant_carriage_init(struct lw_plant_carriage *carriage,
			    const struct lw_plant_config *config);
/** Plan the carriage's motion over the substep that begins at begin_ns. */
void lw_plant_carriage_substep(struct lw_plant_carriage *carriage, uint64_t begin_ns);
/** Where the carriage is now. */
double lw_plant_carriage_usteps(const struct lw_plant *plant);
/** Whole electrical periods by which the rotor at a position is behind its field. */
int64_t lw_plant_carriage_pole(const struct lw_plant_carriage *carriage, double position_usteps);
/** Hold the carriage at a position for the rest of the substep, at rest. */
void lw_plant_carriage_halt(struct lw_plant *plant, double position_usteps);

/** Put a switch to rest as a carriage at position_usteps leaves it. */
void lw_plant_switch_init(struct lw_plant_switch *contact, double position_usteps);
/** Plan when the pole moves, for a carriage motion over remaining_s from now on. */
void lw_plant_switch_plan(struct lw_plant_switch *contact, const struct lw_plant *plant,
			  double position_usteps, double remaining_s);
/** Execute what is due now. */
void lw_plant_switch_run(struct lw_plant *plant, struct lw_plant_switch *contact);
/** Bring the pins of all switches up to date. @return pins that changed */
uint32_t lw_plant_switch_pins(struct lw_plant *plant);

#endif /* LW_PLANT_INTERNAL_H */
