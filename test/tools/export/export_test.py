#!/usr/bin/env python3
"""export_test.py BIN_DIR [unittest's arguments]: the files of leonav-export, read by readers that are not leonav's.

json and xml.etree of Python's library read GeoJSON, GPX and KML; MCAP and the messages in it are walked byte by byte here by their
specifications. With the PyPI packages mcap, mcap-ros2-support, rosbags and gpxpy, in the Python that LEONAV_PYTHON names, also
these read the same files.
"""
import collections
import datetime
import json
import math
import os
import pathlib
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.append(str(ROOT / "tools" / "scripts" / "lib"))
import lcm_log  # noqa: E402

BIN = None
WORK = pathlib.Path(tempfile.mkdtemp())
COLUMNS = ("gps_week gps_tow_s latitude_deg longitude_deg height_m v_north_m_s v_east_m_s v_down_m_s roll_deg pitch_deg yaw_deg "
           "std_north_m std_east_m std_down_m std_v_north_m_s std_v_east_m_s std_v_down_m_s std_roll_deg std_pitch_deg "
           "std_yaw_deg source satellites pdop protection_horizontal_m protection_vertical_m protection_heading_deg").split()
GPX, KML = "{http://www.topografix.com/GPX/1/1}", "{http://www.opengis.net/kml/2.2}"
MINE = "{urn:leonav:solution}"
GPS_EPOCH = datetime.datetime(1980, 1, 6, tzinfo=datetime.timezone.utc)
Row = collections.namedtuple("Row", COLUMNS)


def gps(utc, leap):
    """Week and time of week of an instant of UTC."""
    seconds = (utc - GPS_EPOCH).total_seconds() + leap
    return int(seconds // 604800), seconds % 604800


def drive(start=datetime.datetime(2024, 2, 28, 23, 59, 58, 250000, tzinfo=datetime.timezone.utc), leap=18, points=20, gap_after=11,
          longitude=7.5):
    """A curve with a point a second, a gap of 30 s, no attitude at the first two points, and INS alone at some."""
    rows, times = [], []
    for index in range(points):
        utc = start + datetime.timedelta(seconds=index + (30 if index > gap_after else 0))
        week, tow = gps(utc, leap)
        east = longitude + index * 1e-4
        attitude = [2.0 - 0.1 * index, -3.0 + 0.2 * index, 80.0 + 5 * index] if index >= 2 else ["", "", ""]
        sigma_attitude = [0.1, 0.2, 0.5] if index >= 2 else ["", "", ""]
        source = "aligning" if index < 2 else "ins" if index in (9, 10) else "smoother" if index > 15 else "ekf"
        rows.append(Row(week, round(tow, 3), 45.0 + index * 1.25e-4, (east + 180) % 360 - 180, 300.125 + index, 11.0, 7.0, -0.5,
                        *attitude, 0.5, 0.25, 1.5, 0.01, 0.02, 0.04, *sigma_attitude, source, 9 + index % 3, 1.75, 5.5, 8.25,
                        2.5 if index >= 2 else ""))
        times.append(utc)
    return rows, times


def write_csv(rows, name="drive.csv"):
    path = WORK / name
    path.write_text(",".join(COLUMNS) + "\n" + "".join(",".join(str(field) for field in row) + "\n" for row in rows))
    return path


def export(*arguments, expect=0):
    done = subprocess.run([f"{BIN}/leonav-export", *map(str, arguments)], capture_output=True, text=True, check=False, timeout=100)
    if done.returncode != expect:
        raise AssertionError(f"exit code {done.returncode}: {done.stderr}")
    return done


def utc_of(text):
    return datetime.datetime.fromisoformat(text.replace("Z", "+00:00"))


def ecef(latitude_deg, longitude_deg, height):
    a, e2 = 6378137.0, 6.69437999014e-3
    phi, lam = math.radians(latitude_deg), math.radians(longitude_deg)
    n = a / math.sqrt(1 - e2 * math.sin(phi) ** 2)
    return ((n + height) * math.cos(phi) * math.cos(lam), (n + height) * math.cos(phi) * math.sin(lam),
            (n * (1 - e2) + height) * math.sin(phi))


def east_north_up(row, origin):
    d = [a - b for a, b in zip(ecef(row.latitude_deg, row.longitude_deg, row.height_m),
                               ecef(origin.latitude_deg, origin.longitude_deg, origin.height_m))]
    phi, lam = math.radians(origin.latitude_deg), math.radians(origin.longitude_deg)
    return (-math.sin(lam) * d[0] + math.cos(lam) * d[1],
            -math.sin(phi) * math.cos(lam) * d[0] - math.sin(phi) * math.sin(lam) * d[1] + math.cos(phi) * d[2],
            math.cos(phi) * math.cos(lam) * d[0] + math.cos(phi) * math.sin(lam) * d[1] + math.sin(phi) * d[2])


def product(a, b):
    """Quaternions x, y, z, w."""
    return (a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1], a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
            a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3], a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2])


