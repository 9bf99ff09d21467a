"""Describes what differs between a recorded case and the same case now."""
import difflib
import gzip
import os

# The messages from which leonav-replay writes its files.
GROUPS = {"solution.csv": "SOLUTION or EPOCH", "epochs.csv": "EPOCH", "satellites.csv": "EPOCH", "measurements.csv": "EPOCH",
          "constraints.csv": "CONSTRAINTS", "events.csv": "EVENT", "summary.txt": "counts, warnings, hash"}
SHOWN = 160  # characters of a line
SHORT = 500  # lines; in shorter texts an additional line must not make all following ones differ
SHORT_SHOWN = 8  # lines of such a text


def shortened(text):
    return text if len(text) <= SHOWN else text[:SHOWN] + "..."


def column_of(header, was, now):
    """The first field that differs, with its name, if both lines have as many fields as the header."""
    names, old, new = header.split(","), was.split(","), now.split(",")
    if not len(names) == len(old) == len(new) or len(names) < 3:
        return ""
    return next((f", column {name}: {a} -> {b}" for name, a, b in zip(names, old, new) if a != b), "")


def rows_that_differ(old, new):
    """For tables: the first row that differs, and the number of such rows."""
    pairs = [(i, a, b) for i, (a, b) in enumerate(zip(old, new), 1) if a != b]
    texts = []
    for i, a, b in pairs[:1]:
        column = column_of(old[0], a, b) if i > 1 else ""
        texts += [f"line {i}{column}", f"  was: {shortened(a)}", f"  now: {shortened(b)}"]
    if len(old) != len(new):
        texts.append(f"{len(old)} lines then, {len(new)} now")
    elif len(pairs) > 1:
        texts.append(f"{len(pairs)} of {len(old)} lines differ")
    return texts


def lines_that_differ(old, new):
    """For short texts: lines that are missing now, and lines that are new."""
    lines = [line for line in difflib.unified_diff(old, new, n=0, lineterm="") if line[:2] not in ("--", "++", "@@")]
    texts = [f"{'was' if line[0] == '-' else 'now'}: {shortened(line[1:])}" for line in lines]
    more = [f"and {len(texts) - SHORT_SHOWN} lines more"] if len(texts) > SHORT_SHOWN else []
    return ["lines that differ"] + texts[:SHORT_SHOWN] + more


def text_difference(old, new):
    if old == new:
        return ["its digest is not that of the recorded text, which is equal: was the record edited?"]
    old, new = old.split("\n"), new.split("\n")
    return lines_that_differ(old, new) if max(len(old), len(new)) <= SHORT and "," not in old[0] else rows_that_differ(old, new)


def file_difference(name, was, now, kept, folder):
    group = f" ({GROUPS[name]})" if name in GROUPS else ""
    if was is None:
        return [f"{name}{group}: was not there when it was recorded"]
    if now is None:
        return [f"{name}{group}: is not written any more"]
    if "channels" in was or "channels" in now:
        old, new = was.get("channels", {}), now.get("channels", {})
        channels = [c for c in sorted({*old, *new}) if old.get(c) != new.get(c)]
        words = [f"{c} ({old.get(c, 'none').split()[0]} messages then, {new.get(c, 'none').split()[0]} now)" for c in channels]
        return [f"{name}: channels that differ: {', '.join(words)}" if words else f"{name}: the order of its messages"]
    copy = os.path.join(kept, name + ".gz")
    if not os.path.exists(copy):
        return [f"{name}{group}: {was['bytes']} bytes then, {now['bytes']} now (no copy of the recorded text)"]
    with gzip.open(copy, "rt", errors="replace", newline="") as file:
        old = file.read()
    with open(os.path.join(folder, name), errors="replace", newline="") as file:
        new = file.read()
    texts = text_difference(old, new)
    return [f"{name}{group}: {texts[0]}"] + [f"  {text}" for text in texts[1:]]


# The standard output of leonav-replay is in summary.txt too.
def is_repeated(name, differing):
    return name.endswith("leonav-replay.stdout") and "summary.txt" in differing


def words(was, now, kept, folder):
    """Lines that describe the differences; empty: there are none."""
    differing = [name for name in sorted({*was, *now}) if was.get(name, {}).get("sha256") != now.get(name, {}).get("sha256")]
    order = {name: i for i, name in enumerate(GROUPS)}
    differing.sort(key=lambda name: (order.get(name, len(order)), name))
    texts = []
    for name in differing:
        if not is_repeated(name, differing):
            texts += file_difference(name, was.get(name), now.get(name), kept, folder)
    if differing and all(name == "summary.txt" or is_repeated(name, differing) for name in differing):
        texts.append("all tables are equal: the difference is in bits beyond their digits, or in the messages EVENT, DECISION, "
                     "SMOOTHER, or SOLUTION between epochs")
    return texts
