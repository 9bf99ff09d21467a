# To be sourced.

# base_rover DATA OUT: of the recorded vehicle with a base in the folder DATA the data set for leonav-import,
# OUT/rover.yaml, and RTKLIB's kinematic positions with that base as truth, OUT/rover.pos, fixed or not.
base_rover() {
  printf '%s\n' pos1-posmode=kinematic pos1-frequency=l1+l2 pos1-soltype=combined pos1-elmask=15 pos1-navsys=9 \
    pos2-armode=fix-and-hold ant2-postype=xyz ant2-pos1=-3959400.631 ant2-pos2=3385704.533 ant2-pos3=3667523.111 \
    out-solformat=llh out-timesys=gpst out-timeform=tow >"$2/rover.conf"
  rnx2rtkp -k "$2/rover.conf" -o "$2/rover.pos" "$1/SEPT265G.21O" "$1/3034265G.21O" "$1/SEPT2650.21P" >"$2/rtklib.log" 2>&1 ||
    fail "rnx2rtkp failed: $2/rtklib.log"
  printf 'name: rover\nobservations: [%s]\nnavigation: [%s]\n' "$1/SEPT265G.21O" "$1/SEPT2650.21P" >"$2/rover.yaml"
}
