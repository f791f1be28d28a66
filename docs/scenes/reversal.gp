set xlabel 'strain'
set ylabel 'relative viscosity'
set yrange [0:30]
set arrow from 2, graph 0 to 2, graph 1 nohead dashtype 2
plot data.'/viscosity.csv' using "strain":(1 + column("shear")/column("rate")) with lines lw 2 title 'reversed at strain 2'
