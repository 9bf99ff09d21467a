"""The tables that the replay of a run's journal has written."""
import csv
from typing import NamedTuple

from service_faults.drive import START_S


class Innovation(NamedTuple):
    t: float  # s since the start
    satellite: str
    reason: str
    innovation_m: float  # of a Doppler m/s


def innovations_of(run, satellite, observable):
    """What the filter made of a satellite's measurements; the journal must have been replayed."""
    with open(run.folder / "replay" / "measurements.csv", newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["satellite"] == satellite and row["observable"] == observable:
                t = int(row["gps_week"]) * 604800 + float(row["gps_tow_s"]) - START_S
                yield Innovation(t, satellite, row["reason"], float(row["innovation"]))
