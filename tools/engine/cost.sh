#!/bin/bash
# make engine-cost: what a step costs in the engine. Needs a quiet machine; says where a bar is missed.
#
# On one rank against shear (user seconds, S2 and S3 of `make bench` and its state; bars 2.5 and 2.0 times shear's).
# On two ranks against one (wall seconds, S3 with uniform numbers at rate 9e-2, the states of `make scaling`; bar: efficiency t_1/(2 t_2) at
# least 0.85 at 1e5 spheres). Each time is that of a long run less that of a short one, so that starting drops out, all programs in turn: medians
# of user seconds, the least of wall seconds (ranks wait for each other, so whatever else runs adds to these). ONLY_RANKS=1 leaves out the
# first part. Then the model
# t = a n^p (+ b n^(2/3) on several ranks) per step, n spheres per rank: p above 1 is the cache, b the border.
set -euo pipefail
cd "$(dirname "$0")/../.."
B=${1:-build}
repeats=${BENCH_REPEATS:-3}
work=$B/engine-cost
mpirun="mpirun --allow-run-as-root --oversubscribe --mca mpi_yield_when_idle 1"
sizes=${SIZES:-"1000 10000 100000"}
scenes="s2 s3 s3-uniform"
[ -z "${ONLY_RANKS:-}" ] || scenes=
mkdir -p "$work"
PREPARE_ONLY=1 tools/bench/bench.sh "$B" >/dev/null
PREPARE_ONLY=1 tools/bench/scaling.sh "$B" >/dev/null
cp "$B/bench/mixed.csv" "$work"
for n in $sizes; do cp "$B/scaling/$n.csv" "$work" 2>/dev/null || [ -s "$work/$n.csv" ]; done

edge_of() {
    awk -F, '/^#/ { next } !seen++ { for (k = 1; k <= NF; k++) c[$k] = k; next }
             { a = $c["species"] == 1 ? 1 : 1.4; v += 4 / 3 * 3.14159265358979323846 * a ^ 3 } END { printf "%.17g", (v / 0.5) ^ (1 / 3) }' "$1"
}
scene() { # bench-scene states steps rate -> file
    sed -e "s/EDGE/$(edge_of "$work/$2.csv")/g" -e "s|mixed.csv|$2.csv|" -e "s/\"steps\": 1000/\"steps\": $3/" -e "s/\"rate\": 9e-3/\"rate\": $4/" \
        "tools/bench/$1.json" >"$work/$1-$2-$3.json"
}
seconds() { # format program... : seconds of the command
    local TIMEFORMAT=$1
    shift
    { time "$@" >"$work/said" 2>&1; } 2>&1
}
per_step() { # format scene states short long program... : seconds per step
    local a b
    a=$(seconds "$1" "${@:6}" "$work/$2-$3-$4.json" -o "$work/out") b=$(seconds "$1" "${@:6}" "$work/$2-$3-$5.json" -o "$work/out")
    awk -v a="$a" -v b="$b" -v s=$(($5 - $4)) 'BEGIN { print (b - a) / s }'
}
least() { sort -g | head -n 1; }
median() { sort -g | awk '{ v[NR] = $1 } END { print (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2 }'; }

declare -A t
for what in $scenes; do scene $what mixed 100 9e-3; scene $what mixed 2100 9e-3; done
for n in $sizes; do steps=$((6000000 / n < 20 ? 20 : 6000000 / n)); scene s3-uniform "$n" 10 9e-2; scene s3-uniform "$n" $((steps + 10)) 9e-2; done
for ((r = 0; r < repeats; r++)); do
    for what in $scenes; do
        # shellcheck disable=SC2086
        t[$what,shear]+=$(per_step %U $what mixed 100 2100 "$B/shear")$'\n' t[$what,engine]+=$(per_step %U $what mixed 100 2100 $mpirun -np 1 "$B/shear-lammps")$'\n'
    done
    for n in $sizes; do
        steps=$((6000000 / n < 20 ? 20 : 6000000 / n))
        for ranks in 1 2; do
            # shellcheck disable=SC2086
            t[$n,$ranks]+=$(per_step %R s3-uniform "$n" 10 $((steps + 10)) $mpirun -np $ranks "$B/shear-lammps")$'\n'
        done
    done
done
: >"$work/points"
{
    "$B/shear-lammps" --version
    printf '%s; %d repeats\n\n%-34s %12s %12s %8s %6s\n' "$(awk -F': ' '/model name/ { print $2; exit }' /proc/cpuinfo)" "$repeats" \
           "one rank, 1000 spheres" "shear, us" "engine, us" ratio bar
    for what in $scenes; do
        [ $what = s2 ] && bar=2.5 || bar=2.0
        awk -v w=$what -v s="$(printf %s "${t[$what,shear]}" | median)" -v e="$(printf %s "${t[$what,engine]}" | median)" -v bar=$bar \
            'BEGIN { printf "%-34s %12.3f %12.3f %8.2f %6s%s\n", w, s * 1e3, e * 1e3, e / s, bar, (e / s <= bar ? "" : "  MISSED") }'
    done
    printf '\n%-34s %12s %12s %12s\n' "spheres, S3 uniform, rate 9e-2" "1 rank, s" "2 ranks, s" efficiency
    for n in $sizes; do
        t1=$(printf %s "${t[$n,1]}" | least) t2=$(printf %s "${t[$n,2]}" | least)
        echo "$n 1 $t1
$n 2 $t2" >>"$work/points"
        awk -v n="$n" -v a="$t1" -v b="$t2" 'BEGIN { printf "%-34d %12.4g %12.4g %12.3f%s\n", n, a, b, a / b / 2, (n != 1e5 || a / b / 2 >= 0.85 ? "" : "  MISSED") }'
    done
} | tee "$work/table"
# One rank: a and p by the line through log t; more: b by least squares of relative errors.
awk '{ N[NR] = $1; P[NR] = $2; t[NR] = $3 }
     $2 == 1 { x = log($1); y = log($3); m++; sx += x; sy += y; sxx += x * x; sxy += x * y }
     END { p = (m * sxy - sx * sy) / (m * sxx - sx * sx); a = exp((sy - p * sx) / m)
           for (k = 1; k <= NR; k++) if (P[k] > 1) { n = N[k] / P[k]; g = n ^ (2 / 3); up += (t[k] - a * n ^ p) * g / t[k] ^ 2; down += g * g / t[k] ^ 2 }
           b = down ? up / down : 0
           for (k = 1; k <= NR; k++) { n = N[k] / P[k]; s += log(t[k] / (a * n ^ p + (P[k] > 1 ? b * n ^ (2 / 3) : 0))) ^ 2 }
           printf "model: t = %.3g us n^%.3f, and %.3g us n^(2/3) more on several ranks; typical error %.0f %%\n", a * 1e6, p, b * 1e6, 100 * sqrt(s / NR) }' \
    "$work/points" | tee -a "$work/table"
missed=$(grep -c MISSED "$work/table" || true)
awk -v missed="$missed" '$1 == "s2" || $1 ~ /^s3/ { r = r " " $1 " " $4 } $1 == 100000 { e = $4 }
    END { printf "engine-cost: times shear on one rank:%s; efficiency on 2 ranks at 1e5 spheres %s; %d bars missed\n", r, e, missed; exit missed > 0 }' "$work/table"
