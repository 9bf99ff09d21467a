"""Names of the numbers in messages, as the tables of leonav-replay show them.

Each list is in the order of an enumeration of core; numbers are only ever added at the end. A number that is in no list is shown
as "unknown".
"""
import numpy as np

SOURCES = ("none", "aligning", "ins", "ekf", "smoother")  # core/navigator/interface/solution.cc
SYSTEMS = ("gps", "galileo", "beidou", "leo")  # core/gnss/signals/satellite.cc
OBSERVABLES = ("code", "carrier", "doppler")  # core/gnss/measurement/measurement.cc
REASONS = ("used", "downweighted", "outlier", "system_disabled", "no_ephemeris", "ephemeris_too_old", "unhealthy", "low_elevation",
           "low_cn0", "no_usable_signal", "implausible", "satellite_cap", "capacity", "no_position", "not_solved", "faulty")
SLIP_CAUSES = ("gap", "signal_changed", "loss_of_lock", "lock_time", "geometry_free", "melbourne_wuebbena", "doppler",
               "half_cycle", "range_change", "filter", "clock_jump", "untested")  # core/gnss/signals/slip_cause.cc, bits
EVENTS = ("rejected_input", "deadline_miss", "filter_reset", "aligned", "imu_gap", "late_epoch", "empty_epoch", "solution_jump",
          "capacity", "improbable", "orbit_fallback", "orbit_return", "clock_step", "none_usable", "clock_fallback",
          "clock_return", "smoother_failed", "source_change", "constraints_left_out", "convention_suspect", "outage_over",
          "reconverged", "checkpoint", "satellite_fault", "prediction_widened", "command",
          "orbit_refused")  # core/navigator/interface/event.cc
# tools/replay/result_files.cc
STAGES = ("sequencer", "inertial", "gnss", "smoother")
ORBIT_SOURCES = ("none", "broadcast", "precise")
CONSTRAINTS = ("side", "vertical", "standing_x", "standing_y", "standing_z", "standing_rate_x", "standing_rate_y",
               "standing_rate_z", "odometer")
MAILBOXES = ("filter", "smoother", "keyframe")  # docs/operations/channels.md
SMOOTHER_STATUS = ("ok", "no_filter", "started", "singular", "diverged", "few_satellites")
COMMANDS = ("restart", "set_heading")
EPHEMERIS_MESSAGES = ("lnav", "inav", "fnav", "d1", "d2")


def named(numbers, names):
    """Returns the names of an array of numbers."""
    numbers = np.asarray(numbers, dtype=np.int64)
    known = (numbers >= 0) & (numbers < len(names))
    return np.array([*names, "unknown"], dtype=object)[np.where(known, numbers, len(names))]


def satellite_names(systems, numbers):
    """Returns "G05", "E11", "C29"; the names of LEO satellites continue from L99 with M00."""
    pairs = np.stack([np.asarray(systems, dtype=np.int64), np.asarray(numbers, dtype=np.int64)], axis=-1).reshape(-1, 2)
    unique, inverse = np.unique(pairs, axis=0, return_inverse=True)
    return np.array([_satellite_name(*pair) for pair in unique.tolist()], dtype=object)[inverse.reshape(-1)]


def _satellite_name(system, number):
    if system == 3 and 0 < number < 400:
        return f"{'LMNO'[number // 100]}{number % 100:02d}"
    return f"{'GEC'[system]}{number:02d}" if 0 <= system < 3 and 0 < number < 100 else "unknown"


def signal_names(bands, attributes):
    """Returns "1C", "5Q"; empty where no signal is named."""
    pairs = np.stack([np.asarray(bands, dtype=np.int64), np.asarray(attributes, dtype=np.int64)], axis=-1).reshape(-1, 2)
    unique, inverse = np.unique(pairs, axis=0, return_inverse=True)
    texts = ["".join(chr(one) for one in pair if 32 < one < 127) for pair in unique.tolist()]
    return np.array(texts, dtype=object)[inverse.reshape(-1)]


def slip_cause_names(bits):
    """Returns "geometry_free|doppler" of a sum of causes; empty if there is none."""
    unique, inverse = np.unique(np.asarray(bits, dtype=np.int64), return_inverse=True)
    texts = ["|".join(name for bit, name in enumerate(SLIP_CAUSES) if value >> bit & 1) for value in unique.tolist()]
    return np.array(texts, dtype=object)[inverse.reshape(-1)]
