"""The log of a leonavd with the s since the drive's start."""
import re
import time

from service_faults.recorded import Health

LINE = re.compile(r"\S+ (\d\d):(\d\d):(\d\d\.\d+) (\w+): (.*)")
DAY_S = 86400


def lines_of(text, begin_wall_s):
    """(s, line) of each."""
    local = time.localtime(begin_wall_s)
    begin_day_s = local.tm_hour * 3600 + local.tm_min * 60 + local.tm_sec + begin_wall_s % 1
    for line in text.splitlines():
        if found := LINE.match(line):
            t = int(found[1]) * 3600 + int(found[2]) * 60 + float(found[3]) - begin_day_s
            yield (t + DAY_S / 2) % DAY_S - DAY_S / 2, found[5]


def health_of(text, begin_wall_s, last_s):
    """HEALTH once a second by the log, which has each change of it."""
    changes = []
    for t, line in lines_of(text, begin_wall_s):
        if found := re.match(r"(OK|DEGRADED|FAULT)(?:: (.*))?$", line):
            changes.append(Health(t, found[1], found[2] or "", ""))
    out = []
    for change, following in zip(changes, [*[one.t for one in changes[1:]], last_s]):
        t = change.t
        while t < following:
            out.append(change._replace(t=t))
            t += 1.0
    return out
