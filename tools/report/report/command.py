"""The command line of leonav-report."""
import argparse
import sys

import leonav
import numpy as np

from . import accuracy_pictures, error_pictures, numbers, residual_pictures, timeline_picture
from .errors import ReportError
from .local_frame import LocalFrame
from .map_picture import COLORS_BY, draw_map
from .page import Page
from .run import add_journal, read_run
from .sky_picture import draw_sky
from .tables import POSITION, read_csv

MAP_TEXT = (
    "The track on a scale, in metres from its first point; dashed blue lines are whole degrees, minutes or seconds. A gap is dashed, with "
    "its duration.")
SKY_TEXT = (
    "Each line is a satellite over the run, its mark where it was last. Cells darken with the share of epochs in which a signal was lost: "
    "the satellite was there before and after, or came too weak. Directions are to north, also of a vehicle that turns, so that in streets "
    "this is a mean of what stood around it.")
RESIDUAL_TEXT = "What the update left of each measurement. Rejected ones that are larger than the picture stand at its edge."
SATELLITE_TEXT = (
    "Colour is the largest residual of a satellite in its slice of time, over the RMS of all residuals of its kind that were used; grey: "
    "there was none. A column of one colour is a common cause.")
TIMELINE_TEXT = "Short events are drawn wider than they are."


def arguments(words):
    parser = argparse.ArgumentParser(
        prog="leonav-report", formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Shows one or several runs: a map with gaps and what lies outside, errors against a truth, satellites and dilution\n"
                    "of precision, sigma and protection levels; of each run a sky plot, residuals by kind and by satellite, and what\n"
                    "happened when: HEALTH, who answered, late results, gaps of inputs, events. Needs no display and no network.",
        epilog="A RUN is a journal of leonavd (its first piece, or the folder with its pieces, stands for all of them), or what leonav-replay\n"
               "or leonav-smooth wrote: the folder, or its solution.csv, beside which satellites.csv, measurements.csv and events.csv are read\n"
               "where they are; or RTKLIB's .pos file. What a run does not hold is left out, and the page says so. Journals need\n"
               "python3-pandas.\n\n"
               "  leonav-report run.journal -o report.html\n"
               "  leonav-report --truth truth.csv smoother=result filter=result/filter.csv -o plots\n"
               "  leonav-report result --journal run.journal --color sigma -o report.html\n\n"
               "Exit codes: 0 written; 1 a file cannot be used; 2 command line.")
    parser.add_argument("runs", nargs="+", metavar="[LABEL=]RUN", help="one or more; the first is drawn in most detail")
    parser.add_argument(
    "-o",
    "--out",
    required=True,
    metavar="PATH",
    help="a file NAME.html that holds everything, or a folder for PNG files and "
    "an index.html; made if needed")
    parser.add_argument("--truth", metavar="FILE", help="truth.csv; without it there are no errors")
    parser.add_argument("--journal", metavar="PATH", help="journal of the first RUN, or the folder with its pieces, for what its tables do not hold")
    parser.add_argument("--color", choices=COLORS_BY, default="source", help="what colours the first run on the map: who gave the answer, "
                                                                             "horizontal sigma, or speed [source]")
    parser.add_argument("--remove-offset", action="store_true", help="remove each run's mean error (a truth with an unknown datum)")
    parser.add_argument("--max-gap", type=float, default=2.0, metavar="S",
                        help="do not interpolate the truth over holes longer than this [2]")
    parser.add_argument("--version", action="version", version=f"%(prog)s {leonav.__version__}")
    parser.add_argument("--prefix", default="LEONAV_", metavar="TEXT", help="lcm.prefix of the journal's configuration [LEONAV_]")
    return parser.parse_args(words)


def tell(sentence):
    print(f"leonav-report: {sentence}", file=sys.stderr)


class Truth:
    """The truth and each run's errors against it."""

    def __init__(self, path):
        self.table = read_csv(path, POSITION, POSITION, tell)

    def errors(self, runs, frame, longest_hole_s):
        truth_neu, found = frame.of(self.table), []
        for run in runs:
            error = error_pictures.errors_against(run.solution, frame.of(run.solution), self.table, truth_neu, longest_hole_s)
            if not np.isfinite(error).all(axis=0).any():
                raise ReportError(
    f"{run.solution.path} and {self.table.path} have no common time; is this the truth of that run? Over holes of the "
    "truth --max-gap interpolates")
            found.append(error)
        return found


def report(options):
    """Reads, draws and writes; returns the paths of the files."""
    truth = Truth(options.truth) if options.truth else None
    runs = [read_run(word, options.prefix, tell) for word in options.runs]
    if options.journal:
        add_journal(runs[0], options.journal, options.prefix, tell)
    frame = LocalFrame(truth.table if truth else runs[0].solution)
    for run in runs:
        LocalFrame(run.solution)  # each has a position
    errors = truth.errors(runs, frame, options.max_gap) if truth else None
    offsets = [np.zeros((3, 1)) for _ in runs]
    if errors and options.remove_offset:
        # Off the track too: two metres apart nobody sees whether two tracks are alike.
        offsets = [np.nanmean(error, axis=1, keepdims=True) for error in errors]
        errors = [error - offset for error, offset in zip(errors, offsets)]
    start = min(run.solution.time[0] for run in runs)
    length = max(run.solution.time[-1] for run in runs) - start
    page = Page(options.out, ", ".join(run.label for run in runs))
    page.table(*numbers.summary(runs, errors))
    page.heading("Map")
    page.picture(draw_map(runs, offsets, truth.table if truth else None, frame, options.color), "track.png", MAP_TEXT)
    if errors:
        page.heading("Errors")
        page.picture(error_pictures.draw_errors(runs, errors, start, length), "errors.png", "Thin lines are three of the run's own sigmas.")
        page.picture(error_pictures.draw_distribution(runs, errors), "cdf.png", "How many epochs have at most this error.")
    page.heading("Satellites and accuracy")
    page.picture(accuracy_pictures.draw_satellites(runs, start, length), "satellites.png", "What the answers rest on.")
    page.picture(accuracy_pictures.draw_sigma(runs, errors, start, length), "sigma.png", "Sigma and protection levels are the run's own.")
    for index, run in enumerate(runs):
        _one_run(page, run, start, length, "" if index == 0 else f"-{index + 1}")
    return page.finish()


def _one_run(page, run, start, length, suffix):
    """What is shown of each run by itself."""
    page.heading(f"Run {run.label}")
    page.missing(run.missing)
    page.picture(timeline_picture.draw_timeline(run, start, length), f"timeline{suffix}.png", TIMELINE_TEXT)
    if run.health is not None:
        page.table(*numbers.health_table(run), caption="Reasons in HEALTH")
    page.table(*numbers.gap_table(run, start), caption="Longest gaps of the solution")
    if run.satellites is not None:
        page.picture(draw_sky(run), f"sky{suffix}.png", SKY_TEXT)
        page.table(*numbers.reason_table(run))
    if run.measurements is not None:
        page.picture(residual_pictures.draw_residuals(run, start), f"residuals{suffix}.png", RESIDUAL_TEXT)
        page.picture(residual_pictures.draw_residuals_by_satellite(run, start), f"residuals_by_satellite{suffix}.png", SATELLITE_TEXT)
        page.table(*numbers.residual_table(run))


def main(words):
    try:
        for path in report(arguments(words)):
            print(path)
    except ReportError as error:
        tell(error)
        return 1
    return 0
