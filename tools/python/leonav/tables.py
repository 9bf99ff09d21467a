"""Turns the messages of a log into one table for each channel.

Columns carry their units in their names, as in the tables of leonav-replay; what both have is named alike.
"""
import numpy as np
import pandas as pd

from . import gps_time, names

DEGREES = 180.0 / np.pi
AXES_NED = ("north", "east", "down")
AXES_BODY = ("x", "y", "z")
ANGLES = ("roll", "pitch", "yaw")


def time_columns(time_ns):
    """Returns the columns that begin each table: GPS week, time of week, UTC. Where no time is set they are 0, NaN and NaT."""
    time_ns = np.asarray(time_ns, dtype=np.int64)
    is_set = (time_ns > 0) & (time_ns <= gps_time.LATEST_NS)
    week, tow = gps_time.week_and_tow(np.where(is_set, time_ns, 0))
    utc = pd.Series(pd.to_datetime(gps_time.unix_ns(np.where(is_set, time_ns, 0)), utc=True))
    return {"gps_week": week, "gps_tow_s": np.where(is_set, tow, np.nan), "utc": utc.where(is_set).to_numpy() if not is_set.all() else utc}


def _native(array):
    """numpy's own byte order, which pandas needs."""
    array = np.asarray(array)
    return array.astype(array.dtype.newbyteorder("="))


def _spread(columns, pattern, array, suffixes, scale=1.0):
    for index, suffix in enumerate(suffixes):
        column = _native(array[:, index])
        columns[pattern.format(suffix)] = column if scale == 1.0 else column * scale


def _sources(solutions):
    """Names as in solution.csv: what no IMU carries on over a time without GNSS, and so has no attitude, is a prediction."""
    named, attitude = names.named(solutions["source"], names.SOURCES), np.asarray(solutions["has_attitude"]) != 0
    return np.where((named == "ins") & ~attitude, "prediction", named)


def _solution_columns(m):
    """Columns of solution.csv, without satellites and PDOP, which SOLUTION does not have; then the other fields."""
    attitude = np.asarray(m["has_attitude"]) != 0
    columns = {"latitude_deg": _native(m["latitude_rad"]) * DEGREES, "longitude_deg": _native(m["longitude_rad"]) * DEGREES,
               "height_m": _native(m["height_m"])}
    _spread(columns, "v_{}_m_s", m["v_n"], AXES_NED)
    _spread(columns, "{}_deg", np.where(attitude[:, None], m["rpy_rad"], np.nan), ANGLES, DEGREES)
    _spread(columns, "std_{}_m", m["sigma_p_n"], AXES_NED)
    _spread(columns, "std_v_{}_m_s", m["sigma_v_n"], AXES_NED)
    _spread(columns, "std_{}_deg", np.where(attitude[:, None], m["sigma_rpy"], np.nan), ANGLES, DEGREES)
    columns["source"] = _sources(m)
    has_levels = "horizontal_protection_m" in m.dtype.names  # not in journals of older versions
    columns["protection_horizontal_m"] = _native(m["horizontal_protection_m"]) if has_levels else np.nan
    columns["protection_vertical_m"] = _native(m["vertical_protection_m"]) if has_levels else np.nan
    columns["protection_heading_deg"] = _native(m["heading_protection_rad"]) * DEGREES if has_levels else np.nan
    _spread(columns, "ecef_{}_m", m["p_e"], AXES_BODY)
    _spread(columns, "gyro_bias_{}_rad_s", m["gyro_bias_b"], AXES_BODY)
    _spread(columns, "accel_bias_{}_m_s2", m["accel_bias_b"], AXES_BODY)
    _spread(columns, "gyro_scale_{}", m["gyro_scale"], AXES_BODY)
    _spread(columns, "accel_scale_{}", m["accel_scale"], AXES_BODY)
    columns["anchor_epoch"] = _native(m["anchor_epoch"])
    columns["jump_m"] = _native(m["jump_m"])
    columns["sequence"] = _native(m["sequence"])
    return columns


def _table(time_ns, columns):
    return pd.DataFrame({**time_columns(time_ns), **columns})


def _gather(messages, name):
    """The member of many messages as one array."""
    return np.array([m[name] for m in messages])


def _rows(messages, name):
    """Nested rows of all messages, and of which message each is."""
    arrays = [m[name] for m in messages]
    owner = np.repeat(np.arange(len(arrays)), [len(one) for one in arrays])
    return np.concatenate(arrays), owner


