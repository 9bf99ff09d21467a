"""Every row of the papers' matrix, and of the convergence study: what is simulated and how it is estimated."""
import motion
import published
from scenes import Row, Scene, mode

def title_of(systems, ins):
    return "/".join([{"gps": "GPS", "bds": "BDS", "gal": "GAL", "leo": "LEO"}[s] for s in systems] + (["INS"] if ins else []))


def name_of(systems, ins):
    return "-".join(list(systems) + (["ins"] if ins else []))


CODE_MODES = [(["gps"], False), (["leo"], False), (["gps", "leo"], False), (["gps"], True), (["leo"], True),
              (["gps", "leo"], True)]
INS_MODES = [(["gps"], True), (["gps", "leo"], True), (["bds"], True), (["bds", "leo"], True)]
CARRIER_MODES = CODE_MODES + INS_MODES[2:]


def code_rows(scene):
    rows = []
    for robust in (True, False):
        for systems, ins in CODE_MODES:
            key = name_of(systems, ins) + ("" if robust else "-plain")
            rows.append(Row(f"code-{key}", "code" if robust else "code-plain", title_of(systems, ins), scene,
                            mode(systems, ins, False, robust), published_=published.CODE.get(key)))
    for limited in ("gps", "leo"):
        for ins in (False, True):
            for count in (1, 2, 3, 4):
                key = f"{name_of(['gps', 'leo'], ins)}-{limited}{count}"
                rows.append(Row(f"code-{key}", f"few-{limited}",
                                f"{title_of(['gps', 'leo'], ins)}, {count} {limited.upper()}", scene,
                                mode(["gps", "leo"], ins, False) + [f"gnss.{limited}.max_satellites={count}"],
                                published_=published.CODE.get(key)))
    return rows


def carrier_rows(scene):
    rows = []
    for robust in (True, False):
        for systems, ins in CARRIER_MODES if robust else INS_MODES:
            key = name_of(systems, ins)
            rows.append(Row(f"carrier-{key}" + ("" if robust else "-plain"), "carrier" if robust else "carrier-plain",
                            title_of(systems, ins), scene, mode(systems, ins, True, robust),
                            published_=published.CARRIER.get(key) if robust else None))
    return rows


# Today's BeiDou shows more satellites between houses than the papers' six.
LOW_CAPS = {"gps": [], "bds": ["gnss.beidou.max_satellites=6"]}


def low_rows(scene):
    return [Row(f"low-{name_of(s, ins)}", "low", title_of(s, ins), scene, mode(s, ins, True) + LOW_CAPS[s[0]],
                published_=published.LOW[name_of(s, ins)]) for s, ins in INS_MODES]


def set_rows(scene):
    """Four data sets of 2,000 epochs from a cold start: seeds 1 to 4."""
    rows = []
    for systems, ins in INS_MODES:
        name = name_of(systems, ins)
        rows.append(Row(f"sets-{name}", "sets", title_of(systems, ins), scene, mode(systems, ins, True), settle_epochs=0))
        rows[-1].published_sets = published.SETS[name]
    return rows


# Of every satellite, for half a minute and for a minute.
OUTAGES = "faults=[" + ", ".join(f"{{kind: outage, from_s: {a}, to_s: {b}, systems: [gps, galileo, beidou, leo]}}"
                                 for a, b in ((1500, 1530), (2500, 2560))) + "]"


def outage_rows(epochs):
    """Are the stated sigmas true where nothing is reflected, with and without LEO, in outages and after them?"""
    scene = Scene("outages", epochs + 2.0, ["places=none", OUTAGES])
    return [Row(f"outages-{name_of(s, True)}", "outages", title_of(s, True), scene, mode(s, True, True))
            for s in (["gps"], ["gps", "leo"])]


# An antenna of its own point: convergence is the carriers', not the lever arm's. A standing antenna's multipath is
# alike for a minute (receiver.multipath.time_s): taken for white, more satellites made it slower, not faster.
OPEN = ["places=none", "receiver.lever_arm_b_m=[0, 0, 0]", "imu.enabled=false"]


def convergence_rows(duration_s):
    rows = []
    for moving in (False, True):
        kind = "drive" if moving else "static"
        standing = ["route.standing_s=10"] if moving else [f"route.standing_s={duration_s + 100:g}"]
        for systems in (["gps"], ["gps", "gal", "bds"]):
            for leo in (0, 1, 2, 4):
                chosen = systems + (["leo"] if leo else [])
                settings = mode(chosen, False, True) + ["vehicle.lever_arm_b_m=[0, 0, 0]", "ekf.code_correlation_time_s=60"]
                if not moving:
                    settings.append("ekf.motion=static")
                scene = Scene(f"open-{kind}-{160 * leo if leo > 1 else 160}", duration_s, OPEN + standing, leo,
                              "config/scenario/open_sky.yaml")
                rows.append(Row(f"convergence-{kind}-{'-'.join(systems)}-leo{160 * leo}", f"convergence-{kind}",
                                f"{title_of(systems, False)}" + (f" + LEO {160 * leo}" if leo else ""), scene,
                                settings, settle_epochs=0, bound_m=0.1))
    return rows


# Twice the IMU errors of the preset urban.
TWICE_AS_BAD = ["imu.angle_random_walk_deg_per_sqrt_h=0.1", "imu.velocity_random_walk_m_s_per_sqrt_h=0.2",
                "imu.gyro_bias_deg_per_h=2", "imu.accel_bias_mgal=50", "imu.gyro_scale_ppm=600", "imu.accel_scale_ppm=600"]
