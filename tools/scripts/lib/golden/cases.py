"""The list of cases. A case is a list of commands; everything that they write is compared."""
from golden import inputs
from golden.inputs import MEMS_SETTINGS, SIMULATIONS


class Case:
    """`commands` are run one after the other; {out} is the folder of the case. `data`: the recorded data they read."""

    def __init__(self, name, commands, needs=(), data=(), quick=False):
        self.name, self.commands, self.needs, self.data, self.quick = name, commands, tuple(needs), tuple(data), quick
        self.programs = tuple(sorted({words[0] for words in commands}))


def with_settings(settings):
    return [w for s in settings for w in ("--set", s)]


def log_of(name):
    return f"in/{name}/run.lcmlog"


CASES = []


def add(*args, **named):
    CASES.append(Case(*args, **named))


def replay(name, log, config, *settings, options=(), quick=False):
    """config None: the one that the journal holds."""
    words = ["leonav-replay"]
    if config:
        words += ["--config", f"in/config/{config}.yaml"]
    words += [*with_settings(settings), *options, log_of(log), "--out", "{out}"]
    add(f"replay/{name}", [words], [log] + (["config"] if config else []), quick=quick)


def replays(name, log, config, variants, quick=()):
    """{variant: settings}"""
    for variant, settings in variants.items():
        replay(f"{name}/{variant}", log, config, *settings, quick=variant in quick)


SMOOTHER = "estimator=smoother"
CAR = "vehicle.kind=car"
GPS, GPS_LEO, LEO = "gnss.systems=[gps]", "gnss.systems=[gps, leo]", "gnss.systems=[leo]"
NO_BEIDOU = "gnss.systems=[gps, galileo, leo]"
NO_IMU = "ekf.motion=constant_velocity"
FREE = [NO_IMU, "ekf.acceleration_noise_horizontal_m_s2_per_sqrt_hz=100", "ekf.acceleration_noise_vertical_m_s2_per_sqrt_hz=100"]


def capped(number):
    return [f"gnss.{system}.max_satellites={number}" for system in ("gps", "galileo", "beidou", "leo")]


