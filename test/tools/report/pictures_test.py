#!/usr/bin/python3
"""pictures_test.py [unittest's arguments]: what leonav-report shows, on a run of known content.

The run is made by made_run.py, as tables and as a journal that lcm-gen's types encode. What a picture shows is asked of its figure; every
text of every picture must stand free.
"""
import base64
import contextlib
import html.parser
import io
import math
import pathlib
import random
import re
import shutil
import struct
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path[:0] = [str(ROOT / "tools" / "report"), str(ROOT / "tools" / "python"), str(HERE.parent), str(ROOT / "tools" / "scripts" / "lib")]
try:
    import matplotlib
    import numpy as np
    import pandas  # noqa: F401
except ImportError as missing:
    print(f"SKIPPED: {missing} for {sys.executable} (Debian packages python3-numpy, python3-matplotlib, python3-pandas)")
    sys.exit(0)
matplotlib.use("Agg")
import lcm_log  # noqa: E402
import made_run  # noqa: E402
from generated_types import generated_types  # noqa: E402
from report import (accuracy_pictures, command, error_pictures, map_marks, map_picture, map_view, numbers,  # noqa: E402
                    residual_pictures, sky, style, timeline)
from report.errors import ReportError  # noqa: E402
from report.gaps import gaps  # noqa: E402
from report.local_frame import LocalFrame  # noqa: E402
from report.map_picture import draw_map  # noqa: E402
from report.run import add_journal, read_run  # noqa: E402
from report.sky_picture import draw_sky  # noqa: E402
from report.tables import Table  # noqa: E402
from report.timeline_picture import draw_timeline  # noqa: E402

WORK = pathlib.Path(tempfile.mkdtemp())


def quiet(_):
    pass


def table(**columns):
    size = len(next(iter(columns.values())))
    columns.setdefault("gps_tow_s", np.arange(size, dtype=float))
    return Table("made", {"gps_week": np.full(size, 2200.0), **columns})


