"""What must hold of a live drive: each function prints its numbers and gives the faults that it has found."""
import collections
import datetime
import functools
import json
import math
import operator
import re
import subprocess

import numpy as np

import lcm_log
import leonav

GPS_EPOCH = datetime.datetime(1980, 1, 6)
LEAP_S = 18
EARTH_M = 6378137.0
# The increments of the sensor have 24 bits, 6e-8 of themselves; files and messages hold the same bytes of everything else.
SAME_M, SAME_M_S, SAME_DEG = 0.001, 0.001, 0.0005
# Of codes of 0.3 m with multipath of 0.3 m, some seconds after the start; the sky is the same at every start.
ERROR_M, YAW_DEG, VELOCITY_M_S, SETTLING_EPOCHS = 0.6, 0.5, 0.1, 20
CHANNELS = {"receiver": ["GNSS_EPOCH", "EPHEMERIS", "IONOSPHERE"], "imu": ["IMU"], "service": ["CORRECTED_STATES", "BIASES"]}
# Half of the last digit: of NMEA's minutes and of gpsd's degrees; of NMEA's and gpsd's metres; of NMEA's knots and gpsd's m/s.
PLACE_DEG, HEIGHT_M, SPEED_M_S = 0.5e-6 / 60 + 0.5e-9, 0.0005 + 0.0005, 0.0005 * 1852 / 3600 + 0.0005


def replays(bin_folder, out):
    """The journal of leonavd, byte for byte."""
    done = subprocess.run([bin_folder / "leonav-replay", out / "run.journal", "--out", out / "live", "--verify"], capture_output=True,
                          text=True, check=False)
    (out / "verify.txt").write_text(done.stdout + done.stderr, encoding="utf-8")
    line = next((line for line in done.stdout.splitlines() if "verif" in line.lower() or "outputs" in line.lower()), "")
    print(f"journal: leonav-replay --verify ended with {done.returncode}: {line.strip()}")
    return [] if done.returncode == 0 else ["the journal does not replay byte for byte: " + (out / "verify.txt").read_text("utf-8")[-500:]]


def of_files(bin_folder, out, configuration):
    """leonav-import and leonav-replay on the recorded bytes, into the folder files."""
    with open(out / "import.txt", "w", encoding="utf-8") as text:
        subprocess.run([bin_folder / "leonav-import", out / "dataset.yaml", "-o", out / "files.lcmlog"], check=True, stdout=text, stderr=text)
        subprocess.run([bin_folder / "leonav-replay", "--config", configuration, out / "files.lcmlog", "--out", out / "files"], check=True,
                       stdout=text, stderr=text)


def differences(live, files):
    """Worst differences of position (m), velocity (m/s) and attitude (degrees) at the epochs that both have."""
    both = live.merge(files, on=["gps_week", "gps_tow_s"], suffixes=("", "_f"))
    off = lambda name: (both[name] - both[name + "_f"]).to_numpy()
    north, east = np.radians(off("latitude_deg")) * EARTH_M, np.radians(off("longitude_deg")) * EARTH_M
    east = east * np.cos(np.radians(both["latitude_deg"]))
    place = np.sqrt(north**2 + east**2 + off("height_m")**2)
    velocity = np.sqrt(sum(off(f"v_{axis}_m_s")**2 for axis in ("north", "east", "down")))
    turn = np.max([np.abs((off(f"{angle}_deg") + 180) % 360 - 180) for angle in ("roll", "pitch", "yaw")], axis=0)
    return both, place, velocity, turn


def against_files(out):
    """The solution of the live run and that of its recorded bytes."""
    live, files = (leonav.read_solution(out / name / "solution.csv") for name in ("live", "files"))
    both, place, velocity, turn = differences(live, files)
    attitude = np.isfinite(turn)
    print(f"live against files: {len(live)} and {len(files)} epochs, {len(both)} in both; position within {place.max() * 1e3:.4f} mm, velocity "
          f"within {velocity.max() * 1e3:.4f} mm/s, attitude within {turn[attitude].max() if attitude.any() else math.nan:.6f} degrees; "
          f"source equal at {(both['source'] == both['source_f']).sum()}, satellites at {(both['satellites'] == both['satellites_f']).sum()}")
    faults = []
    if len(both) < 0.95 * max(len(live), len(files)):
        faults.append("live run and files have other epochs")
    if place.max() > SAME_M or velocity.max() > SAME_M_S or not attitude.any() or turn[attitude].max() > SAME_DEG:
        faults.append("the live solution is not that of the recorded bytes")
    return faults


