# Li (2026) fig 4.3b: running Green-Kubo viscosity, points; exponential approach, lines
set logscale xy
set key top left
set xlabel 'lag / {/Symbol t}_I'
set ylabel '{/Symbol h}_{GK} / {/Symbol h}'
plot for [p in "0.30 0.45 0.50 0.55"] data.'fig4.3b.csv' skip 3 using (strcol(1) eq 'phi-'.p ? $3 : NaN):5 pt 7 ps 0.5 title '{/Symbol f} = '.p, \
     for [p in "0.30 0.45 0.50 0.55"] data.'fig4.3b.csv' skip 3 using (strcol(1) eq 'phi-'.p ? $3 : NaN):6 with lines lc 'gray' notitle
