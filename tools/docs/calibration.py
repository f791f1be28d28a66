#!/usr/bin/env python3
"""The figure of `make calibrate`: are p-values of a right solver what they claim to be?

    calibration.py TABLE.csv FIGURE.png

TABLE is what `gate calibrate` wrote: a row per seed, a column per statistical check. Left, the share of p-values below p against p, for checks whose null
distribution is exact and for those that are conservative by construction (a band about the null, or the worst of many): a right suite lies on the
diagonal, or below it. Right, per exact check the Kolmogorov-Smirnov p of its column being uniform, in order: again the diagonal. Prints the counts.
"""
import csv, math, re, subprocess, sys

FIXED = 4   # offset, seconds, failed, inconclusive
# Null is a band (systematic error of a step that is no fault) or the worst of many by Bonferroni: single_langevin.c, boltzmann.c, noise.c.
CONSERVATIVE = re.compile(r"worst block|^contact-share|^langevin.*(square|autocorrelation|equipartition)")


def read(path):
    rows = list(csv.reader(line for line in open(path) if not line.startswith("#")))
    names, rows = rows[0][FIXED:], [r for r in rows[1:] if len(r) == len(rows[0])]
    return names, [[float(r[FIXED + k]) for r in rows if r[FIXED + k] != "nan"] for k in range(len(names))], rows


def uniform_p(values):
    """Kolmogorov-Smirnov, with Stephens's (1970) correction for small samples."""
    n, p = len(values), sorted(values)
    d = max(max((k + 1) / n - x, x - k / n) for k, x in enumerate(p))
    t = d * (math.sqrt(n) + 0.12 + 0.11 / math.sqrt(n))
    return 1.0 if t < 0.2 else min(1.0, 2 * sum((-1) ** (k - 1) * math.exp(-2 * k * k * t * t) for k in range(1, 101)))


def poisson_above(count, mean):
    """Chance of `count` or more where `mean` are expected."""
    term, below = math.exp(-mean), 0.0
    for k in range(count):
        below += term
        term *= mean / (k + 1)
    return max(0.0, 1 - below)


def shares(values):
    p, n = sorted(values), len(values)
    at, points = 10.0 ** (-math.ceil(math.log10(n))), []
    while at <= 1:
        points.append((at, sum(x <= at for x in p) / n))
        at *= 10 ** 0.05
    return [f"{x:.6g} {y:.6g}" for x, y in points if y > 0]


def main(table, figure):
    names, columns, rows = read(table)
    exact = [k for k, name in enumerate(names) if not CONSERVATIVE.search(name)]
    pooled = {"exact": [x for k in exact for x in columns[k]], "conservative": [x for k in range(len(names)) if k not in exact for x in columns[k]]}
    ks = sorted(uniform_p(columns[k]) for k in exact)
    data = ["$exact << END", *shares(pooled["exact"]), "END", "$conservative << END", *shares(pooled["conservative"]), "END",
            "$ks << END", *(f"{(k + 0.5) / len(ks):.6g} {x:.6g}" for k, x in enumerate(ks)), "END"]
    n = len(pooled["exact"])
    subprocess.run(["gnuplot"], check=True, text=True, input="\n".join([f"""
set terminal pngcairo size 1100,480 enhanced font 'sans,11' background 'white'
set output '{figure}'""", *data, f"""
set multiplot layout 1,2
set logscale xy
set key bottom right
set format xy '10^{{%T}}'
set xlabel 'p'
set ylabel 'share of p-values below p'
set title '{len(rows)} seeds, {n + len(pooled["conservative"])} p-values of a right solver'
set xrange [{1 / n}:1]
set yrange [{0.5 / n}:1]
plot x + 3*sqrt(x/{n}) lc 'grey60' dt 2 title '3 deviations of {n}', (x > 9.0/{n} ? x - 3*sqrt(x/{n}) : NaN) lc 'grey60' dt 2 notitle, \\
     x lc 'grey40' title 'uniform', $exact with lines lw 2 lc 1 title 'exact null', $conservative with lines lw 2 lc 2 title 'conservative null'
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
    for kind, values in pooled.items():
        tails = ", ".join(f"{sum(x < q for x in values)} below {q:g} ({q * len(values):.1f} if uniform)" for q in (1e-2, 1e-3, 1e-4))
        print(f"calibration: {kind}: {len(values)} p-values, {tails}")
    print(f"calibration: columns with an exact null: least Kolmogorov-Smirnov p {ks[0]:.2g} of {len(ks)} ({ks[0] * len(ks):.2g} after Bonferroni); all of them together {uniform_p(ks):.2g}")
    worst = min((poisson_above(sum(x < 0.01 for x in c), 0.01 * len(c)), name) for c, name in zip(columns, names) if c)
    print(f"calibration: most often below 0.01 for its number: {worst[1]}, a chance of {worst[0]:.2g} ({worst[0] * len(names):.2g} after Bonferroni)")
    bad = sum(float(r[2]) > 0 for r in rows), sum(float(r[3]) > 0 for r in rows)
    print(f"calibration: {len(rows)} seeds, {bad[0]} with a false failure, {bad[1]} with an inconclusive result"
          + ("" if bad[0] else f"; the rate of false runs is below {-math.log(0.05) / len(rows):.2g} with 95 % confidence"))


main(*sys.argv[1:])