def recorded():
    replays("walk", "walk", "walk", {
        "ekf": [],
        "smoother": [SMOOTHER, "smoother.keyframe_interval_s=0.2"],
        "gps": [GPS],
        "gps-smoother": [GPS, SMOOTHER],
        "standstills": ["vehicle.zero_velocity=true"],
        "car": [CAR],
        "car-smoother": [CAR, SMOOTHER],
        "no-imu": [NO_IMU],
        "heading": ["alignment.initial_heading_deg=30", "alignment.initial_heading_sigma_deg=40"],
        "carriers": ["ekf.carrier=true"],
        "codes-alone": ["ekf.carrier=false"],
        "sine": ["gnss.weight_model=sine", "gnss.code_combination=single_frequency"],
    }, quick=("ekf", "smoother"))
    replay("walk/ekf-200-hz", "walk", "walk", options=["--rate", "200"])
    replay("walk/rinex", "walk-rinex", "walk")
    replays("drive", "drive", "drive", {
        "ekf": [],
        "smoother": [SMOOTHER],
        "gps": [GPS],
        "gps-smoother": [GPS, SMOOTHER],
        "codes-alone": ["ekf.carrier=false"],
        "not-robust": ["robust.enabled=false"],
        "two-of-each": capped(2),
        "broadcast": ["gnss.ephemerides.use_precise=false"],
        "ionosphere-free": ["gnss.code_combination=ionosphere_free", "gnss.weight_model=elevation"],
        "station": ["ekf.motion=static"],
    }, quick=("ekf", "gps-smoother"))
    replay("drive/messages-of-the-day", "drive-day", "drive")
    replays("drive-ins", "drive-ins", "drive_ins", {
        "ekf": [],
        "smoother": [SMOOTHER],
        "car": [CAR],
        "car-smoother": [CAR, SMOOTHER],
        "gps": [GPS],
        "codes-alone": ["ekf.carrier=false"],
        "not-robust": ["robust.enabled=false"],
        "one-of-each": capped(1),
    }, quick=("car",))
    replays("drive-leo", "drive-leo", "drive", {
        "gps": ["gnss.systems=[gps, leo]"],
        "all": ["gnss.systems=[gps, galileo, leo]"],
        "all-smoother": ["gnss.systems=[gps, galileo, leo]", SMOOTHER],
    })
    replays("drive-ins-leo", "drive-ins-leo", "drive_ins", {
        "ekf": ["gnss.systems=[gps, galileo, leo]"],
        "smoother": ["gnss.systems=[gps, leo]", SMOOTHER, CAR],
    })
    station_ca = [GPS, "gnss.gps.attributes=[C,W]", "gnss.gps.code_sigma_m=0.5"]
    loading = ", ".join(str(x) for x in (
        .00352, .00123, .00080, .00032, .00187, .00112, .00063, .00003, .00082, .00044, .00037,
        .00144, .00035, .00035, .00008, .00053, .00049, .00018, .00009, .00012, .00005, .00006,
        .00086, .00023, .00023, .00006, .00029, .00028, .00010, .00007, .00004, .00002, .00001,
        -64.7, -52.0, -96.2, -55.2, -58.8, -151.4, -65.6, -138.1, 8.4, 5.2, 2.1,
        85.5, 114.5, 56.5, 113.6, 99.4, 19.1, 94.1, -10.4, -167.4, -170.0, -177.7,
        109.5, 147.0, 92.7, 148.8, 71.0, 11.8, 71.5, -40.0, 10.2, 9.3, 1.9))
    replays("station", "station", "station", {
        "static": [],
        "static-smoother": [SMOOTHER],
        "static-gps": [GPS],
        "static-gps-ca": station_ca,
        "kinematic": FREE,
        "kinematic-smoother": [*FREE, SMOOTHER],
        "kinematic-gps": [*FREE, GPS],
        "kinematic-three-of-each": [*FREE, *capped(3)],
        "broadcast": ["gnss.ephemerides.use_precise=false", "gnss.systems=[gps, galileo, beidou]"],
        "single-frequency": ["gnss.code_combination=single_frequency", *FREE],
        "ocean-and-pole": [f"gnss.ocean_loading_coefficients=[{loading}]", "gnss.polar_motion_x_arcsec=0.15",
                           "gnss.polar_motion_y_arcsec=0.42"],
        "correlated": [*FREE, "ekf.code_correlation_time_s=60", "ekf.doppler_correlation_time_s=60"],
    }, quick=("static", "kinematic"))
    for name in inputs.SPOILED:
        replay(f"station-spoiled/{name[8:]}-static", name, "station")
        replay(f"station-spoiled/{name[8:]}-kinematic", name, "station", *FREE, quick=name == "station-all-70m")
    replay("station-spoiled/all-70m-kinematic-smoother", "station-all-70m", "station", *FREE, SMOOTHER)
    replays("rover", "rover", "urban", {
        "ekf": [NO_IMU],
        "smoother": [NO_IMU, SMOOTHER],
        "single-frequency": [NO_IMU, "gnss.code_combination=single_frequency", "gnss.weight_model=cn0"],
    })


