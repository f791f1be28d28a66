#!/bin/sh
# Runs every sample scene of docs/scenes/ and draws its plot to build/scenes/NAME.svg; prints the sentence and the seconds of each.
# Bar: 20 seconds each.
set -eu
cd "$(dirname "$0")/.."
out=build/scenes slow=0 count=0
mkdir -p $out
for plot in docs/scenes/*.gp; do
    name=$(basename "$plot" .gp)
    start=$(date +%s.%N)
    build/shear "docs/scenes/$name.json" -o "$out/$name" 2>"$out/$name.txt" || { cat "$out/$name.txt"; exit 1; }
    seconds=$(echo "$(date +%s.%N) $start" | awk '{ printf "%.1f", $1 - $2 }')
    gnuplot -e "set terminal svg size 720,460 enhanced font 'sans,12' background 'white'; set output '$out/$name.svg'; set datafile separator ','; data='$out/$name'" "$plot"
    printf '%-12s %5s s  %s\n' "$name" "$seconds" "$(jq -r .about "docs/scenes/$name.json")"
    count=$((count + 1))
    echo "$seconds" | awk '{ exit !($1 > 20) }' && slow=$((slow + 1))
done
echo "scenes: $count, of which $slow took more than 20 s; plots in $out/"
[ $slow = 0 ]
