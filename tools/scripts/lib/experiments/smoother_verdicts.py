"""The smoother against the filter: the same drives and measurements, row by row, and beside its gain that of the papers."""
import math
import statistics

import published
import spread
import verdicts

MOST = 1.03  # 3D error over the filter's, in any row
LEAST_GAIN = 0.20  # mean over the urban and low-observability rows
URBAN_GROUPS = ("fgo-carrier", "fgo-low")
ROBUST_GROUPS = ("fgo-code", "fgo-few-gps", "fgo-few-leo", "fgo-carrier", "fgo-low")
LEAST_WITHIN = 0.98  # three stated sigma
TABLE_3 = {"fgo-carrier": "with robust weights", "fgo-carrier-plain": "without robust weights, as theirs"}


def published_pair(row):
    """(EKF, factor graph) of the same measurements in table 3 of Remote Sensing, or None."""
    key = row.name.removeprefix("fgo-carrier-").removesuffix("-plain")
    if row.group not in TABLE_3 or key not in published.CARRIER_SMOOTHER:
        return None
    return published.CARRIER[key], published.CARRIER_SMOOTHER[key]


class Comparison:
    def __init__(self, row, results):
        self.row = row
        pair = results.get(row.filter.name, {}), results[row.name]
        # Sets that never converge have no error to compare.
        self.seeds = [s for s in spread.common(*pair) if all(math.isfinite(verdicts.value_of(row, r[s])) for r in pair)]
        self.before, self.after = ([verdicts.value_of(row, r[s]) for s in self.seeds] for r in pair)
        whole = spread.good(results.get(row.whole_log.name, {}))
        self.bound = [verdicts.value_of(row, whole[s]) for s in self.seeds] if set(self.seeds) <= set(whole) else []
        self.within = [spread.of(r, "within_three_sigma", seeds=self.seeds) for r in pair]
        self.ratio = None
        if self.seeds and statistics.fmean(self.before) > 0.0:
            self.ratio = statistics.fmean(self.after) / statistics.fmean(self.before)
        pair = published_pair(row)
        self.theirs = pair and published.improvement(pair[0].three_d(), pair[1].three_d())
        self.rooted = pair and published.by_components(*pair)

    def published_text(self):
        """Their factor graph's gain on their EKF."""
        if self.theirs is None:
            return "-" if verdicts.published_3d(self.row) is None else "no EKF printed"
        rooted = "" if self.rooted is None else f" (from N, E and U {100.0 * self.rooted:+.0f} %)"
        return f"{100.0 * self.theirs:+.0f} %{rooted}"

    def line(self):
        better = sum(a < b for b, a in zip(self.before, self.after))
        shares = " → ".join("-" if w is None else f"{100.0 * w[0]:.1f} %" for w in self.within)
        verdict = "-" if self.ratio is None else f"{100.0 * (1.0 - self.ratio):+.0f} %" + ("" if self.ratio <= MOST else ": WORSE")
        numbers = (spread.text(spread.mean_spread(v)) if v else "-" for v in (self.before, self.after, self.bound))
        return f"| `{self.row.name}` | {' | '.join(numbers)} | {better} of {len(self.seeds)} | {verdict} | {self.published_text()} | {shares} |"


def number_reached(ours, theirs):
    return sum(a >= b for a, b in zip(ours, theirs))


def mean_percent(shares):
    return round(100.0 * statistics.fmean(shares))


def published_sentences(compared):
    """Our gains beside the published ones, where both are there."""
    text = []
    for group, words in TABLE_3.items():
        some = [c for c in compared if c.row.group == group and c.theirs is not None]
        if some:
            ours, theirs = [1.0 - c.ratio for c in some], [c.theirs for c in some]
            rooted = [c.theirs if c.rooted is None else c.rooted for c in some]
            text.append(f"{words}: reached in {number_reached(ours, theirs)} of {len(some)} rows, {mean_percent(ours)} % on the mean "
                        f"beside {mean_percent(theirs)} %" +
                        (f" (from N, E and U: {number_reached(ours, rooted)} of {len(some)}, {mean_percent(rooted)} %)"
                         if rooted != theirs else ""))
    if not text:
        return []
    return ["The published gain of the factor graph on the EKF (Remote Sensing, table 3), " + "; ".join(text) + ".", "",
            "What each side had. The paper: one recorded drive with simulated LEO, GPS L1 and L2 or BeiDou B1I and B3I, codes, carriers "
            "and Dopplers, precise orbits, a tactical IMU, weights by elevation alone for both of its estimators. Here: simulated "
            "drives with the same signals, precise orbits with errors, an IMU with the data sheet of theirs. Only the gain of each on "
            "its own filter is compared: errors in metres are those of other drives.", ""]


