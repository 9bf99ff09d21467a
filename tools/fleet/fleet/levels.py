"""Protection levels of many runs: how often errors exceed them, with the confidence of that, and levels of larger risks.

Few hours cannot show a small risk. The same errors are therefore held against the levels that larger risks would give:
without fault hypotheses a level is a multiple of its sigma, and with them it is no smaller. Equations and reasons are in
docs/models/evaluation.md (protection levels over many runs).
"""
import collections
import dataclasses
import functools
import math

from . import measure

QUANTITIES = ("horizontal", "vertical", "heading")
COUNTS = ("expected", "epochs", "misleading", "blocks", "misleading_blocks")
RISKS = (1e-7, 1e-5, 1e-3, 1e-2, 1e-1, 1.0)  # per hour
HOUR_S = 3600.0
CONFIDENCE = 0.95  # of upper bounds
TENTHS = 10  # of a sigma, in which leonav-eval counts


@dataclasses.dataclass(frozen=True, order=True)
class Model:
    """What the runs' levels were computed with: keys integrity.* of the configuration."""
    risk_per_hour: float
    error_correlation_s: float
    sigma_factor: float
    tail_share: float
    tail_factor: float

    def text(self):
        return (f"risk {self.risk_per_hour:g} per hour, errors independent after {self.error_correlation_s:g} s, sigma factor "
                f"{self.sigma_factor:g}, tail {100.0 * self.tail_share:g} % of {self.tail_factor:g} sigma")


def model_of(result):
    """None: the run does not tell."""
    told = result.get("integrity_model")
    return Model(**{field.name: told[field.name] for field in dataclasses.fields(Model)}) if told else None


def exceedance(multiple, model):
    """Probability of an error beyond so many sigmas (core/integrity/overbound.h)."""
    core = multiple / (model.sigma_factor * math.sqrt(2.0))
    return (1.0 - model.tail_share) * math.erfc(core) + model.tail_share * math.erfc(core / model.tail_factor)


@functools.lru_cache(maxsize=None)
def multiple_of(quantity, risk_per_hour, model):
    """The level of a risk in sigmas, without fault hypotheses; horizontally each axis has half the risk."""
    samples = max(1.0, HOUR_S / model.error_correlation_s)
    risk = risk_per_hour / samples * (0.5 if quantity == "horizontal" else 1.0)
    low, high = 0.0, model.sigma_factor * model.tail_factor * 40.0  # erfc is 0 there
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if exceedance(middle, model) <= risk else (middle, high)
    return high


def term(events, mean):
    """Probability of just so many events."""
    return math.exp(events * math.log(mean) - mean - math.lgamma(events + 1))


def confidence_of(events, allowed):
    """Probability of more than `events` where `allowed` are expected: that of the statement that no more are."""
    if allowed <= 0.0:
        return 0.0
    if allowed >= events + 1:
        return max(0.0, 1.0 - math.fsum(term(k, allowed) for k in range(events + 1)))
    total, k, part = 0.0, events + 1, term(events + 1, allowed)
    while part > 1e-17 * total:
        total, k = total + part, k + 1
        part *= allowed / k
    return total


def at_most(events):
    """The number of expected events that is not exceeded with CONFIDENCE."""
    low, high = 0.0, 2.0 * events + 10.0
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if confidence_of(events, middle) >= CONFIDENCE else (middle, high)
    return high


class Sums:
    """Counts of one quantity over runs; whole numbers add up, ratios are compared."""

    def __init__(self):
        self.expected = self.epochs = self.misleading = self.blocks = self.misleading_blocks = 0
        self.limits = collections.defaultdict(collections.Counter)
        self.multiples, self.diagram = collections.defaultdict(collections.Counter), collections.Counter()
        self.seconds, self.largest_of_runs = [], []
        self.largest_ratio, self.misleading_runs = 0.0, 0

    def add(self, counts):
        for name in COUNTS:
            setattr(self, name, getattr(self, name) + counts.get(name, 0))
        self.misleading_runs += counts.get("misleading", 0) > 0
        self.largest_ratio = max(self.largest_ratio, counts.get("largest_ratio", 0.0))
        self.seconds.append(counts.get("observed_s", 0.0))
        for limit in counts.get("limits", []):
            self.limits[limit["limit_m"]].update({name: n for name, n in limit.items() if name != "limit_m"})
        for tenths, epochs, blocks in counts.get("multiples", []):
            self.multiples[tenths].update(epochs=epochs, blocks=blocks)
        self.largest_of_runs.append(max((m[0] for m in counts.get("multiples", [])), default=-1))
        for error, level, epochs in counts.get("diagram", []):
            self.diagram[error, level] += epochs

    def plain(self):
        return {**{name: getattr(self, name) for name in COUNTS}, "hours": rounded(self.hours()), "largest_ratio": self.largest_ratio}

    def hours(self):
        return math.fsum(self.seconds) / HOUR_S

    def beyond(self, multiple):
        """Epochs, blocks and runs with an error beyond so many sigmas, rounded down to tenths: never too few."""
        first = math.floor(TENTHS * multiple)
        found = [m for tenths, m in self.multiples.items() if tenths >= first]
        return sum(m["epochs"] for m in found), sum(m["blocks"] for m in found), sum(tenths >= first for tenths in self.largest_of_runs)

    def available(self, limit_m):
        """Epochs whose level is at most the limit."""
        of = self.limits.get(limit_m, collections.Counter())
        return of["nominal"] + of["misleading"] + of["hazardous"]

    def for_diagram(self):
        """What leonav-integrity-plots reads."""
        return {"epochs": self.epochs, "misleading": self.misleading,
                "limits": [{"limit_m": limit, **self.limits[limit]} for limit in sorted(self.limits)],
                "diagram": [[*bins, epochs] for bins, epochs in sorted(self.diagram.items())]}