def run_report(*words):
    """Exit code and what was written to the two streams."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = command.main([str(word) for word in words])
    return code, out.getvalue(), err.getvalue()


def setUpModule():
    made_run.write(WORK)
    if shutil.which("lcm-gen"):
        types = generated_types(ROOT, WORK / "generated")
        lcm_log.write(WORK / "run.journal", [(stamp / 1e6, channel, data) for stamp, channel, data in made_run.journal(types)])


def tearDownModule():
    shutil.rmtree(WORK)


def journal():
    if not (WORK / "run.journal").exists():
        print("SKIPPED: no lcm-gen (package liblcm-bin)")
        raise unittest.SkipTest("no lcm-gen")
    return WORK / "run.journal"


class Marks(unittest.TestCase):
    def test_a_scale_bar_is_one_two_or_five_and_fits(self):
        for most in np.geomspace(0.003, 2e6, 400):
            length = map_marks.round_length(most)
            self.assertLessEqual(length, most * (1 + 1e-8))
            self.assertGreater(2.5 * length, most * (1 - 1e-8))
            self.assertIn(f"{length:.6e}"[:8], ("1.000000", "2.000000", "5.000000"))
        self.assertEqual([style.distance(one) for one in (0.05, 0.5, 1.0, 200.0, 1000.0, 20000.0)],
                         ["5 cm", "50 cm", "1 m", "200 m", "1 km", "20 km"])

    def test_the_graticule_says_where_its_lines_are(self):
        for text, value, step in (("45°03'N", 45.05, 60.0), ("45°03'30\"N", 45 + 3.5 / 60, 30.0), ("0°00'S", -1e-9, 3600.0),
                                  ("33°51'24.50\"S", -(33 + 51 / 60 + 24.5 / 3600), 0.05)):
            self.assertEqual(map_marks.arc_text(value, step, "NS"), text)
        dice = random.Random(1)
        for _ in range(2000):
            step = dice.choice(map_marks.STEPS)
            value = dice.randrange(-int(90 * 3600 / step), int(90 * 3600 / step)) * step / 3600.0
            parts = re.fullmatch(r"(\d+)°(\d\d)'(?:(\d\d(?:\.\d+)?)\")?([NS])", map_marks.arc_text(value, step, "NS"))
            read = int(parts[1]) + int(parts[2]) / 60.0 + float(parts[3] or 0.0) / 3600.0
            self.assertLess(int(parts[2]), 60)
            self.assertLess(float(parts[3] or 0.0), 60.0)
            self.assertAlmostEqual(read if parts[4] == "N" else -read, value, delta=1e-4 * step / 3600.0 + 1e-12)

    def test_lines_of_the_graticule_are_multiples_and_few(self):
        for span in np.geomspace(1e-6, 40.0, 60):
            step = map_marks.arc_step(span, 5)
            lines = map_marks.multiples(7.123, 7.123 + span, step)
            self.assertLessEqual(len(lines), 6)
            for line in lines:
                self.assertAlmostEqual(line * 3600.0 / step, round(line * 3600.0 / step), delta=1e-4)


class Frame(unittest.TestCase):
    @staticmethod
    def ecef(latitude_deg, longitude_deg, height):
        """WGS84: Hofmann-Wellenhof et al., GNSS, 2008, eq. 8.6."""
        a, b = 6378137.0, 6356752.314245
        latitude, longitude = math.radians(latitude_deg), math.radians(longitude_deg)
        n = a**2 / math.hypot(a * math.cos(latitude), b * math.sin(latitude))
        return np.array([(n + height) * math.cos(latitude) * math.cos(longitude), (n + height) * math.cos(latitude) * math.sin(longitude),
                         (b**2 / a**2 * n + height) * math.sin(latitude)])

    def test_what_lies_between_two_close_points_is_as_long_as_in_space(self):
        for latitude, longitude in ((45.0, 7.0), (-33.0, 151.0), (0.01, 0.0), (68.0, -179.9999)):
            frame = LocalFrame(table(latitude_deg=np.array([latitude]), longitude_deg=np.array([longitude]), height_m=np.array([100.0])))
            for away in (0.0, 0.02, 0.5):
                for dlat, dlon, up in ((1e-5, 0.0, 0.0), (0.0, 1e-4, 0.0), (3e-5, -2e-5, 3.0)):
                    a = (latitude + away, longitude + away, 100.0)
                    b = (a[0] + dlat, a[1] + dlon, 100.0 + up)
                    local = frame.north_east_up(*(np.array([one, two]) for one, two in zip(a, b)))
                    length = np.linalg.norm(local[:, 1] - local[:, 0])
                    true = np.linalg.norm(self.ecef(*b) - self.ecef(*a))
                    converging = abs(local[1, 0] * math.tan(math.radians(latitude))) / 6.37e6
                    self.assertAlmostEqual(length, true, delta=(2e-4 + converging) * true)

    def test_the_inverse_of_the_graticule_comes_back(self):
        frame = LocalFrame(table(latitude_deg=np.array([48.0]), longitude_deg=np.array([11.0]), height_m=np.array([500.0])))
        latitude, longitude = frame.latitude_longitude_deg(np.array([-3000.0, 20000.0]), np.array([500.0, -10000.0]))
        north, east, _ = frame.north_east_up(latitude, longitude, 500.0)
        np.testing.assert_allclose(north, (-3000.0, 20000.0), atol=1e-6)
        np.testing.assert_allclose(east, (500.0, -10000.0), atol=1e-6)


class View(unittest.TestCase):
    def extent(self, north, east, sigma=1.0, speed=None, truth=None):
        size = len(north)
        one = table(std_north_m=np.broadcast_to(sigma, size) + 0.0, std_east_m=np.broadcast_to(sigma, size) + 0.0,
                    **({} if speed is None else {"v_north_m_s": np.broadcast_to(speed, size) + 0.0, "v_east_m_s": np.zeros(size)}))
        return map_view.extent([(north, east, one)], truth)

    def assert_shows(self, box, north, east):
        self.assertTrue(np.all((east > box[0]) & (east < box[1]) & (north > box[2]) & (north < box[3])), box)

    def test_a_whole_drive_is_shown_also_of_a_vehicle_that_mostly_stood(self):
        way = np.concatenate([np.zeros(5000), np.arange(100) * 20.0])
        speed = np.where(np.arange(5100) < 5000, 0.0, 20.0)
        noise = np.random.default_rng(1).normal(size=5100)
        self.assert_shows(self.extent(way + noise, noise[::-1], speed=speed), way, 0.0 * way)

    def test_single_outliers_do_not_shrink_the_map(self):
        north, east = np.arange(300) * 10.0, np.zeros(300)
        plain = self.extent(north, east, speed=10.0)
        for some in ((100,), (100, 101), (5, 150, 298)):
            bad = north.copy()
            bad[list(some)] += 50000.0
            np.testing.assert_allclose(self.extent(bad, east, speed=10.0), plain, atol=20.0)
            np.testing.assert_allclose(self.extent(bad, east), plain, atol=20.0)  # speed not known
        station = np.random.default_rng(2).normal(size=(2, 300)) * 0.02
        bad = station[0].copy()
        bad[77] = 900.0
        self.assertLess(np.ptp(self.extent(bad, station[1], sigma=0.02)[2:]), 1.0)

    def test_a_drift_with_its_sigma_does_not_shrink_it_and_close_positions_are_shown(self):
        north, east, sigma = np.arange(400) * 10.0, np.zeros(400), np.ones(400)
        east[150:350] = 25.0 * np.arange(200.0)  # no step tells: only its sigma does
        sigma[150:350] = 1.0 + np.arange(200.0)
        self.assertLess(np.ptp(self.extent(north, east, sigma, speed=10.0)[:2]), 4000.0)
        east[150:350], sigma[150:350] = 0.0, 1.0
        sigma[200:230] = np.arange(30.0) ** 3
        east[200:230] = 30.0 * np.arange(30.0)
        self.assert_shows(self.extent(north, east, sigma, speed=10.0), north, east)

    def test_the_truth_is_shown_whole_and_the_shape_suits_a_page(self):
        truth = np.array([np.linspace(-4000.0, 100.0, 50), np.linspace(0.0, 900.0, 50)])
        box = self.extent(np.arange(5.0), np.arange(5.0), truth=truth)
        self.assert_shows(box, *truth)
        for north, east in ((np.arange(100.0), np.zeros(100)), (np.zeros(100), np.arange(100.0)), (np.zeros(100), np.zeros(100))):
            west, right, south, top = self.extent(north, east)
            self.assertTrue(0.74 < (right - west) / (top - south) < 1.71)


class Sky(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.made = read_run(str(WORK), "LEONAV_", quiet)
        cls.tracks = {one.satellite: one for one in sky.sky_tracks(cls.made.satellites)}

    def test_tracks_are_those_of_the_run_and_lost_epochs_lie_behind_the_house(self):
        written = {}
        for name, epoch, azimuth, elevation, reason in made_run.satellites():
            written.setdefault(name, {})[epoch] = (azimuth, elevation, reason)
        self.assertEqual(set(self.tracks), set(made_run.SKY))
        kinds = {"used": "used", "downweighted": "weakened", "outlier": "rejected", "low_elevation": "left out"}
        for name, track in self.tracks.items():
            azimuth0, elevation0, azimuth_rate, elevation_rate = made_run.SKY[name]
            epochs = np.rint(track.time - track.time[0]).astype(int) + min(written[name])
            for epoch, azimuth, elevation, kind in zip(epochs, track.azimuth, track.elevation, track.kind):
                self.assertAlmostEqual((azimuth - azimuth0 - epoch * azimuth_rate + 180.0) % 360.0 - 180.0, 0.0, delta=0.02)
                self.assertAlmostEqual(elevation, elevation0 + epoch * elevation_rate, delta=0.02)
                self.assertEqual(kind, kinds[written[name][epoch][2]] if epoch in written[name] else "lost")
        self.assertGreater(sum(int((one.kind == "lost").sum()) for one in self.tracks.values()), 500)

    def test_the_horizon_is_that_of_the_house(self):
        azimuth, elevation, share = sky.lost_share(self.tracks.values())
        top = sky.horizon(azimuth, elevation, share)
        behind = (azimuth[:-1] >= made_run.HOUSE[0]) & (azimuth[1:] <= made_run.HOUSE[1])
        self.assertTrue(np.isnan(top[~behind]).all())
        self.assertEqual(np.isfinite(top[behind]).sum(), behind.sum())
        self.assertTrue((top[behind] <= made_run.HOUSE[2]).all())
        self.assertEqual(top[behind].max(), made_run.HOUSE[2])
        self.assertTrue((np.nan_to_num(share[~behind]) == 0.0).all())
        low = elevation[1:] <= made_run.HOUSE[2]
        inside = share[np.ix_(behind, low)]
        self.assertTrue(0.6 < np.nanmedian(inside) < 0.8)  # seven of ten epochs

    def test_epochs_without_any_satellite_and_satellites_that_were_left_out_are_not_lost(self):
        time = np.concatenate([np.arange(10.0), np.arange(40.0, 50.0)])
        made = table(gps_tow_s=np.repeat(time, 2), satellite=np.array(["G01", "G02"] * 20, dtype=object), azimuth_deg=np.full(40, 359.0),
                     elevation_deg=np.full(40, 30.0), reason=np.array(["used", "unhealthy"] * 20, dtype=object))
        tracks = sky.sky_tracks(made)
        self.assertEqual([set(one.kind) for one in tracks], [{"used"}, {"left out"}])
        _, _, share = sky.lost_share(tracks)
        self.assertEqual((np.nanmax(share), np.isfinite(share).sum()), (0.0, 1))

    def test_a_satellite_that_passes_north_turns_on_instead_of_back(self):
        made = table(satellite=np.array(["L01"] * 4, dtype=object), azimuth_deg=np.array([350.0, 358.0,
                     6.0, 14.0]), elevation_deg=np.full(4, 50.0), reason=np.array(["used"] * 4, dtype=object))
        np.testing.assert_allclose(np.diff(sky.sky_tracks(made)[0].azimuth), 8.0)


class Numbers(unittest.TestCase):
    def test_gaps_are_found_and_jitter_is_none(self):
        time = np.arange(1000) * 0.1 + np.random.default_rng(3).uniform(-0.02, 0.02, 1000)
        self.assertEqual(len(gaps(time)), 0)
        cut = np.delete(time, np.arange(300, 350))
        np.testing.assert_allclose(gaps(cut), [[time[299], time[350]]])
        self.assertEqual(len(gaps(cut, shortest_s=10.0)), 0)
        self.assertEqual(gaps(time[:2]).shape, (0, 2))

    def test_durations_and_times_are_for_people(self):
        for seconds, text in ((0.012, "0.012 s"), (9.94, "9.9 s"), (59.6, "60 s"),
                              (200.0, "3 min 20 s"), (3599.6, "1 h 00 min"), (7500.0, "2 h 05 min")):
            self.assertEqual(style.duration(seconds), text)
        self.assertEqual(style.clock_text(3725.0, True), "1:02:05")
        self.assertEqual(style.clock_text(59.9, False), "1:00")
        # GPS time was 18 s ahead of UTC in 2022; week 2200 began on 2022-03-06.
        self.assertEqual(style.utc_text(2200 * 604800.0 + 18.0), "2022-03-06 00:00:00 UTC")

    def test_residuals_are_counted_by_kind_and_their_size_is_told(self):
        run = read_run(str(WORK), "LEONAV_", quiet)
        reasons = [row[5] for row in made_run.measurements() if row[2] == "code"]
        used, weakened, rejected = (sum(one in some for one in reasons)
                                    for some in (("used", "downweighted"), ("downweighted",), ("outlier",)))
        header, rows = numbers.residual_table(run)
        self.assertEqual([row[0] for row in rows], ["code", "carrier", "Doppler"])
        for row, sigma in zip(rows, (1.5, 0.01, 0.08)):
            self.assertEqual(row[1:4], [f"{used}", f"{weakened}", f"{rejected}"])
            self.assertAlmostEqual(float(row[5].split()[0]), 0.8 * sigma, delta=0.03 * sigma)
        self.assertEqual(rows[2][5].split()[1], "m/s")

    def test_errors_are_those_that_were_made(self):
        code, out, err = run_report("--truth", WORK / "truth.csv", f"run={WORK}", "-o", WORK / "errors.html")
        self.assertEqual((code, err), (0, ""))
        text = (WORK / "errors.html").read_text()
        self.assertIn("<td>epochs with a truth</td><td>588</td>", text)
        # Of the made noise, 1.11 m north and 0.95 m east, and one row 30 km off.
        made = np.array([row[2:5] for row in made_run.solutions()[0]]) - np.array([row[2:5] for row in made_run.solutions()[1] if not
                         made_run.GAP[0] <= row[1] - made_run.TOW < made_run.GAP[1]])
        self.assertAlmostEqual(float(re.search(r"vertical error: RMSE</td><td>([\d.]+) m", text)[1]), np.sqrt(np.mean(made[:, 2]**2)), delta=0.005)
        horizontal = np.hypot(111140.0 * made[:, 0], 78840.0 * made[:, 1])
        self.assertAlmostEqual(float(re.search(r"horizontal error: 95 %</td><td>([\d.]+) m", text)[1]), np.percentile(horizontal, 95), delta=0.01)
        largest = float(re.search(r"horizontal error: largest</td><td>([\d.e+]+) m", text)[1])
        self.assertAlmostEqual(largest, 0.27 * 111140.0, delta=100.0)

    def test_a_journal_gives_the_numbers_of_the_tables_and_what_they_lack(self):
        ours, theirs = read_run(str(journal()), "LEONAV_", quiet), read_run(str(WORK), "LEONAV_", quiet)
        self.assertEqual(ours.missing, [])
        for function in (numbers.residual_table, numbers.reason_table):
            self.assertEqual(function(ours), function(theirs))
        self.assertEqual(numbers.gap_table(ours, ours.solution.time[0]), numbers.gap_table(theirs, theirs.solution.time[0]))
        notes = {row.name: row.note for row in [timeline.health_row(ours), *timeline.miss_rows(ours), *timeline.input_rows(ours)]}
        self.assertEqual(notes, {"health": "OK 99 %, DEGRADED 1 %", "filter late": "0 of 600 missed the deadline",
                                 "smoother late": "6 of 600 missed the deadline", "IMU": "10 Hz, no gap", "GNSS": "1 Hz, 1 gap, 7 s"})
        self.assertEqual(numbers.health_table(ours)[1], [["DEGRADED", "INS only", "6"], ["DEGRADED", "smoother late", "6"]])
        late = next(row for row in timeline.miss_rows(ours) if row.name == "smoother late").ticks
        np.testing.assert_allclose(late - ours.solution.time[0], np.arange(50.0, 600.0, 100.0))
        add_journal(theirs, str(journal()), "LEONAV_", quiet)
        self.assertEqual((theirs.missing, len(theirs.health), len(theirs.solution)), ([], 600, 588))

    def test_a_journal_in_pieces_is_one_run_by_its_folder_and_by_its_first_piece(self):
        events = list(lcm_log.messages(journal()))
        folder = WORK / "pieces"
        folder.mkdir()

        def write(name, run, piece, first, last):
            mark = struct.pack(">8xqqiqqb", 0, piece, 1, run, first, 0)
            numbered = [(0, 0.0, "LEONAV_CONFIG", b""), (1, 0.0, "LEONAV_PIECE", mark)] + [(k + 2, *events[k]) for k in range(first - 2, last)]
            with open(folder / name, "wb") as log:
                for number, wall_s, channel, data in numbered:
                    log.write(lcm_log.HEADER.pack(0xEDA1DA01, number, round(wall_s * 1e6), len(channel), len(data)) + channel.encode() + data)
        half = len(events) // 2
        write("run", 5, 1, 2, half)
        write("run.part0002.kept", 5, 2, half + 2, len(events))
        (folder / "notes.txt").write_text("no log")
        whole = read_run(str(journal()), "LEONAV_", quiet)
        gaps_of_whole = numbers.gap_table(whole, whole.solution.time[0])
        for path in (folder, folder / "run"):
            run = read_run(str(path), "LEONAV_", quiet)
            self.assertEqual((run.missing, len(run.solution), len(run.health)), ([], len(whole.solution), len(whole.health)))
            self.assertEqual(numbers.gap_table(run, run.solution.time[0]), gaps_of_whole)
        self.assertEqual(read_run(str(folder), "LEONAV_", quiet).label, "pieces")
        tables = read_run(str(WORK), "LEONAV_", quiet)
        add_journal(tables, str(folder), "LEONAV_", quiet)
        self.assertEqual((tables.missing, len(tables.health)), ([], 600))
        (folder / "run").rename(folder / "run.kept")  # as after a fault: it is still found under its name
        self.assertEqual(len(read_run(str(folder / "run"), "LEONAV_", quiet).solution), len(whole.solution))
        write("other", 6, 1, 2, 20)
        self.assertRaisesRegex(ReportError, "several runs; give the first piece", read_run, str(folder), "LEONAV_", quiet)

    def test_a_span_ends_where_the_value_changes_or_the_series_pauses(self):
        spans = timeline.spans_of(np.array([0.0, 1.0, 2.0, 3.0, 20.0, 21.0]), np.array(["a", "a", "b", "b", "b", "a"], dtype=object),
                                  {"a": "red", "b": "blue"}, 2.5)
        self.assertEqual(spans, [(0.0, 2.0, "red"), (2.0, 5.5, "blue"), (20.0, 21.0, "blue"), (21.0, 21.0, "red")])


def texts_of(figure):
    """Every text that is drawn, with its box in pixels."""
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()
    found, hidden = [], set()
    for axis in (one for axes in figure.axes for one in (axes.xaxis, axes.yaxis)):
        low, high = sorted(axis.get_view_interval())
        for tick in axis.get_major_ticks() + axis.get_minor_ticks():
            if not low <= tick.get_loc() <= high:  # has a text, but is not drawn
                hidden |= {tick.label1, tick.label2}
    for one in figure.findobj(lambda artist: isinstance(artist, matplotlib.text.Text)):
        if one not in hidden and one.get_visible() and one.get_text().strip():
            found.append((one.get_text(), one.get_window_extent(renderer)))
    return found


class Pictures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.runs = [read_run(f"a run={WORK}", "LEONAV_", quiet), read_run(f"another={WORK}/solution.csv", "LEONAV_", quiet)]
        if (WORK / "run.journal").exists():
            add_journal(cls.runs[0], str(WORK / "run.journal"), "LEONAV_", quiet)
        cls.truth = command.Truth(str(WORK / "truth.csv"))
        cls.frame = LocalFrame(cls.truth.table)
        cls.errors = cls.truth.errors(cls.runs, cls.frame, 2.0)
        cls.start = cls.runs[0].solution.time[0]
        cls.offsets = [np.zeros((3, 1))] * 2

    def tearDown(self):
        matplotlib.pyplot.close("all")

    def map(self, color="source", runs=2, truth=True):
        return draw_map(self.runs[:runs], self.offsets[:runs], self.truth.table if truth else None, self.frame, color)

    def figures(self):
        for color in ("source", "sigma", "speed"):
            yield f"map by {color}", self.map(color)
        yield "map alone", self.map(runs=1, truth=False)
        yield "errors", error_pictures.draw_errors(self.runs, self.errors, self.start, 600.0)
        yield "cdf", error_pictures.draw_distribution(self.runs, self.errors)
        yield "satellites", accuracy_pictures.draw_satellites(self.runs, self.start, 600.0)
        yield "sigma", accuracy_pictures.draw_sigma(self.runs, self.errors, self.start, 600.0)
        for run in self.runs:
            yield "sky", draw_sky(run)
            yield "residuals", residual_pictures.draw_residuals(run, self.start)
            yield "residuals by satellite", residual_pictures.draw_residuals_by_satellite(run, self.start)
            yield "timeline", draw_timeline(run, self.start, 600.0)

    def test_no_text_covers_another(self):
        for name, figure in self.figures():
            texts = texts_of(figure)
            self.assertGreater(len(texts), 8, name)
            for index, (text, box) in enumerate(texts):
                for other, another in texts[:index]:
                    across = min(box.x1, another.x1) - max(box.x0, another.x0)
                    down = min(box.y1, another.y1) - max(box.y0, another.y0)
                    self.assertFalse(across > 1.0 and down > 1.0, f"{name}: '{text}' covers '{other}'")

    def test_every_axis_has_a_label_with_its_unit(self):
        for name, figure in self.figures():
            labels = " ".join(text for text, _ in texts_of(figure))
            for unit in {
    "map by source": (
        "east (m)", "north (m)"), "map by speed": (
            "speed (m/s)",), "map by sigma": (
                "sigma (m)",), "errors": (
                    "north (m)", "east (m)", "up (m)", "(min:s)"), "cdf": (
                        "error (m)", "(%)"), "sky": (
                            "epochs lost (%)",), "sigma": (
                                "horizontal (m)", "vertical (m)", "(min:s)"), "residuals": (
                                    "code (m)", "carrier (m)", "Doppler (m/s)")}.get(
                                        name, ()):
                self.assertIn(unit, labels, name)

    def test_the_map_has_equal_axes_scale_arrow_graticule_start_end_and_the_gap(self):
        figure = self.map()
        axis = figure.axes[0]
        texts = [text for text, _ in texts_of(figure)]
        for text in ("start", "end", "N", "13 s", "200 m" if "200 m" in texts else "100 m", "45°03'10\"N", "7°39'10\"E"):
            self.assertIn(text, texts)
        self.assertTrue(any(text.startswith("outside the map: 1 of a run, up to 29.") for text in texts), texts)
        box = axis.get_window_extent()
        self.assertAlmostEqual(
    box.width /
    np.ptp(
        axis.get_xlim()),
        box.height /
        np.ptp(
            axis.get_ylim()),
            delta=1e-3 *
            box.width /
            np.ptp(
                axis.get_xlim()))
        self.assertLess(np.ptp(axis.get_ylim()), 1500.0)
        # The parallel 45°03'10" N lies where the formula of the frame has it.
        north = self.frame.north_east_up(np.array([45 + 190 / 3600]), np.array([made_run.LONGITUDE]), made_run.HEIGHT)[0]
        self.assertTrue(any(np.allclose(line.get_ydata(), north, atol=0.5) for line in axis.lines if line.get_linestyle() == "--"))

    def test_the_scale_bar_is_as_long_as_it_says(self):
        axis = self.map().axes[0]
        ends = {text.get_text(): text.get_position()[0] for text in axis.texts if text.get_text() in ("0", "100 m", "200 m")}
        zero, (name, end) = ends.pop("0"), next(iter(ends.items()))
        self.assertAlmostEqual(end - zero, float(name.split()[0]), places=6)

    def test_nothing_is_drawn_through_a_gap_but_dashes(self):
        axis = self.map(runs=1, truth=False).axes[0]
        inside = 0
        for lines in axis.collections:
            for segment in lines.get_segments():
                inside += np.hypot(*(segment[1] - segment[0])) > 60.0
        self.assertEqual(inside, 0)

    def test_every_satellite_is_named_in_the_sky_and_in_the_residuals(self):
        for figure in (draw_sky(self.runs[0]), residual_pictures.draw_residuals_by_satellite(self.runs[0], self.start)):
            texts = [text for text, _ in texts_of(figure)]
            self.assertEqual([one for one in made_run.SKY if one not in texts], [])


class Reader(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.sources, self.open = [], []

    def handle_starttag(self, tag, attributes):
        self.sources += [value for name, value in attributes if name in ("src", "href")]
        if tag not in ("img", "meta"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        if self.open.pop() != tag:
            raise AssertionError(tag)


class Page(unittest.TestCase):
    PICTURES = ["track", "errors", "cdf", "satellites", "sigma", "timeline", "sky", "residuals", "residuals_by_satellite"]

    def read(self, path):
        reader = Reader()
        text = path.read_text()
        reader.feed(text)
        self.assertEqual(reader.open, [])
        written = re.sub(r'"data:image/png;base64,[^"]*"', "", text)
        self.assertFalse("http" in written, "the page refers to something outside")
        return reader, text

    def test_one_file_holds_everything(self):
        code, out, err = run_report("--truth", WORK / "truth.csv", f"<b>&run={WORK}", "-o", WORK / "new" / "one.html")
        self.assertEqual((code, out, err), (0, f"{WORK}/new/one.html\n", ""))
        self.assertEqual(sorted(one.name for one in (WORK / "new").iterdir()), ["one.html"])
        reader, text = self.read(WORK / "new" / "one.html")
        self.assertEqual(len(reader.sources), len(self.PICTURES))
        for source in reader.sources:
            data = base64.b64decode(source.removeprefix("data:image/png;base64,"), validate=True)
            self.assertTrue(data.startswith(b"\x89PNG\r\n") and data.endswith(b"IEND\xaeB`\x82"))
        self.assertIn("<h1>&lt;b&gt;&amp;run</h1>", text)

    def test_a_folder_holds_pictures_and_an_index_that_shows_them(self):
        code, out, _ = run_report("--truth", WORK / "truth.csv", WORK, "-o", WORK / "folder")
        self.assertEqual(code, 0)
        self.assertEqual(out.split(), [f"{WORK}/folder/{name}.png" for name in self.PICTURES] + [f"{WORK}/folder/index.html"])
        reader, _ = self.read(WORK / "folder" / "index.html")
        self.assertEqual(reader.sources, [f"{name}.png" for name in self.PICTURES])
        for name in reader.sources:
            self.assertGreater((WORK / "folder" / name).stat().st_size, 5000)

    def test_positions_alone_give_a_map_and_the_page_says_what_is_missing(self):
        alone = WORK / "alone"
        alone.mkdir()
        rows = (WORK / "solution.csv").read_text().splitlines()
        (alone / "solution.csv").write_text("\n".join(",".join(row.split(",")[:5]) for row in rows) + "\n")
        code, out, err = run_report(alone, "-o", alone / "r.html")
        self.assertEqual((code, err), (0, ""))
        reader, text = self.read(alone / "r.html")
        self.assertEqual(len(reader.sources), 3)  # map, satellites, timeline
        for sentence in ("no sky plot: no satellites.csv beside", "no residuals: no measurements.csv", "give it with --journal PATH"):
            self.assertIn(sentence, text)


    def test_what_is_only_predicted_is_a_gap_and_no_track(self):
        folder = WORK / "predicted"
        folder.mkdir()
        text = (WORK / "solution.csv").read_text()
        self.assertEqual(text.count(",ins,"), 20)
        (folder / "solution.csv").write_text(text.replace(",ins,", ",prediction,"))
        run, with_imu = read_run(str(folder), "LEONAV_", quiet), read_run(str(WORK), "LEONAV_", quiet)
        start, no_offset = run.solution.time[0], np.zeros((3, 1))
        tracks = [map_picture.Track(one, no_offset, LocalFrame(with_imu.solution)) for one in (run, with_imu)]
        everywhere = (-1e9, 1e9, -1e9, 1e9)
        rows = [track.segments(everywhere)[1] for track in tracks]
        self.assertEqual(len(rows[1]) - len(rows[0]), 20)
        self.assertNotIn("prediction", set(run.solution["source"][rows[0]]))
        # From the last epoch before the gap to the first one that is no prediction.
        self.assertEqual([track.gaps[0][1] - track.gaps[0][0] for track in tracks], [33.0, 13.0])
        self.assertEqual(numbers.gap_table(run, start)[1][0][2], "33 s")
        self.assertIn("prediction 3 %", timeline.answer_rows(run)[0].note)
        code, _, err = run_report(folder, "--truth", WORK / "truth.csv", "-o", folder / "r.html")
        self.assertEqual((code, err), (0, ""))
        # A run of nothing else is shown all the same.
        (folder / "solution.csv").write_text(re.sub(",(ins|ekf|smoother),", ",prediction,", text))
        code, _, err = run_report(folder, "-o", folder / "r.html")
        self.assertEqual((code, err), (0, ""))

    def test_what_leonav_smooth_wrote_is_a_run_with_its_own_sigmas(self):
        smoothed = WORK / "smoothed"
        smoothed.mkdir()
        shutil.copy(WORK / "solution.csv", smoothed)
        rows = [(2200, 345600 + epoch, "G05", "code", "1C", 0.5, 0.25, 2.0, weight, 40.0) for epoch, weight in enumerate((1.0, 0.4, 0.0) * 20)]
        (smoothed / "residuals.csv").write_text("gps_week,gps_tow_s,satellite,observable,signals,residual,sigma,test_ratio,weight_factor,"
                                                "elevation_deg\n" + "".join(",".join(map(str, row)) + "\n" for row in rows))
        run = read_run(str(smoothed), "LEONAV_", quiet)
        self.assertEqual(numbers.residual_table(run)[1], [["code", "40", "20", "20", "33.33 %", "0.5 m"]])
        labels = [text for text, _ in texts_of(residual_pictures.draw_residuals(run, run.solution.time[0]))]
        self.assertIn("3 sigma of the measurement, median", labels)
        self.assertTrue(any(text.startswith("3 sigma 0.75 m;") for text in labels), labels)


class Refusals(unittest.TestCase):
    def refused(self, *words):
        code, out, err = run_report(*words, "-o", WORK / "refused.html")
        self.assertEqual((code, out), (1, ""))
        self.assertFalse((WORK / "refused.html").exists())
        return err

    def made(self, name, data):
        path = WORK / name
        path.write_bytes(data if isinstance(data, bytes) else data.encode())
        return path

    def test_errors_name_the_file_the_line_and_the_remedy(self):
        header = "gps_week,gps_tow_s,latitude_deg,longitude_deg,height_m\n"
        for name, data, expected in (
                ("e1.csv", "", "e1.csv: the file is empty"),
                ("e2.csv", "a,b\n1,2\n", "e2.csv:1: no column 'gps_week'; give a solution.csv"),
                ("e3.csv", header, "e3.csv: no data below the header"),
                ("e4.csv", header + "2200,1,45,x,0\n", "e4.csv:2: 'x' is no number (longitude_deg)"),
                ("e5.csv", header + "2200,1,,,\n", "e5.csv: no row has a position; did the run end"),
                ("e6.csv", b"\xff\xfe\x00\x80", "e6.csv: is no text file; give"),
                ("e7.pos", "% nothing\n", "e7.pos: no solution with week"),
                ("e8.csv", header + "2200,-inf,45,7,0\n", "e8.csv: no row has a position")):
            self.assertIn(expected, self.refused(self.made(name, data)))
        self.assertIn("absent: No such file or directory; check the path", self.refused(WORK / "absent"))
        (WORK / "empty").mkdir()
        self.assertIn("neither solution.csv nor a journal's pieces in this folder; give the folder that leonav-replay",
                      self.refused(WORK / "empty"))
        self.assertIn("have no common time; is this the truth", self.refused(
            WORK, "--truth", self.made("t.csv", header + "2100,1,45,7,0\n")))
        self.assertIn("this is no LCM log, and no folder with the pieces of one; give --journal the journal",
                      self.refused(WORK, "--journal", WORK / "solution.csv"))
        self.assertIn("no folder with the pieces of one", self.refused(WORK, "--journal", WORK / "empty"))

    def test_an_output_that_cannot_be_written_is_an_error(self):
        self.made("file", "x")
        for out in (WORK / "file" / "r.html", WORK / "file"):
            code, _, err = run_report(WORK, "-o", out)
            self.assertEqual(code, 1)
            self.assertIn("give another --out", err)

    def test_a_log_of_inputs_is_told_from_a_journal(self):
        journal()
        import lcm_log as log
        inputs = [(stamp, channel, data) for stamp, channel, data in log.messages(
            WORK / "run.journal") if channel in ("LEONAV_IMU", "LEONAV_GNSS_EPOCH")]
        log.write(WORK / "inputs.lcmlog", inputs)
        self.assertIn("no SOLUTION with a position in this log; replay it with leonav-replay", self.refused(WORK / "inputs.lcmlog"))

    def test_a_damaged_journal_gives_what_is_good_and_says_so(self):
        data = bytearray(journal().read_bytes())
        middle = len(data) // 2
        data[middle:middle + 4000] = bytes(4000)
        code, _, err = run_report(self.made("damaged.journal", bytes(data)), "-o", WORK / "damaged.html")
        self.assertEqual(code, 0)
        self.assertIn("the log is damaged", err)
        self.assertIn("the log is damaged", (WORK / "damaged.html").read_text())

    def test_no_mutation_of_a_table_or_journal_ends_with_a_fault(self):
        dice = random.Random(4)
        folder = WORK / "mutated"
        folder.mkdir()
        good = {name: (WORK / name).read_bytes() for name in ("solution.csv", "satellites.csv", "measurements.csv", "events.csv")}
        short = {name: b"\n".join(data.split(b"\n")[:120]) for name, data in good.items()}
        shown = 0
        for damaged in [()] + [(name,) for name in short] + [tuple(short)] * 4:
            for name, data in short.items():
                bad = bytearray(data)
                for _ in range(dice.choice((1, 3, 30)) if name in damaged else 0):
                    bad[dice.randrange(len(bad))] = dice.choice(b"0123456789.,-e\n\xffnGx")
                (folder / name).write_bytes(bad)
            code, _, err = run_report(folder, "--color", dice.choice(("source", "sigma", "speed")), "-o", folder / "r.html")
            self.assertIn(code, (0, 1) if damaged else (0,), err)
            self.assertTrue(code == 0 or "mutated/" in err, err)
            shown += code == 0
        self.assertGreater(shown, 0)


if __name__ == "__main__":
    unittest.main()
