"""Several seeds to one number and its spread."""
import math
import statistics


def good(results):
    """Results that are numbers, by seed."""
    return {s: r for s, r in results.items() if r and "failure" not in r}


def common(*results_of_rows):
    """Seeds that all of these rows have numbers of, in order."""
    return sorted(set.intersection(*(set(good(results)) for results in results_of_rows)))


def mean_spread(values):
    values = [v for v in values if v is not None and math.isfinite(v)]
    if not values:
        return None
    return statistics.fmean(values), statistics.stdev(values) if len(values) > 1 else 0.0


def of(results, key, index=None, seeds=None):
    """Mean and spread over the good seeds, or those of `seeds` alone."""
    picked = []
    for seed, result in good(results).items():
        value = result.get(key) if seeds is None or seed in seeds else None
        picked.append(value if index is None or value is None else value[index])
    return mean_spread(picked)


def median_time(results, key="convergence_s", seeds=None):
    """Median over all seeds (or `seeds`), in s; one that never converged or failed counts as later than all.

    (median or None, seeds with a time, seeds)
    """
    numbers = good(results)
    times = [numbers[s].get(key) if s in numbers else None for s in (results if seeds is None else seeds)]
    if not times:
        return None, 0, 0
    middle = statistics.median(math.inf if t is None else t for t in times)
    return (middle if math.isfinite(middle) else None), sum(t is not None for t in times), len(times)


def text(pair, digits=2):
    if pair is None:
        return "-"
    return f"{pair[0]:.{digits}f} ± {pair[1]:.{digits}f}"
