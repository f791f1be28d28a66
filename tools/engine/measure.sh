#!/bin/bash
# make engine: shear-lammps against shear, pathwise, and broken engines against the unit tests.
#
# 1000 spheres at phi 0.5 with friction, lubrication, drag and noise, pressed together by 0.44 strains of shear (1100 contacts
# with a history); from that checkpoint both programs go on for 100 and for 1000 steps, the cell being remapped at the 400th (600th). Bars: forces, torques,
# spins and histories at step 100 to 1e-10 of the largest, positions at step 1000 to 1e-9 (they measure 2e-12 and 2e-13: rounding of
# wrapped positions and the order of sums). A run that was stopped and went on on other ranks: positions to 1e-12.
# Faults: each of faults.json is built and must fail the suite `engine` of the unit tests. SKIP_FAULTS=1 leaves them out, ONLY_FAULTS=1 all else.
set -euo pipefail
cd "$(dirname "$0")/../.."
B=${1:-build}
work=$B/engine
mpirun="mpirun --allow-run-as-root --oversubscribe --mca mpi_yield_when_idle 1"
scene=tools/engine/compare.json
mkdir -p "$work"

go() { # program from to steps
    rm -rf "$work/$3" && cp -r "$work/$2" "$work/$3"
    $1 $scene -o "$work/$3" --set run.steps="$4" --resume >"$work/said" 2>&1 || { cat "$work/said"; exit 1; }
}
compare() { # title a b force-limit position-limit: fails where a limit is missed
    printf '%-44s ' "$1"
    if "$B/compare-checkpoints" "$work/$2/checkpoint.bin" "$work/$3/checkpoint.bin" "$4" "$5" >"$work/difference"; then
        awk '/contacts/ { next } NF == 2 { printf "%s %s  ", $1, $2 } END { print "" }' "$work/difference"
    else
        cat "$work/difference"; echo "engine: $1: a limit is missed"; exit 1
    fi
    awk -v kind="$1" '$1 == "position" { x = $2 } $1 ~ /force|torque|spin|history/ && $2 > f { f = $2 } END { print kind, f, x }' "$work/difference" >>"$work/figures"
}

: >"$work/figures"
rm -rf "$work/pressed"
if [ -z "${ONLY_FAULTS:-}" ]; then
$B/shear $scene -o "$work/pressed" >"$work/said" 2>&1 || { cat "$work/said"; exit 1; }
for steps in 100 1000; do
    go "$B/shear" pressed shear-$steps $((4400 + steps))
    for ranks in 1 2 4; do
        go "$mpirun -np $ranks $B/shear-lammps" pressed engine-$steps-$ranks $((4400 + steps))
        [ $steps = 100 ] && limits="1e-10 1e-9" || limits="1e-8 1e-9"
        # shellcheck disable=SC2086
        compare "engine against shear, step $steps, $ranks ranks:" shear-$steps engine-$steps-$ranks $limits
    done
done
go "$mpirun -np 4 $B/shear-lammps" engine-100-2 resumed 5400
compare "engine stopped at 100, resumed on 4 ranks:" engine-1000-2 resumed 1e-10 1e-12
fi

seen=0 tried=0
[ -n "${SKIP_FAULTS:-}" ] || tried=$(jq '.faults | length' tools/engine/faults.json)
for ((k = 0; k < tried; k++)); do
    name=$(jq -r ".faults[$k].name" tools/engine/faults.json)
    broken=$work/fault && rm -rf "$broken" && mkdir -p "$broken/build" && cp -rp solver tools Makefile "$broken"       # as old as the objects
    cp -rp "$B/obj" "$B/commit" "$B/shear" "$B/unit-tests" "$B/compare-checkpoints" "$broken/build"
    FIND=$(jq -r ".faults[$k].find | @base64" tools/engine/faults.json) REPLACE=$(jq -r ".faults[$k].replace | @base64" tools/engine/faults.json) \
        perl -MMIME::Base64 -0777 -i -pe 'BEGIN { $f = decode_base64($ENV{FIND}); $r = decode_base64($ENV{REPLACE}) } s/\Q$f\E/$r/' \
            "$broken/$(jq -r ".faults[$k].file" tools/engine/faults.json)"
    make --no-print-directory -s -C "$broken" B=build CFLAGS="-O2 -g -Wno-error" build/shear-lammps >"$work/said" 2>&1 || { cat "$work/said"; exit 1; }
    if "$broken/build/unit-tests" engine >"$work/said" 2>&1; then
        echo "NOT SEEN   $name"
    else
        seen=$((seen + 1))
        echo "seen       $name: $(grep -o 'rank [0-9]*: .*\|[0-9]* and [0-9]* with a history: not the same\|force  *[0-9].*\|[a-z_]*\.csv: measured [^,]*' "$work/said" |
            awk '$1 != "force" || $2 > 1e-10' | head -1)"
    fi
    rm -rf "$broken"
done
awk -v seen=$seen -v tried="$tried" '/step 100,/ && $(NF - 1) > f { f = $(NF - 1) } /step 1000,/ && $NF > x { x = $NF } /resumed/ { r = $NF }
    END { printf "engine: forces and torques off by %s at step 100, positions by %s at step 1000, after a restart by %s; %d of %d faults seen\n",
          f, x, r, seen, tried; exit seen != tried }' "$work/figures"
