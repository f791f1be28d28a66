#!/bin/sh
# Valgrind on a small scene with every force, wrapping, a remap and every output; and on one frozen case.
set -eu
cd "$(dirname "$0")/.."
work=build/memcheck
mkdir -p $work
valgrind --quiet --error-exitcode=9 --leak-check=full --errors-for-leak-kinds=all build/shear docs/scenes/everything.json -o $work/run \
    --set run='{"steps":300}' --set shear[0].rate=6 --set start.time=0.083 --set dynamics.verlet.dt=2e-5
valgrind --quiet --error-exitcode=9 --leak-check=full --errors-for-leak-kinds=all build/shear docs/scenes/everything.json --check >/dev/null
valgrind --quiet --error-exitcode=9 --leak-check=full --errors-for-leak-kinds=all build/unit-tests scene >/dev/null
echo "memcheck: no errors, no leaks"
