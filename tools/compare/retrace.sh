#!/bin/sh
# In four rows of docs/viscosities.md the paths of shear and LAMMPS part, so that only means can be compared. Here one whole run of each row is
# gone again by shear in pieces too short to part (retrace.c). The gate makes the question; this script is also the candidate it calls.
#
#     tools/compare/retrace.sh BUILD                  all rows; golden/viscosities/retraced.csv and the page
#     tools/compare/retrace.sh BUILD answer STEPS CASE_DIR OUT_DIR
set -eu
cd "$(dirname "$0")/../.."
B=$1
if [ "${2:-}" = answer ]; then
    steps=$3 case=$4 out=$5
    jq --argjson steps "$steps" '.output = { stress: { every: $steps }, states: { every: $steps } }' "$case/scene.json" >"$case/scene.new"
    mv "$case/scene.new" "$case/scene.json"
    "$B/lammps-candidate" --own reference "$case" "$out"
    "$B/retrace" "$case" "$out" >"$B/retracing/pieces.csv" || true
    rm -f "$out"/lammps.* "$out/trajectory.csv"     # hundreds of megabytes
    echo "the gate's own run: there is nothing to judge" >&2
    exit 77
fi

# row, its case, steps of a piece
rows="phi 0.50 mu 1|viscosities-contact|100
phi 0.55 mu 0.5|viscosities-contact|100
phi 0.55 mu 1|viscosities-contact|100
phi 0.50 mu 0.5 Pe 1 A/kT 100|viscosities-repulsion|5000"
table=golden/viscosities/retraced.csv
rm -rf "$B/retracing" && mkdir -p "$B/retracing"
echo "row,pieces,steps,places,stresses,verdict" >"$B/retracing/table.csv"
good=0
while IFS='|' read -r row case steps; do
    suite=$B/retracing/suite
    mkdir -p "$suite/cases/6-dense/$case"
    cp validation/flags.json validation/terms.json "$suite"
    jq --arg row "$row" '.parameters.points |= map(select(.name == $row) | .realisations = 1)' "validation/cases/6-dense/$case/case.json" >"$suite/cases/6-dense/$case/case.json"
    rm -f "$B/retracing/pieces.csv"
    "$B/gate" run --candidate "$0 $B answer $steps" --suite-dir "$suite" --case "$case" --tier full --work "$B/retracing/work" --report "$B/retracing/report" \
        >"$B/retracing/gate.txt" 2>&1 </dev/null || true
    said=$(tail -1 "$B/retracing/pieces.csv" 2>/dev/null || true)
    case $said in "retrace: "*) ;; *) echo "retrace: $row: not retraced to its end"; cat "$B/retracing/gate.txt" "$B"/retracing/work/*/*/out.log 2>/dev/null || true; exit 1 ;; esac
    printf '%s: %s\n' "$row" "$said"
    echo "$said" | sed -E "s#^retrace: ([0-9]+) pieces from step 0 to ([0-9]+): places agree to (.*), stresses to (.*): (.*)#$row,\1,\2,\3,\4,\5#" >>"$B/retracing/table.csv"
    case $said in *": the same steps") good=$((good + 1)) ;; esac
    rm -rf "$suite" "$B/retracing/work"
done <<EOF
$rows
EOF
mv "$B/retracing/table.csv" "$table"
golden/viscosities/page.py golden/viscosities docs/viscosities.md
echo "retrace: $good of 4 rows: LAMMPS's run is made of shear's steps"
[ "$good" = 4 ]
