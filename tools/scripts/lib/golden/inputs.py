"""The inputs of the cases: recorded data as logs, simulated drives, edited logs, journals. They are made once and kept.

An input is a folder within the inputs folder. Programs are called in a scratch folder in which `in` is the inputs folder,
`data` the recorded data and `dataset` the files for leonav-import, so that no output contains another path.
"""
import os
import re
import shutil
import subprocess

import lcm_log
import mistakes

from golden import edits

# Configuration -> its preset.
CONFIGS = {"walk": "walk", "drive": "phone", "drive_ins": "phone_imu", "station": "station", "urban": "urban", "demo": "demo"}
PRESETS = ("car", "demo", "phone", "phone_imu", "realtime", "station", "urban", "walk")
SCENARIOS = ("open_sky", "urban", "leo_320", "leo_640", "creeping", "drive_overlay", "correlated")

DATASETS = {
    "walk": "name: walk\nobservations: [../data/walk/gnss.ubx]\nnavigation: [../data/walk/gnss.nav]\n"
            "imu: ../data/walk/imu.csv\ntruth: ../data/walk/truth.csv\n",
    "walk-rinex": "name: walk as RINEX\nobservations: [../data/walk/gnss.obs]\nnavigation: [../data/walk/gnss.nav]\n"
                  "imu: ../data/walk/imu.csv\n",
    "drive": "name: drive\nobservations: [../data/drive/gnss.obs]\nnavigation: [../data/drive/gps.nav]\n"
             "orbits: [../data/drive/COD0MGXFIN_20211180000_05M_ORB.SP3]\ntruth: ../data/drive/truth.csv\n",
    "drive-day": "name: drive with the day's messages\nobservations: [../data/drive/gnss.obs]\n"
                 "navigation: [../data/drive/gps_day.nav]\n",
    "drive-ins": "name: drive\nobservations: [../data/drive/gnss.obs]\nnavigation: [../data/drive/gps.nav]\n"
                 "orbits: [../data/drive/COD0MGXFIN_20211180000_05M_ORB.SP3]\nimu: ../in/drive-imu/imu.csv\n"
                 "truth: ../in/drive-imu/truth_attitude.csv\n",
    "station": "name: station\nobservations: [../data/station/ESBC00DNK_2020177_6H_30S.obs]\n"
               "navigation: [../data/station/ESBC00DNK_2020177.nav]\n"
               "orbits: [../data/station/GRG0MGXFIN_2020176_15M.sp3, ../data/station/GRG0MGXFIN_2020177_15M.sp3]\n"
               "clocks: [../data/station/GRG0MGXFIN_2020177_6H30_30S.clk]\n"
               "antenna_models: ../data/station/igs14_satellites_and_station.atx\n",
    "rover": "name: rover\nobservations: [../data/base_rover/SEPT265G.21O]\nnavigation: [../data/base_rover/SEPT2650.21P]\n",
}

MEMS = {"angle_random_walk_deg_per_sqrt_h": 0.3, "velocity_random_walk_m_s_per_sqrt_h": 0.1, "gyro_bias_deg_per_h": 1000,
        "gyro_bias_time_s": 1000, "accel_bias_mgal": 20000, "accel_bias_time_s": 1000, "gyro_scale_ppm": 5000,
        "gyro_scale_time_s": 10000, "accel_scale_ppm": 5000, "accel_scale_time_s": 10000}
MEMS_SETTINGS = [f"imu.{key}={value}" for key, value in MEMS.items()]
ALL = "systems: [gps, galileo, beidou, leo]"
TUNNELS = (f"faults=[{{kind: outage, from_s: 120, to_s: 150, {ALL}}}, {{kind: outage, from_s: 210, to_s: 250, {ALL}}}, "
           f"{{kind: outage, from_s: 300, to_s: 360, {ALL}, below_elevation_deg: 50}}]")
ODOMETER = ["odometer.rate_hz=10", "odometer.scale_error_percent=1.5", "odometer.resolution_m=0.05",
            "odometer.slip_percent_per_m_s2=0.2"]
