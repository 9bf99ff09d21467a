"""The faults: what each does to the bytes, and what has to follow."""
import dataclasses
import math
import random

from damage import between, flipped, halved, lengthened, merged, misread, without
from drive import WEEK_S, host_gps_s

# s since the first epoch: the drive, the fault within it, and from when on errors count.
DURATION_S, BEGIN_S, END_S, SETTLED_S = 150, 60, 90, 45
UBX, RTCM3, OEM7, SBF = "format: ubx", "format: rtcm3", "format: oem7", "format: sbf"
IMU, SERVICE = "format: vectornav", "format: rtcm3, corrections: true"
LEAP_SECOND_GPS_S = 1167264017  # 2017-01-01 00:00:00 UTC: the 17 s before became 18


@dataclasses.dataclass
class Expected:
    """A run fails where one of these does not hold. Patterns are searched for in the lines of the logs."""
    connect: tuple = ()  # said by leonav-connect from the fault's begin on
    within_s: float = 20.0
    health: tuple = ()  # said by leonavd from the fault's begin on
    never: tuple = ()  # not said by either from the fault's begin on
    worst_m: float = 4.0  # largest 3D error from SETTLED_S on
    sigmas: float = 5.0  # largest error over its 1 sigma
    gap_s: float = 0.5  # longest time without a solution
    recovered_s: float = 10.0  # after the fault's end the error is below LIMIT_M for good
    corrected: tuple = ()  # least share of corrected satellites (before, during, at the end), of those with corrections


LIMIT_M = 2.5


@dataclasses.dataclass
class Row:
    name: str
    text: str  # of the table
    make: object  # a function of a Scene that returns what is Made
    expected: Expected
    duration_s: int = DURATION_S
    begin_s: float = BEGIN_S
    end_s: float = END_S
    settled_s: float = 0.0  # from when on errors count; 0: SETTLED_S, and before the fault


@dataclasses.dataclass
class Made:
    drive: object
    streams: dict  # name: (keys, stream)
    actions: tuple = ()  # (s, what is called, name of the stream's source, "names" or "clock")
    casters: dict = dataclasses.field(default_factory=dict)  # name of a stream that comes from a caster: its host
    has_name_server: bool = False  # one of the row's own, "names"
    clock: tuple = ()  # of the host, "clock": by how many days it is wrong where it is, and whether at the start
    connect_keys: tuple = ()
    daemon_options: tuple = ()
    recorded: bool = False


@dataclasses.dataclass
class Scene:
    """Where a row makes its drive, and when its fault is."""
    new_drive: object
    begin_s: float
    end_s: float

    def during(self, change):
        return between(self.begin_s, self.end_s, change)

    def inside(self, stream):
        return [item for item in stream if self.begin_s <= item[0] < self.end_s]

    def outside(self, stream):
        return without(self.begin_s, self.end_s)(stream)


def plain(scene, receiver=lambda stream: stream, imu=lambda stream: stream):
    """UBX and VectorNav with GPS time, each after a change."""
    drive = scene.new_drive()
    return Made(drive, {"receiver": (UBX, receiver(drive.ubx())), "imu": (IMU, imu(drive.vectornav()))})


def on_both(change):
    def make(scene):
        dice = random.Random(7)
        return plain(scene, scene.during(change(dice)), scene.during(change(dice)))
    return make


def on_receiver(change):
    return lambda scene: plain(scene, receiver=scene.during(change))


def on_imu(change):
    return lambda scene: plain(scene, imu=scene.during(change))


# The receivers by their formats.
RECEIVERS = {"ubx": (UBX, lambda drive: drive.ubx), "rtcm3": (RTCM3, lambda drive: drive.rtcm3), "oem7": (OEM7, lambda drive: drive.oem7),
             "sbf": (SBF, lambda drive: drive.sbf)}


def sends(kind, change=lambda dice: lambda data: data):
    """A receiver of another format, with a change of its bytes."""
    def make(scene):
        drive, (keys, stream_of) = scene.new_drive(), RECEIVERS[kind]
        return Made(drive, {"receiver": (keys, scene.during(change(random.Random(7)))(stream_of(drive)())), "imu": (IMU, drive.vectornav())})
    return make


def with_long_lengths(kind):
    return sends(kind, lambda dice: lengthened(kind))