MISMATCHES = [("convergence-static-gps-leo160", "multipath", "multipath of 200 s, taken for 60 s", ["receiver.multipath.time_s=200"]),
              ("convergence-static-gps-gal-bds-leo160", "multipath", "multipath of 200 s, taken for 60 s",
               ["receiver.multipath.time_s=200"]),
              ("convergence-static-gps-gal-bds-leo160", "carrier-multipath", "carriers without multipath",
               ["receiver.multipath.carrier_m=0"]),
              ("carrier-gps-leo-ins", "imu", "an IMU twice as bad as it is taken for", TWICE_AS_BAD)]


def mismatch_rows(rows):
    """Rows as they are, of drives that are not as the estimator is told."""
    by_name = {row.name: row for row in rows}
    result = []
    for name, what, words, overrides in MISMATCHES:
        row = by_name[name]
        scene = Scene(f"{row.scene.name}-{what}", row.scene.duration_s, row.scene.overrides[1:] + overrides, row.scene.leo_factor,
                      row.scene.file)
        short = name.replace("convergence-static", "static")
        result.append(Row(f"mismatch-{what}-{short}", "mismatch", f"{row.title}: {words}", scene, row.settings,
                          row.settle_epochs, row.bound_m))
        result[-1].matched = name
    return result


# The papers laid simulated LEO over their drive without its houses, and hardly masked (report.py, sky_lines). LEO/INS
# without weights is there to tell what the reflected codes of GPS do to the row with both.
OPEN_LEO = ["code-gps-ins-plain", "code-gps-leo-ins-plain", "code-leo-ins-plain", "carrier-bds-ins", "carrier-bds-leo-ins", "low-gps-ins", "low-gps-leo-ins",
            "low-bds-ins", "low-bds-leo-ins", "sets-gps-ins", "sets-gps-leo-ins", "sets-bds-ins", "sets-bds-leo-ins"]


def open_leo_rows(rows):
    by_name = {row.name: row for row in rows}
    result = []
    for name in OPEN_LEO:
        row = by_name[name]
        scene = Scene(f"{row.scene.name}-open-leo", row.scene.duration_s, row.scene.overrides[1:], open_leo=True)
        result.append(Row(f"open-{name}", "open-leo", f"{row.title}, {row.group}", scene,
                          row.settings + ["gnss.elevation_mask_deg=5"], row.settle_epochs, row.bound_m, row.published))
        result[-1].housed, result[-1].published_sets = row, row.published_sets
    return result


SMOOTHED_GROUPS = ("code", "code-plain", "few-gps", "few-leo", "carrier", "carrier-plain", "low", "outages", "sets")


def smoother_rows(rows):
    """The same drives, the same measurements: the sliding window's answer, and the whole log's, its bound."""
    result = []
    for row in rows:
        if row.group not in SMOOTHED_GROUPS:
            continue
        published_ = {"carrier": published.CARRIER_SMOOTHER.get(row.name.removeprefix("carrier-")),
                      "low": row.published}.get(row.group)
        result.append(Row(f"fgo-{row.name}", f"fgo-{row.group}", row.title, row.scene, row.settings + ["estimator=smoother"],
                          row.settle_epochs, row.bound_m, published_))
        smoother = result[-1]
        smoother.filter, smoother.published_sets = row, row.published_sets
        result.append(Row(f"whole-{row.name}", f"whole-{row.group}", row.title, row.scene, row.settings, row.settle_epochs, row.bound_m))
        result[-1].program, result[-1].published_sets = "leonav-smooth", row.published_sets
        smoother.whole_log = result[-1]
    return result


# What the smoother's gain is made of: keyframes, iterations, weights; and what arcs that end could cost at most.
STUDIES = [(f"w{w}", f"W = {w}", [f"smoother.window={w}"], []) for w in (1, 2, 5, 10, 40, 60)] + [
    ("once", "one iteration", ["smoother.max_iterations=1"], []),
    ("filter-weights", "weights as the filter has them", ["smoother.reweigh=false"], []),
    ("reweigh-10", "weights decided for 10 s", ["smoother.reweigh_s=10"], []),
    ("reweigh-20", "weights decided over the whole window", ["smoother.reweigh_s=20"], []),
    ("no-means", "each code judged by itself", ["smoother.code_alike_s=0"], []),
    ("no-slips", "a receiver that never slips", [], ["receiver.tracking.slips_per_hour=0"])]


def study_rows(rows):
    by_name = {row.name: row for row in rows}
    result = []
    for name in ("fgo-carrier-gps-leo-ins", "fgo-low-gps-leo-ins"):
        row = by_name[name]
        for short, words, settings, simulated in STUDIES:
            scene = Scene(f"{row.scene.name}-{short}", row.scene.duration_s, row.scene.overrides[1:] + simulated) if simulated else row.scene
            result.append(Row(f"study-{row.scene.name}-{short}", "study", f"{row.title}, {row.scene.name}: {words}", scene,
                              row.settings + settings, row.settle_epochs, row.bound_m))
            result[-1].filter, result[-1].studied = row.filter, row
    return result


def all_rows(epochs, sets_epochs, convergence_epochs):
    city = Scene("city", epochs + 2.0, ["places=city"])
    dense = Scene("dense", epochs + 2.0, ["places=dense_city"])
    sets = Scene("sets", sets_epochs + 2.0, ["places=city"])
    rows = (code_rows(city) + carrier_rows(city) + low_rows(dense) + outage_rows(epochs) + set_rows(sets) +
            convergence_rows(convergence_epochs + 2.0))
    smoothed = smoother_rows(rows)
    return rows + mismatch_rows(rows) + open_leo_rows(rows) + smoothed + study_rows(smoothed) + motion.rows()