def simulated():
    replays("city", "urban", "urban", {
        "ekf": [],
        "smoother": [SMOOTHER],
        "gps": [GPS],
        "gps-smoother": [GPS, SMOOTHER],
        "gps-leo": [GPS_LEO],
        "gps-leo-smoother": [GPS_LEO, SMOOTHER],
        "leo": [LEO],
        "car": [CAR],
        "car-smoother": [CAR, SMOOTHER, NO_BEIDOU],
        "rail": ["vehicle.kind=rail", GPS],
        "boat": ["vehicle.kind=boat", GPS],
        "no-imu": [NO_IMU],
        "no-imu-gps": [NO_IMU, GPS],
        "no-imu-gps-leo": [NO_IMU, GPS_LEO],
        "no-imu-smoother": [NO_IMU, SMOOTHER, NO_BEIDOU],
        "codes-alone": ["ekf.carrier=false", "ekf.wet_delay_sigma_m=0"],
        "codes-alone-smoother": ["ekf.carrier=false", "ekf.wet_delay_sigma_m=0", SMOOTHER, GPS_LEO],
        "not-robust": ["robust.enabled=false"],
        "not-robust-smoother": ["robust.enabled=false", SMOOTHER, GPS_LEO],
        "single-frequency": ["gnss.code_combination=single_frequency"],
        "cn0": ["gnss.weight_model=cn0", "gnss.cn0_mask_dbhz=32"],
        "correlated": ["ekf.code_correlation_time_s=20", "ekf.doppler_correlation_time_s=5"],
        "correlated-smoother": ["ekf.code_correlation_time_s=20", "ekf.doppler_correlation_time_s=5", SMOOTHER, GPS],
        "phone-clock": ["ekf.carrier_clock_noise_m_per_sqrt_s=30", "ekf.clock_offset_noise_m_per_sqrt_s=10"],
        "two-of-each": capped(2),
        "two-of-each-smoother": [*capped(2), SMOOTHER],
        "mems": [*MEMS_SETTINGS, CAR, GPS],
        "window-40": [SMOOTHER, GPS, "smoother.window=40", "smoother.keyframe_interval_s=0.5", "smoother.max_iterations=8"],
        "window-3": [SMOOTHER, GPS, "smoother.window=3", "smoother.reweigh=false"],
        "no-means": [SMOOTHER, GPS, "smoother.code_alike_s=0", "smoother.max_iterations=1"],
        "slow-keyframes": [SMOOTHER, GPS, "smoother.keyframe_interval_s=3.5"],
        "heading-told": ["alignment.initial_heading_deg=0", "alignment.initial_heading_sigma_deg=2"],
        "heading-told-wrong": ["alignment.initial_heading_deg=100", CAR],
        "course-alone": ["alignment.max_gyrocompass_sigma_deg=0", "alignment.course_window_s=3", "alignment.max_course_sigma_deg=20"],
        "yaw-steering": ["gnss.leo_attitude=yaw_steering", GPS_LEO],
        "wrong-arm": ["vehicle.lever_arm_b_m=[1, -0.5, 0.5]", "vehicle.estimate_lever_arm=true", "vehicle.lever_arm_sigma_m=2"],
    }, quick=("ekf", "gps", "gps-leo-smoother", "car-smoother", "no-imu-gps-leo", "codes-alone"))
    replay("city/50-hz", "urban", "urban", GPS, options=["--rate", "50"])
    replays("dense-city", "dense", "urban", {
        "ekf": [],
        "gps": [GPS],
        "gps-smoother": [GPS, SMOOTHER, CAR],
        "no-imu": [NO_IMU, GPS],
        "no-imu-smoother": [NO_IMU, GPS, SMOOTHER],
    })
    arm = "vehicle.lever_arm_b_m=[0.4, -0.2, -1.1]"
    replays("open-sky", "open", "demo", {
        "ekf": [arm, "gnss.systems=[gps, galileo, beidou, leo]", "ekf.carrier=true"],
        "smoother": [arm, "gnss.systems=[gps, galileo, leo]", "ekf.carrier=true", SMOOTHER],
        "gps": [arm, GPS],
        "gps-carriers": [arm, GPS, "ekf.carrier=true"],
        "gps-leo": [arm, GPS_LEO, "ekf.carrier=true"],
        "no-imu": [arm, NO_IMU],
        "demo": [],
    }, quick=("gps-leo", "no-imu"))
    replays("leo-320", "leo-320", "urban", {
        "gps": [arm, GPS],
        "gps-leo": [arm, GPS_LEO],
        "leo-smoother": [arm, LEO, SMOOTHER],
    })
    replays("leo-640", "leo-640", "urban", {"gps-leo": [arm, NO_IMU, GPS_LEO], "all": [arm, NO_IMU]})
    point = ["vehicle.lever_arm_b_m=[0, 0, 0]", "ekf.code_correlation_time_s=60"]
    still = [*point, "ekf.motion=static"]
    replays("convergence", "still", "urban", {
        "gps": [*still, GPS],
        "gps-leo": [*still, GPS_LEO],
        "all-smoother": [*still, SMOOTHER, NO_BEIDOU],
    })
    replays("convergence-moving", "moving", "urban", {
        "gps": [*point, NO_IMU, GPS],
        "gps-leo": [*point, NO_IMU, GPS_LEO],
        "all": [*point, NO_IMU],
        "gps-leo-smoother": [*point, NO_IMU, GPS_LEO, SMOOTHER],
    })
    car = [CAR, "vehicle.odometer_resolution_m=0.05"]
    replays("tunnels", "tunnels", "urban", {
        "gps": [GPS],
        "gps-smoother": [GPS, SMOOTHER],
        "gps-leo": [GPS_LEO],
        "car-gps": [GPS, *car, "vehicle.odometer=false"],
        "car-gps-leo": [GPS_LEO, *car, "vehicle.odometer=false"],
        "car-gps-leo-smoother": [GPS_LEO, *car, "vehicle.odometer=false", SMOOTHER],
        "odometer": [GPS, *car],
        "odometer-all": car,
        "odometer-smoother": [GPS, *car, SMOOTHER],
        "odometer-scale-known": [GPS, *car, "vehicle.odometer_scale_sigma_percent=0"],
        "no-standstills": [GPS, *car, "vehicle.zero_velocity=false"],
        "standstills-alone": [GPS, *car, "vehicle.non_holonomic=false"],
        "constraint-point": [GPS, *car, "vehicle.constraint_point_b_m=[-1.2, 0, 0.3]", "vehicle.estimate_travel_direction=false",
                             "vehicle.constraint_interval_s=0.5"],
        "gate": [GPS, *car, "vehicle.mounting_rpy_deg=[0, 0, 12]"],
        "no-imu": [NO_IMU, GPS],
        "no-imu-leo": [NO_IMU, GPS_LEO],
    }, quick=("car-gps", "odometer-smoother"))
    replays("tunnels-mems", "tunnels-mems", "urban", {
        "gps": [GPS, *MEMS_SETTINGS],
        "gps-leo": [GPS_LEO, *MEMS_SETTINGS],
        "car": [GPS, CAR, *MEMS_SETTINGS],
        "car-smoother": [GPS_LEO, CAR, *MEMS_SETTINGS, SMOOTHER],
    })
    replays("places", "places", "urban", {
        "gps": [GPS, CAR],
        "all": [CAR],
        "gps-leo-smoother": [GPS_LEO, CAR, SMOOTHER],
    })
    replays("faults", "faults", "urban", {
        "ekf": [arm],
        "car": [arm, CAR, GPS_LEO],
        "smoother": [arm, SMOOTHER, GPS_LEO],
        "no-imu": [arm, NO_IMU],
        "no-imu-smoother": [arm, NO_IMU, SMOOTHER, GPS],
        "codes-alone": [arm, "ekf.carrier=false", GPS],
    }, quick=("ekf", "smoother"))
    replays("noisy", "noisy", "urban", {
        "ekf": [arm],
        "smoother": [arm, SMOOTHER, NO_BEIDOU],
        "no-imu": [arm, NO_IMU],
        "single-frequency": [arm, "gnss.code_combination=single_frequency", GPS],
    })
    for name in ("jumps", "jumps-all"):
        replays(name, name, "urban", {
            "ekf": [arm],
            "no-imu": [arm, NO_IMU],
            "smoother": [arm, SMOOTHER, GPS_LEO],
            "codes-alone": [arm, NO_IMU, GPS, "ekf.carrier=false"],
        })
    replays("flight", "flight", "urban", {
        "uav": [arm, "vehicle.kind=uav", *MEMS_SETTINGS],
        "handheld": [arm, *MEMS_SETTINGS, GPS],
        "smoother": [arm, "vehicle.kind=uav", *MEMS_SETTINGS, SMOOTHER, GPS],
    })
    replays("creeping", "creeping", "urban", {
        "car": [CAR, GPS],
        "car-smoother": [CAR, GPS_LEO, SMOOTHER],
        "handheld": [],
    })
    replays("parking", "parking", "urban", {
        "car": [arm, CAR, GPS, *MEMS_SETTINGS],
        "rail": [arm, "vehicle.kind=rail", *MEMS_SETTINGS],
        "smoother": [arm, CAR, GPS_LEO, *MEMS_SETTINGS, SMOOTHER],
        "told-wrong": [arm, CAR, GPS, *MEMS_SETTINGS, "alignment.initial_heading_deg=170"],
    })
    near = ["vehicle.lever_arm_b_m=[0.6, -0.4, -1]", "vehicle.mounting_rpy_deg=[4, -4, 4]", "imu.time_offset_ms=30"]
    estimated = ["vehicle.estimate_lever_arm=true", "vehicle.lever_arm_sigma_m=0.3", "vehicle.estimate_time_offset=true",
                 "vehicle.time_offset_sigma_ms=20"]
    replays("misplaced", "misplaced", "urban", {
        "as-it-is": [CAR],
        "estimated": [CAR, *near, *estimated],
        "estimated-smoother": [CAR, *near, *estimated, SMOOTHER, GPS],
        "estimated-no-constraints": [*near, *estimated, GPS],
    }, quick=("estimated",))


