/*
 * Steady shear: the flow is the sum of simple shears at constant rate
 *
 *     U_inf(x) = G x,    G_fg = rate  for flow along axis f that varies along axis g
 *
 * Which sums keep a cell that can be remapped is box.c's to say.
 */
#include "protocols/protocols.h"

mat3 steady_shear(struct settings *root, struct error *e)
{
    static const char *const axes[] = { "x", "y", "z", NULL };
    mat3 G = { { { 0.0 } } };
    const int shears = settings_has(root, "shear") ? settings_length(root, "shear", e) : 0;
    for (int k = 0; k < shears && !error_raised(e); k++) {
        struct settings shear = settings_item(root, "shear", k, e);
        const int flow = settings_choice(&shear, "flow", axes, e), gradient = settings_choice(&shear, "gradient", axes, e);
        const double rate = settings_number(&shear, "rate", e);
        if (!error_raised(e) && flow == gradient)
            settings_refuse(&shear, "gradient", e, "must differ from the flow's axis");
        G.m[flow][gradient] += rate;
        settings_done(&shear, e);
    }
    return G;
}
