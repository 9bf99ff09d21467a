"""Encodes RINEX files as the bytes of a u-blox receiver: UBX-RXM-RAWX and UBX-RXM-SFRBX.

Written from the interface documents alone, so that it is independent of leonav's decoder: u-blox ZED-F9P interface
description UBX-22008968 (3.2 frame, 3.17.5 RXM-RAWX, 3.17.9 RXM-SFRBX) and IS-GPS-200 (20.3.3 subframes 1 to 3,
20.3.5 parity). Numbers are rounded as those messages round them.

  ubx_bytes.py RUN.obs RUN.nav OUT.ubx
"""
import datetime
import pathlib
import struct
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "support/python"))
import navigation_file  # noqa: E402
from navigation_file import GPS_EPOCH  # noqa: E402

# Such a receiver tracks L2 CL where the simulator has P(Y): 2W goes out as 2L.
GNSS_IDS = {"G": 0, "E": 2, "C": 3}
SIGNAL_IDS = {"G": {"1C": 0, "2W": 3, "2L": 3, "2S": 4, "5I": 6, "5Q": 7},
              "E": {"1C": 0, "1B": 1, "5I": 3, "5Q": 4, "7I": 5, "7Q": 6, "6B": 8, "6C": 9},
              "C": {"2I": 0, "7I": 2, "6I": 4, "1P": 5, "1D": 6, "5P": 7, "5D": 8}}
# IS-GPS-200 table 20-XIV: the data bits d1..d24 that enter each parity bit, and which of the last two bits before does.
PARITY = [((1, 2, 3, 5, 6, 10, 11, 12, 13, 14, 17, 18, 20, 23), 29), ((2, 3, 4, 6, 7, 11, 12, 13, 14, 15, 18, 19, 21, 24), 30),
          ((1, 3, 4, 5, 7, 8, 12, 13, 14, 15, 16, 19, 20, 22), 29), ((2, 4, 5, 6, 8, 9, 13, 14, 15, 16, 17, 20, 21, 23), 30),
          ((1, 3, 5, 6, 7, 9, 10, 14, 15, 16, 17, 18, 21, 22, 24), 30), ((3, 5, 6, 8, 9, 10, 11, 13, 15, 19, 22, 23, 24), 29)]


def frame(message_class, message_id, payload):
    body = struct.pack("<BBH", message_class, message_id, len(payload)) + payload
    a = b = 0
    for byte in body:
        a = (a + byte) & 0xFF
        b = (b + a) & 0xFF
    return b"\xb5\x62" + body + bytes((a, b))


# --- observations ---

def epochs(path):
    """(seconds since the GPS epoch as (whole, fraction), {satellite: {observation code: (value, loss of lock digit)}})"""
    types, current = {}, None
    with open(path, encoding="ascii") as file:
        for line in file:
            label = line[60:].strip()
            if label == "SYS / # / OBS TYPES":
                system = line[0] if line[0] != " " else system
                types.setdefault(system, []).extend(line[7:60].split())
            elif label == "END OF HEADER":
                break
        for line in file:
            if line[0] == ">":
                if current:
                    yield current
                year, month, day, hour, minute = (int(part) for part in line[2:18].split())
                start = datetime.datetime(year, month, day, hour, minute)
                seconds = float(line[18:29])
                whole = (start - GPS_EPOCH).days * 86400 + (start - GPS_EPOCH).seconds + int(seconds)
                current = (whole, seconds - int(seconds)), {}
                continue
            values = {}
            for index, code in enumerate(types.get(line[0], [])):
                field = line[3 + 16 * index:19 + 16 * index]
                if field[:14].strip():
                    values[code] = float(field[:14]), field[14:15]
            current[1][line[:3]] = values
    if current:
        yield current


def rawx(time, satellites, locks, leap_seconds=18):
    """`locks`: since when (s) each signal's carrier is locked; kept from epoch to epoch."""
    whole, fraction = time
    week, tow = divmod(whole, 604800)
    blocks = []
    for name, values in sorted(satellites.items()):
        for signal, signal_id in SIGNAL_IDS.get(name[0], {}).items():
            code, carrier, doppler, cn0 = (values.get(kind + signal) for kind in "CLDS")
            if not (code or carrier):
                continue
            now = whole + fraction
            lli = carrier[1] if carrier else " "
            if not carrier or lli in "1357" and lli.strip():
                locks.pop((name, signal), None)
            since = locks.setdefault((name, signal), now) if carrier else now
            status = (1 if code else 0) | (2 if carrier else 0) | (0 if lli in "23" and lli.strip() else 4)
            blocks.append(struct.pack("<ddfBBBBHBBBBBx", code[0] if code else 0.0, carrier[0] if carrier else 0.0,
                                      doppler[0] if doppler else 0.0, GNSS_IDS[name[0]], int(name[1:]), signal_id, 0,
                                      min(round((now - since) * 1e3), 64500), round(cn0[0]) if cn0 else 0, 5, 3, 8, status))
    header = struct.pack("<dHbBBBxx", tow + fraction, week, leap_seconds, len(blocks), 1, 1)
    return frame(0x02, 0x15, header + b"".join(blocks))


# --- broadcast messages of GPS ---

def records(path):
    """The GPS records of a RINEX 3 navigation file: (satellite number, time of clock, clock terms, 28 numbers)."""
    for satellite, toc, clock, orbit in navigation_file.records(path):
        if satellite[0] == "G":
            yield int(satellite[1:]), toc, clock, orbit


def bits(value, count, power=0, unit=1.0):
    """A number in two's complement, `count` bits, in steps of 2^power units."""
    steps = round(value / unit * 2.0 ** -power)
    return format(steps & ((1 << count) - 1), f"0{count}b")


