"""report.md and report.json of a matrix: a row for each scene and estimator, over its seeds."""
import json
import os
import statistics

from . import matrix as matrices
from . import levels, measure, programs, report

AXES = measure.AXES
BAD_SHARE = 0.9


class Row:
    """One scene and variant over the seeds; `results` by seed."""

    def __init__(self, scene, variant, results):
        self.scene, self.variant, self.results = scene, variant, results
        self.name = matrices.row_name(scene, variant)
        self.good = {seed: r for seed, r in results.items() if r["failure"] is None}
        self.pooled = report.pooled(self.good.values())

    def all_but(self, axis):
        """The scene and the values of all axes but that at one place."""
        return self.scene.name, *(value for place, value in enumerate(self.variant.values) if place != axis)

    def complete(self):
        """Whether every seed has a result."""
        return bool(self.good) and len(self.good) == len(self.results)

    def mean(self, key, without=None):
        """RMSE, mean of all seeds, or of all but one."""
        values = [r["errors"][key]["rmse"] for seed, r in self.good.items() if seed != without]
        return statistics.fmean(values) if values else None

    def worst(self):
        """(3D RMSE, seed) of the seed with the largest."""
        return max(((r["errors"]["3d"]["rmse"], seed) for seed, r in self.good.items()), default=(None, None))

    def shares(self):
        return [report.share(self.pooled["sigmas"][axis]) if self.pooled else None for axis in AXES]

    def worst_shares(self):
        return [min((s for r in self.good.values() if (s := report.share(r["sigmas"][axis])) is not None), default=None) for axis in AXES]

    def ratios(self):
        return [self.pooled["sigmas"][axis]["sigma_over_rmse"] if self.pooled else None for axis in AXES]

    def available(self):
        return self.pooled["availability"] if self.pooled else None

    def integrity(self):
        return self.pooled["integrity"] if self.pooled else None

    def misleading(self):
        """Share of each quantity's epochs that is beyond its level; of those that have an epoch."""
        return [count / epochs for count, epochs in report.misleading(self.integrity()).values() if epochs] or [None]

    def values(self, measure_name):
        """Of a limit's measure, in its units: one number, or one of each axis."""
        def in_percent(values):
            return [None if v is None else 100.0 * v for v in values]
        return {"share": lambda: in_percent(self.shares()), "worst_share": lambda: in_percent(self.worst_shares()),
                "sigma_over_rmse": self.ratios, "rmse": lambda: [self.mean(axis) for axis in AXES],
                "rmse_horizontal": lambda: [self.mean("horizontal")], "rmse_3d": lambda: [self.mean("3d")],
                "misleading": lambda: in_percent(self.misleading()), "worst_3d": lambda: [self.worst()[0]], "available": lambda: in_percent([self.available()])}[measure_name]()

    def missed(self):
        """The limits that it does not keep to, with its values."""
        return [(limit, values) for limit in self.scene.limits if not limit.holds(values := self.values(limit.measure))]

    def verdict(self):
        failed = len(self.results) - len(self.good)
        parts = [f"FAILED in {failed} of {len(self.results)} seeds"] if failed else []
        missed = self.missed()
        if missed:
            parts.append("MISSED: " + "; ".join(f"{limit.text}: {report.triple(values)}" for limit, values in missed))
        return "; ".join(parts) or ("met" if self.scene.limits else "-")

    def line(self, with_integrity):
        worst, seed = self.worst()
        cells = [self.scene.name, *self.variant.values, f"{len(self.good)} of {len(self.results)}",
                 report.triple(self.mean(axis) for axis in AXES), report.number(self.mean("3d")),
                 "-" if worst is None else f"{worst:.2f} (seed {seed})", " / ".join(report.percent(v) for v in self.shares()),
                 " / ".join(report.percent(v) for v in self.worst_shares()), report.triple(self.ratios()), report.percent(self.available())]
        if with_integrity:
            cells.append(report.integrity_text(self.integrity()))
        return "| " + " | ".join([*cells, self.verdict()]) + " |"

    def plain(self):
        worst, seed = self.worst()
        return {"name": self.name, "scene": self.scene.name, "variant": list(self.variant.values), "verdict": self.verdict(),
                "mean_rmse": {key: measure.rounded(self.mean(key)) for key in (*AXES, "horizontal", "3d")},
                "worst_3d": measure.rounded(worst), "worst_seed": seed, "pooled": self.pooled,
                "share": [measure.rounded(v) for v in self.shares()], "worst_share": [measure.rounded(v) for v in self.worst_shares()],
                "limits_missed": [limit.text for limit, _ in self.missed()],
                "runs": [{"seed": seed, **report.plain_run(r)} for seed, r in sorted(self.results.items())]}


