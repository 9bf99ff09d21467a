"""Changes to LCM logs: commands, checkpoints, damage. Each function takes and returns messages (s, channel, bytes)."""
import csv
import math
import random
import struct

EPOCH_HEAD = struct.Struct(">8sqqii")  # fingerprint, time, sequence, schema, observations
OBSERVATION = struct.Struct(">bhbbdddffb")  # system, number, band, attribute, code, carrier, Doppler, C/N0, lock, flags
IMU_HEAD = struct.Struct(">8sqqiq")  # fingerprint, time, sequence, schema, interval
DECISION = struct.Struct(">8sqqiqbbi")  # fingerprint, time, sequence, schema, epoch, mailbox, committed, iterations
COMMAND = struct.Struct(">8sqqibdd")  # fingerprint, time, sequence, schema, kind, value, sigma
CHECKPOINT = struct.Struct(">8sqqib3dddd3dd")  # ..., standing, antenna, sigma, heading, sigma, bias, sigma
COMMAND_TYPE = bytes.fromhex("78d6d3bbb0ad5bd0")  # fingerprint of lcmtypes/command_t.lcm
CHECKPOINT_TYPE = bytes.fromhex("c4467a3927b8fb38")  # of lcmtypes/checkpoint_t.lcm
IMU, EPOCH, ODOMETER = "LEONAV_IMU", "LEONAV_GNSS_EPOCH", "LEONAV_ODOMETER"
MEASURED = (IMU, EPOCH, ODOMETER)
SPEED_OF_LIGHT = 299_792_458.0
GPS, GALILEO = 0, 1
MEGAHERTZ = {"1": 1575.42, "2": 1227.60, "5": 1176.45, "7": 1207.14, "8": 1191.795, "6": 1278.75}
BEIDOU_MEGAHERTZ = {"2": 1561.098, "1": 1575.42, "5": 1176.45, "7": 1207.14, "6": 1268.52, "8": 1191.795}


def stamp_ns(data):
    return struct.unpack_from(">q", data, 8)[0]


def with_stamp(data, ns):
    return data[:8] + struct.pack(">q", ns) + data[16:]


def first_ns(messages):
    return next(stamp_ns(data) for _, channel, data in messages if channel == IMU or channel == EPOCH)


def observations_of(data):
    return [list(o) for o in OBSERVATION.iter_unpack(data[EPOCH_HEAD.size:])]


def epoch_of(data, observations):
    head = EPOCH_HEAD.unpack(data[:EPOCH_HEAD.size])
    return EPOCH_HEAD.pack(*head[:4], len(observations)) + b"".join(OBSERVATION.pack(*o) for o in observations)


def wavelength_m(observation):
    table = BEIDOU_MEGAHERTZ if observation[0] == 2 else MEGAHERTZ
    return SPEED_OF_LIGHT / (table[chr(observation[2])] * 1e6)


def spoiled(messages, first, count, hit, noise_m, late_s):
    """`count` epochs from the `first` (from 0) on: codes and carriers are wrong by the same metres, or stamps are late."""
    draw, number = random.Random(1), -1
    for wall, channel, data in messages:
        if channel == EPOCH:
            number += 1
            if first <= number < first + count:
                observations, off_of = observations_of(data), {}
                for o in observations:
                    off_m = off_of.setdefault((o[0], o[1]), noise_m * draw.gauss(0.0, 1.0))
                    if hit(o[0], o[1]):
                        o[4] += off_m
                        o[5] += off_m / wavelength_m(o)
                data = with_stamp(epoch_of(data, observations), stamp_ns(data) + round(late_s * 1e9))
        yield wall, channel, data


def inserted(messages, extra):
    """Inserts `extra`: (s since the first measurement, channel, function from a time in ns to bytes)."""
    messages, waiting = list(messages), sorted(extra, key=lambda e: e[0])
    start = first_ns(messages)
    for wall, channel, data in messages:
        while waiting and channel in MEASURED and stamp_ns(data) >= start + waiting[0][0] * 1e9:
            _, name, make = waiting.pop(0)
            yield wall, name, make(stamp_ns(data))
        yield wall, channel, data


def command(number, kind, value=0.0, sigma=0.0):
    return "LEONAV_COMMAND", lambda ns: COMMAND.pack(COMMAND_TYPE, ns, number, 1, kind, value, sigma)


RESTART, SET_HEADING = 0, 1