def orientation(row):
    """Of forward-left-up against east-north-up: the heading counts from east to the left, and the pitch changes its sign."""
    yaw, pitch, roll = math.radians(90 - row.yaw_deg) / 2, -math.radians(row.pitch_deg) / 2, math.radians(row.roll_deg) / 2
    return product(product((0, 0, math.sin(yaw), math.cos(yaw)), (0, math.sin(pitch), 0, math.cos(pitch))),
                   (math.sin(roll), 0, 0, math.cos(roll)))


def turned(quaternion, vector):
    x, y, z, w = quaternion
    return product(product(quaternion, (*vector, 0)), (-x, -y, -z, w))[:3]


class Cdr:
    """Reads members of a message of ROS 2."""

    def __init__(self, data):
        assert data[:4] == b"\0\1\0\0", "not little endian CDR"
        self.data, self.at = data[4:], 0

    def take(self, code, count=1):
        size = struct.calcsize(code)
        self.at += -self.at % size
        values = struct.unpack_from(f"<{count}{code}", self.data, self.at)
        self.at += size * count
        return values if count > 1 else values[0]

    def text(self):
        length = self.take("I")
        value = self.data[self.at:self.at + length]
        self.at += length
        assert value.endswith(b"\0")
        return value[:-1].decode()

    def header(self):
        return self.take("i") * 10**9 + self.take("I"), self.text()