def edited():
    replays("commands", "commands", "urban", {
        "ekf": [NO_BEIDOU],
        "car": [GPS, CAR],
        "smoother": [GPS, SMOOTHER],
        "no-imu": [NO_IMU, GPS_LEO],
    }, quick=("car", "smoother"))
    for name in inputs.CHECKPOINTS:
        replay(f"checkpoint/{name}", f"checkpoint-{name}", "urban", CAR, GPS_LEO, "alignment.max_gyrocompass_sigma_deg=0",
               quick=name == "used")
    replay("checkpoint/used-handheld-smoother", "checkpoint-used", "urban", GPS, SMOOTHER)
    replay("checkpoint/heading-given-too", "checkpoint-used", "urban", CAR, GPS, "alignment.initial_heading_deg=0")
    replays("late-start", "late-start", "urban", {
        "car": [CAR],
        "handheld": [GPS],
        "no-matching": [CAR, GPS, "alignment.velocity_matching=false"],
        "smoother": [CAR, GPS, SMOOTHER],
    })
    for name in ("jitter", "jitter-strong", "bursts", "leap", "leap-back", "damaged"):
        replay(f"{name}/ekf", name, "urban", NO_BEIDOU, CAR, quick=name in ("leap", "damaged"))
        replay(f"{name}/smoother", name, "urban", GPS, SMOOTHER)
        replay(f"{name}/no-imu", name, "urban", GPS_LEO, NO_IMU)
    replay("damaged/gnss-only", "damaged-gnss-only", "drive")
    resets()
    arm = "vehicle.lever_arm_b_m=[0.8, -0.6, -1.1]"
    replay("first-run/none", "first-run", "urban", arm, CAR, quick=True)
    replay("first-run/lever-arm-sign", "first-run", "urban", "vehicle.lever_arm_b_m=[-0.8, 0.6, 1.1]")
    for name in inputs.mistakes.MISTAKES:
        replay(f"first-run/{name}", f"mistake-{name}", "urban", arm, quick=name in ("forward-left-up", "doppler-sign"))
    verify = ["--verify"]
    for name in ("walk", "ekf", "smoother", "smoother-full", "commands", "checkpoint", "cut"):
        replay(f"journal/{name}", f"journal-{name}", None, options=verify, quick=name in ("ekf", "smoother"))
    replay("journal/ekf-by-the-file", "journal-ekf", "urban", "gnss.systems=[gps, galileo, leo]", "realtime.deadline_ekf_ms=6", CAR,
           options=verify)
    replay("journal/other-settings", "journal-ekf", None, "gnss.elevation_mask_deg=30", options=verify)
    replay("journal/ekf-third-missed", "journal-ekf-third", None, quick=True)
    replay("journal/smoother-half-missed", "journal-smoother-half", None, quick=True)


