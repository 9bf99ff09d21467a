"""report.md and report.json of many runs. Neither holds a time or a worker: they are the same whatever ran them."""
import json
import math
import os

from . import levels, measure, programs

AXES = measure.AXES


def number(value, digits=2):
    return "-" if value is None else f"{value:.{digits}f}"


def triple(values, digits=2):
    return " / ".join(number(v, digits) for v in values)


def percent(value, digits=1):
    return "-" if value is None else f"{100.0 * value:.{digits}f}"


def share(sigma):
    return sigma["within"] / sigma["count"] if sigma["count"] else None


def pooled(results):
    """RMSE, share within three sigma and mean sigma over RMSE per axis, over all epochs of all runs."""
    judged = [r for r in results if r.get("judged")]
    if not judged:
        return None
    epochs = sum(r["epochs"] for r in judged)
    rmse = {key: math.sqrt(sum(r["epochs"] * r["errors"][key]["rmse"] ** 2 for r in judged) / epochs) for key in (*AXES, "horizontal", "3d")}
    sigmas = {}
    for axis in AXES:
        count = sum(r["sigmas"][axis]["count"] for r in judged)
        mean = sum(r["sigmas"][axis]["count"] * (r["sigmas"][axis]["mean_sigma_m"] or 0.0) for r in judged) / count if count else None
        sigmas[axis] = {"count": count, "within": sum(r["sigmas"][axis]["within"] for r in judged), "mean_sigma_m": measure.rounded(mean),
                        "sigma_over_rmse": measure.rounded(mean / rmse[axis]) if count and rmse[axis] > 0.0 else None}
    answered, expected = (sum(r[key] for r in judged) for key in ("answered", "expected_in_truth"))
    return {"runs": len(judged), "epochs": epochs, "rmse": {key: measure.rounded(v) for key, v in rmse.items()}, "sigmas": sigmas,
            "availability": measure.rounded(answered / expected) if expected else None, "integrity": integrity(judged)}


def integrity(results):
    """Sums of the whole numbers that leonav-eval counts, named by their places as in horizontal.misleading; None: none.

    In a list, each group is named by its limit_m. The largest ratio is that of all. Lists of bins are levels.py's.
    """
    sums = {}

    def add(value, name):
        if isinstance(value, dict):
            for key, inner in value.items():
                if key == "largest_ratio":
                    sums[f"{name}.{key}"] = max(sums.get(f"{name}.{key}", 0.0), inner)
                elif key not in ("limit_m", "multiples", "diagram"):
                    add(inner, f"{name}.{key}" if name else key)
        elif isinstance(value, list):
            for place, inner in enumerate(value):
                limit = inner.get("limit_m") if isinstance(inner, dict) else None
                add(inner, f"{name}.{place}" if limit is None else f"{name}.{limit:g}_m")
        elif isinstance(value, int) and not isinstance(value, bool):
            sums[name] = sums.get(name, 0) + value

    for result in results:
        add(result.get("integrity") or {}, "")
    return dict(sorted(sums.items())) or None


def misleading(sums):
    """{quantity: (epochs beyond their level, epochs)} of the sums."""
    ending = ".misleading"
    names = [key[:-len(ending)] for key in sums or {} if key.endswith(ending) and key.count(".") == 1]
    return {name: (sums[name + ending], sums.get(f"{name}.epochs")) for name in names}


def integrity_text(sums):
    """Misleading epochs of each quantity, or else all that is counted."""
    parts = [f"{name} {count}" + (f" of {epochs}" if epochs is not None else "") for name, (count, epochs) in misleading(sums).items()]
    return ", ".join(parts or [f"{key} {value}" for key, value in (sums or {}).items()]) or "-"


def totals(results):
    good = [r for r in results if r["failure"] is None]
    return {"runs": len(results), "failed": len(results) - len(good), "judged": sum(bool(r.get("judged")) for r in good),
            "misses": sum(r["misses"] for r in good), "resets": sum(r["resets"] for r in good),
            "warnings": sum(len(r["warnings"]) for r in good), "pooled": pooled(good)}


HEADER = ["| run | RMSE N / E / U, m | 3D RMSE, m | 95 % N / E / U, m | max N / E / U, m | within 3 sigma N / E / U, % | sigma / RMSE N / E / U | "
          "available, % | epochs | misses | resets | warnings |", "|---|---|---|---|---|---|---|---|---|---|---|---|"]


