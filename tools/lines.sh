#!/bin/sh
# The tour: everything that runs Li's model with velocity Verlet, in reading order, comments included. At most 2000 lines.
# Beside the tour: reading JSON (settings), the step limit, carrying contact histories over to new lists, the check of a scene, starts, observers, outputs, the gate's cases.
set -eu
cd "$(dirname "$0")/../solver"
tour="shear.c scene.h scene.c simulation.h simulation.c
core/vec3.h core/particles.h core/particles.c core/box.h core/box.c
core/pairs.h core/neighbours.h core/neighbours.c
core/force.h core/suspension.h core/suspension.c core/stress.h core/stress.c
forces/forces.h forces/contact.h forces/contact.c forces/drag.h forces/drag.c
core/resistance.h core/resistance.c forces/lubrication.h forces/lubrication.c
core/noise.h forces/drag_noise.c forces/lubrication_noise.c
core/motion.h core/motion.c core/dynamics.h dynamics/dynamics.h dynamics/verlet.c"
# shellcheck disable=SC2086
wc -l $tour | awk '{ printf "%6d %s\n", $1, $2 } $2 == "total" { total = $1 }
    END { printf "tour: %d lines, at most 2000\n", total; exit total > 2000 }'
