"""LEO constellations of 160, 320 and 640 satellites as a scenario's shells.

160 is the papers' (70 in six polar planes, 90 in ten planes of 60 degrees, 970 km); 320 has twice as many in
each plane, 640 twice the planes of these. leonav names 399 LEO satellites at most, and one receiver sees few of 640 in
an hour, so only those are given that come above its horizon.
"""
import math

MU, OMEGA, RADIUS = 3.986004418e14, 7.292115e-5, 6378137.0
HEIGHT_M = 970e3
J2 = 1.08263e-3
LATITUDE_DEG, LONGITUDE_DEG = 39.9065, 116.4365  # where the scenarios drive


def orbits(factor):
    """(inclination, node, argument of latitude at the start), degrees; factor 1, 2 or 4."""
    planes, per_plane = max(1, factor // 2), 2 if factor > 1 else 1
    result = []
    polar = 6 * planes
    for p in range(polar):
        # 70 satellites in six planes: 12, 12, 12, 12, 11, 11.
        count = (12 if p // planes < 4 else 11) * per_plane
        result += [(90.0, p * 180.0 / polar, p * 13.0 / planes + 360.0 * i / count) for i in range(count)]
    inclined = 10 * planes
    count = 9 * per_plane
    for p in range(inclined):
        phase = 5 * 360.0 / (inclined * count)
        result += [(60.0, p * 360.0 / inclined, p * phase + 360.0 * i / count) for i in range(count)]
    return result


def elevation(orbit, latitude, longitude, begin_s, t):
    """rad. Circular orbit with J2's drifts: good to a fraction of a degree within an hour or two."""
    inclination, node, argument = (math.radians(x) for x in orbit)
    a = RADIUS + HEIGHT_M
    n = math.sqrt(MU / a ** 3)
    drift = 1.5 * J2 * (RADIUS / a) ** 2 * n
    node_rate = -drift * math.cos(inclination) - OMEGA
    rate = n + drift * (4.0 - 5.0 * math.sin(inclination) ** 2)
    # What advances the sky knows no J2 (leonav-sim, satellites.advance_s).
    u = argument + n * begin_s + rate * t
    w = node - OMEGA * begin_s + node_rate * t
    site = [math.cos(latitude) * math.cos(longitude), math.cos(latitude) * math.sin(longitude), math.sin(latitude)]
    s = [math.cos(w) * math.cos(u) - math.sin(w) * math.sin(u) * math.cos(inclination),
         math.sin(w) * math.cos(u) + math.cos(w) * math.sin(u) * math.cos(inclination),
         math.sin(u) * math.sin(inclination)]
    cosine = sum(x * y for x, y in zip(s, site))
    return math.atan2(cosine - RADIUS / a, math.sqrt(max(0.0, 1.0 - cosine ** 2)))


def rises(orbit, latitude, longitude, begin_s, duration_s, least=math.radians(2.0)):
    steps = range(-30, int(duration_s) + 45, 15)
    return any(elevation(orbit, latitude, longitude, begin_s, t) > least for t in steps)


def mean_in_view(factor, masks_deg, latitude_deg=LATITUDE_DEG, longitude_deg=LONGITUDE_DEG):
    """Satellites above each mask on the mean of a day, nothing in the way."""
    site = math.radians(latitude_deg), math.radians(longitude_deg)
    times = range(0, 86400, 600)
    seen = [math.degrees(elevation(o, *site, 0.0, t)) for o in orbits(factor) for t in times]
    return [sum(e > mask for e in seen) / len(times) for mask in masks_deg]


def shells(factor, begin_s, duration_s, latitude_deg=LATITUDE_DEG, longitude_deg=LONGITUDE_DEG):
    """The value of satellites.leo.shells; begin_s is the scenario's satellites.advance_s."""
    site = math.radians(latitude_deg), math.radians(longitude_deg)
    chosen = [o for o in orbits(factor) if rises(o, *site, begin_s, duration_s)]
    return "[" + ", ".join(
        f"{{semi_major_axis_km: {(RADIUS + HEIGHT_M) / 1e3:.3f}, inclination_deg: {i:g}, "
        f"first_node_deg: {node:.4f}, first_anomaly_deg: {u % 360.0:.4f}}}" for i, node, u in chosen) + "]"
