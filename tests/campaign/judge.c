/* SPDX-License-Identifier: Apache-2.0 */
#include "judge.h"

#include <math.h>
#include <stdlib.h>

#include "lw/bytes/require.h"
#include "lw/motion/law.h"

/** Microsteps per micrometre of the plant's defaults, which the scenarios keep. */
#define USTEPS_PER_UM 0.1

/** A limit switch of the plant tells late by the transit of its contact and by its speed shift. */
#define LATE_S 0.0015

/** Fastest carriage: 60,000 edges/s, where overspeed stops it, times the factory slope. */
#define CARRIAGE_MAX_USTEPS_PER_S 25000.0

/** The drum watch sees a dead channel from this speed on, and a loose wire, that is dead half of
 * the time and at random. Transitions of the drum: two of each channel's; a tenth more, to be fair.
 */
#define DEAD_PER_MS  4.4
#define LOOSE_PER_MS 13.0

/** What is lost within so many revolutions of the encoder after power-up, nobody can know. */
#define SILENT_REVOLUTIONS 2

/** Later than its threshold by so many drum turns, rope laid standing is not told. */
#define STANDING_MARGIN_TURNS 0.05

/** Withheld steps end in a fault at the next tick. */
#define BLOCKED_NS 2000000u

/** So long a switch may tell what cannot be, before it must cost the permit. */
#define IMPOSSIBLE_MS 300

/** How long a carriage may stand beside a turning drum. */
#define STOOD_MS 600

/** A rotor in step is less than a quarter of its electrical period off. */
#define ROTOR_USTEPS 10.0

static void broken(struct lw_judge *judge, enum lw_invariant invariant, double found, double limit)
{
	struct lw_verdict *verdict = &judge->verdict;
	const bool counts = !judge->upset || invariant == LW_INVARIANT_OVERTRAVEL ||
			    invariant == LW_INVARIANT_SILENT || invariant == LW_INVARIANT_UNASKED;

	if (verdict->broken < 0 && counts) {
		verdict->broken = (int32_t)invariant;
		verdict->broken_ms = (uint32_t)(judge->now_ns / 1000000u);
		verdict->found = found;
		verdict->limit = limit;
	}
}

/* ---- the ideal screw ------------------------------------------------------------------------- */

static int region(const struct lw_judge_screw *screw)
{
	return screw->m >= screw->end ? -1 : screw->m < screw->begin ? 1 : 0;
}

/** Edges to rest at the far point where the screw is. */
static int64_t dwell_edges(const struct lw_judge_screw *screw)
{
	return screw->dwell_edges[screw->m >= screw->end ? LW_PLUS : LW_MINUS];
}

static void turn(struct lw_judge_screw *screw, int dd)
{
	if (screw->u == 0 && dd > 0 && screw->rested_edges < dwell_edges(screw)) {
		screw->rested_edges++;
	} else if (screw->u == 0 && dd < 0 && screw->rested_edges > 0) {
		screw->rested_edges--;
	} else if (dd > 0) {
		screw->rested_edges = 0;
		screw->u += region(screw) * screw->ka;
		screw->m += screw->u;
	} else {
		screw->m -= screw->u;
		screw->u -= region(screw) * screw->ka;
		screw->rested_edges = screw->u == 0 ? dwell_edges(screw) : 0;
	}
}

/** Turn so many edges one way. */
static void turn_run(struct lw_judge_screw *screw, int dd, int64_t edges)
{
	const int64_t to = screw->m + dd * edges * screw->u;

	/* The sweep has nothing but its slope: between two places in it lie no others. */
	if (screw->u != 0 && screw->m >= screw->begin && screw->m < screw->end &&
	    to >= screw->begin && to < screw->end) {
		screw->m = to;
		screw->rested_edges = 0;
		return;
	}
	for (; edges > 0; edges--) {
		turn(screw, dd);
	}
}

static void anchor(struct lw_judge *judge, const struct lw_status *status)
{
	judge->screw = (struct lw_judge_screw){
		.ka = status->ka,
		.ks = status->ks,
		.begin = (int64_t)(status->reversal_minus_usteps + 1) * LW_USTEP,
		.end = (int64_t)status->reversal_plus_usteps * LW_USTEP,
		.dwell_edges = {(int64_t)status->dwell_plus_edges,
				(int64_t)status->dwell_minus_edges},
		.m = status->m,
		.u = status->u,
	};
	judge->following = true;
	judge->lay = judge->screw;
	judge->laying = true;
	judge->recoveries = status->los_recoveries;
}

