"""What is known of real-time corrections: from whom they come, for which satellites, and how old they are."""
import math

from typing import NamedTuple

from leonav import names

MOST_SOURCES, MOST_SATELLITES = 8, 512
KEPT_S = 120.0  # a satellite without a new state for longer is not counted any more; services send each at least once a minute


class Kept(NamedTuple):
    """The newest state of a satellite."""

    came: float  # monotonic time, s
    time_ns: int  # at which the ages hold
    clock_age_s: float
    orbit_age_s: float
    sigma_m: float


class Corrections:
    """The newest state of each satellite by the source of its corrections: provider and solution."""

    def __init__(self):
        self.sources = {}  # (provider, solution): [issue of the series, when it came, satellites]

    def take(self, fields, now):
        """Keeps the states of a message of CORRECTED_STATES. Each holds one system, or a part of it; `now` is a monotonic time in s."""
        key = (int(fields["provider"]), int(fields["solution"]))
        while key not in self.sources and len(self.sources) >= MOST_SOURCES:
            del self.sources[min(self.sources, key=lambda one: self.sources[one][1])]
        satellites = self.sources.get(key, (0, 0.0, {}))[2]
        for state in fields["states"]:
            satellite = int(state["system"]), int(state["number"])
            if satellite in satellites or len(satellites) < MOST_SATELLITES:
                ages = (float(state[name]) for name in ("clock_age_s", "orbit_age_s", "sigma_m"))
                satellites[satellite] = Kept(now, int(fields["time_ns"]), *ages)
        self.sources[key] = [int(fields["ssr_issue"]), now, {one: kept for one, kept in satellites.items() if now - kept.came <= KEPT_S}]

    def lines(self, data_time_ns, now):
        """A line for each source. Ages are of the reference times of the corrections at the time of the data, the oldest satellite's."""
        for (provider, solution), (issue, came, satellites) in sorted(self.sources.items()):
            title = f"provider {provider}, solution {solution}, issue {issue}:"
            kept = {one: state for one, state in satellites.items() if now - state.came <= KEPT_S}
            if not kept:
                yield f"{title} none for {now - came:.0f} s"
                continue
            since_s = {one: max(0, data_time_ns - state.time_ns) / 1e9 for one, state in kept.items()}
            clock = max(state.clock_age_s + since_s[one] for one, state in kept.items())
            orbit = max(state.orbit_age_s + since_s[one] for one, state in kept.items())
            sigma = sorted(state.sigma_m for state in kept.values())[len(kept) // 2]
            systems = [system for system, _ in kept]
            counted = ", ".join(f"{name} {systems.count(index)}" for index, name in enumerate(names.SYSTEMS) if index in systems)
            yield (f"{title} {len(kept)} satellites ({counted})   oldest: clock {_seconds(clock)}, orbit {_seconds(orbit)}   "
                   f"1 sigma {sigma:.2f} m   last {now - came:.0f} s ago")


def _seconds(value):
    return f"{value:.0f} s" if math.isfinite(value) else "-"
