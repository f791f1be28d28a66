set xlabel 'distance of centres'
set ylabel 'g'
plot '< grep ^far '.data.'/pair_distribution.csv' using (0.5*($4+$5)):7 with lines lw 2 title 'pair distribution, volume fraction 0.40'
