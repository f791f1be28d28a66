#!/bin/sh
# Data and plots of the figures at rest of docs/published.md, from what the checks of layer 7 left: tools/published-rest.sh [WORK]
# after `build/gate run --candidate "build/shear --evaluate" --layer 7 --tier full --work WORK` (default build/cases).
set -eu
cd "$(dirname "$0")/.."
work=${1:-build/cases} out=docs/published
solver=${SOLVER:-$(git log -1 --format=%h -- solver)}      # SOLVER=commit where an older one did the runs

# put CASE FILE NAME SENTENCE [FILTER]
put() {
    [ -f "$work/$1/$2" ] || { echo "no $work/$1/$2: left as it was"; return; }
    {
        echo "# $4"
        echo "# Measured with shear (solver/ of commit $solver) by: gate run --tier full --case $1, seed $(jq .seed "validation/cases/7-published/$1/case.json")"
        cat "$work/$1/$2" | ${5:-cat}
    } >"$out/$3"
}

few_lags() { awk -F, 'NR == 1 || $4 < 0.51 || ($4 * 40) % 10 < 0.5'; }
dilute() { awk 'BEGIN { print "kT,t/tau_I,msd,eq_4.2,error"; split("0.017 0.17 1.7", kT, " "); k = 1 } NF == 4 { printf "%s,%.5g,%s,%s,%s\n", kT[k], $1 / 4.5, $2, $3, $4; old = 1 } NF == 0 && old { k++; old = 0 }'; }

put fig4.2a-dilute-displacement msd.dat fig4.2a.csv "Mean square displacement per component, phi 0.001; tau_I/tau_B = kT; t/tau_I with m/(6 pi eta a) = tau_I/4.5; a = 1" dilute
put fig4.2d-diffusion msd.csv fig4.2b.csv "Mean square displacement per component; the first four times of each point are of the short runs" few_lags
put fig4.2d-diffusion diffusion.csv fig4.2d.csv "D over kT/(6 pi eta a): slope from 0.05 to 0.5 a^2/D_0 (middle), 1 to 2 (long); <dx^2>/((kT/m) t^2) at t/tau_I = 1e-6 to 1e-3"
put fig4.3b-green-kubo green-kubo.csv fig4.3b.csv "Running Green-Kubo viscosity over that of the fluid, lag in tau_I (tau_B = 5.88 tau_I), and its fit"
put fig4.3b-green-kubo fits.csv fig4.3b-fits.csv "Fits eta (1 - exp(-s/tau)), errors by jackknife over realisations; viscosities over that of the fluid"
put fig4.3b-green-kubo means.csv rest-pressures.csv "Pressures in n kT, temperatures in kT, tau_I/tau_B 0.17; standard errors from realisations"
put fig4.9-friction-at-rest fits.csv fig4.9-rest-fits.csv "Fits eta (1 - exp(-s/tau)) with and without friction, tau_I/tau_B 1.7; viscosities over that of the fluid"
put fig4.9-friction-at-rest means.csv fig4.9-rest.csv "Pressures in n kT, temperatures in kT, with and without friction, tau_I/tau_B 1.7"
put rest-split split.csv rest-split.csv "Pressures in n kT at phi 0.40 against the step of the explicit scheme (0: the split, at step 1e-3)"

for plot in "$out"/fig4.2?.gp "$out"/fig4.3b.gp "$out"/rest-split.gp; do
    name=$(basename "$plot" .gp)
    gnuplot -e "set terminal pngcairo size 640,440 font 'sans,10' background 'white'; set output '$out/$name.png'; set datafile separator ','; set datafile commentschars '#'; data='$out/'" "$plot"
done