def rows_of(matrix, results):
    """`results` by (row's name, seed)."""
    return [Row(scene, variant, {seed: results[matrices.row_name(scene, variant), seed] for seed in matrix.seeds})
            for scene, variant in matrix.rows()]


def judged_of(rows):
    """(log, result) of every run with numbers. Rows of one scene replay the same logs."""
    return [((row.scene.name, seed), r) for row in rows for seed, r in sorted(row.good.items()) if r.get("judged")]


def availability_parts(matrix, rows):
    """((scene, value of the first axis), results) of each scene, and of all scenes, over what else the axes vary."""
    values = list(dict.fromkeys(row.variant.values[0] for row in rows))
    scenes = list(dict.fromkeys(row.scene.name for row in rows))
    parts = [((scene, value), [row for row in rows if (row.scene.name, row.variant.values[0]) == (scene, value)])
             for scene in scenes for value in values]
    parts += [(("all scenes", value), [row for row in rows if row.variant.values[0] == value]) for value in values]
    parts.append((("all scenes", "all together"), rows))
    return [(cells, [r for _, r in judged_of(some)]) for cells, some in parts if some]


def verdict_lines(matrix, rows):
    limited = [row for row in rows if row.scene.limits]
    if not limited:
        return []
    lines = [f"{sum(row.verdict() == 'met' for row in limited)} of {len(limited)} rows keep to every limit.", "",
             "| limit | rows that keep to it |", "|---|---|"]
    for limit in dict.fromkeys(limit for row in limited for limit in row.scene.limits):
        held = [row for row in limited if limit in row.scene.limits]
        lines.append(f"| {limit.text} | {sum(limit.holds(row.values(limit.measure)) for row in held)} of {len(held)} |")
    meanings = {limit.measure: matrices.MEASURES[limit.measure] for row in limited for limit in row.scene.limits}
    return [*lines, "", "; ".join(f"{name}: {text}" for name, text in meanings.items()) + ".", ""]


def bad_runs_lines(rows):
    """Each run with too few errors within three sigma on an axis, or with an error beyond its level, which a whole row hides."""
    lines = []
    for run in (run for row in rows for run in row.good.values() if run.get("judged")):
        shares = [report.share(run["sigmas"][axis]) for axis in AXES]
        beyond = {quantity: counts.get("misleading", 0) for quantity, counts in (run["integrity"] or {}).items() if isinstance(counts, dict)}
        if any(share is not None and share < BAD_SHARE for share in shares) or any(beyond.values()):
            cells = [run["name"], *(" / ".join(texts) for texts in ([report.percent(share) for share in shares],
                                                                  [report.number(run["errors"][axis]["rmse"]) for axis in AXES])),
                     ", ".join(f"{quantity} {count}" for quantity, count in sorted(beyond.items()) if count) or "-"]
            lines.append("| " + " | ".join(cells) + " |")
    return [f"## Single runs to look at: {len(lines)}", "", f"Less than {100 * BAD_SHARE:g} % of the errors of an axis within three sigma, "
            "or an error beyond its level.", "", "| run | within 3 sigma N / E / U, % | RMSE N / E / U, m | epochs beyond their level |",
            "|---|---|---|---|", *lines, ""] if lines else []