class Mcap:
    """Walks an MCAP file, checks every length, checksum and index, and keeps messages by topic."""

    def __init__(self, path):
        data = path.read_bytes()
        assert data[:8] == data[-8:] == b"\x89MCAP0\r\n"
        self.topics, self.schemas, self.messages = {}, {}, collections.defaultdict(list)
        self.chunks, self.indexed, records, at = 0, 0, [], 8
        while at < len(data) - 8:
            opcode, length = struct.unpack_from("<BQ", data, at)
            records.append((opcode, at, data[at + 9:at + 9 + length]))
            at += 9 + length
        assert at == len(data) - 8
        order = [opcode for opcode, _, _ in records]
        assert order[0] == 1 and order[-1] == 2 and order.count(0x0F) == 1
        end = order.index(0x0F)
        assert struct.unpack("<I", records[end][2])[0] == zlib.crc32(data[:records[end][1]])
        for opcode, at, content in records[:end]:
            self.record(opcode, at, content)
        summary, offsets, checksum = struct.unpack("<QQI", records[-1][2])
        assert summary == records[end + 1][1] and checksum == zlib.crc32(data[summary:len(data) - 8 - 4])
        self.summary(records[end + 1:-1], offsets, data)

    def text(self, content, at):
        length = struct.unpack_from("<I", content, at)[0]
        return content[at + 4:at + 4 + length], at + 4 + length

    def record(self, opcode, at, content):
        if opcode == 3:
            name, start = self.text(content, 2)
            encoding, start = self.text(content, start)
            self.schemas[struct.unpack_from("<H", content)[0]] = name.decode(), encoding.decode(), self.text(content, start)[0].decode()
        elif opcode == 4:
            number, schema = struct.unpack_from("<HH", content)
            topic, start = self.text(content, 4)
            self.topics[number] = topic.decode(), self.text(content, start)[0].decode(), self.schemas[schema]
        elif opcode == 6:
            self.chunk(content)
        elif opcode == 7:
            channel, size = struct.unpack_from("<HI", content)
            for time, offset in struct.iter_unpack("<QQ", content[6:6 + size]):
                assert struct.unpack_from("<H", self.inner, offset + 9)[0] == channel
                assert struct.unpack_from("<Q", self.inner, offset + 15)[0] == time
                self.indexed += 1

    def chunk(self, content):
        first, last, size, checksum = struct.unpack_from("<QQQI", content)
        compression, at = self.text(content, 28)
        assert compression == b"" and struct.unpack_from("<Q", content, at)[0] == size
        self.inner, at, times = content[at + 8:], 0, []
        assert len(self.inner) == size and zlib.crc32(self.inner) == checksum
        while at < size:
            opcode, length = struct.unpack_from("<BQ", self.inner, at)
            channel, sequence, logged, published = struct.unpack_from("<HIQQ", self.inner, at + 9)
            topic = self.topics[channel][0]
            assert opcode == 5 and logged == published and sequence == len(self.messages[topic])
            self.messages[topic].append((logged, self.inner[at + 9 + 22:at + 9 + length]))
            times.append(logged)
            at += 9 + length
        assert (first, last) == (min(times), max(times))
        self.chunks += 1

    def summary(self, records, offsets, data):
        count = sum(len(some) for some in self.messages.values())
        assert self.indexed == count
        groups = collections.Counter(opcode for opcode, _, _ in records)
        assert groups == {3: len(self.schemas), 4: len(self.topics), 0x0B: 1, 8: self.chunks, 0x0E: 4}, groups
        for opcode, at, content in records:
            if opcode == 0x0B:
                assert struct.unpack_from("<QHIIII", content) == (count, len(self.schemas), len(self.topics), 0, 0, self.chunks)
            elif opcode == 8:
                start, length = struct.unpack_from("<QQ", content, 16)
                assert data[start] == 6 and struct.unpack_from("<Q", data, start + 1)[0] + 9 == length
            elif opcode == 0x0E:
                assert at >= offsets
                group, start, length = struct.unpack("<BQQ", content)
                assert length == sum(len(one) + 9 for kind, _, one in records if kind == group) and data[start] == group


class Test(unittest.TestCase):
    def close(self, got, wanted, margin, what=""):
        got, wanted = (got, wanted) if hasattr(got, "__len__") else ([got], [wanted])
        self.assertEqual(len(got), len(wanted), what)
        for a, b in zip(got, wanted):
            self.assertLessEqual(abs(float(a) - b), margin, what)


