"""Makes a run of known content: a drive round a block with gaps and an outlier, satellites with a house in the east, measurements.

Everything is written as leonav-replay writes its tables; journal() encodes the same by the types that lcm-gen writes.
"""
import math

import numpy as np

WEEK, TOW, EPOCHS = 2200, 345600.0, 600
LATITUDE, LONGITUDE, HEIGHT = 45.05, 7.65, 250.0
GAP = (200, 212)  # epochs without a solution, first and one behind the last
OUTLIER = 400  # the epoch that lies 30 km off
HOUSE = (60.0, 120.0, 45.0)  # azimuths between which signals below an elevation are lost, degrees
SOLUTION_HEADER = (
    "gps_week,gps_tow_s,latitude_deg,longitude_deg,height_m,v_north_m_s,v_east_m_s,v_down_m_s,std_north_m,std_east_m,std_down_m,"
    "source,satellites,pdop,protection_horizontal_m,protection_vertical_m")


# Satellites with azimuth and elevation at the start, degrees, and the rates of both in degrees a second.
SKY = {"G03": (5, 18, 0.02, 0.004), "G07": (80, 30, 0.01, 0.005), "G12": (100, 62, 0.02, -0.004), "G22": (150, 41, -0.02, 0.004),
       "G31": (205, 25, 0.02, 0.003), "E05": (240, 52, 0.02, 0.004), "E11": (285, 34, -0.01, 0.004), "E24": (330, 71, 0.03, 0.002),
       "E33": (60.5, 22, 0.02, 0.004), "C19": (112, 40, 0.01, -0.01), "C29": (178, 14, 0.01, 0.004), "L07": (20, 55, 0.35, -0.06),
       "M12": (210, 68, 0.25, -0.13)}


def metres(epoch):
    """North and east in m: along the four sides of a block of 1000 m by 600 m, at 6 m/s."""
    way = 6.0 * epoch % 3200.0
    for length, (north, east), (dn, de) in ((1000, (0, 0), (1, 0)), (600, (1000, 0), (0, 1)),
                 (1000, (1000, 600), (-1, 0)), (600, (0, 600), (0, -1))):
        if way <= length:
            return north + dn * way, east + de * way, 6.0 * dn, 6.0 * de
        way -= length
    raise AssertionError


def solutions():
    """Rows of solution.csv and of truth.csv."""
    dice = np.random.default_rng(1)
    rows, truth = [], []
    for epoch in range(EPOCHS):
        north, east, vn, ve = metres(epoch)
        latitude, longitude = LATITUDE + north / 111140.0, LONGITUDE + east / 78840.0
        truth.append((WEEK, TOW + epoch, latitude, longitude, HEIGHT))
        if GAP[0] <= epoch < GAP[1]:
            continue
        noise = dice.normal(size=3) * (1e-5, 1.2e-5, 2.0)
        if epoch == OUTLIER:
            noise[0] += 0.27
        source = "ins" if GAP[1] <= epoch < GAP[1] + 20 else "ekf" if epoch < 60 else "smoother"
        rows.append(
    (WEEK,
    TOW +
    epoch,
    latitude +
    noise[0],
    longitude +
    noise[1],
    HEIGHT +
    noise[2],
    vn,
    ve,
    0.0,
    1.0,
    1.2,
    2.0,
    source,
    9,
    1.8,
    6.0,
     11.0))
    return rows, truth


def satellites():
    """Rows of satellites.csv without those behind the house: name, epoch, azimuth, elevation, reason."""
    rows = []
    for index, (name, (azimuth0, elevation0, azimuth_rate, elevation_rate)) in enumerate(SKY.items()):
        for epoch in range(EPOCHS):
            azimuth, elevation = (azimuth0 + epoch * azimuth_rate) % 360.0, elevation0 + epoch * elevation_rate
            if elevation < 0.0 or (HOUSE[0] < azimuth < HOUSE[1] and elevation < HOUSE[2] and epoch % 10 < 7):
                continue
            reason = "low_elevation" if elevation < 8.0 else "outlier" if (
                epoch + index) % 97 == 5 else "downweighted" if (epoch + index) % 31 < 3 else "used"
            rows.append((name, epoch, azimuth, elevation, reason))
    return rows


def measurements():
    """Rows of measurements.csv: name, epoch, kind, residual, sigma, reason."""
    dice = np.random.default_rng(2)
    rows = []
    for name, epoch, _, _, reason in satellites():
        if reason == "low_elevation":
            continue
        for kind, sigma in (("code", 1.5), ("doppler", 0.08), ("carrier", 0.01)):
            residual = sigma * dice.normal() * (0.8 if reason != "outlier" else 8.0)
            rows.append((name, epoch, kind, residual, sigma, reason))
    return rows


