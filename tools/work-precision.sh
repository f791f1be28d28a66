#!/bin/bash
# make work-precision: seconds of one core for 1 % of the number of pairs near contact, by scheme and step.
#
# Two Brownian spheres with the constants of Li (2026) Table 4.1, each tethered where it starts, near contact; many such pairs, each alone.
# Asked: how many are nearer than the inner gap, over Boltzmann's number (quadrature below). A scheme's error after t seconds is
# sqrt(bias^2 + s^2/t); s is measured from the spread over pairs, the time is user time of the steps after the transient.
# `bias` is the scheme's predicted one: verlet 1 - eps/2, predicted_verlet (1 - eps)^(1/3) (1 + eps/2)^(2/3), split none. "divided" takes
# the predicted factor out of the result. Writes build/work-precision/table.csv row by row (rows there are kept: delete it to measure anew)
# and its plot.
set -euo pipefail
B=${1:-build}
work=$B/work-precision
table=$work/table.csv
mkdir -p "$work"
[ -s "$table" ] || { "$B/shear" --version | sed 's/^/# /' >"$table"
                     echo "scheme,dt,eps,pairs,steps,seconds,ratio,error,predicted,cost" >>"$table"; }

# scheme dt pairs: transient of 1.5 time units (six relaxations of the trap), then $4 units sampled 60 times
row() {
    local scheme=$1 dt=$2 pairs=$3 units=$4 dynamics every seconds name=${1}_$2
    grep -q "^$scheme,$dt," "$table" && return
    dynamics="\"$scheme\": { \"dt\": $dt }"
    [ "$scheme" = sweeps ] && dynamics="\"split\": { \"dt\": $dt, \"friction\": \"sweeps\" }"
    every=$(awk -v u="$units" -v dt="$dt" 'BEGIN { print int(u / dt / 60 + 0.5) }')
    local burn across edge steps
    burn=$(awk -v e="$every" -v dt="$dt" 'BEGIN { print int(1.5 / dt / e + 1) * e }')
    steps=$((burn + 60 * every))
    across=$(awk -v n="$pairs" 'BEGIN { c = int(n ^ (1 / 3)); while (c ^ 3 < n) c++; print c }')
    edge=$(awk -v c="$across" 'BEGIN { print 4.7 * c }')
    awk -v n="$pairs" -v c="$across" -v OFS=, 'function gauss() { return sqrt(-2 * log(rand() + 1e-12)) * cos(6.283185307179586 * rand()) }
        BEGIN { srand(11); print "id,species,x,y,z,ux,uy,uz,wx,wy,wz"
                m = 4 / 3 * 3.141592653589793 * 0.1; s = sqrt(0.017 / m); t = sqrt(0.017 / (0.4 * m))
                for (k = 0; k < n; k++) for (side = -1; side <= 1; side += 2)
                    printf "%d,1,%.17g,%.17g,%.17g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", ++id, 4.7 * (k % c + 0.5) + side * (1 + 0.0003),
                        4.7 * (int(k / c) % c + 0.5), 4.7 * (int(k / c / c) + 0.5), s * gauss(), s * gauss(), s * gauss(), t * gauss(), t * gauss(), t * gauss()
        }' >"$work/$name.csv"
    cat >"$work/$name.json" <<END
{ "about": "Tethered Brownian pairs near contact", "seed": 7, "fluid": { "viscosity": 0.1, "kT": 0.017 },
  "box": { "lengths": [$edge, $edge, $edge], "periodic": [true, true, true] },
  "species": [ { "name": "sphere", "radius": 1.0, "density": 0.1 } ], "start": { "file": "$name.csv" },
  "forces": { "contact": { "normal_stiffness": 1e4, "friction": 0 }, "tether": { "sphere": { "stiffness": 4000 } },
    "lubrication": { "inner_gap": 1e-3, "outer_gap": 0.05, "rotation_correction": "none" }, "lubrication_noise": { "distribution": "gaussian" } },
  "dynamics": { $dynamics }, "run": { "steps": $steps }, "output": { "states": { "every": $every } } }
END
    seconds=$( { TIMEFORMAT=%U; time "$B/shear" "$work/$name.json" -o "$work/$name" >"$work/said" 2>&1; } 2>&1 ) || { cat "$work/said"; exit 1; }
    awk -F, -v OFS=, -v scheme="$scheme" -v dt="$dt" -v pairs="$pairs" -v steps=$((60 * every)) -v burn="$burn" \
        -v seconds="$(awk -v s="$seconds" -v b="$burn" -v n="$steps" 'BEGIN { print s * (n - b) / n }')" '
        function g(h, eps) {         # X_A of equal spheres at xi = h/a, a = 1; m_eff = (2/3) pi rho
            h = h > 1e-3 ? h : 1e-3
            eps = 6 * pi * 0.1 * (0.25 / h - 9 / 40 * log(h)) * dt / (2 / 3 * pi * 0.1)
            return scheme == "verlet" ? 1 - eps / 2 : scheme == "predicted_verlet" ? ((1 - eps) * (1 + eps / 2) ^ 2) ^ (1 / 3) : 1 }
        BEGIN { pi = 3.141592653589793
                for (h = -0.0104; h < 0.025; h += 2e-6) { r = 2 + h
                    w = r * exp(-((h < 0 ? 0.5e4 * h * h : 0) + 1000 * (h - 0.0006) ^ 2) / 0.017)
                    all += w; biased += w * g(h); if (h < 1e-3) { near += w; biased_near += w * g(h) } }
                boltzmann = near / all; predicted = biased_near / biased / boltzmann }
        /^#/ { next }
        !seen++ { for (k = 1; k <= NF; k++) c[$k] = k; next }
        $c["step"] > burn {
            if ($c["id"] % 2) { x = $c["x"]; y = $c["y"]; z = $c["z"]; next }
            samples[$c["id"]]++
            if (sqrt((x - $c["x"]) ^ 2 + (y - $c["y"]) ^ 2 + (z - $c["z"]) ^ 2) < 2.001) own[$c["id"]]++ }
        END { for (i in samples) { v = own[i] / samples[i]; n++; sum += v; squares += v * v }
              mean = sum / n; error = sqrt((squares / n - mean * mean) / (n - 1)) / boltzmann
              printf "%s,%s,%.3g,%d,%d,%.3g,%.5g,%.2g,%.5g,%.3g\n", scheme, dt, 2263.96 * dt, pairs, steps, seconds, mean / boltzmann, error, predicted,
                  seconds * (error * predicted ^ -1 / 0.01) ^ 2 }' "$work/$name/trajectory.csv" >>"$table"
    rm -r "${work:?}/$name" "$work/$name.csv"
    tail -1 "$table"
}

