#!/bin/bash
# make scaling: time of a step against the number of spheres, and the exponent p of time ~ N^p. Bar: at most 1.08.
#
# Scene: S3 of `make bench` (friction, lubrication, drag, noise of uniform numbers; 1:1.4 at phi 0.5), each N from its own random start with
# 20 steps behind it, kept in build/scaling/. Time: user seconds of a long run minus those of a short one, so that start-up drops out;
# sizes in turn, `repeats` times, median of each. Each size does the same number of particle-steps, so the largest few steps and few new lists.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
B=${1:-build}
repeats=${BENCH_REPEATS:-3}
particle_steps=${BENCH_PARTICLE_STEPS:-1.2e7}
work=$B/scaling
shear=$B/shear
sizes="100 1000 10000 100000"
mkdir -p "$work"

edge_of() { # count -> edge of the cube that `count` spheres half fill, as shear's random start shares them
    awk -v n="$1" 'BEGIN { k = 1.4 ^ 3; small = int(n * k / (1 + k) + 0.5)
                           printf "%.17g", ((small + (n - small) * k) * 4 / 3 * 3.14159265358979323846 / 0.5) ^ (1 / 3) }'
}

scene() { # count steps start-keys -> scene on stdout
    sed -e "s/EDGE/$(edge_of "$1")/g" -e "s|\"file\": \"mixed.csv\"|$3|" -e "s/\"steps\": 1000/\"steps\": $2/" -e 's/"rate": 9e-3/"rate": 9e-2/' \
        "$here/s3-uniform.json"
}

prepare() { # count
    [ -s "$work/$1.csv" ] && return
    echo "placing $1 spheres (once) ..." >&2
    scene "$1" 20 '"random": { "phi": 0.5, "count": '"$1"', "volume_shares": [0.5, 0.5] }' |
        sed 's|"run": .*|&, "output": { "states": { "at": [20] } }|' >"$work/start-$1.json"
    "$shear" "$work/start-$1.json" -o "$work/start-$1" >/dev/null 2>&1
    awk -F, -v OFS=, -v factor=1 -f "$here/last-frame.awk" "$work/start-$1/trajectory.csv" >"$work/$1.new"
    mv "$work/$1.new" "$work/$1.csv"
    rm -r "$work/start-$1"
}

user_seconds() { local TIMEFORMAT=%U; { time "$shear" "$1" -o "$work/out" >"$work/said" 2>&1; } 2>&1; }
median() { sort -g | awk '{ v[NR] = $1 } END { print (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2 }'; }

declare -A steps seen
for n in $sizes; do prepare "$n"; done
[ -z "${PREPARE_ONLY:-}" ] || exit 0
for n in $sizes; do
    steps[$n]=$(awk -v n="$n" -v p="$particle_steps" 'BEGIN { printf "%d", p / n }')
    scene "$n" 10 "\"file\": \"$n.csv\"" >"$work/$n-short.json"
    scene "$n" $((steps[$n] + 10)) "\"file\": \"$n.csv\"" >"$work/$n-long.json"
done
for _ in $(seq "$repeats"); do
    for n in $sizes; do
        short=$(user_seconds "$work/$n-short.json"); long=$(user_seconds "$work/$n-long.json")
        seen[$n]+=$(awk -v a="$short" -v b="$long" -v n="$n" -v s="${steps[$n]}" 'BEGIN { print (b - a) / s / n * 1e6 }')$'\n'
    done
done
{
    printf '%s; %s\n' "$("$shear" --version | head -1)" "$(awk -F': ' '/model name/ { print $2; exit }' /proc/cpuinfo)"
    printf 'S3 with uniform noise, rate 9e-2, median of %s interleaved repeats, user time, one core\n\n%10s %10s %22s %12s\n' "$repeats" \
           spheres steps "us / particle-step" "s / step"
    for n in $sizes; do
        us=$(printf %s "${seen[$n]}" | median)
        awk -v n="$n" -v s="${steps[$n]}" -v us="$us" -v spread="$(printf %s "${seen[$n]}" | sort -g | tr '\n' ' ')" \
            'BEGIN { printf "%10d %10d %10.3f (%s) %12.3g\n", n, s, us, spread, us * n * 1e-6 }'
    done
} | tee "$work/table"
awk '$1 + 0 >= 100 && NF >= 4 { x = log($1); y = log($NF); m++; sx += x; sy += y; sxx += x * x; sxy += x * y }
     END { p = (m * sxy - sx * sy) / (m * sxx - sx * sx); printf "scaling: time of a step ~ N^%.3f from 1e2 to 1e5 spheres (bar 1.08)\n", p
           exit !(m == 4 && p <= 1.08) }' "$work/table"