def resets():
    """Each way in which a filter starts over, is dropped or is suspected, with each kind of state that may outlive it."""
    arm, codes = "vehicle.lever_arm_b_m=[0.4, -0.2, -1.1]", "ekf.carrier=false"
    replays("elsewhere", "elsewhere", "urban", {
        "ekf": [arm],
        "car": [arm, CAR],
        "smoother": [arm, SMOOTHER, CAR],
        "codes-alone": [arm, codes, GPS],
        "no-imu": [arm, NO_IMU],
        "no-imu-smoother": [arm, NO_IMU, GPS, SMOOTHER],
        "not-robust": [arm, GPS, "robust.enabled=false"],
        "two-satellites": [arm, CAR, GPS, *capped(2)],
        "three-satellites": [arm, GPS, *capped(3)],
        "three-satellites-smoother": [arm, CAR, GPS, SMOOTHER, *capped(3)],
        "three-satellites-codes-alone": [arm, GPS, codes, *capped(3)],
        "three-satellites-no-imu": [arm, GPS, NO_IMU, *capped(3)],
        "four-satellites": [arm, CAR, GPS, *capped(4)],
    }, quick=("car", "three-satellites-smoother"))
    replays("elsewhere-near", "elsewhere-near", "urban", {
        "ekf": [arm],
        "car": [arm, CAR, GPS],
        "smoother": [arm, SMOOTHER],
        "no-imu": [arm, NO_IMU],
    }, quick=("ekf",))
    replays("codes-shifted", "codes-shifted", "urban", {
        "ekf": [arm],
        "two-satellites": [arm, CAR, GPS, *capped(2)],
        "three-satellites": [arm, GPS, *capped(3), "robust.k1=3"],
        "smoother": [arm, CAR, GPS, SMOOTHER, *capped(2)],
        "no-imu": [arm, NO_IMU, GPS, *capped(3)],
    })
    replays("long-outages", "long-outages", "urban", {
        "codes-alone": [arm, codes, *MEMS_SETTINGS],
        "carriers": [arm, *MEMS_SETTINGS],
        "car": [arm, CAR, codes, GPS, *MEMS_SETTINGS],
        "smoother": [arm, codes, GPS, SMOOTHER, *MEMS_SETTINGS],
        "no-imu": [arm, codes, NO_IMU],
        "no-imu-carriers": [arm, NO_IMU],
        "no-imu-smoother": [arm, codes, NO_IMU, GPS_LEO, SMOOTHER],
    }, quick=("no-imu-smoother",))
    for name, config in (("in-stages", "urban"), ("in-stages-gnss-only", "drive"), ("wild-stamps", "urban"),
                         ("wild-stamps-gnss-only", "drive"), ("leap-gnss-only", "drive")):
        replay(f"{name}/ekf", name, config, CAR)
        replay(f"{name}/smoother", name, config, CAR, GPS if name == "wild-stamps" else NO_BEIDOU, SMOOTHER)
    for name in ("in-stages-dopplers-last", "in-stages-dopplers-of-others"):
        replay(f"{name}/ekf", name, "drive")
        replay(f"{name}/smoother", name, "urban", NO_IMU, NO_BEIDOU, SMOOTHER)
    replay("products-stop/static", "products-stop", "station", quick=True)
    replay("products-stop/kinematic", "products-stop", "station", *FREE, "gnss.systems=[gps, galileo, beidou]")
    replay("products-stop/kinematic-smoother", "products-stop", "station", *FREE, SMOOTHER)
    replay("products-late/ekf", "products-late", "urban", arm)
    replay("products-late/smoother", "products-late", "urban", arm, GPS_LEO, SMOOTHER)
    slow = [arm, "realtime.epoch_interval_s=10"]
    replays("fast-imu", "fast-imu", "urban", {"ekf": slow, "car": [*slow, CAR, GPS], "smoother": [*slow, GPS_LEO, SMOOTHER],
                                             "interval-not-told": [arm, GPS]})
    replay("leo-640/low-mask", "leo-640", "urban", arm, NO_IMU, "gnss.elevation_mask_deg=0", "ekf.code_correlation_time_s=60")
    replay("leo-640/low-mask-single-frequency", "leo-640", "urban", arm, NO_IMU, "gnss.elevation_mask_deg=0",
           "gnss.code_combination=single_frequency", "ekf.code_correlation_time_s=60")
    replay("late-start/course-alone-reverse", "late-start", "urban", CAR, GPS, "alignment.max_gyrocompass_sigma_deg=0",
           "alignment.velocity_matching=false", "vehicle.mounting_rpy_deg=[0, 0, 180]")


