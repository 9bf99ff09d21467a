"""Reads files of leonav-export with mcap, mcap-ros2-support, rosbags and gpxpy (PyPI) and compares them with the solution.

  export.py SOLUTION.csv DRIVE.mcap DRIVE.gpx
"""
import csv
import pathlib
import sys

import gpxpy
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_typestore


def close(what, got, wanted, margin):
    if abs(got - float(wanted)) > margin:
        sys.exit(f"{what}: {got} instead of {wanted}")


def check_fix(message, row):
    close("latitude", message.latitude, row["latitude_deg"], 1e-9)
    close("longitude", message.longitude, row["longitude_deg"], 1e-9)
    close("height", message.altitude, row["height_m"], 1e-6)
    for index, name in ((0, "std_east_m"), (4, "std_north_m"), (8, "std_down_m")):
        close(name, message.position_covariance[index], float(row[name]) ** 2, 1e-9)


def by_mcap(path, rows):
    """Both read every message; the first decodes by the file's own definitions, the second by those of ROS 2."""
    with open(path, "rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        fixes = []
        odometries = 0
        for _, channel, message, decoded in reader.iter_decoded_messages():
            if channel.topic == "/leonav/fix":
                fixes.append(decoded)
                if decoded.header.stamp.sec * 10**9 + decoded.header.stamp.nanosec != message.log_time:
                    sys.exit("the stamp is not the log time")
            odometries += channel.topic == "/leonav/odometry"
        statistics = reader.get_summary().statistics
    if len(fixes) != len(rows) or statistics.message_count != 2 * len(rows) + odometries:
        sys.exit(f"mcap: {len(fixes)} fixes of {len(rows)}")
    for fix, row in zip(fixes, rows):
        check_fix(fix, row)
    return len(fixes), odometries


def by_rosbags(path, rows):
    store, counts = get_typestore(Stores.ROS2_HUMBLE), {"/leonav/fix": 0, "/leonav/odometry": 0, "/leonav/source": 0}
    with Reader(pathlib.Path(path)) as reader:
        for connection, _, data in reader.messages():
            message = store.deserialize_cdr(data, connection.msgtype)
            if bytes(store.serialize_cdr(message, connection.msgtype)) != bytes(data):
                sys.exit(f"rosbags: {connection.topic} is other bytes when it is written again")
            if connection.topic == "/leonav/fix":
                check_fix(message, rows[counts[connection.topic]])
            counts[connection.topic] += 1
    return counts


def by_gpxpy(path, rows):
    with open(path, encoding="utf-8") as file:
        gpx = gpxpy.parse(file)
    points = [point for track in gpx.tracks for segment in track.segments for point in segment.points]
    if len(points) != len(rows):
        sys.exit(f"gpxpy: {len(points)} points of {len(rows)}")
    for point, row in zip(points, rows):
        close("latitude", point.latitude, row["latitude_deg"], 1e-9)
        close("longitude", point.longitude, row["longitude_deg"], 1e-9)
        close("height", point.elevation, row["height_m"], 1e-3)
    return len(points), sum(len(track.segments) for track in gpx.tracks)


def main():
    with open(sys.argv[1], encoding="ascii", newline="") as file:
        rows = list(csv.DictReader(file))
    fixes, odometries = by_mcap(sys.argv[2], rows)
    print(f"mcap, mcap-ros2-support: {fixes} fixes, {odometries} odometries")
    print("rosbags:", by_rosbags(sys.argv[2], rows))
    print("gpxpy: {} points in {} segments".format(*by_gpxpy(sys.argv[3], rows)))


main()
