"""structure.py --root DIR [--before REVISION] [--epoch LOG --config FILE ...]: what `tools/validate structure` prints."""
import argparse
import collections
import os
import re
import subprocess
import sys
import tempfile

SOURCES = ("core", "daemon", "drivers", "tools")
LARGEST = 12  # classes and folders listed by name


def run(*command, **options):
    return subprocess.run(command, check=True, capture_output=True, text=True, **options).stdout


def files(root, folders, endings):
    for folder in folders:
        for path, _, names in os.walk(os.path.join(root, folder)):
            for name in names:
                if name.endswith(endings):
                    yield os.path.relpath(os.path.join(path, name), root)


def read(root, name):
    with open(os.path.join(root, name), encoding="utf-8") as file:
        return file.read()


def units_per_folder(root):
    units = collections.defaultdict(set)
    for name in files(root, SOURCES, (".h", ".cc")):
        folder = re.sub(r"/internal$", "", os.path.dirname(name))
        units[folder].add(os.path.splitext(os.path.basename(name))[0])
    return {folder: len(names) for folder, names in units.items()}


def classes(root):
    """Functions (declared or defined in the class), data members and source files of every class of core and daemon."""
    headers = list(files(root, ("core", "daemon"), (".h",)))
    sources = list(files(root, ("core", "daemon"), (".h", ".cc")))
    form = "%K\t%N\t%s\t%F"
    tags = run("ctags", "-x", "--language-force=C++", "--kinds-C++=cfmps", "--_xformat=" + form, *sources, cwd=root)
    functions, members, places = collections.defaultdict(set), collections.Counter(), collections.defaultdict(set)
    declared = set()
    for line in tags.splitlines():
        kind, name, scope, file = line.split("\t")
        scope = scope.split("::")[-1] if scope else ""
        if kind in ("class", "struct"):
            declared.add(name)
        elif kind in ("function", "prototype") and scope:
            functions[scope].add(name)
            if kind == "function" and file.endswith(".cc"):
                places[scope].add(file)
        elif kind == "member" and scope and file in headers and name.endswith("_"):
            members[scope] += 1
    return {name: (len(functions[name]), members[name], len(places[name])) for name in declared if members[name]}


def count(root, pattern, folders, leave_out=()):
    found = 0
    for name in files(root, folders, (".h", ".cc")):
        if not name.startswith(tuple(leave_out) or ("\0",)):
            found += len(re.findall(pattern, read(root, name), re.M))
    return found


def documents(root):
    return [name for name in files(root, (".",), (".md",)) if not re.match(r"(\./)?(build|\.git|[a-z]*-output)/", name)]


def longest_cell(root):
    longest = (0, "")
    for name in documents(root):
        for line in read(root, name).splitlines():
            if line.lstrip().startswith("|"):
                for cell in line.strip().strip("|").split("|"):
                    longest = max(longest, (len(cell.strip()), os.path.normpath(name)))
    return longest


def prose(text):
    """Sentences of a document: no code, no tables, no headings; a list item is a paragraph."""
    text = re.sub(r"```.*?```", "\n\n", text, flags=re.S)
    paragraphs, words = [], []
    for line in text.splitlines() + [""]:
        bare = line.strip()
        if not bare or bare.startswith(("|", "#")) or re.match(r"([-*]|\d+\.)\s", bare):
            if words:
                paragraphs.append(" ".join(words))
            words = []
            if not bare or bare.startswith(("|", "#")):
                continue
        words.append(re.sub(r"^([-*]|\d+\.)\s+", "", bare))
    for paragraph in paragraphs:
        for sentence in re.split(r"(?<=[.!?:])\s+(?=[A-Z`*(\[])", paragraph):
            if sentence.split():
                yield sentence


def long_sentences(root):
    sentences = [len(sentence.split()) for name in documents(root) for sentence in prose(read(root, name))]
    return len(sentences), 100.0 * sum(words > 40 for words in sentences) / max(1, len(sentences))


