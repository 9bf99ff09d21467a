"""The version of leonav."""
import pathlib


def _read():
    """The file is in the package once that is installed by pip; in the tree, and where the programs are installed, it is at the top."""
    here = pathlib.Path(__file__).resolve()
    for folder in (here.parent, *list(here.parents)[3:4]):
        if (folder / "VERSION").exists():
            return (folder / "VERSION").read_text(encoding="utf-8").strip()
    return "of unknown version"


__version__ = _read()