def summed(results):
    """{quantity: Sums} of what leonav-eval counted; empty where it counted nothing."""
    sums = {}
    for result in results:
        for quantity in QUANTITIES:
            counts = (result.get("integrity") or {}).get(quantity)
            if counts is not None:
                sums.setdefault(quantity, Sums()).add(counts)
    return sums


@dataclasses.dataclass(frozen=True)
class Line:
    """One level against the errors: that of a risk, or the stated one."""
    quantity: str
    risk_per_hour: float
    stated: bool
    multiple: float  # of sigma; of the stated level the least
    ratio: float     # to that of the stated level
    hours: float
    epochs: int
    events: int      # blocks with an error beyond the level
    runs: int        # runs with one
    replays: float   # of one log

    def allowed(self):
        return self.risk_per_hour * self.hours

    def confidence(self):
        """Where all replays of one log tell no more than one of them; never more than if all told something new."""
        as_one = confidence_of(math.ceil(self.events / self.replays - 1e-9), self.allowed() / self.replays)
        return min(as_one, self.confidence_if_independent())

    def confidence_if_independent(self):
        return confidence_of(self.events, self.allowed())

    def rate(self):
        return self.events / self.hours if self.hours else None

    def rate_at_most(self):
        return at_most(math.ceil(self.events / self.replays - 1e-9)) * self.replays / self.hours if self.hours else None

    def plain(self):
        return {**dataclasses.asdict(self), **{name: rounded(getattr(self, name)()) for name in (
            "allowed", "confidence", "confidence_if_independent", "rate", "rate_at_most")}}

    def cells(self):
        level = f"as stated (at least {self.multiple:.2f} sigma)" if self.stated else f"{self.multiple:.2f} sigma"
        risk = f"{self.risk_per_hour:g}" + (", configured" if self.stated else "")
        return [self.quantity, risk, level, f"{self.ratio:.3f}", f"{self.hours:.2f}", str(self.epochs), str(self.events), str(self.runs),
                f"{self.allowed():.3g}", "-" if self.rate() is None else f"{self.rate():.3g}",
                "-" if self.rate_at_most() is None else f"{self.rate_at_most():.3g}", confidence_text(self.confidence()),
                confidence_text(self.confidence_if_independent())]


def rounded(value):
    return None if value is None else float(f"{value:.6g}")


def confidence_text(value):
    percent = 100.0 * value
    if percent < 0.001:
        return "< 0.001"
    return f"{percent:.3g}" if percent < 99.0 else f"{math.floor(100.0 * percent) / 100.0:.2f}"


def lines_of(quantity, sums, model, replays):
    """One for the stated level, and one for each other risk."""
    common = {"quantity": quantity, "hours": sums.hours(), "replays": replays}
    stated = multiple_of(quantity, model.risk_per_hour, model)
    lines = [Line(risk_per_hour=model.risk_per_hour, stated=True, multiple=stated, ratio=1.0, epochs=sums.misleading,
                  events=sums.misleading_blocks, runs=sums.misleading_runs, **common)]
    others = [risk for risk in RISKS if risk != model.risk_per_hour] if sums.multiples else []
    for risk in others:
        multiple = multiple_of(quantity, risk, model)
        epochs, events, runs = sums.beyond(multiple)
        lines.append(Line(risk_per_hour=risk, stated=False, multiple=multiple, ratio=multiple / stated, epochs=epochs, events=events,
                          runs=runs, **common))
    return sorted(lines, key=lambda line: line.risk_per_hour)


class Group:
    """Runs of one model. `judged`: (log, result) pairs."""

    def __init__(self, model, judged):
        self.model, self.runs, self.logs = model, len(judged), len({log for log, _ in judged})
        self.sums = summed(result for _, result in judged)

    def replays(self):
        return self.runs / self.logs

    def lines(self):
        return [line for quantity, sums in self.sums.items() if sums.epochs and self.model
                for line in lines_of(quantity, sums, self.model, self.replays())]


