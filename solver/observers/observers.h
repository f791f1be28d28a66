/* Every observer. */
#ifndef OBSERVERS_H
#define OBSERVERS_H

#include "core/observer.h"
#include "core/settings.h"
#include "output/table.h"

struct observer *stress_table_new(struct settings *s, struct suspension *of, struct error *e);
struct observer *trajectory_new(struct settings *s, struct suspension *of, struct error *e);
struct observer *viscosity_new(struct settings *s, struct suspension *of, struct error *e);
struct observer *contacts_new(struct settings *s, struct suspension *of, struct error *e);
struct observer *temperature_new(struct settings *s, struct suspension *of, struct error *e);
struct observer *displacement_new(struct settings *s, struct suspension *of, struct error *e);
struct observer *velocity_correlation_new(struct settings *s, struct suspension *of, struct error *e);
struct observer *pair_distribution_new(struct settings *s, struct suspension *of, struct error *e);
struct observer *brownian_stress_new(struct settings *s, struct suspension *of, struct error *e);
struct observer *green_kubo_new(struct settings *s, struct suspension *of, struct error *e);
struct observer *averages_new(struct settings *s, struct suspension *of, struct error *e);

#endif
