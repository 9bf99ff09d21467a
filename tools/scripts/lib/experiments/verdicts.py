"""What LEO brings: every row with LEO against the same drives without, and beside it what LEO brings the papers."""
import math
import re
import statistics

import published
import spread

# Why a row with LEO is better by less than the papers say stands there only where it is proven: fewer LEO satellites
# (satellites_text), or rows open-* that reach it (houses_text).
NOT_KNOWN = "cause not known"


def name_without_leo(name):
    """Of the row that has everything but LEO."""
    if name.startswith("convergence-"):
        return re.sub(r"-leo\d+$", "-leo0", name)
    return "-".join(part for part in name.split("-") if not re.fullmatch(r"leo\d*", part))


def pairs(rows):
    """(without LEO, with LEO), of the same scene: the same logs."""
    by_name = {row.name: row for row in rows}
    for row in rows:
        partner = by_name.get(name_without_leo(row.name))
        if partner is not None and partner is not row and partner.scene.name == row.scene.name:
            yield partner, row


def published_3d(row):
    if row.is_set():
        return statistics.fmean(row.published_sets)
    return None if row.published is None else row.published.three_d()


def is_alike(row):
    """Whether the published errors are those of the same kind of estimator, a filter or a factor graph."""
    theirs = published.FACTOR_GRAPH if row.is_set() else row.published.estimator
    return theirs == (published.FILTER if row.filter is None else published.FACTOR_GRAPH)


def value_of(row, result):
    """What is compared, one number per seed: less is better; never converged is infinity."""
    if row.by_time:
        value = result["convergence_s"]
    else:
        value = result["after_convergence"] if row.is_set() else result["rmse"][3]
    return math.inf if value is None else value


def added_by_leo(row):
    """Satellites that LEO adds in the papers; None: not printed."""
    row = row.filter or row
    name = row.name.removesuffix("-ins")
    key = name.split("-", 1)[1]
    if row.group == "low":
        return published.LOW_SKY[key + "-ins"] - published.LOW_SKY[name_without_leo(key) + "-ins"]
    where = {"code": published.A, "carrier": published.B}.get(row.group)
    means = [next((n for w, n, _ in published.SKY.get(k, []) if w == where), None) for k in (name_without_leo(key), key)]
    return None if None in means else means[1] - means[0]


def satellites_text(partner, row, results, seeds):
    """Of a row that LEO improves by less than published: that fewer LEO satellites were there. "": they were not fewer."""
    theirs = added_by_leo(row)
    before, after = (spread.of(results[r.name], "satellites", seeds=seeds) for r in (partner, row))
    if theirs is None or before is None or after is None or after[0] - before[0] >= theirs - 0.5:
        return ""
    return f"LEO adds {after[0] - before[0]:.1f} satellites here, {theirs:.1f} in the paper (see Satellites and PDOP)"


def houses_text(verdict, others):
    """That LEO over the same drives reaches the published improvement where no house hides it. "": no such row does."""
    for other in others:
        if other.row.housed is (verdict.row.filter or verdict.row) and other.ours is not None and other.ours >= verdict.theirs:
            whose = "" if verdict.row.filter is None else " by the filter"
            return ("LEO stands behind our houses; without them, as in the paper, and masked at 5 degrees, "
                    f"{100.0 * other.ours:+.0f} %{whose} (`{other.row.name}`)")
    return ""


def reflections_text(verdict, others, results):
    """The reflections of the row of the same drives whose LEO no house hides, where that misses it too."""
    own = own_reflections_text(verdict, results)
    if own:
        return own
    for other in others:
        if other.row.housed is (verdict.row.filter or verdict.row):
            open_text = own_reflections_text(other, results)
            return open_text and f"LEO stands behind our houses, and {open_text}"
    return ""


def own_reflections_text(verdict, results):
    """That what the other system's codes bring without weights keeps LEO from more: LEO without them is better than both."""
    name = "-".join(part for part in verdict.row.name.split("-") if part != "gps")
    alone = results.get(name)
    if "-plain" not in name or name == verdict.row.name or not alone:
        return ""
    seeds = [s for s in verdict.seeds if s in spread.good(alone)]
    if not seeds:
        return ""
    mean = statistics.fmean(value_of(verdict.row, alone[s]) for s in seeds)
    gain = published.improvement(verdict.before, mean)
    if gain is None or gain < verdict.theirs:
        return ""
    return (f"reflected GPS codes keep their full weight whatever LEO adds: the same LEO without GPS {mean:.2f} m, "
            f"{100.0 * gain:+.0f} % (`{name}`)")


