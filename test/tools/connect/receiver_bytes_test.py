#!/usr/bin/env python3
"""receiver_bytes_test.py STATION_FOLDER: what oem7_bytes.py and sbf_bytes.py encode of a recorded station, as novatel-edie and
pysbf2 read it (test/oracle). Measurements must be those of the RINEX file within half a step of their fields, carriers up to
whole cycles, which RANGECMP and MeasEpoch leave out. Exit 77: neither package is there.
"""
import itertools
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ORACLE = HERE.parents[1] / "oracle"
sys.path.append(str(HERE))
import oem7_bytes  # noqa: E402
import sbf_bytes  # noqa: E402
import ubx_bytes  # noqa: E402

EPOCHS = 20
# Half a step of code (m), carrier (cycles), Doppler (Hz), C/N0 (dB-Hz). In SBF a carrier is relative to the code, a slave's Doppler to the
# master's: roundings of both are in it. NovAtel's C/N0 has whole dB-Hz from 20 to 51.
FORMATS = {"oem7": (oem7_bytes, (1 / 256, 1 / 512, 1 / 512, 0.51)), "sbf": (sbf_bytes, (0.51e-3, 0.51e-3, 1.1e-4, 0.126))}


def fail(text):
    sys.exit(f"FAILED: {text}")


def fields(name, data):
    """{(GPS s, satellite, code): (code, carrier, Doppler, C/N0, lock time)} as the package reads them; None: it is not there."""
    oracle = [sys.executable, "-B", ORACLE / f"{name}.py"]
    if subprocess.run([*oracle, "--have"], stderr=subprocess.DEVNULL, check=False).returncode != 0:
        return None
    with tempfile.NamedTemporaryFile() as file:
        file.write(data)
        file.flush()
        text = subprocess.run([*oracle, "fields", file.name], capture_output=True, text=True, check=True).stdout
    lines = [line.split() for line in text.splitlines() if line.startswith("O ")]
    return {(int(line[1]) * 604800 + float(line[2]) / 1e3, line[3], line[4]): [float(value) for value in line[5:10]] for line in lines}


def check(name, epochs):
    encoder, limits = FORMATS[name]
    locks, data, wanted = {}, b"", {}
    for time, satellites in epochs:
        data += encoder.epoch(time, satellites, locks)
        for satellite, values in satellites.items():
            for signal in encoder.SIGNALS.get(satellite[0], {}):
                if values.get("C" + signal):
                    wanted[time[0] + time[1], satellite, signal] = [values.get(kind + signal) for kind in "CLDS"]
    read = fields(name, data)
    if read is None:
        return False
    if set(read) != set(wanted) or len(read) < 1000:
        fail(f"{name}: {len(read)} measurements, encoded were {len(wanted)}; of one alone are {sorted(set(read) ^ set(wanted))[:5]}")
    worst = [0.0] * 4
    for key, values in wanted.items():
        for index, value in enumerate(values):
            if not value:
                continue
            error = read[key][index] - value[0]
            if index == 1:
                error -= round(error)
            if name == "oem7" and index == 3 and not 20 <= value[0] <= 51:
                continue
            worst[index] = max(worst[index], abs(error))
    print(f"{name}: {len(read)} measurements; largest differences {', '.join(f'{value:.2g}' for value in worst)}")
    if any(value > limit for value, limit in zip(worst, limits)):
        fail(f"{name}: differences {worst}, allowed {limits}")
    if not any(values[4] > 100 for values in read.values()):
        fail(f"{name}: no carrier has been locked for long")
    return True


def main():
    epochs = list(itertools.islice(ubx_bytes.epochs(next(pathlib.Path(sys.argv[1]).glob("*.obs"))), EPOCHS))
    compared = {name: check(name, epochs) for name in FORMATS}
    for name, is_compared in compared.items():
        if not is_compared:
            print(f"SKIPPED (optional): no independent decoder of {name} for this Python (LEONAV_PYTHON names another)")
    if not any(compared.values()):
        sys.exit(77)


if __name__ == "__main__":
    main()
