"""The smoother against the filter: the same drives and measurements, row by row, and the published factor graph beside it."""
import math
import statistics

import spread
import verdicts

MOST = 1.03  # 3D error over the filter's, in any row
LEAST_GAIN = 0.20  # mean over the urban and low-observability rows
URBAN_GROUPS = ("fgo-carrier", "fgo-low")
ROBUST_GROUPS = ("fgo-code", "fgo-few-gps", "fgo-few-leo", "fgo-carrier", "fgo-low")
LEAST_FACTOR = 3.0  # published error over ours
LEAST_WITHIN = 0.98  # three stated sigma


class Comparison:
    def __init__(self, row, results):
        self.row = row
        pair = results.get(row.filter.name, {}), results[row.name]
        # Sets that never converge have no error to compare.
        self.seeds = [s for s in spread.common(*pair) if all(math.isfinite(verdicts.value_of(row, r[s])) for r in pair)]
        self.before, self.after = ([verdicts.value_of(row, r[s]) for s in self.seeds] for r in pair)
        self.within = [spread.of(r, "within_three_sigma", seeds=self.seeds) for r in pair]
        self.ratio = None
        if self.seeds and statistics.fmean(self.before) > 0.0:
            self.ratio = statistics.fmean(self.after) / statistics.fmean(self.before)

    def line(self):
        better = sum(a < b for b, a in zip(self.before, self.after))
        shares = " → ".join("-" if w is None else f"{100.0 * w[0]:.1f} %" for w in self.within)
        verdict = "-" if self.ratio is None else f"{100.0 * (1.0 - self.ratio):+.0f} %" + ("" if self.ratio <= MOST else ": WORSE")
        theirs = verdicts.published_3d(self.row)
        factor = "-"
        if theirs is not None and self.seeds:
            ours = statistics.fmean(self.after)
            factor = f"{theirs:.2f} m / {theirs / ours:.1f}" if ours > 0.0 else "-"
        numbers = (spread.text(spread.mean_spread(v)) for v in (self.before, self.after))
        return f"| `{self.row.name}` | {' | '.join(numbers)} | {better} of {len(self.seeds)} | {verdict} | {shares} | {factor} |"


def lines(rows, results):
    compared = [Comparison(row, results) for row in rows if row.filter is not None and row.studied is None]
    missing = [c.row.name for c in compared if c.ratio is None]
    compared = [c for c in compared if c.ratio is not None]
    if not compared:
        return []
    urban_robust = [c for c in compared if c.row.group in ROBUST_GROUPS]
    urban = [c for c in compared if c.row.group in URBAN_GROUPS]
    with_ins = [c for c in urban if "INS" in c.row.title]
    table_3 = [c for c in compared if c.row.group == "fgo-carrier" and c.row.published is not None]
    gains = [f"{100.0 * statistics.fmean(1.0 - c.ratio for c in some):.0f} % better {words}" for some, words in (
        (urban, f"in the {len(urban)} urban and low-observability rows with carriers (target {100.0 * LEAST_GAIN:.0f} %)"),
        (with_ins, f"in the {len(with_ins)} of them that have an INS"),
        (urban_robust, f"in all {len(urban_robust)} robust rows of the city and the dense city")) if some]
    factors = [verdicts.published_3d(c.row) / statistics.fmean(c.after) for c in table_3]
    text = [f"Of {len(compared)} rows {sum(c.ratio <= MOST for c in compared)} have a 3D error of at most {MOST:.2f} times the "
            f"filter's (worst {max(c.ratio for c in compared):.2f})."]
    text += [f"{'It' if i else 'On the mean the smoother'} is {gain}." for i, gain in enumerate(gains)]
    within = [c for c in compared if c.within[1] is not None and c.within[1][0] >= LEAST_WITHIN]
    text.append(f"In {len(within)} rows {100.0 * LEAST_WITHIN:.0f} % of the smoother's errors are within three stated sigma.")
    if missing:
        text.append(f"Not to be compared: {', '.join(missing)}.")
    if factors:
        text.append(f"The published factor graph's errors (table 3) are at least {min(factors):.1f} times ours (target "
                    f"{LEAST_FACTOR:.0f}).")
    return ["## The smoother against the filter", "", " ".join(text), "",
            "The same drives and measurements; W = 20 unless stated otherwise. Columns: mean ± standard deviation of the 3D RMSE "
            "over the seeds (of the sets from 3 m on); the seeds in which the smoother is better; its gain on the mean. Then the "
            "share of north, east and up errors within three stated sigma, and the published error of the factor graph over ours.", "",
            "| | filter, m | smoother, m | better in | gain | within three sigma | published / factor |",
            "|---|---|---|---|---|---|---|"] + [c.line() for c in compared] + [""]


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
