/* Every observer. */
#ifndef OBSERVERS_H
#define OBSERVERS_H

#include "core/observer.h"
#include "core/settings.h"
#include "output/table.h"

struct observer *stress_table_new(struct settings *s, struct suspension *of, struct error *e);
struct observer *trajectory_new(struct settings *s, struct suspension *of, struct error *e);

#endif
