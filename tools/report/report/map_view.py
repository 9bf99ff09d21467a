"""Which part of the ground a map shows: all of the tracks, but for outliers, which would shrink it."""
import numpy as np

FASTEST_M_S = 70.0  # of a vehicle whose speed is not known
LONG_STEP_S = 5.0  # over longer intervals the speed at both ends tells nothing
SMALL_PIECE = 0.02  # of the rows: a piece of a track cut off by jumps on both sides that is smaller is an outlier
MARGIN = 0.06
WIDEST, NARROWEST = 1.7, 0.75  # width over height


def horizontal_sigma(table):
    return np.hypot(table["std_north_m"], table["std_east_m"])


def speed(table):
    return np.hypot(table["v_north_m_s"], table["v_east_m_s"])


def typical(values, otherwise):
    values = values[np.isfinite(values)]
    return float(np.median(values)) if len(values) else otherwise


def trusted(north, east, table):
    """Which rows decide what a map shows.

    Left out are rows whose own sigma is twenty times the usual one and above 10 m, and small pieces of the track that are cut off by
    steps that the vehicle cannot have made: longer than its speed and its usual sigma allow.
    """
    good = np.isfinite(north) & np.isfinite(east)
    sigma, usual = horizontal_sigma(table), typical(horizontal_sigma(table), 5.0)
    good &= ~(sigma > max(20.0 * usual, 10.0))
    rows = np.flatnonzero(good)
    if len(rows) < 3:
        return np.isfinite(north) & np.isfinite(east)
    step, interval = np.hypot(np.diff(north[rows]), np.diff(east[rows])), np.diff(table.time[rows])
    v = speed(table)[rows]
    v = np.where(np.isfinite(v), v, FASTEST_M_S)
    fastest = np.where(interval > LONG_STEP_S, np.maximum(FASTEST_M_S, np.maximum(v[1:], v[:-1])), 1.5 * np.maximum(v[1:], v[:-1]))
    piece = np.concatenate([[0], np.cumsum(step > fastest * interval + 10.0 * usual + 1.0)])
    sizes = np.bincount(piece)
    large = (sizes >= SMALL_PIECE * len(rows)) | (sizes == sizes.max())
    good[rows] = large[piece]
    return good


def bounds(points):
    """(west, east, south, north) of points in rows of north and east."""
    return np.array([points[1].min(), points[1].max(), points[0].min(), points[0].max()])


def extent(tracks, truth=None):
    """Returns (west, east, south, north) in m of the map, with a margin and a shape that suits a page.

    `tracks` are tuples of north, east and table; `truth` is rows of north and east. Where there is a truth, its whole track is shown.
    """
    shown, others = [], []
    for north, east, table in tracks:
        good = trusted(north, east, table)
        shown.append(np.array([north[good], east[good]]))
        rest = np.isfinite(north) & np.isfinite(east) & ~good
        others.append(np.array([north[rest], east[rest]]))
    if truth is not None:
        shown.append(truth[:, np.isfinite(truth).all(axis=0)])
    shown, others = np.concatenate(shown, axis=1), np.concatenate(others, axis=1)
    west, east, south, north = bounds(shown)
    # What lies close by shrinks the map little.
    near = 0.5 * max(east - west, north - south)
    close = (others[1] > west - near) & (others[1] < east + near) & (others[0] > south - near) & (others[0] < north + near)
    west, east, south, north = bounds(np.concatenate([shown, others[:, close]], axis=1))
    width, height = max(east - west, 0.02), max(north - south, 0.02)
    margin = MARGIN * max(width, height)
    width, height = width + 2.0 * margin, height + 2.0 * margin
    width, height = max(width, NARROWEST * height), max(height, width / WIDEST)
    middle_east, middle_north = 0.5 * (west + east), 0.5 * (south + north)
    return (middle_east - 0.5 * width, middle_east + 0.5 * width, middle_north - 0.5 * height, middle_north + 0.5 * height)
