#!/usr/bin/env python3
"""seeds_program_test.py BIN_DIR: leonav-fuzz-seeds writes into a folder that was meant, and nowhere else."""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = None


class Words(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def run_with(self, *words):
        done = subprocess.run([PROGRAM, *words], cwd=self.folder.name, capture_output=True, text=True, check=False, timeout=100)
        return done.returncode, done.stdout, done.stderr, os.listdir(self.folder.name)

    def test_help_is_printed(self):
        code, out, err, files = self.run_with("--help")
        self.assertEqual((code, err, files), (0, "", []))
        self.assertIn("usage: leonav-fuzz-seeds CORPUS", out)

    def test_other_words_with_a_dash_are_refused(self):
        for words in (["--version"], ["-h"], ["-"], [""], [], ["a", "b"]):
            code, out, err, files = self.run_with(*words)
            self.assertEqual((code, out, files), (2, "", []), words)
            self.assertIn("usage: leonav-fuzz-seeds CORPUS", err)

    def test_a_folder_gets_the_seeds(self):
        code, out, _, files = self.run_with("corpus")
        self.assertEqual((code, out, files), (0, "", ["corpus"]))
        self.assertIn("sequencer", os.listdir(pathlib.Path(self.folder.name) / "corpus"))


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve() / "leonav-fuzz-seeds")
    if not os.path.exists(PROGRAM):
        sys.exit("leonav-fuzz-seeds is not built")
    unittest.main(verbosity=1)