class BestOthers:
    """A scene with all axes but the compared one: the compared value's row, and that of the others with the least 3D RMSE."""

    def __init__(self, comparison, row, others):
        self.row, self.at_most = row, comparison.at_most
        self.best = min(others, key=lambda other: other.mean("3d"))
        self.best_name = self.best.variant.values[comparison.axis]
        self.ratios = {key: row.mean(key) / self.best.mean(key) for key in ("horizontal", "3d")}
        self.unseen_ratios = {key: row.mean(key) / self.unseen(others, key) for key in self.ratios} if len(row.good) > 1 else {}

    def unseen(self, others, key):
        """Mean RMSE over the seeds, at each that of the value that is the best at the other seeds."""
        return statistics.fmean(min(others, key=lambda other: other.mean("3d", seed)).good[seed]["errors"][key]["rmse"]
                                for seed in self.row.good)

    def holds(self):
        return all(ratio <= self.at_most for ratio in self.ratios.values())

    def line(self, axis):
        cells = [*self.row.all_but(axis), *(report.number(self.row.mean(key)) for key in self.ratios), self.best_name,
                 *(report.number(self.best.mean(key)) for key in self.ratios),
                 " / ".join(report.percent(share) for share in self.best.shares()), *(report.number(v) for v in self.ratios.values()),
                 "met" if self.holds() else "MISSED", " / ".join(report.number(v) for v in self.unseen_ratios.values()) or "-"]
        return "| " + " | ".join(cells) + " |"

    def plain(self):
        return {"name": self.row.name, "best": self.best.name, "ratios": {key: measure.rounded(v) for key, v in self.ratios.items()},
                "unseen_ratios": {key: measure.rounded(v) for key, v in self.unseen_ratios.items()}}


def compared(matrix, rows):
    """BestOthers of every row of the compared value that has others, all with every seed; none without a comparison."""
    comparison = matrix.comparison
    if comparison is None:
        return []

    found = []
    for row in rows:
        if row.variant.values[comparison.axis] != comparison.value or not row.complete():
            continue
        others = [other for other in rows if other is not row and other.complete()
                  and other.all_but(comparison.axis) == row.all_but(comparison.axis)]
        found += [BestOthers(comparison, row, others)] if others else []
    return found


def one_for_all(comparison, rows):
    """(value of the axis, geometric mean over all others of its 3D RMSE over that of the compared value, the largest ratio, the least
    share within three sigma), best first; of the other values that have every row."""
    by_value = {}
    for row in rows:
        if row.complete():
            by_value.setdefault(row.variant.values[comparison.axis], {})[row.all_but(comparison.axis)] = row
    own = by_value.pop(comparison.value, {})
    found = []
    for value, its in by_value.items():
        if own and its.keys() == own.keys():
            ratios = [its[key].mean("3d") / own[key].mean("3d") for key in own]
            shares = [share for row in its.values() for share in row.shares() if share is not None]
            found.append((value, statistics.geometric_mean(ratios), max(ratios), min(shares, default=None)))
    return sorted(found, key=lambda entry: entry[1])


def one_for_all_lines(matrix, rows):
    found = one_for_all(matrix.comparison, rows)
    if not found:
        return []
    value = matrix.comparison.value
    return [f"One for all, 3D RMSE over that of {value}: geometric mean of all rows, the largest, and the least share within three sigma.", "",
            f"| {matrix.axes[matrix.comparison.axis]} | mean | largest | least share, % |", "|---|---|---|---|",
            *(f"| {name} | {mean:.2f} | {largest:.2f} | {report.percent(least)} |" for name, mean, largest, least in found), ""]


