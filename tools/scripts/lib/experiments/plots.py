"""Pictures of the report."""
import os
import re

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import spread

WIDE_M = 20.0


def save(figure, site, name):
    figure.tight_layout()
    figure.savefig(os.path.join(site.out, name), dpi=100)
    plt.close(figure)
    return name


def series(row, seed, site):
    try:
        return np.load(site.result_path(row, seed)[:-5] + ".npz")
    except OSError:
        return None


def all_series(row, results, site):
    loaded = [series(row, seed, site) for seed in spread.good(results[row.name])]
    return [data for data in loaded if data is not None]


def bars(group, rows, results, site):
    figure, axis = plt.subplots(figsize=(max(6.0, 1.1 * len(rows)), 4.0))
    x = np.arange(len(rows))
    for i, name in enumerate(("north", "east", "up")):
        pairs = [spread.of(results[row.name], "rmse", i) or (np.nan, 0.0) for row in rows]
        axis.bar(x + 0.27 * (i - 1), [p[0] for p in pairs], 0.25, yerr=[p[1] for p in pairs], label=name, capsize=2)
        theirs = [row.published.rmse[i] if row.published and row.published.rmse[i] else np.nan for row in rows]
        axis.plot(x + 0.27 * (i - 1), theirs, "k_", markersize=12, label="published, another drive" if i == 0 else None)
    axis.set_xticks(x, [row.title for row in rows], rotation=20, ha="right", fontsize=8)
    axis.set_ylabel("RMSE, m")
    axis.grid(axis="y", alpha=0.3)
    axis.legend(fontsize=8)
    return save(figure, site, f"{group}-rmse.png")


def distributions(group, rows, results, site):
    figure, axes = plt.subplots(1, 4, figsize=(13.0, 3.6), sharey=True)
    top = 0.0
    for row in rows:
        runs = all_series(row, results, site)
        if not runs:
            continue
        error = np.concatenate([d["error"][:, d["t"] >= row.settle_epochs] for d in runs], axis=1)
        parts = [np.abs(error[0]), np.abs(error[1]), np.abs(error[2]), np.linalg.norm(error, axis=0)]
        for axis, values in zip(axes, parts):
            if len(values):
                axis.plot(np.sort(values), np.linspace(0.0, 100.0, len(values)), label=row.title, lw=1.2)
                top = max(top, float(np.quantile(values, 0.98)))
    for axis, name in zip(axes, ("north", "east", "up", "3D")):
        axis.set_xlabel(f"{name} error, m")
        if top > WIDE_M:  # rows of decimetres beside rows of kilometres
            axis.set_xscale("log")
            axis.set_xlim(0.01, top)
        else:
            axis.set_xlim(0.0, top or 1.0)
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("epochs, %")
    axes[3].legend(fontsize=7)
    return save(figure, site, f"{group}-cdf.png")


def errors_in_time(group, rows, results, site):
    figure, axes = plt.subplots(3, 1, figsize=(10.0, 6.0), sharex=True)
    for row in rows:
        runs = all_series(row, results, site)
        if not runs:
            continue
        for axis, values in zip(axes, runs[0]["error"]):
            axis.plot(runs[0]["t"], values, lw=0.7, label=row.title)
    settled = [d["error"][:, d["t"] >= row.settle_epochs] for row in rows for d in all_series(row, results, site)[:1]]
    for i, (axis, name) in enumerate(zip(axes, ("north", "east", "up"))):
        limits = [np.quantile(np.abs(e[i]), 0.99) for e in settled if e.shape[1]]
        top = max(1.0, 1.5 * float(max(limits))) if limits else 1.0
        axis.set_ylim(-top, top)
        axis.set_ylabel(f"{name}, m")
        axis.grid(alpha=0.3)
    axes[2].set_xlabel("s from the start (first seed)")
    axes[0].legend(fontsize=7, ncol=3)
    return save(figure, site, f"{group}-errors.png")


