"""The numbers of the report's tables, as texts."""
import collections

import numpy as np

from . import style
from .gaps import solution_gaps
from .map_view import horizontal_sigma
from .residuals import KINDS, counts, kinds_of, tried
from .timeline import gap_note, miss_rows, shares

MOST_ROWS = 20


def _metres(value):
    return f"{value:.3g} m" if np.isfinite(value) else "-"


def summary(runs, errors):
    """Header and rows: one column for each run."""
    rows = collections.OrderedDict()

    def put(name, value):
        rows.setdefault(name, []).append(value)
    for index, run in enumerate(runs):
        table = run.solution
        put("start", style.utc_text(table.time[0]))
        put("duration", style.duration(table.time[-1] - table.time[0]))
        put("solutions", f"{len(table)}" + (" shown, thinned" if run.continuous else ""))
        put("gaps of the solution", gap_note(run.solution_gaps if run.continuous else solution_gaps(table)))
        put("answered by", shares(table["source"], style.SOURCE_NAMES) or "-")
        sigma = horizontal_sigma(table)
        put("horizontal 1 sigma, median", _metres(np.nanmedian(sigma)) if np.isfinite(sigma).any() else "-")
        satellites = (run.epochs if run.epochs is not None and "satellites" not in table else table)["satellites"]
        put("satellites used, median", f"{np.nanmedian(satellites):.0f}" if np.isfinite(satellites).any() else "-")
        late = miss_rows(run)
        put("late results", "; ".join(f"{row.name}: {row.note}" for row in late))
        if errors is not None:
            horizontal = np.hypot(errors[index][0], errors[index][1])
            horizontal = horizontal[np.isfinite(horizontal)]
            up = errors[index][2][np.isfinite(errors[index][2])]
            put("epochs with a truth", f"{len(horizontal)}")
            put("horizontal error: RMSE", _metres(np.sqrt(np.mean(horizontal ** 2))))
            put("horizontal error: 95 %", _metres(np.percentile(horizontal, 95)))
            put("horizontal error: largest", _metres(horizontal.max()))
            put("vertical error: RMSE", _metres(np.sqrt(np.mean(up ** 2))))
    return ["", *(run.label for run in runs)], [[name, *values] for name, values in rows.items()]


def gap_table(run, start):
    """The longest gaps of the solution."""
    found = run.solution_gaps if run.continuous else solution_gaps(run.solution)
    found = found[np.argsort(found[:, 0] - found[:, 1], kind="stable")][:MOST_ROWS]
    hours = run.solution.time[-1] - start >= 3600
    return ["from", "to", "duration"], [[style.clock_text(begin -
    start, hours), style.clock_text(end -
    start, hours), style.duration(end -
     begin)] for begin, end in found]


def residual_table(run):
    """Each kind with its counts and the RMS of its residuals."""
    table, good = run.measurements, tried(run.measurements)
    rows = []
    for kind in kinds_of(table):
        mine = good & (table["observable"] == kind)
        if not mine.any():
            continue
        one, name = counts(table["reason"][mine]), KINDS[kind]
        used = table["residual"][mine & np.isin(table["reason"], ("used", "downweighted"))]
        rms = f"{np.sqrt(np.mean(used ** 2)):.3g} {name[1]}" if len(used) else "-"
        rows.append([name[0], f"{one.used}", f"{one.weakened}", f"{one.rejected}",
                    f"{100.0 * one.rejected / max(one.total, 1):.2f} %", rms])
    return ["kind", "used", "of them down-weighted", "rejected", "rejected, share", "RMS of those used"], rows


def reason_table(run):
    """What became of satellites, in satellite epochs."""
    reasons, number = np.unique([*run.satellites["reason"]], return_counts=True)
    order = np.argsort(-number, kind="stable")
    return ["what became of satellites", "satellite epochs", "share"], [[str(reasons[one]).replace("_", " "), f"{number[one]}",
                                                                         f"{100.0 * number[one] / number.sum():.1f} %"] for one in order]


def health_table(run):
    """The reasons in HEALTH and for how many of its messages, one a second, each held."""
    counted = collections.Counter()
    for status, why in zip(run.health["status"], run.health["why"]):
        for reason in filter(None, why.split("; ")):
            counted[(status, reason)] += 1
    return ["status", "reason", "messages, one a second"], [[status, reason[:200], f"{number}"]
                                                            for (status, reason), number in counted.most_common(MOST_ROWS)]