/** Edges from a switch to the other one, in either direction of the drum. */
static int64_t traverse_edges(const struct lw_judge_screw *screw)
{
	const int64_t dwell = screw->dwell_edges[LW_PLUS] > screw->dwell_edges[LW_MINUS]
				      ? screw->dwell_edges[LW_PLUS]
				      : screw->dwell_edges[LW_MINUS];

	return (screw->end - screw->begin) / screw->ks + 1 + 2 * (screw->ks / screw->ka) + dwell;
}

/** The tolerance of a lay, see doc/campaign.md. */
static double tolerance_usteps(const struct lw_judge *judge)
{
	return judge->world->device.active.switch_tolerance_um * USTEPS_PER_UM +
	       LATE_S * CARRIAGE_MAX_USTEPS_PER_S + ROTOR_USTEPS;
}

/** Edges that a switch may be passed late: from its place to where a reversal is judged. */
static int64_t slack_edges(const struct lw_judge *judge)
{
	const struct lw_params *active = &judge->world->device.active;
	const int32_t plus_um = active->reversal_plus_um - active->switch_plus_um;
	const int32_t minus_um = active->switch_minus_um - active->reversal_minus_um;
	const double usteps =
		USTEPS_PER_UM * (fmax(plus_um, minus_um) + active->switch_tolerance_um +
				 active->switch_hysteresis_um) +
		tolerance_usteps(judge);

	return (int64_t)(usteps * LW_USTEP / (double)judge->screw.ks) + 200;
}

static void begin_range(struct lw_judge_range *range, int64_t edges)
{
	*range = (struct lw_judge_range){.begun = true, .least = edges, .most = edges};
}

static int64_t widen_range(struct lw_judge_range *range, int64_t edges)
{
	range->least = edges < range->least ? edges : range->least;
	range->most = edges > range->most ? edges : range->most;
	return range->most - range->least;
}

/* ---- edges ----------------------------------------------------------------------------------- */

/** Where in a pulse the pins are: A leads B. */
static int pins_phase(const struct lw_world *world)
{
	static const int phases[2][2] = {{0, 3}, {1, 2}};

	return phases[world->plant.pins.encoder_a][world->plant.pins.encoder_b];
}

/** Edges used of those up to a transition; for phase 0 -> 1 of pulse 0 it becomes 1. */
static int64_t used_edges(int64_t transitions, int32_t edges_per_pulse)
{
	const int spacing_log2 = edges_per_pulse == 4 ? 0 : edges_per_pulse == 2 ? 1 : 2;

	return (transitions + (1 << spacing_log2) - 1) >> spacing_log2;
}

static int64_t true_edges(const struct lw_judge *judge, const struct lw_plant_truth *truth)
{
	return used_edges(truth->drum_transitions, judge->edges_per_pulse);
}

/** The used edge that lies between the pins before and now: +1, -1, or 0. */
static int pins_edge(struct lw_judge *judge)
{
	const int before = judge->phase;
	const int phase = pins_phase(judge->world);
	const int moved = (phase - before) & 3;
	const int dd = moved == 1 ? 1 : -1;
	const int behind = dd > 0 ? before : phase; /* the transition's backward end */

	judge->phase = phase;
	if (moved == 2 || moved == 0) {
		return 0; /* both channels at once say nothing about the direction */
	}
	return behind % (4 / judge->edges_per_pulse) == 0 ? dd : 0;
}

