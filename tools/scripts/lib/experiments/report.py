"""report.md: our numbers, the published ones beside them, and how to run each row alone."""
import os
import textwrap

import constellation
import motion
import plots
import published
import smoother_verdicts
import spread
import verdicts

TITLES = {
    "code": "Code and Doppler, robust (Electronics 2024)",
    "code-plain": "Code and Doppler, not robust",
    "few-gps": "One to four GPS satellites, with LEO (code and Doppler, robust)",
    "few-leo": "One to four LEO satellites, with GPS (code and Doppler, robust)",
    "carrier": "Carriers too, robust (Remote Sensing 2024, not robust there)",
    "carrier-plain": "Carriers too, not robust",
    "low": "Low observability: a dense city (carriers, robust)",
    "outages": "Open sky with two outages: are the stated sigmas true? (within three sigma: The smoother against the filter)",
    "sets": "Convergence of four data sets of 2,000 epochs",
    "convergence-static": "Convergence to 10 cm, open sky, static",
    "convergence-drive": "Convergence to 10 cm, open sky, driving, without IMU",
    "mismatch": "Where the estimator is told wrongly: multipath and IMU",
    "fgo-code": "Smoother: code and Doppler, robust",
    "fgo-code-plain": "Smoother: code and Doppler, not robust",
    "fgo-few-gps": "Smoother: one to four GPS satellites, with LEO",
    "fgo-few-leo": "Smoother: one to four LEO satellites, with GPS",
    "fgo-carrier": "Smoother: carriers too, robust (Remote Sensing 2024, table 3, not robust there)",
    "fgo-carrier-plain": "Smoother: carriers too, not robust",
    "fgo-low": "Smoother: low observability",
    "fgo-outages": "Smoother: open sky with two outages",
    "fgo-sets": "Smoother: convergence of four data sets of 2,000 epochs (Remote Sensing 2024, table 4)",
    "study": "What the smoother's gain is made of",
    "open-leo": "LEO as the papers simulate it: over the same drives without their houses, all masked at 5 degrees",
    **motion.TITLES,
}


def title_of(row):
    return "The whole log: " + TITLES[row.group.removeprefix("whole-")] if row.is_whole_log() else TITLES[row.group]


WIDTH = 110  # characters of a line of prose
TARGET_S = {"gps": 240.0, "gps-gal-bds": 120.0}


def wrapped(lines):
    """Prose broken into lines; tables, headings, pictures and code stay as they are."""
    result, in_code = [], False
    for line in lines:
        if line.startswith("```"):
            in_code = not in_code
        if in_code or line.startswith(("|", "#", "!", "```")):
            result.append(line)
        else:
            result += textwrap.wrap(line, WIDTH, subsequent_indent="  " if line.startswith("- ") else "",
                                    break_long_words=False, break_on_hyphens=False) or [""]
    return result


def published_text(p):
    if p is None or all(v is None for v in p.rmse):
        return "-"
    return " / ".join("-" if v is None else f"{v:g}" for v in p.rmse)


def rmse_table(rows, results, lines, notes):
    lines += ["| | seeds | N, m | E, m | U, m | 3D, m | 3D 95 %, m | available | satellites | PDOP | published, another drive: N / E / U / 3D, m |",
              "|---|---|---|---|---|---|---|---|---|---|---|"]
    for row in rows:
        r = results[row.name]
        cells = [f"{len(spread.good(r))} of {len(r)}"] + [spread.text(spread.of(r, "rmse", i)) for i in range(4)]
        available = spread.of(r, "availability")
        cells += [spread.text(spread.of(r, "p95_3d")), "-" if available is None else f"{100.0 * available[0]:.1f} %",
                  spread.text(spread.of(r, "satellites"), 1), spread.text(spread.of(r, "pdop"), 1),
                  published_text(row.published)]
        lines.append(f"| {row.title} | " + " | ".join(cells) + " |")
        if row.published is not None and row.published.note:
            notes.append(f"{row.title}: published {row.published.where}; {row.published.note}.")


def gain_lines(rows, results):
    """What LEO brings, row against row, over the seeds that both have."""
    by_title = {row.title: row for row in rows}
    lines = []
    for row in rows:
        partner = by_title.get(row.title.replace("/LEO", "", 1))
        if partner is None or partner is row:
            continue
        seeds = spread.common(results[partner.name], results[row.name])
        ours = []
        for i in range(4):
            a, b = (spread.of(results[r.name], "rmse", i, seeds) for r in (partner, row))
            ours.append("-" if a is None or b is None or a[0] == 0.0 else f"{100.0 * (1.0 - b[0] / a[0]):.0f} %")
        theirs = "-"
        if row.published and partner.published:
            theirs = " / ".join("-" if a is None or b is None else f"{100.0 * (1.0 - b / a):.0f} %"
                                for a, b in zip(partner.published.rmse, row.published.rmse))
            if not verdicts.is_alike(row):
                theirs += " by the factor graph"
        better = sum(results[row.name][s]["rmse"][3] < results[partner.name][s]["rmse"][3] for s in seeds)
        lines.append(f"| {partner.title} → {row.title} | {' / '.join(ours)} | {better} of {len(seeds)} | {theirs} |")
    if lines:
        lines = ["", "LEO improves N / E / U / 3D by:", "", "| | ours | seeds with a smaller 3D error | published |",
                 "|---|---|---|---|"] + lines
    return lines


