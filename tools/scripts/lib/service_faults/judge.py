"""Whether a run went as its row expects."""
import math
import re
import subprocess

from service_faults import said
from service_faults.recorded import Outputs, Truth

SETTLED_BEFORE_S = 10  # errors and gaps count from so long before the fault on

CHANGES_WITHIN_S = 20  # one each second would be twenty

LATE_S = 0.3  # a message that leaves later than this is a fault that the row does not mean


class Judgement:
    """Numbers of the table, and what was not as expected."""

    def __init__(self):
        self.numbers, self.failures = {}, []

    def must(self, holds, text):
        if not holds:
            self.failures.append(text)

    def at_most(self, name, value, limit, unit="s"):
        """`value` None or infinite: it never came."""
        if limit is None:
            return
        if value is None or not math.isfinite(value):
            self.failures.append(f"{name}: never")
        else:
            self.must(value <= limit, f"{name}: {value:.1f} {unit}, allowed {limit:g}")


def first_reason(why):
    """Without its remedy, which stands behind the last colon."""
    reason = why.split("; ")[0]
    return reason if reason.endswith(")") else reason.rsplit(": ", 1)[0]


def judge_health(row, outputs, result):
    expected, begin, end = row.expected, row.begin_s, row.end_s
    before = [one for one in outputs.health if begin - SETTLED_BEFORE_S <= one.t < begin]
    if row.begin_s > 0:
        result.must(before and before[-1].status == "OK", "HEALTH was not OK before: " + (before[-1].why if before else "none"))
    since = [one for one in outputs.health if one.t >= begin]
    bad = [one for one in since if one.status != "OK"]
    if expected.status:
        told = next((one for one in since if one.status in expected.status and re.search(expected.reason, one.why)), None)
        result.at_most(f"{'/'.join(expected.status)} '{expected.reason}'", told and told.t - begin, expected.told_s)
    else:
        told = None
        wrong = [one for one in bad if not re.search(expected.allowed, one.why)] if expected.allowed else bad
        result.must(not wrong, f"HEALTH: {wrong[0].status}: {wrong[0].why}" if wrong else "")
    shown = told or (bad[0] if bad else None)
    result.numbers["told"] = f"{shown.status}: {first_reason(matching(shown.why, expected.reason))}" if shown else "OK"
    result.numbers["told_s"] = shown.t - begin if shown else None
    at_end = [one for one in since if one.t < end]
    result.must(not expected.stays or (at_end and at_end[-1].status != "OK"), "HEALTH is OK while the fault lasts")
    # From its end on, for good.
    late = [one for one in outputs.health if one.t >= end]
    last_bad = max((k for k, one in enumerate(late) if one.status != "OK"), default=-1)
    ok = late[last_bad + 1].t - end if last_bad + 1 < len(late) else math.inf
    result.numbers["ok_s"] = 0.0 if last_bad < 0 else ok
    result.at_most("OK again", result.numbers["ok_s"], expected.ok_s)
    if expected.ok_s is not None and not math.isfinite(ok) and late:
        result.must(False, f"HEALTH at the end: {late[-1].status}: {late[-1].why}")


def matching(why, pattern):
    """The reasons from the first one on that matches."""
    reasons = why.split("; ")
    at = next((k for k, reason in enumerate(reasons) if pattern and re.search(pattern, reason)), 0)
    return "; ".join(reasons[at:])


def judge_solution(row, outputs, result, last_s):
    expected = row.expected
    settled, end = max(row.begin_s - SETTLED_BEFORE_S, row.settled_s), last_s - 1
    result.numbers["gap_s"] = outputs.longest_gap(settled, end)
    error, sigma, at, sigmas = outputs.worst(settled, end)
    result.numbers.update(worst_m=error, sigma_m=sigma, worst_at_s=at - row.begin_s, sigmas=sigmas)
    result.numbers["back_s"] = max(outputs.first_after(row.end_s) - row.end_s, 0.0)
    result.at_most("longest time without SOLUTION", result.numbers["gap_s"], expected.gap_s)
    result.at_most("worst error", error, expected.worst_m, "m")
    result.at_most("worst error / sigma", sigmas, expected.sigmas, "")
    result.at_most("SOLUTION back", result.numbers["back_s"], expected.back_s)
    off = outputs.off_in_time(settled, end)
    result.must(off == 0, f"{off} SOLUTION are stamped with another time than now")


def judge_continuity(row, outputs, result, last_s):
    """HEALTH of a leonavd that runs comes once a second, and its text changes only with the case."""
    result.numbers["health_gap_s"] = None if row.health_by_log else outputs.longest_health_gap(0, last_s)
    changes = outputs.health_changes(max(row.begin_s - SETTLED_BEFORE_S, 0), last_s)
    result.numbers["health_changes"] = len(changes)
    if not row.health_by_log:
        result.at_most("longest time without HEALTH", result.numbers["health_gap_s"], row.expected.health_gap_s)
    most = max((sum(t <= other < t + CHANGES_WITHIN_S for other in changes) for t in changes), default=0)
    result.numbers["health_changes_at_once"] = most
    result.at_most(f"changes of HEALTH within {CHANGES_WITHIN_S} s", most, row.expected.health_changes, "")


def judge_sent(row, run, result):
    """Else the row would show another fault, or none."""
    refused = run.sender.refused
    result.must(row.loses_route or refused == 0, f"the network refused {refused} datagrams")
    result.must(refused > 0 or not row.loses_route, "the network refused no datagram")
    result.must(run.late_s < LATE_S, f"this machine was too slow: messages left up to {run.late_s:.1f} s late")


def replay(row, run, result):
    """Each journal of the run has to replay byte for byte."""
    words = []
    for journal in row.journals(run) if row.journals else run.journals():
        out = run.folder / f"replay{len(words) or ''}"
        done = subprocess.run([run.bin / "leonav-replay", journal, "--verify", "--out", out], capture_output=True, text=True, check=False)
        out.mkdir(exist_ok=True)
        (out / "replay.txt").write_text(done.stdout + done.stderr)
        found = re.search(r"^verified.*$", done.stdout, re.M)
        equal = done.returncode == 0 and found is not None
        words.append("equal" if equal else "differs")
        if row.expected.replays:
            said_of_it = found[0] if found else (done.stderr.strip().splitlines() or ["nothing"])[-1]
            result.must(equal, f"replay of {journal.name}: {said_of_it}")
    result.must(words or not row.expected.replays, "there is no journal")
    result.numbers["replay"] = ", ".join(words) or "-"


def judged(row, run):
    result = Judgement()
    outputs = Outputs(run.folder / "outputs.lcmlog", Truth(run.drive.truth), run.begin_wall_s)
    if row.health_by_log:
        outputs.health = said.health_of(run.daemon.said(), run.begin_wall_s, run.last_s)
    outputs.health = [one for one in outputs.health if one.t <= run.last_s]  # behind it nothing comes any more
    judge_health(row, outputs, result)
    judge_continuity(row, outputs, result, run.last_s)
    judge_solution(row, outputs, result, run.last_s)
    expected_codes = row.expected.exit_codes
    result.must(tuple(run.daemon.codes) == expected_codes, f"exit codes {run.daemon.codes}, expected {list(expected_codes)}")
    replay(row, run, result)
    if row.judge:
        row.judge(run, outputs, result)
    judge_sent(row, run, result)
    return result
