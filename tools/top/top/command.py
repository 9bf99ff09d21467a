"""The command line and the screen of leonav-top."""
import argparse
import math
import shutil
import signal
import sys
import time

import leonav

from .picture import State, picture

CHANNELS = ("HEALTH", "SOLUTION", "EPOCH", "EVENT", "STREAMS", "CORRECTED_STATES")
REDRAW_S = 0.25
ENTER, LEAVE = "\x1b[?1049h\x1b[?25l", "\x1b[?25h\x1b[?1049l"
HOME, CLEAR_LINE, CLEAR_BELOW = "\x1b[H", "\x1b[K", "\x1b[J"
SETTLE_S = 3.0  # that --once listens for the other channels once the first message is there
ALL = {"HEALTH", "SOLUTION", "EPOCH", "STREAMS", "CORRECTED_STATES"}


def seconds(text):
    value = float(text)
    if not 0 <= value < math.inf:
        raise argparse.ArgumentTypeError(f"{text} is no number of seconds from 0 on")
    return value


def arguments(words):
    parser = argparse.ArgumentParser(
        prog="leonav-top", formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Shows in a terminal what leonavd and leonav-connect publish: health with misses and refused inputs, the\n"
                    "solution, streams, source and age of corrections, the last events, satellites with their orbits. Ctrl-C ends it.\n"
                    "It only listens. What the words mean stands in docs/operations/health.md, channels.md, connect.md and events.md.",
        epilog="Exit codes: 0 ended; 1 no message came (--once), or LCM cannot be joined; 2 command line.")
    parser.add_argument("--once", action="store_true", help="print one picture and end")
    parser.add_argument("--wait", type=seconds, default=5.0, metavar="S", help="with --once: for the first message, at most; 5 unless given")
    parser.add_argument("--listen", type=seconds, default=SETTLE_S, metavar="S",
                        help="with --once: for the other messages after the first; 3 unless given. Corrections come each 5 to 30 s")
    parser.add_argument("--prefix", default="LEONAV_", metavar="TEXT", help="lcm.prefix of the configuration; LEONAV_ unless given")
    parser.add_argument("--url", default="udpm://239.255.76.67:7667", metavar="URL", help="lcm.url of the configuration")
    parser.add_argument("--version", action="version", version=f"%(prog)s {leonav.__version__}")
    return parser.parse_args(words)


def once(options):
    """Prints one picture; returns the exit code."""
    state, end = State(), None
    for message in leonav.subscribe(CHANNELS, options.prefix, options.url, timeout_s=options.wait):
        now = time.monotonic()
        state.take(message, now)
        end = now + options.listen if end is None else end
        if now >= end or ALL <= set(state.fields):
            break
    if not state.fields:
        print(f"leonav-top: no message on {options.prefix}* within {options.wait:g} s; does leonavd run on this LCM network, with this "
              "prefix and URL?", file=sys.stderr)
        return 1
    print("\n".join(picture(state, time.monotonic())))  # whole: a terminal breaks long lines, a file has no width
    return 0


def draw(state):
    size = shutil.get_terminal_size()
    lines = picture(state, time.monotonic(), size.columns, size.lines - 1)
    sys.stdout.write(HOME + "".join(line + CLEAR_LINE + "\n" for line in lines) + CLEAR_BELOW)
    sys.stdout.flush()


def watch(options):
    """Draws until it is interrupted."""
    state, next_s = State(), 0.0
    sys.stdout.write(ENTER)
    try:
        while True:  # a silent second ends the subscription, and the picture must say so
            draw(state)
            for message in leonav.subscribe(CHANNELS, options.prefix, options.url, timeout_s=1.0):
                now = time.monotonic()
                state.take(message, now)
                if now >= next_s:
                    draw(state)
                    next_s = now + REDRAW_S
    finally:
        sys.stdout.write(LEAVE)
        sys.stdout.flush()


def main(words):
    options = arguments(words)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
    try:
        return once(options) if options.once else watch(options)
    except KeyboardInterrupt:
        return 0
    except leonav.LeonavError as error:
        print(f"leonav-top: {error}", file=sys.stderr)
        return 1