FAULTS = "faults=[" + ", ".join((
    "{kind: satellite_clock, from_s: 60, to_s: 90, satellites: [G05, G12, E03, L12], jump_m: 40}",
    "{kind: satellite_clock, from_s: 70, to_s: 130, satellites: [C20, C21], drift_m_s: 2}",
    "{kind: outage, from_s: 100, to_s: 107, systems: [gps, galileo, beidou, leo]}",
    "{kind: bad_orbit, from_s: 120, to_s: 150, systems: [leo], along_m: 30}",
    "{kind: spoofing, from_s: 150, to_s: 190, systems: [gps], pull_m_s: 3, pull_time_s: 10}",
    "{kind: imu_gap, from_s: 200, to_s: 200.7}",
    "{kind: imu_gap, from_s: 215, to_s: 219}",
    "{kind: imu_saturation, from_s: 230, to_s: 240, gyro_limit_deg_s: 3, accel_limit_m_s2: 10}",
    "{kind: late, stream: gnss, from_s: 250, to_s: 258, delay_s: 0.4}",
    "{kind: late, stream: gnss, from_s: 262, to_s: 270, delay_s: 1.4}",
    "{kind: late, stream: imu, from_s: 280, to_s: 285, delay_s: 1.5}",
    "{kind: late, stream: imu, from_s: 290, to_s: 295, delay_s: 2.6}",
    "{kind: duplicate, stream: gnss, from_s: 300, to_s: 305}",
    "{kind: duplicate, stream: imu, from_s: 306, to_s: 308}",
    "{kind: receiver_reset, from_s: 315, to_s: 320}",
    "{kind: late, stream: products, from_s: 100, to_s: 330, delay_s: 120}")) + "]"
WAYPOINTS = ("route.waypoints=[{north_m: 0, east_m: 0, speed_m_s: 12}, {north_m: 300, east_m: 0, stop_s: 8}, "
             "{north_m: 300, east_m: 200, speed_m_s: 20}, {north_m: 700, east_m: 260, up_m: 12, stop_s: 15}]")
# The same drive at three places, 2 km and 10 m apart: measurements that suddenly come from another place.
ELSEWHERE = ["duration_s=320", "route.standing_s=20", "satellites.beidou.enabled=false"]
CITY = ["places=city", "route.standing_s=20"]
GEODETIC = ["imu.enabled=false", "receiver.lever_arm_b_m=[0, 0, 0]"]


class Simulation:
    def __init__(self, scenario, *settings, seed=1, options=(), route=False):
        self.scenario, self.settings, self.seed, self.options, self.route = scenario, settings, seed, options, route

    def words(self, out):
        """The command. The scenario and its route are inputs as well."""
        words = ["leonav-sim", f"in/{self.needs()[0]}/{self.scenario}.yaml", "--seed", str(self.seed)]
        for setting in self.settings:
            words += ["--set", setting]
        for option in self.options:
            words.append(option.replace("{out}", out))
        return words + ["-o", f"{out}/run.lcmlog", "--truth", f"{out}/truth.csv"]

    def needs(self):
        return ["parking-route"] if self.route else ["scenario"]


