/* Layer 1: the table of its checks; the files pair_*.c hold them. */
#include "pair_checks.h"

const struct check pair_checks[] = {
    { "pair-forces", pair_forces }, { "pair-resistance", pair_resistance }, { "pair-frames", pair_frames },
    { "pair-rigid", pair_rigid },   { "pair-crowd", pair_crowd }, { "pair-drawn", pair_drawn },           { "pair-drag", pair_drag },
    { "pair-units", pair_units },   { "pair-repulsion", pair_repulsion }, { "pair-applied", pair_applied },
    { "pair-cut-off", pair_cut_off }, { NULL, NULL },
};
