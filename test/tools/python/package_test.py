#!/usr/bin/python3
"""package_test.py BIN_DIR [unittest's arguments]: the Python package of tools/python against what leonav's programs write.

A drive is played over LCM to leonavd in a network namespace of its own; its journal, as the package reads it, must agree with the
tables that leonav-replay writes of it, and live messages with the journal. Messages of every type are compared with the types
that lcm-gen writes for Python. Damaged logs must give what is good and a warning, or an error that names the byte.
"""
import io
import os
import pathlib
import pickle
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import warnings

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path[:0] = [str(ROOT / "tools" / "python"), str(HERE.parent), str(ROOT / "tools" / "scripts" / "lib")]
try:
    import numpy as np
    import pandas as pd
except ImportError as missing:
    print(f"SKIPPED: {missing} for {sys.executable} (Debian packages python3-numpy, python3-pandas)")
    sys.exit(0)
import lcm_log  # noqa: E402
from generated_types import generated_types  # noqa: E402
import leonav  # noqa: E402
from leonav import event_log, gps_time, lcm_types, names, pieces  # noqa: E402
from leonav.live import Assembler  # noqa: E402

BIN = None
WORK = pathlib.Path(tempfile.mkdtemp())
# Leaves what it got when it is told to end.
RECEIVE = """import pickle, signal, sys
sys.path.insert(0, sys.argv[1])
import leonav
signal.signal(signal.SIGTERM, lambda *_: sys.exit())
got, messages = [], leonav.subscribe(timeout_s=100)
open(sys.argv[2] + ".listens", "w").close()
try:
    for one in messages:
        got.append((one.channel, one.type, int(one.fields["sequence"]), int(one.fields["time_ns"])))
finally:
    pickle.dump(got, open(sys.argv[2], "wb"))
"""
# What a last digit of the tables is worth; other columns have 3 decimals or more.
DIGIT = {"pdop": 0.01, "hdop": 0.01, "vdop": 0.01, "elevation_deg": 0.01, "azimuth_deg": 0.01, "cn0_dbhz": 0.1, "ephemeris_age_s": 0.1}


def filled(types, kind, dice, counts=None):
    """A message of a generated type with random values; counts of arrays are small."""
    message = getattr(types, kind.name)()
    values = {}
    for member in kind.members:
        shape = [size if isinstance(size, int) else values[size] for size in member.dimensions]

        def one(member=member):
            if member.type in lcm_types.TYPES:
                return filled(types, lcm_types.TYPES[member.type], dice)
            if member.type == "string":
                return dice.choice(["", "good", "Größe"])
            if member.type in ("double", "float"):
                return struct.unpack(">f", struct.pack(">f", dice.uniform(-1e6, 1e6)))[0]
            if member.type == "boolean":
                return dice.random() < 0.5
            if member.type == "byte":
                return dice.randrange(256)
            bits = {"int8_t": 8, "int16_t": 16, "int32_t": 32, "int64_t": 64}[member.type]
            return dice.randrange(-2 ** (bits - 1), 2 ** (bits - 1))
        if member.name in ("n", "n_counts", "n_satellites", "n_aiding"):
            value = dice.randrange(4)
        elif len(shape) == 1:
            value = [one() for _ in range(shape[0])]
            if member.type == "byte":
                value = bytes(value)
        else:
            value = one()
        values[member.name] = value
        setattr(message, member.name, value)
    return message


