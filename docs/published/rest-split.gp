# Parts of the pressure at rest against the step of the explicit scheme; the split at 0.001 drawn at 0
set key center right
set xlabel 'time step / 10^{-4}  (split, step 10: drawn at 0)'
set ylabel 'pressure / (n kT)'
set xrange [-0.2:2.3]
set yrange [-0.5:7]
plot data.'rest-split.csv' skip 3 using ($2 * 1e4):3:4 with yerrorbars pt 7 title 'contact', \
     data.'rest-split.csv' skip 3 using ($2 * 1e4):5 with lines lc 'gray' title 'Carnahan and Starling times 1 - {/Symbol e}/2', \
     data.'rest-split.csv' skip 3 using ($2 * 1e4):6:7 with yerrorbars pt 5 title 'lubrication', \
     data.'rest-split.csv' skip 3 using ($2 * 1e4):8:9 with yerrorbars pt 6 title 'sum'