class Maps(Test):
    def setUp(self):
        self.rows, self.times = drive()
        self.csv = write_csv(self.rows)

    def attributes(self, row):
        return {name: getattr(row, name) for name in COLUMNS[4:]}

    def test_geojson_has_every_point_with_its_attributes_and_no_line_over_the_gap(self):
        out = WORK / "drive.geojson"
        self.assertIn("20 points in 2 parts", export(self.csv, "--out", out).stdout)
        features = json.loads(out.read_text())["features"]
        lines = [one for one in features if one["geometry"]["type"] == "LineString"]
        points = [one for one in features if one["geometry"]["type"] == "Point"]
        self.assertEqual([len(one["geometry"]["coordinates"]) for one in lines], [12, 8])
        self.assertEqual([one["properties"]["points"] for one in lines], [12, 8])
        self.assertEqual(utc_of(lines[1]["properties"]["begin"]), self.times[12])
        self.assertEqual(len(points), 20)
        for row, time, point in zip(self.rows, self.times, points):
            self.close(point["geometry"]["coordinates"], [row.longitude_deg, row.latitude_deg, row.height_m], 1e-9)
            properties = point["properties"]
            self.assertEqual(utc_of(properties.pop("time")), time)
            for name, value in self.attributes(row).items():
                got = properties.pop(name)
                self.assertTrue(got == value if name == "source" else got is None if value == "" else abs(got - value) < 1e-4, name)
            self.assertEqual(properties, {})

    def test_gpx_has_a_segment_for_each_part(self):
        out = WORK / "drive.gpx"
        export(self.csv, "--out", out, "--geoid-separation", "50", "--name", "<a&b>")
        track = ElementTree.parse(out).getroot().find(GPX + "trk")
        self.assertEqual(track.find(GPX + "name").text, "<a&b>")
        self.assertEqual([len(segment) for segment in track.findall(GPX + "trkseg")], [12, 8])
        for row, time, point in zip(self.rows, self.times, track.iter(GPX + "trkpt")):
            self.close([point.get("lat"), point.get("lon"), point.find(GPX + "ele").text],
                       [row.latitude_deg, row.longitude_deg, row.height_m - 50], 1e-9)
            self.assertEqual(utc_of(point.find(GPX + "time").text), time)
            self.assertEqual(point.findtext(GPX + "fix"), None if row.source == "ins" else "3d")
            self.assertEqual(int(point.find(GPX + "sat").text), row.satellites)
            more = {one.tag: one.text for one in point.find(GPX + "extensions")}
            for name, value in self.attributes(row).items():
                got = more.pop(MINE + name, "")
                self.assertTrue(got == value if name == "source" or value == "" else abs(float(got) - value) < 1e-4, name)
            self.assertEqual(more, {})

    def test_kml_has_lines_and_points_with_times_and_attributes(self):
        out = WORK / "drive.kml"
        export(self.csv, "--out", out)
        root = ElementTree.parse(out).getroot()
        lines = list(root.iter(KML + "LineString"))
        self.assertEqual([len(line.find(KML + "coordinates").text.split()) for line in lines], [12, 8])
        self.assertEqual(lines[0].find(KML + "altitudeMode").text, "clampToGround")
        fields = [one.get("name") for one in root.iter(KML + "SimpleField")]
        points = [one for one in root.iter(KML + "Placemark") if one.find(KML + "Point") is not None]
        self.assertEqual(len(points), 20)
        for row, time, point in zip(self.rows, self.times, points):
            self.close(point.find(f"{KML}Point/{KML}coordinates").text.split(","),
                       [row.longitude_deg, row.latitude_deg, row.height_m], 1e-9)
            self.assertEqual(utc_of(point.find(f"{KML}TimeStamp/{KML}when").text), time)
            more = {one.get("name"): one.text for one in point.iter(KML + "SimpleData")}
            self.assertTrue(set(more) <= set(fields))
            for name, value in self.attributes(row).items():
                got = more.get(name, "")
                self.assertTrue(got == value if name == "source" or value == "" else abs(float(got) - value) < 1e-4, name)

    def test_a_line_ends_at_the_180th_meridian(self):
        rows, _ = drive(longitude=179.9995, gap_after=99)
        out = WORK / "around.geojson"
        self.assertIn("2 parts", export(write_csv(rows), "--out", out).stdout)
        for one in json.loads(out.read_text())["features"]:
            if one["geometry"]["type"] == "LineString":
                east = [point[0] for point in one["geometry"]["coordinates"]]
                self.assertLess(max(east) - min(east), 1)

    def test_times_step_at_a_leap_second(self):
        before = datetime.datetime(2016, 12, 31, 23, 59, 58, tzinfo=datetime.timezone.utc)
        rows, _ = drive(start=before, leap=17, points=6, gap_after=99)
        out = WORK / "leap.geojson"
        export(write_csv(rows), "--out", out)
        points = [one["properties"]["time"] for one in json.loads(out.read_text())["features"] if one["geometry"]["type"] == "Point"]
        self.assertEqual([one[11:19] for one in points], ["23:59:58", "23:59:59", "00:00:00", "00:00:00", "00:00:01", "00:00:02"])

    def test_rate_and_gap_choose_points_and_lines(self):
        out = WORK / "chosen.geojson"
        self.assertIn("in 1 part\n", export(self.csv, "--out", out, "--gap", "60").stdout)
        self.assertIn("20 points in 20 parts", export(self.csv, "--out", out, "--gap", "0.5", "--rate", "all").stdout)
        self.assertFalse([one for one in json.loads(out.read_text())["features"] if one["geometry"]["type"] == "LineString"])
        slow = export(self.csv, "--out", out, "--rate", "0.1").stdout
        self.assertLess(int(slow.split(": ")[1].split()[0]), 8)


    def test_a_prediction_ends_the_line_and_is_in_none(self):
        rows, _ = drive(gap_after=99)
        for index in (6, 7, 8):
            rows[index] = rows[index]._replace(source="prediction", roll_deg="", pitch_deg="", yaw_deg="")
        csv = write_csv(rows, "lost.csv")
        files = {name: WORK / f"lost.{name}" for name in ("gpx", "kml", "geojson")}
        for out in files.values():
            self.assertIn("20 points in 2 parts, and 3 of them are predictions", export(csv, "--out", out, "--gap", "60").stdout)
        features = json.loads(files["geojson"].read_text())["features"]
        places = [one["geometry"]["coordinates"] for one in features if one["geometry"]["type"] == "Point"]
        lines = [one["geometry"]["coordinates"] for one in features if one["geometry"]["type"] == "LineString"]
        self.assertEqual(lines, [places[:6], places[9:]])
        self.assertEqual([one["properties"]["source"] for one in features if one["geometry"]["type"] == "Point"][5:10],
                         ["ekf", "prediction", "prediction", "prediction", "ins"])
        segments = ElementTree.parse(files["gpx"]).getroot().findall(f"{GPX}trk/{GPX}trkseg")
        self.assertEqual([len(one.findall(f"{GPX}trkpt")) for one in segments], [6, 1, 1, 1, 11])
        lines = ElementTree.parse(files["kml"]).getroot().iter(f"{KML}LineString")
        self.assertEqual([len(one.find(f"{KML}coordinates").text.split()) for one in lines], [6, 11])


