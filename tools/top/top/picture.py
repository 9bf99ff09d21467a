"""Draws the newest messages as lines of text."""
import collections
import datetime
import math

from leonav import names
from leonav.gps_time import LATEST_NS, unix_ns

from .corrections import Corrections

EVENTS_SHOWN = 5
SILENT_S = 3.0
CORRECTIONS_SILENT_S = 60.0  # services send clocks each 5 to 30 s
MISSES = {"ekf_misses": ("filter", "commits"), "smoother_misses": ("smoother", "smoother commits")}  # name, results in time
COUNTERS = ("rejected ", "lost ", "late ", "empty epochs", "imu gaps", "keyframes skipped", "filter resets")  # their beginnings
BAR = 20  # characters for 60 dB-Hz


class State:
    """The newest message of each channel, when it came, the latest events, and when a deadline was last missed."""

    def __init__(self):
        self.fields, self.came, self.missed = {}, {}, {}
        self.events = collections.deque(maxlen=EVENTS_SHOWN)
        self.corrections = Corrections()

    def take(self, message, now):
        """Keeps a message; `now` is a monotonic time in s."""
        if message.channel == "HEALTH" and "HEALTH" in self.fields:
            for name in MISSES:
                if message.fields[name] > self.fields["HEALTH"][name]:
                    self.missed[name] = now
        self.fields[message.channel], self.came[message.channel] = message.fields, now
        if message.channel == "EVENT":
            self.events.append(message.fields)
        elif message.channel == "CORRECTED_STATES":
            self.corrections.take(message.fields, now)

    def data_time_ns(self):
        """The latest time of the data, GPS time in ns; 0 where none is known."""
        times = [int(self.fields[one]["time_ns"]) for one in ("HEALTH", "SOLUTION", "EPOCH") if one in self.fields]
        return max((one for one in times if 0 < one < LATEST_NS), default=0)

    def age_s(self, channel, now):
        return now - self.came[channel] if channel in self.came else math.inf


def number(value, pattern, unit=""):
    """A number with its unit; "-" where it is unknown."""
    return pattern % value + unit if math.isfinite(value) else "-"


def safe(text, width=None):
    """Text of a message without characters that would steer the terminal, at most `width` of them."""
    return "".join(one if one.isprintable() else "?" for one in text[:width])


