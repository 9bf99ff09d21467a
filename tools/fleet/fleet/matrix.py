"""A matrix file: scenes that are simulated, estimators that replay them, and the limits that each row is held to."""
import dataclasses
import fnmatch
import itertools
import operator
import os
import re

import yaml

from . import programs, replays

KEYS = {"title", "scenes", "simulate", "axes", "preset", "config", "set", "seeds", "duration_s", "settle_s", "per_seed", "limits", "compare"}
SCENE_KEYS = {"scenario", "set", "duration_s", "optional", "limits"}
VARIANT_KEYS = {"preset", "config", "set"}
COMPARE_KEYS = {"axis", "value", "at_most"}
COMPARE = {">=": operator.ge, "<=": operator.le, ">": operator.gt, "<": operator.lt}
MEASURES = {
    "share": "pooled share within three sigma, %, of every axis",
    "worst_share": "the same of the worst seed",
    "sigma_over_rmse": "mean stated sigma over RMSE, of every axis",
    "rmse": "mean RMSE of the seeds, m, of every axis",
    "rmse_horizontal": "mean horizontal RMSE, m",
    "rmse_3d": "mean 3D RMSE, m",
    "worst_3d": "3D RMSE of the worst seed, m",
    "misleading": "errors beyond their protection level, % of the epochs of every quantity that has one",
    "available": "answered epochs, % of those in the truth's span",
}


class MatrixError(Exception):
    """The file cannot be used; the text says where and why."""


@dataclasses.dataclass(frozen=True)
class Limit:
    text: str
    measure: str
    compare: str
    bound: float

    def holds(self, values):
        """Of every axis; a value that is missing does not keep to it."""
        return all(v is not None and COMPARE[self.compare](v, self.bound) for v in values)


@dataclasses.dataclass(frozen=True)
class Comparison:
    """One value of an axis is held against the best of its other values, all else being equal."""
    axis: int  # place among the matrix's axes
    value: str
    at_most: float  # ratio of the RMSE to the best one


def value_of_seed(value, seed):
    """Of a list one after the other; a number as many times as the seed says."""
    return value[(seed - 1) % len(value)] if isinstance(value, list) else value * seed


@dataclasses.dataclass(frozen=True)
class Scene:
    name: str
    scenario: str
    settings: tuple
    limits: tuple

    def settings_of(self, seed, per_seed):
        return (f"seed={seed}", *(f"{key}={value_of_seed(value, seed):g}" for key, value in per_seed), *self.settings)


@dataclasses.dataclass(frozen=True)
class Variant:
    values: tuple  # one of each axis
    estimator: replays.Estimator


@dataclasses.dataclass
class Matrix:
    path: str
    title: str
    axes: list
    scenes: list
    variants: list
    seeds: list
    per_seed: tuple  # (key of the scenario, its values: value_of_seed())
    settle_s: float
    common: tuple   # words of leonav-replay that all variants share
    choices: list   # (axis, value, its further words)
    skipped: list  # (scene, why)
    comparison: Comparison | None = None

    def rows(self):
        return [(scene, variant) for scene in self.scenes for variant in self.variants]


def slug(text):
    return re.sub(r"[^\w.+-]+", "_", text)


def row_name(scene, variant):
    return "/".join([slug(scene.name), "-".join(slug(v) for v in variant.values)])