SIMULATIONS = {
    "urban": Simulation("urban", "duration_s=400", "truth_interval_s=0.1", *CITY),
    "dense": Simulation("urban", "duration_s=400", "places=dense_city", "route.standing_s=0", seed=3),
    "open": Simulation("open_sky", "duration_s=300", "route.standing_s=20", "satellites.advance_s=7001", seed=2),
    "leo-320": Simulation("leo_320", "duration_s=300", "route.standing_s=0", seed=2),
    "leo-640": Simulation("leo_640", "duration_s=120", "route.standing_s=10", "imu.enabled=false", seed=4),
    "still": Simulation("open_sky", "duration_s=500", "route.standing_s=600", *GEODETIC, seed=5),
    "moving": Simulation("open_sky", "duration_s=400", "route.standing_s=10", *GEODETIC, seed=6),
    "tunnels": Simulation("urban", "duration_s=420", "truth_interval_s=0.1", *CITY, TUNNELS, *ODOMETER, seed=7),
    "tunnels-mems": Simulation("urban", "duration_s=420", "imu.grade=mems", *CITY, TUNNELS, *ODOMETER, seed=8),
    "places": Simulation(
        "urban", "duration_s=300", "route.standing_s=10", "odometer.rate_hz=5", "odometer.signed=false",
        "places=[{from_s: 40, place: suburban}, {from_s: 80, place: tunnel}, {from_s: 100, place: urban_canyon, "
        "house_height_m: 40}, {from_s: 150, place: viaduct}, {from_s: 200, place: woods}, {from_m: 2000, place: open_sky}]",
        seed=9),
    "faults": Simulation("open_sky", "duration_s=340", "route.standing_s=20", FAULTS, seed=10),
    "noisy": Simulation(
        "open_sky", "duration_s=240", "route.standing_s=10", "receiver.tracking.slips_per_hour=120", "receiver.multipath.code_m=3",
        "atmosphere.wave_tecu=3", "atmosphere.scintillation_tecu=0.1", "atmosphere.scintillation_db=2", "satellites.gps.told=broadcast",
        "satellites.beidou.told=broadcast", "satellites.leo.product_update_s=60", "imu.gyro_quantum_deg=0.001", seed=11),
    "jumps": Simulation(
        "open_sky", "duration_s=240", "route.standing_s=0", "receiver.clock.jumps=code", "receiver.clock.drift_ppb=10000",
        "receiver.clock.oscillator=ocxo", seed=12),
    "jumps-all": Simulation(
        "open_sky", "duration_s=240", "route.standing_s=0", "receiver.clock.jumps=code_and_carrier",
        "receiver.clock.drift_ppb=-10000", "receiver.interval_s=0.5", seed=13),
    "flight": Simulation("open_sky", "duration_s=240", "route.vehicle=uav", "route.standing_s=15", "imu.grade=mems", seed=14),
    "waypoints": Simulation("open_sky", "duration_s=150", "route.standing_s=5", WAYPOINTS, "ideal=true", "imu.rate_hz=100", seed=15),
    "creeping": Simulation("creeping", "duration_s=420", seed=16),
    "misplaced": Simulation(
        "open_sky", "duration_s=420", "route.hill_m=25", "route.standing_s=30", "imu.mounting_rpy_deg=[5, -5, 5]",
        "imu.time_offset_ms=40", "receiver.lever_arm_b_m=[0.8, -0.6, -0.8]", seed=17),
    "parking": Simulation("parking", "duration_s=300", "places=city", "imu.grade=mems", seed=18, route=True),
    "first-run": Simulation("urban", "duration_s=120", "route.standing_s=10", "places=city", "receiver.lever_arm_b_m=[0.8, -0.6, -1.1]",
                            "satellites.beidou.enabled=false"),
    "short": Simulation("urban", "duration_s=150", *CITY, "satellites.beidou.enabled=false", *ODOMETER, seed=19),
    "here": Simulation("open_sky", *ELSEWHERE, seed=22),
    "there": Simulation("open_sky", *ELSEWHERE, "route.origin_latitude_deg=39.9245", seed=22),
    "near": Simulation("open_sky", *ELSEWHERE, "route.origin_latitude_deg=39.9066", seed=22),
    "long-outages": Simulation(
        "open_sky", "duration_s=420", "route.standing_s=20", "imu.grade=mems", "satellites.beidou.enabled=false",
        f"faults=[{{kind: outage, from_s: 60, to_s: 200, {ALL}}}, {{kind: outage, from_s: 230, to_s: 370, {ALL}}}]", seed=23),
    "fast-imu": Simulation("open_sky", "duration_s=180", "route.standing_s=10", "imu.rate_hz=500", "receiver.interval_s=10",
                           "satellites.beidou.enabled=false", seed=24),
    "correlated": Simulation("correlated", "duration_s=300", "route.standing_s=20", seed=25),
    "files": Simulation("open_sky", "duration_s=120", "route.standing_s=10", seed=20, options=["--export", "{out}"]),
    "files-as-gps": Simulation("open_sky", "duration_s=60", "route.standing_s=10", "imu.enabled=false", seed=21,
                               options=["--export", "{out}", "--leo-as-gps"]),
}
# Laid over the recorded drive: (log below, settings).
OVERLAYS = {
    "drive-leo": ("drive", []),
    "drive-ins-leo": ("drive-ins", ["satellites.advance_s=7001", "faults=[{kind: outage, systems: [galileo]}]"]),
}
# Needed by no other case than that of leonav-sim itself.
SIMULATED_ALONE = ("files-as-gps", "waypoints")
FROM_THERE, FROM_NEAR = [(100.0, 130.0), (200.0, 260.0)], [(80.0, 320.0)]


