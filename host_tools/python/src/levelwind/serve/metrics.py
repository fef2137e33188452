# SPDX-License-Identifier: Apache-2.0
"""What the server and the controller say to Prometheus."""

import time
from collections.abc import Iterator

from prometheus_client import CONTENT_TYPE_LATEST, CollectorRegistry, generate_latest
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily
from prometheus_client.metrics_core import Metric

from levelwind.line.live import LIVE_POINTS, all_flags
from levelwind.map_table import POINTS, Flag
from levelwind.serve.owner import PortOwner
from levelwind.serve.recorder import Recorder
from levelwind.serve.watcher import Watcher

FRESH_S = 1.0
NUMBERS = [p for p in LIVE_POINTS if p.bits is None and p.name != "launch_inhibit"]
QUANTILES = (0.5, 0.99, 1.0)


class _Collector:
    def __init__(self, owner: PortOwner, watcher: Watcher, recorder: Recorder | None) -> None:
        self.owner, self.watcher, self.recorder = owner, watcher, recorder

    def collect(self) -> Iterator[Metric]:
        """One look at everything."""
        counts = self.owner.counts
        for name, text, value in (
            ("requests", "Requests on the line", counts.requests),
            ("page_requests", "Of them the server's own", counts.page_requests),
            ("no_answer", "Requests without an answer", counts.no_answer),
            ("no_path", "Requests while the port was away", counts.no_path),
        ):
            yield CounterMetricFamily(f"levelwind_line_{name}", text, value)
        latency = GaugeMetricFamily(
            "levelwind_line_latency_seconds", "Of the last requests", labels=["quantile"]
        )
        taken = sorted(counts.line_s)
        for quantile in QUANTILES if taken else ():
            latency.add_metric([str(quantile)], taken[round(quantile * (len(taken) - 1))])
        yield latency
        if self.recorder is not None:
            state = self.recorder.state()
            yield CounterMetricFamily(
                "levelwind_recorder_lost_samples", "Found no room", self.recorder.lost
            )
            yield GaugeMetricFamily(
                "levelwind_recorder_ok", "The disk takes what is recorded", not state["problem"]
            )
        seen = self.watcher.seen
        age_s = time.monotonic() - seen.stamp_s if seen else float("inf")
        yield GaugeMetricFamily("levelwind_data_age_seconds", "Of the last answer", age_s)
        yield GaugeMetricFamily("levelwind_up", "The controller answers", age_s < FRESH_S)
        if seen is None or age_s >= FRESH_S:
            return  # nothing old
        for point in NUMBERS:
            yield GaugeMetricFamily(
                f"levelwind_{point.name}",
                POINTS[point.name].text.replace("\n", " "),
                seen.status[point.name],
            )
        flags = GaugeMetricFamily("levelwind_flag", "Discrete inputs", labels=["flag"])
        for bit in Flag:
            flags.add_metric([bit.label], all_flags(seen.status) >> bit & 1)
        yield flags


def exposition(owner: PortOwner, watcher: Watcher, recorder: Recorder | None) -> tuple[bytes, str]:
    """Text for Prometheus, and its type."""
    registry = CollectorRegistry(auto_describe=False)
    registry.register(_Collector(owner, watcher, recorder))
    return generate_latest(registry), CONTENT_TYPE_LATEST
