#!/usr/bin/env python3
"""Compares the instructions that Callgrind has counted with budgets; a Markdown table to standard output.

  instructions.py BUDGETS COUNTS    exits with 1 if a stage exceeds its budget or its function was not called
  instructions.py --self-test       every rule, on counts that break it and on counts that do not

BUDGETS: rows of stage, function and budget, separated by tabs. A function is its qualified name, with parameters where
the name alone has several. COUNTS: Callgrind's output with --compress-strings=no --compress-pos=no. A call's
instructions include those of all that it calls.
"""
import contextlib
import io
import pathlib
import re
import sys
import tempfile

BUDGETS = pathlib.Path(__file__).resolve().parent / "instruction_budgets.tsv"
HEADER = ["stage", "function", "budget"]
LOW = 0.8  # of a budget; below, the budget is too large to show a regression


class Unusable(Exception):
    """A file that cannot be judged."""


def read_budgets(path):
    """[(stage, function, budget)]"""
    lines = [line for line in pathlib.Path(path).read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    rows = [line.split("\t") for line in lines]
    if not rows or rows[0] != HEADER:
        raise Unusable(f"{path}: the first row is not {', '.join(HEADER)}")
    for row in rows[1:]:
        if len(row) != len(HEADER) or not row[2].isdigit() or int(row[2]) == 0:
            raise Unusable(f"{path}: not a stage, a function and a number: {row}")
    if len(rows) == 1:
        raise Unusable(f"{path}: holds no budget")
    return [(stage, function, int(budget)) for stage, function, budget in rows[1:]]


def read_counts(path, functions):
    """{function: (calls, instructions)} of those that were called. What a function calls of itself is in it already."""
    known, counts, signatures = {}, {}, {}

    def function_of(symbol):
        if symbol not in known:  # parameters may follow, or " [clone .isra.0]", or "'2" of a recursion
            known[symbol] = next((name for name in functions if symbol.startswith(name) and symbol[len(name):][:1] in ("", "(", " ", "'")), None)
            signature = re.split(r" \[clone|'", symbol)[0]
            if known[symbol] is not None and signatures.setdefault(known[symbol], signature) != signature:
                raise Unusable(f"{known[symbol]} has several lists of parameters; {BUDGETS.name} must give the one that is meant")
        return known[symbol]

    caller, callee, calls, complete = None, None, 0, False
    with open(path, encoding="utf-8") as file:
        for line in file:
            key, _, value = line.rstrip("\n").partition("=")
            if key == "fn":
                caller = function_of(value)
            elif key == "cfn":
                callee = function_of(value)
            elif key == "calls":
                calls = int(value.split()[0])
            elif calls:  # the row behind "calls": line and instructions, which are left out where there are none
                if callee is not None and callee != caller:
                    before = counts.get(callee, (0, 0))
                    counts[callee] = (before[0] + calls, before[1] + int((line.split() + ["0"])[1]))
                calls = 0
            elif line.startswith("totals:"):
                complete = True
    if not complete:
        raise Unusable(f"{path}: does not end with totals; Callgrind has not written it to the end")
    return counts


def judge(budgets, counts):
    """Rows of a table, and what fails and what should be lowered."""
    rows, failures, low = [], [], []
    for stage, function, budget in budgets:
        if function not in counts:
            rows.append((stage, "0", "-", str(budget), "-"))
            failures.append(f"{stage}: {function} was not called; it was renamed, removed or inlined")
            continue
        calls, instructions = counts[function]
        per_call = instructions / calls
        rows.append((stage, str(calls), f"{per_call:.0f}", str(budget), f"{100.0 * per_call / budget:.1f} %"))
        if per_call > budget:
            failures.append(f"{stage}: {per_call:.0f} instructions a call, {per_call / budget - 1.0:.1%} above the budget of {budget} ({function})")
        elif per_call < LOW * budget:
            low.append(f"{stage}: {per_call:.0f} instructions a call, only {per_call / budget:.0%} of the budget of {budget}; lower it ({function})")
    return rows, failures, low


def compare(budgets_path, counts_path):
    """Prints table and verdict; returns the exit status."""
    try:
        budgets = read_budgets(budgets_path)
        counts = read_counts(counts_path, {function for _, function, _ in budgets})
    except (Unusable, OSError) as error:
        print(f"FAILED: {error}")
        return 1
    rows, failures, low = judge(budgets, counts)
    print("| stage | calls | instructions per call | budget | of the budget |\n|---|---|---|---|---|")
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()
    for text in low:
        print(f"LOW: {text}")
    for text in failures:
        print(f"FAILED: {text}")
    if not failures:
        print(f"All of {len(rows)} stages are within their budgets.")
    return 1 if failures else 0


# The self-test.
BUDGET_ROWS = "# a remark\nstage\tfunction\tbudget\nan epoch\tleonav::Stage::process(leonav::Epoch const&)\t1000\nits update\tleonav::Update::operator()\t500\n"


def call(caller, callee, calls, instructions):
    return f"fl=a.cc\nfn={caller}\n7 3\ncfi=b.cc\ncfn={callee}\ncalls={calls} 12 \n8 {instructions}\n9 1\n\n"


EPOCHS = call("main", "leonav::Stage::process(leonav::Epoch const&)", 10, 10000)
UPDATES = call("leonav::Stage::process(leonav::Epoch const&)", "leonav::Update::operator()(int) [clone .isra.0]", 10, 5000)
TOTALS = "totals: 20000\n"
CASES = (
    # what, budgets, counts, exit status, what is printed
    ("budgets that are just kept", BUDGET_ROWS, EPOCHS + UPDATES + TOTALS, 0, "All of 2 stages"),
    ("one instruction too many", BUDGET_ROWS, EPOCHS + UPDATES.replace("5000", "5001") + TOTALS, 1, "FAILED: its update"),
    ("too many in a second caller", BUDGET_ROWS, EPOCHS + UPDATES + call("main", "leonav::Update::operator()(int)", 1, 501) + TOTALS, 1,
     "FAILED: its update"),
    ("the whole too large, its part not", BUDGET_ROWS, EPOCHS.replace("10000", "10100") + UPDATES + TOTALS, 1, "1.0% above"),
    ("a function that is gone", BUDGET_ROWS, EPOCHS + TOTALS, 1, "leonav::Update::operator() was not called"),
    ("a function whose name only begins alike", BUDGET_ROWS, EPOCHS + UPDATES.replace("::operator()", "::operator()s") + TOTALS, 1, "was not called"),
    ("other parameters", BUDGET_ROWS, EPOCHS.replace("Epoch", "Orbit") + UPDATES + TOTALS, 1, "was not called"),
    ("two lists of parameters", BUDGET_ROWS, EPOCHS + UPDATES + call("main", "leonav::Update::operator()(double)", 1, 1) + TOTALS, 1, "several lists"),
    ("a clone beside the function", BUDGET_ROWS, EPOCHS + UPDATES + call("main", "leonav::Update::operator()(int)", 1, 1) + TOTALS, 0, "All of 2"),
    ("a function that only calls itself", BUDGET_ROWS, EPOCHS + call(*2 * ["leonav::Update::operator()(int)"], 1, 1) + TOTALS, 1, "was not called"),
    ("a call to itself", BUDGET_ROWS, EPOCHS + UPDATES + call("leonav::Update::operator()(int)", "leonav::Update::operator()(int)'2", 5, 4000) + TOTALS, 0, "All of 2 stages"),
    ("less than 80 %", BUDGET_ROWS, EPOCHS + UPDATES.replace("5000", "3990") + TOTALS, 0, "LOW: its update"),
    ("80 %", BUDGET_ROWS, EPOCHS + UPDATES.replace("5000", "4000") + TOTALS, 0, "| 80.0 % |\n\nAll of 2"),
    ("a call without instructions", BUDGET_ROWS, EPOCHS + UPDATES.replace("8 5000", "8") + TOTALS, 0, "LOW: its update"),
    ("names as numbers", BUDGET_ROWS, "fn=(1) main\ncfn=(2)\ncalls=1 0\n1 1\n" + TOTALS, 1, "was not called"),
    ("empty counts", BUDGET_ROWS, "", 1, "does not end with totals"),
    ("nothing but totals", BUDGET_ROWS, TOTALS, 1, "was not called"),
    ("counts cut off", BUDGET_ROWS, EPOCHS + UPDATES, 1, "does not end with totals"),
    ("no counts", BUDGET_ROWS, None, 1, "No such file"),
    ("empty budgets", "", EPOCHS + UPDATES + TOTALS, 1, "the first row"),
    ("no budget", "stage\tfunction\tbudget\n", EPOCHS + UPDATES + TOTALS, 1, "holds no budget"),
    ("a budget that is no number", BUDGET_ROWS.replace("500\n", "?\n"), EPOCHS + UPDATES + TOTALS, 1, "not a stage"),
    ("a budget of nothing", BUDGET_ROWS.replace("500\n", "0\n"), EPOCHS + UPDATES + TOTALS, 1, "not a stage"),
)


def self_test():
    wrong = []
    with tempfile.TemporaryDirectory() as folder:
        budgets_path, counts_path = pathlib.Path(folder) / "budgets.tsv", pathlib.Path(folder) / "callgrind.out"
        for what, budgets, counts, status, printed in CASES:
            budgets_path.write_text(budgets, encoding="utf-8")
            counts_path.unlink(missing_ok=True)
            if counts is not None:
                counts_path.write_text(counts, encoding="utf-8")
            with contextlib.redirect_stdout(io.StringIO()) as told:
                found = compare(budgets_path, counts_path)
            if found != status or printed not in told.getvalue():
                wrong.append(f"{what}: exit status {found} instead of {status}, or not printed: {printed}\n{told.getvalue()}")
    try:
        functions = [function for _, function, _ in read_budgets(BUDGETS)]
        wrong += [f"{BUDGETS.name}: {name} twice" for name in sorted({name for name in functions if functions.count(name) > 1})]
    except (Unusable, OSError) as error:
        wrong.append(str(error))
    print("\n".join([f"self-test: {text}" for text in wrong] + [f"{len(wrong)} failures"]) if wrong else "self-test: every rule holds")
    return 1 if wrong else 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    if len(sys.argv) != 3 or sys.argv[1] in ("-h", "--help"):
        print(__doc__)
        return 0 if sys.argv[1:2] in (["-h"], ["--help"]) else 2
    return compare(sys.argv[1], sys.argv[2])


if __name__ == "__main__":
    sys.exit(main())