def programs():
    for name, data, options in (("walk", "walk", ()), ("walk-rinex", "walk", ()), ("drive", "drive", ()), ("drive-day", "drive", ()),
                                ("station", "station", ()), ("rover", "base_rover", ())):
        add(f"import/{name}", [inputs.import_words(name, "{out}", *options)], data=[data], quick=name in ("walk", "station"))
    add("import/walk-late", [inputs.import_words("walk", "{out}", "--gnss-latency-ms", "300")], data=["walk"])
    add("import/station-part", [inputs.import_words("station", "{out}", "--from", "2111:352800", "--to", "2111:360000")], data=["station"])
    add("import/drive-ins", [inputs.import_words("drive-ins", "{out}")], ["drive-imu"], ["drive"])
    add("import/simulated-files", [["leonav-import", "in/files/dataset.yaml", "-o", "{out}/run.lcmlog"]], ["files"], quick=True)
    add("imu-from-truth/drive", [["leonav-imu-from-truth", "--truth", "data/drive/truth.csv", "--out", "{out}/imu.csv",
                                  "--truth-out", "{out}/truth.csv"]], data=["drive"])
    add("imu-from-truth/simulated", [["leonav-imu-from-truth", "--truth", "in/urban/truth.csv", "--out", "{out}/imu.csv",
                                      "--truth-out", "{out}/truth.csv"]], ["urban"], quick=True)
    for name, simulation in SIMULATIONS.items():
        add(f"sim/{name}", [simulation.words("{out}")], simulation.needs(), quick=name in ("urban", "tunnels", "faults", "files"))
    for name in inputs.OVERLAYS:
        add(f"sim/{name}", [inputs.overlay_words(name, "{out}")], ["scenario", inputs.OVERLAYS[name][0]], ["drive"])
    add("sim/sky-statistics", [["leonav-sim", "--sky-statistics", f"in/scenario/{name}.yaml", *with_settings(settings), "--step", "30"]
                               for name, settings in (("open_sky", []), ("leo_320", []), ("urban", ["duration_s=600", "places=city"]))],
        ["scenario"])
    calibrate = ["leonav-calibrate", "--config", "in/config/urban.yaml", "--set", CAR]
    add("calibrate/misplaced", [[*calibrate, "--set", "vehicle.lever_arm_b_m=[0.4, -0.2, -1.2]", "--set", GPS, "--passes", "4",
                                 "--json", "{out}/found.json", log_of("misplaced")]], ["misplaced", "config"])
    add("calibrate/one-pass", [[*calibrate, "--passes", "1", "--json", "{out}/found.json", log_of("tunnels")]], ["tunnels", "config"])
    add("calibrate/walk", [["leonav-calibrate", "--config", "in/config/walk.yaml", "--passes", "2", "--json", "{out}/found.json",
                            log_of("walk")]], ["walk", "config"])
    starts = ["leonav-starts", "--config", "in/config/urban.yaml", "--set", CAR, "--set", GPS, "--list", "{out}/starts.csv"]
    add("starts/city", [[*starts, "--number", "6", "--truth", "in/urban/truth.csv", log_of("urban")]], ["urban", "config"])
    add("starts/parking", [[*starts, "--number", "6", *with_settings(MEMS_SETTINGS), "--truth", "in/parking/truth.csv",
                            log_of("parking")]], ["parking", "config"])
    add("starts/told-off", [[*starts, "--number", "4", "--seconds", "90", "--told-off", "20:180", "--truth", "in/urban/truth.csv",
                             log_of("urban")]], ["urban", "config"])
    stops = ["leonav-stops", "--set", CAR]
    add("stops/creeping", [[*stops, "--config", "in/config/urban.yaml", "--set", systems, "--truth", "in/creeping/truth.csv",
                            log_of("creeping")] for systems in (GPS, NO_BEIDOU)], ["creeping", "config"], quick=True)
    add("stops/city", [[*stops, "--config", "in/config/urban.yaml", "--set", GPS, "--truth", "in/tunnels/truth.csv", log_of("tunnels")]],
        ["tunnels", "config"])
    add("stops/drive", [[*stops, "--config", "in/config/drive_ins.yaml", "--truth", "in/drive-imu/truth_attitude.csv",
                         log_of("drive-ins")]], ["drive-ins", "drive-imu", "config"])
    evaluate = ["leonav-eval", "--json", "{out}/errors.json"]
    add("eval/city", [[*evaluate, "--truth", "in/urban/truth.csv", "--from", "2136:345640", "all=in/results/urban/solution.csv",
                       "GPS=in/results/urban-gps/solution.csv"],
                      ["leonav-eval", "--residuals", "in/results/urban/measurements.csv"],
                      ["leonav-eval", "--truth", "in/urban/truth.csv", "--remove-offset", "--up-offset", "1.2", "--to", "2136:345800",
                       "--convergence-bound", "0.5", "in/results/urban/solution.csv"]], ["urban", "results"], quick=True)
    add("eval/walk", [[*evaluate, "--truth", "data/walk/truth.csv", "--remove-offset", "--max-course-rate", "10", "--imu",
                       "data/walk/imu.csv", "in/walk-result/walk/solution.csv"]], ["walk-result"], ["walk"])
    add("eval/integrity", [["leonav-eval", "--integrity", "--json", "{out}/counts.json", "--truth", "in/urban/truth.csv",
                            "--alert-limit-m", "0.5,5", "all=in/results/urban/solution.csv",
                            "GPS=in/results/urban-gps/solution.csv"]], ["urban", "results"], quick=True)
    for name in ("urban", "noisy", "walk", "drive", "station", "drive-leo"):
        add(f"quality/{name}", [["leonav-eval", "--quality", "--json", "{out}/quality.json", log_of(name)]], [name],
            quick=name == "urban")
    add("quality/damaged", [["leonav-eval", "--quality", "--mask", "5", "--json", "{out}/quality.json", log_of("damaged")],
                            ["leonav-eval", "--quality", "in/refusals/no-gnss.lcmlog"]], ["damaged", "refusals"])
    refusals()