def clock(time_ns):
    """UTC of GPS time in ns; "-" where none is set."""
    if not 0 < time_ns < 2**62:
        return "-"
    stamp = datetime.datetime(1970, 1, 1) + datetime.timedelta(microseconds=int(unix_ns(time_ns)) // 1000)
    return stamp.strftime("%Y-%m-%d %H:%M:%S.") + f"{stamp.microsecond // 100000} UTC"


def name_of(value, known):
    return known[value] if 0 <= value < len(known) else "unknown"


def misses_text(health, missed, now):
    """"filter 0 of 300, smoother 17 of 300, last 12 s ago": results that missed their deadline, of all."""
    counts = {one["name"]: one["value"] for one in health["counts"]}
    parts = []
    for name, (title, commits) in MISSES.items():
        misses = health[name]
        text = f"{title} {misses}" + (f" of {misses + counts[commits]}" if commits in counts else "")
        parts.append(text + (f", last {now - missed[name]:.0f} s ago" if name in missed else ""))
    return "misses " + ", ".join(parts)


def health_lines(health, missed, now):
    yield (f"{safe(health['status'], 20)}  {safe(health['why'])}".rstrip())
    yield (f"uptime {number(health['uptime_s'], '%.0f', ' s')}   memory {number(health['memory_mb'], '%.0f', ' MB')}   "
           f"{misses_text(health, missed, now)}")
    queues = ", ".join(f"{name} {level} %" for name, level in zip(("inertial", "gnss", "out"), health["queue_high_water_percent"]))
    yield (f"worst: tick {number(health['worst_tick_us'], '%.0f', ' us')}, filter {number(health['worst_ekf_ms'], '%.1f', ' ms')}, "
           f"solve {number(health['worst_solve_ms'], '%.1f', ' ms')}   queues {queues}")
    refused = [f"{safe(one['name'], 40)} {one['value']}" for one in health["counts"]
               if one["value"] and one["name"].startswith(COUNTERS)]
    if refused:
        yield "counts: " + ", ".join(refused)


def solution_lines(solution):
    source = name_of(solution["source"], names.SOURCES)
    yield f"{clock(solution['time_ns'])}   source {source}"
    if source == "none":
        return
    degrees = math.degrees
    yield (f"latitude {degrees(solution['latitude_rad']):.8f}   longitude {degrees(solution['longitude_rad']):.8f}   "
           f"height {solution['height_m']:.2f} m")
    north, east, down = solution["v_n"]
    speed = f"speed {math.hypot(north, east):.2f} m/s, up {-down:.2f} m/s"
    if solution["has_attitude"]:
        roll, pitch, yaw = (degrees(one) for one in solution["rpy_rad"])
        speed += f"   roll {roll:.2f}, pitch {pitch:.2f}, heading {yaw % 360:.2f} degrees (1 sigma {degrees(solution['sigma_rpy'][2]):.2f})"
    yield speed
    sigma = solution["sigma_p_n"]
    yield (f"1 sigma north {sigma[0]:.2f}, east {sigma[1]:.2f}, down {sigma[2]:.2f} m   protection levels: "
           f"horizontal {number(solution.get('horizontal_protection_m', math.nan), '%.1f', ' m')}, "
           f"vertical {number(solution.get('vertical_protection_m', math.nan), '%.1f', ' m')}")


def correction_lines(state, now):
    yield from state.corrections.lines(state.data_time_ns(), now)
    health = state.fields.get("HEALTH")
    if health is not None:
        parts = [f"{number_used} by {name} (oldest {number(age, '%.0f', ' s')})" for number_used, name, age in
                 zip(health["satellites_by_source"], ("broadcast messages", "corrected or precise states"), health["age_by_source_s"])]
        yield "satellites used: " + ", ".join(parts)


def satellite_lines(epoch):
    satellites = epoch["satellites"]
    used = [int(one["system"]) for one in satellites if one["reason"] <= 1]
    systems = "".join(f", {name} {used.count(index)}" for index, name in enumerate(names.SYSTEMS) if index in used)
    yield (f"{epoch['satellites_used']} used of {len(satellites)}{systems}   PDOP {number(epoch['pdop'], '%.1f')}, "
           f"HDOP {number(epoch['hdop'], '%.1f')}, VDOP {number(epoch['vdop'], '%.1f')}")
    titles = names.satellite_names(satellites["system"], satellites["number"]) if len(satellites) else []
    rows = sorted(zip(titles, satellites), key=lambda pair: (pair[1]["reason"] > 1, -float(pair[1]["cn0_dbhz"])))
    for title, one in rows:
        cn0 = float(one["cn0_dbhz"])
        bar = "#" * round(min(max(cn0, 0.0), 60.0) / 60.0 * BAR) if math.isfinite(cn0) else ""
        yield (f"{title:7} {number(math.degrees(one['elevation_rad']), '%3.0f')} {number(math.degrees(one['azimuth_rad']) % 360, '%3.0f')} "
               f"{number(cn0, '%4.1f')} {bar:{BAR}} {name_of(int(one['reason']), names.REASONS):16} {orbit_text(one)}".rstrip())


def orbit_text(satellite):
    """"precise, 12 s": by what a satellite's orbit is known and how old that is; empty of none."""
    orbit = name_of(int(satellite["orbit_source"]), names.ORBIT_SOURCES)
    return "" if orbit == "none" else f"{orbit}, {number(float(satellite['ephemeris_age_s']), '%.0f', ' s')}"


def stream_lines(streams):
    for one in streams["streams"]:
        yield (f"{safe(one['name'], 16):16} {safe(one['state'], 12):12} published {one['messages']}, damaged {one['damaged']}, "
               f"refused {one['refused']}, failures {one['failures']}, last {number(one['message_age_s'], '%.1f', ' s')} ago   "
               f"{safe(one['detail'])}".rstrip())


def event_lines(events):
    for one in reversed(events):
        yield (f"{clock(one['time_ns'])}  {name_of(one['stage'], names.STAGES)}: {name_of(one['kind'], names.EVENTS)}, "
               f"code {one['code']}, value {number(one['value'], '%.3f')}")


# Title, channel, what draws it of the state and the time, and whether it need not come: leonav-connect need not run.
SECTIONS = (
    ("health", "HEALTH", lambda state, now: health_lines(state.fields["HEALTH"], state.missed, now), False),
    ("solution", "SOLUTION", lambda state, now: solution_lines(state.fields["SOLUTION"]), False),
    ("streams", "STREAMS", lambda state, now: stream_lines(state.fields["STREAMS"]), True),
    ("corrections", "CORRECTED_STATES", correction_lines, True))


def picture(state, now, width=None, height=None):
    """Returns the lines of the picture: at most `height`, none longer than `width`; None: no limit. Satellites come last and fill what
    is left."""
    lines = []
    for title, channel, draw, optional in SECTIONS:
        if channel not in state.fields:
            if not optional:
                lines.append(f"-- {title}: none came yet")
            continue
        age = state.age_s(channel, now)
        silent = age > (CORRECTIONS_SILENT_S if channel == "CORRECTED_STATES" else SILENT_S)
        lines.append(f"-- {title}" + (f": SILENT for {age:.0f} s" if silent else ""))
        lines += ["   " + line for line in draw(state, now)]
    if state.events:
        lines.append("-- last events")
        lines += ["   " + line for line in event_lines(state.events)]
    if "EPOCH" in state.fields:
        age = state.age_s("EPOCH", now)
        silent = f": SILENT for {age:.0f} s" if age > SILENT_S else ""
        lines.append("-- satellites: elevation, azimuth, C/N0, whether used, orbit and its age" + silent)
        lines += ["   " + line for line in satellite_lines(state.fields["EPOCH"])]
    return [line[:width] for line in lines[:height]]
