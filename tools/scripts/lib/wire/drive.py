"""A simulated drive as the bytes of a receiver, an inertial sensor and a correction service."""
import math
import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[4]
sys.path += [str(ROOT / "test/tools/connect"), str(ROOT / "tools/scripts/lib")]
import oem7_bytes  # noqa: E402
import rtcm3_bytes  # noqa: E402
import sbf_bytes  # noqa: E402
import ssr_from_products  # noqa: E402
import ubx_bytes  # noqa: E402
import vectornav_bytes  # noqa: E402

WEEK_S = 604800
UNIX_GPS_S = 315964800
LEAP_SECONDS = 18
# From the instant of a measurement to its last byte; the defaults of leonav-connect, and what the rows configure.
GNSS_LATENCY_S, IMU_LATENCY_S = 0.05, 0.004


def host_gps_s():
    """GPS time by the host's clock: RTCM 3 gives no week, so a live stream has to be of today."""
    return int(time.time()) - UNIX_GPS_S + LEAP_SECONDS


class Drive:
    """Files of leonav-sim; times of messages are s since the first epoch."""

    def __init__(self, bin_dir, folder, duration_s, start_gps_s=None, settings=()):
        self.folder, self.start = folder, host_gps_s() // 60 * 60 if start_gps_s is None else start_gps_s
        folder.mkdir(parents=True, exist_ok=True)
        keys = [f"duration_s={duration_s}", "route.standing_s=5", "truth_interval_s=0.1", f"start_gps_week={self.start // WEEK_S}",
                f"start_gps_tow_s={self.start % WEEK_S}", "satellites.leo.enabled=false",
                *(f"satellites.{system}.clock_interval_s=10" for system in ("gps", "galileo")), *settings]
        command = [bin_dir / "leonav-sim", ROOT / "config/scenario/open_sky.yaml", "--export", folder / "export", "-o", folder / "run.lcmlog"]
        done = subprocess.run([*command, *(word for key in keys for word in ("--set", key))], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"leonav-sim: {done.stderr}")
        self.truth = folder / "export/truth.csv"
        self.epochs = list(ubx_bytes.epochs(folder / "export/run.obs"))
        self.first = self.epochs[0][0][0] + self.epochs[0][0][1]
        self.navigation = folder / "export/run.nav"

    def since(self, time_of_epoch):
        return time_of_epoch[0] + time_of_epoch[1] - self.first

    def receiver(self, encode, broadcasts, restarts=(), cut=(0, 0)):
        """(s, epoch as `encode` makes it of instant, satellites and locks), and (s, message) of what the satellites send: after the
        start and again after each of the `restarts`, s. Within `cut`, s, the antenna is, and epochs have no signals.
        """
        locks, begun, out = {}, [], []
        waiting = sorted(broadcasts(self.navigation, self.epochs[0][0][0]))
        for instant, satellites in self.epochs:
            now = self.since(instant)
            for restart in restarts:
                if now >= restart and restart not in begun:
                    begun.append(restart)
                    locks.clear()
                    waiting = sorted(broadcasts(self.navigation, instant[0]))
            is_cut = cut[0] <= now < cut[1]
            out.append((now + GNSS_LATENCY_S, encode(instant, {} if is_cut else satellites, locks)))
            while waiting and waiting[0][0] <= instant[0]:
                out.append((now + GNSS_LATENCY_S, waiting.pop(0)[1]))
            if is_cut:
                locks.clear()
        return out

    def ubx(self, leap_seconds=lambda now: 18, **keys):
        encode = lambda instant, satellites, locks: ubx_bytes.rawx(instant, satellites, locks, leap_seconds(self.since(instant)))
        return self.receiver(encode, ubx_bytes.broadcasts, **keys)

    def oem7(self, **keys):
        return self.receiver(oem7_bytes.epoch, oem7_bytes.broadcasts, **keys)

    def sbf(self, **keys):
        return self.receiver(sbf_bytes.epoch, sbf_bytes.broadcasts, **keys)

    def ubx_at(self, change):
        """(s, RAWX) whose times are what `change` makes of the epochs'."""
        return [(self.since(instant) + GNSS_LATENCY_S, ubx_bytes.rawx(change(instant), satellites, {})) for instant, satellites in self.epochs]

    def strongest(self, system, s):
        """The satellite of the system that arrives best at an epoch."""
        satellites = next(satellites for instant, satellites in self.epochs if self.since(instant) >= s)
        strength = lambda name: max((value[0] for code, value in satellites[name].items() if code[0] == "S" and value), default=0.0)
        return max((name for name in satellites if name[0] == system), key=strength)

    def rtcm3(self, station=1):
        """(s, MSM7 of one epoch), and every ephemeris each 30 s."""
        receiver, out = rtcm3_bytes.Receiver(station), []
        for index, (instant, satellites) in enumerate(self.epochs):
            now = self.since(instant) + GNSS_LATENCY_S
            out.append((now, receiver.epoch(instant, satellites)))
            if index % 30 == 1:
                out += [(now, message) for message in self.ephemerides(instant[0]).values()]
        return out

    def ephemerides(self, gps_s):
        return rtcm3_bytes.ephemerides(self.navigation, gps_s)

    def vectornav(self, kind="gps", clock=None):
        """(s, message); `clock`: what the sensor's own clock shows, s, of the s since its first sample, for the kind startup."""
        messages = vectornav_bytes.messages(self.folder / "export/imu.csv", kind, clock=clock)
        return [(time_ns * 1e-9 - self.first + IMU_LATENCY_S, data) for time_ns, data in messages]

    def corrections(self, change=lambda kind, system, rows, t: rows, tag_s=0):
        """(s, message): ephemerides and SSR orbits each 30 s and clocks each 10 s, made of the precise products.

        `change` gets ("orbit" or "clock", system, rows, GPS s) and returns the rows that are sent. `tag_s` is added to the time
        of every message: its contents are then of another time.
        """
        ssr = ssr_from_products
        sets = ssr.read_nav(self.navigation)
        orbits = ssr.read_sp3(sorted((self.folder / "export").glob("*.sp3")))
        clocks = ssr.read_clk(self.folder / "export/run.clk")
        satellites = sorted(set(sets) & set(orbits) & set(clocks))
        begin = math.ceil(self.first / 10) * 10  # where the product has its clocks
        # A service goes on with the issue before until users have had the new one for a while.
        out = [(begin - self.first, message) for message in self.ephemerides(begin - ssr.SETTLED_S).values()]
        for t in range(begin, math.floor(self.first + self.since(self.epochs[-1][0])), 10):
            in_force = {satellite: s for satellite in satellites if (s := ssr.chosen_set(sets[satellite], t))}
            if t % 30 == 0 or t == begin:
                out += [(t - self.first, message) for message in self.ephemerides(t).values()]
                for system in "GE":
                    rows = change("orbit", system, ssr.orbit_rows(system, t, orbits, in_force, 30), t)
                    out.append((t - self.first, ssr.encode_orbits(system, t + tag_s, rows, 30)))
            for system in "GE":
                rows = change("clock", system, ssr.clock_rows(system, t, orbits, clocks, in_force), t)
                out.append((t - self.first, ssr.encode_clocks(system, t + tag_s, rows)))
        return out
