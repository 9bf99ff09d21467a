"""Turns GPS time into weeks, times of week and UTC.

GPS time counts nanoseconds since 1980-01-06 without leap seconds. UTC has them: while one is inserted, numpy's time, which has
no second 60, repeats the second after it, as Unix time does.
"""
import numpy as np

NS_PER_S = 1_000_000_000
NS_PER_WEEK = 604_800 * NS_PER_S
GPS_EPOCH_UNIX_NS = 315_964_800 * NS_PER_S  # 1980-01-06 00:00 UTC
LATEST_NS = 10_000 * NS_PER_WEEK  # leonav takes no later times
# First days after a leap second since 1980. Source: IERS Bulletin C (1 to 70).
LEAP_DAYS = np.array(["1981-07-01", "1982-07-01", "1983-07-01", "1985-07-01", "1988-01-01", "1990-01-01", "1991-01-01",
                      "1992-07-01", "1993-07-01", "1994-07-01", "1996-01-01", "1997-07-01", "1999-01-01", "2006-01-01",
                      "2009-01-01", "2012-07-01", "2015-07-01", "2017-01-01"], dtype="datetime64[ns]")
# In GPS time a new day begins later by the leap seconds so far, its own included.
_LEAPS_GPS_NS = LEAP_DAYS.astype(np.int64) - GPS_EPOCH_UNIX_NS + (np.arange(len(LEAP_DAYS)) + 1) * NS_PER_S


def leap_seconds(gps_ns):
    """Returns how many seconds GPS time is ahead of UTC at instants of GPS time in ns: 18 since 2017."""
    return np.searchsorted(_LEAPS_GPS_NS, np.asarray(gps_ns, dtype=np.int64), side="right")


def unix_ns(gps_ns):
    """Returns UTC as nanoseconds since 1970-01-01 (Unix time) of instants of GPS time in ns."""
    gps_ns = np.asarray(gps_ns, dtype=np.int64)
    return gps_ns + GPS_EPOCH_UNIX_NS - leap_seconds(gps_ns) * NS_PER_S


def week_and_tow(gps_ns):
    """Returns the week without roll-over and the time of week in s of instants of GPS time in ns."""
    gps_ns = np.asarray(gps_ns, dtype=np.int64)
    week = gps_ns // NS_PER_WEEK
    return week, (gps_ns - week * NS_PER_WEEK) / NS_PER_S


def gps_ns(week, tow_s):
    """Returns GPS time in ns of weeks and times of week in s, rounded to the nearest nanosecond."""
    seconds = np.floor(tow_s)
    return (np.asarray(week, dtype=np.int64) * NS_PER_WEEK + seconds.astype(np.int64) * NS_PER_S +
            np.rint((tow_s - seconds) * NS_PER_S).astype(np.int64))
