"""Several seeds to one number and its spread."""
import math
import statistics


def good(results):
    """Results that are numbers, by seed."""
    return {s: r for s, r in results.items() if r and "failure" not in r}


def mean_spread(values):
    values = [v for v in values if v is not None and math.isfinite(v)]
    if not values:
        return None
    return statistics.fmean(values), statistics.stdev(values) if len(values) > 1 else 0.0


def of(results, key, index=None):
    picked = []
    for result in good(results).values():
        value = result.get(key)
        picked.append(value if index is None or value is None else value[index])
    return mean_spread(picked)


def median_time(results, key="convergence_s"):
    """Median over all seeds, in s; a seed that never converged counts as later than all. (median or None, share)"""
    times = [r.get(key) for r in good(results).values()]
    if not times:
        return None, 0, 0
    ordered = sorted(math.inf if t is None else t for t in times)
    middle = ordered[len(ordered) // 2] if len(ordered) % 2 else 0.5 * (ordered[len(ordered) // 2 - 1] + ordered[len(ordered) // 2])
    return (middle if math.isfinite(middle) else None), sum(t is not None for t in times), len(times)


def text(pair, digits=2):
    if pair is None:
        return "-"
    return f"{pair[0]:.{digits}f} ± {pair[1]:.{digits}f}"
