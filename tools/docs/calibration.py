#!/usr/bin/env python3
"""The figure of `make calibrate`: are p-values of a right solver what they claim to be?

    calibration.py TABLE.csv SUMMARY.txt FIGURE.png

TABLE is what `gate calibrate` wrote, a row per seed, a column per statistical check; SUMMARY what it printed. Left, the share of p-values below p against p,
for checks whose null distribution is exact and for those that are conservative by construction (a band about the null, or the worst of many): a right suite
lies on the diagonal, or below it. Right, per exact check the Kolmogorov-Smirnov p of its column being uniform, in order: again the diagonal.
"""
import csv, math, re, subprocess, sys

FIXED = 4   # offset, seconds, failed, inconclusive
# Null is a band (systematic error of a step that is no fault) or the worst of many by Bonferroni: single_langevin.c, boltzmann.c, noise.c.
CONSERVATIVE = re.compile(r"worst block|^contact-share|^langevin.*(square|autocorrelation|equipartition)")


def shares(values):
    p, points = sorted(values), []
    at = 1 / max(1, len(p))
    while p and at <= 1:
        points.append(f"{at:.6g} {sum(x <= at for x in p) / len(p):.6g}")
        at *= 10 ** 0.05
    return [x for x in points if not x.endswith(" 0")]


def main(table, summary, figure):
    rows = list(csv.reader(line for line in open(table) if not line.startswith("#")))
    names, rows = rows[0], [r for r in rows[1:] if len(r) == len(rows[0])]
    pooled = {True: [], False: []}
    for k, name in enumerate(names[FIXED:], FIXED):
        pooled[bool(CONSERVATIVE.search(name))] += [float(r[k]) for r in rows if r[k] != "nan"]
    lines = [line.split() for line in open(summary) if re.match(r"\S+: .*(\s+\S+){6}$", line)]
    ks = sorted(float(line[-1]) for line in lines if line[-5].isdigit() and not CONSERVATIVE.search(" ".join(line)))
    n = max(1, len(pooled[False]))
    data = ["$exact << END", *shares(pooled[False]), "END", "$conservative << END", *shares(pooled[True]), "END",
            "$ks << END", *(f"{(k + 0.5) / len(ks):.6g} {x:.6g}" for k, x in enumerate(ks)), "END"]
    subprocess.run(["gnuplot"], check=True, text=True, input="\n".join(["set terminal pngcairo size 1100,480 enhanced font 'sans,11' background 'white'",
                                                                        f"set output '{figure}'", *data, f"""
set multiplot layout 1,2
set logscale xy
set key bottom right
set format xy '10^{{%T}}'
set xlabel 'p'
set ylabel 'share of p-values below p'
set title '{len(rows)} seeds, {n + len(pooled[True])} p-values of a right solver'
set xrange [{1 / n}:1]
set yrange [{0.5 / n}:1]
plot x + 3*sqrt(x/{n}) lc 'grey60' dt 2 title '3 deviations of {n}', (x > 9.0/{n} ? x - 3*sqrt(x/{n}) : NaN) lc 'grey60' dt 2 notitle, \\
     x lc 'grey40' title 'uniform', $exact with lines lw 2 lc 1 title 'exact null'{", $conservative with lines lw 2 lc 2 title 'conservative null'" if pooled[True] else ""}
unset logscale
set format xy '%g'
set xrange [0:1]
set yrange [0:1]
set key top left
set xlabel 'rank / number of checks'
set ylabel 'Kolmogorov-Smirnov p of being uniform'
set title '{len(ks)} checks with an exact null'
plot x lc 'grey40' title 'uniform', $ks with points pt 7 ps 0.5 lc 1 notitle
"""]))


main(*sys.argv[1:])
