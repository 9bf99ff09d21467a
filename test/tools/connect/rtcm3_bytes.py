"""Encodes RINEX files as RTCM 3: MSM7 of GPS, Galileo and BeiDou, and the ephemerides 1019, 1042, 1045 and 1046.

Written from the standard alone, so that it is independent of leonav's decoder: RTCM 10403.3 (3.5.16 MSM with tables 3.5-78
to 3.5-108, 3.5.11 ephemerides, DF407 in table 3.5-76). Numbers are rounded as those messages round them.

  rtcm3_bytes.py RUN.obs RUN.nav OUT.rtcm3
"""
import sys

from ubx_bytes import bits, epochs  # finds those of test/support/python
from crc24q import crc24q
from galileo_accuracy import sisa_index
from navigation_file import records

C = 299792458.0
MSM7 = {"G": 1077, "E": 1097, "C": 1127}
# The bits of the signal mask, and the carriers' frequencies in MHz by system and band.
MASK = {"G": {"1C": 2, "1W": 4, "2W": 10, "2S": 15, "2L": 16, "5I": 22, "5Q": 23},
        "E": {"1C": 2, "1B": 4, "6C": 8, "6B": 10, "7I": 14, "7Q": 15, "5I": 22, "5Q": 23},
        "C": {"2I": 2, "6I": 8, "7I": 14, "5D": 22, "5P": 23, "1D": 30, "1P": 31}}
FREQUENCY = {"G1": 1575.42, "G2": 1227.60, "G5": 1176.45, "E1": 1575.42, "E5": 1176.45, "E6": 1278.75, "E7": 1207.14,
             "C1": 1575.42, "C2": 1561.098, "C5": 1176.45, "C6": 1268.52, "C7": 1207.14}
SEMICIRCLE = 3.141592653589793
ACCURACY = [2.4, 3.4, 4.85, 6.85, 9.65, 13.65, 24, 48, 96, 192, 384, 768, 1536, 3072, 6144]