def solution(m):
    return {"": _table(m["time_ns"], _solution_columns(m))}


def imu(m):
    columns = {"interval_s": _native(m["interval_ns"]) / 1e9}
    _spread(columns, "delta_theta_{}_rad", m["delta_theta_b"], AXES_BODY)
    _spread(columns, "delta_velocity_{}_m_s", m["delta_velocity_b"], AXES_BODY)
    columns["sequence"] = _native(m["sequence"])
    return {"": _table(m["time_ns"], columns)}


def odometer(m):
    return {"": _table(m["time_ns"], {"interval_s": _native(m["interval_ns"]) / 1e9, "distance_m": _native(m["distance_m"]),
                                      "sign_known": np.asarray(m["sign_known"]) != 0, "sequence": _native(m["sequence"])})}


def event(m):
    return {"": _table(m["time_ns"], {"stage": names.named(m["stage"], names.STAGES), "event": names.named(m["kind"], names.EVENTS),
                                      "code": _native(m["code"]), "value": _native(m["value"]), "sequence": _native(m["sequence"])})}


def decision(m):
    return {"": _table(m["time_ns"], {"epoch": _native(m["epoch"]), "mailbox": names.named(m["mailbox"], names.MAILBOXES),
                                      "committed": np.asarray(m["committed"]) != 0, "iterations": _native(m["iterations"]),
                                      "sequence": _native(m["sequence"])})}


def command(m):
    return {"": _table(m["time_ns"], {"command": names.named(m["kind"], names.COMMANDS), "heading_deg": _native(m["value"]) * DEGREES,
                                      "std_heading_deg": _native(m["sigma"]) * DEGREES, "sequence": _native(m["sequence"])})}


def smoother(m):
    columns = {"epoch": _native(m["epoch"]), "status": names.named(m["status"], names.SMOOTHER_STATUS),
               "iterations": _native(m["iterations"]), "converged": np.asarray(m["converged"]) != 0,
               "keyframes": _native(m["keyframes"]), "used": _native(m["used"])}
    columns.update(_solution_columns(m["solution"]))
    return {"": _table(m["time_ns"], columns)}


def gnss_epoch(messages):
    rows, owner = _rows(messages, "observations")
    flags = np.asarray(rows["flags"])
    columns = {"satellite": names.satellite_names(rows["system"], rows["number"]),
               "signal": names.signal_names(rows["band"], rows["attribute"])}
    for name in ("pseudorange_m", "carrier_cycles", "doppler_hz", "cn0_dbhz", "lock_time_s"):
        columns[name] = _native(rows[name])
    columns["loss_of_lock"], columns["half_cycle"] = flags & 1 != 0, flags & 2 != 0
    columns["sequence"] = _gather(messages, "sequence")[owner]
    return {"": _table(_gather(messages, "time_ns")[owner], columns)}


def epoch(messages):
    """EPOCH as epochs.csv, _SATELLITES as satellites.csv, _MEASUREMENTS as measurements.csv."""
    time_ns = _gather(messages, "time_ns")
    solutions = np.array([m["solution"] for m in messages])
    columns = {"epoch": _gather(messages, "index"), "empty": _gather(messages, "empty") != 0,
               "source": _sources(solutions), "satellites": _gather(messages, "satellites_used")}
    for name in ("pdop", "hdop", "vdop"):
        columns[name] = _gather(messages, name)
    _spread(columns, "clock_{}_m", _gather(messages, "clock_m"), names.SYSTEMS)
    _spread(columns, "drift_{}_m_s", _gather(messages, "clock_drift_m_s"), names.SYSTEMS)
    columns.update({"nis": _gather(messages, "nis"), "nis_degrees": _gather(messages, "nis_degrees"),
                    "wet_delay_m": _gather(messages, "wet_delay_m"), "std_wet_delay_m": _gather(messages, "wet_delay_sigma_m")})
    if "fault_hypotheses" in messages[0]:  # not in journals of older versions
        columns["fault_hypotheses"] = np.array([m.get("fault_hypotheses", 0) for m in messages])
    estimate = _solution_columns(solutions)
    estimate.pop("source")
    columns.update({name: estimate[name] for name in estimate if name != "sequence"})
    columns["sequence"] = _gather(messages, "sequence")
    rows, owner = _rows(messages, "satellites")
    satellites = {"satellite": names.satellite_names(rows["system"], rows["number"]), "reason": names.named(rows["reason"], names.REASONS),
                  "used": np.asarray(rows["reason"]) <= 1, "elevation_deg": _native(rows["elevation_rad"]) * DEGREES,
                  "azimuth_deg": _native(rows["azimuth_rad"]) * DEGREES, "cn0_dbhz": _native(rows["cn0_dbhz"]),
                  "ephemeris_age_s": _native(rows["ephemeris_age_s"]), "orbit": names.named(rows["orbit_source"], names.ORBIT_SOURCES),
                  "arc": _native(rows["arc"]), "arc_started": np.asarray(rows["arc_started"]) != 0,
                  "arc_causes": names.slip_cause_names(rows["arc_causes"])}
    return {"": _table(time_ns, columns), "_SATELLITES": _table(time_ns[owner], satellites),
            "_MEASUREMENTS": _measurements(messages, time_ns)}