def write(folder):
    """Writes solution.csv, satellites.csv, measurements.csv, events.csv and truth.csv."""
    def table(name, header, rows):
        (folder / name).write_text(header + "\n" + "".join(",".join(str(one) for one in row) + "\n" for row in rows))
    rows, truth = solutions()
    table("solution.csv", SOLUTION_HEADER, rows)
    table("truth.csv", "gps_week,gps_tow_s,latitude_deg,longitude_deg,height_m", truth)
    table("satellites.csv", "gps_week,gps_tow_s,satellite,reason,used,elevation_deg,azimuth_deg,cn0_dbhz",
          [(WEEK, TOW + epoch, name, reason, int(reason == "used"), round(elevation, 2), round(azimuth, 2), 45.0)
           for name, epoch, azimuth, elevation, reason in satellites()])
    table("measurements.csv", "gps_week,gps_tow_s,satellite,observable,signals,innovation,innovation_sigma,reason,residual",
          [(WEEK, TOW + epoch, name, kind, "1C", residual, sigma, reason, residual)
           for name, epoch, kind, residual, sigma, reason in measurements()])
    some = ((60, "aligned"), (GAP[1], "outage_over"), (100, "deadline_miss"), (300, "deadline_miss"))
    table("events.csv", "gps_week,gps_tow_s,stage,event,code,value", [(WEEK, TOW + epoch, "gnss", kind, 0, 0.0) for epoch, kind in some])


def journal(types):
    """Events (microseconds, channel, data) of the same run as a journal, with HEALTH, decisions and inputs."""
    reasons = {"used": 0, "downweighted": 1, "outlier": 2, "low_elevation": 7}
    systems = {"G": (0, 0), "E": (1, 0), "C": (2, 0), "L": (3, 0), "M": (3, 100)}
    sources = {"ins": 2, "ekf": 3, "smoother": 4}
    by_epoch, aiding = {}, {}
    for row in satellites():
        by_epoch.setdefault(row[1], []).append(row)
    for row in measurements():
        aiding.setdefault(row[1], []).append(row)
    solution_rows = {round(row[1] - TOW): row for row in solutions()[0]}
    out = []

    def put(time_ns, channel, message):
        message.time_ns = time_ns
        out.append((time_ns // 1000, f"LEONAV_{channel}", message.encode()))
    for epoch in range(EPOCHS):
        time_ns = (WEEK * 604800 + int(TOW) + epoch) * 10**9
        if epoch not in range(300, 306):  # the receiver pauses
            message = types.gnss_epoch_t()
            one = types.gnss_observation_t()
            one.number, message.n, message.observations = 3, 1, [one]
            put(time_ns, "GNSS_EPOCH", message)
        for part in range(10):
            put(time_ns + part * 10**8, "IMU", types.imu_t())
        health = types.health_t()
        health.status, health.why = ("DEGRADED", "INS only; smoother late") if epoch in range(300, 306) else ("OK", "")
        health.worst_ekf_ms, health.worst_solve_ms = 1.5 + 0.2 * math.sin(epoch), 30.0 + 5.0 * math.cos(epoch)
        put(time_ns, "HEALTH", health)
        for mailbox in (0, 1):
            decision = types.decision_t()
            decision.epoch, decision.mailbox, decision.committed = epoch, mailbox, not (mailbox == 1 and epoch % 100 == 50)
            put(time_ns, "DECISION", decision)
        solution = types.solution_t()
        solution.time_ns = time_ns
        if epoch in solution_rows:
            row = solution_rows[epoch]
            solution.source, solution.latitude_rad, solution.longitude_rad, solution.height_m = sources[row[11]], *np.radians(
                row[2:4]), row[4]
            solution.has_attitude = True  # an IMU carries the answer on where there is no GNSS
            solution.v_n, solution.sigma_p_n = list(row[5:8]), list(row[8:11])
            solution.horizontal_protection_m, solution.vertical_protection_m = row[14:16]
            put(time_ns, "SOLUTION", solution)
        message = types.epoch_t()
        message.index, message.solution, message.satellites_used, message.pdop = epoch, solution, 9, 1.8
        for name, _, azimuth, elevation, reason in by_epoch[epoch]:
            one = types.satellite_report_t()
            one.system, one.number = systems[name[0]][0], systems[name[0]][1] + int(name[1:])
            one.reason, one.azimuth_rad, one.elevation_rad, one.cn0_dbhz = reasons[reason], math.radians(
                azimuth), math.radians(elevation), 45.0
            message.satellites.append(one)
        for name, _, kind, residual, sigma, reason in aiding[epoch]:
            one = types.aiding_t()
            one.system, one.number = systems[name[0]][0], systems[name[0]][1] + int(name[1:])
            one.observable, one.residual, one.innovation_variance, one.reason = (
    "code", "carrier", "doppler").index(kind), residual, sigma**2, reasons[reason]
            message.aiding.append(one)
        message.n_satellites, message.n_aiding = len(message.satellites), len(message.aiding)
        put(time_ns, "EPOCH", message)
    event = types.event_t()
    event.kind = 3  # aligned
    put((WEEK * 604800 + int(TOW) + 60) * 10**9, "EVENT", event)
    return sorted(out, key=lambda one: one[0])
