#!/usr/bin/env python3
"""rtcm3_bytes_test.py STATION_FOLDER: what rtcm3_bytes.py encodes of a recorded station, as pyrtcm reads it.

Measurements and elements must be those of the RINEX files within half a step of their fields. And what damage.py makes of a
serial line at the right rate must be what was sent. Exit 77: no pyrtcm.
"""
import io
import itertools
import pathlib
import random
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path += [str(HERE), str(HERE.parents[2] / "tools/scripts/lib/wire")]
import damage  # noqa: E402
import rtcm3_bytes  # noqa: E402
import ubx_bytes  # noqa: E402

try:
    from pyrtcm import RTCMReader
except ImportError:
    print("SKIPPED (optional): no pyrtcm for this Python (LEONAV_PYTHON names another)")
    sys.exit(77)

C = 299792458.0
SYSTEMS = {"1077": "G", "1097": "E", "1127": "C"}
SEMICIRCLE = rtcm3_bytes.SEMICIRCLE


def fail(text):
    sys.exit(f"FAILED: {text}")


def messages(data):
    return [message for _, message in RTCMReader(io.BytesIO(data), quitonerror=2)]


def check_measurements(path):
    receiver, cells = rtcm3_bytes.Receiver(), 0
    worst = {"code, m": 0.0, "carrier, m": 0.0, "Doppler, m/s": 0.0, "C/N0, dB": 0.0}
    cycles = {}
    for time, satellites in itertools.islice(ubx_bytes.epochs(path), 20):
        for message in messages(receiver.epoch(time, satellites)):
            system = SYSTEMS[message.identity]
            field = lambda name, index: getattr(message, f"{name}_{index:02d}")
            rough = {field("PRN", i)[-2:]: (field("DF397", i) + field("DF398", i), field("DF399", i)) for i in range(1, message.NSat + 1)}
            for i in range(1, message.NCell + 1):
                number, signal = field("CELLPRN", i)[-2:], field("CELLSIG", i)
                code, carrier, doppler, cn0 = (satellites[system + number].get(kind + signal) for kind in "CLDS")
                rough_ms, rough_rate = rough[number]
                wavelength = receiver.wavelength(system, signal)
                errors = {"code, m": (rough_ms + field("DF405", i)) * C / 1e3 - code[0]}
                if carrier and field("DF407", i) > 0:  # a new arc may begin at another cycle
                    off = (rough_ms + field("DF406", i)) * C / 1e3 / wavelength - carrier[0]
                    last = cycles.get((system, number, signal), off)
                    errors["carrier, m"] = (off - last) * wavelength
                    cycles[system, number, signal] = last
                elif carrier:
                    cycles[system, number, signal] = (rough_ms + field("DF406", i)) * C / 1e3 / wavelength - carrier[0]
                if doppler:
                    errors["Doppler, m/s"] = -(rough_rate + field("DF404", i)) - doppler[0] * wavelength
                if cn0:
                    errors["C/N0, dB"] = field("DF408", i) - cn0[0]
                worst.update({name: max(worst[name], abs(error)) for name, error in errors.items()})
                cells += 1
    print(f"{cells} cells; largest differences: " + ", ".join(f"{name} {value:.2g}" for name, value in worst.items()))
    step = C / 1e3
    limits = {"code, m": step * 2 ** -29, "carrier, m": 2 * step * 2 ** -31, "Doppler, m/s": 1e-4, "C/N0, dB": 1 / 16}
    if cells < 1000 or any(worst[name] > limit for name, limit in limits.items()):
        fail(f"cells are not what the file says: {worst}, allowed {limits}")


