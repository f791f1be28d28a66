# Li (2026) fig 4.2a: points measured, lines eq 4.2
set logscale xy
set format y '10^{%L}'
set key top left
set xlabel 't / {/Symbol t}_I'
set ylabel '<x^2> / a^2, per component'
f(x, r) = 2 / (27 * pi) * r * (4.5 * x - 1 + exp(-4.5 * x))
plot for [r in "0.017 0.17 1.7"] f(x, r + 0) lc 'gray' notitle, \
     for [r in "0.017 0.17 1.7"] data.'fig4.2a.csv' skip 3 using ($1 == r + 0 ? $2 : NaN):3:5 with yerrorbars pt 7 ps 0.7 title '{/Symbol t}_I/{/Symbol t}_B = '.r