def presets():
    """The presets as the programs have them; the other cases have the text of when the inputs were made."""
    add("configuration/presets", [["leonavd", "--check", "--preset", name] for name in inputs.PRESETS], quick=True)
    for name, log in (("car", "short"), ("demo", "open"), ("phone", "drive"), ("phone_imu", "drive-ins"), ("station", "station"),
                      ("urban", "urban"), ("walk", "walk")):
        add(f"replay/preset/{name}", [["leonav-replay", "--preset", name, log_of(log), "--out", "{out}"]], [log], quick=name == "car")


def refusals():
    """Inputs that programs refuse, with their messages and exit codes."""
    def replay_of(log, *words):
        return ["leonav-replay", "--out", "{out}/run", *words, log]
    urban, bad = ["--config", "in/config/urban.yaml"], "in/refusals/"
    log = "in/first-run/run.lcmlog"
    configs = ("unknown-key", "wrong-kind", "out-of-range", "twice", "no-yaml")
    add("refused/configuration", [
        *(replay_of(log, "--config", f"{bad}{name}.yaml") for name in configs),
        *(replay_of(log, *urban, "--set", setting) for setting in (
            "gnss.sistems=[gps]", "gnss.elevation_mask_deg=100", "vehicle.kind=truck", "gnss=3", "robust.k0", "smoother.window=2.5",
            "gnss.systems=[glonass]", "gnss.ocean_loading_file=absent.blq", "gnss.polar_motion_x_arcsec=0.1")),
        *(["leonavd", "--config", f"{bad}{name}.yaml"] for name in configs)], ["first-run", "config", "refusals"], quick=True)
    add("refused/inputs", [
        *(replay_of(f"{bad}{name}.lcmlog", *urban) for name in ("text", "empty", "no-imu", "no-gnss", "no-ephemeris", "absent")),
        replay_of(log, *urban, "--set", "lcm.prefix=OTHER_"), replay_of(log), replay_of(log, *urban, "--verify"),
        replay_of(log, *urban, "--rate", "0"),
        ["leonav-sim", f"{bad}scenario.yaml", "-o", "{out}/x.lcmlog"], ["leonav-sim", f"{bad}fault.yaml", "-o", "{out}/x.lcmlog"],
        ["leonav-sim", "in/scenario/urban.yaml", "--set", "duration_s=-1", "-o", "{out}/x.lcmlog"],
        ["leonav-import", f"{bad}dataset.yaml", "-o", "{out}/x.lcmlog"], ["leonav-import", f"{bad}absent.yaml", "-o", "{out}/x.lcmlog"],
        ["leonav-eval", "--truth", f"{bad}text.lcmlog", "in/results/urban/solution.csv"],
        ["leonav-calibrate", *urban, f"{bad}no-imu.lcmlog"],
        ["leonav-stops", *urban, "--truth", "in/urban/truth.csv", log],
        ["leonav-starts", *urban, "--truth", "in/urban/truth.csv", "--told-off", "9", log]],
        ["first-run", "config", "scenario", "refusals", "urban", "results"], quick=True)


recorded()
simulated()
edited()
presets()
programs()
