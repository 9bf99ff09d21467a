#!/usr/bin/python3
"""pip_test.py: the Python package of tools/python as pip builds and installs it, without a network.

What is installed must have every module, the message types and the version, and read a log as the tree's own does. Exit 77: pip,
setuptools or wheel are missing for this Python.
"""
import importlib.util
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
PACKAGE = ROOT / "tools" / "python"
NEEDED = {"pip": "python3-pip", "setuptools": "python3-setuptools", "wheel": "python3-wheel", "numpy": "python3-numpy", "pandas": "python3-pandas"}
LOGS = [ROOT / "test" / "fuzz" / "corpus" / "event_log" / name for name in ("inputs", "piece")]
# Of the one package in the folder given: where it is, its version, and every table of the logs.
READ = """import sys
sys.path.insert(0, sys.argv[1])
import leonav
print(leonav.__file__, leonav.__version__)
for log in sys.argv[2:]:
    for channel, table in leonav.read_log(log).items():
        print(channel, list(table.columns))
        print(table.to_csv())
"""
# Neither a configuration nor packages of the user, and no index.
ENVIRONMENT = {name: value for name, value in os.environ.items() if not name.startswith(("PIP_", "PYTHON"))}
ENVIRONMENT.update(PIP_CONFIG_FILE=os.devnull, PIP_NO_INDEX="1", PIP_DISABLE_PIP_VERSION_CHECK="1", PYTHONNOUSERSITE="1",
                   PYTHONDONTWRITEBYTECODE="1")


def run(*command):
    done = subprocess.run([sys.executable, *command], env=ENVIRONMENT, cwd="/", capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(f"{command}: {done.stdout}{done.stderr}")
    return done.stdout


def files_in(folder):
    return {path.relative_to(folder) for path in folder.rglob("*") if "__pycache__" not in path.parts}


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.work = tempfile.TemporaryDirectory()
        folder = pathlib.Path(cls.work.name)
        cls.before = files_in(PACKAGE)
        run("-m", "pip", "wheel", "--no-build-isolation", "--no-deps", "--wheel-dir", folder, PACKAGE)
        cls.wheel, = folder.glob("*.whl")
        cls.target = folder / "installed"
        run("-m", "pip", "install", "--no-deps", "--target", cls.target, cls.wheel)
        cls.version = (ROOT / "VERSION").read_text(encoding="utf-8").strip()

    @classmethod
    def tearDownClass(cls):
        cls.work.cleanup()

    def test_the_wheel_has_every_module_the_types_and_the_version(self):
        self.assertTrue(self.wheel.name.startswith(f"leonav-{self.version}-"), self.wheel.name)
        with zipfile.ZipFile(self.wheel) as wheel:
            names = {name for name in wheel.namelist() if ".dist-info/" not in name}
        expected = {f"leonav/{path.name}" for path in (PACKAGE / "leonav").glob("*.py")}
        expected |= {f"leonav/lcmtypes/{path.name}" for path in (ROOT / "lcmtypes").glob("*.lcm")} | {"leonav/VERSION"}
        self.assertEqual(names, expected)

    def test_it_reads_logs_as_the_package_in_the_tree_does(self):
        own, ours = (run("-c", READ, folder, *LOGS).split("\n", 1) for folder in (self.target, PACKAGE))
        self.assertEqual(own[0], f"{self.target}/leonav/__init__.py {self.version}")
        self.assertEqual(ours[0], f"{PACKAGE}/leonav/__init__.py {self.version}")
        self.assertEqual(own[1], ours[1])
        for channel in ("IMU", "GNSS_EPOCH", "BIASES", "PIECE"):
            self.assertRegex(own[1], rf"(?m)^{channel} \[")

    def test_nothing_is_left_in_the_tree(self):
        self.assertEqual(files_in(PACKAGE), self.before)

    def test_the_build_asks_for_a_setuptools_that_has_what_setup_py_uses(self):
        self.assertIn("self.editable_mode", (PACKAGE / "setup.py").read_text(encoding="utf-8"))
        asked = re.search(r'"setuptools>=(\d+)"', (PACKAGE / "pyproject.toml").read_text(encoding="utf-8"))
        self.assertGreaterEqual(int(asked[1]), 64)  # PEP 660: the first one with build_py.editable_mode


if __name__ == "__main__":
    missing = [package for module, package in NEEDED.items() if importlib.util.find_spec(module) is None]
    if missing:
        print(f"SKIPPED: {', '.join(missing)} for {sys.executable}")
        sys.exit(77)
    unittest.main()