def against_truth(bin_folder, out, configuration, start):
    """leonav-eval from the twentieth epoch with attitude on; beside it the same bytes with the broadcast orbits alone."""
    live = leonav.read_solution(out / "live/solution.csv")
    aligned = live[np.isfinite(live["yaw_deg"])]
    if len(aligned) < SETTLING_EPOCHS + 15:
        return [f"only {len(aligned)} epochs with attitude"]
    seconds = lambda row: row["gps_week"] * 604800 + row["gps_tow_s"]
    first = aligned.iloc[SETTLING_EPOCHS]
    subprocess.run([bin_folder / "leonav-replay", "--config", configuration, "--set", "gnss.ephemerides.use_precise=false",
                    out / "files.lcmlog", "--out", out / "broadcast"], check=True, capture_output=True)
    done = subprocess.run([bin_folder / "leonav-eval", "--truth", out / "export/truth.csv", "--from",
                           f"{int(first['gps_week'])}:{first['gps_tow_s']:.3f}", "--json", out / "errors.json",
                           f"live={out / 'live/solution.csv'}", f"broadcast={out / 'broadcast/solution.csv'}"], capture_output=True, text=True,
                          check=False)
    (out / "errors.txt").write_text(done.stdout + done.stderr, encoding="utf-8")
    if done.returncode != 0:
        return [f"leonav-eval ended with {done.returncode}: {done.stderr}"]
    live, broadcast = json.loads((out / "errors.json").read_text("utf-8"))
    print(f"truth: attitude since {seconds(aligned.iloc[0]) - start:.0f} s after the start; from {seconds(first) - start:.0f} s on, {live['epochs']} "
          f"epochs, root mean square: horizontal {live['horizontal_m']['rmse']:.3f} m, 3D {live['3d_m']['rmse']:.3f} m, velocity "
          f"{live['velocity_m_s']['rmse']:.3f} m/s, yaw {live['yaw_deg']['rmse']:.3f} degrees; within three stated sigma {live['within_three_sigma']:.1%}")
    print(f"the same bytes with broadcast orbits: horizontal {broadcast['horizontal_m']['rmse']:.3f} m, 3D {broadcast['3d_m']['rmse']:.3f} m")
    faults = []
    if live["3d_m"]["rmse"] > ERROR_M or live["yaw_deg"]["rmse"] > YAW_DEG or live["velocity_m_s"]["rmse"] > VELOCITY_M_S:
        faults.append("the error against the truth is beyond its bound")
    if live["3d_m"]["rmse"] >= broadcast["3d_m"]["rmse"]:
        faults.append("corrections do not make the position better than broadcast orbits do")
    return faults


def milliseconds(text):
    """GPS time in ms of gpsd's UTC."""
    return round((datetime.datetime.strptime(text, "%Y-%m-%dT%H:%M:%S.%fZ") - GPS_EPOCH).total_seconds() * 1e3) + LEAP_S * 1000


def gpsd_against(of_journal, name, reports):
    """Every TPV with a fix against the SOLUTION of its time, and satellites in SKY."""
    positions = [one for one in reports if one.get("class") == "TPV" and one.get("mode", 0) >= 2 and "time" in one]
    skies = [one for one in reports if one.get("class") == "SKY" and one.get("satellites")]
    worst, missing, times = {"place": 0.0, "height": 0.0, "speed": 0.0}, 0, set()
    for one in positions:
        at = milliseconds(one["time"])
        row = of_journal.get(at)
        if row is None:
            missing += 1
            continue
        times.add(at)
        worst["place"] = max(worst["place"], abs(one["lat"] - row["latitude_deg"]), abs(one["lon"] - row["longitude_deg"]))
        if "altHAE" in one:
            worst["height"] = max(worst["height"], abs(one["altHAE"] - row["height_m"]))
        if "speed" in one:
            worst["speed"] = max(worst["speed"], abs(one["speed"] - math.hypot(row["v_north_m_s"], row["v_east_m_s"])))
    seen = max((len(one["satellites"]) for one in skies), default=0)
    used = max((sum(satellite["used"] for satellite in one["satellites"]) for one in skies), default=0)
    systems = sorted({satellite.get("gnssid", -1) for one in skies for satellite in one["satellites"]})
    print(f"gpsd ({name}): {len(positions)} TPV of {len(times)} instants, {missing} of times without SOLUTION; latitude and longitude within "
          f"{worst['place']:.2e} degrees, height within {worst['height'] * 1e3:.2f} mm, speed within {worst['speed'] * 1e3:.2f} mm/s; "
          f"{len(skies)} SKY with up to {seen} satellites, {used} used, gnssid {systems}")
    faults = []
    if missing or worst["place"] > PLACE_DEG or worst["height"] > HEIGHT_M or worst["speed"] > SPEED_M_S:
        faults.append(f"gpsd ({name}) does not report the solution")
    if used < 8 or systems != [0, 2]:
        faults.append(f"gpsd ({name}) does not report the satellites of GPS and Galileo")
    return faults, len(times)