class Reader:
    def __init__(self, path):
        self.path, self.folder = path, os.path.dirname(os.path.abspath(path))

    def fail(self, where, what):
        raise MatrixError(f"{self.path}: {where}: {what}")

    def group(self, value, where, keys):
        if value is None:
            value = {}
        if not isinstance(value, dict):
            self.fail(where, "must be a map of keys")
        for key in value:
            if keys is not None and key not in keys:
                self.fail(f"{where}.{key}" if where else str(key), f"no such key; there are {', '.join(sorted(keys))}")
        return value

    def words(self, group, where):
        value = group.get("set") or []
        if not isinstance(value, list) or not all(isinstance(v, str) and "=" in v for v in value):
            self.fail(f"{where}.set" if where else "set", "must be a list of \"key=value\"")
        return tuple(value)

    def number(self, group, key, where, fallback, least=0.0):
        value = group.get(key, fallback)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not value >= least:
            self.fail(f"{where}.{key}" if where else key, f"must be a number of at least {least:g}")
        return float(value)

    def per_seed(self, value):
        group = self.group(value, "per_seed", None)
        for key, values in group.items():
            numbers = values if isinstance(values, list) and values else [values]
            if any(isinstance(v, bool) or not isinstance(v, (int, float)) for v in numbers):
                self.fail(f"per_seed.{key}", "must be a number, which is multiplied by the seed, or a list of numbers, which the seeds take one after the other")
        return tuple((str(key), values) for key, values in group.items())

    def file(self, name, where):
        if not isinstance(name, str):
            self.fail(where, "must name a file")
        return os.path.normpath(os.path.join(self.folder, name))

    def limits(self, group, where):
        value = group.get("limits") or []
        if not isinstance(value, list):
            self.fail(where, "must be a list")
        return tuple(self.limit(text, where) for text in value)

    def limit(self, text, where):
        found = re.fullmatch(r"(\w+) *(>=|<=|>|<) *([-+.\deE]+)", str(text))
        if not found or found[1] not in MEASURES:
            self.fail(where, f"{text!r}: must be one of {', '.join(MEASURES)}, then >=, <=, > or <, then a number")
        try:
            return Limit(str(text), found[1], found[2], float(found[3]))
        except ValueError:
            self.fail(where, f"{text!r}: {found[3]} is no number")

    def comparison(self, value, axes):
        """`axes`: {axis: {value: ...}}."""
        if value is None:
            return None
        group = self.group(value, "compare", COMPARE_KEYS)
        axis = group.get("axis")
        if axis not in axes:
            self.fail("compare.axis", f"must be one of {', '.join(axes)}")
        names = [str(name) for name in axes[axis]]
        if str(group.get("value")) not in names or len(names) < 2:
            self.fail("compare.value", f"must be one of several values of {axis}: {', '.join(names)}")
        return Comparison(list(axes).index(axis), str(group["value"]), self.number(group, "at_most", "compare", 1.1))

    def scene(self, name, value, matrix, duration_s, settle_s):
        where = f"scenes.{name}"
        group = self.group(value, where, SCENE_KEYS)
        if "scenario" not in group:
            self.fail(where, "needs a scenario")
        common = self.words(self.group(matrix.get("simulate"), "simulate", {"set"}), "simulate")
        own = self.number(group, "duration_s", where, matrix.get("duration_s", 0))
        length = duration_s or own
        settings = (*common, *self.words(group, where), *((f"duration_s={length:g}",) if length else ()))
        if length and length <= settle_s:
            self.fail(where, f"its {length:g} s are over before the {settle_s:g} s that do not count")
        limits = self.limits(group if "limits" in group else matrix, f"{where}.limits" if "limits" in group else "limits")
        return Scene(str(name), self.file(group["scenario"], f"{where}.scenario"), settings, limits), bool(group.get("optional"))

    def estimator(self, groups, wheres, given):
        """The matrix's own, then one group of each axis, then the command line's: later ones win."""
        preset = config = None
        settings = ()
        for group, where in zip(groups, wheres):
            if "preset" in group or "config" in group:
                preset, config = group.get("preset"), group.get("config")
                if (preset is None) == (config is None) or not isinstance(preset or config, str):
                    self.fail(where or "preset", "preset names a preset, or config a file, and only one of them")
                config = self.file(config, f"{where}.config") if config else None
            settings += self.words(group, where)
        if given.preset or given.config:
            preset, config = given.preset, given.config
        if config and not os.path.isfile(config):
            self.fail("config", f"{config}: no such file")
        return replays.Estimator(preset, config, settings + given.settings)

    def seeds(self, value, given):
        value = given or value
        if isinstance(value, int) and not isinstance(value, bool) and value >= 1:
            return list(range(1, value + 1))
        good = isinstance(value, list) and value and all(isinstance(v, int) and v >= 0 for v in value) and len(set(value)) == len(value)
        return value if good else self.fail("seeds", "must be a number of seeds, or a list of them")