class Types(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if shutil.which("lcm-gen") is None:
            print("SKIPPED: no lcm-gen (package liblcm-bin)")
            raise unittest.SkipTest("no lcm-gen")
        cls.generated = generated_types(ROOT, WORK / "generated")

    def same(self, ours, theirs, where):
        if isinstance(ours, dict) or (isinstance(ours, np.void) and ours.dtype.names):
            for name in ours if isinstance(ours, dict) else ours.dtype.names:
                self.same(ours[name], getattr(theirs, name), f"{where}.{name}")
        elif isinstance(ours, (list, np.ndarray)):
            self.assertEqual(len(ours), len(theirs), where)
            for index, (a, b) in enumerate(zip(ours, theirs)):
                self.same(a, b, f"{where}[{index}]")
        else:
            self.assertEqual(ours, theirs, where)

    def test_every_type_has_the_fingerprint_of_lcm_gen(self):
        self.assertEqual(len(lcm_types.TYPES), len(list((ROOT / "lcmtypes").glob("*.lcm"))))
        for name, kind in lcm_types.TYPES.items():
            self.assertEqual(kind.fingerprint, getattr(self.generated, name)()._get_packed_fingerprint(), name)

    def test_every_field_of_every_type_is_read_as_lcm_gen_writes_it(self):
        dice = random.Random(1)
        for name, kind in lcm_types.TYPES.items():
            for _ in range(20):
                message = filled(self.generated, kind, dice)
                got, members = leonav.decode(message.encode())
                self.assertEqual(got, name)
                self.same(members, message, name)

    def test_every_cut_and_every_flipped_byte_of_a_message_is_an_error_or_a_message(self):
        dice = random.Random(2)
        for name in ("epoch_t", "health_t", "streams_t", "antenna_t", "solution_t", "config_t"):
            data = filled(self.generated, lcm_types.TYPES[name], dice).encode()
            for end in range(len(data)):
                with self.assertRaises(leonav.LeonavError):
                    leonav.decode(data[:end])
            for _ in range(500):
                bad = bytearray(data)
                bad[dice.randrange(len(bad))] ^= 1 << dice.randrange(8)
                try:
                    leonav.decode(bad)
                except leonav.LeonavError as error:
                    self.assertTrue(str(error))

    def test_no_message_breaks_the_picture_of_leonav_top(self):
        sys.path.append(str(ROOT / "tools" / "top"))
        from top.picture import State, picture
        dice, state = random.Random(8), State()
        for channel, name in (("HEALTH", "health_t"), ("SOLUTION", "solution_t"), ("EPOCH", "epoch_t"), ("EVENT", "event_t"),
                              ("STREAMS", "streams_t"), ("CORRECTED_STATES", "corrected_states_t")) * 60:
            data = bytearray(filled(self.generated, lcm_types.TYPES[name], dice).encode())
            for _ in range(3):
                data[dice.randrange(8, len(data))] = dice.choice((0, 0x7F, 0xFF, dice.randrange(256)))
            try:
                state.take(leonav.Message(channel, *leonav.decode(data)), 0.0)
            except leonav.LeonavError:
                continue
            for line in picture(state, 1.0, 80, 40):
                self.assertTrue(line.isprintable() and len(line) <= 80, line)

    def test_a_log_of_random_messages_on_every_channel_gives_tables(self):
        dice = random.Random(3)
        from leonav.tables import CHANNELS
        for _ in range(5):
            path = WORK / "random.lcmlog"
            lcm_log.write(path, [(index, f"LEONAV_{channel}", filled(self.generated, lcm_types.TYPES[kind], dice).encode())
                                 for index, (channel, (kinds, _)) in enumerate(list(CHANNELS.items()) * 3) for kind in kinds])
            log = leonav.read_log(path)
            self.assertTrue(set(CHANNELS) <= set(log))
            for table in log.values():
                self.assertEqual(list(table.columns[:3]), ["gps_week", "gps_tow_s", "utc"])

    def test_messages_that_cannot_be_read_are_counted_and_lose_nothing_else(self):
        dice = random.Random(4)
        good = filled(self.generated, lcm_types.TYPES["solution_t"], dice).encode()
        epoch = filled(self.generated, lcm_types.TYPES["epoch_t"], dice).encode()
        path = WORK / "refused.lcmlog"
        lcm_log.write(path, [(0, "LEONAV_SOLUTION", good), (1, "LEONAV_SOLUTION", good[:-1]), (2, "LEONAV_SOLUTION", b"12345678"),
                             (3, "LEONAV_EPOCH", epoch), (4, "LEONAV_EPOCH", epoch[:-3]), (5, "LEONAV_SOLUTION", epoch),
                             (6, "OTHER", b""), (7, "LEONAV_SOLUTION", good)])
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            log = leonav.read_log(path)
        self.assertEqual((len(log["SOLUTION"]), len(log["EPOCH"])), (2, 1))
        texts = sorted(str(one.message) for one in told)
        self.assertEqual(len(texts), 2)
        second = 28 + len("LEONAV_SOLUTION") + len(good)
        self.assertIn(f"refused.lcmlog: byte {second}: messages of LEONAV_SOLUTION are left out", texts[1])
        self.assertIn("1 solution_t of a wrong length", texts[1])
        self.assertIn("1 epoch_t that ends within", texts[0])


class Enumerations(unittest.TestCase):
    def names_in(self, path, function):
        text = (ROOT / path).read_text()
        body = text[text.index(function):]
        return [line.split('"')[1] for line in body[:body.index("\n}")].splitlines() if line.strip().startswith('return "')]

    def test_names_are_those_of_the_sources(self):
        for ours, path, function in ((names.EVENTS, "core/navigator/interface/event.cc", "to_string(EventKind"),
                                     (names.SOURCES, "core/navigator/interface/solution.cc", "to_string(Source"),
                                     (names.REASONS, "core/gnss/measurement/measurement.cc", "to_string(Reason"),
                                     (names.OBSERVABLES, "core/gnss/measurement/measurement.cc", "to_string(Observable"),
                                     (names.SLIP_CAUSES, "core/gnss/signals/slip_cause.cc", "to_string(SlipCause")):
            theirs = [one for one in self.names_in(path, function) if one not in ("unknown", "")]
            self.assertEqual(list(ours), theirs, path)

    def test_satellites_have_the_names_of_the_programs(self):
        self.assertEqual(list(names.satellite_names([0, 1, 2, 3, 3, 3, 9], [5, 36, 63, 1, 99, 100, 1])),
                         ["G05", "E36", "C63", "L01", "L99", "M00", "unknown"])


class Times(unittest.TestCase):
    def test_utc_steps_at_leap_seconds(self):
        # 2017-01-01 00:00:00 UTC is second 18 of that day in GPS time; 2016-12-31 23:59:59 is second 16.
        day = (np.datetime64("2017-01-01") - np.datetime64("1980-01-06")).astype("timedelta64[ns]").astype(np.int64)
        for seconds, leap, utc in ((16, 17, "2016-12-31T23:59:59"), (17, 17, "2017-01-01T00:00:00"), (18, 18, "2017-01-01T00:00:00")):
            gps = day + seconds * 10**9
            self.assertEqual(gps_time.leap_seconds(gps), leap)
            self.assertEqual(np.datetime64(int(gps_time.unix_ns(gps)), "ns"), np.datetime64(utc))

    def test_leap_days_are_those_of_the_c_code(self):
        text = (ROOT / "core/base/calendar.cc").read_text()
        text = text[text.index("kLeapSeconds{{{"):]
        theirs = [f"{int(y):04}-{int(m):02}-{int(d):02}" for y, m, d in re.findall(r"\{(\d+), (\d+), (\d+)\}", text[:text.index(";")])]
        self.assertEqual([str(one)[:10] for one in gps_time.LEAP_DAYS], theirs)

    def test_week_and_time_of_week_come_back(self):
        ns = np.array([2200 * gps_time.NS_PER_WEEK + 345600 * 10**9 + 255_000_000, 10**9])
        week, tow = gps_time.week_and_tow(ns)
        self.assertTrue((gps_time.gps_ns(week, tow) == ns).all())


class Pieces(unittest.TestCase):
    """A journal in pieces, each with the events 0 and 1 of the run again."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(dir=WORK))

    def write(self, name, run, piece, first, last):
        mark = struct.pack(">8xqqiqqb", 0, piece, 1, run, first, 0)
        events = [(0, "X_CONFIG", bytes(50)), (1, "X_PIECE", mark)] + [(i, "X_IMU", b"i") for i in range(first, last + 1)]
        with open(self.folder / name, "wb") as log:
            for number, channel, data in events:
                log.write(event_log.HEADER.pack(event_log.SYNC, number, 0, len(channel), len(data)) + channel.encode() + data)

    def counts(self, name):
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            channels = [event.channel for event in leonav.events(self.folder / name)]
        return channels.count("X_CONFIG"), channels.count("X_PIECE"), channels.count("X_IMU"), [str(one.message) for one in told]

    def test_pieces_are_one_log_from_the_first_or_from_the_folder(self):
        self.write("run", 5, 1, 2, 12)
        self.write("run.part0002.kept", 5, 2, 10, 19)  # three events again
        self.write("run.part0003", 5, 3, 20, 29)
        (self.folder / "notes.txt").write_text("no log")
        for name in ("run", "."):
            self.assertEqual(self.counts(name), (1, 1, 28, []))
        with open(self.folder / "run.part0002.kept", "r+b") as piece:  # cut short, and no piece has the rest
            piece.truncate(os.path.getsize(piece.name) - 1)
        self.assertEqual(self.counts("run")[:3], (1, 1, 27))
        self.assertIn("1 messages are missing with pieces that are gone", self.counts("run")[3][0])
        os.remove(self.folder / "run.part0002.kept")
        self.assertIn("7 messages are missing", self.counts("run")[3][0])

    def test_names_are_taken_apart_by_the_rule_of_the_table(self):
        table = (ROOT / "test/drivers/lcm/piece_names.txt").read_text().splitlines()
        for name, journal, number, kept in (line.split() for line in table if not line.startswith("#")):
            found = pieces.NAME.fullmatch(name)
            with self.subTest(name):
                self.assertEqual((found["journal"], int(found["number"] or 1), bool(found["kept"])), (journal, int(number), kept == "yes"))

    def test_a_damaged_event_number_is_damage(self):
        self.write("run", 5, 1, 2, 9)
        self.write("run.part0002", 5, 2, 8, 15)
        part = self.folder / "run.part0002"
        whole, length = part.read_bytes(), event_log.HEADER.size + len("X_IMU") + 1
        at = len(whole) - 3 * length
        for number in (-1, 3, 12, 14, 1 << 62):
            part.write_bytes(whole[:at + 4] + struct.pack(">q", number) + whole[at + 12:])
            with self.assertRaisesRegex(leonav.LeonavError, f"run.part0002: byte {at}: an event with the number {number} instead of 13"):
                self.counts("run")
            with warnings.catch_warnings(record=True) as told:
                warnings.simplefilter("always")
                read = [event.channel for event in leonav.events(self.folder / "run", "skip")]
            self.assertEqual(read.count("X_IMU"), 13)
            self.assertIn("1 events whose numbers are wrong are left out", str(told[0].message))

    def test_a_log_from_a_later_piece_on_says_that_it_replays_as_another_run(self):
        self.write("run", 5, 1, 2, 9)
        self.write("run.part0002", 5, 2, 10, 19)
        self.assertIn("the log begins with piece 2 of its run; a replay of it is another run", self.counts("run.part0002")[3][0])
        self.assertEqual(self.counts("run")[3], [])

    def test_a_run_that_no_clock_gives_is_no_piece(self):
        self.write("run", 5, 1, 2, 9)
        for run in (-1, pieces.GREATEST_RUN + 1):
            self.write("run.part0002", run, 2, 10, 19)
            self.assertIsNone(pieces.piece_of(self.folder / "run.part0002"))
        self.assertIsNotNone(pieces.piece_of(self.folder / "run"))

    def test_several_runs_in_a_folder_are_told_apart(self):
        self.write("run", 5, 1, 2, 9)
        self.write("run.part0002", 6, 2, 10, 19)
        self.assertEqual(self.counts("run"), (1, 1, 8, []))
        with self.assertRaisesRegex(leonav.LeonavError, "several runs; give the first piece"):
            self.counts(".")
        os.remove(self.folder / "run")
        os.remove(self.folder / "run.part0002")
        with self.assertRaisesRegex(leonav.LeonavError, "holds no piece of a journal"):
            self.counts(".")


class Damage(unittest.TestCase):
    def setUp(self):
        self.path = WORK / "damage.lcmlog"
        lcm_log.write(self.path, [(index, "LEONAV_X", bytes([index] * 20)) for index in range(5)])
        self.data = self.path.read_bytes()
        self.each = 28 + 8 + 20

    def read(self, data, damaged="raise"):
        self.path.write_bytes(data)
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            got = [event.data[0] for event in leonav.events(self.path, damaged)]
        return got, [str(one.message) for one in told]

    def test_a_log_cut_at_any_byte_yields_its_whole_events_and_a_warning(self):
        for end in range(1, len(self.data)):
            got, told = self.read(self.data[:end])
            self.assertEqual(got, list(range(end // self.each)))
            self.assertEqual(len(told), 1 if end % self.each else 0)
            if told:
                self.assertIn(f"damage.lcmlog: byte {end // self.each * self.each}: the last event is cut short", told[0])

    def test_damage_is_an_error_with_its_byte_or_is_left_out(self):
        data = bytearray(self.data)
        data[2 * self.each] ^= 1
        with self.assertRaisesRegex(leonav.LeonavError, rf"damage.lcmlog: byte {2 * self.each}: no event starts here.*damaged='skip'"):
            self.read(data)
        got, told = self.read(data, "skip")
        self.assertEqual(got, [0, 1, 3, 4])
        self.assertIn(f"byte {2 * self.each}: the log is damaged; {self.each} bytes are left out in all", told[0])

    def test_false_beginnings_of_events_are_searched_once(self):
        class Counting:
            def __init__(self, data):
                self.file, self.bytes = io.BytesIO(data), 0

            def seek(self, place):
                self.file.seek(place)

            def read(self, count):
                data = self.file.read(count)
                self.bytes += len(data)
                return data

        junk = event_log.SYNC * 100_000
        file = Counting(junk + self.data)
        self.assertEqual(event_log._next_event(file, 1, len(junk + self.data)), len(junk))
        self.assertLess(file.bytes, 3 * len(junk))
        file = Counting(self.data * 10_000)
        self.assertEqual(event_log._next_event(file, 1, 10_000 * len(self.data)), self.each)
        self.assertLess(file.bytes, 5000)  # the next event is near: a large block would be read for every damaged one

    def test_what_is_no_log_is_an_error_with_a_remedy(self):
        for data, text in ((b"", "byte 0: the file is empty; give"), (b"gps_week,gps_tow_s\n" * 9, "byte 0: this is not an LCM log")):
            with self.assertRaisesRegex(leonav.LeonavError, text):
                self.read(data)
        with self.assertRaisesRegex(leonav.LeonavError, "absent: No such file or directory; check the path"):
            list(leonav.events(WORK / "absent"))
        self.path.write_bytes(self.data)
        with self.assertRaisesRegex(leonav.LeonavError, r"no message that can be read on LEONAV_\*; the log holds LEONAV_X 5"):
            leonav.read_log(self.path)

    def test_flipped_bytes_never_end_otherwise(self):
        dice = random.Random(5)
        for _ in range(2000):
            data = bytearray(self.data)
            for _ in range(dice.randrange(1, 4)):
                data[dice.randrange(len(data))] = dice.randrange(256)
            for mode in ("raise", "skip"):
                try:
                    got, _ = self.read(data, mode)
                    self.assertLessEqual(len(got), 5)
                except leonav.LeonavError:
                    self.assertTrue(mode == "raise" or data[:4] != self.data[:4])


def namespace():
    """The words that run a command in a network namespace of its own."""
    for words in (["unshare", "-n"], ["unshare", "-rn"]):
        if subprocess.run([*words, "true"], stderr=subprocess.DEVNULL, check=False).returncode == 0:
            return words
    print("SKIPPED: no network namespace can be made here")
    raise unittest.SkipTest("no namespace")


class Route(unittest.TestCase):
    def test_a_missing_multicast_route_is_told_with_what_mends_it(self):
        listen = "import leonav; next(iter(leonav.subscribe(timeout_s=0.1)), None)"
        environment = {**os.environ, "PYTHONPATH": str(ROOT / "tools" / "python")}
        without = subprocess.run([*namespace(), sys.executable, "-c", listen], capture_output=True, text=True, check=False, env=environment)
        self.assertIn("LeonavError", without.stderr)
        route = re.findall("as root: (.*)", without.stderr)[-1]  # the message, behind the trace
        there = subprocess.run([*namespace(), "sh", "-c", f"{route} && exec '{sys.executable}' -c '{listen}'"], check=False, env=environment)
        self.assertEqual(there.returncode, 0)


class Datagrams(unittest.TestCase):
    def fragments(self, data, size):
        parts = [data[start:start + size] for start in range(0, len(data), size)]
        for index, part in enumerate(parts):
            head = struct.pack(">4sIIIHH", b"LC03", 7, len(data), index * size, index, len(parts))
            yield head + (b"LEONAV_EPOCH\0" if index == 0 else b"") + part

    def test_fragments_in_any_order_make_the_message(self):
        data = bytes(range(256)) * 40
        pieces = list(self.fragments(data, 1000))
        random.Random(6).shuffle(pieces)
        assembler = Assembler()
        whole = [one for one in (assembler.add(piece, "a") for piece in pieces) if one]
        self.assertEqual(whole, [("LEONAV_EPOCH", data)])

    def test_bad_datagrams_are_dropped_and_memory_is_bounded(self):
        dice, assembler = random.Random(7), Assembler()
        pieces = [struct.pack(">4sI", b"LC02", 1) + b"LEONAV_X\0abc", *self.fragments(bytes(3000), 1000)]
        for number in range(20000):
            piece = bytearray(dice.choice(pieces))
            piece[dice.randrange(len(piece))] = dice.randrange(256)
            assembler.add(bytes(piece[:dice.randrange(len(piece) + 1)]), number % 100)
            self.assertLessEqual(len(assembler._parts), 16)
        self.assertGreater(assembler.dropped, 0)


class Csv(unittest.TestCase):
    HEADER = "gps_week,gps_tow_s,latitude_deg,longitude_deg,height_m,source,pdop\n"

    def read(self, text):
        path = WORK / "bad.csv"
        path.write_text(text)
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            table = leonav.read_solution(path)
        return table, [str(one.message) for one in told]

    def test_a_bad_row_loses_only_itself(self):
        good = "2200,1000.5,45.0,7.0,100.0,ekf,\n"
        table, told = self.read(self.HEADER + good + "2200,1001\n" + good + "2200,,45.0,7.0,100.0,ekf,1.5\n")
        self.assertEqual((len(table), len(told)), (2, 1))
        self.assertIn("bad.csv:3: 2 rows are left out", told[0])
        self.assertEqual(str(table["utc"][0]), "2022-03-06 00:16:22.500000+00:00")
        self.assertTrue(table["pdop"].isna().all())

    def test_a_week_with_a_fraction_is_left_out_and_a_column_utc_is_made_anew(self):
        table, told = self.read(self.HEADER.replace("pdop", "utc") + "2200,1000.5,45.0,7.0,100.0,ekf,noon\n2200.5,1001.5,45.0,7.0,100.0,ekf,noon\n")
        self.assertEqual(len(table), 1)
        self.assertIn("bad.csv:3: 1 rows are left out", told[0])
        self.assertEqual([str(time) for time in table["utc"]], ["2022-03-06 00:16:22.500000+00:00"])

    def test_errors_name_the_line_and_the_remedy(self):
        for text, expected in (("", "bad.csv:1: no column 'gps_week'; give"), (self.HEADER, "no row with time and position"),
                               (self.HEADER + "2200,x,45,7,100,ekf,1\n", r"bad.csv:2: 'x' is no number \(gps_tow_s\)")):
            with self.assertRaisesRegex(leonav.LeonavError, expected):
                self.read(text)


class Journal(unittest.TestCase):
    """A run of the service, as its journal, its replay and a live subscriber show it."""

    @classmethod
    def setUpClass(cls):
        for name in ("leonavd", "leonav-replay", "leonav-synthetic-drive"):
            if not os.path.exists(f"{BIN}/{name}"):
                print(f"SKIPPED: {name} is not built")
                raise unittest.SkipTest(name)
        if shutil.which("lcm-logplayer") is None:
            print("SKIPPED: no lcm-logplayer (package liblcm-bin)")
            raise unittest.SkipTest("no lcm-logplayer")
        enter = namespace()
        cls.journal, cls.tables, cls.log = WORK / "run.journal", WORK / "replay", WORK / "drive.lcmlog"
        subprocess.run([f"{BIN}/leonav-synthetic-drive", "--out", cls.log, "--truth", WORK / "truth.csv", "--duration", "60", "--carriers"],
                       check=True, stdout=subprocess.DEVNULL)
        (WORK / "receive.py").write_text(RECEIVE)
        script = f"""ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo || exit 90
'{sys.executable}' '{WORK}/receive.py' '{ROOT}/tools/python' '{WORK}/live.pickle' & receiver=$!
for _ in $(seq 600); do [ -e '{WORK}/live.pickle.listens' ] && break; sleep 0.1; done
'{ROOT}/tools/scripts/lib/live-run' '{BIN}' urban '{cls.log}' '{cls.journal}' 5 2>'{WORK}/live.err' || exit 91
kill $receiver; wait $receiver"""
        done = subprocess.run([*enter, "bash", "-c", script], check=False)
        if done.returncode:
            raise AssertionError((WORK / "live.err").read_text()[-2000:])
        subprocess.run([f"{BIN}/leonav-replay", cls.journal, "--out", cls.tables], check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
        cls.read = leonav.read_log(cls.journal)

    def compare(self, ours, csv, columns_missing=()):
        theirs = pd.read_csv(self.tables / csv, keep_default_na=False, na_values=[""])
        self.assertEqual(len(ours), len(theirs), csv)
        for name in theirs.columns:
            if name in columns_missing:
                continue
            self.assertIn(name, ours.columns, csv)
            a, b = ours[name], theirs[name]
            if pd.api.types.is_numeric_dtype(a) or a.isna().all():
                a, b = a.astype(float).to_numpy(), b.astype(float).to_numpy()
                self.assertTrue((np.isnan(a) == np.isnan(b)).all(), f"{csv} {name}")
                digit = DIGIT.get(name, 0.001)
                self.assertTrue(np.all(np.abs(a - b)[~np.isnan(a)] <= 0.51 * digit), f"{csv} {name}")
            else:
                self.assertEqual(list(a), list(b.astype(object).where(b.notna(), "")), f"{csv} {name}")

    def test_epochs_agree_with_the_replay_field_by_field(self):
        learned = ("code_sigma_factor", "code_correlation_s", "doppler_sigma_factor", "doppler_correlation_s")  # in no message
        self.compare(self.read["EPOCH"], "epochs.csv", learned)
        self.compare(self.read["EPOCH_SATELLITES"], "satellites.csv")
        self.compare(self.read["EPOCH_MEASUREMENTS"], "measurements.csv", ("elevation_deg",))
        self.compare(self.read["EVENT"].sort_values("gps_tow_s", kind="stable"), "events.csv")

    def test_solutions_agree_with_the_replay_field_by_field(self):
        epochs = self.read["EPOCH"]
        self.compare(epochs[epochs["source"] != "none"].reset_index(drop=True), "solution.csv")
        csv = leonav.read_solution(self.tables / "solution.csv")
        at_epochs = epochs[epochs["source"] != "none"]
        self.assertLess(np.abs(csv["latitude_deg"].to_numpy() - at_epochs["latitude_deg"].to_numpy()).max(), 1e-10)
        self.assertTrue((csv["utc"].to_numpy() == at_epochs["utc"].to_numpy()).all())

    def test_solutions_at_the_rate_of_the_imu_agree_with_a_replay_at_that_rate(self):
        subprocess.run([f"{BIN}/leonav-replay", self.journal, "--out", WORK / "rate", "--rate", "10"], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        csv = leonav.read_solution(WORK / "rate" / "solution.csv")
        stream = self.read["SOLUTION"]
        both = csv.merge(stream, on=["gps_week", "gps_tow_s"], suffixes=("", "_log"))
        self.assertEqual(len(both), len(csv))
        for name in csv.columns:
            if name + "_log" not in both or name in ("utc", "source"):
                continue
            a, b = both[name], both[name + "_log"]
            self.assertTrue((a.isna() == b.isna()).all(), name)
            self.assertTrue((np.abs(a - b).dropna() <= 0.51e-4).all(), name)
        self.assertEqual(list(both["source"]), list(both["source_log"]))

    def test_inputs_are_those_of_the_log(self):
        log = leonav.read_log(self.log)
        self.assertEqual(len(log["IMU"]), len(self.read["IMU"]))
        for name in ("IMU", "GNSS_EPOCH", "EPHEMERIS"):
            pd.testing.assert_frame_equal(log[name], self.read[name])

    def test_channels_can_be_chosen(self):
        self.assertEqual(set(leonav.read_log(self.journal, ["IMU", "END"])), {"IMU", "END"})
        self.assertEqual(set(leonav.read_log(self.journal, "HEALTH")), {"HEALTH", "HEALTH_COUNTS"})
        with self.assertRaisesRegex(ValueError, "there is no channel GPS"):
            leonav.read_log(self.journal, ["GPS"])

    def test_live_messages_are_those_of_the_journal(self):
        with open(WORK / "live.pickle", "rb") as file:
            got = pickle.load(file)
        # LCM is UDP: what a busy machine loses is lost, so not every message must be there.
        for channel, kind in (("EPOCH", "epoch_t"), ("HEALTH", "health_t"), ("SOLUTION", "solution_t"), ("IMU", "imu_t")):
            live = {(sequence, time) for name, type_name, sequence, time in got if name == channel and type_name == kind}
            table = self.read[channel]
            times = gps_time.gps_ns(table["gps_week"].to_numpy(), table["gps_tow_s"].to_numpy())
            journaled = set(zip(table["sequence"].tolist(), times.tolist()))
            common = {(sequence, time) for sequence, time in live if (sequence, time) in journaled}
            self.assertGreater(len(common), 0, channel)
            self.assertLessEqual(len(live - common), 2, channel)  # a message may come after the journal's end


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    BIN = sys.argv.pop(1)
    try:
        unittest.main(verbosity=1)
    finally:
        shutil.rmtree(WORK, ignore_errors=True)