def comparison_lines(matrix, rows):
    comparison = matrix.comparison
    if comparison is None:
        return []
    found = compared(matrix, rows)
    axis = matrix.axes[comparison.axis]
    if not found:
        return [f"## {comparison.value} against the best other {axis}", "", f"Nothing to compare: no scene has all seeds of {comparison.value} and "
                f"of another {axis}.", ""]
    header = ["scene", *(a for a in matrix.axes if a != axis), f"{comparison.value}: horizontal, m", "3D, m", f"best other {axis}",
              "horizontal, m", "3D, m", "its share within 3 sigma N / E / U, %", "horizontal ratio", "3D ratio", "verdict",
              "ratios by other seeds"]
    return [f"## {comparison.value} against the best other {axis}", "",
            f"The best has the least 3D RMSE of all others in the same scene, chosen with the truth in hand. In {sum(b.holds() for b in found)} of "
            f"{len(found)} rows {comparison.value} has at most {comparison.at_most:g} times its RMSE, horizontally and in 3D. Ratios by other "
            "seeds: as if the best had been chosen for each seed by the others, so that no luck is in the choice.", "",
            "| " + " | ".join(header) + " |", "|" + "---|" * len(header), *(b.line(comparison.axis) for b in found), "",
            *one_for_all_lines(matrix, rows)]


def markdown(matrix, rows):
    seeds = ", ".join(map(str, matrix.seeds))
    lines = [f"# {matrix.title}", "", f"Seeds {seeds}; the first {matrix.settle_s:g} s of each run do not count. RMSE: mean of the seeds. "
             "Within 3 sigma: of the epochs of all seeds together, and of the worst seed. Sigma / RMSE: mean stated sigma over RMSE, all "
             "seeds together.", ""]
    lines += [f"Skipped: {name}: {why}." for name, why in matrix.skipped] + ([""] if matrix.skipped else [])
    lines += verdict_lines(matrix, rows)
    with_integrity = any(row.pooled and row.pooled["integrity"] for row in rows)
    header = ["scene", *matrix.axes, "seeds", "RMSE N / E / U, m", "3D, m", "worst seed 3D, m", "within 3 sigma N / E / U, %",
              "worst seed, %", "sigma / RMSE N / E / U", "available, %", *(["misleading"] if with_integrity else []), "verdict"]
    lines += ["| " + " | ".join(header) + " |", "|" + "---|" * len(header), *(row.line(with_integrity) for row in rows), ""]
    failed = [r for row in rows for _, r in sorted(row.results.items()) if r["failure"] is not None]
    lines += report.failed_lines(failed)
    lines += bad_runs_lines(rows)
    lines += comparison_lines(matrix, rows)
    lines += levels.section(judged_of(rows), ["scene", matrix.axes[0]], availability_parts(matrix, rows))
    lines += ["## Commands", "", "Every run of every scene, first seed:", "", "```sh"]
    for scene in matrix.scenes:
        settings = programs.with_settings(scene.settings_of(matrix.seeds[0], matrix.per_seed))
        lines.append(programs.shell_line(["leonav-sim", os.path.relpath(scene.scenario), *settings, "-o", "run.lcmlog"]))
    lines += [programs.shell_line(["leonav-replay", *matrix.common, "run.lcmlog", "--out", "."]), "```", "", "with, for", ""]
    lines += [f"- {axis} {name}: " + (f"`{programs.shell_line(words)}`" if words else "nothing else")
              for axis, name, words in matrix.choices]
    return "\n".join(lines) + "\n"


def write(out, matrix, results):
    """Returns the path of report.md, that of stanford.json or None, and the rows."""
    rows = rows_of(matrix, results)
    plain = {"title": matrix.title, "seeds": matrix.seeds, "settle_s": matrix.settle_s, "skipped": matrix.skipped,
             "rows": [row.plain() for row in rows], "comparison": [b.plain() for b in compared(matrix, rows)],
             "protection_levels": levels.plain(judged_of(rows)),
             "level_availability": [{"scene": scene, "value": value, **levels.availability(results)}
                                    for (scene, value), results in availability_parts(matrix, rows)]}
    programs.write_atomically(os.path.join(out, "report.json"), json.dumps(plain, indent=1, sort_keys=True) + "\n")
    path = os.path.join(out, "report.md")
    programs.write_atomically(path, markdown(matrix, rows))
    return path, report.write_diagrams(out, judged_of(rows)), rows
