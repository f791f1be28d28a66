#!/bin/bash
# make bench: time and instructions per particle and step of our solver, and time of stock LAMMPS in the same run.
#
# State: 1000 spheres (1 : 1.4, equal volumes; and equal ones) at phi 0.5, sheared 2 strains (1.5 with contact and drag, 0.5 with
# friction and lubrication) at rate 0.1, velocities then scaled to the rate 9e-3 of Table 4.1. Made once, kept in build/bench/.
#
# Time: user seconds of a long run minus those of a short one, so that start-up drops out; solver and LAMMPS in turn, `repeats` times,
# median of each. Instructions: callgrind, 120 steps minus 20, in which few lists, if any, are rebuilt (LAMMPS's last about a thousand
# steps at this slow flow). LAMMPS's skin is 0.1: of 0.05, 0.1 and 0.3 the fastest or as fast within the noise for every deck.
#
# What is compared: s1 with fix langevin is the same physics. lubricate/poly and brownian/poly are other physics for unequal radii
# (coefficients and third law), so those rows compare the cost of codes for the same kind of model, not of the same numbers.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
B=${1:-build}
repeats=${BENCH_REPEATS:-3}
work=$B/bench
shear=$B/shear
lmp=${LMP:-lmp}
count=1000
mkdir -p "$work"
command -v "$lmp" >/dev/null || { echo "bench: the LAMMPS program \"$lmp\" was not found (Debian package lammps)"; exit 1; }
command -v valgrind >/dev/null || { echo "bench: valgrind was not found"; exit 1; }

# Edge of the cube in which the spheres of states.csv fill half the volume (small 1, large 1.4).
edge_of() {
    awk -F, '/^#/ { next } !seen++ { for (k = 1; k <= NF; k++) c[$k] = k; next }
             { a = $c["species"] == 1 ? 1 : 1.4; v += 4 / 3 * 3.14159265358979323846 * a ^ 3 }
             END { printf "%.17g", (v / 0.5) ^ (1 / 3) }' "$1"
}

# Last frame of a trajectory -> starting states, velocities times `factor`.
freeze() { # trajectory factor
    awk -F, -v OFS=, -v factor="$2" -f "$here/last-frame.awk" "$1"
}

# Scene $1.json with the box edge and the starting file filled in.
scene() { # scene states edge steps
    sed -e "s/EDGE/$3/g" -e "s|mixed.csv|$(basename "$2")|" -e "s/\"steps\": 1000/\"steps\": $4/" "$here/$1.json"
}

prepare() { # mixed|equal
    local kind=$1 states=$work/$1.csv tmp=$work/making-$1
    [ -s "$states" ] && return
    echo "making the sheared state $states (once) ..." >&2
    mkdir -p "$tmp"
    if [ "$kind" = equal ]; then
        sed 's/"volume_shares": \[0.5, 0.5\]/"volume_shares": [1.0, 0.0]/' "$here/preshear.json" >"$tmp/preshear.json"
    else
        cp "$here/preshear.json" "$tmp/preshear.json"
    fi
    "$shear" "$tmp/preshear.json" -o "$tmp/first" >/dev/null
    freeze "$tmp/first/trajectory.csv" 1 >"$tmp/first.csv"
    scene s2 "$tmp/first.csv" "$(edge_of "$tmp/first.csv")" 25000 |
        sed -e 's/"rate": 9e-3/"rate": 0.1/' -e 's/"dt": 1e-4/"dt": 2e-4/' -e 's|"file": "first.csv"|&, "time": 15.0|' \
            -e 's|"run": .*|&, "output": { "states": { "at": [25000] } }|' >"$tmp/second.json"
    "$shear" "$tmp/second.json" -o "$tmp/second" >/dev/null
    freeze "$tmp/second/trajectory.csv" 0.09 >"$states.new"
    mv "$states.new" "$states"
    rm -r "$tmp"
}

user_seconds() { local TIMEFORMAT=%U; { time "$@" >"$work/said" 2>&1; } 2>&1; }

run_shear() { # scene state steps
    "$shear" "$work/$1-$2-$3.json" -o "$work/out"
}
run_lammps() { # physics state steps
    "$lmp" -in "$here/lammps.in" -var data "$work/$2.data" -var physics "$1" -var steps "$3" -var skin 0.1 -var bench "$here" \
           -screen none -log "$work/log.lammps"
}
instructions() { # scene state steps
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$shear" "$work/$1-$2-$3.json" -o "$work/out" 2>&1 |
        awk '/Collected/ { print $NF }'
}
median() { sort -g | awk '{ v[NR] = $1 } END { print (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2 }'; }

