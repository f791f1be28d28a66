set xlabel 'time'
set ylabel 'velocity along x and y'
small = '< grep -E "^[0-9]+,[^,]+,1," '.data.'/trajectory.csv'
large = '< grep -E "^[0-9]+,[^,]+,2," '.data.'/trajectory.csv'
plot small using 2:7 with lines lw 2 title 'small, x', small using 2:8 with lines title 'small, y', \
     large using 2:7 with lines lw 2 title 'large, x', large using 2:8 with lines title 'large, y'
