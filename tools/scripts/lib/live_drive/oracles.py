"""The drive's bytes as other people's packages read them: oracles.py RECEIVER.ubx OBSERVATIONS.obs SERVICE.rtcm3

By pyubx2 and pyrtcm, of PyPI, where the Python that runs this has them. Each difference is a line of standard error.
"""
import collections
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[4] / "test/tools/connect"))
import ubx_bytes  # noqa: E402

UBX_GNSS = {"GPS": "G", "Galileo": "E", 0: "G", 2: "E"}


def rawx_values(message):
    """{satellite: codes and carriers, sorted} of pyubx2's RXM-RAWX."""
    found = collections.defaultdict(list)
    for index in range(1, message.numMeas + 1):
        field = lambda name: getattr(message, f"{name}_{index:02d}")
        found[f"{UBX_GNSS[field('gnssId')]}{field('svId'):02d}"] += [field("prMes"), field("cpMes")]
    return {name: sorted(values) for name, values in found.items()}


def receiver(path, observations):
    """Every message of the receiver, and of RXM-RAWX every value against the RINEX file that it was made of."""
    try:
        import pyubx2
    except ImportError:
        print("SKIPPED (optional): no pyubx2 for this Python (LEONAV_PYTHON names another)")
        return []
    kinds, values, faults = collections.Counter(), 0, []
    epochs = ubx_bytes.epochs(observations)
    with open(path, "rb") as file:
        for _, message in pyubx2.UBXReader(file, protfilter=pyubx2.UBX_PROTOCOL, quitonerror=pyubx2.ERR_RAISE):
            kinds[message.identity] += 1
            if message.identity != "RXM-RAWX":
                continue
            (whole, fraction), satellites = next(epochs)
            if abs(message.week * 604800 + message.rcvTow - whole - fraction) > 1e-6:
                faults.append(f"pyubx2 reads another time: {message.week}, {message.rcvTow}")
            read = rawx_values(message)
            for name, values_of in satellites.items():
                sent = sorted(values_of.get(kind + signal, (0.0,))[0] for signal in ubx_bytes.SIGNAL_IDS[name[0]] for kind in "CL"
                              if "C" + signal in values_of or "L" + signal in values_of)
                if read.pop(name, []) != sent:
                    faults.append(f"pyubx2 reads other codes or carriers of {name} at {message.rcvTow} than were sent")
                values += len(sent)
            if read:
                faults.append(f"pyubx2 reads satellites that were not sent: {sorted(read)}")
    print(f"pyubx2: {dict(kinds)}; {values} codes and carriers, {'equal to the last bit' if not faults else 'not all as sent'}")
    return faults[:3]


def service(path):
    """Every message of the correction service; a connection that breaks off in a message leaves a part, which is skipped."""
    try:
        import pyrtcm
    except ImportError:
        print("SKIPPED (optional): no pyrtcm for this Python (LEONAV_PYTHON names another)")
        return []
    kinds = collections.Counter()
    with open(path, "rb") as file:
        for _, message in pyrtcm.RTCMReader(file, quitonerror=pyrtcm.ERR_IGNORE):
            if message is not None:
                kinds[message.identity] += 1
    print(f"pyrtcm: {dict(sorted(kinds.items()))}")
    return [] if set(kinds) == {"1057", "1058", "1240", "1241"} else [f"pyrtcm reads other messages than were sent: {dict(kinds)}"]


def main():
    receiver_path, observations, service_path = map(pathlib.Path, sys.argv[1:])
    for fault in receiver(receiver_path, observations) + service(service_path):
        print(fault, file=sys.stderr)


if __name__ == "__main__":
    main()
