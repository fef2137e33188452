/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * @brief The parts of the plant, the lower first; each uses only those above it. Not for hosts.
 *
 * The world is computed ahead by one substep: at its beginning the motion over the whole substep is
 * known (constant speed of drum and carriage), and so are the instants of what happens in it.
 */
#ifndef LW_PLANT_INTERNAL_H
#define LW_PLANT_INTERNAL_H

#include "plant_base.h"

void lw_plant_drum_init(struct lw_plant_drum *drum, const struct lw_plant_config *config);
/** Plan the drum's motion over the substep that begins at begin_ns. */
void lw_plant_drum_substep(struct lw_plant_drum *drum, uint64_t begin_ns);
/** Execute the planned transition. @return pins that changed */
uint32_t lw_plant_drum_transition(struct lw_plant *plant);
/** Execute the planned change of a dither or an extra pulse. @return pins that changed */
uint32_t lw_plant_drum_dither(struct lw_plant *plant);

/** Note whether the transitions until the next rare event are plain. */
void lw_plant_drum_note_plain(struct lw_plant_drum *drum);
/** Execute what is due at the encoder's wires now. @return pins that changed */
uint32_t lw_plant_drum_wires(struct lw_plant *plant);
/** Bring the encoder's pins to where the drum is. */
void lw_plant_drum_show(struct lw_plant *plant);
/** A wire of the encoder breaks, or is mended: enum lw_plant_channel_fault. */
void lw_plant_drum_channel(struct lw_plant_drum *drum, int channel, uint8_t fault, uint64_t now_ns);

void lw_plant_carriage_init(struct lw_plant_carriage *carriage,
			    const struct lw_plant_config *config);
/** Plan the carriage's motion over the substep that begins at begin_ns. */
void lw_plant_carriage_substep(struct lw_plant_carriage *carriage, uint64_t begin_ns);
/** Where the carriage is now. */
double lw_plant_carriage_usteps(const struct lw_plant *plant);
/** Where the rotor is now: the same, but for backlash and a loose coupling. */
double lw_plant_rotor_usteps(const struct lw_plant *plant);
/** Whole electrical periods by which the rotor at a position is behind its field. */
int64_t lw_plant_carriage_pole(const struct lw_plant_carriage *carriage, double position_usteps);
/** Hold the carriage where it is for the rest of the substep, at rest. */
void lw_plant_carriage_halt(struct lw_plant *plant);
/** Put the carriage somewhere else, at rest. */
void lw_plant_carriage_place(struct lw_plant *plant, double position_usteps);

/** Put a switch to rest as a carriage at position_usteps leaves it. */
void lw_plant_switch_init(struct lw_plant *plant, struct lw_plant_switch *contact,
			  double position_usteps);
/** Where the pole changes over next, outward. */
static inline double lw_plant_switch_point_usteps(const struct lw_plant_switch *contact)
{
	return contact->actuated ? contact->release_usteps : contact->trigger_usteps;
}
/** Plan when the pole moves, for a carriage motion over remaining_s from now on. */
void lw_plant_switch_plan(struct lw_plant_switch *contact, const struct lw_plant *plant,
			  double position_usteps, double remaining_s);
/** Execute what is due now. */
void lw_plant_switch_run(struct lw_plant *plant, struct lw_plant_switch *contact);
/** Bring the pins of all switches up to date. @return pins that changed */
uint32_t lw_plant_switch_pins(struct lw_plant *plant);

/** Plan when switches and trigger meet the carriage between now and the end of the substep. */
void lw_plant_plan_contacts(struct lw_plant *plant);
/** Note between which places nothing is to be planned, as switches and trigger are now. */
void lw_plant_note_clear(struct lw_plant *plant);
/** Does the carriage stay between them over the substep that begins now? Nothing is planned yet. */
bool lw_plant_is_clear(const struct lw_plant *plant);

/** Rope on the drum, layer by layer; off a bare drum it is negative. */
double lw_plant_rope_um(const struct lw_plant *plant);

#endif /* LW_PLANT_INTERNAL_H */
