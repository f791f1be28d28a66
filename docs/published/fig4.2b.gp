# Li (2026) fig 4.2b: points measured at tau_I/tau_B 1.7; gray eq 4.2, black the ballistic part
set logscale xy
set format y '10^{%L}'
set format x '10^{%L}'
set key top left
set xlabel 't / {/Symbol t}_I'
set ylabel '<x^2> / a^2, per component'
set xrange [5e-6:60]
f(x, r) = 2 / (27 * pi) * r * (4.5 * x - 1 + exp(-4.5 * x))
plot [5e-6:60] x > 1e-3 ? f(x, 1.7) : NaN lc 'gray' title 'eq 4.2', 1.7 * 3 / (4 * pi) * x**2 lc 'black' dt 2 title '(kT/m) t^2', \
     for [phi in "0.1 0.2 0.3 0.4 0.5"] data.'fig4.2b.csv' skip 3 using ($1 == phi + 0 && $2 == 1.7 ? $3 : NaN):5 pt 7 ps 0.5 title '{/Symbol f} = '.phi
