#include "core/resistance.h"

struct resistance_sizes resistance_of_sizes(double viscosity, double a_i, double a_j)
{
    const double b = a_j / a_i, c = a_i / a_j;
    const double A = 6.0 * M_PI * viscosity * a_i;
    const double B_i = -4.0 * M_PI * viscosity * a_i * a_i, B_j = -4.0 * M_PI * viscosity * a_j * a_j;
    const double C_i = 8.0 * M_PI * viscosity * a_i * a_i * a_i, C_j = 8.0 * M_PI * viscosity * a_j * a_j * a_j;
    const double cube = (1.0 + b) * (1.0 + b) * (1.0 + b);
    return (struct resistance_sizes){
        .squeeze = A * 2.0 * b * b / cube,
        .log = { .X_A = A * b * (1.0 + 7.0 * b + b * b) / (5.0 * cube),
                 .Y_A = A * 4.0 * b * (2.0 + b + 2.0 * b * b) / (15.0 * cube),
                 .B_1 = B_i * b * (4.0 + b) / (5.0 * (1.0 + b) * (1.0 + b)),
                 .B_2 = B_j * c * (4.0 + c) / (5.0 * (1.0 + c) * (1.0 + c)),
                 .C_11 = C_i * 2.0 * b / (5.0 * (1.0 + b)),
                 .C_12 = C_i * b * b / (10.0 * (1.0 + b)),
                 .C_22 = C_j * 2.0 * c / (5.0 * (1.0 + c)) } };
}