static inline void check_step(struct lw_judge *judge, enum lw_edge_source source, int step)
{
	const struct lw_world *world = judge->world;
	const int direction = judge->motor_reversed ? -step : step;
	const int side = direction > 0 ? LW_PLUS : LW_MINUS;
	/* A motor that is wired wrongly is stopped by the tick, or moves out when told to back off.
	 */
	const bool backing_off =
		judge->state == LW_STATE_JOGGING || judge->state == LW_STATE_BACKING_OFF;
	const uint64_t late_ns = !judge->motor_reversed ? 0 : backing_off ? UINT64_MAX : 2000000u;

	judge->steps++;
	if (step > 1 || step < -1) {
		broken(judge, LW_INVARIANT_BURST, step, 1);
	}
	if (world->plant.pins.overtravel[side] &&
	    judge->now_ns - judge->overtravel_ns[side] >= late_ns) {
		broken(judge, LW_INVARIANT_OVERTRAVEL, 1, 0);
	}
	/* Beside an overtravel switch that is actuated, or was in this tick, an edge that rocks
	 * steps away from it only. */
	if (judge->step == step && judge->step_source == source && judge->screw.ks > 0 &&
	    (judge->blocked_ns == 0 || judge->now_ns - judge->blocked_ns > BLOCKED_NS)) {
		/* A whole microstep lies between two steps the same way. */
		const int64_t between = llabs(judge->source_edges[source] - judge->step_edges);

		if ((between + 1) * judge->screw.ks <= LW_USTEP) {
			broken(judge, LW_INVARIANT_BURST, (double)between,
			       (double)LW_USTEP / (double)judge->screw.ks);
		}
	}
	judge->step = step;
	judge->step_source = source;
	judge->step_edges = judge->source_edges[source];
}

/** Is an overtravel switch actuated? */
static bool is_blocked(const struct lw_judge *judge)
{
	const struct lw_plant_pins *pins = &judge->world->plant.pins;

	return pins->overtravel[LW_PLUS] || pins->overtravel[LW_MINUS];
}

/** Something happens at this time. */
static void begin_edge(struct lw_judge *judge, uint64_t now_ns)
{
	const struct lw_plant_pins *pins = &judge->world->plant.pins;

	judge->now_ns = now_ns;
	if (is_blocked(judge)) {
		judge->blocked_ns = now_ns;
	}
	for (int side = 0; side < 2; side++) {
		if (!pins->overtravel[side]) {
			judge->overtravel_ns[side] = now_ns;
		}
	}
}

void lw_judge_edge(struct lw_judge *judge, enum lw_edge_source source, int step)
{
	const int edge = source == LW_EDGE_SOURCE_TIMER ? 1 : pins_edge(judge);

	begin_edge(judge, judge->world->now_ns);
	judge->source_edges[source] += edge;
	if (source == LW_EDGE_SOURCE_ENCODER) {
		judge->edges += edge;
		judge->verdict.pin_edges += edge != 0;
		if (judge->following && edge != 0) {
			turn(&judge->screw, edge);
		}
	}
	if (step != 0) {
		if (edge == 0) {
			broken(judge, LW_INVARIANT_BURST, 1, 0);
		}
		check_step(judge, source, step);
	}
}

void lw_judge_run(struct lw_judge *judge, const struct lw_world_run *run)
{
	const int dd = run->direction;
	const int64_t from =
		LW_WORLD_RUN_MAX + judge->phase; /* a multiple of 4 more: none below 0 */
	const int64_t base = used_edges(from, judge->edges_per_pulse);
	const int64_t before = judge->source_edges[LW_EDGE_SOURCE_ENCODER];
	const int64_t edges =
		used_edges(from + dd * (int64_t)run->count, judge->edges_per_pulse) - base;
	/* No switch changes in a run. */
	const bool blocked = is_blocked(judge);

	for (uint32_t i = 0; i < run->step_count; i++) {
		const int64_t at = from + dd * (int64_t)run->steps[i].transition;
		const int64_t to = used_edges(at, judge->edges_per_pulse);

		judge->now_ns = run->steps[i].time_ns;
		if (blocked) {
			begin_edge(judge, run->steps[i].time_ns);
		}
		judge->source_edges[LW_EDGE_SOURCE_ENCODER] = before + to - base;
		if (to == used_edges(at - dd, judge->edges_per_pulse)) {
			broken(judge, LW_INVARIANT_BURST, 1, 0);
		}
		check_step(judge, LW_EDGE_SOURCE_ENCODER, run->steps[i].steps);
	}
	begin_edge(judge, judge->world->now_ns);
	judge->phase = (int)((from + dd * (int64_t)run->count) & 3);
	judge->source_edges[LW_EDGE_SOURCE_ENCODER] = before + edges;
	judge->edges += edges;
	judge->verdict.pin_edges += llabs(edges);
	if (judge->following && edges != 0) {
		turn_run(&judge->screw, dd, llabs(edges));
	}
	LW_REQUIRE(judge->phase == pins_phase(judge->world));
}