def solutions(out):
    """{GPS time in ms: SOLUTION} of the journal, from the first position on."""
    table = leonav.read_log(out / "run.journal", ["SOLUTION"])["SOLUTION"]
    table = table[table["source"] != "none"]
    at = (table["gps_week"] * 604800000 + (table["gps_tow_s"] * 1e3).round()).astype(np.int64)
    columns = ["latitude_deg", "longitude_deg", "height_m", "v_north_m_s", "v_east_m_s"]
    return dict(zip(at, table[columns].to_dict("records")))


def gpsd(of_journal, readers, duration_s):
    """The reports of every gpsd against the journal's SOLUTION."""
    faults = []
    for name, reader in readers.items():
        found, instants = gpsd_against(of_journal, name, reader.read())
        faults += found
        if instants < 0.6 * duration_s:
            faults.append(f"gpsd ({name}) reported only {instants} instants of {duration_s} s")
    return faults


def degrees(text, letter):
    point = text.index(".")
    return (int(text[:point - 2]) + float(text[point - 2:]) / 60) * (-1 if letter in "SW" else 1)


def nmea(of_journal, data, duration_s):
    """What came out of the serial port: checksums, and each GGA against the SOLUTION of its time of day."""
    by_day = {(at - LEAP_S * 1000) % 86400000: row for at, row in of_journal.items()}
    worst, instants, sentences = 0.0, 0, 0
    for line in data.decode("ascii", "replace").split("\r\n")[:-1]:
        body, _, checksum = line[1:].partition("*")
        if line[:1] != "$" or f"{functools.reduce(operator.xor, body.encode()):02X}" != checksum:
            return [f"the serial port has a bad sentence: {line}"]
        sentences += 1
        fields = body.split(",")
        if fields[0] != "GNGGA" or fields[6] == "0":
            continue
        row = by_day.get(round((int(fields[1][:2]) * 3600 + int(fields[1][2:4]) * 60 + float(fields[1][4:])) * 1000))
        if row is None:
            return [f"the serial port has a time without SOLUTION: {line}"]
        instants += 1
        worst = max(worst, abs(degrees(*fields[2:4]) - row["latitude_deg"]), abs(degrees(*fields[4:6]) - row["longitude_deg"]))
    print(f"serial port: {sentences} sentences, their checksums right; {instants} positions within {worst:.2e} degrees")
    return [] if instants > 0.6 * duration_s and worst <= PLACE_DEG else ["the serial port does not carry the solution"]


def corrections(out):
    """What EPOCH says about the orbits that it used."""
    satellites = leonav.read_log(out / "run.journal", ["EPOCH"])["EPOCH_SATELLITES"]
    used = satellites[satellites["used"]]
    precise = used[used["orbit"] == "precise"]
    by_epoch = used.groupby("gps_tow_s")["orbit"].apply(lambda orbits: (orbits == "precise").mean())
    ages = precise["ephemeris_age_s"]
    print(f"corrections: of {len(used)} uses of a satellite {len(precise)} with corrected orbit, at ages from {ages.min():.1f} to {ages.max():.1f} s "
          f"(median {ages.median():.1f} s); {(by_epoch > 0.99).sum()} of {len(by_epoch)} epochs with corrected orbits alone")
    faults = []
    if len(precise) < 0.5 * len(used):
        faults.append("corrections were not used by most satellites")
    if len(precise) and ages.median() > 15:
        faults.append("corrections are older than they were sent")
    return faults


def journaled(out, said):
    """LCM is UDP: what leonav-connect says that it has published, and what leonavd has got of it."""
    held = collections.Counter(channel for _, channel, _ in lcm_log.messages(out / "run.journal"))
    faults = []
    for stream, channels in CHANNELS.items():
        got = sum(held["LEONAV_" + channel] for channel in channels)
        print(f"{stream}: {said.get(stream)} messages published, {got} in the journal of leonavd ({', '.join(channels)})")
        if got != said.get(stream):
            faults.append(f"{stream}: LCM has lost messages, or leonavd has; is the machine overloaded?")
    return faults


def connections(caster, said):
    """Each break is told, and the stream is open again after it; without service that is told once more."""
    opened = sum("service: " in line and " is open" in line for line in said.splitlines())
    told = [line.split("service: ", 1)[1] for line in said.splitlines() if "warning: service: " in line and "trying again" in line]
    print(f"caster: {caster.refused} refused, {caster.served} served, {caster.broken} broken off; leonav-connect opened it {opened} times and told:")
    print("".join(f"  {line}\n" for line in told), end="")
    if caster.broken != 2 or caster.served != 3 or opened != 3:
        return ["the caster was not opened anew after each break"]
    if sum("closed the connection; trying again" in line for line in told) != 2 or not any("without an answer" in line for line in told):
        return ["a break, or a caster without service, is not told as such"]
    return []


def published(text):
    """How many messages each stream published, by the last line about it."""
    return {name: int(count) for name, count in re.findall(r"(\w+): [\w ]+, \d+ bytes, (\d+) messages", text)}
