"""What the kernel says of a process."""
import pathlib


def status_kb(process_id, name):
    """A size in /proc/PID/status, as VmRSS (resident) or VmLck (locked); 0 where it is not there."""
    for line in pathlib.Path(f"/proc/{process_id}/status").read_text(encoding="ascii").splitlines():
        if line.startswith(name + ":"):
            return int(line.split()[1])
    return 0