/* ---- every millisecond ----------------------------------------------------------------------- */

static bool resting(int32_t state)
{
	return state == LW_STATE_UNINDEXED || state == LW_STATE_READY ||
	       state == LW_STATE_CENTRED || state == LW_STATE_OFF || state == LW_STATE_FAULT;
}

static bool flag(const struct lw_status *status, enum lw_flag bit)
{
	return ((uint64_t)status->flags_2 << 32 | status->flags) >> bit & 1u;
}

static void check_odometer(struct lw_judge *judge, const struct lw_status *status,
			   const struct lw_plant_truth *truth)
{
	if (status->uptime_ms < judge->uptime_ms ||
	    judge->edges_per_pulse != judge->world->device.active.encoder_edges_per_pulse) {
		judge->edges_per_pulse = judge->world->device.active.encoder_edges_per_pulse;
		judge->edges_base = judge->edges - status->net_edges;
		judge->true_base = true_edges(judge, truth) - status->net_edges;
		judge->lay_edges = true_edges(judge, truth);
		judge->standing_edges = 0;
		if (status->uptime_ms < judge->uptime_ms && status->net_edges != 0) {
			broken(judge, LW_INVARIANT_ODOMETER, (double)status->net_edges, 0);
		}
	}

	const int64_t counted = judge->edges - judge->edges_base;
	const int64_t hidden = llabs(counted - (true_edges(judge, truth) - judge->true_base));
	/* One pulse may be under way, and one dither. */
	const int64_t may = judge->may_hide_edges + judge->edges_per_pulse + 1;

	if (status->net_edges != counted) {
		broken(judge, LW_INVARIANT_ODOMETER, (double)(status->net_edges - counted), 0);
	}
	if (hidden > may && !judge->channels_hide) {
		broken(judge, LW_INVARIANT_ODOMETER, (double)hidden, (double)may);
	}
	/* The first index pulse has nothing to be compared with, and the second one only it. */
	if (hidden > judge->edges_per_pulse + 1 && !judge->channels_hide &&
	    llabs(true_edges(judge, truth) - judge->true_base) <
		    (int64_t)SILENT_REVOLUTIONS * judge->edges_per_pulse *
			    judge->world->device.active.encoder_pulses_per_rev) {
		judge->unknowable = true;
	}
	if (hidden > judge->verdict.hidden_edges && !judge->channels_hide) {
		judge->verdict.hidden_edges = hidden;
	}
}

static void check_place(struct lw_judge *judge, const struct lw_status *status,
			const struct lw_plant_truth *truth)
{
	const struct lw_params *active = &judge->world->device.active;
	const double late_usteps =
		LATE_S * (double)active->index_rate_edges_per_s * (double)status->ks / LW_USTEP;
	const double place = (double)truth->commanded_usteps;
	const double plus = active->flange_plus_um * USTEPS_PER_UM + late_usteps;
	const double minus = active->flange_minus_um * USTEPS_PER_UM - late_usteps;

	if (status->state == LW_STATE_SEEKING || status->state == LW_STATE_BACKING_OFF) {
		judge->seeking_pole_slips = truth->pole_slips;
	}
	/* After a slip, and by a switch that lies, nobody knows where the steps lead. */
	if (!flag(status, LW_FLAG_INDEXED) || truth->pole_slips != judge->seeking_pole_slips ||
	    !judge->sound) {
		return;
	}
	if (place > plus) {
		broken(judge, LW_INVARIANT_FLANGE, place, plus);
	} else if (place < minus) {
		broken(judge, LW_INVARIANT_FLANGE, place, minus);
	}
}

/** Does a limit switch read actuated, by the contacts that are wired? */
static bool reads_actuated(const struct lw_judge *judge, int side)
{
	const struct lw_plant_pins *pins = &judge->world->plant.pins;

	switch (judge->world->device.active.switch_contacts) {
	case LW_SWITCH_CONTACTS_SINGLE_NO:
		return pins->limit[side].no_closed;
	case LW_SWITCH_CONTACTS_SINGLE_NC:
		return !pins->limit[side].nc_closed;
	default:
		return pins->limit[side].no_closed && !pins->limit[side].nc_closed;
	}
}

