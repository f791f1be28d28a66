#!/bin/sh
# Puts each fault of validation/faults/faults.json into a copy of the solver, builds it, and lets the fast tier judge it, cheap
# layers first, until one fails. Writes build/faults.txt: verdict, seconds, layer and case, what was said. `make faults [ONLY=word] [FROM=number]`.
# Fails if a fault passes, or an equivalent change does not.
set -eu
cd "$(dirname "$0")/.."
list=validation/faults/faults.json
table=build/faults.txt
count=$(jq '.faults | length' $list)
: >$table
missed=0 tried=0
k=$((${FROM:-0} - 1))
while [ $((k += 1)) -lt "$count" ]; do
    name=$(jq -r ".faults[$k].name" $list)
    case $name in *"${ONLY:-}"*) ;; *) continue ;; esac
    class=$(jq -r ".faults[$k].class" $list)
    work=build/faults/$k
    rm -rf "$work" && mkdir -p "$work/build/obj" && cp -a solver Makefile "$work"
    cp -a build/obj/solver "$work/build/obj"        # with their times, so that only what the fault touches is compiled anew
    FIND=$(jq -r ".faults[$k].find | @base64" $list) REPLACE=$(jq -r ".faults[$k].replace | @base64" $list) \
        perl -MMIME::Base64 -0777 -i -pe 'BEGIN { $f = decode_base64($ENV{FIND}); $r = decode_base64($ENV{REPLACE}) }
            $n = () = /\Q$f\E/g; die "found $n times, not once\n" unless $n == 1; s/\Q$f\E/$r/' "$work/$(jq -r ".faults[$k].file" $list)"
    make --no-print-directory -s -C "$work" -j"$(nproc)" B=build CFLAGS="-O2 -g -Wno-error" build/shear 2>"$work/make.txt" ||
        { echo "faults: \"$name\" does not build"; cat "$work/make.txt"; exit 1; }
    verdict="passed everything" where="" said="" start=$(date +%s.%N)
    for layer in 1 2 3 4 5 6; do
        build/gate run --candidate "$work/build/shear --evaluate" --layer $layer --jobs "$(nproc)" --work "$work/cases" --report "$work/report" \
            >"$work/gate.txt" 2>&1 && continue
        code=$?
        [ $code = 1 ] || [ $code = 3 ] || { echo "faults: the gate itself ended with $code"; cat "$work/gate.txt"; exit 1; }
        verdict=caught
        where=$(awk '/ FAIL | inconclusive / { print $1 " " $2; exit }' "$work/gate.txt")
        said=$(grep -m1 '  *fails: \|  *inconclusive: ' "$work/gate.txt" | sed 's/^ *//')
        break
    done
    seconds=$(echo "$(date +%s.%N) $start" | awk '{ printf "%.1f", $1 - $2 }')
    good=yes
    [ "$class" = equivalent ] && wanted="passed everything" || wanted=caught
    [ "$verdict" = "$wanted" ] || { good=NO; missed=$((missed + 1)); }
    tried=$((tried + 1))
    printf '%s\t%s\t%s s\t%s\t%s\t%s\n' "$good" "$verdict" "$seconds" "$name" "$where" "$said" | tee -a $table
    rm -rf "$work"
done
echo "faults: $tried tried, $missed judged wrongly"
[ $missed = 0 ]