def row(result):
    counts = [str(result["misses"]), str(result["resets"]), str(len(result["warnings"]))]
    if not result["judged"]:
        return f"| {result['name']} | - | - | - | - | - | - | - | {result['epochs_replayed']} | " + " | ".join(counts) + " |"
    errors, sigmas = result["errors"], result["sigmas"]
    cells = [triple(errors[a]["rmse"] for a in AXES), number(errors["3d"]["rmse"]), triple(errors[a]["p95"] for a in AXES),
             triple(errors[a]["worst"] for a in AXES), " / ".join(percent(share(sigmas[a])) for a in AXES),
             triple(sigmas[a]["sigma_over_rmse"] for a in AXES), percent(available(result)), str(result["epochs"])]
    return f"| {result['name']} | " + " | ".join(cells + counts) + " |"


def available(result):
    """Answered epochs over those in the truth's span."""
    return result["answered"] / result["expected_in_truth"] if result["expected_in_truth"] else None


def worst_first(results):
    return sorted(results, key=lambda r: (-(r["errors"]["3d"]["rmse"] if r["judged"] else -1.0), r["name"]))


def one_line(result):
    if result["failure"] is not None:
        return f"{result['name']}: FAILED: {result['failure']}"
    if not result["judged"]:
        return f"{result['name']}: {result['epochs_replayed']} epochs, no truth"
    e = result["errors"]
    return f"{result['name']}: RMSE N {e['north']['rmse']:.2f} E {e['east']['rmse']:.2f} U {e['up']['rmse']:.2f} m"


def totals_lines(sums):
    lines = [f"{sums['runs']} runs, {sums['failed']} failed, {sums['judged']} with a truth; {sums['misses']} misses, {sums['resets']} resets, "
             f"{sums['warnings']} warnings."]
    all_ = sums["pooled"]
    if all_ is None:
        return lines
    sigmas = all_["sigmas"]
    lines += ["", "| over all epochs of all runs | N | E | U | horizontal | 3D |", "|---|---|---|---|---|---|",
              "| RMSE, m | " + " | ".join(number(all_["rmse"][key]) for key in (*AXES, "horizontal", "3d")) + " |",
              "| within 3 sigma, % | " + " | ".join(percent(share(sigmas[a])) for a in AXES) + " | | |",
              "| mean sigma / RMSE | " + " | ".join(number(sigmas[a]["sigma_over_rmse"]) for a in AXES) + " | | |", "",
              f"{all_['epochs']} epochs judged; answered {percent(all_['availability'])} % of those in the truths' spans."]
    if all_["integrity"]:
        hazardous = [f"{key} {value}" for key, value in all_["integrity"].items() if key.endswith("hazardous")]
        lines += ["", f"Errors beyond their protection levels: {integrity_text(all_['integrity'])}" + "".join(f"; {h}" for h in hazardous) + "."]
    return lines


def failed_lines(results):
    failed = [r for r in results if r["failure"] is not None]
    return ["## Runs that failed", ""] + [f"- {r['name']}: {r['failure']}" for r in failed] + [""] if failed else []


def warning_lines(results):
    lines = [f"- {r['name']}: {text}" for r in results if r["failure"] is None for text in r["warnings"]]
    return ["## Warnings", ""] + lines + [""] if lines else []


def markdown(words, results):
    good = [r for r in results if r["failure"] is None]
    judged = judged_of(results)
    lines = ["# Runs", "", f"`{words}`", "", *totals_lines(totals(results)), "", *failed_lines(results),
             *levels.section(judged, ["runs"], [(["all"], [r for _, r in judged])])]
    if good:
        lines += ["## Worst runs first", "", *HEADER, *(row(r) for r in worst_first(good)), ""]
    return "\n".join(lines + warning_lines(results))


def judged_of(results):
    """(log, result) of those with numbers: every run has a log of its own."""
    return [(r["name"], r) for r in results if r["failure"] is None and r.get("judged")]


def write_diagrams(out, judged):
    """stanford.json, for leonav-integrity-plots. Returns its path; None: there is nothing to be drawn."""
    if not levels.has_diagram(judged):
        return None
    path = os.path.join(out, "stanford.json")
    programs.write_atomically(path, json.dumps(levels.diagrams(judged), sort_keys=True) + "\n")
    return path


def plain(words, results):
    """What report.json holds; the definitions stay in the files of the runs."""
    judged = judged_of(results)
    return {"configuration": words, "totals": totals(results), "runs": [plain_run(r) for r in results],
            "protection_levels": levels.plain(judged), "level_availability": levels.availability(r for _, r in judged)}


def plain_run(result):
    return {key: value for key, value in levels.without_lists(result).items() if key != "definition"}


def write(out, words, results):
    """Returns the paths of report.md and of stanford.json, or None for that."""
    results = sorted(results, key=lambda r: r["name"])
    programs.write_atomically(os.path.join(out, "report.json"), json.dumps(plain(words, results), indent=1, sort_keys=True) + "\n")
    path = os.path.join(out, "report.md")
    programs.write_atomically(path, markdown(words, results))
    return path, write_diagrams(out, judged_of(results))
