"""Local coordinates north, east, up about one point of the ellipsoid, for pictures.

n = (lat - lat0) (M + h0), e = (lon - lon0) (N + h0) cos lat, u = h - h0, with the radii of curvature M, N at lat0 (WGS84): lengths along
meridian and parallel. What lies between two points that are close together, such as an error, is off by e tan(lat) / N of itself at most,
because meridians converge: by 3 thousandths 20 km east of the origin at a latitude of 45 degrees.
"""
import math

import numpy as np

from .errors import ReportError

SEMI_MAJOR_AXIS = 6378137.0
ECCENTRICITY_SQUARED = 6.69437999014e-3


def radii(latitude):
    """Radii of curvature in the meridian and in the prime vertical, m, of a latitude in rad."""
    s = math.sin(latitude)
    w = 1.0 - ECCENTRICITY_SQUARED * s * s
    return SEMI_MAJOR_AXIS * (1.0 - ECCENTRICITY_SQUARED) / w ** 1.5, SEMI_MAJOR_AXIS / math.sqrt(w)


class LocalFrame:
    """Local coordinates about the first position of a table."""

    def __init__(self, table):
        ok = np.isfinite(table["latitude_deg"] + table["longitude_deg"] + table["height_m"])
        if not ok.any():
            raise ReportError(f"{table.path}: no row has a position; did the run end with an answer?")
        self.latitude = math.radians(table["latitude_deg"][ok][0])
        self.longitude = math.radians(table["longitude_deg"][ok][0])
        self.height = table["height_m"][ok][0]

    def north_east_up(self, latitude_deg, longitude_deg, height_m):
        """North, east, up in m as the rows of an array."""
        latitude, longitude = np.radians(latitude_deg), np.radians(longitude_deg)
        across = (longitude - self.longitude + math.pi) % (2.0 * math.pi) - math.pi  # the shorter way over the date line
        meridian, normal = radii(self.latitude)
        return np.array([(latitude - self.latitude) * (meridian + self.height), across * (normal + self.height) * np.cos(latitude),
                         height_m - self.height + np.zeros_like(latitude)])

    def of(self, table):
        """North, east, up of a table's positions."""
        return self.north_east_up(table["latitude_deg"], table["longitude_deg"], table["height_m"])

    def latitude_longitude_deg(self, north, east):
        """The inverse at the frame's height, for the graticule."""
        meridian, normal = radii(self.latitude)
        latitude = self.latitude + north / (meridian + self.height)
        longitude = self.longitude + east / ((normal + self.height) * np.cos(latitude))
        return np.degrees(latitude), np.degrees(longitude)
