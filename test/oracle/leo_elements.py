#!/usr/bin/env python3
"""Low orbits integrated numerically and elements fitted to them, as an oracle for core/gnss/orbits/satellite_state.

Needs scipy, in a virtual environment; nothing else in the project does. It shares no code with leonav: forces, frames, the
equations of the elements and the fit are its own. Use:

  leo_elements.py > test/core/gnss/orbits/leo_oracle.h
      The fitted elements of each arc, and positions and velocities of the integrated orbit along it, as C++. The errors of
      the elements, with and without the two rates, go to stderr.

Forces: the Earth's point mass with J2 to J6, drag of an exponential atmosphere that turns with the Earth, and the
tides of Sun and Moon on circular paths. The elements are those of IS-GPS-200 table 20-III with A_dot and delta_n0_dot of
30.3.3.1, fitted to positions every ten seconds of the arc.
"""
import sys

import numpy as np
from scipy.integrate import solve_ivp

MU = 3.986004418e14  # of the forces
RE = 6378136.3
ZONAL = {2: 1.0826362e-3, 3: -2.532437e-6, 4: -1.619331e-6, 5: -2.27716e-7, 6: 5.39648e-7}
MU_ELEMENTS = 3.986005e14  # IS-GPS-200 table 20-IV
EARTH_RATE = 7.2921151467e-5
TOE_TOW = 345600.0
WEEK = 2200

# name, height km, inclination deg, eccentricity, minutes of the arc
ARCS = (("500 km, 53 deg, 10 min", 500.0, 53.0, 0.0005, 10), ("500 km, 53 deg, 20 min", 500.0, 53.0, 0.0005, 20),
        ("550 km, 97.6 deg, 15 min", 550.0, 97.6, 0.001, 15), ("970 km, 90 deg, 10 min", 970.0, 90.0, 0.0001, 10),
        ("970 km, 90 deg, 20 min", 970.0, 90.0, 0.0001, 20), ("1200 km, 87.9 deg, 20 min", 1200.0, 87.9, 0.02, 20))


def zonal_potential_gradient(r):
    """Acceleration of J2 to J6: the gradient of -mu/r sum J_n (RE/r)^n P_n(z/r), from Legendre polynomials."""
    d = np.linalg.norm(r)
    s = r[2] / d
    total = np.zeros(3)
    for n, j in ZONAL.items():
        poly = np.polynomial.legendre.Legendre.basis(n)
        p, dp = poly(s), poly.deriv()(s)
        # d/dr of r^-(n+1), and of P_n(s) with ds = (e_z - s r/d)/d.
        scale = -MU * j * RE**n / d ** (n + 2)
        total += scale * (-(n + 1) * p * r / d + dp * (np.array([0, 0, 1.0]) - s * r / d))
    return total


def third_body(r, gm, distance, angle, tilt):
    b = distance * np.array([np.cos(angle), np.sin(angle) * np.cos(tilt), np.sin(angle) * np.sin(tilt)])
    return gm * ((b - r) / np.linalg.norm(b - r) ** 3 - b / distance**3)


def acceleration(t, y):
    r, v = y[:3], y[3:]
    d = np.linalg.norm(r)
    a = -MU * r / d**3 + zonal_potential_gradient(r)
    density = 4e-12 * np.exp(-(d - RE - 450e3) / 60e3)  # kg/m^3, an active Sun
    relative = v - np.cross([0, 0, EARTH_RATE], r)
    a -= 0.5 * density * 0.02 * np.linalg.norm(relative) * relative  # c_D A/m = 0.02 m^2/kg
    a += third_body(r, 1.327124e20, 1.496e11, 0.7 + 1.99e-7 * t, 0.409)
    return a + third_body(r, 4.902801e12, 3.844e8, 2.1 + 2.66e-6 * t, 0.45)


def integrated(height_km, inclination_deg, eccentricity, half_s, times):
    """States in the inertial frame that coincides with ECEF at toe, from 0 s outwards."""
    a = RE + height_km * 1e3
    i, node, u = np.radians(inclination_deg), 0.6, 0.9
    p = a * (1 - eccentricity**2)
    radius = p / (1 + eccentricity * np.cos(0.5))
    to_frame = np.array([[np.cos(node), -np.sin(node) * np.cos(i)], [np.sin(node), np.cos(node) * np.cos(i)], [0, np.sin(i)]])
    perigee = u - 0.5
    r = to_frame @ (radius * np.array([np.cos(u), np.sin(u)]))
    root = np.sqrt(MU / p)
    v = to_frame @ (root * np.array([-np.sin(u) - eccentricity * np.sin(perigee), np.cos(u) + eccentricity * np.cos(perigee)]))

    def run(end):
        return solve_ivp(lambda t, y: np.concatenate([y[3:], acceleration(t, y)]), (0.0, end), np.concatenate([r, v]),
                         method="DOP853", rtol=1e-13, atol=1e-7, dense_output=True).sol

    ahead, back = run(half_s), run(-half_s)
    return np.array([ahead(t) if t >= 0 else back(t) for t in times])