def sky(group, rows, results, site):
    figure, axes = plt.subplots(2, 1, figsize=(10.0, 4.5), sharex=True)
    for row in rows:
        runs = all_series(row, results, site)
        if not runs or ("INS" in row.title) != (group.removeprefix("fgo-") != "code"):
            continue
        axes[0].plot(runs[0]["t_epoch"], runs[0]["satellites"], lw=0.7, label=row.title)
        pdop = np.where((runs[0]["pdop"] > 0.0) & (runs[0]["pdop"] < 20.0), runs[0]["pdop"], np.nan)
        axes[1].plot(runs[0]["t_epoch"], pdop, lw=0.7)
    axes[0].set_ylabel("satellites used")
    axes[1].set_ylabel("PDOP")
    axes[1].set_xlabel("s from the start (first seed)")
    for axis in axes:
        axis.grid(alpha=0.3)
    axes[0].legend(fontsize=7, ncol=3)
    return save(figure, site, f"{group}-sky.png")


def converging(group, rows, results, site):
    """The 3D error over time, median of the seeds."""
    figure, axis = plt.subplots(figsize=(9.0, 4.5))
    for row in rows:
        runs = all_series(row, results, site)
        if not runs:
            continue
        t = np.arange(0.0, max(d["t"][-1] for d in runs) + 1.0, 1.0)
        lines = [np.interp(t, d["t"], np.linalg.norm(d["error"], axis=0), right=np.nan) for d in runs if len(d["t"])]
        axis.semilogy(t / 60.0, np.nanmedian(lines, axis=0), lw=1.0, label=row.title)
    axis.axhline(3.0 if group.endswith("sets") else 0.1, color="k", lw=0.8, ls="--")
    axis.set_ylim(0.005, 20.0)
    axis.set_xlabel("minutes from the start")
    axis.set_ylabel("3D error, m (median of the seeds)")
    axis.grid(alpha=0.3, which="both")
    axis.legend(fontsize=8)
    return save(figure, site, f"{group}-convergence.png")


def windows(group, rows, results, site):
    """3D RMSE over the length of the window."""
    figure, axis = plt.subplots(figsize=(7.0, 4.0))
    for studied in dict.fromkeys(row.studied for row in rows):
        named = {row: re.search(r"-w(\d+)$", row.name) for row in rows if row.studied is studied}
        lengths = {row: int(name[1]) for row, name in named.items() if name}
        lengths = {row: length for row, length in (lengths | {studied: 20}).items() if row.name in results}
        points = sorted((length, *(spread.of(results[row.name], "rmse", 3) or (np.nan, 0.0))) for row, length in lengths.items())
        line = axis.errorbar([p[0] for p in points], [p[1] for p in points], [p[2] for p in points], fmt="o-", capsize=3,
                             label=f"{studied.title}, {studied.scene.name}")
        of_filter = spread.of(results.get(studied.filter.name, {}), "rmse", 3)
        if of_filter is not None:
            axis.axhline(of_filter[0], color=line[0].get_color(), ls="--", lw=0.8, label="the filter")
    axis.set_xlabel("keyframes in the window")
    axis.set_ylabel("3D RMSE, m (mean of the seeds)")
    axis.set_ylim(bottom=0.0)
    axis.grid(alpha=0.3)
    axis.legend(fontsize=8)
    return save(figure, site, f"{group}-windows.png")


def draw(group, rows, results, site):
    """File names of the pictures, in the report's folder."""
    if group == "mismatch" or not any(spread.good(results[row.name]) for row in rows):
        return []
    if group == "study":
        return [windows(group, rows, results, site)]
    if group.startswith("convergence"):
        return [converging(group, rows, results, site)]
    if group.endswith("sets"):
        return [converging(group, rows, results, site), bars(group, rows, results, site)]
    pictures = [bars(group, rows, results, site), distributions(group, rows, results, site)]
    if group.removeprefix("fgo-") in ("code", "carrier", "low"):
        pictures += [errors_in_time(group, rows, results, site), sky(group, rows, results, site)]
    return pictures
