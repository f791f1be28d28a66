set xlabel 'strain'
set ylabel 'stress / (viscosity x rate)'
plot data.'/stress.csv' using "strain":"eta_r" with lines lw 2 title 'relative viscosity', '' using "strain":"lubrication_xy" with lines title 'lubrication', \
     '' using "strain":"contact_normal_xy" with lines title 'contact, normal', '' using "strain":"contact_tangential_xy" with lines title 'contact, tangential'
