#!/bin/sh
# Valgrind on a small scene with every force, wrapping, a remap and every output; and on one frozen case.
set -eu
cd "$(dirname "$0")/.."
work=build/memcheck
mkdir -p $work
valgrind --quiet --error-exitcode=9 --leak-check=full --errors-for-leak-kinds=all build/shear docs/scenes/everything.json -o $work/run \
    --set run='{"steps":300}' --set shear[0].rate=6 --set start.time=0.083 --set dynamics.verlet.dt=2e-5
for more in '' --resume; do     # every observer, and checkpoints written and read
    # shellcheck disable=SC2086
    valgrind --quiet --error-exitcode=9 --leak-check=full --errors-for-leak-kinds=all build/shear docs/scenes/everything.json -o $work/split $more \
        --set run="{\"steps\":${more:+1}50}" --set output='{"checkpoint":{"every":20},"averages":{"every":5},"displacement":{"every":2,"levels":3},
            "pair_distribution":{"every":25,"range":4,"bins":9,"near":{"gap":0.1,"bins":5}},"brownian_stress":{"every":25},"contacts":{"every":5}}'
done
valgrind --quiet --error-exitcode=9 --leak-check=full --errors-for-leak-kinds=all build/shear docs/scenes/everything.json --check >/dev/null
valgrind --quiet --error-exitcode=9 --leak-check=full --errors-for-leak-kinds=all build/unit-tests scene >/dev/null
echo "memcheck: no errors, no leaks"
