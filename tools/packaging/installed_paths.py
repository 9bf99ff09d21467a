#!/usr/bin/python3
"""Paths of the tree become those of an installation: installed_paths.py SHARE DOC ETC UNITS < TEXT > TEXT

For pages, manuals and configuration files. A link to a file that is not installed becomes its own words.
"""
import re
import sys

NOT_INSTALLED = r"(?:core|daemon|drivers|tools|test|cmake)/[^)]*|CONTRIBUTING\.md[^)]*"


def path(pattern):
    """At the begin of a path, not within a longer one."""
    return r"(?<![\w./-])" + pattern


def installed(text, share, doc, etc, units):
    text = re.sub(path(r"(?:\.\./)+(?=(?:core|daemon|drivers|tools|test|config|lcmtypes)/|CONTRIBUTING)"), "", text)
    text = text.replace("build/release/bin/", "")
    text = re.sub(path(r"tools/packaging/systemd/(?=[\w-]+\.service)"), units + "/", text)
    text = re.sub(r"\[([^]]*)\]\((?:" + NOT_INSTALLED + r")\)", r"\1", text)
    text = re.sub(path(r"config/(?=(?:connect|serve)\.yaml)"), etc + "/", text)
    text = re.sub(path(r"config/(?=presets\b|scenario/|matrix/|(?:reference|dataset)\.yaml)"), share + "/", text)
    text = re.sub(path(r"lcmtypes/"), share + "/lcmtypes/", text)
    return re.sub(path(r"docs/"), doc + "/", text)


sys.stdout.write(installed(sys.stdin.read(), *sys.argv[1:5]))