row() { # name state scene steps lammps-physics lammps-steps remark
    local name=$1 state=$2 what=$3 steps=$4 physics=$5 lammps_steps=$6 remark=$7 edge short long ours="" theirs="" s1 s2
    edge=$(edge_of "$work/$state.csv")
    short=$((steps / 10)) long=$((steps + steps / 10))
    for n in $short $long 20 120; do scene "$what" "$work/$state.csv" "$edge" $n >"$work/$what-$state-$n.json"; done
    awk -f "$here/states-to-data.awk" -v edge="$edge" -v rate=9e-3 -v radius1=1 -v radius2=1.4 -v density=0.1 "$work/$state.csv" >"$work/$state.data"
    run_shear "$what" "$state" $short >"$work/said" 2>&1 || { cat "$work/said"; return 1; }
    run_lammps "$physics" "$state" 1 >"$work/said" 2>&1 || { grep ERROR "$work/log.lammps"; return 1; }
    for _ in $(seq "$repeats"); do
        s1=$(user_seconds run_shear "$what" "$state" $short); s2=$(user_seconds run_shear "$what" "$state" $long)
        ours+=$(awk -v a="$s1" -v b="$s2" -v n=$steps -v c=$count 'BEGIN { print (b - a) / n / c * 1e6 }')$'\n'
        s1=$(user_seconds run_lammps "$physics" "$state" $((lammps_steps / 10)))
        s2=$(user_seconds run_lammps "$physics" "$state" $((lammps_steps + lammps_steps / 10)))
        theirs+=$(awk -v a="$s1" -v b="$s2" -v n=$lammps_steps -v c=$count 'BEGIN { print (b - a) / n / c * 1e6 }')$'\n'
    done
    ours=$(printf %s "$ours" | median) theirs=$(printf %s "$theirs" | median)
    if [ -z "${counted[$what-$state]:-}" ]; then
        counted[$what-$state]=$(($(instructions "$what" "$state" 120) - $(instructions "$what" "$state" 20)))
    fi
    awk -v name="$name" -v o="$ours" -v t="$theirs" -v i="${counted[$what-$state]}" -v c=$count -v physics="$physics" \
        -v remark="$remark" -v headline="$work/headline" 'BEGIN {
        printf "%-24s %11.3f %9.3f %13.0f %11.3f %8.1f   %-13s %s\n", name, 1 / o, o, i / 100 / c, t, t / o, physics, remark
        if (physics != "s1-viscous") printf "%s %.0f, %.1fx\n", name, i / 100 / c, t / o >>headline }'
}

declare -A counted
prepare mixed
[ -z "${PREPARE_ONLY:-}" ] || exit 0
prepare equal
: >"$work/headline"
{
    printf '%s; LAMMPS %s; %s\n' "$("$shear" --version | head -1)" \
           "$("$lmp" -h | awk '/Large-scale/ { sub(/.*Simulator - /, ""); print }')" \
           "$(awk -F': ' '/model name/ { print $2; exit }' /proc/cpuinfo)"
    printf '1000 spheres, phi 0.5, constants of Table 4.1, dt 1e-4; per particle and step; median of %d interleaved repeats, user time, one core\n\n' "$repeats"
    printf '%-24s %11s %9s %13s %11s %8s   %-13s %s\n' scene 'M steps/s' 'us' 'instructions' 'LAMMPS us' ratio 'LAMMPS deck' remark
    row 'S1 contact+drag'          mixed s1 30000 s1-langevin 6000 'same physics: gran/hooke, fix langevin on temp/deform'
    row 'S1 contact+drag'          mixed s1 30000 s1-viscous 15000 'different physics: gran/hooke, fix viscous (drag towards rest)'
    row 'S2 friction+lub+drag'     mixed s2 4000 s2-poly      600 'different physics: gran/hooke/history + lubricate/poly'
    row 'S2 equal spheres'         equal s2 4000 s2-equal    2000 'different physics (C_11, C_12; spins in shear): gran/hooke/history + lubricate'
    row 'S3 S2+noise, gaussian'    mixed s3 1500 s3-poly      300 'different physics: s2-poly + brownian/poly (uniform numbers)'
    row 'S3 S2+noise, uniform'     mixed s3-uniform 2000 s3-poly 300 'different physics: s2-poly + brownian/poly (uniform numbers)'
} | tee "$B/bench.txt.new"
mv "$B/bench.txt.new" "$B/bench.txt"
echo "bench: instructions per particle-step, speed against LAMMPS: $(paste -sd ";" "$work/headline" | sed "s/;/; /g")" | tee -a "$B/bench.txt"
