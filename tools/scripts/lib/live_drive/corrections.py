"""SSR messages that lead from the simulator's broadcast messages to its precise products."""
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
import ssr_from_products as ssr  # noqa: E402

SEMICIRCLE = 3.141592653589793
# The steps in which both navigation messages send an orbit (IS-GPS-200, table 20-III; Galileo OS SIS ICD, table 67).
STEPS = {"crs": 2**-5, "crc": 2**-5, "cuc": 2**-29, "cus": 2**-29, "cic": 2**-29, "cis": 2**-29, "e": 2**-33, "sqrta": 2**-19,
         "deltan": 2**-43 * SEMICIRCLE, "m0": 2**-31 * SEMICIRCLE, "omega0": 2**-31 * SEMICIRCLE, "i0": 2**-31 * SEMICIRCLE,
         "omega": 2**-31 * SEMICIRCLE, "omegadot": 2**-43 * SEMICIRCLE, "idot": 2**-43 * SEMICIRCLE}
CLOCK_STEPS = {"G": {"af0": 2**-31, "af1": 2**-43, "af2": 2**-55}, "E": {"af0": 2**-34, "af1": 2**-46, "af2": 2**-59}}


def as_sent(one):
    """A set of broadcast elements, rounded as the message rounds it: corrections refer to what users have."""
    steps = {**STEPS, **CLOCK_STEPS[one["system"]]}
    return {key: round(value / steps[key]) * steps[key] if key in steps else value for key, value in one.items()}


def in_force(export, told):
    """{satellite: the set of which `told` has the message}, by its time of clock."""
    found = {}
    for satellite, sets in ssr.read_nav(export / "run.nav").items():
        message = told.get(satellite[0], {}).get(int(satellite[1:]))
        for one in sets:
            if message and round(one["toc"]) == message[0]:
                found[satellite] = as_sent(one)
    return found


def messages(export, told, start, duration_s, clock_interval_s):
    """[(GPS time in ns, bytes)]: clocks each `clock_interval_s`, and before those of whole minutes the orbits."""
    sets = in_force(export, told)
    orbits = ssr.read_sp3([export / "gps.sp3", export / "galileo.sp3"])
    clocks = ssr.read_clk(export / "run.clk")
    known = {satellite: one for satellite, one in sets.items() if satellite in orbits and satellite in clocks}
    found = []
    for t in range(start, start + duration_s, clock_interval_s):
        made = [ssr.orbit_message(system, t, orbits, known) for system in "GE"] if t % ssr.ORBIT_INTERVAL == 0 else []
        made += [ssr.clock_message(system, t, orbits, clocks, known) for system in "GE"]
        found.append((t * 10**9, b"".join(data for data, count in made if count)))
    return found
