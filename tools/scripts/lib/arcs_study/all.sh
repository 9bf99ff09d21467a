for scene in city dense; do for seed in 1 2 3; do [ -e /tmp/x/arcs/$scene-$seed-plain.lcmlog ] || continue
for est in filter smoother; do for system in gps gps+leo; do
bash /tmp/x/joinrun.sh $scene $seed $system $est false j0 & bash /tmp/x/joinrun.sh $scene $seed $system $est true ${1:-j1}; wait; done; done; done; done
