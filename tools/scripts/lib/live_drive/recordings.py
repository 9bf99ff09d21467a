"""What leonav-connect has recorded, as the files that leonav-import reads."""
import csv
import math
import struct

MAGIC = b"leonav recording 1\n"
VECTORNAV = struct.Struct("<xBHQQ7fxx")  # sync, groups, fields; TimeStartup, TimeGps, DeltaTheta; checksum


def stream_bytes(path):
    """The bytes of a recording, without the times of their arrival."""
    data, at, found = path.read_bytes(), len(MAGIC), []
    if data[:at] != MAGIC:
        raise ValueError(f"{path} is no recording")
    while at + 12 <= len(data):
        length = struct.unpack_from("<qI", data, at)[1]
        found.append(data[at + 12:at + 12 + length])
        at += 12 + length
    return b"".join(found)


def imu_csv(data, path):
    """The increments of the drive's VectorNav messages as rates over their interval, which is what imu.csv holds."""
    count = 0
    with open(path, "w", newline="", encoding="ascii") as file:
        rows = csv.writer(file)
        rows.writerow(["gps_week", "gps_tow_s"] + [f"{kind}_{axis}_{unit}" for kind, unit in (("gyro", "rad_s"), ("accel", "m_s2"))
                                                   for axis in "xyz"])
        for at in range(0, len(data) - VECTORNAV.size + 1, VECTORNAV.size):
            _, _, _, gps_ns, interval, *increments = VECTORNAV.unpack_from(data, at)
            week, of_week = divmod(gps_ns, 604800 * 10**9)
            rates = [math.radians(value) / interval for value in increments[:3]] + [value / interval for value in increments[3:]]
            rows.writerow([week, f"{of_week // 10**9}.{of_week % 10**9:09d}"] + [repr(rate) for rate in rates])
            count += 1
    return count


def dataset(out, week_day, latency_s):
    """Writes receiver.ubx, service.rtcm3, imu.csv and dataset.yaml of the recordings in `out`; gives how many bytes each had."""
    sizes = {}
    for stream, name in (("receiver", "receiver.ubx"), ("service", "service.rtcm3"), ("imu", "imu.vn")):
        data = stream_bytes(out / f"{stream}.leoraw")
        (out / name).write_bytes(data)
        sizes[stream] = len(data)
    imu_csv((out / "imu.vn").read_bytes(), out / "imu.csv")
    (out / "dataset.yaml").write_text(f"""name: the recordings of the live drive
date: {week_day}
observations: receiver.ubx
imu: imu.csv
corrections: service.rtcm3
corrections_latency_s: {latency_s}
corrections_point: antenna
""", encoding="ascii")
    return sizes
