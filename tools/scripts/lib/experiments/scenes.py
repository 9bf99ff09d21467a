"""What a row of the experiments is: a drive that is simulated, and how it is estimated."""
import constellation

SYSTEMS = {"gps": "gps", "bds": "beidou", "gal": "galileo", "leo": "leo"}
START_WEEK, START_TOW = 2136, 345600.0
ADVANCE_S = 7001.0  # per seed: another sky for every seed, the same for all rows


class Scene:
    """What is simulated; one log for each seed, shared by the rows that name it."""

    def __init__(self, name, duration_s, overrides=(), leo_factor=None, file="config/scenario/urban.yaml", open_leo=False):
        self.name, self.duration_s, self.leo_factor, self.file = name, duration_s, leo_factor, file
        self.open_leo = open_leo  # LEO is laid over the drive as if there were no houses
        self.overrides = [f"duration_s={duration_s:g}"] + list(overrides)

    def settings(self, seed):
        return [f"seed={seed}", f"satellites.advance_s={ADVANCE_S * seed:g}"] + self.overrides

    def leo_shells(self, seed):
        """None: the simulator's own constellation."""
        if self.leo_factor in (None, 0, 1):
            return None
        return constellation.shells(self.leo_factor, ADVANCE_S * seed, self.duration_s)


class Row:
    def __init__(self, name, group, title, scene, settings, settle_epochs=1000, bound_m=3.0, published_=None):
        self.name, self.group, self.title, self.scene = name, group, title, scene
        self.settings, self.settle_epochs, self.bound_m = list(settings), settle_epochs, bound_m
        self.published = published_
        self.by_time = bound_m < 1.0  # judged by when it converges, not by its errors
        self.matched = None  # name of the row whose drives are as the estimator takes them to be
        self.filter = None  # row of the same drives and settings that the filter answers, where this one is the smoother's
        self.whole_log = None  # row of the same drives and settings that leonav-smooth answers, where this one is the smoother's
        self.program = "leonav-replay"
        self.studied = None  # row that this one varies
        self.published_sets = None  # 3D errors of the four sets
        self.housed = None  # row of the same drives whose LEO satellites stand behind the same houses as the others

    def is_whole_log(self):
        return self.program == "leonav-smooth"

    def is_set(self):
        """Judged from where it has converged on."""
        return self.published_sets is not None


# Of the papers' rows: from the course alone, at the first chance.
ALIGNMENT = ["alignment.max_gyrocompass_sigma_deg=0", "alignment.course_window_s=3", "alignment.max_course_sigma_deg=20"]


def mode(systems, ins, carrier, robust=True):
    names = ", ".join(SYSTEMS[s] for s in systems)
    settings = [f"gnss.systems=[{names}]", *ALIGNMENT]
    if not ins:
        settings.append("ekf.motion=constant_velocity")
    if not carrier:
        settings += ["ekf.carrier=false", "ekf.wet_delay_sigma_m=0"]
    if not robust:
        settings.append("robust.enabled=false")
    return settings