def rows_of_truth(path):
    with open(path, newline="") as file:
        return [{k: float(v) if v else math.nan for k, v in row.items()} for row in csv.DictReader(file)]


def heading_at(truth, since_s):
    """The heading, rad, in the row of the truth nearest to `since_s` after the first row."""
    row = min(truth, key=lambda r: abs(r["gps_tow_s"] - truth[0]["gps_tow_s"] - since_s))
    return math.radians(row["yaw_deg"])


def ecef(latitude_deg, longitude_deg, height_m):
    a, e2 = 6378137.0, 6.69437999014e-3
    phi, lam = math.radians(latitude_deg), math.radians(longitude_deg)
    n = a / math.sqrt(1.0 - e2 * math.sin(phi) ** 2)
    return ((n + height_m) * math.cos(phi) * math.cos(lam), (n + height_m) * math.cos(phi) * math.sin(lam),
            (n * (1.0 - e2) + height_m) * math.sin(phi))


def checkpoint(truth, age_s, standing=True, moved_m=0.0, turned_rad=0.0, antenna_up_m=1.2):
    """A CHECKPOINT with the place of the truth's first row, written `age_s` before the message."""
    row = truth[0]
    point = ecef(row["latitude_deg"] + moved_m / 111_132.0, row["longitude_deg"], row["height_m"] + antenna_up_m)
    heading = math.radians(row["yaw_deg"]) + turned_rad
    return "LEONAV_CHECKPOINT", lambda ns: CHECKPOINT.pack(
        CHECKPOINT_TYPE, ns - round(age_s * 1e9), 1, 1, 1 if standing else 0, *point, 2.0, heading, math.radians(1.0),
        1e-6, -1e-6, 5e-7, 3e-6)


def from_second(messages, since_s):
    """Removes the measurements of the first `since_s` seconds; products and ephemerides stay."""
    messages = list(messages)
    limit = first_ns(messages) + since_s * 1e9
    return [m for m in messages if m[1] not in MEASURED or stamp_ns(m[2]) >= limit]


def up_to_second(messages, until_s):
    messages = list(messages)
    limit = first_ns(messages) + until_s * 1e9
    return [m for m in messages if m[1] not in MEASURED or stamp_ns(m[2]) <= limit]


def jittered(messages, share):
    """IMU stamps are wrong by up to that share of their interval; one sample in 200 is lost."""
    draw = random.Random(2)
    for wall, channel, data in messages:
        if channel == IMU:
            interval = IMU_HEAD.unpack_from(data)[4]
            off = round(draw.uniform(-share, share) * interval)
            if draw.random() < 0.005:
                continue
            data = with_stamp(data, stamp_ns(data) + off)
        yield wall, channel, data