def to_ecef(state, t):
    c, s = np.cos(EARTH_RATE * t), np.sin(EARTH_RATE * t)
    turn = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1.0]])
    p = turn @ state[:3]
    return np.concatenate([p, turn @ state[3:] - np.cross([0, 0, EARTH_RATE], p)])


NAMES = ("sqrt_a", "ex", "ey", "m0_plus_omega", "delta_n", "omega0", "omega_dot", "i0", "i_dot", "cuc", "cus", "crc", "crs", "cic",
         "cis", "a_dot", "delta_n_dot")
SCALE = np.array([1e-1, 1e-5, 1e-5, 1e-5, 1e-8, 1e-5, 1e-8, 1e-5, 1e-8, 1e-5, 1e-5, 100, 100, 1e-5, 1e-5, 1e-1, 1e-11])


def position(x, t):
    """ECEF position by the elements at t after toe; omega0 is here the node's longitude at toe."""
    e, omega = np.hypot(x[1], x[2]), np.arctan2(x[2], x[1])
    a0 = x[0] ** 2
    m = (x[3] - omega) + (np.sqrt(MU_ELEMENTS / a0**3) + x[4] + 0.5 * x[16] * t) * t
    big_e = m.copy()
    for _ in range(8):
        big_e = m + e * np.sin(big_e)
    phi = 2 * np.arctan2(np.sqrt(1 + e) * np.sin(big_e / 2), np.sqrt(1 - e) * np.cos(big_e / 2)) + omega
    u = phi + x[10] * np.sin(2 * phi) + x[9] * np.cos(2 * phi)
    r = (a0 + x[15] * t) * (1 - e * np.cos(big_e)) + x[12] * np.sin(2 * phi) + x[11] * np.cos(2 * phi)
    i = x[7] + x[8] * t + x[14] * np.sin(2 * phi) + x[13] * np.cos(2 * phi)
    node = x[5] + (x[6] - EARTH_RATE) * t
    px, py = r * np.cos(u), r * np.sin(u)
    return np.stack([px * np.cos(node) - py * np.cos(i) * np.sin(node), px * np.sin(node) + py * np.cos(i) * np.cos(node),
                     py * np.sin(i)], axis=1)


def first_guess(state):
    r, v = state[:3], state[3:]
    h = np.cross(r, v)
    a = 1 / (2 / np.linalg.norm(r) - v @ v / MU_ELEMENTS)
    node = np.arctan2(h[0], -h[1])
    along = np.cross(h / np.linalg.norm(h), [np.cos(node), np.sin(node), 0])
    u = np.arctan2(r @ along, r @ np.array([np.cos(node), np.sin(node), 0]))
    x = np.zeros(17)
    x[[0, 1, 3, 5, 7]] = np.sqrt(a), 1e-4, u, node, np.arccos(h[2] / np.linalg.norm(h))
    return x


def fit(samples, times, start, rates):
    count = 17 if rates else 15
    base = first_guess(start)
    # The part of the elements that the arc does not show is held near nothing: 1 cm of position against ten thousand units.
    weak = np.array([0, 0, 0, 0, 1, 0, 1, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1])[:count] * 1e-4

    def unknowns(z):
        x = base.copy()
        x[:count] += z * SCALE[:count]
        return x

    def residuals(z):
        return np.concatenate([((position(unknowns(z), times) - samples) / 0.01).ravel(), weak * z])

    # Levenberg and Marquardt's iteration; derivatives by central differences of a unit each.
    z, damping = np.zeros(count), 1e-3
    r = residuals(z)
    for _ in range(200):
        unit = np.eye(count) * 0.1
        jacobian = np.stack([(residuals(z + one) - residuals(z - one)) / 0.2 for one in unit], axis=1)
        size = np.linalg.norm(jacobian, axis=0)
        system = np.vstack([jacobian, np.diag(np.sqrt(damping) * size)])
        step = np.linalg.lstsq(system, np.concatenate([-r, np.zeros(count)]), rcond=None)[0]
        tried = residuals(z + step)
        if not tried @ tried < r @ r:
            damping *= 10.0
            if damping > 1e8:
                break
            continue
        gain = 1 - tried @ tried / (r @ r)
        z, r, damping = z + step, tried, max(damping * 0.1, 1e-14)
        if gain < 1e-9:
            break
    return unknowns(z)