def fragments(root):
    """Share of comment blocks that begin with a question word, and how often comments speak of telling."""
    blocks = begins = tell = likewise = 0
    for name in files(root, SOURCES, (".h", ".cc")):
        inside = False
        for line in read(root, name).splitlines():
            match = re.match(r"\s*//\s?(.*)", line)
            if match and not inside:
                blocks += 1
                begins += bool(re.match(r"(What|Of|Where|How|Whether|As)\b", match.group(1)))
            inside = match is not None
            comment = line.split("//", 1)[1] if "//" in line else ""
            tell += len(re.findall(r"\b(tells?|told|says?|said)\b", comment))
            likewise += len(re.findall(r"\b(likewise|of it)\b", comment))
    return 100.0 * begins / max(1, blocks), blocks, tell, likewise


def configuration(root):
    """Lines that a user reads to make a configuration of his own, and keys without a meaning beside them."""
    reference = os.path.join(root, "config", "reference.yaml")
    folder = os.path.join(root, "config", "presets")
    if os.path.isdir(folder):
        copies = sorted(name for name in os.listdir(folder) if name.endswith(".yaml"))
        lines = {name: len(open(os.path.join(folder, name), encoding="utf-8").readlines()) for name in copies}
        keys = [reference]
    else:
        folder = os.path.join(root, "config")
        copies = sorted(name for name in os.listdir(folder) if name.endswith(".yaml"))
        lines = {name: len(open(os.path.join(folder, name), encoding="utf-8").readlines()) for name in copies}
        keys = [os.path.join(folder, "urban.yaml")]
    total = unexplained = 0
    for path in keys:
        above, repeats = "", None  # indentation of a group whose keys have their meaning in another group
        for line in open(path, encoding="utf-8"):
            comment = line.split("#", 1)[1] if "#" in line else ""
            if line.strip().startswith("#"):
                above += comment
                continue
            indent = len(line) - len(line.lstrip())
            if line.strip() and repeats is not None and indent <= repeats:
                repeats = None
            if re.match(r"\s*[a-z0-9_]+:\s*[^\s#]", line):
                total += 1
                # Behind a key of the reference are only its allowed values.
                meaning = above if path == reference else re.sub(r"\[[^\]]*\]", "", comment) + above
                unexplained += repeats is None and len(re.findall(r"[A-Za-z]{3,}", meaning)) < 2
            elif re.match(r"\s*[a-z0-9_]+:", line) and "the keys are those of" in above:
                repeats = indent
            above = ""
    return lines, total, unexplained