def within_lines(rows, results):
    lines = []
    for row in rows:
        if row.published is None or row.published.within_5m is None:
            continue
        ours = [spread.of(results[row.name], "within_5m", i) for i in range(3)]
        lines.append(f"| {row.title} | " + " / ".join("-" if o is None else f"{o[0]:.1f}" for o in ours) +
                     " | " + " / ".join(f"{v:g}" for v in row.published.within_5m) + " |")
    if lines:
        lines = ["", "Share of epochs within 5 m, N / E / U, %:", "", "| | ours | published, another drive (Electronics, figure 10) |",
                 "|---|---|---|"] + lines
    return lines


def sky_lines(rows, results):
    lines = []
    for row in (row for row in rows if row.filter is None and not row.is_whole_log()):
        key = row.name.removeprefix("code-").removeprefix("carrier-").removesuffix("-ins")
        for where, satellites, pdop in published.SKY.get(key, []):
            wanted = where == published.A and row.group == "code" and "INS" not in row.title
            wanted |= where == published.B and row.group == "carrier" and "INS" in row.title
            if wanted:
                r = results[row.name]
                below = spread.of(r, "below_four")
                lines.append(f"| {row.title} | {spread.text(spread.of(r, 'satellites'), 1)} | "
                             f"{spread.text(spread.of(r, 'pdop'), 1)} | {'-' if below is None else f'{100 * below[0]:.1f} %'} | "
                             f"{satellites} | {pdop} | {where} |")
    for row in rows:
        if row.group == "low":
            r, seen = results[row.name], published.LOW_SKY[row.name.removeprefix("low-")]
            below = spread.of(r, "below_four")
            lines.append(f"| {row.title}, low observability | {spread.text(spread.of(r, 'satellites'), 1)} | "
                         f"{spread.text(spread.of(r, 'pdop'), 1)} | {'-' if below is None else f'{100 * below[0]:.1f} %'} | "
                         f"{seen} | - | {published.B} |")
    if lines:
        lines = ["", "## Satellites and PDOP", "",
                 "Used satellites of each epoch (mean), PDOP of the epochs below 20 (mean).", "",
                 "| | satellites | PDOP | epochs below four | published satellites | published PDOP | |",
                 "|---|---|---|---|---|---|---|"] + lines + in_view_lines()
    return lines


def in_view_lines():
    masks = [0, 5, 10, 15]
    means = ", ".join(f"{m:.1f} above {mask}°" for m, mask in zip(constellation.mean_in_view(1, masks), masks))
    return ["", "Why they differ. Of the papers' 160 LEO satellites, geometry alone shows a receiver at 39.9° north "
            f"{means} on the mean of a day with nothing in the way. The published 9.5 (Electronics) fits a horizon of about "
            "zero. 6.9 (Remote Sensing: 13.4 with LEO, 6.5 without) is more than a mask of 15°, which its table 2 names, shows "
            "even in the open. Their simulated LEO was hardly masked, neither by elevation nor by houses. Ours is masked at "
            "15° and by the same houses as the rest, so it adds fewer satellites and the PDOP stays higher.", "",
            "GPS and BDS: the papers' streets are not known; ours are drawn. BeiDou has 45 satellites today, geostationary and "
            "inclined ones that stay over Beijing among them, and had fewer when the papers drove; at low observability it is "
            "held to six."]


def sets_table(rows, results, lines):
    lines += ["To 3 m (3D, ten epochs in a row), s; and the 3D RMSE from there on, m. The published 3D errors are those of "
              "the factor graph on other drives (table 4); no EKF is printed.", "",
              "| | set | to 3 m, s | 3D after, m | published, another drive: 3D, m |", "|---|---|---|---|---|"]
    for row in rows:
        for seed, result in results[row.name].items():
            if not result or "failure" in result:
                lines.append(f"| {row.title} | {seed} | failed | - | {row.published_sets[seed - 1]} |")
                continue
            t, after = result["convergence_s"], result["after_convergence"]
            lines.append(f"| {row.title} | {seed} | {'never' if t is None else f'{t:.0f}'} | "
                         f"{'-' if after is None else f'{after:.2f}'} | {row.published_sets[seed - 1]} |")