def _measurements(messages, time_ns):
    rows, owner = _rows(messages, "aiding")
    first = names.signal_names(rows["band"], rows["attribute"])
    second = names.signal_names(rows["second_band"], rows["second_attribute"])
    with np.errstate(invalid="ignore"):
        sigma = np.sqrt(_native(rows["innovation_variance"]))
    return _table(time_ns[owner], {
        "satellite": names.satellite_names(rows["system"], rows["number"]),
        "observable": names.named(rows["observable"], names.OBSERVABLES),
        "signals": np.array([a + "+" + b if b else a for a, b in zip(first, second)], dtype=object),
        "observation": _native(rows["observation"]), "innovation": _native(rows["innovation"]), "innovation_sigma": sigma,
        "test_ratio": _native(rows["test_ratio"]), "weight_factor": _native(rows["weight_factor"]),
        "reason": names.named(rows["reason"], names.REASONS), "residual": _native(rows["residual"])})


def constraints(messages):
    rows, _ = _rows(messages, "components")
    with np.errstate(invalid="ignore"):
        sigma = np.sqrt(_native(rows["innovation_variance"]))
    return {"": _table(rows["time_ns"], {
        "constraint": names.named(rows["component"], names.CONSTRAINTS), "observation": _native(rows["observation"]),
        "innovation": _native(rows["innovation"]), "innovation_sigma": sigma, "test_ratio": _native(rows["test_ratio"]),
        "used": np.asarray(rows["used"]) != 0, "residual": _native(rows["residual"])})}


def health(messages):
    """HEALTH with a row each second, _COUNTS with a row for each counter of each message."""
    time_ns = _gather(messages, "time_ns")
    columns = {}
    for name in ("status", "why", "source"):
        columns[name] = np.array([m[name] for m in messages], dtype=object)
    for name in ("ekf_misses", "smoother_misses", "worst_tick_us", "worst_ekf_ms", "worst_solve_ms"):
        columns[name] = _gather(messages, name)
    _spread(columns, "queue_{}_high_water_percent", _gather(messages, "queue_high_water_percent"), ("inertial", "gnss", "out"))
    _spread(columns, "satellites_{}", _gather(messages, "satellites_used"), names.SYSTEMS)
    _spread(columns, "ephemeris_age_{}_s", _gather(messages, "ephemeris_age_s"), names.SYSTEMS)
    _spread(columns, "satellites_by_{}", _gather(messages, "satellites_by_source"), ("broadcast", "precise"))
    _spread(columns, "age_{}_s", _gather(messages, "age_by_source_s"), ("broadcast", "precise"))
    for name in ("odometer_age_s", "memory_mb", "uptime_s"):
        columns[name] = _gather(messages, name)
    columns["protection_horizontal_m"] = _gather(messages, "horizontal_protection_m")
    columns["protection_vertical_m"] = _gather(messages, "vertical_protection_m")
    columns["protection_heading_deg"] = _gather(messages, "heading_protection_rad") * DEGREES
    columns["sequence"] = _gather(messages, "sequence")
    counts = [(index, one["name"], one["value"]) for index, m in enumerate(messages) for one in m["counts"]]
    owner = np.array([index for index, _, _ in counts], dtype=np.int64)
    return {"": _table(time_ns, columns), "_COUNTS": _table(time_ns[owner], {
        "name": np.array([name for _, name, _ in counts], dtype=object),
        "value": np.array([value for _, _, value in counts], dtype=np.int64)})}


