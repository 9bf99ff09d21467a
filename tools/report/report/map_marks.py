"""What makes a picture a map: scale bar, north arrow, and the graticule of latitude and longitude."""
import math

import numpy as np
from matplotlib.patches import Polygon, Rectangle
from matplotlib.transforms import Bbox

from .labels import HALO
from .style import distance

# Steps of the graticule in seconds of arc.
STEPS = tuple(step * unit for unit, steps in ((1e-4, (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000)), (1, (1, 2, 5, 10, 15, 30)),
                                              (60, (1, 2, 5, 10, 15, 30)), (3600, (1, 2, 5, 10, 15, 30))) for step in steps)

EDGE = 0.045  # of the map: a line that close to a corner has no label, which would stick out


def round_length(most):
    """The longest of 1, 2, 5 times a power of ten that is not longer than `most`."""
    power = 10.0 ** math.floor(math.log10(most))
    return next(factor * power for factor in (5.0, 2.0, 1.0) if factor * power <= most * (1.0 + 1e-9))


def arc_step(span_deg, lines):
    """The step of the graticule in seconds of arc that gives at most `lines` lines over a span."""
    return next((step for step in STEPS if span_deg * 3600.0 / step <= lines), STEPS[-1])


def arc_text(value_deg, step_arcsec, letters):
    """An angle in degrees, minutes and as much of seconds as the step needs: 45°04'N, 45°04'30"N, 45°04'30.25"N."""
    letter = letters[0] if value_deg >= 0 else letters[1]
    decimals = max(0, min(4, math.ceil(-math.log10(step_arcsec) - 1e-9)))
    scale = 10 ** decimals
    units = int(round(abs(value_deg) * 3600.0 * scale))
    minutes, units = divmod(units, 60 * scale)
    degrees, minutes = divmod(minutes, 60)
    if step_arcsec >= 60:
        return f"{degrees}°{minutes:02d}'{letter}"
    seconds = f"{units / scale:0{3 + decimals if decimals else 2}.{decimals}f}"
    return f"{degrees}°{minutes:02d}'{seconds}\"{letter}"


def multiples(low_deg, high_deg, step_arcsec):
    """The multiples of a step within a span, in degrees."""
    first, last = math.ceil(low_deg * 3600.0 / step_arcsec), math.floor(high_deg * 3600.0 / step_arcsec)
    return [index * step_arcsec / 3600.0 for index in range(first, last + 1)]


def draw_graticule(axis, frame, extent, lines):
    """Draws parallels and meridians, with their labels at the right and at the top. `lines` is how many there may be, (east, north)."""
    west, east, south, north = extent
    corner_lat, corner_lon = frame.latitude_longitude_deg(np.array([south, south, north, north]), np.array([west, east, west, east]))
    style = dict(color="#9db4c8", linewidth=0.7, linestyle=(0, (6, 3)), zorder=0.5)
    step = arc_step(np.ptp(corner_lon), lines[0])
    for longitude in multiples(corner_lon.min(), corner_lon.max(), step):
        latitude = np.linspace(corner_lat.min(), corner_lat.max(), 20)
        n, e, _ = frame.north_east_up(latitude, np.full(20, longitude), frame.height)
        axis.plot(e, n, **style)
        at = np.interp(north, n, e)
        if west + EDGE * (east - west) < at < east - EDGE * (east - west):
            axis.annotate(arc_text((longitude + 180.0) % 360.0 - 180.0, step, "EW"), (at, north), xytext=(0, 4), textcoords="offset points",
                          ha="center", va="bottom", fontsize=8, color="#4a6a86")
    step = arc_step(np.ptp(corner_lat), lines[1])
    for latitude in multiples(corner_lat.min(), corner_lat.max(), step):
        longitude = np.linspace(corner_lon.min(), corner_lon.max(), 20)
        n, e, _ = frame.north_east_up(np.full(20, latitude), longitude, frame.height)
        axis.plot(e, n, **style)
        at = np.interp(east, e, n)
        if south + EDGE * (north - south) < at < north - EDGE * (north - south):
            axis.annotate(arc_text(latitude, step, "NS"), (east, at), xytext=(4, 0), textcoords="offset points", ha="left", va="center",
                          fontsize=8, color="#4a6a86", rotation=90)


def draw_scale_and_arrow(axis, labels, extent):
    """Draws the scale bar with the north arrow above it in the corner of the map that has the fewest points, and reserves its box."""
    west, east, south, north = extent
    width = east - west
    pixel = width / axis.bbox.width  # m
    length = round_length(0.22 * width)
    inch = axis.figure.dpi * pixel
    box_width, box_height = max(length, 0.9 * inch) + 0.3 * inch, 0.95 * inch
    pad = 0.1 * inch
    corners = [(x, y) for y in (south + pad, north - pad - box_height) for x in (west + pad, east - pad - box_width)]

    def pixels(corner):
        return Bbox(axis.transData.transform([corner, (corner[0] + box_width, corner[1] + box_height)]))
    x, y = min(corners, key=lambda corner: labels.covered(pixels(corner)))
    axis.add_patch(Rectangle((x, y), box_width, box_height, facecolor="white", alpha=0.8, edgecolor="#cccccc", linewidth=0.6, zorder=40))
    middle, base, thick = x + 0.5 * box_width, y + 0.32 * inch, 0.06 * inch
    for part in range(4):
        axis.add_patch(
    Rectangle(
        (middle -
        0.5 *
        length +
        0.25 *
        part *
        length,
        base),
        0.25 *
        length,
        thick,
        edgecolor="black",
        linewidth=0.7,
        facecolor="black" if part %
        2 == 0 else "white",
         zorder=41))
    axis.text(middle - 0.5 * length, base - 0.03 * inch, "0", ha="center", va="top", fontsize=8.5, zorder=41)
    axis.text(middle + 0.5 * length, base - 0.03 * inch, distance(length), ha="center", va="top", fontsize=8.5, zorder=41)
    tip, foot, half = y + 0.88 * inch, y + 0.48 * inch, 0.09 * inch
    axis.add_patch(Polygon([(middle, tip), (middle - half, foot), (middle, foot + 0.08 * inch)], facecolor="black", zorder=41))
    axis.add_patch(Polygon([(middle, tip), (middle + half, foot), (middle, foot + 0.08 * inch)], facecolor="white", edgecolor="black",
                           linewidth=0.7, zorder=41))
    axis.text(middle + half + 0.05 * inch, foot + 0.2 * inch, "N", ha="left", va="center", fontsize=10, weight="bold", zorder=41,
              path_effects=HALO)
    labels.reserve(pixels((x, y)))