def convergence_table(rows, results, lines):
    lines += ["| | median, s | fastest to slowest, s | seeds that converge | below 10 cm for good, median s | target, s |",
              "|---|---|---|---|---|---|"]
    for row in rows:
        r = results[row.name]
        median, reached, count = spread.median_time(r)
        settled, _, _ = spread.median_time(r, "settled_s")
        times = [x["convergence_s"] for x in spread.good(r).values() if x["convergence_s"] is not None]
        key = row.name.split("-", 2)[2].rsplit("-leo", 1)[0].removesuffix("-leo")
        target = TARGET_S.get(key) if not row.name.endswith("leo0") else None
        if not spread.good(r):
            verdict = "failed" if any(r.values()) else "not run"
        else:
            verdict = "-" if target is None else f"{target:.0f}: " + ("met" if median is not None and median < target else "MISSED")
        lines.append(f"| {row.title} | {'-' if median is None else f'{median:.0f}'} | "
                     f"{f'{min(times):.0f} to {max(times):.0f}' if times else '-'} | {reached} of {count} | "
                     f"{'-' if settled is None else f'{settled:.0f}'} | {verdict} |")


def mismatch_table(rows, results, lines):
    lines += ["Beside each stands the row whose drives are as the estimator takes them to be, over the seeds that both have. Numbers "
              "are the median time to 10 cm or the mean 3D RMSE, and the mean share of components within three stated sigma.", "",
              "| | seeds | matched | mismatched | within three sigma, matched → mismatched |", "|---|---|---|---|---|"]
    for row in rows:
        both = results.get(row.matched, {}), results[row.name]
        paired = row.matched in results
        seeds = spread.common(*both) if paired else sorted(spread.good(both[1]))
        cells, shares = [], []
        for r in both:
            if row.by_time:
                median, reached, _ = spread.median_time(r, seeds=[s for s in seeds if s in r])
                cells.append("-" if not reached else "never" if median is None else f"{median:.0f} s")
            else:
                mean = spread.of(r, "rmse", 3, seeds)
                cells.append("-" if mean is None else f"{mean[0]:.2f} m")
            share = spread.of(r, "within_three_sigma", seeds=seeds)
            shares.append("-" if share is None else f"{100.0 * share[0]:.1f} %")
        lines.append(f"| {row.title} (`{row.matched}`) | {len(seeds)} | {cells[0]} | {cells[1]} | {shares[0]} → {shares[1]} |")


def write(out, rows, results, site, seeds_of):
    lines = ["# The papers' experiments", "",
             f"{published.A} (code and Doppler) and {published.B} (carriers too), repeated on leonav's EKF and smoother with "
             "simulated drives. Mean ± standard deviation over the seeds; each seed is another drive, another sky and other noise. RMSE "
             "over all epochs after the first 1,000. The papers drove a real car through Beijing: their errors hold what their "
             "receiver and their streets did, ours what the simulator knows of it. Metres are therefore not comparable; improvements on "
             "one's own result are.",
             ""]
    lines += verdicts.lines(rows, results) + smoother_verdicts.lines(rows, results) + motion.verdict_lines(rows, results, site)
    for group, title in TITLES.items():
        chosen = [row for row in rows if row.group == group]
        if not chosen:
            continue
        lines += [f"## {title}", ""]
        notes = []
        if chosen[0].is_set() and group != "open-leo":
            sets_table(chosen, results, lines)
        elif group == "mismatch":
            mismatch_table(chosen, results, lines)
        elif group in motion.TITLES:
            motion.table(chosen, results, site, lines)
        elif group.startswith("convergence"):
            convergence_table(chosen, results, lines)
        else:
            rmse_table(chosen, results, lines, notes)
            lines += gain_lines(chosen, results) + within_lines(chosen, results)
        if group == "study":
            lines += smoother_verdicts.study_lines(chosen, results)
        if notes:
            lines += [""] + [f"- {note}" for note in notes]
        for picture in plots.draw(group, chosen, results, site):
            lines += ["", f"![{title}]({picture})"]
        lines.append("")
    lines = wrapped(lines + sky_lines(rows, results))
    failed = [f"{row.name}, seed {s}: {r['failure']}" for row in rows for s, r in results[row.name].items()
              if r and "failure" in r]
    if failed:
        lines += ["", "## Runs that failed", ""] + [f"- {text}" for text in failed]
    lines += wrapped(["", "## One row alone", "", "From the project's folder; the first seed as an example. Others differ in "
                      "`seed` and `satellites.advance_s`, and with LEO 320 and 640 in the scenario's file.", ""])
    for row in rows:
        lines += [f"`{row.name}`", "", "```sh", *site.alone(row, seeds_of(row)[0]), "```", ""]
    path = os.path.join(out, "report.md")
    with open(path, "w") as file:
        file.write("\n".join(lines) + "\n")
    return path