def epoch_way(binary, log, config, extra):
    script = os.path.join(os.path.dirname(__file__), "epoch-way.gdb.py")
    out = tempfile.mkdtemp()
    environment = dict(os.environ, LEONAV_EPOCH_WAY=os.path.join(out, "way.txt"))
    subprocess.run(["gdb", "-q", "-batch", "-x", script, "--args", binary, *config, *extra, "--out", out, log],
                   check=True, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    way = [line.strip() for line in open(os.path.join(out, "way.txt"), encoding="utf-8")]
    crossings = [(one, other) for one, other in zip(way, way[1:]) if one != other]
    return len(set(way)), len(set(crossings)), len(crossings)


def column(root, way):
    folders, every = units_per_folder(root), classes(root)
    lines, keys, unexplained = configuration(root)
    cell, cell_file = longest_cell(root)
    sentences, share = long_sentences(root)
    begins, blocks, tell, likewise = fragments(root)
    functions = max(every.items(), key=lambda item: item[1][0])
    members = max(every.items(), key=lambda item: item[1][1])
    crowded = max(folders.items(), key=lambda item: item[1])
    filter_folders = ("core/filter/", "core/ekf/")
    rows = [
        ("folders of sources", len(folders)),
        ("most units in one folder", f"{crowded[1]} ({crowded[0]})"),
        ("folders of more than 13 units", sum(units > 13 for units in folders.values())),
        ("folders with a README", sum(os.path.exists(os.path.join(root, folder, "README.md")) for folder in folders)),
        ("most functions in a class", f"{functions[1][0]} ({functions[0]})"),
        ("most data members in a class", f"{members[1][1]} ({members[0]})"),
        ("classes of more than 30 functions", sum(entry[0] > 30 for entry in every.values())),
        ("classes spread over several .cc", sum(entry[2] > 1 for entry in every.values())),
        ("ekf_index:: or its constants outside the filter",
         count(root, r"\bekf_index\b", SOURCES, filter_folders)),
        ("definitions of square()", count(root, r"^(?:inline |constexpr )*double square\(double", SOURCES)),
        ("lines of the largest ready configuration", max(lines.values())),
        ("lines of all ready configurations", f"{sum(lines.values())} in {len(lines)} files"),
        ("keys, and those without a meaning beside them", f"{keys}, {unexplained}"),
        ("longest table cell of the documents", f"{cell} ({cell_file})"),
        ("sentences over 40 words", f"{share:.1f} % of {sentences}"),
        ("comment blocks beginning What/Of/Where/How/Whether/As", f"{begins:.1f} % of {blocks}"),
        ("tell, told, say in comments", tell),
        ("likewise, of it in comments", likewise),
    ]
    if way:
        rows += [("units on an epoch's way", way[0]),
                 ("crossings from unit to unit: different ones, all", f"{way[1]}, {way[2]}")]
    for name in ("Ekf", "GnssStage", "Sequencer", "InertialNavigator", "Engine", "StateEstimate"):
        if name in every:
            rows.append((f"{name}: functions, members, .cc files", ", ".join(map(str, every[name]))))
    return rows, folders, every


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--root", required=True)
    parser.add_argument("--before")
    parser.add_argument("--epoch")
    parser.add_argument("--config")
    parser.add_argument("--bin")
    parser.add_argument("--bin-before")
    options = parser.parse_args()
    binary = os.path.join(options.bin or os.path.join(options.root, "build/release/bin"), "leonav-replay")
    config = ["--config", options.config] if options.config else []

    def way(program):
        return epoch_way(program, options.epoch, config, []) if options.epoch else None

    columns = []
    if options.before:
        with tempfile.TemporaryDirectory() as folder:
            archive = subprocess.run(["git", "-C", options.root, "archive", options.before], check=True,
                                     capture_output=True).stdout
            subprocess.run(["tar", "-x", "-C", folder], input=archive, check=True)
            before = os.path.join(options.bin_before, "leonav-replay") if options.bin_before else None
            columns.append((options.before, *column(folder, way(before) if before else None)))
    columns.append(("now", *column(options.root, way(binary))))
    labels = []
    for _, rows, _, _ in columns:
        labels += [label for label, _ in rows if label not in labels]
    width = max(map(len, labels))
    print(f"| {'':{width}} | " + " | ".join(f"{name:30}" for name, *_ in columns) + " |")
    print(f"|{'-' * (width + 2)}|" + "|".join("-" * 32 for _ in columns) + "|")
    for label in labels:
        values = [str(dict(rows).get(label, "-")) for _, rows, _, _ in columns]
        print(f"| {label:{width}} | " + " | ".join(f"{value:30}" for value in values) + " |")
    for name, _, folders, every in columns:
        largest = sorted(every.items(), key=lambda item: -item[1][0])[:LARGEST]
        print(f"\n{name}: largest classes (functions, members, .cc files): " +
              "; ".join(f"{cls} {entry[0]}, {entry[1]}, {entry[2]}" for cls, entry in largest))
        fullest = sorted(folders.items(), key=lambda item: -item[1])[:LARGEST]
        print(f"{name}: fullest folders: " + "; ".join(f"{folder} {units}" for folder, units in fullest))


sys.exit(main())
