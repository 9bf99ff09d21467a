"""A simulated drive as messages: (s since its start, channel, payload), and its truth."""
import fcntl
import hashlib
import pathlib
import struct
import subprocess

import lcm_log

ROOT = pathlib.Path(__file__).resolve().parents[4]
PREFIX = "LEONAV_"
IMU, EPOCH, ORBITS = PREFIX + "IMU", PREFIX + "GNSS_EPOCH", PREFIX + "ORBIT_CLOCK"
PRODUCTS = {PREFIX + name for name in ("EPHEMERIS", "IONOSPHERE", "ORBIT_CLOCK", "CORRECTED_STATES", "BIASES")}
GPS, LEO = 0, 3  # numbers of systems in messages
IMU_INTERVAL_S = 0.005
STANDING_S = 10
WEEK, TOW_S = 2136, 345600  # of the start
START_S = WEEK * 604800 + TOW_S
START_NS = START_S * 10**9
# So that a row shows its fault and not the alignment: the heading is known from the start, as behind a checkpoint.
HEADING_SIGMA_DEG = 1


class Drive:
    """The files of leonav-sim, made once for each list of settings, and again where leonav-sim or the scenario is newer."""

    def __init__(self, bin_dir, folder, duration_s, settings=()):
        keys = [f"duration_s={duration_s}", f"route.standing_s={STANDING_S}", "truth_interval_s=0.1",
                f"start_gps_week={WEEK}", f"start_gps_tow_s={TOW_S}", *settings]
        self.folder = folder / hashlib.sha256("\n".join(keys).encode()).hexdigest()[:12]
        self.log, self.truth = self.folder / "run.lcmlog", self.folder / "truth.csv"
        self.folder.mkdir(parents=True, exist_ok=True)
        simulator, scenario, done_file = bin_dir / "leonav-sim", ROOT / "config/scenario/urban.yaml", self.folder / "done"
        newest = max(file.stat().st_mtime for file in (simulator, scenario))
        with open(self.folder / "lock", "w", encoding="utf-8") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not done_file.exists() or done_file.stat().st_mtime < newest:
                command = [simulator, scenario, "-o", self.log, "--truth", self.truth]
                done = subprocess.run([*command, *(word for key in keys for word in ("--set", key))], capture_output=True, text=True,
                                      check=False)
                if done.returncode != 0:
                    raise RuntimeError(f"leonav-sim: {done.stderr}")
                done_file.write_text("\n".join(keys) + "\n")

    def messages(self):
        """What was there before the start comes at its first instant."""
        first_s = min(wall for wall, channel, _ in lcm_log.messages(self.log) if channel == IMU)
        return [(max(wall - first_s, 0.0), channel, data) for wall, channel, data in lcm_log.messages(self.log)]

    def heading_deg(self):
        with open(self.truth, encoding="utf-8") as file:
            names, first = (next(file).strip().split(",") for _ in range(2))
        return float(first[names.index("yaw_deg")])


def stamp_ns(data):
    """The time of a message, which every type of leonav has first."""
    return struct.unpack_from(">q", data, 8)[0]


def stamped(data, time_ns):
    return data[:8] + struct.pack(">q", time_ns) + data[16:]
