"""Mistakes of a first run, made in an LCM log."""
import math
import struct

import lcm_log

IMU = struct.Struct(">8sqqiq6d")  # fingerprint, time, sequence, schema, interval, increments of angle and velocity
EPOCH = struct.Struct(">8sqqii")  # fingerprint, time, sequence, schema, observations
OBSERVATION = struct.Struct(">bhbbdddffb")  # system, number, band, attribute, code, carrier, Doppler, C/N0, lock, flags
LEAP_S = 18

# Angle a and velocity v increments over dt seconds, as they come in the place of the true ones.
IMU_MISTAKES = {
    "forward-left-up": lambda a, v, dt: ((a[0], -a[1], -a[2]), (v[0], -v[1], -v[2])),
    "right-forward-up": lambda a, v, dt: ((a[1], a[0], -a[2]), (v[1], v[0], -v[2])),
    "forward-right-exchanged": lambda a, v, dt: ((a[1], a[0], a[2]), (v[1], v[0], v[2])),
    "backwards": lambda a, v, dt: ((-a[0], -a[1], a[2]), (-v[0], -v[1], v[2])),
    "yaw-gyro-sign": lambda a, v, dt: ((a[0], a[1], -a[2]), v),
    "force-sign": lambda a, v, dt: (a, tuple(-x for x in v)),
    "force-in-g": lambda a, v, dt: (a, tuple(x / 9.80665 for x in v)),
    "gyros-in-degrees": lambda a, v, dt: (tuple(math.degrees(x) for x in a), v),
    "increments-times-interval": lambda a, v, dt: (tuple(x * dt for x in a), tuple(x * dt for x in v)),
    "rates-as-increments": lambda a, v, dt: (tuple(x / dt for x in a), tuple(x / dt for x in v)),
}


def exchanged(observations, whole):
    """Of each satellite's first two signals: the names (whole), or the pseudoranges alone."""
    changed = [list(o) for o in observations]
    of = {}
    for o in changed:
        of.setdefault((o[0], o[1]), []).append(o)
    for signals in of.values():
        if len(signals) < 2:
            continue
        a, b = signals[:2]
        columns = (2, 3) if whole else (4,)
        for i in columns:
            a[i], b[i] = b[i], a[i]
    return sorted(changed, key=lambda o: o[:4])


GNSS_MISTAKES = {
    "doppler-sign": lambda all: [o[:6] + (-o[6],) + o[7:] for o in all],
    "signals-exchanged": lambda all: exchanged(all, True),
    "codes-exchanged": lambda all: exchanged(all, False),
}
# Seconds added to the stamps of a channel; "merged": put in the order of the stamps, as from files.
STAMP_MISTAKES = {
    "imu-in-utc": ("LEONAV_IMU", -LEAP_S, False),
    "gnss-in-utc": ("LEONAV_GNSS_EPOCH", -LEAP_S, False),
    "imu-in-utc-merged": ("LEONAV_IMU", -LEAP_S, True),
    "gnss-in-utc-merged": ("LEONAV_GNSS_EPOCH", -LEAP_S, True),
}


def turned(rpy_deg, v):
    """A vector of the body in the axes of an IMU that is mounted by roll, pitch, yaw."""
    roll, pitch, yaw = (math.radians(x) for x in rpy_deg)
    x, y, z = v
    x, y = math.cos(yaw) * x + math.sin(yaw) * y, math.cos(yaw) * y - math.sin(yaw) * x
    x, z = math.cos(pitch) * x - math.sin(pitch) * z, math.cos(pitch) * z + math.sin(pitch) * x
    return x, math.cos(roll) * y + math.sin(roll) * z, math.cos(roll) * z - math.sin(roll) * y


def imu_changed(change, data):
    head, time, sequence, schema, interval, *x = IMU.unpack(data)
    angle, velocity = change(tuple(x[:3]), tuple(x[3:]), interval * 1e-9)
    return IMU.pack(head, time, sequence, schema, interval, *angle, *velocity)


def epoch_changed(change, data):
    head = data[:EPOCH.size]
    observations = list(OBSERVATION.iter_unpack(data[EPOCH.size:]))
    return head + b"".join(OBSERVATION.pack(*o) for o in change(observations))


def stamp_s(data):
    """Of a message of the IMU or an epoch."""
    return struct.unpack_from(">q", data, 8)[0] * 1e-9


def stamped(seconds, data):
    return data[:8] + struct.pack(">q", struct.unpack_from(">q", data, 8)[0] + round(seconds * 1e9)) + data[16:]


def changed(mistake, messages):
    for wall, channel, data in messages:
        if channel == "LEONAV_IMU" and mistake in IMU_MISTAKES:
            data = imu_changed(IMU_MISTAKES[mistake], data)
        elif channel == "LEONAV_GNSS_EPOCH" and mistake in GNSS_MISTAKES:
            data = epoch_changed(GNSS_MISTAKES[mistake], data)
        elif mistake in STAMP_MISTAKES and channel == STAMP_MISTAKES[mistake][0]:
            _, seconds, merged = STAMP_MISTAKES[mistake]
            data, wall = stamped(seconds, data), wall + (seconds if merged else 0)
        yield wall, channel, data


MISTAKES = (*IMU_MISTAKES, *STAMP_MISTAKES, *GNSS_MISTAKES)


def write_misplaced(rpy_deg, late_s, source, target):
    """The log `source` with an IMU mounted by `rpy_deg` that measures `late_s` later than it stamps."""
    messages = []
    for wall, channel, data in lcm_log.messages(source):
        if channel == "LEONAV_IMU":
            data = imu_changed(lambda a, v, dt: (turned(rpy_deg, a), turned(rpy_deg, v)), stamped(-late_s, data))
            wall -= late_s
        messages.append((wall, channel, data))
    lcm_log.write(target, sorted(messages, key=lambda m: m[0]))


def write_mistaken(mistake, source, target):
    """The log `source` as a mistake changes its inputs."""
    messages = list(changed(mistake, lcm_log.messages(source)))
    if mistake in STAMP_MISTAKES:
        messages.sort(key=lambda m: m[0])
    lcm_log.write(target, messages)
