# To be sourced.

# semi_real_drive BIN DATA OUT: the recorded drive in the folder DATA with an IMU synthesised from its truth:
# OUT/imu.csv, OUT/truth_attitude.csv, OUT/run_ins.lcmlog. BIN: the folder of the programs.
semi_real_drive() {
  "$1/leonav-imu-from-truth" --truth "$2/truth.csv" --out "$3/imu.csv" --truth-out "$3/truth_attitude.csv"
  sed -e "s#: \"\"#: []#; s#^\(observations\|navigation\|orbits\): \[#&$2/#; s#^imu:.*#imu: $3/imu.csv#" \
    -e "s#^truth:.*#truth: $2/truth.csv#" "$2/dataset.yaml" >"$3/dataset_ins.yaml"
  "$1/leonav-import" "$3/dataset_ins.yaml" -o "$3/run_ins.lcmlog"
}
