"""Draws the newest messages as lines of text."""
import collections
import datetime
import math

from leonav import names
from leonav.gps_time import unix_ns

EVENTS_SHOWN = 5
SILENT_S = 3.0
COUNTERS = ("rejected ", "lost ", "late ", "empty epochs", "imu gaps", "keyframes skipped", "filter resets")  # their beginnings
BAR = 20  # characters for 60 dB-Hz


class State:
    """The newest message of each channel, when it came, and the latest events."""

    def __init__(self):
        self.fields, self.came = {}, {}
        self.events = collections.deque(maxlen=EVENTS_SHOWN)

    def take(self, message, now):
        """Keeps a message; `now` is a monotonic time in s."""
        self.fields[message.channel], self.came[message.channel] = message.fields, now
        if message.channel == "EVENT":
            self.events.append(message.fields)

    def age_s(self, channel, now):
        return now - self.came[channel] if channel in self.came else math.inf


def number(value, pattern, unit=""):
    """A number with its unit; "-" where it is unknown."""
    return pattern % value + unit if math.isfinite(value) else "-"


def safe(text, width=200):
    """Text of a message without characters that would steer the terminal."""
    return "".join(one if one.isprintable() else "?" for one in text)[:width]


def clock(time_ns):
    """UTC of GPS time in ns; "-" where none is set."""
    if not 0 < time_ns < 2**62:
        return "-"
    stamp = datetime.datetime(1970, 1, 1) + datetime.timedelta(microseconds=int(unix_ns(time_ns)) // 1000)
    return stamp.strftime("%Y-%m-%d %H:%M:%S.") + f"{stamp.microsecond // 100000} UTC"


def name_of(value, known):
    return known[value] if 0 <= value < len(known) else "unknown"


def health_lines(health):
    yield (f"{safe(health['status'], 20)}  {safe(health['why'])}".rstrip())
    yield (f"uptime {number(health['uptime_s'], '%.0f', ' s')}   memory {number(health['memory_mb'], '%.0f', ' MB')}   "
           f"misses filter {health['ekf_misses']}, smoother {health['smoother_misses']}")
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


def satellite_lines(epoch):
    satellites = epoch["satellites"]
    yield (f"{epoch['satellites_used']} used of {len(satellites)}   PDOP {number(epoch['pdop'], '%.1f')}, "
           f"HDOP {number(epoch['hdop'], '%.1f')}, VDOP {number(epoch['vdop'], '%.1f')}")
    titles = names.satellite_names(satellites["system"], satellites["number"]) if len(satellites) else []
    rows = sorted(zip(titles, satellites), key=lambda pair: (pair[1]["reason"] > 1, -float(pair[1]["cn0_dbhz"])))
    for title, one in rows:
        cn0 = float(one["cn0_dbhz"])
        bar = "#" * round(min(max(cn0, 0.0), 60.0) / 60.0 * BAR) if math.isfinite(cn0) else ""
        yield (f"{title:7} {number(math.degrees(one['elevation_rad']), '%3.0f')} {number(math.degrees(one['azimuth_rad']) % 360, '%3.0f')} "
               f"{number(cn0, '%4.1f')} {bar:{BAR}} {name_of(int(one['reason']), names.REASONS)}")


def stream_lines(streams):
    for one in streams["streams"]:
        yield (f"{safe(one['name'], 16):16} {safe(one['state'], 12):12} published {one['messages']}, damaged {one['damaged']}, "
               f"refused {one['refused']}, failures {one['failures']}, last {number(one['message_age_s'], '%.1f', ' s')} ago   "
               f"{safe(one['detail'], 80)}".rstrip())


def event_lines(events):
    for one in reversed(events):
        yield (f"{clock(one['time_ns'])}  {name_of(one['stage'], names.STAGES)}: {name_of(one['kind'], names.EVENTS)}, "
               f"code {one['code']}, value {number(one['value'], '%.3f')}")


SECTIONS = (("health", "HEALTH", health_lines), ("solution", "SOLUTION", solution_lines), ("streams", "STREAMS", stream_lines))


def picture(state, now, width, height):
    """Returns the lines of the picture: at most `height`, none longer than `width`. Satellites come last and fill what is left."""
    lines = []
    for title, channel, draw in SECTIONS:
        if channel not in state.fields:
            if channel != "STREAMS":  # leonav-connect need not run
                lines.append(f"-- {title}: none came yet")
            continue
        age = state.age_s(channel, now)
        lines.append(f"-- {title}" + (f": SILENT for {age:.0f} s" if age > SILENT_S else ""))
        lines += ["   " + line for line in draw(state.fields[channel])]
    if state.events:
        lines.append("-- last events")
        lines += ["   " + line for line in event_lines(state.events)]
    if "EPOCH" in state.fields:
        age = state.age_s("EPOCH", now)
        lines.append("-- satellites: elevation, azimuth, C/N0" + (f": SILENT for {age:.0f} s" if age > SILENT_S else ""))
        lines += ["   " + line for line in satellite_lines(state.fields["EPOCH"])]
    return [line[:width] for line in lines[:height]]
