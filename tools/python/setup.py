"""Puts the message types of lcmtypes/ and the version into the package that is built; the rest is in pyproject.toml."""
import atexit
import pathlib
import shutil
import tempfile

from setuptools import setup
from setuptools.command.build_py import build_py

ROOT = pathlib.Path(__file__).resolve().parents[2]
TYPES = ROOT / "lcmtypes"
VERSION = ROOT / "VERSION"


class BuildWithTypes(build_py):
    def run(self):
        super().run()
        if self.editable_mode:  # the package then reads the tree's own
            return
        definitions = sorted(TYPES.glob("*.lcm"))
        if not definitions:
            raise SystemExit(f"{TYPES}: no message types; build the package within the tree of leonav")
        target = pathlib.Path(self.build_lib) / "leonav" / "lcmtypes"
        target.mkdir(parents=True, exist_ok=True)
        for definition in definitions:
            shutil.copy(definition, target)
        shutil.copy(VERSION, target.parent)


# What is built on the way does not stay in the tree.
work = tempfile.mkdtemp(prefix="leonav-build-")
atexit.register(shutil.rmtree, work, ignore_errors=True)
setup(version=VERSION.read_text(encoding="utf-8").strip(), cmdclass={"build_py": BuildWithTypes}, options={"build": {"build_base": work}, "egg_info": {"egg_base": work}})