def streams(messages):
    rows = [(m["time_ns"], one) for m in messages for one in m["streams"]]
    columns = {name: np.array([one[name] for _, one in rows], dtype=object if name in ("name", "state", "detail") else None)
               for name in ("name", "state", "detail", "bytes", "frames", "messages", "damaged", "refused", "failures", "byte_age_s",
                            "message_age_s", "stamp_sigma_s")}
    return {"": _table([time for time, _ in rows], columns)}


def ephemeris(m):
    low = "message" not in m.dtype.names  # leo_ephemeris_t
    columns = {"satellite": names.satellite_names(m["system"], m["number"])}
    if not low:
        columns["message"] = names.named(m["message"], names.EPHEMERIS_MESSAGES)
    for name in ("toe", "toc"):
        columns[f"{name}_gps_week"], columns[f"{name}_gps_tow_s"] = gps_time.week_and_tow(m[f"{name}_ns"])
    units = {"sqrt_a": "_sqrt_m", "m0": "_rad", "delta_n": "_rad_s", "omega0": "_rad", "omega_dot": "_rad_s", "i0": "_rad",
             "i_dot": "_rad_s", "omega": "_rad", "cuc": "_rad", "cus": "_rad", "crc": "_m", "crs": "_m", "cic": "_rad", "cis": "_rad", "af0": "_s",
             "af1": "_s_s", "af2": "_s_s2"}
    for name in ("issue", "issue_clock", "health", "accuracy_m", "eccentricity", *units):
        columns[name + units.get(name, "")] = _native(m[name])
    if low:
        columns.update({"a_dot_m_s": _native(m["a_dot"]), "delta_n_dot_rad_s2": _native(m["delta_n_dot"])})
    else:
        _spread(columns, "group_delay_{}_s", m["group_delay_s"], ("1", "2"))
    columns["sequence"] = _native(m["sequence"])
    return {"": _table(m["time_ns"], columns)}


def orbit_clock(messages):
    rows, owner = _rows(messages, "states")
    columns = {"satellite": names.satellite_names(rows["system"], rows["number"])}
    _spread(columns, "ecef_{}_m", rows["p_e"], AXES_BODY)
    columns.update({"clock_s": _native(rows["clock_s"]), "flags": _native(rows["flags"])})
    return {"": _table(_gather(messages, "time_ns")[owner], columns)}


def corrected_states(messages):
    rows, owner = _rows(messages, "states")
    columns = {"satellite": names.satellite_names(rows["system"], rows["number"])}
    _spread(columns, "ecef_{}_m", rows["p_e"], AXES_BODY)
    _spread(columns, "ecef_velocity_{}_m_s", rows["v_e"], AXES_BODY)
    columns.update({name: _native(rows[name]) for name in ("clock_s", "clock_drift", "sigma_m", "orbit_age_s", "clock_age_s", "issue", "flags")})
    columns.update({name: _gather(messages, name)[owner] for name in ("provider", "solution", "ssr_issue")})
    return {"": _table(_gather(messages, "time_ns")[owner], columns)}


def biases(messages):
    rows, owner = _rows(messages, "biases")
    columns = {"satellite": names.satellite_names(rows["system"], rows["number"]), "signal": names.signal_names(rows["band"], rows["attribute"]),
               "is_phase": np.asarray(rows["kind"]) == 1, "is_broadcast": np.asarray(rows["kind"]) == 2, "bias_m": _native(rows["bias_m"]),
               "valid_from_ns": _native(rows["from_ns"]), "valid_until_ns": _native(rows["until_ns"])}
    return {"": _table(_gather(messages, "time_ns")[owner], columns)}


def ionosphere(m):
    columns = {}
    _spread(columns, "alpha_{}_s_semicircle", m["alpha"], range(4))
    _spread(columns, "beta_{}_s_semicircle", m["beta"], range(4))
    columns["sequence"] = _native(m["sequence"])
    return {"": _table(m["time_ns"], columns)}