class Verdict:
    def __init__(self, partner, row, results):
        self.partner, self.row = partner, row
        self.seeds = spread.common(results[partner.name], results[row.name])
        before, after = ([value_of(r, results[r.name][s]) for s in self.seeds] for r in (partner, row))
        self.better = sum(b < a for a, b in zip(before, after))
        if row.by_time:
            self.before, self.after = (statistics.median(v) if v else None for v in (before, after))
        else:
            both = [(a, b) for a, b in zip(before, after) if math.isfinite(a) and math.isfinite(b)]
            self.before, self.after = (statistics.fmean(v) for v in zip(*both)) if both else (None, None)
        self.improves = self.before is not None and self.after < self.before
        self.ours = published.improvement(self.before, self.after)
        self.theirs = published.improvement(published_3d(partner), published_3d(row))
        self.rooted = None
        if self.theirs is not None and not row.is_set():
            self.rooted = published.by_components(partner.published, row.published)
        # A filter is not judged by what LEO brings a factor graph.
        self.reached = None if self.theirs is None or self.ours is None or not is_alike(row) else self.ours >= self.theirs

    def cause(self, results, others):
        """Why it does not improve, or by less than published; "-": it does."""
        if self.before is None or (self.improves and self.reached is not False):
            return "-"
        fewer = satellites_text(self.partner, self.row, results, self.seeds) if self.improves else ""
        reflections = reflections_text(self, others, results) if self.improves else ""
        return "; ".join(c for c in (houses_text(self, others), fewer, reflections) if c) or NOT_KNOWN

    def line(self, results, others):
        def number(value):
            if value is None or not math.isfinite(value):
                return "-" if value is None else "never"
            return f"{value:.0f} s" if self.row.by_time else f"{value:.2f} m"
        if self.before is None:
            verdict = "no seed of both"
        else:
            verdict = "improves" if self.improves else "DOES NOT IMPROVE"
            if self.ours is not None:
                verdict += f" ({100.0 * self.ours:+.0f} %)"
        theirs = "-" if self.theirs is None else f"{100.0 * self.theirs:+.0f} %"
        if self.reached is not None:
            theirs += ": reached" if self.reached else ": MISSED"
            if self.rooted is not None:
                theirs += f" (from N, E and U {100.0 * self.rooted:+.0f} %: {'reached' if self.ours >= self.rooted else 'MISSED'})"
        elif self.theirs is not None and not is_alike(self.row):
            theirs += " by the factor graph: not judged"
        return (f"| `{self.partner.name}` → `{self.row.name}` | {number(self.before)} | {number(self.after)} | {len(self.seeds)} | "
                f"{self.better} | {verdict} | {theirs} | {self.cause(results, others)} |")


def lines(rows, results):
    # Of the smoother those rows alone whose improvement is published.
    verdicts = [Verdict(partner, row, results) for partner, row in pairs(rows)
                if not row.is_whole_log() and (row.filter is None or published_3d(row) is not None)]
    if not verdicts:
        return []
    judged = [v for v in verdicts if v.before is not None]
    compared = [v for v in judged if v.reached is not None]
    return ["## What LEO brings: verdicts", "",
            f"LEO improves {sum(v.improves for v in judged)} of {len(judged)} rows, and reaches {sum(v.reached for v in compared)} "
            f"of {len(compared)} published improvements of the same kind of estimator.", "",
            "Every row with LEO against the same drives without. Mean 3D RMSE over the seeds that both rows have (of the sets: from "
            "3 m on); of convergence the median time to 10 cm. Published: the improvement of the 3D error; where that is not printed, "
            "that of the root of the squares of N, E and U. It is the improvement of their estimator on their recorded drive with "
            "simulated LEO, ours that of our estimator on simulated drives. A published improvement of the factor graph is compared "
            "with the smoother's (`fgo-*`) alone. The estimators of Remote Sensing have no robust weights; ours without them are "
            "the rows `carrier-*-plain`.", "",
            "| without LEO → with LEO | without | with | seeds | better in | verdict | published | cause |",
            "|---|---|---|---|---|---|---|---|"] + [v.line(results, verdicts) for v in verdicts] + [""]
