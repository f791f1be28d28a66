#!/bin/sh
# adapters.sh BUILD [all]: the worked examples of docs/adapter.md before the gate, each with what it declares; then each with a mistake
# planted, which the gate must name. Asks the cases that fit into a minute; `all`: every case of the fast tier.
set -eu
B=${1:-build}; every=${2:-}
here=tools/adapters
W=$B/adapters
export PYTHONDONTWRITEBYTECODE=1
mkdir -p "$W"
passed=0; skipped=0; caught=0; bad=""

ask() {     # ask NAME GATE-ARGUMENTS...: one verdict of the gate, its counts added up
    name=$1; shift
    "$B/gate" "$@" --report "$W/$name-report" >"$W/$name.txt" 2>&1 && code=0 || code=$?
    line=$(grep -E '^[0-9]+ passed, ' "$W/$name.txt" || echo "0 passed, 0 failed, 0 skipped: no verdict")
    echo "$name: $line"
    [ "$code" = 0 ] || { bad="$bad $name"; grep -A3 -E ' FAIL | inconclusive |^gate:' "$W/$name.txt" | cut -c1-150 | head -n 20; }
    passed=$((passed + ${line%% passed*}))
    line=${line%% skipped*}; skipped=$((skipped + ${line##* }))
}

broken() {  # broken NAME FILE OLD NEW CASES WORDS COMMAND...: a copy with OLD (to be found once) as NEW; the verdict must say WORDS
    name=broken-$1 file=$2 old=$3 new=$4 cases=$5 words=$6; shift 6
    rm -rf "$W/$name"; cp -r "$here" "$W/$name"
    OLD=$old NEW=$new python3 - "$W/$name/$file" <<'END'
import os, sys
path, old, new = sys.argv[1], os.environ["OLD"], os.environ["NEW"]
text = open(path).read()
assert text.count(old) == 1, f"{path}: {text.count(old)} times: {old}"
open(path, "w").write(text.replace(old, new))
END
    case $file in fortran/*) fortran "$W/$name/fortran" "$W/$name/spheres" ;; esac
    "$B/gate" run --candidate "$*" --capabilities "$(ls "$here/${file%%/*}/"*capabilities.json)" --case "$cases" --jobs 2 \
        --work "$W/$name/cases" --report "$W/$name/report" >"$W/$name.txt" 2>&1 && code=0 || code=$?
    said=$(sed '/^report:/,$d' "$W/$name.txt" | tr '\n' ' ' | tr -s ' ' | sed 's/ fails: /\nfails: /g' | grep '^fails:' | grep -F "$words" | head -n 1 || true)
    echo "$name: $new"
    echo "    ${said:-not named: $words}"
    if [ "$code" = 1 ] && [ -n "$said" ]; then caught=$((caught + 1)); else bad="$bad $name"; fi
}

fortran() { # fortran SOURCES PROGRAM
    gfortran -O2 -std=f2018 -Wall -Wextra -Werror -J"$(dirname "$2")" -o "$2" "$1/spheres.f90" "$1/adapter.f90"
}

fortran $here/fortran "$W/spheres"
python="python3 $here/python/adapter.py" dump="python3 $here/dump/read_dump.py"
if [ "$every" ]; then
    ask fortran run --candidate "$W/spheres" --capabilities $here/fortran/capabilities.json --jobs 2 --work "$W/fortran"
    ask python run --candidate "$python" --jobs 2 --work "$W/python"
else
    ask fortran run --candidate "$W/spheres" --capabilities $here/fortran/capabilities.json --layer pair,noise --jobs 2 --work "$W/fortran"
    ask python-steps run --candidate "$python" --layer pair --jobs 2 --work "$W/python"
    ask python-runs run --candidate "$python" --case approach,metamorphic,dense-contact-memory,einstein-slope --jobs 2 --work "$W/python"
fi

# Level C: questions exported, runs made elsewhere, answers read from them, judged.
rm -rf "$W/dump"
"$B/gate" export "$W/dump" --capabilities $here/dump/read_dump.py.capabilities.json --case approach,collision,dense-contact-memory,dense-path,dense-path-friction >/dev/null
python3 $here/dump/elsewhere.py "$W/dump" "$B/shear"
sh "$W/dump/run.sh" $dump >/dev/null
ask dump judge "$W/dump"

broken fortran-torque fortran/spheres.f90 't(:, j) = t(:, j) + arm*a(j)*cross(p%n, tangential)' 't(:, j) = t(:, j) - arm*a(j)*cross(p%n, tangential)' \
    contact-friction 'torque on 2' "$W/broken-fortran-torque/spheres"
broken fortran-b2 fortran/spheres.f90 't(:, j) = t(:, j) + z%b2*cross(du, n)' 't(:, j) = t(:, j) - z%b2*cross(du, n)' \
    lubrication-resistance 'B_2' "$W/broken-fortran-b2/spheres"
broken python-image python/dem.py 'plus(plus(self.u[j], apply(self.gradient, shift)), self.u[i], -1)' 'plus(self.u[j], self.u[i], -1)' \
    frames-lubrication 'image' "python3 $W/broken-python-image/python/adapter.py"
broken dump-half dump/read_dump.py '-float(row' '-0.5 * float(row' \
    dense-path 'stress' "python3 $W/broken-dump-half/dump/read_dump.py --runs $W/dump"

echo "adapters: $passed cases passed, $skipped skipped, $caught planted mistakes named${bad:+; not right:$bad}"
[ -z "$bad" ]