def overlay_words(name, out):
    below, settings = OVERLAYS[name]
    words = ["leonav-sim", "in/scenario/drive_overlay.yaml"]
    for setting in settings:
        words += ["--set", setting]
    return words + ["--overlay", f"in/{below}/run.lcmlog", "--truth", "data/drive/truth.csv", "-o", f"{out}/run.lcmlog"]


def import_words(dataset, out, *options):
    return ["leonav-import", f"dataset/{dataset}.yaml", "-o", f"{out}/run.lcmlog", *options]


class InputError(Exception):
    pass


class Input:
    def __init__(self, make, needs=(), data=(), programs=(), live=False):
        self.make, self.needs, self.data, self.programs, self.live = make, tuple(needs), tuple(data), tuple(programs), live


def command_input(words_for, needs=(), data=()):
    """Made by one program: words_for(folder)."""
    return Input(lambda maker, out: maker.call(words_for(out)), needs, data, (words_for("x")[0],))


def edited_input(source, change):
    """The log of another input, changed: change(messages, maker)."""
    def make(maker, out):
        messages = lcm_log.messages(maker.path(source, "run.lcmlog"))
        lcm_log.write(os.path.join(maker.scratch, out, "run.lcmlog"), change(messages, maker))
    return Input(make, (source,))


def all_hit(system, number):
    return True


# As test/scenario/spoiled_epochs_test.cc: first epoch, how many, whom, noise in m, s late.
SPOILED = {
    "station-gps-7km": (495, 1, lambda s, n: s == edits.GPS, 7155.0, 0.0),
    "station-half-9km": (495, 1, lambda s, n: n % 2 == 0, 9000.0, 0.0),
    "station-all-70m": (495, 3, all_hit, 70.0, 0.0),
    "station-galileo-5m": (495, 2, lambda s, n: s == edits.GALILEO, 5.0, 0.0),
    "station-late-100ms": (495, 3, all_hit, 0.0, 0.1),
    "station-late-5ms": (495, 3, all_hit, 0.0, 0.005),
}


def with_commands(messages, maker):
    truth = edits.rows_of_truth(maker.path("short", "truth.csv"))
    at = [(4.0, *edits.command(1, edits.SET_HEADING, edits.heading_at(truth, 4.0), 0.05)),
          (60.0, *edits.command(2, edits.RESTART)),
          (61.0, *edits.command(3, edits.SET_HEADING, edits.heading_at(truth, 61.0) + 0.5, 0.1)),
          (90.0, *edits.command(4, edits.SET_HEADING, edits.heading_at(truth, 90.0), 0.02)),
          (110.0, *edits.command(5, edits.SET_HEADING, 20.0, -1.0)),
          (120.0, *edits.command(6, edits.RESTART))]
    return edits.inserted(messages, at)


def with_checkpoint(**how):
    def change(messages, maker):
        truth = edits.rows_of_truth(maker.path("urban", "truth.csv"))
        return edits.inserted(edits.up_to_second(messages, 120.0), [(0.0, *edits.checkpoint(truth, **how))])
    return change


CHECKPOINTS = {
    "used": dict(age_s=3600.0),
    "turned": dict(age_s=3600.0, turned_rad=1.0),
    "elsewhere": dict(age_s=3600.0, moved_m=300.0),
    "old": dict(age_s=4e6),
    "later": dict(age_s=-500.0),
    "moving": dict(age_s=3600.0, standing=False),
}


