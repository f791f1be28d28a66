# Li (2026) fig 4.2d: D/D_0 against volume fraction for three tau_I/tau_B
set key top right
set xlabel 'volume fraction'
set ylabel 'D / D_0'
set xrange [0:0.6]
set yrange [0:1.05]
plot for [r in "1.7 0.17 0.017"] data.'fig4.2d.csv' skip 3 using ($2 == r + 0 ? $1 : NaN):3:4 with yerrorbars pt 7 ps 0.8 title 'up to 0.5 a^2/D_0, {/Symbol t}_I/{/Symbol t}_B = '.r, \
     for [r in "1.7 0.17 0.017"] data.'fig4.2d.csv' skip 3 using ($2 == r + 0 ? $1 + 0.008 : NaN):5:6 with yerrorbars pt 6 ps 0.8 title '1 to 2 a^2/D_0, {/Symbol t}_I/{/Symbol t}_B = '.r
