"""Takes what a report needs out of a journal, with the Python package of leonav."""
import os
import warnings

import numpy as np
from leonav import pieces

from .errors import ReportError
from .gaps import solution_gaps
from .tables import POSITION, SOLUTION, Table

SYNC = b"\xed\xa1\xda\x01"
INPUTS = ("IMU", "GNSS_EPOCH", "ODOMETER", "CORRECTED_STATES", "ORBIT_CLOCK", "EPHEMERIS")
OUTPUTS = ("SOLUTION", "EPOCH", "EVENT", "DECISION", "HEALTH")
SHOWN_HZ = 10.0  # of a solution at the IMU's rate; no picture has more pixels


def name_of(path):
    """The path under which a journal is: its first piece is renamed where it is kept after a fault."""
    return pieces.name_of(path)


def is_journal(path):
    """Whether a file begins as an LCM event log does, or a folder holds such pieces of a journal."""
    if os.path.isdir(path):
        return any(pieces.piece_of(os.path.join(path, name)) is not None for name in sorted(os.listdir(path)))
    try:
        with open(path, "rb") as file:
            return file.read(len(SYNC)) == SYNC
    except OSError as error:
        raise ReportError(f"{path}: {error.strerror}; check the path") from error


def read_into(run, path, prefix, tell):
    """Fills the members of a run that are not known yet. `tell` is called with sentences about what could not be read."""
    try:
        import leonav
        from leonav import read_log
    except ImportError as missing:
        raise ReportError(f"{path}: {missing}; a journal needs python3-pandas") from missing
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always", leonav.LeonavWarning)
        try:
            log = read_log(path, OUTPUTS + INPUTS, prefix, damaged="skip")
        except leonav.LeonavError as error:
            raise ReportError(str(error)) from error
    for one in told:
        if issubclass(one.category, leonav.LeonavWarning):
            tell(str(one.message))
            run.missing.append(str(one.message))

    def table(name, *wanted):
        frame = log.get(name)
        if frame is None or not len(frame):
            return None
        names = [one for one in ("gps_week", "gps_tow_s") + wanted if one in frame.columns]
        found = Table(path, {one: frame[one].to_numpy() for one in names})
        return found if len(found) else None

    if run.solution is None and "SOLUTION" in log:
        _read_solution(run, table("SOLUTION", *SOLUTION[2:], "source"))
    for member, name, wanted in (
            ("satellites", "EPOCH_SATELLITES", ("satellite", "reason", "elevation_deg", "azimuth_deg", "cn0_dbhz")),
            ("measurements", "EPOCH_MEASUREMENTS", ("satellite", "observable", "signals", "innovation_sigma", "reason", "residual")),
            ("epochs", "EPOCH", ("satellites", "pdop")), ("events", "EVENT", ("event",)),
            ("decisions", "DECISION", ("mailbox", "committed")),
            ("health", "HEALTH", ("status", "why", "ekf_misses", "smoother_misses", "worst_ekf_ms", "worst_solve_ms"))):
        if getattr(run, member) is None:
            setattr(run, member, table(name, *wanted))
            if getattr(run, member) is None:
                run.missing.append(f"no {name.split('_')[0]} in {path}: {member} are not shown; is it the journal of leonavd?")
    tables = {name: table(name) for name in INPUTS}
    run.inputs = {name: np.unique(one.time) for name, one in tables.items() if one is not None}


def _read_solution(run, stream):
    """The solutions that have a position, thinned; gaps are found before."""
    if stream is None:
        return
    stream = stream.rows((stream["source"] != "none") & np.isfinite(stream[POSITION[2]] + stream[POSITION[3]] + stream[POSITION[4]]))
    if not len(stream):
        return
    run.solution_gaps, run.continuous = solution_gaps(stream), True
    slot, source = np.floor(stream.time * SHOWN_HZ), stream["source"]
    first = np.concatenate([[True], (slot[1:] != slot[:-1]) | (source[1:] != source[:-1])])
    if len(run.solution_gaps):
        first |= np.isin(stream.time, run.solution_gaps)
    first[-1] = True
    run.solution = stream.rows(first)
