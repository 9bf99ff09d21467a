#!/bin/sh
# live_test.sh BIN_DIR PRESET LOG OUT_DIR [SPEED]: plays LOG over real LCM multicast to leonavd in a network
# namespace of its own, stops it by SIGTERM, and demands that the journal replays byte for byte.
# Exit 77: no namespace can be made here (the caller skips).
set -eu
if [ "${LEONAV_IN_NAMESPACE:-}" != yes ]; then
  if unshare -n true 2>/dev/null; then ns="unshare -n"
  elif unshare -rn true 2>/dev/null; then ns="unshare -rn"
  else echo "SKIPPED: no network namespace can be made here"; exit 77; fi
  LEONAV_IN_NAMESPACE=yes exec $ns "$0" "$@"
fi
bin=$1 preset=$2 log=$3 out=$4 speed=${5:-20}
mkdir -p "$out"
journal=$out/journal.lcmlog

# Without a route: refused at once, with the command that mends it.
status=0
"$bin/leonavd" --preset "$preset" 2>"$out/no_route.txt" || status=$?
[ "$status" = 4 ] || { echo "FAILED: without a route exit code $status, not 4"; exit 1; }
grep -q "ip route add 224.0.0.0/4 dev lo" "$out/no_route.txt" || { echo "FAILED: no remedy named"; exit 1; }

ip link set lo up multicast on
ip route add 224.0.0.0/4 dev lo
start_daemon() {  # JOURNAL TEXT_FILE
  "$bin/leonavd" --preset "$preset" --journal "$1" 2>"$2" &
  daemon=$!
  trap 'kill -9 "$daemon" 2>/dev/null || true' EXIT
  for _ in 1 2 3 4 5 6 7 8 9 10; do
    sleep 0.5
    if grep -q "running; LCM" "$2"; then break; fi
  done
}
start_daemon "$journal" "$out/leonavd.txt"
lcm-logplayer --speed="$speed" "$log" >/dev/null
sleep 1
kill -TERM "$daemon"
status=0
wait "$daemon" || status=$?
trap - EXIT
cat "$out/leonavd.txt"
[ "$status" = 0 ] || { echo "FAILED: leonavd ended with $status"; exit 1; }
"$bin/leonav-replay" --preset "$preset" --out "$out/replay" --verify "$journal" >"$out/replay.txt" || {
  cat "$out/replay.txt"; echo "FAILED: the journal does not replay"; exit 1; }
grep -E "^(input|verified|deadline|output hash|lost)" "$out/replay.txt"

# A journal that takes nothing holds the end up; a second signal ends the daemon all the same.
mkfifo "$out/stuck"
sleep 100 <"$out/stuck" &
reader=$!
start_daemon "$out/stuck" "$out/stuck.txt"
lcm-logplayer --speed=100 "$log" >/dev/null
kill -TERM "$daemon"
sleep 1
kill -0 "$daemon" 2>/dev/null || { echo "FAILED: the stuck journal did not hold leonavd up"; exit 1; }
kill -TERM "$daemon"
status=0
wait "$daemon" || status=$?
kill "$reader"
trap - EXIT
[ "$status" = 143 ] || { echo "FAILED: after a second SIGTERM leonavd ended with $status"; exit 1; }