def lines(rows, results):
    compared = [Comparison(row, results) for row in rows if row.filter is not None and row.studied is None]
    missing = [c.row.name for c in compared if c.ratio is None]
    compared = [c for c in compared if c.ratio is not None]
    if not compared:
        return []
    urban_robust = [c for c in compared if c.row.group in ROBUST_GROUPS]
    urban = [c for c in compared if c.row.group in URBAN_GROUPS]
    with_ins = [c for c in urban if "INS" in c.row.title]
    gains = [f"{100.0 * statistics.fmean(1.0 - c.ratio for c in some):.0f} % better {words}" for some, words in (
        (urban, f"in the {len(urban)} urban and low-observability rows with carriers (target {100.0 * LEAST_GAIN:.0f} %)"),
        (with_ins, f"in the {len(with_ins)} of them that have an INS"),
        (urban_robust, f"in all {len(urban_robust)} robust rows of the city and the dense city")) if some]
    text = [f"Of {len(compared)} rows {sum(c.ratio <= MOST for c in compared)} have a 3D error of at most {MOST:.2f} times the "
            f"filter's (worst {max(c.ratio for c in compared):.2f})."]
    text += [f"{'It' if i else 'On the mean the smoother'} is {gain}." for i, gain in enumerate(gains)]
    within = [c for c in compared if c.within[1] is not None and c.within[1][0] >= LEAST_WITHIN]
    text.append(f"In {len(within)} rows {100.0 * LEAST_WITHIN:.0f} % of the smoother's errors are within three stated sigma.")
    if missing:
        text.append(f"Not to be compared: {', '.join(missing)}.")
    return ["## The smoother against the filter", "", " ".join(text), "", *published_sentences(compared),
            "The same drives and measurements; W = 20 unless stated otherwise. Columns: mean ± standard deviation of the 3D RMSE "
            "over the seeds (of the sets from 3 m on); the seeds in which the smoother is better; its gain on the mean. Then the "
            "published gain of the factor graph on the EKF, and the share of north, east and up errors within three stated sigma. "
            "*Whole log* is `leonav-smooth`, which knows the future too.", "",
            "| | filter, m | smoother, m | whole log, m | better in | gain | published gain | within three sigma |",
            "|---|---|---|---|---|---|---|---|"] + [c.line() for c in compared] + [""]


def study_lines(rows, results):
    """Each beside the row that it varies and the filter."""
    body = []
    for studied in dict.fromkeys(row.studied for row in rows):
        mine = [row for row in rows if row.studied is studied]
        everyone = [studied.filter, studied] + mine
        if any(row.name not in results for row in everyone):
            continue
        seeds = spread.common(*(results[row.name] for row in everyone))
        base = spread.of(results[studied.filter.name], "rmse", 3, seeds)
        for row in everyone:
            words = {studied.filter: "the filter", studied: "W = 20"}.get(row, row.title.split(": ")[-1])
            mean = spread.of(results[row.name], "rmse", 3, seeds)
            gain = "-" if mean is None or base is None else f"{100.0 * (1.0 - mean[0] / base[0]):+.0f} %"
            share = spread.of(results[row.name], "within_three_sigma", seeds=seeds)
            body.append(f"| {studied.title}, {studied.scene.name} | {words} | {spread.text(mean)} | {gain} | "
                        f"{'-' if share is None else f'{100.0 * share[0]:.1f} %'} |")
    if not body:
        return []
    return ["", "Beside the filter, over the seeds that all have:", "", "| drive | smoother | 3D, m | gain | within three sigma |",
            "|---|---|---|---|---|"] + body