class Errors(Test):
    def test_nothing_to_export_is_an_error_and_leaves_no_file(self):
        header = ",".join(COLUMNS) + "\n"
        for text, expected in ((header, "empty.csv"), ("", "empty.csv"), (header + "2200,x,1,2,3\n", "empty.csv")):
            path, out = WORK / "empty.csv", WORK / "none.gpx"
            path.write_text(text)
            self.assertIn(expected, export(path, "--out", out, expect=1).stderr)
            self.assertEqual(list(WORK.glob("none.gpx*")), [])

    def test_an_old_file_stays_where_an_export_fails(self):
        out = WORK / "old.kml"
        out.write_text("old")
        export(WORK / "absent.csv", "--out", out, expect=1)
        self.assertEqual(out.read_text(), "old")

    def test_wrong_command_lines_are_told(self):
        csv = write_csv(drive()[0])
        for arguments, expected in (((csv,), "--out"), ((csv, "--out", WORK / "a.shp"), "--format"),
                                    (("--out", WORK / "a.gpx"), "expected one RUN"),
                                    ((csv, "--out", csv, "--format", "gpx"), "is the file that is read"),
                                    ((csv, "--out", WORK / "a.gpx", "--rate", "0"), "--rate: must be")):
            self.assertIn(expected, export(*arguments, expect=2).stderr)
        self.assertIn("Foxglove", export("--help").stdout)

    def test_a_folder_that_is_not_there_and_a_device_are_errors(self):
        csv = write_csv(drive()[0])
        self.assertIn("cannot be created", export(csv, "--out", WORK / "no" / "a.gpx", expect=1).stderr)
        self.assertIn("no regular file", export(csv, "--out", "/dev/null", "--format", "gpx", expect=1).stderr)

    def test_a_file_of_the_user_with_the_name_of_the_unfinished_one_is_kept(self):
        csv, out = write_csv(drive()[0]), WORK / "kept.gpx"
        mine = WORK / "kept.gpx.part"
        mine.write_text("mine")
        export(csv, "--out", out)
        self.assertEqual(mine.read_text(), "mine")
        self.assertEqual(sorted(path.name for path in WORK.glob("kept.gpx*")), ["kept.gpx", "kept.gpx.part"])