#   scheme           dt      pairs  time
row split            1e-3    1000   6
row split            2e-3    1000   12
row sweeps           2e-3    1000   12
row verlet           8.8e-6  150    3
row verlet           2e-4    800    6
row verlet           4e-4    800    12
row predicted_verlet 9e-5    600    4
row predicted_verlet 2e-4    800    6

awk -F, '/^#/ || /^scheme/ { next }
    !shown++ { printf "%-18s %9s %6s %19s %11s %22s\n", "scheme", "dt", "eps", "ratio to Boltzmann", "predicted", "seconds for 1 %" }
    { off = $9 > 1 ? $9 - 1 : 1 - $9
      printf "%-18s %9s %6s %9.4f +- %.4f %11.4f %11.1f %s\n", $1, $2, $3, $7, $8, $9, $10, off <= 0.01 ? "" : "  bias divided out" }' "$table"
{
    echo "set terminal pngcairo size 1000,520 font 'sans,11'; set output '$work/work-precision.png'; set logscale xy; set key outside right"
    echo "set xlabel 'seconds of one core'; set ylabel 'relative error of the number of pairs near contact'; set samples 400"
    printf "plot [0.1:1e4] [1e-3:0.3] 0.01 with lines lc rgb 'black' dt 3 title '1 %%'"
    awk -F, 'BEGIN { split("#1b6ca8 #62b0e8 #6a3d9a #000000 #b2182b #ef8a62 #1b7837 #7fbf7b", colour, " ") }
        /^#/ || /^scheme/ { next }
        { off = $9 > 1 ? $9 - 1 : 1 - $9; name = $1 " " $2; gsub("_", " ", name); s = $8 / $9 * sqrt($6); c = colour[++n]
          printf ", sqrt(%g**2 + %g**2/x) with lines lw 2 lc rgb \"%s\" title \"%s\"", off, s, c, name
          if (off > 0.01) printf ", %g/sqrt(x) with lines lw 2 dt 2 lc rgb \"%s\" title \"%s, divided\"", s, c, name }' "$table"
} >"$work/plot.gnuplot"
gnuplot "$work/plot.gnuplot"
best=$(awk -F, '$1 == "split" || $1 == "sweeps" { if (!b || $10 < b) b = $10 } END { print b }' "$table")
slow=$(awk -F, '$1 == "verlet" && $3 < 0.03 { print $10 }' "$table")
echo "work-precision: 1 % near contact takes $best s with the best split, $slow s with verlet at its unbiased step; plot in $work/work-precision.png"