def groups_of(judged):
    """The runs by their models; those that tell none come last."""
    by_model = collections.defaultdict(list)
    for log, result in judged:
        if result.get("integrity"):
            by_model[model_of(result)].append((log, result))
    return [Group(model, by_model[model]) for model in sorted(by_model, key=lambda m: (m is None, m or 0))]


COUNTED = ["| error | epochs | hours | misleading epochs | blocks with one | largest error / level |", "|---|---|---|---|---|---|"]
HEADER = ["| error | risk per hour | level | / stated | hours | epochs beyond | events | runs with one | events allowed | events per hour | "
          "at most (95 %) | confidence, % | were all runs independent, % |", "|" + "---|" * 13]
MEANING = ("An event is a block of 60 s with an error beyond the level. The levels of other risks than the configured one are those without "
           "fault hypotheses, which no level of that risk is below. Allowed: risk x hours. Confidence: with which the rate of events is at "
           "most the risk, P(Poisson(allowed) > events). Replays of one log meet the same errors: `at most` and the first confidence count "
           "them as one, with the means of their events and hours; the last column takes all runs for independent.")


def group_lines(group):
    model = f"Levels of {group.model.text()}." if group.model else "The runs do not tell what their levels were computed with."
    lines = ["", f"{model} Runs: {group.runs}, logs: {group.logs}.", "", *COUNTED]
    for quantity, sums in group.sums.items():
        lines.append(f"| {quantity} | {sums.epochs} | {sums.hours():.2f} | {sums.misleading} | {sums.misleading_blocks} of {sums.blocks} | "
                     f"{sums.largest_ratio:.3f} |")
    table = group.lines()
    if not table:
        return lines
    return [*lines, "", *HEADER, *("| " + " | ".join(line.cells()) + " |" for line in table)]


def availability_lines(names, parts):
    """A table with a row for each of `parts`: (cells of the names, results)."""
    rows = [(cells, summed(results)) for cells, results in parts]
    limits = sorted({limit for _, sums in rows for of in sums.values() for limit in of.limits})
    if not limits:
        return []
    shown = " / ".join(f"{limit:g}" for limit in limits)
    header = [*names, "epochs expected", *(f"{quantity} level at most {shown} m, %" for quantity in QUANTITIES[:2])]
    lines = ["", "Availability: share of the expected epochs whose level is at most an alert limit.", "",
             "| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    for cells, sums in rows:
        of = [sums.get(quantity, Sums()) for quantity in QUANTITIES[:2]]
        shares = [" / ".join(f"{100.0 * s.available(limit) / s.expected:.2f}" if s.expected else "-" for limit in limits) for s in of]
        lines.append("| " + " | ".join([*cells, str(of[0].expected), *shares]) + " |")
    return lines


def availability(results):
    """{quantity: {limit: share}} for programs."""
    return {quantity: {f"{limit:g}": measure.rounded(sums.available(limit) / sums.expected) for limit in sorted(sums.limits) if sums.expected}
            for quantity, sums in summed(results).items() if sums.limits}


def section(judged, names, parts):
    """Lines of report.md; empty where nothing is counted. `judged`: (log, result) of every run; `parts` of the table of availability."""
    groups = groups_of(judged)
    if not groups:
        return []
    lines = ["## Protection levels"]
    for group in groups:
        lines += group_lines(group)
    lines += ["", MEANING]
    lines += availability_lines(names, parts)
    if has_diagram(judged):
        lines += ["", "Stanford diagrams of all runs together: stanford_horizontal.png, stanford_vertical.png; their numbers: stanford.json."]
    return [*lines, ""]


def plain(judged):
    """The same for programs; None where nothing is counted."""
    groups = groups_of(judged)
    return [{"model": dataclasses.asdict(g.model) if g.model else None, "runs": g.runs, "logs": g.logs,
             "counts": {quantity: sums.plain() for quantity, sums in g.sums.items()},
             "levels": [line.plain() for line in g.lines()]} for g in groups] or None


def diagrams(judged):
    """What stanford.json holds of all runs together."""
    sums = summed(result for _, result in judged)
    return [{"label": "all runs", **{quantity: sums[quantity].for_diagram() for quantity in QUANTITIES[:2] if quantity in sums}}]


def has_diagram(judged):
    return any(of.get("diagram") for quantities in diagrams(judged) for of in quantities.values() if isinstance(of, dict))


def without_lists(result):
    """A run's result without what is summed up elsewhere and long."""
    if not result.get("integrity"):
        return result
    short = {quantity: {name: v for name, v in counts.items() if name not in ("multiples", "diagram")} if isinstance(counts, dict) else counts
             for quantity, counts in result["integrity"].items()}
    return {**result, "integrity": short}