def subframes(toc, clock, orbit, sent):
    """The data of subframes 1 to 3, 8 words of 24 bits each behind the two of TLM and HOW, as bit strings."""
    semicircle = 3.141592653589793
    (iode, crs, delta_n, m0, cuc, ecc, cus, sqrt_a, toe, cic, omega0, cis, i0, crc, omega, omega_dot, i_dot, _, _, _,
     accuracy, health, tgd, iodc) = orbit[:24]
    limits = [2.4, 3.4, 4.85, 6.85, 9.65, 13.65, 24, 48, 96, 192, 384, 768, 1536, 3072, 6144]
    ura = next((index for index, limit in enumerate(limits) if accuracy <= limit), 15)
    iodc, iode = int(iodc), int(iode)
    first = (bits(sent // 604800 % 1024, 10) + "01" + bits(ura, 4) + bits(int(health), 6) + bits(iodc >> 8, 2) + "0" * 24 * 3 + "0" * 16 +
             bits(tgd, 8, -31) + bits(iodc & 255, 8) + bits(toc % 604800, 16, 4) + bits(clock[2], 8, -55) + bits(clock[1], 16, -43) +
             bits(clock[0], 22, -31))
    second = (bits(iode, 8) + bits(crs, 16, -5) + bits(delta_n, 16, -43, semicircle) + bits(m0, 32, -31, semicircle) + bits(cuc, 16, -29) +
              bits(ecc, 32, -33) + bits(cus, 16, -29) + bits(sqrt_a, 32, -19) + bits(toe, 16, 4) + "0" * 6)
    third = (bits(cic, 16, -29) + bits(omega0, 32, -31, semicircle) + bits(cis, 16, -29) + bits(i0, 32, -31, semicircle) + bits(crc, 16, -5) +
             bits(omega, 32, -31, semicircle) + bits(omega_dot, 24, -43, semicircle) + bits(iode, 8) + bits(i_dot, 14, -43, semicircle))
    for index, data in enumerate((first, second, third), 1):
        start = sent + 6 * (index - 1)
        how = bits((start % 604800) // 6 + 1, 17) + "00" + bits(index, 3)
        yield start, with_parity(["10001011" + "0" * 16, how] + [data[i:i + 24] for i in range(0, 24 * 8, 24)])


# Klobuchar's coefficients as GPS has sent them: alpha in steps of 2^-30, -27, -24, -24, beta of 2^11, 14, 16, 16.
ALPHA, BETA = (12, 2, -1, -1), (44, 2, -2, -4)


def ionosphere_page(sent):
    """Subframe 4, page 18 (data identifier 01, page 56), which begins at `sent`."""
    data = "01" + bits(56, 6) + "".join(bits(value, 8) for value in ALPHA + BETA)
    data = data.ljust(190, "0")
    how = bits((sent % 604800) // 6 + 1, 17) + "00" + bits(4, 3)
    return with_parity(["10001011" + "0" * 16, how] + [data[i:i + 24] for i in range(0, 24 * 8, 24)])


def with_parity(words):
    """Ten words of 30 bits in 32, as the receiver gives them, below the last two bits of the word before. A word that follows
    a last bit 1 has its data inverted on air: the receiver turns all 32 bits back. Words two and ten end in two bits that make
    their own parity end in zeros; they are searched for here."""
    out, d29, d30 = [], 0, 0
    for index, word in enumerate(words):
        for tail in ("",) if index not in (1, 9) else ("00", "01", "10", "11"):
            data = [int(bit) for bit in (word + tail).ljust(24, "0")]
            parity = [(sum(data[bit - 1] for bit in places) + (d29 if last == 29 else d30)) & 1 for places, last in PARITY]
            if tail == "" or parity[4:] == [0, 0]:
                break
        value = d29 << 31 | d30 << 30
        for place, bit in enumerate(data + parity):
            value |= bit << (29 - place)
        out.append(value ^ (0xC000003F if d30 else 0))
        d29, d30 = parity[4], parity[5]
    return out


def sfrbx(satellite, words):
    header = struct.pack("<BBBBBBBx", 0, satellite, 0, 0, len(words), 0, 2)
    return frame(0x02, 0x13, header + struct.pack(f"<{len(words)}I", *words))


def newest_records(path, start):
    """{satellite number: (time of clock, clock terms, 28 numbers)} of the newest record of each GPS satellite that is sent at `start`."""
    newest = {}
    for satellite, toc, clock, orbit in records(path):
        if toc <= start + 7200 and (satellite not in newest or toc > newest[satellite][0]):
            newest[satellite] = toc, clock, orbit
    return newest


def received_subframes(path, start):
    """(time of reception, satellite number, ten words) of the ionosphere's page and of three subframes of each satellite."""
    newest = newest_records(path, start)
    first = start - start % 6 + 24
    yield first + 6, min(newest), ionosphere_page(first)
    for satellite, (toc, clock, orbit) in newest.items():
        for sent, words in subframes(toc, clock, orbit, start - start % 6 + 6):
            yield sent + 6, satellite, words


def broadcasts(path, start):
    """(time of reception, message) of each."""
    for received, satellite, words in received_subframes(path, start):
        yield received, sfrbx(satellite, words)


def main():
    observations, navigation, out = sys.argv[1:4]
    locks, waiting = {}, None
    with open(out, "wb") as file:
        for time, satellites in epochs(observations):
            if waiting is None:
                waiting = sorted(broadcasts(navigation, time[0]))
            file.write(rawx(time, satellites, locks))
            while waiting and waiting[0][0] <= time[0]:
                file.write(waiting.pop(0)[1])


if __name__ == "__main__":
    main()
