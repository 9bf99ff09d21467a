"""What tests of a running program share: a network namespace of their own, and an end with a reason."""
import os
import pathlib
import subprocess
import sys


def fail(text):
    sys.exit(f"FAILED: {text}")


def require_log_thread(process):
    """The program writes its log in a thread of its own, so that nobody who reads it holds up the others."""
    tasks = pathlib.Path(f"/proc/{process.pid}/task")
    names = [(task / "comm").read_text(encoding="ascii").strip() for task in tasks.iterdir()]
    if "leonav-log" not in names:
        fail(f"no thread writes the log; there are {names}")


def namespace_command():
    """The command that runs another one in a network namespace of its own; exit 77: none can be made."""
    for enter in (["unshare", "-n"], ["unshare", "-rn"]):
        if subprocess.run([*enter, "true"], stderr=subprocess.DEVNULL, check=False).returncode == 0:
            return enter
    print("SKIPPED: no network namespace can be made here")
    sys.exit(77)


def enter_namespace():
    """Starts this script again in a namespace with LCM's multicast route on loopback."""
    if os.environ.get("LEONAV_IN_NAMESPACE") != "yes":
        enter = namespace_command()
        os.environ["LEONAV_IN_NAMESPACE"] = "yes"
        os.execvp(enter[0], [*enter, sys.executable, *sys.argv])
    subprocess.run(["ip", "link", "set", "lo", "up", "multicast", "on"], check=True)
    subprocess.run(["ip", "route", "add", "224.0.0.0/4", "dev", "lo"], check=True)