def checkpoint(m):
    columns = {"standing": np.asarray(m["standing"]) != 0}
    _spread(columns, "antenna_ecef_{}_m", m["antenna_p_e"], AXES_BODY)
    columns.update({"std_antenna_m": _native(m["antenna_sigma_m"]), "heading_deg": _native(m["heading_rad"]) * DEGREES,
                    "std_heading_deg": _native(m["heading_sigma_rad"]) * DEGREES})
    _spread(columns, "gyro_bias_{}_rad_s", m["gyro_bias_b"], AXES_BODY)
    columns["std_gyro_bias_rad_s"] = _native(m["gyro_bias_sigma"])
    if "code_sigma_factor" in m.dtype.names:  # not in journals of older versions
        columns.update({name: _native(m[name]) for name in ("code_sigma_factor", "doppler_sigma_factor")})
    if "calibrated" in m.dtype.names:
        columns["calibrated"] = np.asarray(m["calibrated"]) != 0
        for name, unit in (("mounting_rpy", "_rad"), ("accel_bias_b", "_m_s2"), ("accel_bias_sigma", "_m_s2"), ("gyro_scale", ""),
                           ("gyro_scale_sigma", ""), ("accel_scale", ""), ("accel_scale_sigma", "")):
            _spread(columns, name + "_{}" + unit, m[name], AXES_BODY)
        for name in ("constants", "constant_sigmas"):
            _spread(columns, "vehicle_" + name + "_{}", m[name], range(7))
    columns["sequence"] = _native(m["sequence"])
    return {"": _table(m["time_ns"], columns)}


def antenna(messages):
    """One row for each message; the pattern's values are a numpy array in its row."""
    columns = {name: _gather(messages, name) for name in ("angles", "azimuths", "sequence")}
    columns["is_receiver"] = _gather(messages, "is_receiver") != 0
    columns["system"] = names.named(_gather(messages, "system"), names.SYSTEMS)
    columns["number"] = _gather(messages, "number")
    columns["band"] = names.signal_names(_gather(messages, "band"), np.zeros(len(messages)))
    _spread(columns, "offset_{}_m", _gather(messages, "offset_m"), ("1", "2", "3"))
    columns["first_angle_deg"] = _gather(messages, "first_angle_rad") * DEGREES
    columns["angle_step_deg"] = _gather(messages, "angle_step_rad") * DEGREES
    columns["values_m"] = pd.Series([_native(m["values_m"]) for m in messages])
    return {"": _table(_gather(messages, "time_ns"), columns)}


def config(messages):
    return {"": _table(_gather(messages, "time_ns"), {name: np.array([m[name] for m in messages], dtype=object)
                                                      for name in ("program", "name", "text", "overrides")})}


def end(m):
    return {"": _table(m["time_ns"], {"messages": _native(m["messages"])})}


def piece(m):
    return {"": _table(m["time_ns"], {"number": _native(m["sequence"]), "run": _native(m["run"]), "first": _native(m["first"]),
                                      "outputs": _native(m["outputs"])})}


def refused(m):
    """Inputs that were refused as they came, since the row of the same reason and input before it."""
    return {"": _table(m["time_ns"], {"fault": _native(m["fault"]), "input": _native(m["input"]),
                                      "count": _native(m["count"])})}


def lost(m):
    return {"": _table(m["time_ns"], {"solutions": _native(m["solutions"]), "others": _native(m["others"])})}


# Channel, without prefix: its types, the newest first, and what makes its tables. A function whose types are of fixed size
# gets a numpy array of all messages, any other a list of dicts.
CHANNELS = {
    "IMU": (("imu_t",), imu), "GNSS_EPOCH": (("gnss_epoch_t",), gnss_epoch), "EPHEMERIS": (("ephemeris_t", "leo_ephemeris_t"), ephemeris),
    "ORBIT_CLOCK": (("orbit_clock_t",), orbit_clock), "IONOSPHERE": (("ionosphere_t",), ionosphere), "ANTENNA": (("antenna_t",), antenna),
    "CORRECTED_STATES": (("corrected_states_t",), corrected_states), "BIASES": (("biases_t",), biases),
    "COMMAND": (("command_t",), command), "ODOMETER": (("odometer_t",), odometer),
    "CHECKPOINT": (("checkpoint_t", "checkpoint_v2_t", "checkpoint_v1_t"), checkpoint), "SOLUTION": (("solution_t", "solution_v1_t"), solution),
    "EPOCH": (("epoch_t", "epoch_v1_t"), epoch), "CONSTRAINTS": (("constraints_t",), constraints), "EVENT": (("event_t",), event),
    "DECISION": (("decision_t",), decision), "SMOOTHER": (("smoother_t", "smoother_v1_t"), smoother),
    "SMOOTHED": (("solution_t", "solution_v1_t"), solution), "HEALTH": (("health_t",), health), "STREAMS": (("streams_t",), streams),
    "CONFIG": (("config_t",), config), "END": (("end_t",), end),
    "PIECE": (("piece_t",), piece), "REFUSED": (("refused_t",), refused), "LOST": (("lost_t",), lost)}