class Ros(Test):
    def setUp(self):
        self.rows, self.times = drive()
        self.out = WORK / "drive.mcap"
        self.assertIn("20 fixes, 18 odometries", export(write_csv(self.rows), "--out", self.out).stdout)

    def ns(self, time):
        return round((time - datetime.datetime(1970, 1, 1, tzinfo=datetime.timezone.utc)).total_seconds() * 1000) * 10**6

    def test_the_file_is_sound_and_its_messages_are_those_of_the_solution(self):
        mcap = Mcap(self.out)
        self.assertEqual(sorted((name, encoding, schema[0], schema[1]) for name, encoding, schema in mcap.topics.values()),
                         [("/leonav/fix", "cdr", "sensor_msgs/msg/NavSatFix", "ros2msg"),
                          ("/leonav/odometry", "cdr", "nav_msgs/msg/Odometry", "ros2msg"),
                          ("/leonav/source", "cdr", "std_msgs/msg/String", "ros2msg")])
        fixes = mcap.messages["/leonav/fix"]
        self.assertEqual([time for time, _ in fixes], [self.ns(time) for time in self.times])
        for row, (time, data) in zip(self.rows, fixes):
            cdr = Cdr(data)
            self.assertEqual(cdr.header(), (time, "base_link"))
            self.assertEqual((cdr.take("b"), cdr.take("H")), (0, 13))
            self.close(cdr.take("d", 3), [row.latitude_deg, row.longitude_deg, row.height_m], 1e-9)
            self.close(cdr.take("d", 9), [0.0625, 0, 0, 0, 0.25, 0, 0, 0, 2.25], 1e-9)
            self.assertEqual((cdr.take("B"), cdr.at), (2, len(cdr.data)))
        self.assertEqual([Cdr(data).text() for _, data in mcap.messages["/leonav/source"]], [row.source for row in self.rows])

    def test_odometry_is_in_the_frames_of_ros(self):
        messages = Mcap(self.out).messages["/leonav/odometry"]
        self.assertEqual(len(messages), 18)
        for row, (time, data) in zip(self.rows[2:], messages):
            cdr = Cdr(data)
            self.assertEqual(cdr.header(), (time, "map"))
            self.assertEqual(cdr.text(), "base_link")
            self.close(cdr.take("d", 3), east_north_up(row, self.rows[0]), 1e-6)
            quaternion, wanted = cdr.take("d", 4), orientation(row)
            sign = math.copysign(1, sum(a * b for a, b in zip(quaternion, wanted)))
            self.close([sign * one for one in quaternion], wanted, 2e-4)  # the verticals differ by the way over the Earth's radius
            pose = cdr.take("d", 36)
            self.close([pose[0], pose[7], pose[14]], [0.0625, 0.25, 2.25], 1e-3)
            turn = sum(pose[21 + 7 * index] for index in range(3))
            self.close(turn, math.radians(0.1) ** 2 + math.radians(0.2) ** 2 + math.radians(0.5) ** 2, 1e-9)
            self.close([pose[6 * i + j] - pose[6 * j + i] for i in range(6) for j in range(6)], [0] * 36, 1e-12)
            velocity = turned(quaternion, cdr.take("d", 3))
            self.close(velocity, [row.v_east_m_s, row.v_north_m_s, -row.v_down_m_s], 5e-3)
            self.assertEqual(cdr.take("d", 3), (0, 0, 0))
            twist = cdr.take("d", 36)
            self.close(sum(twist[7 * index] for index in range(3)), 0.01 ** 2 + 0.02 ** 2 + 0.04 ** 2, 1e-12)
            self.assertEqual((twist[21], cdr.at), (1e9, len(cdr.data)))

    def test_a_vehicle_that_looks_east_moves_forward(self):
        row = self.rows[5]._replace(roll_deg=0.0, pitch_deg=0.0, yaw_deg=90.0, v_north_m_s=0.0, v_east_m_s=10.0, v_down_m_s=0.0)
        out = WORK / "east.mcap"
        export(write_csv([row], "east.csv"), "--out", out)
        cdr = Cdr(Mcap(out).messages["/leonav/odometry"][0][1])
        cdr.header(), cdr.text()
        self.close(cdr.take("d", 3), [0, 0, 0], 1e-9)
        self.close([abs(one) for one in cdr.take("d", 4)], [0, 0, 0, 1], 1e-9)
        cdr.take("d", 36)
        self.close(cdr.take("d", 3), [10, 0, 0], 1e-9)

    def test_many_messages_make_several_chunks(self):
        rows = [self.rows[5]._replace(gps_tow_s=1000 + index / 100) for index in range(4000)]
        out = WORK / "long.mcap"
        export(write_csv(rows, "long.csv"), "--out", out)
        mcap = Mcap(out)
        self.assertGreater(mcap.chunks, 2)
        self.assertEqual([len(some) for some in mcap.messages.values()], [4000] * 3)

    def test_a_time_that_ros_does_not_have_is_an_error(self):
        late = WORK / "late.mcap"
        told = export(write_csv([self.rows[5]._replace(gps_week=3100)], "late.csv"), "--out", late, expect=1).stderr
        self.assertIn("ROS has no times after 2038", told)
        self.assertFalse(late.exists())

    def test_other_readers_read_the_same(self):
        python = os.environ.get("LEONAV_PYTHON", "python3")
        if subprocess.run([python, "-c", "import mcap_ros2, rosbags, gpxpy"], stderr=subprocess.DEVNULL, check=False).returncode:
            print("SKIPPED (optional): no Python with mcap-ros2-support, rosbags and gpxpy (LEONAV_PYTHON names another)")
            return
        gpx = WORK / "oracle.gpx"
        export(write_csv(self.rows), "--out", gpx)
        subprocess.run([python, str(ROOT / "test/oracle/export.py"), write_csv(self.rows), self.out, gpx], check=True)