# (field, place among the 28 numbers, step, its unit) of what every message has.
ELEMENTS = {
    "1019": {"DF079": (16, 2 ** -43, SEMICIRCLE), "DF086": (1, 2 ** -5, 1), "DF087": (2, 2 ** -43, SEMICIRCLE), "DF088": (3, 2 ** -31, SEMICIRCLE),
             "DF089": (4, 2 ** -29, 1), "DF090": (5, 2 ** -33, 1), "DF091": (6, 2 ** -29, 1), "DF092": (7, 2 ** -19, 1), "DF093": (8, 16, 1),
             "DF094": (9, 2 ** -29, 1), "DF095": (10, 2 ** -31, SEMICIRCLE), "DF096": (11, 2 ** -29, 1), "DF097": (12, 2 ** -31, SEMICIRCLE),
             "DF098": (13, 2 ** -5, 1), "DF099": (14, 2 ** -31, SEMICIRCLE), "DF100": (15, 2 ** -43, SEMICIRCLE), "DF101": (22, 2 ** -31, 1)},
    "1042": {"DF491": (16, 2 ** -43, SEMICIRCLE), "DF498": (1, 2 ** -6, 1), "DF499": (2, 2 ** -43, SEMICIRCLE), "DF500": (3, 2 ** -31, SEMICIRCLE),
             "DF501": (4, 2 ** -31, 1), "DF502": (5, 2 ** -33, 1), "DF503": (6, 2 ** -31, 1), "DF504": (7, 2 ** -19, 1), "DF505": (8, 8, 1),
             "DF506": (9, 2 ** -31, 1), "DF507": (10, 2 ** -31, SEMICIRCLE), "DF508": (11, 2 ** -31, 1), "DF509": (12, 2 ** -31, SEMICIRCLE),
             "DF510": (13, 2 ** -6, 1), "DF511": (14, 2 ** -31, SEMICIRCLE), "DF512": (15, 2 ** -43, SEMICIRCLE)},
    "1046": {"DF292": (16, 2 ** -43, SEMICIRCLE), "DF297": (1, 2 ** -5, 1), "DF298": (2, 2 ** -43, SEMICIRCLE), "DF299": (3, 2 ** -31, SEMICIRCLE),
             "DF300": (4, 2 ** -29, 1), "DF301": (5, 2 ** -33, 1), "DF302": (6, 2 ** -29, 1), "DF303": (7, 2 ** -19, 1), "DF304": (8, 60, 1),
             "DF305": (9, 2 ** -29, 1), "DF306": (10, 2 ** -31, SEMICIRCLE), "DF307": (11, 2 ** -29, 1), "DF308": (12, 2 ** -31, SEMICIRCLE),
             "DF309": (13, 2 ** -5, 1), "DF310": (14, 2 ** -31, SEMICIRCLE), "DF311": (15, 2 ** -43, SEMICIRCLE), "DF312": (22, 2 ** -32, 1)},
}
CLOCKS = {"1019": ("DF084", 2 ** -31), "1042": ("DF496", 2 ** -33), "1046": ("DF296", 2 ** -34)}


def check_ephemerides(path):
    found = {}
    for satellite, toc, clock, orbit in rtcm3_bytes.records(path):
        for message in messages(rtcm3_bytes.ephemeris(satellite, toc, clock, orbit)):
            if message.identity not in ELEMENTS:
                continue
            found[message.identity] = found.get(message.identity, 0) + 1
            name, step = CLOCKS[message.identity]
            values = [(name, getattr(message, name), clock[0], step)]
            values += [(name, getattr(message, name) * unit, orbit[place], step * unit) for name, (place, step, unit) in ELEMENTS[message.identity].items()]
            for name, got, wanted, step in values:
                # An angle comes back within one turn.
                if min(abs(got - wanted), abs(abs(got - wanted) - 2 * SEMICIRCLE)) > 0.501 * step:
                    fail(f"{satellite} {message.identity} {name}: {got}, the file has {wanted}")
    print("ephemerides: " + ", ".join(f"{count} of {name}" for name, count in sorted(found.items())))
    if set(found) != set(ELEMENTS):
        fail(f"of {set(ELEMENTS) - set(found)} there is none")


def check_serial_line():
    data = random.Random(1).randbytes(2000)
    for rate in (440000, 460800, 480000):  # a receiver of bytes allows for some percent
        if damage.misread(rate, 460800)(data) != data:
            fail(f"a line at {rate} is not read at 460800")
    for sent, read in ((38400, 460800), (921600, 115200)):
        if any(piece in damage.misread(sent, read)(data) for piece in (data[i:i + 4] for i in range(0, 1996))):
            fail(f"four bytes sent at {sent} are read at {read}")


def main():
    station = pathlib.Path(sys.argv[1])
    check_measurements(next(station.glob("*.obs")))
    check_ephemerides(next(station.glob("*.nav")))
    check_serial_line()


if __name__ == "__main__":
    main()
