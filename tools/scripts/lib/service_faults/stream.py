"""What is done to the messages of a drive, which are a list of (s, channel, payload)."""
import random
import struct

from service_faults.drive import EPOCH, IMU, ORBITS, PREFIX, PRODUCTS, START_NS, stamp_ns, stamped

IMU_FORMAT = struct.Struct(">8sqqiq6d")  # fingerprint, time, sequence, schema, interval, increments of angle and velocity
OBSERVATION = struct.Struct(">bhbbdddffb")  # system, number, band, attribute, code, carrier, Doppler, C/N0, lock, flags
EPOCH_BYTES = 32  # before the observations
S = 10**9


def changed(channel, begin, end, change):
    """`change` of each payload of the channel within the span; None leaves the message out."""
    def result(messages):
        for t, name, data in messages:
            if name == channel and begin <= t < end:
                data = change(data)
            if data is not None:
                yield t, name, data
    return lambda messages: list(result(messages))


def without(channel, begin, end):
    return changed(channel, begin, end, lambda data: None)


def shifted(channel, seconds, begin, end):
    """The stamps of the span are off by so much."""
    return changed(channel, begin, end, lambda data: stamped(data, stamp_ns(data) + round(seconds * S)))


def in_turn(*changes):
    def result(messages):
        for change in changes:
            messages = change(messages)
        return messages
    return result


def added(messages, more):
    return sorted([*messages, *more], key=lambda message: message[0])


def epochs_from_the_future(begin, seconds, count):
    """So many copies of an epoch, one after the other, from another time, and no IMU sample between them."""
    def result(messages):
        epoch = next(data for t, name, data in messages if name == EPOCH and t >= begin)
        more = [(begin, EPOCH, stamped(epoch, stamp_ns(epoch) + (seconds + k) * S)) for k in range(count)]
        return added(messages, more)
    return result


def imu_zeros(begin, end):
    def zeros(data):
        return IMU_FORMAT.pack(*IMU_FORMAT.unpack(data)[:5], *[0.0] * 6)
    return changed(IMU, begin, end, zeros)


def imu_frozen(begin, end):
    """The stamps go on, the values are those of one sample."""
    held = []

    def frozen(data):
        values = IMU_FORMAT.unpack(data)
        held[:] = held or values[5:]
        return IMU_FORMAT.pack(*values[:5], *held)
    return changed(IMU, begin, end, frozen)


def imu_repeated(begin, end):
    """The same message again and again."""
    held = []

    def repeated(data):
        held[:] = held or [data]
        return held[0]
    return changed(IMU, begin, end, repeated)


def orbits_stop(last_s, end):
    """Orbits and clocks of times behind `last_s` do not come; at `end` all come that should have come by then."""
    def result(messages):
        late = [(t, name, data) for t, name, data in messages if name == ORBITS and stamp_ns(data) > START_NS + last_s * S and t < end]
        gone = {id(data) for _, _, data in late}
        kept = [message for message in messages if id(message[2]) not in gone]
        return added(kept, [(end + 0.01 * k, name, data) for k, (_, name, data) in enumerate(late)])
    return result


def products_stop(begin):
    """No ephemerides, orbits, clocks and models any more."""
    return lambda messages: [message for message in messages if message[1] not in PRODUCTS or message[0] < begin]


def products_late(begin):
    """What was to come of them before then comes at once."""
    def result(messages):
        late = [message for message in messages if message[1] in PRODUCTS and message[0] < begin]
        kept = [message for message in messages if message[1] not in PRODUCTS or message[0] >= begin]
        return added(kept, [(begin + 0.001 * k, name, data) for k, (_, name, data) in enumerate(late)])
    return result


def new_names(begin, end, count):
    """So many messages, each on a channel of its own that nobody has: half of them begin as channels of leonav do."""
    def result(messages):
        more = [(begin + k * (end - begin) / count, f"{PREFIX if k % 2 else 'NEW_'}{k:06d}", b"nothing") for k in range(count)]
        return added(messages, more)
    return result


def observations(data):
    return OBSERVATION.iter_unpack(data[EPOCH_BYTES:])


def strongest(messages, system, begin, end):
    """The number of the satellite of the system that arrives best from begin to end, of those that are never missing."""
    seen, epochs = {}, 0
    for t, name, data in messages:
        if name != EPOCH or not begin <= t < end:
            continue
        epochs += 1
        best = {}
        for observation in observations(data):
            if observation[0] == system:
                best[observation[1]] = max(best.get(observation[1], 0.0), observation[7])
        for number, strength in best.items():
            seen.setdefault(number, []).append(strength)
    always = {number: strengths for number, strengths in seen.items() if len(strengths) == epochs}
    return max(always, key=lambda number: sum(always[number]))


# Messages per second of each input channel in a normal run.
NOMINAL_HZ = {"IMU": 200, "GNSS_EPOCH": 1, "EPHEMERIS": 1, "ORBIT_CLOCK": 1, "CORRECTED_STATES": 0.2, "BIASES": 0.1, "IONOSPHERE": 0.1,
              "ANTENNA": 0.1, "ODOMETER": 10, "COMMAND": 0.1, "CHECKPOINT": 0.1}


def junk(begin, end, factor):
    """Random bytes at so many times the nominal rate, between the good messages: half of them behind a true fingerprint and
    header, the rest without."""
    def result(messages):
        dice = random.Random(7)
        heads = {name: data[:EPOCH_BYTES] for _, name, data in messages}
        more = []
        for name, rate in NOMINAL_HZ.items():
            channel = PREFIX + name
            for k in range(int(rate * factor * (end - begin))):
                data = dice.randbytes(dice.randrange(400))
                if dice.random() < 0.5 and channel in heads:
                    data = heads[channel] + data
                more.append((begin + k / (rate * factor), channel, data))
        return added(messages, more)
    return result
