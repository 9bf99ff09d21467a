#!/bin/bash
# joinrun.sh scene seed system estimator join(true/false) tag [extra sets]
scene=$1 seed=$2 system=$3 est=$4 join=$5 tag=$6; shift 6
out=/tmp/x/joinout; mkdir -p $out
log=/tmp/x/arcs/$scene-$seed-plain; run=$out/$scene-$seed-$system-$est-$tag
m=(); [ $est = smoother ] && m=(--set estimator=smoother)
LEONAV_JOINS=1 nice ${BIN:-/tmp/x/joinbin}/leonav-replay --preset urban --set alignment.max_gyrocompass_sigma_deg=0 --set alignment.course_window_s=3 --set alignment.max_course_sigma_deg=20 --set "gnss.systems=[${system//+/, }]" "${m[@]}" --set vehicle.kind=handheld --set ekf.join_arcs=$join "$@" --out $run $log.lcmlog > $run.log 2> $run.err
${BIN:-/tmp/x/joinbin}/leonav-eval --truth $log.truth.csv --from 2136:345800 --json $run.json $run/solution.csv > $run.eval
rm -rf $run