def in_bursts(messages, burst_s):
    """IMU stamps are rounded up to multiples of `burst_s`, as a serial adapter causes."""
    burst = round(burst_s * 1e9)
    for wall, channel, data in messages:
        if channel == IMU:
            data = with_stamp(data, -(-stamp_ns(data) // burst) * burst)
        yield wall, channel, data


def within(messages, start_ns, from_s, to_s):
    return [m for m in messages if m[1] in MEASURED and start_ns + from_s * 1e9 <= stamp_ns(m[2]) < start_ns + to_s * 1e9]


def pieces(messages, *spans):
    """The measurements of these spans (s, s) follow one another, so that time leaps between them. Products come first."""
    messages = list(messages)
    start = first_ns(messages)
    rest = [m for m in messages if m[1] not in MEASURED]
    return sum((within(messages, start, *span) for span in spans), rest)


def epochs_changed(messages, change):
    """change(s since the first measurement, time in ns, observations) returns the new observations of each epoch."""
    messages = list(messages)
    start = first_ns(messages)
    for wall, channel, data in messages:
        if channel == EPOCH:
            ns = stamp_ns(data)
            data = epoch_of(data, change((ns - start) * 1e-9, ns, observations_of(data)))
        yield wall, channel, data


def is_within(since_s, spans):
    return any(a <= since_s < b for a, b in spans)


def elsewhere(messages, others, spans, codes_alone=False):
    """Within these spans the epochs, or only their codes, are replaced by those of another log with the same stamps."""
    other = {stamp_ns(data): data for _, channel, data in others if channel == EPOCH}

    def change(since_s, ns, observations):
        if not is_within(since_s, spans) or ns not in other:
            return observations
        theirs = observations_of(other[ns])
        if not codes_alone:
            return theirs
        code_of = {tuple(o[:4]): o[4] for o in theirs}
        return [o[:4] + [code_of.get(tuple(o[:4]), o[4])] + o[5:] for o in observations]
    return epochs_changed(messages, change)


def codes_shifted(messages, spans, by_m):
    return epochs_changed(messages, lambda since_s, _, observations: [
        o[:4] + [o[4] + by_m * is_within(since_s, spans)] + o[5:] for o in observations])


def in_stages(messages, no_doppler_s, one_system_s, without=range(4)):
    """Dopplers (of the systems in `without`) begin at `no_doppler_s`, systems other than GPS at `one_system_s`."""
    def change(since_s, _, observations):
        if since_s < one_system_s:
            observations = [o for o in observations if o[0] == GPS]
        if since_s < no_doppler_s:
            observations = [o[:6] + [math.nan if o[0] in without else o[6]] + o[7:] for o in observations]
        return observations
    return epochs_changed(messages, change)


def wild_stamps(messages):
    """Epochs are stamped far ahead or far behind, or repeated; odometer increments are late or stamped far behind."""
    number, late = 0, []
    for wall, channel, data in messages:
        if channel == EPOCH:
            number += 1
            if number % 20 == 7:
                yield wall, channel, with_stamp(data, stamp_ns(data) + 30_000_000_000)
            if number % 20 == 11:
                yield wall, channel, with_stamp(data, stamp_ns(data) - 20_000_000_000)
            if number % 20 == 14:
                data = with_stamp(data, stamp_ns(data) + 6_000_000_000)
            if number % 20 == 17:
                yield wall, channel, data
        if channel == ODOMETER and number % 20 == 3:
            late.append((wall, channel, data))
            continue
        if channel == ODOMETER and 60 <= number < 70:
            data = with_stamp(data, stamp_ns(data) - 40_000_000_000)
        yield wall, channel, data
        if channel == EPOCH and number % 20 == 5:
            yield from late
            late = []


def without_products(messages, from_s, to_s):
    """Removes ORBIT_CLOCK between `from_s` and `to_s` of the log's own time."""
    messages = list(messages)
    start = next(wall for wall, channel, _ in messages if channel == EPOCH)
    return [m for m in messages if m[1] != "LEONAV_ORBIT_CLOCK" or not from_s <= m[0] - start < to_s]


def damaged(messages):
    """Random damage: messages are cut, lost, exchanged, repeated, foreign, absurd, or have a flipped bit."""
    draw, held = random.Random(3), None
    for wall, channel, data in messages:
        kind = draw.random()
        rare = 10.0 if channel == IMU else 1.0
        if kind < 0.01 / rare:
            data = data[:draw.randrange(len(data))]
        elif kind < 0.02 / rare:
            at = draw.randrange(len(data))
            data = data[:at] + bytes([data[at] ^ (1 << draw.randrange(8))]) + data[at + 1:]
        elif kind < 0.025 / rare:
            yield wall, "CAMERA", b"\1\2\3\4"
        elif kind < 0.035 / rare:
            continue
        elif kind < 0.045 / rare:
            yield wall, channel, data
        elif kind < 0.055 / rare and held is None:
            held = (wall, channel, data)
            continue
        elif kind < 0.065 / rare and channel == IMU:
            data = data[:IMU_HEAD.size] + struct.pack(">6d", *draw.choice(((0.0,) * 6, (math.nan,) + (0.0,) * 5, (50.0,) * 6)))
        elif kind < 0.10 and channel == EPOCH:
            observations = observations_of(data)
            for o in observations:
                what = draw.random()
                if what < 0.05:
                    o[draw.choice((4, 5, 6))] = draw.choice((math.nan, math.inf, 1e12, 0.0, -2e7))
                elif what < 0.08:
                    o[4] += draw.choice((-1.0, 1.0)) * draw.uniform(20.0, 3000.0)
                elif what < 0.10:
                    o[6] += draw.uniform(-100.0, 100.0)
            data = epoch_of(data, observations)
        yield wall, channel, data
        if held is not None and draw.random() < 0.3:
            yield wall, held[1], held[2]
            held = None


def decisions_missed(messages, every):
    """Turns each `every`-th decision of a journal into a miss."""
    for wall, channel, data in messages:
        if channel == "LEONAV_DECISION":
            head = list(DECISION.unpack(data))
            if head[4] % every == 0:
                head[6], head[7] = 0, 0
                data = DECISION.pack(*head)
        yield wall, channel, data
