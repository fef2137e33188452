/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file
 * The judge of a launch: looks at the machine as it really is, at every edge and every millisecond,
 * and says which invariant was broken first. doc/campaign.md states each one with its reason.
 *
 * The controller is asked for what it tells the outside only (its status registers), never believed
 * about where the carriage is.
 */
#ifndef LW_CAMPAIGN_JUDGE_H
#define LW_CAMPAIGN_JUDGE_H

#include <stdbool.h>
#include <stdint.h>

#include "world.h"

/** What must never be broken. */
enum lw_invariant {
	/** The place that the steps command lies between the flanges. */
	LW_INVARIANT_FLANGE,
	/** No step toward an actuated overtravel switch. */
	LW_INVARIANT_OVERTRAVEL,
	/** A wrong lay is told within one traverse; a carriage that stands, sooner. */
	LW_INVARIANT_SILENT,
	/** Launch permit only after an indexing that really went to both switches. */
	LW_INVARIANT_PERMIT,
	/** At most one step per edge, and not before the slope has earned it. */
	LW_INVARIANT_BURST,
	/** No step in a state in which the carriage rests. */
	LW_INVARIANT_UNASKED,
	/** The pattern is the ideal reversing screw's, to the last bit. */
	LW_INVARIANT_PATTERN,
	/** Every edge on the pins is counted, and the pins tell what the drum does. */
	LW_INVARIANT_ODOMETER,
	/** A loss of synchronization that was told is made good in the sweep after the next
	 *  reversal. */
	LW_INVARIANT_RECOVERY,
	/** What does not disturb the lay gives no alarm. */
	LW_INVARIANT_FALSE_ALARM,
	/** Rope laid while the carriage stood is told. */
	LW_INVARIANT_STANDING,
	/** A request is answered once, also over a line that echoes, and after babble. */
	LW_INVARIANT_LINE,
	LW_INVARIANT_COUNT,
};

/** What came of a launch. */
struct lw_verdict {
	int32_t broken; /**< enum lw_invariant that was broken first; -1: none */
	uint32_t broken_ms;
	double found; /**< the value that broke it */
	double limit; /**< what it may be at most */

	uint32_t duration_ms;
	uint32_t tracking_ms;
	uint32_t permit_ms;
	int32_t state;     /**< at the end, enum lw_state */
	int32_t fault;     /**< the last one, enum lw_fault */
	uint32_t flags;    /**< at the end, bits of enum lw_flag */
	uint32_t los_seen; /**< LOS flags that were set at any time, bits of enum lw_flag */
	int32_t recoveries;
	uint64_t pole_slips;
	int64_t pin_edges;       /**< all edges on the pins, either direction */
	double error_usteps;     /**< largest error of the carriage while the permit stood */
	int64_t silent_edges;    /**< longest wrong lay that was not told */
	double slow_turns;       /**< the same in drum turns, too slow for the drum watch to see */
	int64_t recovered_edges; /**< longest way from being told to being right again */
	int64_t hidden_edges;    /**< largest difference of pins and drum */
};

/** A reversing screw, integrated on its own: position and slope in Q16.16 microsteps. */
struct lw_judge_screw {
	int64_t ka;
	int64_t ks;
	int64_t begin; /**< first position of the sweep */
	int64_t end;   /**< first position past the sweep */
	int64_t dwell_edges[2];
	int64_t m;
	int64_t u;
	int64_t rested_edges;
};

/** How far a counter has gone, both ways, since something began. */
struct lw_judge_range {
	bool begun;
	int64_t least;
	int64_t most;
};

/** State of the judge. It refers to its world. */
struct lw_judge {
	struct lw_world *world;
	struct lw_verdict verdict;
	bool harmless; /**< told by the scenario: nothing in it disturbs the lay */
	/** Told by the scenario: a bit of the controller's memory has been flipped. Only what the
	 *  rope and the carriage suffer without being told counts from here on. */
	bool upset;
	bool motor_reversed;    /**< told by the scenario: its direction is wired wrongly, now */
	bool switch_broken[2];  /**< told by the scenario: now */
	int64_t may_hide_edges; /**< told by the scenario: edges that its faults may hide or add */
	uint8_t channel_fault[2]; /**< told by the scenario: enum lw_plant_channel_fault, now */
	bool channels_hide;       /**< a channel has had a fault: edges are hidden without limit */
	bool index_open;          /**< told by the scenario: there are no index pulses */
	/** Nobody can know what was hidden: neither channel showed it, nor an index pulse. */
	bool unknowable;

	uint64_t now_ns; /**< of what is being judged */
	int phase;       /**< of the encoder's pins, 0..3 */
	int64_t edges;
	int64_t edges_base; /**< at power-up */
	int64_t true_base;
	int32_t edges_per_pulse;
	uint32_t uptime_ms;

	int64_t source_edges[3];         /**< net, by enum lw_edge_source */
	enum lw_edge_source step_source; /**< of the last step */
	int64_t step_edges;              /**< its source's, at the last step */
	int step;                        /**< the last step, 0: none since the last rest */
	uint32_t steps;                  /**< in this tick */
	uint64_t overtravel_ns[2];       /**< last time that it was not actuated */
	uint64_t blocked_ns;             /**< last time that one was actuated */

	int32_t state;
	bool sound; /**< motor and switches were right all the time since the indexing began */
	bool indexed;
	bool permit;
	uint32_t impossible_ms[2]; /**< a switch reads actuated far inward of its place, so long */
	bool homing;
	bool visited[2]; /**< the carriage really was at the switch since the indexing began */
	uint64_t seeking_pole_slips;

	bool correction_waited; /**< at the last tick, for the sweep */
	bool following;         /**< `screw` is what the pins ask for */
	struct lw_judge_screw screw;
	bool laying;               /**< `lay` is where the rope belongs */
	struct lw_judge_screw lay; /**< the same, driven by the drum itself */
	int64_t lay_edges;         /**< the drum's, that it has taken */
	int64_t transitions;       /**< of the drum, at the last tick */
	double transitions_per_ms; /**< of the drum, over some ticks */
	int64_t stood_pins_edges;  /**< the pins' edges when they last went on */
	int64_t standing_edges;    /**< hauled in while the carriage does not follow */
	uint32_t stood_ms;         /**< the drum turns and they have not, for so long */
	int32_t recoveries;
	struct lw_judge_range wrong;      /**< drum edges since the lay is wrong and not told */
	struct lw_judge_range right;      /**< drum edges since it is right again meanwhile */
	int64_t wrong_slow_edges;         /**< of them, those too slow for the watch */
	int64_t wrong_edges;              /**< the drum's at the last tick, while it is wrong */
	struct lw_judge_range recovering; /**< edges since it is told and nothing disturbs */
	bool recovered;
	uint64_t pole_slips;
};

/** Begin with a world that has just been powered up. */
void lw_judge_init(struct lw_judge *judge, struct lw_world *world);

/** To be called from lw_world_config.observe_edge. */
void lw_judge_edge(struct lw_judge *judge, enum lw_edge_source source, int step);

/** To be called from lw_world_config.observe_run. */
void lw_judge_run(struct lw_judge *judge, const struct lw_world_run *run);

/** To be called from lw_world_config.observe. */
void lw_judge_tick(struct lw_judge *judge);

/** A request to this unit has been sent: so many answers came. */
void lw_judge_answers(struct lw_judge *judge, uint32_t answers);

/** The launch is over: complete the verdict. */
void lw_judge_end(struct lw_judge *judge);

#endif /* LW_CAMPAIGN_JUDGE_H */