/** No permit while a switch tells what the place of the carriage makes impossible. */
static void check_switches(struct lw_judge *judge, const struct lw_status *status,
			   const struct lw_plant_truth *truth)
{
	const struct lw_params *active = &judge->world->device.active;
	const double margin =
		USTEPS_PER_UM * (active->switch_tolerance_um + active->switch_hysteresis_um) +
		2 * tolerance_usteps(judge);
	const double told = (double)status->m / LW_USTEP;

	for (int side = 0; side < 2; side++) {
		const int out = side == LW_PLUS ? 1 : -1;
		const double at = USTEPS_PER_UM * (side == LW_PLUS ? active->switch_plus_um
								   : active->switch_minus_um);
		const bool inward =
			out * (at - told) > margin && out * (at - truth->carriage_usteps) > margin;

		if (!flag(status, LW_FLAG_LAUNCH_PERMIT) || !inward ||
		    !reads_actuated(judge, side)) {
			judge->impossible_ms[side] = 0;
		} else if (++judge->impossible_ms[side] > IMPOSSIBLE_MS) {
			broken(judge, LW_INVARIANT_PERMIT, judge->impossible_ms[side],
			       IMPOSSIBLE_MS);
		}
	}
}

static void check_permit(struct lw_judge *judge, const struct lw_status *status,
			 const struct lw_plant_truth *truth)
{
	const struct lw_params *active = &judge->world->device.active;
	const struct lw_plant_pins *pins = &judge->world->plant.pins;
	const bool indexed = flag(status, LW_FLAG_INDEXED);
	const bool permit = flag(status, LW_FLAG_LAUNCH_PERMIT);
	const double near_usteps = tolerance_usteps(judge);
	const bool homing =
		status->state == LW_STATE_SEEKING || status->state == LW_STATE_BACKING_OFF;

	if ((judge->indexed && !indexed) || (homing && !judge->homing)) {
		judge->visited[LW_PLUS] = false;
		judge->visited[LW_MINUS] = false;
	}
	if (homing && !judge->homing) {
		judge->sound = true;
	}
	judge->sound &= !judge->motor_reversed && !judge->switch_broken[LW_PLUS] &&
			!judge->switch_broken[LW_MINUS];
	judge->indexed = indexed;
	judge->homing = homing;
	judge->visited[LW_PLUS] |=
		truth->carriage_usteps >= active->switch_plus_um * USTEPS_PER_UM - near_usteps;
	judge->visited[LW_MINUS] |=
		truth->carriage_usteps <= active->switch_minus_um * USTEPS_PER_UM + near_usteps;
	if (!indexed && (status->state == LW_STATE_READY || status->state == LW_STATE_CENTRED ||
			 status->state == LW_STATE_TRACKING)) {
		broken(judge, LW_INVARIANT_PERMIT, status->state, 0);
	}
	if (permit && !(indexed && judge->visited[LW_PLUS] && judge->visited[LW_MINUS])) {
		broken(judge, LW_INVARIANT_PERMIT, 1, 0);
	}
	if (permit && (pins->overtravel[LW_PLUS] || pins->overtravel[LW_MINUS] ||
		       status->state != LW_STATE_TRACKING || status->fault != LW_FAULT_NONE ||
		       flag(status, LW_FLAG_LOS))) {
		broken(judge, LW_INVARIANT_PERMIT, 1, 0);
	}
	judge->permit = permit;
	judge->verdict.permit_ms += permit;
}

/** Let the drum drive its screw, and see how fast it turns. */
static void turn_lay(struct lw_judge *judge, const struct lw_plant_truth *truth)
{
	const int64_t edges = true_edges(judge, truth);
	const double moved = (double)llabs(truth->drum_transitions - judge->transitions);

	turn_run(&judge->lay, edges > judge->lay_edges ? 1 : -1, llabs(edges - judge->lay_edges));
	judge->lay_edges = edges;
	judge->transitions = truth->drum_transitions;
	judge->transitions_per_ms += (moved - judge->transitions_per_ms) / 8.0;
}