def missing_file(scenario):
    """A file that the scenario names, and that is not there; None: there is none."""
    return next((path for path in files_of(scenario) if not os.path.isfile(path)), None)


def files_of(scenario):
    """The scenario and the files that it names, under keys `file`, relative to itself."""
    def named(value):
        if isinstance(value, dict):
            for key, inner in value.items():
                if key == "file" and isinstance(inner, str) and inner:
                    yield os.path.normpath(os.path.join(os.path.dirname(scenario), inner))
                yield from named(inner)
        elif isinstance(value, list):
            for inner in value:
                yield from named(inner)

    try:
        with open(scenario) as file:
            return [scenario, *named(yaml.safe_load(file))]
    except (OSError, yaml.YAMLError):
        return [scenario]  # leonav-sim will say what is wrong


def read(path, given, seeds=None, duration_s=None, settle_s=None, patterns=None):
    """`given`: the estimator of the command line. Raises MatrixError."""
    reader = Reader(path)
    try:
        with open(path) as file:
            content = yaml.safe_load(file)
    except OSError as error:
        raise MatrixError(f"{path}: {error.strerror}") from None
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        raise MatrixError(f"{path}{f':{mark.line + 1}' if mark else ''}: {getattr(error, 'problem', None) or error}") from None
    top = reader.group(content, "", KEYS)
    settle_s = reader.number(top, "settle_s", "", 0) if settle_s is None else settle_s
    scenes, skipped = [], []
    for name, value in reader.group(top.get("scenes"), "scenes", None).items():
        scene, optional = reader.scene(name, value, top, duration_s, settle_s)
        missing = missing_file(scene.scenario)
        if missing is None:
            scenes.append(scene)
        elif optional:
            skipped.append((scene.name, f"{os.path.relpath(missing)} is not there"))
        else:
            reader.fail(f"scenes.{name}", f"{missing}: no such file")
    axes = reader.group(top.get("axes"), "axes", None) or {"estimator": {"as it is": {}}}
    choices = []
    for axis, values in axes.items():
        if not reader.group(values, f"axes.{axis}", None):
            reader.fail(f"axes.{axis}", "has no value")
        choices.append([(str(name), reader.group(value, f"axes.{axis}.{name}", VARIANT_KEYS), f"axes.{axis}.{name}")
                        for name, value in values.items()])
    variants = []
    for combination in itertools.product(*choices):
        names, groups, wheres = zip(*combination)
        variants.append(Variant(names, reader.estimator((top, *groups), ("", *wheres), given)))
    common = reader.estimator((top,), ("",), dataclasses.replace(given, settings=()))
    further = [(axis, name, replays.Estimator(group.get("preset"), group.get("config"), reader.words(group, where)).words())
               for axis, values in zip(axes, choices) for name, group, where in values]
    further += [("command", "line", programs.with_settings(given.settings))] if given.settings else []
    matrix = Matrix(path, str(top.get("title", "Matrix")), [str(a) for a in axes], scenes, variants, reader.seeds(top.get("seeds", 1), seeds),
                    reader.per_seed(top.get("per_seed")), settle_s, common.words(), further, skipped, reader.comparison(top.get("compare"), axes))
    return chosen(matrix, patterns, reader)


def chosen(matrix, patterns, reader):
    """Only scenes and variants of which a row's name matches; each name is that of one row."""
    names = [row_name(*row) for row in matrix.rows()]
    for name in names:
        if names.count(name) > 1:
            reader.fail("axes", f"two rows are called {name}")
    if not matrix.scenes and not matrix.skipped:
        reader.fail("scenes", "has no scene")
    if not patterns:
        return matrix
    for pattern in patterns:
        if not any(fnmatch.fnmatchcase(name, pattern) for name in names):
            raise MatrixError(f"--rows {pattern}: no row has such a name; --list tells the names")
    rows = [row for row in matrix.rows() if any(fnmatch.fnmatchcase(row_name(*row), p) for p in patterns)]
    matrix.rows = lambda: rows
    matrix.scenes = [scene for scene in matrix.scenes if any(s is scene for s, _ in rows)]
    return matrix