def make_texts(folder, names):
    """Copies of the texts in the repository."""
    def make(maker, out):
        for name in names:
            source = os.path.join(maker.root, folder, f"{name}.yaml")
            if not os.path.exists(source):
                raise InputError(f"{source} is not there; tools/scripts/lib/golden/inputs.py says where texts are looked for")
            shutil.copyfile(source, os.path.join(maker.scratch, out, f"{name}.yaml"))
    return make


def make_configs(maker, out):
    """What each preset changes. Not every key: there `by_kind` is resolved already, and vehicle.kind=car would change nothing."""
    for name, preset in CONFIGS.items():
        with open(os.path.join(maker.scratch, out, f"{name}.yaml"), "w") as file:
            # The cases set the smoother themselves.
            file.write(maker.call(["leonavd", "--check", "--changes", "--preset", preset, "--set", "estimator=ekf"]))
    if fault := fault_of_configs(os.path.join(maker.scratch, out)):
        raise InputError(fault)


def fault_of_configs(folder):
    """Why the cases of a car would drive no car with these configurations; empty: they do."""
    for name in CONFIGS:
        with open(os.path.join(folder, f"{name}.yaml")) as file:
            if found := re.search(r"(?m)^ *non_holonomic: (true|false)", file.read()):
                return f"{name}.yaml fixes {found[0].strip()}, so that vehicle.kind=car does not constrain the motion"
    return ""


def make_parking(maker, out):
    folder = os.path.join(maker.scratch, out)
    with open(os.path.join(folder, "parking.csv"), "w") as file:
        subprocess.run([os.path.join(maker.lib, "parking-route"), "1", "310"], stdout=file, check=True)
    with open(os.path.join(folder, "parking.yaml"), "w") as file:
        file.write("name: parking\nroute: {file: parking.csv}\n")


def make_drive_imu(maker, out):
    maker.call(["leonav-imu-from-truth", "--truth", "data/drive/truth.csv", "--out", f"{out}/imu.csv",
                "--truth-out", f"{out}/truth_attitude.csv"])


def make_results(maker, out):
    """Tables of runs, for leonav-eval."""
    for name, words in (("urban", ["--config", "in/config/urban.yaml", "in/urban/run.lcmlog"]),
                        ("urban-gps", ["--config", "in/config/urban.yaml", "--set", "gnss.systems=[gps]", "in/urban/run.lcmlog"])):
        maker.call(["leonav-replay", *words, "--out", f"{out}/{name}"])


def make_walk_result(maker, out):
    maker.call(["leonav-replay", "--config", "in/config/walk.yaml", "in/walk/run.lcmlog", "--out", f"{out}/walk"])


def make_refusals(maker, out):
    texts = {
        "unknown-key.yaml": "# a comment\ngnss:\n  elevation_mask_dge: 10\n",
        "wrong-kind.yaml": "vehicle:\n  kind: truck\n",
        "out-of-range.yaml": "smoother:\n  window: 61\n",
        "twice.yaml": "gnss:\n  elevation_mask_deg: 10\n  elevation_mask_deg: 12\n",
        "no-yaml.yaml": "gnss: [1, 2\nvehicle: }\n",
        "scenario.yaml": "duration_s: 60\nroute:\n  vehikle: car\n",
        "fault.yaml": "duration_s: 60\nfaults: [{kind: late, stream: imo}]\n",
        "dataset.yaml": "name: s\nobservatoins: a.obs\n",
        "absent.yaml": "name: s\nobservations: absent.obs\n",
        "text.lcmlog": "this is not an event log, but long enough to be one\n",
        "empty.lcmlog": "",
    }
    folder = os.path.join(maker.scratch, out)
    for name, text in texts.items():
        with open(os.path.join(folder, name), "w") as file:
            file.write(text)
    messages = list(edits.up_to_second(lcm_log.messages(maker.path("first-run", "run.lcmlog")), 30.0))
    for name, left_out in (("no-imu", edits.IMU), ("no-gnss", edits.EPOCH), ("no-ephemeris", "LEONAV_EPHEMERIS")):
        kept = [m for m in messages if m[1] != left_out and not (name == "no-ephemeris" and m[1] == "LEONAV_ORBIT_CLOCK")]
        lcm_log.write(os.path.join(folder, name + ".lcmlog"), kept)