/** Other reversal points: the drum's screw keeps its place, if it is in the sweep. */
static void move_lay(struct lw_judge *judge)
{
	struct lw_judge_screw *lay = &judge->lay;
	const bool was_in_sweep = region(lay) == 0;

	lay->begin = judge->screw.begin;
	lay->end = judge->screw.end;
	judge->laying = judge->laying && was_in_sweep && region(lay) == 0;
}

static void check_pattern(struct lw_judge *judge, const struct lw_status *status)
{
	struct lw_judge_screw *screw = &judge->screw;

	if (status->los_recoveries != judge->recoveries) {
		judge->laying = judge->upset;
		judge->following = false; /* the carriage is brought into another phase */
		/* It may be the count that was flipped. */
		if (!flag(status, LW_FLAG_LOS) && !judge->upset) {
			broken(judge, LW_INVARIANT_SILENT, status->los_recoveries, 0);
		}
	} else if (judge->upset) {
		judge->following = false; /* the reversal points that are told may be wrong */
	} else if (judge->correction_waited && screw->u == status->u && screw->m != status->m &&
		   (screw->m - status->m) % LW_USTEP == 0) {
		/* Left from before a hand-over or a trim, and on its way. */
		judge->laying = false;
		judge->following = false;
	} else if (screw->begin != (int64_t)(status->reversal_minus_usteps + 1) * LW_USTEP ||
		   screw->end != (int64_t)status->reversal_plus_usteps * LW_USTEP) {
		const struct lw_judge_screw lay = judge->lay;
		const bool as_one = lay.m == screw->m && lay.u == screw->u;

		anchor(judge, status); /* a trim has come into force */
		if (!as_one) {
			judge->lay = lay;
			move_lay(judge);
		}
	} else if (screw->m != status->m || screw->u != status->u) {
		broken(judge, LW_INVARIANT_PATTERN, status->m, (double)screw->m);
		anchor(judge, status);
	}
}

/** Can the controller see at this speed that a channel does not tell the drum's motion? */
static bool can_be_watched(const struct lw_judge *judge)
{
	const bool loose = judge->channel_fault[0] == LW_PLANT_CHANNEL_FLICKER ||
			   judge->channel_fault[1] == LW_PLANT_CHANNEL_FLICKER;

	if (!judge->channels_hide || !judge->index_open) {
		return true; /* index pulses tell at any speed */
	}
	return judge->transitions_per_ms >= (loose ? LOOSE_PER_MS : DEAD_PER_MS);
}

/** Does the carriage stand beside a turning drum, untold? */
static void check_stood(struct lw_judge *judge, const struct lw_status *status)
{
	/* Both channels dead only index pulses can tell, and they take as long as they take. */
	if (judge->unknowable || flag(status, LW_FLAG_LOS) ||
	    (judge->channel_fault[0] != 0 && judge->channel_fault[1] != 0) ||
	    judge->transitions_per_ms < DEAD_PER_MS ||
	    llabs(judge->edges - judge->stood_pins_edges) > 2) {
		judge->stood_pins_edges = judge->edges;
		judge->stood_ms = 0;
		return;
	}
	if (++judge->stood_ms > STOOD_MS) {
		broken(judge, LW_INVARIANT_SILENT, judge->stood_ms, STOOD_MS);
	}
}