def antenna_cut(kind):
    """The receiver goes on with epochs without signals; then all carriers are locked anew, and the satellites' messages come again."""
    def make(scene):
        drive, (keys, stream_of) = scene.new_drive(), RECEIVERS[kind]
        stream = stream_of(drive)(cut=(scene.begin_s, scene.end_s), restarts=(scene.end_s,))
        return Made(drive, {"receiver": (keys, stream), "imu": (IMU, drive.vectornav())})
    return make


def other_station(number):
    """The caster sends what a station with this number, 11 km to the north, receives."""
    def make(scene):
        drive = scene.new_drive()
        other = scene.new_drive(name="other", start_gps_s=drive.start, settings=("route.origin_latitude_deg=40.0065",))
        stream = merged(scene.outside(drive.rtcm3()), scene.inside(other.rtcm3(number)))
        return Made(drive, {"receiver": (RTCM3, stream), "imu": (IMU, drive.vectornav())}, casters={"receiver": "127.0.0.1"})
    return make


WEEK_END_S = 6 * 3600


def host_clock(days, is_wrong_at_start=False):
    """The host's clock, of which RTCM 3 has its week, is wrong by days from the fault's begin to its end."""
    def make(scene):
        start = host_gps_s() // 60 * 60
        # Within hours of a week's end an ephemeris may rightly state either week: the drive is further away.
        past_end = (start + WEEK_S // 2) % WEEK_S - WEEK_S // 2
        if abs(past_end) < WEEK_END_S:
            start += (WEEK_END_S if past_end >= 0 else -WEEK_END_S) - past_end
        drive = scene.new_drive(start_gps_s=start)
        actions = (() if is_wrong_at_start else ((scene.begin_s, "wrong", "clock"),)) + ((scene.end_s, "right", "clock"),)
        return Made(drive, {"receiver": (RTCM3, drive.rtcm3()), "imu": (IMU, drive.vectornav())}, actions=actions, clock=(days, is_wrong_at_start))
    return make


def mixed(scene):
    """Sentences, RTCM 3 and the sensor's messages come between the receiver's own, and those of the receiver between the sensor's."""
    drive = scene.new_drive()
    sentence = b"$GNGGA,120000.00,3954.39,N,11626.19,E,4,12,0.6,50.0,M,-9.0,M,1.0,0000*6D\r\n"
    ubx, imu = drive.ubx(), drive.vectornav()
    sentences = [(t + 0.01, sentence) for t, _ in scene.inside(ubx)]
    return Made(drive, {"receiver": (UBX, merged(ubx, scene.inside(drive.rtcm3()), sentences, scene.inside(imu)[::20])),
                        "imu": (IMU, merged(imu, scene.inside(ubx), sentences))})


def swapped(scene):
    """Each device is on the other's port."""
    drive = scene.new_drive()
    ubx, imu = drive.ubx(), drive.vectornav()
    return Made(drive, {"receiver": (UBX, merged(scene.outside(ubx), scene.inside(imu))), "imu": (IMU, merged(scene.outside(imu), scene.inside(ubx)))})


def restarted(scene):
    drive = scene.new_drive()
    return Made(drive, {"receiver": (UBX, scene.outside(drive.ubx(restarts=(scene.end_s,)))), "imu": (IMU, drive.vectornav())})


def restarted_without_time(scene):
    """For five seconds the receiver gives the time of its clock, which begins at the week of its firmware."""
    drive = scene.new_drive()
    stream = scene.outside(drive.ubx(restarts=(scene.end_s,)))
    wrong = drive.ubx_at(lambda instant: (2200 * WEEK_S + instant[0] - drive.epochs[0][0][0], instant[1]))
    return Made(drive, {"receiver": (UBX, merged(stream, [item for item in wrong if scene.end_s - 5 <= item[0] < scene.end_s])),
                        "imu": (IMU, drive.vectornav())})


def over_the_week(make_receiver):
    def make(scene):
        week_end = round(host_gps_s() / WEEK_S) * WEEK_S
        drive = scene.new_drive(start_gps_s=week_end - scene.begin_s)
        return Made(drive, {"receiver": make_receiver(drive), "imu": (IMU, drive.vectornav())})
    return make


def over_the_leap_second(scene):
    """By the host's clock, which has counted from before the leap second on: recordings of 2016-12-31."""
    drive = scene.new_drive(start_gps_s=LEAP_SECOND_GPS_S - scene.begin_s)
    stream = drive.ubx(leap_seconds=lambda t: 17 if t < scene.begin_s else 18)
    return Made(drive, {"receiver": (UBX, stream), "imu": (IMU + ", latency_ms: 4", drive.vectornav("startup", lambda passed: passed))},
                connect_keys=("time: {reference: host}",), recorded=True)


def own_clock(shown):
    """`shown(passed s, s of the fault's begin)`: what the sensor's clock shows."""
    def make(scene):
        drive = scene.new_drive()
        imu = drive.vectornav("startup", lambda passed: shown(passed, scene.begin_s))
        return Made(drive, {"receiver": (UBX, drive.ubx()), "imu": (IMU + ", latency_ms: 4", imu)})
    return make


def corrected(change_of=None, tag_s=0, is_gone=False, names_are_gone=False):
    """With a correction service; `change_of` gives for a drive what is done to the corrections from the fault's begin to its end.

    `names_are_gone`: the caster breaks off, and the name server, of which its address comes, is mute.
    """
    def make(scene):
        drive = scene.new_drive()
        stream = drive.corrections()
        if change_of or tag_s:
            wrong = drive.corrections(change_of(drive, scene), tag_s) if change_of else drive.corrections(tag_s=tag_s)
            stream = merged(scene.outside(stream), scene.inside(wrong))
        actions = ((scene.begin_s, "down", "service"), (scene.end_s, "up", "service")) if is_gone else ()
        if names_are_gone:
            actions = ((scene.begin_s, "mute", "names"), (scene.begin_s, "down", "service"), (scene.begin_s + 0.1, "up", "service"),
                       (scene.end_s, "speak", "names"))
        return Made(drive, {"receiver": (UBX, drive.ubx()), "imu": (IMU, drive.vectornav()), "service": (SERVICE, stream)}, actions=actions,
                    casters={"service": "caster.example" if names_are_gone else "127.0.0.1"}, has_name_server=names_are_gone)
    return make


def other_issue(*_):
    def change(kind, system, rows, t):
        if kind == "clock":
            return rows
        return [(satellite, {**broadcast, "iode": (int(broadcast["iode"]) + 77) % 256}, *rest) for satellite, broadcast, *rest in rows]
    return change


def unknown_satellites(*_):
    """The numbers 60 and above belong to no satellite of these systems."""
    return lambda kind, system, rows, t: rows + [(f"{system}{60 + index}", *row[1:]) for index, row in enumerate(rows[:3])]


def one_clock_off(drive, scene):
    satellite = drive.strongest("G", scene.begin_s)
    return lambda kind, system, rows, t: rows if kind == "orbit" else [(name, clock + (15.0 if name == satellite else 0.0)) for name, clock in rows]


def all_orbits_off(*_):
    """Along the track, in the same sense for all."""
    def change(kind, system, rows, t):
        if kind == "clock":
            return rows
        return [(satellite, broadcast, (d[0], d[1] + 15.0, d[2]), rate) for satellite, broadcast, d, rate in rows]
    return change


# What neither program says while all is well.
QUIET = (r": (silent|unreadable|no data|damaged|waiting)", "FAULT", "DEGRADED: (INS|no usable|no solution)")
ALIGNS_AGAIN_S = 70  # after half a minute without the sensor


def quiet(**keys):
    return Expected(never=QUIET, **keys)


def told(connect=(), health=(), **keys):
    return Expected(connect=connect, health=health, **keys)


# Orbits are sent at 29, 59, 89, ... s: the times of the product.
SSR_SPAN = {"begin_s": 58, "end_s": 148, "duration_s": 210}
GNSS_GONE = ("no usable GNSS",)
STEPPED, OTHER_WEEK = r"receiver: .*its time has stepped 1 times", r"receiver: .*ephemerides are of another week than the host's clock shows"
# All codes agree on another place, and nothing contradicts them but the way there: the solution goes along, and comes back.
AT_OTHER_STATION = {"worst_m": 11200.0, "sigmas": math.inf, "recovered_s": 15.0}
DAMAGED = r"receiver: (damaged|unreadable): .*is the cable good"
IMU_GONE = ("no usable IMU",)
ROWS = [
    Row("none", "none", plain, quiet()),
    Row("none-rtcm3", "none, the receiver sends RTCM 3", sends("rtcm3"), quiet()),
    Row("none-oem7", "none, the receiver sends NovAtel's logs", sends("oem7"), quiet()),
    Row("none-sbf", "none, the receiver sends Septentrio's blocks", sends("sbf"), quiet()),
    Row("flips-1e-4", "one byte of 10,000 flipped", on_both(lambda dice: flipped(1e-4, dice)), told((r"imu: good, .* [1-9]\d* damaged",))),
    Row("flips-1e-3", "one byte of 1,000 flipped", on_both(lambda dice: flipped(1e-3, dice)), told((r"receiver: damaged: .* is the cable good",), GNSS_GONE)),
    Row("flips-1e-2", "one byte of 100 flipped", on_both(lambda dice: flipped(1e-2, dice)),
        told((r"receiver: unreadable: .* is the cable good", r"imu: damaged: .* is the cable good"), GNSS_GONE, recovered_s=15)),
    Row("flips-rtcm3", "one byte of 1,000 flipped, RTCM 3", sends("rtcm3", lambda dice: flipped(1e-3, dice)), told((DAMAGED,))),
    Row("flips-oem7", "one byte of 1,000 flipped, NovAtel", sends("oem7", lambda dice: flipped(1e-3, dice)), told((DAMAGED,), GNSS_GONE)),
    Row("flips-sbf", "one byte of 1,000 flipped, Septentrio", sends("sbf", lambda dice: flipped(1e-3, dice)), told((DAMAGED,), GNSS_GONE)),
    *(Row(f"length-{kind}", f"a bit of the length flipped in each third message, {text}", with_long_lengths(kind),
          told((DAMAGED,), never=("no usable GNSS",))) for kind, text in
      (("ubx", "UBX"), ("rtcm3", "RTCM 3"), ("oem7", "NovAtel"), ("sbf", "Septentrio"))),
    Row("halves", "half of a third of all messages", on_both(lambda dice: halved(1 / 3, dice)), told((r"receiver: damaged: ", r"imu: damaged: "))),
    Row("mixed", "NMEA, RTCM 3 and the other device's messages between the own", mixed, quiet()),
    Row("swapped", "each device on the other's port", swapped,
        told((r"receiver: unreadable: .* is it a u-blox receiver", "imu: unreadable: .* no valid binary message"), GNSS_GONE + IMU_GONE,
             gap_s=32, worst_m=8, recovered_s=ALIGNS_AGAIN_S)),
    Row("baud-receiver", "the receiver sends at 38,400, the port reads at 460,800", on_receiver(misread(38400, 460800)),
        told((r"receiver: unreadable: .* is the baud rate right",), GNSS_GONE, recovered_s=15)),
    Row("baud-imu", "the sensor sends at 921,600, the port reads at 115,200", on_imu(misread(921600, 115200)),
        told((r"imu: unreadable: .* is the baud rate right",), IMU_GONE, gap_s=32, worst_m=8, recovered_s=ALIGNS_AGAIN_S)),
    Row("restart", "receiver silent, then new locks and ephemerides", restarted, told((r"receiver: silent: .* is the sensor on",), GNSS_GONE, recovered_s=15)),
    Row("restart-no-time", "receiver silent, then five epochs of an old week, new locks and ephemerides", restarted_without_time,
        told((r"receiver: silent: ", r"receiver: .*its time has stepped 2 times"), GNSS_GONE, within_s=35, recovered_s=15)),
    *(Row(f"antenna-{kind}", f"antenna cut: epochs without signals, then new locks, {text}", antenna_cut(kind),
          told((r"receiver: no data: no epoch with signals .* is the antenna connected",), ("DEGRADED: INS only",), recovered_s=15)) for kind, text in
      (("ubx", "UBX"), ("oem7", "NovAtel"), ("sbf", "Septentrio"))),
    Row("station", "RTCM 3: the caster sends another station, 11 km away", other_station(2),
        told((r"receiver: .*its station has changed 1 times, the last from 1 to 2",), ("the solution has jumped",),
             **AT_OTHER_STATION)),
    Row("station-number", "RTCM 3: the caster sends another station with the same number, 11 km away", other_station(1), told((), ("the solution has jumped",), **AT_OTHER_STATION)),
    Row("week-ubx", "week rollover, UBX", over_the_week(lambda drive: (UBX, drive.ubx())), quiet(), end_s=BEGIN_S),
    Row("week-rtcm3", "week rollover, RTCM 3", over_the_week(lambda drive: (RTCM3, drive.rtcm3())), quiet(), end_s=BEGIN_S),
    Row("clock-2-days", "RTCM 3: host's clock steps by 2 days", host_clock(2), quiet()),
    # Ephemerides come at 60, 90 and 120 s: those of 90 s come while the clock is wrong.
    Row("clock-ahead", "RTCM 3: host's clock steps by 5 days", host_clock(5),
        told((STEPPED, OTHER_WEEK), ("GNSS_EPOCH as too_far_ahead",), within_s=40, worst_m=6), end_s=95),
    Row("clock-behind", "RTCM 3: host's clock steps by -5 days", host_clock(-5),
        told((STEPPED, OTHER_WEEK), ("GNSS_EPOCH as ",), within_s=40, worst_m=6), end_s=95),
    Row("clock-start-ahead", "RTCM 3: host's clock wrong by 5 days for a minute from the start on", host_clock(5, True),
        told((OTHER_WEEK,), (r"no solution yet \(all GNSS epochs are rejected as too_far_ahead",)), begin_s=0, end_s=60, settled_s=110),
    Row("clock-start-behind", "RTCM 3: host's clock wrong by -5 days for a minute from the start on", host_clock(-5, True),
        told((OTHER_WEEK,), (r"no solution yet \(all GNSS epochs are rejected as time_backwards",)), begin_s=0, end_s=60, settled_s=110),
    Row("leap-second", "leap second, stamps by the host's clock", over_the_leap_second, Expected(never=QUIET[:1]), end_s=BEGIN_S),
    Row("clock-drift", "sensor's clock 100 ppm fast", own_clock(lambda passed, _: passed * 1.0001), Expected((r"imu: .* drift -(99|100|101)\.\d ppm, 0 steps",), never=QUIET)),
    Row("clock-step", "sensor's clock steps by 0.5 s", own_clock(lambda passed, begin: passed + (0.5 if passed >= begin else 0.0)),
        told((r"imu: .* 1 steps, the last by -0\.(49|50)",), gap_s=6), end_s=BEGIN_S),
    Row("clock-back", "sensor's clock steps by -0.5 s", own_clock(lambda passed, begin: passed - (0.5 if passed >= begin else 0.0)),
        told((r"imu: .* 1 steps, the last by 0\.(49|50)",), gap_s=6), end_s=BEGIN_S),
    Row("ssr-none", "none, with corrections", corrected(), quiet(corrected=((0.9, 1), (0.9, 1), (0.9, 1)))),
    Row("ntrip-gone", "caster gone for ten minutes", corrected(is_gone=True),
        told((r"service: .*nothing listens there",), corrected=((0.9, 1), (0, 0), (0.9, 1))), duration_s=780, end_s=660),
    Row("ntrip-break", "caster gone for a minute and a half", corrected(is_gone=True),
        told((r"service: .*nothing listens there",), corrected=((0.9, 1), (0, 0), (0.9, 1))), **SSR_SPAN),
    Row("name-server", "caster broken off and name server mute for a minute and a half", corrected(names_are_gone=True),
        told((r"service: .*the name server does not answer",), corrected=((0.9, 1), (0, 0), (0.9, 1)),
             never=(r"(receiver|imu): (silent|unreadable|no data|damaged|waiting)", *QUIET[1:])), begin_s=58, end_s=148, duration_s=270),
    Row("ssr-issue", "corrections of another issue", corrected(other_issue),
        told((r"service: no data: .* none can be used .*without their ephemeris",), within_s=50, corrected=((0.9, 1), (0, 0), (0.9, 1))), **SSR_SPAN),
    Row("ssr-stale", "corrections 150 s old", corrected(tag_s=-150),
        told((r"service: no data: .* none can be used .*too old",), within_s=50, corrected=((0.9, 1), (0, 0), (0.9, 1))), **SSR_SPAN),
    Row("ssr-unknown", "corrections for satellites that do not exist", corrected(unknown_satellites),
        quiet(corrected=((0.9, 1), (0.9, 1), (0.9, 1))), **SSR_SPAN),
    Row("ssr-clock", "one satellite's clock correction 15 m off", corrected(one_clock_off),
        Expected(corrected=((0.9, 1), (0.5, 1), (0.9, 1))), **SSR_SPAN),
    Row("ssr-orbits", "all orbit corrections 15 m off along", corrected(all_orbits_off),
        told(health=("precise orbits contradict the broadcast ones",), corrected=((0.9, 1), (0, 1), (0.9, 1))), **SSR_SPAN),
]

# The same in little time, for the test suite.
SHORT = {"short-flips": "flips-1e-3", "short-baud": "baud-receiver", "short-restart": "restart", "short-mixed": "mixed"}


def all_rows():
    short = {name: next(row for row in ROWS if row.name == of) for name, of in SHORT.items()}
    # The heading is not long known by then, so that the sigmas, and errors without GNSS, are larger.
    return ROWS + [dataclasses.replace(row, name=name, duration_s=75, begin_s=35, end_s=50, expected=dataclasses.replace(row.expected, worst_m=20.0))
                   for name, row in short.items()]
