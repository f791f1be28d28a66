#include "describe.h"

#include "core/step_limit.h"

#include <stdio.h>
#include <string.h>

void describe_scene(const struct simulation *sim, struct error *e)
{
    const struct suspension *s = &sim->suspension;
    const struct particles *p = &s->particles;
    const struct step_limit limit = step_limit_of(s, e);
    double solid = 0.0, smallest = INFINITY, k_n = 0.0;
    for (int i = 0; i < p->count; i++)
        solid += 4.0 / 3.0 * M_PI * pow(radius_of(p, i), 3);
    for (int k = 0; k < p->species_count; k++)
        smallest = fmin(smallest, p->kind[k].radius);
    printf("scene       %s\nparticles   %d of %d species, volume fraction %.6g, %s\n", sim->about, p->count, p->species_count,
           solid / s->box.volume, s->rotates ? "rotating" : "without rotation");
    printf("cell        A (%g, %g, %g)  B (%g, %g, %g)  C (%g, %g, %g)\nforces     ", s->box.cell.m[0][0], s->box.cell.m[1][0], s->box.cell.m[2][0],
           s->box.cell.m[0][1], s->box.cell.m[1][1], s->box.cell.m[2][1], s->box.cell.m[0][2], s->box.cell.m[1][2], s->box.cell.m[2][2]);
    for (int k = 0; k < s->force_count; k++) {
        struct response r = { 0 };
        printf(" %s", s->force[k]->name);
        if (s->force[k]->respond)
            s->force[k]->respond(s->force[k], p, 0, 0, -1e-300, &r);
        k_n = fmax(k_n, r.normal_stiffness);
    }
    const double rho = p->kind[0].density, a = smallest, eta = s->viscosity;
    printf("%s\npairs       %d within range\ntime scales", s->force_count ? "" : " none", s->neighbours.near.count);
    if (k_n > 0)
        printf("  contact sqrt(rho a^3/k_n) %.4g", sqrt(rho * a * a * a / k_n));
    if (eta > 0)
        printf("  inertia rho a^2/eta %.4g", rho * a * a / eta);
    if (eta > 0 && s->kT > 0)
        printf("  diffusion eta a^3/kT %.4g", eta * a * a * a / s->kT);
    if (s->box.rate > 0)
        printf("  shear 1/rate %.4g", 1.0 / s->box.rate);
    printf("\nstep        dt %.6g, limit %.6g (set by %s), advised %.3g\nrun         %lld steps, time %.6g, strain %.6g\n", s->dt, limit.dt,
           limit.force, step_advised(s), (long long)sim->last_step, (double)sim->last_step * s->dt, 
           box_strain(&s->box, s->start_time, s->start_time + (double)sim->last_step * s->dt));
}

void describe_provenance(struct simulation *sim, const char *scene, const struct scene_options *options)
{
    struct destination *to = &sim->destination;
    int used = snprintf(to->provenance, sizeof to->provenance, "# shear %s\n# scene: %s\n# about: %s\n# seed %u realisation %u dt %.17g\n",
                        SHEAR_VERSION, scene, sim->about, sim->suspension.key.seed, sim->suspension.key.realisation, sim->suspension.dt);
    for (int k = 0; k < options->set_count && used < 1200; k++)
        used += snprintf(to->provenance + used, sizeof to->provenance - (size_t)used, "# --set %.100s\n", options->set[k]);
    for (char *c = to->provenance; *c; c++)             /* a text may have line breaks of its own */
        if (*c == '\r' || (*c == '\n' && c[1] && strncmp(c + 1, "# ", 2) != 0))
            *c = ' ';
}

/*
 * Predicted biases, with where they were measured in docs/integrators.md. Density in contact: verlet 1 - eps/2, predicted_verlet
 * (1 - eps)^(1/3) (1 + eps/2)^(2/3), about 1 - eps^2/4. Lubrication stress of pair sweeps: low by 0.0015 eps^2 at volume fraction 0.50.
 */
void describe_bias(const struct simulation *sim)
{
    const struct suspension *s = &sim->suspension;
    const double eps = step_bias(s, s->dt);
    const double density = s->predicted_friction ? cbrt(fmax(0.0, 1.0 - eps) * (1.0 + 0.5 * eps) * (1.0 + 0.5 * eps)) : 1.0 - 0.5 * eps;
    const double order = 0.0015 * eps * eps;
    if (s->kT > 0.0 && !sim->dynamics->friction && density < 0.995)
        fprintf(stderr, "shear: note: with noise, %s makes pairs in contact rarer by the factor %s = %.3f (eps = X_A dt/m_eff = %.3g); "
                        "a smaller dt lessens it %s\n", sim->dynamics->name, s->predicted_friction ? "1 - eps^2/4 ..." : "1 - eps/2", density, eps,
                s->predicted_friction ? "as dt^2" : "in proportion");
    if (s->friction_sweeps && order > 0.005)
        fprintf(stderr, "shear: note: pair sweeps make friction too weak where many pairs share particles: about 0.0015 eps^2 = %.2g of the "
                        "lubrication stress at volume fraction 0.5 (eps = X_A dt/m_eff = %.3g); a smaller dt lessens it as dt^2\n", order, eps);
}