def velocity(x, t):
    h = 0.5
    return (8 * (position(x, t + h) - position(x, t - h)) - position(x, t + 2 * h) + position(x, t - 2 * h)) / (12 * h)


def literal(value):
    return repr(float(value))


def main():
    print("// Low orbits integrated numerically, with elements fitted to them. Made by test/oracle/leo_elements.py.\n#pragma once\n"
          "#include <Eigen/Core>\n#include <vector>\n\n#include \"core/gnss/orbits/ephemeris.h\"\n\nnamespace leonav::test {\n\n"
          "// A state of the integrated orbit, ECEF.\nstruct LeoState {\n  double since_toe_s;\n  Eigen::Vector3d p_e, v_e;\n};\n\n"
          "// An arc: its elements, how far they are from the integrated orbit by the script's own equations, and the\n"
          "// orbit. The largest errors are over the whole arc.\nstruct LeoArc {\n  const char* name;\n  Ephemeris elements;\n"
          "  double worst_m, worst_m_s;\n  double worst_without_rates_m;\n  std::vector<LeoState> states;\n};\n\n"
          "inline std::vector<LeoArc> leo_arcs() {\n  std::vector<LeoArc> arcs;")
    for name, height, inclination, eccentricity, minutes in ARCS:
        half = 30.0 * minutes
        times = np.arange(-half, half + 0.5, 10.0)
        inertial = integrated(height, inclination, eccentricity, half, times)
        truth = np.array([to_ecef(state, t) for state, t in zip(inertial, times)])
        start = inertial[np.argmin(np.abs(times))]
        worst = {}
        for rates in (False, True):
            x = fit(truth[:, :3], times, start, rates)
            p = np.linalg.norm(position(x, times) - truth[:, :3], axis=1)
            v = np.linalg.norm(velocity(x, times) - truth[:, 3:], axis=1)
            worst[rates] = p.max(), v.max()
            print(f"{name}, {'17 elements' if rates else '15 elements'}: position rms {np.sqrt(np.mean(p**2)):.4f} m, worst "
                  f"{p.max():.4f} m; velocity rms {np.sqrt(np.mean(v**2)):.2e} m/s, worst {v.max():.2e} m/s", file=sys.stderr)
        print("   " + ", ".join(f"{n} {value:.3g}" for n, value in zip(NAMES, x)), file=sys.stderr)
        e, omega = np.hypot(x[1], x[2]), np.arctan2(x[2], x[1])
        wrap = lambda angle: np.remainder(angle + np.pi, 2 * np.pi) - np.pi
        values = {"sqrt_a": x[0], "eccentricity": e, "m0": wrap(x[3] - omega), "delta_n": x[4],
                  "omega0": wrap(x[5] + EARTH_RATE * TOE_TOW), "omega_dot": x[6], "i0": x[7], "i_dot": x[8], "omega": omega,
                  **dict(zip(NAMES[9:], x[9:]))}
        print(f"  {{\n    LeoArc arc;\n    arc.name = \"{name}\";\n    Ephemeris& e = arc.elements;\n"
              f"    e.satellite = {{System::kLeo, 150}};\n    e.toe = e.toc = GpsTime::from_week_and_tow({WEEK}, {TOE_TOW});")
        for key, value in values.items():
            print(f"    e.{key} = {literal(value)};")
        print(f"    arc.worst_m = {worst[True][0]:.4g};\n    arc.worst_m_s = {worst[True][1]:.4g};\n"
              f"    arc.worst_without_rates_m = {worst[False][0]:.4g};\n    arc.states = {{")
        for k in range(0, len(times), max(1, (len(times) - 1) // 6)):
            numbers = [literal(value) for value in truth[k]]
            print(f"        {{{literal(times[k])}, {{{', '.join(numbers[:3])}}}, {{{', '.join(numbers[3:])}}}}},")
        print("    };\n    arcs.push_back(arc);\n  }")
    print("  return arcs;\n}\n\n}  // namespace leonav::test")


if __name__ == "__main__":
    main()
