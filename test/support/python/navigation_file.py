"""Reads RINEX 3 navigation files, for encoders of tests."""
import datetime

GPS_EPOCH = datetime.datetime(1980, 1, 6)
SYSTEMS = "GEC"


def records(path):
    """Whole records of GPS, Galileo and BeiDou: (satellite, clock's time in its own system's count of s since 1980-01-06, clock
    terms, 28 numbers)."""
    with open(path, encoding="ascii") as file:
        lines = file.read().split("END OF HEADER")[1].splitlines()[1:]
    begins = [index for index, line in enumerate(lines) if line[:1].isalpha()] + [len(lines)]
    for begin, end in zip(begins, begins[1:]):
        line, rest = lines[begin], lines[begin + 1:end]
        if line[0] not in SYSTEMS or len(rest) != 7:
            continue
        toc = datetime.datetime(*(int(part) for part in line[4:23].split())) - GPS_EPOCH
        clock = [_number(line[23 + 19 * i:42 + 19 * i]) for i in range(3)]
        yield (line[:3].replace(" ", "0"), toc.days * 86400 + toc.seconds, clock,
               [_number(row[4 + 19 * i:23 + 19 * i]) for row in rest for i in range(4)])


def _number(field):
    return float(field.replace("D", "E").replace("d", "e")) if field.strip() else 0.0