/** Is the rope laid where the drum wants it, and if not, is it told? */
static void check_lay(struct lw_judge *judge, const struct lw_status *status,
		      const struct lw_plant_truth *truth)
{
	const int64_t way = traverse_edges(&judge->lay) + slack_edges(judge);
	/* A law whose position has jumped comes to its next reversal a little later. */
	const int64_t traverse = judge->upset ? way + way / 50 : way;
	const double tolerance = tolerance_usteps(judge);
	const double error = fabs(truth->carriage_usteps - (double)judge->lay.m / (double)LW_USTEP);

	if (judge->permit && !judge->unknowable && error > judge->verdict.error_usteps) {
		judge->verdict.error_usteps = error;
	}
	if (flag(status, LW_FLAG_LOS) || judge->unknowable || (judge->upset && !judge->permit)) {
		judge->wrong.begun = false;
		return;
	}
	if (error > tolerance) {
		judge->right.begun = false;
	} else if (!judge->wrong.begun) {
		return;
	} else if (!judge->right.begun) {
		begin_range(&judge->right, judge->lay_edges);
	} else if (widen_range(&judge->right, judge->lay_edges) > traverse / 4) {
		judge->wrong.begun = false; /* not where a shifted lay only crosses the right one */
		return;
	}
	if (!judge->wrong.begun) {
		begin_range(&judge->wrong, judge->lay_edges);
		judge->wrong_edges = judge->lay_edges;
		judge->wrong_slow_edges = 0;
	}
	if (!can_be_watched(judge)) {
		judge->wrong_slow_edges += llabs(judge->lay_edges - judge->wrong_edges);
	}
	judge->wrong_edges = judge->lay_edges;

	const int64_t silent =
		widen_range(&judge->wrong, judge->lay_edges) - judge->wrong_slow_edges;

	judge->verdict.slow_turns =
		fmax(judge->verdict.slow_turns,
		     (double)judge->wrong_slow_edges * 1000.0 / status->edges_per_1000_drum_revs);
	if (silent > judge->verdict.silent_edges) {
		judge->verdict.silent_edges = silent;
	}
	/* The limit is a parameter's, which a flipped bit may make anything until it is mended. */
	if (silent > 0 && silent > traverse) {
		broken(judge, LW_INVARIANT_SILENT, (double)silent, (double)traverse);
	}
}

/**
 * Rope that is hauled in while the carriage does not follow lies on one heap: a stack of turns, of
 * which the drum takes off what it pays out.
 */
static void check_standing(struct lw_judge *judge, const struct lw_status *status, int64_t turned)
{
	const bool meant =
		status->state == LW_STATE_TRACKING || status->state == LW_STATE_REACQUIRING ||
		status->active_mode == LW_MODE_OFF ||
		(status->active_mode == LW_MODE_CENTRE && status->fault == LW_FAULT_NONE);
	const double turn = status->edges_per_1000_drum_revs / 1000.0;
	const double limit = turn * (judge->world->device.active.standing_turns_permille / 1000.0 +
				     STANDING_MARGIN_TURNS);

	/* Each stand counts for itself; an indexing that succeeds ends one. */
	const bool indexed_now = flag(status, LW_FLAG_INDEXED) && !judge->indexed;

	judge->standing_edges += turned;
	if (judge->standing_edges < 0 || meant || indexed_now || judge->channels_hide ||
	    judge->may_hide_edges > (int64_t)(turn * STANDING_MARGIN_TURNS / 2)) {
		judge->standing_edges = 0;
	}
	if ((double)judge->standing_edges > limit && !flag(status, LW_FLAG_ROPE_LAID_STANDING)) {
		broken(judge, LW_INVARIANT_STANDING, (double)judge->standing_edges / turn,
		       limit / turn);
	}
}

/** Once told, is the lay made good within one sweep after the next reversal? */
static void check_recovery(struct lw_judge *judge, const struct lw_status *status,
			   const struct lw_plant_truth *truth)
{
	const double error = fabs(truth->carriage_usteps - (double)status->m / LW_USTEP);
	const bool slipping = truth->pole_slips != judge->pole_slips;
	const bool sound = error <= tolerance_usteps(judge);

	judge->pole_slips = truth->pole_slips;
	if (!flag(status, LW_FLAG_LOS) || slipping || !judge->sound) {
		judge->recovering.begun = false;
		return;
	}
	if (!judge->recovering.begun) {
		begin_range(&judge->recovering, judge->edges);
		judge->recovered = sound;
	}

	const int64_t way = widen_range(&judge->recovering, judge->edges);
	/* Up to a traverse to the next reversal, which tells; then the sweep to the other switch.
	 */
	const int64_t limit = 2 * traverse_edges(&judge->screw) + slack_edges(judge);

	if (!judge->recovered && sound && !flag(status, LW_FLAG_CORRECTION_PENDING)) {
		judge->recovered = true;
		if (way > judge->verdict.recovered_edges) {
			judge->verdict.recovered_edges = way;
		}
	}
	if (way > limit && !sound) {
		broken(judge, LW_INVARIANT_RECOVERY, error, tolerance_usteps(judge));
	}
}

