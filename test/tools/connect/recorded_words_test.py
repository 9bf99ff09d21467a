#!/usr/bin/env python3
"""recorded_words_test.py: the encoders of navigation bits against bits that satellites have sent.

The recording of the walk holds the words of the satellites as the receiver gave them, and a RINEX file that RTKLIB's convbin
made of them. What ubx_bytes and inav_bytes make of that file must be those words, bit for bit, but for what RINEX does not
have. Exit 77: the recording is neither in $LEONAV_DATA nor in ../shared/data.
"""
import os
import pathlib
import struct
import sys

import inav_bytes
import ubx_bytes
from crc24q import crc24q_of_bits

# Of the 240 data bits of a GPS subframe, those that RINEX does not have: TLM and HOW, which change; the codes on L2 and the
# reserved words of subframe 1; fit interval and AODO of subframe 2.
NOT_IN_RINEX = {1: [(0, 48), (58, 60), (72, 160)], 2: [(0, 48), (232, 240)], 3: [(0, 48)]}


def fail(text):
    sys.exit(f"FAILED: {text}")


def recorded(path):
    """(GNSS, satellite, signal, words) of each UBX-RXM-SFRBX whose checksum is right."""
    data, at = path.read_bytes(), 0
    while (at := data.find(b"\xb5\x62\x02\x13", at)) >= 0:
        gnss, satellite, signal, _, count = data[at + 6:at + 11]
        end = at + 14 + 4 * count
        if ubx_bytes.frame(2, 0x13, data[at + 6:end])[-2:] == data[end:end + 2]:
            yield gnss, satellite, signal, struct.unpack_from(f"<{count}I", data, at + 14)
        at += 4


def differing(a, b, left_out):
    return [i for i, (x, y) in enumerate(zip(a, b)) if x != y and not any(first <= i < end for first, end in left_out)]


def check_galileo(messages, records):
    made = {}
    for satellite, toc, clock, orbit in records:
        for kind in (1, 2, 3, 4):
            word = inav_bytes.words(satellite, toc, clock, orbit, toc)[kind]
            made[satellite, word[:16]] = word  # by type and issue
    same = pages = 0
    for gnss, satellite, signal, values in messages:
        if (gnss, signal, len(values)) != (2, 1, 8):
            continue
        text = "".join(format(value, "032b") for value in values)
        word = text[2:114] + text[130:146]
        if crc24q_of_bits(text[:114] + text[128:210]) != int(text[210:234], 2):
            fail(f"the CRC of a page of E{satellite:02d} is not as it is computed here")
        pages += 1
        wanted = made.get((satellite, word[:16]))
        if wanted is None:
            continue
        if differing(word, wanted, [(126, 128)] if int(word[:6], 2) != 3 else []):  # spare bits at the end
            fail(f"word {int(word[:6], 2)} of E{satellite:02d} was sent as\n{word}, and is made as\n{wanted}")
        same += 1
    print(f"Galileo: {pages} CRCs of pages as they were sent; {same} words 1 to 4 as they were sent")
    return same


def data_bits(words):
    """The 240 data bits of a GPS subframe; the receiver has turned the inverted ones back."""
    return "".join(format(word >> 6 & 0xFFFFFF, "024b") for word in words)


def check_gps(messages, records):
    made = {}
    for satellite, toc, clock, orbit in records:
        for number, (_, words) in enumerate(ubx_bytes.subframes(toc, clock, orbit, toc), 1):
            text = data_bits(words)
            issue = {1: text[168:176], 2: text[48:56], 3: text[216:224]}[number]
            made[satellite, number, issue] = text
    same = parities = 0
    for gnss, satellite, signal, words in messages:
        if (gnss, signal, len(words)) != (0, 0, 10):
            continue
        text = data_bits(words)
        # Words two and ten end in two bits that their parity determines.
        solved = [text[i:i + (22 if i in (24, 216) else 24)] for i in range(0, 240, 24)]
        if tuple(ubx_bytes.with_parity(solved)) != words:
            fail(f"the parity of a subframe of G{satellite:02d} is not as it is computed here")
        parities += 1
        number = int(text[43:46], 2)
        issue = {1: text[168:176], 2: text[48:56], 3: text[216:224]}.get(number)
        wanted = made.get((satellite, number, issue))
        if wanted is None:
            continue
        if wrong := differing(text, wanted, NOT_IN_RINEX[number]):
            fail(f"subframe {number} of G{satellite:02d} was sent otherwise than it is made, at bits {wrong}")
        same += 1
    print(f"GPS: {parities} subframes with the parity that they were sent with; {same} subframes 1 to 3 as they were sent")
    return same


def main():
    walk = pathlib.Path(os.environ.get("LEONAV_DATA", pathlib.Path(__file__).resolve().parents[4] / "shared/data")) / "walk"
    if not (walk / "gnss.ubx").exists():
        print(f"SKIPPED: recorded data {walk / 'gnss.ubx'} is not on this machine")
        sys.exit(77)
    messages = list(recorded(walk / "gnss.ubx"))
    if check_galileo(messages, inav_bytes.records(walk / "gnss.nav")) < 20:
        fail("too few words to compare")
    if check_gps(messages, ubx_bytes.records(walk / "gnss.nav")) < 20:
        fail("too few subframes to compare")


if __name__ == "__main__":
    main()
