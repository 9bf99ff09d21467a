"""Logs, journals, solutions and live messages of leonav for Python.

  leonav.read_log("run.journal")          dict of DataFrames by channel: "SOLUTION", "IMU", "GNSS_EPOCH", ...
  leonav.read_solution("solution.csv")    a DataFrame
  leonav.events("run.journal")            every event of a log, with its byte and its data
  leonav.decode(data)                     (type's name, members) of one message
  leonav.subscribe()                      live messages, as they come
"""
from .errors import LeonavError, LeonavWarning
from .event_log import Event, events
from .live import Message, subscribe
from .message import decode
from .version import __version__

__all__ = ["Event", "LeonavError", "LeonavWarning", "Message", "__version__", "decode", "events", "read_log", "read_solution", "subscribe"]


def __getattr__(name):
    """Imports what needs pandas when it is first used: live messages need numpy only."""
    if name == "read_log":
        from .log import read_log
        return read_log
    if name == "read_solution":
        from .solution_csv import read_solution
        return read_solution
    raise AttributeError(f"module 'leonav' has no attribute '{name}'")