def journal_input(source, config, speed, *settings, misses=None):
    """The journal of a leonavd to which a log is played. `misses`: the count of leonav-replay that must not be zero."""
    def make(maker, out):
        folder = os.path.join(maker.scratch, out)
        for attempt in range(4):
            journal = f"{out}/run.lcmlog"
            for name in os.listdir(folder):
                os.remove(os.path.join(folder, name))
            words = [w for s in settings for w in ("--set", s)]
            # A machine that other work keeps busy may lose messages: slower each time.
            maker.live(config, f"in/{source}/run.lcmlog", journal, speed / (1 + attempt), words)
            text = maker.call(["leonav-replay", journal, "--verify", "--out", f"{out}-replay"])
            shutil.rmtree(os.path.join(maker.scratch, f"{out}-replay"))
            found = re.search(rf"^{misses}: (\d+)$", text, re.M) if misses else None
            if misses is None or (found and int(found[1]) > 0):
                return
        raise InputError(f"the journal of {source} came to hold no {misses}")
    return Input(make, (source, "config"), programs=("leonavd", "leonav-replay"), live=True)


def make_cut_journal(maker, out):
    with open(maker.path("journal-ekf", "run.lcmlog"), "rb") as file:
        whole = file.read()
    with open(os.path.join(maker.scratch, out, "run.lcmlog"), "wb") as file:
        file.write(whole[:len(whole) * 6 // 10])


def build():
    """{name: Input}, in an order in which each comes behind what it needs."""
    inputs = {
        "config": Input(make_configs, programs=("leonavd",)),
        "scenario": Input(make_texts("config/scenario", SCENARIOS)),
        "parking-route": Input(make_parking),
    }
    for name in ("walk", "walk-rinex", "drive", "drive-day", "station", "rover"):
        data = "base_rover" if name == "rover" else name.split("-")[0]
        inputs[name] = command_input(lambda out, n=name: import_words(n, out), data=(data,))
    inputs["drive-imu"] = Input(make_drive_imu, data=("drive",), programs=("leonav-imu-from-truth",))
    inputs["drive-ins"] = command_input(lambda out: import_words("drive-ins", out), ("drive-imu",), ("drive",))
    for name in OVERLAYS:
        inputs[name] = command_input(lambda out, n=name: overlay_words(n, out), ("scenario", OVERLAYS[name][0]), ("drive",))
    for name, simulation in SIMULATIONS.items():
        if name not in SIMULATED_ALONE:
            inputs[name] = command_input(simulation.words, simulation.needs())
    for name, (first, count, hit, noise_m, late_s) in SPOILED.items():
        inputs[name] = edited_input("station", lambda m, _, a=(first, count, hit, noise_m, late_s): edits.spoiled(m, *a))
    inputs["commands"] = edited_input("short", with_commands)
    for name, how in CHECKPOINTS.items():
        inputs[f"checkpoint-{name}"] = edited_input("urban", with_checkpoint(**how))
    inputs["late-start"] = edited_input("urban", lambda m, _: edits.from_second(m, 200.0))
    inputs["jitter"] = edited_input("short", lambda m, _: edits.jittered(m, 0.4))
    inputs["jitter-strong"] = edited_input("short", lambda m, _: edits.jittered(m, 0.8))
    inputs["bursts"] = edited_input("short", lambda m, _: edits.in_bursts(m, 0.016))
    inputs["leap"] = edited_input("urban", lambda m, _: edits.pieces(m, (0.0, 90.0), (200.0, 290.0)))
    inputs["leap-back"] = edited_input("urban", lambda m, _: edits.pieces(m, (200.0, 290.0), (60.0, 150.0)))
    inputs["damaged"] = edited_input("short", lambda m, _: edits.damaged(m))
    inputs["damaged-gnss-only"] = edited_input("moving", lambda m, _: edits.damaged(m))
    for name, other, spans, codes_alone in (("elsewhere", "there", FROM_THERE, False), ("elsewhere-near", "near", FROM_NEAR, True)):
        def displace(maker, out, other=other, spans=spans, codes_alone=codes_alone):
            here, there = (lcm_log.messages(maker.path(n, "run.lcmlog")) for n in ("here", other))
            lcm_log.write(os.path.join(maker.scratch, out, "run.lcmlog"), edits.elsewhere(here, there, spans, codes_alone))
        inputs[name] = Input(displace, ("here", other))
    inputs["codes-shifted"] = edited_input("here", lambda m, _: edits.codes_shifted(m, [(90.0, 170.0), (220.0, 320.0)], 3000.0))
    inputs["in-stages"] = edited_input("here", lambda m, _: edits.in_stages(m, 25.0, 60.0))
    inputs["in-stages-gnss-only"] = edited_input("moving", lambda m, _: edits.in_stages(m, 25.0, 60.0))
    inputs["in-stages-dopplers-last"] = edited_input("moving", lambda m, _: edits.in_stages(m, 40.0, 20.0))
    inputs["in-stages-dopplers-of-others"] = edited_input("moving", lambda m, _: edits.in_stages(m, 40.0, 20.0, (edits.GPS,)))
    inputs["wild-stamps"] = edited_input("short", lambda m, _: edits.wild_stamps(m))
    inputs["wild-stamps-gnss-only"] = edited_input("moving", lambda m, _: edits.wild_stamps(m))
    inputs["leap-gnss-only"] = edited_input("moving", lambda m, _: edits.pieces(m, (0.0, 90.0), (200.0, 290.0), (60.0, 150.0)))
    inputs["products-stop"] = edited_input("station", lambda m, _: edits.without_products(m, 3600.0, 10_800.0))
    inputs["products-late"] = edited_input("open", lambda m, _: edits.without_products(m, -1e9, 60.0))
    for mistake in mistakes.MISTAKES:
        def make(maker, out, mistake=mistake):
            mistakes.write_mistaken(mistake, maker.path("first-run", "run.lcmlog"), os.path.join(maker.scratch, out, "run.lcmlog"))
        inputs[f"mistake-{mistake}"] = Input(make, ("first-run",))
    inputs["results"] = Input(make_results, ("urban", "config"), programs=("leonav-replay",))
    inputs["walk-result"] = Input(make_walk_result, ("walk", "config"), programs=("leonav-replay",))
    inputs["refusals"] = Input(make_refusals, ("first-run",))
    inputs["journal-walk"] = journal_input("walk", "walk", 10)
    inputs["journal-ekf"] = journal_input("short", "urban", 10, "gnss.systems=[gps, galileo, leo]", "realtime.deadline_ekf_ms=6",
                                          "vehicle.kind=car", misses="deadline misses")
    inputs["journal-smoother"] = journal_input("short", "urban", 5, "gnss.systems=[gps, leo]", "estimator=smoother",
                                               "drill.late_solve_every=3", "drill.late_solve_ms=160",
                                               misses="smoother deadline misses")
    inputs["journal-smoother-full"] = journal_input("short", "urban", 10, "gnss.systems=[gps, leo]", "estimator=smoother",
                                                    "drill.late_solve_every=40", "drill.late_solve_ms=3000",
                                                    misses="keyframes skipped")
    inputs["journal-commands"] = journal_input("commands", "urban", 10, "gnss.systems=[gps, galileo, leo]", "vehicle.kind=car",
                                               "estimator=smoother")
    inputs["journal-checkpoint"] = journal_input("checkpoint-used", "urban", 10, "gnss.systems=[gps]", "vehicle.kind=car")
    inputs["journal-cut"] = Input(make_cut_journal, ("journal-ekf",))
    inputs["journal-ekf-third"] = edited_input("journal-ekf", lambda m, _: edits.decisions_missed(m, 3))
    inputs["journal-smoother-half"] = edited_input("journal-smoother", lambda m, _: edits.decisions_missed(m, 2))
    return inputs


INPUTS = build()
