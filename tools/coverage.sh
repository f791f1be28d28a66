#!/bin/sh
# Line coverage of solver/ by the unit tests and the fast tier together. Bar: 90 %.
set -eu
cd "$(dirname "$0")/.."
b=build/coverage
make --no-print-directory -s -j"$(nproc)" >/dev/null
make --no-print-directory -s -j"$(nproc)" B=$b CFLAGS="-O1 -g --coverage" $b/unit-tests $b/shear $b/gate $b/lammps-candidate $b/shear-lammps $b/compare-checkpoints >/dev/null
find $b -name '*.gcda' -delete
$b/unit-tests >$b/unit-tests.txt
$b/gate run --candidate "$b/shear --evaluate" --jobs "$(nproc)" --work $b/cases --report $b/report >$b/gate.txt
tail -n 1 $b/unit-tests.txt $b/gate.txt
gcovr --root . --filter 'solver/' --object-directory $b --print-summary --fail-under-line 90 >$b/coverage.txt || { cat $b/coverage.txt; exit 1; }
sed -n '/^---/,$p' $b/coverage.txt
awk '/^lines:/ { print "coverage: lines of solver/ " $2 ", at least 90 %" }' $b/coverage.txt