static void check_alarm(struct lw_judge *judge, const struct lw_status *status,
			const struct lw_plant_truth *truth)
{
	const double error = fabs(truth->carriage_usteps - (double)judge->lay.m / LW_USTEP);

	if (!judge->harmless) {
		return;
	}
	if (flag(status, LW_FLAG_LOS) || status->fault != LW_FAULT_NONE) {
		broken(judge, LW_INVARIANT_FALSE_ALARM, status->fault, 0);
	}
	if (judge->laying && error > tolerance_usteps(judge)) {
		broken(judge, LW_INVARIANT_FALSE_ALARM, error, tolerance_usteps(judge));
	}
}

void lw_judge_tick(struct lw_judge *judge)
{
	const uint32_t los = 1u << LW_FLAG_LOS | 1u << LW_FLAG_LOS1_PLUS |
			     1u << LW_FLAG_LOS1_MINUS | 1u << LW_FLAG_LOS2_PLUS |
			     1u << LW_FLAG_LOS2_MINUS;
	struct lw_verdict *verdict = &judge->verdict;
	const struct lw_status *status = &judge->world->device.status_image;
	struct lw_plant_truth truth;
	int64_t lay_edges;

	judge->now_ns = judge->world->now_ns;
	lw_device_refresh_live(&judge->world->device);
	lw_plant_read_truth(&judge->world->plant, &truth);
	check_odometer(judge, status, &truth);
	lay_edges = judge->lay_edges;
	turn_lay(judge, &truth);
	check_standing(judge, status, judge->lay_edges - lay_edges);
	if (status->state != LW_STATE_TRACKING || status->uptime_ms < judge->uptime_ms) {
		judge->following = false;
		judge->laying = false;
		judge->wrong.begun = false;
		judge->recovering.begun = false;
	} else if (judge->state != LW_STATE_TRACKING) {
		anchor(judge, status);
	}
	if (resting(status->state)) {
		judge->step = 0;
		if (resting(judge->state) && judge->steps != 0) {
			broken(judge, LW_INVARIANT_UNASKED, judge->steps, 0);
		}
	}
	judge->screw.ks = status->ks;
	judge->steps = 0;
	judge->state = status->state;
	judge->uptime_ms = status->uptime_ms;

	check_place(judge, status, &truth);
	check_permit(judge, status, &truth);
	check_switches(judge, status, &truth);
	if (judge->following) {
		check_pattern(judge, status);
	}
	if (judge->laying) {
		check_lay(judge, status, &truth);
		check_stood(judge, status);
	}
	if (status->state == LW_STATE_TRACKING) {
		check_recovery(judge, status, &truth);
	}
	check_alarm(judge, status, &truth);
	judge->correction_waited = flag(status, LW_FLAG_CORRECTION_PENDING);

	verdict->tracking_ms += status->state == LW_STATE_TRACKING;
	verdict->los_seen |= status->flags & los;
	if (status->fault != LW_FAULT_NONE) {
		verdict->fault = status->fault;
	}
	if (status->los_recoveries > verdict->recoveries) {
		verdict->recoveries = status->los_recoveries;
	}
}

void lw_judge_init(struct lw_judge *judge, struct lw_world *world)
{
	struct lw_plant_truth truth;

	*judge = (struct lw_judge){
		.world = world,
		.verdict.broken = -1,
		.phase = pins_phase(world),
		.edges_per_pulse = world->device.active.encoder_edges_per_pulse,
		.sound = true,
	};
	lw_plant_read_truth(&world->plant, &truth);
	judge->true_base = true_edges(judge, &truth);
	judge->lay_edges = judge->true_base;
}

void lw_judge_answers(struct lw_judge *judge, uint32_t answers)
{
	judge->now_ns = judge->world->now_ns;
	if (answers != 1) {
		broken(judge, LW_INVARIANT_LINE, answers, 1);
	}
}

void lw_judge_end(struct lw_judge *judge)
{
	struct lw_plant_truth truth;

	lw_plant_read_truth(&judge->world->plant, &truth);
	lw_device_refresh_status(&judge->world->device);
	judge->verdict.duration_ms = (uint32_t)(judge->world->now_ns / 1000000u);
	judge->verdict.state = judge->world->device.status_image.state;
	judge->verdict.flags = judge->world->device.status_image.flags;
	judge->verdict.pole_slips = truth.pole_slips;
}