def frame(text):
    """A message from its bits."""
    text += "0" * (-len(text) % 8)
    body = int(text, 2).to_bytes(len(text) // 8, "big")
    if len(body) > 1023:
        raise OverflowError(f"a message of {len(body)} bytes")
    body = b"\xd3" + len(body).to_bytes(2, "big") + body
    return body + crc24q(body).to_bytes(3, "big")


# --- observations ---

def lock_indicator(milliseconds):
    """DF407: steps of 1 ms up to 64 ms, then of 2, 4, 8, ... ms, 32 of each."""
    if milliseconds < 64:
        return milliseconds
    power = milliseconds.bit_length() - 6
    return min((milliseconds >> power) + 32 * power, 704)


class Receiver:
    """Keeps since when carriers are locked, and which cycles were taken off their phase ranges."""

    def __init__(self, station=1):
        self.station, self.locks = station, {}

    def restart(self):
        self.locks.clear()

    def epoch(self, time, satellites):
        """The messages of one epoch of (seconds since the GPS epoch, fraction) and what `epochs` gives of satellites."""
        now = time[0] + time[1]
        systems = [system for system in MSM7 if any(name[0] == system for name in satellites)]
        parts = [self.split(system, satellites) for system in systems]
        parts = [(system, part) for system, of in zip(systems, parts) for part in of]
        return b"".join(self.msm7(system, now, part, more=index + 1 < len(parts)) for index, (system, part) in enumerate(parts))

    def split(self, system, satellites):
        """Parts with at most 64 cells each, by what the satellites of one system measure."""
        mine = {int(name[1:]): {signal: values for signal in MASK[system] if (values := self.measured(of, signal))}
                for name, of in sorted(satellites.items()) if name[0] == system}
        mine = {number: signals for number, signals in mine.items() if signals}
        widest = max((len({signal for signals in mine.values() for signal in signals}), 1))
        step = max(64 // widest, 1)
        numbers = sorted(mine)
        return [{number: mine[number] for number in numbers[i:i + step]} for i in range(0, len(numbers), step)]

    @staticmethod
    def measured(values, signal):
        found = [values.get(kind + signal) for kind in "CLDS"]
        return found if found[0] else None

    def msm7(self, system, now, part, more):
        signals = sorted({signal for of in part.values() for signal in of}, key=lambda signal: MASK[system][signal])
        tow_ms = round(now * 1e3) % 604800000
        if system == "C":
            tow_ms = (tow_ms - 14000) % 604800000
        out = bits(MSM7[system], 12) + bits(self.station, 12) + bits(tow_ms, 30) + bits(more, 1) + "0" * 18
        out += "".join("1" if number in part else "0" for number in range(1, 65))
        out += "".join("1" if bit in {MASK[system][signal] for signal in signals} else "0" for bit in range(1, 33))
        out += "".join("1" if signal in of else "0" for of in part.values() for signal in signals)
        cells, rough = [], []
        for number, of in part.items():
            first = next(iter(of))
            steps = round(of[first][0][0] / C * 1e3 * 1024)  # DF397 and DF398
            rates = [-values[2][0] * self.wavelength(system, signal) for signal, values in of.items() if values[2]]
            rough.append((steps, round(rates[0]) if rates else -8192))
            cells += [self.cell(system, now, number, signal, of[signal], *rough[-1]) for signal in signals if signal in of]
        out += "".join(bits(steps // 1024, 8) for steps, _ in rough) + "0000" * len(rough)
        out += "".join(bits(steps % 1024, 10) for steps, _ in rough) + "".join(bits(rate, 14) for _, rate in rough)
        return frame(out + "".join("".join(field) for field in zip(*cells)))

    @staticmethod
    def wavelength(system, signal):
        return C / (FREQUENCY[system + signal[0]] * 1e6)

    def cell(self, system, now, number, signal, values, steps, rough_rate):
        code, carrier, doppler, cn0 = values
        key, wavelength = (system, number, signal), self.wavelength(system, signal)
        rough_ms = steps / 1024
        flags = carrier[1].strip() if carrier else ""
        phase, lock, half = -(1 << 23), 0, "0"
        if carrier:
            if flags and flags in "1357":
                self.locks.pop(key, None)
            # A phase range is given near the code's: whole cycles are taken off when an arc begins.
            since, cycles = self.locks.setdefault(key, (now, round(carrier[0] - code[0] / wavelength)))
            phase = round(((carrier[0] - cycles) * wavelength / C * 1e3 - rough_ms) * 2 ** 31)
            lock, half = lock_indicator(round((now - since) * 1e3)), "1" if flags and flags in "2367" else "0"
            if abs(phase) >= 1 << 23:
                self.locks.pop(key)
                phase = -(1 << 23)
        else:
            self.locks.pop(key, None)
        rate = round((-doppler[0] * wavelength - rough_rate) * 1e4) if doppler and rough_rate != -8192 else -(1 << 14)
        return (bits(round((code[0] / C * 1e3 - rough_ms) * 2 ** 29), 20), bits(phase, 24), bits(lock, 10), half,
                bits(round(cn0[0] * 16) if cn0 else 0, 10), bits(rate, 15))


# --- ephemerides ---

def orbit_bits(orbit, small, crs, toe_bits, toe_unit):
    """From Crs to the rate of the node: `small` is (bits, power) of the angles' corrections, `crs` of the radius'."""
    (_, c_rs, delta_n, m0, cuc, ecc, cus, sqrt_a, toe, cic, omega0, cis, i0, crc, omega, omega_dot) = orbit[:16]
    return (bits(c_rs, *crs) + bits(delta_n, 16, -43, SEMICIRCLE) + bits(m0, 32, -31, SEMICIRCLE) + bits(cuc, *small) + bits(ecc, 32, -33) +
            bits(cus, *small) + bits(sqrt_a, 32, -19) + bits(toe / toe_unit, toe_bits) + bits(cic, *small) + bits(omega0, 32, -31, SEMICIRCLE) +
            bits(cis, *small) + bits(i0, 32, -31, SEMICIRCLE) + bits(crc, *crs) + bits(omega, 32, -31, SEMICIRCLE) +
            bits(omega_dot, 24, -43, SEMICIRCLE))


def accuracy_index(metres):
    return next((index for index, limit in enumerate(ACCURACY) if metres <= limit), 15)


def ephemeris(satellite, toc, clock, orbit):
    system, number = satellite[0], bits(int(satellite[1:]), 6)
    i_dot, source, week = orbit[16], int(orbit[17]), int(orbit[18])
    slope = bits(i_dot, 14, -43, SEMICIRCLE)
    if system == "G":
        accuracy, health, tgd, iodc = orbit[20:24]
        return frame(bits(1019, 12) + number + bits(week % 1024, 10) + bits(accuracy_index(accuracy), 4) + "01" + slope + bits(orbit[0], 8) +
                     bits(toc % 604800 // 16, 16) + bits(clock[2], 8, -55) + bits(clock[1], 16, -43) + bits(clock[0], 22, -31) +
                     bits(iodc, 10) + orbit_bits(orbit, (16, -29), (16, -5), 16, 16) + bits(tgd, 8, -31) + bits(health, 6) + "00")
    if system == "C":
        accuracy, health, tgd1, tgd2, _, aodc = orbit[20:26]
        return frame(bits(1042, 12) + number + bits(week, 13) + bits(accuracy_index(accuracy), 4) + slope + bits(orbit[0], 5) +
                     bits(toc % 604800 // 8, 17) + bits(clock[2], 11, -66) + bits(clock[1], 22, -50) + bits(clock[0], 24, -33) +
                     bits(aodc, 5) + orbit_bits(orbit, (18, -31), (18, -6), 17, 8) + bits(tgd1 * 1e10, 10) + bits(tgd2 * 1e10, 10) + bits(health, 1))
    accuracy, health, bgd_e5a, bgd_e5b = orbit[20], int(orbit[21]), orbit[22], orbit[23]
    is_inav = source & 0b101 != 0
    head = (bits(1046 if is_inav else 1045, 12) + number + bits((week - 1024) % 4096, 12) + bits(orbit[0], 10) + bits(sisa_index(accuracy), 8) + slope +
            bits(toc % 604800 // 60, 14) + bits(clock[2], 6, -59) + bits(clock[1], 21, -46) + bits(clock[0], 31, -34) +
            orbit_bits(orbit, (16, -29), (16, -5), 14, 60) + bits(bgd_e5a, 10, -32))
    if is_inav:
        return frame(head + bits(bgd_e5b, 10, -32) + bits(health >> 7, 2) + bits(health >> 6, 1) + bits(health >> 1, 2) + bits(health, 1) + "00")
    return frame(head + bits(health >> 4, 2) + bits(health >> 3, 1) + "0" * 7)


GEOSTATIONARY = {f"C{number:02d}" for number in (*range(1, 6), *range(59, 64))}


def at_whole_unit(toc, clock, orbit, unit):
    """The same orbit and clock by a reference time that is a multiple of `unit`, s: BeiDou's messages have no other one."""
    step = -(orbit[8] % unit)
    n = (3.986004418e14 / orbit[7] ** 6) ** 0.5 + orbit[2]
    moved = list(orbit)
    moved[8] += step
    moved[3] = (orbit[3] + n * step + SEMICIRCLE) % (2 * SEMICIRCLE) - SEMICIRCLE
    moved[10] += orbit[15] * step
    moved[12] += orbit[16] * step
    return toc + round(step), [clock[0] + clock[1] * step + clock[2] * step ** 2, clock[1] + 2 * clock[2] * step, clock[2]], moved


def ephemerides(path, now):
    """{satellite: message} of the newest record of each that has been sent by `now`, s since the GPS epoch.

    Of BeiDou's geostationary satellites those are left out whose reference time no message can hold: their model turns with it.
    """
    newest = {}
    for satellite, toc, clock, orbit in records(path):
        sent = toc + (orbit[24] - toc + 302400) % 604800 - 302400  # a time of the week, near the clock's
        if satellite[0] == "C" and orbit[8] % 8:
            if satellite in GEOSTATIONARY:
                continue
            toc, clock, orbit = at_whole_unit(toc, clock, orbit, 8)
        is_inav = int(orbit[17]) & 0b101 != 0  # Galileo sends two with one time
        if sent <= now and abs(now - toc) <= 7200 and (satellite not in newest or (toc, is_inav) > newest[satellite][0]):
            newest[satellite] = (toc, is_inav), toc, clock, orbit
    return {satellite: ephemeris(satellite, *rest) for satellite, (_, *rest) in sorted(newest.items())}


def main():
    observations, navigation, out = sys.argv[1:4]
    receiver, sent = Receiver(), False
    with open(out, "wb") as file:
        for time, satellites in epochs(observations):
            file.write(receiver.epoch(time, satellites))
            if not sent:
                file.write(b"".join(ephemerides(navigation, time[0]).values()))
            sent = True


if __name__ == "__main__":
    main()
