set xlabel 'time'
set ylabel 'shear stress along the steady flow'
plot data.'/viscosity.csv' using "time":"shear" with lines lw 2 title 'all', '' using "time":"shear_contact_normal" with lines title 'contact, normal', \
     '' using "time":"shear_contact_tangential" with lines title 'contact, tangential'
