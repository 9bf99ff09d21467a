"""What a row is: a fault, when it is, and what has to follow."""
import dataclasses


ALIGNING_CHANGES = 8  # of HEALTH within 20 s: an alignment alone tells five steps


@dataclasses.dataclass
class Expected:
    """None: not asked. Times are s from the fault's begin or, of what has to come back, from its end."""
    status: tuple = ()  # of HEALTH; empty: it stays OK but for reasons that match `allowed`
    reason: str = ""
    allowed: str = ""
    told_s: float = 5.0
    ok_s: float = 10.0
    gap_s: float = 0.5
    health_gap_s: float = 2.5  # it comes once a second
    health_changes: int = 4  # of status or text, within any 20 s
    worst_m: float = 2.0
    sigmas: float = 5.0
    back_s: float = 2.0
    stays: bool = False  # HEALTH is not OK at the fault's end
    replays: bool = True
    exit_codes: tuple = (0,)


@dataclasses.dataclass
class Row:
    name: str
    text: str  # of the table
    begin_s: float = 60.0
    end_s: float = 60.0
    after_s: float = 80.0  # the drive goes on so long after the fault
    expected: Expected = dataclasses.field(default_factory=Expected)
    scenario: tuple = ()  # settings of leonav-sim
    options: tuple = ()  # of leonavd
    daemon: dict = dataclasses.field(default_factory=dict)  # other keys of Daemon
    knows_heading: bool = True
    heading_off_deg: float = 0.0  # what is taken for known is off by so much
    settled_s: float = 40.0  # errors and gaps count from here on at the earliest
    change: object = None  # of the messages: a function of row and messages
    before: object = None  # a function of the Run: before the daemon starts
    actions: tuple = ()  # (s, function of the Run) while the drive is played
    after: object = None  # a function of the Run: when the daemon has ended
    journals: object = None  # a function of the Run: what is replayed, instead of its journals
    judge: object = None  # a function of Run, Outputs and Judgement: what else has to hold
    check: object = None  # instead of a drive: a function of Run and Judgement
    skipped: object = None  # a function that says why the row cannot run here, "" if it can
    has_route: bool = True
    loses_route: bool = False  # while the drive is played: the network refuses messages, as it does in no other row
    health_by_log: bool = False  # as leonavd's own log has it
    until_stopped: bool = False  # the drive ends with the daemon
    quick: bool = False

    @property
    def duration_s(self):
        return self.end_s + self.after_s


def fault(*status, reason, **keys):
    return Expected(status=status, reason=reason, **keys)
