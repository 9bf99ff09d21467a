"""Disks that fill up, freeze or vanish; inside the row's mount namespace."""
import os
import shutil
import subprocess

SIZE_MB = 24
FROZEN_MB = 64


def why_no_tmpfs():
    return "" if os.geteuid() == 0 or shutil.which("unshare") else "no mount namespace can be made here"


def why_no_freeze():
    if os.geteuid() != 0:
        return "a loop device takes root"
    if not os.path.exists("/dev/loop-control"):
        return "there are no loop devices here"
    missing = [name for name in ("mkfs.ext4", "fsfreeze") if not shutil.which(name)]
    return f"{missing[0]} is missing" if missing else ""


def folder(run):
    return run.folder / "disk"


def mount_tmpfs(run):
    folder(run).mkdir(exist_ok=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={SIZE_MB}m", "tmpfs", folder(run)], check=True)


def fill(run):
    """To the last byte."""
    with open(folder(run) / "filler", "wb", buffering=0) as file:
        for size in (1 << 20, 4096, 1):
            try:
                while True:
                    file.write(bytes(size))
            except OSError:
                pass


def free(run):
    (folder(run) / "filler").unlink()


def mount_loop(run):
    image = run.folder / "disk.img"
    image.unlink(missing_ok=True)
    with open(image, "wb") as file:
        file.truncate(FROZEN_MB << 20)
    subprocess.run(["mkfs.ext4", "-q", image], check=True)
    folder(run).mkdir(exist_ok=True)
    subprocess.run(["mount", "-o", "loop", image, folder(run)], check=True)


def freeze(run):
    subprocess.run(["fsfreeze", "-f", folder(run)], check=True)


def thaw(run):
    subprocess.run(["fsfreeze", "-u", folder(run)], check=False, stderr=subprocess.DEVNULL)


def link_pieces(run):
    """Other names for the journal's pieces, which outlive those that are removed."""
    for piece in run.daemon.journal.parent.iterdir():
        if not (whole(run) / piece.name).exists():
            os.link(piece, whole(run) / piece.name)


def whole(run):
    return run.folder / "whole"


def remove(run):
    whole(run).mkdir(exist_ok=True)
    link_pieces(run)
    shutil.rmtree(run.daemon.journal.parent)


def pieces_of_both(run):
    """The folder of the pieces that were removed and of those behind them."""
    link_pieces(run)
    return [whole(run)]


def make_again(run):
    run.daemon.journal.parent.mkdir(exist_ok=True)