class Logs(Test):
    """SOLUTION and EPOCH of a log, by the code that lcm-gen writes for Python."""

    @classmethod
    def setUpClass(cls):
        if shutil.which("lcm-gen") is None:
            print("SKIPPED: no lcm-gen (package liblcm-bin)")
            raise unittest.SkipTest("no lcm-gen")
        subprocess.run(["lcm-gen", "-p", "--ppath", WORK / "generated", *sorted((ROOT / "lcmtypes").glob("*.lcm"))], check=True)
        sys.path.insert(0, str(WORK / "generated"))
        import leonav
        cls.types = leonav

    def solution(self, row, index):
        message = self.types.solution_t()
        message.time_ns = row.gps_week * 604800 * 10**9 + round(row.gps_tow_s * 1000) * 10**6
        message.sequence, message.schema = index + 1, 2
        message.source = ("none", "aligning", "ins", "ekf", "smoother").index(row.source)
        message.latitude_rad, message.longitude_rad = math.radians(row.latitude_deg), math.radians(row.longitude_deg)
        message.height_m = row.height_m
        message.v_n = [row.v_north_m_s, row.v_east_m_s, row.v_down_m_s]
        message.has_attitude = row.roll_deg != ""
        if message.has_attitude:
            message.rpy_rad = [math.radians(one) for one in (row.roll_deg, row.pitch_deg, row.yaw_deg)]
            message.sigma_rpy = [math.radians(one) for one in (row.std_roll_deg, row.std_pitch_deg, row.std_yaw_deg)]
        message.sigma_p_n = [row.std_north_m, row.std_east_m, row.std_down_m]
        message.sigma_v_n = [row.std_v_north_m_s, row.std_v_east_m_s, row.std_v_down_m_s]
        message.horizontal_protection_m, message.vertical_protection_m = row.protection_horizontal_m, row.protection_vertical_m
        message.heading_protection_rad = math.radians(row.protection_heading_deg) if message.has_attitude else math.nan
        return message

    def messages(self, rows):
        for index, row in enumerate(rows):
            solution, epoch = self.solution(row, index), self.types.epoch_t()
            epoch.time_ns, epoch.schema, epoch.solution = solution.time_ns, 2, solution
            epoch.satellites_used, epoch.pdop = row.satellites, row.pdop
            yield index, "LEONAV_EPOCH", epoch.encode()
            yield index, "LEONAV_SOLUTION", solution.encode()

    def test_a_log_gives_what_its_solution_csv_gives(self):
        rows, _ = drive()
        log, csv = WORK / "run.journal", write_csv(rows)
        lcm_log.write(log, self.messages(rows))
        for format_name in ("gpx", "kml", "geojson", "mcap"):
            one, other = WORK / f"log.{format_name}", WORK / f"csv.{format_name}"
            export(log, "--out", one, "--name", "drive", "--rate", "all")
            export(csv, "--out", other, "--name", "drive", "--rate", "all")
            if format_name == "mcap":  # degrees through radians differ in their last bits
                self.assertEqual(len(one.read_bytes()), len(other.read_bytes()))
                self.assertEqual(Mcap(one).topics, Mcap(other).topics)
            else:
                self.assertEqual(one.read_text(), other.read_text())

    def test_smoothed_states_and_another_prefix_can_be_chosen(self):
        rows, _ = drive()
        log, out = WORK / "smoothed.journal", WORK / "smoothed.geojson"
        lcm_log.write(log, [*((0, "CAR_SOLUTION", self.solution(row, 0).encode()) for row in rows),
                            *((1, "CAR_SMOOTHED", self.solution(row, 0).encode()) for row in rows[:7])])
        self.assertIn("7 points", export(log, "--out", out, "--prefix", "CAR_", "--smoothed").stdout)
        self.assertIn("20 points", export(log, "--out", out, "--prefix", "CAR_").stdout)
        self.assertIn("no message on LEONAV_SMOOTHED", export(log, "--out", out, "--smoothed", expect=1).stderr)

    def test_damaged_messages_are_told_and_lose_nothing_else(self):
        rows, _ = drive()
        log, some = WORK / "damaged.journal", list(self.messages(rows))
        some[5] = (2, "LEONAV_SOLUTION", some[5][2][:-4])
        some.insert(9, some[3])  # comes again, too late
        lcm_log.write(log, some)
        log.write_bytes(log.read_bytes()[:-10])
        done = export(log, "--out", WORK / "damaged.geojson")
        self.assertIn("18 points", done.stdout)
        for told in ("1 messages of LEONAV_SOLUTION are left out: undecodable", "1 messages of LEONAV_SOLUTION are left out: their time does not fit",
                     "the last event is cut short"):
            self.assertIn(told, done.stderr)

    def test_a_time_that_leaps_ahead_loses_only_itself(self):
        rows, _ = drive()
        rows[6] = rows[6]._replace(gps_week=rows[6].gps_week + 500)
        log = WORK / "leap.journal"
        lcm_log.write(log, self.messages(rows))
        done = export(log, "--out", WORK / "leap.mcap")
        self.assertIn("19 fixes", done.stdout)
        self.assertIn("1 messages of LEONAV_SOLUTION are left out: their time does not fit those around them", done.stderr)

    def test_a_log_without_solutions_says_what_to_do(self):
        log, out = WORK / "inputs.lcmlog", WORK / "inputs.gpx"
        lcm_log.write(log, [(0, "LEONAV_IMU", b"1234")])
        told = export(log, "--out", out, expect=1).stderr
        self.assertIn("no message on LEONAV_SOLUTION; a log of leonav-import has no solutions (leonav-replay --out DIR", told)
        rows = [row._replace(source="none") for row in drive()[0]]
        lcm_log.write(log, self.messages(rows))
        self.assertIn("no solution has a position (20 messages)", export(log, "--out", out, expect=1).stderr)
        self.assertEqual(list(WORK.glob("inputs.gpx*")), [])

    def test_cut_and_flipped_logs_end_with_a_file_or_an_error(self):
        dice, log, out = random.Random(1), WORK / "hostile.journal", WORK / "hostile.mcap"
        lcm_log.write(log, self.messages(drive(points=4)[0]))
        good = log.read_bytes()
        for _ in range(40):
            bad = bytearray(good[:dice.randrange(1, len(good) + 1)])
            for _ in range(dice.randrange(4)):
                bad[dice.randrange(len(bad))] ^= 1 << dice.randrange(8)
            log.write_bytes(bad)
            out.unlink(missing_ok=True)
            code = subprocess.run([f"{BIN}/leonav-export", log, "--out", out], capture_output=True, check=False, timeout=100).returncode
            self.assertIn(code, (0, 1))
            self.assertEqual(out.exists(), code == 0)
            if code == 0:
                Mcap(out)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    BIN = sys.argv.pop(1)
    if not os.path.exists(f"{BIN}/leonav-export"):
        sys.exit("leonav-export is not built")
    try:
        unittest.main(verbosity=1)
    finally:
        shutil.rmtree(WORK, ignore_errors=True)
